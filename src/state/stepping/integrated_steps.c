#include "state/stepping/integrated_steps.h"

#include "model/parts.h"
#include "state/evaluation.h"

static integrator *integrator_of(const propagator *self)
{
    return ((const integrated_steps *)self)->integrator;
}

static int rhs(double t, const double *y, double *y_dot, void *user)
{
    const propagator *self = user;
    return simulation_rates(self->launch, t, y, y_dot);
}

static int project(double t, double *y, void *user)
{
    const propagator *self = user;
    simulation_project(self->launch, t, y);
    return 0;
}

static int events(double t, const double *y, double *g, void *user)
{
    const propagator *self = user;
    const launcher_output *out = simulation_output(self->launch, t, y);
    if (!out)
        return -1;
    events_evaluate(&self->events, self->launch, out, g);
    return 0;
}

// Where nothing comes and goes, adaptors being held on both sides, accuracy leaves steps as long as
// stability does, unless much of it is asked for: then the method that is stable for the longest.
static integrator_method choose_method(const launch_state *launch)
{
    bool held = launch->launcher.launching.adaptors.law.held;
    return held && model_run(launch->model)->tolerance >= 1e-6 ? INTEGRATOR_OSCILLATING
                                                               : INTEGRATOR_CASH_KARP;
}

// Whether the end of each step is put back onto the constraints: with loops, what they hold in
// places, where a lock holds for long on a base that is moved. Its speed, that of a ship, has the
// error of the steps, by which the rocket would drift along the tube: 2 mm in 100 s at 6 m/s.
static bool puts_back(const launch_state *launch)
{
    const double long_lead_in = 10; // [s]
    const base_system *base = &launch->launcher.base;
    bool moved = !base->kind->dynamics && !base->kind->stepping && !base->kind->receive_frame;
    return base->drifts || launching_holds_places(&launch->launcher.launching) ||
           (moved && model_run(launch->model)->lead_in > long_lead_in);
}

integrator_settings integrated_settings(propagator *self, const tolerances *all)
{
    const launch_state *launch = self->launch;
    integrator_settings settings = {
        .n = (size_t)launch->launcher.state_count,
        .method = choose_method(launch),
        .rtol = model_run(launch->model)->tolerance,
        .atol = all->atol,
        .absolute = all->absolute,
        .max_step = model_run(launch->model)->max_step,
        .rhs = rhs,
        .project = puts_back(launch) ? project : NULL,
        .events = events,
        .event_count = self->events.count,
        .self = self,
        .course = launch->course,
    };
    return settings;
}

static ld_status create(propagator *self, ld_error *error)
{
    tolerances all;
    tolerances_find(self->launch, &all);
    integrator_settings settings = integrated_settings(self, &all);
    return integrator_create(&settings, &((integrated_steps *)self)->integrator, error);
}

static void release(propagator *self)
{
    integrator_free(integrator_of(self));
}

static ld_status start(propagator *self, double t, const double *y, bool anew, ld_error *error)
{
    (void)anew;
    return integrator_start(integrator_of(self), t, y, error);
}

// After a stop the integrator starts again, as one does that was saved there.
integrator_outcome integrated_step(propagator *self, double t_stop, ld_error *error)
{
    integrated_steps *steps = (integrated_steps *)self;
    integrator *by = steps->integrator;
    if (steps->stopped && integrator_start(by, integrator_time(by), integrator_state(by), error))
        return INTEGRATOR_FAILED;
    integrator_outcome outcome = integrator_step(by, t_stop, error);
    steps->stopped = outcome == INTEGRATOR_STOPPED;
    return outcome;
}

integrator_outcome integrated_go_back(propagator *self, double t, ld_error *error)
{
    return integrator_return(integrator_of(self), t, error);
}

double integrated_time(const propagator *self)
{
    return integrator_time(integrator_of(self));
}

double integrated_previous_time(const propagator *self)
{
    return integrator_previous_time(integrator_of(self));
}

const double *integrated_state(const propagator *self)
{
    return integrator_state(integrator_of(self));
}

void integrated_interpolate(propagator *self, double t, double *y)
{
    integrator_interpolate(integrator_of(self), t, y);
}

int integrated_event(const propagator *self, int i)
{
    return integrator_event(integrator_of(self), i);
}

void integrated_error(propagator *self, double *error)
{
    integrator_error(integrator_of(self), error);
}

int64_t integrated_count(const propagator *self)
{
    return integrator_steps(integrator_of(self));
}

int64_t integrated_evaluations(const propagator *self)
{
    return integrator_evaluations(integrator_of(self));
}

static void archive_all(propagator *self, archive *bytes)
{
    integrator_archive(integrator_of(self), bytes);
    archive_expect(bytes, false); // no long steps
    archive_expect(bytes, false); // nothing apart
}

const stepper integrated_stepper = {
    .size = sizeof(integrated_steps),
    .create = create,
    .release = release,
    .start = start,
    .step = integrated_step,
    .go_back = integrated_go_back,
    .time = integrated_time,
    .previous_time = integrated_previous_time,
    .state = integrated_state,
    .interpolate = integrated_interpolate,
    .event = integrated_event,
    .error = integrated_error,
    .steps = integrated_count,
    .most_steps = integrated_count,
    .evaluations = integrated_evaluations,
    .archive = archive_all,
};
