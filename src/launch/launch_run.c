#include "launch/launch_run.h"

#include <assert.h>

#include "model/parts.h"

const double *run_present_state(ld_run *run)
{
    if (!run->ahead)
        return propagator_state(run->propagator);
    propagator_interpolate(run->propagator, run->t, run->between);
    return run->between;
}

bool launch_is_finished(const ld_run *run)
{
    const launch_state *self = &run->launch;
    if (run->ahead)
        return false;
    if (self->current + 1 < model_firing_count(self->model))
        return false;
    if (model_run(self->model)->end == LD_END_TIME)
        return propagator_time(run->propagator) >= run->t_end;
    return self->phase.passed[0];
}

void launch_record_event(ld_run *run, ld_event_kind kind, double t, int part)
{
    assert(run->event_count < MOST_EVENTS);
    run->event[run->event_count++] =
        (ld_event){.kind = kind, .t = t, .rocket = run->launch.current + 1, .part = part + 1};
}
