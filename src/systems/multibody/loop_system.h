// The equations of the loops' forces, S force = -gap: symmetric, block by block of the loops,
// within the envelope of those that act on each other; each block's rows in the order of their
// pivots.
#ifndef LD_SYSTEMS_LOOP_SYSTEM_H
#define LD_SYSTEMS_LOOP_SYSTEM_H

#include "systems/multibody/multibody.h"

typedef struct loop_pivots {
    double shift; // added to each row's own response, in its scale: 0, or for guesses
    double least; // pivots below, in the row's scale, count as none
    bool limited; // no more rows of a loop than its limit
} loop_pivots;

// Factors S of the latest propagation. Returns the least pivot of the rows that had to be found, in
// its row's scale, and the loop it belongs to: below `least` a row is missing.
double loop_system_factor(ld_mstmm *system, const loop_pivots *pivots, int *where);

// force = -S^-1 gap, 0 in rows without pivots.
void loop_system_solve(ld_mstmm *system);

// The same by orthogonalising the rows against each other, the largest first, which loses half as
// many digits near a singular pose, at the cost of a dense factorisation. Returns the least pivot
// as the factorisation does, or a negative number where there is no room for it.
double loop_system_solve_dense(ld_mstmm *system, double least, int *where);

// Part of gap that the forces leave open in loop i's rows, against what they add up from.
double loop_system_rest(const ld_mstmm *system, int i);

#endif
