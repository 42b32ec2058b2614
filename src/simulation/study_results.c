#include "simulation/study_results.h"

#include <math.h>
#include <string.h>

#define OF(member) offsetof(ld_rocket_summary, member)

const study_result study_results[STUDY_RESULTS + 1] = {
    {"t_ignition", "s", OF(t_ignition)},
    {"t_release", "s", OF(t_release)},
    {"t_front", "s", OF(t_front)},
    {"t_middle", "s", OF(t_middle)},
    {"t_rear", "s", OF(t_rear)},
    {"muzzle_speed", "m/s", OF(muzzle_speed)},
    {"inertial_speed", "m/s", OF(inertial_speed)},
    {"spin_rate", "rad/s", OF(spin_rate)},
    {"pitch", "rad", OF(pitch)},
    {"yaw", "rad", OF(yaw)},
    {"pitch_rate", "rad/s", OF(pitch_rate)},
    {"yaw_rate", "rad/s", OF(yaw_rate)},
    {"exit.x", "m", OF(exit.position[0])},
    {"exit.y", "m", OF(exit.position[1])},
    {"exit.z", "m", OF(exit.position[2])},
    {"exit.vx", "m/s", OF(exit.velocity[0])},
    {"exit.vy", "m/s", OF(exit.velocity[1])},
    {"exit.vz", "m/s", OF(exit.velocity[2])},
    {"tip.y", "m", OF(tip.y)},
    {"tip.z", "m", OF(tip.z)},
    {"tip.pitch", "rad", OF(tip.pitch)},
    {"tip.yaw", "rad", OF(tip.yaw)},
    {"tip.vy", "m/s", OF(tip.vy)},
    {"tip.vz", "m/s", OF(tip.vz)},
    {"tip.pitch_rate", "rad/s", OF(tip.pitch_rate)},
    {"tip.yaw_rate", "rad/s", OF(tip.yaw_rate)},
    {"tip_off.pitch", "rad", OF(tip_off.pitch)},
    {"tip_off.yaw", "rad", OF(tip_off.yaw)},
    {"tip_off.pitch_rate", "rad/s", OF(tip_off.pitch_rate)},
    {"tip_off.yaw_rate", "rad/s", OF(tip_off.yaw_rate)},
    {"tip_off.pitch_rate_relative", "rad/s", OF(tip_off.pitch_rate_relative)},
    {"tip_off.yaw_rate_relative", "rad/s", OF(tip_off.yaw_rate_relative)},
    {"tip_off.vy", "m/s", OF(tip_off.vy)},
    {"tip_off.vz", "m/s", OF(tip_off.vz)},
    {"tip_off.vy_relative", "m/s", OF(tip_off.vy_relative)},
    {"tip_off.vz_relative", "m/s", OF(tip_off.vz_relative)},
    {"aim.pitch", "rad", OF(aim.pitch)},
    {"aim.yaw", "rad", OF(aim.yaw)},
    {"aim.pitch_rate", "rad/s", OF(aim.pitch_rate)},
    {"aim.yaw_rate", "rad/s", OF(aim.yaw_rate)},
    {"aim.vy", "m/s", OF(aim.vy)},
    {"aim.vz", "m/s", OF(aim.vz)},
    {"apogee", "m", OF(flight.apogee)},
    {"downrange", "m", OF(flight.downrange)},
    {"drift", "m", OF(flight.drift)},
    {"range", "m", OF(flight.range)},
    {"t_impact", "s", OF(flight.t_impact)},
    {"time_of_flight", "s", OF(flight.time_of_flight)},
    {"impact_speed", "m/s", OF(flight.impact_speed)},
    {"impact_angle", "rad", OF(flight.impact_angle)},
    {"max_mach", "", OF(flight.max_mach)},
    {"max_angle_of_attack", "rad", OF(flight.max_angle_of_attack)},
    {NULL, NULL, 0},
};

const study_result *study_result_named(const char *name)
{
    for (const study_result *r = study_results; r->name; r++)
        if (strcmp(r->name, name) == 0)
            return r;
    return NULL;
}

const study_pair study_pairs[STUDY_PAIRS] = {
    {"Landing points", {"downrange", "drift"}, "m"},
    {"Attitude at the exit", {"pitch", "yaw"}, "rad"},
    {"Rates at the exit", {"pitch_rate", "yaw_rate"}, "rad/s"},
    {"Attitude at the exit, against the launcher", {"tip_off.pitch", "tip_off.yaw"}, "rad"},
    {"Rates at the exit, launcher's axes", {"tip_off.pitch_rate", "tip_off.yaw_rate"}, "rad/s"},
};

double study_result_of(const ld_rocket_summary *rocket, const study_result *result)
{
    // the state at the exit is there only where it has left, flight results where it has flown
    bool in_flight = result->offset >= OF(flight), at_exit = result->offset >= OF(exit);
    if (in_flight ? !rocket->flown : at_exit && isnan(rocket->t_rear))
        return NAN;
    return *(const double *)((const char *)rocket + result->offset);
}
