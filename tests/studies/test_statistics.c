// Statistics of a linear model y = a + b x_1 + c x_2 of normal factors, whose answers are known,
// and how often they lie inside the intervals stated.
#include "support/check.h"

#include <stdlib.h>

#include "base/random.h"
#include "math/distributions.h"
#include "studies/statistics.h"

enum { REPEATS = 1000, LEVELS = STATISTICS_QUANTILES };
static const double a = 3, b = 2, c = 1.5; // mean 3, deviation 2.5

static double normal(uint64_t stream, uint64_t i, uint64_t j)
{
    return normal_quantile(random_uniform(11, stream, i, j, 0));
}

static double inside(estimate e, double truth)
{
    return e.low <= truth && truth <= e.high;
}

static void test_coverage(void **state)
{
    (void)state;
    enum { SAMPLES = 60 };
    double mean = 0, deviation = 0, quantile[LEVELS] = {0}, value[SAMPLES];
    int64_t group[SAMPLES];
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        group_statistics s;
        for (int i = 0; i < SAMPLES; i++) {
            uint64_t k = (uint64_t)(repeat * SAMPLES + i);
            value[i] = a + b * normal(1, k, 0) + c * normal(2, k, 0);
            group[i] = i;
        }
        statistics_of(value, group, SAMPLES, &s);
        mean += inside(s.mean, a);
        deviation += inside(s.deviation, 2.5);
        for (int q = 0; q < LEVELS; q++)
            quantile[q] += isnan(s.quantile[q].low) ||
                           inside(s.quantile[q], a + 2.5 * normal_quantile(statistics_level[q]));
    }
    CHECK_WITHIN("mean inside its interval [%]", mean * 100 / REPEATS, 93, 97);
    CHECK_WITHIN("deviation inside its interval [%]", deviation * 100 / REPEATS, 93, 97);
    // order statistics cover at least as much as they say
    CHECK_WITHIN("median inside its interval [%]", quantile[1] * 100 / REPEATS, 94, 98.5);
}

// Rockets of one sample share what is drawn once a sample.
static void test_coverage_of_groups(void **state)
{
    (void)state;
    enum { GROUPS = 20, ROCKETS = 6, COUNT = GROUPS * ROCKETS };
    double mean = 0, naive = 0, deviation = 0, value[COUNT];
    int64_t group[COUNT], single[COUNT];
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        group_statistics s;
        for (int i = 0; i < COUNT; i++) {
            uint64_t k = (uint64_t)(repeat * GROUPS + i / ROCKETS);
            value[i] = a + b * normal(3, k, 0) + c * normal(4, k, (uint64_t)(i % ROCKETS));
            group[i] = i / ROCKETS;
            single[i] = i;
        }
        statistics_of(value, group, COUNT, &s);
        mean += inside(s.mean, a);
        deviation += inside(s.deviation, 2.5);
        assert_true(s.groups == GROUPS && isnan(s.quantile[1].low));
        statistics_of(value, single, COUNT, &s);
        naive += inside(s.mean, a);
    }
    CHECK_WITHIN("mean inside its interval over groups [%]", mean * 100 / REPEATS, 93, 97);
    CHECK_WITHIN("deviation, of 20 groups [%]", deviation * 100 / REPEATS, 90, 97);
    CHECK_WITHIN("mean, were the rockets independent [%]", naive * 100 / REPEATS, 40, 75);
}

static void test_numbers(void **state)
{
    (void)state;
    double value[] = {9, 1, 4, 1, 16}, again[] = {9e-3, 1e-3, 4e-3, 1e-3, 16e-3};
    int64_t group[] = {0, 1, 2, 3, 4};
    group_statistics s;
    statistics_of(value, group, 5, &s);
    CHECK_BELOW("mean", s.mean.value - 6.2, 1e-15);
    CHECK_BELOW("variance", s.deviation.value * s.deviation.value - 162.8 / 4, 1e-14);
    // m_3 = 134.256, m_2 = 32.56 by hand
    CHECK_BELOW("skewness", s.skewness - 134.256 / pow(32.56, 1.5) * sqrt(20.) / 3, 1e-14);
    assert_true(s.least == 1 && s.greatest == 16 && s.quantile[1].value == 4);
    double half = student_quantile(0.975, 4) * s.deviation.value / sqrt(5.);
    CHECK_BELOW("interval of the mean", s.mean.high - 6.2 - half, 1e-14);
    // a large offset costs no digits
    for (int i = 0; i < 5; i++)
        again[i] += 1048576;
    statistics_of(again, group, 5, &s);
    CHECK_BELOW("deviation far from zero, relative", s.deviation.value / sqrt(40.7e-6) - 1, 1e-7);
}

// A square of points turned by 30 deg: variances along its axes by hand.
static void test_ellipse(void **state)
{
    (void)state;
    const double turn = 3.14159265358979323846 / 6;
    double x[4], y[4];
    for (int i = 0; i < 4; i++) {
        double along = i & 1 ? 3 : -3, across = i & 2 ? 1 : -1;
        x[i] = 10 + along * cos(turn) - across * sin(turn);
        y[i] = -5 + along * sin(turn) + across * cos(turn);
    }
    covariance_ellipse e;
    covariance_ellipse_of(x, y, 4, &e);
    CHECK_BELOW("centre", hypot(e.mean[0] - 10, e.mean[1] + 5), 1e-14);
    CHECK_BELOW("long semi-axis", e.semi_axis[0] - 3 * sqrt(4. / 3), 1e-14);
    CHECK_BELOW("short semi-axis", e.semi_axis[1] - sqrt(4. / 3), 1e-14);
    CHECK_BELOW("angle", e.angle - turn, 1e-15);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_coverage),
        cmocka_unit_test(test_coverage_of_groups),
        cmocka_unit_test(test_numbers),
        cmocka_unit_test(test_ellipse),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
