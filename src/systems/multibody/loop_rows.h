// The joints that close loops at an instant: what they hold, how far they are open, what their
// springs do (mstmm.md, closed loops).
#ifndef LD_SYSTEMS_LOOP_ROWS_H
#define LD_SYSTEMS_LOOP_ROWS_H

#include "systems/multibody/multibody.h"

// What gaps are.
typedef enum loop_purpose {
    LOOPS_ACCELERATIONS, // what q and u alone give of the relative acceleration
    LOOPS_SPEEDS,        // relative speed along the rows
    LOOPS_PLACES,        // what the rows are open by
    LOOPS_FAR,           // the same as lengths and angles that lead from any attitude; for guesses
} loop_purpose;

// One side's joint frame in inertial axes.
typedef struct loop_side {
    v3 origin;   // of the node's body
    v3 arm;      // from there to the joint's point
    v3 position; // of the joint's point
    v3 velocity; // likewise
    v3 w;
    m3 frame;
} loop_side;

// Both sides; after multibody_move and with `place` of their nodes.
void loop_sides(const ld_mstmm *system, const loop *l, loop_side side[2]);

// Places of all nodes on the loops' paths; after multibody_move.
void loops_place(ld_mstmm *system, const double *u);

// Unit wrenches and gaps of all loops; after loops_place.
void loops_make_rows(ld_mstmm *system, loop_purpose purpose);

// Largest distance and angle that a joint is open by; after loops_place.
void loop_opening(const ld_mstmm *system, const loop *l, double *distance, double *angle);

// The caller's wrenches (NULL: none) with those of springs in loops, in the workspace; the caller's
// where there are none.
const double *loops_load(ld_mstmm *system, const double *wrench);

// The same with the forces that keep the loops closed, of the latest evaluation of accelerations.
const double *loops_load_all(ld_mstmm *system, const double *wrench);

// What a joint does on its second side at its point, of the forces found: into `reaction`.
void loop_sum_forces(const loop *l, loop_work *w);

// Energy in the springs of loops.
double loops_energy(const ld_mstmm *system);

#endif
