// What acts on the tube in one evaluation, distinguished by where it acts: the sums over what lies
// beyond stations of the tube, and what each support puts on it.
#ifndef LD_ELEMENTS_GUIDE_FORCES_H
#define LD_ELEMENTS_GUIDE_FORCES_H

#include "math/vectors/mat3.h"
#include "model/blocks/limits.h"
#include "model/blocks/tubes.h"

typedef struct guide_wrench {
    v3 f, m; // [N], [N m]
} guide_wrench;

typedef struct guide_forces {
    int count;
    double at[LD_MAX_STATIONS]; // [m] the stations
    guide_wrench
        beyond[LD_MAX_STATIONS]; // of all at a station or beyond it, about R's origin, in R
    guide_wrench support[LD_MAX_SUPPORTS]; // on the tube at the support's station, in base axes
} guide_forces;

// Sets all sums to zero; `station`: the `count` stations, at most LD_MAX_STATIONS.
void guide_forces_begin(guide_forces *self, int count, const ld_station *station);
// Adds force f and moment m about R's origin, both in R, that act on the section at x; before the
// rear end they act on the section there.
void guide_forces_add(guide_forces *self, double x, v3 f, v3 m);

#endif
