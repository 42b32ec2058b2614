// Takes a launcher forward in time, step by step: all subsystems by one integrator, or each by its
// own with exchanges at fixed instants (run.coupling; coupling.md), or all by one outside,
// of which only the points are reported (importer_steps.h).
#ifndef LD_STATE_STEPPING_PROPAGATOR_H
#define LD_STATE_STEPPING_PROPAGATOR_H

#include "integration/integrator.h"
#include "state/event.h"

typedef struct propagator propagator;

// `outside`: whoever calls takes the steps. *out stays as it is where it fails.
ld_status propagator_create(launch_state *launch, bool outside, propagator **out, ld_error *error);
void propagator_free(propagator *self);

// As those of integrator.h, for the whole state; an event is asked for by its name. `anew`: the
// state is another one, nothing of before continues.
ld_status propagator_start(propagator *self, double t, const double *y, bool anew, ld_error *error);
integrator_outcome propagator_step(propagator *self, double t_stop, ld_error *error);
integrator_outcome propagator_return(propagator *self, double t, ld_error *error);
double propagator_time(const propagator *self);
double propagator_previous_time(const propagator *self);
const double *propagator_state(const propagator *self);
void propagator_interpolate(propagator *self, double t, double *y);
int propagator_event(const propagator *self, event_kind kind, int index);
// Estimated error of the last step, of tube and rocket alone [base_at]; 0 of a long one.
void propagator_error(propagator *self, double *error);
int64_t propagator_steps(const propagator *self);
// Of the integrator that took most: apart from the tube's, the base's have theirs.
int64_t propagator_most_steps(const propagator *self);
int64_t propagator_evaluations(const propagator *self);
// As integrator_archive, into one of an equal launch in the same state.
void propagator_archive(propagator *self, archive *bytes);

// The events, and what an absolute tolerance of each state is for a tolerance of 1; 0: it
// steers no step.
const event_list *propagator_events(const propagator *self);
void propagator_sizes(const propagator *self, double *size);

#endif
