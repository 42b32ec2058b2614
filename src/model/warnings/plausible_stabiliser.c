// Plausibility of the stabilisers' options.
#include "model/warnings/plausible_rule.h"

#define HINGE "platform.#.stabiliser."
#define TORQUE_LIMIT .unit = "N.m", .other = HINGE "torque_limit"
#define RATE_TIME .unit = "s", .other = "the decay time by the rate gain"

const plausible_rule plausible_of_stabiliser[] = {
    {HINGE "cascade.kp", .unit = "1/s", .other = "rate_kp over the inertia that the hinge turns",
     NO_LOW, .high = 1, .why = "the angle loop is faster than the rate loop"},
    {HINGE "bandwidth", .unit = "Hz", .other = "the loop's kp over kd", .low = 2, NO_HIGH,
     .when = HINGE "bandwidth", .why = "a loop with such a slow actuator oscillates"},
    {HINGE "slew", "the time in which the torque reaches its limit", .unit = "s", NO_LOW,
     .high = 0.3, .form = PLAUSIBLE_RATIO, .a = HINGE "torque_limit", .b = HINGE "slew",
     .with = "a free hinge", .when = HINGE "slew",
     .why = "large motions then grow; no check before the run detects it"},
    {HINGE "sample", RATE_TIME, NO_LOW, .high = 2, .when = HINGE "sample",
     .why = "the loop oscillates from sample to sample"},
    {HINGE "sample", .unit = "s", .other = "run.max_step", .low = 0.1, NO_HIGH,
     .a = "the sampling period of the loop", .when = HINGE "sample",
     .why = "each sample ends a step of the integration"},
    {HINGE "delay", "the delay of a torque, half a period included", RATE_TIME, NO_LOW, .high = 1,
     .a = "the delay of a torque", .when = HINGE "delay", .of = HINGE "sample",
     .why = "a loop with such a delay oscillates"},
    {HINGE "sensor_noise.angle", "the torque that it causes", TORQUE_LIMIT, NO_LOW, .high = 0.3,
     .form = PLAUSIBLE_PRODUCT, .b = "the loop's angle gain", .why = "noise dominates the torque"},
    {HINGE "sensor_noise.rate", "the torque that it causes", TORQUE_LIMIT, NO_LOW, .high = 0.3,
     .form = PLAUSIBLE_PRODUCT, .b = "the loop's rate gain", .why = "noise dominates the torque"},
    {HINGE "sensor_resolution.angle", "the torque of a step", TORQUE_LIMIT, NO_LOW, .high = 0.3,
     .form = PLAUSIBLE_PRODUCT, .b = "the loop's angle gain",
     .why = "a few steps of the sensor reach the torque limit"},
    {HINGE "sensor_resolution.rate", "the torque of a step", TORQUE_LIMIT, NO_LOW, .high = 0.3,
     .form = PLAUSIBLE_PRODUCT, .b = "the loop's rate gain",
     .why = "a few steps of the sensor reach the torque limit"},
    {HINGE "gear.stiffness", "the frequency of the hinge on it", .unit = "Hz", .low = 1,
     .high = 1000, .form = PLAUSIBLE_FREQUENCY, .b = "the inertia that the hinge turns",
     .when = "a free hinge", .of = "tubes.layout.first",
     .why = "gears are stiffer than a pendulum and softer than rock"},
    {HINGE "gear.inertia", .unit = "kg.m2", .other = "the inertia that the hinge turns",
     .low = 1e-4, .high = 5, .when = "a free hinge", .of = "tubes.layout.first",
     .why = "seen from the hinge, a motor has about the inertia of its load"},
    {HINGE "gear.backlash", .unit = "rad",
     .other = "the error at which the torque reaches its limit", NO_LOW, .high = 0.5,
     .why = "the torque reaches its limit within the backlash"},
    {0}};
