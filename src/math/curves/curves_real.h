// Curves over reals (math/real.h): each lane keeps the interval that it was in last.
#ifndef LD_MATH_CURVES_REAL_H
#define LD_MATH_CURVES_REAL_H

#include "math/curves/curves.h"
#include "math/real.h"

enum { CURVES_COEFFICIENTS = 3 }; // where these begin in what is kept

// The lanes whose x has left the interval kept: bit i for lane i.
LD_INLINE unsigned curves_left(const real *kept, real x)
{
    return real_lanes(real_not((x >= kept[0]) & (x < kept[1])));
}

// Keeps in one lane the interval of x, with the first `functions` of the table.
LD_OUTLINE void curves_keep(real *kept, int lane, const curves *table, double x, int functions)
{
    double *to = (double *)kept + lane;
    size_t i = curves_find(table, x), count = (size_t)table->count;
    const double *c = table->coefficient + 4 * i * count;
    to[0] = i > 0 ? table->x[i] : (double)-INFINITY;
    to[LANES] = i + 2 < table->points ? table->x[i + 1] : (double)INFINITY;
    to[2 * LANES] = table->x[i];
    to += CURVES_COEFFICIENTS * LANES;
    for (int power = 0; power < 4; power++)
        for (int k = 0; k < functions; k++)
            to[(power * functions + k) * LANES] = c[(size_t)power * count + (size_t)k];
}

// Their values at x by the intervals kept.
LD_INLINE void curves_kept_values(const real *kept, real x, int functions, real *values)
{
    const real *c = kept + CURVES_COEFFICIENTS;
    real t = x - kept[2];
    for (int k = 0; k < functions; k++)
        values[k] =
            c[k] + t * (c[functions + k] + t * (c[2 * functions + k] + t * c[3 * functions + k]));
}

#endif
