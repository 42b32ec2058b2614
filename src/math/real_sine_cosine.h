// Sine and cosine over reals, each lane with the bits of one alone.
#ifndef LD_MATH_REAL_SINE_COSINE_H
#define LD_MATH_REAL_SINE_COSINE_H

#include "math/functions.h"
#include "math/real_functions.h"

// Sine and cosine of any angle [rad]; those beyond 5e5 one by one.
LD_INLINE void real_sine_cosine(real x, real *sine, real *cosine)
{
    real_sine_cosine_near(x, sine, cosine);
    if (!real_any(real_abs(x) >= 5e5))
        return;
    for (int lane = 0; lane < LANES; lane++) {
        double angle = REAL_LANE(x, lane);
        if (fabs(angle) >= 5e5) {
            double s, c;
            sincos(angle, &s, &c);
            REAL_LANE(*sine, lane) = s;
            REAL_LANE(*cosine, lane) = c;
        }
    }
}

#endif
