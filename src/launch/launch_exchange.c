#include "launch/launch_exchange.h"

#include <math.h>
#include <string.h>

#include "launch/launch.h"
#include "launch/launch_base.h"
#include "launch/launch_events.h"
#include "launch/launch_limits.h"
#include "launch/launch_run.h"
#include "model/parts.h"
#include "state/evaluation.h"
#include "state/stepping/importer_steps.h"

_Static_assert((int)EVENTS_MOST <= (int)LD_MAX_STATES, "more indicators than reported");

ld_status launch_exchange_check(const ld_simulation *simulation, ld_error *error)
{
    const launcher_system *launcher = &simulation->launcher;
    if (model_run(simulation->model)->coupling_step > 0)
        return ld_fail(error, LD_ERR_MISSING,
                       "run.coupling: partitioned subsystems have their own integrators; model "
                       "exchange requires monolithic integration");
    if (launcher->base.kind->receive_frame && launcher->launching.supports.clamps)
        return ld_fail(error, LD_ERR_MISSING,
                       "tubes.supports.clamped: a clamp requires its base's acceleration, which an "
                       "externally driven base does not have in model exchange");
    return LD_OK;
}

// ---- states ----

// Of an externally driven base, which are not the integrator's; they stand at base_at.
static int driven_states(const ld_run *run)
{
    const base_system *base = &run->launch.launcher.base;
    return base->kind->receive_frame ? base->state_count : 0;
}

int launch_exchange_states(const ld_run *run)
{
    return run->launch.launcher.state_count - driven_states(run);
}

// From all states those of the integrator.
static void gather_states(const ld_run *run, const double *y, double *x)
{
    size_t before = (size_t)run->launch.launcher.base_at, driven = (size_t)driven_states(run);
    size_t all = (size_t)run->launch.launcher.state_count;
    memcpy(x, y, before * sizeof *x);
    memcpy(x + before, y + before + driven, (all - before - driven) * sizeof *x);
}

static void scatter_states(const ld_run *run, const double *x, double *y)
{
    size_t before = (size_t)run->launch.launcher.base_at, driven = (size_t)driven_states(run);
    size_t all = (size_t)run->launch.launcher.state_count;
    memcpy(y, x, before * sizeof *x);
    memcpy(y + before + driven, x + before, (all - before - driven) * sizeof *x);
}

void launch_exchange_nominals(const ld_run *run, double *nominal)
{
    const double work = 1e9; // [J] what steers no step
    double size[LD_MAX_STATES];
    propagator_sizes(run->propagator, size);
    gather_states(run, size, nominal);
    for (int i = 0; i < launch_exchange_states(run); i++)
        nominal[i] = nominal[i] > 0 ? nominal[i] : work;
}

// ---- where it is ----

ld_status launch_exchange_place(ld_run *run, double t, const double *x, const ld_base_frame *given,
                                ld_error *error)
{
    const launcher_system *launcher = &run->launch.launcher;
    double y[LD_MAX_STATES];
    base_frame frame;
    memcpy(y, propagator_state(run->propagator), (size_t)launcher->state_count * sizeof *y);
    scatter_states(run, x, y);
    if (launcher->base.kind->receive_frame) {
        ld_status status = launch_read_frame(given, &frame, error);
        if (status)
            return status;
        launcher->base.kind->receive_frame(&launcher->base, t, true, &frame, y + launcher->base_at);
    }
    propagator_place(run->propagator, t, y);
    run->t = t;
    // what was found at a point that is left is found again, since steps continue from the last one
    run->ahead &= propagator_has_accepted(run->propagator);
    return LD_OK;
}

void launch_exchange_get(ld_run *run, double *x)
{
    gather_states(run, run_present_state(run), x);
}

static ld_status no_solution(const ld_run *run, ld_error *error)
{
    return ld_fail(error, LD_ERR_NUMERIC,
                   "the equations of motion gave no finite result at t = %.9g s", run->t);
}

ld_status launch_exchange_rates(ld_run *run, double *rate, ld_error *error)
{
    launch_state *launch = &run->launch;
    const double *y = run_present_state(run);
    const launcher_output *out = simulation_output(launch, run->t, y);
    double y_dot[LD_MAX_STATES], sum = 0;
    if (!out)
        return no_solution(run, error);
    launcher_rates(&launch->launcher, y, out, launch->phase.rocket, y_dot);
    gather_states(run, y_dot, rate);
    for (int i = 0; i < launch_exchange_states(run); i++)
        sum += 0 * rate[i];
    return sum == 0 ? LD_OK : no_solution(run, error);
}

int launch_exchange_indicators(const ld_run *run)
{
    return propagator_events(run->propagator)->count;
}

ld_status launch_exchange_values(ld_run *run, double *indicator, ld_error *error)
{
    const launcher_output *out = simulation_output(&run->launch, run->t, run_present_state(run));
    if (!out)
        return no_solution(run, error);
    events_evaluate(propagator_events(run->propagator), &run->launch, out, indicator);
    return LD_OK;
}

// ---- steps ----

double launch_exchange_next(const ld_run *run)
{
    return launch_next_instant(run, propagator_previous_time(run->propagator));
}

// Puts an end of a step that misses an instant by rounding on it: times are sums of others on an
// importer's clock.
static ld_status meet_instant(ld_run *run, double next, ld_error *error)
{
    const double rounding = 1e-12, late = 1e-9;
    double t = run->t, last = propagator_previous_time(run->propagator), size = fmax(1, fabs(t));
    if (t < last - late * size || t > next + late * size)
        return ld_fail(error, LD_ERR_INPUT,
                       "found a step that ends at %.17g s after one that ended at %.17g s; "
                       "expected at most the next event, at %.17g s",
                       t, last, next);
    t = fmax(t, last);
    if (t >= next - rounding * size)
        t = next;
    if (t != run->t)
        propagator_place(run->propagator, t, propagator_state(run->propagator));
    run->t = t;
    return LD_OK;
}

// What happens at the end of a step happens, and the next one can begin.
static ld_status pass_instant(ld_run *run)
{
    ld_status status = launch_arrive(run);
    return status ? status : propagator_continue(run->propagator, &run->error);
}

static ld_status end_step(ld_run *run, bool stops)
{
    double unused[LD_MAX_STATES];
    bool happens;
    ld_status status = launch_check_base(run, propagator_previous_time(run->propagator));
    if (status)
        return status;
    if (propagator_accept(run->propagator, &happens, &run->error))
        return launch_step_failed(run);
    run->outcome = happens ? INTEGRATOR_EVENT : stops ? INTEGRATOR_STOPPED : INTEGRATOR_STEPPED;
    run->event_count = run->event_reported = 0;
    run->ahead = true;
    bool waits = run->outcome != INTEGRATOR_STEPPED || propagator_project(run->propagator, unused);
    return waits ? LD_OK : pass_instant(run);
}

static ld_status copy_error(const ld_run *run, ld_error *error)
{
    if (run->status)
        *error = run->error;
    return run->status;
}

ld_status launch_exchange_accept(ld_run *run, bool *happens, ld_error *error)
{
    *happens = false;
    if (run->status)
        return copy_error(run, error);
    if (!propagator_has_accepted(run->propagator)) {
        double next = launch_exchange_next(run);
        ld_status status = meet_instant(run, next, error);
        if (status)
            return status;
        run->status = end_step(run, run->t >= next);
    }
    *happens = run->ahead;
    return copy_error(run, error);
}

ld_status launch_exchange_pass_events(ld_run *run, bool *happened, ld_error *error)
{
    double y[LD_MAX_STATES];
    ld_status status = launch_exchange_accept(run, happened, error);
    if (status || !*happened)
        return status;
    bool stops = run->outcome == INTEGRATOR_EVENT && run->t >= launch_exchange_next(run);
    run->status = pass_instant(run);
    if (!run->status && stops && !launch_is_finished(run)) { // both at one instant
        run->outcome = INTEGRATOR_STOPPED;
        run->status = pass_instant(run);
    }
    if (!run->status && propagator_project(run->propagator, y))
        run->status = propagator_start(run->propagator, run->t, y, false, &run->error);
    return copy_error(run, error);
}
