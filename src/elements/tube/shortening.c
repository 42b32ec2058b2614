#include "elements/tube/shortening.h"

#include <stdlib.h>
#include <string.h>

// Bending shapes of a plane at xi of an element, their slopes.
static void slopes_at(const flexible_tube *tube, const tube_element *element, int plane, double xi,
                      double *slope)
{
    const double(*b)[LD_NB] = element->b[plane];
    for (int i = 0; i < tube->nb; i++)
        slope[i] = b[1][i] + xi * (2 * b[2][i] + xi * 3 * b[3][i]);
}

// to += int b' b'^T dx from the element's x0 to xi: Gauss's rule with three points, exact for
// products of two slopes.
static void add_stretch(const flexible_tube *tube, const tube_element *element, int plane,
                        double xi, double *to)
{
    static const double at[3] = {-0.7745966692414833770, 0, 0.7745966692414833770};
    static const double weight[3] = {5.0 / 9, 8.0 / 9, 5.0 / 9};
    double slope[LD_NB];
    for (int p = 0; p < 3; p++) {
        slopes_at(tube, element, plane, 0.5 * xi * (1 + at[p]), slope);
        for (int i = 0; i < tube->nb; i++)
            for (int j = 0; j < tube->nb; j++)
                to[i * tube->nbp + j] += 0.5 * xi * weight[p] * slope[i] * slope[j];
    }
}

// What a mass dm at x of an element has of int H dm and int x H dm; H is room.
static void add_mass(flexible_tube *tube, int e, double x, double dm, double *H)
{
    const tube_element *element = &tube->element[e];
    tube_shortening *self = tube->shortening;
    for (int plane = 0; plane < self->planes; plane++) {
        memcpy(H, shortening_before(self, e, plane), (size_t)self->size * sizeof *H);
        add_stretch(tube, element, plane, x - element->x0, H);
        for (int i = 0; i < self->size; i++) {
            self->first[plane * self->size + i] += dm * H[i];
            self->second[plane * self->size + i] += dm * x * H[i];
        }
    }
}

static const ld_section *section_at(const ld_tubes *model, double x)
{
    int s = 0;
    while (s + 1 < model->section_count && model->section[s + 1].from <= x)
        s++;
    return &model->section[s];
}

// Gauss's rule with four points: H has degree 5 in an element, x H 6.
static void integrate(flexible_tube *tube, const ld_tubes *model, double *H)
{
    static const double at[4] = {-0.86113631159405257522, -0.33998104358485626480,
                                 0.33998104358485626480, 0.86113631159405257522};
    static const double weight[4] = {0.34785484513745385737, 0.65214515486254614263,
                                     0.65214515486254614263, 0.34785484513745385737};
    for (int e = 0; e < tube->element_count; e++) {
        double x0 = tube->element[e].x0, half = 0.5 * (tube->element[e].x1 - x0);
        double per_length = section_at(model, x0 + half)->mass_per_length;
        for (int p = 0; p < 4; p++)
            add_mass(tube, e, x0 + half * (1 + at[p]), per_length * half * weight[p], H);
    }
    for (int i = 0; i < model->point_mass_count; i++) {
        double x = model->point_mass[i].at;
        add_mass(tube, flexible_tube_find(tube, x), x, model->point_mass[i].mass, H);
    }
}

static void fill_before(flexible_tube *tube)
{
    tube_shortening *self = tube->shortening;
    size_t all = (size_t)(self->planes * self->size);
    for (int e = 0; e + 1 < tube->element_count; e++) {
        const tube_element *element = &tube->element[e];
        double *from = self->before + (size_t)e * all, *to = from + all;
        memcpy(to, from, all * sizeof *to);
        for (int plane = 0; plane < self->planes; plane++)
            add_stretch(tube, element, plane, element->x1 - element->x0, to + plane * self->size);
    }
}

ld_status shortening_build(flexible_tube *tube, const ld_tubes *model, ld_error *error)
{
    int planes = tube->overlap ? 2 : 1, size = tube->nb * tube->nbp;
    size_t all = (size_t)(planes * size), count = ((size_t)tube->element_count + 2) * all;
    size_t bytes = (count * sizeof(double) + 63) / 64 * 64;
    tube_shortening *self = tube->shortening = malloc(sizeof *self);
    double *block = self ? aligned_alloc(64, bytes) : NULL, *H = malloc(all * sizeof *H);
    if (self)
        *self = (tube_shortening){planes, size, block, block + all, block + 2 * all};
    if (!block || !H) {
        free(H);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the tube's geometric stiffness");
    }
    memset(block, 0, bytes);
    fill_before(tube);
    integrate(tube, model, H);
    free(H);
    return LD_OK;
}

void shortening_free(tube_shortening *self)
{
    if (self)
        free(self->first);
    free(self);
}

void shortening_apply(const flexible_tube *tube, const double *matrix, const double *q, double *to)
{
    for (int i = 0; i < tube->nb; i++) {
        to[i] = 0;
        for (int j = 0; j < tube->nb; j++)
            to[i] += matrix[i * tube->nbp + j] * q[j];
    }
}

void shortening_at(const flexible_tube *tube, int plane, double x, const double *q, double *Hq)
{
    int e = flexible_tube_find(tube, x);
    const tube_element *element = &tube->element[e];
    const double(*b)[LD_NB] = element->b[plane];
    double v[4] = {0}, weight[4];
    for (int k = 0; k < 4; k++)
        for (int j = 0; j < tube->nb; j++)
            v[k] += b[k][j] * q[j];
    shortening_weights(v, x - element->x0, weight);
    shortening_apply(tube, shortening_before(tube->shortening, e, plane), q, Hq);
    for (int i = 0; i < tube->nb; i++)
        for (int k = 1; k < 4; k++)
            Hq[i] += weight[k] * b[k][i];
}
