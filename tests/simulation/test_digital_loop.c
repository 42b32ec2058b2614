// A launch whose elevation is held by a digital loop: it comes to the continuous one as its period
// goes to nothing, as late as half a period and its delay; apart as together.
#include <math.h>
#include <string.h>

#include "model/model.h"
#include "quantities/summary.h"
#include "support/check.h"
#include "support/reference_model.h"

// A launch at 30 km/h over sines, by a loop of this period and delay, subsystems exchanging at this
// step (0: together).
static ld_rocket_summary launch(double sample, double delay, double exchange)
{
    ld_model model;
    ld_simulation *simulation;
    ld_summary summary = {0};
    ld_error error;
    reference_vehicle(&model, 30 / 3.6);
    ld_road *road = &model.base.vehicle.road;
    road->sine_count = 1;
    road->sine[0] = (ld_road_sine){.amplitude = 5e-3, .wavelength = 2.5};
    model.run.lead_in = 0.1;
    model.run.tolerance = 1e-8;
    model.run.coupling_step = exchange;
    model.platform.elevation.stabiliser.sample = sample;
    model.platform.elevation.stabiliser.delay = delay;
    if (ld_simulation_create(&model, &simulation, &error) ||
        ld_simulation_run(simulation, NULL, &summary, &error))
        fail_msg("%s", error.text);
    ld_simulation_free(simulation);
    reference_model_free(&model);
    return summary.rocket[0];
}

static double distance(const ld_rocket_summary *a, const ld_rocket_summary *b)
{
    return hypot(a->pitch_rate - b->pitch_rate, 50 * (a->pitch - b->pitch));
}

static void digital_loop(void **state)
{
    (void)state;
    ld_rocket_summary at_once = launch(0, 0, 0);
    ld_rocket_summary coarse = launch(1e-3, 0, 0), fine = launch(0.5e-3, 0, 0);
    ld_rocket_summary late = launch(0.5e-3, 0.5e-3, 0), half = launch(0.5e-3, 0.25e-3, 0);
    ld_rocket_summary apart = launch(0.5e-3, 0.25e-3, 0.1e-3);
    double error = distance(&fine, &at_once);
    CHECK_WITHIN("half a millisecond's difference [rad/s]", error, 1e-5, 1e-2);
    CHECK_WITHIN("a period of twice, over it", distance(&coarse, &at_once) / error, 1.9, 2.1);
    CHECK_WITHIN("late by half a period, over it", distance(&half, &at_once) / error, 1.9, 2.1);
    CHECK_WITHIN("late by a period, over it", distance(&late, &at_once) / error, 2.85, 3.15);
    CHECK_BELOW("apart against together [rad/s]", distance(&apart, &half), 1e-5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(digital_loop),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
