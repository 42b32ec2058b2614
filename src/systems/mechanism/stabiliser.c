#include "systems/mechanism/stabiliser.h"

#include <math.h>

#include "base/random.h"
#include "math/curves/distributions.h"

static const double TWO_PI = 6.283185307179586476925286766559;

bool stabiliser_has_drive(const ld_stabiliser *given)
{
    return given->bandwidth > 0 || given->sample > 0 || given->gear.present;
}

void stabiliser_rest(const ld_stabiliser *given, double torque, double *drive)
{
    const ld_gear *gear = &given->gear;
    drive[DRIVE_TORQUE] = drive[DRIVE_HELD] = drive[DRIVE_COMPUTED] = torque;
    drive[DRIVE_TWIST] =
        gear->present ? torque / gear->stiffness + copysign(0.5 * gear->backlash, torque) : 0;
    drive[DRIVE_RATE] = 0;
}

// Torque that the loops ask for, within its limit; rate of their integral z.
static double commanded_torque(const ld_stabiliser *given, double z, hinge_report *hinge,
                               double *z_dot)
{
    const ld_cascade *cascade = &given->cascade;
    double rate_command = hinge->command_rate - given->feedforward * hinge->base_rate;
    double e = hinge->error, e_dot = rate_command - hinge->measured_rate;
    double limit = given->torque_limit, wanted;
    if (cascade->present) {
        double rate_error = cascade->kp * e + e_dot;
        wanted = cascade->rate_kp * rate_error + z;
        *z_dot = cascade->rate_ki * rate_error;
    } else {
        wanted = given->kp * e + given->kd * e_dot + z;
        *z_dot = given->ki * e;
    }
    if (fabs(z) >= limit && z * *z_dot > 0)
        *z_dot = 0;
    hinge->limited = fabs(wanted) >= limit;
    return hinge->limited ? copysign(limit, wanted) : wanted;
}

// Rate of the torque of an actuator that is asked for another.
static double actuator_rate(const ld_stabiliser *given, double torque, double asked)
{
    double rate = TWO_PI * given->bandwidth * (asked - torque);
    return given->slew > 0 && fabs(rate) > given->slew ? copysign(given->slew, rate) : rate;
}

// Torque of a gear on the hinge; teeth push and do not pull, unless they are `stuck` together.
static double gear_torque(const ld_gear *gear, bool stuck, double twist, double twist_rate)
{
    double pressed = twist - copysign(0.5 * gear->backlash, twist);
    double torque = gear->stiffness * pressed + gear->damping * twist_rate;
    bool push = pressed * twist > 0 && torque * twist > 0;
    return push || stuck || gear->backlash == 0 ? torque : 0;
}

// NOLINTNEXTLINE(readability-function-size)
void stabiliser_evaluate(const ld_stabiliser *given, bool linear, double z, const double *drive,
                         hinge_report *hinge, double *z_dot, double *drive_dot)
{
    double asked;
    if (given->sample > 0 && !linear) {
        asked = drive[DRIVE_HELD];
        hinge->limited = fabs(asked) >= given->torque_limit;
        *z_dot = 0;
    } else {
        asked = commanded_torque(given, z, hinge, z_dot);
    }
    hinge->torque = asked;
    if (given->bandwidth > 0) {
        hinge->torque = drive[DRIVE_TORQUE];
        drive_dot[DRIVE_TORQUE] = actuator_rate(given, hinge->torque, asked);
    }
    if (given->gear.present) {
        double motor = hinge->torque, twist_rate = drive[DRIVE_RATE] - hinge->rate;
        hinge->torque = gear_torque(&given->gear, linear, drive[DRIVE_TWIST], twist_rate);
        drive_dot[DRIVE_TWIST] = twist_rate;
        drive_dot[DRIVE_RATE] = (motor - hinge->torque) / given->gear.inertia;
    }
}

// ---- digital loops

// The first of the instants k period + after behind t; which one it is.
static double instant_behind(double t, double period, double after, double *k)
{
    *k = floor((t - after) / period) - 1; // rounding may have taken it one too far
    while (*k * period + after <= t)
        ++*k;
    return *k * period + after;
}

// Whether t is one of those instants, and which one.
static bool is_instant(double t, double period, double after, double *k)
{
    return instant_behind(nextafter(t, -INFINITY), period, after, k) == t;
}

// A torque that is late by a whole period is given out with the next sample.
static bool is_late_between(const ld_stabiliser *given)
{
    return given->delay > 0 && given->delay < given->sample;
}

double stabiliser_next_sample(const ld_stabiliser *given, double t)
{
    double unused;
    if (!(given->sample > 0))
        return INFINITY;
    double next = instant_behind(t, given->sample, 0, &unused);
    if (is_late_between(given))
        next = fmin(next, instant_behind(t, given->sample, given->delay, &unused));
    return next;
}

// A value as a sensor reports it.
static double measured_value(double value, double noise, double resolution, double normal)
{
    double heard = value + noise * normal;
    return resolution > 0 ? resolution * nearbyint(heard / resolution) : heard;
}

// Angle and rate as sample k has them.
static void take_sample(const ld_stabiliser *given, double k, uint64_t stream, hinge_report *hinge)
{
    const ld_sensor_noise *noise = &given->noise;
    double normal[2], angle = hinge->measured;
    for (int i = 0; i < 2; i++)
        normal[i] = normal_quantile(
            random_uniform((uint64_t)noise->seed, stream, (uint64_t)(int64_t)k, (uint64_t)i, 0));
    hinge->measured = measured_value(angle, noise->angle, given->resolution.angle, normal[0]);
    hinge->error -= hinge->measured - angle;
    hinge->measured_rate =
        measured_value(hinge->measured_rate, noise->rate, given->resolution.rate, normal[1]);
}

void stabiliser_sample(const ld_stabiliser *given, double t, uint64_t stream,
                       const hinge_report *hinge, double *z, double *drive)
{
    double k, unused, z_dot, limit = given->torque_limit;
    bool samples = is_instant(t, given->sample, 0, &k);
    if (is_late_between(given) ? is_instant(t, given->sample, given->delay, &unused) : samples)
        drive[DRIVE_HELD] = drive[DRIVE_COMPUTED];
    if (!samples)
        return;
    hinge_report heard = *hinge;
    take_sample(given, k, stream, &heard);
    drive[DRIVE_COMPUTED] = commanded_torque(given, *z, &heard, &z_dot);
    if (given->delay == 0)
        drive[DRIVE_HELD] = drive[DRIVE_COMPUTED];
    *z += given->sample * z_dot;
    if (fabs(*z) > limit)
        *z = copysign(limit, *z);
}
