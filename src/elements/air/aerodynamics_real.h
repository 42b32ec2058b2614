// Air forces over reals (math/real.h), as elements/air/aerodynamics.h has them.
#ifndef LD_ELEMENTS_AERODYNAMICS_REAL_H
#define LD_ELEMENTS_AERODYNAMICS_REAL_H

#include "elements/air/aerodynamics_surfaces.h"
#include "math/vectors/real_vec3.h"

// Force f and moment m about the mass centre, in axes whose x is the rocket's.
typedef struct real_wrench {
    real3 f, m;
} real_wrench;

// How the rocket moves through the air, as in `airflow`.
typedef struct real_airflow {
    real3 v;
    real speed;
    real3 w, c;
    real density;
} real_airflow;

LD_INLINE real_wrench aerodynamics_of_body(real drag, real3 damping, const real_airflow *flow)
{
    real rho = flow->density, speed = flow->speed;
    real3 w = flow->w, turned = {damping.x * w.x, damping.y * w.y, damping.z * w.z};
    return (real_wrench){real3_scale(-rho * drag * speed, flow->v),
                         real3_scale(rho * speed, turned)};
}

// As in `aerodynamics`.
typedef struct real_body {
    real half_area, diameter, cant, crossflow_drag, crossflow_at;
} real_body;

// k: the table's coefficients at the Mach number; drag: the first or the second of them.
LD_INLINE real_wrench aerodynamics_of_coefficients(const real_body *self, const real *k, real drag,
                                                   const real_airflow *flow)
{
    real3 v = flow->v, w = flow->w, c = flow->c;
    real rho = flow->density, speed = flow->speed;
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

// As in `air_surfaces`.
typedef struct real_surfaces {
    real half_area, diameter;
    int slopes, acrosses;
    const real *slope_at, *across_at, *across;
} real_surfaces;

// Velocity through the air at x of B, of that at the origin and its change along x; less the wind's
// there.
LD_INLINE real3 velocity_at(real3 v_0, real3 v_1, real x, const real3 *shear)
{
    real3 u = real3_axpy(v_0, x, v_1);
    return shear ? real3_sub(u, *shear) : u;
}

// k: the table's coefficients at the Mach number; drag: the first or the second of them; shear: the
// wind's velocity less that at the mass centre at each place with a slope and then each of across;
// NULL: none. Axial force and roll moment go with the speed of the mass centre, each lateral force
// with the velocity where it acts.
LD_INLINE real_wrench aerodynamics_of_surfaces(const real_surfaces *self, const real *k, real drag,
                                               const real_airflow *flow, const real3 *shear)
{
    real3 v = flow->v, w = flow->w, c = flow->c;
    real rho = flow->density, speed = flow->speed;
    real q = rho * self->half_area, qd = q * speed * self->diameter;
    real3 v_0 = real3_sub(v, real3_cross(w, c)), v_1 = {real_all(0), w.z, -w.y};
    // sums of the lateral forces, and of them times x
    real3 f = {-q * speed * drag * v.x, real_all(0), real_all(0)};
    real first_y = real_all(0), first_z = real_all(0);
    for (int i = 0; i < self->slopes + self->acrosses; i++) {
        int j = i - self->slopes;
        real x = j < 0 ? self->slope_at[i] : self->across_at[j];
        real3 u = velocity_at(v_0, v_1, x, shear ? shear + i : NULL);
        real side = j < 0 ? -q * k[SURFACES_FIRST + i] * real3_norm(u)
                          : -q * self->across[j] * real_sqrt(u.y * u.y + u.z * u.z);
        real y = side * u.y, z = side * u.z;
        f.y += y;
        f.z += z;
        first_y += x * y;
        first_z += x * z;
    }
    real3 m = {qd * (k[2] * v.x + k[3] * (0.5 * self->diameter) * w.x), -first_z, first_y};
    return (real_wrench){f, real3_sub(m, real3_cross(c, f))};
}

#endif
