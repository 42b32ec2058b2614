// What a study's folder holds, for those who read it (show, export, report, `until`): its points,
// columns, counts and failures, and columns of values. A snapshot: what a running study adds later
// is not seen.
#ifndef LD_STUDIES_STUDY_DATA_H
#define LD_STUDIES_STUDY_DATA_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "launchdyn/origin.h"
#include "launchdyn/status.h"
#include "launchdyn/study_data.h"
#include "model/blocks/study.h"

typedef ld_study_column study_column;
typedef ld_study_point study_point;

// How its samples were planned; random where the scenario cannot be read.
typedef struct study_plan {
    ld_plan kind;
    int seed, factors;
    int row; // runs of a row
} study_plan;

typedef struct study_data {
    struct study_reader *reader;
    study_plan plan;
    const char *title, *scenario, *version; // the scenario as text in SI, launchdyn's version
    int64_t strata; // samples of one Latin hypercube: they are one group; 1: random
    int column_count, result_count, swept_count, point_count;
    const study_column *column; // [column_count] results first, then factors
    const int *number;          // [column_count] of a factor in the scenario, from 0; else -1
    const char *const *swept;   // [swept_count] paths of the swept keys
    const study_point *point;   // [point_count]
    int64_t asked;              // samples, of all points
    int64_t rockets;            // of all samples that are as they were kept
    ld_error damage;            // what is wrong with the others; LD_OK: nothing
} study_data;

// @return LD_OK, LD_ERR_INPUT (no study there, or it is damaged), LD_ERR_FILE, LD_ERR_MEMORY
ld_status study_data_open(const char *folder, study_data *data, ld_error *error);
// The same where samples are damaged; of those that are not, counts alone are good.
ld_status study_data_open_damaged(const char *folder, study_data *data, ld_error *error);
void study_data_close(study_data *data);
// The database that it reads.
struct study_store *study_data_store(const study_data *data);

// Where the study comes from; without a scenario where it does not say.
ld_status study_data_origin(const study_data *data, ld_origin *origin, ld_error *error);

// The column of that name; else NULL, with *nearest the name that may be meant, or NULL.
const study_column *study_data_find(const study_data *data, const char *name, const char **nearest);

// Samples of a point that failed in the same way.
typedef struct study_failure {
    int64_t count, first; // how many, number of the first
    char status[16];      // `input`, `launch`, `numeric`
    char reason[384];     // of the first
} study_failure;

// Fills up to `capacity`, the most frequent first; *count becomes how many.
ld_status study_data_failures(const study_data *data, const study_point *point,
                              study_failure *failure, int capacity, int *count, ld_error *error);

// A sample that failed.
typedef struct study_failed {
    int64_t sample;
    char status[16];
    char reason[384];
} study_failed;

// Fills up to `capacity`, in the order of their numbers; *count becomes how many.
ld_status study_data_failed(const study_data *data, const study_point *point, study_failed *failed,
                            int capacity, int *count, ld_error *error);

// Columns of the rockets of a point's samples that went well, in order of (sample, rocket).
typedef struct study_values {
    size_t count, capacity;
    int columns;             // for which there is room
    int64_t *sample, *group; // [count] group: number of the independent unit, rises
    int *rocket;             // [count] from 1, in the order of firing
    double **value;          // [columns][count] in the order in which they were asked for
} study_values;

// Reads some columns; rockets that lack one of the values are left out. `values` is used again from
// call to call; zeros at first, to be freed.
ld_status study_data_read(const study_data *data, const study_point *point,
                          const study_column *const *column, int columns, study_values *values,
                          ld_error *error);
void study_values_free(study_values *values);

// Reads the places of the rockets' lines, "line.N.x" and "line.N.z", all as two columns: those of
// one line after each other. Their count is 0 where the study has no lines.
ld_status study_data_read_line(const study_data *data, const study_point *point,
                               study_values *values, ld_error *error);

// Half the width of the 95 % interval of a result's statistic that a stopping rule asks for, the
// greatest over all points, of the samples numbered up to `last` (0: of all). Of a relative one, as
// a share of the statistic's magnitude. Infinite while a point states no interval; 0 of a result
// that does not scatter.
ld_status study_data_half_width(const study_data *data, const study_column *result,
                                const ld_until *rule, int64_t last, double *half, ld_error *error);

#endif
