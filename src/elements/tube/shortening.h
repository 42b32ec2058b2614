// Foreshortening: how far bending draws the axis points of a tube towards its rear end
// (theory-tube.md). A part of the axis keeps its length, so to second order
//   u_x(x) = -1/2 (q_y . H_y(x) q_y + q_z . H_z(x) q_z),   H(x) = int_0^x b' b'^T dx
// and forces and inertia along x work on it: the geometric stiffness.
#ifndef LD_ELEMENTS_SHORTENING_H
#define LD_ELEMENTS_SHORTENING_H

#include "elements/tube/flexible_tube.h"

// Matrices [nb][nbp], zeros as padding, 64-byte aligned; one set where the planes share their
// shapes.
typedef struct tube_shortening {
    int planes;             // 1 or 2
    int size;               // of a matrix: nb nbp
    double *first, *second; // by plane: int H dm, int x H dm; owned with what follows
    double *before;         // by element, then plane: H at the element's x0
} tube_shortening;

// Fills tube->shortening from the shapes of its elements; `model`: what it was built of.
ld_status shortening_build(flexible_tube *tube, const ld_tubes *model, ld_error *error);
void shortening_free(tube_shortening *self);

static inline const double *shortening_matrix(const tube_shortening *self, const double *from,
                                              int plane)
{
    return from + (plane < self->planes ? plane : 0) * self->size;
}

// H of a plane at the element's x0.
static inline const double *shortening_before(const tube_shortening *self, int element, int plane)
{
    return shortening_matrix(self, self->before + element * self->planes * self->size, plane);
}

// What a unit of the powers of xi adds to H q behind the element's x0, for a deflection with
// coefficients v of xi^0..3: weight[k] of coefficient k, int (xi^k)' v' d xi.
static inline void shortening_weights(const double v[4], double xi, double weight[4])
{
    double x2 = xi * xi, x3 = x2 * xi;
    weight[0] = 0;
    weight[1] = xi * (v[1] + xi * (v[2] + xi * v[3]));
    weight[2] = x2 * (v[1] + xi * (4.0 / 3 * v[2] + xi * 1.5 * v[3]));
    weight[3] = x3 * (v[1] + xi * (1.5 * v[2] + xi * 1.8 * v[3]));
}

// H(x) q of a plane [nb]; x on the tube.
void shortening_at(const flexible_tube *tube, int plane, double x, const double *q, double *Hq);

// to = matrix q of a plane [nb].
void shortening_apply(const flexible_tube *tube, const double *matrix, const double *q, double *to);

#endif
