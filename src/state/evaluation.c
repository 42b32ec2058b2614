#include "state/evaluation.h"
#include "model/blocks/firing.h"
#include "model/parts.h"
#include "systems/launching/launching_dynamics.h"

#include <math.h>
#include <string.h>

// The air about the rocket at its mass centre.
static void find_air(const launch_state *self, double t, const double *y, launching_input *input)
{
    const launching_system *launching = &self->launcher.launching;
    v3 r = launching_rocket_point(launching, y, input->mass.c);
    double left = launching->adaptors.end[0] - y[launching->layout.x + X_S];
    input->air = flight_air_at(self->air, t, r, left);
    if (model_has_open_air(self->model))
        input->aerodynamics = &self->air->aerodynamics;
}

static moving_air air_at(const void *self, double t, v3 r)
{
    return flight_air_about(self, t, r);
}

// The tip of the guide without deflection, in I.
static v3 tip_of(const launching_system *launching, const double *y)
{
    const launching_layout *at = &launching->layout;
    v3 axis = m3_column(q_matrix(q_from(y + at->quaternion)), 0);
    return v3_axpy(v3_from(y + at->r), launching->tube.flexible.length, axis);
}

// Of the rocket that is in the guide.
static jet_source source_in_guide(const launch_state *self, const double *y, double thrust)
{
    const launching_system *launching = &self->launcher.launching;
    v3 nozzle = launching_rocket_point(launching, y, v3_zero());
    v3 ahead = launching_rocket_point(launching, y, v3_make(1, 0, 0));
    return (jet_source){nozzle, v3_sub(ahead, nozzle), {thrust, self->motor->greatest}};
}

static void find_jet(const launch_state *self, double t, const double *y, launching_input *input)
{
    const launching_system *launching = &self->launcher.launching;
    const ld_tubes *tubes = model_tubes(self->model);
    const ld_plume *plume = &self->rocket->motor.plume;
    bool inside = self->phase.rocket;
    int tube = model_firing(self->model, self->launcher.base.tube)->tube;
    jet_source from =
        inside ? source_in_guide(self, y, input->thrust) : jets_source(&self->jets, t, tube);
    m3 A = q_matrix(q_from(y + launching->layout.quaternion));
    if (!inside)
        input->jet_face = jet_on_face(tubes, plume, &from, tip_of(launching, y), A);
    if (tubes->deflector.present)
        input->deflector =
            jet_on_deflector(tubes, plume, &from, v3_from(y + launching->layout.r), A);
}

// The air about the guide, its turbulence that at the tip of the undeformed one.
static void find_air_about(const launch_state *self, double t, const double *y,
                           launching_input *input)
{
    const launching_system *launching = &self->launcher.launching;
    v3 tip = tip_of(launching, y);
    input->about = (air_about){.at = air_at,
                               .self = self->air,
                               .t = t,
                               .turbulence = flight_turbulence_past(self->air, t, tip)};
}

void simulation_surround(const launch_state *self, double t, const double *y,
                         launching_input *input)
{
    double tau = t - self->t_ignition;
    input->thrust = motor_thrust(self->motor, self->piece, tau);
    input->across = (motor_across){0};
    if (self->motor->across)
        input->across = motor_across_at(self->motor, self->piece, tau);
    input->power = self->piece + 1 < (int)self->motor->corner_count;
    input->since = tau;
    input->pressure_piece = self->pressure_piece;
    motor_mass(self->motor, self->piece, tau, &input->mass);
    for (int i = 0; i < self->launcher.launching.adaptors.count; i++)
        if (__builtin_expect(self->phase.passed[i], 0))
            rocket_mass_without(self->rocket, i, &input->mass);
    input->air = (moving_air){0};
    input->aerodynamics = NULL;
    const base_disturbance *disturbed = self->launcher.base.disturbed;
    input->load = disturbed ? &disturbed->input.launching : NULL;
    input->record = NULL;
    input->about.at = NULL;
    input->jet_face = input->deflector = (guide_push){0};
    bool blows = self->phase.rocket
                     ? input->thrust > 0 && model_tubes(self->model)->deflector.present
                     : self->jets.count > 0;
    if (blows)
        find_jet(self, t, y, input);
    if (self->air && self->phase.rocket)
        find_air(self, t, y, input);
    if (self->air && self->launcher.launching.wind.count)
        find_air_about(self, t, y, input);
}

jet_wrench simulation_jets(const launch_state *self, double t, const base_frame *tube)
{
    return jets_at(&self->jets, t, tube, model_firing(self->model, self->launcher.base.tube)->tube);
}

void simulation_input(const launch_state *self, double t, const double *y, launcher_input *input)
{
    launcher_place(&self->launcher, t, y, input);
    simulation_surround(self, t, y, &input->launching);
    input->jet = simulation_jets(self, t, &input->launching.base);
    input->rest = self->rest;
    input->held = false;
    input->formulation = model_run(self->model)->formulation;
}

launching_outcome simulation_loads(const launch_state *self, launcher_input *input, const double *y,
                                   launcher_output *out, launching_loads *loads)
{
    const launcher_system *launcher = &self->launcher;
    const ld_tubes *tubes = &launcher->launching.tubes;
    guide_forces record;
    if (tubes->station_count == 0)
        return launcher_evaluate(launcher, input, &self->phase, y, out);
    guide_forces_begin(&record, tubes->station_count, tubes->station);
    input->launching.record = &record;
    launching_outcome outcome = launcher_evaluate(launcher, input, &self->phase, y, out);
    launching_find_loads(&launcher->launching, &input->launching, y, &out->launching, loads);
    input->launching.record = NULL;
    return outcome;
}

// NaN or infinity anywhere makes the sum of 0 y not zero.
bool all_finite(int n, const double *y)
{
    double sum[4] = {0};
    int i = 0;
    for (; i + 4 <= n; i += 4)
        for (int k = 0; k < 4; k++)
            sum[k] += 0 * y[i + k];
    for (; i < n; i++)
        sum[0] += 0 * y[i];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]) == 0;
}

static void find_conditions(const launch_state *self, double t, run_conditions *conditions)
{
    memset(conditions, 0, sizeof *conditions);
    conditions->t = t;
    conditions->t_ignition = self->t_ignition;
    conditions->piece = self->piece;
    conditions->pressure_piece = self->pressure_piece;
    conditions->jets = jets_pieces(&self->jets);
    conditions->rocket = self->current;
    conditions->tube = self->launcher.base.tube;
    conditions->disturbed = self->launcher.base.disturbed;
    memcpy(&conditions->phase, &self->phase, sizeof self->phase);
    memcpy(&conditions->rest, &self->rest, sizeof self->rest);
}

// The works at the state's end count for nothing in the equations.
static size_t size_that_counts(const launch_state *self)
{
    return (size_t)self->launcher.work_at * sizeof(double);
}

// latest.out is that of state y at t.
static void keep_latest(launch_state *self, double t, const double *y)
{
    self->latest.known = true;
    find_conditions(self, t, &self->latest.at);
    memcpy(self->latest.y, y, size_that_counts(self));
}

bool simulation_is_latest(const launch_state *self, double t, const double *y)
{
    run_conditions now;
    if (!self->latest.known || self->latest.at.t != t)
        return false;
    find_conditions(self, t, &now);
    return memcmp((const char *)&now, (const char *)&self->latest.at, sizeof now) == 0 &&
           memcmp((const char *)y, (const char *)self->latest.y, size_that_counts(self)) == 0;
}

void simulation_note_outcome(launch_state *self, launching_outcome outcome)
{
    self->jammed = outcome == LAUNCHING_JAMMED;
    if (outcome || model_run(self->model)->formulation != LD_FORMULATION_OVERALL)
        return;
    const launching_output *out = &self->latest.out.launching;
    self->fallbacks += out->fell_back;
    self->worst_condition = fmax(self->worst_condition, out->condition);
}

const launcher_output *simulation_output(launch_state *self, double t, const double *y)
{
    if (!simulation_is_latest(self, t, y)) {
        launcher_input input;
        simulation_input(self, t, y, &input);
        self->latest.known = false;
        if (launcher_evaluate(&self->launcher, &input, &self->phase, y, &self->latest.out))
            return NULL;
        keep_latest(self, t, y);
    }
    return &self->latest.out;
}

int simulation_rates(launch_state *self, double t, const double *y, double *y_dot)
{
    launcher_input input;
    launcher_output *out = &self->latest.out;
    simulation_input(self, t, y, &input);
    self->latest.known = false;
    launching_outcome outcome = launcher_evaluate(&self->launcher, &input, &self->phase, y, out);
    simulation_note_outcome(self, outcome);
    if (outcome)
        return -1;
    keep_latest(self, t, y);
    launcher_rates(&self->launcher, y, out, self->phase.rocket, y_dot);
    return all_finite(self->launcher.state_count, y_dot) ? 0 : -1;
}

void simulation_project(const launch_state *self, double t, double *y)
{
    launcher_input input;
    simulation_input(self, t, y, &input);
    launching_project(&self->launcher.launching, &input.launching, &self->phase, y);
    const base_system *base = &self->launcher.base;
    if (base->drifts)
        base->kind->dynamics->project(base, t, y + self->launcher.base_at);
}
