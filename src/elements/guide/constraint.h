// Constraints of rocket and tube: directions in which a force (or moment) acts on the rocket at a
// point of a section of the tube, the opposite on the tube, and which the solve keeps from moving
// (formulation.md, sections 3 and 4). The sections may be several: that at s, those of other
// adaptors.
//
// G: unit wrench on the rocket about O1; B = L^T of the same on the tube, L of its section. Held is
//   G^T V - B^T eta = 0;   D x = -(G^T r_O - B^T e_0 + beta),   D_ij = G_i^T M3^-1 G_j + B_i^T
//   M2^-1 B_j
#ifndef LD_ELEMENTS_CONSTRAINT_H
#define LD_ELEMENTS_CONSTRAINT_H

#include "elements/rocket.h"
#include "math/matrices/ldl.h"

enum {
    LD_MAX_CONSTRAINTS = 8 + LD_MAX_CLAMPED,
    LD_MAX_CONSTRAINT_SECTIONS = 2 + LD_MAX_CLAMPED_STATIONS,
};

// A direction of constraint: unit wrench on the rocket about O1 and on the tube (formulation.md,
// section 3, G_e and B_e), and what the solve makes of them.
typedef struct constraint_direction {
    int section;     // on which it acts, of the set's
    v3 G_f, G_m;     // on the rocket
    v3 r_a, r_alpha; // M3^-1 G
    v3 force, mu;    // at the section: force, and Jl^T moment, that act on the modes
    v3 moment;       // at the section's axis point
    double rigid[6]; // L^-1 (B_r - C B_q): forward-substituted
    double beta;     // right-hand side besides accelerations
    double drift;    // e . v_rel
    double error;    // of what clamps hold in place: as far as it is off, like the drift
    int work;        // of its force, which among the powers
} constraint_direction;

// A unit force and moment at a point of a section of the tube that is a point of the rocket, too;
// all in R. The force is zero where a moment holds, and the moment where a force does.
typedef struct unit_wrench {
    v3 f, m;
    v3 r_T; // the point, from the section's axis point
    v3 rho; // the same, from O1
} unit_wrench;

// Velocity-dependent accelerations of a section (formulation.md, section 4: gv, gw).
typedef struct section_bias {
    v3 gv, gw;
} section_bias;

// A section on which constraints act.
typedef struct constraint_section {
    const element_motion *motion;
    const axis_section *at;
    const section_rates *rates;
    int support;  // that clamps it, of the tube's, where one does
    double s_dot; // of its station
    v3 v_P, w_P;  // section's material velocity and rate, inertial, in R
    v3 Om;        // rate of the frame that goes along with the station, against R
    section_shapes shapes;
    section_bias bias;
} constraint_section;

// Products of the shapes at two sections p, q, by plane (the first of both, where they are shared).
typedef struct shape_products {
    double bb[2], bb1[2], b1b[2], b1b1[2]; // b_p . b_q, b_p . b'_q, b'_p . b_q, ...
    double tt;
} shape_products;

// The constraints in force, in the order in which their elements have put them; friction of one of
// them acts along a tangent.
typedef struct constraint_set {
    int section_count; // the first is the rocket's, where it is in the tube
    constraint_section section[LD_MAX_CONSTRAINT_SECTIONS];
    int count;
    constraint_direction e[LD_MAX_CONSTRAINTS];
    double x[LD_MAX_CONSTRAINTS];     // forces found
    int slot_row, lock_row;           // of these, or -1
    int clamp_row;                    // the first of the clamps, which come last
    int adaptor_row[LD_MAX_ADAPTORS]; // the first of the two of an adaptor held on the axis
    // friction of the slot, -rub |x| along the tangent
    bool sliding;
    constraint_direction tangent;
    double v_tau;    // [m/s] along it
    double mu, rub;  // coefficient; mu v_tau/sqrt(v_tau^2 + v_eps^2)
    double friction; // [N] found, along tau
} constraint_set;

// Products of the directions in force; Dt: of each on the tangent.
typedef struct constraint_products {
    double D[LD_MAX_CONSTRAINTS][LD_MAX_CONSTRAINTS], Dt[LD_MAX_CONSTRAINTS];
    // of the shapes at sections p < q
    shape_products cross[LD_MAX_CONSTRAINT_SECTIONS][LD_MAX_CONSTRAINT_SECTIONS];
} constraint_products;

// Accelerations with the constraint forces so far: of the rocket, of the tube
// (forward-substituted), and the forces on the sections that the modes still have to feel.
typedef struct constrained {
    v3 a, alpha;
    double rigid[6];
    v3 force[LD_MAX_CONSTRAINT_SECTIONS], mu[LD_MAX_CONSTRAINT_SECTIONS];
} constrained;

// What a direction does to the modes of a plane: by its force, and by its couple, that the slope
// works on.
typedef struct plane_load {
    double f, mu;
} plane_load;

LD_INLINE plane_load load_in_y(const constraint_direction *e)
{
    return (plane_load){e->force.y, e->mu.z};
}
LD_INLINE plane_load load_in_z(const constraint_direction *e)
{
    return (plane_load){e->force.z, -e->mu.y};
}

// A plane's part of B_1^T M^-1 B_2 where it has shapes of its own; one section is two alike.
LD_INLINE double plane_product(double bb, double bb1, double b1b, double b1b1, plane_load p,
                               plane_load q)
{
    return bb * p.f * q.f + bb1 * p.f * q.mu + b1b * p.mu * q.f + b1b1 * p.mu * q.mu;
}

LD_OUTLINE double modal_product_two_planes(const section_shapes *shapes,
                                           const constraint_direction *p,
                                           const constraint_direction *q)
{
    const plane_shapes *y = &shapes->plane[PLANE_Y], *z = &shapes->plane[PLANE_Z];
    return plane_product(y->bb, y->bb1, y->bb1, y->b1b1, load_in_y(p), load_in_y(q)) +
           plane_product(z->bb, z->bb1, z->bb1, z->b1b1, load_in_z(p), load_in_z(q)) +
           shapes->tt * p->mu.x * q->mu.x;
}

LD_OUTLINE double modal_cross_product_two_planes(const shape_products *of,
                                                 const constraint_direction *p,
                                                 const constraint_direction *q)
{
    const int z = PLANE_Z;
    return plane_product(of->bb[0], of->bb1[0], of->b1b[0], of->b1b1[0], load_in_y(p),
                         load_in_y(q)) +
           plane_product(of->bb[z], of->bb1[z], of->b1b[z], of->b1b1[z], load_in_z(p),
                         load_in_z(q)) +
           of->tt * p->mu.x * q->mu.x;
}

// Modal part of B_1^T M^-1 B_2 for forces at one section.
LD_INLINE double modal_product(const section_shapes *of, const constraint_direction *p,
                               const constraint_direction *q)
{
    const plane_shapes *shapes = &of->plane[PLANE_Y];
    if (__builtin_expect(of->z == PLANE_Z, 0))
        return modal_product_two_planes(of, p, q);
    return shapes->bb * (p->force.y * q->force.y + p->force.z * q->force.z) +
           shapes->b1b1 * (p->mu.z * q->mu.z + p->mu.y * q->mu.y) +
           shapes->bb1 * (p->force.y * q->mu.z + p->mu.z * q->force.y - p->force.z * q->mu.y -
                          p->mu.y * q->force.z) +
           of->tt * p->mu.x * q->mu.x;
}

// The same for forces at two sections.
LD_INLINE double modal_cross_product(const shape_products *shapes, bool planes_differ,
                                     const constraint_direction *p, const constraint_direction *q)
{
    if (__builtin_expect(planes_differ, 0))
        return modal_cross_product_two_planes(shapes, p, q);
    return shapes->bb[0] * (p->force.y * q->force.y + p->force.z * q->force.z) +
           shapes->b1b1[0] * (p->mu.z * q->mu.z + p->mu.y * q->mu.y) +
           shapes->bb1[0] * (p->force.y * q->mu.z - p->force.z * q->mu.y) +
           shapes->b1b[0] * (p->mu.z * q->force.y - p->mu.y * q->force.z) +
           shapes->tt * p->mu.x * q->mu.x;
}

LD_INLINE void shape_products_load(const int lanes, const tube_system *guide,
                                   const section_shapes *p, const section_shapes *q,
                                   shape_products *products)
{
    for (int k = PLANE_Y; k <= guide->z; k++) {
        const plane_shapes *of_p = &p->plane[k], *of_q = &q->plane[k];
        products->bb[k] = v4d_dot(lanes, of_p->b, of_q->b);
        products->bb1[k] = v4d_dot(lanes, of_p->b, of_q->b1);
        products->b1b[k] = v4d_dot(lanes, of_p->b1, of_q->b);
        products->b1b1[k] = v4d_dot(lanes, of_p->b1, of_q->b1);
    }
    products->tt = 0;
    for (int j = 0; j < guide->flexible.nt; j++)
        products->tt += p->tau[j] * q->tau[j];
}

// Sets up what a direction does to the tube: the opposite of its unit wrench at the section.
LD_INLINE void direction_load_tube(const launching_instant *now, const constraint_section *section,
                                   const unit_wrench *unit, constraint_direction *e)
{
    v3 f = unit->f, m = unit->m, r_T = unit->r_T;
    const tube_state *tube = &now->tube;
    const section_shapes *shapes = &section->shapes;
    const plane_shapes *y = &shapes->plane[PLANE_Y], *z = &shapes->plane[shapes->z];
    const axis_section *s = section->at;
    v3 W = v3_add(s->P, r_T);
    e->force = f;
    e->moment = v3_add(m, v3_cross(r_T, f));
    e->mu = m3_apply_transposed(s->Jl, v3_add(m, v3_cross(v3_sub(W, s->root), f)));
    // B_r - C B_q, with C B_q from the shapes' own products
    v3 B_f = f, B_m = v3_add(m, v3_cross(W, f));
    B_f.y -= y->ct0 * f.y + y->ct1 * e->mu.z;
    B_f.z -= z->ct0 * f.z - z->ct1 * e->mu.y;
    B_m.x -= shapes->uy * f.z - shapes->uy1 * e->mu.y - shapes->uz * f.y - shapes->uz1 * e->mu.z +
             shapes->cp_tau * e->mu.x;
    B_m.y += z->c0 * f.z - z->c1 * e->mu.y;
    B_m.z -= y->c0 * f.y + y->c1 * e->mu.z;
    tube_forward(tube, B_f, B_m, e->rigid);
}

// The same with the wrench itself on the rocket.
LD_INLINE void direction_load(const launching_instant *now, const constraint_section *section,
                              const unit_wrench *unit, constraint_direction *e)
{
    e->G_f = unit->f;
    e->G_m = v3_add(unit->m, v3_cross(unit->rho, unit->f));
    rocket_solve(&now->inertia, e->G_f, e->G_m, &e->r_a, &e->r_alpha);
    direction_load_tube(now, section, unit, e);
}

// G_p^T M3^-1 G_q + B_p^T M2^-1 B_q.
LD_INLINE double direction_product(const tube_state *tube, const constraint_set *set,
                                   const constraint_products *D, const constraint_direction *p,
                                   const constraint_direction *q)
{
    bool planes_differ = tube->modal.planes_differ;
    double modal =
        p->section == q->section ? modal_product(&set->section[p->section].shapes, p, q)
        : p->section < q->section
            ? modal_cross_product(&D->cross[p->section][q->section], planes_differ, p, q)
            : modal_cross_product(&D->cross[q->section][p->section], planes_differ, q, p);
    return v3_dot(p->G_f, q->r_a) + v3_dot(p->G_m, q->r_alpha) +
           tube_product(tube, p->rigid, q->rigid) + modal;
}

// G^T r_O - B^T e_0 for the accelerations without constraint forces, given by `to`.
LD_INLINE double free_acceleration(const int lanes, const tube_system *guide,
                                   const launching_instant *now, const constraint_set *set,
                                   const constraint_direction *e, const constrained *to)
{
    const tube_force *h = &now->on_tube;
    const section_shapes *shapes = &set->section[e->section].shapes;
    const plane_shapes *y = &shapes->plane[PLANE_Y], *z = &shapes->plane[shapes->z];
    double modal = e->force.y * v4d_dot(lanes, y->b, h->y) + e->mu.z * v4d_dot(lanes, y->b1, h->y) +
                   e->force.z * v4d_dot(lanes, z->b, h->z) - e->mu.y * v4d_dot(lanes, z->b1, h->z);
    for (int j = 0; j < guide->flexible.nt; j++)
        modal += e->mu.x * shapes->tau[j] * h->t[j];
    return v3_dot(e->G_f, to->a) + v3_dot(e->G_m, to->alpha) -
           tube_product(&now->tube, e->rigid, to->rigid) - modal;
}

LD_INLINE section_bias bias_of(const tube_state *tube, const constraint_section *section)
{
    const axis_section *s = section->at;
    const section_rates *r = section->rates;
    v3 w = tube->w;
    section_bias bias;
    v3 inner = v3_add(v3_cross(w, s->P), v3_scale(2, r->u_dot));
    bias.gv = v3_axpy(v3_cross(w, inner), section->s_dot, v3_add(v3_cross(w, s->t), r->u1_dot));
    if (__builtin_expect(section->motion->shortened, 0))
        bias.gv.x += shortened_to(section->motion, s->xi).pull;
    // gamma_rot = Jl_dot Psi q_dot + w x (Jl Psi q_dot); then the convective part along s
    bias.gw = v3_add(rv_left_jacobian_derivative(s->th, r->th_dot, r->th_dot), v3_cross(w, r->w));
    v3 along =
        v3_add(m3_apply(s->Jl, r->k0_dot), rv_left_jacobian_derivative(s->th, s->k0, r->th_dot));
    bias.gw = v3_axpy(bias.gw, section->s_dot, along);
    return bias;
}

// beta and drift of a direction of a unit force, whose n turns by dn_dt in the section:
// formulation.md, section 4.
LD_INLINE void force_bias(const launching_instant *now, const constraint_section *section,
                          const unit_wrench *unit, v3 dn_dt, constraint_direction *e)
{
    v3 n = unit->f, r_T = unit->r_T, rho = unit->rho;
    const tube_state *tube = &now->tube;
    const rocket_state *rocket = &now->rocket;
    const section_bias *bias = &section->bias;
    v3 v_E = v3_add(rocket->v_O1, v3_cross(rocket->w_B, rho));
    v3 v_rel = v3_sub(v_E, v3_add(section->v_P, v3_cross(section->w_P, r_T)));
    v3 n_dot = v3_add(dn_dt, v3_cross(v3_add(tube->w, section->Om), n));
    v3 sum = v3_cross(rocket->w_B, v3_cross(rocket->w_B, rho));
    sum = v3_sub(sum, v3_add(bias->gv, v3_cross(bias->gw, r_T)));
    v3 r_T_dot = v3_axpy(v3_sub(v_E, section->v_P), -section->s_dot, section->at->t);
    sum = v3_sub(sum, v3_cross(section->w_P, r_T_dot));
    e->beta = v3_dot(n, sum) + v3_dot(n_dot, v_rel);
    e->drift = v3_dot(n, v_rel);
}

// Adds the accelerations that a force x along e makes.
LD_INLINE void constraint_apply(const constraint_direction *e, double x, constrained *to)
{
    to->a = v3_axpy(to->a, x, e->r_a);
    to->alpha = v3_axpy(to->alpha, x, e->r_alpha);
    for (int i = 0; i < 6; i++)
        to->rigid[i] -= x * e->rigid[i];
    v3 *force = &to->force[e->section], *mu = &to->mu[e->section];
    *force = v3_axpy(*force, x, e->force);
    *mu = v3_axpy(*mu, x, e->mu);
}

// No accelerations of the tube, and no forces on its sections.
LD_INLINE void constrained_begin(constrained *to)
{
    for (int i = 0; i < LD_MAX_CONSTRAINT_SECTIONS; i++)
        to->force[i] = to->mu[i] = v3_zero();
}

// Counts the set's next section in, of which all but shapes and bias is there: its number.
LD_INLINE int constraint_section_add(const int lanes, const tube_system *guide,
                                     const tube_state *tube, constraint_set *set)
{
    constraint_section *section = &set->section[set->section_count];
    shapes_load(lanes, guide, &tube->modal, section->motion, section->at, &section->shapes);
    section->bias = bias_of(tube, section);
    return set->section_count++;
}

// Empties the set.
LD_INLINE void constraints_begin(constraint_set *set)
{
    set->section_count = set->count = 0;
    set->slot_row = set->lock_row = -1;
    for (int i = 0; i < LD_MAX_ADAPTORS; i++)
        set->adaptor_row[i] = -1;
    set->sliding = false;
    set->friction = set->v_tau = 0;
}

// The rocket's section, the first one of the set.
LD_INLINE void rocket_section_add(const int lanes, const tube_system *guide,
                                  const launching_instant *now, constraint_set *set)
{
    const rocket_state *rocket = &now->rocket;
    constraint_section *section = &set->section[0];
    section->motion = &rocket->motion;
    section->at = &rocket->at;
    section->rates = &rocket->rates;
    section->s_dot = rocket->s_dot;
    section->v_P = rocket->v_P;
    section->w_P = rocket->w_P;
    section->Om = rocket->Om;
    constraint_section_add(lanes, guide, &now->tube, set);
}

// The next direction, of a unit force that turns by dn_dt in the section; what it does counts as
// that work.
LD_INLINE constraint_direction *constrain_force(const launching_instant *now, int section,
                                                const unit_wrench *unit, v3 dn_dt, int work,
                                                constraint_set *set)
{
    constraint_direction *e = &set->e[set->count++];
    e->section = section;
    e->work = work;
    direction_load(now, &set->section[section], unit, e);
    force_bias(now, &set->section[section], unit, dn_dt, e);
    return e;
}

// All D_ij of the set in the fast layout.
LD_INLINE void constraint_products_load(const int lanes, const tube_system *guide,
                                        const tube_state *tube, const constraint_set *set,
                                        constraint_products *D)
{
    for (int i = 0; i < set->section_count; i++)
        for (int j = i + 1; j < set->section_count; j++)
            shape_products_load(lanes, guide, &set->section[i].shapes, &set->section[j].shapes,
                                &D->cross[i][j]);
    for (int i = 0; i < set->count; i++) {
        for (int j = i; j < set->count; j++)
            D->D[i][j] = direction_product(tube, set, D, &set->e[i], &set->e[j]);
        if (set->sliding)
            D->Dt[i] = direction_product(tube, set, D, &set->e[i], &set->tangent);
    }
}

// Constraint forces for r = what the free accelerations miss: D x = r, and with friction -rub x_k
// of the slot (row k) along the tangent (D - rub Dt e_k^T) x = r, by D^-1 r + rub x_k D^-1 Dt.
// False where the knob jams: mu |(D^-1 Dt)_k| >= 1, no sign of x_k is consistent, or both are.
LD_INLINE bool constraints_solve(constraint_products *D, const double r[], constraint_set *set)
{
    double *x = set->x;
    int n = set->count, k = set->slot_row;
    ldl_factor(n, LD_MAX_CONSTRAINTS, D->D[0]);
    for (int i = 0; i < n; i++)
        x[i] = r[i];
    ldl_solve(n, LD_MAX_CONSTRAINTS, D->D[0], x);
    if (!set->sliding)
        return true;
    ldl_solve(n, LD_MAX_CONSTRAINTS, D->D[0], D->Dt);
    if (!(set->mu * fabs(D->Dt[k]) < 1))
        return false;
    double rub = x[k] < 0 ? -set->rub : set->rub;
    set->friction = -rub * (x[k] / (1 - rub * D->Dt[k]));
    for (int i = 0; i < n; i++)
        x[i] -= set->friction * D->Dt[i];
    return true;
}

// Records what the constraints put on the sections of the tube: the opposite of what acts on the
// rocket.
LD_INLINE void constraints_record(const launching_instant *now, const constraint_set *set)
{
    if (!now->on_tube.record || !set->count)
        return;
    for (int i = 0; i < set->count + set->sliding; i++) {
        const constraint_direction *e = i < set->count ? &set->e[i] : &set->tangent;
        double x = i < set->count ? set->x[i] : set->friction;
        const axis_section *at = set->section[e->section].at;
        v3 m = v3_add(e->moment, v3_cross(at->P, e->force));
        guide_forces_add(now->on_tube.record, at->x, v3_scale(-x, e->force), v3_scale(-x, m));
    }
}

// Forces, drift and powers of what the set holds.
LD_INLINE void constraints_report(const constraint_set *set, launching_output *out)
{
    int slot = set->slot_row, lock = set->lock_row;
    out->N = out->lock_force = out->slot_friction = out->drift = 0;
    if (slot >= 0) {
        out->N = set->x[slot];
        out->drift = set->e[slot].drift;
        out->slot_friction = set->friction;
        out->power[POWER_SLOT_FRICTION] = set->friction * set->v_tau;
    }
    if (lock >= 0)
        out->lock_force = -set->x[lock];
    for (int i = 0; i < set->count; i++)
        out->power[set->e[i].work] += set->x[i] * set->e[i].drift;
}

#endif
