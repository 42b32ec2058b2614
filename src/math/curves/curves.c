#include "math/curves/curves.h"

#include <stdlib.h>
#include <string.h>

#include "math/curves/pchip.h"
#include "math/curves/spline.h"

// Cubic with values y, slopes d at both ends of an interval of length h.
static void hermite(double h, double y0, double y1, double d0, double d1, double c[4])
{
    double s = (y1 - y0) / h;
    c[0] = y0;
    c[1] = d0;
    c[2] = (3 * s - 2 * d0 - d1) / h;
    c[3] = (d0 + d1 - 2 * s) / (h * h);
}

// Coefficients [n - 1][4] of one function.
static ld_status fit(size_t n, const double *x, const double *y, curve_kind kind, double *c,
                     ld_error *error)
{
    if (kind == CURVE_SPLINE) {
        spline cubic;
        ld_status status = spline_build(&cubic, n, x, y, error);
        if (!status)
            memcpy(c, cubic.coefficient, 4 * (n - 1) * sizeof(double));
        spline_free(&cubic);
        return status;
    }
    double *d = malloc(n * sizeof(double));
    if (!d)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a table of %zu points", n);
    if (kind == CURVE_PCHIP)
        pchip_slopes(n, x, y, d);
    for (size_t i = 0; i + 1 < n; i++) {
        double h = x[i + 1] - x[i], s = (y[i + 1] - y[i]) / h;
        hermite(h, y[i], y[i + 1], kind == CURVE_LINEAR ? s : d[i],
                kind == CURVE_LINEAR ? s : d[i + 1], c + 4 * i);
    }
    free(d);
    return LD_OK;
}

static ld_status fill(curves *self, size_t rows, const double *data, curve_kind kind,
                      double *scratch, ld_error *error)
{
    size_t n = self->points, columns = (size_t)self->count + 1;
    double *x = scratch, *y = scratch + n, *c = scratch + 2 * n;
    // a single row is a constant: one interval, wherever
    for (size_t i = 0; i < n; i++)
        x[i] = i < rows ? data[i * columns] : x[0] + 1;
    memcpy(self->x, x, n * sizeof(double));
    for (int k = 0; k < self->count; k++) {
        for (size_t i = 0; i < n; i++) {
            size_t row = i < rows ? i : 0;
            y[i] = data[row * columns + (size_t)k + 1];
        }
        ld_status status = fit(n, x, y, kind, c, error);
        if (status)
            return status;
        for (size_t i = 0; i + 1 < n; i++)
            for (size_t power = 0; power < 4; power++)
                self->coefficient[(4 * i + power) * (size_t)self->count + (size_t)k] =
                    c[4 * i + power];
    }
    return LD_OK;
}

ld_status curves_build(curves *self, size_t rows, size_t columns, const double *data,
                       curve_kind kind, ld_error *error)
{
    size_t n = rows > 1 ? rows : 2;
    *self = (curves){.points = n, .count = (int)columns - 1};
    self->x = malloc(n * sizeof(double));
    self->coefficient = calloc((n - 1) * 4 * (size_t)self->count + 1, sizeof(double));
    double *scratch = malloc(6 * n * sizeof(double));
    ld_status status;
    if (self->x && self->coefficient && scratch)
        status = fill(self, rows, data, kind, scratch, error);
    else
        status = ld_fail(error, LD_ERR_MEMORY, "no memory for a table of %zu points", n);
    free(scratch);
    if (status)
        curves_free(self);
    return status;
}

void curves_set_slopes(curves *self, int k, const double *d)
{
    size_t n = (size_t)self->count;
    for (size_t i = 0; i + 1 < self->points; i++) {
        double *at = self->coefficient + 4 * i * n + (size_t)k, c[4];
        double h = self->x[i + 1] - self->x[i];
        double next = at[0] + h * (at[n] + h * (at[2 * n] + h * at[3 * n]));
        hermite(h, at[0], next, d[i], d[i + 1], c);
        for (size_t power = 0; power < 4; power++)
            at[power * n] = c[power];
    }
}

void curves_free(curves *self)
{
    free(self->x);
    free(self->coefficient);
    *self = (curves){0};
}

size_t curves_find(const curves *self, double x)
{
    size_t low = 0, high = self->points - 1;
    while (high - low > 1) {
        size_t middle = (low + high) / 2;
        if (x < self->x[middle])
            high = middle;
        else
            low = middle;
    }
    return low;
}

void curves_values(const curves *self, size_t interval, double x, double *values)
{
    curves_first_values(self, interval, x, self->count, values);
}

void curves_held(const curves *self, double x, double *values)
{
    double first = self->x[0], last = self->x[self->points - 1];
    x = x < first ? first : x > last ? last : x;
    curves_values(self, curves_find(self, x), x, values);
}
