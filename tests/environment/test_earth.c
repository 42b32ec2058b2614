// Earth: gravitation as the gradient of its potential, geodetic places there and back, frames.
#define LANES 1
#include "model/model.h"
#include "support/check.h"

#include "environment/earth.h"
#include "environment/earth_real.h"
#include "support/draw.h"

static const double degree = 0.017453292519943295;

static earth earth_of(ld_earth_model kind, double latitude, double longitude, double azimuth)
{
    ld_model model;
    earth self;
    model_init(&model);
    model.environment.earth.kind = kind;
    model.environment.site = (ld_site){true, latitude, longitude, 100, azimuth};
    earth_build(&self, &model);
    return self;
}

// Potential -GM/r (1 - J2 (a/r)^2 (3 sin^2 - 1)/2), differentiated by long double differences.
static long double potential(const earth *self, long double x, long double y, long double z)
{
    long double r2 = x * x + y * y + z * z, r = sqrtl(r2), a = self->a;
    return -self->gm / r * (1 - self->j2 * a * a / r2 * (3 * z * z / r2 - 1) / 2);
}

static void test_gravitation(void **state)
{
    (void)state;
    earth self = earth_of(LD_EARTH_WGS84, 0, 0, 0);
    uint64_t seed = 3;
    double worst = 0;
    for (int i = 0; i < 200; i++) {
        v3 r = v3_make(9e6 * draw(&seed), 9e6 * draw(&seed), 9e6 * draw(&seed));
        if (v3_norm(r) < 5e6)
            continue;
        long double h = 1000;
#define SLOPE(dx, dy, dz)                                                                          \
    (double)((8 * (potential(&self, r.x + dx * h, r.y + dy * h, r.z + dz * h) -                    \
                   potential(&self, r.x - dx * h, r.y - dy * h, r.z - dz * h)) -                   \
              (potential(&self, r.x + 2 * dx * h, r.y + 2 * dy * h, r.z + 2 * dz * h) -            \
               potential(&self, r.x - 2 * dx * h, r.y - 2 * dy * h, r.z - 2 * dz * h))) /          \
             (12 * h))
        v3 expected = v3_make(-SLOPE(1, 0, 0), -SLOPE(0, 1, 0), -SLOPE(0, 0, 1));
        worst = fmax(worst, v3_norm(v3_sub(earth_gravity(&self, r), expected)));
    }
    CHECK_BELOW("gravitation [m/s2] less gradient", worst, 1e-13);
    // normal gravity of WGS 84, less what its J4 adds: 15/8 and 5 J4 times the central part
    const double J4 = -2.37091e-6, ratio = self.a / self.b;
    v3 g = earth_gravity(&self, v3_make(self.a, 0, 0));
    double central = self.gm / (self.a * self.a);
    CHECK_NEAR("gravity at the equator", -g.x - self.rotation * self.rotation * self.a,
               9.7803253359 + 15.0 / 8 * J4 * central, 2e-7);
    g = earth_gravity(&self, v3_make(0, 0, self.b));
    central = self.gm / (self.b * self.b);
    CHECK_NEAR("gravity at the pole", -g.z, 9.8321849379 + 5 * J4 * central * pow(ratio, 4), 5e-7);
    // NESC check-case 1 (AIAA 2015-1810): 32.1065 ft/s2 at 30 000 ft over the equator
    g = earth_gravity(&self, v3_make(self.a + 9144, 0, 0));
    CHECK_NEAR("gravitation of NESC case 1", -g.x, 9.7860721581, 1e-10);
    earth round = earth_of(LD_EARTH_ROUND, 0, 0, 0);
    g = earth_gravity(&round, v3_make(0, 6371007.1809, 0));
    CHECK_NEAR("gravity of the sphere", -g.y, 3.986004418e14 / (6371007.1809 * 6371007.1809),
               1e-14);
}

static void test_geodetic(void **state)
{
    (void)state;
    earth self = earth_of(LD_EARTH_WGS84, 0, 0, 0);
    const double heights[] = {-10e3, 0, 9144, 100e3, 1000e3, 36000e3};
    double angle = 0, altitude = 0;
    for (int i = 0; i < 6; i++)
        for (double latitude = -90; latitude <= 90; latitude += 0.5) {
            geodetic place = {latitude * degree, 3 * degree, heights[i]};
            v3 r = earth_place(&self, place);
            geodetic again = earth_geodetic(&self, r);
            angle = fmax(angle, fabs(again.latitude - place.latitude));
            altitude = fmax(altitude, fabs(again.altitude - place.altitude) / (6e6 + heights[i]));
            altitude =
                fmax(altitude, fabs(earth_altitude(&self, r) - heights[i]) / (6e6 + heights[i]));
        }
    CHECK_BELOW("latitude [rad]", angle, 5e-16);
    CHECK_BELOW("altitude, relative to the distance", altitude, 7e-16);
    // the normal of the ellipsoid points up
    v3 low = earth_place(&self, (geodetic){0.7, 0.4, 0}),
       high = earth_place(&self, (geodetic){0.7, 0.4, 1});
    v3 up = m3_column(earth_local_axes(0.7, 0.4), 1);
    CHECK_BELOW("up", v3_norm(v3_sub(v3_sub(high, low), up)), 2e-9);
    earth round = earth_of(LD_EARTH_ROUND, 0, 0, 0);
    geodetic place = earth_geodetic(&round, v3_make(0, 0, 7e6));
    CHECK_NEAR("altitude over the sphere", place.altitude, 7e6 - 6371007.1809, 1e-9);
    CHECK_NEAR("latitude of the pole", place.latitude, 90 * degree, 1e-16);
}

// Axes north, up, east without angles against those by latitude and longitude, also at the poles.
static void test_from_north(void **state)
{
    (void)state;
    const v3 wind = {5, -2, 3};
    double worst = 0;
    for (int kind = 0; kind < 2; kind++) {
        earth self = earth_of(kind ? LD_EARTH_WGS84 : LD_EARTH_ROUND, 0, 0, 0);
        const real_ellipsoid of = {self.a, self.b, self.e2};
        for (double latitude = -90; latitude <= 90; latitude += 7.5)
            for (double longitude = -180; longitude < 180; longitude += 50) {
                v3 r = earth_place(&self, (geodetic){latitude * degree, longitude * degree, 12e3});
                geodetic at = earth_geodetic(&self, r);
                v3 expected = m3_apply(earth_local_axes(at.latitude, at.longitude), wind);
                real3 found =
                    earth_from_north(&of, (real3){r.x, r.y, r.z}, (real3){wind.x, wind.y, wind.z});
                worst = fmax(worst, v3_norm(v3_sub((v3){found.x, found.y, found.z}, expected)));
            }
        real3 pole = earth_from_north(&of, (real3){0, 0, self.b}, (real3){5, -2, 3});
        CHECK_BELOW("wind at the pole [m/s]", v3_norm((v3){pole.x + 5, pole.y - 3, pole.z + 2}),
                    1e-15);
    }
    CHECK_BELOW("wind from north, up and east [m/s]", worst, 3e-15);
}

// Axes of I: x at the azimuth, clockwise from north, y up, z to the right of x.
static void test_frames(void **state)
{
    (void)state;
    earth self = earth_of(LD_EARTH_WGS84, 40 * degree, -75 * degree, 30 * degree);
    m3 A = earth_local_axes(40 * degree, -75 * degree);
    v3 north = m3_apply_transposed(self.A_EI, m3_column(A, 0));
    v3 up = m3_apply_transposed(self.A_EI, m3_column(A, 1));
    v3 east = m3_apply_transposed(self.A_EI, m3_column(A, 2));
    v3 expected[] = {{cos(30 * degree), 0, -sin(30 * degree)},
                     {0, 1, 0},
                     {sin(30 * degree), 0, cos(30 * degree)}};
    CHECK_BELOW("north", v3_norm(v3_sub(north, expected[0])), 2e-16);
    CHECK_BELOW("up", v3_norm(v3_sub(up, expected[1])), 2e-16);
    CHECK_BELOW("east", v3_norm(v3_sub(east, expected[2])), 2e-16);
    CHECK_BELOW("north by A_IN", v3_norm(v3_sub(m3_column(self.A_IN, 0), expected[0])), 1e-16);
    // a point at rest on the ground moves with the Earth, and comes back
    double t = 1234.5;
    v3 r = v3_make(100, 20, -30), v = v3_make(3, 2, 1);
    earth_motion there = earth_from_ground(&self, t, r, v);
    earth_motion again = earth_to_ground(&self, t, there.r, there.v);
    CHECK_BELOW("position there and back", v3_norm(v3_sub(again.r, r)), 3e-9);
    CHECK_BELOW("velocity there and back", v3_norm(v3_sub(again.v, v)), 2e-13);
    double h = 0.5;
    v3 late = earth_from_ground(&self, t + h, v3_axpy(r, h, v), v).r;
    v3 early = earth_from_ground(&self, t - h, v3_axpy(r, -h, v), v).r;
    v3 rate = v3_scale(1 / (2 * h), v3_sub(late, early));
    CHECK_BELOW("velocity against differences", v3_norm(v3_sub(rate, there.v)), 2e-7);
    // the site lies where it was asked for
    geodetic site = earth_geodetic(&self, self.r_site);
    CHECK_NEAR("latitude of the site", site.latitude / degree, 40, 1e-13);
    CHECK_NEAR("longitude of the site", site.longitude / degree, -75, 1e-13);
    CHECK_NEAR("altitude of the site", site.altitude, 100, 2e-9);
}

static void test_flat(void **state)
{
    (void)state;
    earth self = earth_of(LD_EARTH_FLAT, 40 * degree, 0, 30 * degree);
    v3 g = earth_gravity(&self, v3_make(1, 2, 3));
    assert_true(g.x == 0 && g.y == -9.80665 && g.z == 0);
    assert_true(earth_altitude(&self, v3_make(1, 2, 3)) == 102);
    earth_motion m = earth_from_ground(&self, 5, v3_make(1, 2, 3), v3_make(4, 5, 6));
    assert_true(m.r.x == 1 && m.v.z == 6);
    assert_true(earth_rate(&self).z == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_gravitation), cmocka_unit_test(test_geodetic),
        cmocka_unit_test(test_from_north),  cmocka_unit_test(test_frames),
        cmocka_unit_test(test_flat),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
