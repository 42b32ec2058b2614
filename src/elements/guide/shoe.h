// Shoes: adaptors that slide on the surfaces of a guide in place of a bore (model.md, section 5).
//
// Foot s_i of C_i as in a bore. Of surface k, at (y_k, z_k) from the guide line o, with normal n:
//   delta = [A' (X - P)]_(y,z) - (o + (y_k, z_k)),   p = n . delta - gap
// where X is the rocket's point (l_i, y_k, z_k); on a round one delta = [A' (C_i - P)]_(y,z) - o.
// The normal force is the generalised one, -F dp/d(speeds), the foot's motion included: without
// friction nothing is lost. With kappa = n . (t + Jl k0 x (X - P)) and a = e_x/(e_x . (t + Jl k0 x
// (C - P))), which makes s_i_dot = a . v_rel(C), that is -F n at X and F kappa a at C, the opposite
// on section s_i. Friction acts at W = P + A (0, o + (y_k, z_k)), on a round one + delta's part
// along it.
#ifndef LD_ELEMENTS_SHOE_H
#define LD_ELEMENTS_SHOE_H

#include "elements/guide/adaptor.h"
#include "math/functions.h"
#include "model/guide.h"

typedef struct guide_surface {
    double y, z;   // [m] from the guide line
    double ny, nz; // normal, from shoe to surface
    double gap;    // [m] to a shoe of no clearance of its own
    bool flat;
} guide_surface;

typedef struct surface_set {
    int count;             // 0: a bore
    bool flat;             // one of them is
    double line_y, line_z; // [m] guide line, from the elastic axis
    guide_surface surface[LD_MAX_SURFACES];
    double wider[LD_MAX_ADAPTORS]; // [m] added to each gap at a shoe
} surface_set;

// One shoe: its foot, and where its points stand in the section's frame.
typedef struct shoe_state {
    adaptor_state at;
    double yy, yz, zy, zz; // e_y, e_z of the section times those of the rocket
} shoe_state;

// A shoe that touches: how it moves against the section at its foot, and what its surfaces do.
typedef struct shoe_touch {
    const shoe_state *shoe;
    v3 v_C;      // [m/s] of its centre, inertial
    v3 v_P, w_P; // of the section's material, inertial
    v3 twist;    // Jl k0
    v3 a;        // s_i_dot = a . v_rel(C)
    double s_dot;
    v3 f, m; // force on the rocket, and moment about the foot
} shoe_touch;

LD_INLINE void shoe_load(const adaptor_set *adaptors, const tube_system *guide,
                         const tube_state *tube, const rocket_state *rocket, int i,
                         shoe_state *shoe)
{
    adaptor_load(adaptors, guide, tube, rocket, i, &shoe->at);
    const m3 *A = &shoe->at.foot->A;
    v3 y = m3_column(rocket->A_RB, 1), z = m3_column(rocket->A_RB, 2);
    shoe->yy = v3_dot(m3_column(*A, 1), y);
    shoe->yz = v3_dot(m3_column(*A, 1), z);
    shoe->zy = v3_dot(m3_column(*A, 2), y);
    shoe->zz = v3_dot(m3_column(*A, 2), z);
}

// delta of a surface, in the section's y and z.
LD_INLINE void surface_offset(const surface_set *self, const guide_surface *surface,
                              const shoe_state *shoe, double *y, double *z)
{
    *y = shoe->at.y - self->line_y;
    *z = shoe->at.z - self->line_z;
    if (!surface->flat)
        return;
    *y += shoe->yy * surface->y + shoe->yz * surface->z - surface->y;
    *z += shoe->zy * surface->y + shoe->zz * surface->z - surface->z;
}

LD_INLINE double surface_penetration(const surface_set *self, const guide_surface *surface,
                                     const shoe_state *shoe)
{
    double y, z;
    surface_offset(self, surface, shoe, &y, &z);
    return surface->ny * y + surface->nz * z - (surface->gap + self->wider[shoe->at.number]);
}

// How the shoe moves; its surfaces do nothing so far.
LD_INLINE shoe_touch shoe_touch_of(const tube_state *tube, const rocket_state *rocket,
                                   shoe_state *shoe)
{
    shoe_touch touch;
    adaptor_state *at = &shoe->at;
    const axis_section *foot = at->foot;
    if (at->number > 0)
        section_rates_load(&at->own_motion, foot, &at->own_rates);
    at->rates = at->number > 0 ? &at->own_rates : &rocket->rates;
    touch.shoe = shoe;
    touch.v_C = v3_add(rocket->v_O1, v3_cross(rocket->w_B, at->arm));
    touch.v_P = v3_add(v3_add(tube->v, v3_cross(tube->w, foot->P)), at->rates->u_dot);
    touch.w_P = v3_add(tube->w, at->rates->w);
    touch.twist = m3_apply(foot->Jl, foot->k0);
    v3 axis = m3_column(foot->A, 0);
    v3 column = v3_add(foot->t, v3_cross(touch.twist, at->offset));
    touch.a = v3_scale(1 / v3_dot(axis, column), axis);
    v3 slip = v3_sub(touch.v_C, v3_add(touch.v_P, v3_cross(touch.w_P, at->offset)));
    touch.s_dot = v3_dot(touch.a, slip);
    touch.f = touch.m = v3_zero();
    return touch;
}

// A surface at an instant, in R: its normal, the rocket's point X that counts, p_dot and kappa.
typedef struct surface_contact {
    const guide_surface *surface;
    v3 n, arm, from_foot; // from C to X, from P to X
    double rate, kappa;
} surface_contact;

LD_INLINE surface_contact surface_contact_of(const guide_surface *surface,
                                             const rocket_state *rocket, const shoe_touch *touch)
{
    const axis_section *foot = touch->shoe->at.foot;
    surface_contact c;
    c.surface = surface;
    c.n = m3_apply(foot->A, v3_make(0, surface->ny, surface->nz));
    c.arm = surface->flat ? m3_apply(rocket->A_RB, v3_make(0, surface->y, surface->z)) : v3_zero();
    c.from_foot = v3_add(touch->shoe->at.offset, c.arm);
    v3 v_X = v3_add(touch->v_C, v3_cross(rocket->w_B, c.arm));
    v3 v_rel = v3_sub(v_X, v3_add(touch->v_P, v3_cross(touch->w_P, c.from_foot)));
    c.kappa = v3_dot(c.n, v3_add(foot->t, v3_cross(touch->twist, c.from_foot)));
    c.rate = v3_dot(c.n, v_rel) - c.kappa * touch->s_dot;
    return c;
}

// Friction at W against the sliding there, for a normal force; returns its power.
LD_INLINE double surface_rub(const surface_set *self, const contact_law *law, double normal,
                             const rocket_state *rocket, const surface_contact *c,
                             shoe_touch *touch)
{
    const guide_surface *surface = c->surface;
    double y, z;
    surface_offset(self, surface, touch->shoe, &y, &z);
    double across = surface->flat ? 0 : surface->ny * z - surface->nz * y; // along (-nz, ny)
    v3 from_foot = m3_apply(touch->shoe->at.foot->A,
                            v3_make(0, self->line_y + surface->y - across * surface->nz,
                                    self->line_z + surface->z + across * surface->ny));
    v3 v_W = v3_add(touch->v_C, v3_cross(rocket->w_B, v3_sub(from_foot, touch->shoe->at.offset)));
    v3 v_rel = v3_sub(v_W, v3_add(touch->v_P, v3_cross(touch->w_P, from_foot)));
    v3 v_t = v3_axpy(v_rel, -v3_dot(v_rel, c->n), c->n);
    double rub = law->mu * normal / sqrt(v3_norm2(v_t) + law->v_eps * law->v_eps);
    v3 force = v3_scale(-rub, v_t);
    touch->f = v3_add(touch->f, force);
    touch->m = v3_add(touch->m, v3_cross(from_foot, force));
    return -rub * v3_norm2(v_t);
}

// A touched surface adds to the wrench of its shoe.
LD_INLINE void surface_press(const surface_set *self, const contact_law *law, int k,
                             double penetration, shoe_touch *touch, launching_instant *now)
{
    int i = touch->shoe->at.number;
    const rocket_state *rocket = &now->rocket;
    surface_contact c = surface_contact_of(&self->surface[k], rocket, touch);
    double normal = contact_normal(law, penetration, c.rate, now->phase->surface_speed[i][k]);
    v3 push = v3_scale(-normal, c.n), along = v3_scale(normal * c.kappa, touch->a);
    v3 turning = v3_add(v3_cross(c.from_foot, push), v3_cross(touch->shoe->at.offset, along));
    touch->f = v3_add(touch->f, v3_add(push, along));
    touch->m = v3_add(touch->m, turning);
    now->out->power[POWER_CONTACT_NORMAL] -= normal * c.rate;
    now->out->adaptor[i].normal += normal;
    if (law->mu > 0 && !now->phase->frictionless)
        now->out->power[POWER_CONTACT_FRICTION] +=
            surface_rub(self, law, normal, rocket, &c, touch);
}

// What the surfaces do to the shoe: on the rocket about O1 and, opposite, on the guide.
LD_INLINE void shoe_apply(const int lanes, const surface_set *self, const tube_system *guide,
                          const shoe_touch *touch, launching_instant *now)
{
    int i = touch->shoe->at.number;
    const axis_section *foot = touch->shoe->at.foot;
    shoe_report *report = &now->out->shoe[i];
    v3 line = m3_apply(foot->A, v3_make(0, self->line_y, self->line_z));
    report->force_y = v3_dot(m3_column(foot->A, 1), touch->f);
    report->force_z = v3_dot(m3_column(foot->A, 2), touch->f);
    report->moment_x = v3_dot(m3_column(foot->A, 0), v3_sub(touch->m, v3_cross(line, touch->f)));
    now->out->adaptor[i].force = v3_norm(touch->f);
    now->f = v3_add(now->f, touch->f);
    v3 about_O1 = v3_add(touch->m, v3_cross(v3_sub(foot->P, now->rocket.p1), touch->f));
    now->m = v3_add(now->m, about_O1);
    apply_wrench_at_section(lanes, guide, foot, v3_neg(touch->f), v3_neg(touch->m), &now->on_tube);
}

LD_INLINE void shoe_add(const int lanes, const surface_set *self, const adaptor_set *adaptors,
                        const tube_system *guide, int i, launching_instant *now)
{
    shoe_state shoe;
    shoe_load(adaptors, guide, &now->tube, &now->rocket, i, &shoe);
    double *penetration = now->out->shoe[i].penetration, deepest = -INFINITY;
    for (int k = 0; k < self->count; k++) {
        penetration[k] = surface_penetration(self, &self->surface[k], &shoe);
        deepest = fmax(deepest, penetration[k]);
    }
    now->out->adaptor[i] = (adaptor_report){.s = shoe.at.foot->x,
                                            .y = shoe.at.y - self->line_y,
                                            .z = shoe.at.z - self->line_z,
                                            .penetration = deepest};
    now->out->shoe[i].force_y = now->out->shoe[i].force_z = now->out->shoe[i].moment_x = 0;
    if (deepest <= 0)
        return;
    shoe_touch touch = shoe_touch_of(&now->tube, &now->rocket, &shoe);
    for (int k = 0; k < self->count; k++)
        if (penetration[k] > 0)
            surface_press(self, &adaptors->law, k, penetration[k], &touch, now);
    shoe_apply(lanes, self, guide, &touch, now);
}

// All that have not left.
LD_INLINE void shoes_add(const int lanes, const surface_set *self, const adaptor_set *adaptors,
                         const tube_system *guide, launching_instant *now)
{
    for (int i = 0; i < adaptors->count; i++)
        if (!now->phase->passed[i])
            shoe_add(lanes, self, adaptors, guide, i, now);
}

LD_INLINE void surfaces_build(const ld_guide *guide, const ld_rocket *rocket, surface_set *self)
{
    ld_surface from[LD_MAX_SURFACES];
    *self = (surface_set){.count = guide_surfaces(guide, from), .flat = guide_is_flat(guide)};
    if (!self->count)
        return;
    self->line_y = guide->line[0];
    self->line_z = guide->line[1];
    for (int k = 0; k < self->count; k++)
        self->surface[k] = (guide_surface){.y = from[k].at[0],
                                           .z = from[k].at[1],
                                           .ny = cos(from[k].normal),
                                           .nz = sin(from[k].normal),
                                           .gap = from[k].gap,
                                           .flat = from[k].shape == LD_SURFACE_FLAT};
    for (int i = 0; i < rocket->adaptor_count; i++)
        self->wider[i] = guide_clearance(&rocket->adaptor[i]);
}

#endif
