// run.max_step: what its default saves where the tolerance is coarse, and that a touch that comes
// and goes within a few milliseconds of smooth motion is found with it, as it is not without.
#include <string.h>

#include "model/model.h"
#include "scenario/scenario.h"
#include "support/check.h"
#include "support/recorded_run.h"

static ld_model read_model(const char *text, const char *tolerance, const char *max_step)
{
    char set[2][64];
    const char *sets[] = {set[0], set[1]};
    ld_model model;
    ld_messages messages;
    snprintf(set[0], sizeof set[0], "run.tolerance=%s", tolerance);
    snprintf(set[1], sizeof set[1], "run.max_step=%s", max_step ? max_step : "");
    ld_status status = scenario_read_text(text, strlen(text), "text", LD_SOURCE_DIR "/examples",
                                          sets, max_step ? 2 : 1, &model, &messages);
    ld_messages_print(&messages, stdout);
    assert_int_equal(status, LD_OK);
    return model;
}

// max_step NULL: the default
static ld_summary run(const char *text, const char *tolerance, const char *max_step)
{
    ld_model model = read_model(text, tolerance, max_step);
    ld_summary summary = summary_of_run(&model);
    model_clear(&model);
    return summary;
}

static double evaluations(const char *text, const char *tolerance, const char *max_step)
{
    return (double)run(text, tolerance, max_step).statistics.rhs_evaluations;
}

// Of the default over those at 0.2 ms. Six bending modes are as stiff as steps of 0.2 ms can be:
// longer ones are tried and taken back.
static void coarse_runs_cost_less(void **state)
{
    (void)state;
    static const struct {
        const char *what, *modes;
        double low, high;
    } of[] = {{"evaluations, 2 bending, 1 torsion mode, of 0.2 ms", "{bending: 2, torsion: 1}", 0.5,
               0.53},
              {"evaluations, 3 bending, 2 torsion modes", "{bending: 3}", 0.63, 0.66},
              {"evaluations, 6 bending, 2 torsion modes", "{bending: 6}", 1.05, 1.12}};
    for (size_t i = 0; i < sizeof of / sizeof of[0]; i++) {
        char text[128];
        snprintf(text, sizeof text, "include: fixed.yaml\ntubes: {modes: %s}\n", of[i].modes);
        CHECK_WITHIN(of[i].what,
                     evaluations(text, "1e-3", NULL) / evaluations(text, "1e-3", "0.2 ms"),
                     of[i].low, of[i].high);
    }
}

static void fine_runs_stay(void **state)
{
    (void)state;
    static const char text[] = "include: fixed.yaml\n";
    for (int i = 0; i < 2; i++) {
        const char *tolerance = i ? "1e-6" : "1e-5";
        ld_summary by_default = run(text, tolerance, NULL), given = run(text, tolerance, "0.2 ms");
        assert_memory_equal(&by_default.rocket[0].exit, &given.rocket[0].exit,
                            sizeof given.rocket[0].exit);
        assert_int_equal(by_default.statistics.rhs_evaluations, given.statistics.rhs_evaluations);
    }
}

// A straight smooth bore on soft supports heaves about a rocket that touches nothing: its middle
// adaptor is touched once, for half a millisecond, 10 um short of not at all, which turns the
// rocket; the clearances are wide so that the tube comes fast, and smoothly.
static const char graze[] =
    "include: fixed.yaml\n"
    "environment: {gravity: 0 m/s2}\n"
    "base: {kind: prescribed, elevation: 0 deg,\n"
    "  motion: {heave: [{amplitude: 10 mm, frequency: 8 Hz, phase: 90 deg}]}}\n"
    "tubes:\n"
    "  modes: {bending: 1, torsion: 0}\n"
    "  slot: none\n"
    "  material: {youngs_modulus: 6 GPa}\n"
    "  supports:\n"
    "    - {at: 0.4 m, stiffness: 2e5 2e5 2e5 N/m, damping: 0 0 0 N.s/m,\n"
    "       rotational_stiffness: 2e4 2e4 2e4 N.m/rad, rotational_damping: 0 0 0 N.m.s/rad}\n"
    "    - {at: 1.8 m, stiffness: 2e5 2e5 2e5 N/m, damping: 0 0 0 N.s/m,\n"
    "       rotational_stiffness: 2e4 2e4 2e4 N.m/rad, rotational_damping: 0 0 0 N.m.s/rad}\n"
    "rocket:\n"
    "  contact: {stiffness: 5e8 N/m}\n"
    "  adaptors: [{name: rear, at: 0 m, clearance: 80 mm},\n"
    "    {name: middle, at: 1.2 m, clearance: 24.315 mm},\n"
    "    {name: front, at: 1.9 m, clearance: 80 mm}]\n"
    "run: {start: undeformed}\n";

static void a_touch_is_found(void **state)
{
    (void)state;
    static const struct {
        const char *tolerance;
        double bound;
    } of[] = {{"1e-3", 0.12}, {"1e-4", 0.02}, {"1e-5", 0.006}, {"1e-6", 0.004}};
    double rate = run(graze, "1e-9", NULL).rocket[0].pitch_rate;
    CHECK_WITHIN("pitch rate after the touch [mrad/s]", 1e3 * rate, -1.56, -1.53);
    for (size_t i = 0; i < sizeof of / sizeof of[0]; i++) {
        double found = run(graze, of[i].tolerance, NULL).rocket[0].pitch_rate;
        printf("    at %s", of[i].tolerance);
        CHECK_BELOW("error of it over it, default step", found / rate - 1, of[i].bound);
    }
}

static void longer_steps_pass_over_it(void **state)
{
    (void)state;
    double rate = run(graze, "1e-9", NULL).rocket[0].pitch_rate;
    static const char *const of[][2] = {{"1e-3", "7 ms"}, {"1e-4", "5 ms"}};
    for (int i = 0; i < 2; i++) {
        ld_summary summary = run(graze, of[i][0], of[i][1]);
        assert_true(summary.rocket[0].max_contact_force[1] == 0);
        printf("    at %s, %s", of[i][0], of[i][1]);
        CHECK_BELOW("pitch rate over that after the touch", summary.rocket[0].pitch_rate / rate,
                    0.01);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(coarse_runs_cost_less),
        cmocka_unit_test(fine_runs_stay),
        cmocka_unit_test(a_touch_is_found),
        cmocka_unit_test(longer_steps_pass_over_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
