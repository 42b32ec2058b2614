// How far a quantile of paired values lies from that of their references.
#ifndef LD_STUDIES_QUANTILE_DIFFERENCE_H
#define LD_STUDIES_QUANTILE_DIFFERENCE_H

#include <stddef.h>
#include <stdint.h>

#include "launchdyn/status.h"
#include "studies/statistics/statistics.h"

// Pairs in the order of their groups, which rise.
typedef struct quantile_pairs {
    const double *value[2]; // [count] value, reference
    const int64_t *group;   // [count]
    size_t count;
} quantile_pairs;

// The difference of Harrell and Davis's estimators (Biometrika 69, 1982), whose weights reach over
// all order statistics; its interval by a bootstrap over groups, percentiles of resamples with
// fixed keys, as Wilcox compares quantiles of dependent groups (Introduction to Robust Estimation
// and Hypothesis Testing, 2012, section 5.9). NaN: no interval of fewer than eight groups, or where
// one side has none (quantile_of_values()).
// @return LD_OK, LD_ERR_MEMORY
ld_status quantile_difference_of(const quantile_pairs *pairs, double q, estimate *difference);

#endif
