// The public structs keep their sizes: programs are compiled with them (docs/interface.md). A size
// that changes here breaks programs, and requires a new version in cmake/exports.map.
#include "support/check.h"

#include "launchdyn/compare.h"
#include "launchdyn/derivatives.h"
#include "launchdyn/environment.h"
#include "launchdyn/fit.h"
#include "launchdyn/fmu.h"
#include "launchdyn/history.h"
#include "launchdyn/loop.h"
#include "launchdyn/model.h"
#include "launchdyn/mstmm.h"
#include "launchdyn/optimise.h"
#include "launchdyn/origin.h"
#include "launchdyn/output.h"
#include "launchdyn/report.h"
#include "launchdyn/response_view.h"
#include "launchdyn/results.h"
#include "launchdyn/run.h"
#include "launchdyn/scenario.h"
#include "launchdyn/section.h"
#include "launchdyn/simulation.h"
#include "launchdyn/status.h"
#include "launchdyn/study.h"
#include "launchdyn/study_data.h"
#include "launchdyn/summary.h"
#include "launchdyn/version.h"

// where pointers and sizes have 64 bits
#define SIZE(type, bytes)                                                                          \
    _Static_assert(sizeof(void *) != 8 || sizeof(type) == (bytes), #type " has another size")

// Asked for by the caller: may grow into what is reserved.
SIZE(ld_compare_options, 80);
SIZE(ld_fit_options, 80);
SIZE(ld_fmu_options, 56);
SIZE(ld_derivative_key, 16);
SIZE(ld_derivative_options, 64);
SIZE(ld_optimise_options, 72);
SIZE(ld_picture, 80);
SIZE(ld_scene, 16);
SIZE(ld_response_wish, 96);
SIZE(ld_watch, 16);
SIZE(ld_run_options, 64);
SIZE(ld_sink, 72);
SIZE(ld_study_range, 16);
SIZE(ld_study_options, 72);
SIZE(ld_study_over, 64);
SIZE(ld_study_question, 64);
SIZE(ld_study_view, 48);
SIZE(ld_mstmm_beam, 88);
SIZE(ld_mstmm_description, 80);
SIZE(ld_mstmm_element, 360);
SIZE(ld_mstmm_loop, 336);
SIZE(ld_mstmm_settings, 80);

// Handed out one by one: may grow at their ends, up to which programs know them.
SIZE(ld_compared_clock, 24);
SIZE(ld_compared_result, 104);
SIZE(ld_compared_series, 200);
SIZE(ld_key, 56);
SIZE(ld_quantity, 32);
SIZE(ld_study_cell, 96);
SIZE(ld_study_column, 24);
SIZE(ld_study_footprint, 104);
SIZE(ld_study_influence, 152);
SIZE(ld_study_point, 40);
SIZE(ld_study_statistics, 160);
SIZE(ld_study_values, 32);

// In the caller's memory, or one beside the other: stay as they are.
SIZE(ld_array, 48);
SIZE(ld_base_frame, 104);
SIZE(ld_base_wrench, 48);
SIZE(ld_column, 24);
SIZE(ld_error, 644);
SIZE(ld_estimate, 24);
SIZE(ld_event, 24);
SIZE(ld_fact, 16);
SIZE(ld_validation, 56);
SIZE(ld_figure, 16);
SIZE(ld_loop_margins, 80);
SIZE(ld_loop_point, 48);
SIZE(ld_message, 40);
SIZE(ld_messages, 16);
SIZE(ld_mode, 88);
SIZE(ld_origin, 40);
SIZE(ld_phasor, 16);
SIZE(ld_pole, 80);
SIZE(ld_report, 2072);
SIZE(ld_section, 96);
SIZE(ld_stretch, 24);
SIZE(ld_fit_counts, 24);
SIZE(ld_fit_key, 40);
SIZE(ld_optimise_counts, 32);
SIZE(ld_study_counts, 48);
SIZE(ld_wind_section, 40);
SIZE(ld_mstmm_assembly, 40);
SIZE(ld_mstmm_end, 64);
SIZE(ld_mstmm_energies, 24);
SIZE(ld_mstmm_mode, 24);
SIZE(ld_mstmm_overall, 272);
SIZE(ld_mstmm_point, 104);
SIZE(ld_mstmm_statistics, 16);

// What is reserved must stay zeros: an initialiser that does not name it makes it so.
static void test_what_is_reserved_is_null(void **state)
{
    (void)state;
    const ld_run_options options = {.self = state};
    const ld_sink sink = {.self = state};
    for (int i = 0; i < 4; i++)
        assert_true(!options.reserved[i] && !sink.reserved[i]);
}

static void test_version(void **state)
{
    (void)state;
    int major, minor, patch;
    assert_string_equal(ld_version(), LD_VERSION);
    assert_int_equal(sscanf(ld_version(), "%d.%d.%d", &major, &minor, &patch), 3);
    assert_int_equal(ld_version_number(), 10000 * major + 100 * minor + patch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_is_reserved_is_null),
        cmocka_unit_test(test_version),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
