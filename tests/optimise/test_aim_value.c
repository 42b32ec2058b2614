// Statistics of candidates, and how often their intervals contain the truth.
#include "support/check.h"

#include <stdlib.h>

#include "base/random.h"
#include "math/curves/distributions.h"
#include "optimise/aim_value.h"

enum { MOST = 400 };
static const double pi = 3.14159265358979323846;

static double normal(int repeat, int sample, int number)
{
    return normal_quantile(
        random_uniform(5, (uint64_t)repeat, (uint64_t)sample, (uint64_t)number, 0));
}

// Two results of one rocket: deviations 1 and 2, correlation 0.6.
static void draw(int repeat, int samples, double *value)
{
    for (int i = 0; i < samples; i++) {
        double x = normal(repeat, i, 0), y = normal(repeat, i, 1);
        value[2 * i] = x;
        value[2 * i + 1] = 2 * (0.6 * x + 0.8 * y);
    }
}

static ld_estimate estimate_of(const aim_plan *plan, int samples, const double *value,
                               const double *from)
{
    static double work[MOST];
    const aim_samples of = {samples, 1, 2, value}, other = {samples, 1, 2, from};
    return aim_estimate(plan, &of, from ? &other : NULL, aim_blocks_of(plan, samples, 0), work);
}

// The jackknife of a mean is Student's interval: values 1, 2, 4, 9 have mean 4, deviation
// sqrt(38/3), t of 3 degrees of freedom 3.182446305284263.
static void a_mean(void **state)
{
    (void)state;
    static const double value[] = {1, 0, 2, 0, 4, 0, 9, 0};
    const aim_plan plan = {LD_AIM_MEAN, 0, 0, -1};
    const ld_estimate found = estimate_of(&plan, 4, value, NULL);
    CHECK_BELOW("mean", found.value - 4, 1e-14);
    CHECK_BELOW("half of its interval", found.high - 4 - 3.182446305284263 * sqrt(38.0 / 3 / 4),
                1e-9);
    CHECK_BELOW("the lower end as far", found.high + found.low - 8, 1e-12);
}

// Of two rockets a sample: means over all, the greatest of each sample, both variances.
static void several_rockets(void **state)
{
    (void)state;
    static const double value[] = {1, 10, 5, 20, 2, 30, 3, 50}; // [2][2][2]
    double work[4];
    const aim_samples of = {2, 2, 2, value};
    const aim_plan mean = {LD_AIM_MEAN, 0, 1, -1}, greatest = {LD_AIM_GREATEST, 0, 0, -1};
    const aim_plan both = {LD_AIM_DEVIATION, 0, 0, 1}, middle = {LD_AIM_QUANTILE, 0.5, 1, -1};
    const aim_blocks blocks = {2, false};
    assert_true(aim_value(&mean, &of, blocks, -1, work) == 27.5);
    assert_true(aim_value(&mean, &of, blocks, 0, work) == 40);
    assert_true(aim_value(&mean, &of, blocks, 1, work) == 15);
    assert_true(aim_value(&greatest, &of, blocks, -1, work) == 4);
    assert_true(aim_value(&greatest, &of, blocks, 1, work) == 5);
    assert_true(aim_value(&middle, &of, blocks, -1, work) == 25);
    CHECK_BELOW("root of both variances",
                aim_value(&both, &of, blocks, -1, work) - sqrt(8.75 / 3 + 875.0 / 3), 1e-13);
}

static void a_footprint(void **state)
{
    (void)state;
    static double value[2 * MOST];
    double sum = 0;
    enum { REPEATS = 200 };
    const aim_plan plan = {LD_AIM_FOOTPRINT, 0, 0, 1};
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        draw(repeat, MOST, value);
        sum += estimate_of(&plan, MOST, value, NULL).value / REPEATS;
    }
    // 95 % of a normal distribution: pi r^2 sqrt(det C), r^2 = -2 ln 0.05
    double area = pi * -2 * log(0.05) * 1 * 2 * 0.8;
    CHECK_BELOW("area with 95 % of normal landings (relative)", sum / area - 1, 5e-3);
}

// [%] of 1000 repeats.
static double coverage(const aim_plan *plan, int samples, double truth, bool paired)
{
    enum { REPEATS = 1000 };
    static double value[2 * MOST], other[2 * MOST];
    int inside = 0;
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        draw(repeat, samples, value);
        for (int i = 0; paired && i < 2 * samples; i++)
            other[i] = 0.8 * value[i] + 0.1 * normal(repeat, i, 2);
        const ld_estimate found =
            estimate_of(plan, samples, paired ? other : value, paired ? value : NULL);
        inside += found.low <= truth && truth <= found.high;
    }
    return 100.0 * inside / REPEATS;
}

static void intervals_contain_the_truth(void **state)
{
    (void)state;
    const aim_plan deviation = {LD_AIM_DEVIATION, 0, 0, 1},
                   quantile = {LD_AIM_QUANTILE, 0.9, 0, -1},
                   footprint = {LD_AIM_FOOTPRINT, 0, 0, 1};
    const struct {
        const char *name;
        const aim_plan *plan;
        int samples;
        double truth;
        bool paired;
        double most; // [%]
    } cases[] = {
        {"deviation of two results, 40 samples", &deviation, 40, sqrt(5), false, 97},
        {"its difference, paired", &deviation, 40, sqrt(0.64 * 5 + 0.02) - sqrt(5), true, 97},
        {"quantile, 200 samples", &quantile, 200, 1.2815515655446004, false, 97},
        {"its difference, paired", &quantile, 200, 1.2815515655446004 * (sqrt(0.65) - 1), true,
         99.5},
        {"area of the footprint, 100 samples", &footprint, 100, pi * -2 * log(0.05) * 1.6, false,
         97},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double share = coverage(cases[i].plan, cases[i].samples, cases[i].truth, cases[i].paired);
        CHECK_WITHIN(cases[i].name, share, 92, cases[i].most);
    }
}

static void no_interval(void **state)
{
    (void)state;
    static double value[2 * MOST];
    const aim_plan mean = {LD_AIM_MEAN, 0, 0, -1}, quantile = {LD_AIM_QUANTILE, 0.9, 0, -1};
    draw(0, 19, value);
    assert_true(isnan(estimate_of(&quantile, 19, value, NULL).low));
    assert_true(isnan(estimate_of(&mean, 1, value, NULL).low));
    assert_true(aim_blocks_of(&quantile, 100, 0).halves);
    assert_int_equal(aim_blocks_of(&mean, 100, 0).count, 100);
    assert_int_equal(aim_blocks_of(&mean, 100, 4).count, 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_mean),      cmocka_unit_test(several_rockets),
        cmocka_unit_test(a_footprint), cmocka_unit_test(intervals_contain_the_truth),
        cmocka_unit_test(no_interval),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
