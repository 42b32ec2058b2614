#include "elements/tube/initial_shape.h"

#include <stdlib.h>

ld_status initial_shape_build(const ld_tubes *tubes, initial_shape **self, ld_error *error)
{
    const ld_initial_shape *given = &tubes->initial_shape;
    const ld_table *table = &given->offsets;
    const double scale[3] = {given->scale[0], given->scale[1], given->twist_scale};
    *self = NULL;
    if (!given->present)
        return LD_OK;
    initial_shape *shape = calloc(1, sizeof *shape);
    if (!shape)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the initial shape");
    ld_status status =
        curves_build(&shape->of, table->rows, table->columns, table->data, CURVE_SPLINE, error);
    if (status) {
        free(shape);
        return status;
    }
    size_t count = (size_t)shape->of.count, coefficients = 4 * (shape->of.points - 1) * count;
    for (size_t i = 0; i < coefficients; i++)
        shape->of.coefficient[i] *= scale[i % count];
    *self = shape;
    return LD_OK;
}

void initial_shape_free(initial_shape *self)
{
    if (self)
        curves_free(&self->of);
    free(self);
}

void initial_shape_at(const initial_shape *self, double x, initial_section *at)
{
    const curves *of = &self->of;
    size_t i = curves_find(of, x), count = (size_t)of->count;
    double t = x - of->x[i], d[3][4] = {{0}}; // y_0, z_0, tau_0 with their derivatives
    for (size_t k = 0; k < count; k++) {
        const double *c = of->coefficient + 4 * i * count + k;
        double c1 = c[count], c2 = c[2 * count], c3 = c[3 * count];
        d[k][0] = c[0] + t * (c1 + t * (c2 + t * c3));
        d[k][1] = c1 + t * (2 * c2 + t * 3 * c3);
        d[k][2] = 2 * c2 + t * 6 * c3;
        d[k][3] = 6 * c3;
    }
    at->P = v3_make(0, d[0][0], d[1][0]);
    at->P1 = v3_make(0, d[0][1], d[1][1]);
    at->P2 = v3_make(0, d[0][2], d[1][2]);
    at->th = v3_make(d[2][0], -d[1][1], d[0][1]);
    at->th1 = v3_make(d[2][1], -d[1][2], d[0][2]);
    at->th2 = v3_make(d[2][2], -d[1][3], d[0][3]);
}
