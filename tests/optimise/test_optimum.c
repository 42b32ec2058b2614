// Searches of functions whose least values are known in closed form.
#include "support/check.h"

#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "math/curves/distributions.h"
#include "optimise/optimum.h"

enum { KEYS = 2, MOST = 2000 };

// A function of two keys, of which every evaluation is kept.
typedef struct function {
    double (*value)(const struct function *self, const double *x);
    double (*limit)(const struct function *self, const double *x); // NULL: none
    double center[KEYS], scale[KEYS], sum;
    bool (*is_there)(const double *x); // NULL: everywhere
    int asked, fails_at, most_at_once;
    double seen[MOST];
    int enough_after; // rounds; 0: never
    int rounds;
} function;

static ld_status evaluate(void *user, int count, const double *points, double *values, bool *there,
                          ld_error *error)
{
    function *self = user;
    self->most_at_once = count > self->most_at_once ? count : self->most_at_once;
    for (int i = 0; i < count; i++) {
        const double *x = &points[KEYS * i];
        for (int k = 0; k < KEYS; k++)
            assert_true(x[k] >= 0 && x[k] <= 1);
        assert_in_range(self->asked, 0, MOST - 1);
        there[i] = !self->is_there || self->is_there(x);
        double *row = &values[i * (self->limit ? 2 : 1)];
        row[0] = there[i] ? self->value(self, x) : NAN;
        if (self->limit)
            row[1] = there[i] ? self->limit(self, x) : NAN;
        self->seen[self->asked] = row[0];
        if (++self->asked == self->fails_at)
            return ld_fail(error, LD_ERR_INTERRUPTED, "as asked");
    }
    return LD_OK;
}

static bool is_enough(void *user, int before, int now)
{
    function *self = user;
    assert_true(before >= 0 && now >= before && now < self->asked);
    return ++self->rounds >= self->enough_after;
}

static optimum search(function *of, ld_optimise_method method, double precision, const double *x)
{
    const optimum_problem problem = {.keys = KEYS,
                                     .limits = of->limit ? 1 : 0,
                                     .method = method,
                                     .evaluations = MOST - KEYS,
                                     .precision = precision,
                                     .self = of,
                                     .evaluate = evaluate,
                                     .is_enough = of->enough_after ? is_enough : NULL};
    optimum found;
    ld_error error;
    of->asked = of->most_at_once = 0;
    assert_int_equal(optimum_search(&problem, x, 0, &found, &error), LD_OK);
    assert_int_equal(found.evaluations, of->asked);
    return found;
}

// ---- a quadratic under a linear constraint

static double quadratic(const function *self, const double *x)
{
    double dx = (x[0] - self->center[0]) * self->scale[0];
    double dy = (x[1] - self->center[1]) * self->scale[1];
    return 3 + dx * dx + 2 * dy * dy;
}

static double sum_limit(const function *self, const double *x)
{
    return x[0] + x[1] - self->sum;
}

// Least of (x - a)^2 + 2 (y - b)^2 where x + y <= s < a + b: with the multiplier m, 2 (x - a) = -m
// = 4 (y - b), so x = a - 2/3 (a + b - s), y = b - 1/3 (a + b - s).
static const double a = 0.6, b = 0.7, s = 0.7;
#define KKT_X (a - 2.0 / 3 * (a + b - s))
#define KKT_Y (b - 1.0 / 3 * (a + b - s))

static void at_a_constraint(void **state)
{
    (void)state;
    static const struct {
        ld_optimise_method method;
        double precision, bound;
    } cases[] = {{LD_OPTIMISE_COBYLA, 1e-9, 1e-6},
                 {LD_OPTIMISE_SLSQP, 1e-6, 1e-5},
                 {LD_OPTIMISE_CCSA, 1e-6, 1e-4}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        static const double start[KEYS] = {0.1, 0.2}, broken[KEYS] = {0.9, 0.9};
        function of = {
            .value = quadratic, .limit = sum_limit, .center = {a, b}, .scale = {1, 1}, .sum = s};
        optimum found = search(&of, cases[i].method, cases[i].precision, start);
        char text[64];
        snprintf(text, sizeof text, "%s: x", optimum_method_of(cases[i].method)->name);
        CHECK_BELOW(text, found.best.x[0] - KKT_X, cases[i].bound);
        snprintf(text, sizeof text, "%s: y", optimum_method_of(cases[i].method)->name);
        CHECK_BELOW(text, found.best.x[1] - KKT_Y, cases[i].bound);
        assert_true(found.best.x[0] + found.best.x[1] <= s); // it holds, not nearly
        assert_int_equal(found.end, OPTIMUM_PRECISE);
        found = search(&of, cases[i].method, cases[i].precision, broken);
        CHECK_BELOW("from where it is broken", found.best.x[0] - KKT_X, cases[i].bound);
    }
}

// Where no point holds, the one that breaks the constraint least.
static void nowhere_allowed(void **state)
{
    (void)state;
    static const double start[KEYS] = {0.5, 0.5};
    function of = {
        .value = quadratic, .limit = sum_limit, .center = {a, b}, .scale = {1, 1}, .sum = -0.5};
    optimum found = search(&of, LD_OPTIMISE_COBYLA, 1e-6, start);
    CHECK_BELOW("x + y", found.best.x[0] + found.best.x[1], 1e-6);
    CHECK_BELOW("worst", found.best.worst - 0.5, 1e-6);
}

// ---- without constraints

static double rosenbrock(const function *self, const double *x)
{
    double p = 4 * x[0] - 2, q = 4 * x[1] - 2; // -2 to 2, least at 1, 1
    (void)self;
    return (1 - p) * (1 - p) + 100 * (q - p * p) * (q - p * p);
}

static void a_curved_valley(void **state)
{
    (void)state;
    static const struct {
        ld_optimise_method method;
        double precision, bound;
    } cases[] = {{LD_OPTIMISE_BOBYQA, 1e-7, 1e-5},
                 {LD_OPTIMISE_SBPLX, 1e-7, 1e-4},
                 {LD_OPTIMISE_SLSQP, 1e-6, 1e-3},
                 {LD_OPTIMISE_CRS, 1e-6, 1e-4}};
    static const double start[KEYS] = {0.2, 0.75}; // p = -1.2, q = 1
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        function of = {.value = rosenbrock};
        optimum found = search(&of, cases[i].method, cases[i].precision, start);
        char text[64];
        snprintf(text, sizeof text, "Rosenbrock by %s", optimum_method_of(cases[i].method)->name);
        CHECK_BELOW(text, fmax(fabs(found.best.x[0] - 0.75), fabs(found.best.x[1] - 0.75)),
                    cases[i].bound);
    }
}

// Global methods leave a valley that is not the lowest: two wells, the lower one far from the
// start.
static double two_wells(const function *self, const double *x)
{
    double near = hypot(x[0] - 0.2, x[1] - 0.2), far = hypot(x[0] - 0.8, x[1] - 0.7);
    (void)self;
    return fmin(near * near, far * far - 0.05);
}

static void the_lower_of_two_wells(void **state)
{
    (void)state;
    static const double start[KEYS] = {0.15, 0.25};
    static const ld_optimise_method global[] = {LD_OPTIMISE_DIRECT, LD_OPTIMISE_CRS,
                                                LD_OPTIMISE_ISRES};
    for (size_t i = 0; i < 3; i++) {
        function of = {.value = two_wells};
        optimum found = search(&of, global[i], 1e-4, start);
        CHECK_BELOW(optimum_method_of(global[i])->name, found.best.x[0] - 0.8, 1e-2);
    }
    function of = {.value = two_wells};
    optimum found = search(&of, LD_OPTIMISE_COBYLA, 1e-6, start);
    CHECK_BELOW("local: COBYLA", found.best.x[0] - 0.2, 1e-3);
}

// One key is 10000 times as steep as the other.
static void unequal_scales(void **state)
{
    (void)state;
    static const double start[KEYS] = {0.9, 0.1};
    function of = {.value = quadratic, .center = {0.3, 0.8}, .scale = {100, 0.01}};
    optimum found = search(&of, LD_OPTIMISE_BOBYQA, 1e-8, start);
    CHECK_BELOW("steep key", found.best.x[0] - 0.3, 1e-6);
    CHECK_BELOW("flat key", found.best.x[1] - 0.8, 1e-2);
}

// ---- noise that is the same for all candidates

enum { SAMPLES = 50 };

static double noisy(const function *self, const double *x)
{
    double sum = 0;
    for (int i = 0; i < SAMPLES; i++) {
        double u = normal_quantile(random_uniform(1, 1, (uint64_t)i, 0, 0));
        double v = normal_quantile(random_uniform(1, 2, (uint64_t)i, 0, 0));
        double dx = x[0] - self->center[0] - 0.2 * u, dy = x[1] - self->center[1] - 0.2 * v;
        sum += dx * dx + dy * dy;
    }
    return sum / SAMPLES;
}

// The mean of the same samples is a quadratic about the mean of the noise.
static void common_numbers(void **state)
{
    (void)state;
    static const double start[KEYS] = {0.9, 0.9};
    function of = {.value = noisy, .center = {0.4, 0.5}};
    double mean[KEYS] = {0.4, 0.5};
    for (int i = 0; i < SAMPLES; i++)
        for (int k = 0; k < KEYS; k++)
            mean[k] += 0.2 / SAMPLES *
                       normal_quantile(random_uniform(1, (uint64_t)k + 1, (uint64_t)i, 0, 0));
    optimum found = search(&of, LD_OPTIMISE_BOBYQA, 1e-9, start);
    CHECK_BELOW("x of the least sample mean", found.best.x[0] - mean[0], 1e-7);
    CHECK_BELOW("y of the least sample mean", found.best.x[1] - mean[1], 1e-7);
}

// ---- holes, and what ends a search

static bool is_left(const double *x)
{
    return x[0] < 0.55;
}

// Beyond 0.55 nothing can be evaluated: the best is at that edge.
static void holes(void **state)
{
    (void)state;
    static const double start[KEYS] = {0.2, 0.2}, outside[KEYS] = {0.9, 0.2};
    function of = {.value = quadratic, .center = {0.8, 0.4}, .scale = {1, 1}, .is_there = is_left};
    optimum found = search(&of, LD_OPTIMISE_COBYLA, 1e-6, start);
    CHECK_BELOW("edge", found.best.x[0] - 0.55, 1e-2);
    found = search(&of, LD_OPTIMISE_COBYLA, 1e-6, outside);
    assert_int_equal(found.end, OPTIMUM_NOWHERE);
    assert_int_equal(found.best.number, -1);
    assert_int_equal(found.evaluations, 1);
}

// The same points as those before: a search that is repeated finds what was kept.
static void the_same_again(void **state)
{
    (void)state;
    static const double start[KEYS] = {0.1, 0.2};
    function one = {.value = rosenbrock}, other = {.value = rosenbrock};
    for (int method = LD_OPTIMISE_COBYLA; method <= LD_OPTIMISE_ISRES; method++) {
        memset(one.seen, 0, sizeof one.seen);
        memset(other.seen, 0, sizeof other.seen);
        search(&one, (ld_optimise_method)method, 1e-3, start);
        search(&other, (ld_optimise_method)method, 1e-3, start);
        assert_int_equal(one.asked, other.asked);
        assert_memory_equal(one.seen, other.seen, sizeof one.seen);
    }
}

static void it_ends_when_told(void **state)
{
    (void)state;
    static const double start[KEYS] = {0.1, 0.2};
    function of = {.value = rosenbrock, .fails_at = 7};
    optimum_problem problem = {.keys = KEYS,
                               .method = LD_OPTIMISE_SLSQP,
                               .evaluations = 10,
                               .precision = 1e-9,
                               .self = &of,
                               .evaluate = evaluate};
    optimum found;
    ld_error error;
    assert_int_equal(optimum_search(&problem, start, 0, &found, &error), LD_ERR_INTERRUPTED);
    assert_int_equal(of.asked, 7);
    assert_int_equal(of.most_at_once, KEYS); // differences side by side
    of.fails_at = of.asked = 0;
    assert_int_equal(optimum_search(&problem, start, 0, &found, &error), LD_OK);
    assert_int_equal(found.end, OPTIMUM_EVALUATIONS);
    assert_in_range(of.asked, 10, 10 + KEYS);
    function noise = {.value = rosenbrock, .enough_after = 2};
    found = search(&noise, LD_OPTIMISE_COBYLA, 1e-9, start);
    assert_int_equal(found.end, OPTIMUM_NOISE);
    assert_int_equal(noise.rounds, 2);
    assert_in_range(noise.asked, 24, 36); // the second of two rounds of 4 x 3, after the first best
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(at_a_constraint),
        cmocka_unit_test(nowhere_allowed),
        cmocka_unit_test(a_curved_valley),
        cmocka_unit_test(the_lower_of_two_wells),
        cmocka_unit_test(unequal_scales),
        cmocka_unit_test(common_numbers),
        cmocka_unit_test(holes),
        cmocka_unit_test(the_same_again),
        cmocka_unit_test(it_ends_when_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
