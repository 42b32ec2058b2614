// How much of a result's variance comes from one factor alone, from the values of a study as it is.
#ifndef LD_STUDIES_SENSITIVITY_H
#define LD_STUDIES_SENSITIVITY_H

#include "studies/statistics/statistics.h"

// Estimates the first-order sensitivity S = Var(E[y | x])/Var(y) of `count` values of a result y to
// a factor x: adjusted R^2 of a regression on polynomials of x, of degree 6 at most and of one a
// score of independent draws, so that it is too small where E[y | x] is wilder than such a
// polynomial, and may be below zero where S is small. Of correlated factors each has in its S what
// comes with the others.
// The interval: jackknife over groups of log(1 - S).
// @param sample, group  of each value, in order of both; where `per_rocket`, each value has a draw
//                       of x of its own, else those of one sample have the same
// @return NaN where y does not scatter, or with fewer than 5 draws or 3 groups
estimate sensitivity_of(const double *x, const double *y, const int64_t *sample,
                        const int64_t *group, size_t count, bool per_rocket);

#endif
