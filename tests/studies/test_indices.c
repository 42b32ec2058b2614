// Sobol's indices and Morris's effects against functions whose answers are known: the estimates
// from the study's own plans, and how often the answers lie inside the intervals stated. ctest:
// slow
#include "support/check.h"

#include <stdlib.h>

#include "math/curves/distributions.h"
#include "studies/plan/draw.h"
#include "studies/statistics/indices.h"

enum { MOST_FACTORS = 8, MOST_ROWS = 1024, REPEATS = 2000 };

static const double pi = 3.14159265358979324;

// ---- functions of numbers in (0, 1)

typedef struct known_function {
    const char *name;
    int factors;
    double (*of)(const double *u);
    double first[MOST_FACTORS], total[MOST_FACTORS];
} known_function;

// T. Ishigami and T. Homma, 1990: a = 7, b = 0.1.
static double ishigami(const double *u)
{
    double x[3];
    for (int i = 0; i < 3; i++)
        x[i] = pi * (2 * u[i] - 1);
    return sin(x[0]) + 7 * sin(x[1]) * sin(x[1]) + 0.1 * pow(x[2], 4) * sin(x[0]);
}

static known_function make_ishigami(void)
{
    double one = 0.5 * pow(1 + 0.1 * pow(pi, 4) / 5, 2), two = 49. / 8;
    double both = 0.01 * pow(pi, 8) * (1. / 18 - 1. / 50), all = one + two + both;
    return (known_function){"Ishigami",
                            3,
                            ishigami,
                            {one / all, two / all, 0},
                            {(one + both) / all, two / all, both / all}};
}

// I. M. Sobol's g function with these a_i.
static const double g_a[] = {0, 1, 4.5, 9, 99, 99, 99, 99};

static double sobol_g(const double *u)
{
    double product = 1;
    for (int i = 0; i < 8; i++)
        product *= (fabs(4 * u[i] - 2) + g_a[i]) / (1 + g_a[i]);
    return product;
}

static known_function make_g(void)
{
    known_function f = {.name = "Sobol's g", .factors = 8, .of = sobol_g};
    double all = 1, part[8];
    for (int i = 0; i < 8; i++) {
        part[i] = 1 / (3 * (1 + g_a[i]) * (1 + g_a[i]));
        all *= 1 + part[i];
    }
    for (int i = 0; i < 8; i++) {
        f.first[i] = part[i] / (all - 1);
        f.total[i] = part[i] * all / (1 + part[i]) / (all - 1);
    }
    return f;
}

// Of normal numbers with unequal deviations; two of five factors do nothing.
static const double slope[] = {4, 2, 1, 0, 0}, deviation[] = {1, 3, 0.5, 1, 1};

static double linear(const double *u)
{
    double sum = 1e6; // from which the variance must not suffer
    for (int i = 0; i < 5; i++)
        sum += slope[i] * deviation[i] * normal_quantile(u[i]);
    return sum;
}

static known_function make_linear(void)
{
    known_function f = {.name = "linear", .factors = 5, .of = linear};
    double all = 0;
    for (int i = 0; i < 5; i++)
        all += pow(slope[i] * deviation[i], 2);
    for (int i = 0; i < 5; i++)
        f.first[i] = f.total[i] = pow(slope[i] * deviation[i], 2) / all;
    return f;
}

// ---- runs of a plan

static ld_factor factor[MOST_FACTORS];

static ld_scatter make_scatter(ld_plan plan, int factors, int samples, int replicates)
{
    for (int i = 0; i < factors; i++) {
        factor[i] = (ld_factor){.distribution = LD_UNIFORM};
        snprintf(factor[i].path, sizeof factor[i].path, "x%d", i + 1);
    }
    return (ld_scatter){.present = true,
                        .seed = 1,
                        .samples = samples,
                        .plan = plan,
                        .replicates = replicates,
                        .factor_count = factors,
                        .factor = factor};
}

static double result_of(const known_function *f, const ld_scatter *scatter, int64_t run)
{
    double u[MOST_FACTORS];
    for (int i = 0; i < f->factors; i++)
        u[i] = draw_uniform(scatter, &factor[i], run, 0);
    return f->of(u);
}

static double y[MOST_FACTORS + 2][MOST_ROWS];
static int64_t group[MOST_ROWS];

static void run_rows(const known_function *f, const ld_scatter *scatter)
{
    const int row = plan_row(scatter);
    for (int i = 0; i < scatter->samples; i++) {
        group[i] = (int64_t)i * row / plan_strata(scatter);
        for (int column = 0; column < row; column++)
            y[column][i] = result_of(f, scatter, (int64_t)i * row + column + 1);
    }
}

// ---- Saltelli's plan

enum { FIRST, TOTAL, TOGETHER, INDICES };
static const char *const names[] = {"first", "total", "total less first"};

typedef struct tally {
    double in[INDICES], mean[INDICES], width[INDICES];
} tally;

static void take(tally *self, int which, estimate e, double truth)
{
    const double slack = 1e-12; // intervals of what does nothing have no width
    self->in[which] += e.low - slack <= truth && truth <= e.high + slack;
    self->mean[which] += e.value;
    self->width[which] += e.high - e.low;
}

static void print_tally(const known_function *f, int i, const tally *self, int repeats)
{
    const double truth[] = {f->first[i], f->total[i], f->total[i] - f->first[i]};
    for (int k = 0; k < INDICES; k++) {
        char what[80];
        snprintf(what, sizeof what, "%s, x%d, %s: off by", f->name, i + 1, names[k]);
        // three standard errors, and the bias of a ratio
        double width = self->width[k] / repeats;
        CHECK_BELOW(what, self->mean[k] / repeats - truth[k],
                    3 * width / 3.92 / sqrt(repeats) + 0.1 * width + 1e-12);
        snprintf(what, sizeof what, "    inside the interval, +- %.4f [%%]", width / 2);
        if (width > 1e-9)
            CHECK_WITHIN(what, 100 * self->in[k] / repeats, 93, 97);
        else
            CHECK_WITHIN(what, 100 * self->in[k] / repeats, 100, 100);
    }
}

static void check_indices(const known_function *f, int samples, int replicates)
{
    const int repeats = OF_ALL(REPEATS, 20);
    tally of[MOST_FACTORS] = {0};
    ld_scatter scatter = make_scatter(LD_PLAN_SALTELLI, f->factors, samples, replicates);
    printf("  %s, %d rows%s\n", f->name, samples, replicates > 1 ? " of scrambled points" : "");
    for (scatter.seed = 1; scatter.seed <= repeats; scatter.seed++) {
        run_rows(f, &scatter);
        for (int i = 0; i < f->factors; i++) {
            variance_indices found;
            const frozen_values values = {y[0], y[1], y[i + 2], group, NULL, (size_t)samples};
            assert_int_equal(variance_indices_of(&values, &found), LD_OK);
            take(&of[i], FIRST, found.first, f->first[i]);
            take(&of[i], TOTAL, found.total, f->total[i]);
            take(&of[i], TOGETHER, found.together, f->total[i] - f->first[i]);
        }
    }
    for (int i = 0; i < f->factors && repeats == REPEATS; i++)
        print_tally(f, i, &of[i], repeats);
}

static void test_random(void **state)
{
    (void)state;
    const known_function all[] = {make_ishigami(), make_g(), make_linear()};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        check_indices(&all[i], 1024, 1);
}

static void test_points(void **state)
{
    (void)state;
    const known_function all[] = {make_ishigami(), make_g(), make_linear()};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        check_indices(&all[i], 1024, 16);
}

// Rockets of a salvo, each with a mean of its own, have one index: that of their values less it.
static void test_parts(void **state)
{
    (void)state;
    enum { ROWS = 400, ROCKETS = 3 };
    static double value[3][2][ROWS * ROCKETS];
    static int part[ROWS * ROCKETS];
    static int64_t of_row[ROWS * ROCKETS];
    const known_function f = make_linear();
    const ld_scatter scatter = make_scatter(LD_PLAN_SALTELLI, f.factors, ROWS, 1);
    const int column[] = {0, 1, 3};
    run_rows(&f, &scatter);
    for (size_t i = 0; i < ROWS * ROCKETS; i++) {
        part[i] = (int)(i % ROCKETS) + 1;
        of_row[i] = (int64_t)i / ROCKETS;
        for (int k = 0; k < 3; k++) {
            value[k][0][i] = y[column[k]][i / ROCKETS];
            value[k][1][i] = value[k][0][i] + 1000. * part[i];
        }
    }
    variance_indices one, found[2];
    const frozen_values once = {y[0], y[1], y[3], group, NULL, ROWS};
    assert_int_equal(variance_indices_of(&once, &one), LD_OK);
    for (int k = 0; k < 2; k++) {
        const frozen_values all = {value[0][k], value[1][k],     value[2][k],
                                   of_row,      k ? part : NULL, ROWS * ROCKETS};
        assert_int_equal(variance_indices_of(&all, &found[k]), LD_OK);
        CHECK_NEAR("rockets alike: first", found[k].first.value, one.first.value, 1e-9);
        CHECK_NEAR("rockets alike: its lower end", found[k].first.low, one.first.low, 1e-9);
        CHECK_NEAR("rockets alike: total", found[k].total.value, one.total.value, 1e-9);
    }
    assert_int_equal(one.groups, ROWS);
    assert_int_equal(found[1].groups, ROWS);
    assert_int_equal(found[1].count, ROWS * ROCKETS);
}

static void test_without_answer(void **state)
{
    (void)state;
    const double same[] = {2, 2, 2, 2}, other[] = {1, 2, 3, 5};
    const int64_t groups[] = {1, 2, 3, 4};
    variance_indices found;
    assert_int_equal(
        variance_indices_of(&(frozen_values){same, same, same, groups, NULL, 4}, &found), LD_OK);
    assert_true(isnan(found.first.value) && isnan(found.total.low));
    assert_int_equal(
        variance_indices_of(&(frozen_values){other, other, other, groups, NULL, 2}, &found), LD_OK);
    assert_true(isnan(found.total.value));
    elementary_effects none;
    assert_int_equal(elementary_effects_of(NULL, NULL, 0, &none), LD_OK);
    assert_true(isnan(none.magnitude.value));
    assert_int_equal(none.count, 0);
}

// ---- Morris's plan

enum { LEVELS = 4, TRAJECTORIES = 60 };

static double level_of(int64_t code, int i)
{
    return 0.05 + 0.3 * (double)((code >> 2 * i) % LEVELS);
}

// mu*, mu and sigma over all starts; how far the magnitudes scatter.
static void find_effects(const known_function *f, int of, double truth[4])
{
    const int64_t starts = (int64_t)1 << 2 * f->factors;
    double sum = 0, magnitude = 0, squares = 0;
    for (int64_t code = 0; code < starts; code++) {
        double u[MOST_FACTORS], before, after, way;
        for (int i = 0; i < f->factors; i++)
            u[i] = level_of(code, i);
        before = f->of(u);
        way = u[of] < 0.5 ? 0.6 : -0.6;
        u[of] += way;
        after = f->of(u);
        double effect = (after - before) / way;
        sum += effect, magnitude += fabs(effect), squares += effect * effect;
    }
    double n = (double)starts;
    truth[0] = magnitude / n;
    truth[1] = sum / n;
    truth[2] = sqrt(fmax(0, squares / n - truth[1] * truth[1]));
    truth[3] = sqrt(fmax(0, squares / n - truth[0] * truth[0]));
}

// Effects of factor `of` in all trajectories, as the study's values have them.
static void take_effects(const known_function *f, const ld_scatter *scatter, int of, double *effect)
{
    for (int i = 0; i < scatter->samples; i++) {
        int turn = draw_turn(scatter->seed, f->factors, i + 1, of), row = plan_row(scatter);
        int64_t run = (int64_t)i * row + turn + 1;
        double way = draw_uniform(scatter, &factor[of], run + 1, 0) -
                     draw_uniform(scatter, &factor[of], run, 0);
        assert_true(fabs(way - draw_step(scatter->seed, factor[of].path, i + 1)) < 1e-15);
        assert_true(fabs(fabs(way) - 0.6) < 1e-15);
        for (int k = 0; k < f->factors; k++)
            if (k != of)
                assert_true(draw_uniform(scatter, &factor[k], run, 0) ==
                            draw_uniform(scatter, &factor[k], run + 1, 0));
        effect[i] = (y[turn + 1][i] - y[turn][i]) / way;
    }
}

typedef struct effect_tally {
    double in[2], mean[3], truth[4];
} effect_tally;

static void take_found(const elementary_effects *found, int repeats, effect_tally *of)
{
    const estimate both[] = {found->magnitude, found->mean};
    for (int k = 0; k < 2; k++) {
        of->in[k] += both[k].low - 1e-9 <= of->truth[k] && of->truth[k] <= both[k].high + 1e-9;
        of->mean[k] += both[k].value / repeats;
    }
    of->mean[2] += found->deviation / repeats;
}

static void print_effects(const known_function *f, int i, const effect_tally *of, int repeats)
{
    static const char *const kinds[] = {"mu*", "mu", "sigma"};
    for (int k = 0; k < 3; k++) {
        char what[80];
        snprintf(what, sizeof what, "%s, x%d, %s", f->name, i + 1, kinds[k]);
        CHECK_NEAR(what, of->mean[k], of->truth[k], 0.01 * of->truth[0] + 1e-6);
        if (k < 2 && of->truth[k == 0 ? 3 : 2] > 1e-6)
            CHECK_WITHIN("    inside the interval [%]", 100 * of->in[k] / repeats, 93, 97);
    }
}

static void check_effects(const known_function *f)
{
    const int repeats = OF_ALL(REPEATS, 20);
    effect_tally of[MOST_FACTORS] = {0};
    ld_scatter scatter = make_scatter(LD_PLAN_MORRIS, f->factors, TRAJECTORIES, 1);
    for (int i = 0; i < f->factors; i++)
        find_effects(f, i, of[i].truth);
    for (scatter.seed = 1; scatter.seed <= repeats; scatter.seed++) {
        run_rows(f, &scatter);
        for (int i = 0; i < f->factors; i++) {
            double effect[TRAJECTORIES];
            elementary_effects found;
            take_effects(f, &scatter, i, effect);
            assert_int_equal(elementary_effects_of(effect, group, TRAJECTORIES, &found), LD_OK);
            take_found(&found, repeats, &of[i]);
        }
    }
    for (int i = 0; i < f->factors && repeats == REPEATS; i++)
        print_effects(f, i, &of[i], repeats);
}

static void test_effects(void **state)
{
    (void)state;
    const known_function all[] = {make_ishigami(), make_g(), make_linear()};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        check_effects(&all[i]);
    // a normal factor moves by half of its probability
    double truth[4], way = normal_quantile(0.65) - normal_quantile(0.05);
    const known_function linear_one = make_linear();
    find_effects(&linear_one, 1, truth);
    CHECK_NEAR("slope 2, deviation 3: mu*", truth[0], 2 * 3 * way / 0.6, 1e-8);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random),  cmocka_unit_test(test_points),
        cmocka_unit_test(test_parts),   cmocka_unit_test(test_without_answer),
        cmocka_unit_test(test_effects),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
