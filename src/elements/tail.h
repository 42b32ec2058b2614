// The tube tail: a rigid body welded to the rear section (model.md, section 4), folded into the
// rigid part of the tube, on which R rides (formulation.md, section 1).
#ifndef LD_ELEMENTS_TAIL_H
#define LD_ELEMENTS_TAIL_H

#include "elements/instant.h"

// Masses and inertias of tube and tail together.
LD_INLINE void tail_fold(const ld_tail *tail, tube_system *guide)
{
    const flexible_tube *tube = &guide->flexible;
    double away = tail->mass * tail->center * tail->center;
    guide->m = tube->m + tail->mass;
    guide->Sx = tube->s0 + tail->mass * tail->center;
    guide->tail_inertia =
        v3_make(tail->inertia[0], tail->inertia[1] + away, tail->inertia[2] + away);
    guide->jx = tube->j - tube->cpcp + tail->inertia[0];
}

// Kinetic energy [J] from the velocity of R's origin and the rate of R, in R.
LD_INLINE double tail_kinetic_energy(const ld_tail *tail, v3 v, v3 w)
{
    v3 v_C = v3_add(v, v3_cross(w, v3_make(tail->center, 0, 0)));
    return 0.5 * (tail->mass * v3_norm2(v_C) + v3_dot(w, v3_mul(v3_from(tail->inertia), w)));
}

#endif
