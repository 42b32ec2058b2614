// Adaptors of the law `ideal`: held on the axis exactly, without friction (model.md, section 5).
//
// Held is y = z = 0 of the offset at the adaptor's foot. With t = dP/dx there and v_rel the
// velocity of its centre against the section's material, moved rigidly,
//   y_dot = n . v_rel,   n = A (e_y - kappa e_x),   kappa = (A e_y . t)/(A e_x . t),   n . t = 0;
// force along n at the centre, the opposite on the section. z alike.
#ifndef LD_ELEMENTS_IDEAL_H
#define LD_ELEMENTS_IDEAL_H

#include "elements/guide/adaptor.h"
#include "elements/guide/constraint.h"
#include "math/functions.h"

// Rate of t = dP/dx of a section as its station moves, less what turns with the section's frame.
LD_INLINE v3 tangent_rate(const constraint_section *section)
{
    const axis_section *at = section->at;
    v3 t_dot = section->rates->u1_dot;
    if (at->beyond == 0) { // there the axis is straight
        const element_motion *motion = section->motion;
        v3 bend = v3_make(0, poly2(motion->y, at->xi), poly2(motion->z, at->xi));
        if (__builtin_expect(motion->shortened, 0))
            bend.x = shortened_bend(motion, at->xi);
        if (__builtin_expect(motion->initial != NULL, 0)) {
            initial_section initial;
            initial_shape_at(motion->initial, at->x, &initial);
            bend = v3_add(bend, initial.P2);
        }
        t_dot = v3_axpy(t_dot, section->s_dot, bend);
    }
    return v3_sub(t_dot, v3_cross(section->Om, at->t));
}

// The section at the adaptor's foot as the next one of the set.
LD_INLINE int foot_add(const int lanes, const tube_system *guide, const launching_instant *now,
                       const adaptor_state *adaptor, constraint_set *set)
{
    const tube_state *tube = &now->tube;
    const axis_section *at = adaptor->foot;
    constraint_section *section = &set->section[set->section_count];
    section->motion = &adaptor->own_motion;
    section->at = at;
    section->rates = adaptor->rates;
    section->v_P = v3_add(v3_add(tube->v, v3_cross(tube->w, at->P)), adaptor->rates->u_dot);
    section->w_P = v3_add(tube->w, adaptor->rates->w);
    v3 twist = m3_apply(at->Jl, at->k0), axis = m3_column(at->A, 0);
    v3 slip = v3_sub(adaptor->v_C, v3_add(section->v_P, v3_cross(section->w_P, adaptor->offset)));
    v3 column = v3_add(at->t, v3_cross(twist, adaptor->offset));
    section->s_dot = v3_dot(axis, slip) / v3_dot(axis, column);
    section->Om = v3_axpy(adaptor->rates->w, section->s_dot, twist);
    return constraint_section_add(lanes, guide, tube, set);
}

// The two directions of an adaptor; what it reports but for the force, which is not known yet.
LD_INLINE void adaptor_constrain(const int lanes, const tube_system *guide,
                                 const launching_instant *now, const adaptor_state *adaptor,
                                 constraint_set *set)
{
    int i = adaptor->number;
    now->out->adaptor[i] =
        (adaptor_report){.s = adaptor->foot->x, .y = adaptor->y, .z = adaptor->z};
    int number = i == 0 ? 0 : foot_add(lanes, guide, now, adaptor, set);
    const constraint_section *section = &set->section[number];
    const axis_section *at = section->at;
    v3 t_rate = tangent_rate(section), e_x = m3_column(at->A, 0);
    double along = v3_dot(e_x, at->t), offset[2] = {adaptor->y, adaptor->z};
    set->adaptor_row[i] = set->count;
    for (int k = 0; k < 2; k++) {
        v3 e = m3_column(at->A, 1 + k);
        double kappa = v3_dot(e, at->t) / along;
        v3 n = v3_axpy(e, -kappa, e_x);
        v3 n_rate = v3_scale(-v3_dot(n, t_rate) / along, e_x);
        const unit_wrench unit = {n, v3_zero(), adaptor->offset, adaptor->arm};
        constraint_direction *held =
            constrain_force(now, number, &unit, n_rate, POWER_CONTACT_NORMAL, set);
        held->beta += now->phase->restoring * offset[k];
    }
}

// All that have not passed the tip; `adaptor`: room for them, as long as the set is used.
LD_INLINE void ideal_constrain(const int lanes, const adaptor_set *self, const tube_system *guide,
                               const launching_instant *now,
                               adaptor_state adaptor[IDEAL_MOST_ADAPTORS], constraint_set *set)
{
    for (int i = 0; self->law.held && i < self->count; i++)
        if (!now->phase->passed[i]) {
            adaptor_load(self, guide, &now->tube, &now->rocket, i, &adaptor[i]);
            adaptor_rates(&now->tube, &now->rocket, &adaptor[i]);
            adaptor_constrain(lanes, guide, now, &adaptor[i], set);
        }
}

// The forces found, of the adaptors that are held.
LD_INLINE void ideal_report(const adaptor_set *self, const constraint_set *set,
                            launching_output *out)
{
    for (int i = 0; self->law.held && i < self->count; i++)
        if (set->adaptor_row[i] >= 0) {
            const double *x = &set->x[set->adaptor_row[i]];
            out->adaptor[i].normal = out->adaptor[i].force = hypot(x[0], x[1]);
        }
}

// Puts the rocket where the adaptors that are held have no offset from the axis: O1 by its position
// in the section, the other one by the rocket's attitude. Other coordinates stay.
LD_INLINE void ideal_place(const adaptor_set *self, const tube_system *guide,
                           const launching_layout *layout, const launching_phase *phase,
                           const tube_state *tube, double *state)
{
    double *x = state + layout->x;
    rocket_state rocket;
    launching_output unused;
    adaptor_state adaptor;
    x[X_Y] = x[X_Z] = 0;
    for (int i = 1; i < self->count; i++)
        for (int pass = 0; pass < 10 && !phase->passed[i]; pass++) {
            rocket_load(guide, layout, state, tube, &rocket, &unused);
            adaptor_load(self, guide, tube, &rocket, i, &adaptor);
            x[X_PSI] -= adaptor.y / self->at[i];
            x[X_THETA] += adaptor.z / self->at[i];
            if (fabs(adaptor.y) + fabs(adaptor.z) < 1e-15)
                break;
        }
}

#endif
