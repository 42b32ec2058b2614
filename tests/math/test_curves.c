// Interpolation: pchip slopes in closed form, shapes kept, polynomials reproduced, ends held.
#include "support/check.h"

#include "math/curves/curves.h"
#include "math/curves/pchip.h"

// Squares at 0, 1, 2, 3: harmonic means 2 s0 s1/(s0 + s1) of the secants 1, 3, 5; ends (3 s0 -
// s1)/2.
static void test_slopes_of_a_parabola(void **state)
{
    (void)state;
    const double x[] = {0, 1, 2, 3}, y[] = {0, 1, 4, 9}, expected[] = {0, 1.5, 3.75, 6};
    double d[4];
    pchip_slopes(4, x, y, d);
    for (int i = 0; i < 4; i++)
        CHECK_NEAR("slope", d[i], expected[i], 1e-15);
}

// Unequal steps 1 and 2 with secants 2 and 1: weights 2 h1 + h0 = 5 and h1 + 2 h0 = 4, so
// 9/(5/2 + 4/1); at the left end (2 h0 + h1) s0 - h0 s1 over h0 + h1 = (8 - 1)/3; at the right one
// (2 h1 + h0) s1 - h1 s0 over the same = (5 - 4)/3.
static void test_unequal_steps(void **state)
{
    (void)state;
    const double x[] = {0, 1, 3}, y[] = {0, 2, 4};
    double d[3];
    pchip_slopes(3, x, y, d);
    CHECK_NEAR("left end", d[0], 7.0 / 3, 1e-15);
    CHECK_NEAR("inside", d[1], 18.0 / 13, 1e-15);
    CHECK_NEAR("right end", d[2], 1.0 / 3, 1e-15);
}

// Turning points are flat; an end's slope of the wrong sign is 0, a too steep one three secants.
static void test_turning_points(void **state)
{
    (void)state;
    const double x[] = {0, 1, 2, 3}, peak[] = {0, 1, 0, 0}, steep[] = {0, 1, 0, 8};
    double d[4];
    pchip_slopes(4, x, peak, d);
    CHECK_NEAR("left of a peak", d[0], 2, 1e-15);
    CHECK_NEAR("peak", d[1], 0, 0);
    CHECK_NEAR("level", d[2], 0, 0);
    CHECK_NEAR("level end", d[3], 0, 0);
    pchip_slopes(4, x, steep, d);
    CHECK_NEAR("left of a peak", d[0], 2, 1e-15);
    const double x2[] = {0, 1, 1.1}, y2[] = {0, 1, -5};
    pchip_slopes(3, x2, y2, d);
    CHECK_NEAR("three secants", d[0], 3, 1e-15);
}

// Between monotone data the interpolant is monotone, at steps of any kind.
static void test_monotone(void **state)
{
    (void)state;
    double data[] = {0, 0, 0.1, 0, 0.2, 1e-3, 1, 0.5, 1.1, 0.501, 3, 10, 3.5, 10, 8, 11};
    curves c;
    assert_int_equal(curves_build(&c, 8, 2, data, CURVE_PCHIP, NULL), LD_OK);
    double before = -1, least = INFINITY, value;
    for (double x = 0; x <= 8; x += 1.0 / 1024) {
        curves_held(&c, x, &value);
        least = fmin(least, value - before);
        before = value;
    }
    CHECK_BELOW("steepest fall", fmin(least, 0), 2e-15);
    curves_free(&c);
}

// The spline reproduces a cubic, the linear table a line; two columns at once.
static void test_polynomials(void **state)
{
    (void)state;
    double data[18], worst = 0, value[2], x0[] = {0, 0.3, 1, 1.1, 2.5, 4};
    for (int i = 0; i < 6; i++) {
        double x = x0[i];
        data[3 * i] = x;
        data[3 * i + 1] = 1 + x * (2 + x * (3 - x));
        data[3 * i + 2] = 2 - 3 * x;
    }
    curves spline, line;
    assert_int_equal(curves_build(&spline, 6, 3, data, CURVE_SPLINE, NULL), LD_OK);
    assert_int_equal(curves_build(&line, 6, 3, data, CURVE_LINEAR, NULL), LD_OK);
    for (double x = 0; x <= 4; x += 0.01) {
        curves_held(&spline, x, value);
        worst = fmax(worst, fabs(value[0] - (1 + x * (2 + x * (3 - x)))));
        worst = fmax(worst, fabs(value[1] - (2 - 3 * x)));
        curves_held(&line, x, value);
        worst = fmax(worst, fabs(value[1] - (2 - 3 * x)));
    }
    CHECK_BELOW("cubic and line", worst, 5e-14);
    curves_held(&spline, -7, value);
    CHECK_NEAR("held before the table", value[0], 1, 0);
    curves_held(&line, 7, value);
    CHECK_NEAR("held after the table", value[1], -10, 1e-14);
    curves_free(&spline);
    curves_free(&line);
}

// One row is a constant; the interval is found from any hint.
static void test_edges(void **state)
{
    (void)state;
    double one[] = {5, 7}, many[] = {0, 0, 1, 1, 2, 4, 3, 9}, value;
    curves c;
    assert_int_equal(curves_build(&c, 1, 2, one, CURVE_PCHIP, NULL), LD_OK);
    for (double x = 0; x < 10; x += 1) {
        curves_held(&c, x, &value);
        assert_true(value == 7);
    }
    curves_free(&c);
    assert_int_equal(curves_build(&c, 4, 2, many, CURVE_PCHIP, NULL), LD_OK);
    for (size_t hint = 0; hint < 6; hint++) {
        assert_int_equal(curves_interval(&c, -1, hint), 0);
        assert_int_equal(curves_interval(&c, 0.5, hint), 0);
        assert_int_equal(curves_interval(&c, 1, hint), 1);
        assert_int_equal(curves_interval(&c, 2.5, hint), 2);
        assert_int_equal(curves_interval(&c, 9, hint), 2);
    }
    curves_free(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_slopes_of_a_parabola), cmocka_unit_test(test_unequal_steps),
        cmocka_unit_test(test_turning_points),       cmocka_unit_test(test_monotone),
        cmocka_unit_test(test_polynomials),          cmocka_unit_test(test_edges),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
