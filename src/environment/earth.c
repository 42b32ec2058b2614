#include "environment/earth.h"

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
    const ld_environment *environment = &model->environment;
    const ld_site *site = &environment->site;
    double s = sin(site->azimuth), c = cos(site->azimuth);
    *self = (earth){.flat = environment->earth.kind == LD_EARTH_FLAT,
                    .gravity = model->gravity,
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

v3 earth_gravity(const earth *self, v3 r)
{
    if (self->flat)
        return v3_make(0, -self->gravity, 0);
    double r2 = v3_norm2(r), g = -self->gm / (r2 * sqrt(r2));
    double k = 1.5 * self->j2 * self->a * self->a / r2, s = 5 * r.z * r.z / r2;
    return v3_make(g * r.x * (1 + k * (1 - s)), g * r.y * (1 + k * (1 - s)),
                   g * r.z * (1 + k * (3 - s)));
}

// Sine and cosine of the geodetic latitude of a point at the distances p from the axis and z from
// the equator: Bowring's iteration on the reduced latitude (Survey Review 23, 1976), by ratios, so
// that the poles are no exception. The error falls by e2^2 (h/a) or so a round.
static void latitude_of(const earth *self, double p, double z, int rounds, double *sine,
                        double *cosine)
{
    double outer = self->e2 * self->a, inner = outer * self->a / self->b; // e^2 a, e'^2 b
    double s = z * self->a, c = p * self->b;
    for (int i = 0; i < rounds; i++) {
        double n = 1 / sqrt(s * s + c * c);
        s *= n;
        c *= n;
        double up = z + inner * s * s * s, out = p - outer * c * c * c;
        s = up * self->b;
        c = out * self->a;
        *sine = up;
        *cosine = out;
    }
    double n = 1 / sqrt(*sine * *sine + *cosine * *cosine);
    *sine *= n;
    *cosine *= n;
}

static double height(const earth *self, double p, double z, double sine, double cosine)
{
    return p * cosine + z * sine - self->a * sqrt(1 - self->e2 * sine * sine);
}

geodetic earth_geodetic(const earth *self, v3 r)
{
    double sine, cosine, p = hypot(r.x, r.y);
    latitude_of(self, p, r.z, 3, &sine, &cosine);
    return (geodetic){atan2(sine, cosine), atan2(r.y, r.x), height(self, p, r.z, sine, cosine)};
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
    double p = sqrt(r.x * r.x + r.y * r.y);
    if (self->e2 == 0)
        return sqrt(p * p + r.z * r.z) - self->a;
    double sine, cosine;
    // the height changes with the square of the latitude's error
    latitude_of(self, p, r.z, 2, &sine, &cosine);
    return height(self, p, r.z, sine, cosine);
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
