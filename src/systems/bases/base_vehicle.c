// A base that is a vehicle: the mechanism of chassis and platforms (vehicle_mechanism.h) and the
// marching subsystem, which exchange positions, velocities and spring-damper forces with each other
// and with the tube (model.md, sections 2, 6 and 7). Here stands what is a vehicle's own: where it
// comes to rest, its names, its messages.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "math/functions.h"
#include "model/model.h"
#include "model/parts.h"
#include "systems/bases/mechanism_base.h"
#include "systems/bases/vehicle_mechanism.h"
#include "systems/mechanism/mechanism_loops.h"
#include "systems/mechanism/mechanism_motion.h"

bool base_is_vehicle(const base_system *self)
{
    return self->kind == &base_vehicle;
}

static const marching_system *marching_of(const base_system *self)
{
    const mechanism_base *own = self->own;
    return &own->marching;
}

// ---- life

// Unknown in an equilibrium: y, pitch and roll of the chassis, the hinges. Place and heading are
// free.
static void list_freedoms(mechanism_base *self)
{
    static const int of_chassis[] = {1, 5, 3};
    const mechanism_system *mechanism = &self->of_tube[0];
    for (int i = 0; i < 3; i++)
        self->freedom[self->freedom_count++] = of_chassis[i];
    for (int i = 0; i < mechanism->hold_count; i++)
        self->freedom[self->freedom_count++] = mechanism->hold[i].u;
}

static ld_status build(base_system *base, ld_error *error)
{
    mechanism_base *self = base->own = calloc(1, sizeof *self);
    ld_mechanism *made = calloc(1, sizeof *made);
    if (!self || !made) {
        free(made);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the vehicle");
    }
    vehicle_describe(base->model, made);
    self->made = made;
    self->mechanism_works = VEHICLE_BODY_POWERS;
    self->has_jet = model_has_jet(base->model);
    const mechanism_plan plan = vehicle_plan(base->model, made);
    ld_status status = mechanism_base_build(base, &plan, error);
    if (status)
        return status;
    for (int i = 0; i < self->tube_count; i++)
        vehicle_name_streams(&self->of_tube[i]);
    for (int i = 0; i < self->of_tube[0].hold_count; i++)
        snprintf(self->holder[i], sizeof self->holder[i], "platform.%.60s.stabiliser",
                 self->of_tube[0].hold[i].name);
    list_freedoms(self);
    mechanism_base_count(base);
    return LD_OK;
}

// ---- equilibrium

// Upright over its place at the start, each wheel with its share of the weight.
static void guess(const base_system *self, double tube, double rocket, double *state)
{
    const mechanism_system *mechanism = mechanism_of(self);
    const marching_system *marching = marching_of(self);
    const ld_vehicle *vehicle = &self->model->base.vehicle;
    double weight = mechanism->mass + tube + rocket, t = -self->model->run.lead_in;
    weight *= self->model->gravity / vehicle->wheel_count;
    double tyre = weight / vehicle->tyre.stiffness[1];
    double spring = weight / vehicle->suspension.stiffness[1];
    double *wheel = state + mechanism_base_marching_at(self);
    double mount = 0, ground = 0, slope;
    state[VEHICLE_R] = vehicle->speed * t;
    for (int j = 0; j < vehicle->wheel_count; j++) {
        double x = state[VEHICLE_R] + vehicle->wheel[j].mount[0];
        ground += road_height_between(marching->road, marching->right[j], x, &slope);
        mount += vehicle->wheel[j].mount[1];
    }
    state[VEHICLE_R + 1] =
        (ground - mount) / vehicle->wheel_count + vehicle->tyre.radius - tyre - spring;
    state[VEHICLE_QUATERNION] = 1;
    for (int i = 0; i < mechanism->hold_count; i++) {
        double rate;
        state[mechanism->hold[i].q] = mechanism_command(&mechanism->hold[i], t, &rate);
    }
    mechanism_base_mount_wheels(self, state);
    for (int j = 0; j < vehicle->wheel_count; j++) {
        double *r = wheel + WHEEL_STATES * j;
        r[1] = road_height_between(marching->road, marching->right[j], r[0], &slope) +
               vehicle->tyre.radius - tyre;
    }
}

// How a chassis could turn whose wheels, seen from above, are on one line or all at one place;
// NULL: they hold it.
static const char *unheld(const ld_vehicle *vehicle)
{
    double n = vehicle->wheel_count, x = 0, z = 0, xx = 0, xz = 0, zz = 0;
    for (int i = 0; i < vehicle->wheel_count; i++) {
        x += vehicle->wheel[i].mount[0] / n;
        z += vehicle->wheel[i].mount[2] / n;
    }
    for (int i = 0; i < vehicle->wheel_count; i++) {
        double dx = vehicle->wheel[i].mount[0] - x, dz = vehicle->wheel[i].mount[2] - z;
        xx += dx * dx;
        xz += dx * dz;
        zz += dz * dz;
    }
    if (xx * zz - xz * xz > 1e-12 * xx * zz)
        return NULL;
    const double least = 1e-12; // [m2]
    return xx > least && zz <= least   ? "roll"
           : zz > least && xx <= least ? "pitch"
                                       : "pitch and roll";
}

static ld_status report_no_rest(const base_system *self, double smallest, ld_error *error)
{
    const char *turns = unheld(&self->model->base.vehicle);
    if (turns)
        return ld_fail(error, LD_ERR_INPUT,
                       "base.wheels: nothing holds the chassis in %s: the wheels are on one line, "
                       "seen from above, and no equilibrium was found (smallest residual %.3g "
                       "m/s2): give wheels beside it",
                       turns, smallest);
    return ld_fail(
        error, LD_ERR_NUMERIC,
        "base.wheels: the vehicle has no static equilibrium on its wheels (smallest residual %.3g "
        "m/s2): check that all wheels reach the road and the mass centre is between them",
        smallest);
}

static ld_status check_growing(const base_system *self, double rate, ld_error *error)
{
    const char *turns = unheld(&self->model->base.vehicle);
    if (!turns)
        return LD_OK;
    return ld_fail(error, LD_ERR_INPUT,
                   "base.wheels: nothing holds the chassis in %s: the wheels are on one line, seen "
                   "from above, and about its equilibrium it tips over, growing by %.3g 1/s: give "
                   "wheels beside it",
                   turns, rate);
}

static ld_status check_rest(const base_system *self, const base_found *found, const double *state,
                            ld_error *error)
{
    const mechanism_system *mechanism = mechanism_of(self);
    ld_status status = mechanism_base_check_wheels(self, found, state, error);
    for (int i = 0; i < mechanism->hold_count && !status; i++) {
        const mechanism_hold *hold = &mechanism->hold[i];
        double torque = state[mechanism->z_at + i], limit = hold->control->torque_limit;
        if (!hold->lock && fabs(torque) > limit)
            status = ld_fail(error, LD_ERR_INPUT,
                             "platform.%s.stabiliser.torque_limit: holding the platform at the "
                             "start takes %.6g N m, more than the limit of %.6g N m",
                             hold->name, torque, limit);
    }
    return status;
}

// ---- linearised

enum {
    SURGE,
    HEAVE,
    SWAY,
    ROLL,
    YAW,
    PITCH,
    AZIMUTH,
    ELEVATION,
    WHEEL_ALONG,
    WHEEL_HOP,
    WHEEL_ACROSS,
    GROUPS
};
_Static_assert((int)GROUPS <= (int)BASE_GROUPS, "more groups than a base is allowed");

static const char *const groups[GROUPS] = {
    [SURGE] = "chassis, surge",
    [HEAVE] = "chassis, heave",
    [SWAY] = "chassis, sway",
    [ROLL] = "chassis, roll",
    [YAW] = "chassis, yaw",
    [PITCH] = "chassis, pitch",
    [AZIMUTH] = "azimuth platform",
    [ELEVATION] = "elevation platform",
    [WHEEL_ALONG] = "wheels, along",
    [WHEEL_HOP] = "wheels, hop",
    [WHEEL_ACROSS] = "wheels, across",
};

static const char *group_name(const base_system *self, int group)
{
    (void)self;
    return groups[group];
}

static double inertia_of(const base_system *self, int displacement, int *group)
{
    static const int of_chassis[6] = {SURGE, HEAVE, SWAY, ROLL, YAW, PITCH};
    const mechanism_system *mechanism = mechanism_of(self);
    const ld_platform *platform = &self->model->platform;
    int k = displacement - mechanism->freedom_count;
    if (k >= 0) {
        *group = WHEEL_ALONG + k % 3;
        return self->model->base.vehicle.wheel[k / 3].mass;
    }
    if (displacement < 6) {
        *group = of_chassis[displacement];
        return displacement < 3 ? mechanism->mass : platform->chassis_inertia[displacement - 3];
    }
    bool azimuth = displacement == 6 && platform->has_azimuth;
    *group = azimuth ? AZIMUTH : ELEVATION;
    return azimuth ? platform->azimuth.inertia[1] + platform->elevation.inertia[1]
                   : platform->elevation.inertia[2];
}

static const base_dynamics dynamics = {
    .evaluate = mechanism_base_evaluate,
    .kinetic_energy = mechanism_base_kinetic_energy,
    .tolerances = mechanism_base_tolerances,
    .set_start_velocity = mechanism_base_set_start_velocity,
    .part_of = mechanism_base_part_of,
    .guess = guess,
    .displace = mechanism_base_displace,
    .rest_of = mechanism_base_rest_of,
    .residual = mechanism_base_residual,
    .check_rest = check_rest,
    .report_no_rest = report_no_rest,
    .check_growing = check_growing,
    .displace_slightly = mechanism_base_displace_slightly,
    .speed_of = mechanism_base_speed_of,
    .extra_of = mechanism_base_extra_of,
    .inertia_of = inertia_of,
    .group_name = group_name,
    .holder_of = mechanism_base_holder_of,
    .held_by = mechanism_base_held_by,
};

// ---- quantities

#define AT(member) .at = QUANTITY_AT(vehicle_instant, member)
#define EACH(array, member) .at = QUANTITY_OF_EACH(vehicle_instant, array, member)

// clang-format off
static const quantity of_chassis[] = {
    {"chassis.x", "m", "chassis: mass centre in I", AT(chassis.r[0])},
    {"chassis.y", "m", "chassis: mass centre in I", AT(chassis.r[1])},
    {"chassis.z", "m", "chassis: mass centre in I", AT(chassis.r[2])},
    {"chassis.yaw", "rad", "chassis: yaw of Ry(yaw) Rz(pitch) Rx(roll)", AT(chassis.angles[0])},
    {"chassis.pitch", "rad", "chassis: pitch", AT(chassis.angles[1])},
    {"chassis.roll", "rad", "chassis: roll", AT(chassis.angles[2])},
    {"chassis.vx", "m/s", "chassis: velocity of its mass centre in I", AT(chassis.u[0])},
    {"chassis.vy", "m/s", "chassis: velocity of its mass centre in I", AT(chassis.u[1])},
    {"chassis.vz", "m/s", "chassis: velocity of its mass centre in I", AT(chassis.u[2])},
    {"chassis.wx", "rad/s", "chassis: angular velocity in its own axes", AT(chassis.u[3])},
    {"chassis.wy", "rad/s", "chassis: angular velocity in its own axes", AT(chassis.u[4])},
    {"chassis.wz", "rad/s", "chassis: angular velocity in its own axes", AT(chassis.u[5])},
};
static const quantity of_hinges[] = {
    {"%s.angle", "rad", "%s hinge: angle", EACH(hinge, angle)},
    {"%s.rate", "rad/s", "%s hinge: rate of the angle", EACH(hinge, rate)},
    {"%s.measured", "rad", "%s: yaw or pitch of the elevation platform in I", EACH(hinge, measured)},
    {"%s.command", "rad", "%s: commanded yaw or pitch", EACH(hinge, command)},
    {"%s.error", "rad", "%s: command minus measured", EACH(hinge, error)},
    {"%s.torque", "N.m", "%s: torque of stabiliser or lock", EACH(hinge, torque)},
    {"%s.friction", "N.m", "%s: friction in the hinge", EACH(hinge, friction)},
};
static const quantity of_platforms[] = {
    {"%s.x", "m", "%s platform: centre of its hinge in I", EACH(platform, r[0])},
    {"%s.y", "m", "%s platform: centre of its hinge in I", EACH(platform, r[1])},
    {"%s.z", "m", "%s platform: centre of its hinge in I", EACH(platform, r[2])},
    {"%s.yaw", "rad", "%s platform: yaw of Ry(yaw) Rz(pitch) Rx(roll)", EACH(platform, angles[0])},
    {"%s.pitch", "rad", "%s platform: pitch", EACH(platform, angles[1])},
    {"%s.roll", "rad", "%s platform: roll", EACH(platform, angles[2])},
    {"%s.vx", "m/s", "%s platform: velocity of the centre of its hinge in I", EACH(platform, v[0])},
    {"%s.vy", "m/s", "%s platform: velocity of the centre of its hinge in I", EACH(platform, v[1])},
    {"%s.vz", "m/s", "%s platform: velocity of the centre of its hinge in I", EACH(platform, v[2])},
    {"%s.wx", "rad/s", "%s platform: angular velocity in its own axes", EACH(platform, w[0])},
    {"%s.wy", "rad/s", "%s platform: angular velocity in its own axes", EACH(platform, w[1])},
    {"%s.wz", "rad/s", "%s platform: angular velocity in its own axes", EACH(platform, w[2])},
};
static const quantity of_jets[] = {
    {"jet.force", "N", "force on the elevation platform by the jets of rockets that have left, along -x of T", AT(jet)},
};
static const quantity_group quantity_groups[] = {
    {.title = "chassis of a vehicle", .each = EACH_VEHICLE, QUANTITY_ROWS(of_chassis)},
    {.title = "each hinge of a vehicle", .each = EACH_HINGE, QUANTITY_ROWS(of_hinges)},
    {.title = "each platform of a vehicle", .each = EACH_HINGE, QUANTITY_ROWS(of_platforms)},
    {.title = "drive of a vehicle", .each = EACH_VEHICLE, QUANTITY_ROWS(rolling_drive_columns)},
    {.title = "each wheel of a vehicle", .each = EACH_WHEEL, QUANTITY_ROWS(rolling_wheel_columns)},
    {.title = "jets on its platform", .each = EACH_JET, QUANTITY_ROWS(of_jets)},
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
static const quantity commands[] = {
    {"%s.command", "rad", "%s: commanded yaw or pitch", INPUT_OF(command)},
};
static const quantity forces[] = {
    {"chassis.force_x", "N", "force on the chassis at its mass centre, in I", INPUT(force.x)},
    {"chassis.force_y", "N", "force on the chassis at its mass centre, in I", INPUT(force.y)},
    {"chassis.force_z", "N", "force on the chassis at its mass centre, in I", INPUT(force.z)},
    {"chassis.moment_x", "N.m", "moment on the chassis, in I", INPUT(moment.x)},
    {"chassis.moment_y", "N.m", "moment on the chassis, in I", INPUT(moment.y)},
    {"chassis.moment_z", "N.m", "moment on the chassis, in I", INPUT(moment.z)},
    {"platform.force_x", "N", "force on the elevation platform at the tube's rear end, along the tube", INPUT(tube_force.x)},
    {"platform.force_y", "N", "force on the elevation platform at the tube's rear end, upwards from it", INPUT(tube_force.y)},
    {"platform.force_z", "N", "force on the elevation platform at the tube's rear end, to its right", INPUT(tube_force.z)},
    {"platform.moment_x", "N.m", "moment on the elevation platform about the tube's x axis", INPUT(tube_moment.x)},
    {"platform.moment_y", "N.m", "moment on the elevation platform about the tube's y axis", INPUT(tube_moment.y)},
    {"platform.moment_z", "N.m", "moment on the elevation platform about the tube's z axis", INPUT(tube_moment.z)},
};
// clang-format on
static const quantity_group input_groups[] = {
    {.title = "road", .each = EACH_WHEEL, QUANTITY_ROWS(roads)},
    {.title = "commands", .each = EACH_HINGE, QUANTITY_ROWS(commands)},
    {.title = "forces", .each = EACH_VEHICLE, QUANTITY_ROWS(forces)},
};
static const quantity_table inputs = {input_groups, sizeof input_groups / sizeof *input_groups};

static void fill_instant(const base_system *base, const base_found *found,
                         const base_output *output, const double *state, base_instant *instant)
{
    const mechanism_system *self = mechanism_of(base);
    const mechanism_report *report = &output->report.mechanism.report;
    vehicle_instant *now = &instant->vehicle;
    memcpy(now->chassis.r, state + VEHICLE_R, sizeof now->chassis.r);
    memcpy(now->chassis.u, state + self->q_count, sizeof now->chassis.u);
    m3_yaw_pitch_roll(&found->mechanism.body[self->wheels].A, now->chassis.angles);
    mechanism_stand(self, &found->mechanism);
    for (int i = 0; i < self->hold_count; i++) {
        now->hinge[i] = report->hold[i];
        now->hinge[i].friction = report->friction[self->hold[i].joint];
        body_motion platform = mechanism_body_motion(self, 1 + i);
        body_instant_find(&platform, &now->platform[i]);
    }
    mechanism_base_fill_rolling(base, output, state, &now->rolling);
    now->jet = output->report.jet;
}

const base_interface base_vehicle = {
    .build = build,
    .free = mechanism_base_free,
    .take_road = mechanism_base_take_road,
    .share = mechanism_base_share,
    .find_frame = mechanism_base_find_frame,
    .next_corner = mechanism_base_next_corner,
    .next_sample = mechanism_base_next_sample,
    .sample = mechanism_base_sample,
    .quantities = &quantities,
    .fill_instant = fill_instant,
    .dynamics = &dynamics,
    .inputs = &inputs,
};
