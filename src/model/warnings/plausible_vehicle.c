// Plausibility of a vehicle: wheels, road, chassis and platforms.
#include "math/functions.h"
#include "model/model.h"
#include "model/parts.h"
#include "model/warnings/estimates.h"
#include "model/warnings/plausible.h"

#define PI 3.14159265358979323846
#define FIND(name) static plausible_pair name(const plausible_entry *at)

static const ld_vehicle *vehicle_of(const plausible_entry *at)
{
    return &at->model->base.vehicle;
}

// From the least to the greatest coordinate of the wheels along an axis [m].
static void wheel_span(const ld_vehicle *vehicle, int axis, double span[2])
{
    span[0] = INFINITY;
    span[1] = -INFINITY;
    for (int i = 0; i < vehicle->wheel_count; i++) {
        span[0] = fmin(span[0], vehicle->wheel[i].mount[axis]);
        span[1] = fmax(span[1], vehicle->wheel[i].mount[axis]);
    }
}

static double wheel_base(const ld_vehicle *vehicle, int axis)
{
    double span[2];
    wheel_span(vehicle, axis, span);
    return span[1] - span[0];
}

// ---- wheels

FIND(wheel_distance)
{
    const ld_wheel *wheel = vehicle_of(at)->wheel, *own = &wheel[at->i];
    double nearest = INFINITY;
    for (int i = 0; i < at->i; i++)
        nearest = fmin(nearest,
                       hypot(own->mount[0] - wheel[i].mount[0], own->mount[2] - wheel[i].mount[2]));
    return plausible_compare(nearest, vehicle_of(at)->tyre.radius);
}

FIND(tyre_deflection)
{
    const ld_vehicle *vehicle = vehicle_of(at);
    double load =
        (estimate_sprung_mass(at->model) / vehicle->wheel_count + vehicle->wheel[0].mass) *
        at->model->gravity;
    return plausible_compare(load / vehicle->tyre.stiffness[1], vehicle->tyre.radius);
}

FIND(hop_frequency)
{
    const ld_vehicle *vehicle = vehicle_of(at);
    double stiffness = vehicle->tyre.stiffness[1] + vehicle->suspension.stiffness[1];
    return plausible_alone(sqrt(stiffness / vehicle->wheel[0].mass) / (2 * PI));
}

FIND(heave_frequency)
{
    return plausible_alone(estimate_heave_frequency(at->model));
}

FIND(heave_damping)
{
    const ld_vehicle *vehicle = vehicle_of(at);
    double mass = estimate_sprung_mass(at->model) / vehicle->wheel_count;
    double critical = 2 * sqrt(vehicle->suspension.stiffness[1] * mass);
    return plausible_alone(vehicle->suspension.damping[1] / critical);
}

FIND(stop_by_sag)
{
    const ld_vehicle *vehicle = vehicle_of(at);
    double load = estimate_sprung_mass(at->model) / vehicle->wheel_count * at->model->gravity;
    return plausible_compare(vehicle->suspension.bump_stop.compression,
                             load / vehicle->suspension.stiffness[1]);
}

FIND(drive_time)
{
    const ld_vehicle *vehicle = vehicle_of(at);
    double time = estimate_sprung_mass(at->model) / vehicle->drive.kp;
    return plausible_alone(vehicle->speed > 0 ? time : NAN);
}

// ---- chassis

FIND(chassis_mass)
{
    return plausible_compare(at->model->platform.chassis_mass, estimate_carried_mass(at->model));
}

FIND(chassis_roll)
{
    const ld_platform *platform = &at->model->platform;
    return plausible_compare(sqrt(platform->chassis_inertia[0] / platform->chassis_mass),
                             wheel_base(vehicle_of(at), 2));
}

FIND(chassis_pitch)
{
    const ld_platform *platform = &at->model->platform;
    return plausible_compare(sqrt(platform->chassis_inertia[2] / platform->chassis_mass),
                             wheel_base(vehicle_of(at), 0));
}

// Where the chassis' mass centre stands between the outermost wheels: 0 to 1.
static plausible_pair place_between(const plausible_entry *at, int axis)
{
    double span[2];
    wheel_span(vehicle_of(at), axis, span);
    return plausible_alone(-span[0] / (span[1] - span[0]));
}

FIND(place_along)
{
    return place_between(at, 0);
}

FIND(place_across)
{
    return place_between(at, 2);
}

// ---- jet

FIND(jet_force)
{
    const ld_platform *platform = &at->model->platform;
    const ld_table *jet = &platform->jet;
    double most = 0;
    for (size_t i = 0; i < jet->rows; i++)
        most = fmax(most, jet->data[2 * i + 1]);
    return plausible_compare(most * platform->jet_scale,
                             estimate_peak_thrust(&at->model->rocket.motor));
}

FIND(jet_reach)
{
    const ld_table *jet = &at->model->platform.jet;
    double reach = jet->rows > 0 ? jet->data[2 * (jet->rows - 1)] : NAN;
    return plausible_compare(reach, at->model->tubes.length);
}

FIND(jet_scale)
{
    double scale = at->model->platform.jet_scale;
    return plausible_alone(model_has_jet(at->model) && scale > 0 ? scale : NAN);
}

// ---- platforms

static plausible_pair hinge_place(const plausible_entry *at, const ld_turret *turret)
{
    return plausible_compare(plausible_norm(turret->hinge_at), wheel_base(vehicle_of(at), 0));
}

static plausible_pair turret_center(const plausible_entry *at, const ld_turret *turret)
{
    return plausible_compare(plausible_norm(turret->center), wheel_base(vehicle_of(at), 0));
}

static plausible_pair turret_gyration(const plausible_entry *at, const ld_turret *turret)
{
    return plausible_compare(sqrt(turret->inertia[1] / turret->mass),
                             wheel_base(vehicle_of(at), 0));
}

// Frequency of a hinge with what it carries on a spring.
static plausible_pair hinge_frequency(const plausible_entry *at, double stiffness, double inertia)
{
    return plausible_alone(sqrt(stiffness / (inertia + estimate_tubes_inertia(at->model))) /
                           (2 * PI));
}

// Time [s] in which a damper [N m s/rad] of a hinge takes the motion of what it carries.
static plausible_pair hinge_time(const plausible_entry *at, double damping, double inertia)
{
    if (!(damping > 0))
        return plausible_nothing();
    return plausible_compare((inertia + estimate_tubes_inertia(at->model)) / damping,
                             at->model->run.max_step);
}

// Decay time [s] of a wheel's motion by a damper [N s/m].
static plausible_pair wheel_time(const plausible_entry *at, double damping)
{
    if (!(damping > 0))
        return plausible_nothing();
    return plausible_compare(vehicle_of(at)->wheel[0].mass / damping, at->model->run.max_step);
}

FIND(tyre_time)
{
    return wheel_time(at, vehicle_of(at)->tyre.damping[1]);
}

FIND(suspension_time_along)
{
    return wheel_time(at, vehicle_of(at)->suspension.damping[0]);
}

FIND(suspension_time_across)
{
    return wheel_time(at, vehicle_of(at)->suspension.damping[2]);
}

FIND(azimuth_angle)
{
    const ld_table *command = &at->model->platform.azimuth.stabiliser.command;
    double most = 0;
    for (size_t i = 0; i < command->rows; i++)
        most = fmax(most, fabs(command->data[2 * i + 1]));
    return plausible_alone(most);
}

static plausible_pair greatest_slew(const ld_table *command)
{
    double most = 0;
    for (size_t i = 1; i < command->rows; i++) {
        const double *a = &command->data[2 * (i - 1)], *b = &command->data[2 * i];
        most = fmax(most, fabs(b[1] - a[1]) / (b[0] - a[0]));
    }
    return plausible_alone(most);
}

#define OF_PLATFORM(name, about)                                                                   \
    FIND(name##_hinge)                                                                             \
    {                                                                                              \
        return hinge_place(at, &at->model->platform.name);                                         \
    }                                                                                              \
    FIND(name##_center)                                                                            \
    {                                                                                              \
        return turret_center(at, &at->model->platform.name);                                       \
    }                                                                                              \
    FIND(name##_gyration)                                                                          \
    {                                                                                              \
        return turret_gyration(at, &at->model->platform.name);                                     \
    }                                                                                              \
    FIND(name##_frequency)                                                                         \
    {                                                                                              \
        const ld_turret *turret = &at->model->platform.name;                                       \
        double kp = turret->lock.present ? NAN : turret->stabiliser.kp;                            \
        return hinge_frequency(at, kp, turret->inertia[about]);                                    \
    }                                                                                              \
    FIND(name##_lock)                                                                              \
    {                                                                                              \
        const ld_turret *turret = &at->model->platform.name;                                       \
        return hinge_frequency(at, turret->lock.stiffness, turret->inertia[about]);                \
    }                                                                                              \
    FIND(name##_viscous)                                                                           \
    {                                                                                              \
        const ld_turret *turret = &at->model->platform.name;                                       \
        return hinge_time(at, turret->friction.viscous, turret->inertia[about]);                   \
    }                                                                                              \
    FIND(name##_kd)                                                                                \
    {                                                                                              \
        const ld_turret *turret = &at->model->platform.name;                                       \
        double kd = turret->lock.present ? NAN : turret->stabiliser.kd;                            \
        return hinge_time(at, kd, turret->inertia[about]);                                         \
    }                                                                                              \
    FIND(name##_lock_damping)                                                                      \
    {                                                                                              \
        const ld_turret *turret = &at->model->platform.name;                                       \
        double damping = turret->lock.present ? turret->lock.damping : NAN;                        \
        return hinge_time(at, damping, turret->inertia[about]);                                    \
    }                                                                                              \
    FIND(name##_slew)                                                                              \
    {                                                                                              \
        return greatest_slew(&at->model->platform.name.stabiliser.command);                        \
    }
OF_PLATFORM(azimuth, 1)
OF_PLATFORM(elevation, 2)

#define NO_LOW .low = -INFINITY
#define NO_HIGH .high = INFINITY
#define WHEEL_BASE .other = "the distance of front and rear wheels"

#define PLATFORM_RULES(name)                                                                       \
    {"platform." #name ".hinge_at",                                                                \
     "its distance from the body that carries it",                                                 \
     .unit = "m",                                                                                  \
     WHEEL_BASE,                                                                                   \
     NO_LOW,                                                                                       \
     .high = 2,                                                                                    \
     .find = name##_hinge,                                                                         \
     .why = "the platform is on the vehicle"},                                                     \
        {"platform." #name ".center",                                                              \
         "its distance from the hinge",                                                            \
         .unit = "m",                                                                              \
         WHEEL_BASE,                                                                               \
         NO_LOW,                                                                                   \
         .high = 2,                                                                                \
         .find = name##_center,                                                                    \
         .why = "the platform is on the vehicle"},                                                 \
        {"platform." #name ".inertia",                                                             \
         "the radius of gyration about y",                                                         \
         .unit = "m",                                                                              \
         WHEEL_BASE,                                                                               \
         .low = 0.005,                                                                             \
         .high = 1,                                                                                \
         .find = name##_gyration,                                                                  \
         .why = "the platform is on the vehicle and has a size"},                                  \
        {"platform." #name ".stabiliser.kp",                                                       \
         "the frequency of the hinge",                                                             \
         .unit = "Hz",                                                                             \
         .low = 0.1,                                                                               \
         .high = 100,                                                                              \
         .find = name##_frequency,                                                                 \
         .of = "tubes.layout.first",                                                               \
         .why = "a stabiliser is stiffer than a pendulum, and no drive is faster"},                \
        {"platform." #name ".lock.stiffness",                                                      \
         "the frequency of the hinge",                                                             \
         .unit = "Hz",                                                                             \
         .low = 0.1,                                                                               \
         .high = 1000,                                                                             \
         .find = name##_lock,                                                                      \
         .of = "tubes.layout.first",                                                               \
         .why = "a lock is stiffer than a pendulum and softer than rock"},                         \
        {"platform." #name ".friction.viscous",                                                    \
         "the decay time of the hinge's motion",                                                   \
         .unit = "s",                                                                              \
         .other = "run.max_step",                                                                  \
         .low = 0.05,                                                                              \
         NO_HIGH,                                                                                  \
         .find = name##_viscous,                                                                   \
         .why = "the integrator needs many short steps to follow it"},                             \
        {"platform." #name ".stabiliser.kd",                                                       \
         "the decay time of the hinge's motion",                                                   \
         .unit = "s",                                                                              \
         .other = "run.max_step",                                                                  \
         .low = 0.05,                                                                              \
         NO_HIGH,                                                                                  \
         .find = name##_kd,                                                                        \
         .why = "the integrator needs many short steps to follow it"},                             \
        {"platform." #name ".lock.damping",                                                        \
         "the decay time of the hinge's motion",                                                   \
         .unit = "s",                                                                              \
         .other = "run.max_step",                                                                  \
         .low = 0.05,                                                                              \
         NO_HIGH,                                                                                  \
         .find = name##_lock_damping,                                                              \
         .why = "the integrator needs many short steps to follow it"},                             \
        {"platform." #name ".stabiliser.command",                                                  \
         "the greatest rate",                                                                      \
         .unit = "rad/s",                                                                          \
         NO_LOW,                                                                                   \
         .high = 2 * PI,                                                                           \
         .find = name##_slew,                                                                      \
         .why = "that is more than a turn in a second"},                                           \
        {"platform." #name ".friction.coulomb",                                                    \
         .unit = "N.m",                                                                            \
         .other = "platform." #name ".stabiliser.torque_limit",                                    \
         NO_LOW,                                                                                   \
         .high = 0.5,                                                                              \
         .why = "friction takes most of the torque"},                                              \
    {                                                                                              \
        "platform." #name ".friction.rate", .unit = "rad/s", NO_LOW, .high = 0.1,                  \
                                            .why = "it only smooths friction near zero speed"      \
    }

const plausible_rule plausible_of_vehicle[] = {
    {"base.speed", .unit = "m/s", NO_LOW, .high = 60,
     .why = "no launcher marches faster than 216 km/h"},
    {"base.wheels", "the chassis' mass centre from rear (0) to front wheels (1)", .unit = "",
     .low = 0, .high = 1, .find = place_along, .why = "the vehicle tips over"},
    {"base.wheels", "the chassis' mass centre from left (0) to right wheels (1)", .unit = "",
     .low = 0, .high = 1, .find = place_across, .why = "the vehicle tips over"},
    {"base.wheels.#.mount", "the distance from the nearest wheel before it", .unit = "m",
     .other = "base.tyre.radius", .low = 0.25, NO_HIGH, .find = wheel_distance,
     .why = "two wheels cannot be at one position"},
    {"base.wheels.#.mount.y", .unit = "m", .other = "base.tyre.radius", NO_LOW, .high = 1,
     .why = "the chassis' mass centre lies below the road"},
    {"base.wheels.#.mass", .unit = "kg", .other = "platform.chassis.mass", .low = 1e-4, .high = 0.5,
     .why = "wheels are a small part of a vehicle"},
    {"base.drive.kp", "the vehicle's mass over it (the time to take up an error)", .unit = "s",
     .low = 0.01, .high = 100, .find = drive_time, .why = "a driver takes about a second"},
    {"base.suspension.stiffness.y", "the heave frequency of the vehicle", .unit = "Hz", .low = 0.3,
     .high = 30, .find = heave_frequency, .why = "that of lorries is 1 Hz to 3 Hz"},
    {"base.suspension.damping.y", "the damping ratio of the heave", .unit = "", NO_LOW, .high = 2,
     .find = heave_damping, .of = "base.suspension.stiffness.y",
     .why = "that of lorries is 0.2 to 0.5"},
    {"base.suspension.damping.x", "the decay time of a wheel's motion", .unit = "s",
     .other = "run.max_step", .low = 0.05, NO_HIGH, .find = suspension_time_along,
     .of = "base.wheels.#.mass", .why = "the integrator needs many short steps to follow it"},
    {"base.suspension.damping.z", "the decay time of a wheel's motion", .unit = "s",
     .other = "run.max_step", .low = 0.05, NO_HIGH, .find = suspension_time_across,
     .of = "base.wheels.#.mass", .why = "the integrator needs many short steps to follow it"},
    {"base.suspension.bump_stop.compression", .unit = "m", .other = "the static travel", .low = 1,
     NO_HIGH, .find = stop_by_sag, .of = "base.suspension.stiffness.y",
     .why = "the vehicle stands on its stops"},
    {"base.tyre.radius", .unit = "m", .low = 0.1, .high = 2.5,
     .why = "tyres of lorries have 0.4 m to 0.8 m"},
    {"base.tyre.stiffness.y", "the tyre's static deflection", .unit = "m",
     .other = "base.tyre.radius", NO_LOW, .high = 0.3, .find = tyre_deflection,
     .why = "the tyre is flat"},
    {"base.tyre.stiffness.y", "the frequency of a wheel between tyre and suspension", .unit = "Hz",
     .low = 1, .high = 200, .find = hop_frequency, .of = "base.suspension.stiffness.y",
     .why = "that of lorries is about 10 Hz"},
    {"base.tyre.damping.y", "the decay time of a wheel's motion", .unit = "s",
     .other = "run.max_step", .low = 0.05, NO_HIGH, .find = tyre_time, .of = "base.wheels.#.mass",
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
     .find = chassis_mass, .why = "the chassis carries all of them"},
    {"platform.chassis.inertia.x", "the radius of gyration about x", .unit = "m",
     .other = "the distance of left and right wheels", .low = 0.05, .high = 2, .find = chassis_roll,
     .of = "platform.chassis.mass",
     .why = "the chassis is about as large as its wheelbase and track"},
    {"platform.chassis.inertia.z", "the radius of gyration about z", .unit = "m", WHEEL_BASE,
     .low = 0.05, .high = 2, .find = chassis_pitch, .of = "platform.chassis.mass",
     .why = "the chassis is about as large as its wheelbase and track"},
    {"platform.jet", "the greatest force", .unit = "N", .other = "the greatest thrust", NO_LOW,
     .high = 1, .find = jet_force, .why = "the force of a jet is at most the thrust"},
    {"platform.jet", "the distance at which it ends", .unit = "m", .other = "tubes.length",
     .low = 0.02, .high = 50, .find = jet_reach,
     .why = "a jet acts up to some tube lengths from the tip"},
    {"platform.jet_scale", .unit = "", .low = 0.1, .high = 10, .find = jet_scale,
     .why = "it is a correction of the table"},
    {"platform.azimuth.stabiliser.command", "the greatest angle", .unit = "rad", NO_LOW,
     .high = 4 * PI, .find = azimuth_angle, .why = "that is more than two turns"},
    PLATFORM_RULES(azimuth),
    PLATFORM_RULES(elevation),
    {0}};
