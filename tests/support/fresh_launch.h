// A launch that has not begun: a simulation of a model, and the state of one launch over it.
#ifndef LD_TESTS_SUPPORT_FRESH_LAUNCH_H
#define LD_TESTS_SUPPORT_FRESH_LAUNCH_H

#include "state/launch_state.h"
#include "support/check.h"

typedef struct fresh_launch {
    ld_simulation *simulation;
    launch_state state;
} fresh_launch;

static inline void fresh_launch_make(fresh_launch *self, const ld_model *model)
{
    ld_error error;
    if (ld_simulation_create(model, &self->simulation, &error) ||
        launch_state_begin(&self->state, self->simulation, &error))
        fail_msg("%s", error.text);
}

static inline void fresh_launch_free(fresh_launch *self)
{
    launch_state_end(&self->state);
    ld_simulation_free(self->simulation);
}

#endif
