// The random part of a motor's side force: two independent stationary processes of unit variance,
// sums of harmonics that a seed decides (model.md, section 5).
//
//   X_j(t) = sqrt(2/n) sum_i cos(2 pi f_ji t + phi_ji),  j = y, z
// f_ji lies in the i-th of n cells of equal power of the spectrum, by chance evenly in its power;
// phi_ji is uniform. One-sided density over the frequency f, but for a factor: 1/(1 + (f/f_c)^2) up
// to NOISE_TOP f_c, or that of a table, linear between its rows.
#ifndef LD_ELEMENTS_SIDE_NOISE_H
#define LD_ELEMENTS_SIDE_NOISE_H

#include "launchdyn/status.h"
#include "model/blocks/motor.h"

enum { NOISE_TOP = 10 };

typedef struct side_noise {
    int harmonics;       // [-] of each process; 0: there is none
    double *omega, *phi; // [2][harmonics] rad/s, rad; owned by omega
} side_noise;

// Draws the harmonics that (seed, rocket) decide; `rocket`: its place in the firing sequence.
ld_status side_noise_build(side_noise *self, const ld_side_noise *given, int rocket,
                           ld_error *error);
void side_noise_free(side_noise *self);

// X_y, X_z at t [s] after ignition.
void side_noise_at(const side_noise *self, double t, double x[2]);

#endif
