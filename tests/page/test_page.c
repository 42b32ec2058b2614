// What the worker of the page that simulates calls, beside the files that the same run writes.
#include "page/page.h"

#include <string.h>
#include <unistd.h>

#include "base/text_file.h"
#include "launchdyn/output.h"
#include "launchdyn/scenario.h"
#include "launchdyn/simulation.h"
#include "launchdyn/summary.h"
#include "support/check.h"
#include "support/scratch.h"

static char *text_of(const char *path)
{
    char *text = NULL;
    size_t length;
    ld_error error;
    assert_int_equal(text_file_read(path, 1 << 26, &text, &length, &error), LD_OK);
    return text;
}

static char *fixed(void)
{
    return text_of(LD_SOURCE_DIR "/examples/fixed.yaml");
}

// The same run into a folder.
static void run_here(const char *const *sets, size_t count)
{
    ld_model *model;
    ld_simulation *simulation;
    ld_output *output;
    ld_messages messages;
    ld_error error;
    ld_summary *summary = ld_summary_new();
    assert_int_equal(
        ld_scenario_read(LD_SOURCE_DIR "/examples/fixed.yaml", sets, count, &model, &messages),
        LD_OK);
    assert_int_equal(ld_simulation_create(model, &simulation, &error), LD_OK);
    assert_int_equal(ld_output_open(in("run"), model, true, &output, &error), LD_OK);
    const ld_run_options options = {.sink = ld_output_sink(output)};
    ld_simulation_run(simulation, &options, summary, &error);
    assert_int_equal(ld_output_finish(output, summary, &error), LD_OK);
    ld_summary_free(summary);
    ld_simulation_free(simulation);
    ld_model_free(model);
}

static void check_columns(const page_core *core)
{
    char *written = text_of(in("run/history.csv"));
    assert_int_equal(page_write_csv(core, 0, in("page.csv")), LD_OK);
    char *kept = text_of(in("page.csv"));
    assert_string_equal(kept, written);
    assert_int_equal(page_write_csv(core, 1, in("page.csv")), LD_ERR_INPUT); // none has flown
    free(kept);
    free(written);
}

static void test_run(void **state)
{
    static const char *const set[] = {"rocket.mass=61 kg", "run.output_step=1 ms"};
    char sets[] = "rocket.mass=61 kg\nrun.output_step=1 ms\n";
    char *scenario = fixed();
    page_core *core = page_new("/");
    (void)state;
    run_here(set, 2);
    assert_int_equal(page_run(core, scenario, sets), LD_OK);
    assert_string_equal(page_text(core, PAGE_MESSAGES), "");
    check_columns(core);
    assert_non_null(strstr(page_text(core, PAGE_SCENARIO), "mass: 61 kg"));
    assert_non_null(strstr(page_text(core, PAGE_SUMMARY), "\"exit_speed\""));
    assert_non_null(strstr(page_text(core, PAGE_DATA), "\"kind\":\"launch\""));
    page_free(core);
    free(scenario);
}

// A run that its own limits end leaves what there is, and says why.
static void test_ended_early(void **state)
{
    static const char *const set[] = {"rocket.lock.release_force=50 kN", "run.output_step=20 ms"};
    char sets[] = "rocket.lock.release_force=50 kN\nrun.output_step=20 ms";
    char *scenario = fixed();
    page_core *core = page_new("/");
    (void)state;
    run_here(set, 2);
    assert_int_equal(page_run(core, scenario, sets), LD_ERR_LAUNCH);
    printf("    %s", page_text(core, PAGE_MESSAGES));
    assert_true(strlen(page_text(core, PAGE_MESSAGES)) > 20);
    check_columns(core);
    page_free(core);
    free(scenario);
}

static void test_wrong_scenario(void **state)
{
    char none[] = "", wrong[] = "rocket.mas=61 kg";
    char *scenario = fixed();
    page_core *core = page_new("/");
    (void)state;
    assert_int_equal(page_run(core, "launchdyn: 1\nbase: {kind: fixd}\n", none), LD_ERR_INPUT);
    assert_non_null(
        strstr(page_text(core, PAGE_MESSAGES), "scenario.yaml:2:14: error: base.kind: "));
    assert_string_equal(page_text(core, PAGE_SUMMARY), "");
    assert_int_equal(page_write_csv(core, 0, in("page.csv")), LD_ERR_INPUT);
    assert_int_equal(page_run(core, scenario, wrong), LD_ERR_INPUT);
    assert_non_null(strstr(page_text(core, PAGE_MESSAGES), "did you mean \"mass\"?"));
    page_free(core);
    free(scenario);
}

static void test_values(void **state)
{
    char sets[] = "rocket.mass=61 kg";
    char *scenario = fixed();
    page_core *core = page_new("/");
    (void)state;
    assert_int_equal(
        page_values(core, scenario, sets, "rocket.mass\nbase.speed\nrocket.no_such\nbase.kind"),
        LD_OK);
    assert_string_equal(page_text(core, PAGE_VALUES), "61 kg\n\n\nfixed\n");
    char none[] = "";
    assert_int_equal(page_values(core, "launchdyn: 2\n", none, "rocket.mass"), LD_ERR_INPUT);
    assert_non_null(strstr(page_text(core, PAGE_MESSAGES), "error: launchdyn: "));
    page_free(core);
    free(scenario);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_run), cmocka_unit_test(test_ended_early),
        cmocka_unit_test(test_wrong_scenario), cmocka_unit_test(test_values)};
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
