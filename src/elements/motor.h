// The motor: thrust over time, and the rocket's mass data that follow from it (model.md, section
// 5).
#ifndef LD_ELEMENTS_MOTOR_H
#define LD_ELEMENTS_MOTOR_H

#include <stddef.h>

#include "elements/side_noise.h"
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

// Beside the thrust, linear between corners: the side force F_y, F_z in B and the deviation of its
// noise [N]; eps_y, eps_z [-] and y, z [m] by which the nozzle has moved; of the further motors the
// thrust, which is in that of all, their force [N] and moment about O1 [N m] in B.
enum {
    ACROSS_FORCE,
    ACROSS_DEVIATION = 2,
    ACROSS_LEAN,
    ACROSS_SHIFT = 5,
    ACROSS_OTHERS = 7,
    ACROSS_OTHERS_FORCE,
    ACROSS_OTHERS_MOMENT = 11,
    ACROSS_COUNT = 14
};

// The same at one instant.
typedef struct motor_across {
    double others;
    double force[2], lean[2], shift[2];
    v3 others_force, others_moment;
} motor_across;

// The thrust curve of all motors, scaled, cut into pieces between its corners, and those of other
// tables over time; and what burns: with the impulse, or between masses evenly in time.
typedef struct motor {
    size_t corner_count;
    double *t;               // [corner_count] s after ignition, owned
    double *thrust;          // [corner_count] N
    double greatest;         // [N] of them
    double *impulse;         // [corner_count] N s burnt up to the corner
    double propellant;       // [kg]
    rocket_mass full, empty; // with mass error and eccentricity; rates unused
    rocket_mass *at;         // [corner_count] likewise, where a table says it; else NULL. Owned
    double *across;          // [corner_count][ACROSS_COUNT] where there is any; else NULL. Owned
    side_noise noise;
} motor;

// `place` of the rocket in the firing sequence, from 0, decides its noise.
ld_status motor_build(motor *self, const struct ld_rocket *rocket, int place, ld_error *error);
void motor_free(motor *self);

// Pieces: -1 before ignition or the first corner, k between corners k and k + 1, corner_count - 1
// after the last. Within a piece thrust is linear, so that steps can be cut at the corners.
double motor_thrust(const motor *self, int piece, double t);
double motor_impulse(const motor *self, int piece, double t);
// The piece that begins at or before t (of two corners at one time, the later).
int motor_piece(const motor *self, double t);
// Total impulse [N s].
double motor_total_impulse(const motor *self);

// What is across the axis while it burns, of a motor that has any.
motor_across motor_across_at(const motor *self, int piece, double t);

// Mass data at time t after ignition.
void motor_mass(const motor *self, int piece, double t, rocket_mass *mass);

// What falls off with adaptor i leaves the mass data at one instant: mass, first moment and inertia
// about any point are those of both parts before it.
void rocket_mass_without(const struct ld_rocket *rocket, int i, rocket_mass *mass);
// The same of the masses at all corners, of all adaptors: between them they go as the motor's do.
void motor_without_falling(motor *self, const struct ld_rocket *rocket);

#endif
