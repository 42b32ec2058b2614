// How many intervals of 95 % must hold the truth.
#ifndef LD_TESTS_SUPPORT_COVERAGE_H
#define LD_TESTS_SUPPORT_COVERAGE_H

#include <math.h>

// Of `sets` intervals of 95 % that are right this many at least hold the truth (6 of 8, 34 of 40,
// 183 of 200): fewer have a chance of 1.2 % at most.
static inline int least_of_95(int sets)
{
    return (int)(0.95 * sets - 2.27 * sqrt(0.95 * 0.05 * sets));
}

#endif
