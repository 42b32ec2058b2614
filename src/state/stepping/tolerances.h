// The tolerances of a launch's states.
#ifndef LD_STATE_STEPPING_TOLERANCES_H
#define LD_STATE_STEPPING_TOLERANCES_H

#include "state/launch_state.h"

// Absolute tolerance per kind of state; positions in I have no relative one: a vehicle may be far
// from the origin. Works are quadratures: they do not steer the step, with infinity for a
// tolerance, whose shares of the error are zero and not denormal numbers.
typedef struct tolerances {
    double atol[LD_MAX_STATES];
    bool absolute[LD_MAX_STATES]; // those that are places in I, x, y and z after each other
} tolerances;

void tolerances_find(const launch_state *self, tolerances *all);

#endif
