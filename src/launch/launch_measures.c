// The measures of a launch, taken as it goes.
#include "launch/launch_measures.h"

#include <math.h>

#include "model/parts.h"
#include "state/history.h"

_Static_assert((int)LD_MAX_COLUMNS <= (int)MEASURING_MOST_COLUMNS,
               "the rows of a launch exceed their buffer");

void launch_begin_measures(ld_run *run, double t)
{
    run->t_rocket = t;
    measuring_begin(run->measure, run->launch.system->measure.count);
}

static void find_row(void *self, double t, double *row)
{
    ld_run *run = self;
    propagator_interpolate(run->propagator, t, run->between);
    history_row(&run->launch, t, run->between, run->energy_start, row);
}

// When it was [s]; NaN: it has not come.
static double time_of(const ld_run *run, measure_instant instant)
{
    const launch_state *self = &run->launch;
    const ld_rocket_summary *rocket = &run->summary.rocket[self->current];
    switch (instant.kind) {
    case INSTANT_START:
        return run->t_rocket;
    case INSTANT_IGNITION:
        return launch_is_ignited(self) ? self->t_ignition : NAN;
    case INSTANT_RELEASE:
        return self->t_ignition + rocket->t_release;
    case INSTANT_EXIT:
        return self->t_ignition + rocket->t_exit[instant.adaptor];
    default:
        return NAN; // launch_end_measures
    }
}

static bool has_come(void *self, measure_instant instant)
{
    return !isnan(time_of(self, instant));
}

static measuring measuring_of(ld_run *run)
{
    const launch_state *self = &run->launch;
    return (measuring){
        .plans = &self->system->measure,
        .window = run->measure,
        .result = run->summary.rocket[self->current].measure,
        .row = find_row,
        .has_come = has_come,
        .self = run,
    };
}

// In how many pieces a step is taken: a long one of the lead-in in shorter ones.
static int pieces_of(const ld_run *run, double step)
{
    const double longest = fmax(model_run(run->launch.model)->max_step, 0.5e-3);
    return (int)fmax(1, ceil(step / longest - 1e-6));
}

void launch_measure_step(ld_run *run, bool lands)
{
    const measuring self = measuring_of(run);
    double t = propagator_time(run->propagator), from = run->t_measured, end[LD_MAX_COLUMNS];
    bool looks = measuring_is_open(&self) || (lands && measuring_is_there(&self));
    run->t_measured = t;
    // a long step in pieces
    for (int left = looks ? pieces_of(run, t - from) : 1; left > 1; left--) {
        double to = from + (t - from) / left;
        find_row(run, to, end);
        measuring_step(&self, from, to, end);
        from = to;
    }
    if (looks)
        history_row(&run->launch, t, propagator_state(run->propagator), run->energy_start, end);
    measuring_step(&self, from, t, looks ? end : NULL);
}

void launch_measure_instant(ld_run *run, double t, const double *y)
{
    const measuring self = measuring_of(run);
    double now[LD_MAX_COLUMNS];
    if (!measuring_is_there(&self))
        return;
    history_row(&run->launch, t, y, run->energy_start, now);
    measuring_instant(&self, t, now);
    run->t_measured = t;
}

void launch_end_measures(ld_run *run)
{
    const measuring self = measuring_of(run);
    measuring_end(&self, run->t_measured);
}
