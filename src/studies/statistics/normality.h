// Whether a cloud of points may come from a normal distribution of two numbers.
#ifndef LD_STUDIES_NORMALITY_H
#define LD_STUDIES_NORMALITY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// Fewer independent points are too few for the test.
enum { NORMALITY_LEAST = 20 };

// How often a normal cloud fails the test: 5 %, half of it by each of its two halves.
extern const double normality_level;

typedef struct normality {
    double skewness, kurtosis; // of two numbers: 0 and 8 of a normal distribution
    double effective;          // independent points that tell as much as all of them
    double chance[2];          // p of the skewness, of the kurtosis
    bool tested, normal;       // enough points for a test; it does not refuse a normal distribution
} normality;

// Mardia's test (K. V. Mardia, Biometrika 57, 1970): of the points in the axes in which their mean
// is 0 and their covariance 1, b1 = sum of the squared third moments, n b1 / 6 of chi squared with
// 4 degrees of freedom; b2 = mean of |z|^4, (b2 - 8) / sqrt(64 / n) of a normal distribution.
// Rockets of one group are not independent: n is the number of points over the design effect (J. N.
// K. Rao and A. J. Scott, J. Am. Stat. Assoc. 76, 1981), how many times as large the variance of
// such a moment is as of independent points, at least 1. Two columns [count] in the order of their
// groups, which rise; count > 0.
normality normality_of(const double *x, const double *y, const int64_t *group, size_t count);

#endif
