// Whether two sets of values in groups agree: how far their means and deviations are apart, and
// how often chance alone takes them so far.
#ifndef LD_STUDIES_AGREEMENT_H
#define LD_STUDIES_AGREEMENT_H

#include "studies/statistics/statistics.h"

// Values in the order of their groups, as those of statistics_of().
typedef struct grouped_values {
    const double *value;  // [count] no NaN
    const int64_t *group; // [count] rises
    size_t count;
} grouped_values;

typedef struct agreement {
    estimate mean;           // difference of the means, first less second
    estimate deviation;      // ratio of the mean distances from the median, first over second
    double mean_chance;      // p of a difference of the means, from 0 to 1
    double deviation_chance; // p of a ratio other than 1
} agreement;

// Welch's t over groups (B. L. Welch, Biometrika 34, 1947, with Satterthwaite's degrees of
// freedom), of independent values his very test: of the means; of the deviations, of the logarithms
// of the mean distances from the median, after Levene's test in the form of M. B. Brown and A. B.
// Forsythe (J. Am. Stat. Assoc. 69, 1974), which requires no normal values. A number lies outside
// its interval of 95 % where p < 0.05. NaN where one side has too few groups (two, three for the
// deviation) or does not scatter.
// @return LD_OK, LD_ERR_MEMORY
ld_status agreement_of(grouped_values first, grouped_values second, agreement *result);

#endif
