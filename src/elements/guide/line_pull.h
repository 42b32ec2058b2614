// The line that the rocket draws out of its container, while the rocket is in its tube (model.md,
// section 8): straight from the container to the bridle, all that is out as fast as the bridle.
// With l the distance, u its rate, m' the mass per length, T_c the container's tension, a the
// acceleration of the bridle along the line, the pull is T_c + m' u^2 + m' l a. The last term
// follows from what acts on the rocket, less the forces of constraints; while the lock holds it is
// left out.
//
// What lies slack pulls at nothing. Once l is the length L that is out, a wave runs from the bridle
// to the container with the speed c = sqrt(EA/m'). Behind it the line is as fast as the bridle, so
// the pull is sqrt(EA m') u (K. F. Graff, Wave Motion in Elastic Solids, 1975, section 2.4), up to
// where l - L = l u/c: what the pull has given, sqrt(EA m') (l - L), is then the momentum m' l u,
// with which the line goes on as above.
#ifndef LD_ELEMENTS_LINE_PULL_H
#define LD_ELEMENTS_LINE_PULL_H

#include "elements/rocket.h"

// [m/s] below which the container's tension falls to nothing with the speed.
static const double LINE_CREEP = 0.1;

// The container and its velocity, in R, from R's origin.
LD_INLINE void line_container(const ld_line *given, const launching_instant *now, v3 *r, v3 *v)
{
    const base_frame *base = &now->input->base;
    const tube_state *tube = &now->tube;
    v3 at = v3_from(given->container), speed = v3_zero();
    if (given->container_on == LD_LINE_ON_LAUNCHER) {
        v3 arm = m3_apply(base->A, at);
        at = v3_add(base->r, arm);
        speed = v3_add(base->v, v3_cross(base->w, arm));
    }
    *r = m3_apply_transposed(tube->A_IR, v3_sub(at, tube->r));
    *v = m3_apply_transposed(tube->A_IR, speed);
}

// [m/s] Of a wave of tension.
LD_INLINE double line_wave_speed(const ld_line *given)
{
    return sqrt(given->stiffness / given->mass_per_length);
}

// [N] Pull at the end of a line at rest that is drawn with u.
LD_INLINE double line_jerk(const ld_line *given, double u)
{
    return fmax(0, u) * sqrt(given->stiffness * given->mass_per_length);
}

// What of m' l a follows: with the pull itself, by the rocket's mobility at its bridle.
LD_INLINE double line_inertia(double mass, const launching_instant *now, v3 bridle, v3 e)
{
    v3 a, alpha, w = now->rocket.w_B;
    rocket_solve(&now->inertia, now->f, now->m, &a, &alpha);
    v3 at = v3_add(v3_add(a, v3_cross(alpha, bridle)), v3_cross(w, v3_cross(w, bridle)));
    rocket_solve(&now->inertia, e, v3_cross(bridle, e), &a, &alpha);
    double mobility = v3_dot(e, v3_add(a, v3_cross(alpha, bridle)));
    return mass * v3_dot(at, e) / (1 + mass * mobility);
}

// How far a line is from another state: from being taut [mm], from its end having moved as far as
// it does while the wave runs along what is out [mm], or from breaking. While nothing is slack it
// first breaks at the bridle: behind that the pull is less by what it accelerates, and what it is
// without acceleration falls where the rocket gets slower.
LD_INLINE double line_left(const ld_line *given, const launching_phase *phase, double distance,
                           double u, double pull)
{
    double beyond = (phase->line_out - distance) / 1e-3;
    if (phase->line == LINE_SLACK)
        return beyond;
    double left = isnan(given->breaking_force) ? 1 : 1 - pull / given->breaking_force;
    if (phase->line == LINE_JERKED)
        left = fmin(left, beyond + distance * u / line_wave_speed(given) / 1e-3);
    return left;
}

LD_INLINE void line_pull(const ld_line *given, launching_instant *now)
{
    const rocket_state *rocket = &now->rocket;
    const launching_phase *phase = now->phase;
    launching_output *out = now->out;
    v3 bridle = m3_apply(rocket->A_RB, v3_from(given->bridle)), c, v_c;
    v3 v = v3_add(rocket->v_O1, v3_cross(rocket->w_B, bridle));
    line_container(given, now, &c, &v_c);
    v3 reach = v3_sub(v3_add(rocket->p1, bridle), c);
    double distance = v3_norm(reach);
    v3 e = distance > 0 ? v3_scale(1 / distance, reach) : v3_zero();
    double u = v3_dot(e, v3_sub(v, v_c)), holds = phase->frictionless ? 0 : given->tension;
    double pull = u > 0 ? holds * fmin(1, u / LINE_CREEP) + given->mass_per_length * u * u : 0;
    if (phase->line != LINE_TAUT)
        pull = phase->line == LINE_JERKED ? line_jerk(given, u) : 0;
    now->f = v3_axpy(now->f, -pull, e);
    now->m = v3_axpy(now->m, -pull, v3_cross(bridle, e));
    if (u > 0 && !phase->locked && phase->line == LINE_TAUT) {
        double lag = line_inertia(given->mass_per_length * distance, now, bridle, e);
        lag = fmax(lag, -pull);
        now->f = v3_axpy(now->f, -lag, e);
        now->m = v3_axpy(now->m, -lag, v3_cross(bridle, e));
        pull += lag;
    }
    out->line_tension = pull;
    out->line_paid = phase->line == LINE_TAUT ? distance : phase->line_out;
    out->line_left = phase->line == LINE_BROKEN ? 1 : line_left(given, phase, distance, u, pull);
    out->power[POWER_LINE] = -pull * v3_dot(e, v);
}

#endif
