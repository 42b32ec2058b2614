// Sampled values: their distributions, hypercubes, and that none depends on what else is sampled.
#include "model/fields/factor.h"
#include "model/model.h"
#include "support/check.h"

#include <stdlib.h>

#include "base/random.h"
#include "math/curves/distributions.h"
#include "scenario/scenario.h"
#include "studies/plan/draw.h"
#include "studies/plan/sample.h"

static const field_row row = {.kind = FIELD_NUMBER, .unit = "m", .range = {0, 999, 0, 0}};
static const field_place place = {.row = &row};

static ld_factor factor_named(const char *path, ld_distribution distribution)
{
    ld_factor factor = {.distribution = distribution,
                        .deviation = 0.5,
                        .within = NAN,
                        .between = {NAN, NAN},
                        .spread = NAN};
    snprintf(factor.path, sizeof factor.path, "%s", path);
    return factor;
}

// Largest difference between the values' distribution function and the expected one, times sqrt n:
// below 1.95 in 99.9 % of all seeds (Kolmogorov).
static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double distance(double *u, int n)
{
    double worst = 0;
    qsort(u, (size_t)n, sizeof *u, by_value);
    for (int i = 0; i < n; i++)
        worst = fmax(worst, fmax(u[i] - (double)i / n, (i + 1.) / n - u[i]));
    return worst * sqrt(n);
}

enum { MANY = 20000 };

static void test_uniform_numbers(void **state)
{
    (void)state;
    ld_scatter scatter = {.seed = 7, .samples = MANY, .replicates = 1};
    ld_factor a = factor_named("rocket.mass", LD_NORMAL),
              b = factor_named("base.azimuth", LD_NORMAL);
    static double u[MANY];
    double product[3] = {0};
    for (int k = 0; k < MANY; k++) {
        u[k] = draw_uniform(&scatter, &a, k + 1, 1);
        double x = u[k] - 0.5;
        product[0] += x * (draw_uniform(&scatter, &b, k + 1, 1) - 0.5);
        product[1] += x * (draw_uniform(&scatter, &a, k + 1, 2) - 0.5);
        product[2] += x * (draw_uniform(&scatter, &a, k + 2, 1) - 0.5);
    }
    CHECK_BELOW("Kolmogorov's distance", distance(u, MANY), 1.95);
    const char *const what[] = {"correlation of factors", "of rockets", "of samples"};
    for (int i = 0; i < 3; i++)
        CHECK_BELOW(what[i], product[i] * 12 / sqrt(MANY), 3.3);
}

static void test_distributions(void **state)
{
    (void)state;
    ld_factor normal = factor_named("a", LD_NORMAL), uniform = factor_named("a", LD_UNIFORM);
    double z = normal_quantile(0.3);
    CHECK_BELOW("normal", draw_value(&normal, &place, 10, 0.3) - (10 + 0.5 * z), 1e-15);
    normal.within = 1;
    double p = normal_cumulative(-1) + 0.3 * (1 - 2 * normal_cumulative(-1));
    CHECK_BELOW("kept within",
                normal_cumulative((draw_value(&normal, &place, 10, 0.3) - 10) / 0.5) - p, 1e-15);
    CHECK_BELOW("its end", draw_value(&normal, &place, 10, 1 - 0x1p-53) - 10.5, 1e-14);
    // far out in the upper tail, where 1 - Phi is 1e-23
    normal.within = NAN;
    normal.between[0] = 15, normal.between[1] = 16;
    double far = (draw_value(&normal, &place, 10, 0.5) - 10) / 0.5;
    double tail = normal_cumulative(-10) + normal_cumulative(-12);
    CHECK_BELOW("median between 10 and 12 deviations", normal_cumulative(-far) / (tail / 2) - 1,
                2e-13);
    uniform.spread = 0.25;
    CHECK_BELOW("uniform about", draw_value(&uniform, &place, 10, 0.1) - 9.8, 1e-14);
    uniform.between[0] = 2, uniform.between[1] = 4;
    CHECK_BELOW("uniform between", draw_value(&uniform, &place, 10, 0.1) - 2.2, 1e-15);
    ld_factor lognormal = factor_named("a", LD_LOGNORMAL);
    CHECK_BELOW("lognormal", draw_value(&lognormal, &place, 10, 0.3) - 10 * exp(0.5 * z), 1e-14);
    assert_true(draw_value(&lognormal, &place, 10, 0.5) == 10);
    ld_factor discrete = factor_named("a", LD_DISCRETE);
    discrete.value_count = 3;
    for (int i = 0; i < 3; i++)
        discrete.value[i] = i + 5, discrete.weight[i] = (double[]){1, 0, 3}[i];
    assert_true(draw_value(&discrete, &place, 10, 0.2499) == 5);
    assert_true(draw_value(&discrete, &place, 10, 0.2501) == 7);
    assert_true(draw_value(&discrete, &place, 10, 1 - 0x1p-53) == 7);
    ld_factor each = factor_named("a", LD_EACH_SAMPLE);
    assert_true(draw_value(&each, &place, 1, 0x1p-53) == 0);
    assert_true(draw_value(&each, &place, 1, 1 - 0x1p-53) == 999);
}

// The launch on a fixed base with these factors.
static ld_model read_text(const char *factors)
{
    char text[1024];
    ld_model model;
    ld_messages messages;
    int length =
        snprintf(text, sizeof text,
                 "include: fixed.yaml\nscatter:\n  seed: 5\n  samples: 8\n  factors:\n%s", factors);
    ld_status status = scenario_read_text(text, (size_t)length, "text", LD_SOURCE_DIR "/examples",
                                          NULL, 0, &model, &messages);
    ld_messages_print(&messages, stdout);
    assert_int_equal(status, LD_OK);
    return model;
}

// P(Z <= z | a < Z < b) of the value sampled for u is u, on whichever side of the mean a and b lie:
// a value rises with its u. Counted from the nearer tail, where Phi has its digits.
static void test_between_anywhere(void **state)
{
    (void)state;
    static const double ends[][2] = {{-1, 2}, {-3, -1}, {-8, -6}, {0, 1},  {0.5, 0.6},
                                     {1, 3},  {6, 8},   {-2, 0},  {2, 40}, {-40, -2}};
    double worst = 0;
    for (size_t k = 0; k < sizeof ends / sizeof *ends; k++) {
        ld_factor normal = factor_named("a", LD_NORMAL);
        double a = ends[k][0], b = ends[k][1], side = a + b > 0 ? -1 : 1;
        normal.between[0] = 10 + 0.5 * a;
        normal.between[1] = 10 + 0.5 * b;
        for (double u = 0.05; u < 1; u += 0.1) {
            double z = (draw_value(&normal, &place, 10, u) - 10) / 0.5;
            double below = fabs(normal_cumulative(side * z) - normal_cumulative(side * a));
            double all = fabs(normal_cumulative(side * b) - normal_cumulative(side * a));
            worst = fmax(worst, fabs(below / all - u));
        }
    }
    CHECK_BELOW("share below a value less its u", worst, 3e-13);
}

// A normal distribution far from its bounds is possible as long as they leave it values, on either
// side of the mean.
static void test_possible_far_out(void **state)
{
    (void)state;
    ld_model model = read_text("    rocket.mass_error: {normal: 0.2 kg}\n");
    field_place at;
    char why[256];
    assert_true(field_locate(&model, "rocket.mass_error", &at, why, sizeof why));
    double nominal = field_get(&model, &at);
    static const double ends[][2] = {{10, 12},   {-12, -10}, {20, 21},
                                     {-21, -20}, {60, 61},   {-61, -60}};
    for (int k = 0; k < 6; k++) {
        ld_factor normal = factor_named("rocket.mass_error", LD_NORMAL);
        normal.between[0] = nominal + 0.5 * ends[k][0];
        normal.between[1] = nominal + 0.5 * ends[k][1];
        assert_true(factor_is_possible(&model, &normal, why, sizeof why) == (k < 4));
    }
    model_clear(&model);
}

static void test_permutation(void **state)
{
    (void)state;
    static const int64_t sizes[] = {1, 2, 3, 10, 257, 4096, 5000};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        int64_t n = sizes[k], fixed = 0;
        bool *taken = calloc((size_t)n, sizeof *taken);
        assert_non_null(taken);
        for (int64_t i = 0; i < n; i++) {
            int64_t to = draw_permuted((uint64_t[]){3, 4}, 5, 6, n, i);
            assert_true(to >= 0 && to < n && !taken[to]);
            taken[to] = true;
            fixed += to == i;
        }
        free(taken);
        if (n > 100) // one on the average
            CHECK_WITHIN("places that stay", (double)fixed, 0, 6);
    }
}

// Every replicate has one value in each stratum; seeds stay as they are.
static void test_hypercube(void **state)
{
    (void)state;
    enum { STRATA = 25, REPLICATES = 4, SAMPLES = STRATA * REPLICATES };
    ld_scatter lhs = {.seed = 7, .samples = SAMPLES, .plan = LD_PLAN_LHS, .replicates = REPLICATES};
    ld_scatter plain = {.seed = 7, .samples = SAMPLES, .replicates = 1};
    ld_factor a = factor_named("rocket.mass", LD_NORMAL);
    ld_factor each = factor_named("base.road.seed", LD_EACH_SAMPLE);
    int hit[REPLICATES][STRATA] = {0};
    for (int k = 1; k <= SAMPLES; k++) {
        hit[(k - 1) / STRATA][(int)(draw_uniform(&lhs, &a, k, 3) * STRATA)]++;
        assert_true(draw_uniform(&lhs, &each, k, 0) == draw_uniform(&plain, &each, k, 0));
    }
    for (int i = 0; i < REPLICATES; i++)
        for (int j = 0; j < STRATA; j++)
            assert_int_equal(hit[i][j], 1);
}

// From a scenario: the factors as written, and the draws moved by no other factor, nor by the way
// in which a list's member is named.
static void test_factors_of_a_scenario(void **state)
{
    (void)state;
    ld_model one = read_text("    rocket.adaptors.2.clearance: {uniform: +-0.1 mm}\n"),
             two = read_text("    rocket.mass_error: {normal: 200 g, within: 3, per: sample}\n"
                             "    base.elevation: {normal: 1 deg, between: 19 21 deg}\n"
                             "    tubes.modes.bending: {discrete: [5, 6], weights: [1, 3]}\n"
                             "    rocket.adaptors.middle.clearance: {uniform: +-0.1 mm}\n");
    const ld_factor *f = two.scatter.factor;
    assert_true(two.scatter.factor_count == 4 && two.scatter.samples == 8);
    assert_true(f[0].deviation == 0.2 && f[0].within == 3 && !f[0].per_rocket);
    CHECK_BELOW("19 deg", f[1].between[0] - 19 * 3.14159265358979323846 / 180, 1e-16);
    assert_true(f[2].value[1] == 6 && f[2].weight[1] == 3 && !f[2].per_rocket);
    assert_true(f[3].spread == 1e-4 && f[3].per_rocket);
    assert_string_equal(one.scatter.factor[0].path, f[3].path);
    for (int k = 1; k <= 8; k++)
        for (int i = 1; i <= 3; i++)
            assert_true(draw_uniform(&one.scatter, &one.scatter.factor[0], k, i) ==
                        draw_uniform(&two.scatter, &f[3], k, i));

    // the number itself
    field_place at;
    char why[256];
    assert_true(field_locate(&two, f[3].path, &at, why, sizeof why));
    assert_true(field_get(&two, &at) == 0.0005);
    field_set(&two, &at, 0.0006);
    assert_true(two.rocket.adaptor[1].clearance == 0.0006);
    assert_true(field_locate(&two, "rocket.eccentricity.z", &at, why, sizeof why));
    field_set(&two, &at, 0.01);
    assert_true(two.rocket.eccentricity[1] == 0.01 && two.rocket.eccentricity[0] == 0);
    assert_true(field_locate(&two, "firing.1.tube", &at, why, sizeof why) && at.whole);
    field_set(&two, &at, 3);
    assert_true(two.firing[0].tube == 3);
    assert_true(field_locate(&two, "environment.ground", &at, why, sizeof why));
    field_set(&two, &at, -2);
    assert_true(two.environment.ground_height == -2);
    model_clear(&one);
    model_clear(&two);
}

// Several keys under one name: sampled once by the name, set all; the printed scenario reads back.
static void test_several_keys(void **state)
{
    (void)state;
    static const char factors[] =
        "    gap: {paths: [rocket.adaptors.rear.clearance, rocket.adaptors.2.clearance,\n"
        "      rocket.adaptors.front.clearance], uniform: 0.3 0.5 mm}\n"
        "    rocket.mass_error: {normal: 0.1 kg}\n"
        "  correlated: [{factors: [rocket.mass_error, gap], matrix: [[1, 0.25], [0.25, 1]]}]\n";
    ld_model model = read_text(factors);
    ld_factor *gap = &model.scatter.factor[0];
    assert_string_equal(gap->path, "gap");
    assert_int_equal(gap->together.count, 3);
    assert_string_equal(gap->together.path[1], "rocket.adaptors.middle.clearance");
    assert_true(gap->per_rocket && model.scatter.correlated[0].factor[1] == 0);
    assert_true(model.rocket.adaptor[0].clearance != model.rocket.adaptor[1].clearance);
    model.scatter.correlated_count = 0;
    study_sampler sampler;
    ld_error error;
    assert_int_equal(sampler_create(&sampler, &model, &error), LD_OK);
    study_sample *sample = sample_create(&sampler);
    double worst = 0, spread = 0;
    for (int k = 1; k <= 8; k++) {
        assert_int_equal(sample_draw(sample, &sampler, k, &error), LD_OK);
        double u = random_uniform(5, random_stream("gap"), (uint64_t)k, 1, 0);
        double expected = 0.3e-3 + 0.2e-3 * u;
        for (int i = 0; i < 3; i++)
            worst = fmax(worst, fabs(sample->salvo[0].adaptor[i].clearance - expected));
        spread = fmax(spread, fabs(expected - 0.4e-3));
    }
    CHECK_BELOW("clearances, from the name's number [m]", worst, 1e-19);
    CHECK_WITHIN("the largest from the middle [mm]", spread * 1e3, 0.05, 0.1);
    sample_free(sample);
    sampler_free(&sampler);
    model_clear(&model);
}

// The longest step of sample 3, whose tolerance is sampled.
static double longest_step(const char *factors, double given, double *tolerance)
{
    ld_model model = read_text(factors);
    study_sampler sampler;
    ld_error error;
    if (given > 0) {
        model.run.max_step = given;
        model.completed.max_step = false;
    }
    assert_int_equal(sampler_create(&sampler, &model, &error), LD_OK);
    study_sample *sample = sample_create(&sampler);
    assert_int_equal(sample_draw(sample, &sampler, 3, &error), LD_OK);
    double step = sample->model->run.max_step;
    *tolerance = sample->model->run.tolerance;
    sample_free(sample);
    sampler_free(&sampler);
    model_clear(&model);
    return step;
}

// The longest step follows a drawn tolerance, but not where it is given or drawn itself.
static void test_longest_step(void **state)
{
    (void)state;
    static const char tolerance[] = "    run.tolerance: {uniform: 1e-4 1e-3}\n",
                      both[] = "    run.tolerance: {uniform: 1e-4 1e-3}\n"
                               "    run.max_step: {uniform: 0.3 0.31 ms}\n",
                      neither[] = "    rocket.mass_error: {normal: 0.1 kg}\n";
    double drawn;
    double step = longest_step(tolerance, 0, &drawn);
    CHECK_WITHIN("tolerance drawn", drawn, 1e-4, 1e-3);
    CHECK_NEAR("longest step with it [s]", step, 2e-4 * pow(drawn / 1e-5, 0.2), 1e-18);
    assert_true(longest_step(tolerance, 2e-4, &drawn) == 2e-4);
    CHECK_WITHIN("drawn itself [s]", longest_step(both, 0, &drawn), 3e-4, 3.1e-4);
    assert_true(longest_step(neither, 0, &drawn) == 2e-4 && drawn == 1e-5);
}

// Sample 3 of a scenario beside the examples, of which `number` reports something.
static double drawn_number(const char *text, double (*number)(const study_sample *sample))
{
    ld_model model;
    ld_messages messages;
    study_sampler sampler;
    ld_error error;
    ld_status status = scenario_read_text(text, strlen(text), "text", LD_SOURCE_DIR "/examples",
                                          NULL, 0, &model, &messages);
    ld_messages_print(&messages, stdout);
    assert_int_equal(status, LD_OK);
    assert_int_equal(sampler_create(&sampler, &model, &error), LD_OK);
    study_sample *sample = sample_create(&sampler);
    if (sample_draw(sample, &sampler, 3, &error))
        fail_msg("%s", error.text);
    double found = number(sample);
    sample_free(sample);
    sampler_free(&sampler);
    model_clear(&model);
    return found;
}

static double propellant_fired(const study_sample *sample)
{
    return sample->salvo[0].propellant;
}
static double propellant_aboard(const study_sample *sample)
{
    return sample->model->rocket.propellant;
}
static double empty_mass(const study_sample *sample)
{
    return sample->salvo[0].empty.mass;
}
static double empty_center(const study_sample *sample)
{
    return sample->salvo[0].empty.center[0];
}
static double stuck_time(const study_sample *sample)
{
    return sample->model->run.stuck_time;
}
static double ground(const study_sample *sample)
{
    return sample->model->environment.ground_height;
}

// What the scenario leaves to follow from other numbers follows from those that are sampled: of
// every rocket, of those aboard that are not fired, of the sample; what it says stays.
static void test_what_follows(void **state)
{
    (void)state;
#define SCATTERED "scatter:\n  samples: 3\n  factors:\n"
#define MASS_63 SCATTERED "    rocket.mass: {discrete: [63 kg]}\n"
#define EMPTY_42 "    rocket.empty.mass: {discrete: [42 kg], per: sample}\n"
#define ROUND                                                                                      \
    "environment: {earth: round, site: {latitude: 0 deg, longitude: 0 deg, altitude: 9 m}}\n"
    static const struct {
        const char *what, *text;
        double (*number)(const study_sample *sample);
        double expected;
    } all[] = {
        {"propellant of masses drawn [kg]", "include: fixed.yaml\n" MASS_63 EMPTY_42,
         propellant_fired, 21},
        {"the same of a salvo", "include: salvo.yaml\n" MASS_63 "    rocket.propellant:\n",
         propellant_fired, 23},
        {"aboard, the full mass its own [kg]",
         "include: salvo.yaml\n" MASS_63 EMPTY_42 "    rocket.propellant:\n", propellant_aboard,
         18},
        {"where it is given [kg]", "include: fixed.yaml\nrocket: {propellant: 19 kg}\n" MASS_63,
         propellant_fired, 19},
        {"where it is drawn itself [kg]",
         "include: fixed.yaml\n" MASS_63 "    rocket.propellant: {discrete: [18.5 kg]}\n",
         propellant_fired, 18.5},
        {"without an empty rocket: its mass [kg]",
         "include: fixed.yaml\nrocket: {empty: }\n" MASS_63, empty_mass, 63},
        {"its mass centre [m]",
         "include: fixed.yaml\nrocket: {empty: }\n" SCATTERED
         "    rocket.center.x: {discrete: [1.15 m]}\n",
         empty_center, 1.15},
        {"time to give up, the thrust's times drawn [s]",
         "include: fixed.yaml\n" SCATTERED "    rocket.motor.time_scale: {discrete: [2]}\n",
         stuck_time, 6.1},
        {"ground, the site's altitude drawn [m]",
         "include: flight.yaml\n" ROUND SCATTERED
         "    environment.site.altitude: {discrete: [11 m]}\n",
         ground, 11},
    };
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        CHECK_NEAR(all[i].what, drawn_number(all[i].text, all[i].number), all[i].expected, 1e-14);
}

// 11 factors of each of 18 rockets and 8 of the sample, of which 2 are seeds.
static void test_dimensions(void **state)
{
    (void)state;
    const struct {
        const char *plan;
        ld_status status;
    } all[] = {{"scatter.plan=sobol", LD_OK}, {"scatter.plan=saltelli", LD_ERR_INPUT}};
    for (size_t i = 0; i < 2; i++) {
        const char *const sets[] = {all[i].plan, "scatter.samples=16", "scatter.replicates=2"};
        ld_model *model;
        ld_messages messages;
        study_sampler sampler;
        ld_error error = {0};
        assert_int_equal(
            ld_scenario_read(LD_SOURCE_DIR "/examples/salvo.yaml", sets, 3, &model, &messages),
            LD_OK);
        assert_int_equal(sampler_create(&sampler, model, &error), all[i].status);
        if (all[i].status)
            assert_string_equal(error.text,
                                "scatter.plan: Sobol points have at most 256 coordinates, and "
                                "these factors of 18 rockets require 404; use random numbers");
        sampler_free(&sampler);
        ld_model_free(model);
        ld_messages_free(&messages);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_uniform_numbers),
        cmocka_unit_test(test_distributions),
        cmocka_unit_test(test_between_anywhere),
        cmocka_unit_test(test_possible_far_out),
        cmocka_unit_test(test_permutation),
        cmocka_unit_test(test_hypercube),
        cmocka_unit_test(test_factors_of_a_scenario),
        cmocka_unit_test(test_several_keys),
        cmocka_unit_test(test_longest_step),
        cmocka_unit_test(test_what_follows),
        cmocka_unit_test(test_dimensions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
