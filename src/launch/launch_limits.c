// What ends a launch early, and who hears how far it is.
#include "launch/launch_limits.h"

#include "integration/step_limit.h"
#include "math/functions.h"
#include "model/blocks/firing.h"
#include "model/parts.h"
#include "state/evaluation.h"
#include "systems/launching/launching_kinematics.h"

ld_status launch_check_tube(ld_run *run, double t, const double *y)
{
    const int parts = 4;
    double length = run->launch.launcher.launching.tube.flexible.length;
    for (int k = parts; k > 0; k--) {
        launching_section at;
        double x = length * k / parts;
        launching_section_at(&run->launch.launcher.launching, y, x, &at);
        double sag = hypot(at.P.y, at.P.z);
        if (sag > 0.2 * length || at.A.a[0][0] < 0.8)
            return ld_fail(&run->error, LD_ERR_NUMERIC,
                           "the tube bends beyond small deflections at t = %.6g s: %.3g m from its "
                           "rear end it is %.3g m off its axis",
                           t, x, sag);
    }
    return LD_OK;
}

// Beyond the breech, which is a contact's spring; without a law that has one it holds nothing.
static ld_status report_breech(ld_run *run, double t, double depth)
{
    double stiffness = run->launch.rocket->contact.stiffness;
    char why[64];
    if (isnan(stiffness))
        snprintf(why, sizeof why, "rocket.contact has no stiffness that holds it");
    else
        snprintf(why, sizeof why, "a contact of %.6g N/m does not hold it", stiffness);
    return ld_fail(&run->error, LD_ERR_LAUNCH,
                   "the rocket is %.4g m behind the breech at t = %.6g s: %s", depth, t, why);
}

static ld_status check_progress(ld_run *run, double t, const double *y)
{
    launch_state *self = &run->launch;
    const ld_rocket *rocket = self->rocket;
    double since = t - self->t_ignition, s = y[self->launcher.launching.layout.x + X_S];
    if (self->phase.passed[0] && since < 0)
        return ld_fail(&run->error, LD_ERR_LAUNCH,
                       "the rocket slid out of the tube's tip at t = %.6g s, %.3g s before its "
                       "ignition",
                       t, -since);
    if (!self->phase.rocket)
        return LD_OK;
    if (self->phase.breech - s > 0.1 * self->launcher.launching.tube.flexible.length)
        return report_breech(run, t, self->phase.breech - s);
    if (since < model_run(self->model)->stuck_time)
        return LD_OK;
    if (self->phase.locked)
        return ld_fail(&run->error, LD_ERR_LAUNCH,
                       "the lock never released: it carried at most %.6g N of the release force "
                       "%.6g N by %.4g s after ignition",
                       run->greatest_lock_force, rocket->lock.release_force, since);
    return ld_fail(
        &run->error, LD_ERR_LAUNCH,
        "the rocket is stuck in the tube: its rear adaptor is at %.4g m of %.4g m, %.4g s "
        "after ignition",
        s, self->launcher.launching.adaptors.end[0], since);
}

// Launches must not overlap.
static ld_status check_next(ld_run *run, double t)
{
    const launch_state *self = &run->launch;
    int next = self->current + 1;
    if (next == model_firing_count(self->model) || !self->phase.rocket ||
        t < model_firing(self->model, next)->at)
        return LD_OK;
    return ld_fail(&run->error, LD_ERR_LAUNCH,
                   "firing %d: at its ignition, t = %.6g s, the previous rocket is still in its "
                   "tube; overlapping launches are not simulated",
                   next + 1, t);
}

// A table of the base's motion must continue beyond t.
ld_status launch_check_base(ld_run *run, double t)
{
    double first, last;
    base_span(&run->launch.launcher.base, &first, &last);
    if (t >= first && t < last)
        return LD_OK;
    return ld_fail(&run->error, LD_ERR_LAUNCH,
                   "base.motion.table: goes from %.6g s to %.6g s, which does not cover the launch "
                   "(now at t = %.6g s)",
                   first, last, t);
}

// Steps of less than 50 ns on the average over a millisecond, or shorter on the average than that
// over the whole run: it would hardly continue.
static ld_status check_steps(ld_run *run, double t)
{
    const int64_t most = 20000;
    if (++run->steps_since_progress > most)
        return ld_fail(&run->error, LD_ERR_NUMERIC,
                       "the steps became too short to continue: more than %lld steps within a "
                       "millisecond, up to t = %.9g s",
                       (long long)most, t);
    int64_t steps = propagator_most_steps(run->propagator);
    double spent = t - run->t_start;
    const ld_run_settings *settings = model_run(run->launch.model);
    double least = least_step(settings->tolerance, 1e-5, settings->max_step / 2, steps);
    if (spent < 1e-3 || spent >= least * (double)steps)
        return LD_OK;
    return ld_fail(&run->error, LD_ERR_NUMERIC,
                   "the steps are too short to continue: %lld steps for %.6g s, up to t = %.9g s; "
                   "check for a contact, damper or friction that is far too stiff",
                   (long long)steps, spent, t);
}

// On an open guide the table must continue as in free flight.
static ld_status check_air(ld_run *run, double t, const double *y)
{
    launch_state *self = &run->launch;
    const ld_aerodynamics *given = &self->rocket->aerodynamics;
    if (!model_has_open_air(self->model) || !self->phase.rocket ||
        given->beyond_table == LD_BEYOND_HOLD)
        return LD_OK;
    double last = self->air->aerodynamics.last_mach;
    const launcher_output *out = simulation_output(self, t, y);
    if (!out || out->launching.air_mach <= last)
        return LD_OK;
    return ld_fail(&run->error, LD_ERR_LAUNCH,
                   "%s: ends at Mach %.4g; the rocket exceeds it at t = %.4f s, still on its guide "
                   "(`beyond_table: hold` keeps the last values)",
                   self->air->aerodynamics.last_of, last, t);
}

// Every millisecond of physics: the caller hears of it, tube and air are checked.
static ld_status report_progress(ld_run *run, double t)
{
    if (t < run->next_progress)
        return LD_OK;
    run->next_progress = t + 1e-3;
    run->steps_since_progress = 0;
    const double *y = propagator_state(run->propagator);
    ld_status status = launch_check_tube(run, t, y);
    if (!status)
        status = check_air(run, t, y);
    if (status || !run->options.progress)
        return status;
    // a launch's end is not known: the travel's share is the estimate
    const launch_state *self = &run->launch;
    double length = self->launcher.launching.tube.flexible.length, s0 = self->rocket->start_at;
    double s = y[self->launcher.launching.layout.x + X_S];
    double in_tube = fmin(1, sqrt(fmax(0, (s - s0) / (length - s0))));
    double lead_in = self->t_ignition - run->t_start;
    double expected = lead_in + 0.2;
    double share =
        t < self->t_ignition ? (t - run->t_start) / expected : (lead_in + 0.2 * in_tube) / expected;
    if (!run->options.progress(run->options.self, share))
        return ld_fail(&run->error, LD_ERR_INTERRUPTED, "interrupted at t = %.6g s", t);
    return LD_OK;
}

ld_status launch_check_step(ld_run *run, double t, const double *y)
{
    ld_status status = check_progress(run, t, y);
    if (!status)
        status = check_next(run, t);
    if (!status && !run->outside) // whose steps are another one's business
        status = check_steps(run, t);
    return status ? status : report_progress(run, t);
}
