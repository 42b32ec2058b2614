// The Earth in free flight: flat, or a rotating sphere or ellipsoid with gravitation (model.md,
// section 8). Frames: I at the site (x at its azimuth, y up, z right), fixed to the ground; E fixed
// to the Earth (z along the axis, x through latitude 0, longitude 0); C inertial, the same as E at
// t = 0. On a flat Earth C is I.
#ifndef LD_ENVIRONMENT_EARTH_H
#define LD_ENVIRONMENT_EARTH_H

#include <stdbool.h>

#include "launchdyn/model.h"
#include "math/vectors/mat3.h"

typedef struct earth {
    bool flat;
    double gravity;  // [m/s2] flat
    double gm;       // [m3/s2]
    double j2;       // [-]
    double rotation; // [rad/s]
    double a, b;     // [m] semi-axes
    double e2;       // first eccentricity squared, 1 - b^2/a^2
    double altitude; // [m] of the site
    v3 r_site;       // [m] I's origin in E
    m3 A_EI;         // axes of I in E (flat: identity)
    m3 A_IN;         // axes north, up, east at the site, in I
} earth;

void earth_build(earth *self, const ld_model *model);

// Gravitational acceleration in C (flat: gravity in I) at the point r of C.
v3 earth_gravity(const earth *self, v3 r);

typedef struct geodetic {
    double latitude, longitude; // [rad]
    double altitude;            // [m] above the ellipsoid
} geodetic;

// Place of the point r of E, and back. Not for a flat Earth.
geodetic earth_geodetic(const earth *self, v3 r);
v3 earth_place(const earth *self, geodetic place);
// Axes north, up, east there, in E.
m3 earth_local_axes(double latitude, double longitude);

// Altitude above the ellipsoid of the point r of E or C (they differ by a turn about the axis
// only); flat: that of the site plus y.
double earth_altitude(const earth *self, v3 r);

// Height of the point r of C that counts against the ground, and the direction `up` in which it
// grows, in C: y on a flat Earth, else the altitude above sphere or ellipsoid.
double earth_height(const earth *self, v3 r, v3 *up);

// A_CE at time t: turn about z by the angle the Earth has gone since t = 0; flat: identity.
m3 earth_turn(const earth *self, double t);

// Position r, velocity v of a point against the ground, in I, turned into C, and back.
typedef struct earth_motion {
    v3 r, v;
} earth_motion;
earth_motion earth_from_ground(const earth *self, double t, v3 r, v3 v);
earth_motion earth_to_ground(const earth *self, double t, v3 r, v3 v);
// Angular velocity of the Earth in C.
v3 earth_rate(const earth *self);

#endif
