// The measures of a launch, taken as it goes: at the ends and in the middle of every step.
#include <math.h>

#include "simulation/launch_run.h"

static int measure_count(const ld_run *run)
{
    return run->launch.model->measure_count;
}

void launch_begin_measures(ld_run *run, double t)
{
    run->t_rocket = t;
    for (int i = 0; i < measure_count(run); i++)
        run->measure[i] = (measure_so_far){.value = NAN};
}

// ---- values

// Of each measure's column at t in state y.
static void find_values(const ld_run *run, double t, const double *y, double *value)
{
    double row[LD_MAX_COLUMNS];
    history_row(&run->launch, t, y, run->energy_start, row);
    for (int i = 0; i < measure_count(run); i++)
        value[i] = row[run->launch.system->measure[i].column];
}

static double integrand(ld_take take, double value)
{
    return take == LD_TAKE_RMS ? value * value : value;
}

// Simpson's rule over a step of length h, whose middle and end are given.
static void add_step(measure_so_far *self, ld_take take, double h, double middle, double end)
{
    double sides = integrand(take, self->value) + integrand(take, end);
    self->sum += h / 6 * (sides + 4 * integrand(take, middle));
    self->peak = fmax(self->peak, fmax(fabs(middle), fabs(end)));
}

static bool is_any_open(const ld_run *run)
{
    bool any = false;
    for (int i = 0; i < measure_count(run); i++)
        any |= run->measure[i].open;
    return any;
}

// The step from `from` to t, with the values at its end.
static void add_steps(ld_run *run, double from, double t, const double *end)
{
    double middle[LD_MAX_MEASURES], t_middle = from + (t - from) / 2;
    propagator_interpolate(run->propagator, t_middle, run->between);
    find_values(run, t_middle, run->between, middle);
    for (int i = 0; i < measure_count(run); i++)
        if (run->measure[i].open)
            add_step(&run->measure[i], run->launch.system->measure[i].take, t - from, middle[i],
                     end[i]);
}

void launch_measure_step(ld_run *run, bool lands)
{
    double t = propagator_time(run->propagator), from = run->t_measured, end[LD_MAX_MEASURES];
    bool open = is_any_open(run), looks = open || (lands && measure_count(run) > 0);
    run->t_measured = t;
    if (looks)
        find_values(run, t, propagator_state(run->propagator), end);
    if (open)
        add_steps(run, from, t, end);
    for (int i = 0; i < measure_count(run); i++)
        run->measure[i].value = looks ? end[i] : NAN;
}

// ---- instants

// When it was [s]; NaN: it has not come.
static double time_of(const ld_run *run, measure_instant instant)
{
    const launch_state *self = &run->launch;
    const ld_rocket_summary *rocket = &run->summary.rocket[self->current];
    switch (instant.kind) {
    case INSTANT_START:
        return run->t_rocket;
    case INSTANT_IGNITION:
        return self->piece >= 0 ? self->t_ignition : NAN;
    case INSTANT_RELEASE:
        return self->t_ignition + rocket->t_release;
    case INSTANT_EXIT:
        return self->t_ignition + rocket->t_exit[instant.adaptor];
    default:
        return NAN; // launch_end_measures
    }
}

// The window ends where the last step did, with the value before what happens there.
static void end_window(ld_run *run, int i, double t)
{
    const ld_take take = run->launch.system->measure[i].take;
    measure_so_far *self = &run->measure[i];
    bool window = take != LD_TAKE_VALUE && t > self->t_from; // else a single instant
    double mean = window ? self->sum / (t - self->t_from) : integrand(take, self->value);
    double result = take == LD_TAKE_RMS ? sqrt(mean) : mean;
    if (take == LD_TAKE_PEAK)
        result = window && !isnan(mean) ? self->peak : fabs(mean);
    run->summary.rocket[run->launch.current].measure[i] = result;
    self->open = false;
    self->done = true;
}

void launch_measure_instant(ld_run *run, double t, const double *y)
{
    const measure_plan *plan = run->launch.system->measure;
    double now[LD_MAX_MEASURES];
    if (measure_count(run) == 0)
        return;
    find_values(run, t, y, now);
    for (int i = 0; i < measure_count(run); i++) {
        measure_so_far *measure = &run->measure[i];
        if (!measure->open && !measure->done && !isnan(time_of(run, plan[i].from))) {
            if (isnan(measure->value)) // nothing was before
                measure->value = now[i];
            measure->open = true;
            measure->t_from = t;
        }
        if (measure->open && !isnan(time_of(run, plan[i].to)))
            end_window(run, i, t);
        if (measure->open) {
            measure->value = now[i];
            measure->peak = fmax(measure->peak, fabs(now[i]));
        }
    }
    run->t_measured = t;
}

void launch_end_measures(ld_run *run)
{
    for (int i = 0; i < measure_count(run); i++) {
        bool ends = run->launch.system->measure[i].to.kind == INSTANT_END;
        bool value = run->launch.system->measure[i].take == LD_TAKE_VALUE;
        if (ends && (run->measure[i].open || value))
            end_window(run, i, run->t_measured);
    }
}
