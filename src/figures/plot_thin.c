// Thinning: points that would not be seen are left out (Douglas and Peucker).
#include <math.h>
#include <string.h>

#include "figures/plot.h"

// Square of the distance of point i from the straight line a to b, in shares of the panel.
static double distance2(const double *x, const double *y, double x_span, double y_span, size_t i,
                        size_t a, size_t b)
{
    double bx = (x[b] - x[a]) / x_span, by = (y[b] - y[a]) / y_span;
    double ix = (x[i] - x[a]) / x_span, iy = (y[i] - y[a]) / y_span;
    double length2 = bx * bx + by * by;
    double along = length2 > 0 ? fmin(fmax((ix * bx + iy * by) / length2, 0), 1) : 0;
    double dx = ix - along * bx, dy = iy - along * by;
    return dx * dx + dy * dy;
}

void plot_thin(const double *x, const double *y, double x_span, double y_span, size_t first,
               size_t last, char *keep, size_t *stack)
{
    const double seen = 1.0 / 3000;
    size_t depth = 0;
    keep[first] = keep[last] = 1;
    stack[depth++] = first;
    stack[depth++] = last;
    while (depth > 0) {
        size_t b = stack[--depth], a = stack[--depth], far = a;
        double farthest = seen * seen;
        for (size_t i = a + 1; i < b; i++) {
            double d2 = distance2(x, y, x_span, y_span, i, a, b);
            if (d2 > farthest) {
                farthest = d2;
                far = i;
            }
        }
        if (far == a)
            continue;
        keep[far] = 1;
        size_t parts[] = {a, far, far, b};
        memcpy(stack + depth, parts, sizeof parts);
        depth += 4;
    }
}
