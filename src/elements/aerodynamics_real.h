// Air forces over reals (math/real.h), as elements/aerodynamics.h has them.
#ifndef LD_ELEMENTS_AERODYNAMICS_REAL_H
#define LD_ELEMENTS_AERODYNAMICS_REAL_H

#include "math/real_vec3.h"

// Force f and moment m about the mass centre, in axes whose x is the rocket's.
typedef struct real_wrench {
    real3 f, m;
} real_wrench;

// v: velocity [m/s] through the air of the mass centre c [m from O1], w: angular velocity [rad/s],
// rho: density [kg/m3], all in the same axes, of B or of a frame that differs from B by a roll.
LD_INLINE real_wrench aerodynamics_of_body(real drag, real3 damping, real3 v, real speed, real3 w,
                                           real rho)
{
    real3 turned = {damping.x * w.x, damping.y * w.y, damping.z * w.z};
    return (real_wrench){real3_scale(-rho * drag * speed, v), real3_scale(rho * speed, turned)};
}

// As in `aerodynamics`.
typedef struct real_body {
    real half_area, diameter, cant, crossflow_drag, crossflow_at;
} real_body;

// k: the table's coefficients at the Mach number; drag: the first or the second of them.
LD_INLINE real_wrench aerodynamics_of_coefficients(const real_body *self, const real *k, real drag,
                                                   real3 v, real speed, real3 w, real3 c, real rho)
{
    // force of the coefficients at the centre of pressure, drag of the lateral speed where it acts
    real q = rho * self->half_area * speed, half = 0.5 * self->diameter;
    real side = -q * k[2];
    real lateral = real_sqrt(v.y * v.y + v.z * v.z);
    real across = -rho * self->half_area * self->crossflow_drag * lateral;
    real3 f = {-q * drag * v.x, side * v.y, side * v.z};
    real3 g = {real_all(0), across * v.y, across * v.z};
    real qd = q * self->diameter;
    real3 m = {qd * (k[4] * self->cant * v.x + k[5] * half * w.x), qd * k[6] * half * w.y,
               qd * k[6] * half * w.z};
    m = real3_add(m, real3_cross((real3){k[3] - c.x, -c.y, -c.z}, f));
    m = real3_add(m, real3_cross((real3){self->crossflow_at - c.x, -c.y, -c.z}, g));
    return (real_wrench){real3_add(f, g), m};
}

#endif
