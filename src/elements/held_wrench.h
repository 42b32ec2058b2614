// A wrench that is known at instants alone: how it continues until the next one.
#ifndef LD_ELEMENTS_HELD_WRENCH_H
#define LD_ELEMENTS_HELD_WRENCH_H

#include "math/vec3.h"

// A force [N] and a moment [N m] as they were reported, continuing as the last two report.
typedef struct held_wrench {
    v3 force, moment, force_rate, moment_rate;
} held_wrench;

// Takes what is reported `since` [s] after the last; 0: nothing of before continues, or its rate
// does.
static inline void held_wrench_take(held_wrench *self, v3 force, v3 moment, double since)
{
    if (since > 0) {
        self->force_rate = v3_scale(1 / since, v3_sub(force, self->force));
        self->moment_rate = v3_scale(1 / since, v3_sub(moment, self->moment));
    }
    self->force = force;
    self->moment = moment;
}

// The wrench tau [s] after the last instant.
static inline void held_wrench_at(const held_wrench *self, double tau, v3 *force, v3 *moment)
{
    *force = v3_add(self->force, v3_scale(tau, self->force_rate));
    *moment = v3_add(self->moment, v3_scale(tau, self->moment_rate));
}

#endif
