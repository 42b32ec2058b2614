// The elementary functions that lanes share, against those of long double.
#define LANES 1
#include "math/real_sine_cosine.h"

#include <float.h>
#include <stdlib.h>

#include "support/check.h"

// Of v from exact, in units of its last place.
static double units(long double exact, double v)
{
    int exponent;
    frexp(v, &exponent);
    return (double)(fabsl(exact - v) / ldexpl(1, exponent - DBL_MANT_DIG));
}

static double uniform(double from, double to)
{
    static unsigned short seed[3] = {1, 2, 3};
    return from + (to - from) * erand48(seed);
}

static void test_exp(void **state)
{
    double worst = 0;
    for (int i = 0; i < 20000; i++) {
        double x = i % 2 ? uniform(-4, 4) : uniform(-690, 690);
        worst = fmax(worst, units(expl(x), real_exp((real_pair){x, 0})));
    }
    CHECK_NEAR("exp, units in the last place", worst, 0, 0.7);
    (void)state;
}

static void test_log(void **state)
{
    double worst = 0;
    for (int i = 0; i < 20000; i++) {
        double x = i % 2 ? uniform(0.5, 2) : exp(uniform(-690, 690));
        worst = fmax(worst, units(logl(x), real_log(x)));
    }
    CHECK_NEAR("log, units in the last place", worst, 0, 0.9);
    assert_true(real_log(1) == 0);
    (void)state;
}

// The powers of the standard atmosphere, and any.
static void test_power(void **state)
{
    double worst = 0, of_air = 0;
    for (int i = 0; i < 20000; i++) {
        double b = uniform(180, 300), a = b * uniform(0.67, 1.5), y = uniform(-35, 35);
        const double exponent = 5.2558797;
        worst = fmax(worst, units(powl((long double)a / b, y), real_exp(real_log_power(a, b, y))));
        of_air = fmax(of_air, units(powl((long double)a / b, exponent),
                                    real_exp(real_log_power(a, b, exponent))));
    }
    CHECK_NEAR("power 5.26, units in the last place", of_air, 0, 0.8);
    CHECK_NEAR("powers to 35, units in the last place", worst, 0, 2);
    (void)state;
}

static void test_sine_cosine(void **state)
{
    double of_sine = 0, of_cosine = 0, s, c;
    for (int i = 0; i < 20000; i++) {
        double x = i % 2 ? uniform(-7, 7) : uniform(-5e5, 5e5);
        real_sine_cosine(x, &s, &c);
        of_sine = fmax(of_sine, units(sinl(x), s));
        of_cosine = fmax(of_cosine, units(cosl(x), c));
    }
    CHECK_NEAR("sine, units in the last place", of_sine, 0, 0.8);
    CHECK_NEAR("cosine, units in the last place", of_cosine, 0, 0.8);
    real_sine_cosine(1e9, &s, &c);
    assert_true(s == sin(1e9) && c == cos(1e9));
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_exp), cmocka_unit_test(test_log),
                                       cmocka_unit_test(test_power),
                                       cmocka_unit_test(test_sine_cosine)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
