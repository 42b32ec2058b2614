// What the joints of a mechanism transmit and how those that close loops stand: for output, after
// an evaluation.
#ifndef LD_SYSTEMS_MECHANISM_JOINTS_H
#define LD_SYSTEMS_MECHANISM_JOINTS_H

#include "systems/mechanism/mechanism.h"

// On the joint's body, springs, friction and drives included, in I.
typedef struct joint_load {
    v3 force, moment; // [N], [N m] about the joint's position on the body
} joint_load;

// Of the evaluation that gave `output` and these rates of the state; constraints that others imply
// carry nothing.
void mechanism_joint_loads(const mechanism_system *self, const mechanism_motion *motion,
                           const double *state_dot, const mechanism_output *output,
                           joint_load load[LD_MAX_JOINTS]);

enum { JOINT_MOST_COORDINATES = 7, JOINT_MOST_SPEEDS = 6 };

// Coordinates and speeds of a joint, as many as it has: [rad], [rad/s] or [m], [m/s]; an angle that
// closes a loop within pi.
void mechanism_joint_state(const mechanism_system *self, const mechanism_motion *motion, int joint,
                           double q[JOINT_MOST_COORDINATES], double u[JOINT_MOST_SPEEDS]);

#endif
