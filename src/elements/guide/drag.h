// Drag of the guide: a force against sliding, given as such (model.md, section 5).
//
// D over the travel s' = s - start_at, to which another over the speed |v| is added, is that of all
// n adaptors; until it leaves the guide each takes D/n. On the rocket at W of the adaptor's
// section, the opposite on the section at the same point, with v = e_x . v_rel there:  -D/n
// v/sqrt(v^2 + v_eps^2) e_x.  W is the adaptor's centre, on surfaces the middle of their points.
// None while a lock holds.
#ifndef LD_ELEMENTS_DRAG_H
#define LD_ELEMENTS_DRAG_H

#include "elements/guide/shoe.h"
#include "elements/guide/slot.h"

typedef struct drag_system {
    const ld_contact *given; // NULL: there is none
    double start;            // [m] s at which the travel is 0
    bool on_surfaces;
    double y, z; // [m] W from the elastic axis, on surfaces
} drag_system;

// The share of adaptor i.
LD_INLINE void drag_adaptor(const int lanes, const drag_system *self, const adaptor_set *adaptors,
                            const tube_system *guide, int i, launching_instant *now)
{
    const rocket_state *rocket = &now->rocket;
    const ld_contact *given = self->given;
    double slope, force = 0;
    if (given->drag.rows > 0)
        force = table_linear_at(&given->drag, rocket->s - self->start, &slope);
    adaptor_state adaptor;
    adaptor_load(adaptors, guide, &now->tube, rocket, i, &adaptor);
    adaptor_rates(&now->tube, rocket, &adaptor);
    const axis_section *foot = adaptor.foot;
    v3 axis = m3_column(foot->A, 0), from_foot = adaptor.offset;
    if (self->on_surfaces)
        from_foot = m3_apply(foot->A, v3_make(0, self->y, self->z));
    v3 W = v3_add(foot->P, from_foot);
    v3 v_W = v3_add(rocket->v_O1, v3_cross(rocket->w_B, v3_sub(W, rocket->p1)));
    v3 v_rel = v3_sub(v_W, adaptor_wall_velocity(&now->tube, &adaptor, W, from_foot));
    double v = v3_dot(axis, v_rel), v_eps = adaptors->law.v_eps;
    if (given->drag_over_speed.rows > 0)
        force += table_linear_at(&given->drag_over_speed, fabs(v), &slope);
    force *= given->drag_scale / adaptors->count;
    double drag = force * v / sqrt(v * v + v_eps * v_eps);
    v3 on_rocket = v3_scale(-drag, axis);
    now->out->power[POWER_CONTACT_FRICTION] -= drag * v;
    now->f = v3_add(now->f, on_rocket);
    now->m = v3_add(now->m, v3_cross(v3_sub(W, rocket->p1), on_rocket));
    apply_at_section(lanes, guide, foot, W, v3_neg(on_rocket), &now->on_tube);
}

LD_INLINE void drag_add(const int lanes, const drag_system *self, const adaptor_set *adaptors,
                        const tube_system *guide, launching_instant *now)
{
    if (now->phase->locked || now->phase->frictionless)
        return;
    for (int i = 0; i < adaptors->count; i++)
        if (!now->phase->passed[i])
            drag_adaptor(lanes, self, adaptors, guide, i, now);
}

LD_INLINE void drag_build(const ld_rocket *rocket, const surface_set *surfaces, drag_system *self)
{
    const ld_contact *contact = &rocket->contact;
    bool any = contact->drag.rows > 0 || contact->drag_over_speed.rows > 0;
    *self = (drag_system){.given = any ? contact : NULL,
                          .start = rocket->start_at,
                          .on_surfaces = surfaces->count > 0,
                          .y = surfaces->line_y,
                          .z = surfaces->line_z};
    for (int k = 0; k < surfaces->count; k++) {
        self->y += surfaces->surface[k].y / surfaces->count;
        self->z += surfaces->surface[k].z / surfaces->count;
    }
}

#endif
