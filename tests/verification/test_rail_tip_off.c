// Figures of docs/rail.md: a rail that hardly gives against the closed form of a rigid rocket that
// pivots on its rear shoe, and the rail of examples/rail/pad.yaml against what the page says.
// ctest: slow
#include "model/model.h"
#include "support/check.h"

#include <stdlib.h>

#include "scenario/scenario.h"
#include "support/recorded_run.h"

#define CALM "environment.wind.speed=0 m/s"
#define NO_GAPS "tubes.guide.t_slot.gap=0 mm", "tubes.guide.t_slot.side_gap=0 mm"
#define STIFF                                                                                      \
    NO_GAPS, "tubes.sections.1.bending_stiffness_y=4e8 N.m2",                                      \
        "tubes.sections.1.bending_stiffness_z=9e8 N.m2",                                           \
        "tubes.sections.1.torsion_stiffness=3e8 N.m2", "tubes.sections.1.axial_stiffness=2.3e11 N"

static ld_rocket_summary launch(const char *const *set, size_t count)
{
    static ld_summary summary;
    ld_model model;
    ld_messages messages;
    if (scenario_read(LD_SOURCE_DIR "/examples/rail/pad.yaml", set, count, &model, &messages)) {
        ld_messages_print(&messages, stdout);
        fail();
    }
    summary = summary_of_run(&model);
    model_clear(&model);
    return summary.rocket[0];
}

static void stiff_rail_is_near_the_closed_form(void **state)
{
    (void)state;
    static const char *const stiff[] = {STIFF, CALM};
    ld_rocket_summary rocket = launch(stiff, 7);
    CHECK_WITHIN("pitch rate, over -64.71 mrad/s", rocket.tip_off.pitch_rate / -64.71e-3, 0.97,
                 1.03);
    CHECK_WITHIN("yaw rate, over -1.41 mrad/s", rocket.tip_off.yaw_rate / -1.41e-3, 0.93, 1.03);
}

static void soft_rail_swings(void **state)
{
    (void)state;
    static const char *const gapless[] = {CALM, NO_GAPS};
    CHECK_NEAR("pitch rate [mrad/s]", 1e3 * launch(gapless, 1).tip_off.pitch_rate, -67.0, 0.5);
    CHECK_NEAR("without gaps [mrad/s]", 1e3 * launch(gapless, 3).tip_off.pitch_rate, -60.7, 0.5);
}

static void wind_turns_as_it_does_a_rigid_rocket(void **state)
{
    (void)state;
    static const char *const stiff[] = {STIFF, "environment.wind={speed: 10 m/s, heading: 90 deg}",
                                        "rocket.aerodynamics.crossflow={drag: 23, at: 1.3 m}"};
    CHECK_WITHIN("yaw rate, over -22.77 mrad/s", launch(stiff, 8).tip_off.yaw_rate / -22.77e-3,
                 0.97, 1.03);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stiff_rail_is_near_the_closed_form),
        cmocka_unit_test(soft_rail_swings),
        cmocka_unit_test(wind_turns_as_it_does_a_rigid_rocket),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
