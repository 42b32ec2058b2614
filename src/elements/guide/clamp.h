// Directions of supports that are held rigidly (model.md, section 4).
//
// At station x_k, in base axes e_i with d and phi as in support.h, held are
//   d_i = 0:    force along e_i at P;            d_i'' = e_i . (a_P - a_T - alpha_T x rho
//               - w_T x (w_T x rho) - 2 w_T x v_rel),  rho from T's origin, v_rel = v_P - base
//               there
//   phi_i = 0:  moment m_i = J_l(phi)^-T e_i;    phi_i' = m_i . w_rel,
//               phi_i'' = m_i . (alpha_P - alpha_T - w_T x w_rel - (J_l along phi') phi')
// on the section, the opposite on the base: the limit of stiff springs.
#ifndef LD_ELEMENTS_CLAMP_H
#define LD_ELEMENTS_CLAMP_H

#include "elements/guide/constraint.h"
#include "elements/guide/support.h"

// The section at a clamped station.
typedef struct clamped_section {
    element_motion motion;
    axis_section at;
    section_rates rates;
} clamped_section;

// Base and section at a clamped station, in R.
typedef struct clamp_state {
    m3 A_RT;
    v3 a, alpha, w; // of the base
    v3 rho;         // from T's origin to P
    v3 v_base;      // of the base at P
    v3 v_rel, w_rel;
    v3 d, phi; // in T
} clamp_state;

LD_INLINE void clamp_load(const tube_support *support, const launching_instant *now,
                          const constraint_section *section, clamp_state *clamp)
{
    const base_frame *base = &now->input->base;
    const tube_state *tube = &now->tube;
    m3 A_RT = m3_mul(m3_transpose(tube->A_IR), base->A);
    clamp->A_RT = A_RT;
    clamp->a = m3_apply_transposed(tube->A_IR, base->a);
    clamp->alpha = m3_apply_transposed(tube->A_IR, base->alpha);
    clamp->w = m3_apply_transposed(tube->A_IR, base->w);
    clamp->rho = v3_add(m3_apply_transposed(tube->A_IR, v3_sub(tube->r, base->r)), section->at->P);
    clamp->v_base =
        v3_add(m3_apply_transposed(tube->A_IR, base->v), v3_cross(clamp->w, clamp->rho));
    clamp->v_rel = v3_sub(section->v_P, clamp->v_base);
    clamp->w_rel = v3_sub(section->w_P, clamp->w);
    clamp->d = m3_apply_transposed(A_RT, clamp->rho);
    clamp->d.x -= support->x;
    m3 A_TP = m3_mul(m3_transpose(A_RT), section->at->A);
    clamp->phi = rv_of_quaternion(q_from_matrix(A_TP));
}

// m_i = J_l(phi)^-T e_i, in R.
LD_INLINE v3 clamp_moment(const clamp_state *clamp, int i)
{
    v3 e = v3_make(i == 0, i == 1, i == 2);
    return m3_apply(clamp->A_RT, rv_left_jacobian_inverse_transposed(clamp->phi, e));
}

// A coordinate that a clamp holds at zero.
typedef struct clamped_coordinate {
    v3 f, m;            // unit wrench on the section that holds it
    double value, rate; // what is wrong with it
    double bias;        // of its acceleration, what speeds and base make
} clamped_coordinate;

// Its direction, the next one of the set.
LD_INLINE void clamp_direction(const launching_instant *now, int section,
                               const clamped_coordinate *held, constraint_set *set)
{
    const unit_wrench unit = {held->f, held->m, v3_zero(), v3_zero()};
    constraint_direction *e = &set->e[set->count++];
    e->section = section;
    e->work = POWER_BASE;
    e->G_f = e->G_m = e->r_a = e->r_alpha = v3_zero();
    direction_load_tube(now, &set->section[section], &unit, e);
    e->beta = -held->bias - now->phase->restoring * held->value;
    e->drift = -held->rate;
    e->error = -held->value;
}

LD_INLINE void clamp_translations(const tube_support *support, const launching_instant *now,
                                  int number, const clamp_state *clamp, constraint_set *set)
{
    const double d[3] = {clamp->d.x, clamp->d.y, clamp->d.z};
    v3 carried = v3_add(clamp->a, v3_cross(clamp->alpha, clamp->rho));
    carried = v3_add(carried, v3_cross(clamp->w, v3_cross(clamp->w, clamp->rho)));
    carried = v3_add(carried, v3_scale(2, v3_cross(clamp->w, clamp->v_rel)));
    v3 bias = v3_sub(set->section[number].bias.gv, carried);
    for (int i = 0; i < 3; i++)
        if (support->clamped >> (LD_CLAMP_X + i) & 1u) {
            v3 e = m3_column(clamp->A_RT, i);
            const clamped_coordinate held = {.f = e,
                                             .m = v3_zero(),
                                             .value = d[i],
                                             .rate = v3_dot(e, clamp->v_rel),
                                             .bias = v3_dot(e, bias)};
            clamp_direction(now, number, &held, set);
        }
}

LD_INLINE void clamp_rotations(const tube_support *support, const launching_instant *now,
                               int number, const clamp_state *clamp, constraint_set *set)
{
    const double phi[3] = {clamp->phi.x, clamp->phi.y, clamp->phi.z};
    v3 m[3], bias = v3_sub(set->section[number].bias.gw, clamp->alpha);
    for (int i = 0; i < 3; i++)
        m[i] = clamp_moment(clamp, i);
    v3 rate =
        v3_make(v3_dot(m[0], clamp->w_rel), v3_dot(m[1], clamp->w_rel), v3_dot(m[2], clamp->w_rel));
    v3 turning = rv_left_jacobian_derivative(clamp->phi, rate, rate);
    bias = v3_sub(bias, v3_cross(clamp->w, clamp->w_rel));
    bias = v3_sub(bias, m3_apply(clamp->A_RT, turning));
    const double rates[3] = {rate.x, rate.y, rate.z};
    for (int i = 0; i < 3; i++)
        if (support->clamped >> (LD_CLAMP_ROLL + i) & 1u) {
            const clamped_coordinate held = {.f = v3_zero(),
                                             .m = m[i],
                                             .value = phi[i],
                                             .rate = rates[i],
                                             .bias = v3_dot(m[i], bias)};
            clamp_direction(now, number, &held, set);
        }
}

// The section of a clamped station as the next one of the set.
LD_INLINE int station_add(const int lanes, const tube_system *guide, const tube_support *support,
                          const launching_instant *now, clamped_section *own, constraint_set *set)
{
    const tube_state *tube = &now->tube;
    constraint_section *section = &set->section[set->section_count];
    own->at.index = support->element;
    element_load(guide, &tube->modal, own->at.index, &own->motion);
    own->motion.initial = NULL;
    section_load(guide, &own->motion, support->x, &own->at);
    section_rates_load(&own->motion, &own->at, &own->rates);
    section->motion = &own->motion;
    section->at = &own->at;
    section->rates = &own->rates;
    section->s_dot = 0;
    section->v_P = v3_add(v3_add(tube->v, v3_cross(tube->w, own->at.P)), own->rates.u_dot);
    section->w_P = v3_add(tube->w, own->rates.w);
    section->Om = own->rates.w;
    return constraint_section_add(lanes, guide, tube, set);
}

// The directions of all supports; `own`: room for their sections, as long as the set is used.
LD_INLINE void clamp_constrain(const int lanes, const support_set *self, const tube_system *guide,
                               const launching_instant *now,
                               clamped_section own[LD_MAX_CLAMPED_STATIONS], constraint_set *set)
{
    int stations = 0;
    for (int k = 0; self->clamps && k < self->count; k++) {
        const tube_support *support = &self->support[k];
        clamp_state clamp;
        if (!support->clamped)
            continue;
        int number = station_add(lanes, guide, support, now, &own[stations++], set);
        set->section[number].support = k;
        clamp_load(support, now, &set->section[number], &clamp);
        clamp_translations(support, now, number, &clamp, set);
        clamp_rotations(support, now, number, &clamp, set);
    }
}

// Adds the forces found to those on the base and, the opposite, to those recorded of the supports,
// and what the base does by them to its work.
LD_INLINE void clamp_report(const launching_instant *now, const constraint_set *set,
                            launching_output *out)
{
    const base_frame *base = &now->input->base;
    const tube_state *tube = &now->tube;
    m3 A_TR = m3_mul(m3_transpose(base->A), tube->A_IR);
    v3 r = m3_apply_transposed(base->A, v3_sub(tube->r, base->r));
    v3 v = m3_apply_transposed(base->A, base->v), w = m3_apply_transposed(base->A, base->w);
    for (int i = set->clamp_row; i < set->count; i++) {
        const constraint_direction *e = &set->e[i];
        v3 force = v3_scale(set->x[i], m3_apply(A_TR, e->force));
        v3 moment = v3_scale(set->x[i], m3_apply(A_TR, e->moment));
        if (now->on_tube.record) {
            guide_wrench *on = &now->on_tube.record->support[set->section[e->section].support];
            *on = (guide_wrench){v3_sub(on->f, force), v3_sub(on->m, moment)};
        }
        v3 place = v3_add(r, m3_apply(A_TR, set->section[e->section].at->P));
        moment = v3_add(moment, v3_cross(place, force));
        out->base_force = v3_add(out->base_force, force);
        out->base_moment = v3_add(out->base_moment, moment);
        out->power[POWER_BASE] -= v3_dot(force, v) + v3_dot(moment, w);
    }
}

#endif
