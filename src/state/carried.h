// In which directions the surfaces that a resting rocket touches carry it; in the others it has
// play.
#ifndef LD_STATE_CARRIED_H
#define LD_STATE_CARRIED_H

#include "state/launch_state.h"

enum { SHOE_FREEDOMS = 5 }; // y_S, z_S, psi, theta, gamma

// Directions as lengths: angles times `scale`.
typedef struct carried_directions {
    int count;
    double scale[SHOE_FREEDOMS]; // [1] or [m]
    double basis[SHOE_FREEDOMS][SHOE_FREEDOMS];
} carried_directions;

// Of the surfaces that `out` finds touched, to first order in the rocket's angles; `rolls`: gamma
// is free to change.
void carried_find(const launching_system *launching, const launching_phase *phase,
                  const launching_output *out, bool rolls, carried_directions *carried);

// Takes what is carried out of a small displacement [m, m, rad, rad, rad].
void carried_remove(const carried_directions *carried, double displacement[SHOE_FREEDOMS]);

#endif
