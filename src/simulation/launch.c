// The run: start, ignition, release, adaptors leaving, end; rows out at the output steps.
#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "simulation/free_flight.h"
#include "simulation/propagator.h"

// ---- life ----

// The stretch of road [m] that the wheels will see in a launch.
static void road_under(const ld_model *model, double x[2])
{
    const ld_vehicle *vehicle = &model->base.vehicle;
    double speed = vehicle->speed, rear = 0, front = 0;
    for (int j = 0; j < vehicle->wheel_count; j++) {
        rear = fmin(rear, vehicle->wheel[j].mount[0]);
        front = fmax(front, vehicle->wheel[j].mount[0]);
    }
    double end = model->run.end == LD_END_TIME ? model->run.end_time : 1;
    x[0] = rear - speed * model->run.lead_in - 1;
    x[1] = front + speed * (model->firing[model->firing_count - 1].at + end) + 1;
}

static ld_status create_launch(ld_simulation *self, launching_tube *kept, ld_error *error)
{
    const ld_model *model = self->model;
    double stretch[2];
    road_under(model, stretch);
    ld_status status = launcher_build(&self->launcher, model, kept, stretch[0], stretch[1], error);
    int count = model->salvo ? model->firing_count : 1;
    for (int i = 0; i < count && !status; i++) {
        status = motor_build(&self->motor_of[i], model->salvo ? &model->salvo[i] : &model->rocket,
                             error);
        self->motor_count += !status;
    }
    if (status)
        return status;
    simulation_select_rocket(self, 0);
    self->t_ignition = model->firing[0].at;
    history_build(self);
    return LD_OK;
}

// Makes it empty, but for the columns' texts, which are many and mean nothing until they are
// counted.
static void clear(ld_simulation *self)
{
    memset(self, 0, offsetof(ld_simulation, column));
}

static void release(ld_simulation *self)
{
    launcher_free(&self->launcher);
    flight_free(&self->flight);
    for (int i = 0; i < self->motor_count; i++)
        motor_free(&self->motor_of[i]);
    clear(self);
}

ld_status simulation_renew(ld_simulation **simulation, const ld_model *model, ld_error *error)
{
    ld_simulation *self = *simulation;
    launching_tube kept = {0};
    if (self) {
        kept = launching_take_tube(&self->launcher.launching);
        release(self);
    } else {
        // its lanes want their alignment
        self = aligned_alloc(64, (sizeof *self + 63) / 64 * 64);
        if (!self)
            return ld_fail(error, LD_ERR_MEMORY, "no memory for the simulation");
        clear(self);
        *simulation = self;
    }
    self->model = model;
    if (model->salvo) {
        self->own = *model;
        self->model = &self->own;
    }
    ld_status status = model->base.kind == LD_BASE_NONE ? flight_alone_create(self, error)
                                                        : create_launch(self, &kept, error);
    launching_tube_free(&kept);
    if (status)
        release(self);
    return status;
}

ld_status ld_simulation_create(const ld_model *model, ld_simulation **out, ld_error *error)
{
    clock_t start = clock();
    ld_simulation *self = NULL;
    ld_status status = simulation_renew(&self, model, error);
    if (status) {
        ld_simulation_free(self);
        return status;
    }
    self->mode_count = ld_simulation_tube_modes(self, self->mode, LD_MAX_MODES);
    self->cpu_seconds_setup = (double)(clock() - start) / CLOCKS_PER_SEC;
    *out = self;
    return LD_OK;
}

void ld_simulation_free(ld_simulation *self)
{
    if (self)
        release(self);
    free(self);
}

void simulation_select_rocket(ld_simulation *self, int i)
{
    bool differ = self->model->salvo != NULL;
    self->rocket = i;
    self->motor = self->motor_of[differ ? i : 0];
    if (!differ)
        return;
    self->own.rocket = self->model->salvo[i];
    launching_set_rocket(&self->launcher.launching);
}

// ---- a run ----

typedef struct launch_run {
    ld_simulation *self;
    const ld_run_options *options;
    ld_summary *summary;
    ld_error *error;
    propagator *propagator;
    double *row;         // one row of the history
    double *between;     // state between steps
    double energy_start; // [J]
    double t_start, t_end;
    double next_output; // time of the next row
    double output_step;
    int64_t output_index; // rows since the last change of the output step
    double output_from;   // where that was
    double last_row;      // time of the last row written
    double next_progress;
    int64_t steps_since_progress;
    bool sink_failed;
    double greatest_lock_force;
    double point[LD_MAX_FIRINGS][2]; // [m] x and z of the rear adaptors at their ignition
    int flight_column_count;
    double cpu_output; // [s] spent on rows and their sink
} launch_run;

// From ignition on rows come at the tube's step; before it, and where a rocket has left and another
// is to follow, at that of the lead-in.
static double output_step(const launch_run *run, double t)
{
    const ld_simulation *self = run->self;
    bool between = !self->phase.rocket && self->current + 1 < self->model->firing_count;
    return t < self->t_ignition || between ? self->model->run.output_step_lead_in
                                           : self->model->run.output_step_tube;
}

static double cpu_now(void)
{
    return (double)clock() / CLOCKS_PER_SEC;
}

static ld_status write_row(launch_run *run, double t, const double *y)
{
    const ld_sink *sink = run->options ? run->options->sink : NULL;
    if (!sink || t == run->last_row)
        return LD_OK;
    run->last_row = t;
    double start = cpu_now();
    history_row(run->self, t, y, run->energy_start, run->row);
    ld_status status = sink->row(sink->self, run->row, (size_t)run->self->column_count, run->error);
    run->cpu_output += cpu_now() - start;
    run->sink_failed = status != LD_OK;
    return status;
}

// Rows that fell into the last step.
static ld_status write_rows(launch_run *run)
{
    double now = propagator_time(run->propagator);
    while (run->options && run->options->sink && run->next_output <= now) {
        double t = run->next_output;
        propagator_interpolate(run->propagator, t, run->between);
        ld_status status = write_row(run, t, run->between);
        if (status)
            return status;
        run->output_index++;
        run->next_output = run->output_from + (double)run->output_index * run->output_step;
    }
    return LD_OK;
}

static void restart_output(launch_run *run, double t)
{
    run->output_from = t;
    run->output_index = 1;
    run->output_step = output_step(run, t);
    run->next_output = t + run->output_step;
}

// Rocket i of the firing comes next: its lock closed, its motor not yet lit.
static void set_up_rocket(launch_run *run, int i)
{
    ld_simulation *self = run->self;
    const ld_firing *firing = &self->model->firing[i];
    self->current = i;
    simulation_select_rocket(self, i);
    self->t_ignition = firing->at;
    self->phase = simulation_start_phase(self);
    self->piece = -1;
    self->jammed = false;
    run->greatest_lock_force = 0;
    ld_rocket_summary *rocket = &run->summary->rocket[i];
    run->summary->rocket_count = i + 1;
    rocket->tube = firing->tube;
    rocket->t_ignition = firing->at;
    rocket->t_release = rocket->t_front = rocket->t_middle = rocket->t_rear = NAN;
    for (int k = 0; k < LD_MAX_ADAPTORS; k++)
        rocket->t_exit[k] = NAN;
    rocket->muzzle_speed = rocket->inertial_speed = rocket->spin_rate = NAN;
    rocket->pitch = rocket->yaw = rocket->pitch_rate = rocket->yaw_rate = NAN;
    double *relative = &rocket->relative.y, *tip = &rocket->tip.y, *out = (double *)&rocket->exit;
    for (int k = 0; k < 8; k++)
        relative[k] = tip[k] = NAN;
    for (int k = 0; k < 13; k++)
        out[k] = NAN;
    rocket->tip_off = no_tip_off;
    rocket->aim = no_aim;
}

static ld_status find_start(launch_run *run, double *y)
{
    ld_simulation *self = run->self;
    ld_status status = LD_OK;
    if (self->launcher.vehicle && !self->stability_checked)
        status = simulation_check_stability(self, &self->growing, run->error);
    if (status)
        return status;
    self->stability_checked = true;
    if (self->model->run.start == LD_START_EQUILIBRIUM)
        status =
            simulation_equilibrium(self, run->t_start, y, &run->summary->equilibrium, run->error);
    else
        status = simulation_undeformed(self, run->t_start, y, run->error);
    if (status)
        return status;
    simulation_move_with_base(self, run->t_start, y);
    return status;
}

// ---- what happens at events ----

static void record_exit(launch_run *run, double t, const double *landed)
{
    ld_simulation *self = run->self;
    const launching_layout *at = &self->launcher.launching.layout;
    // the curvature jumps at the tip: its inner value counts, on whichever side the step landed
    double y[LD_MAX_STATES];
    memcpy(y, landed, (size_t)self->launcher.state_count * sizeof(double));
    y[at->x] = fmin(y[at->x], self->launcher.launching.tube.flexible.length);
    ld_rocket_summary *rocket = &run->summary->rocket[self->current];
    launching_output out;
    launching_pose pose;
    launcher_input input;
    launching_rocket_pose(&self->launcher.launching, y, &pose, &out);
    simulation_input(self, t, y, &input);
    m3 A_IR = q_matrix(q_from(y + at->quaternion));
    v3 axis = m3_column(pose.A_RB, 0);
    direction_angles angles =
        direction_angles_of(m3_apply(A_IR, axis), m3_apply(A_IR, v3_cross(pose.w_B, axis)));
    rocket->muzzle_speed = out.y[0];
    rocket->inertial_speed = v3_norm(pose.v_O1);
    rocket->spin_rate = v3_dot(axis, pose.w_B);
    rocket->pitch = angles.pitch;
    rocket->yaw = angles.yaw;
    rocket->pitch_rate = angles.pitch_rate;
    rocket->yaw_rate = angles.yaw_rate;
    memcpy(&rocket->relative.y, y + at->x + 1, 5 * sizeof(double));
    memcpy(&rocket->relative.w_x, out.y + 3, 3 * sizeof(double));
    v3_store(rocket->exit.position, v3_add(v3_from(y + at->r), m3_apply(A_IR, pose.p1)));
    v3_store(rocket->exit.velocity, m3_apply(A_IR, pose.v_O1));
    quat q = q_from_matrix(m3_mul(A_IR, pose.A_RB));
    memcpy(rocket->exit.quaternion, &q, sizeof q);
    v3_store(rocket->exit.rate, m3_apply_transposed(pose.A_RB, pose.w_B));
    tip_state tip = tip_state_of(self, &input.launching.base, y);
    rocket->tip.y = tip.offset.y;
    rocket->tip.z = tip.offset.z;
    rocket->tip.pitch = tip.angles.pitch;
    rocket->tip.yaw = tip.angles.yaw;
    rocket->tip.vy = tip.offset_dot.y;
    rocket->tip.vz = tip.offset_dot.z;
    rocket->tip.pitch_rate = tip.angles.pitch_rate;
    rocket->tip.yaw_rate = tip.angles.yaw_rate;
    rocket_motion motion = rocket_motion_of(&pose, input.launching.mass.c, y, at);
    rocket->tip_off = tip_off_of(&input.launching.base, &motion);
    rocket->aim = aim_of(self, t, &motion);
}

static void pass_adaptor(launch_run *run, int i, double t, const double *y)
{
    ld_simulation *self = run->self;
    ld_rocket_summary *rocket = &run->summary->rocket[self->current];
    int count = self->launcher.launching.adaptors.count, ahead = 0;
    double since = t - self->t_ignition;
    const ld_adaptor *adaptor = self->model->rocket.adaptor;
    for (int j = 0; j < count; j++)
        ahead += adaptor[j].at > adaptor[i].at;
    self->phase.passed[i] = true;
    rocket->t_exit[i] = since;
    if (i == 0) {
        rocket->t_rear = since;
        record_exit(run, t, y);
    } else if (ahead == 0) {
        rocket->t_front = since;
    } else if (count == 3) {
        rocket->t_middle = since;
    }
}

// Rear adaptor out: the rocket goes; the balance goes on without its energy.
static void let_rocket_go(launch_run *run, double t, const double *y)
{
    ld_simulation *self = run->self;
    launcher_input input;
    simulation_input(self, t, y, &input);
    double with = launcher_kinetic_energy(&self->launcher, &input, &self->phase, y);
    self->phase.rocket = false;
    double without = launcher_kinetic_energy(&self->launcher, &input, &self->phase, y);
    run->energy_start -= with - without;
    if (self->current + 1 < self->model->firing_count)
        restart_output(run, t);
}

// Speed at a first touch, never so slow that damping grows beyond bounds.
static double touch_speed(const ld_simulation *self, double speed)
{
    return fmax(speed, 1e-3 * self->launcher.launching.adaptors.law.v_0);
}

// The lock lets go; where the rocket then stands it meets the breech.
static void let_go(launch_run *run, double t, const double *y)
{
    ld_simulation *self = run->self;
    self->phase.locked = false;
    self->phase.breech = fmin(self->phase.breech, y[self->launcher.launching.layout.x]);
    run->summary->rocket[self->current].t_release = t - self->t_ignition;
}

// Switches what the events just located say; true where the equations changed.
static bool switch_phase(launch_run *run, double t, const double *y)
{
    ld_simulation *self = run->self;
    int count = self->launcher.launching.adaptors.count;
    bool changed = false;
    if (self->phase.locked && propagator_event(run->propagator, 0) < 0) {
        let_go(run, t, y);
        changed = true;
    }
    for (int i = count - 1; i >= 0; i--) {
        if (!self->phase.passed[i] && propagator_event(run->propagator, 1 + i) < 0) {
            pass_adaptor(run, i, t, y);
            changed = true;
        }
        if (!self->phase.passed[i] && propagator_event(run->propagator, 1 + count + i) > 0) {
            // first touch: its speed is kept for the whole contact
            self->phase.touch_speed[i] =
                touch_speed(self, launching_offset_rate(&self->launcher.launching, y, i));
            changed = true;
        }
    }
    if (propagator_event(run->propagator, simulation_breech_event(self)) > 0) {
        launching_output out;
        launching_pose unused;
        launching_rocket_pose(&self->launcher.launching, y, &unused, &out);
        self->phase.breech_speed = touch_speed(self, -out.y[0]);
        changed = true;
    }
    for (int j = 0; j < self->launcher.marching.wheel_count; j++)
        changed |= propagator_event(run->propagator, 1 + 2 * count + j) > 0;
    bool last = self->current + 1 == self->model->firing_count;
    if (self->phase.passed[0] && self->phase.rocket &&
        !(last && self->model->run.end != LD_END_TIME)) {
        let_rocket_go(run, t, y);
        changed = true;
    }
    return changed;
}

// Largest contact and slot forces so far.
static void watch_forces(launch_run *run, double t, const double *y)
{
    ld_simulation *self = run->self;
    if (!self->phase.rocket)
        return;
    ld_rocket_summary *rocket = &run->summary->rocket[self->current];
    const launcher_output *at = simulation_output(self, t, y);
    if (!at)
        return;
    const launching_output *out = &at->launching;
    for (int i = 0; i < self->launcher.launching.adaptors.count; i++)
        if (!self->phase.passed[i])
            rocket->max_contact_force[i] =
                fmax(rocket->max_contact_force[i], out->adaptor[i].force);
    rocket->max_slot_force = fmax(rocket->max_slot_force, fabs(out->N));
    if (self->phase.locked)
        run->greatest_lock_force = fmax(run->greatest_lock_force, out->lock_force);
}

// ---- what ends a run early ----

static ld_status check_tube(launch_run *run, double t, const double *y)
{
    const int parts = 4;
    double length = run->self->launcher.launching.tube.flexible.length;
    for (int k = parts; k > 0; k--) {
        launching_section at;
        double x = length * k / parts;
        launching_section_at(&run->self->launcher.launching, y, x, &at);
        double sag = hypot(at.P.y, at.P.z);
        if (sag > 0.2 * length || at.A.a[0][0] < 0.8)
            return ld_fail(run->error, LD_ERR_NUMERIC,
                           "the tube bends beyond what small deflections allow at t = %.6g s: "
                           "%.3g m from its rear end it is %.3g m off its axis",
                           t, x, sag);
    }
    return LD_OK;
}

static ld_status check_progress(launch_run *run, double t, const double *y)
{
    ld_simulation *self = run->self;
    const ld_rocket *rocket = &self->model->rocket;
    double since = t - self->t_ignition, s = y[self->launcher.launching.layout.x];
    if (self->phase.passed[0] && since < 0)
        return ld_fail(run->error, LD_ERR_LAUNCH,
                       "the rocket slid out of the tube's tip at t = %.6g s, %.3g s before its "
                       "ignition",
                       t, -since);
    if (!self->phase.rocket)
        return LD_OK;
    if (self->phase.breech - s > 0.1 * self->launcher.launching.tube.flexible.length)
        return ld_fail(
            run->error, LD_ERR_LAUNCH,
            "the rocket is %.4g m behind the breech at t = %.6g s: a contact of %.6g N/m "
            "does not hold it",
            self->phase.breech - s, t, rocket->contact.stiffness);
    if (since < self->model->run.stuck_time)
        return LD_OK;
    if (self->phase.locked)
        return ld_fail(
            run->error, LD_ERR_LAUNCH,
            "the lock never let go: it carried at most %.6g N of the release force %.6g N "
            "by %.4g s after ignition",
            run->greatest_lock_force, rocket->lock.release_force, since);
    return ld_fail(
        run->error, LD_ERR_LAUNCH,
        "the rocket is stuck in the tube: its rear adaptor is at %.4g m of %.4g m, %.4g s "
        "after ignition",
        s, self->launcher.launching.tube.flexible.length, since);
}

// Launches must not overlap.
static ld_status check_next(launch_run *run, double t)
{
    const ld_simulation *self = run->self;
    int next = self->current + 1;
    if (next == self->model->firing_count || !self->phase.rocket ||
        t < self->model->firing[next].at)
        return LD_OK;
    return ld_fail(run->error, LD_ERR_LAUNCH,
                   "firing %d: at its ignition, t = %.6g s, the rocket before is still in its "
                   "tube; launches that overlap are not simulated",
                   next + 1, t);
}

// A table of the base's motion must go on beyond t.
static ld_status check_base(launch_run *run, double t)
{
    double first, last;
    base_motion_span(&run->self->launcher.motion, &first, &last);
    if (t >= first && t < last)
        return LD_OK;
    return ld_fail(run->error, LD_ERR_INPUT,
                   "the table of the base's motion goes from %.6g s to %.6g s, which does not "
                   "cover the launch (now at t = %.6g s)",
                   first, last, t);
}

// Steps of less than 50 ns on the average over a millisecond: the run would hardly go on.
static ld_status check_steps(launch_run *run, double t)
{
    const int64_t most = 20000;
    if (++run->steps_since_progress <= most)
        return LD_OK;
    return ld_fail(run->error, LD_ERR_NUMERIC,
                   "the steps became too short to go on: more than %lld within a millisecond, up "
                   "to t = %.9g s",
                   (long long)most, t);
}

// Every millisecond of physics: the caller hears of it, and the tube is looked at.
static ld_status report_progress(launch_run *run, double t)
{
    const ld_run_options *options = run->options;
    if (t < run->next_progress)
        return LD_OK;
    run->next_progress = t + 1e-3;
    run->steps_since_progress = 0;
    ld_status status = check_tube(run, t, propagator_state(run->propagator));
    if (status || !options || !options->progress)
        return status;
    // a launch's end is not known: the travel's share is the estimate
    const ld_simulation *self = run->self;
    double length = self->launcher.launching.tube.flexible.length,
           s0 = self->model->rocket.start_at;
    double s = propagator_state(run->propagator)[self->launcher.launching.layout.x];
    double in_tube = fmin(1, sqrt(fmax(0, (s - s0) / (length - s0))));
    double lead_in = self->t_ignition - run->t_start;
    double expected = lead_in + 0.2;
    double share =
        t < self->t_ignition ? (t - run->t_start) / expected : (lead_in + 0.2 * in_tube) / expected;
    if (!options->progress(options->self, share))
        return ld_fail(run->error, LD_ERR_INTERRUPTED, "interrupted at t = %.6g s", t);
    return LD_OK;
}

// ---- the loop ----

// The first instant after t at which a commanded angle has a corner.
static double next_corner(const ld_table *command, double t)
{
    for (size_t i = 0; i < command->rows && command->rows > 1; i++)
        if (command->data[i * command->columns] > t)
            return command->data[i * command->columns];
    return INFINITY;
}

// When the next tube takes the place of the one that is empty now.
static double change_instant(const ld_simulation *self)
{
    return self->model->firing[self->current + 1].at - 0.2;
}

// The next instant at which the step must end: ignition, a corner of the thrust, the end.
static double next_stop(const launch_run *run, double t)
{
    const ld_simulation *self = run->self;
    double first, stop;
    base_motion_span(&self->launcher.motion, &first, &stop);
    stop = fmin(stop, run->t_end);
    if (self->launcher.vehicle)
        stop =
            fmin(stop, fmin(next_corner(&self->model->platform.azimuth.stabiliser.command, t),
                            next_corner(&self->model->platform.elevation.stabiliser.command, t)));
    if (t < self->t_ignition)
        return fmin(stop, self->t_ignition);
    if (self->current + 1 < self->model->firing_count)
        stop = fmin(stop, self->phase.rocket ? self->model->firing[self->current + 1].at
                                             : change_instant(self));
    int next = self->piece + 1;
    if (next < (int)self->motor.corner_count)
        stop = fmin(stop, self->t_ignition + self->motor.t[next]);
    return stop;
}

// At a stop: ignition lights the motor, a corner begins the next piece of the thrust curve, or of a
// commanded angle.
static bool pass_stop(launch_run *run, double t)
{
    ld_simulation *self = run->self;
    bool changed = self->launcher.vehicle;
    while (t >= self->t_ignition && self->piece + 1 < (int)self->motor.corner_count &&
           t >= self->t_ignition + self->motor.t[self->piece + 1]) {
        self->piece++;
        changed = true;
    }
    return changed;
}

// Where the rocket is when it is lit, over the ground, and how its tube is aimed.
static void record_ignition(launch_run *run, double t, const double *y)
{
    ld_simulation *self = run->self;
    const launching_layout *at = &self->launcher.launching.layout;
    launching_output unused;
    launching_pose pose;
    launching_rocket_pose(&self->launcher.launching, y, &pose, &unused);
    v3 r = v3_add(v3_from(y + at->r), m3_apply(q_matrix(q_from(y + at->quaternion)), pose.p1));
    run->point[self->current][0] = r.x;
    run->point[self->current][1] = r.z;
    launcher_input input;
    launcher_place(&self->launcher, t, y, &input);
    self->aim = input.launching.base.A;
}

// A jump of the thrust, or the start itself, can carry the lock's force past the release force
// without a crossing that the integrator could locate.
static void let_go_at_once(launch_run *run, double t, const double *y)
{
    ld_simulation *self = run->self;
    if (!self->phase.locked)
        return;
    const launcher_output *at = simulation_output(self, t, y);
    const launching_output *out = at ? &at->launching : NULL;
    if (!out || !(out->lock_force > self->model->rocket.lock.release_force))
        return;
    run->greatest_lock_force = fmax(run->greatest_lock_force, out->lock_force);
    let_go(run, t, y);
}

static bool finished(const launch_run *run, double t)
{
    const ld_simulation *self = run->self;
    if (self->current + 1 < self->model->firing_count)
        return false;
    if (self->model->run.end == LD_END_TIME)
        return t >= run->t_end;
    return self->phase.passed[0];
}

static void energy_at(const ld_simulation *self, double t, const double *y, double energy_start,
                      ld_energy *energy)
{
    launcher_input input;
    launcher_output out = {0};
    simulation_input(self, t, y, &input);
    launcher_evaluate(&self->launcher, &input, &self->phase, y, &out);
    simulation_energy(self, &input, &out, y, energy_start, energy);
}

// Once a rocket is out, the next tube is put in its place; the balance goes on without what that
// drops.
static ld_status change_tube(launch_run *run, double t)
{
    ld_simulation *self = run->self;
    int next = self->current + 1;
    if (next == self->model->firing_count || self->phase.rocket || t < change_instant(self))
        return LD_OK;
    double y[LD_MAX_STATES];
    ld_energy before, after;
    memcpy(y, propagator_state(run->propagator),
           (size_t)self->launcher.state_count * sizeof(double));
    energy_at(self, t, y, run->energy_start, &before);
    set_up_rocket(run, next);
    ld_status status = simulation_change_tube(self, next, t, y, run->error);
    if (status)
        return status;
    self->phase.locked = self->model->rocket.lock.present;
    energy_at(self, t, y, run->energy_start, &after);
    run->energy_start += after.residual - before.residual;
    run->summary->rocket[next].energy_dropped = before.kinetic - after.kinetic;
    let_go_at_once(run, t, y);
    restart_output(run, t);
    run->last_row = NAN;
    status = propagator_start(run->propagator, t, y, true, run->error);
    return status ? status : write_row(run, t, y);
}

static ld_status step_failed(launch_run *run)
{
    double t = propagator_time(run->propagator);
    if (check_tube(run, t, propagator_state(run->propagator)) || !run->self->jammed)
        return LD_ERR_NUMERIC;
    return ld_fail(run->error, LD_ERR_LAUNCH,
                   "the knob jams in the slot at t = %.6g s: with this angle and friction no slot "
                   "force fulfils the constraint",
                   propagator_time(run->propagator));
}

static ld_status after_step(launch_run *run, integrator_outcome outcome)
{
    ld_simulation *self = run->self;
    double t = propagator_time(run->propagator);
    const double *y = propagator_state(run->propagator);
    bool igniting = outcome == INTEGRATOR_STOPPED && t == self->t_ignition && self->piece < 0;
    if (igniting)
        record_ignition(run, t, y); // the row of this instant wants it
    ld_status status = write_rows(run);
    watch_forces(run, t, y);
    if (!status && outcome != INTEGRATOR_STEPPED)
        status = write_row(run, t, y);
    bool changed = outcome == INTEGRATOR_EVENT && switch_phase(run, t, y);
    if (outcome == INTEGRATOR_STOPPED) {
        changed = pass_stop(run, t);
        if (igniting)
            restart_output(run, t);
    }
    if (!status)
        status = check_progress(run, t, y);
    if (!status)
        status = check_next(run, t);
    if (!status)
        status = check_steps(run, t);
    if (!status)
        status = report_progress(run, t);
    if (!status && (changed || outcome == INTEGRATOR_EVENT)) {
        let_go_at_once(run, t, y);
        status = propagator_start(run->propagator, t, y, false, run->error);
    }
    return status;
}

static ld_status loop(launch_run *run)
{
    double t = propagator_time(run->propagator);
    while (!finished(run, t)) {
        ld_status status = check_base(run, t);
        if (status)
            return status;
        integrator_outcome outcome =
            propagator_step(run->propagator, next_stop(run, t), run->error);
        if (outcome == INTEGRATOR_FAILED)
            return step_failed(run);
        t = propagator_time(run->propagator);
        status = after_step(run, outcome);
        if (!status)
            status = change_tube(run, t);
        if (status)
            return status;
    }
    return LD_OK;
}

static ld_status begin(launch_run *run)
{
    ld_simulation *self = run->self;
    double y[LD_MAX_STATES];
    const ld_model *model = self->model;
    double last = model->firing[model->firing_count - 1].at;
    launcher_select(&self->launcher, 0);
    self->fallbacks = 0;
    self->worst_condition = 0;
    run->t_start = fmin(model->firing[0].at, 0 - model->run.lead_in);
    run->t_end = model->run.end == LD_END_TIME ? last + model->run.end_time : INFINITY;
    run->last_row = NAN;
    run->summary->t_end = run->t_start;
    set_up_rocket(run, 0);
    ld_status status = check_base(run, run->t_start);
    if (!status)
        status = find_start(run, y);
    const ld_sink *sink = run->options ? run->options->sink : NULL;
    double before = cpu_now();
    if (!status && sink)
        status = simulation_geometry(self, sink, run->error);
    if (!status && sink)
        status = sink->begin(sink->self, self->column, (size_t)self->column_count, run->error);
    run->cpu_output += cpu_now() - before;
    if (status)
        return status;
    ld_energy energy;
    energy_at(self, run->t_start, y, 0, &energy);
    run->energy_start = energy.kinetic + energy.potential + energy.elastic;
    if (run->t_start >= self->t_ignition) {
        record_ignition(run, run->t_start, y);
        pass_stop(run, run->t_start);
    }
    self->phase.locked = self->model->rocket.lock.present;
    let_go_at_once(run, run->t_start, y);
    restart_output(run, run->t_start);
    run->next_progress = run->t_start;
    status = propagator_create(self, &run->propagator, run->error);
    if (!status)
        status = propagator_start(run->propagator, run->t_start, y, true, run->error);
    return status ? status : write_row(run, run->t_start, y);
}

void simulation_note(ld_summary *summary, const char *format, ...)
{
    int capacity = (int)(sizeof summary->note / sizeof summary->note[0]);
    if (summary->note_count == capacity)
        return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(summary->note[summary->note_count++], sizeof summary->note[0], format, arguments);
    va_end(arguments);
}

// ---- the flights ----

static ld_status write_flight_row(void *user, const flight_phase *phase, double t,
                                  const double *state, ld_error *error)
{
    launch_run *run = user;
    const ld_sink *sink = run->options->sink;
    double row[FLIGHT_MAX_COLUMNS], start = cpu_now();
    flight_row(&run->self->flight, phase, t, state, row);
    ld_status status = sink->row(sink->self, row, (size_t)run->flight_column_count, error);
    run->cpu_output += cpu_now() - start;
    return status;
}

static ld_status begin_flight_rows(launch_run *run, int i)
{
    const ld_sink *sink = run->options->sink;
    double start = cpu_now();
    ld_column columns[FLIGHT_MAX_COLUMNS];
    run->flight_column_count = flight_columns(&run->self->flight, columns);
    ld_status status =
        sink->flight(sink->self, i + 1, columns, (size_t)run->flight_column_count, run->error);
    run->cpu_output += cpu_now() - start;
    return status;
}

// Flies rocket i from the state in which it left its tube; nothing jumps.
static ld_status fly(launch_run *run, int i)
{
    ld_simulation *self = run->self;
    ld_rocket_summary *rocket = &run->summary->rocket[i];
    flight_free(&self->flight);
    simulation_select_rocket(self, i);
    ld_status status = flight_build(&self->flight, self->model, i, run->error);
    if (status)
        return status;
    double t = rocket->t_ignition + rocket->t_rear, state[FLIGHT_STATES];
    bool rows = run->options && run->options->sink && run->options->sink->flight;
    quat q = q_from(rocket->exit.quaternion);
    const earth *globe = &self->flight.earth;
    m3 A_EB = m3_mul(globe->A_EI, q_matrix(q));
    flight_pose pose = {
        .r_O1 = v3_from(rocket->exit.position),
        .v_O1 = v3_from(rocket->exit.velocity),
        .q_IB = q,
        .w = v3_add(v3_from(rocket->exit.rate), m3_apply_transposed(A_EB, earth_rate(globe))),
    };
    flight_phase phase = free_flight_phase(&self->flight, rocket->t_ignition, t);
    flight_enter(&self->flight, &phase, t, &pose, state);
    double height = flight_center(&self->flight, t, state).r.y;
    if (self->model->run.end == LD_END_TIME && self->flight.has_ground &&
        height < self->flight.ground) {
        simulation_note(
            run->summary,
            "the rocket of tube %d does not fly: it leaves the tube below the ground, its "
            "mass centre at y = %.4g m",
            rocket->tube, height);
        return LD_OK;
    }
    free_flight job = {
        .system = &self->flight,
        .model = self->model,
        .t_ignition = rocket->t_ignition,
        .t_start = t,
        .t_end = run->t_end,
        .launch_x = run->point[i][0],
        .launch_z = run->point[i][1],
        .options = run->options,
        .row = rows ? write_flight_row : NULL,
        .self = run,
    };
    if (rows)
        status = begin_flight_rows(run, i);
    if (!status)
        status = free_flight_run(&job, state, rocket, run->summary, run->error);
    return status;
}

// Every rocket that has left its tube flies to the ground, or until the run's end.
static ld_status fly_all(launch_run *run)
{
    ld_status status = LD_OK;
    if (run->self->model->run.end == LD_END_TIP)
        return LD_OK;
    for (int i = 0; i < run->summary->rocket_count && !status; i++)
        if (!isnan(run->summary->rocket[i].t_rear))
            status = fly(run, i);
    return status;
}

static void note_formulation(const ld_simulation *self, ld_summary *summary)
{
    if (self->model->run.formulation != LD_FORMULATION_OVERALL)
        return;
    simulation_note(summary, "overall form: condition of the tube's transfer matrix up to %.2g",
                    self->worst_condition);
    if (self->fallbacks)
        simulation_note(summary,
                        "overall form: %lld of %lld evaluations fell back on the reduced form",
                        (long long)self->fallbacks, (long long)summary->statistics.rhs_evaluations);
}

// A run that ends early has its last state as its last row.
static void write_last_row(launch_run *run)
{
    ld_error unused, *error = run->error;
    run->error = &unused;
    if (!run->sink_failed)
        write_row(run, propagator_time(run->propagator), propagator_state(run->propagator));
    run->error = error;
}

static void summarise(launch_run *run, ld_status status, double cpu_seconds)
{
    ld_simulation *self = run->self;
    ld_summary *summary = run->summary;
    summary->complete = status == LD_OK;
    if (status && !run->error->text[0])
        ld_fail(run->error, status, "the receiver of the rows stopped the run");
    if (status)
        memcpy(summary->stopped, run->error->text, sizeof summary->stopped);
    summary->statistics.cpu_seconds = cpu_seconds;
    summary->statistics.cpu_seconds_setup = self->cpu_seconds_setup;
    summary->mode_count = self->mode_count;
    memcpy(summary->mode, self->mode, sizeof summary->mode);
    if (!run->propagator)
        return;
    double t = propagator_time(run->propagator);
    summary->t_end = t;
    energy_at(self, t, propagator_state(run->propagator), run->energy_start, &summary->energy);
    summary->statistics.steps += propagator_steps(run->propagator);
    summary->statistics.rhs_evaluations += propagator_evaluations(run->propagator);
    note_formulation(self, summary);
    for (int i = 0; i < summary->rocket_count; i++)
        if (summary->rocket[i].t_release < 0)
            simulation_note(summary, "the lock of tube %d let go %.4g s before its ignition",
                            summary->rocket[i].tube, -summary->rocket[i].t_release);
    if (self->growing.real > 0)
        simulation_note(summary, "about the equilibrium a motion grows by %.3g 1/s: %s",
                        self->growing.real, self->growing.shape);
}

ld_status ld_simulation_run(ld_simulation *self, const ld_run_options *options, ld_summary *summary,
                            ld_error *error)
{
    ld_error own;
    double start = cpu_now();
    memset(summary, 0, sizeof *summary);
    double row[LD_MAX_COLUMNS], between[LD_MAX_STATES];
    launch_run run = {.self = self,
                      .options = options,
                      .summary = summary,
                      .error = error ? error : &own,
                      .row = row,
                      .between = between};
    *run.error = (ld_error){0};
    if (self->model->base.kind == LD_BASE_NONE)
        return flight_alone_run(self, options, summary, run.error);
    ld_status status = begin(&run);
    if (!status) {
        status = loop(&run);
        if (status)
            write_last_row(&run);
        else
            status = fly_all(&run);
    }
    summarise(&run, status, cpu_now() - start - run.cpu_output);
    propagator_free(run.propagator);
    return status;
}
