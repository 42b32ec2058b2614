// The history of a free flight: columns and rows.
#include <string.h>

#include "simulation/free_flight.h"
#include "simulation/simulation.h"

static const ld_column common_columns[] = {
    {"t", "s", "time on the run's clock"},
    {"rocket.x", "m", "rear adaptor's centre, in I"},
    {"rocket.y", "m", "rear adaptor's centre, in I"},
    {"rocket.z", "m", "rear adaptor's centre, in I"},
    {"rocket.vx", "m/s", "velocity of the rear adaptor against the ground, in I"},
    {"rocket.vy", "m/s", "velocity of the rear adaptor against the ground, in I"},
    {"rocket.vz", "m/s", "velocity of the rear adaptor against the ground, in I"},
    {"rocket.q0", "1", "quaternion of the rocket against I, scalar part"},
    {"rocket.q1", "1", "quaternion of the rocket against I, x"},
    {"rocket.q2", "1", "quaternion of the rocket against I, y"},
    {"rocket.q3", "1", "quaternion of the rocket against I, z"},
    {"rocket.wx", "rad/s", "rate of the rocket against inertial axes, in B"},
    {"rocket.wy", "rad/s", "rate of the rocket against inertial axes, in B"},
    {"rocket.wz", "rad/s", "rate of the rocket against inertial axes, in B"},
    {"rocket.pitch", "rad", "pitch of the rocket's axis in I"},
    {"rocket.yaw", "rad", "yaw of the rocket's axis in I, positive to the left"},
    {"rocket.pitch_rate", "rad/s", "rate of rocket.pitch"},
    {"rocket.yaw_rate", "rad/s", "rate of rocket.yaw"},
    {"rocket.spin", "rad/s", "rate of the rocket against inertial axes about its axis"},
    {"center.x", "m", "mass centre, in I"},
    {"center.y", "m", "mass centre, in I"},
    {"center.z", "m", "mass centre, in I"},
    {"center.vx", "m/s", "velocity of the mass centre against the ground, in I"},
    {"center.vy", "m/s", "velocity of the mass centre against the ground, in I"},
    {"center.vz", "m/s", "velocity of the mass centre against the ground, in I"},
    {"rocket.mass", "kg", "instantaneous mass"},
    {"thrust", "N", "thrust"},
    {"altitude", "m", "altitude of the mass centre"},
    {"density", "kg/m3", "density of the air there"},
    {"airspeed", "m/s", "speed of the mass centre through the air"},
    {"mach", "1", "Mach number"},
    {"angle_of_attack", "rad", "between the rocket's axis and its velocity through the air"},
    {"wind.x", "m/s", "velocity of the air against the ground, in I"},
    {"wind.y", "m/s", "velocity of the air against the ground, in I"},
    {"wind.z", "m/s", "velocity of the air against the ground, in I"},
};

static const ld_column earth_columns[] = {
    {"latitude", "rad", "geodetic latitude of the mass centre"},
    {"longitude", "rad", "longitude of the mass centre"},
    {"v_north", "m/s", "velocity of the mass centre against the ground, to the north"},
    {"v_east", "m/s", "velocity of the mass centre against the ground, to the east"},
    {"v_down", "m/s", "velocity of the mass centre against the ground, down"},
    {"heading", "rad", "of the rocket's axis, clockwise from north"},
    {"local_pitch", "rad", "of the rocket's axis above the local horizon"},
    {"local_roll", "rad", "of the rocket, Ry(-heading) Rz(pitch) Rx(roll) against north, up, east"},
};

enum {
    COMMON = sizeof common_columns / sizeof common_columns[0],
    EARTH = sizeof earth_columns / sizeof earth_columns[0],
};

int flight_columns(const flight_system *system, ld_column columns[FLIGHT_MAX_COLUMNS])
{
    memcpy(columns, common_columns, sizeof common_columns);
    if (system->earth.flat)
        return COMMON;
    memcpy(columns + COMMON, earth_columns, sizeof earth_columns);
    return COMMON + EARTH;
}

static double *put(double *to, v3 a)
{
    v3_store(to, a);
    return to + 3;
}

void flight_row(const flight_system *system, const flight_phase *phase, double t,
                const double *state, double *row)
{
    flight_pose pose;
    flight_leave(system, phase, t, state, &pose);
    earth_motion center = flight_center(system, t, state);
    flight_flow flow = flight_flow_at(system, t, state);
    m3 A_IB = q_matrix(pose.q_IB);
    v3 turn = m3_apply_transposed(system->earth.A_EI, earth_rate(&system->earth));
    v3 w = v3_sub(m3_apply(A_IB, pose.w), turn), axis = m3_column(A_IB, 0);
    direction_angles angles = direction_angles_of(axis, v3_cross(w, axis));
    double *to = row;
    *to++ = t;
    to = put(to, pose.r_O1);
    to = put(to, pose.v_O1);
    memcpy(to, &pose.q_IB, sizeof pose.q_IB);
    to = put(to + 4, pose.w);
    const double about[] = {angles.pitch, angles.yaw, angles.pitch_rate, angles.yaw_rate, pose.w.x};
    memcpy(to, about, sizeof about);
    to = put(to + 5, center.r);
    to = put(to, center.v);
    const double body[] = {flight_mass(system, phase, t).m,
                           flight_thrust(system, phase, t),
                           flow.altitude,
                           flow.density,
                           flow.airspeed,
                           flow.mach,
                           flow.angle_of_attack};
    memcpy(to, body, sizeof body);
    to = put(to + 7, flow.wind);
    if (system->earth.flat)
        return;
    flight_place place = flight_place_at(system, t, state, A_IB);
    const double globe[] = {place.geodetic.latitude, place.geodetic.longitude};
    memcpy(to, globe, sizeof globe);
    to = put(to + 2, place.velocity_ned);
    const double local[] = {place.heading, place.pitch, place.roll};
    memcpy(to, local, sizeof local);
}
