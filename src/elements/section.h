// Sections of the flexible tube in the fast layout: everything at a moving station from one read of
// the element's shapes, and a force on a section (formulation.md, sections 1 and 5).
#ifndef LD_ELEMENTS_SECTION_H
#define LD_ELEMENTS_SECTION_H

#include "elements/sheared.h"
#include "elements/shortened.h"

// The deflection along z by shapes of its own.
LD_OUTLINE void element_load_z(const tube_system *self, const modal_state *q,
                               element_motion *motion)
{
    const packed_shapes *shapes = &motion->element->plane[PLANE_Z];
    v2d sum[4] = {{0}};
    for (int j = 0; j < self->flexible.nb; j++) {
        const v2d *shape = v2d_lanes_of(shapes->by_mode[j]);
        for (int i = 0; i < 2; i++) {
            sum[i] += shape[i] * v2d_all(q->z[j]);
            sum[2 + i] += shape[i] * v2d_all(q->z_dot[j]);
        }
    }
    memcpy(motion->z, sum, 2 * sizeof *sum);
    memcpy(motion->z_dot, sum + 2, 2 * sizeof *sum);
}

LD_INLINE void element_load(const tube_system *self, const modal_state *q, int index,
                            element_motion *motion)
{
    const packed_element *element = &self->packed[index];
    v4d y = v4d_all(0), z = y, y_dot = y, z_dot = y;
    for (int j = 0; j < self->flexible.nb; j++) {
        v4d shape = *v4d_lanes_of(element->plane[PLANE_Y].by_mode[j]);
        y += shape * v4d_all(q->y[j]);
        z += shape * v4d_all(q->z[j]);
        y_dot += shape * v4d_all(q->y_dot[j]);
        z_dot += shape * v4d_all(q->z_dot[j]);
    }
    double t0 = 0, t1 = 0, d0 = 0, d1 = 0;
    for (int j = 0; j < self->flexible.nt; j++) {
        t0 += element->tau[j][0] * q->t[j];
        t1 += element->tau[j][1] * q->t[j];
        d0 += element->tau[j][0] * q->t_dot[j];
        d1 += element->tau[j][1] * q->t_dot[j];
    }
    double a0 = 0, a1 = 0, e0 = 0, e1 = 0;
    for (int j = 0; j < self->flexible.na; j++) {
        a0 += element->a[j][0] * q->a[j];
        a1 += element->a[j][1] * q->a[j];
        e0 += element->a[j][0] * q->a_dot[j];
        e1 += element->a[j][1] * q->a_dot[j];
    }
    motion->element = element;
    *v4d_lanes(motion->y) = y;
    *v4d_lanes(motion->z) = z;
    *v4d_lanes(motion->y_dot) = y_dot;
    *v4d_lanes(motion->z_dot) = z_dot;
    if (__builtin_expect(q->planes_differ, 0))
        element_load_z(self, q, motion);
    motion->t[0] = t0, motion->t[1] = t1;
    motion->t_dot[0] = d0, motion->t_dot[1] = d1;
    motion->a[0] = a0, motion->a[1] = a1;
    motion->a_dot[0] = e0, motion->a_dot[1] = e1;
    motion->shortened = self->flexible.shortening != NULL;
    if (__builtin_expect(motion->shortened, 0))
        element_shorten(self, q, index, motion);
    motion->initial = self->initial;
    motion->sheared = self->flexible.shear != NULL;
    if (__builtin_expect(motion->sheared, 0))
        element_shear(self, q, index, motion);
}

// Adds the guide's initial shape to a section. Out of line: most guides are straight.
LD_OUTLINE void section_shape(const initial_shape *initial, double x, axis_section *s)
{
    initial_section at;
    initial_shape_at(initial, x, &at);
    s->P = s->root = v3_add(s->P, at.P);
    s->t = v3_add(s->t, at.P1);
    s->th = v3_add(s->th, at.th);
    s->k0 = v3_add(s->k0, at.th1);
}

LD_INLINE void section_load(const tube_system *self, const element_motion *motion, double x,
                            axis_section *s)
{
    double length = self->flexible.length;
    double inside = x < 0 ? 0 : x > length ? length : x;
    double xi = inside - motion->element->x0;
    s->x = x;
    s->xi = xi;
    double uy = poly0(motion->y, xi), uy1 = poly1(motion->y, xi);
    double uz = poly0(motion->z, xi), uz1 = poly1(motion->z, xi);
    s->P = s->root = v3_make(inside + (motion->a[0] + xi * motion->a[1]), uy, uz);
    s->t = v3_make(1 + motion->a[1], uy1, uz1);
    if (__builtin_expect(motion->shortened, 0))
        section_shorten(motion, s);
    s->th = v3_make(motion->t[0] + xi * motion->t[1], -uz1, uy1);
    s->k0 = v3_make(motion->t[1], -poly2(motion->z, xi), poly2(motion->y, xi));
    if (__builtin_expect(motion->sheared, 0))
        turn_less(motion->strain, &s->th);
    if (__builtin_expect(motion->initial != NULL, 0))
        section_shape(motion->initial, inside, s);
    rv_coefficients k = rv_coefficients_of(v3_norm2(s->th));
    double t2 = v3_norm2(s->th);
    m3 outer = m3_outer(s->th, s->th), skew = m3_skew(s->th);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            s->A.a[i][j] = k.b * outer.a[i][j] + k.a * skew.a[i][j];
            s->Jl.a[i][j] = k.c * outer.a[i][j] + k.b * skew.a[i][j];
        }
    for (int i = 0; i < 3; i++) {
        s->A.a[i][i] += 1 - k.b * t2;
        s->Jl.a[i][i] += 1 - k.c * t2;
    }
    s->beyond = x - inside;
    if (__builtin_expect(s->beyond != 0, 0)) {
        v3 axis = m3_column(s->A, 0);
        s->P = v3_axpy(s->P, s->beyond, axis);
        s->t = axis;
        s->k0 = v3_zero();
    }
}

LD_INLINE void section_rates_load(const element_motion *motion, const axis_section *s,
                                  section_rates *r)
{
    double xi = s->xi;
    double uy1 = poly1(motion->y_dot, xi), uz1 = poly1(motion->z_dot, xi);
    r->u_dot = v3_make(motion->a_dot[0] + xi * motion->a_dot[1], poly0(motion->y_dot, xi),
                       poly0(motion->z_dot, xi));
    r->u1_dot = v3_make(motion->a_dot[1], uy1, uz1);
    r->th_dot = v3_make(motion->t_dot[0] + xi * motion->t_dot[1], -uz1, uy1);
    r->k0_dot = v3_make(motion->t_dot[1], -poly2(motion->z_dot, xi), poly2(motion->y_dot, xi));
    if (__builtin_expect(motion->sheared, 0))
        turn_less(motion->strain_dot, &r->th_dot);
    r->w = m3_apply(s->Jl, r->th_dot);
    if (__builtin_expect(motion->shortened, 0))
        section_rates_shorten(motion, s, r);
    if (__builtin_expect(s->beyond != 0, 0)) {
        v3 axis = m3_column(s->A, 0);
        v3 axis_dot = v3_cross(r->w, axis);
        r->u_dot = v3_axpy(r->u_dot, s->beyond, axis_dot);
        r->u1_dot = axis_dot;
        r->k0_dot = v3_zero();
    }
}

// A point of the tube's own axis, without an initial shape; its velocity, in R, and the rate w at
// which its section turns.
LD_OUTLINE v3 axis_point_load(const tube_system *self, const tube_state *tube, double x,
                              axis_section *at, v3 *w)
{
    element_motion motion;
    section_rates rates;
    at->index = flexible_tube_find(&self->flexible, x);
    element_load(self, &tube->modal, at->index, &motion);
    motion.initial = NULL;
    section_load(self, &motion, x, at);
    section_rates_load(&motion, at, &rates);
    *w = v3_add(tube->w, rates.w);
    return v3_add(v3_add(tube->v, v3_cross(tube->w, at->P)), rates.u_dot);
}

// e_x . A_RP(x)^T (C - P(x)): how far C lies in front of the section at x.
LD_INLINE double section_gap(const tube_system *self, const element_motion *motion, double x, v3 C)
{
    double length = self->flexible.length;
    double inside = x < 0 ? 0 : x > length ? length : x, xi = inside - motion->element->x0;
    v3 th = v3_make(motion->t[0] + xi * motion->t[1], -poly1(motion->z, xi), poly1(motion->y, xi));
    if (__builtin_expect(motion->sheared, 0))
        turn_less(motion->strain, &th);
    initial_section initial = {0};
    if (__builtin_expect(motion->initial != NULL, 0)) {
        initial_shape_at(motion->initial, inside, &initial);
        th = v3_add(th, initial.th);
    }
    rv_coefficients k = rv_coefficients_of(v3_norm2(th));
    v3 axis = v3_make(1 - k.b * (th.y * th.y + th.z * th.z), k.b * th.x * th.y + k.a * th.z,
                      k.b * th.x * th.z - k.a * th.y);
    v3 P = v3_make(inside + (motion->a[0] + xi * motion->a[1]), poly0(motion->y, xi),
                   poly0(motion->z, xi));
    if (__builtin_expect(motion->shortened, 0))
        P.x += shortened_to(motion, xi).shift;
    if (__builtin_expect(motion->initial != NULL, 0))
        P = v3_add(P, initial.P);
    return v3_dot(axis, v3_sub(C, P)) - (x - inside);
}

// Station of the section whose plane holds point C (in R): e_x . A_RP(s)^T (C - P(s)) = 0, from
// `guess`. On return `motion` and `s` belong to the station.
LD_INLINE void section_foot(const tube_system *self, const modal_state *q, v3 C, double guess,
                            element_motion *motion, axis_section *s)
{
    double x = guess;
    s->index = flexible_tube_find(&self->flexible, x);
    element_load(self, q, s->index, motion);
    // by the secant; the first slope is -1, wrong by curvature times offset (1e-6 in a launch)
    double step = section_gap(self, motion, x, C), gap = step;
    for (int iteration = 0; iteration < 20 && fabs(step) > 1e-14; iteration++) {
        double before = gap;
        x += step;
        if (__builtin_expect(x < motion->element->x0 || x >= motion->element->x1, 0)) {
            s->index = flexible_tube_find(&self->flexible, x);
            element_load(self, q, s->index, motion);
        }
        gap = section_gap(self, motion, x, C);
        step *= gap / (before - gap);
    }
    section_load(self, motion, x, s);
}

// Adds to the forces on a plane's modes what weights of the powers of xi put on them.
LD_INLINE void add_by_power(const int lanes, const packed_shapes *shapes, const double weight[4],
                            double *h)
{
    const v4d *p0 = v4d_lanes_of(shapes->by_power[0]), *p1 = v4d_lanes_of(shapes->by_power[1]);
    const v4d *p2 = v4d_lanes_of(shapes->by_power[2]), *p3 = v4d_lanes_of(shapes->by_power[3]);
    for (int i = 0; i < lanes; i++)
        v4d_lanes(h)[i] += v4d_all(weight[0]) * p0[i] + v4d_all(weight[1]) * p1[i] +
                           v4d_all(weight[2]) * p2[i] + v4d_all(weight[3]) * p3[i];
}

// Adds force and moment about R's origin on the tube's section s, of which the modes feel the
// moment about the section's root, mu = Jl^T m_root.
LD_INLINE void apply_generalised(const int lanes, const tube_system *self, const axis_section *s,
                                 guide_wrench on, v3 mu, tube_force *h)
{
    const packed_element *element = &self->packed[s->index];
    v3 f = on.f;
    h->f = v3_add(h->f, f);
    h->m = v3_add(h->m, on.m);
    if (__builtin_expect(h->record != NULL, 0))
        guide_forces_add(h->record, s->x, f, on.m);
    if (__builtin_expect(h->bent != NULL, 0))
        bend_by_axial_force(self, s->x, f.x, h);
    if (__builtin_expect(self->flexible.shear != NULL, 0))
        shear_by_moment(self, s->index, mu, h);
    double xi = s->xi, x2 = xi * xi, x3 = x2 * xi;
    // weights of the powers of xi: b and b' against force and moment
    double y[4] = {f.y, f.y * xi + mu.z, f.y * x2 + mu.z * 2 * xi, f.y * x3 + mu.z * 3 * x2};
    double z[4] = {f.z, f.z * xi - mu.y, f.z * x2 - mu.y * 2 * xi, f.z * x3 - mu.y * 3 * x2};
    add_by_power(lanes, &element->plane[PLANE_Y], y, h->y);
    add_by_power(lanes, &element->plane[self->z], z, h->z);
    for (int j = 0; j < self->flexible.nt; j++)
        h->t[j] += mu.x * (element->tau[j][0] + xi * element->tau[j][1]);
    for (int j = 0; j < self->flexible.na; j++)
        h->a[j] += f.x * (element->a[j][0] + xi * element->a[j][1]);
}

// Adds force f at point W (in R) of the tube's section s.
LD_INLINE void apply_at_section(const int lanes, const tube_system *self, const axis_section *s,
                                v3 W, v3 f, tube_force *h)
{
    v3 mu = m3_apply_transposed(s->Jl, v3_cross(v3_sub(W, s->root), f));
    apply_generalised(lanes, self, s, (guide_wrench){f, v3_cross(W, f)}, mu, h);
}

// Adds force f on the tube's section s with moment m about its point P (in R).
LD_INLINE void apply_wrench_at_section(const int lanes, const tube_system *self,
                                       const axis_section *s, v3 f, v3 m, tube_force *h)
{
    v3 mu = m3_apply_transposed(s->Jl, v3_add(m, v3_cross(v3_sub(s->P, s->root), f)));
    apply_generalised(lanes, self, s, (guide_wrench){f, v3_add(m, v3_cross(s->P, f))}, mu, h);
}

// A plane's shapes at a section for every mode, and their products.
LD_INLINE void plane_shapes_load(const int lanes, const packed_shapes *from, double xi,
                                 plane_shapes *shapes)
{
    LANES_NOT_EMPTY(lanes);
    v4d x = v4d_all(xi), x2 = v4d_all(2 * xi), x3 = v4d_all(3 * xi);
    const v4d *p0 = v4d_lanes_of(from->by_power[0]), *p1 = v4d_lanes_of(from->by_power[1]);
    const v4d *p2 = v4d_lanes_of(from->by_power[2]), *p3 = v4d_lanes_of(from->by_power[3]);
    v4d *b = v4d_lanes(shapes->b), *b1 = v4d_lanes(shapes->b1);
    for (int i = 0; i < lanes; i++) {
        b[i] = p0[i] + x * (p1[i] + x * (p2[i] + x * p3[i]));
        b1[i] = p1[i] + x2 * p2[i] + x3 * (x * p3[i]);
    }
    shapes->bb = v4d_dot(lanes, shapes->b, shapes->b);
    shapes->bb1 = v4d_dot(lanes, shapes->b, shapes->b1);
    shapes->b1b1 = v4d_dot(lanes, shapes->b1, shapes->b1);
    shapes->ct0 = poly0(from->ctb, xi);
    shapes->ct1 = poly1(from->ctb, xi);
    shapes->c0 = poly0(from->cb, xi);
    shapes->c1 = poly1(from->cb, xi);
}

// Those of z, where they are its own, and how a plane's deflection meets the shapes of the other.
LD_OUTLINE void shapes_load_two_planes(const int lanes, const packed_element *from,
                                       const modal_state *q, double xi, section_shapes *shapes)
{
    const plane_shapes *of_y = &shapes->plane[PLANE_Y], *of_z = &shapes->plane[PLANE_Z];
    plane_shapes_load(lanes, &from->plane[PLANE_Z], xi, &shapes->plane[PLANE_Z]);
    shapes->uy = v4d_dot(lanes, q->y_on_z, of_z->b);
    shapes->uy1 = v4d_dot(lanes, q->y_on_z, of_z->b1);
    shapes->uz = v4d_dot(lanes, q->z_on_y, of_y->b);
    shapes->uz1 = v4d_dot(lanes, q->z_on_y, of_y->b1);
}

// Shapes at a section for every mode, and their products.
LD_INLINE void shapes_load(const int lanes, const tube_system *self, const modal_state *q,
                           const element_motion *motion, const axis_section *s,
                           section_shapes *shapes)
{
    const packed_element *element = &self->packed[s->index];
    shapes->z = self->z;
    plane_shapes_load(lanes, &element->plane[PLANE_Y], s->xi, &shapes->plane[PLANE_Y]);
    shapes->uy = poly0(motion->y, s->xi);
    shapes->uy1 = poly1(motion->y, s->xi);
    shapes->uz = poly0(motion->z, s->xi);
    shapes->uz1 = poly1(motion->z, s->xi);
    if (__builtin_expect(q->planes_differ, 0))
        shapes_load_two_planes(lanes, element, q, s->xi, shapes);
    shapes->tt = shapes->cp_tau = 0;
    for (int j = 0; j < self->flexible.nt; j++) {
        shapes->tau[j] = element->tau[j][0] + s->xi * element->tau[j][1];
        shapes->tt += shapes->tau[j] * shapes->tau[j];
        shapes->cp_tau += self->flexible.cp[j] * shapes->tau[j];
    }
}

#endif
