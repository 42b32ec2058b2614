// Section kinematics of the tube in the fast layout: everything at a moving station from one read
// of the element's shapes. Private to the launching subsystem.
#ifndef LD_SYSTEMS_LAUNCHING_KINEMATICS_H
#define LD_SYSTEMS_LAUNCHING_KINEMATICS_H

#include "math/rotation_vector.h"
#include "systems/launching.h"

// Modal coordinates and speeds, in lanes (padded with zeros) and torsion apart.
typedef struct modal_state {
    LANE_ARRAY(y, LD_NB);
    LANE_ARRAY(z, LD_NB);
    LANE_ARRAY(y_dot, LD_NB);
    LANE_ARRAY(z_dot, LD_NB);
    const double *t, *t_dot; // torsion
    const double *a, *a_dot; // axial
} modal_state;

// The deflection of one element as polynomials in xi.
typedef struct element_motion {
    const packed_element *element;
    LANE_ARRAY(y, 4); // coefficients of xi^0..3
    LANE_ARRAY(z, 4);
    LANE_ARRAY(y_dot, 4);
    LANE_ARRAY(z_dot, 4);
    double t[2], t_dot[2]; // torsion: value at x0, slope
    double a[2], a_dot[2]; // stretch, likewise
} element_motion;

LD_INLINE void element_load(const launching_system *self, const modal_state *q, int index,
                            element_motion *motion)
{
    const packed_element *element = &self->packed[index];
    v4d y = v4d_all(0), z = y, y_dot = y, z_dot = y;
    for (int j = 0; j < self->tube.nb; j++) {
        v4d shape = *v4d_lanes_of(element->by_mode[j]);
        y += shape * v4d_all(q->y[j]);
        z += shape * v4d_all(q->z[j]);
        y_dot += shape * v4d_all(q->y_dot[j]);
        z_dot += shape * v4d_all(q->z_dot[j]);
    }
    double t0 = 0, t1 = 0, d0 = 0, d1 = 0;
    for (int j = 0; j < self->tube.nt; j++) {
        t0 += element->tau[j][0] * q->t[j];
        t1 += element->tau[j][1] * q->t[j];
        d0 += element->tau[j][0] * q->t_dot[j];
        d1 += element->tau[j][1] * q->t_dot[j];
    }
    double a0 = 0, a1 = 0, e0 = 0, e1 = 0;
    for (int j = 0; j < self->tube.na; j++) {
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
    motion->t[0] = t0, motion->t[1] = t1;
    motion->t_dot[0] = d0, motion->t_dot[1] = d1;
    motion->a[0] = a0, motion->a[1] = a1;
    motion->a_dot[0] = e0, motion->a_dot[1] = e1;
}

LD_INLINE double poly0(const double *c, double x)
{
    return c[0] + x * (c[1] + x * (c[2] + x * c[3]));
}
LD_INLINE double poly1(const double *c, double x)
{
    return c[1] + x * (2 * c[2] + x * (3 * c[3]));
}
LD_INLINE double poly2(const double *c, double x)
{
    return 2 * c[2] + 6 * c[3] * x;
}

// Section at station x (formulation.md, sections 1 and 3); all vectors in R. Beyond the ends the
// axis goes on straight (model.md, section 3): forces then act through the end section at `root`.
typedef struct section {
    int index;     // element
    double x;      // station
    double beyond; // x less the end's station, outside the tube
    double xi;     // of the shapes, from the element's x0
    v3 P;          // point of the axis
    v3 root;       // axis point of the section that carries forces (P itself inside the tube)
    v3 t;          // dP/dx
    v3 th;         // rotation vector
    v3 k0;         // d th/dx
    m3 A;          // A_RP
    m3 Jl;         // left Jacobian
} section;

LD_INLINE void section_load(const launching_system *self, const element_motion *motion, double x,
                            section *s)
{
    double length = self->tube.length;
    double inside = x < 0 ? 0 : x > length ? length : x;
    double xi = inside - motion->element->x0;
    s->x = x;
    s->xi = xi;
    double uy = poly0(motion->y, xi), uy1 = poly1(motion->y, xi);
    double uz = poly0(motion->z, xi), uz1 = poly1(motion->z, xi);
    s->P = s->root = v3_make(inside + (motion->a[0] + xi * motion->a[1]), uy, uz);
    s->t = v3_make(1 + motion->a[1], uy1, uz1);
    s->th = v3_make(motion->t[0] + xi * motion->t[1], -uz1, uy1);
    s->k0 = v3_make(motion->t[1], -poly2(motion->z, xi), poly2(motion->y, xi));
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

// Speeds of the section's material relative to R, in R.
typedef struct section_rates {
    v3 u_dot;  // Phi q_dot
    v3 u1_dot; // Phi' q_dot
    v3 th_dot; // Psi q_dot
    v3 k0_dot; // Psi' q_dot
    v3 w;      // Jl Psi q_dot
} section_rates;

LD_INLINE void section_rates_load(const element_motion *motion, const section *s, section_rates *r)
{
    double xi = s->xi;
    double uy1 = poly1(motion->y_dot, xi), uz1 = poly1(motion->z_dot, xi);
    r->u_dot = v3_make(motion->a_dot[0] + xi * motion->a_dot[1], poly0(motion->y_dot, xi),
                       poly0(motion->z_dot, xi));
    r->u1_dot = v3_make(motion->a_dot[1], uy1, uz1);
    r->th_dot = v3_make(motion->t_dot[0] + xi * motion->t_dot[1], -uz1, uy1);
    r->k0_dot = v3_make(motion->t_dot[1], -poly2(motion->z_dot, xi), poly2(motion->y_dot, xi));
    r->w = m3_apply(s->Jl, r->th_dot);
    if (__builtin_expect(s->beyond != 0, 0)) {
        v3 axis = m3_column(s->A, 0);
        v3 axis_dot = v3_cross(r->w, axis);
        r->u_dot = v3_axpy(r->u_dot, s->beyond, axis_dot);
        r->u1_dot = axis_dot;
        r->k0_dot = v3_zero();
    }
}

// e_x . A_RP(x)^T (C - P(x)): how far C lies in front of the section at x.
LD_INLINE double section_gap(const launching_system *self, const element_motion *motion, double x,
                             v3 C)
{
    double length = self->tube.length;
    double inside = x < 0 ? 0 : x > length ? length : x, xi = inside - motion->element->x0;
    v3 th = v3_make(motion->t[0] + xi * motion->t[1], -poly1(motion->z, xi), poly1(motion->y, xi));
    rv_coefficients k = rv_coefficients_of(v3_norm2(th));
    v3 axis = v3_make(1 - k.b * (th.y * th.y + th.z * th.z), k.b * th.x * th.y + k.a * th.z,
                      k.b * th.x * th.z - k.a * th.y);
    v3 P = v3_make(inside + (motion->a[0] + xi * motion->a[1]), poly0(motion->y, xi),
                   poly0(motion->z, xi));
    return v3_dot(axis, v3_sub(C, P)) - (x - inside);
}

// Station of the section whose plane holds point C (in R): e_x . A_RP(s)^T (C - P(s)) = 0, from
// `guess`. On return `motion` and `s` belong to the station.
LD_INLINE void section_foot(const launching_system *self, const modal_state *q, v3 C, double guess,
                            element_motion *motion, section *s)
{
    double x = guess;
    s->index = flexible_tube_find(&self->tube, x);
    element_load(self, q, s->index, motion);
    // by the secant; the first slope is -1, wrong by curvature times offset (1e-6 in a launch)
    double step = section_gap(self, motion, x, C), gap = step;
    for (int iteration = 0; iteration < 20 && fabs(step) > 1e-14; iteration++) {
        double before = gap;
        x += step;
        if (__builtin_expect(x < motion->element->x0 || x >= motion->element->x1, 0)) {
            s->index = flexible_tube_find(&self->tube, x);
            element_load(self, q, s->index, motion);
        }
        gap = section_gap(self, motion, x, C);
        step *= gap / (before - gap);
    }
    section_load(self, motion, x, s);
}

#endif
