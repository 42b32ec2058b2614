// The slot: the rocket's knob in a helical slot of the tube (model.md, section 5).
//
// Knob at r_E = (0, y_S, z_S) + A_SB rho_E in S, e_t circumferential there, alpha the slot's angle
// at s:  n = -sin(alpha) e_x + cos(alpha) e_t,  tau = cos(alpha) e_x + sin(alpha) e_t.  Held is n .
// v_rel = 0; force on the rocket N n - mu |N| w tau, w = v_tau/sqrt(v_tau^2 + v_eps^2).
#ifndef LD_ELEMENTS_SLOT_H
#define LD_ELEMENTS_SLOT_H

#include "elements/guide/constraint.h"
#include "math/functions.h"
#include "model/blocks/rocket.h"

typedef struct slot_system {
    bool present;          // false: smooth bore
    const ld_table *angle; // over the station
    double knob_y, knob_z; // [m] rho_E = (0, knob_y, knob_z)
    double friction;       // mu_s
    double v_eps;          // [m/s] of its regularisation
} slot_system;

// The slot's two directions at the knob, in S: normal and tangent, and the normal's derivative.
typedef struct slot_frame {
    v3 r_E;           // from P(s) to the knob, in S
    v3 n, tau, n_dot; // in S
} slot_frame;

// Of a table of two columns the second at s and its derivative (linear between the table's points,
// constant outside).
LD_INLINE double table_linear_at(const ld_table *table, double s, double *slope)
{
    *slope = 0;
    const double *row = table->data;
    size_t last = table->rows - 1, columns = table->columns;
    if (s <= row[0] || last == 0)
        return row[1];
    if (s >= row[last * columns])
        return row[last * columns + 1];
    size_t k = 1;
    while (s >= row[k * columns])
        k++;
    const double *p = row + (k - 1) * columns, *q = row + k * columns;
    *slope = (q[1] - p[1]) / (q[0] - p[0]);
    return p[1] + *slope * (s - p[0]);
}

LD_INLINE void slot_load(const slot_system *self, const rocket_state *rocket, slot_frame *slot)
{
    v3 arm = m3_apply(rocket->A_SB, v3_make(0, self->knob_y, self->knob_z));
    v3 r = v3_add(rocket->d, arm);
    slot->r_E = r;
    double radius = sqrt(r.y * r.y + r.z * r.z);
    v3 e_t = v3_make(0, -r.z / radius, r.y / radius);
    double slope, alpha = table_linear_at(self->angle, rocket->s, &slope), sa, ca;
    sine_cosine_small(alpha, &sa, &ca);
    slot->n = v3_make(-sa, ca * e_t.y, ca * e_t.z);
    slot->tau = v3_make(ca, sa * e_t.y, sa * e_t.z);
    // rates in S: of the knob, of e_t about x, of alpha
    v3 r_dot = v3_add(v3_make(0, rocket->y_dot, rocket->z_dot), v3_cross(rocket->w_SB, arm));
    double turn = (r.y * r_dot.z - r.z * r_dot.y) / (radius * radius);
    double alpha_dot = slope * rocket->s_dot;
    // n = (-sin a, cos a e_t): d/dt = -alpha_dot tau + cos a de_t, de_t = turn (e_x x e_t)
    slot->n_dot = v3_axpy(v3_make(0, -ca * turn * e_t.z, ca * turn * e_t.y), -alpha_dot, slot->tau);
}

// The slot's constraint and, where it slides, the tangent with the sliding speed.
LD_INLINE void slot_constrain(const slot_system *self, const launching_instant *now,
                              constraint_set *set)
{
    const rocket_state *rocket = &now->rocket;
    slot_frame slot;
    slot_load(self, rocket, &slot);
    v3 n = m3_apply(rocket->at.A, slot.n), tau = m3_apply(rocket->at.A, slot.tau);
    v3 r_T = m3_apply(rocket->at.A, slot.r_E), rho = v3_sub(r_T, rocket->Ad);
    const unit_wrench normal = {n, v3_zero(), r_T, rho}, along = {tau, v3_zero(), r_T, rho};
    set->slot_row = set->count;
    constrain_force(now, 0, &normal, m3_apply(rocket->at.A, slot.n_dot), POWER_SLOT, set);
    set->sliding = !now->phase->locked && !now->phase->frictionless && self->friction > 0;
    if (!set->sliding)
        return;
    set->tangent.section = 0;
    direction_load(now, &set->section[0], &along, &set->tangent);
    v3 v_E = v3_add(rocket->v_O1, v3_cross(rocket->w_B, rho));
    set->v_tau = v3_dot(tau, v3_sub(v_E, v3_add(rocket->v_P, v3_cross(rocket->w_P, r_T))));
    set->mu = self->friction;
    set->rub =
        self->friction * set->v_tau / sqrt(set->v_tau * set->v_tau + self->v_eps * self->v_eps);
}

LD_INLINE void slot_build(const ld_slot *slot, const ld_rocket *rocket, slot_system *self)
{
    self->present = slot->kind == LD_SLOT_HELIX;
    self->angle = &slot->angle;
    self->knob_y = slot->radius * cos(rocket->knob_angle);
    self->knob_z = slot->radius * sin(rocket->knob_angle);
    self->friction = slot->friction;
    self->v_eps = rocket->contact.friction_speed;
}

#endif
