// RockSim .rse files: thrust, masses of the propellant or of the whole motor, its centre.
#include "model/model.h"
#include "support/check.h"

#include "model/masses.h"
#include "scenario/scenario.h"

#define ROCKSIM LD_SOURCE_DIR "/tests/data/rocksim/"

// A flight of 30 kg with the motor's front end 0.9 m before the origin.
static ld_model read_with(const char *thrust, const char *masses)
{
    char first[512], second[512];
    const char *const sets[] = {first, second, "rocket.motor.masses_at=0.9 m", "rocket.empty="};
    ld_model model;
    ld_messages messages;
    snprintf(first, sizeof first, "rocket.motor.thrust=" ROCKSIM "%s", thrust);
    snprintf(second, sizeof second, "rocket.motor.masses=" ROCKSIM "%s", masses);
    ld_status status =
        scenario_read(LD_SOURCE_DIR "/examples/flight.yaml", sets, 4, &model, &messages);
    ld_messages_print(&messages, stdout);
    assert_int_equal(status, LD_OK);
    return model;
}

static void test_numbers(void **state)
{
    (void)state;
    ld_model model = read_with("hybrid.rse", "hybrid.rse");
    const ld_table *thrust = &model.rocket.motor.thrust, *masses = &model.rocket.motor.masses;
    assert_true(thrust->rows == 4 && thrust->columns == 2);
    CHECK_NEAR("second time [s]", thrust->data[2], 0.1, 0);
    CHECK_NEAR("second thrust [N]", thrust->data[3], 1200, 0);
    CHECK_NEAR("what was measured below 0 [N]", thrust->data[7], -3, 0);
    assert_true(masses->rows == 4 && masses->columns == MASSES_COLUMNS);
    const double *row = masses->data + 2 * (size_t)MASSES_COLUMNS;
    CHECK_NEAR("time [s]", row[MASSES_TIME], 3.5, 0);
    CHECK_NEAR("4 kg of casing and 0.1 kg [kg]", row[MASSES_MASS], 4.1, 1e-15);
    CHECK_NEAR("centre, behind the front end [m]", row[MASSES_CENTER], -0.43, 1e-16);
    CHECK_NEAR("of a cylinder of 50 mm [kg m2]", row[MASSES_AXIAL], 4.1 * 0.05 * 0.05 / 2, 1e-17);
    CHECK_NEAR("and 0.8 m [kg m2]", row[MASSES_TRANSVERSE],
               4.1 * (0.05 * 0.05 / 4 + 0.8 * 0.8 / 12), 1e-16);
    CHECK_NEAR("propellant [kg]", model.rocket.propellant, 2, 1e-14);
    double m = model.rocket.full.mass, c = model.rocket.full.center[0];
    CHECK_NEAR("centre of what is left [m]", model.rocket.empty.center[0],
               (m * c - 6 * (0.9 - 0.35) + 4 * (0.9 - 0.44)) / (m - 2), 1e-14);
    model_clear(&model);
}

// A file whose masses are those of the whole motor says the same.
static void test_whole(void **state)
{
    (void)state;
    ld_model a = read_with("hybrid.rse", "hybrid.rse"), b = read_with("whole.rse", "whole.rse");
    for (size_t i = 0; i < 4 * (size_t)MASSES_COLUMNS; i++)
        CHECK_NEAR("masses", b.rocket.motor.masses.data[i], a.rocket.motor.masses.data[i], 1e-15);
    model_clear(&a);
    model_clear(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_numbers),
        cmocka_unit_test(test_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
