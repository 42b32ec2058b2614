// The ways in which a propagator takes its steps: a table of functions for each.
#ifndef LD_STATE_STEPPING_STEPPER_H
#define LD_STATE_STEPPING_STEPPER_H

#include "integration/integrator.h"
#include "state/event.h"

typedef struct propagator propagator;

// As the functions of propagator.h; what is NULL a way has not.
typedef struct stepper {
    size_t size; // of its object, which begins with the propagator
    // Launch and events are there, all else is zero; `release` follows where it fails.
    ld_status (*create)(propagator *self, ld_error *error);
    void (*release)(propagator *self); // what the object holds, not itself
    ld_status (*start)(propagator *self, double t, const double *y, bool anew, ld_error *error);
    integrator_outcome (*step)(propagator *self, double t_stop, ld_error *error);
    integrator_outcome (*go_back)(propagator *self, double t, ld_error *error);
    double (*time)(const propagator *self);
    double (*previous_time)(const propagator *self);
    const double *(*state)(const propagator *self);
    void (*interpolate)(propagator *self, double t, double *y);
    int (*event)(const propagator *self, int i); // of the list
    void (*error)(propagator *self, double *error);
    int64_t (*steps)(const propagator *self);
    int64_t (*most_steps)(const propagator *self);
    int64_t (*evaluations)(const propagator *self);
    void (*archive)(propagator *self, archive *bytes);
} stepper;

struct propagator {
    const stepper *stepper; // by which it goes now
    launch_state *launch;
    event_list events;
};

#endif
