#include "systems/stabiliser.h"

#include <math.h>

static const double TWO_PI = 6.283185307179586476925286766559;

bool stabiliser_has_drive(const ld_stabiliser *given)
{
    return given->bandwidth > 0;
}

void stabiliser_rest(const ld_stabiliser *given, double torque, double *drive)
{
    (void)given;
    drive[DRIVE_TORQUE] = torque;
}

// Torque that the loops ask for, within its limit; rate of their integral z.
static double ask(const ld_stabiliser *given, double z, hinge_report *hinge, double *z_dot)
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
static double follow(const ld_stabiliser *given, double torque, double asked)
{
    double rate = TWO_PI * given->bandwidth * (asked - torque);
    return given->slew > 0 && fabs(rate) > given->slew ? copysign(given->slew, rate) : rate;
}

void stabiliser_evaluate(const ld_stabiliser *given, double z, const double *drive,
                         hinge_report *hinge, double *z_dot, double *drive_dot)
{
    double asked = ask(given, z, hinge, z_dot);
    hinge->torque = asked;
    if (given->bandwidth > 0) {
        hinge->torque = drive[DRIVE_TORQUE];
        drive_dot[DRIVE_TORQUE] = follow(given, hinge->torque, asked);
    }
}
