// First-order sensitivities against models whose answers are known, and how often they lie inside
// the intervals stated.
// ctest: slow
#include "support/check.h"

#include "base/random.h"
#include "math/curves/distributions.h"
#include "studies/plan/draw.h"
#include "studies/statistics/sensitivity.h"

enum { REPEATS = 1000, MOST = 2000 };

static double uniform(uint64_t stream, uint64_t repeat, uint64_t sample, uint64_t rocket)
{
    return random_uniform(21, stream, repeat, sample, rocket);
}

// ---- y = 2 x_1 + 1.5 x_2 + rest e, x_1 of the sample, x_2 of the rocket, x_3, x_4 without
// influence

typedef struct linear_case {
    const char *name;
    int samples, rockets;
    int strata; // samples of a hypercube, which is a group; 0: random
    double shared, own, rest;
    double low, high; // [%] asked of x_1 and x_2
    double zero;      // [%] asked of x_3 and x_4, at least
} linear_case;

static double x[4][MOST], y[MOST];
static int64_t number[MOST], group[MOST];

// A number in (0, 1) of sample i, rocket j, in hypercubes or without.
static double drawn(const linear_case *made, uint64_t stream, uint64_t repeat, uint64_t i,
                    uint64_t j)
{
    double u = uniform(stream, repeat, i, j);
    if (!made->strata)
        return u;
    int64_t at = (int64_t)i - 1, strata = made->strata;
    uint64_t key[] = {22, stream}, cube = (uint64_t)(at / strata);
    int64_t stratum = draw_permuted(key, repeat, cube << 8 | j, strata, at % strata);
    return ((double)stratum + u) / (double)strata;
}

static size_t make_linear(const linear_case *made, uint64_t repeat)
{
    size_t count = 0;
    for (uint64_t i = 1; i <= (uint64_t)made->samples; i++)
        for (uint64_t j = 1; j <= (uint64_t)made->rockets; j++, count++) {
            number[count] = (int64_t)i;
            group[count] = made->strata ? ((int64_t)i - 1) / made->strata : (int64_t)i;
            x[0][count] = normal_quantile(drawn(made, 1, repeat, i, 0));
            x[1][count] = normal_quantile(drawn(made, 2, repeat, i, j));
            x[2][count] = drawn(made, 3, repeat, i, 0);
            x[3][count] = normal_quantile(drawn(made, 4, repeat, i, j));
            y[count] = 7 + made->shared * x[0][count] + made->own * x[1][count] +
                       made->rest * normal_quantile(drawn(made, 5, repeat, i, j));
        }
    return count;
}

static void check_linear(const linear_case *made)
{
    static const char *const names[] = {"of the sample", "of the rocket", "sample, inert",
                                        "rocket, inert"};
    double a = made->shared * made->shared, b = made->own * made->own;
    double truth[4] = {a / (a + b + made->rest * made->rest),
                       b / (a + b + made->rest * made->rest)};
    double in[4] = {0}, mean[4] = {0}, width[4] = {0};
    for (uint64_t repeat = 0; repeat < REPEATS; repeat++) {
        size_t count = make_linear(made, repeat);
        for (int k = 0; k < 4; k++) {
            estimate e = sensitivity_of(x[k], y, number, group, count, k % 2);
            in[k] += e.low <= truth[k] && truth[k] <= e.high;
            mean[k] += e.value / REPEATS;
            width[k] += (e.high - e.low) / REPEATS;
        }
    }
    for (int k = 0; k < 4; k++) {
        printf("  %s, %s: S = %.4f, mean estimate %.4f, mean width %.3f\n", made->name, names[k],
               truth[k], mean[k], width[k]);
        CHECK_BELOW("mean estimate - S", mean[k] - truth[k], 0.015);
        CHECK_WITHIN("inside [%]", in[k] * 100 / REPEATS, k < 2 ? made->low : made->zero,
                     k < 2 ? made->high : 100);
    }
}

static void test_linear(void **state)
{
    (void)state;
    static const linear_case made[] = {
        {"60 samples", 60, 1, 0, 2, 1.5, 0, 93, 97, 95},
        {"200 samples", 200, 1, 0, 2, 1.5, 0, 93, 97, 95},
        {"200 samples, noise", 200, 1, 0, 1, 1, 3, 93, 97, 95},
        {"40 samples of 6", 40, 6, 0, 2, 1.5, 0, 93, 97, 95},
        {"10 hypercubes of 20", 200, 1, 20, 2, 1.5, 0, 93, 97, 95},
        {"5 hypercubes of 100, noise", 500, 1, 100, 1, 1, 3, 93, 97, 95},
        // falls short: ten draws of what is sampled once a sample
        {"10 samples of 18", 10, 18, 0, 1, 2, 2, 83, 97, 95},
    };
    for (size_t i = 0; i < sizeof made / sizeof *made; i++)
        check_linear(&made[i]);
}

// ---- Ishigami's function sin x_1 + 7 sin^2 x_2 + 0.1 x_3^4 sin x_1, uniform from -pi to pi

static void test_ishigami(void **state)
{
    (void)state;
    enum { COUNT = 400, TIMES = 200 };
    const double pi = 3.14159265358979323846, a = 7, b = 0.1;
    // variances of E[y | x_1], E[y | x_2] and y in closed form
    double v1 = 0.5 * pow(1 + b * pow(pi, 4) / 5, 2), v2 = a * a / 8;
    double v = v1 + v2 + b * b * pow(pi, 8) * (1. / 18 - 1. / 50);
    double truth[3] = {v1 / v, v2 / v, 0}, in[3] = {0}, mean[3] = {0};
    CHECK_BELOW("S_1 as in the literature", truth[0] - 0.3139, 5e-5);
    CHECK_BELOW("S_2 as in the literature", truth[1] - 0.4424, 5e-5);
    for (uint64_t repeat = 0; repeat < TIMES; repeat++) {
        for (uint64_t i = 0; i < COUNT; i++) {
            for (uint64_t k = 0; k < 3; k++)
                x[k][i] = pi * (2 * uniform(30 + k, repeat, i, 0) - 1);
            y[i] = sin(x[0][i]) + a * pow(sin(x[1][i]), 2) + b * pow(x[2][i], 4) * sin(x[0][i]);
            number[i] = (int64_t)i;
        }
        for (int k = 0; k < 3; k++) {
            estimate e = sensitivity_of(x[k], y, number, number, COUNT, true);
            in[k] += e.low <= truth[k] && truth[k] <= e.high;
            mean[k] += e.value / TIMES;
        }
    }
    CHECK_BELOW("x_1: mean estimate - S", mean[0] - truth[0], 0.01);
    // what a polynomial of degree 6 leaves of a wave and a half
    CHECK_BELOW("x_2: mean estimate - S", mean[1] - truth[1], 0.015);
    CHECK_BELOW("x_3, which acts with x_1 alone: mean estimate", mean[2], 0.01);
    for (int k = 0; k < 3; k++)
        CHECK_WITHIN("inside [%]", in[k] * 100 / TIMES, 91, 99);
}

// ---- few different values; no scatter

static void test_discrete(void **state)
{
    (void)state;
    enum { COUNT = 300 };
    // y is 0, 5, 2 where x is 1, 2, 3, a third of the draws each, and noise of variance 1/12
    for (uint64_t i = 0; i < COUNT; i++) {
        x[0][i] = (double)(1 + i % 3);
        y[i] = (double)("052"[i % 3] - '0') + uniform(40, 0, i, 0);
        x[1][i] = 4;
        number[i] = (int64_t)i;
    }
    double v = (0 + 25 + 4) / 3. - pow(7 / 3., 2);
    estimate e = sensitivity_of(x[0], y, number, number, COUNT, true);
    CHECK_NEAR("three values, of any response", e.value, v / (v + 1. / 12), 0.002);
    CHECK_WITHIN("of a factor that never differs",
                 sensitivity_of(x[1], y, number, number, COUNT, true).value, 0, 0);
    assert_true(isnan(sensitivity_of(y, x[1], number, number, COUNT, true).value));
    assert_true(isnan(sensitivity_of(x[0], y, number, number, 4, true).value));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_linear),
        cmocka_unit_test(test_ishigami),
        cmocka_unit_test(test_discrete),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
