// Stabilisers that cannot hold their platforms are refused before the run, and no others.
#include "launchdyn/scenario.h"
#include "model/model.h"
#include "quantities/summary.h"
#include "state/simulation.h"
#include "support/check.h"
#include "support/reference_model.h"

static ld_status start(ld_model *model, ld_error *error)
{
    ld_simulation *simulation;
    ld_summary summary = {0};
    model->run.end = LD_END_TIME;
    model->run.end_time = 1e-3;
    if (ld_simulation_create(model, &simulation, error))
        fail_msg("%s", error->text);
    ld_status status = ld_simulation_run(simulation, NULL, &summary, error);
    ld_simulation_free(simulation);
    return status;
}

static void unstable_stabiliser(void **state)
{
    (void)state;
    ld_model model;
    ld_error error;
    reference_vehicle(&model, 30 / 3.6);
    model.platform.elevation.stabiliser.ki = 1e9;
    assert_int_equal(start(&model, &error), LD_ERR_INPUT);
    printf("    %s\n", error.text);
    assert_non_null(strstr(error.text, "platform.elevation.stabiliser: unstable"));
    model.platform.elevation.stabiliser.ki = 6e6;
    model.platform.azimuth.stabiliser.ki = 1e9;
    assert_int_equal(start(&model, &error), LD_ERR_INPUT);
    assert_non_null(strstr(error.text, "platform.azimuth.stabiliser: unstable"));
    reference_model_free(&model);
}

// A parked trailer rolls freely: an eigenvalue of 0 twice, which errors of the differences part to
// +-0.046 1/s. Nothing of it grows.
static void a_rolling_trailer_does_not_grow(void **state)
{
    (void)state;
    ld_model *model;
    ld_error error;
    ld_messages messages = {0};
    ld_simulation *simulation;
    assert_int_equal(ld_scenario_read(LD_SOURCE_DIR "/tests/data/multibody/rolling.yaml", NULL, 0,
                                      &model, &messages),
                     LD_OK);
    if (ld_simulation_create(model, &simulation, &error))
        fail_msg("%s", error.text);
    CHECK_BELOW("growth of a rolling trailer [1/s]", simulation->growing.real, 0);
    ld_simulation_free(simulation);
    ld_model_free(model);
}

// Routh's bound for one platform on a base that stands still: J s^3 + kd s^2 + kp s + ki is stable
// for kp kd > J ki. A gain a little on either side of what the vehicle's chassis makes of it.
static void bound_of_the_integral_gain(void **state)
{
    (void)state;
    ld_model model;
    ld_error error;
    reference_vehicle(&model, 0);
    double stable = 6e6, unstable = 1e9;
    while (unstable / stable > 1.01) {
        double middle = sqrt(stable * unstable);
        model.platform.elevation.stabiliser.ki = middle;
        if (start(&model, &error))
            unstable = middle;
        else
            stable = middle;
    }
    // about the hinge, loaded, rigid tubes: J = kp kd/ki
    const ld_stabiliser *stabiliser = &model.platform.elevation.stabiliser;
    double inertia = stabiliser->kp * (stabiliser->kd + 800) / stable;
    CHECK_WITHIN("inertia that the bound of ki tells [kg m2]", inertia, 2900, 3300);
    reference_model_free(&model);
}

// Of a platform on a base that stands still, by PD through a lag of time T: J T s^3 + J s^2 + kd s
// + kp is stable for kd > T kp, whatever the inertia.
static void bound_of_the_lag(void **state)
{
    (void)state;
    ld_model model;
    ld_error error;
    reference_vehicle(&model, 0);
    ld_stabiliser *stabiliser = &model.platform.elevation.stabiliser;
    stabiliser->ki = 0;
    double stable = 100, unstable = 0.1;
    while (stable / unstable > 1.01) {
        double middle = sqrt(stable * unstable);
        stabiliser->bandwidth = middle;
        if (start(&model, &error)) {
            assert_non_null(strstr(error.text, "platform.elevation.stabiliser: unstable"));
            unstable = middle;
        } else {
            stable = middle;
        }
    }
    double ratio = 2 * 3.14159265358979324 * stable * stabiliser->kd / stabiliser->kp;
    CHECK_WITHIN("bandwidth over kp/kd", ratio, 0.9, 1.1);
    reference_model_free(&model);
}

// A vehicle whose wheels stand all but in one line tips over, and its own weight does the work: a
// stabiliser that gives a hundredth of it is not what makes it unstable.
static void vehicle_that_tips(void **state)
{
    (void)state;
    ld_model model;
    ld_error error = {0};
    ld_simulation *simulation;
    reference_vehicle(&model, 0);
    for (int i = 0; i < model.base.vehicle.wheel_count; i++)
        model.base.vehicle.wheel[i].mount[2] *= 0.1;
    assert_int_equal(start(&model, &error), LD_OK);
    assert_int_equal(ld_simulation_create(&model, &simulation, &error), LD_OK);
    CHECK_WITHIN("rate at which it tips [1/s]", simulation->growing.real, 0.5, 5);
    ld_simulation_free(simulation);
    reference_model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(unstable_stabiliser),
        cmocka_unit_test(a_rolling_trailer_does_not_grow),
        cmocka_unit_test(bound_of_the_integral_gain),
        cmocka_unit_test(bound_of_the_lag),
        cmocka_unit_test(vehicle_that_tips),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
