// The orientating subsystem: chassis, azimuth and elevation platform with a stabiliser on each
// hinge (model.md, section 6), a chain of the transfer matrix method (launchdyn/mstmm.h). It takes
// the wrenches of wheels and tube supports and gives the frames of chassis and tube.
//
// State: q [9]: r_C [3] mass centre of the chassis in I, q_IC [4] its quaternion, azimuth and
// elevation angle; u [8]: velocity of r_C in I, angular velocity of the chassis in its own axes,
// rates of the two angles; z [2]: integrals of the stabilisers (azimuth, elevation) [N m]; where
// one of them has a drive of its own, what both drives have [DRIVE_STATES each] (stabiliser.h).
#ifndef LD_SYSTEMS_ORIENTATING_H
#define LD_SYSTEMS_ORIENTATING_H

#include "elements/base_frame.h"
#include "elements/tube/work.h"
#include "launchdyn/model.h"
#include "launchdyn/mstmm.h"
#include "model/blocks/run.h"
#include "model/blocks/tubes.h"
#include "systems/mechanism/stabiliser.h"

enum { HINGE_AZIMUTH, HINGE_ELEVATION, HINGES };

enum {
    ORIENTATING_R = 0,          // r_C
    ORIENTATING_QUATERNION = 3, // q_IC
    ORIENTATING_ANGLE = 7,      // azimuth, elevation
    ORIENTATING_V = 9,
    ORIENTATING_W = 12,
    ORIENTATING_RATE = 15, // of the two angles
    ORIENTATING_SPEEDS = 8,
    ORIENTATING_Z = 17,
    ORIENTATING_STATES = 19, // without drives
    ORIENTATING_DRIVE = 19,
    ORIENTATING_MOST_STATES = ORIENTATING_DRIVE + HINGES * DRIVE_STATES
};

// Powers [W] by kind of force, and their works [J].
#define ORIENTATING_WORKS(X)                                                                       \
    X(ORIENTATING_STABILISER, "stabilisers", "work of the stabilisers or locks")                   \
    X(ORIENTATING_FRICTION, "hinge_friction", "work of the friction in the hinges")                \
    X(ORIENTATING_GRAVITY, "gravity_platform", "work of gravity on chassis and platforms")

enum orientating_power { ORIENTATING_WORKS(WORK_PLACE) ORIENTATING_POWERS };

// Hinge angle and torque of the equilibrium, about which a locked hinge has its spring.
typedef struct hinge_rest {
    double angle;  // [rad]
    double torque; // [N m]
} hinge_rest;

typedef struct orientating_system {
    const ld_model *model;
    ld_formulation formulation;
    ld_mstmm *chain;
    int state_count;
    double mass; // [kg] of the three bodies, carried tubes included
    // elevation platform with the tubes that it carries: mass [kg]; mass centre and undeformed
    // launching tube's rear end [m] from its hinge, its axes
    double elevation_mass;
    v3 elevation_center, tube_at;
} orientating_system;

typedef struct orientating_motion {
    base_frame chassis;         // r: mass centre
    base_frame tube;            // frame T of the undeformed tube
    v3 momentum;                // [kg m/s] of the three bodies, in I
    hinge_report hinge[HINGES]; // angles, rates and commands; torques by orientating_evaluate
} orientating_motion;

typedef struct orientating_input {
    v3 chassis_force, chassis_moment; // in I, about the chassis' mass centre
    v3 tube_force, tube_moment;       // in T, about T's origin
    hinge_rest rest[HINGES];          // of locked or held hinges
    bool linear;                      // no Coulomb friction, drives as linear ones (linearisation)
    bool held; // hinges carry rest[].torque, whatever stabilisers and friction say (equilibrium)
} orientating_input;

typedef struct orientating_output {
    double power[ORIENTATING_POWERS];
    double loss; // overall form: largest difference from the reduced sweep, relative
} orientating_output;

// Rear end [m] of tube `number` (from 1), undeformed, in elevation-platform axes.
v3 orientating_tube_place(const ld_layout *layout, int number);

// Tube number `launching` is left out of the elevation platform's inertia; tubes listed in
// `fired` [count] have no rocket any more.
ld_status orientating_build(orientating_system *self, const ld_model *model, int launching,
                            const int *fired, int fired_count, ld_error *error);
void orientating_free(orientating_system *self);

// Frames and angles at time t [s], from the state alone.
void orientating_motion_at(const orientating_system *self, double t, const double *state,
                           orientating_motion *motion);

// Rates of the state; completes the hinge reports in `motion`. Other than 0: singular or not
// finite.
int orientating_evaluate(const orientating_system *self, const orientating_input *input,
                         const double *state, orientating_motion *motion, double *state_dot,
                         orientating_output *output);

// Puts the drives at rest under the torques z.
void orientating_rest(const orientating_system *self, double *state);

// The first instant [s] after t at which a digital loop changes the state; infinity: none. What it
// makes of the state at such an instant.
double orientating_next_sample(const orientating_system *self, double t);
void orientating_sample(const orientating_system *self, double t, double *state);

// [J] kinetic energy of chassis and platforms.
double orientating_kinetic_energy(const orientating_system *self, const double *state);

#endif
