// Statistics of a linear model y = a + b x_1 + c x_2 of normal factors, whose answers are known,
// and how often they lie inside the intervals stated.
// ctest: slow
#include "support/check.h"

#include <stdlib.h>

#include "base/random.h"
#include "math/curves/distributions.h"
#include "studies/plan/draw.h"
#include "studies/statistics/statistics.h"

enum { REPEATS = 1000, LEVELS = STATISTICS_QUANTILES };
static const double a = 3; // mean

// ---- how often the truth lies inside

typedef struct made_case {
    const char *name;
    int groups, rockets; // of a sample
    int strata;          // of a hypercube, which is a group; 0: random
    double shared, own;  // deviations of what a sample's rockets share, and of what they do not
    double low, high;    // [%] asked
    int none; // [%] of the quantiles at the ends state no interval: at most, or, from 50 on, at
              // least
} made_case;

// The number in (0, 1) of stratum `stratum` after a permutation that belongs to (stream,
// hypercube).
static double stratified(uint64_t stream, uint64_t hypercube, int strata, int stratum)
{
    int64_t place = draw_permuted((uint64_t[]){17, stream}, hypercube, 0, strata, stratum);
    double u = random_uniform(11, stream, hypercube, (uint64_t)stratum, 0);
    return ((double)place + u) / (double)strata;
}

// Values of one repeat; returns how many.
static size_t make_values(const made_case *made, uint64_t repeat, double *value, int64_t *group)
{
    int samples = made->strata ? made->strata : 1;
    size_t count = 0;
    for (int g = 0; g < made->groups; g++)
        for (int i = 0; i < samples; i++)
            for (int j = 0; j < made->rockets; j++) {
                uint64_t k = repeat * (uint64_t)made->groups + (uint64_t)g;
                double u[2] = {random_uniform(11, 3, k, 0, 0),
                               random_uniform(11, 4, k, (uint64_t)j, 0)};
                if (made->strata) {
                    u[0] = stratified(5, k, samples, i);
                    u[1] = stratified(6 + (uint64_t)j, k, samples, i);
                }
                group[count] = g;
                value[count++] =
                    a + made->shared * normal_quantile(u[0]) + made->own * normal_quantile(u[1]);
            }
    return count;
}

static double inside(estimate e, double truth)
{
    return e.low <= truth && truth <= e.high;
}

static void check_coverage(const made_case *made, const char *what, int in, int stated)
{
    char name[96];
    snprintf(name, sizeof name, "%s, %s [%%]", made->name, what);
    CHECK_WITHIN(name, in * 100. / stated, made->low, made->high);
}

static void check_case(const made_case *made)
{
    enum { MOST = 2000 };
    static double value[MOST];
    static int64_t group[MOST];
    int mean = 0, deviation = 0, quantile[LEVELS] = {0}, stated[LEVELS] = {0};
    double sigma = hypot(made->shared, made->own);
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        group_statistics s;
        size_t count = make_values(made, (uint64_t)repeat, value, group);
        assert_int_equal(statistics_of(value, group, count, &s), LD_OK);
        assert_true(s.count == count && (int)s.groups == made->groups);
        mean += inside(s.mean, a);
        deviation += inside(s.deviation, sigma);
        for (int q = 0; q < LEVELS; q++) {
            stated[q] += !isnan(s.quantile[q].low);
            quantile[q] += inside(s.quantile[q], a + sigma * normal_quantile(statistics_level[q]));
        }
    }
    check_coverage(made, "mean", mean, REPEATS);
    check_coverage(made, "deviation", deviation, REPEATS);
    check_coverage(made, "median", quantile[1], stated[1]);
    // the model is symmetric: both ends are one check
    int ends = stated[0] + stated[2];
    if (made->none < 50)
        check_coverage(made, "5 % and 95 %", quantile[0] + quantile[2], ends);
    CHECK_WITHIN("  these are not stated [%]", 100 - ends * 50. / REPEATS,
                 made->none < 50 ? 0 : made->none, made->none < 50 ? made->none : 100);
}

static void test_coverage(void **state)
{
    (void)state;
    static const made_case made[] = {
        {"60 values", 60, 1, 0, 2, 1.5, 93, 97, 100},
        {"200 values", 200, 1, 0, 2, 1.5, 93, 97, 0},
        {"20 groups of 6 that share much", 20, 6, 0, 2, 1.5, 93, 97, 99},
        {"10 of 18 that share much", 10, 18, 0, 2, 1.5, 93, 97, 99},
        {"10 of 18 that share little", 10, 18, 0, 0.5, 2, 93, 97, 30},
        {"100 of 6 that share much", 100, 6, 0, 2, 1.5, 93, 97, 0},
        {"10 hypercubes of 20", 10, 1, 20, 2, 1.5, 93, 97, 0},
        {"10 hypercubes of 20 with 6 rockets", 10, 6, 20, 2, 1.5, 93, 97, 0},
        {"5 hypercubes of 100", 5, 1, 100, 2, 1.5, 93, 97, 0},
        // falls short: so few groups that share much
        {"6 groups of 6 that share much", 6, 6, 0, 2, 1.5, 89, 97, 99},
    };
    for (size_t i = 0; i < sizeof made / sizeof *made; i++)
        check_case(&made[i]);
}

// One interval for all, were the rockets of a sample independent.
static void test_not_by_values(void **state)
{
    (void)state;
    static const made_case made = {"20 groups of 6", 20, 6, 0, 2, 1.5, 0, 0, 0};
    double value[120];
    int64_t group[120];
    int mean = 0;
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        group_statistics s;
        size_t count = make_values(&made, (uint64_t)repeat, value, group);
        for (size_t i = 0; i < count; i++)
            group[i] = (int64_t)i;
        assert_int_equal(statistics_of(value, group, count, &s), LD_OK);
        mean += inside(s.mean, a);
    }
    CHECK_WITHIN("mean, were the rockets independent [%]", mean * 100. / REPEATS, 40, 75);
}

static void test_numbers(void **state)
{
    (void)state;
    double value[] = {9, 1, 4, 1, 16};
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
}

static double apart(estimate e, estimate of, double offset)
{
    return fmax(fabs(e.value - offset - of.value),
                fmax(fabs(e.low - offset - of.low), fabs(e.high - offset - of.high)));
}

// A large offset costs no digits: noise in whole multiples of 2^-20 is added to 1e9 without error.
static void test_offset(void **state)
{
    (void)state;
    enum { COUNT = 300 };
    double near[COUNT], far[COUNT];
    int64_t group[COUNT];
    group_statistics s, t;
    for (int i = 0; i < COUNT; i++) {
        near[i] = rint(normal_quantile(random_uniform(5, 6, (uint64_t)i, 0, 0)) * 0x1p20) * 0x1p-20;
        far[i] = 1e9 + near[i];
        assert_true(far[i] - 1e9 == near[i]);
        group[i] = i / 3;
    }
    assert_int_equal(statistics_of(near, group, COUNT, &s), LD_OK);
    assert_int_equal(statistics_of(far, group, COUNT, &t), LD_OK);
    // a unit in the last place of 1e9 is 1.2e-7
    CHECK_BELOW("mean", t.mean.value - 1e9 - s.mean.value, 6e-8);
    CHECK_BELOW("deviation and interval", apart(t.deviation, s.deviation, 0), 1e-14);
    CHECK_BELOW("skewness", t.skewness - s.skewness, 1e-14);
    for (int q = 0; q < LEVELS; q++)
        CHECK_BELOW("quantile and interval", apart(t.quantile[q], s.quantile[q], 1e9), 1.2e-7);
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

// Semi-axes 3 and `across` of normal values turned by 30 deg, of which `rockets` share half the
// variance.
static void check_ellipse(int groups, int rockets, double across, double low, double high)
{
    enum { MOST = 200 };
    const double turn = 3.14159265358979323846 / 6, truth[2] = {3, across};
    double x[MOST], y[MOST], in[2] = {0}, share = rockets > 1 ? sqrt(0.5) : 0;
    int64_t group[MOST];
    int count = groups * rockets;
    for (uint64_t repeat = 0; repeat < REPEATS; repeat++) {
        for (uint64_t i = 0; i < (uint64_t)count; i++) {
            uint64_t g = i / (uint64_t)rockets;
            double along[2];
            for (uint64_t k = 0; k < 2; k++)
                along[k] =
                    truth[k] * (share * normal_quantile(random_uniform(31, k, repeat, g, 0)) +
                                sqrt(1 - share * share) *
                                    normal_quantile(random_uniform(31, 2 + k, repeat, i, 0)));
            x[i] = 10 + along[0] * cos(turn) - along[1] * sin(turn);
            y[i] = -5 + along[0] * sin(turn) + along[1] * cos(turn);
            group[i] = (int64_t)g;
        }
        covariance_ellipse e;
        estimate axis[2];
        covariance_ellipse_of(x, y, (size_t)count, &e);
        assert_int_equal(covariance_ellipse_intervals(x, y, group, (size_t)count, &e, axis), LD_OK);
        assert_true(fabs(axis[0].value / e.semi_axis[0] - 1) < 1e-12);
        assert_true(fabs(axis[1].value / e.semi_axis[1] - 1) < 1e-12);
        for (int k = 0; k < 2; k++)
            in[k] += inside(axis[k], truth[k]);
    }
    printf("  %d groups of %d, semi-axes 3 and %g\n", groups, rockets, across);
    CHECK_WITHIN("long one inside [%]", in[0] * 100 / REPEATS, low, high);
    CHECK_WITHIN("short one inside [%]", in[1] * 100 / REPEATS, low, high);
}

static void test_coverage_of_ellipses(void **state)
{
    (void)state;
    check_ellipse(60, 1, 1, 93, 97);
    check_ellipse(20, 6, 1, 93, 97);
    // nearly round: the axes follow the values' whims
    check_ellipse(60, 1, 2.7, 91, 98);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_coverage), cmocka_unit_test(test_not_by_values),
        cmocka_unit_test(test_numbers),  cmocka_unit_test(test_offset),
        cmocka_unit_test(test_ellipse),  cmocka_unit_test(test_coverage_of_ellipses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
