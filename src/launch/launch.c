// A launch from its start to its end: begin, then step by step what comes next.
#include "launch/launch.h"

#include <math.h>
#include <string.h>

#include "launch/launch_base.h"
#include "launch/launch_events.h"
#include "launch/launch_exit_error.h"
#include "launch/launch_flights.h"
#include "launch/launch_limits.h"
#include "launch/launch_measures.h"
#include "launch/launch_parts.h"
#include "launch/launch_rows.h"
#include "launch/launch_summary.h"
#include "model/blocks/firing.h"
#include "model/parts.h"
#include "quantities/summary_quantities.h"
#include "state/equilibrium.h"

// Rocket i of the firing comes next: its lock closed, its motor not yet lit.
static void set_up_rocket(ld_run *run, int i, double t)
{
    const ld_firing *firing = model_firing(run->launch.model, i);
    launch_state_select(&run->launch, i);
    run->greatest_lock_force = 0;
    for (int k = 0; k < HINGES; k++)
        run->watch[k] = (hinge_watch){.since = NAN};
    for (int k = 0; k < LD_MAX_DRIVES; k++)
        run->drive_watch[k] = (hinge_watch){.since = NAN};
    ld_rocket_summary *rocket = &run->summary.rocket[i];
    run->summary.rocket_count = i + 1;
    rocket_clear(rocket, true);
    rocket->t_ignition = firing->at;
    rocket->tube = firing->tube;
    launch_begin_measures(run, t);
}

static void take_start(launch_state *self, const launch_start *start, double *y)
{
    memcpy(y, start->y, (size_t)self->launcher.state_count * sizeof(double));
    self->rest = start->rest;
    self->on_breech = start->on_breech;
    base_set_road(&self->launcher.base, start->road);
}

static ld_status find_start(ld_run *run, double *y)
{
    launch_state *self = &run->launch;
    if (run->start) {
        take_start(self, run->start, y);
        return LD_OK;
    }
    return simulation_start(self, run->t_start, y, &run->summary.equilibrium, &run->error);
}

static void no_numbers(double *to, size_t count)
{
    for (size_t i = 0; i < count; i++)
        to[i] = NAN;
}

// No equilibrium: that of a start which has none, or not yet.
static void forget_equilibrium(ld_equilibrium_summary *rest)
{
    *rest = (ld_equilibrium_summary){
        .lock_force = NAN, .breech_force = NAN, .slot_force = NAN, .residual = NAN};
    no_numbers(rest->contact_force, LD_MAX_ADAPTORS);
    no_numbers(rest->tip_sag, 2);
    for (int j = 0; j < LD_MAX_WHEELS; j++) {
        rest->wheel[j].tyre_force = rest->wheel[j].tyre_deflection = NAN;
        no_numbers(rest->wheel[j].suspension, 3);
    }
    rest->chassis.y = rest->chassis.pitch = rest->chassis.roll = NAN;
    for (int i = 0; i < HINGES; i++)
        rest->hinge[i].angle = rest->hinge[i].torque = NAN;
}

// A run that finds no start leaves no number as if computed.
static void forget_start(ld_summary *summary)
{
    ld_energy *energy = &summary->energy;
    energy->kinetic = energy->potential = energy->elastic = NAN;
    energy->residual = energy->residual_relative = NAN;
    no_numbers(energy->work, LD_MAX_WORKS);
    ld_rocket_summary *rocket = &summary->rocket[0];
    no_numbers(rocket->max_contact_force, LD_MAX_ADAPTORS);
    rocket->max_slot_force = rocket->energy_dropped = NAN;
}

// Once a rocket is out, the next tube is put in its place; the balance continues without what that
// drops.
static ld_status change_tube(ld_run *run, double t)
{
    launch_state *self = &run->launch;
    int next = self->current + 1;
    if (next == model_firing_count(self->model) || self->phase.rocket ||
        t < launch_change_instant(self))
        return LD_OK;
    double y[LD_MAX_STATES];
    ld_energy before, after;
    memcpy(y, propagator_state(run->propagator),
           (size_t)self->launcher.state_count * sizeof(double));
    launch_energy_at(self, t, y, run->energy_start, &before);
    launch_end_measures(run);
    set_up_rocket(run, next, t);
    ld_status status = simulation_change_tube(self, next, t, y, &run->error);
    if (status)
        return status;
    self->phase.locked = self->rocket->lock.present;
    launch_energy_at(self, t, y, run->energy_start, &after);
    run->energy_start += after.residual - before.residual;
    run->summary.rocket[next].energy_dropped = before.kinetic - after.kinetic;
    launch_release_at_once(run, t, y);
    launch_restart_output(run, t);
    launch_record_event(run, LD_EVENT_TUBE, t, -1);
    run->last_row = NAN;
    launch_measure_instant(run, t, y);
    status = propagator_start(run->propagator, t, y, true, &run->error);
    return status ? status : launch_write_row(run, t, y);
}

ld_status launch_step_failed(ld_run *run)
{
    double t = propagator_time(run->propagator);
    if (run->error.status == LD_ERR_MEMORY)
        return LD_ERR_MEMORY;
    if (launch_check_tube(run, t, propagator_state(run->propagator)) || !run->launch.jammed)
        return LD_ERR_NUMERIC;
    return ld_fail(&run->error, LD_ERR_LAUNCH,
                   "the knob jams in the slot at t = %.6g s: with this angle and friction no slot "
                   "force fulfils the constraint",
                   propagator_time(run->propagator));
}

static ld_status after_step(ld_run *run, integrator_outcome outcome)
{
    launch_state *self = &run->launch;
    double t = propagator_time(run->propagator);
    const double *y = propagator_state(run->propagator);
    bool igniting =
        outcome == INTEGRATOR_STOPPED && t == self->t_ignition && !launch_is_ignited(self);
    if (igniting)
        launch_record_ignition(run, t, y); // the row of this instant requires it
    ld_status status = launch_write_rows(run);
    launch_watch_forces(run, t, y);
    launch_watch_recoil(run, t, y);
    launch_watch_loads(run, t, y);
    launch_watch_hinges(run, t, y);
    launch_watch_parts(run, t, y);
    launch_measure_step(run, outcome != INTEGRATOR_STEPPED);
    if (!status && outcome != INTEGRATOR_STEPPED)
        status = launch_write_row(run, t, y);
    bool inside = self->phase.rocket;
    bool changed = outcome == INTEGRATOR_EVENT && launch_switch_phase(run, t, y);
    if (!status && inside && !self->phase.rocket && model_has_jets(self->model))
        status = launch_begin_jet(run, t, y);
    if (outcome == INTEGRATOR_STOPPED) {
        changed = launch_pass_stop(run, t);
        if (igniting)
            launch_restart_output(run, t);
    }
    changed |= launch_hold_stops(run, t, y, outcome == INTEGRATOR_EVENT);
    if (outcome != INTEGRATOR_STEPPED)
        launch_pass_corners(run, t, y, outcome == INTEGRATOR_EVENT);
    if (!status)
        status = launch_check_step(run, t, y);
    if (!status && (changed || outcome == INTEGRATOR_EVENT)) {
        launch_release_at_once(run, t, y);
        status = propagator_start(run->propagator, t, y, false, &run->error);
    }
    if (outcome != INTEGRATOR_STEPPED)
        launch_measure_instant(run, t, y);
    return status;
}

// One step; what happens at its end has not happened yet.
static ld_status step(ld_run *run)
{
    double t = propagator_time(run->propagator), stop = launch_next_stop(run, t);
    double input = fmin(run->t_input, launch_next_sample(run, t));
    ld_status status = launch_check_base(run, t);
    if (status)
        return status;
    if (run->exit_error)
        exit_error_begin_step(run->exit_error, run);
    run->outcome = propagator_step(run->propagator, fmin(stop, input), &run->error);
    if (run->outcome == INTEGRATOR_FAILED)
        return launch_step_failed(run);
    if (run->outcome == INTEGRATOR_STOPPED && propagator_time(run->propagator) < stop)
        run->outcome = INTEGRATOR_STEPPED; // an input's or a sample's instant is none of the launch
    run->ahead = true;
    run->event_count = run->event_reported = 0;
    return LD_OK;
}

ld_status launch_arrive(ld_run *run)
{
    run->ahead = false;
    if (run->exit_error)
        exit_error_end_step(run->exit_error, run);
    ld_status status = after_step(run, run->outcome);
    if (!status)
        status = launch_sample_base(run);
    if (!status)
        status = change_tube(run, propagator_time(run->propagator));
    if (!status && launch_is_finished(run)) {
        launch_end_measures(run);
        launch_record_event(run, LD_EVENT_END, propagator_time(run->propagator), -1);
    }
    return status;
}

ld_status launch_advance(ld_run *run, double t, bool to_event)
{
    while (!run->status) {
        if (to_event && !run->ahead && run->event_reported < run->event_count)
            break;
        double reached = propagator_time(run->propagator);
        if (run->ahead ? t < reached : t <= reached || launch_is_finished(run))
            break;
        run->status = run->ahead ? launch_arrive(run) : step(run);
        if (run->status)
            launch_write_last_row(run);
    }
    run->t = run->ahead ? t : propagator_time(run->propagator);
    return run->status;
}

ld_status launch_find_rest(ld_run *run)
{
    if (!run->ahead)
        return run->status;
    double t = run->t;
    run->outcome = propagator_return(run->propagator, t, &run->error);
    run->status = run->outcome == INTEGRATOR_FAILED ? run->error.status : LD_OK;
    // error control may have made the step still shorter
    run->t_input = t;
    launch_advance(run, t, false);
    run->t_input = INFINITY;
    return run->status;
}

ld_status launch_begin(ld_run *run)
{
    launch_state *self = &run->launch;
    double y[LD_MAX_STATES];
    const ld_model *model = self->model;
    const ld_run_settings *settings = model_run(model);
    double last = model_firing(model, model_firing_count(model) - 1)->at;
    run->t_start = simulation_start_time(model);
    run->t_end = settings->end == LD_END_TIME ? last + settings->end_time : INFINITY;
    run->t = run->t_start;
    run->t_input = INFINITY;
    run->last_row = run->reported_at = NAN;
    run->summary.t_end = run->t_start;
    set_up_rocket(run, 0, run->t_start);
    forget_equilibrium(&run->summary.equilibrium);
    ld_status status = launch_check_base(run, run->t_start);
    if (!status)
        status = launch_begin_base(run);
    if (!status)
        status = find_start(run, y);
    if (status)
        forget_start(&run->summary);
    if (!status)
        status = launch_open_output(run);
    if (status)
        return status;
    ld_energy energy;
    launch_energy_at(self, run->t_start, y, 0, &energy);
    run->energy_start = energy.kinetic + energy.potential + energy.elastic;
    if (run->t_start >= self->t_ignition) {
        launch_record_ignition(run, run->t_start, y);
        launch_pass_stop(run, run->t_start);
    }
    self->phase.locked = self->rocket->lock.present;
    launch_lay_line(run, run->t_start, y);
    launch_release_at_once(run, run->t_start, y);
    launch_pass_corners(run, run->t_start, y, false);
    launch_measure_instant(run, run->t_start, y);
    launch_restart_output(run, run->t_start);
    run->next_progress = run->t_start;
    status = launch_step_base(run, run->t_start, y);
    if (!status)
        status = propagator_create(&run->launch, run->outside, &run->propagator, &run->error);
    if (!status)
        status = propagator_start(run->propagator, run->t_start, y, true, &run->error);
    return status ? status : launch_write_row(run, run->t_start, y);
}
