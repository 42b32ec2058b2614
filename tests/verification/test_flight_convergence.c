// The error of a flight follows its tolerance; a rocket that leaves a tube flies on as one that
// begins in flight with the same state.
#include "model/model.h"
#include "support/check.h"

#include <stdlib.h>

#include "scenario/scenario.h"
#include "support/recorded_run.h"

static ld_model read_model(const char *name, const char *const *sets, size_t count)
{
    ld_model model;
    ld_messages messages;
    char path[128];
    snprintf(path, sizeof path, LD_SOURCE_DIR "/examples/%s", name);
    if (scenario_read(path, sets, count, &model, &messages)) {
        ld_messages_print(&messages, stdout);
        fail();
    }
    return model;
}

static ld_rocket_summary fly(ld_model *model, double tolerance)
{
    model->run.flight_tolerance = tolerance;
    return summary_of_run(model).rocket[0];
}

static double impact_apart(const ld_rocket_summary *a, const ld_rocket_summary *b)
{
    return hypot(a->final.center[0] - b->final.center[0], a->final.center[2] - b->final.center[2]);
}

// Impact and apogee at 1e-5 .. 1e-9 against 1e-13: four decades of the tolerance, four of the
// error.
static void test_tolerance(void **state)
{
    (void)state;
    const char *const unbalanced[] = {"rocket.eccentricity=0.5 0 mm",
                                      "rocket.motor.misalignment=0 0.5 mrad"};
    for (size_t changes = 0; changes <= 2; changes += 2) {
        ld_model model = read_model("flight.yaml", unbalanced, changes);
        ld_rocket_summary exact = fly(&model, 1e-13);
        double impact[5], apogee[5];
        for (int i = 0; i < 5; i++) {
            ld_rocket_summary rocket = fly(&model, pow(10, -5 - i));
            impact[i] = impact_apart(&rocket, &exact);
            apogee[i] = fabs(rocket.flight.apogee - exact.flight.apogee);
            printf("    tolerance 1e-%d: impact %.1e m, apogee %.1e m\n", 5 + i, impact[i],
                   apogee[i]);
        }
        CHECK_BELOW("impact at 1e-5 [m]", impact[0], 1e-2);
        CHECK_BELOW("impact at the default, 1e-7 [m]", impact[2], 3e-4);
        CHECK_BELOW("impact at 1e-9 [m]", impact[4], 1e-5);
        CHECK_WITHIN("decades of the impact's error", log10(impact[0] / impact[4]), 2, 5);
        CHECK_WITHIN("decades of the apogee's error", log10(apogee[0] / apogee[4]), 1.5, 5);
        model_clear(&model);
    }
}

// The launch of the example to the ground, and its flight alone from the state at the exit.
static void test_hand_off(void **state)
{
    (void)state;
    const char *const sets[] = {
        ("rocket.aerodynamics={reference_diameter: 164 mm, fin_cant: 1 deg, "
         "table: reference-aero.csv}"),
        "run.end=landing", "environment.wind={speed: 3 m/s}", "run.flight_tolerance=1e-11"};
    ld_model launch = read_model("unbalanced.yaml", sets, 4);
    ld_rocket_summary flown = summary_of_run(&launch).rocket[0];
    ld_model alone = read_model("unbalanced.yaml", sets, 4);
    ld_flight *start = &alone.flight;
    alone.base.kind = LD_BASE_NONE;
    start->ignition = -flown.t_rear;
    memcpy(start->position, flown.exit.position, sizeof start->position);
    memcpy(start->velocity, flown.exit.velocity, sizeof start->velocity);
    memcpy(start->quaternion, flown.exit.quaternion, sizeof start->quaternion);
    memcpy(start->rate, flown.exit.rate, sizeof start->rate);
    start->velocity_ned[0] = start->speed = NAN;
    ld_rocket_summary other = summary_of_run(&alone).rocket[0];
    CHECK_WITHIN("range [m]", flown.flight.range, 5000, 12000);
    CHECK_BELOW("impact [m]", impact_apart(&flown, &other), 1e-9);
    CHECK_BELOW("impact from ignition [s]", flown.flight.t_impact - other.flight.t_impact, 1e-10);
    CHECK_BELOW("apogee [m]", flown.flight.apogee - other.flight.apogee, 1e-10);
    model_clear(&launch);
    model_clear(&alone);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tolerance),
        cmocka_unit_test(test_hand_off),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
