// Wind: headings, profile, scale and addition; gusts as half cosines.
#include "support/check.h"

#include "environment/wind.h"

static const double degree = 0.017453292519943295;

static wind wind_of(const ld_wind *model)
{
    wind self;
    assert_int_equal(wind_build(&self, model, NULL), LD_OK);
    return self;
}

static void test_heading(void **state)
{
    (void)state;
    ld_wind model = {
        .present = true, .speed = 5, .heading = 30 * degree, .scale = 2, .add = {0, 0, 1}};
    wind self = wind_of(&model);
    v3 v = wind_at(&self, 0, 1000);
    CHECK_NEAR("forward", v.x, 10 * cos(30 * degree), 1e-15);
    CHECK_NEAR("up", v.y, 0, 0);
    CHECK_NEAR("to the right", v.z, 10 * sin(30 * degree) + 1, 1e-15);
    assert_true(isinf(wind_next_corner(&self, 0)));
    wind_free(&self);
}

static void test_profile(void **state)
{
    (void)state;
    double rows[] = {0, 1, 0, 100, 3, -2, 1000, 9, -8};
    ld_wind model = {.present = true, .scale = 0.5, .add = {1, 0, 0}, .profile = {3, 3, rows}};
    wind self = wind_of(&model);
    v3 low = wind_at(&self, 0, -50), middle = wind_at(&self, 0, 100), high = wind_at(&self, 0, 2e4);
    CHECK_NEAR("below the table", low.x, 1.5, 1e-15);
    CHECK_NEAR("on a row, along x", middle.x, 2.5, 1e-15);
    CHECK_NEAR("on a row, along z", middle.z, -1, 1e-15);
    CHECK_NEAR("above the table", high.z, -4, 1e-15);
    wind_free(&self);
}

// Half a cosine up from 1 to 3 s, constant to 4 s, half a cosine down to 8 s.
static void test_gust(void **state)
{
    (void)state;
    ld_wind model = {.present = true, .scale = 1, .gust_count = 1};
    model.gust[0] = (ld_gust){1, 2, 1, 4, 10, 90 * degree};
    wind self = wind_of(&model);
    const double t[] = {0.5, 1.5, 2, 3.5, 6, 7, 9};
    const double share[] = {0, (1 - sqrt(0.5)) / 2, 0.5, 1, 0.5, (1 - sqrt(0.5)) / 2, 0};
    for (int i = 0; i < 7; i++)
        CHECK_NEAR("gust to the right", wind_at(&self, t[i], 0).z, 10 * share[i], 3e-15);
    CHECK_NEAR("first corner", wind_next_corner(&self, -9), 1, 0);
    CHECK_NEAR("after the rise", wind_next_corner(&self, 3), 4, 0);
    CHECK_NEAR("last corner", wind_next_corner(&self, 4), 8, 0);
    assert_true(isinf(wind_next_corner(&self, 8)));
    model.gust[0].fall = NAN;
    self = wind_of(&model);
    CHECK_NEAR("fall as rise", wind_at(&self, 5, 0).z, 5, 1e-14);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_heading),
        cmocka_unit_test(test_profile),
        cmocka_unit_test(test_gust),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
