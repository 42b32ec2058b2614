// How far two runs are apart where the first rocket leaves.
#ifndef LD_TESTS_SUPPORT_EXIT_DISTANCE_H
#define LD_TESTS_SUPPORT_EXIT_DISTANCE_H

#include <math.h>

#include "quantities/summary.h"

// [rad/s] in its rates, and in its attitude at 50/s.
static inline double exit_distance(const ld_summary *a, const ld_summary *b)
{
    const ld_rocket_summary *p = &a->rocket[0], *q = &b->rocket[0];
    double rates = hypot(p->pitch_rate - q->pitch_rate, p->yaw_rate - q->yaw_rate);
    return hypot(rates, 50 * hypot(p->pitch - q->pitch, p->yaw - q->yaw));
}

#endif
