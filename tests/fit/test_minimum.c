// Least squares of a fit where the answer is known: a linear model in closed form, bounds, profiles
// of a curve, several minima, launches that are not there.
#include "support/check.h"

#include <stdlib.h>

#include "base/random.h"
#include "fit/minimum.h"
#include "math/functions.h"

enum { KEYS = 4, ROWS = 12 };

// ---- a linear model

// Rows A p - y, each over its deviation.
typedef struct linear_model {
    double A[ROWS][KEYS], y[ROWS];
    double mean[KEYS], deviation[KEYS]; // priors
    int computed;
} linear_model;

static double draw(int i, int j)
{
    return 2 * random_uniform(5, 3, (uint64_t)i, (uint64_t)j, 0) - 1;
}

static ld_status linear_rows(void *self, int count, const double *points, double *residuals,
                             bool *there, ld_error *error)
{
    linear_model *model = self;
    (void)error;
    for (int i = 0; i < count; i++) {
        there[i] = true;
        model->computed++;
        for (int r = 0; r < ROWS; r++) {
            residuals[i * ROWS + r] = -model->y[r];
            for (int k = 0; k < KEYS; k++)
                residuals[i * ROWS + r] += model->A[r][k] * points[i * KEYS + k];
        }
    }
    return LD_OK;
}

static void no_stage(void *self, const char *text, double chi2)
{
    (void)self;
    (void)text;
    (void)chi2;
}

// With its minimum inside the cube; a prior of every second key.
static void make_linear(linear_model *model)
{
    *model = (linear_model){0};
    for (int k = 0; k < KEYS; k++) {
        model->mean[k] = 0.4 + 0.05 * k;
        model->deviation[k] = k % 2 ? INFINITY : 0.02;
    }
    for (int r = 0; r < ROWS; r++) {
        for (int k = 0; k < KEYS; k++) {
            model->A[r][k] = 40 * draw(r, k);
            model->y[r] += model->A[r][k] * (0.35 + 0.1 * k);
        }
        model->y[r] += draw(r, 99);
    }
}

static fit_problem linear_problem(linear_model *model)
{
    return (fit_problem){.keys = KEYS,
                         .residuals = ROWS,
                         .prior_mean = model->mean,
                         .prior_deviation = model->deviation,
                         .evaluate = linear_rows,
                         .stage = no_stage,
                         .self = model};
}

// Inverts a matrix by Gauss and Jordan; for normal equations of a few keys.
static void invert(long double A[KEYS][KEYS], long double inverse[KEYS][KEYS])
{
    for (int i = 0; i < KEYS; i++)
        for (int j = 0; j < KEYS; j++)
            inverse[i][j] = i == j;
    for (int i = 0; i < KEYS; i++) {
        long double pivot = A[i][i];
        for (int j = 0; j < KEYS; j++) {
            A[i][j] /= pivot;
            inverse[i][j] /= pivot;
        }
        for (int r = 0; r < KEYS; r++) {
            long double by = A[r][i];
            for (int j = 0; j < KEYS && r != i; j++) {
                A[r][j] -= by * A[i][j];
                inverse[r][j] -= by * inverse[i][j];
            }
        }
    }
}

// The closed form: covariance (A' A + P)^-1, keys covariance (A' y + P mean).
static void solve_linear(const linear_model *model, long double covariance[KEYS][KEYS],
                         long double p[KEYS])
{
    long double normal[KEYS][KEYS], right[KEYS];
    for (int i = 0; i < KEYS; i++) {
        double deviation = model->deviation[i];
        long double weight = isinf(deviation) ? 0 : 1.0L / ((long double)deviation * deviation);
        right[i] = isinf(deviation) ? 0 : weight * model->mean[i];
        for (int j = 0; j < KEYS; j++)
            normal[i][j] = i == j ? weight : 0;
        for (int r = 0; r < ROWS; r++) {
            right[i] += (long double)model->A[r][i] * model->y[r];
            for (int j = 0; j < KEYS; j++)
                normal[i][j] += (long double)model->A[r][i] * model->A[r][j];
        }
    }
    invert(normal, covariance);
    for (int i = 0; i < KEYS; i++) {
        p[i] = 0;
        for (int j = 0; j < KEYS; j++)
            p[i] += covariance[i][j] * right[j];
    }
}

static const uint64_t streams[KEYS] = {11, 12, 13, 14};

static void test_linear(void **state)
{
    (void)state;
    linear_model model;
    ld_error error;
    fit_minimum minimum;
    long double covariance[KEYS][KEYS], p[KEYS];
    double far = 0, cov = 0, ends = 0, singular = 0;
    const double first[KEYS] = {0.5, 0.5, 0.5, 0.5}, z = 1.96;
    make_linear(&model);
    const fit_problem problem = linear_problem(&model);
    solve_linear(&model, covariance, p);
    assert_int_equal(fit_minimise(&problem, 3, first, 1, streams, &minimum, &error), LD_OK);
    for (int i = 0; i < KEYS; i++) {
        fit_end end[2];
        bool lower;
        double sigma = (double)sqrtl(covariance[i][i]);
        far = fmax(far, fabs((double)(minimum.best.p[i] - p[i])));
        for (int j = 0; j < KEYS; j++)
            cov = fmax(
                cov, fabs((double)(minimum.covariance[i * FIT_MOST_KEYS + j] - covariance[i][j])) /
                         (double)covariance[i][i]);
        assert_int_equal(fit_profile(&problem, &minimum, i, z, end, &lower, &error), LD_OK);
        assert_false(lower || end[0].open || end[1].open);
        ends = fmax(ends, fabs(end[0].p - ((double)p[i] - z * sigma)) / sigma);
        ends = fmax(ends, fabs(end[1].p - ((double)p[i] + z * sigma)) / sigma);
    }
    // A' A v = s^2 v, without the priors
    for (int k = 0; k < KEYS; k++) {
        double s = minimum.singular_value[k], product[ROWS] = {0};
        for (int r = 0; r < ROWS; r++)
            for (int i = 0; i < KEYS; i++)
                product[r] += model.A[r][i] * minimum.direction[k][i];
        for (int i = 0; i < KEYS; i++) {
            double again = -s * s * minimum.direction[k][i];
            for (int r = 0; r < ROWS; r++)
                again += model.A[r][i] * product[r];
            singular = fmax(singular, fabs(again) / (s * s));
        }
        assert_true(k == 0 || s <= minimum.singular_value[k - 1]);
    }
    CHECK_BELOW("linear model, keys", far, 1e-10);
    CHECK_BELOW("covariance, relative", cov, 1e-10);
    CHECK_BELOW("ends of the profiles [deviations]", ends, 5e-4);
    CHECK_BELOW("singular values and directions", singular, 1e-10);
    for (int i = 0; i < minimum.starts; i++)
        CHECK_BELOW("chi2 of a start", minimum.start[i].chi2 - minimum.best.chi2, 1e-9);
    fit_minimum_free(&minimum);
}

// ---- a bound

// (3 (p - 1.2), 3 (q - 0.5), p - q)/0.1: with p <= 1 the minimum is at p = 1, q = 5.5/10.
static ld_status bounded_rows(void *self, int count, const double *points, double *residuals,
                              bool *there, ld_error *error)
{
    (void)self;
    (void)error;
    for (int i = 0; i < count; i++) {
        double p = points[2 * i], q = points[2 * i + 1];
        there[i] = true;
        residuals[3 * i] = 3 * (p - 1.2) / 0.1;
        residuals[3 * i + 1] = 3 * (q - 0.5) / 0.1;
        residuals[3 * i + 2] = (p - q) / 0.1;
    }
    return LD_OK;
}

static void test_bound(void **state)
{
    (void)state;
    const double none[KEYS] = {INFINITY, INFINITY}, zero[KEYS] = {0}, first[KEYS] = {0.3, 0.9};
    const fit_problem problem = {.keys = 2,
                                 .residuals = 3,
                                 .prior_mean = zero,
                                 .prior_deviation = none,
                                 .evaluate = bounded_rows,
                                 .stage = no_stage};
    ld_error error;
    fit_minimum minimum;
    fit_end end[2];
    bool lower;
    assert_int_equal(fit_minimise(&problem, 2, first, 1, streams, &minimum, &error), LD_OK);
    assert_true(minimum.at_bound[0] && !minimum.at_bound[1]);
    CHECK_NEAR("key at its bound", minimum.best.p[0], 1, 0);
    CHECK_NEAR("the other", minimum.best.p[1], 0.55, 1e-10);
    CHECK_NEAR("its deviation", sqrt(minimum.covariance[FIT_MOST_KEYS + 1]), 0.1 / sqrt(10), 1e-10);
    assert_true(isnan(minimum.covariance[0]));
    // over q the minimum is (9 (p - 1.2)^2 + 0.9 (p - 0.5)^2)/0.01
    double least = (0.36 + 0.9 * 0.25) / 0.01, b = -(21.6 + 0.9) / 9.9;
    double c = (12.96 + 0.9 * 0.25 - 0.01 * (least + 4)) / 9.9;
    assert_int_equal(fit_profile(&problem, &minimum, 0, 2, end, &lower, &error), LD_OK);
    assert_true(end[1].open && end[1].p == 1 && !end[0].open && !lower);
    CHECK_NEAR("the interval's other end", end[0].p, (-b - sqrt(b * b - 4 * c)) / 2, 1e-4);
    fit_minimum_free(&minimum);
}

// ---- a curve, with two minima

// exp(3 p) against 4 +- 0.5, of which only p > 0.1 has launches; from below 0.1 nothing begins.
static ld_status curve_rows(void *self, int count, const double *points, double *residuals,
                            bool *there, ld_error *error)
{
    (void)self;
    (void)error;
    for (int i = 0; i < count; i++) {
        there[i] = points[i] > 0.1;
        residuals[i] = (exp(3 * points[i]) - 4) / 0.5;
    }
    return LD_OK;
}

static void test_curve(void **state)
{
    (void)state;
    const double none[KEYS] = {INFINITY}, zero[KEYS] = {0}, first[KEYS] = {0.05};
    const fit_problem problem = {.keys = 1,
                                 .residuals = 1,
                                 .prior_mean = zero,
                                 .prior_deviation = none,
                                 .evaluate = curve_rows,
                                 .stage = no_stage};
    ld_error error;
    fit_minimum minimum;
    fit_end end[2];
    bool lower;
    assert_int_equal(fit_minimise(&problem, 1, first, 1, streams, &minimum, &error), LD_ERR_LAUNCH);
    fit_minimum_free(&minimum);
    assert_int_equal(fit_minimise(&problem, 4, first, 1, streams, &minimum, &error), LD_OK);
    assert_true(isnan(minimum.start[0].chi2));
    CHECK_NEAR("the curve's key", minimum.best.p[0], log(4) / 3, 1e-9);
    assert_int_equal(fit_profile(&problem, &minimum, 0, 2, end, &lower, &error), LD_OK);
    CHECK_NEAR("interval, from", end[0].p, log(3) / 3, 1e-4);
    CHECK_NEAR("interval, to", end[1].p, log(5) / 3, 1e-4);
    // 4 +- 2.8: below exp(0.3) there are no launches
    assert_int_equal(fit_profile(&problem, &minimum, 0, 5.6, end, &lower, &error), LD_OK);
    assert_true(end[0].open && !end[1].open);
    CHECK_NEAR("where launches end", end[0].p, 0.1, 1e-3);
    fit_minimum_free(&minimum);
}

// sin(3 pi p) against 1, and p against 1/6 +- 2: two maxima of the sine, the first one lower.
static ld_status wave_rows(void *self, int count, const double *points, double *residuals,
                           bool *there, ld_error *error)
{
    (void)self;
    (void)error;
    for (int i = 0; i < count; i++) {
        there[i] = true;
        residuals[2 * i] = (sin(9.42477796076937971 * points[i]) - 1) / 0.1;
        residuals[2 * i + 1] = (points[i] - 1.0 / 6) / 2;
    }
    return LD_OK;
}

static void test_starts(void **state)
{
    (void)state;
    const double none[KEYS] = {INFINITY}, zero[KEYS] = {0}, first[KEYS] = {0.85};
    const fit_problem problem = {.keys = 1,
                                 .residuals = 2,
                                 .prior_mean = zero,
                                 .prior_deviation = none,
                                 .evaluate = wave_rows,
                                 .stage = no_stage};
    ld_error error;
    fit_minimum one, several;
    assert_int_equal(fit_minimise(&problem, 1, first, 1, streams, &one, &error), LD_OK);
    assert_int_equal(fit_minimise(&problem, 6, first, 1, streams, &several, &error), LD_OK);
    CHECK_NEAR("from one start the minimum nearby", one.best.p[0], 5.0 / 6, 0.02);
    CHECK_NEAR("from six the lowest", several.best.p[0], 1.0 / 6, 1e-6);
    fit_minimum_free(&one);
    fit_minimum_free(&several);
}

// tanh(10 (p - 0.5)): chi2 rises to 1 and no further, so that the data limit the key nowhere.
static ld_status step_rows(void *self, int count, const double *points, double *residuals,
                           bool *there, ld_error *error)
{
    (void)self;
    (void)error;
    for (int i = 0; i < count; i++) {
        there[i] = true;
        residuals[i] = tanh(10 * (points[i] - 0.5));
    }
    return LD_OK;
}

static void test_saturated(void **state)
{
    (void)state;
    const double none[KEYS] = {INFINITY}, zero[KEYS] = {0}, first[KEYS] = {0.45};
    const fit_problem problem = {.keys = 1,
                                 .residuals = 1,
                                 .prior_mean = zero,
                                 .prior_deviation = none,
                                 .evaluate = step_rows,
                                 .stage = no_stage};
    ld_error error;
    fit_minimum minimum;
    fit_end end[2];
    bool lower;
    assert_int_equal(fit_minimise(&problem, 1, first, 1, streams, &minimum, &error), LD_OK);
    CHECK_NEAR("deviation of a key that is not limited", sqrt(minimum.covariance[0]), 0.1, 1e-3);
    assert_int_equal(fit_profile(&problem, &minimum, 0, 1.96, end, &lower, &error), LD_OK);
    assert_true(end[0].open && end[1].open);
    CHECK_NEAR("interval, from", end[0].p, 0, 0);
    CHECK_NEAR("interval, to", end[1].p, 1, 0);
    fit_minimum_free(&minimum);
}

// ---- keys without effect

static ld_status idle_rows(void *self, int count, const double *points, double *residuals,
                           bool *there, ld_error *error)
{
    (void)self;
    (void)error;
    for (int i = 0; i < count; i++) {
        there[i] = true;
        residuals[i] = points[3 * i] + 1e-3 * points[3 * i + 2];
    }
    return LD_OK;
}

static void test_idle(void **state)
{
    (void)state;
    const double p[3] = {0.5, 0.5, 0.5};
    const fit_problem problem = {
        .keys = 3, .residuals = 1, .evaluate = idle_rows, .stage = no_stage};
    bool idle[3];
    ld_error error;
    assert_int_equal(fit_find_idle(&problem, p, idle, &error), LD_OK);
    assert_true(!idle[0] && idle[1] && !idle[2]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_linear),    cmocka_unit_test(test_bound),
        cmocka_unit_test(test_curve),     cmocka_unit_test(test_starts),
        cmocka_unit_test(test_saturated), cmocka_unit_test(test_idle)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
