// The rocket in the tube: a rigid body with six degrees of freedom against the section at its
// travel s (model.md, section 5). Newton-Euler about O1, all in R:
//   M3 [a_O1; alpha_B] = h3 + G N,   M3 = [m E, -m ~c; m ~c, J_O1]
// solved by its inertia about the mass centre; m, c, J instantaneous, without their rates.
#ifndef LD_ELEMENTS_ROCKET_H
#define LD_ELEMENTS_ROCKET_H

#include "elements/tube.h"
#include "math/sine_cosine.h"
#include "math/vectors/rotation_vector.h"
#include "model/blocks/motor.h"

// Sines and cosines of the rocket's angles in the tube.
typedef struct rocket_turns {
    double sp, cp, st, ct, sg, cg;
} rocket_turns;

LD_INLINE rocket_turns rocket_turns_of(const double x[X_COUNT])
{
    rocket_turns k;
    sine_cosine_small(x[X_PSI], &k.sp, &k.cp);
    sine_cosine_small(x[X_THETA], &k.st, &k.ct);
    sine_cosine_small(x[X_GAMMA], &k.sg, &k.cg);
    return k;
}

// A_SB = Rz(psi) Ry(theta) Rx(gamma)
LD_INLINE m3 rocket_attitude(rocket_turns k)
{
    return (m3){{{k.cp * k.ct, k.cp * k.st * k.sg - k.sp * k.cg, k.cp * k.st * k.cg + k.sp * k.sg},
                 {k.sp * k.ct, k.sp * k.st * k.sg + k.cp * k.cg, k.sp * k.st * k.cg - k.cp * k.sg},
                 {-k.st, k.ct * k.sg, k.ct * k.cg}}};
}

// Where the rocket is in the tube and how it moves (formulation.md, section 3).
LD_INLINE void rocket_load(const tube_system *guide, const launching_layout *layout,
                           const double *state, const tube_state *tube, rocket_state *rocket,
                           launching_output *out)
{
    const double *x = state + layout->x, *V = state + layout->V;
    rocket->s = x[X_S];
    rocket->y = x[X_Y];
    rocket->z = x[X_Z];
    rocket_turns k = rocket_turns_of(x);
    rocket->A_SB = rocket_attitude(k);
    rocket->v_O1 = v3_from(V);
    rocket->w_B = v3_from(V + 3);
    axis_section *at = &rocket->at;
    at->index = flexible_tube_find(&guide->flexible, rocket->s);
    element_load(guide, &tube->modal, at->index, &rocket->motion);
    section_load(guide, &rocket->motion, rocket->s, at);
    section_rates_load(&rocket->motion, at, &rocket->rates);
    const section_rates *rates = &rocket->rates;
    rocket->d = v3_make(0, rocket->y, rocket->z);
    rocket->Ad = m3_apply(at->A, rocket->d);
    rocket->p1 = v3_add(at->P, rocket->Ad);
    rocket->A_RB = m3_mul(at->A, rocket->A_SB);
    rocket->v_P = v3_add(v3_add(tube->v, v3_cross(tube->w, at->P)), rates->u_dot);
    rocket->w_P = v3_add(tube->w, rates->w);
    // y = Y^-1 (V - X eta)
    v3 twist = m3_apply(at->Jl, at->k0);
    v3 column = v3_add(at->t, v3_cross(twist, rocket->Ad));
    v3 slip = v3_sub(rocket->v_O1, v3_add(rocket->v_P, v3_cross(rocket->w_P, rocket->Ad)));
    rocket->s_dot = v3_dot(m3_column(at->A, 0), slip) / v3_dot(m3_column(at->A, 0), column);
    slip = v3_axpy(slip, -rocket->s_dot, column);
    rocket->y_dot = v3_dot(m3_column(at->A, 1), slip);
    rocket->z_dot = v3_dot(m3_column(at->A, 2), slip);
    rocket->Om = v3_axpy(rates->w, rocket->s_dot, twist);
    v3 w = m3_apply_transposed(at->A, v3_sub(rocket->w_B, v3_add(tube->w, rocket->Om)));
    rocket->w_SB = w;
    double gamma_dot = (k.cp * w.x + k.sp * w.y) / k.ct;
    out->x_dot[X_S] = out->y[0] = rocket->s_dot;
    out->x_dot[X_Y] = out->y[1] = rocket->y_dot;
    out->x_dot[X_Z] = out->y[2] = rocket->z_dot;
    out->x_dot[X_PSI] = w.z + k.st * gamma_dot;
    out->x_dot[X_THETA] = k.cp * w.y - k.sp * w.x;
    out->x_dot[X_GAMMA] = gamma_dot;
    v3_store(out->y + 3, w);
}

LD_INLINE void rocket_inertia_load(const rocket_mass *mass, m3 A_RB, rocket_inertia *inertia)
{
    inertia->m = mass->m;
    inertia->c = m3_apply(A_RB, mass->c);
    inertia->J = mass->J;
    inertia->J_inverse = m3_symmetric_inverse(mass->J);
    inertia->A_RB = A_RB;
}

// M3^-1 (f, m about O1).
LD_INLINE void rocket_solve(const rocket_inertia *inertia, v3 f, v3 m, v3 *a, v3 *alpha)
{
    v3 m_C = v3_sub(m, v3_cross(inertia->c, f));
    v3 local = m3_apply(inertia->J_inverse, m3_apply_transposed(inertia->A_RB, m_C));
    *alpha = m3_apply(inertia->A_RB, local);
    *a = v3_sub(v3_scale(1 / inertia->m, f), v3_cross(*alpha, inertia->c));
}

// The further motors' force and moment about O1, and their power.
LD_INLINE void rocket_push_further(const motor_across *across, launching_instant *now)
{
    const rocket_state *rocket = &now->rocket;
    v3 force = m3_apply(rocket->A_RB, across->others_force);
    v3 moment = m3_apply(rocket->A_RB, across->others_moment);
    now->f = v3_add(now->f, force);
    now->m = v3_add(now->m, moment);
    now->out->power[POWER_THRUST] += v3_dot(force, rocket->v_O1) + v3_dot(moment, rocket->w_B);
}

// Gravity, thrust and gyroscopic wrench about O1; their powers.
LD_INLINE void rocket_forces(const ld_motor *thruster, launching_instant *now)
{
    const rocket_state *rocket = &now->rocket;
    const rocket_inertia *inertia = &now->inertia;
    launching_output *out = now->out;
    v3 w = rocket->w_B, c = inertia->c;
    v3 weight = v3_scale(inertia->m, now->tube.g);
    v3 v_C = v3_add(rocket->v_O1, v3_cross(w, c));
    // thrust along (1, eps_y, eps_z) at (x_T, e_y, e_z) of B, the side force there
    const motor_across *across = &now->input->across;
    double ey = thruster->misalignment[0] + across->lean[0],
           ez = thruster->misalignment[1] + across->lean[1];
    double along = (now->input->thrust - across->others) / sqrt(1 + ey * ey + ez * ez);
    v3 thrust = v3_make(along, along * ey + across->force[0], along * ez + across->force[1]);
    thrust = m3_apply(rocket->A_RB, thrust);
    v3 at = v3_make(thruster->at[0], thruster->at[1] + across->shift[0],
                    thruster->at[2] + across->shift[1]);
    at = m3_apply(rocket->A_RB, at);
    now->f = v3_add(weight, thrust);
    now->m = v3_add(v3_cross(c, weight), v3_cross(at, thrust));
    out->power[POWER_GRAVITY_ROCKET] = v3_dot(weight, v_C);
    out->power[POWER_THRUST] = v3_dot(thrust, v3_add(rocket->v_O1, v3_cross(w, at)));
    if (across->others != 0)
        rocket_push_further(across, now);
    // gyroscopic: -(m w x (w x c), c x the same + w x J w)
    v3 w_local = m3_apply_transposed(rocket->A_RB, w);
    v3 J_w = m3_apply(inertia->J, w_local);
    v3 gyro = v3_scale(inertia->m, v3_cross(w, v3_cross(w, c)));
    v3 turn = m3_apply(rocket->A_RB, v3_cross(w_local, J_w));
    now->f = v3_sub(now->f, gyro);
    now->m = v3_sub(now->m, v3_add(turn, v3_cross(c, gyro)));
    // burnt mass takes its kinetic energy along: 1/2 V^T (dM/dt) V
    const rocket_mass *mass = &now->input->mass;
    v3 c_dot = m3_apply(rocket->A_RB, mass->c_dot);
    out->power[POWER_MASS_CHANGE] = 0.5 * mass->m_dot * v3_norm2(v_C) +
                                    inertia->m * v3_dot(v_C, v3_cross(w, c_dot)) +
                                    0.5 * v3_dot(w_local, m3_apply(mass->J_dot, w_local));
}

#endif
