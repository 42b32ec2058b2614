// Values beside those of a reference, pair by pair: rockets that drew the same numbers, so that
// what they share drops out of differences and ratios.
#ifndef LD_STUDIES_PAIRS_H
#define LD_STUDIES_PAIRS_H

#include "studies/statistics/statistics.h"

// A result, or two of one unit, of rockets in the order of their groups and samples.
typedef struct paired_values {
    int columns;                // 1 or 2
    const double *value[2];     // [count] of each column, no NaN
    const double *reference[2]; // [count]
    const int64_t *sample;      // [count] number of the sample, rises
    const int64_t *group;       // [count] of the independent unit, rises
    size_t count;
} paired_values;

typedef struct paired_statistics {
    size_t count, groups; // pairs, independent groups
    estimate difference;  // mean of value less reference, of the first column
    estimate spread;      // ratio of the standard deviations, of two columns of the areas of their
                          // ellipses, value over reference
    estimate within;      // the same of the distances from the mean of the sample's pairs
} paired_statistics;

// The mean difference: Student's t over groups. Ratios: jackknife over groups of pairs of the
// ratio's logarithm, with Student's t (R. G. Miller, Ann. Math. Stat. 39, 1968; Efron and
// Tibshirani, An introduction to the bootstrap, 1993, chapter 11), which requires neither normal
// values nor independent rockets within a group. NaN: intervals of one group, ratios of fewer than
// three groups or where one side does not scatter, `within` where samples have one pair each.
// @return LD_OK, LD_ERR_MEMORY
ld_status paired_statistics_of(const paired_values *pairs, paired_statistics *result);

#endif
