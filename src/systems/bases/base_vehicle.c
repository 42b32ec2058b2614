// A base that is a vehicle: the orientating and the marching subsystem, which exchange positions,
// velocities and spring-damper forces with each other and with the tube (model.md, sections 2, 6
// and 7).
#include <stdlib.h>
#include <string.h>

#include "math/functions.h"
#include "model/model.h"
#include "model/parts.h"
#include "systems/bases/base.h"

const vehicle_system *base_as_vehicle(const base_system *self)
{
    return self->kind == &base_vehicle ? self->own : NULL;
}

void base_set_road(base_system *self, road *under)
{
    vehicle_system *vehicle = self->own;
    vehicle->marching.road = under;
}

static const orientating_system *orientating_of(const base_system *self)
{
    const vehicle_system *vehicle = self->own;
    return &vehicle->of_tube[self->tube];
}

static const marching_system *marching_of(const base_system *self)
{
    const vehicle_system *vehicle = self->own;
    return self->disturbed ? &vehicle->level : &vehicle->marching;
}

static int marching_at(const base_system *self)
{
    const vehicle_system *vehicle = self->own;
    return vehicle->marching_at;
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

static ld_status build_orientating(vehicle_system *self, ld_error *error)
{
    const ld_model *model = self->model;
    int fired[LD_MAX_FIRINGS];
    for (int i = 0; i < model->firing_count; i++) {
        fired[i] = model->firing[i].tube;
        ld_status status = orientating_build(&self->of_tube[i], model, fired[i], fired, i, error);
        if (status)
            return status;
        self->tube_count++;
    }
    return LD_OK;
}

static ld_status build_marching(vehicle_system *self, ld_error *error)
{
    static const ld_road flat = {.iso_class = LD_ROAD_SMOOTH};
    const ld_model *model = self->model;
    double stretch[2];
    road_under(model, stretch);
    ld_status status = marching_build(&self->marching, &model->base.vehicle, model->gravity,
                                      stretch[0], stretch[1], error);
    if (status)
        return status;
    self->level = self->marching;
    self->level.road = NULL;
    return road_build(&flat, 0, 0, &self->level.road, error);
}

static ld_status build(base_system *base, ld_error *error)
{
    vehicle_system *self = calloc(1, sizeof *self);
    if (!self)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the vehicle");
    base->own = self;
    self->model = base->model;
    ld_status status = build_orientating(self, error);
    if (!status)
        status = build_marching(self, error);
    int wheels = self->marching.wheel_count;
    self->marching_at = self->of_tube[0].state_count;
    base->state_count = self->marching_at + self->marching.state_count;
    base->work_count = model_has_jet(base->model) ? VEHICLE_POWERS : VEHICLE_ALWAYS;
    base->event_count = wheels;
    base->speed_at = ORIENTATING_V;
    base->speed_count = ORIENTATING_SPEEDS;
    base->freedom_count = 3 + 2 * HINGES + 3 * wheels;
    base->displacement_count = 6 + HINGES + 3 * wheels;
    base->extra_count = HINGES + 2 * wheels + 1 + self->marching_at - ORIENTATING_DRIVE;
    return status;
}

static void release(base_system *base)
{
    vehicle_system *self = base->own;
    if (!self)
        return;
    for (int i = 0; i < self->tube_count; i++)
        orientating_free(&self->of_tube[i]);
    if (!self->roads_of_another) {
        road_free(self->marching.road);
        road_free(self->level.road);
    }
    free(self);
}

// The chains are workspaces, too.
static ld_status share(base_system *base, ld_error *error)
{
    const vehicle_system *of = base->own;
    vehicle_system *self = base->own = malloc(sizeof *self);
    if (!self)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the vehicle");
    *self = *of;
    self->roads_of_another = true;
    self->tube_count = 0;
    return build_orientating(self, error);
}

// ---- motion

static void find_frame(const base_system *self, double t, const double *state, base_frame *tube,
                       base_found *found)
{
    orientating_motion_at(orientating_of(self), t, state, &found->vehicle);
    *tube = found->vehicle.tube;
}

// The first instant after t at which a commanded angle has a corner.
static double corner_after(const ld_table *command, double t)
{
    for (size_t i = 0; i < command->rows && command->rows > 1; i++)
        if (command->data[i * command->columns] > t)
            return command->data[i * command->columns];
    return INFINITY;
}

static double next_corner(const base_system *self, double t)
{
    const ld_platform *platform = &self->model->platform;
    return fmin(corner_after(&platform->azimuth.stabiliser.command, t),
                corner_after(&platform->elevation.stabiliser.command, t));
}

// Adds what disturbs chassis and platforms.
static void disturb(const base_disturbance *by, orientating_motion *motion,
                    orientating_input *wrenches)
{
    const base_inputs *input = &by->input;
    for (int i = 0; i < HINGES; i++) {
        motion->hinge[i].command += input->command[i];
        motion->hinge[i].command_rate += by->rate.command[i];
        motion->hinge[i].error += input->command[i];
    }
    wrenches->chassis_force = v3_add(wrenches->chassis_force, input->force);
    wrenches->chassis_moment = v3_add(wrenches->chassis_moment, input->moment);
    wrenches->tube_force = v3_add(wrenches->tube_force, input->tube_force);
    wrenches->tube_moment = v3_add(wrenches->tube_moment, input->tube_moment);
}

static double next_sample(const base_system *self, double t)
{
    return orientating_next_sample(orientating_of(self), t);
}

static void sample(const base_system *self, double t, double *state)
{
    orientating_sample(orientating_of(self), t, state);
}

double jet_power(const jet_wrench *jet, const base_frame *tube)
{
    return v3_dot(m3_apply(tube->A, jet->force), tube->v) +
           v3_dot(m3_apply(tube->A, jet->moment), tube->w);
}

static int evaluate(const base_system *self, const base_found *found, const base_load *load,
                    const double *state, base_output *output)
{
    vehicle_report *report = &output->report.vehicle;
    marching_output *marching = &report->marching;
    orientating_output orientating;
    orientating_motion motion = found->vehicle;
    const base_disturbance *disturbed = self->disturbed;
    road_disturbance ground = {disturbed ? disturbed->input.road : NULL,
                               disturbed ? disturbed->rate.road : NULL};
    marching_evaluate(marching_of(self), &motion.chassis, load->held, disturbed ? &ground : NULL,
                      state + marching_at(self), output->rate + marching_at(self), marching);
    orientating_input wrenches = {
        .chassis_force = marching->force,
        .chassis_moment = marching->moment,
        .tube_force = v3_add(load->force, load->jet.force),
        .tube_moment = v3_add(load->moment, load->jet.moment),
        .rest = {load->rest.hinge[0], load->rest.hinge[1]},
        .held = load->held,
        .linear = load->linear || disturbed,
    };
    if (disturbed)
        disturb(disturbed, &motion, &wrenches);
    int outcome = orientating_evaluate(orientating_of(self), &wrenches, state, &motion,
                                       output->rate, &orientating);
    memcpy(report->hinge, motion.hinge, sizeof report->hinge);
    memcpy(output->power, orientating.power, sizeof orientating.power);
    memcpy(output->power + ORIENTATING_POWERS, marching->power, sizeof marching->power);
    output->power[VEHICLE_JET] = jet_power(&load->jet, &motion.tube);
    report->jet = -load->jet.force.x;
    output->elastic = marching->elastic;
    for (int j = 0; j < self->event_count; j++)
        output->event[j] = marching->wheel[j].deflection;
    return outcome;
}

static double kinetic_energy(const base_system *self, const base_found *found, const double *state)
{
    (void)found;
    return orientating_kinetic_energy(orientating_of(self), state) +
           marching_kinetic_energy(marching_of(self), state + marching_at(self));
}

static void tolerances(const base_system *self, double tolerance, double *atol, bool *absolute)
{
    double *wheel = atol + marching_at(self);
    for (int i = 0; i < ORIENTATING_Z; i++)
        atol[i] = i < ORIENTATING_V ? 1e-2 * tolerance : tolerance;
    for (int i = ORIENTATING_Z; i < marching_at(self); i++)
        atol[i] = 1e2 * tolerance; // torques
    for (int i = ORIENTATING_DRIVE; i < marching_at(self); i += DRIVE_STATES) {
        atol[i + DRIVE_TWIST] = 1e-2 * tolerance;
        atol[i + DRIVE_RATE] = tolerance;
    }
    for (int i = 0; i < 3; i++)
        absolute[ORIENTATING_R + i] = true;
    for (int j = 0; j < marching_of(self)->wheel_count; j++, wheel += WHEEL_STATES)
        for (int i = 0; i < WHEEL_STATES; i++) {
            bool speed = i >= WHEEL_V && i < WHEEL_V + 3;
            wheel[i] = speed ? tolerance : 1e-2 * tolerance;
            absolute[wheel + i - atol] = i < WHEEL_V;
        }
    *wheel = tolerance;
}

// Each wheel is one; the drive is with the chassis.
static int part_of(const base_system *self, int state)
{
    int wheel = (state - marching_at(self)) / WHEEL_STATES;
    bool of_wheel = state >= marching_at(self) && wheel < marching_of(self)->wheel_count;
    return of_wheel ? wheel + 1 : 0;
}

static void set_start_velocity(const base_system *self, double *state)
{
    double speed = self->model->base.vehicle.speed;
    orientating_rest(orientating_of(self), state);
    state[ORIENTATING_V] = speed;
    for (int j = 0; j < marching_of(self)->wheel_count; j++)
        state[marching_at(self) + WHEEL_STATES * j + WHEEL_V] = speed;
}

// ---- equilibrium

// Upright over its position at the start, each wheel with its share of the weight.
static void guess(const base_system *self, double tube, double rocket, double *state)
{
    const orientating_system *orientating = orientating_of(self);
    const marching_system *marching = marching_of(self);
    const ld_vehicle *vehicle = &self->model->base.vehicle;
    double weight = orientating->mass + tube + rocket, t = -self->model->run.lead_in;
    weight *= self->model->gravity / vehicle->wheel_count;
    double tyre = weight / vehicle->tyre.stiffness[1];
    double spring = weight / vehicle->suspension.stiffness[1];
    double *wheel = state + marching_at(self);
    double mount = 0, ground = 0, slope;
    state[ORIENTATING_R] = vehicle->speed * t;
    for (int j = 0; j < vehicle->wheel_count; j++) {
        double x = state[ORIENTATING_R] + vehicle->wheel[j].mount[0];
        ground += road_height_between(marching->road, marching->right[j], x, &slope);
        mount += vehicle->wheel[j].mount[1];
    }
    state[ORIENTATING_R + 1] =
        (ground - mount) / vehicle->wheel_count + vehicle->tyre.radius - tyre - spring;
    state[ORIENTATING_QUATERNION] = 1;
    orientating_motion motion;
    orientating_motion_at(orientating, t, state, &motion);
    for (int i = 0; i < HINGES; i++)
        state[ORIENTATING_ANGLE + i] = motion.hinge[i].command;
    orientating_motion_at(orientating, t, state, &motion);
    marching_place(marching, &motion.chassis, wheel);
    for (int j = 0; j < vehicle->wheel_count; j++) {
        double *r = wheel + WHEEL_STATES * j;
        r[1] = road_height_between(marching->road, marching->right[j], r[0], &slope) +
               vehicle->tyre.radius - tyre;
    }
}

// Unknowns: chassis y, pitch, roll; hinge angles, hinge torques; wheel positions.
static void displace(const base_system *self, int freedom, double change, double *state)
{
    if (freedom == 0) {
        state[ORIENTATING_R + 1] += change;
    } else if (freedom < 3) {
        double c = cos(0.5 * change), s = sin(0.5 * change);
        quat q = q_from(state + ORIENTATING_QUATERNION);
        // Rz(pitch) Rx(roll): pitch turns from the left, roll from the right
        q = freedom == 1 ? q_multiply((quat){c, 0, 0, s}, q) : q_multiply(q, (quat){c, s, 0, 0});
        memcpy(state + ORIENTATING_QUATERNION, &q, sizeof q);
    } else if (freedom < 3 + HINGES) {
        state[ORIENTATING_ANGLE + freedom - 3] += change;
    } else if (freedom < 3 + 2 * HINGES) {
        state[ORIENTATING_Z + freedom - 3 - HINGES] += 1e6 * change; // held torque
    } else {
        int k = freedom - 3 - 2 * HINGES;
        state[marching_at(self) + WHEEL_STATES * (k / 3) + WHEEL_R + k % 3] += change;
    }
}

// Locked hinges keep their equilibrium; the others begin with the integral that holds it.
static void rest_of(const base_system *self, const double *state, base_rest *rest)
{
    (void)self;
    for (int i = 0; i < HINGES; i++)
        rest->hinge[i] =
            (hinge_rest){.angle = state[ORIENTATING_ANGLE + i], .torque = state[ORIENTATING_Z + i]};
}

// Accelerations but those that are neutral, and the errors of yaw and pitch.
static void residual(const base_system *self, const base_output *output, double *r)
{
    const double *rate = output->rate, *wheel = rate + marching_at(self);
    *r++ = rate[ORIENTATING_V + 1];
    *r++ = rate[ORIENTATING_W + 2];
    *r++ = rate[ORIENTATING_W];
    for (int i = 0; i < HINGES; i++)
        *r++ = rate[ORIENTATING_RATE + i];
    for (int i = 0; i < HINGES; i++)
        *r++ = output->report.vehicle.hinge[i].error;
    for (int j = 0; j < marching_of(self)->wheel_count; j++, wheel += WHEEL_STATES)
        for (int i = 0; i < 3; i++)
            *r++ = wheel[WHEEL_V + i];
}

static ld_status report_no_rest(double smallest, ld_error *error)
{
    return ld_fail(
        error, LD_ERR_NUMERIC,
        "base.wheels: the vehicle has no static equilibrium on its wheels (smallest residual %.3g "
        "m/s2): check that all wheels reach the road and the mass centre is between them",
        smallest);
}

static ld_status check_rest(const base_system *self, const base_found *found, const double *state,
                            ld_error *error)
{
    marching_output marching;
    double unused[WHEEL_STATES * LD_MAX_WHEELS + 1];
    const ld_platform *platform = &self->model->platform;
    const ld_turret *turret[HINGES] = {&platform->azimuth, &platform->elevation};
    static const char *const names[HINGES] = {"azimuth", "elevation"};
    marching_evaluate(marching_of(self), &found->vehicle.chassis, true, NULL,
                      state + marching_at(self), unused, &marching);
    for (int j = 0; j < marching_of(self)->wheel_count; j++)
        if (!(marching.wheel[j].normal > 0))
            return ld_fail(
                error, LD_ERR_INPUT,
                "base.wheels.%d: wheel \"%s\" does not reach the ground at the start: in "
                "equilibrium it hangs %.3g m above the road",
                j + 1, self->model->base.vehicle.wheel[j].name,
                fmax(0, -marching.wheel[j].deflection));
    for (int i = 0; i < HINGES; i++) {
        double torque = state[ORIENTATING_Z + i];
        double limit = turret[i]->stabiliser.torque_limit;
        if (!turret[i]->lock.present && fabs(torque) > limit)
            return ld_fail(error, LD_ERR_INPUT,
                           "platform.%s.stabiliser.torque_limit: holding the platform at the start "
                           "takes %.6g N m, more than the limit of %.6g N m",
                           names[i], torque, limit);
    }
    return LD_OK;
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

// Displacements: position and attitude of the chassis (the rotation in its own axes), hinge angles,
// wheel positions.
static void displace_slightly(const base_system *self, int displacement, double change,
                              double *state)
{
    if (displacement < 3) {
        state[ORIENTATING_R + displacement] += change;
    } else if (displacement < 6) {
        double axis[3] = {0};
        axis[displacement - 3] = sin(0.5 * change);
        quat turn = {cos(0.5 * change), axis[0], axis[1], axis[2]};
        quat q = q_multiply(q_from(state + ORIENTATING_QUATERNION), turn);
        memcpy(state + ORIENTATING_QUATERNION, &q, sizeof q);
    } else if (displacement < 8) {
        state[ORIENTATING_ANGLE + displacement - 6] += change;
    } else {
        int k = displacement - 8;
        state[marching_at(self) + WHEEL_STATES * (k / 3) + WHEEL_R + k % 3] += change;
    }
}

static int speed_of(const base_system *self, int displacement)
{
    if (displacement < 8)
        return ORIENTATING_V + displacement;
    int k = displacement - 8;
    return marching_at(self) + WHEEL_STATES * (k / 3) + WHEEL_V + k % 3;
}

// The stabilisers' integrals, eta and xi of each wheel, the drive's integral, the stabilisers'
// drives.
static int extra_of(const base_system *self, int extra)
{
    if (extra < HINGES)
        return ORIENTATING_Z + extra;
    int k = extra - HINGES, wheels = marching_of(self)->wheel_count;
    if (k < 2 * wheels)
        return marching_at(self) + WHEEL_STATES * (k / 2) + WHEEL_ETA + k % 2;
    if (k == 2 * wheels)
        return marching_at(self) + WHEEL_STATES * wheels;
    return ORIENTATING_DRIVE + k - 2 * wheels - 1;
}

static const char *group_name(const base_system *self, int group)
{
    (void)self;
    return groups[group];
}

static const char *key_of(int displacement)
{
    return displacement == 6   ? "platform.azimuth.stabiliser"
           : displacement == 7 ? "platform.elevation.stabiliser"
                               : NULL;
}

static const char *holder_of(const base_system *self, int displacement)
{
    (void)self;
    return key_of(displacement);
}

static double held_by(const base_system *self, const base_output *output, int displacement)
{
    (void)self;
    return key_of(displacement) ? output->report.vehicle.hinge[displacement - 6].torque : 0;
}

static double inertia_of(const base_system *self, int displacement, int *group)
{
    if (displacement >= 8) {
        *group = WHEEL_ALONG + (displacement - 8) % 3;
        return self->model->base.vehicle.wheel[(displacement - 8) / 3].mass;
    }
    static const int of_body[8] = {SURGE, HEAVE, SWAY, ROLL, YAW, PITCH, AZIMUTH, ELEVATION};
    const ld_platform *platform = &self->model->platform;
    const double *azimuth = platform->azimuth.inertia, *elevation = platform->elevation.inertia;
    *group = of_body[displacement];
    if (displacement < 3)
        return orientating_of(self)->mass;
    if (displacement < 6)
        return platform->chassis_inertia[displacement - 3];
    return displacement == 6 ? azimuth[1] + elevation[1] : elevation[2];
}

static const base_dynamics dynamics = {
    .evaluate = evaluate,
    .kinetic_energy = kinetic_energy,
    .tolerances = tolerances,
    .set_start_velocity = set_start_velocity,
    .part_of = part_of,
    .guess = guess,
    .displace = displace,
    .rest_of = rest_of,
    .residual = residual,
    .check_rest = check_rest,
    .report_no_rest = report_no_rest,
    .displace_slightly = displace_slightly,
    .speed_of = speed_of,
    .extra_of = extra_of,
    .inertia_of = inertia_of,
    .group_name = group_name,
    .holder_of = holder_of,
    .held_by = held_by,
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
    {"%s.angle", "rad", "%s hinge: angle", EACH(report.hinge, angle)},
    {"%s.rate", "rad/s", "%s hinge: rate of the angle", EACH(report.hinge, rate)},
    {"%s.measured", "rad", "%s: yaw or pitch of the elevation platform in I", EACH(report.hinge, measured)},
    {"%s.command", "rad", "%s: commanded yaw or pitch", EACH(report.hinge, command)},
    {"%s.error", "rad", "%s: command minus measured", EACH(report.hinge, error)},
    {"%s.torque", "N.m", "%s: torque of stabiliser or lock", EACH(report.hinge, torque)},
    {"%s.friction", "N.m", "%s: friction in the hinge", EACH(report.hinge, friction)},
};
static const quantity of_drive[] = {
    {"drive.speed", "m/s", "speed of the chassis along its heading", AT(report.marching.speed)},
    {"drive.force", "N", "drive force of all driven wheels", AT(report.marching.drive_force)},
};
static const quantity of_wheels[] = {
    {"wheel.%s.x", "m", "wheel %s: centre in I", EACH(wheel, r[0])},
    {"wheel.%s.y", "m", "wheel %s: centre in I", EACH(wheel, r[1])},
    {"wheel.%s.z", "m", "wheel %s: centre in I", EACH(wheel, r[2])},
    {"wheel.%s.road", "m", "wheel %s: height of the road under it", EACH(report.marching.wheel, height)},
    {"wheel.%s.travel", "m", "wheel %s: suspension travel along the chassis' y, from unloaded", EACH(report.marching.wheel, travel.y)},
    {"wheel.%s.deflection", "m", "wheel %s: tyre deflection", EACH(report.marching.wheel, deflection)},
    {"wheel.%s.tyre_force", "N", "wheel %s: vertical tyre force", EACH(report.marching.wheel, normal)},
    {"wheel.%s.along", "N", "wheel %s: longitudinal tyre force", EACH(report.marching.wheel, along)},
    {"wheel.%s.side", "N", "wheel %s: lateral tyre force", EACH(report.marching.wheel, side)},
};
static const quantity of_jets[] = {
    {"jet.force", "N", "force on the elevation platform by the jets of rockets that have left, along -x of T", AT(report.jet)},
};
static const quantity_group quantity_groups[] = {
    {.title = "chassis of a vehicle", .each = EACH_VEHICLE, QUANTITY_ROWS(of_chassis)},
    {.title = "each hinge of a vehicle", .each = EACH_HINGE, QUANTITY_ROWS(of_hinges)},
    {.title = "drive of a vehicle", .each = EACH_VEHICLE, QUANTITY_ROWS(of_drive)},
    {.title = "each wheel of a vehicle", .each = EACH_WHEEL, QUANTITY_ROWS(of_wheels)},
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
    const vehicle_system *self = base->own;
    vehicle_instant *now = &instant->vehicle;
    const double *wheel = state + self->marching_at;
    memcpy(now->chassis.r, state + ORIENTATING_R, sizeof now->chassis.r);
    memcpy(now->chassis.u, state + ORIENTATING_V, sizeof now->chassis.u);
    m3_yaw_pitch_roll(&found->vehicle.chassis.A, now->chassis.angles);
    for (int j = 0; j < self->marching.wheel_count; j++)
        memcpy(now->wheel[j].r, wheel + j * WHEEL_STATES + WHEEL_R, sizeof now->wheel[j].r);
    now->report = output->report.vehicle;
}

const base_interface base_vehicle = {
    .build = build,
    .free = release,
    .share = share,
    .find_frame = find_frame,
    .next_corner = next_corner,
    .next_sample = next_sample,
    .sample = sample,
    .quantities = &quantities,
    .fill_instant = fill_instant,
    .dynamics = &dynamics,
    .inputs = &inputs,
};
