// US Standard Atmosphere 1976 against its table; uniform air, scales and offsets, no air.
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
    atmosphere_build(&self, &model);
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
    atmosphere_build(&self, &model);
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
    atmosphere_build(&self, &model);
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
    atmosphere_build(&plain, &model);
    model.density_scale = 1.1;
    model.temperature_offset = 20;
    atmosphere_build(&other, &model);
    double T, p, z = 4321;
    atmosphere_state(&plain, z, &T, &p);
    air before = atmosphere_at(&plain, z), after = atmosphere_at(&other, z);
    CHECK_NEAR("density, scaled and warmer", after.density, 1.1 * before.density * T / (T + 20),
               1e-15);
    CHECK_NEAR("speed of sound, warmer", after.speed_of_sound,
               before.speed_of_sound * sqrt((T + 20) / T), 1e-12);
    assert_true(atmosphere_at(&plain, 86001).density == 0);
    assert_true(atmosphere_at(&plain, 1e7).speed_of_sound > 270);
    model = (ld_atmosphere){LD_ATMOSPHERE_UNIFORM, 1.2, 340, 2, 0};
    atmosphere_build(&other, &model);
    assert_true(atmosphere_at(&other, 1e4).density == 2.4);
    assert_true(atmosphere_at(&other, 1e4).speed_of_sound == 340);
    model.kind = LD_ATMOSPHERE_NONE;
    atmosphere_build(&other, &model);
    assert_true(atmosphere_at(&other, 0).density == 0);
    assert_true(atmosphere_at(&other, 0).speed_of_sound > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_table),
        cmocka_unit_test(test_standard),
        cmocka_unit_test(test_hydrostatic),
        cmocka_unit_test(test_scales),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
