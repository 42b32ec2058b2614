// The launcher: the launching subsystem on its base, which exchange positions, velocities and
// spring-damper forces (model.md, section 2).
//
// State: launching | base | works by kind of force, first the launching subsystem's.
#ifndef LD_SYSTEMS_LAUNCHER_H
#define LD_SYSTEMS_LAUNCHER_H

#include "model/blocks/run.h"
#include "systems/bases/base.h"
#include "systems/launching/launching.h"

enum {
    LAUNCHER_MOST_WORKS = POWER_COUNT + BASE_MOST_WORKS,
    LD_MAX_STATES = 32 + 2 * LD_MAX_MODAL + BASE_MOST_STATES + LAUNCHER_MOST_WORKS,
};

typedef struct launcher_system {
    const ld_model *model;
    launching_system launching;
    base_system base;
    int base_at, work_at; // offsets in the state
    int work_count, state_count;
} launcher_system;

// What comes from outside, and what follows from the base's state alone.
typedef struct launcher_input {
    launching_input launching;  // base frame, thrust, mass
    ld_formulation formulation; // of the launching subsystem
    jet_wrench jet;             // of rockets that have left
    base_rest rest;             // of the base in the equilibrium
    bool held;                  // the base carries what `rest` says (equilibrium)
    base_found found;
} launcher_input;

typedef struct launcher_output {
    launching_output launching;
    base_output base; // of a base with a motion of its own
} launcher_output;

// Which of the base_inputs act on tube and rocket.
extern const quantity_table launcher_inputs;

// What may be the same in the next launcher, taken from one that is used no more.
typedef struct launcher_kept {
    launching_tube tube;
    road *road; // NULL: none
} launcher_kept;

launcher_kept launcher_hand_over(launcher_system *self);
void launcher_kept_free(launcher_kept *self);

// Builds the launcher, for the first rocket of the model's firing; with what was kept (or NULL)
// where that is the same to the bit, which it then owns.
ld_status launcher_build(launcher_system *self, const ld_model *model, launcher_kept *kept,
                         ld_error *error);
void launcher_free(launcher_system *self);

// Makes *self the launcher of one run, which may continue beside others: it shares what does not
// change with `of`, which must outlive it, and has a workspace, tube and rocket of its own.
ld_status launcher_share(launcher_system *self, const launcher_system *of, ld_error *error);
void launcher_free_share(launcher_system *self);

// Takes the tube of firing i as the flexible one, the others with the base.
void launcher_select(launcher_system *self, int i);

// The base's frames at time t [s] and state: fills input->launching.base and input->found, where
// input->launching.station points.
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

// A base with a motion of its own alone, under the wrench of the tube that stands in
// output->launching (base_force, base_moment). 0, or other where it has no solution.
int launcher_evaluate_base(const launcher_system *self, const launcher_input *input,
                           const launching_phase *phase, const double *state,
                           launcher_output *output);

// Derivative of the state from the accelerations found; works included.
void launcher_rates(const launcher_system *self, const double *state, const launcher_output *output,
                    bool rocket, double *state_dot);

// Kinetic energy [J] of all bodies; the rocket's if it is in the tube.
double launcher_kinetic_energy(const launcher_system *self, const launcher_input *input,
                               const launching_phase *phase, const double *state);

// Elastic energy [J] of the tube on its supports and of its base, as just evaluated.
double launcher_elastic_energy(const launcher_system *self, const launcher_output *output);

#endif
