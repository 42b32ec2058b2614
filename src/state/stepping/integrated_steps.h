// Steps of all states together by one integrator. With exponential steps it takes those in between
// (long_steps.h); with subsystems apart it has the states of the launching one alone
// (partitioned_steps.h).
#ifndef LD_STATE_STEPPING_INTEGRATED_STEPS_H
#define LD_STATE_STEPPING_INTEGRATED_STEPS_H

#include "state/stepping/stepper.h"
#include "state/stepping/tolerances.h"

// The first member of the other two objects.
typedef struct integrated_steps {
    propagator propagator;
    integrator *integrator;
    bool stopped; // its last step landed on a stop
} integrated_steps;

extern const stepper integrated_stepper;

// Those of all states together; `all` outlives them.
integrator_settings integrated_settings(propagator *self, const tolerances *all);

// The functions of integrated_stepper that serve the other two.
integrator_outcome integrated_step(propagator *self, double t_stop, ld_error *error);
integrator_outcome integrated_go_back(propagator *self, double t, ld_error *error);
double integrated_time(const propagator *self);
double integrated_previous_time(const propagator *self);
const double *integrated_state(const propagator *self);
void integrated_interpolate(propagator *self, double t, double *y);
int integrated_event(const propagator *self, int i);
void integrated_error(propagator *self, double *error);
int64_t integrated_count(const propagator *self);
int64_t integrated_evaluations(const propagator *self);

#endif
