// Plausibility of the stabilisers' options.
#include "model/model.h"
#include "model/warnings/estimates.h"
#include "model/warnings/plausible.h"

#define PI 3.14159265358979323846

// A hinge's loop, be it a PID or a cascade, as the PID that it is the same as; NaN where a lock
// holds the hinge.
typedef struct hinge_loop {
    const ld_stabiliser *given;
    double kp, kd;   // [N m/rad], [N m s/rad]
    double inertia;  // [kg m2] of what the hinge turns
    double time;     // [s] in which kd takes its motion
    double max_step; // [s]
} hinge_loop;

static hinge_loop loop_of(const plausible_entry *at, const ld_turret *turret)
{
    const ld_platform *platform = &at->model->platform;
    const ld_stabiliser *given = &turret->stabiliser;
    const ld_cascade *two = &given->cascade;
    hinge_loop loop = {.given = given,
                       .kp = two->present ? two->rate_kp * two->kp + two->rate_ki : given->kp,
                       .kd = two->present ? two->rate_kp : given->kd};
    loop.inertia = turret->inertia[turret == &platform->azimuth ? 1 : 2];
    loop.inertia += estimate_tubes_inertia(at->model);
    loop.max_step = at->model->run.max_step;
    if (turret->lock.present)
        loop.kp = loop.kd = loop.inertia = loop.max_step = NAN;
    loop.time = loop.kd > 0 ? loop.inertia / loop.kd : NAN;
    return loop;
}

// An option's value, where it is not off.
static double on(double value)
{
    return value > 0 ? value : NAN;
}

#define OF_LOOP(name, value, other)                                                                \
    static plausible_pair name(const hinge_loop *loop)                                             \
    {                                                                                              \
        return plausible_compare(value, other);                                                    \
    }                                                                                              \
    static plausible_pair azimuth_##name(const plausible_entry *at)                                \
    {                                                                                              \
        hinge_loop loop = loop_of(at, &at->model->platform.azimuth);                               \
        return name(&loop);                                                                        \
    }                                                                                              \
    static plausible_pair elevation_##name(const plausible_entry *at)                              \
    {                                                                                              \
        hinge_loop loop = loop_of(at, &at->model->platform.elevation);                             \
        return name(&loop);                                                                        \
    }

OF_LOOP(cascade_kp, loop->given->cascade.kp, 1 / loop->time)
OF_LOOP(bandwidth, on(loop->given->bandwidth), loop->kp / loop->kd / (2 * PI))
OF_LOOP(slew_time, loop->given->torque_limit / on(loop->given->slew), isnan(loop->kd) ? NAN : 1)
OF_LOOP(sample, on(loop->given->sample), loop->time)
OF_LOOP(sample_step, on(loop->given->sample), loop->max_step)
OF_LOOP(late, on(loop->given->delay) + loop->given->sample / 2, loop->time)
OF_LOOP(angle_noise, loop->kp * loop->given->noise.angle, loop->given->torque_limit)
OF_LOOP(rate_noise, loop->kd * loop->given->noise.rate, loop->given->torque_limit)
OF_LOOP(angle_step, loop->kp * loop->given->resolution.angle, loop->given->torque_limit)
OF_LOOP(rate_step, loop->kd * loop->given->resolution.rate, loop->given->torque_limit)
OF_LOOP(gear_frequency, sqrt(loop->given->gear.stiffness / loop->inertia) / (2 * PI), 1)
OF_LOOP(motor, loop->given->gear.inertia, loop->inertia)
OF_LOOP(backlash, loop->given->gear.backlash, loop->given->torque_limit / loop->kp)

#define NO_LOW .low = -INFINITY
#define NO_HIGH .high = INFINITY
#define STABILISER(name) "platform." #name ".stabiliser"
#define TORQUE_LIMIT(name) .unit = "N.m", .other = STABILISER(name) ".torque_limit"
#define RATE_TIME .unit = "s", .other = "the decay time by the rate gain"

// clang-format off
#define RULES(name)                                                                                \
    {STABILISER(name) ".cascade.kp", .unit = "1/s",                                                \
     .other = "rate_kp over the inertia that the hinge turns", NO_LOW, .high = 1,                  \
     .find = name##_cascade_kp, .why = "the angle loop is faster than the rate loop"},   \
    {STABILISER(name) ".bandwidth", .unit = "Hz", .other = "the loop's kp over kd",    \
     .low = 2, NO_HIGH, .find = name##_bandwidth,                                                  \
     .why = "a loop with such a slow actuator oscillates"},                                             \
    {STABILISER(name) ".slew", "the time in which the torque reaches its limit", .unit = "s",      \
     NO_LOW, .high = 0.3, .find = name##_slew_time,                                                \
     .why = "large motions then grow; no check before the run detects it"},         \
    {STABILISER(name) ".sample", RATE_TIME, NO_LOW, .high = 2, .find = name##_sample,              \
     .why = "the loop oscillates from sample to sample"},                                  \
    {STABILISER(name) ".sample", .unit = "s", .other = "run.max_step", .low = 0.1, NO_HIGH,        \
     .find = name##_sample_step, .why = "each sample ends a step of the integration"},             \
    {STABILISER(name) ".delay", "the delay of a torque, half a period included",           \
     RATE_TIME, NO_LOW, .high = 1, .find = name##_late, .of = STABILISER(name) ".sample",          \
     .why = "a loop with such a delay oscillates"},                                                      \
    {STABILISER(name) ".sensor_noise.angle", "the torque that it causes", TORQUE_LIMIT(name),       \
     NO_LOW, .high = 0.3, .find = name##_angle_noise, .why = "noise dominates the torque"},      \
    {STABILISER(name) ".sensor_noise.rate", "the torque that it causes", TORQUE_LIMIT(name),        \
     NO_LOW, .high = 0.3, .find = name##_rate_noise, .why = "noise dominates the torque"},       \
    {STABILISER(name) ".sensor_resolution.angle", "the torque of a step", TORQUE_LIMIT(name),      \
     NO_LOW, .high = 0.3, .find = name##_angle_step,                                               \
     .why = "a few steps of the sensor reach the torque limit"},                                   \
    {STABILISER(name) ".sensor_resolution.rate", "the torque of a step", TORQUE_LIMIT(name),       \
     NO_LOW, .high = 0.3, .find = name##_rate_step,                                                \
     .why = "a few steps of the sensor reach the torque limit"},                                   \
    {STABILISER(name) ".gear.stiffness", "the frequency of the hinge on it", .unit = "Hz",         \
     .low = 1, .high = 1000, .find = name##_gear_frequency, .of = "tubes.layout.first",            \
     .why = "gears are stiffer than a pendulum and softer than rock"},                             \
    {STABILISER(name) ".gear.inertia", .unit = "kg.m2", .other = "the inertia that the hinge turns", \
     .low = 1e-4, .high = 5, .find = name##_motor, .of = "tubes.layout.first",                     \
     .why = "seen from the hinge, a motor has about the inertia of its load"},                     \
    {STABILISER(name) ".gear.backlash", .unit = "rad",                                             \
     .other = "the error at which the torque reaches its limit", NO_LOW, .high = 0.5,                   \
     .find = name##_backlash, .why = "the torque reaches its limit within the backlash"}
// clang-format on

const plausible_rule plausible_of_stabiliser[] = {RULES(azimuth), RULES(elevation), {0}};
