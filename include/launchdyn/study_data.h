/// What a study's folder holds, as numbers: its points, columns and values, and their statistics.
#ifndef LAUNCHDYN_STUDY_DATA_H
#define LAUNCHDYN_STUDY_DATA_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "launchdyn/status.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/// A snapshot of a study, which may be running: what it adds later is not seen. On one thread at a
/// time.
typedef struct ld_study_data ld_study_data;

/// @param data to be closed; NULL on failure
/// @return LD_OK, LD_ERR_INPUT (no study there), LD_ERR_FILE, LD_ERR_MEMORY
ld_status ld_study_data_open(const char *folder, ld_study_data **data, ld_error *error);
/// May be NULL.
void ld_study_data_close(ld_study_data *data);

/// A number of each rocket, or of each sample.
typedef struct ld_study_column {
    const char *name; ///< of a result, or path of a factor
    const char *unit; ///< SI; "" without, or of a factor that this version does not know
    bool factor;      ///< drawn; else a result
    bool per_rocket;  ///< else one for all rockets of a sample
    bool seed;        ///< a factor that is another seed in each sample
} ld_study_column;

/// Column `index` (from 0), results first, then factors; NULL after the last.
const ld_study_column *ld_study_data_column(const ld_study_data *data, int index);

/// The path of swept key `axis` (from 0); NULL after the last.
const char *ld_study_data_swept(const ld_study_data *data, int axis);

/// A point of the sweep; a study without one has a single point.
typedef struct ld_study_point {
    int64_t number;          ///< from 1
    const char *const *text; ///< value of each swept key, as in the scenario
    int64_t asked;           ///< samples; of all, `done` are kept, of which `failed`
    int64_t done, failed;
} ld_study_point;

/// Point `number` (from 1); NULL after the last.
const ld_study_point *ld_study_data_point(const ld_study_data *data, int number);

/// Values of the rockets of a point's samples that went well, in order of (sample, rocket).
typedef struct ld_study_values {
    size_t count;
    const int64_t *sample;      ///< [count] number of the sample
    const int *rocket;          ///< [count] from 1, in the order of firing
    const double *const *value; ///< [columns][count] in the order in which they were asked for, SI
} ld_study_values;

/// Reads some columns by name; rockets that lack one of the values are left out.
/// @param values the data's own, until the next call that reads
/// @return LD_OK, LD_ERR_INPUT (no such column or point), LD_ERR_FILE, LD_ERR_MEMORY
ld_status ld_study_data_values(ld_study_data *data, int point, const char *const *names,
                               size_t columns, const ld_study_values **values, ld_error *error);

/// A number with its interval of 95 %, NaN where none can be stated.
typedef struct ld_estimate {
    double value;
    double low, high;
} ld_estimate;

/// Of the values of a column. The rockets of one sample are not independent: intervals count
/// groups, of which a sample, or a whole Latin hypercube, is one.
typedef struct ld_study_statistics {
    size_t count;          ///< values
    size_t groups;         ///< independent ones
    ld_estimate mean;      ///< interval: Student's t over groups
    ld_estimate deviation; ///< of all values; interval: studentised bootstrap over groups
    double skewness;
    double least, greatest;
    ld_estimate
        quantile[3]; ///< 5 %, 50 %, 95 %; interval: order statistics of the effective number
} ld_study_statistics;

/// @param statistics the data's own, until the next call that reads
/// @return as ld_study_data_values()
ld_status ld_study_data_statistics(ld_study_data *data, int point, const char *name,
                                   const ld_study_statistics **statistics, ld_error *error);

/// How much of the variance of a result one factor explains alone (docs/study.md).
/// @param share NaN where the result does not scatter, or with too few samples
/// @return as ld_study_data_values()
ld_status ld_study_data_sensitivity(ld_study_data *data, int point, const char *result,
                                    const char *factor, ld_estimate *share, ld_error *error);

/// What one factor does to a result (docs/study.md); what the plan of the samples does not give is
/// NaN.
typedef struct ld_study_influence {
    const char *factor;   ///< its path
    ld_estimate first;    ///< first-order index; of other plans than saltelli a regression's
    ld_estimate total;    ///< total index, plan saltelli
    ld_estimate together; ///< total less first: the share that it makes with other factors
    ld_estimate mu_star;  ///< mean magnitude of its elementary effects, plan morris
    ld_estimate mu;       ///< their mean
    double sigma;         ///< their deviation
    size_t count, groups; ///< rows or effects, of each rocket; independent groups
} ld_study_influence;

/// Of all factors on a result, the greatest total index, first-order one or mu_star first.
/// @param list [*count] the data's own, until the next call that reads
/// @return as ld_study_data_values()
ld_status ld_study_data_influences(ld_study_data *data, int point, const char *result,
                                   const ld_study_influence **list, size_t *count, ld_error *error);

/// A footprint, for range safety: the region in which a share of landings lies (docs/study.md).
typedef struct ld_study_footprint {
    double share;         ///< of further landings that lie within, on average
    double needed;        ///< independent landings that it requires
    double independent;   ///< how many report this share as well as those that are there
    bool stated;          ///< there are as many as are needed; else what follows is NaN
    ld_estimate content;  ///< share of further landings that lie within
    ld_estimate area;     ///< [m2] interval: of the contour within which the share lies exactly
    ld_estimate distance; ///< [m] from the launch point to the farthest point; interval likewise
} ld_study_footprint;

/// The footprint of a point's landings.
/// @param share 0.95, 0.99 or 0.999
/// @param footprint the data's own, until the next call that reads
/// @return as ld_study_data_values(); LD_ERR_INPUT too for another share, and where fewer than
///         three rockets have landed, or all on one line
ld_status ld_study_data_footprint(ld_study_data *data, int point, double share,
                                  const ld_study_footprint **footprint, ld_error *error);

/// What is asked of a sweep.
typedef struct ld_study_over {
    const char *result;  ///< name of a column; NULL of a footprint
    const char *over;    ///< one or two swept keys, "base.speed,firing.interval"; NULL: the first
    const char *against; ///< a point by number or as KEY=VALUE,...: differences from it; NULL: none
    const char *statistic;   ///< as of ld_study_question (launchdyn/study.h); NULL: "mean"
    const void *reserved[4]; ///< NULL: room for what later versions may be asked
} ld_study_over;

/// A value of the swept key, or a pair of values of two, pooled over the other keys: every point
/// has the same weight, intervals count the groups that all points share (docs/study.md).
typedef struct ld_study_cell {
    const char *text[2];  ///< as in the scenario; NULL: of one key the second
    double number[2];     ///< in `unit`; NaN where the key's values are no numbers of one kind
    const char *unit[2];  ///< as in the scenario; "" without
    ld_estimate estimate; ///< SI; of differences that of the means or shares, ratio of deviations
    size_t count, groups; ///< rockets, or pairs of them; independent groups
    int points;           ///< that have them
    bool reference;       ///< what differences are from: `estimate` is NaN
} ld_study_cell;

/// A result over the values of swept keys, the first key varying most slowly.
/// @param cell [*count] the data's own, until the next call that reads
/// @return LD_OK; LD_ERR_INPUT (no sweep, no such key, result, point or statistic), LD_ERR_FILE,
///         LD_ERR_MEMORY
ld_status ld_study_data_pool(ld_study_data *data, const ld_study_over *question,
                             const ld_study_cell **cell, size_t *count, ld_error *error);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
