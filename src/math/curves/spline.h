// Cubic interpolating spline through points of increasing x, not-a-knot at both ends.
#ifndef LD_MATH_SPLINE_H
#define LD_MATH_SPLINE_H

#include <stddef.h>

#include "launchdyn/status.h"

typedef struct spline {
    size_t count;
    double *x;           // [count] owned
    double *coefficient; // [count - 1][4] of (x - x_i)^k, owned
} spline;

// At least two points; with two it is a line, with three a parabola.
ld_status spline_build(spline *self, size_t count, const double *x, const double *y,
                       ld_error *error);
void spline_free(spline *self);

// Value and slope at x; outside the table the end pieces continue.
double spline_value(const spline *self, double x, double *slope);
// Second derivative at x.
double spline_curvature(const spline *self, double x);

#endif
