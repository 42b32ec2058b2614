// The motor: thrust over time, and the rocket's mass data that follow from it (model.md, section
// 5).
#ifndef LD_ELEMENTS_MOTOR_H
#define LD_ELEMENTS_MOTOR_H

#include <stddef.h>

#include "launchdyn/status.h"
#include "math/vectors/mat3.h"

struct ld_rocket;

// Mass data of the rocket at one instant; rates for the energy balance.
typedef struct rocket_mass {
    double m; // [kg]
    v3 c;     // [m] mass centre in B
    m3 J;     // [kg m2] about the mass centre, in B
    double m_dot;
    v3 c_dot;
    m3 J_dot;
} rocket_mass;

// The thrust curve, scaled, cut into pieces between its corners, and those of the masses where they
// are given; and what burns: with the impulse, or between masses evenly in time.
typedef struct motor {
    size_t corner_count;
    double *t;               // [corner_count] s after ignition, owned
    double *thrust;          // [corner_count] N
    double *impulse;         // [corner_count] N s burnt up to the corner
    double propellant;       // [kg]
    rocket_mass full, empty; // with mass error and eccentricity; rates unused
    rocket_mass *at;         // [corner_count] likewise, where a table says it; else NULL. Owned
} motor;

ld_status motor_build(motor *self, const struct ld_rocket *rocket, ld_error *error);
void motor_free(motor *self);

// Pieces: -1 before ignition or the first corner, k between corners k and k + 1, corner_count - 1
// after the last. Within a piece thrust is linear, so that steps can be cut at the corners.
double motor_thrust(const motor *self, int piece, double t);
double motor_impulse(const motor *self, int piece, double t);
// The piece that begins at or before t (of two corners at one time, the later).
int motor_piece(const motor *self, double t);
// Total impulse [N s].
double motor_total_impulse(const motor *self);

// Mass data at time t after ignition.
void motor_mass(const motor *self, int piece, double t, rocket_mass *mass);

#endif
