// What a launch leaves besides its rows.
#include "launch/launch_summary.h"

#include <stdio.h>
#include <string.h>

#include "base/printed.h"
#include "launch/launch_exit_error.h"
#include "math/functions.h"
#include "model/parts.h"
#include "state/energy.h"
#include "state/evaluation.h"
#include "state/exit_figures.h"
#include "systems/launching/launching_figures.h"
#include "systems/launching/launching_kinematics.h"

// Where the container of a line is at the exit, and how it goes.
static void record_container(ld_run *run, const base_frame *base)
{
    const ld_line *line = &run->launch.rocket->line;
    v3 at = v3_from(line->container), v = v3_zero();
    if (line->container_on == LD_LINE_ON_LAUNCHER) {
        v3 arm = m3_apply(base->A, at);
        at = v3_add(base->r, arm);
        v = v3_add(base->v, v3_cross(base->w, arm));
    }
    v3_store(run->container, at);
    v3_store(run->container + 3, v);
}

void launch_record_exit(ld_run *run, double t, const double *landed)
{
    launch_state *self = &run->launch;
    const launching_layout *at = &self->launcher.launching.layout;
    // the curvature jumps at the tip: its inner value counts, on whichever side the step landed
    double y[LD_MAX_STATES];
    memcpy(y, landed, (size_t)self->launcher.state_count * sizeof(double));
    y[at->x + X_S] = fmin(y[at->x + X_S], self->launcher.launching.tube.flexible.length);
    ld_rocket_summary *rocket = &run->summary.rocket[self->current];
    launching_output out;
    launching_pose pose;
    launcher_input input;
    launching_rocket_pose(&self->launcher.launching, y, &pose, &out);
    simulation_input(self, t, y, &input);
    m3 A_IR = q_matrix(q_from(y + at->quaternion));
    v3 axis = m3_column(pose.A_RB, 0);
    direction_angles angles =
        direction_angles_of(m3_apply(A_IR, axis), m3_apply(A_IR, v3_cross(pose.w_B, axis)));
    rocket->exit_speed = out.x_dot[X_S];
    rocket->inertial_speed = v3_norm(pose.v_O1);
    rocket->spin_rate = v3_dot(axis, pose.w_B);
    rocket->pitch = angles.pitch;
    rocket->yaw = angles.yaw;
    rocket->pitch_rate = angles.pitch_rate;
    rocket->yaw_rate = angles.yaw_rate;
    const double *x = y + at->x, *w = out.y + 3;
    rocket->relative.y = x[X_Y];
    rocket->relative.z = x[X_Z];
    rocket->relative.psi = x[X_PSI];
    rocket->relative.theta = x[X_THETA];
    rocket->relative.gamma = x[X_GAMMA];
    rocket->relative.w_x = w[0];
    rocket->relative.w_y = w[1];
    rocket->relative.w_z = w[2];
    v3_store(rocket->exit.position, v3_add(v3_from(y + at->r), m3_apply(A_IR, pose.p1)));
    v3_store(rocket->exit.velocity, m3_apply(A_IR, pose.v_O1));
    quat q = q_from_matrix(m3_mul(A_IR, pose.A_RB));
    memcpy(rocket->exit.quaternion, &q, sizeof q);
    v3_store(rocket->exit.rate, m3_apply_transposed(pose.A_RB, pose.w_B));
    record_container(run, &input.launching.base);
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
    rocket->since_ignition = since_ignition_of(self, t, &motion);
    if (run->exit_error)
        exit_error_record(run->exit_error, run, t, y);
}

// Position of the rocket at its ignition, and the launcher's axes there.
void launch_record_ignition(ld_run *run, double t, const double *y)
{
    launch_state *self = &run->launch;
    const launching_layout *at = &self->launcher.launching.layout;
    launching_output unused;
    launching_pose pose;
    launching_rocket_pose(&self->launcher.launching, y, &pose, &unused);
    v3 r = v3_add(v3_from(y + at->r), m3_apply(q_matrix(q_from(y + at->quaternion)), pose.p1));
    launch_record_event(run, LD_EVENT_IGNITION, t, -1);
    run->point[self->current][0] = r.x;
    run->point[self->current][1] = r.z;
    launcher_input input;
    launcher_place(&self->launcher, t, y, &input);
    self->A_ignition = input.launching.base.A;
}

// Largest contact and slot forces so far.
void launch_watch_forces(ld_run *run, double t, const double *y)
{
    launch_state *self = &run->launch;
    if (!self->phase.rocket)
        return;
    ld_rocket_summary *rocket = &run->summary.rocket[self->current];
    const launcher_output *at = simulation_output(self, t, y);
    if (!at)
        return;
    const launching_output *out = &at->launching;
    for (int i = 0; i < self->launcher.launching.adaptors.count; i++)
        if (!self->phase.passed[i])
            rocket->max_contact_force[i] =
                fmax(rocket->max_contact_force[i], out->adaptor[i].force);
    rocket->max_slot_force = fmax(rocket->max_slot_force, fabs(out->N));
    if (model_has_pressure(self->model))
        rocket->max_pressure = fmax(rocket->max_pressure, out->pressure);
    if (self->phase.locked)
        run->greatest_lock_force = fmax(run->greatest_lock_force, out->lock_force);
}

void launch_watch_recoil(ld_run *run, double t, const double *y)
{
    launch_state *self = &run->launch;
    int slides = model_slide_count(self->model);
    double *most = run->summary.rocket[self->current].max_recoil;
    if (slides == 0)
        return;
    const launcher_output *at = simulation_output(self, t, y);
    for (int i = 0; i < slides && at; i++)
        most[i] = fmax(most[i], at->launching.slide[i].travel);
}

static void watch_station(const guide_load *load, double since, ld_station_summary *peak)
{
    if (!(load->bending <= peak->bending)) {
        peak->bending = load->bending;
        peak->t_bending = since;
    }
    peak->shear = fmax(peak->shear, hypot(load->wrench.f.y, load->wrench.f.z));
    peak->torque = fmax(peak->torque, fabs(load->wrench.m.x));
    peak->stress = fmax(peak->stress, load->stress);
}

void launch_watch_loads(ld_run *run, double t, const double *y)
{
    const launch_state *self = &run->launch;
    const ld_tubes *tubes = model_tubes(self->model);
    launcher_input input;
    launcher_output out;
    launching_loads loads;
    if (tubes->station_count == 0)
        return;
    simulation_input(self, t, y, &input);
    if (simulation_loads(self, &input, y, &out, &loads))
        return;
    ld_rocket_summary *rocket = &run->summary.rocket[self->current];
    for (int i = 0; i < tubes->station_count; i++)
        watch_station(&loads.station[i], t - self->t_ignition, &rocket->station[i]);
    for (int i = 0; i < tubes->support_count; i++) {
        ld_support_summary *peak = &rocket->support[i];
        peak->force = fmax(peak->force, v3_norm(loads.support[i].f));
        peak->moment = fmax(peak->moment, v3_norm(loads.support[i].m));
    }
}

void launch_watch_hinge(hinge_watch *watch, double since, const hinge_report *hinge,
                        ld_hinge_summary *held)
{
    double power = fabs(hinge->torque * hinge->rate), torque = hinge->torque;
    const double now[] = {hinge->error * hinge->error, torque * torque, power, hinge->limited};
    bool begins = isnan(watch->since);
    double step = begins ? since : since - watch->since;
    for (int k = 0; k < 4; k++) {
        watch->sum[k] += 0.5 * step * ((begins ? now[k] : watch->latest[k]) + now[k]);
        watch->latest[k] = now[k];
    }
    watch->since = since;
    held->torque_peak = fmax(held->torque_peak, fabs(torque));
    held->power_peak = fmax(held->power_peak, power);
    held->saturated = watch->sum[3];
    if (since > 0) {
        held->error_rms = sqrt(watch->sum[0] / since);
        held->torque_rms = sqrt(watch->sum[1] / since);
        held->power_mean = watch->sum[2] / since;
    }
}

void launch_watch_hinges(ld_run *run, double t, const double *y)
{
    launch_state *self = &run->launch;
    double since = t - self->t_ignition;
    if (!base_is_vehicle(&self->launcher.base) || !self->phase.rocket || self->phase.passed[0] ||
        !(since >= 0))
        return;
    const launcher_output *at = simulation_output(self, t, y);
    for (int i = 0; i < model_hinge_count(self->model) && at; i++)
        launch_watch_hinge(&run->watch[i], since, &at->base.report.mechanism.report.hold[i],
                           &run->summary.rocket[self->current].hinge[i]);
}

void launch_energy_at(const launch_state *self, double t, const double *y, double energy_start,
                      ld_energy *energy)
{
    launcher_input input;
    launcher_output out = {0};
    simulation_input(self, t, y, &input);
    launcher_evaluate(&self->launcher, &input, &self->phase, y, &out);
    simulation_energy(self, &input, &out, y, energy_start, energy);
}

static void note_formulation(const launch_state *self, ld_summary *summary)
{
    if (model_run(self->model)->formulation != LD_FORMULATION_OVERALL)
        return;
    summary_note(summary, "overall form: condition of the tube's transfer matrix up to %.2g",
                 self->worst_condition);
    if (self->fallbacks)
        summary_note(summary,
                     "overall form: %lld of %lld evaluations fell back on the reduced form",
                     (long long)self->fallbacks, (long long)summary->statistics.rhs_evaluations);
}

// [mm, mrad]
static double printed_milli(double value)
{
    return printed_fixed(1e3 * value, 3);
}

static void note_rests(ld_summary *summary)
{
    const double *taken = summary->equilibrium.taken, *other = summary->equilibrium.other;
    if (summary->equilibrium.rests_elsewhere)
        summary_note(
            summary,
            "the rocket has more than one equilibrium in its guide: the run begins with its "
            "rear at y, z = %.3f, %.3f mm, turned by psi, theta = %.3f, %.3f mrad; another "
            "is %.3f, %.3f mm, %.3f, %.3f mrad",
            printed_milli(taken[0]), printed_milli(taken[1]), printed_milli(taken[2]),
            printed_milli(taken[3]), printed_milli(other[0]), printed_milli(other[1]),
            printed_milli(other[2]), printed_milli(other[3]));
}

static void note_base(const launch_state *self, ld_summary *summary)
{
    const base_dynamics *dynamics = self->launcher.base.kind->dynamics;
    char text[256] = "";
    if (dynamics && dynamics->note_rest && model_run(self->model)->start == LD_START_EQUILIBRIUM)
        dynamics->note_rest(&self->launcher.base, text, sizeof text);
    if (text[0])
        summary_note(summary, "%s", text);
}

static void note_measure(ld_run *run, int rocket, const ld_measure *measure)
{
    const char *guide = model_guide_word(run->launch.model);
    int tube = run->summary.rocket[rocket].tube;
    if (measure->take == LD_TAKE_EXPRESSION)
        summary_note(&run->summary,
                     "measure.%s of %s %d has no value: a result in it is missing, or it is not "
                     "defined",
                     measure->name, guide, tube);
    else
        summary_note(&run->summary,
                     "measure.%s of %s %d has no value: its window did not occur, or %s is missing "
                     "in a part of it",
                     measure->name, guide, tube, measure->of);
}

// Of a launch that came to its end, the first measure that has no value.
static void note_measures(ld_run *run)
{
    const ld_model *model = run->launch.model;
    for (int i = 0; i < run->summary.rocket_count && run->summary.complete; i++)
        for (int k = 0; k < model_measure_count(model); k++)
            if (isnan(run->summary.rocket[i].measure[k])) {
                note_measure(run, i, model_measure(model, k));
                return;
            }
}

// Of the first rocket that leaves near the vertical.
static void note_vertical(const ld_model *model, ld_summary *summary)
{
    for (int i = 0; i < summary->rocket_count; i++)
        if (near_vertical(summary->rocket[i].pitch)) {
            summary_note(summary,
                         "the rocket of %s %d leaves near the vertical (pitch %.5g deg): yaw "
                         "and rates of the ground frame are not meaningful; use since_ignition",
                         model_guide_word(model), summary->rocket[i].tube,
                         summary->rocket[i].pitch * 180 / 3.14159265358979323846);
            return;
        }
}

void launch_summarise(ld_run *run)
{
    launch_state *self = &run->launch;
    ld_summary *summary = &run->summary;
    ld_status status = run->status;
    summary->complete = status == LD_OK;
    for (int i = 0; i < summary->rocket_count; i++)
        measuring_express(&self->system->measure, &summary->rocket[i]);
    if (status && !run->error.text[0])
        ld_fail(&run->error, status, "the receiver of the rows stopped the run");
    if (status)
        memcpy(summary->stopped, run->error.text, sizeof summary->stopped);
    summary->statistics.cpu_seconds = run->cpu - run->cpu_output;
    summary->statistics.cpu_seconds_setup = self->system->cpu_seconds_setup;
    summary->mode_count = ld_simulation_tube_modes(self->system, summary->mode, LD_MAX_MODES);
    if (!run->propagator)
        return;
    double t = propagator_time(run->propagator);
    summary->t_end = t;
    launch_energy_at(self, t, propagator_state(run->propagator), run->energy_start,
                     &summary->energy);
    summary->statistics.steps += propagator_steps(run->propagator);
    summary->statistics.rhs_evaluations += propagator_evaluations(run->propagator);
    note_formulation(self, summary);
    for (int i = 0; i < summary->rocket_count; i++)
        if (summary->rocket[i].t_release < 0)
            summary_note(summary, "the lock of %s %d released %.4g s before its ignition",
                         model_guide_word(self->model), summary->rocket[i].tube,
                         -summary->rocket[i].t_release);
    note_vertical(self->model, summary);
    note_measures(run);
    exit_error_note(run);
    note_rests(summary);
    note_base(self, summary);
    if (self->system->growing.real > 0)
        summary_note(summary, "a motion about the equilibrium grows by %.3g 1/s: %s",
                     self->system->growing.real, self->system->growing.shape);
}
