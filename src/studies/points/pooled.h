// Points of a sweep taken together: what their rockets have on average over these points. All
// points share sampled numbers, so intervals go over the groups that the points have in common.
#ifndef LD_STUDIES_POOLED_H
#define LD_STUDIES_POOLED_H

#include "studies/points/against.h"

// The numbers of a rocket: those asked for, then of its pair at the point of reference.
enum { POOLED_COLUMNS = 2, POOLED_NUMBERS = 2 * POOLED_COLUMNS };

typedef struct pooled_row {
    int64_t sample, group;
    int point, rocket; // point from 0, of those that are pooled
    double value[POOLED_NUMBERS];
} pooled_row;

// Zeros at first, to be freed; used again from pool to pool.
typedef struct pooled {
    int columns; // 1 or 2
    int points;  // of which there are rows
    size_t count, capacity;
    pooled_row *row;               // [count] in order of their samples
    int64_t *sample, *group;       // [count]
    double *value[POOLED_NUMBERS]; // [count] room for what is made of the rows
    study_values read[2];
} pooled;

void pooled_free(pooled *self);

// Begins one of so many columns.
void pooled_begin(pooled *self, int columns);
// Adds the rockets of a point that have the columns; `reference` where rows are pairs, else NULL.
ld_status pooled_add(pooled *self, const study_data *data, const study_point *point,
                     const study_point *reference, const study_column *const *column,
                     ld_error *error);
// After the last point.
// @return LD_OK, LD_ERR_MEMORY
ld_status pooled_end(pooled *self);

// Independent groups.
size_t pooled_groups(const pooled *self);

// The mean of the points' means, each of the same weight. Of one point that of statistics_of().
// @return LD_OK, LD_ERR_MEMORY
ld_status pooled_mean(const pooled *self, uncertain *mean);
estimate interval_of(const uncertain *mean);

// The root of the mean of the points' variances: what moves the mean from point to point is left
// out. Of one point that of statistics_of(); points with one value have no variance.
// @return LD_OK, LD_ERR_MEMORY
ld_status pooled_deviation(const pooled *self, estimate *deviation);

// The quantile of all rockets.
// @return LD_OK, LD_ERR_MEMORY
ld_status pooled_quantile(const pooled *self, double q, estimate *quantile);

// How far the quantile of all rockets is from that of their pairs (quantile_difference.h).
// @return LD_OK, LD_ERR_MEMORY
ld_status pooled_quantile_difference(const pooled *self, double q, estimate *difference);

// How far the pooled values are from those of reference: the difference of the means as of
// pooled_mean(), the ratios of deviations as of pooled_deviation(). Of one point that of
// paired_statistics_of().
// @return LD_OK, LD_ERR_MEMORY
ld_status pooled_pairs(const pooled *self, paired_statistics *of);

#endif
