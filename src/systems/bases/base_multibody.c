// A base of bodies, joints and force elements, which stands on the ground, on wheels or on a
// carrier that moves (mechanism.h).
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "math/functions.h"
#include "model/model.h"
#include "systems/bases/mechanism_base.h"
#include "systems/bases/multibody_rest.h"
#include "systems/mechanism/mechanism_description.h"
#include "systems/mechanism/mechanism_joints.h"
#include "systems/mechanism/mechanism_loops.h"
#include "systems/mechanism/mechanism_motion.h"
#include "systems/mechanism/mechanism_state.h"

// ---- life

static void name_holders(mechanism_base *self)
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
    mechanism_base *self = base->own;
    double t = -self->model->run.lead_in;
    base_frame carrier = mechanism_base_carrier(base, t);
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

static ld_status build(base_system *base, ld_error *error)
{
    const ld_model *model = base->model;
    const mechanism_plan plan = {
        .model = model,
        .given = &model->base.mechanism,
        .carries = model->tubes.on,
        .mount = m3_mul(m3_rotation_y(model->base.azimuth), m3_rotation_z(model->base.elevation))};
    mechanism_base *self = base->own = calloc(1, sizeof *self);
    if (!self)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the base's bodies");
    self->mechanism_works = MECHANISM_POWERS;
    ld_status status = mechanism_base_build(base, &plan, error);
    if (status)
        return status;
    name_holders(self);
    self->rest = calloc(BASE_MOST_STATES, sizeof *self->rest);
    self->given = calloc(BASE_MOST_STATES, sizeof *self->given);
    if (!self->rest || !self->given)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the base's bodies");
    status = begin(base, self->rest, error);
    if (status)
        return status;
    mechanism_base_count(base);
    mechanism_base_mount_wheels(base, self->rest);
    memcpy(self->given, self->rest, BASE_MOST_STATES * sizeof *self->given);
    status = multibody_rest_find(base, error);
    mechanism_base_count(base);
    return status;
}

// ---- equilibrium

static void guess(const base_system *self, double tube, double rocket, double *state)
{
    (void)tube, (void)rocket;
    const mechanism_base *own = self->own;
    memcpy(state, own->rest, (size_t)self->state_count * sizeof *state);
}

static void place_as_given(const base_system *self, double *state)
{
    const mechanism_base *own = self->own;
    memcpy(state, own->given, (size_t)self->state_count * sizeof *state);
}

static ld_status report_no_rest(const base_system *self, double smallest, ld_error *error)
{
    (void)self;
    return ld_fail(
        error, LD_ERR_NUMERIC,
        "base: its bodies find no static equilibrium (smallest residual %.3g m/s2): does "
        "something hold each of them, and is the mass centre between wheels or feet?",
        smallest);
}

static ld_status check_rest(const base_system *self, const base_found *found, const double *state,
                            ld_error *error)
{
    const mechanism_base *own = self->own;
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
    return own->has_wheels ? mechanism_base_check_wheels(self, found, state, error) : LD_OK;
}

static ld_status check_held(const base_system *self, ld_error *error)
{
    const mechanism_base *own = self->own;
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
    const mechanism_base *own = self->own;
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
    const mechanism_base *own = self->own;
    return mechanism_inertia(mechanism, own->rest, mechanism->freedom[displacement], group);
}

static const base_dynamics dynamics = {
    .evaluate = mechanism_base_evaluate,
    .kinetic_energy = mechanism_base_kinetic_energy,
    .tolerances = mechanism_base_tolerances,
    .set_start_velocity = mechanism_base_set_start_velocity,
    .project = mechanism_base_project,
    .part_of = mechanism_base_part_of,
    .guess = guess,
    .place_as_given = place_as_given,
    .displace = mechanism_base_displace,
    .rest_of = mechanism_base_rest_of,
    .residual = mechanism_base_residual,
    .check_rest = check_rest,
    .report_no_rest = report_no_rest,
    .check_held = check_held,
    .note_rest = note_rest,
    .displace_slightly = mechanism_base_displace_slightly,
    .speed_of = mechanism_base_speed_of,
    .quicken = mechanism_base_quicken,
    .extra_of = mechanism_base_extra_of,
    .inertia_of = inertia_of,
    .group_name = group_name,
    .holder_of = mechanism_base_holder_of,
    .held_by = mechanism_base_held_by,
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
static const quantity of_cylinders[] = {
    {"joint.%s.displacement", "m", "joint %s: displacement along its axis", EACH(cylinder, q[0])},
    {"joint.%s.speed", "m/s", "joint %s: rate of the displacement", EACH(cylinder, u[0])},
    {"joint.%s.angle", "rad", "joint %s: angle about its axis", EACH(cylinder, q[1])},
    {"joint.%s.rate", "rad/s", "joint %s: rate of the angle", EACH(cylinder, u[1])},
};
static const quantity of_universals[] = {
    {"joint.%s.angle", "rad", "joint %s: angle about its first axis", EACH(universal, q[0])},
    {"joint.%s.rate", "rad/s", "joint %s: rate of the angle", EACH(universal, u[0])},
    {"joint.%s.angle_2", "rad", "joint %s: angle about its second axis", EACH(universal, q[1])},
    {"joint.%s.rate_2", "rad/s", "joint %s: rate of that angle", EACH(universal, u[1])},
};
static const quantity of_planes[] = {
    {"joint.%s.displacement", "m", "joint %s: displacement in its plane, first direction", EACH(plane, q[0])},
    {"joint.%s.speed", "m/s", "joint %s: rate of the displacement", EACH(plane, u[0])},
    {"joint.%s.displacement_2", "m", "joint %s: displacement in its plane, second direction", EACH(plane, q[1])},
    {"joint.%s.speed_2", "m/s", "joint %s: rate of that displacement", EACH(plane, u[1])},
    {"joint.%s.angle", "rad", "joint %s: angle about its axis", EACH(plane, q[2])},
    {"joint.%s.rate", "rad/s", "joint %s: rate of the angle", EACH(plane, u[2])},
};
static const quantity of_balls[] = {
    {"joint.%s.yaw", "rad", "joint %s: yaw of Ry(yaw) Rz(pitch) Rx(roll) against its start, in the joint's axes", EACH(ball, angles[0])},
    {"joint.%s.pitch", "rad", "joint %s: pitch", EACH(ball, angles[1])},
    {"joint.%s.roll", "rad", "joint %s: roll", EACH(ball, angles[2])},
    {"joint.%s.wx", "rad/s", "joint %s: angular velocity of the body against its parent, in the joint's axes on the body", EACH(ball, u[0])},
    {"joint.%s.wy", "rad/s", "joint %s: its y component", EACH(ball, u[1])},
    {"joint.%s.wz", "rad/s", "joint %s: its z component", EACH(ball, u[2])},
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
    {"drive.%s.base_rate", "rad/s", "drive %s: rate of what carries its joint about the joint's axis", EACH(drive, base_rate)},
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
static const quantity_group quantity_groups[] = {
    {.title = "each body", .each = EACH_BODY, QUANTITY_ROWS(of_bodies)},
    {.title = "each beam", .each = EACH_BEAM, QUANTITY_ROWS(of_beams)},
    {.title = "each modal coordinate of a beam", .each = EACH_BEAM_COORDINATE, QUANTITY_ROWS(of_beam_coordinates)},
    {.title = "carrier, where something stands on it", .each = EACH_CARRIER, QUANTITY_ROWS(of_carrier)},
    {.title = "each joint that turns about one axis", .each = EACH_TURN, QUANTITY_ROWS(of_turns)},
    {.title = "each joint that slides along one axis", .each = EACH_SLIDER, QUANTITY_ROWS(of_slides)},
    {.title = "each cylindrical joint", .each = EACH_CYLINDER, QUANTITY_ROWS(of_cylinders)},
    {.title = "each universal joint", .each = EACH_UNIVERSAL, QUANTITY_ROWS(of_universals)},
    {.title = "each planar joint", .each = EACH_PLANE, QUANTITY_ROWS(of_planes)},
    {.title = "each spherical joint", .each = EACH_BALL, QUANTITY_ROWS(of_balls)},
    {.title = "each joint", .each = EACH_JOINT, QUANTITY_ROWS(of_joints)},
    {.title = "each drive of a joint", .each = EACH_DRIVE, QUANTITY_ROWS(of_drives)},
    {.title = "each strut", .each = EACH_STRUT, QUANTITY_ROWS(of_struts)},
    {.title = "each foot", .each = EACH_FOOT, QUANTITY_ROWS(of_feet)},
    {.title = "each bushing", .each = EACH_BUSHING, QUANTITY_ROWS(of_bushings)},
    {.title = "drive of a multibody base on wheels", .each = EACH_ROLLING, QUANTITY_ROWS(rolling_drive_columns)},
    {.title = "each wheel of a multibody base", .each = EACH_ROLLER, QUANTITY_ROWS(rolling_wheel_columns)},
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
    {"drive.%s.command", "1", "drive %s: commanded angle [rad] or length [m]", INPUT_OF(command)},
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
    {.title = "commands", .each = EACH_DRIVE, QUANTITY_ROWS(commands)},
    {.title = "forces", .each = EACH_MULTIBODY, QUANTITY_ROWS(forces)},
};
static const quantity_table inputs = {input_groups, sizeof input_groups / sizeof *input_groups};

// An element, the chain standing there.
static void find_element(const mechanism_system *self, int element, body_instant *to)
{
    body_motion from = mechanism_body_motion(self, element);
    body_instant_find(&from, to);
}

// A joint with one axis.
static void find_axis(const mechanism_system *self, const mechanism_motion *motion, int joint,
                      double friction, axis_instant *to)
{
    double q[JOINT_MOST_COORDINATES], u[JOINT_MOST_SPEEDS];
    mechanism_joint_state(self, motion, joint, q, u);
    *to = (axis_instant){.state = {q[0], u[0]}, .friction = friction};
}

// A joint with several coordinates.
static void find_joint(const mechanism_system *self, const mechanism_motion *motion, int joint,
                       joint_instant *to)
{
    mechanism_joint_state(self, motion, joint, to->q, to->u);
    if (self->given->joint[joint].kind != LD_JOINT_SPHERICAL)
        return;
    m3 A = q_matrix(q_from(to->q));
    m3_yaw_pitch_roll(&A, to->angles);
}

// Joints by kind, each in their order.
static void find_joints(const mechanism_system *self, const mechanism_motion *motion,
                        const mechanism_report *report, multibody_instant *now)
{
    axis_instant *turn = now->turn, *slide = now->slide;
    joint_instant *several[] = {[LD_JOINT_CYLINDRICAL] = now->cylinder,
                                [LD_JOINT_UNIVERSAL] = now->universal,
                                [LD_JOINT_PLANAR] = now->plane,
                                [LD_JOINT_SPHERICAL] = now->ball,
                                [LD_JOINT_FREE] = NULL};
    for (int i = 0; i < self->given->joint_count; i++) {
        ld_joint_kind kind = self->given->joint[i].kind;
        if (kind == LD_JOINT_REVOLUTE)
            find_axis(self, motion, i, report->friction[i], turn++);
        else if (kind == LD_JOINT_PRISMATIC)
            find_axis(self, motion, i, report->friction[i], slide++);
        else if (several[kind])
            find_joint(self, motion, i, several[kind]++);
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
        find_element(self, given->body_count + i, &now->beam[i]);
        memcpy(to, motion->q + mechanism_beam_at(self, i), (size_t)count * sizeof *to);
        to += count;
    }
}

static void fill_instant(const base_system *base, const base_found *found,
                         const base_output *output, const double *state, base_instant *instant)
{
    const mechanism_system *self = mechanism_of(base);
    const ld_mechanism *given = self->given;
    const mechanism_report *of = &output->report.mechanism.report;
    multibody_instant *now = &instant->multibody;
    mechanism_stand(self, &found->mechanism);
    for (int i = 0; i < given->body_count; i++)
        find_element(self, i, &now->body[i]);
    find_beams(self, &found->mechanism, now);
    const base_frame *carrier = &found->mechanism.carrier;
    body_instant_find(&(body_motion){carrier->r, carrier->v, carrier->A, carrier->w},
                      &now->carrier);
    mechanism_joint_loads(self, &found->mechanism, output->rate, &output->report.mechanism,
                          now->joint);
    find_joints(self, &found->mechanism, of, now);
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
    mechanism_base_fill_rolling(base, output, state, &now->rolling);
}

static void describe(const base_system *base, FILE *stream)
{
    mechanism_describe(mechanism_of(base), stream);
}

const mechanism_system *base_as_multibody(const base_system *self)
{
    return self->kind == &base_multibody ? mechanism_of(self) : NULL;
}

static const base_frame *stations(const base_system *self, const base_found *found)
{
    return mechanism_of(self)->station_count > 0 ? found->mechanism.station : NULL;
}

const base_interface base_multibody = {
    .build = build,
    .free = mechanism_base_free,
    .take_road = mechanism_base_take_road,
    .share = mechanism_base_share,
    .find_frame = mechanism_base_find_frame,
    .stations = stations,
    .span = mechanism_base_span,
    .next_corner = mechanism_base_next_corner,
    .next_sample = mechanism_base_next_sample,
    .sample = mechanism_base_sample,
    .quantities = &quantities,
    .fill_instant = fill_instant,
    .describe = describe,
    .dynamics = &dynamics,
    .inputs = &inputs,
};
