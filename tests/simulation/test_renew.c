// A simulation renewed from one sample to the next gives the bits of one that was made afresh,
// whatever went before; the tube's modes are found again exactly where the tube is another one.
#include "model/model.h"
#include "support/check.h"

#include <stdlib.h>

#include "run/simulation_build.h"
#include "scenario/scenario.h"
#include "state/simulation.h"

static void read_example(const char *name, ld_model *model)
{
    char path[256];
    ld_messages messages = {0};
    snprintf(path, sizeof path, LD_SOURCE_DIR "/examples/%s", name);
    assert_int_equal(scenario_read(path, NULL, 0, model, &messages), LD_OK);
}

static void run(ld_simulation *simulation, ld_summary *summary)
{
    ld_error error;
    assert_int_equal(ld_simulation_run(simulation, NULL, summary, &error), LD_OK);
}

// Runs the model in the simulation renewed and in one of its own.
static void check_same(ld_simulation **renewed, const ld_model *model)
{
    static ld_summary own, again;
    ld_simulation *afresh;
    ld_error error;
    assert_int_equal(ld_simulation_create(model, &afresh, &error), LD_OK);
    run(afresh, &own);
    ld_simulation_free(afresh);
    assert_int_equal(simulation_renew(renewed, model, &error), LD_OK);
    run(*renewed, &again);
    assert_memory_equal(own.rocket, again.rocket, sizeof own.rocket);
    assert_memory_equal(&own.equilibrium, &again.equilibrium, sizeof own.equilibrium);
    assert_memory_equal(&own.energy, &again.energy, sizeof own.energy);
    assert_int_equal(own.statistics.steps, again.statistics.steps);
}

static void test_same_bits(void **state)
{
    (void)state;
    ld_simulation *simulation = NULL;
    ld_model model, flight;
    read_example("fixed.yaml", &model);
    read_example("flight.yaml", &flight);
    check_same(&simulation, &model);
    const tube_element *first = simulation->launcher.launching.tube.flexible.element;

    // rocket, base and gravity touch no tube
    model.rocket.mass_error = 0.3;
    model.base.elevation += 0.02;
    model.gravity = 9.7;
    check_same(&simulation, &model);
    assert_ptr_equal(simulation->launcher.launching.tube.flexible.element, first);
    model.tubes.slot.friction *= 1.1;
    check_same(&simulation, &model);
    assert_ptr_equal(simulation->launcher.launching.tube.flexible.element, first);

    // any number of the tube does
    double *touched[] = {&model.tubes.support[1].stiffness[1], &model.tubes.support[0].damping[0],
                         &model.tubes.section[0].bending_stiffness, &model.tubes.tail.mass,
                         &model.tubes.modes.damping};
    for (size_t i = 0; i < sizeof touched / sizeof *touched; i++) {
        *touched[i] *= 1.01;
        check_same(&simulation, &model);
        *touched[i] /= 1.01;
    }
    check_same(&simulation, &flight);
    check_same(&simulation, &model);
    ld_simulation_free(simulation);
    model_clear(&model);
    model_clear(&flight);
}

// A flight's measured air stays where its rows do.
static void test_measured_air(void **state)
{
    (void)state;
    ld_simulation *simulation = NULL;
    ld_model model;
    ld_messages messages = {0};
    static const char *const set[] = {
        "environment.atmosphere={profile: [[0 m, 100 kPa, 290 K], [2 km, 78.5 kPa, 280 K]]}"};
    assert_int_equal(
        scenario_read(LD_SOURCE_DIR "/examples/flight.yaml", set, 1, &model, &messages), LD_OK);
    ld_atmosphere *given = &model.environment.atmosphere;
    check_same(&simulation, &model);
    const double *kept = simulation->flight.atmosphere.profile.x;
    given->density_scale = 0.97;
    given->temperature_offset = 3;
    check_same(&simulation, &model);
    assert_ptr_equal(simulation->flight.atmosphere.profile.x, kept);
    given->profile.data[given->profile.columns + 1] *= 1.01;
    check_same(&simulation, &model);
    given->profile.rows = 1;
    check_same(&simulation, &model);
    given->kind = LD_ATMOSPHERE_US1976;
    check_same(&simulation, &model);
    given->kind = LD_ATMOSPHERE_PROFILE;
    check_same(&simulation, &model);
    ld_simulation_free(simulation);
    model_clear(&model);
}

// On the march: the road's table stays where nothing of the road or of the way over it differs.
static void test_marching(void **state)
{
    (void)state;
    ld_simulation *simulation = NULL;
    ld_model model;
    read_example("reference.yaml", &model);
    model.run.lead_in = 0.02;
    model.run.end = LD_END_TIP;
    check_same(&simulation, &model);
    model.rocket.mass_error = 0.3;
    check_same(&simulation, &model);
    model.base.vehicle.road.seed = 2;
    check_same(&simulation, &model);
    model.base.vehicle.speed *= 1.5;
    check_same(&simulation, &model);
    ld_simulation_free(simulation);
    model_clear(&model);
}

// What fails leaves a simulation that the next sample can use.
static void test_after_failure(void **state)
{
    (void)state;
    ld_simulation *simulation = NULL;
    ld_model model;
    ld_error error;
    static ld_summary summary;
    read_example("fixed.yaml", &model);
    check_same(&simulation, &model);
    int bending = model.tubes.modes.bending;
    model.tubes.modes.bending = 0;
    assert_int_equal(simulation_renew(&simulation, &model, &error), LD_ERR_INPUT);
    model.tubes.modes.bending = bending;
    check_same(&simulation, &model);
    double force = model.rocket.lock.release_force;
    model.rocket.lock.release_force = 1e9;
    assert_int_equal(simulation_renew(&simulation, &model, &error), LD_OK);
    assert_int_equal(ld_simulation_run(simulation, NULL, &summary, &error), LD_ERR_LAUNCH);
    model.rocket.lock.release_force = force;
    check_same(&simulation, &model);
    ld_simulation_free(simulation);
    model_clear(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_same_bits),
        cmocka_unit_test(test_measured_air),
        cmocka_unit_test(test_marching),
        cmocka_unit_test(test_after_failure),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
