// Sensitivities of real studies: against derivatives of the flights themselves; the same bits
// however they are run; what is said of them and refused.
#include "support/study_run.h"

#include <stdatomic.h>
#include <stdlib.h>

#include "base/memory_stream.h"
#include "launchdyn/report.h"
#include "launchdyn/simulation.h"
#include "launchdyn/study_data.h"
#include "studies/plan/study.h"

// Five factors of a flight, the last without influence on how far it goes; nearly linear.
#define FLIGHT                                                                                     \
    "include: flight.yaml\n"                                                                       \
    "environment:\n"                                                                               \
    "  wind: {speed: 4 m/s}\n"                                                                     \
    "run: {flight_tolerance: 1e-9}\n"                                                              \
    "scatter:\n"                                                                                   \
    "  samples: 512\n"                                                                             \
    "  plan: saltelli\n"                                                                           \
    "  factors:\n"                                                                                 \
    "    rocket.motor.thrust_scale: {normal: 1 %}\n"                                               \
    "    environment.density_scale: {uniform: +- 3 %}\n"                                           \
    "    environment.temperature_offset: {normal: 5 K}\n"                                          \
    "    environment.wind.add.x: {normal: 3 m/s}\n"                                                \
    "    run.flight_limit: {uniform: 500 600 s}\n"
static const char flight[] = FLIGHT;
enum { FACTORS = 5 };

static ld_study_data *open_data(const char *name)
{
    ld_study_data *data;
    ld_error error;
    if (ld_study_data_open(in(name), &data, &error))
        fail_msg("%s", error.text);
    return data;
}

static const ld_study_influence *influences(ld_study_data *data, const char *result, size_t *count)
{
    const ld_study_influence *list;
    ld_error error;
    if (ld_study_data_influences(data, 1, result, &list, count, &error))
        fail_msg("%s", error.text);
    return list;
}

static const ld_study_influence *influence_of(const ld_study_influence *list, size_t count,
                                              const char *factor)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(list[i].factor, factor) == 0)
            return &list[i];
    fail_msg("there is no factor %s", factor);
    return NULL;
}

// ---- against derivatives

// How far the flight goes with an override.
static double downrange(const char *set)
{
    ld_study *study = study_with(flight, set);
    const ld_model *model = ld_study_model(study);
    ld_simulation *simulation;
    ld_summary *summary = calloc(1, sizeof *summary);
    ld_error error;
    assert_non_null(summary);
    assert_int_equal(ld_simulation_create(model, &simulation, &error), LD_OK);
    assert_int_equal(ld_simulation_run(simulation, NULL, summary, &error), LD_OK);
    double range = summary->rocket[0].flight.downrange;
    ld_simulation_free(simulation);
    free(summary);
    ld_study_free(study);
    return range;
}

typedef struct moved_factor {
    const char *path;
    const char *low, *high; // overrides one deviation below and above
} moved_factor;
static const moved_factor moved[] = {
    {"rocket.motor.thrust_scale", "rocket.motor.thrust_scale=0.99",
     "rocket.motor.thrust_scale=1.01"},
    {"environment.density_scale", "environment.density_scale=0.98267949",
     "environment.density_scale=1.01732051"},
    {"environment.temperature_offset", "environment.temperature_offset=-5 K",
     "environment.temperature_offset=5 K"},
    {"environment.wind.add.x", "environment.wind.add=-3 0 0 m/s", "environment.wind.add=3 0 0 m/s"},
};
enum { MOVED = sizeof moved / sizeof *moved };

// Of a nearly linear result the shares are those of its derivatives.
static void test_derivatives(void **state)
{
    (void)state;
    size_t count;
    double share[MOVED], all = 0;
    for (int i = 0; i < MOVED; i++) {
        share[i] = pow(0.5 * (downrange(moved[i].high) - downrange(moved[i].low)), 2);
        all += share[i];
    }
    static const char *const ways[] = {NULL, "scatter.replicates=8"};
    for (int way = 0; way < 2; way++) {
        const char *name = way ? "points" : "rows";
        ld_study *study = study_with(flight, ways[way]);
        const ld_study_counts counts = study_run(study, name, 2);
        assert_true(counts.done == 512 * (FACTORS + 2) && counts.failed == 0);
        ld_study_data *data = open_data(name);
        const ld_study_influence *list = influences(data, "downrange", &count);
        assert_int_equal(count, FACTORS);
        for (int i = 0; i < MOVED; i++) {
            const ld_study_influence *of = influence_of(list, count, moved[i].path);
            char what[80];
            printf("    %-32s %.4f first %.4f [%.4f, %.4f] total %.4f [%.4f, %.4f]\n",
                   moved[i].path, share[i] / all, of->first.value, of->first.low, of->first.high,
                   of->total.value, of->total.low, of->total.high);
            snprintf(what, sizeof what, "%s: first", moved[i].path);
            CHECK_NEAR(what, of->first.value, share[i] / all,
                       0.75 * (of->first.high - of->first.low));
            snprintf(what, sizeof what, "%s: total", moved[i].path);
            CHECK_NEAR(what, of->total.value, share[i] / all,
                       0.75 * (of->total.high - of->total.low));
            assert_int_equal(of->groups, way ? 8 : 512);
            assert_int_equal(of->count, 512);
            assert_true(i == 0 || isnan(of->mu_star.value));
        }
        const ld_study_influence *inert = influence_of(list, count, "run.flight_limit");
        assert_true(inert->total.value == 0 && inert->total.low == 0 && inert->total.high == 0);
        assert_true(fabs(inert->first.value) < 1e-12 && fabs(inert->first.high) < 1e-12);
        for (size_t i = 1; i < count; i++)
            assert_true(list[i - 1].total.value >= list[i].total.value);
        ld_study_data_close(data);
        ld_study_free(study);
    }
}

static void test_effects(void **state)
{
    (void)state;
    size_t count;
    ld_study *study = study_with(flight, "scatter.plan=morris");
    study_run(study, "morris", 2);
    ld_study_data *data = open_data("morris");
    const ld_study_influence *list = influences(data, "downrange", &count);
    // a normal number goes from 0.05 to 0.65 or back: 2.0302 deviations in 0.6
    const double deviations = (0.38532047 + 1.64485363) / 0.6;
    for (int i = 0; i < MOVED; i++) {
        const ld_study_influence *of = influence_of(list, count, moved[i].path);
        double slope = 0.5 * (downrange(moved[i].high) - downrange(moved[i].low));
        double expected = slope * (i == 1 ? sqrt(12) : deviations);
        CHECK_NEAR(moved[i].path, of->mu.value, expected, 0.03 * fabs(expected));
        CHECK_NEAR("    its magnitude", of->mu_star.value, fabs(of->mu.value), 1e-9);
        assert_int_equal(of->count, 512);
        assert_true(isnan(of->total.value) && isnan(of->first.value));
    }
    ld_study_data_close(data);
    ld_study_free(study);
}

// ---- however it is run

static bool ten_more(void *self)
{
    return atomic_load((atomic_int *)self) < 10;
}

static void count_one(void *self, const ld_study_counts *counts)
{
    (void)counts;
    atomic_fetch_add((atomic_int *)self, 1);
}

static void run_in_parts(const ld_study *study, const char *name)
{
    ld_status status = LD_ERR_INTERRUPTED;
    for (int runs = 0; status == LD_ERR_INTERRUPTED && runs < 60; runs++) {
        atomic_int done = 0;
        ld_error error;
        ld_study_counts counts;
        ld_study_options options = {
            .threads = 2, .self = &done, .progress = count_one, .go_on = ten_more};
        status = ld_study_run(study, in(name), &options, &counts, &error);
    }
    assert_int_equal(status, LD_OK);
}

// Stopped and continued, in shards, with more rows later: the same table.
static void test_same_bits(void **state)
{
    (void)state;
    static const char *const plans[] = {"scatter.plan=saltelli", "scatter.plan=morris"};
    for (int k = 0; k < 2; k++) {
        const char *sets[] = {plans[k], "scatter.samples=8"};
        ld_study *few, *all;
        ld_messages messages;
        ld_error error;
        ld_study_counts counts;
        char whole[32], parts[32], shards[32];
        snprintf(whole, sizeof whole, "whole-%d", k);
        snprintf(parts, sizeof parts, "parts-%d", k);
        snprintf(shards, sizeof shards, "shards-%d", k);
        assert_int_equal(ld_study_read_text(flight, strlen(flight), "text",
                                            LD_SOURCE_DIR "/examples", sets, 2, &few, &messages),
                         LD_OK);
        sets[1] = "scatter.samples=20";
        assert_int_equal(ld_study_read_text(flight, strlen(flight), "text",
                                            LD_SOURCE_DIR "/examples", sets, 2, &all, &messages),
                         LD_OK);
        study_run(all, whole, 1);
        study_run(few, parts, 2);
        run_in_parts(all, parts);
        expect_same_tables(whole, parts);
        for (int i = 1; i <= 3; i++)
            assert_int_equal(ld_study_run(all, in(shards),
                                          &(ld_study_options){.shard = i, .shards = 3}, &counts,
                                          &error),
                             LD_OK);
        FILE *silent = fopen("/dev/null", "w");
        assert_int_equal(ld_study_merge(in(shards), silent, &error), LD_OK);
        fclose(silent);
        expect_same_tables(whole, shards);
        ld_study_free(few);
        ld_study_free(all);
    }
}

// ---- what is said

static char *shown_text(const char *name, const ld_study_view *view, ld_status expected)
{
    char *text = NULL;
    size_t length;
    ld_error error = {.text = ""};
    FILE *stream = memory_stream(&text, &length);
    assert_non_null(stream);
    assert_int_equal(ld_study_show(in(name), view, stream, &error), expected);
    if (expected)
        fputs(error.text, stream);
    fclose(stream);
    return text;
}

static void expect_text(const char *name, const ld_study_view *view, ld_status status,
                        const char *part)
{
    char *text = shown_text(name, view, status);
    if (!strstr(text, part))
        fail_msg("\"%s\" is not in:\n%s", part, text);
    free(text);
}

static void test_said(void **state)
{
    (void)state;
    const char what[] = "downrange";
    expect_text("rows", &(ld_study_view){.what = what, .sensitivity = true}, LD_OK,
                "downrange: % of its variance, 95 % intervals; 512 complete rows");
    expect_text("rows", &(ld_study_view){.what = what, .sensitivity = true}, LD_OK,
                "total                          first order                    with others");
    expect_text("rows",
                &(ld_study_view){.what = what, .sensitivity = true, .index = LD_INDEX_FIRST}, LD_OK,
                "first order                    total                          with others");
    expect_text("rows", &(ld_study_view){.what = what, .sensitivity = true}, LD_OK,
                "environment.wind.add.x makes ");
    expect_text("rows", &(ld_study_view){.what = what, .sensitivity = true, .json = true}, LD_OK,
                "\"with_others\": {");
    expect_text("morris", &(ld_study_view){.what = what, .sensitivity = true}, LD_OK,
                "environment.wind.add.x moves downrange most; its effect is nearly the same");
    expect_text("morris", &(ld_study_view){.what = what, .sensitivity = true, .json = true}, LD_OK,
                "\"mu_star\": {");
    expect_text("morris", &(ld_study_view){.what = what}, LD_OK, "samples of Morris's plan");
    expect_text("rows",
                &(ld_study_view){.what = what, .sensitivity = true, .index = LD_INDEX_MORRIS},
                LD_ERR_INPUT,
                "--sensitivity morris requires samples of another plan: run launchdyn study FILE "
                "--sensitivity morris into a folder of its own");
    expect_text("morris",
                &(ld_study_view){.what = what, .sensitivity = true, .index = LD_INDEX_TOTAL},
                LD_ERR_INPUT, "--sensitivity total requires samples of another plan");
}

// The report says the same in its first sentence, and has the total beside the first order.
static void test_reported(void **state)
{
    (void)state;
    static const char *const parts[][3] = {
        {"rows", "\"says\":\"environment.wind.add.x makes ", "\"effects\":false"},
        {"morris", "\"says\":\"environment.wind.add.x moves downrange most", "\"effects\":true"}};
    for (int k = 0; k < 2; k++) {
        ld_report report;
        ld_error error = {.text = ""};
        char file[160], *page = calloc(1, 1 << 22), *at;
        const char *const folders[] = {in(parts[k][0])};
        snprintf(file, sizeof file, "%s.html", folders[0]);
        if (ld_report_write_studies(folders, 1, file, &report, &error))
            fail_msg("%s", error.text);
        FILE *stream = fopen(file, "r");
        assert_non_null(stream);
        assert_non_null(page);
        assert_true(fread(page, 1, (1 << 22) - 1, stream) > 0);
        fclose(stream);
        at = strstr(page, "\"sensitivities\":[");
        assert_non_null(at);
        at = strstr(at, "{\"name\":\"downrange\"");
        assert_non_null(at);
        assert_non_null(strstr(at, parts[k][1]));
        assert_non_null(strstr(at, parts[k][2]));
        // the first factor's path and three estimates, or one
        at = strstr(at, "[[\"environment.wind.add.x\",");
        assert_non_null(at);
        int estimates = 0;
        for (const char *c = at + 2; strncmp(c, "]]", 2) != 0 && strncmp(c, "]],[", 3) != 0; c++)
            estimates += *c == '[';
        assert_int_equal(estimates, k ? 1 : 3);
        free(page);
    }
}

static void test_plotted(void **state)
{
    (void)state;
    ld_error error = {.text = ""};
    char file[160];
    snprintf(file, sizeof file, "%s.svg", in("bars"));
    const ld_study_question question = {.what = "downrange,drift", .sensitivity = true};
    for (int k = 0; k < 2; k++)
        if (ld_study_plot(in(k ? "morris" : "rows"), &question, file, &error))
            fail_msg("%s", error.text);
    const ld_study_question none = {.what = "flight.max_mach,rocket.motor.thrust_scal",
                                    .sensitivity = true};
    assert_int_equal(ld_study_plot(in("rows"), &none, file, &error), LD_ERR_INPUT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_derivatives), cmocka_unit_test(test_effects),
        cmocka_unit_test(test_same_bits),   cmocka_unit_test(test_said),
        cmocka_unit_test(test_reported),    cmocka_unit_test(test_plotted),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
