// The launcher: the launching subsystem on its base. A fixed or prescribed base is a motion given
// over time; a vehicle is the orientating and the marching subsystem, which exchange positions,
// velocities and spring-damper forces with the tube (model.md, section 2).
//
// State: launching | orientating | marching (both for a vehicle only) | works by kind of force.
#ifndef LD_SYSTEMS_LAUNCHER_H
#define LD_SYSTEMS_LAUNCHER_H

#include "systems/launching.h"
#include "systems/marching.h"
#include "systems/orientating.h"

enum {
    LAUNCHER_WORKS = POWER_COUNT + ORIENTATING_POWERS + MARCHING_POWERS,
    LD_MAX_STATES = 32 + 2 * LD_MAX_MODAL + ORIENTATING_STATES + WHEEL_STATES * LD_MAX_WHEELS + 1 +
                    LAUNCHER_WORKS,
};

typedef struct launcher_system {
    const ld_model *model;
    launching_system launching;
    base_motion motion; // of a fixed or prescribed base
    bool vehicle;
    orientating_system orientating; // with the tube that launches now
    int tube;                       // which that is, in the order of firing
    int tube_count;
    orientating_system of_tube[LD_MAX_FIRINGS]; // in the order of firing
    marching_system marching;
    int orientating_at, marching_at, work_at; // offsets in the state
    int work_count, state_count;
} launcher_system;

// What comes from outside, and what follows from the base's state alone.
typedef struct launcher_input {
    launching_input launching;  // base frame, thrust, mass
    ld_formulation formulation; // of the launching subsystem
    hinge_rest rest[HINGES];    // of locked hinges
    bool held;                  // hinges carry rest[].torque (equilibrium)
    orientating_motion motion;  // of a vehicle
} launcher_input;

typedef struct launcher_output {
    launching_output launching;
    orientating_output orientating;
    marching_output marching;
    hinge_report hinge[HINGES];
    double base_dot[ORIENTATING_STATES + WHEEL_STATES * LD_MAX_WHEELS + 1];
} launcher_output;

// Builds the launcher, for the first rocket of the model's firing; a road is tabulated from x0 to
// x1 [m]. `kept` as for launching_build.
ld_status launcher_build(launcher_system *self, const ld_model *model, launching_tube *kept,
                         double x0, double x1, ld_error *error);
void launcher_free(launcher_system *self);

// Makes *self the launcher of one run, which may go on beside others: it shares what does not
// change with `of`, which must outlive it, and has a workspace, tube and rocket of its own.
ld_status launcher_share(launcher_system *self, const launcher_system *of, ld_error *error);
void launcher_free_share(launcher_system *self);

// Takes the tube of firing i as the flexible one, the others with the platform.
void launcher_select(launcher_system *self, int i);

// The base's frames at time t [s] and state: fills input->launching.base and input->motion.
void launcher_place(const launcher_system *self, double t, const double *state,
                    launcher_input *input);

// All accelerations, by the formulation that the model asks for.
launching_outcome launcher_evaluate(const launcher_system *self, const launcher_input *input,
                                    const launching_phase *phase, const double *state,
                                    launcher_output *output);

// The launching subsystem alone, by the fast reduced form or the overall one.
launching_outcome launcher_evaluate_tube(const launcher_system *self, ld_formulation formulation,
                                         const launching_input *input, const launching_phase *phase,
                                         const double *state, launching_output *output);

// Orientating and marching subsystem alone, under the wrench of the tube that stands in
// output->launching (base_force, base_moment). 0, or other where they have no solution.
int launcher_evaluate_vehicle(const launcher_system *self, const launcher_input *input,
                              const launching_phase *phase, const double *state,
                              launcher_output *output);

// Derivative of the state from the accelerations found; works included.
void launcher_rates(const launcher_system *self, const double *state, const launcher_output *output,
                    bool rocket, double *state_dot);

// Kinetic energy [J] of all bodies; the rocket's if it is in the tube.
double launcher_kinetic_energy(const launcher_system *self, const launcher_input *input,
                               const launching_phase *phase, const double *state);

#endif
