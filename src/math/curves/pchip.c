#include "math/curves/pchip.h"

#include <math.h>

static double secant(const double *x, const double *y, size_t i)
{
    return (y[i + 1] - y[i]) / (x[i + 1] - x[i]);
}

// Slope at an end: h0, s0 of the interval there, h1, s1 of the next.
static double end_slope(double h0, double s0, double h1, double s1)
{
    double d = ((2 * h0 + h1) * s0 - h0 * s1) / (h0 + h1);
    if (d * s0 <= 0)
        return 0;
    if (s0 * s1 <= 0 && fabs(d) > 3 * fabs(s0))
        return 3 * s0;
    return d;
}

void pchip_slopes(size_t n, const double *x, const double *y, double *d)
{
    if (n == 2) {
        d[0] = d[1] = secant(x, y, 0);
        return;
    }
    for (size_t i = 1; i + 1 < n; i++) {
        double h0 = x[i] - x[i - 1], h1 = x[i + 1] - x[i];
        double s0 = secant(x, y, i - 1), s1 = secant(x, y, i);
        double w0 = 2 * h1 + h0, w1 = h1 + 2 * h0;
        d[i] = s0 * s1 > 0 ? (w0 + w1) / (w0 / s0 + w1 / s1) : 0;
    }
    d[0] = end_slope(x[1] - x[0], secant(x, y, 0), x[2] - x[1], secant(x, y, 1));
    d[n - 1] = end_slope(x[n - 1] - x[n - 2], secant(x, y, n - 2), x[n - 2] - x[n - 3],
                         secant(x, y, n - 3));
}
