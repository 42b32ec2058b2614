// Several functions of one variable, tabulated at the same points: piecewise polynomials of degree
// 3 (pchip, spline) or 1 (linear).
#ifndef LD_MATH_CURVES_H
#define LD_MATH_CURVES_H

#include <stddef.h>

#include "launchdyn/status.h"

typedef enum curve_kind { CURVE_PCHIP, CURVE_SPLINE, CURVE_LINEAR } curve_kind;

typedef struct curves {
    size_t points;
    int count;           // functions
    double *x;           // [points] increasing, owned
    double *coefficient; // [points - 1][4][count] of (x - x_i)^k, and room for one more; owned
} curves;

// What is kept of an interval between look-ups (curves_real.h), all doubles: from <= x < to,
// infinite at the table's ends; all 0: nothing is kept. Coefficient [power][function] of x - start.
#define CURVES_KEPT(functions)                                                                     \
    struct {                                                                                       \
        double from, to, start;                                                                    \
        double coefficient[4 * (functions)];                                                       \
    }

// Columns 1 .. of `data` [rows][columns] over column 0, which must increase; at least one row (with
// one row the functions are constant).
ld_status curves_build(curves *self, size_t rows, size_t columns, const double *data,
                       curve_kind kind, ld_error *error);
void curves_free(curves *self);

// Gives function k the slopes d at its points, in place of those that it has.
void curves_set_slopes(curves *self, int k, const double *d);

// The interval that x lies in, the first or last one outside; `hint` is tried first.
static inline size_t curves_interval(const curves *self, double x, size_t hint)
{
    size_t i = hint < self->points - 1 ? hint : self->points - 2;
    while (i > 0 && x < self->x[i])
        i--;
    while (i + 2 < self->points && x >= self->x[i + 1])
        i++;
    return i;
}

// The same interval without a hint.
size_t curves_find(const curves *self, double x);

// The first `count` values at x by the polynomials of that interval; outside the table they
// continue.
static inline void curves_first_values(const curves *self, size_t interval, double x, int count,
                                       double *values)
{
    size_t n = (size_t)self->count;
    const double *c0 = self->coefficient + interval * 4 * n, *c1 = c0 + n, *c2 = c1 + n,
                 *c3 = c2 + n;
    double t = x - self->x[interval];
    for (int k = 0; k < count; k++)
        values[k] = c0[k] + t * (c1[k] + t * (c2[k] + t * c3[k]));
}
// All of them.
void curves_values(const curves *self, size_t interval, double x, double *values);

// The same, but constant outside the table.
void curves_held(const curves *self, double x, double *values);

#endif
