// Correlated factors: correlations as the matrix says, distributions as without it, nothing moved.
#include "model/fields/factor.h"
#include "support/check.h"

#include <stdlib.h>

#include "math/curves/distributions.h"
#include "studies/plan/draw.h"

enum { MANY = 40000, FACTORS = 4 };

static const field_row row = {.kind = FIELD_NUMBER, .unit = "m"};
static const field_place place = {.row = &row};
static const char *const path[FACTORS] = {"rocket.mass", "rocket.center.x", "rocket.start_at",
                                          "rocket.motor.thrust_scale"};
static ld_factor factor[FACTORS];
// the third of them is in no group
static ld_correlated group = {
    .count = 3, .factor = {3, 0, 1}, .matrix = {{1, 0.5, -0.3}, {0.5, 1, 0.6}, {-0.3, 0.6, 1}}};

static ld_scatter scatter_of(ld_distribution distribution, bool together)
{
    for (int i = 0; i < FACTORS; i++) {
        factor[i] = (ld_factor){.distribution = distribution,
                                .deviation = 0.5,
                                .within = NAN,
                                .between = {NAN, NAN},
                                .spread = 0.5,
                                .per_rocket = true};
        strcpy(factor[i].path, path[i]);
    }
    return (ld_scatter){.present = true,
                        .seed = 11,
                        .samples = MANY,
                        .replicates = 1,
                        .factor_count = FACTORS,
                        .factor = factor,
                        .correlated_count = together,
                        .correlated = &group};
}

static double value[FACTORS][MANY];

static void draw(const ld_scatter *scatter)
{
    for (int i = 0; i < FACTORS; i++)
        for (int k = 0; k < MANY; k++)
            value[i][k] =
                draw_value(&factor[i], &place, 10, draw_uniform(scatter, &factor[i], k + 1, 2));
}

static double correlation(const double *x, const double *y)
{
    double mean_x = 0, mean_y = 0, xx = 0, xy = 0, yy = 0;
    for (int k = 0; k < MANY; k++) {
        mean_x += x[k] / MANY;
        mean_y += y[k] / MANY;
    }
    for (int k = 0; k < MANY; k++) {
        xx += (x[k] - mean_x) * (x[k] - mean_x);
        xy += (x[k] - mean_x) * (y[k] - mean_y);
        yy += (y[k] - mean_y) * (y[k] - mean_y);
    }
    return xy / sqrt(xx * yy);
}

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// Kolmogorov's distance from the distribution function of the factor, times sqrt n: below 1.95 in
// 99.9 % of all seeds. Sorts x.
static double distance(double *x, double (*cumulative)(double))
{
    double worst = 0;
    qsort(x, MANY, sizeof *x, by_value);
    for (int k = 0; k < MANY; k++) {
        double p = cumulative(x[k]);
        worst = fmax(worst, fmax(p - (double)k / MANY, (k + 1.) / MANY - p));
    }
    return worst * sqrt(MANY);
}

static double normal(double x)
{
    return normal_cumulative((x - 10) / 0.5);
}

static double within_one(double x)
{
    double below = normal_cumulative(-1);
    return (normal(x) - below) / (1 - 2 * below);
}

static double uniform(double x)
{
    return x - 9.5;
}

// Checks the correlations, by Fisher's z in standard deviations of the sample, and the margins.
static void check(const char *what, double (*expected)(double), double (*cumulative)(double))
{
    for (int i = 0; i < group.count; i++)
        for (int k = 0; k < i; k++) {
            double found = correlation(value[group.factor[i]], value[group.factor[k]]);
            double wanted = expected(group.matrix[i][k]);
            printf("  %s %s %s: %.5f, %.5f expected\n", what, path[group.factor[i]],
                   path[group.factor[k]], found, wanted);
            CHECK_BELOW("deviations of the sample", (atanh(found) - atanh(wanted)) * sqrt(MANY - 3),
                        3.3);
        }
    for (int i = 0; i < FACTORS; i++)
        CHECK_BELOW("Kolmogorov's distance", distance(value[i], cumulative), 1.95);
}

static double same(double c)
{
    return c;
}

static void test_normal(void **state)
{
    (void)state;
    ld_scatter scatter = scatter_of(LD_NORMAL, true);
    draw(&scatter);
    double outside = correlation(value[2], value[3]);
    CHECK_BELOW("correlation with a factor outside", outside * sqrt(MANY), 3.3);
    check("normal", same, normal);
}

// Pearson: the correlation of the numbers of a Gaussian copula.
static double of_uniforms(double c)
{
    return 6 / acos(-1) * asin(c / 2);
}

static void test_uniform(void **state)
{
    (void)state;
    ld_scatter scatter = scatter_of(LD_UNIFORM, true);
    draw(&scatter);
    check("uniform", of_uniforms, uniform);
}

static double truncated(double z)
{
    double below = normal_cumulative(-1);
    return normal_quantile(below + normal_cumulative(z) * (1 - 2 * below));
}

// E[t(x) t(y)]/E[t(x)^2] over the normal density of x and y = c x + sqrt(1 - c^2) z.
static double of_truncated(double c)
{
    double xy = 0, xx = 0, step = 0.05;
    for (double x = -8; x <= 8; x += step)
        for (double z = -8; z <= 8; z += step) {
            double t = truncated(x), density = exp(-(x * x + z * z) / 2);
            xy += t * truncated(c * x + sqrt(1 - c * c) * z) * density;
            xx += t * t * density;
        }
    return xy / xx;
}

static void test_truncated(void **state)
{
    (void)state;
    ld_scatter scatter = scatter_of(LD_NORMAL, true);
    for (int i = 0; i < FACTORS; i++)
        factor[i].within = 1;
    draw(&scatter);
    check("truncated", of_truncated, within_one);
}

// What is outside the group, and its first member, is what it was; a hypercube keeps its strata.
static void test_nothing_moves(void **state)
{
    (void)state;
    ld_scatter apart = scatter_of(LD_NORMAL, false), together = scatter_of(LD_NORMAL, true);
    int moved = 0;
    for (int k = 1; k <= 100; k++)
        for (int i = 0; i < FACTORS; i++) {
            double u = draw_uniform(&apart, &factor[i], k, 1);
            bool kept = u == draw_uniform(&together, &factor[i], k, 1);
            assert_true(kept || i < 2);
            moved += !kept;
        }
    assert_int_equal(moved, 200);
    enum { STRATA = 50 };
    int hit[STRATA] = {0};
    together.plan = LD_PLAN_LHS;
    together.samples = STRATA;
    for (int k = 1; k <= STRATA; k++)
        hit[(int)(draw_uniform(&together, &factor[3], k, 0) * STRATA)]++;
    for (int i = 0; i < STRATA; i++)
        assert_int_equal(hit[i], 1);
}

// The factor of a matrix is what its product says, and a matrix that is none is reported.
static void test_factorise(void **state)
{
    (void)state;
    double lower[LD_MAX_CORRELATED][LD_MAX_CORRELATED], worst = 0;
    assert_true(correlated_factorise(&group, lower));
    for (int i = 0; i < group.count; i++)
        for (int k = 0; k <= i; k++) {
            double sum = 0;
            for (int j = 0; j <= k; j++)
                sum += lower[i][j] * lower[k][j];
            worst = fmax(worst, fabs(sum - group.matrix[i][k]));
        }
    CHECK_BELOW("L L' less the matrix", worst, 2e-16);
    // equal correlations c of n numbers: positive definite above c = -1/(n - 1)
    ld_correlated equal = {.count = 5};
    for (int sign = -1; sign <= 1; sign += 2) {
        for (int i = 0; i < 5; i++)
            for (int k = 0; k < 5; k++)
                equal.matrix[i][k] = i == k ? 1 : -0.25 + sign * 1e-6;
        assert_true(correlated_factorise(&equal, lower) == (sign > 0));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_factorise),     cmocka_unit_test(test_normal),
        cmocka_unit_test(test_uniform),       cmocka_unit_test(test_truncated),
        cmocka_unit_test(test_nothing_moves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
