// How short steps may become before an integration hardly continues.
#ifndef LD_INTEGRATION_STEP_LIMIT_H
#define LD_INTEGRATION_STEP_LIMIT_H

#include <stdint.h>

#include "math/functions.h"

// Average length [s] of `steps` steps below which it hardly continues: 10 ps for each of them (a
// microsecond of 100 000), of a tolerance finer than the usual one less by as much as steps are
// shorter and more; never more than `most`.
static inline double least_step(double tolerance, double usual, double most, int64_t steps)
{
    double finer = fmin(1, pow(tolerance / usual, 0.4));
    return fmin(1e-11 * finer * (double)steps, most);
}

#endif
