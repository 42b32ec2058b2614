// Dryden turbulence, frozen in the air (model.md, section 8; MIL-F-8785C).
#ifndef LD_ENVIRONMENT_TURBULENCE_H
#define LD_ENVIRONMENT_TURBULENCE_H

#include <stdbool.h>

#include "launchdyn/status.h"
#include "math/vec3.h"
#include "model/blocks/environment.h"

enum { TURBULENCE_COMPONENTS = 3 };

// U_j(xi) = sum_i a_ji cos(kappa_ji xi + phi_ji), j = 0 .. 2: U_1 to U_3 of section 8.
typedef struct turbulence {
    bool present;
    double wind_at_6m; // [m/s]
    int harmonics;
    double *a, *kappa, *phi; // [TURBULENCE_COMPONENTS][harmonics], owned by a
} turbulence;

// Draws the harmonics that (seed, rocket) decide.
ld_status turbulence_build(turbulence *self, const ld_turbulence *model, int rocket,
                           ld_error *error);
void turbulence_free(turbulence *self);

// Lengths [m] and standard deviations [m/s] at a height above ground [m]; those of v are those of
// u.
typedef struct turbulence_scales {
    double L_u, L_w;
    double sigma_u, sigma_w;
} turbulence_scales;

turbulence_scales turbulence_scales_at(const turbulence *self, double height);

// Velocity of the air [m/s] along x, y, z of I where the distance flown through the air has come to
// xi_u, xi_w: xi_dot = V_m/L.
v3 turbulence_velocity(const turbulence *self, const turbulence_scales *scales, double xi_u,
                       double xi_w);

// One-sided spectra of unit variance over kappa = L Omega: U_1's, and that of U_2 and U_3.
double turbulence_longitudinal(double kappa);
double turbulence_transverse(double kappa);

#endif
