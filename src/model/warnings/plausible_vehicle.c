// Plausibility of a vehicle: wheels, road, chassis and platforms.
#include "math/functions.h"
#include "model/model.h"
#include "model/parts.h"
#include "model/warnings/estimates.h"
#include "model/warnings/plausible_rule.h"

#define PI 3.14159265358979323846

static const ld_vehicle *vehicle_of(const plausible_entry *at)
{
    return &at->model->base.vehicle;
}

static plausible_pair wheel_distance(const plausible_entry *at)
{
    const ld_wheel *wheel = vehicle_of(at)->wheel, *own = &wheel[at->i];
    double nearest = INFINITY;
    for (int i = 0; i < at->i; i++)
        nearest = fmin(nearest,
                       hypot(own->mount[0] - wheel[i].mount[0], own->mount[2] - wheel[i].mount[2]));
    return plausible_compare(nearest, vehicle_of(at)->tyre.radius);
}

static plausible_pair jet_reach(const plausible_entry *at)
{
    const ld_table *jet = &at->model->platform.jet;
    double reach = jet->rows > 0 ? jet->data[2 * (jet->rows - 1)] : NAN;
    return plausible_compare(reach, at->model->tubes.length);
}

// Greatest rate of a hinge's command [rad/s].
static plausible_pair command_rate(const plausible_entry *at)
{
    const ld_platform *platform = &at->model->platform;
    const ld_turret *turret = at->i == 0 ? &platform->azimuth : &platform->elevation;
    const ld_table *command = &turret->stabiliser.command;
    double most = 0;
    for (size_t i = 1; i < command->rows; i++) {
        const double *a = &command->data[2 * (i - 1)], *b = &command->data[2 * i];
        most = fmax(most, fabs(b[1] - a[1]) / (b[0] - a[0]));
    }
    return plausible_alone(most);
}

#define WHEEL_BASE .other = "the wheelbase"

const plausible_rule plausible_of_vehicle[] = {
    {"base.speed", .unit = "m/s", NO_LOW, .high = 60,
     .why = "no launcher marches faster than 216 km/h"},
    {"base.wheels", "the chassis' mass centre from rear (0) to front wheels (1)", .unit = "",
     .low = 0, .high = 1, .form = PLAUSIBLE_RATIO, .a = "the distance of the rear wheels",
     .b = "the wheelbase", .why = "the vehicle tips over"},
    {"base.wheels", "the chassis' mass centre from left (0) to right wheels (1)", .unit = "",
     .low = 0, .high = 1, .form = PLAUSIBLE_RATIO, .a = "the distance of the left wheels",
     .b = "the track width", .why = "the vehicle tips over"},
    {"base.wheels.#.mount", "the distance from the nearest wheel before it", .unit = "m",
     .other = "base.tyre.radius", .low = 0.25, NO_HIGH, .find = wheel_distance,
     .why = "two wheels cannot be at one position"},
    {"base.wheels.#.mount.y", .unit = "m", .other = "base.tyre.radius", NO_LOW, .high = 1,
     .why = "the chassis' mass centre lies below the road"},
    {"base.wheels.#.mass", .unit = "kg", .other = "platform.chassis.mass", .low = 1e-4, .high = 0.5,
     .why = "wheels are a small part of a vehicle"},
    {"base.drive.kp", "the vehicle's mass over it (the time to take up an error)", .unit = "s",
     .low = 0.01, .high = 100, .form = PLAUSIBLE_RATIO, .a = "the mass on the suspensions",
     .b = "base.drive.kp", .when = "base.speed", .why = "a driver takes about a second"},
    {"base.suspension.stiffness.y", "the heave frequency of the vehicle", .unit = "Hz", .low = 0.3,
     .high = 30, .a = "the heave frequency of the vehicle",
     .why = "that of lorries is 1 Hz to 3 Hz"},
    {"base.suspension.damping.y", "the damping ratio of the heave", .unit = "", NO_LOW, .high = 2,
     .form = PLAUSIBLE_RATIO, .b = "the critical damping of the heave",
     .of = "base.suspension.stiffness.y", .why = "that of lorries is 0.2 to 0.5"},
    {"base.suspension.damping.x", "the decay time of a wheel's motion", .unit = "s",
     .other = "run.max_step", .low = 0.05, NO_HIGH, .form = PLAUSIBLE_DECAY,
     .b = "base.wheels.1.mass", .of = "base.wheels.#.mass",
     .why = "the integrator needs many short steps to follow it"},
    {"base.suspension.damping.z", "the decay time of a wheel's motion", .unit = "s",
     .other = "run.max_step", .low = 0.05, NO_HIGH, .form = PLAUSIBLE_DECAY,
     .b = "base.wheels.1.mass", .of = "base.wheels.#.mass",
     .why = "the integrator needs many short steps to follow it"},
    {"base.suspension.bump_stop.compression", .unit = "m", .other = "the static travel", .low = 1,
     NO_HIGH, .of = "base.suspension.stiffness.y", .why = "the vehicle stands on its stops"},
    {"base.tyre.radius", .unit = "m", .low = 0.1, .high = 2.5,
     .why = "tyres of lorries have 0.4 m to 0.8 m"},
    {"base.tyre.stiffness.y", "the tyre's static deflection", .unit = "m",
     .other = "base.tyre.radius", NO_LOW, .high = 0.3, .form = PLAUSIBLE_RATIO,
     .a = "the load of a tyre", .b = "base.tyre.stiffness.y", .why = "the tyre is flat"},
    {"base.tyre.stiffness.y", "the frequency of a wheel between tyre and suspension", .unit = "Hz",
     .low = 1, .high = 200, .form = PLAUSIBLE_FREQUENCY,
     .a = "the stiffness of suspension and tyre at a wheel", .b = "base.wheels.1.mass",
     .of = "base.suspension.stiffness.y", .why = "that of lorries is about 10 Hz"},
    {"base.tyre.damping.y", "the decay time of a wheel's motion", .unit = "s",
     .other = "run.max_step", .low = 0.05, NO_HIGH, .form = PLAUSIBLE_DECAY,
     .b = "base.wheels.1.mass", .of = "base.wheels.#.mass",
     .why = "the integrator needs many short steps to follow it"},
    {"base.tyre.relaxation_length", .unit = "m", .other = "base.tyre.radius", .low = 0.05,
     .high = 10, .why = "it is about the radius"},
    {"base.tyre.friction", .unit = "", .low = 0.05, .high = 1.5,
     .why = "tyres have 0.1 on ice and 1 on dry asphalt"},
    {"base.road.sines.#.amplitude", .unit = "m", .other = "base.road.sines.#.wavelength",
     .low = -0.2, .high = 0.2, .why = "that is steeper than any road"},
    {"base.road.bumps.#.height", .unit = "m", .other = "base.road.bumps.#.length", .low = -0.5,
     .high = 0.5, .why = "a bump so steep is a wall"},
    {"base.road.wavelengths.y", .unit = "m", .other = "base.tyre.radius", .low = 0.02, NO_HIGH,
     .why = "a tyre filters such short waves out"},
    {"platform.chassis.mass", .unit = "kg",
     .other = "the mass of platforms, tubes and rockets on it", .low = 0.1, NO_HIGH,
     .why = "the chassis carries all of them"},
    {"platform.chassis.inertia.x", "the radius of gyration about x", .unit = "m",
     .other = "the track width", .low = 0.05, .high = 2, .form = PLAUSIBLE_GYRATION,
     .b = "platform.chassis.mass", .of = "platform.chassis.mass",
     .why = "the chassis is about as large as its wheelbase and track"},
    {"platform.chassis.inertia.z", "the radius of gyration about z", .unit = "m", WHEEL_BASE,
     .low = 0.05, .high = 2, .form = PLAUSIBLE_GYRATION, .b = "platform.chassis.mass",
     .of = "platform.chassis.mass",
     .why = "the chassis is about as large as its wheelbase and track"},
    {"platform.jet", "the greatest force", .unit = "N", .other = "the greatest thrust", NO_LOW,
     .high = 1, .form = PLAUSIBLE_GREATEST, .column = 1, .b = "platform.jet_scale",
     .why = "the force of a jet is at most the thrust"},
    {"platform.jet", "the distance at which it ends", .unit = "m", .other = "tubes.length",
     .low = 0.02, .high = 50, .find = jet_reach,
     .why = "a jet acts up to some tube lengths from the tip"},
    {"platform.jet_scale", .unit = "", .low = 0.1, .high = 10, .when = "the scale of jets",
     .why = "it is a correction of the table"},
    {"platform.azimuth.stabiliser.command", "the greatest angle", .unit = "rad", NO_LOW,
     .high = 4 * PI, .form = PLAUSIBLE_GREATEST, .column = 1, .why = "that is more than two turns"},
    {"platform.#.hinge_at", "its distance from the body that carries it", .unit = "m", WHEEL_BASE,
     NO_LOW, .high = 2, .form = PLAUSIBLE_NORM, .why = "the platform is on the vehicle"},
    {"platform.#.center", "its distance from the hinge", .unit = "m", WHEEL_BASE, NO_LOW, .high = 2,
     .form = PLAUSIBLE_NORM, .why = "the platform is on the vehicle"},
    {"platform.#.inertia", "the radius of gyration about y", .unit = "m", WHEEL_BASE, .low = 0.005,
     .high = 1, .form = PLAUSIBLE_GYRATION, .a = "platform.#.inertia.y", .b = "platform.#.mass",
     .why = "the platform is on the vehicle and has a size"},
    {"platform.#.stabiliser.kp", "the frequency of the hinge", .unit = "Hz", .low = 0.1,
     .high = 100, .form = PLAUSIBLE_FREQUENCY, .b = "the inertia that the hinge turns",
     .when = "a free hinge", .of = "tubes.layout.first",
     .why = "a stabiliser is stiffer than a pendulum, and no drive is faster"},
    {"platform.#.lock.stiffness", "the frequency of the hinge", .unit = "Hz", .low = 0.1,
     .high = 1000, .form = PLAUSIBLE_FREQUENCY, .b = "the inertia that the hinge turns",
     .of = "tubes.layout.first", .why = "a lock is stiffer than a pendulum and softer than rock"},
    {"platform.#.friction.viscous", "the decay time of the hinge's motion", .unit = "s",
     .other = "run.max_step", .low = 0.05, NO_HIGH, .form = PLAUSIBLE_DECAY,
     .b = "the inertia that the hinge turns",
     .why = "the integrator needs many short steps to follow it"},
    {"platform.#.stabiliser.kd", "the decay time of the hinge's motion", .unit = "s",
     .other = "run.max_step", .low = 0.05, NO_HIGH, .form = PLAUSIBLE_DECAY,
     .b = "the inertia that the hinge turns", .when = "a free hinge",
     .why = "the integrator needs many short steps to follow it"},
    {"platform.#.lock.damping", "the decay time of the hinge's motion", .unit = "s",
     .other = "run.max_step", .low = 0.05, NO_HIGH, .form = PLAUSIBLE_DECAY,
     .b = "the inertia that the hinge turns",
     .why = "the integrator needs many short steps to follow it"},
    {"platform.#.stabiliser.command", "the greatest rate", .unit = "rad/s", NO_LOW, .high = 2 * PI,
     .find = command_rate, .why = "that is more than a turn in a second"},
    {"platform.#.friction.coulomb", .unit = "N.m", .other = "platform.#.stabiliser.torque_limit",
     NO_LOW, .high = 0.5, .why = "friction takes most of the torque"},
    {"platform.#.friction.rate", .unit = "rad/s", NO_LOW, .high = 0.1,
     .why = "it only smooths friction near zero speed"},
    {0}};
