// Optimisations of the launcher on the range, whose launches take a millisecond: against launches
// and studies of their own, stopped and continued, refused.
#include "support/check.h"

#include <stdlib.h>
#include <unistd.h>

#include "launchdyn/launchdyn.h"
#include "support/scratch.h"

static const char *const coarse[] = {"tubes.modes.bending=1", "tubes.modes.torsion=0",
                                     "run.tolerance=1e-4", "run.max_step=1 ms"};
enum { COARSE = sizeof coarse / sizeof *coarse, MOST_SETS = 8 };

static ld_status read_model(const char *const *sets, ld_model **model, ld_messages *messages)
{
    const char *all[COARSE + MOST_SETS];
    size_t count = 0;
    for (; count < COARSE; count++)
        all[count] = coarse[count];
    for (; *sets; sets++)
        all[count++] = *sets;
    return ld_scenario_read(LD_SOURCE_DIR "/examples/fixed.yaml", all, count, model, messages);
}

static ld_model *make_model(const char *const *sets)
{
    ld_model *model;
    ld_messages messages;
    if (read_model(sets, &model, &messages))
        fail_msg("%s: %s", messages.item[0].path, messages.item[0].text);
    return model;
}

#define SCATTER                                                                                    \
    "scatter={samples: 30, factors: {rocket.mass_error: {normal: 0.5 kg}, "                        \
    "rocket.motor.misalignment.y: {normal: 1 mrad}, rocket.eccentricity.y: {normal: 1 mm}}}"
#define GAIN                                                                                       \
    "optimise={over: {tubes.supports.1.at: [0.2 m, 0.9 m], tubes.supports.2.at: [1.2 m, 2.6 m]}, " \
    "least: {take: deviation, of: pitch_rate}, evaluations: 25, others: 40}"
static const char *const noisy[] = {SCATTER, GAIN, NULL};

static char *text_of(const ld_optimisation *of, bool json)
{
    enum { MOST = 1 << 18 };
    char *text = calloc(1, MOST);
    assert_non_null(text);
    FILE *stream = fmemopen(text, MOST, "w");
    assert_non_null(stream);
    (json ? ld_optimise_print_json : ld_optimise_print)(of, stream);
    assert_int_equal(fclose(stream), 0);
    return text;
}

// The number behind `name`, of the member named `of` (NULL: of the first that has the name).
static double number_in(const char *text, const char *of, const char *name)
{
    char quoted[64];
    if (of) {
        snprintf(quoted, sizeof quoted, "\"%s\": {", of);
        text = strstr(text, quoted);
        assert_non_null(text);
    }
    snprintf(quoted, sizeof quoted, "\"%s\": ", name);
    text = strstr(text, quoted);
    assert_non_null(text);
    text += strlen(quoted);
    return strncmp(text, "null", 4) == 0 ? NAN : strtod(text, NULL);
}

static char *optimise(const ld_model *model, const ld_optimise_options *options, ld_status *status)
{
    ld_optimisation *of;
    ld_error error = {0};
    char *text = NULL;
    assert_int_equal(ld_optimise_create(model, &of, &error), LD_OK);
    *status = ld_optimise_run(of, options, &error);
    if (!*status)
        text = text_of(of, true);
    else
        print_message("    %s\n", error.text);
    ld_optimise_free(of);
    return text;
}

// ---- one launch: a load is limited

static double launch(const char *mass, const char *name)
{
    const char *const sets[] = {mass, NULL};
    ld_model *model = make_model(sets);
    ld_simulation *simulation;
    ld_summary *summary = ld_summary_new();
    ld_error error;
    double value;
    assert_int_equal(ld_simulation_create(model, &simulation, &error), LD_OK);
    assert_int_equal(ld_simulation_run(simulation, NULL, summary, &error), LD_OK);
    assert_int_equal(ld_summary_number(summary, name, &value, &error), LD_OK);
    ld_summary_free(summary);
    ld_simulation_free(simulation);
    ld_model_free(model);
    return value;
}

// A heavy rocket is slow: the time in the tube is least at the mass at which the exit speed is at
// its limit, which bisection finds, too.
static void at_the_limit(void **state)
{
    (void)state;
    static const char *const sets[] = {
        "optimise={over: {rocket.mass: [50 kg, 70 kg]}, least: {of: t_rear}, subject_to: [{of: "
        "exit_speed, at_most: 38 m/s}], precision: 1e-6}",
        NULL};
    ld_model *model = make_model(sets);
    ld_status status;
    char *text = optimise(model, NULL, &status), mass[64];
    double low = 50, high = 70;
    for (int i = 0; i < 40; i++) {
        double middle = 0.5 * (low + high);
        snprintf(mass, sizeof mass, "rocket.mass=%.17g kg", middle);
        *(launch(mass, "rocket.1.exit_speed") > 38 ? &low : &high) = middle;
    }
    const char *keys = strstr(text, "\"keys\"");
    CHECK_BELOW("mass at the limit (relative)", number_in(keys, NULL, "found") / high - 1, 1e-5);
    snprintf(mass, sizeof mass, "rocket.mass=%.17g kg", number_in(keys, NULL, "found"));
    CHECK_BELOW("its time in the tube (relative)",
                number_in(text, "found", "value") / launch(mass, "rocket.1.t_rear") - 1, 1e-14);
    assert_true(launch(mass, "rocket.1.exit_speed") <= 38);
    assert_true(isnan(number_in(text, "found", "low")));
    assert_non_null(strstr(strstr(text, "\"candidates\": ["), "\"holds\": false"));
    assert_non_null(strstr(text, "\"holds\": true")); // the best, which comes first
    assert_true(strstr(text, "\"holds\": true") < strstr(text, "\"holds\": false"));
    free(text);
    ld_model_free(model);
}

// ---- a study: the same numbers as those of ld_study_run()

static double deviation_of(const char *folder_name, size_t from, size_t to)
{
    static const char *const names[] = {"pitch_rate"};
    ld_study_data *data;
    const ld_study_values *values;
    ld_error error;
    double sum = 0, square = 0, count = (double)(to - from);
    assert_int_equal(ld_study_data_open(folder_name, &data, &error), LD_OK);
    assert_int_equal(ld_study_data_values(data, 1, names, 1, &values, &error), LD_OK);
    assert_true(values->count >= to);
    for (size_t i = from; i < to; i++)
        sum += values->value[0][i];
    for (size_t i = from; i < to; i++)
        square += (values->value[0][i] - sum / count) * (values->value[0][i] - sum / count);
    ld_study_data_close(data);
    return sqrt(square / (count - 1));
}

static void the_samples_of_a_study(void **state)
{
    (void)state;
    ld_model *model = make_model(noisy);
    ld_status status;
    char *text = optimise(model, NULL, &status);
    const char *const more[] = {coarse[0], coarse[1], coarse[2],
                                coarse[3], SCATTER,   "scatter.samples=70"};
    ld_study *study;
    ld_study_counts counts;
    ld_messages messages;
    ld_error error;
    assert_int_equal(
        ld_study_read(LD_SOURCE_DIR "/examples/fixed.yaml", more, 6, &study, &messages), LD_OK);
    assert_int_equal(ld_study_run(study, in("study"), NULL, &counts, &error), LD_OK);
    CHECK_BELOW("deviation, of a study (relative)",
                number_in(text, "scenario", "value") / deviation_of(in("study"), 0, 30) - 1, 1e-12);
    CHECK_BELOW("on its next 40 samples (relative)",
                number_in(text, "scenario_others", "value") / deviation_of(in("study"), 30, 70) - 1,
                1e-12);
    assert_true(number_in(text, "found", "value") < number_in(text, "scenario", "value"));
    assert_true(number_in(text, "difference_others", "high") < 0);
    ld_study_free(study);
    free(text);
    ld_model_free(model);
}

// ---- stopped and continued

typedef struct patience {
    int64_t launches, seen;
} patience;

static void count_launches(void *self, const ld_optimise_counts *counts)
{
    patience *of = self;
    assert_true(counts->launches > 0 && counts->stage[0]);
    of->seen++;
}

static bool go_on(void *self)
{
    const patience *of = self;
    return of->launches == 0 || of->seen < of->launches;
}

static void cut_file(const char *path, long bytes)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    long size = ftell(file);
    fclose(file);
    assert_true(size > bytes);
    assert_int_equal(truncate(path, size - bytes), 0);
}

static char *contents(const char *path)
{
    enum { MOST = 1 << 18 };
    char *text = calloc(1, MOST);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    assert_non_null(text);
    assert_true(fread(text, 1, MOST - 1, file) > 0);
    fclose(file);
    return text;
}

static void it_continues(void **state)
{
    (void)state;
    ld_model *model = make_model(noisy);
    patience ours = {0};
    char stopped[128];
    snprintf(stopped, sizeof stopped, "%s", in("stopped"));
    ld_optimise_options options = {
        .threads = 3, .self = &ours, .progress = count_launches, .go_on = go_on};
    ld_status status;
    char *whole = optimise(model, &options, &status);
    assert_int_equal(status, LD_OK);
    options.folder = stopped;
    options.threads = 2;
    for (int64_t launches = 45; launches < 400; launches += 170) {
        ours = (patience){.launches = launches};
        assert_null(optimise(model, &options, &status));
        assert_int_equal(status, LD_ERR_INTERRUPTED);
    }
    char path[160];
    snprintf(path, sizeof path, "%s/optimise.state", stopped);
    cut_file(path, 100); // as after kill -9 within a record
    ours = (patience){0};
    char *continued = optimise(model, &options, &status), *again;
    assert_string_equal(whole, continued);
    options.threads = 1;
    ours = (patience){0};
    again = optimise(model, &options, &status);
    assert_string_equal(whole, again);
    assert_int_equal(ours.seen, 0); // all was kept
    snprintf(path, sizeof path, "%s/optimise.json", stopped);
    char *kept = contents(path);
    assert_string_equal(whole, kept);
    free(kept);
    free(whole);
    free(continued);
    free(again);
    // of another scenario
    static const char *const other[] = {SCATTER, GAIN, "rocket.mass=61 kg", NULL};
    ld_model *heavier = make_model(other);
    assert_null(optimise(heavier, &options, &status));
    assert_int_equal(status, LD_ERR_INPUT);
    ld_model_free(heavier);
    // what was found is a scenario that runs
    snprintf(path, sizeof path, "%s/optimised.yaml", stopped);
    ld_model *found;
    ld_messages messages;
    assert_int_equal(ld_scenario_read(path, NULL, 0, &found, &messages), LD_OK);
    ld_model_free(found);
    ld_model_free(model);
}

// ---- margins

// A late loop has a gain margin of 3.9 dB (docs/stabilisers.md); 6 dB require less of the gains.
static void margins_of_a_loop(void **state)
{
    (void)state;
    static const char *const sets[] = {
        "base.speed=0 km/h",
        "run.lead_in=0 s",
        "run.end=tip",
        "run.tolerance=1e-4",
        "run.max_step=1 ms",
        "run.exit_error=no",
        "tubes.modes.bending=1",
        "tubes.modes.torsion=0",
        "platform.elevation.stabiliser.sample=5 ms",
        "platform.elevation.stabiliser.delay=5 ms",
        "optimise={over: {platform.elevation.stabiliser.kd: [1e5 N.m.s/rad, 6e5 N.m.s/rad, log]}, "
        "least: {of: t_rear}, subject_to: [{take: gain_margin, of: elevation, at_least: 2}], "
        "evaluations: 6}"};
    ld_model *model;
    ld_messages messages;
    ld_status status;
    ld_loop *loop;
    ld_loop_margins margins;
    ld_error error;
    assert_int_equal(ld_scenario_read(LD_SOURCE_DIR "/examples/reference.yaml", sets,
                                      sizeof sets / sizeof *sets, &model, &messages),
                     LD_OK);
    assert_int_equal(ld_loop_create(model, "elevation", &loop, &error), LD_OK);
    ld_loop_margins_of(loop, &margins);
    ld_loop_free(loop);
    char *text = optimise(model, NULL, &status);
    const char *limit = strstr(text, "\"subject_to\"");
    assert_non_null(limit);
    CHECK_BELOW("gain margin (relative)", number_in(limit, "scenario", "value") / margins.raise - 1,
                1e-14);
    CHECK_WITHIN("at first", number_in(limit, "scenario", "value"), 1.5, 1.65);
    CHECK_WITHIN("found", number_in(limit, "found", "value"), 2, 10);
    free(text);
    ld_model_free(model);
}

// ---- candidates without launches

// Beyond 15 kN the lock holds the rocket: the latest release, against all advice, is below.
static void some_cannot_be_launched(void **state)
{
    (void)state;
    static const char *const sets[] = {
        "rocket.lock.release_force=14 kN",
        "optimise={over: {rocket.lock.release_force: [1 kN, 30 kN]}, least: {of: exit_speed}, "
        "evaluations: 30}",
        NULL};
    ld_model *model = make_model(sets);
    ld_optimisation *of;
    ld_error error;
    assert_int_equal(ld_optimise_create(model, &of, &error), LD_OK);
    assert_int_equal(ld_optimise_run(of, NULL, &error), LD_OK);
    char *json = text_of(of, true), *text = text_of(of, false);
    assert_true(number_in(json, NULL, "failed") >= 1);
    assert_non_null(strstr(text, "without launches count as not allowed; the first: "));
    assert_true(number_in(strstr(json, "\"keys\""), NULL, "found") < 15e3);
    free(text);
    free(json);
    ld_optimise_free(of);
    ld_model_free(model);
}

// ---- what is refused

#define OVER "over: {rocket.mass: [50 kg, 70 kg]}, "
typedef struct refusal {
    const char *set[3];
    const char *message;
} refusal;

static void refused(void **state)
{
    (void)state;
    static const refusal cases[] = {
        {{NULL}, "no block optimise"},
        {{"optimise={" OVER "least: {of: t_raer}}"}, "did you mean \"t_rear\"?"},
        {{"optimise={" OVER "least: {of: downrange}}", "run.end=landing"}, "which is no aim"},
        {{"optimise={" OVER "least: {take: quantile, of: range}}"}, "which is no aim"},
        {{"optimise={" OVER "least: {of: t_rear}, subject_to: [{of: drift, at_most: 1 m}]}"},
         "which is no aim"},
        {{"optimise={" OVER "least: {of: measure.far}}",
          "measures=[{name: far, of: rocket.x, take: value, at: t_impact}]", "run.end=landing"},
         "which is no aim"},
        {{"optimise={" OVER "least: {of: measure.miss}}",
          "measures={off: downrange-4 km, miss: abs(measure.off)}", "run.end=landing"},
         "which is no aim"},
        {{"optimise={" OVER "least: {of: measure.miss}}", "measures={miss: rocket.z at t_impact}",
          "run.end=landing"},
         "which is no aim"},
        {{"optimise={" OVER "least: {take: gain_margin, of: elevation}}"},
         "a margin is a constraint"},
        {{"optimise={" OVER "least: {take: deviation, of: yaw}}"}, "at least 3 launches"},
        {{"optimise={" OVER "least: {take: deviation, of: yaw, and: yaw_rate}}"},
         "different units"},
        {{"optimise={over: {rocket.mass: [61 kg, 70 kg]}, least: {of: t_rear}}"},
         "which is outside the bounds"},
        {{"optimise={over: {rocket.mass: [70 kg, 50 kg]}, least: {of: t_rear}}"}, "rising order"},
        {{"optimise={over: {rocket.mass: [0.1 kg]}, least: {of: t_rear}}"}, "expected bounds"},
        {{"optimise={over: {rocket.mass_error: [-1 kg, 1 kg, log]}, least: {of: t_rear}}"},
         "by the logarithm"},
        {{"optimise={over: {tubes.modes.bending: [1, 3]}, least: {of: t_rear}}"}, "whole number"},
        {{"optimise={over: {rocket.mass: [50 m, 70 kg]}, least: {of: t_rear}}"}, "wrong dimension"},
        {{"optimise={" OVER "least: {of: t_rear}, subject_to: [{of: yaw}]}"},
         "expected at_most or at_least"},
        {{"optimise={" OVER "least: {of: t_rear}, method: bobyqa, subject_to: [{of: yaw, at_most: "
          "1 deg}]}"},
         "BOBYQA takes no constraints"},
        {{"optimise={" OVER "least: {of: t_rear}}", "sweep={rocket.mass: [60 kg]}"},
         "leave out the sweep"},
        {{"optimise={" OVER "least: {of: t_rear}}",
          "scatter={samples: 3, factors: {rocket.mass: {uniform: 59 61 kg}}}"},
         "samples this key whatever its value"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const char *const sets[] = {cases[i].set[0], cases[i].set[1], cases[i].set[2], NULL};
        ld_model *model;
        ld_messages messages = {0};
        ld_error error = {0};
        if (read_model(sets, &model, &messages)) {
            snprintf(error.text, sizeof error.text, "%s", messages.item[0].text);
            ld_messages_free(&messages);
        } else {
            ld_optimisation *of;
            assert_int_equal(ld_optimise_create(model, &of, &error), LD_ERR_INPUT);
            ld_model_free(model);
        }
        if (!strstr(error.text, cases[i].message))
            fail_msg("case %zu: \"%s\" has no \"%s\"", i, error.text, cases[i].message);
        assert_null(strchr(error.text, '\n'));
    }
}

// No start has a launch.
static void nowhere(void **state)
{
    (void)state;
    static const char *const sets[] = {
        "rocket.lock.release_force=20 kN",
        "optimise={over: {rocket.lock.release_force: [16 kN, 30 kN]}, least: {of: exit_speed}, "
        "starts: 2}",
        NULL};
    ld_model *model = make_model(sets);
    ld_status status;
    assert_null(optimise(model, NULL, &status));
    assert_int_equal(status, LD_ERR_LAUNCH);
    ld_model_free(model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(at_the_limit),
        cmocka_unit_test(the_samples_of_a_study),
        cmocka_unit_test(it_continues),
        cmocka_unit_test(margins_of_a_loop),
        cmocka_unit_test(some_cannot_be_launched),
        cmocka_unit_test(refused),
        cmocka_unit_test(nowhere),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
