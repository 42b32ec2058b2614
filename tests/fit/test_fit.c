// Fits of a launcher whose keys are known: results come from its own launch, with noise.
// ctest: slow
#include "support/found_fit.h"

#include "base/random.h"
#include "launchdyn/launchdyn.h"
#include "math/curves/distributions.h"
#include "model/model.h"
#include "support/coverage.h"
#include "support/scratch.h"

enum { RESULTS = 4, MOST_ROWS = 64 };

static const char *const names[RESULTS] = {"t_front", "t_middle", "t_rear", "exit_speed"};

static const char *const coarse[] = {"tubes.modes.bending=1", "tubes.modes.torsion=0",
                                     "run.tolerance=1e-4", "run.max_step=1 ms"};
enum { COARSE = sizeof coarse / sizeof *coarse };

// The reference launcher on a fixed base, with a coarse tube: a launch takes 1 ms.
static ld_model *make_model(const char *const *sets, size_t count)
{
    const char *all[COARSE + 8];
    ld_model *model;
    ld_messages messages;
    for (size_t i = 0; i < COARSE; i++)
        all[i] = coarse[i];
    for (size_t i = 0; i < count; i++)
        all[COARSE + i] = sets[i];
    assert_int_equal(ld_scenario_read(LD_SOURCE_DIR "/examples/fixed.yaml", all, COARSE + count,
                                      &model, &messages),
                     LD_OK);
    return model;
}

static void launch(const char *const *sets, size_t count, double value[RESULTS])
{
    ld_model *model = make_model(sets, count);
    ld_simulation *simulation;
    ld_summary *summary = ld_summary_new();
    ld_error error;
    assert_int_equal(ld_simulation_create(model, &simulation, &error), LD_OK);
    assert_int_equal(ld_simulation_run(simulation, NULL, summary, &error), LD_OK);
    for (int i = 0; i < RESULTS; i++) {
        char name[64];
        snprintf(name, sizeof name, "rocket.1.%s", names[i]);
        assert_int_equal(ld_summary_number(summary, name, &value[i], &error), LD_OK);
    }
    ld_summary_free(summary);
    ld_simulation_free(simulation);
    ld_model_free(model);
}

static double noise(int set, int row, int result)
{
    return normal_quantile(random_uniform(29, (uint64_t)set, (uint64_t)row, (uint64_t)result, 0));
}

// ---- the truth

// Thrust, release force, friction and mass of the launcher on the range.
static const char *const truth[] = {"rocket.motor.thrust_scale=1.02",
                                    "rocket.lock.release_force=6 kN",
                                    "rocket.contact.friction=0.2"};
static const double true_value[3] = {1.02, 6000, 0.2};
static const ld_fit_key keys[3] = {{"rocket.motor.thrust_scale", "0.9", "1.1", NULL, NULL},
                                   {"rocket.lock.release_force", "2 kN", "10 kN", NULL, NULL},
                                   {"rocket.contact.friction", "0.02", "0.5", NULL, NULL}};

// Standard deviations of launches: what they share moves times and speed together, and each has its
// own.
static const double shared[RESULTS] = {0.3e-3, 0.4e-3, 0.5e-3, -0.1};
static const double own[RESULTS] = {0.02e-3, 0.02e-3, 0.02e-3, 0.01};

// Writes launches of one set; `given`: with columns of uncertainties, and without what they share.
static const char *write_launches(const double value[RESULTS], int set, int rows, bool given)
{
    const char *file = in("launches.csv");
    FILE *stream = fopen(file, "w");
    assert_non_null(stream);
    fputs("t_front [s],t_middle [s],t_rear [s],exit_speed [m/s]", stream);
    for (int k = 0; k < RESULTS && given; k++)
        fprintf(stream, ",%s_u [%s]", names[k], k == 3 ? "cm/s" : "us");
    for (int row = 0; row < rows; row++) {
        for (int k = 0; k < RESULTS; k++)
            fprintf(stream, "%s%.17g", k ? "," : "\n",
                    value[k] + own[k] * noise(set, row, k) +
                        (given ? 0 : shared[k] * noise(set, row, RESULTS)));
        for (int k = 0; k < RESULTS && given; k++)
            fprintf(stream, ",%.17g", own[k] * (k == 3 ? 1e2 : 1e6));
    }
    assert_int_equal(fclose(stream), 0);
    return file;
}

static void read_found(const ld_fit *fit, size_t count, found *of)
{
    char *text = json_of(fit);
    read_keys(text, count, of);
    free(text);
}

// NOLINTNEXTLINE(readability-function-size)
static ld_status try_fit(const ld_model *model, const ld_fit_key *fitted, size_t count,
                         const char *file, const ld_fit_options *options, found *of,
                         ld_error *error)
{
    ld_fit *fit;
    ld_status status = ld_fit_create(model, fitted, count, &file, 1, &fit, error);
    if (status)
        return status;
    status = ld_fit_run(fit, options, error);
    if (!status && of)
        read_found(fit, count, of);
    ld_fit_free(fit);
    return status;
}

static void fit_well(const ld_model *model, size_t count, const char *file, int starts, found *of)
{
    ld_error error;
    const ld_fit_options options = {.threads = 2, .starts = starts};
    ld_status status = try_fit(model, keys, count, file, &options, of, &error);
    if (status)
        fail_msg("%s", error.text);
}

// ---- without noise

static void test_exact(void **state)
{
    (void)state;
    double value[RESULTS];
    found of = {0};
    ld_model *model = make_model(NULL, 0);
    launch(truth, 3, value);
    FILE *stream = fopen(in("exact.csv"), "w");
    fputs("t_front [s],t_middle [s],t_rear [s],exit_speed [m/s],t_front_u [us],t_middle_u [us],"
          "t_rear_u [us],exit_speed_u [mm/s]\n",
          stream);
    fprintf(stream, "%.17g,%.17g,%.17g,%.17g,1,1,1,1\n", value[0], value[1], value[2], value[3]);
    fclose(stream);
    fit_well(model, 3, in("exact.csv"), 4, &of);
    for (int i = 0; i < 3; i++)
        CHECK_BELOW(keys[i].path, (of.value[i] - true_value[i]) / of.deviation[i], 0.05);
    ld_model_free(model);
}

// One key: 1/deviation^2 is the sum of (change of a result by the key/uncertainty)^2.
static void test_deviation(void **state)
{
    (void)state;
    const char *const less[] = {"rocket.motor.thrust_scale=1.01"},
                      *const more[] = {"rocket.motor.thrust_scale=1.03"};
    const double uncertainty[2] = {0.4e-3, 0.3};
    double value[RESULTS], low[RESULTS], high[RESULTS], sum = 0;
    found of = {0};
    ld_model *model = make_model(NULL, 0);
    launch(truth, 1, value);
    launch(less, 1, low);
    launch(more, 1, high);
    for (int k = 0; k < 2; k++)
        sum += pow((high[k + 2] - low[k + 2]) / 0.02 / uncertainty[k], 2);
    FILE *stream = fopen(in("deviation.csv"), "w");
    fprintf(stream,
            "t_rear [s],t_rear_u [s],exit_speed [m/s],exit_speed_u [m/s]\n%.17g,%g,%.17g,%g\n",
            value[2], uncertainty[0], value[3], uncertainty[1]);
    fclose(stream);
    fit_well(model, 1, in("deviation.csv"), 1, &of);
    CHECK_BELOW("deviation of one key, relative", of.deviation[0] * sqrt(sum) - 1, 2e-3);
    ld_model_free(model);
}

// ---- with noise

// How often the truth lies inside the 95 % intervals of `sets` fits, each to 36 launches.
static void check_coverage(const char *what, bool given, int sets)
{
    enum { LAUNCHES = 36 };
    double value[RESULTS];
    int inside[3] = {0}, noisy = 0, least = least_of_95(sets);
    ld_model *model = make_model(NULL, 0);
    launch(truth, 3, value);
    for (int set = 0; set < sets; set++) {
        found of = {0};
        fit_well(model, 3, write_launches(value, set + 1000 * given, LAUNCHES, given), 1, &of);
        for (int i = 0; i < 3; i++)
            inside[i] += of.low[i] <= true_value[i] && true_value[i] <= of.high[i];
        noisy += of.chance >= 0.05;
    }
    for (int i = 0; i < 3; i++) {
        char text[96];
        snprintf(text, sizeof text, "%s, %s [%%]", what, keys[i].path);
        CHECK_WITHIN(text, 100. * inside[i] / sets, 100. * least / sets, 100);
    }
    CHECK_WITHIN("residuals taken for noise [%]", 100. * noisy / sets, 100. * least / sets, 100);
    ld_model_free(model);
}

// scripts/prove repeats it with more sets (LD_FIT_SETS).
static void test_coverage(void **state)
{
    (void)state;
    int sets = getenv("LD_FIT_SETS") ? atoi(getenv("LD_FIT_SETS")) : OF_ALL(8, 1);
    check_coverage("uncertainties given", true, sets);
    check_coverage("uncertainties estimated", false, sets);
}

// ---- settings, priors

// Launches at two masses, which a column sets: what one mass alone leaves open.
static void test_settings(void **state)
{
    (void)state;
    found of = {0};
    ld_model *model = make_model(NULL, 0);
    FILE *stream = fopen(in("settings.csv"), "w");
    fputs("rocket.mass [kg],t_rear [s],t_rear_u [us],exit_speed [m/s],exit_speed_u [mm/s]\n",
          stream);
    for (int i = 0; i < 2; i++) {
        char mass[64];
        double value[RESULTS];
        snprintf(mass, sizeof mass, "rocket.mass=%d kg", 55 + 10 * i);
        const char *const sets[] = {truth[0], truth[1], mass};
        launch(sets, 3, value);
        fprintf(stream, "%d,%.17g,1,%.17g,1\n", 55 + 10 * i, value[2], value[3]);
    }
    fclose(stream);
    fit_well(model, 2, in("settings.csv"), 2, &of);
    for (int i = 0; i < 2; i++)
        CHECK_BELOW(keys[i].path, (of.value[i] - true_value[i]) / of.deviation[i], 0.05);
    ld_model_free(model);
}

// A prior far narrower than the data: value and deviation are the prior's.
static void test_prior(void **state)
{
    (void)state;
    double value[RESULTS];
    found of = {0};
    ld_error error;
    ld_model *model = make_model(NULL, 0);
    const ld_fit_key narrow[] = {keys[0],
                                 {"rocket.lock.release_force", "2 kN", "10 kN", "5.5 kN", "1 mN"}};
    launch(truth, 2, value);
    assert_int_equal(
        try_fit(model, narrow, 2, write_launches(value, 1, 4, true), NULL, &of, &error), LD_OK);
    CHECK_NEAR("release force at its prior [N]", of.value[1], 5500, 1e-3);
    CHECK_NEAR("its deviation [N]", of.deviation[1], 1e-3, 1e-8);
    ld_model_free(model);
}

// ---- interruption, jobs

static void test_continues(void **state)
{
    (void)state;
    double value[RESULTS];
    ld_error error;
    ld_model *model = make_model(NULL, 0);
    ld_fit *fit;
    launch(truth, 2, value);
    const char *file = write_launches(value, 1, 8, false);
    assert_int_equal(ld_fit_create(model, keys, 2, &file, 1, &fit, &error), LD_OK);
    assert_int_equal(ld_fit_run(fit, NULL, &error), LD_OK);
    char *whole = json_of(fit);
    patience some;
    ld_fit_options options = {.folder = in("fit"), .self = &some, .go_on = wait_once_more};
    int stops = 0;
    for (some.left = 400; ld_fit_run(fit, &options, &error) == LD_ERR_INTERRUPTED; stops++) {
        assert_non_null(strstr(error.text, "the same command continues"));
        some.left = 400 + 200 * stops;
    }
    char *after = json_of(fit);
    assert_true(stops >= 3);
    assert_string_equal(whole, after);
    free(after);
    // on two threads, and once more from what is kept
    options = (ld_fit_options){.threads = 2};
    assert_int_equal(ld_fit_run(fit, &options, &error), LD_OK);
    after = json_of(fit);
    assert_string_equal(whole, after);
    free(after);
    free(whole);
    // another fit does not go into the folder
    options = (ld_fit_options){.folder = in("fit"), .starts = 3};
    assert_int_equal(ld_fit_run(fit, &options, &error), LD_ERR_INPUT);
    assert_non_null(strstr(error.text, "use another folder"));
    ld_fit_free(fit);
    ld_model_free(model);
}

// The fitted scenario has the values.
static void test_fitted(void **state)
{
    (void)state;
    ld_model *fitted;
    ld_messages messages;
    ld_error error;
    double force = 0, scale = 0;
    assert_int_equal(ld_scenario_read(in("fit/fitted.yaml"), NULL, 0, &fitted, &messages), LD_OK);
    assert_int_equal(ld_model_number(fitted, "rocket.lock.release_force", &force, &error), LD_OK);
    assert_int_equal(ld_model_number(fitted, "rocket.motor.thrust_scale", &scale, &error), LD_OK);
    CHECK_NEAR("release force in fitted.yaml [N]", force, 6000, 50);
    CHECK_NEAR("scale of the thrust", scale, 1.02, 0.01);
    ld_model_free(fitted);
}

// ---- what is refused

typedef struct refusal {
    const char *text; // of the file
    ld_fit_key key[2];
    int keys;
    const char *message;
} refusal;

#define OVER(path, from, to)                                                                       \
    {                                                                                              \
        path, from, to, NULL, NULL                                                                 \
    }
#define SCALE OVER("rocket.motor.thrust_scale", "0.9", "1.1")

static void test_refused(void **state)
{
    (void)state;
    static const refusal cases[] = {
        {"t_rear [ms]\n159\n",
         {OVER("rocket.motor.thrust_skale", "0.9", "1.1")},
         1,
         "did you mean"},
        {"t_rear [ms]\n159\n", {OVER("rocket.mass", "61 kg", "60 kg")}, 1, "rising order"},
        {"t_rear [ms]\n159\n",
         {OVER("rocket.mass", "-61 kg", "60 kg")},
         1,
         "expected bounds in > 0"},
        {"t_rear [ms]\n159\n", {OVER("rocket.mass", "61 m", "62 kg")}, 1, "rocket.mass: from:"},
        {"t_rear [ms]\n159\n", {OVER("tubes.modes.bending", "1", "2")}, 1, "whole number"},
        {"t_rear [ms]\n159\n",
         {{"rocket.motor.thrust_scale", "0.9", "1.1", "1", "0"}},
         1,
         "deviation > 0"},
        {"t_rear [ms]\n159\n", {SCALE, SCALE}, 2, "given twice"},
        {"t_raer [ms]\n159\n", {SCALE}, 1, "did you mean \"t_rear\"?"},
        {"t_rear [kg]\n159\n", {SCALE}, 1, "found the unit \"kg\""},
        {"t_rear [ms]\n159\n158\n", {SCALE}, 1, "t_rear: its uncertainty is neither given"},
        {"t_rear [ms]\n159\n159\n159\n159\n", {SCALE}, 1, "do not scatter"},
        {"t_rear [ms],t_rear_u [ms]\n159,0\n", {SCALE}, 1, "t_rear_u: found 0 or less"},
        {"t_rear [ms],t_rear_u [ms]\n159,1\n160,\n", {SCALE}, 1, "t_rear_u: found nothing"},
        {"t_rear [ms],t_rear_u [ms]\n159,1\n160,1\n",
         {SCALE, OVER("rocket.mass", "59 kg", "61 kg")},
         2,
         "2 keys without a prior, but 1 measured results"},
        {"t_rear [ms],t_rear_u [ms],rocket.mass [kg]\n159,1,60\n159,1,\n",
         {SCALE},
         1,
         "launch 2 has no value of rocket.mass"},
        {"rocket.mass [kg]\n60\n", {SCALE}, 1, "names no result"},
        {"t_rear [ms],t_rear_u [ms],rocket.mass [kg]\n159,1,60\n",
         {OVER("rocket.mass", "59 kg", "61 kg")},
         1,
         "a column of the measured launches sets it"},
        {"t_front [ms],t_front_u [ms]\n95,1\n",
         {OVER("run.stuck_time", "8 s", "9 s")},
         1,
         "run.stuck_time changes none of the measured results"},
        {"t_front [ms],t_front_u [ms]\n95,1\n",
         {OVER("rocket.lock.release_force", "20 kN", "30 kN")},
         1,
         "no launch at any of 4 starts; first: "}};
    ld_model *model = make_model(NULL, 0);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const refusal *of = &cases[i];
        ld_error error = {0};
        FILE *stream = fopen(in("refused.csv"), "w");
        fputs(of->text, stream);
        fclose(stream);
        ld_status status =
            try_fit(model, of->key, (size_t)of->keys, in("refused.csv"), NULL, NULL, &error);
        if (!status || !strstr(error.text, of->message))
            fail_msg("case %zu: \"%s\" has no \"%s\"", i, error.text, of->message);
        assert_null(strchr(error.text, '\n'));
    }
    ld_model_free(model);
}

// A scenario that fires several rockets.
static void test_salvo(void **state)
{
    (void)state;
    ld_model *model;
    ld_messages messages;
    ld_error error;
    ld_fit *fit;
    const char *file = "none.csv";
    assert_int_equal(
        ld_scenario_read(LD_SOURCE_DIR "/examples/salvo.yaml", NULL, 0, &model, &messages), LD_OK);
    assert_int_equal(ld_fit_create(model, keys, 1, &file, 1, &fit, &error), LD_ERR_INPUT);
    assert_non_null(strstr(error.text, "fires 18 rockets"));
    ld_model_free(model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_exact),    cmocka_unit_test(test_deviation),
        cmocka_unit_test(test_coverage), cmocka_unit_test(test_settings),
        cmocka_unit_test(test_prior),    cmocka_unit_test(test_continues),
        cmocka_unit_test(test_fitted),   cmocka_unit_test(test_refused),
        cmocka_unit_test(test_salvo)};
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
