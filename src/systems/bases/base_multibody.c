// A base of bodies, joints and force elements, which stands on the ground, on wheels or on a
// carrier that moves (mechanism.h).
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "math/functions.h"
#include "model/model.h"
#include "systems/bases/base.h"
#include "systems/bases/base_coordinates.h"
#include "systems/bases/multibody_base.h"
#include "systems/bases/multibody_rest.h"
#include "systems/mechanism/mechanism_build.h"
#include "systems/mechanism/mechanism_description.h"
#include "systems/mechanism/mechanism_evaluation.h"
#include "systems/mechanism/mechanism_joints.h"
#include "systems/mechanism/mechanism_loops.h"
#include "systems/mechanism/mechanism_motion.h"
#include "systems/mechanism/mechanism_state.h"

static const mechanism_system *mechanism_of(const base_system *self)
{
    const multibody_base *own = self->own;
    return &own->of_tube[self->tube];
}

static const marching_system *marching_of(const base_system *self)
{
    const multibody_base *own = self->own;
    return self->disturbed ? &own->level : &own->marching;
}

// ---- life

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

static ld_status build_mechanisms(multibody_base *self, ld_error *error)
{
    const ld_model *model = self->model;
    int fired[LD_MAX_FIRINGS];
    for (int i = 0; i < model->firing_count; i++) {
        fired[i] = model->firing[i].tube;
        mechanism_tubes tubes = {fired[i], i, fired};
        ld_status status = mechanism_build(&self->of_tube[i], model, &tubes, error);
        if (status)
            return status;
        self->tube_count++;
    }
    return LD_OK;
}

static ld_status build_wheels(multibody_base *self, ld_error *error)
{
    static const ld_road flat = {.iso_class = LD_ROAD_SMOOTH};
    const ld_model *model = self->model;
    double stretch[2];
    self->has_wheels = model->base.vehicle.wheel_count > 0;
    if (!self->has_wheels)
        return LD_OK;
    road_under(model, stretch);
    ld_status status = marching_build(&self->marching, &model->base.vehicle, model->gravity,
                                      stretch[0], stretch[1], error);
    if (status)
        return status;
    self->level = self->marching;
    self->level.road = NULL;
    return road_build(&flat, 0, 0, &self->level.road, error);
}

static ld_status build_air(multibody_base *self, ld_error *error)
{
    const ld_environment *environment = &self->model->environment;
    self->has_drag = self->model->base.mechanism.drag_count > 0;
    if (!self->has_drag)
        return LD_OK;
    ld_status status = atmosphere_build(&self->air, &environment->atmosphere, error);
    return status ? status : wind_build(&self->wind, &environment->wind, error);
}

// Where the marching subsystem's states begin.
static int marching_at(const base_system *self)
{
    return mechanism_of(self)->state_count;
}

static void count(base_system *base)
{
    const multibody_base *self = base->own;
    const mechanism_system *mechanism = &self->of_tube[0];
    int wheels = self->marching.wheel_count;
    int drives = mechanism->hold_count && mechanism->hold[0].drive >= 0
                     ? DRIVE_STATES * mechanism->hold_count
                     : 0;
    base->state_count = mechanism->state_count + self->marching.state_count;
    base->work_count = self->has_wheels ? MULTIBODY_POWERS : MECHANISM_POWERS;
    base->event_count = wheels + self->model->base.mechanism.foot_count;
    base->speed_at = mechanism->q_count;
    base->speed_count = mechanism->u_count;
    base->displacement_count = mechanism->freedom_count + 3 * wheels;
    base->drifts = ld_mstmm_loop_count(mechanism->chain) > 0;
    base->extra_count = mechanism->hold_count + drives +
                        2 * self->model->base.mechanism.foot_count +
                        (self->has_wheels ? 2 * wheels + 1 : 0);
}

static void name_holders(multibody_base *self)
{
    const mechanism_system *mechanism = &self->of_tube[0];
    for (int i = 0; i < mechanism->hold_count; i++) {
        const mechanism_hold *hold = &mechanism->hold[i];
        snprintf(self->holder[i], sizeof self->holder[i],
                 hold->strut >= 0 ? "base.struts.%.60s.actuator"
                 : hold->control  ? "base.drives.%.60s"
                                  : "base.joints.%.60s.lock",
                 hold->name);
    }
}

// The bodies as the scenario gives them and loops leave them, in the state; what is counted from
// there.
static ld_status begin(base_system *base, double *state, ld_error *error)
{
    multibody_base *self = base->own;
    double t = -self->model->run.lead_in;
    base_frame carrier = multibody_carrier(base, t);
    for (int i = self->tube_count - 1; i >= 0; i--) {
        mechanism_system *mechanism = &self->of_tube[i];
        mechanism_start(mechanism, state);
        int rolling = mechanism_rolling(mechanism);
        if (rolling >= 0)
            state[ld_mstmm_coordinate_offset(mechanism->chain, mechanism->wheels)] +=
                self->model->base.vehicle.speed * t;
        ld_status status = mechanism_assemble(mechanism, &carrier, state, error);
        if (!status)
            status = mechanism_find_freedoms(mechanism, &carrier, state, error);
        if (status)
            return status;
        mechanism_complete(mechanism, &carrier, state);
        status = mechanism_check_struts(mechanism, &carrier, state, error);
        if (status)
            return status;
    }
    return LD_OK;
}

// Wheels at their mounts.
static void mount_wheels(const base_system *base, double *state)
{
    const multibody_base *self = base->own;
    const mechanism_system *mechanism = &self->of_tube[0];
    base_frame tube;
    base_found found;
    if (!self->has_wheels)
        return;
    base->kind->find_frame(base, -self->model->run.lead_in, state, &tube, &found);
    const body_motion *body = &found.multibody.body[mechanism->wheels];
    base_frame chassis = {.r = body->r, .A = body->A};
    marching_place(&self->marching, &chassis, state + mechanism->state_count);
}

static ld_status build(base_system *base, ld_error *error)
{
    multibody_base *self = calloc(1, sizeof *self);
    if (!self)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the base's bodies");
    base->own = self;
    self->model = base->model;
    ld_status status = prescribed_motion_build(&self->carrier, base->model, error);
    if (!status)
        status = build_mechanisms(self, error);
    if (!status)
        status = build_wheels(self, error);
    if (!status)
        status = build_air(self, error);
    if (status)
        return status;
    name_holders(self);
    self->rest = calloc(BASE_MOST_STATES, sizeof *self->rest);
    if (!self->rest)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the base's bodies");
    status = begin(base, self->rest, error);
    if (status)
        return status;
    count(base);
    mount_wheels(base, self->rest);
    status = multibody_rest_find(base, error);
    base->freedom_count =
        self->freedom_count + self->of_tube[0].hold_count + 3 * self->marching.wheel_count;
    return status;
}

static void release(base_system *base)
{
    multibody_base *self = base->own;
    if (!self)
        return;
    for (int i = 0; i < self->tube_count; i++)
        mechanism_free(&self->of_tube[i]);
    if (!self->shared) {
        road_free(self->marching.road);
        road_free(self->level.road);
        prescribed_motion_free(&self->carrier);
        if (self->has_drag) {
            atmosphere_free(&self->air);
            wind_free(&self->wind);
        }
        free(self->rest);
    }
    free(self);
}

// The chains are workspaces, too.
static ld_status share(base_system *base, ld_error *error)
{
    const multibody_base *of = base->own;
    multibody_base *self = base->own = malloc(sizeof *self);
    if (!self)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the base's bodies");
    *self = *of;
    self->shared = true;
    self->tube_count = 0;
    for (int i = 0; i < of->tube_count; i++) {
        ld_status status = ld_mstmm_copy(of->of_tube[i].chain, &self->of_tube[i].chain, error);
        if (status)
            return status;
        self->tube_count++;
    }
    return LD_OK;
}

// ---- motion

static void find_frame(const base_system *self, double t, const double *state, base_frame *tube,
                       base_found *found)
{
    base_frame carrier = multibody_carrier(self, t);
    mechanism_move(mechanism_of(self), t, &carrier, state, &found->multibody);
    *tube = found->multibody.tube;
}

static void span(const base_system *base, double *first, double *last)
{
    const multibody_base *self = base->own;
    prescribed_motion_span(&self->carrier, first, last);
}

static double next_corner(const base_system *base, double t)
{
    const multibody_base *self = base->own;
    double next = mechanism_next_corner(mechanism_of(base), t);
    return self->has_drag ? fmin(next, wind_next_corner(&self->wind, t)) : next;
}

static double next_sample(const base_system *self, double t)
{
    return mechanism_next_sample(mechanism_of(self), t);
}

static void sample(const base_system *self, double t, double *state)
{
    base_frame carrier = multibody_carrier(self, t);
    mechanism_motion motion;
    mechanism_move(mechanism_of(self), t, &carrier, state, &motion);
    mechanism_sample(mechanism_of(self), &motion, state);
}

// Density of the air and its velocity in I about the bodies, as at the tube's rear end.
static void find_air(const multibody_base *self, const mechanism_motion *motion,
                     mechanism_input *input)
{
    const ld_site *site = &self->model->environment.site;
    double height = motion->tube.r.y, altitude = height + (site->present ? site->altitude : 0);
    if (!self->has_drag)
        return;
    input->density = atmosphere_at(&self->air, altitude).density;
    if (!self->wind.present)
        return;
    v3 flow = wind_at(&self->wind, motion->t, self->wind.geographic ? altitude : height);
    double s, c;
    sincos(site->azimuth, &s, &c);
    // north, up, east; x of I goes along the azimuth
    input->wind = self->wind.geographic
                      ? v3_make(c * flow.x + s * flow.z, flow.y, c * flow.z - s * flow.x)
                      : flow;
}

// The wheels under their body; its wrench on it.
static void roll(const base_system *self, const base_load *load, const mechanism_motion *motion,
                 const double *state, base_output *output, mechanism_input *input)
{
    const multibody_base *own = self->own;
    const mechanism_system *mechanism = mechanism_of(self);
    const base_disturbance *disturbed = self->disturbed;
    road_disturbance ground = {disturbed ? disturbed->input.road : NULL,
                               disturbed ? disturbed->rate.road : NULL};
    marching_output *marching = &output->report.multibody.marching;
    if (!own->has_wheels)
        return;
    const body_motion *body = &motion->body[mechanism->wheels];
    base_frame chassis = {.r = body->r, .v = body->v, .A = body->A, .w = body->w};
    int at = marching_at(self);
    marching_evaluate(marching_of(self), &chassis, load->held, disturbed ? &ground : NULL,
                      state + at, output->rate + at, marching);
    input->wheel_force = marching->force;
    input->wheel_moment = marching->moment;
    memcpy(output->power + MECHANISM_POWERS, marching->power, sizeof marching->power);
    output->elastic += marching->elastic;
    for (int j = 0; j < own->marching.wheel_count; j++)
        output->event[j] = marching->wheel[j].deflection;
}

static int evaluate(const base_system *self, const base_found *found, const base_load *load,
                    const double *state, base_output *output)
{
    const multibody_base *own = self->own;
    const mechanism_motion *motion = &found->multibody;
    mechanism_input input = {
        .tube_force = v3_add(load->force, load->jet.force),
        .tube_moment = v3_add(load->moment, load->jet.moment),
        .rest = load->rest.hold,
        .held = load->held,
        .linear = load->linear || self->disturbed,
    };
    mechanism_output *of = &output->report.multibody.mechanism;
    if (self->disturbed) {
        const base_inputs *outside = &self->disturbed->input;
        input.tube_force = v3_add(input.tube_force, outside->tube_force);
        input.tube_moment = v3_add(input.tube_moment, outside->tube_moment);
    }
    output->elastic = 0;
    roll(self, load, motion, state, output, &input);
    find_air(own, motion, &input);
    int outcome = mechanism_evaluate(mechanism_of(self), &input, state, motion, output->rate, of);
    memcpy(output->power, of->power, sizeof of->power);
    output->elastic += of->elastic;
    for (int i = 0; i < own->model->base.mechanism.foot_count; i++)
        output->event[own->marching.wheel_count + i] = of->report.foot[i].deflection;
    return outcome;
}

static double kinetic_energy(const base_system *self, const base_found *found, const double *state)
{
    const multibody_base *own = self->own;
    const mechanism_motion *motion = &found->multibody;
    double sum = ld_mstmm_energy(mechanism_of(self)->chain, motion->q, motion->u).kinetic;
    if (own->has_wheels)
        sum += marching_kinetic_energy(marching_of(self), state + marching_at(self));
    return sum;
}

static void tolerances(const base_system *self, double tolerance, double *atol, bool *absolute)
{
    const multibody_base *own = self->own;
    int at = marching_at(self);
    double *wheel = atol + at;
    mechanism_tolerances(mechanism_of(self), tolerance, atol, absolute);
    if (!own->has_wheels)
        return;
    for (int j = 0; j < own->marching.wheel_count; j++, wheel += WHEEL_STATES)
        for (int i = 0; i < WHEEL_STATES; i++) {
            bool speed = i >= WHEEL_V && i < WHEEL_V + 3;
            wheel[i] = speed ? tolerance : 1e-2 * tolerance;
            absolute[wheel + i - atol] = i < WHEEL_V;
        }
    *wheel = tolerance;
}

// Each wheel is one; the drive is with the bodies.
static int part_of(const base_system *self, int state)
{
    const multibody_base *own = self->own;
    int wheel = (state - marching_at(self)) / WHEEL_STATES;
    bool of_wheel = state >= marching_at(self) && wheel < own->marching.wheel_count;
    return of_wheel ? wheel + 1 : 0;
}

static void project(const base_system *self, double t, double *state)
{
    base_frame carrier = multibody_carrier(self, t);
    mechanism_project(mechanism_of(self), &carrier, state);
}

static void set_start_velocity(const base_system *self, double *state)
{
    const multibody_base *own = self->own;
    const mechanism_system *mechanism = mechanism_of(self);
    double speed = own->model->base.vehicle.speed;
    mechanism_set_off(mechanism, state);
    if (!self->disturbed) // linearised, it is at rest
        mechanism_start_speeds(mechanism, state);
    project(self, -own->model->run.lead_in, state);
    if (!own->has_wheels || !(speed > 0))
        return;
    // the body on the wheels hangs on the ground by a free joint, whose first speed is along x
    state[mechanism->q_count + ld_mstmm_speed_offset(mechanism->chain, mechanism->wheels)] = speed;
    for (int j = 0; j < own->marching.wheel_count; j++)
        state[marching_at(self) + WHEEL_STATES * j + WHEEL_V] = speed;
}

// ---- equilibrium

static void guess(const base_system *self, double tube, double rocket, double *state)
{
    (void)tube, (void)rocket;
    const multibody_base *own = self->own;
    memcpy(state, own->rest, (size_t)self->state_count * sizeof *state);
}

// Unknowns: displacements that something holds, torques of holds, wheel positions.
static void displace(const base_system *self, int freedom, double change, double *state)
{
    const multibody_base *own = self->own;
    const mechanism_system *mechanism = mechanism_of(self);
    int hold = freedom - own->freedom_count, k = hold - mechanism->hold_count;
    if (hold < 0)
        mechanism_settle(mechanism, own->freedom[freedom], change, state);
    else if (k < 0)
        state[mechanism->z_at + hold] += 1e6 * change; // held torque
    else
        state[marching_at(self) + WHEEL_STATES * (k / 3) + WHEEL_R + k % 3] += change;
    base_frame carrier = multibody_carrier(self, -own->model->run.lead_in);
    mechanism_plant(mechanism, &carrier, state);
}

// Locked joints keep their equilibrium; the others begin with the integral that holds it.
static void rest_of(const base_system *self, const double *state, base_rest *rest)
{
    const mechanism_system *mechanism = mechanism_of(self);
    for (int i = 0; i < mechanism->hold_count; i++) {
        const mechanism_hold *hold = &mechanism->hold[i];
        rest->hold[i] = (hold_rest){.angle = hold->strut < 0 ? state[hold->q] : 0,
                                    .torque = state[mechanism->z_at + i]};
    }
}

// Accelerations but those that are neutral, and the errors of holds.
static void residual(const base_system *self, const base_output *output, double *r)
{
    const multibody_base *own = self->own;
    const mechanism_system *mechanism = mechanism_of(self);
    const double *rate = output->rate, *wheel = rate + marching_at(self);
    for (int i = 0; i < own->freedom_count; i++)
        *r++ = rate[mechanism->q_count + mechanism->freedom[own->freedom[i]]];
    for (int i = 0; i < mechanism->hold_count; i++)
        *r++ = output->report.multibody.mechanism.report.hold[i].error;
    for (int j = 0; j < own->marching.wheel_count; j++, wheel += WHEEL_STATES)
        for (int i = 0; i < 3; i++)
            *r++ = wheel[WHEEL_V + i];
}

static ld_status report_no_rest(double smallest, ld_error *error)
{
    return ld_fail(
        error, LD_ERR_NUMERIC,
        "base: its bodies find no static equilibrium (smallest residual %.3g m/s2): does "
        "something hold each of them, and is the mass centre between wheels or feet?",
        smallest);
}

// Whether everything that must stand on the ground does.
static ld_status check_wheels(const base_system *self, const base_found *found, const double *state,
                              ld_error *error)
{
    const multibody_base *own = self->own;
    const body_motion *body = &found->multibody.body[mechanism_of(self)->wheels];
    base_frame chassis = {.r = body->r, .v = body->v, .A = body->A, .w = body->w};
    marching_output marching;
    double unused[WHEEL_STATES * LD_MAX_WHEELS + 1];
    marching_evaluate(marching_of(self), &chassis, true, NULL, state + marching_at(self), unused,
                      &marching);
    for (int j = 0; j < own->marching.wheel_count; j++)
        if (!(marching.wheel[j].normal > 0))
            return ld_fail(
                error, LD_ERR_INPUT,
                "base.wheels.%d: wheel \"%s\" does not reach the ground at the start: in "
                "equilibrium it hangs %.3g m above the road",
                j + 1, own->model->base.vehicle.wheel[j].name,
                fmax(0, -marching.wheel[j].deflection));
    return LD_OK;
}

static ld_status check_rest(const base_system *self, const base_found *found, const double *state,
                            ld_error *error)
{
    const multibody_base *own = self->own;
    const mechanism_system *mechanism = mechanism_of(self);
    for (int i = 0; i < mechanism->hold_count; i++) {
        const mechanism_hold *hold = &mechanism->hold[i];
        double torque = state[mechanism->z_at + i];
        if (!hold->lock && hold->control && fabs(torque) > hold->control->torque_limit)
            return ld_fail(error, LD_ERR_INPUT,
                           "%s: holding it at the start takes %.6g N m (N), more than its limit of "
                           "%.6g",
                           own->holder[i], torque, hold->control->torque_limit);
    }
    return own->has_wheels ? check_wheels(self, found, state, error) : LD_OK;
}

static ld_status check_held(const base_system *self, ld_error *error)
{
    const multibody_base *own = self->own;
    const mechanism_system *mechanism = mechanism_of(self);
    if (own->falling < 0)
        return LD_OK;
    mechanism_axis axis = mechanism_axis_of(mechanism, own->falling);
    return ld_fail(
        error, LD_ERR_INPUT,
        "base.joints.%s: no static equilibrium: nothing holds \"%s\", which would start "
        "with %.3g %s; add a spring, a lock or a drive, or use \"run.start: undeformed\"",
        axis.joint->name, axis.joint->body, own->falls_with, axis.turns ? "rad/s2" : "m/s2");
}

static void note_rest(const base_system *self, char *text, size_t size)
{
    const multibody_base *own = self->own;
    const mechanism_moved *moved = &own->moved;
    const double degree = 0.017453292519943295;
    text[0] = 0;
    if (moved->joint)
        snprintf(text, size,
                 "joint %s: its equilibrium, in which the run starts, is %.3g %s from where the "
                 "scenario places \"%s\"",
                 moved->joint->name, moved->turns ? moved->by / degree : moved->by,
                 moved->turns ? "deg" : "m", moved->joint->body);
}

// ---- linearised

// Displacements: those in the sense of the independent speeds, then wheel positions.
static void displace_slightly(const base_system *self, int displacement, double change,
                              double *state)
{
    const mechanism_system *mechanism = mechanism_of(self);
    int k = displacement - mechanism->freedom_count;
    if (k < 0)
        mechanism_displace_freedom(mechanism, displacement, change, state);
    else
        state[marching_at(self) + WHEEL_STATES * (k / 3) + WHEEL_R + k % 3] += change;
}

static int speed_of(const base_system *self, int displacement)
{
    const mechanism_system *mechanism = mechanism_of(self);
    int k = displacement - mechanism->freedom_count;
    return k < 0 ? mechanism->q_count + mechanism->freedom[displacement]
                 : marching_at(self) + WHEEL_STATES * (k / 3) + WHEEL_V + k % 3;
}

static void quicken(const base_system *self, int displacement, double change, double *state)
{
    const mechanism_system *mechanism = mechanism_of(self);
    if (displacement < mechanism->freedom_count)
        mechanism_quicken_freedom(mechanism, displacement, change, state);
    else
        state[speed_of(self, displacement)] += change;
}

// The holds' integrals, then what their drives have; the feet; eta and xi of each wheel, the
// drive's integral.
static int extra_of(const base_system *self, int extra)
{
    const mechanism_system *mechanism = mechanism_of(self);
    bool drives = mechanism->hold_count && mechanism->hold[0].drive >= 0;
    int own = mechanism->hold_count * (1 + (drives ? DRIVE_STATES : 0));
    int feet = 2 * mechanism->given->foot_count;
    if (extra < own)
        return mechanism->z_at + extra;
    if (extra < own + feet)
        return mechanism->feet_at + extra - own;
    int k = extra - own - feet, wheels = marching_of(self)->wheel_count;
    if (k < 2 * wheels)
        return marching_at(self) + WHEEL_STATES * (k / 2) + WHEEL_ETA + k % 2;
    return marching_at(self) + WHEEL_STATES * wheels;
}

static int hold_of(const mechanism_system *mechanism, int displacement)
{
    for (int i = 0; i < mechanism->hold_count; i++)
        if (mechanism->hold[i].strut < 0 && displacement < mechanism->freedom_count &&
            mechanism->hold[i].u == mechanism->freedom[displacement])
            return i;
    return -1;
}

static const char *holder_of(const base_system *self, int displacement)
{
    const multibody_base *own = self->own;
    int hold = hold_of(mechanism_of(self), displacement);
    return hold < 0 ? NULL : own->holder[hold];
}

static double held_by(const base_system *self, const base_output *output, int displacement)
{
    int hold = hold_of(mechanism_of(self), displacement);
    return hold < 0 ? 0 : output->report.multibody.mechanism.report.hold[hold].torque;
}

// What moves: the body that a joint carries, or all wheels in a direction.
enum { WHEEL_GROUPS = LD_MAX_BODIES + LD_MAX_BEAMS };

static const char *group_name(const base_system *self, int group)
{
    static const char *const wheels[] = {"wheels, along", "wheels, hop", "wheels, across"};
    const ld_mechanism *given = mechanism_of(self)->given;
    if (group >= WHEEL_GROUPS)
        return wheels[group - WHEEL_GROUPS];
    return group < given->body_count ? given->body[group].name
                                     : given->beam[group - given->body_count].name;
}

static double inertia_of(const base_system *self, int displacement, int *group)
{
    const mechanism_system *mechanism = mechanism_of(self);
    int k = displacement - mechanism->freedom_count;
    if (k >= 0) {
        *group = WHEEL_GROUPS + k % 3;
        return self->model->base.vehicle.wheel[k / 3].mass;
    }
    const multibody_base *own = self->own;
    return mechanism_inertia(mechanism, own->rest, mechanism->freedom[displacement], group);
}

static const base_dynamics dynamics = {
    .evaluate = evaluate,
    .kinetic_energy = kinetic_energy,
    .tolerances = tolerances,
    .set_start_velocity = set_start_velocity,
    .project = project,
    .part_of = part_of,
    .guess = guess,
    .displace = displace,
    .rest_of = rest_of,
    .residual = residual,
    .check_rest = check_rest,
    .report_no_rest = report_no_rest,
    .check_held = check_held,
    .note_rest = note_rest,
    .displace_slightly = displace_slightly,
    .speed_of = speed_of,
    .quicken = quicken,
    .extra_of = extra_of,
    .inertia_of = inertia_of,
    .group_name = group_name,
    .holder_of = holder_of,
    .held_by = held_by,
};

// ---- quantities

#define EACH(array, member) .at = QUANTITY_OF_EACH(multibody_instant, array, member)
#define EACH_OF(array) .at = QUANTITY_EACH_OF(multibody_instant, array)
#define AT(member) .at = QUANTITY_AT(multibody_instant, member)

// clang-format off
#define OF_BODY(array, what)                                                                       \
    {what ".%s.x", "m", what " %s: origin in I", EACH(array, r[0])},                               \
    {what ".%s.y", "m", what " %s: origin in I", EACH(array, r[1])},                               \
    {what ".%s.z", "m", what " %s: origin in I", EACH(array, r[2])},                               \
    {what ".%s.yaw", "rad", what " %s: yaw of Ry(yaw) Rz(pitch) Rx(roll)", EACH(array, angles[0])},\
    {what ".%s.pitch", "rad", what " %s: pitch", EACH(array, angles[1])},                          \
    {what ".%s.roll", "rad", what " %s: roll", EACH(array, angles[2])},                            \
    {what ".%s.vx", "m/s", what " %s: velocity of its origin in I", EACH(array, v[0])},            \
    {what ".%s.vy", "m/s", what " %s: velocity of its origin in I", EACH(array, v[1])},            \
    {what ".%s.vz", "m/s", what " %s: velocity of its origin in I", EACH(array, v[2])},            \
    {what ".%s.wx", "rad/s", what " %s: angular velocity in its own axes", EACH(array, w[0])},     \
    {what ".%s.wy", "rad/s", what " %s: angular velocity in its own axes", EACH(array, w[1])},     \
    {what ".%s.wz", "rad/s", what " %s: angular velocity in its own axes", EACH(array, w[2])}
static const quantity of_bodies[] = {OF_BODY(body, "body")};
static const quantity of_beams[] = {OF_BODY(beam, "beam")};
static const quantity of_beam_coordinates[] = {
    {"beam.%s", "kg0.5.m", "modal coordinate %s (bending y, z, torsion, axial)", EACH_OF(coordinate)},
};
static const quantity of_carrier[] = {
    {"carrier.x", "m", "carrier: origin in I", AT(carrier.r[0])},
    {"carrier.y", "m", "carrier: origin in I", AT(carrier.r[1])},
    {"carrier.z", "m", "carrier: origin in I", AT(carrier.r[2])},
    {"carrier.yaw", "rad", "carrier: yaw of Ry(yaw) Rz(pitch) Rx(roll)", AT(carrier.angles[0])},
    {"carrier.pitch", "rad", "carrier: pitch", AT(carrier.angles[1])},
    {"carrier.roll", "rad", "carrier: roll", AT(carrier.angles[2])},
};
static const quantity of_turns[] = {
    {"joint.%s.angle", "rad", "joint %s: angle", EACH(turn, state[0])},
    {"joint.%s.rate", "rad/s", "joint %s: rate of the angle", EACH(turn, state[1])},
    {"joint.%s.friction", "N.m", "joint %s: friction", EACH(turn, friction)},
};
static const quantity of_slides[] = {
    {"joint.%s.displacement", "m", "joint %s: displacement", EACH(slide, state[0])},
    {"joint.%s.speed", "m/s", "joint %s: rate of the displacement", EACH(slide, state[1])},
    {"joint.%s.resistance", "N", "joint %s: friction", EACH(slide, friction)},
};
static const quantity of_joints[] = {
    {"joint.%s.fx", "N", "joint %s: force on its body along x of I, springs, friction and drives included", EACH(joint, force.x)},
    {"joint.%s.fy", "N", "joint %s: force on its body along y of I", EACH(joint, force.y)},
    {"joint.%s.fz", "N", "joint %s: force on its body along z of I", EACH(joint, force.z)},
    {"joint.%s.mx", "N.m", "joint %s: moment on its body about the joint's position, x of I", EACH(joint, moment.x)},
    {"joint.%s.my", "N.m", "joint %s: moment on its body, y of I", EACH(joint, moment.y)},
    {"joint.%s.mz", "N.m", "joint %s: moment on its body, z of I", EACH(joint, moment.z)},
};
static const quantity of_drives[] = {
    {"drive.%s.measured", "1", "drive %s: angle [rad] or length [m] that it follows", EACH(drive, measured)},
    {"drive.%s.command", "1", "drive %s: commanded angle [rad] or length [m]", EACH(drive, command)},
    {"drive.%s.error", "1", "drive %s: command minus measured", EACH(drive, error)},
    {"drive.%s.torque", "1", "drive %s: torque [N m] or force [N] of drive or lock", EACH(drive, torque)},
};
static const quantity of_struts[] = {
    {"strut.%s.length", "m", "strut %s: distance of its ends", EACH(strut, spring.length)},
    {"strut.%s.rate", "m/s", "strut %s: rate of that", EACH(strut, spring.rate)},
    {"strut.%s.force", "N", "strut %s: force of spring and damper, pushing", EACH(strut, spring.force)},
    {"strut.%s.push", "N", "strut %s: force of its actuator, pushing", EACH(strut, push)},
};
static const quantity of_feet[] = {
    {"foot.%s.deflection", "m", "foot %s: depth in the ground", EACH(foot, deflection)},
    {"foot.%s.fx", "N", "foot %s: force of the ground on it along x of I", EACH(foot, force.x)},
    {"foot.%s.fy", "N", "foot %s: vertical force", EACH(foot, force.y)},
    {"foot.%s.fz", "N", "foot %s: force along z of I", EACH(foot, force.z)},
};
static const quantity of_bushings[] = {
    {"bushing.%s.fx", "N", "bushing %s: force on `to` along its x", EACH(bushing, x)},
    {"bushing.%s.fy", "N", "bushing %s: force on `to` along its y", EACH(bushing, y)},
    {"bushing.%s.fz", "N", "bushing %s: force on `to` along its z", EACH(bushing, z)},
};
static const quantity of_marching[] = {
    {"drive.speed", "m/s", "speed of the chassis along its heading", AT(marching.speed)},
    {"drive.force", "N", "drive force of all driven wheels", AT(marching.drive_force)},
};
static const quantity of_wheels[] = {
    {"wheel.%s.x", "m", "wheel %s: centre in I", EACH(wheel, r[0])},
    {"wheel.%s.y", "m", "wheel %s: centre in I", EACH(wheel, r[1])},
    {"wheel.%s.z", "m", "wheel %s: centre in I", EACH(wheel, r[2])},
    {"wheel.%s.road", "m", "wheel %s: height of the road under it", EACH(marching.wheel, height)},
    {"wheel.%s.travel", "m", "wheel %s: suspension travel along the chassis' y, from unloaded", EACH(marching.wheel, travel.y)},
    {"wheel.%s.deflection", "m", "wheel %s: tyre deflection", EACH(marching.wheel, deflection)},
    {"wheel.%s.tyre_force", "N", "wheel %s: vertical tyre force", EACH(marching.wheel, normal)},
    {"wheel.%s.along", "N", "wheel %s: tyre force along the way", EACH(marching.wheel, along)},
    {"wheel.%s.side", "N", "wheel %s: tyre force across the way", EACH(marching.wheel, side)},
};
static const quantity_group quantity_groups[] = {
    {.title = "each body", .each = EACH_BODY, QUANTITY_ROWS(of_bodies)},
    {.title = "each beam", .each = EACH_BEAM, QUANTITY_ROWS(of_beams)},
    {.title = "each modal coordinate of a beam", .each = EACH_BEAM_COORDINATE, QUANTITY_ROWS(of_beam_coordinates)},
    {.title = "carrier, where something stands on it", .each = EACH_CARRIER, QUANTITY_ROWS(of_carrier)},
    {.title = "each joint that turns about one axis", .each = EACH_TURN, QUANTITY_ROWS(of_turns)},
    {.title = "each joint that slides along one axis", .each = EACH_SLIDER, QUANTITY_ROWS(of_slides)},
    {.title = "each joint", .each = EACH_JOINT, QUANTITY_ROWS(of_joints)},
    {.title = "each drive of a joint", .each = EACH_DRIVE, QUANTITY_ROWS(of_drives)},
    {.title = "each strut", .each = EACH_STRUT, QUANTITY_ROWS(of_struts)},
    {.title = "each foot", .each = EACH_FOOT, QUANTITY_ROWS(of_feet)},
    {.title = "each bushing", .each = EACH_BUSHING, QUANTITY_ROWS(of_bushings)},
    {.title = "drive of a multibody base on wheels", .each = EACH_ROLLING, QUANTITY_ROWS(of_marching)},
    {.title = "each wheel of a multibody base", .each = EACH_ROLLER, QUANTITY_ROWS(of_wheels)},
};
// clang-format on

static const quantity_table quantities = {quantity_groups,
                                          sizeof quantity_groups / sizeof *quantity_groups};

// clang-format off
#define INPUT(member) .at = QUANTITY_AT(base_inputs, member)
#define INPUT_OF(array) .at = QUANTITY_EACH_OF(base_inputs, array)
static const quantity roads[] = {
    {"wheel.%s.road", "m", "height of the road under wheel %s", INPUT_OF(road)},
};
static const quantity forces[] = {
    {"platform.force_x", "N", "force on what carries the tube at its rear end, along the tube", INPUT(tube_force.x)},
    {"platform.force_y", "N", "the same upwards from it", INPUT(tube_force.y)},
    {"platform.force_z", "N", "the same to its right", INPUT(tube_force.z)},
    {"platform.moment_x", "N.m", "moment on what carries the tube about the tube's x axis", INPUT(tube_moment.x)},
    {"platform.moment_y", "N.m", "moment on what carries the tube about the tube's y axis", INPUT(tube_moment.y)},
    {"platform.moment_z", "N.m", "moment on what carries the tube about the tube's z axis", INPUT(tube_moment.z)},
};
// clang-format on
static const quantity_group input_groups[] = {
    {.title = "road", .each = EACH_ROLLER, QUANTITY_ROWS(roads)},
    {.title = "forces", .each = EACH_MULTIBODY, QUANTITY_ROWS(forces)},
};
static const quantity_table inputs = {input_groups, sizeof input_groups / sizeof *input_groups};

// Upright, yaw and roll turn about one axis: that is told as roll.
static void find_angles(const m3 *A, double angles[3])
{
    m3_yaw_pitch_roll(A, angles);
    if (hypot(A->a[0][0], A->a[2][0]) > 1e-9)
        return;
    angles[0] = 0;
    angles[2] = atan2(A->a[2][1], A->a[2][2]);
}

static void find_body(const body_motion *from, body_instant *to)
{
    v3_store(to->r, from->r);
    v3_store(to->v, from->v);
    v3_store(to->w, m3_apply_transposed(from->A, from->w));
    find_angles(&from->A, to->angles);
}

// Joints with one axis, those that turn and those that slide each in their order.
static void find_joints(const mechanism_system *self, const mechanism_motion *motion,
                        const mechanism_report *report, multibody_instant *now)
{
    int turns = 0, slides = 0;
    for (int i = 0; i < self->given->joint_count; i++) {
        ld_joint_kind kind = self->given->joint[i].kind;
        if (kind != LD_JOINT_REVOLUTE && kind != LD_JOINT_PRISMATIC)
            continue;
        axis_instant *to = kind == LD_JOINT_REVOLUTE ? &now->turn[turns++] : &now->slide[slides++];
        mechanism_joint_state(self, motion, i, to->state);
        to->friction = report->friction[i];
    }
}

// Modal coordinates follow those of the hinge that carries the beam.
static void find_beams(const mechanism_system *self, const mechanism_motion *motion,
                       multibody_instant *now)
{
    const ld_mechanism *given = self->given;
    double *to = now->coordinate;
    for (int i = 0; i < given->beam_count; i++) {
        int count = beam_coordinates(&given->beam[i]);
        find_body(&motion->body[given->body_count + i], &now->beam[i]);
        memcpy(to, motion->q + mechanism_beam_at(self, i), (size_t)count * sizeof *to);
        to += count;
    }
}

static void fill_instant(const base_system *base, const base_found *found,
                         const base_output *output, const double *state, base_instant *instant)
{
    const mechanism_system *self = mechanism_of(base);
    const ld_mechanism *given = self->given;
    const multibody_report *report = &output->report.multibody;
    const mechanism_report *of = &report->mechanism.report;
    multibody_instant *now = &instant->multibody;
    const double *wheel = state + marching_at(base);
    for (int i = 0; i < given->body_count; i++)
        find_body(&found->multibody.body[i], &now->body[i]);
    find_beams(self, &found->multibody, now);
    const base_frame *carrier = &found->multibody.carrier;
    find_body(&(body_motion){carrier->r, carrier->v, carrier->A, carrier->w}, &now->carrier);
    mechanism_joint_loads(self, &found->multibody, output->rate, &report->mechanism, now->joint);
    find_joints(self, &found->multibody, of, now);
    memcpy(now->drive, of->hold, (size_t)given->drive_count * sizeof *now->drive);
    for (int i = 0; i < given->strut_count; i++) {
        now->strut[i].spring = of->strut[i];
        now->strut[i].push = 0;
    }
    for (int i = 0; i < self->hold_count; i++)
        if (self->hold[i].strut >= 0)
            now->strut[self->hold[i].strut].push = of->hold[i].torque;
    memcpy(now->foot, of->foot, sizeof now->foot);
    memcpy(now->bushing, of->bushing, sizeof now->bushing);
    for (int j = 0; j < marching_of(base)->wheel_count; j++)
        memcpy(now->wheel[j].r, wheel + j * WHEEL_STATES + WHEEL_R, sizeof now->wheel[j].r);
    now->marching = report->marching;
}

static void describe(const base_system *base, FILE *stream)
{
    mechanism_describe(mechanism_of(base), stream);
}

const mechanism_system *base_as_multibody(const base_system *self)
{
    return self->kind == &base_multibody ? mechanism_of(self) : NULL;
}

const base_interface base_multibody = {
    .build = build,
    .free = release,
    .share = share,
    .find_frame = find_frame,
    .span = span,
    .next_corner = next_corner,
    .next_sample = next_sample,
    .sample = sample,
    .quantities = &quantities,
    .fill_instant = fill_instant,
    .describe = describe,
    .dynamics = &dynamics,
    .inputs = &inputs,
};
