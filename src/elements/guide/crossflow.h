// The air on the part of the rocket that has come out of the tube, until its rear adaptor does
// (model.md, section 5): a drag of the lateral speed alone.
//
// Per length -1/2 rho C_c D |v_t| v_t, with v_t the velocity of the rocket's axis against the air,
// less its part along the axis; from the tip, x = L - s of B, to the nose.
#ifndef LD_ELEMENTS_CROSSFLOW_H
#define LD_ELEMENTS_CROSSFLOW_H

#include "elements/rocket.h"

typedef struct crossflow_body {
    double nose;       // [m] x of B
    double half_width; // [m] C_c D/2; 0: the air does nothing
} crossflow_body;

// Integrals of |u| u and of x |u| u over x.
typedef struct crossflow_integrals {
    v3 zeroth, first; // [m3/s2], [m4/s2]
} crossflow_integrals;

// Adds those from a to b, u = u_0 + x u_1, by Gauss' formula of five points.
LD_INLINE void crossflow_integrate(v3 u_0, v3 u_1, double a, double b, crossflow_integrals *sum)
{
    static const double node[5] = {-0.90617984593866399280, -0.53846931010568309104, 0,
                                   0.53846931010568309104, 0.90617984593866399280};
    static const double weight[5] = {0.23692688505618908751, 0.47862867049936646804,
                                     0.56888888888888888889, 0.47862867049936646804,
                                     0.23692688505618908751};
    double half = 0.5 * (b - a), middle = 0.5 * (a + b);
    for (int i = 0; i < 5; i++) {
        double x = middle + half * node[i];
        v3 u = v3_axpy(u_0, x, u_1);
        double share = half * weight[i] * v3_norm(u);
        sum->zeroth = v3_axpy(sum->zeroth, share, u);
        sum->first = v3_axpy(sum->first, share * x, u);
    }
}

LD_INLINE void crossflow_add(const crossflow_body *self, const tube_system *guide,
                             launching_instant *now)
{
    const rocket_state *rocket = &now->rocket;
    const moving_air *about = &now->input->air;
    launching_output *out = now->out;
    double tip = guide->flexible.length - rocket->s;
    if (self->half_width == 0)
        return;
    out->emerged = 0;
    out->crossflow = v3_zero();
    if (self->nose <= tip)
        return;
    // lateral velocity against the air, u_0 + x u_1; least at x = least, where |u| u has its bend
    v3 d = m3_column(rocket->A_RB, 0), u_1 = v3_cross(rocket->w_B, d);
    v3 slip = v3_sub(rocket->v_O1, m3_apply_transposed(now->tube.A_IR, about->v));
    v3 u_0 = v3_axpy(slip, -v3_dot(slip, d), d);
    double square = v3_norm2(u_1), least = square > 0 ? -v3_dot(u_0, u_1) / square : tip;
    double bend = fmin(fmax(least, tip), self->nose);
    crossflow_integrals sum = {v3_zero(), v3_zero()};
    crossflow_integrate(u_0, u_1, tip, bend, &sum);
    crossflow_integrate(u_0, u_1, bend, self->nose, &sum);
    // force, and its moment about O1 by x d x f
    double factor = -about->density * self->half_width;
    v3 f = v3_scale(factor, sum.zeroth), first = v3_scale(factor, sum.first);
    out->emerged = self->nose - tip;
    out->crossflow = f;
    out->power[POWER_AIR] = v3_dot(f, rocket->v_O1) + v3_dot(first, u_1);
    now->f = v3_add(now->f, f);
    now->m = v3_add(now->m, v3_cross(d, first));
}

LD_INLINE void crossflow_build(const ld_aerodynamics *given, crossflow_body *self)
{
    *self = (crossflow_body){0};
    if (!given->present || !given->emerged.present)
        return;
    double own = given->emerged.diameter, diameter = isnan(own) ? given->reference_diameter : own;
    self->nose = given->emerged.nose;
    self->half_width = 0.5 * given->emerged.drag * diameter;
}

#endif
