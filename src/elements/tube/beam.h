// A flexible tube as an inner or end element of a multibody system: reduced step and accelerations
// (formulation.md, section 2) in the axes of its floating frame R, which rides on its input end.
#ifndef LD_ELEMENTS_BEAM_H
#define LD_ELEMENTS_BEAM_H

#include <stdbool.h>

#include "elements/tube/tube_dynamics.h"
#include "launchdyn/mstmm.h"
#include "math/vectors/spatial.h"

// An output section: where the beam carries a child.
typedef struct beam_output {
    double station; // [m]
    tube_section_state section;
} beam_output;

// Constant data and the workspace of one beam.
typedef struct beam {
    flexible_tube tube;
    int modes, n; // modal coordinates, 6 + modes
    int output_count;
    beam_output *output;
    v3 w;      // [rad/s] of R in R, of the last beam_move
    double *M; // n x n: mass matrix; after the reduced step its modal block is a Cholesky factor
    double *h; // n: forces; after the reduced step those that the outputs leave
    double *eta_dot; // n: a, alpha of R's origin less gravity, q_ddot, of the last acceleration
} beam;

// Builds the beam with its modes; `name` is the element's, for messages.
ld_status beam_create(beam *self, const ld_mstmm_beam *given, const char *name, ld_error *error);
// Adds an output section, returns its index or -1 without memory.
int beam_add_output(beam *self, double station);
// Frees the workspace, and the tube where `last` says that no copy shares it.
void beam_free(beam *self, bool last);
// A workspace of its own beside another beam's tube; false without memory (free it all the same).
bool beam_copy(beam *self, const beam *from);

// Bound of the turn of its far end [rad] in modal coordinates q, which geometric stiffness takes to
// be small; 0 without that. Trial poses and differences must not turn sections by more than some
// hundredths.
double beam_turn(const beam *self, const double *q);

// M, h and the output sections for angular velocity w of R, in R. Gravity enters as an acceleration
// of the whole system, not here.
void beam_move(beam *self, v3 w, const double *q, const double *q_dot);

// Adds what an output's subtree does to the beam: F = Z [a; alpha] + zf at the section, in R.
void beam_load(beam *self, int output, const spatial_matrix *Z, spatial zf);

// Reduced step with modal forces tau_q: Z and zf at the input end, in R.
// Returns 0, or 1 where the modal mass matrix is not positive definite.
int beam_reduce(beam *self, const double *tau_q, spatial_matrix *Z, spatial *zf);

// The same with unit loads, after the reduced step. What a wrench F at an output (in R) does along
// the beam's speeds is added to Q [n].
void beam_carry_unit(const beam *self, int output, spatial F, double *Q);
// Q's share of the modes: its modal part becomes G^-1 Q_q, its first six what passes to the input.
void beam_reduce_unit(const beam *self, double *Q);
// Before the reduced step: the modes hold, and nothing acts along them.
void beam_hold(beam *self);
// Before the reduced step: no forces of motion and springs.
void beam_still(beam *self);

// After the reduced step: q_ddot from the input end's acceleration x, in R.
void beam_accelerate(beam *self, spatial x, double *q_ddot);

// Inverse dynamics after beam_move: the wrench at the input end that the acceleration x (in R) and
// q_ddot need, outputs unloaded; the modal forces needed stand in h behind the sixth.
spatial beam_needed(beam *self, spatial x, const double *q_ddot);

// Adds the modal forces that carrying wrench F at an output needs; returns the wrench's share at
// the input end, in R.
spatial beam_carry(beam *self, int output, spatial F);

// Momentum and moment of momentum about R's origin, in R, after beam_move; v: velocity of R's
// origin in R.
spatial beam_momentum(const beam *self, v3 v, const double *q_dot);

// [a; alpha] of a section, and of an output section, in R, from eta_dot.
spatial beam_section_acceleration(const beam *self, const tube_section_state *section);
spatial beam_output_acceleration(const beam *self, int output);

#endif
