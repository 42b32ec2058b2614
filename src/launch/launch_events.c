// What happens at events and stops of a launch: the lock releases, adaptors leave the guide,
// ignition, corners.
#include "launch/launch_events.h"

#include <math.h>

#include "launch/launch_base.h"
#include "launch/launch_rows.h"
#include "launch/launch_run.h"
#include "launch/launch_summary.h"
#include "model/blocks/firing.h"
#include "model/parts.h"
#include "state/evaluation.h"
#include "systems/launching/launching_kinematics.h"

// What falls off moves on as the rocket does there, so no speed jumps; the balance continues
// without its energy.
static void let_part_fall(ld_run *run, int i, double t, const double *y)
{
    launch_state *self = &run->launch;
    launcher_input input;
    if (!self->rocket->adaptor[i].falls_off.present)
        return;
    simulation_input(self, t, y, &input);
    double with = launcher_kinetic_energy(&self->launcher, &input, &self->phase, y);
    rocket_mass_without(self->rocket, i, &input.launching.mass);
    double without = launcher_kinetic_energy(&self->launcher, &input, &self->phase, y);
    run->energy_start += without - with;
}

static void let_adaptor_go(ld_run *run, int i, double t, const double *y)
{
    launch_state *self = &run->launch;
    ld_rocket_summary *rocket = &run->summary.rocket[self->current];
    int count = self->launcher.launching.adaptors.count, ahead = 0;
    double since = t - self->t_ignition;
    const ld_adaptor *adaptor = self->rocket->adaptor;
    for (int j = 0; j < count; j++)
        ahead += adaptor[j].at > adaptor[i].at;
    let_part_fall(run, i, t, y);
    self->phase.passed[i] = true;
    rocket->t_exit[i] = since;
    launch_record_event(run, LD_EVENT_EXIT, t, i);
    if (i == 0) {
        rocket->t_rear = since;
        launch_record_exit(run, t, y);
    } else if (ahead == 0) {
        rocket->t_front = since;
    } else if (count == 3) {
        rocket->t_middle = since;
    }
}

// Adaptor i leaves with those that leave with it, the rear one with all.
static void pass_adaptors(ld_run *run, int i, double t, const double *y)
{
    const launch_state *self = &run->launch;
    const adaptor_set *adaptors = &self->launcher.launching.adaptors;
    for (int j = adaptors->count - 1; j >= 0; j--)
        if (!self->phase.passed[j] && (i == 0 || adaptors->leaves_with[j] == i))
            let_adaptor_go(run, j, t, y);
}

// Rear adaptor out and the launcher continues (another rocket, or run.end is a time): the rocket
// goes; the balance continues without its energy.
static void let_rocket_go(ld_run *run, double t, const double *y)
{
    launch_state *self = &run->launch;
    launcher_input input;
    simulation_input(self, t, y, &input);
    double with = launcher_kinetic_energy(&self->launcher, &input, &self->phase, y);
    self->phase.rocket = false;
    double without = launcher_kinetic_energy(&self->launcher, &input, &self->phase, y);
    run->energy_start -= with - without;
    if (self->current + 1 < model_firing_count(self->model))
        launch_restart_output(run, t);
}

// Speed at a first touch, never so slow that damping grows beyond bounds.
static double touch_speed(const launch_state *self, double speed)
{
    return fmax(speed, 1e-3 * self->launcher.launching.adaptors.law.v_0);
}

// The lock releases; where the rocket then stands it meets the breech.
static void let_go(ld_run *run, double t, const double *y)
{
    launch_state *self = &run->launch;
    self->phase.locked = false;
    self->phase.breech = fmin(self->phase.breech, y[self->launcher.launching.layout.x + X_S]);
    run->summary.rocket[self->current].t_release = t - self->t_ignition;
    launch_record_event(run, LD_EVENT_RELEASE, t, -1);
}

// ---- the line

static const launching_output *line_output(launch_state *self, double t, const double *y)
{
    self->latest.known = false; // another phase may hold since then
    const launcher_output *at = simulation_output(self, t, y);
    return at ? &at->launching : NULL;
}

void launch_lay_line(ld_run *run, double t, const double *y)
{
    launch_state *self = &run->launch;
    const ld_line *given = &self->rocket->line;
    const launching_output *out =
        given->present && given->slack > 0 ? line_output(self, t, y) : NULL;
    if (!out)
        return;
    self->phase.line_out = out->line_paid + given->slack;
    self->phase.line = LINE_SLACK;
    self->latest.known = false;
}

// At the bridle (line_pull.h).
static void break_line(ld_run *run, double t, const double *y, const launching_output *out)
{
    launch_state *self = &run->launch;
    ld_rocket_summary *rocket = &run->summary.rocket[self->current];
    const launching_layout *at = &self->launcher.launching.layout;
    launching_output unused;
    launching_pose pose;
    launching_rocket_pose(&self->launcher.launching, y, &pose, &unused);
    v3 bridle = v3_add(pose.p1, m3_apply(pose.A_RB, v3_from(self->rocket->line.bridle)));
    v3 r = v3_add(v3_from(y + at->r), m3_apply(q_matrix(q_from(y + at->quaternion)), bridle));
    self->phase.line_out = out->line_paid;
    self->phase.line = LINE_BROKEN;
    rocket->line.t_break = t - self->t_ignition;
    rocket->line.broken_at = 0;
    v3_store(rocket->line.broken, r);
    summary_note(&run->summary,
                 "the line broke in the guide at t = %.4f s, at the rocket, %.4g m out, by %.4g N",
                 t, out->line_paid, out->line_tension);
    launch_record_event(run, LD_EVENT_LINE, t, -1);
}

// From slack to a jerk to taut; or it breaks.
static void switch_line(ld_run *run, double t, const double *y)
{
    launch_state *self = &run->launch;
    const launching_output *out = line_output(self, t, y);
    double breaking = self->rocket->line.breaking_force;
    double left = out && !isnan(breaking) ? 1 - out->line_tension / breaking : 1;
    if (self->phase.line == LINE_SLACK)
        self->phase.line = LINE_JERKED;
    else if (out && (self->phase.line == LINE_TAUT || left <= out->line_left))
        break_line(run, t, y, out);
    else
        self->phase.line = LINE_TAUT;
    if (self->phase.line == LINE_JERKED)
        launch_record_event(run, LD_EVENT_LINE, t, -1);
    self->latest.known = false;
}

static void break_line_at_once(ld_run *run, double t, const double *y)
{
    launch_state *self = &run->launch;
    const ld_line *given = &self->rocket->line;
    if (!given->present || !self->phase.rocket || isnan(given->breaking_force) ||
        self->phase.line == LINE_BROKEN)
        return;
    const launching_output *out = line_output(self, t, y);
    if (out && out->line_tension > given->breaking_force)
        break_line(run, t, y, out);
    self->latest.known = false;
}

// ---- the phase

// As the integrator reports it: 1, -1, or 0.
static int wall_event(const ld_run *run, int i, int wall)
{
    int surfaces = run->launch.launcher.launching.surfaces.count;
    return surfaces ? propagator_event(run->propagator, EVENT_SURFACE, i * surfaces + wall)
                    : propagator_event(run->propagator, EVENT_TOUCH, i);
}

// A shoe's first touch of a surface, whose speed is kept for the whole contact.
static bool touch_surfaces(ld_run *run, double t, const double *y)
{
    launch_state *self = &run->launch;
    const launching_system *launching = &self->launcher.launching;
    int surfaces = launching->adaptors.law.by_touch ? launching->surfaces.count : 0;
    bool touched = false;
    for (int i = launching->adaptors.count - 1; i >= 0; i--)
        for (int k = 0; k < surfaces; k++) {
            if (self->phase.passed[i] || wall_event(run, i, k) <= 0)
                continue;
            double speed = launching_surface_rate(launching, y, i, k);
            self->phase.surface_speed[i][k] = touch_speed(self, speed);
            launch_record_event(run, LD_EVENT_TOUCH, t, i);
            touched = true;
        }
    return touched;
}

// Whether a stop of a slide pushes is said by its event, where one has been located, else by how it
// lies, and holds up to the next: so its force continues smoothly between two of them.
bool launch_hold_stops(ld_run *run, double t, const double *y, bool at_event)
{
    launch_state *self = &run->launch;
    int stops = LD_SLIDE_STOPS * model_slide_count(self->model);
    const launcher_output *out = stops ? simulation_output(self, t, y) : NULL;
    bool changed = false;
    for (int i = 0; out && i < stops; i++) {
        int *pushing = &self->phase.pushing[i / LD_SLIDE_STOPS][i % LD_SLIDE_STOPS];
        int before = *pushing;
        int located = at_event ? propagator_event(run->propagator, EVENT_STOP, i) : 0;
        *pushing = located ? located : event_stop_press(self, i, &out->launching) > 0 ? 1 : -1;
        if (*pushing == before || !(before || located))
            continue;
        launch_record_event(run, *pushing > 0 ? LD_EVENT_STOP : LD_EVENT_LEAVE, t, i);
        changed = true;
    }
    return changed;
}

// Each wall as launch_hold_stops does. Near the station where it starts an adaptor stands still, or
// may be moved beyond by a change of the scenario.
void launch_pass_corners(ld_run *run, double t, const double *y, bool at_event)
{
    const double near = 1e-3; // of the tube's length
    launch_state *self = &run->launch;
    const launcher_output *out =
        self->course && self->phase.rocket ? simulation_output(self, t, y) : NULL;
    const launching_system *launching = &self->launcher.launching;
    int walls = event_walls(self);
    for (int i = 0; out && i < launching->adaptors.count; i++) {
        adaptor_corner *corner = &self->corner[i];
        double s = out->launching.adaptor[i].s;
        bool passed = at_event && propagator_event(run->propagator, EVENT_STATION, i) < 0;
        if (!corner->known)
            corner->station = event_next_station(self, s + near * launching->tube.flexible.length);
        else if (passed || s > corner->station)
            corner->station = event_next_station(self, s);
        corner->known = true;
        for (int k = 0; k < walls; k++) {
            int located = at_event ? wall_event(run, i, k) : 0;
            double press = event_wall_press(self, i, k, &out->launching);
            corner->touching[k] = located ? located : press > 0 ? 1 : -1;
        }
    }
}

// Switches what the events just located say; true where the equations changed.
bool launch_switch_phase(ld_run *run, double t, const double *y)
{
    launch_state *self = &run->launch;
    int count = self->launcher.launching.adaptors.count;
    bool changed = false, by_touch = self->launcher.launching.adaptors.law.by_touch;
    if (self->phase.locked && propagator_event(run->propagator, EVENT_RELEASE, 0) < 0) {
        let_go(run, t, y);
        changed = true;
    }
    for (int i = count - 1; i >= 0; i--) {
        if (!self->phase.passed[i] && propagator_event(run->propagator, EVENT_EXIT, i) < 0) {
            pass_adaptors(run, i, t, y);
            changed = true;
        }
        if (by_touch && !self->phase.passed[i] &&
            propagator_event(run->propagator, EVENT_TOUCH, i) > 0) {
            // first touch: its speed is kept for the whole contact
            self->phase.touch_speed[i] =
                touch_speed(self, launching_offset_rate(&self->launcher.launching, y, i));
            launch_record_event(run, LD_EVENT_TOUCH, t, i);
            changed = true;
        }
    }
    if (propagator_event(run->propagator, EVENT_BREECH, 0) > 0) {
        launching_output out;
        launching_pose unused;
        launching_rocket_pose(&self->launcher.launching, y, &unused, &out);
        self->phase.breech_speed = touch_speed(self, -out.x_dot[X_S]);
        launch_record_event(run, LD_EVENT_BREECH, t, -1);
        changed = true;
    }
    if (self->phase.rocket && propagator_event(run->propagator, EVENT_LINE, 0) < 0) {
        switch_line(run, t, y);
        changed = true;
    }
    changed |= touch_surfaces(run, t, y);
    for (int j = 0; j < self->launcher.base.event_count; j++) {
        int direction = propagator_event(run->propagator, EVENT_BASE, j);
        if (direction)
            launch_record_event(run, direction > 0 ? LD_EVENT_LAND : LD_EVENT_LIFT, t, j);
        changed |= direction > 0;
    }
    bool last = self->current + 1 == model_firing_count(self->model);
    if (self->phase.passed[0] && self->phase.rocket &&
        !(last && model_run(self->model)->end != LD_END_TIME)) {
        let_rocket_go(run, t, y);
        changed = true;
    }
    return changed;
}

// A jump of the thrust, or the start itself, can carry the lock's force past the release force
// without a crossing that the integrator could locate.
static void open_lock_at_once(ld_run *run, double t, const double *y)
{
    launch_state *self = &run->launch;
    if (!self->phase.locked || self->held_down)
        return;
    const launcher_output *at = simulation_output(self, t, y);
    const launching_output *out = at ? &at->launching : NULL;
    if (!out || !(out->lock_force > self->rocket->lock.release_force))
        return;
    run->greatest_lock_force = fmax(run->greatest_lock_force, out->lock_force);
    let_go(run, t, y);
}

void launch_release_at_once(ld_run *run, double t, const double *y)
{
    open_lock_at_once(run, t, y);
    break_line_at_once(run, t, y);
}

// When the next tube takes the place of the one that is empty now.
double launch_change_instant(const launch_state *self)
{
    return model_firing(self->model, self->current + 1)->at - 0.2;
}

// The next instant at which the step must end: ignition, a corner of the thrust, the end; `none`
// where no one has said when.
static double next_stop(const ld_run *run, double t, double none)
{
    const launch_state *self = &run->launch;
    const base_system *base = &self->launcher.base;
    double first, stop;
    base_span(base, &first, &stop);
    stop = fmin(stop, run->t_end);
    if (base->kind->next_corner)
        stop = fmin(stop, base->kind->next_corner(base, t));
    if (self->air) // a gust's
        stop = fmin(stop, wind_next_corner(&self->air->wind, t));
    stop = fmin(stop, jets_next_corner(&self->jets));
    if (t < self->t_ignition)
        return fmin(stop, isinf(self->t_ignition) ? none : self->t_ignition);
    if (self->current + 1 < model_firing_count(self->model))
        stop = fmin(stop, self->phase.rocket ? model_firing(self->model, self->current + 1)->at
                                             : launch_change_instant(self));
    if (self->held_down)
        stop = fmin(stop, self->t_ignition + self->rocket->lock.hold_down);
    int next = self->piece + 1;
    if (next < (int)self->motor->corner_count)
        stop = fmin(stop, self->t_ignition + self->motor->t[next]);
    if (model_has_pressure(self->model))
        stop =
            fmin(stop, self->t_ignition + pressure_next_corner(&model_tubes(self->model)->pressure,
                                                               self->pressure_piece));
    return isinf(stop) ? none : stop;
}

// A step requires a finite end.
double launch_next_stop(const ld_run *run, double t)
{
    return next_stop(run, t, t + 1);
}

double launch_next_instant(const ld_run *run, double t)
{
    return fmin(next_stop(run, t, INFINITY), launch_next_sample(run, t));
}

// The piece of the pressure that t has reached.
static int pressure_piece_at(const launch_state *self, double t)
{
    const ld_pressure *pressure = &model_tubes(self->model)->pressure;
    int piece = self->pressure_piece;
    while (model_has_pressure(self->model) && t >= self->t_ignition &&
           t >= self->t_ignition + pressure_next_corner(pressure, piece))
        piece++;
    return piece;
}

// At a stop: ignition ignites the motor or lets the pressure on, a corner begins the next piece of
// the curve of either, or of what drives the base; the lock may release.
bool launch_pass_stop(ld_run *run, double t)
{
    launch_state *self = &run->launch;
    const base_system *base = &self->launcher.base;
    int before = self->piece;
    while (t >= self->t_ignition && self->piece + 1 < (int)self->motor->corner_count &&
           t >= self->t_ignition + self->motor->t[self->piece + 1])
        self->piece++;
    int pressed = self->pressure_piece;
    self->pressure_piece = pressure_piece_at(self, t);
    bool burning = self->piece != before || self->pressure_piece != pressed;
    bool held = self->held_down;
    self->held_down &= t < self->t_ignition + self->rocket->lock.hold_down;
    bool driven = base->kind->next_corner != NULL;
    bool base_corner = driven && base->kind->next_corner(base, nextafter(t, -INFINITY)) == t;
    if (base_corner || (burning && t > self->t_ignition))
        launch_record_event(run, LD_EVENT_CORNER, t, -1);
    return jets_pass_corners(&self->jets, t) || burning || driven || held != self->held_down;
}
