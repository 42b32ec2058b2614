#include "state/stepping/propagator.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "model/parts.h"
#include "state/stepping/importer_steps.h"
#include "state/stepping/integrated_steps.h"
#include "state/stepping/long_steps.h"
#include "state/stepping/partitioned_steps.h"
#include "state/stepping/stepper.h"
#include "state/stepping/tolerances.h"

static const stepper *stepper_of(const launch_state *launch, bool outside)
{
    return outside                           ? &importer_stepper
           : partitioned_steps_apply(launch) ? &partitioned_stepper
           : long_steps_apply(launch)        ? &long_stepper
                                             : &integrated_stepper;
}

ld_status propagator_create(launch_state *launch, bool outside, propagator **out, ld_error *error)
{
    const stepper *by = stepper_of(launch, outside);
    propagator *self = calloc(1, by->size);
    if (!self)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the integration");
    self->stepper = by;
    self->launch = launch;
    self->events = events_of(launch, by != &partitioned_stepper);
    ld_status status = by->create(self, error);
    if (status)
        propagator_free(self);
    else
        *out = self;
    return status;
}

void propagator_free(propagator *self)
{
    if (!self)
        return;
    self->stepper->release(self);
    free(self);
}

ld_status propagator_start(propagator *self, double t, const double *y, bool anew, ld_error *error)
{
    return self->stepper->start(self, t, y, anew, error);
}

integrator_outcome propagator_step(propagator *self, double t_stop, ld_error *error)
{
    return self->stepper->step(self, t_stop, error);
}

integrator_outcome propagator_return(propagator *self, double t, ld_error *error)
{
    return self->stepper->go_back(self, t, error);
}

double propagator_time(const propagator *self)
{
    return self->stepper->time(self);
}

double propagator_previous_time(const propagator *self)
{
    return self->stepper->previous_time(self);
}

const double *propagator_state(const propagator *self)
{
    return self->stepper->state(self);
}

void propagator_interpolate(propagator *self, double t, double *y)
{
    self->stepper->interpolate(self, t, y);
}

int propagator_event(const propagator *self, event_kind kind, int index)
{
    int i = event_find(&self->events, kind, index);
    return i < 0 || !self->stepper->event ? 0 : self->stepper->event(self, i);
}

void propagator_error(propagator *self, double *error)
{
    size_t size = (size_t)self->launch->launcher.base_at * sizeof *error;
    double all[LD_MAX_STATES] = {0};
    if (self->stepper->error)
        self->stepper->error(self, all);
    memcpy(error, all, size);
}

int64_t propagator_steps(const propagator *self)
{
    return self->stepper->steps(self);
}

int64_t propagator_most_steps(const propagator *self)
{
    return self->stepper->most_steps(self);
}

int64_t propagator_evaluations(const propagator *self)
{
    return self->stepper->evaluations(self);
}

void propagator_archive(propagator *self, archive *bytes)
{
    self->stepper->archive(self, bytes);
}

const event_list *propagator_events(const propagator *self)
{
    return &self->events;
}

void propagator_sizes(const propagator *self, double *size)
{
    tolerances all;
    tolerances_find(self->launch, &all);
    for (int i = 0; i < self->launch->launcher.state_count; i++)
        size[i] = isinf(all.atol[i]) ? 0 : all.atol[i] / model_run(self->launch->model)->tolerance;
}
