// Sines and cosines of many angles at once, four by four in vector lanes.
#ifndef LD_MATH_SINE_COSINE_H
#define LD_MATH_SINE_COSINE_H

#include <math.h>
#include <stdint.h>

#include "math/lanes.h"

// sin and cos, by their series while the angle is small.
LD_INLINE void sine_cosine_small(double x, double *s, double *c)
{
    double x2 = x * x;
    if (x2 < 1e-3) {
        *s =
            x * (1 + x2 * (-1.0 / 6 + x2 * (1.0 / 120 + x2 * (-1.0 / 5040 + x2 * (1.0 / 362880)))));
        *c = 1 + x2 * (-1.0 / 2 + x2 * (1.0 / 24 + x2 * (-1.0 / 720 + x2 * (1.0 / 40320))));
    } else {
        *s = sin(x);
        *c = cos(x);
    }
}

typedef int64_t lane_bits __attribute__((vector_size(32)));

// Sines and cosines of angles below 5e5 (beyond, the reduction would lose digits), errors below one
// unit in the last place. Reduction by multiples of pi/2 in three pieces and the polynomials on
// [-pi/4, pi/4] are those of Sun's fdlibm (k_sin.c, k_cos.c, e_rem_pio2.c).
LD_INLINE void sine_cosine_lanes(v4d x, v4d *sine, v4d *cosine)
{
    // n = nearest integer of x/(pi/2), in the low bits of a large double; y + tail = x - n pi/2
    v4d shifted = x * 0.63661977236758134 + 6755399441055744.0;
    v4d n = shifted - 6755399441055744.0;
    v4d first = x - n * 1.57079632673412561417e+00;
    v4d second = n * 6.07710050630396597660e-11;
    v4d third = n * 2.02226624879595063154e-21;
    v4d middle = first - second;
    v4d lost = (first - middle) - second;
    v4d y = middle - (third - lost);
    v4d tail = (middle - y) - (third - lost);

    // sine and cosine of y + tail
    v4d z = y * y, cube = z * y;
    v4d p = 2.75573137070700676789e-06 +
            z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10);
    p = 8.33333333332248946124e-03 + z * (-1.98412698298579493134e-04 + z * p);
    v4d s = y - ((z * (0.5 * tail - cube * p) - tail) - cube * -1.66666666666666324348e-01);
    v4d r = -2.75573143513906633035e-07 +
            z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11);
    r = 4.16666666666666019037e-02 +
        z * (-1.38888888888741095749e-03 + z * (2.48015872894767294178e-05 + z * r));
    v4d half = 0.5 * z, w = 1.0 - half;
    v4d c = w + (((1.0 - w) - half) + (z * (z * r) - y * tail));

    // odd quadrants swap the two, the second and third change the sign of the sine, the first and
    // second that of the cosine
    lane_bits quadrant = (lane_bits)shifted, swap = -(quadrant & 1);
    lane_bits sin_bits = ((lane_bits)s & ~swap) | ((lane_bits)c & swap);
    lane_bits cos_bits = ((lane_bits)c & ~swap) | ((lane_bits)s & swap);
    sin_bits ^= (quadrant & 2) << 62;
    cos_bits ^= ((quadrant + 1) & 2) << 62;
    *sine = (v4d)sin_bits;
    *cosine = (v4d)cos_bits;
}

// The sines and cosines of four angles [rad]; the arrays are aligned for lanes.
LD_INLINE void sine_cosine_four(const double *angle, double *sine, double *cosine)
{
    if (fabs(angle[0]) + fabs(angle[1]) + fabs(angle[2]) + fabs(angle[3]) < 5e5) {
        sine_cosine_lanes(*v4d_lanes_of(angle), v4d_lanes(sine), v4d_lanes(cosine));
    } else {
        for (int k = 0; k < 4; k++) {
            sine[k] = sin(angle[k]);
            cosine[k] = cos(angle[k]);
        }
    }
}

// sine[i], cosine[i] of angle[i] [rad] for i < n. The arrays hold an even number of values: at odd
// n one more angle is read and its results written.
void sine_cosine(int n, const double *angle, double *sine, double *cosine);

#endif
