// A bare launching subsystem followed in time: base, mass and thrust held, phase as it is given.
#ifndef LD_TESTS_SUPPORT_LAUNCHING_RUN_H
#define LD_TESTS_SUPPORT_LAUNCHING_RUN_H

#include "integration/integrator.h"
#include "support/dense_launch.h"
#include "systems/launching/launching.h"
#include "systems/launching/launching_kinematics.h"

enum { RUN_STATES = 32 + 2 * LD_MAX_MODAL + POWER_COUNT };

// Builds a system on the heap; fails the test where that fails.
launching_system *launching_system_of(const ld_model *model);
void launching_system_drop(launching_system *system);

// State: as launching_layout, then the works [J] of the kinds of launching_power.
typedef struct launching_run {
    const launching_system *system;
    launching_input input;
    launching_phase phase;
    bool project;       // remove the slot's drift after each step
    integrator_rhs rhs; // NULL: states of the layout, reduced form
    double state[RUN_STATES];
    int64_t steps, evaluations;
    void (*after_step)(struct launching_run *run, double t); // may be NULL
    void *user;
} launching_run;

// Rocket at rest in the tube at s, tube straight, at I's origin; the base there, too, at rest.
void launching_run_begin(launching_run *run, const launching_system *system, double s);

// Gives the rocket the speeds y = (s_dot, y_S_dot, z_S_dot, w_SB) against the tube: the V of
// `state` with which launching_rocket_pose() finds them.
void launching_run_set_speeds(const launching_system *system, double *state, const double y[6]);

// Follows the state for `time` [s] at the tolerance given (relative and absolute, per state).
void launching_run_follow(launching_run *run, double tolerance, double time);

// Momenta and energies of the present state by the independent equations of
// support/dense_launch.h.
void launching_run_dense(const launching_run *run, const dense_launch *dense,
                         dense_launch_output *output);

#endif
