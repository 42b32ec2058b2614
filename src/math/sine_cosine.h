// Sines and cosines of many angles at once, four by four in vector lanes.
#ifndef LD_MATH_SINE_COSINE_H
#define LD_MATH_SINE_COSINE_H

#include <stdint.h>

#include "math/functions.h"
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
        sincos(x, s, c);
    }
}

typedef uint64_t lane_bits __attribute__((vector_size(32)));

#define NAME sine_cosine_lanes
#define NAME_WITHIN sine_cosine_lanes_within
#define NUMBER v4d
#define BITS lane_bits
#define TO_BITS(x) ((lane_bits)(x))
#define FROM_BITS(x) ((v4d)(x))
#include "math/sine_cosine_text.h"

// The sines and cosines of four angles [rad]; the arrays are aligned for lanes.
LD_INLINE void sine_cosine_four(const double *angle, double *sine, double *cosine)
{
    if (fabs(angle[0]) + fabs(angle[1]) + fabs(angle[2]) + fabs(angle[3]) < 5e5) {
        sine_cosine_lanes(*v4d_lanes_of(angle), v4d_lanes(sine), v4d_lanes(cosine));
    } else {
        for (int k = 0; k < 4; k++)
            sincos(angle[k], sine + k, cosine + k);
    }
}

// sine[i], cosine[i] of angle[i] [rad] for i < n. The arrays hold an even number of values: at odd
// n one more angle is read and its results written.
void sine_cosine(int n, const double *angle, double *sine, double *cosine);

#endif
