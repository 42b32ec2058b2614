// Foreshortening of the launching tube (tube/shortening.h), where it has geometric stiffness: how
// far bending draws its sections along x, and what a force along x does to the bending modes. Out
// of line: most tubes have none.
#ifndef LD_ELEMENTS_SHORTENED_H
#define LD_ELEMENTS_SHORTENED_H

#include "elements/instant.h"
#include "elements/tube/shortening.h"

LD_INLINE double shortened_dot(int n, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

// That of the element's x0.
LD_OUTLINE void element_shorten(const tube_system *self, const modal_state *q, int index,
                                element_motion *motion)
{
    const flexible_tube *tube = &self->flexible;
    const double *bent[2] = {q->y, q->z}, *rate[2] = {q->y_dot, q->z_dot};
    int nb = tube->nb;
    motion->before = (foreshortening){0};
    for (int plane = PLANE_Y; plane <= PLANE_Z; plane++) {
        const double *H = shortening_before(tube->shortening, index, plane);
        double drawn[LD_NB], of_rate[LD_NB];
        shortening_apply(tube, H, bent[plane], drawn);
        shortening_apply(tube, H, rate[plane], of_rate);
        motion->before.shift -= 0.5 * shortened_dot(nb, bent[plane], drawn);
        motion->before.rate -= shortened_dot(nb, rate[plane], drawn);
        motion->before.pull -= shortened_dot(nb, rate[plane], of_rate);
    }
}

// That at xi of the element.
LD_OUTLINE foreshortening shortened_to(const element_motion *motion, double xi)
{
    const double *bent[2] = {motion->y, motion->z}, *rate[2] = {motion->y_dot, motion->z_dot};
    foreshortening at = motion->before;
    for (int plane = PLANE_Y; plane <= PLANE_Z; plane++) {
        double by_bent[4], by_rate[4];
        shortening_weights(bent[plane], xi, by_bent);
        shortening_weights(rate[plane], xi, by_rate);
        at.shift -= 0.5 * shortened_dot(4, by_bent, bent[plane]);
        at.rate -= shortened_dot(4, by_bent, rate[plane]);
        at.pull -= shortened_dot(4, by_rate, rate[plane]);
    }
    return at;
}

LD_INLINE void section_shorten(const element_motion *motion, axis_section *s)
{
    double y1 = s->t.y, z1 = s->t.z;
    s->P.x += shortened_to(motion, s->xi).shift;
    s->root.x = s->P.x;
    s->t.x -= 0.5 * (y1 * y1 + z1 * z1);
}

LD_INLINE void section_rates_shorten(const element_motion *motion, const axis_section *s,
                                     section_rates *r)
{
    r->u_dot.x += shortened_to(motion, s->xi).rate;
    r->u1_dot.x -= poly1(motion->y, s->xi) * r->u1_dot.y + poly1(motion->z, s->xi) * r->u1_dot.z;
}

// Part x of the axis' second derivative.
LD_INLINE double shortened_bend(const element_motion *motion, double xi)
{
    return -poly1(motion->y, xi) * poly2(motion->y, xi) -
           poly1(motion->z, xi) * poly2(motion->z, xi);
}

// What a force f along x at station x does to the bending modes: -f H q.
LD_OUTLINE void bend_by_axial_force(const tube_system *self, double x, double f, tube_force *h)
{
    const double *bent[2] = {h->bent->y, h->bent->z};
    double *on[2] = {h->y, h->z}, drawn[LD_NB];
    for (int plane = PLANE_Y; plane <= PLANE_Z; plane++) {
        shortening_at(&self->flexible, plane, x, bent[plane], drawn);
        for (int i = 0; i < self->flexible.nb; i++)
            on[plane][i] -= f * drawn[i];
    }
}

#endif
