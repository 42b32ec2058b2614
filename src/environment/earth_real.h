// Gravity, altitude and axes on a round Earth over reals (math/real.h).
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

// Semi-axes [m] of the ellipsoid and its first eccentricity squared.
typedef struct real_ellipsoid {
    real a, b, e2;
} real_ellipsoid;

// Of the geodetic latitude.
typedef struct real_latitude {
    real sine, cosine;
} real_latitude;

// Geodetic latitude of a point at the distances p from the axis and z from
// the equator: Bowring's iteration on the reduced latitude (Survey Review 23, 1976), by ratios, so
// that the poles are no exception. The error falls by e2^2 (h/a) or so a round.
LD_INLINE real_latitude earth_latitude(const real_ellipsoid *of, real p, real z, int rounds)
{
    real a = of->a, b = of->b;
    real outer = of->e2 * a, inner = outer * a / b; // e^2 a, e'^2 b
    real s = z * a, c = p * b;
    real_latitude out = {s, c};
    for (int i = 0; i < rounds; i++) {
        real n = 1.0 / real_sqrt(s * s + c * c);
        s *= n;
        c *= n;
        out.sine = z + inner * s * s * s;
        out.cosine = p - outer * c * c * c;
        s = out.sine * b;
        c = out.cosine * a;
    }
    real n = 1.0 / real_sqrt(out.sine * out.sine + out.cosine * out.cosine);
    return (real_latitude){out.sine * n, out.cosine * n};
}

LD_INLINE real earth_height_above(const real_ellipsoid *of, real p, real z, real_latitude at)
{
    return p * at.cosine + z * at.sine - of->a * real_sqrt(1.0 - of->e2 * at.sine * at.sine);
}

// From axes north, up, east at the point r of E or C to those of r. At a pole the meridian is that
// of longitude 0.
LD_INLINE real3 earth_from_north(const real_ellipsoid *of, real3 r, real3 v)
{
    real p = real_sqrt(r.x * r.x + r.y * r.y);
    real_latitude at = earth_latitude(of, p, r.z, 3);
    real_condition pole = p == 0.0;
    real east = 1.0 / real_select(pole, real_all(1), p);
    real c = real_select(pole, real_all(1), r.x * east), s = r.y * east;
    real out = at.cosine * v.y - at.sine * v.x; // away from the axis
    return (real3){c * out - s * v.z, s * out + c * v.z, at.cosine * v.x + at.sine * v.y};
}

// Altitude [m] above the ellipsoid, or the sphere, of the point r of E or C.
LD_INLINE real earth_altitude_above(const real_ellipsoid *of, real3 r)
{
    real p = real_sqrt(r.x * r.x + r.y * r.y);
    // the height changes with the square of the latitude's error
    real_latitude at = earth_latitude(of, p, r.z, 2);
    real high = earth_height_above(of, p, r.z, at);
    return real_select(of->e2 == 0.0, real_sqrt(p * p + r.z * r.z) - of->a, high);
}

#endif
