// Dryden turbulence: scales of MIL-F-8785C, harmonics against their definition, what the key
// decides.
#include "environment/turbulence.h"

#include "base/random.h"
#include "support/check.h"

#define PI_LONG 3.14159265358979323846264338327950288L

static turbulence build(int seed, int rocket, int harmonics)
{
    turbulence self;
    ld_turbulence model = {.present = true, .wind_at_6m = 7, .seed = seed, .harmonics = harmonics};
    assert_int_equal(turbulence_build(&self, &model, rocket, NULL), LD_OK);
    return self;
}

// Power between two kappa by Simpson's rule, in long double.
static long double power(int j, long double from, long double to)
{
    enum { PIECES = 2000 };
    long double sum = 0, h = (to - from) / PIECES;
    for (int i = 0; i <= PIECES; i++) {
        long double k2 = powl(from + i * h, 2);
        long double density =
            j == 0 ? 2 / (PI_LONG * (1 + k2)) : (1 + 3 * k2) / (PI_LONG * (1 + k2) * (1 + k2));
        sum += (i == 0 || i == PIECES ? 1 : i % 2 ? 4 : 2) * density;
    }
    return sum * h / 3;
}

static double defined(int seed, int rocket, int harmonics, int j, double xi)
{
    long double sum = 0;
    for (int i = 0; i < harmonics; i++) {
        long double from = 0.01L * powl(1e4L, (long double)i / harmonics),
                    to = 0.01L * powl(1e4L, (long double)(i + 1) / harmonics);
        long double u = random_uniform((uint64_t)seed, random_stream("turbulence.kappa"),
                                       (uint64_t)rocket, (uint64_t)j, (uint64_t)i);
        long double v = random_uniform((uint64_t)seed, random_stream("turbulence.phase"),
                                       (uint64_t)rocket, (uint64_t)j, (uint64_t)i);
        sum +=
            sqrtl(2 * power(j, from, to)) * cosl(from * powl(to / from, u) * xi + 2 * PI_LONG * v);
    }
    return (double)sum;
}

static void test_definition(void **state)
{
    (void)state;
    static const int harmonics[] = {100, 7};
    for (int n = 0; n < 2; n++) {
        turbulence self = build(11, 3, harmonics[n]);
        turbulence_scales unit = {1, 1, 1, 1};
        double error = 0;
        for (int k = 0; k < 50; k++) {
            double xi = -20 + 1.7 * k, eta = 3 + 0.9 * k;
            v3 v = turbulence_velocity(&self, &unit, xi, eta);
            error = fmax(error, fabs(v.x - defined(11, 3, harmonics[n], 0, xi)));
            error = fmax(error, fabs(v.z - defined(11, 3, harmonics[n], 1, xi)));
            error = fmax(error, fabs(v.y - defined(11, 3, harmonics[n], 2, eta)));
        }
        turbulence_free(&self);
        CHECK_BELOW("x, y, z against the definition", error, 2e-12);
    }
}

static void test_spectra_have_unit_variance(void **state)
{
    (void)state;
    turbulence self = build(1, 0, 100);
    for (int j = 0; j < TURBULENCE_COMPONENTS; j++) {
        double sum = 0;
        for (int i = 0; i < self.harmonics; i++)
            sum += self.a[j * self.harmonics + i] * self.a[j * self.harmonics + i] / 2;
        // what lies beyond 0.01 and 100: (2/pi)(0.01 + 0.01), (1/pi)(0.01 + 3/100)
        CHECK_NEAR("variance of a component", sum, 1 - (j == 0 ? 0.04 : 0.04) / acos(-1), 2e-6);
    }
    turbulence_free(&self);
}

// Figures of MIL-F-8785C in feet.
static void test_scales(void **state)
{
    (void)state;
    const double foot = 0.3048;
    turbulence self = build(1, 0, 10);
    turbulence_scales low = turbulence_scales_at(&self, 0),
                      ten = turbulence_scales_at(&self, 10 * foot),
                      at_500 = turbulence_scales_at(&self, 500 * foot),
                      below = turbulence_scales_at(&self, 1000 * foot * (1 - 1e-12)),
                      above = turbulence_scales_at(&self, 1000 * foot * (1 + 1e-12)),
                      at_1500 = turbulence_scales_at(&self, 1500 * foot),
                      high = turbulence_scales_at(&self, 9000);
    assert_memory_equal(&low, &ten, sizeof low);
    CHECK_NEAR("L_w at 10 ft [ft]", ten.L_w / foot, 10, 1e-12);
    CHECK_NEAR("L_u at 500 ft [ft]", at_500.L_u / foot, 500 / pow(0.5885, 1.2), 1e-9);
    CHECK_NEAR("sigma_u at 500 ft over 0.1 W_20", at_500.sigma_u / 0.7, pow(0.5885, -0.4), 1e-12);
    CHECK_NEAR("sigma_w", at_500.sigma_w, 0.7, 1e-15);
    CHECK_NEAR("L_u across 1000 ft", below.L_u - above.L_u, 0, 1e-8);
    CHECK_NEAR("sigma_u across 1000 ft", below.sigma_u - above.sigma_u, 0, 1e-12);
    CHECK_NEAR("L at 1500 ft [ft]", at_1500.L_w / foot, 1375, 1e-9);
    CHECK_NEAR("L high up [ft]", high.L_u / foot, 1750, 1e-9);
    CHECK_NEAR("sigma high up", high.sigma_u, 0.7, 1e-15);
    turbulence_free(&self);
}

static double distance(turbulence a, turbulence b)
{
    turbulence_scales unit = {1, 1, 1, 1};
    double sum = 0;
    for (int i = 0; i < 100; i++) {
        v3 d = v3_sub(turbulence_velocity(&a, &unit, i, i), turbulence_velocity(&b, &unit, i, i));
        sum += v3_dot(d, d) / 600;
    }
    turbulence_free(&a);
    turbulence_free(&b);
    return sqrt(sum);
}

static void test_key(void **state)
{
    (void)state;
    assert_true(distance(build(5, 2, 100), build(5, 2, 100)) == 0);
    CHECK_WITHIN("another seed: difference over sqrt 2 sigma",
                 distance(build(5, 2, 100), build(6, 2, 100)), 0.8, 1.2);
    CHECK_WITHIN("another rocket", distance(build(5, 2, 100), build(5, 3, 100)), 0.8, 1.2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_definition),
        cmocka_unit_test(test_spectra_have_unit_variance),
        cmocka_unit_test(test_scales),
        cmocka_unit_test(test_key),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
