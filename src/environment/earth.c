#define LANES 1
#include "environment/earth.h"

#include "environment/earth_real.h"
#include "math/functions.h"
#include "model/blocks/environment.h"
#include "model/parts.h"

static double or_default(double value, double otherwise)
{
    return isnan(value) ? otherwise : value;
}

// Constants of the models: WGS 84 (NIMA TR8350.2) and the sphere of the same area.
static void set_figure(earth *self, const ld_earth *given)
{
    const double flattening = 1 / 298.257223563;
    bool own = given->kind == LD_EARTH_GIVEN;
    bool ellipsoid = (own ? given->model : given->kind) == LD_EARTH_WGS84;
    self->gm = or_default(own ? given->gm : NAN, 3.986004418e14);
    self->j2 = or_default(own ? given->j2 : NAN, ellipsoid ? 1.08262982e-3 : 0);
    self->rotation = or_default(own ? given->rotation : NAN, 7.292115e-5);
    self->a = or_default(own ? given->radius : NAN, ellipsoid ? 6378137 : 6371007.1809);
    self->b = ellipsoid ? self->a * (1 - flattening) : self->a;
    self->e2 = ellipsoid ? flattening * (2 - flattening) : 0;
}

m3 earth_local_axes(double latitude, double longitude)
{
    double sf = sin(latitude), cf = cos(latitude), sl = sin(longitude), cl = cos(longitude);
    return m3_columns(v3_make(-sf * cl, -sf * sl, cf), v3_make(cf * cl, cf * sl, sf),
                      v3_make(-sl, cl, 0));
}

void earth_build(earth *self, const ld_model *model)
{
    const ld_environment *environment = model_environment(model);
    const ld_site *site = &environment->site;
    double s = sin(site->azimuth), c = cos(site->azimuth);
    *self = (earth){.flat = environment->earth.kind == LD_EARTH_FLAT,
                    .gravity = model_gravity(model),
                    .altitude = site->altitude,
                    .A_EI = m3_identity()};
    // x of I points to cos north + sin east, z to -sin north + cos east
    self->A_IN = m3_columns(v3_make(c, 0, -s), v3_make(0, 1, 0), v3_make(s, 0, c));
    if (self->flat)
        return;
    set_figure(self, &environment->earth);
    self->r_site = earth_place(self, (geodetic){site->latitude, site->longitude, site->altitude});
    self->A_EI =
        m3_mul(earth_local_axes(site->latitude, site->longitude), m3_transpose(self->A_IN));
}

LD_INLINE real3 real3_of(v3 a)
{
    return (real3){a.x, a.y, a.z};
}

v3 earth_gravity(const earth *self, v3 r)
{
    if (self->flat)
        return v3_make(0, -self->gravity, 0);
    real3 g = earth_gravitation(self->gm, self->j2, self->a, real3_of(r));
    return v3_make(g.x, g.y, g.z);
}

static real_ellipsoid ellipsoid_of(const earth *self)
{
    return (real_ellipsoid){self->a, self->b, self->e2};
}

geodetic earth_geodetic(const earth *self, v3 r)
{
    double p = hypot(r.x, r.y);
    real_ellipsoid of = ellipsoid_of(self);
    real_latitude at = earth_latitude(&of, p, r.z, 3);
    return (geodetic){atan2(at.sine, at.cosine), atan2(r.y, r.x),
                      earth_height_above(&of, p, r.z, at)};
}

v3 earth_place(const earth *self, geodetic place)
{
    double s = sin(place.latitude), c = cos(place.latitude);
    double n = self->a / sqrt(1 - self->e2 * s * s); // radius of curvature across the meridian
    double p = (n + place.altitude) * c;
    return v3_make(p * cos(place.longitude), p * sin(place.longitude),
                   (n * (1 - self->e2) + place.altitude) * s);
}

double earth_altitude(const earth *self, v3 r)
{
    if (self->flat)
        return self->altitude + r.y;
    real_ellipsoid of = ellipsoid_of(self);
    return earth_altitude_above(&of, real3_of(r));
}

double earth_height(const earth *self, v3 r, v3 *up)
{
    *up = v3_make(0, 1, 0);
    if (self->flat)
        return r.y;
    geodetic place = earth_geodetic(self, r);
    *up = m3_column(earth_local_axes(place.latitude, place.longitude), 1);
    return place.altitude;
}

m3 earth_turn(const earth *self, double t)
{
    if (self->flat)
        return m3_identity();
    return m3_rotation_z(self->rotation * t);
}

v3 earth_rate(const earth *self)
{
    return v3_make(0, 0, self->flat ? 0 : self->rotation);
}

earth_motion earth_from_ground(const earth *self, double t, v3 r, v3 v)
{
    if (self->flat)
        return (earth_motion){r, v};
    m3 A = m3_mul(earth_turn(self, t), self->A_EI);
    v3 place = v3_add(m3_apply(A, r), m3_apply(earth_turn(self, t), self->r_site));
    return (earth_motion){place, v3_add(m3_apply(A, v), v3_cross(earth_rate(self), place))};
}

earth_motion earth_to_ground(const earth *self, double t, v3 r, v3 v)
{
    if (self->flat)
        return (earth_motion){r, v};
    m3 A = m3_mul(earth_turn(self, t), self->A_EI);
    v3 from_site = v3_sub(r, m3_apply(earth_turn(self, t), self->r_site));
    return (earth_motion){m3_apply_transposed(A, from_site),
                          m3_apply_transposed(A, v3_sub(v, v3_cross(earth_rate(self), r)))};
}
