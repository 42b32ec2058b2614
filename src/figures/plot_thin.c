// Thinning: points that would not be seen are left out (Douglas and Peucker).
#include <math.h>
#include <string.h>

#include "figures/plot.h"

// Square of the distance of point i from the straight line a to b, in shares of the panel.
static double distance2(const plot_line *line, size_t i, size_t a, size_t b)
{
    const double *x = line->x, *y = line->y;
    double bx = (x[b] - x[a]) / line->x_span, by = (y[b] - y[a]) / line->y_span;
    double ix = (x[i] - x[a]) / line->x_span, iy = (y[i] - y[a]) / line->y_span;
    double length2 = bx * bx + by * by;
    double along = length2 > 0 ? fmin(fmax((ix * bx + iy * by) / length2, 0), 1) : 0;
    double dx = ix - along * bx, dy = iy - along * by;
    return dx * dx + dy * dy;
}

void plot_thin(const plot_line *line, size_t first, size_t last)
{
    const double seen = 1.0 / 3000;
    char *keep = line->keep;
    size_t *stack = line->stack;
    size_t depth = 0;
    keep[first] = keep[last] = 1;
    stack[depth++] = first;
    stack[depth++] = last;
    while (depth > 0) {
        size_t b = stack[--depth], a = stack[--depth], far = a;
        double farthest = seen * seen;
        for (size_t i = a + 1; i < b; i++) {
            double d2 = distance2(line, i, a, b);
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
