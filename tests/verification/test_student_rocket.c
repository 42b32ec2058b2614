// examples/student-rocket from rail to ground, against what RocketPy 1.12 has for the rocket as
// scripts/beside-rocketpy flies it, from the end of a rail that lets it go whole.
#include "model/model.h"
#include "support/check.h"

#include "quantities/summary.h"
#include "scenario/scenario.h"
#include "support/recorded_run.h"

static const double degree = 0.017453292519943295;

static void student_rocket(void **state)
{
    (void)state;
    ld_model model;
    ld_messages messages;
    if (scenario_read(LD_SOURCE_DIR "/examples/student-rocket/student-rocket.yaml", NULL, 0, &model,
                      &messages)) {
        ld_messages_print(&messages, stdout);
        fail();
    }
    ld_rocket_summary rocket = summary_of_run(&model).rocket[0];
    model_clear(&model);
    double ahead = rocket.flight.downrange, right = rocket.flight.drift;
    double east = ahead * sin(181 * degree) + right * cos(181 * degree);
    double north = ahead * cos(181 * degree) - right * sin(181 * degree);
    CHECK_NEAR("apogee above the ground [m]", rocket.flight.apogee, 1298.61, 0.8);
    CHECK_NEAR("apogee above sea level [m]", rocket.flight.apogee_altitude, 206 + 1298.61, 0.8);
    CHECK_NEAR("its time [s]", rocket.flight.t_apogee, 16.681, 0.01);
    CHECK_NEAR("lands to the east [m]", east, 447.7, 7);
    CHECK_NEAR("to the north [m]", north, 207.4, 16);
    CHECK_NEAR("at [s]", rocket.flight.t_impact, 89.73, 0.04);
    CHECK_NEAR("drogue opens after the apogee [s]",
               rocket.parachute[0].t_open - rocket.flight.t_apogee, 1, 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(student_rocket)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
