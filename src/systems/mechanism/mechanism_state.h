// The state of a mechanism: where it begins, small displacements, sizes for the tolerances, digital
// loops, locks that close.
#ifndef LD_SYSTEMS_MECHANISM_STATE_H
#define LD_SYSTEMS_MECHANISM_STATE_H

#include "elements/tube/flexible_tube.h"
#include "systems/mechanism/mechanism.h"

// A beam as built, by its number from 0; where its modal coordinates begin in q.
const flexible_tube *mechanism_beam(const mechanism_system *self, int number);
int mechanism_beam_at(const mechanism_system *self, int number);

// Coordinates and speeds as the scenario gives them, holds without torque; not assembled.
void mechanism_start(const mechanism_system *self, double *state);

// What counts from the start, an assembled state: where bushings without a second place meet, the
// lengths of unloaded struts without one, where the feet are set down.
void mechanism_complete(mechanism_system *self, const base_frame *carrier, const double *state);

// LD_ERR_INPUT with the name of a strut whose ends coincide in a state.
ld_status mechanism_check_struts(const mechanism_system *self, const base_frame *carrier,
                                 const double *state, ld_error *error);

// The joint of the tree that a speed belongs to, and whether it turns.
typedef struct mechanism_axis {
    const ld_joint *joint;
    bool turns;
} mechanism_axis;
mechanism_axis mechanism_axis_of(const mechanism_system *self, int speed);

// Sets the ground's deflections under the feet by how far each has moved since it was set down.
void mechanism_plant(const mechanism_system *self, const base_frame *carrier, double *state);

// Adds a small displacement in the sense of speed k: to its coordinate, or a turn about that body
// axis to its quaternion.
void mechanism_displace(const mechanism_system *self, int k, double change, double *state);

// Twice the kinetic energy [kg, kg m2] of speed k alone in the place of a state, and whose it is.
double mechanism_inertia(const mechanism_system *self, const double *state, int k, int *body);

// The first speed of the free joint by which the ground carries the body on the wheels; -1: none.
int mechanism_rolling(const mechanism_system *self);

// Absolute tolerances of the states; where there is no relative one.
void mechanism_tolerances(const mechanism_system *self, double tolerance, double *atol,
                          bool *absolute);

// Drives at rest under the torques of their holds; the speeds that the joints start with.
void mechanism_set_off(const mechanism_system *self, double *state);
void mechanism_start_speeds(const mechanism_system *self, double *state);

// The first instant [s] after t at which a command has a corner, or a load one.
double mechanism_next_corner(const mechanism_system *self, double t);
// The first instant after t at which a digital loop or a lock changes the state; infinity: none.
// What it makes of the state at such an instant.
double mechanism_next_sample(const mechanism_system *self, double t);
void mechanism_sample(const mechanism_system *self, const mechanism_motion *motion, double *state);

#endif
