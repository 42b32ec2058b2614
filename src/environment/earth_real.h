// Gravity and altitude on a round Earth over reals (math/real.h).
#ifndef LD_ENVIRONMENT_EARTH_REAL_H
#define LD_ENVIRONMENT_EARTH_REAL_H

#include "math/vectors/real_vec3.h"

// Gravitational acceleration at the point r of C: gm [m3/s2], j2, a [m] as in environment/earth.h.
LD_INLINE real3 earth_gravitation(real gm, real j2, real a, real3 r)
{
    real r2 = real3_norm2(r), g = -gm / (r2 * real_sqrt(r2));
    real k = 1.5 * j2 * a * a / r2, s = 5.0 * r.z * r.z / r2;
    return (real3){g * r.x * (1.0 + k * (1.0 - s)), g * r.y * (1.0 + k * (1.0 - s)),
                   g * r.z * (1.0 + k * (3.0 - s))};
}

// Sine and cosine of the geodetic latitude of a point at the distances p from the axis and z from
// the equator: Bowring's iteration on the reduced latitude (Survey Review 23, 1976), by ratios, so
// that the poles are no exception. The error falls by e2^2 (h/a) or so a round.
LD_INLINE void earth_latitude(real a, real b, real e2, real p, real z, int rounds, real *sine,
                              real *cosine)
{
    real outer = e2 * a, inner = outer * a / b; // e^2 a, e'^2 b
    real s = z * a, c = p * b;
    for (int i = 0; i < rounds; i++) {
        real n = 1.0 / real_sqrt(s * s + c * c);
        s *= n;
        c *= n;
        real up = z + inner * s * s * s, out = p - outer * c * c * c;
        s = up * b;
        c = out * a;
        *sine = up;
        *cosine = out;
    }
    real n = 1.0 / real_sqrt(*sine * *sine + *cosine * *cosine);
    *sine *= n;
    *cosine *= n;
}

LD_INLINE real earth_height_above(real a, real e2, real p, real z, real sine, real cosine)
{
    return p * cosine + z * sine - a * real_sqrt(1.0 - e2 * sine * sine);
}

// Altitude [m] above the ellipsoid of the semi-axes a, b (its first eccentricity squared: e2), or
// the sphere, of the point r of E or C.
LD_INLINE real earth_altitude_above(real a, real b, real e2, real3 r)
{
    real p = real_sqrt(r.x * r.x + r.y * r.y);
    real sine, cosine;
    // the height changes with the square of the latitude's error
    earth_latitude(a, b, e2, p, r.z, 2, &sine, &cosine);
    real high = earth_height_above(a, e2, p, r.z, sine, cosine);
    return real_select(e2 == 0.0, real_sqrt(p * p + r.z * r.z) - a, high);
}

#endif
