// Statistics of values that come in groups: the rockets of one sample are not independent, so that
// intervals count groups, not values.
#ifndef LD_STUDIES_STATISTICS_H
#define LD_STUDIES_STATISTICS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "launchdyn/status.h"
#include "launchdyn/study_data.h"

typedef ld_estimate estimate;

enum { STATISTICS_QUANTILES = 3 };
extern const double statistics_level[STATISTICS_QUANTILES]; // 5 %, 50 %, 95 %

typedef ld_study_statistics group_statistics;

// Of `count` values (no NaN) in the order of their groups, where `group` rises: the result does not
// depend on how they came about, to the bit.
// @return LD_OK, LD_ERR_MEMORY
ld_status statistics_of(const double *value, const int64_t *group, size_t count,
                        group_statistics *result);

// The same but for the order of the values: without least, greatest and quantiles, which stay NaN.
ld_status moments_of(const double *value, const int64_t *group, size_t count,
                     group_statistics *result);

// An estimate with its variance, which is known with so many degrees of freedom; the variance is
// NaN where there are less than two groups.
typedef struct uncertain {
    double value, variance, freedom;
} uncertain;

// The mean of values as in statistics_of(), with the variance of its interval.
// @return LD_OK, LD_ERR_MEMORY
ld_status uncertain_mean_of(const double *value, const int64_t *group, size_t count,
                            uncertain *mean);

// The quantile q of values as in statistics_of(), with its interval.
// @return LD_OK, LD_ERR_MEMORY
ld_status quantile_of_values(const double *value, const int64_t *group, size_t count, double q,
                             estimate *quantile);

// A share, the mean of so many values that are 0 or 1, with the interval of as many independent
// ones as tell it as well: of C. J. Clopper and E. S. Pearson (Biometrika 26, 1934) for the
// effective number of E. L. Korn and B. I. Graubard (Survey Methodology 24, 1998), at most `count`.
// Where all values are alike that is the number of groups.
estimate share_interval(const uncertain *mean, size_t count);

// Sorts values, the least first.
void sort_values(double *value, size_t count);
// Quantile of sorted values, linear between them.
double sorted_quantile(const double *sorted, size_t count, double level);

// The quantile q of values in the order of their groups, two or more, with its interval: order
// statistics as real numbers of `independent` values, which tell the share of those up to the
// quantile as well as these groups do, at most the number given. No interval where its ends lie
// beyond the least and the greatest value.
// @return LD_OK, LD_ERR_MEMORY
ld_status tail_quantile_of(const double *value, const int64_t *group, size_t count, double q,
                           estimate *quantile, double *independent);

// The share of further values below that quantile, as these many independent ones tell it, with its
// interval: a beta distribution with the mean q.
estimate share_below_quantile(double independent, double q);

// Ellipse of two columns of values: semi-axes of one standard deviation along the main axes, and
// the angle [rad] of the long one from the first towards the second.
typedef struct covariance_ellipse {
    double mean[2];
    double semi_axis[2];
    double angle;
} covariance_ellipse;

void covariance_ellipse_of(const double *x, const double *y, size_t count,
                           covariance_ellipse *result);

// A normal distribution has 95 % within so many deviations: sqrt(-2 ln 0.05).
extern const double ellipse_radius;

// The semi-axes with the intervals of standard deviations along them, as if their directions were
// known.
// @return LD_OK, LD_ERR_MEMORY
ld_status covariance_ellipse_intervals(const double *x, const double *y, const int64_t *group,
                                       size_t count, const covariance_ellipse *ellipse,
                                       estimate semi_axis[2]);

#endif
