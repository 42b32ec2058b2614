#include "systems/stabiliser.h"

#include <math.h>

double stabiliser_drive(const ld_stabiliser *given, double z, hinge_report *hinge)
{
    double rate_command = hinge->command_rate - given->feedforward * hinge->base_rate;
    double e = hinge->error, e_dot = rate_command - hinge->measured_rate;
    double wanted = given->kp * e + given->kd * e_dot + z, limit = given->torque_limit;
    hinge->limited = fabs(wanted) >= limit;
    hinge->torque = hinge->limited ? copysign(limit, wanted) : wanted;
    return fabs(z) >= limit && z * e > 0 ? 0 : given->ki * e;
}
