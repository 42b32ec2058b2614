// Where rocket and tube of the launching subsystem are, and how they move.
#ifndef LD_SYSTEMS_LAUNCHING_KINEMATICS_H
#define LD_SYSTEMS_LAUNCHING_KINEMATICS_H

#include "systems/launching/launching.h"

// Where the rocket is and how it moves, in R.
typedef struct launching_pose {
    v3 p1; // [m] O1
    m3 A_RS, A_RB;
    v3 v_O1; // [m/s] inertial
    v3 w_B;  // [rad/s] against I
} launching_pose;

// Fills `pose` and, of `output`, x_dot and y.
void launching_rocket_pose(const launching_system *self, const double *state, launching_pose *pose,
                           launching_output *output);

// Where the rocket's point (of B [m]) is in I [m].
v3 launching_rocket_point(const launching_system *self, const double *state, v3 point);

// The section at station x (its point of the axis and frame, with their velocity and rate against
// I), in R.
typedef struct launching_section {
    v3 P;
    m3 A;
    v3 v, w;
} launching_section;

void launching_section_at(const launching_system *self, const double *state, double x,
                          launching_section *section);

// Rate [m/s] at which adaptor i's offset from the axis grows, the foot's motion included.
double launching_offset_rate(const launching_system *self, const double *state, int i);
// Rate [m/s] at which adaptor i goes into surface k of the guide.
double launching_surface_rate(const launching_system *self, const double *state, int i, int k);

#endif
