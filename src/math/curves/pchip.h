// Slopes of the monotone piecewise cubic Hermite interpolant: harmonic means of the secants'
// slopes weighted by the distances to the neighbours (Fritsch and Butland, SIAM J. Sci. Stat.
// Comput. 5, 1984), three-point formula kept monotone at the ends (Moler, Numerical Computing with
// MATLAB, 3.6).
#ifndef LD_MATH_PCHIP_H
#define LD_MATH_PCHIP_H

#include <stddef.h>

// d[i]: slope at x[i]; n >= 2 points of increasing x; two points: their secant.
void pchip_slopes(size_t n, const double *x, const double *y, double *d);

#endif
