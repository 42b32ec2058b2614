#include "math/curves/spline.h"

#include <stdlib.h>
#include <string.h>

#include "math/matrices/lapack.h"

// Slopes d of the C2 cubic: h_i d_(i-1) + 2 (h_(i-1) + h_i) d_i + h_(i-1) d_(i+1) = right-hand
// side, not-a-knot rows at the ends (de Boor, A Practical Guide to Splines, ch. IV).
static int solve_slopes(size_t n, const double *x, const double *y, double *d)
{
    double *lower = calloc(3 * n, sizeof *lower);
    if (!lower)
        return -1;
    double *diagonal = lower + n, *upper = lower + 2 * n;
    for (size_t i = 1; i + 1 < n; i++) {
        double h0 = x[i] - x[i - 1], h1 = x[i + 1] - x[i];
        lower[i - 1] = h1;
        diagonal[i] = 2 * (h0 + h1);
        upper[i] = h0;
        d[i] = 3 * (h1 * (y[i] - y[i - 1]) / h0 + h0 * (y[i + 1] - y[i]) / h1);
    }
    double h0 = x[1] - x[0], h1 = x[2] - x[1], s = h0 + h1;
    diagonal[0] = h1;
    upper[0] = s;
    d[0] = ((h0 + 2 * s) * h1 * (y[1] - y[0]) / h0 + h0 * h0 * (y[2] - y[1]) / h1) / s;
    h0 = x[n - 1] - x[n - 2], h1 = x[n - 2] - x[n - 3], s = h0 + h1;
    diagonal[n - 1] = h1;
    lower[n - 2] = s;
    d[n - 1] =
        ((h0 + 2 * s) * h1 * (y[n - 1] - y[n - 2]) / h0 + h0 * h0 * (y[n - 2] - y[n - 3]) / h1) / s;
    int info =
        LAPACKE_dgtsv(LAPACK_COL_MAJOR, (lapack_int)n, 1, lower, diagonal, upper, d, (lapack_int)n);
    free(lower);
    return info;
}

// Two points: a line; three: the parabola through them.
static void few_slopes(size_t n, const double *x, const double *y, double *d)
{
    double s0 = (y[1] - y[0]) / (x[1] - x[0]);
    if (n == 2) {
        d[0] = d[1] = s0;
        return;
    }
    double s1 = (y[2] - y[1]) / (x[2] - x[1]), c = (s1 - s0) / (x[2] - x[0]);
    d[0] = s0 - c * (x[1] - x[0]);
    d[1] = s0 + c * (x[1] - x[0]);
    d[2] = s1 + c * (x[2] - x[1]);
}

ld_status spline_build(spline *self, size_t count, const double *x, const double *y,
                       ld_error *error)
{
    *self = (spline){.count = count};
    self->x = malloc(count * sizeof(double));
    self->coefficient = malloc(count * 4 * sizeof(double));
    double *d = malloc(count * sizeof(double));
    if (!self->x || !self->coefficient || !d) {
        free(d);
        spline_free(self);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a spline of %zu points", count);
    }
    memcpy(self->x, x, count * sizeof(double));
    int bad = 0;
    if (count < 4)
        few_slopes(count, x, y, d);
    else
        bad = solve_slopes(count, x, y, d);
    for (size_t i = 0; i + 1 < count; i++) {
        double h = x[i + 1] - x[i], s = (y[i + 1] - y[i]) / h;
        double *c = self->coefficient + 4 * i;
        c[0] = y[i];
        c[1] = d[i];
        c[2] = (3 * s - 2 * d[i] - d[i + 1]) / h;
        c[3] = (d[i] + d[i + 1] - 2 * s) / (h * h);
    }
    free(d);
    if (bad) {
        spline_free(self);
        return ld_fail(error, LD_ERR_NUMERIC, "a spline's points must have increasing x");
    }
    return LD_OK;
}

void spline_free(spline *self)
{
    free(self->x);
    free(self->coefficient);
    *self = (spline){0};
}

// The piece that holds x: its coefficients; *from: x - x_i.
static const double *piece_at(const spline *self, double x, double *from)
{
    size_t low = 0, high = self->count - 1;
    while (high - low > 1) {
        size_t middle = (low + high) / 2;
        if (x >= self->x[middle])
            low = middle;
        else
            high = middle;
    }
    *from = x - self->x[low];
    return self->coefficient + 4 * low;
}

double spline_value(const spline *self, double x, double *slope)
{
    double t;
    const double *c = piece_at(self, x, &t);
    if (slope)
        *slope = c[1] + t * (2 * c[2] + t * 3 * c[3]);
    return c[0] + t * (c[1] + t * (c[2] + t * c[3]));
}

double spline_curvature(const spline *self, double x)
{
    double t;
    const double *c = piece_at(self, x, &t);
    return 2 * c[2] + t * 6 * c[3];
}
