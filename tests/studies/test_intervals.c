// Numbers of statistics and sensitivities against their definitions, written out a second time:
// each group left out by recomputing from the values that stay. (How often the truth lies inside
// the intervals: test_statistics.c, test_sensitivity.c.)
#include "support/check.h"

#include "base/random.h"
#include "math/curves/distributions.h"
#include "studies/statistics/sensitivity.h"
#include "studies/statistics/statistics.h"

enum { MOST = 200 };

static double value[MOST], other[MOST];
static int64_t group[MOST], number[MOST];

// Uneven groups of values that share a part.
static size_t make_values(int groups)
{
    size_t count = 0;
    for (int g = 0; g < groups; g++)
        for (int i = 0; i < 2 + g % 3; i++) {
            uint64_t k = count;
            group[count] = g;
            number[count] = (int64_t)count;
            value[count] = 5 + normal_quantile(random_uniform(1, 2, (uint64_t)g, 0, 0)) +
                           normal_quantile(random_uniform(3, 4, k, 0, 0));
            other[count++] = normal_quantile(random_uniform(5, 6, k, 0, 0));
        }
    return count;
}

// Of all values but those of group `without` (-1: none).
static double mean_without(const double *x, size_t count, int64_t without)
{
    double sum = 0, n = 0;
    for (size_t i = 0; i < count; i++)
        if (group[i] != without) {
            sum += x[i];
            n++;
        }
    return sum / n;
}

// Mean of the products of the differences from the means, over n - 1 where `unbiased`.
static double moment_without(const double *x, const double *y, size_t count, int64_t without)
{
    double mx = mean_without(x, count, without), my = mean_without(y, count, without);
    double sum = 0, n = 0;
    for (size_t i = 0; i < count; i++)
        if (group[i] != without) {
            sum += (x[i] - mx) * (y[i] - my);
            n++;
        }
    return sum / (n - 1);
}

// Jackknife of the logarithm of the variance over the groups: the variance of g values left out in
// turn, times (g - 1)^2/g (Efron and Tibshirani, section 11.5, of the mean of their squares).
static double jackknife(size_t count, int groups)
{
    double log_of[MOST], mean = 0, squares = 0, g = groups;
    for (int k = 0; k < groups; k++) {
        log_of[k] = log(moment_without(value, value, count, k));
        mean += log_of[k] / g;
    }
    for (int k = 0; k < groups; k++)
        squares += (log_of[k] - mean) * (log_of[k] - mean);
    return sqrt((g - 1) / g * squares);
}

// So few groups that the quantiles are Student's.
static void test_deviation(void **state)
{
    (void)state;
    for (int groups = 3; groups < 8; groups += 2) {
        group_statistics s;
        size_t count = make_values(groups);
        assert_int_equal(statistics_of(value, group, count, &s), LD_OK);
        double deviation = sqrt(moment_without(value, value, count, -1));
        double half = 0.5 * student_quantile(0.975, groups - 1) * jackknife(count, groups);
        printf("  %d groups\n", groups);
        CHECK_BELOW("deviation", s.deviation.value / deviation - 1, 1e-14);
        CHECK_BELOW("its lower end", s.deviation.low / (deviation * exp(-half)) - 1, 1e-13);
        CHECK_BELOW("its upper end", s.deviation.high / (deviation * exp(half)) - 1, 1e-13);
    }
}

// Of a ratio of sums over groups of random size: g/(g - 1) sum (S_k - n_k mean)^2 over n^2.
static void test_mean(void **state)
{
    (void)state;
    enum { GROUPS = 6 };
    group_statistics s;
    size_t count = make_values(GROUPS);
    double mean = mean_without(value, count, -1), squares = 0, g = GROUPS, n = (double)count;
    for (int k = 0; k < GROUPS; k++) {
        double of = 0;
        for (size_t i = 0; i < count; i++)
            of += group[i] == k ? value[i] - mean : 0;
        squares += of * of;
    }
    double half = student_quantile(0.975, g - 1) * sqrt(g / (g - 1) * squares) / n;
    assert_int_equal(statistics_of(value, group, count, &s), LD_OK);
    CHECK_BELOW("mean", s.mean.value - mean, 1e-15);
    CHECK_BELOW("half its interval", (s.mean.high - s.mean.low) / 2 - half, 1e-14);
}

// G_1 = m_3/m_2^1.5 sqrt(n (n - 1))/(n - 2).
static void test_skewness(void **state)
{
    (void)state;
    group_statistics s;
    size_t count = make_values(6);
    double n = (double)count, mean = mean_without(value, count, -1), second = 0, third = 0;
    for (size_t i = 0; i < count; i++) {
        second += pow(value[i] - mean, 2) / n;
        third += pow(value[i] - mean, 3) / n;
    }
    assert_int_equal(statistics_of(value, group, count, &s), LD_OK);
    CHECK_BELOW("skewness", s.skewness - third / pow(second, 1.5) * sqrt(n * (n - 1)) / (n - 2),
                1e-14);
}

// Along its axes the values do not vary together, along the first more than along the second.
static void test_ellipse(void **state)
{
    (void)state;
    covariance_ellipse e;
    size_t count = make_values(20);
    double x[MOST], y[MOST], along[MOST], across[MOST];
    for (int turn = 0; turn < 4; turn++) {
        for (size_t i = 0; i < count; i++) {
            x[i] = 3 * value[i] * cos(turn) - other[i] * sin(turn);
            y[i] = 3 * value[i] * sin(turn) + other[i] * cos(turn);
        }
        covariance_ellipse_of(x, y, count, &e);
        for (size_t i = 0; i < count; i++) {
            along[i] = x[i] * cos(e.angle) + y[i] * sin(e.angle);
            across[i] = y[i] * cos(e.angle) - x[i] * sin(e.angle);
        }
        printf("  turned by %d rad\n", turn);
        CHECK_BELOW("covariance along its axes", moment_without(along, across, count, -1), 1e-13);
        CHECK_BELOW("long semi-axis",
                    e.semi_axis[0] - sqrt(moment_without(along, along, count, -1)), 1e-13);
        CHECK_BELOW("short semi-axis",
                    e.semi_axis[1] - sqrt(moment_without(across, across, count, -1)), 1e-13);
        assert_true(e.semi_axis[0] > e.semi_axis[1]);
    }
}

// A factor of two values, as often one as the other, every sample a group: S is the adjusted
// coefficient of determination 1 - (1 - R^2) (n - 1)/(n - 2), in closed form.
static void test_sensitivity_of_two_values(void **state)
{
    (void)state;
    for (size_t count = 6; count <= 60; count += 18) {
        double x[MOST], y[MOST], n = (double)count, side[2] = {0}, mean = 0, all = 0, rest = 0;
        for (size_t i = 0; i < count; i++) {
            x[i] = i % 2 ? 3 : 1;
            number[i] = (int64_t)i;
            y[i] = x[i] + normal_quantile(random_uniform(7, 8, i, count, 0));
            side[i % 2] += 2 * y[i] / n;
            mean += y[i] / n;
        }
        for (size_t i = 0; i < count; i++) {
            all += pow(y[i] - mean, 2);
            rest += pow(y[i] - side[i % 2], 2);
        }
        estimate e = sensitivity_of(x, y, number, number, count, false);
        printf("  %zu samples\n", count);
        CHECK_BELOW("adjusted R^2", e.value - (1 - rest / all * (n - 1) / (n - 2)), 1e-13);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_deviation),
        cmocka_unit_test(test_mean),
        cmocka_unit_test(test_skewness),
        cmocka_unit_test(test_ellipse),
        cmocka_unit_test(test_sensitivity_of_two_values),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
