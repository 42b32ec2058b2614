// US Standard Atmosphere 1976 against its table; measured air against closed forms, us1976 and its
// own weight; uniform air, scales and offsets, no air.
#include "support/check.h"

#include <stdlib.h>

#include "environment/atmosphere.h"

// Half a unit of the last of `digits` significant digits.
static double half_digit(double value, int digits)
{
    return 0.5 * pow(10, floor(log10(value)) + 1 - digits);
}

static void test_table(void **state)
{
    (void)state;
    const ld_atmosphere model = {.kind = LD_ATMOSPHERE_US1976, .density_scale = 1};
    atmosphere self;
    assert_int_equal(atmosphere_build(&self, &model, NULL), LD_OK);
    FILE *file = fopen(LD_SOURCE_DIR "/tests/data/us76.csv", "r");
    assert_non_null(file);
    char line[256];
    double worst[4] = {0};
    int rows = 0;
    while (fgets(line, sizeof line, file)) {
        double z, H, T, p, rho, a, t, pressure;
        if (sscanf(line, "%lf,%lf,%lf,%lf,%lf,%lf", &z, &H, &T, &p, &rho, &a) != 6)
            continue;
        rows++;
        air here = atmosphere_at(&self, z);
        atmosphere_state(&self, z, &t, &pressure);
        worst[0] = fmax(worst[0], fabs(t - T) / 0.5e-6);
        worst[1] = fmax(worst[1], fabs(pressure - p) / half_digit(p, 8));
        worst[2] = fmax(worst[2], fabs(here.density - rho) / half_digit(rho, 8));
        worst[3] = fmax(worst[3], fabs(here.speed_of_sound - a) / half_digit(a, 7));
    }
    fclose(file);
    CHECK_WITHIN("rows", rows, 109, 109);
    CHECK_BELOW("temperature, halves of the last digit", worst[0], 1.01);
    CHECK_BELOW("pressure, halves of the 8th digit", worst[1], 1.01);
    CHECK_BELOW("density, halves of the 8th digit", worst[2], 1.01);
    CHECK_BELOW("speed of sound, halves of the 7th digit", worst[3], 1.01);
}

// Values printed in the standard itself (its tables I and II, rounded there).
static void test_standard(void **state)
{
    (void)state;
    const ld_atmosphere model = {.kind = LD_ATMOSPHERE_US1976, .density_scale = 1};
    atmosphere self;
    assert_int_equal(atmosphere_build(&self, &model, NULL), LD_OK);
    CHECK_NEAR("density at 0 m", atmosphere_at(&self, 0).density, 1.2250, 0.5e-4);
    CHECK_NEAR("speed of sound at 0 m", atmosphere_at(&self, 0).speed_of_sound, 340.294, 0.5e-3);
    CHECK_NEAR("pressure at 11 km'", self.layer[1].pressure, 22632.06, 0.5e-2);
    CHECK_NEAR("pressure at 20 km'", self.layer[2].pressure, 5474.889, 0.5e-3);
    CHECK_NEAR("pressure at 32 km'", self.layer[3].pressure, 868.0187, 0.5e-4);
    CHECK_NEAR("pressure at 47 km'", self.layer[4].pressure, 110.9063, 0.5e-4);
    CHECK_NEAR("pressure at 51 km'", self.layer[5].pressure, 66.93887, 0.5e-5);
    CHECK_NEAR("pressure at 71 km'", self.layer[6].pressure, 3.956420, 0.5e-6);
}

// Density falls as gravity says: dp/dz = -rho g_0 (r_0/(r_0 + z))^2, in every layer, across
// borders.
static void test_hydrostatic(void **state)
{
    (void)state;
    const ld_atmosphere model = {.kind = LD_ATMOSPHERE_US1976, .density_scale = 1};
    atmosphere self;
    assert_int_equal(atmosphere_build(&self, &model, NULL), LD_OK);
    double worst = 0, jump = 0;
    for (double z = -5000; z < 85990; z += 37) {
        double T, low, high, h = 0.5;
        atmosphere_state(&self, z - h, &T, &low);
        atmosphere_state(&self, z + h, &T, &high);
        double share = 6356766 / (6356766 + z);
        double weight = atmosphere_at(&self, z).density * 9.80665 * share * share;
        worst = fmax(worst, fabs((low - high) / (2 * h) / weight - 1));
        double below = atmosphere_at(&self, z - h).density;
        jump = fmax(jump, fabs(atmosphere_at(&self, z + h).density / below - 1));
    }
    CHECK_BELOW("pressure gradient against weight", worst, 2e-9);
    CHECK_BELOW("density over a metre", jump, 2.1e-4);
}

static void test_scales(void **state)
{
    (void)state;
    ld_atmosphere model = {.kind = LD_ATMOSPHERE_US1976, .density_scale = 1};
    atmosphere plain, other;
    assert_int_equal(atmosphere_build(&plain, &model, NULL), LD_OK);
    model.density_scale = 1.1;
    model.temperature_offset = 20;
    assert_int_equal(atmosphere_build(&other, &model, NULL), LD_OK);
    double T, p, z = 4321;
    atmosphere_state(&plain, z, &T, &p);
    air before = atmosphere_at(&plain, z), after = atmosphere_at(&other, z);
    CHECK_NEAR("density, scaled and warmer", after.density, 1.1 * before.density * T / (T + 20),
               1e-15);
    CHECK_NEAR("speed of sound, warmer", after.speed_of_sound,
               before.speed_of_sound * sqrt((T + 20) / T), 1e-12);
    assert_true(atmosphere_at(&plain, 86001).density == 0);
    assert_true(atmosphere_at(&plain, 1e7).speed_of_sound > 270);
    model = (ld_atmosphere){
        .kind = LD_ATMOSPHERE_UNIFORM, .density = 1.2, .speed_of_sound = 340, .density_scale = 2};
    assert_int_equal(atmosphere_build(&other, &model, NULL), LD_OK);
    assert_true(atmosphere_at(&other, 1e4).density == 2.4);
    assert_true(atmosphere_at(&other, 1e4).speed_of_sound == 340);
    model.kind = LD_ATMOSPHERE_NONE;
    assert_int_equal(atmosphere_build(&other, &model, NULL), LD_OK);
    assert_true(atmosphere_at(&other, 0).density == 0);
    assert_true(atmosphere_at(&other, 0).speed_of_sound > 0);
}

// ---- measured air

static const double R = 8314.32 / 28.9644, g = 9.80665, radius = 6356766;

static double geopotential(double z)
{
    return radius * z / (radius + z);
}

enum { MOST_ROWS = 400 };

// Air at rest of temperature T_0 + L H over the geopotential height H, from 100 kPa at H = 0.
static double lapse_pressure(double T_0, double L, double z)
{
    double H = geopotential(z);
    return L == 0 ? 1e5 * exp(-g * H / (R * T_0)) : 1e5 * pow(1 + L * H / T_0, -g / (R * L));
}

// The largest relative error of the density between rows of that air, `step` apart to 20 km.
static double lapse_error(double T_0, double L, double step)
{
    static double rows[3 * MOST_ROWS];
    ld_atmosphere model = {.kind = LD_ATMOSPHERE_PROFILE, .density_scale = 1};
    atmosphere self;
    size_t n = 0;
    for (double z = 0; z <= 20000; z += step, n++) {
        rows[3 * n] = z;
        rows[3 * n + 1] = lapse_pressure(T_0, L, z);
        rows[3 * n + 2] = T_0 + L * geopotential(z);
    }
    model.profile = (ld_table){.rows = n, .columns = 3, .data = rows};
    assert_int_equal(atmosphere_build(&self, &model, NULL), LD_OK);
    double worst = 0;
    for (double z = step; z < 20000 - step; z += 13) {
        double rho = lapse_pressure(T_0, L, z) / (R * (T_0 + L * geopotential(z)));
        worst = fmax(worst, fabs(atmosphere_at(&self, z).density / rho - 1));
    }
    atmosphere_free(&self);
    return worst;
}

static void test_closed_forms(void **state)
{
    (void)state;
    CHECK_BELOW("isothermal air, rows 1 km apart", lapse_error(250, 0, 1000), 4e-14);
    CHECK_BELOW("air of one lapse rate, rows 1 km apart", lapse_error(290, -6e-3, 1000), 1.2e-7);
    double coarse = lapse_error(290, -6e-3, 2000), fine = lapse_error(290, -6e-3, 1000);
    CHECK_WITHIN("error by half the distance of the rows", coarse / fine, 12, 16);
}

// us1976 by its rows at multiples of `step` up to `top`.
static atmosphere sampled(const atmosphere *standard, double step, double top, double warmer,
                          double *rows)
{
    ld_atmosphere model = {.kind = LD_ATMOSPHERE_PROFILE, .density_scale = 1};
    atmosphere self;
    size_t n = 0;
    for (double z = 0; z <= top; z += step, n++) {
        rows[3 * n] = z;
        atmosphere_state(standard, z, &rows[3 * n + 2], &rows[3 * n + 1]);
        rows[3 * n + 2] *= warmer;
    }
    model.profile = (ld_table){.rows = n, .columns = 3, .data = rows};
    assert_int_equal(atmosphere_build(&self, &model, NULL), LD_OK);
    return self;
}

static void test_sampled_standard(void **state)
{
    (void)state;
    static double rows[3 * MOST_ROWS];
    const ld_atmosphere model = {.kind = LD_ATMOSPHERE_US1976, .density_scale = 1};
    atmosphere standard;
    assert_int_equal(atmosphere_build(&standard, &model, NULL), LD_OK);
    atmosphere self = sampled(&standard, 250, 30000, 1, rows);
    double low = 0, all = 0, sound = 0;
    for (double z = -4900; z < 85900; z += 17) {
        air here = atmosphere_at(&self, z), there = atmosphere_at(&standard, z);
        double off = fabs(here.density / there.density - 1);
        low = z < 10750 ? fmax(low, off) : low;
        all = fmax(all, off);
        sound = fmax(sound, fabs(here.speed_of_sound / there.speed_of_sound - 1));
    }
    atmosphere_free(&self);
    CHECK_BELOW("us1976 by rows of 250 m, density below 10.7 km", low, 3e-10);
    CHECK_BELOW("at the bends of its temperature, too", all, 1e-3);
    CHECK_BELOW("speed of sound", sound, 5e-4);
    // on the rows themselves
    self = sampled(&standard, 1000, 20000, 1, rows);
    for (double z = 0; z <= 20000; z += 1000) {
        air here = atmosphere_at(&self, z), there = atmosphere_at(&standard, z);
        CHECK_NEAR("density on a row", here.density / there.density, 1, 1e-14);
        CHECK_NEAR("speed of sound on a row", here.speed_of_sound, there.speed_of_sound, 1e-12);
    }
    atmosphere_free(&self);
}

// Beyond its rows the air is us1976 of temperatures scaled, with pressures that carry it: checked
// by what density and speed of sound say alone, p = rho a^2/gamma.
static void test_beyond(void **state)
{
    (void)state;
    static double rows[3 * MOST_ROWS];
    const ld_atmosphere model = {.kind = LD_ATMOSPHERE_US1976, .density_scale = 1};
    atmosphere standard;
    assert_int_equal(atmosphere_build(&standard, &model, NULL), LD_OK);
    atmosphere self = sampled(&standard, 500, 6000, 1.03, rows);
    double hydrostatic = 0, scaled = 0, z, h = 0.5;
    for (z = -4700; z < 85000; z += 61) {
        air low = atmosphere_at(&self, z - h), here = atmosphere_at(&self, z),
            high = atmosphere_at(&self, z + h);
        double p_low = low.density * low.speed_of_sound * low.speed_of_sound / 1.4,
               p_high = high.density * high.speed_of_sound * high.speed_of_sound / 1.4;
        double share = radius / (radius + z);
        double weight = here.density * g * share * share;
        hydrostatic = fmax(hydrostatic, fabs((p_low - p_high) / (2 * h) / weight - 1));
        double ratio = here.speed_of_sound / atmosphere_at(&standard, z).speed_of_sound;
        if (z < -200 || z > 6200)
            scaled = fmax(scaled, fabs(ratio * ratio / 1.03 - 1));
    }
    CHECK_BELOW("temperature beyond the rows, scaled", scaled, 1e-3);
    // the rows' own pressures are those of colder air: between them the gradient carries it no more
    CHECK_WITHIN("pressure gradient against weight", hydrostatic, 0.025, 0.05);
    assert_true(atmosphere_at(&self, 86001).density == 0);
    assert_true(atmosphere_at(&self, 85999).density > 0);
    assert_true(atmosphere_at(&self, 1e7).speed_of_sound > 270);
    CHECK_NEAR("far above, as at the top", atmosphere_at(&self, 1e7).speed_of_sound,
               atmosphere_at(&self, 86000).speed_of_sound, 1e-12);
    atmosphere_free(&self);
}

// A single row is us1976 scaled throughout, with the weight of its own air.
static void test_single_row(void **state)
{
    (void)state;
    double row[] = {1200, 87000, 300};
    ld_atmosphere model = {.kind = LD_ATMOSPHERE_PROFILE,
                           .density_scale = 1,
                           .profile = {.rows = 1, .columns = 3, .data = row}};
    atmosphere self;
    assert_int_equal(atmosphere_build(&self, &model, NULL), LD_OK);
    CHECK_NEAR("density on it", atmosphere_at(&self, 1200).density, 87000 / (R * 300), 1e-14);
    double worst = 0, h = 0.5;
    for (double z = -4900; z < 60000; z += 61) {
        double p[2];
        for (int i = 0; i < 2; i++) {
            air here = atmosphere_at(&self, z + (i ? h : -h));
            p[i] = here.density * here.speed_of_sound * here.speed_of_sound / 1.4;
        }
        double share = radius / (radius + z);
        double weight = atmosphere_at(&self, z).density * g * share * share;
        worst = fmax(worst, fabs((p[0] - p[1]) / (2 * h) / weight - 1));
    }
    CHECK_BELOW("pressure gradient against weight", worst, 1e-3);
    atmosphere_free(&self);
}

// Moist air is the sum of dry air and of vapour, each at its own pressure; that of vapour from
// steam tables (IAPWS, saturation at 0, 20 and 35 deg C).
static void test_humidity(void **state)
{
    (void)state;
    const double celsius[] = {0.01, 20, 35}, saturated[] = {611.66, 2339.3, 5629.0};
    for (int i = 0; i < 3; i++) {
        double T = celsius[i] + 273.15, e = 0.8 * saturated[i];
        double row[] = {0, 1e5, T, 0.8};
        ld_atmosphere model = {.kind = LD_ATMOSPHERE_PROFILE,
                               .density_scale = 1,
                               .profile = {.rows = 1, .columns = 4, .data = row}};
        atmosphere self;
        assert_int_equal(atmosphere_build(&self, &model, NULL), LD_OK);
        double sum = (1e5 - e) / (R * T) + e / (8314.32 / 18.01528 * T);
        CHECK_NEAR("density of moist air", atmosphere_at(&self, 0).density / sum, 1, 5.5e-5);
        atmosphere_free(&self);
    }
}

static void test_profile_scales(void **state)
{
    (void)state;
    double rows[] = {0, 1e5, 290, 1000, 88900, 284};
    ld_atmosphere model = {.kind = LD_ATMOSPHERE_PROFILE,
                           .density_scale = 1,
                           .profile = {.rows = 2, .columns = 3, .data = rows}};
    atmosphere plain, other;
    assert_int_equal(atmosphere_build(&plain, &model, NULL), LD_OK);
    model.density_scale = 1.1;
    model.temperature_offset = 20;
    assert_int_equal(atmosphere_build(&other, &model, NULL), LD_OK);
    air before = atmosphere_at(&plain, 0), after = atmosphere_at(&other, 0);
    CHECK_NEAR("density, scaled and warmer", after.density, 1.1 * before.density * 290 / 310,
               1e-15);
    CHECK_NEAR("speed of sound, warmer", after.speed_of_sound,
               before.speed_of_sound * sqrt(310.0 / 290), 1e-12);
    atmosphere_free(&plain);
    atmosphere_free(&other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_table),        cmocka_unit_test(test_standard),
        cmocka_unit_test(test_hydrostatic),  cmocka_unit_test(test_scales),
        cmocka_unit_test(test_closed_forms), cmocka_unit_test(test_sampled_standard),
        cmocka_unit_test(test_beyond),       cmocka_unit_test(test_single_row),
        cmocka_unit_test(test_humidity),     cmocka_unit_test(test_profile_scales),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
