// A vehicle alone under the given wrench, and with our launcher on it, step by step: the error
// against the run of all together falls with the square of the step.
#include <math.h>
#include <string.h>

#include "launchdyn/vehicle_run.h"
#include "model/model.h"
#include "scenario/scenario.h"
#include "support/check.h"
#include "support/exit_distance.h"
#include "support/reference_model.h"

static void marching_model(ld_model *model)
{
    reference_vehicle(model, 30 / 3.6);
    ld_road *road = &model->base.vehicle.road;
    road->form = LD_ROAD_SUM;
    road->sine_count = 1;
    road->sine[0] = (ld_road_sine){.amplitude = 5e-3, .wavelength = 2.5};
    model->run.lead_in = 0.1;
    model->run.tolerance = 1e-9;
}

static ld_simulation *simulation_of(const ld_model *model)
{
    ld_simulation *simulation;
    ld_error error;
    if (ld_simulation_create(model, &simulation, &error))
        fail_msg("%s", error.text);
    return simulation;
}

static ld_summary together(const ld_model *model)
{
    ld_simulation *simulation = simulation_of(model);
    ld_summary summary = {0};
    ld_error error;
    if (ld_simulation_run(simulation, NULL, &summary, &error))
        fail_msg("%s", error.text);
    ld_simulation_free(simulation);
    return summary;
}

static double run_number(ld_run *run, const char *name)
{
    double value;
    assert_int_equal(ld_run_number(run, name, &value, NULL), LD_OK);
    return value;
}

static void find_place(ld_run *run, double place[3])
{
    place[0] = run_number(run, "tip.inertial_y");
    place[1] = run_number(run, "base.pitch");
    place[2] = run_number(run, "base.x");
}

static size_t count_unequal(const double *a, const double *b, size_t count)
{
    size_t unequal = 0;
    for (size_t i = 0; i < count; i++)
        unequal += memcmp(&a[i], &b[i], sizeof *a) != 0;
    return unequal;
}

static double column(const ld_simulation *simulation, ld_vehicle_run *run, const char *name)
{
    double row[512];
    const ld_column *columns;
    size_t count = ld_vehicle_run_columns(simulation, &columns);
    assert_true(count <= 512);
    assert_int_equal(ld_vehicle_run_row(run, row, NULL), LD_OK);
    for (size_t i = 0; i < count; i++)
        if (strcmp(columns[i].name, name) == 0)
            return row[i];
    fail_msg("no column %s", name);
    return NAN;
}

typedef struct coupled {
    ld_summary summary;
    double work, missing, balance; // [J] the largest that goes over, that it misses; the vehicle's
    double moved; // [m], [rad] the farthest that tube or rocket stood from the start
} coupled;

// A vehicle and a launcher of the same model, each on its own.
typedef struct pair {
    ld_model alone; // shares what the model holds
    ld_simulation *whole, *launcher;
    ld_vehicle_run *vehicle;
    ld_run *run;
    ld_base_frame frame;
} pair;

static void pair_begin(pair *self, const ld_model *model)
{
    ld_error error;
    self->alone = *model;
    self->alone.base.kind = LD_BASE_EXTERNAL;
    self->whole = simulation_of(model);
    self->launcher = simulation_of(&self->alone);
    if (ld_vehicle_run_begin(self->whole, &self->vehicle, &error))
        fail_msg("%s", error.text);
    assert_int_equal(ld_vehicle_run_frame(self->vehicle, &self->frame, &error), LD_OK);
    if (ld_run_begin(self->launcher, &(ld_run_options){.base = &self->frame}, &self->run, &error))
        fail_msg("%s", error.text);
}

static ld_summary pair_end(pair *self)
{
    ld_summary summary;
    ld_run_end(self->run, &summary, NULL);
    ld_vehicle_run_end(self->vehicle);
    ld_simulation_free(self->launcher);
    ld_simulation_free(self->whole);
    return summary;
}

// They report each other how they stand, then both continue to t.
static void pair_step(pair *self, double t)
{
    ld_base_wrench wrench;
    ld_error error = {0};
    assert_int_equal(ld_vehicle_run_frame(self->vehicle, &self->frame, &error), LD_OK);
    assert_int_equal(ld_run_set_base(self->run, &self->frame, &error), LD_OK);
    assert_int_equal(ld_run_base_wrench(self->run, &wrench, &error), LD_OK);
    assert_int_equal(ld_vehicle_run_set_wrench(self->vehicle, &wrench, &error), LD_OK);
    if (ld_run_advance(self->run, t, &error) || ld_vehicle_run_advance(self->vehicle, t, &error))
        fail_msg("%s", error.text);
}

static void look(pair *self, const double start[3], coupled *result)
{
    double now[3];
    double told = run_number(self->run, "work.base");
    double given = column(self->whole, self->vehicle, "work.tube");
    double balance = column(self->whole, self->vehicle, "energy.residual");
    result->work = fmax(result->work, fabs(told));
    result->missing = fmax(result->missing, fabs(told + given));
    result->balance = fmax(result->balance, fabs(balance));
    find_place(self->run, now);
    for (int i = 0; i < 3; i++)
        result->moved = fmax(result->moved, fabs(now[i] - start[i]));
}

static coupled couple(const ld_model *model, double step, bool waits)
{
    pair both;
    coupled result = {0};
    double place[3];
    pair_begin(&both, model);
    if (waits)
        assert_int_equal(ld_run_ignite(both.run, INFINITY, NULL), LD_OK);
    double start = ld_run_time(both.run);
    find_place(both.run, place);
    for (int i = 1; !ld_run_is_finished(both.run) && (!waits || i * step <= 1); i++) {
        look(&both, place, &result);
        pair_step(&both, start + i * step);
    }
    result.summary = pair_end(&both);
    return result;
}

static void second_order(void **state)
{
    (void)state;
    enum { STEPS = 4 };
    static const double step[STEPS] = {0.8e-3, 0.4e-3, 0.2e-3, 0.1e-3};
    ld_model model;
    marching_model(&model);
    ld_summary all = together(&model);
    double error[STEPS], missing[STEPS];
    for (int i = 0; i < STEPS; i++) {
        coupled apart = couple(&model, step[i], false);
        error[i] = exit_distance(&apart.summary, &all);
        missing[i] = apart.missing / apart.work;
        printf(
            "    %g ms: attitude and rates %.3g rad/s, of the work that goes over %.3g is missed\n",
            1e3 * step[i], error[i], missing[i]);
        CHECK_BELOW("the vehicle's own balance [J]", apart.balance, 2e-8);
    }
    for (int i = 1; i < STEPS; i++)
        CHECK_WITHIN("order of the exit attitude and rates", log2(error[i - 1] / error[i]), 1.8,
                     2.2);
    CHECK_WITHIN("order of the work that goes over",
                 log2(missing[0] / missing[STEPS - 1]) / (STEPS - 1), 1.8, 2.2);
    CHECK_BELOW("exit attitude and rates at 0.1 ms [rad/s]", error[STEPS - 1], 2.5e-6);
    reference_model_free(&model);
}

// A boom that a cylinder holds low: joints that close a loop, a drive, a lock that closes on the
// way.
static const char *const erector[] = {"run.lead_in=0.1 s", "run.tolerance=1e-9", "run.end=tip",
                                      "base.drives.lift.length.command=0.24 m",
                                      "base.joints.pivot.lock.from=-50 ms"};
// On wheels and jacks, without a loop.
static const char *const trailer[] = {"run.lead_in=0.1 s", "run.tolerance=1e-9", "run.end=tip"};

static void read_example(const char *name, const char *const *sets, size_t count, ld_model *model)
{
    char path[512];
    ld_messages messages = {0};
    snprintf(path, sizeof path, LD_SOURCE_DIR "/examples/multibody/%s.yaml", name);
    if (scenario_read(path, sets, count, model, &messages))
        fail_msg("%s cannot be read", name);
}

static void multibody_bases(void **state)
{
    (void)state;
    enum { STEPS = 3 };
    static const double step[STEPS] = {0.8e-3, 0.4e-3, 0.2e-3};
    for (int k = 0; k < 2; k++) {
        ld_model model;
        read_example(k ? "trailer" : "erector", k ? trailer : erector, k ? 3 : 5, &model);
        ld_summary all = together(&model);
        double error = 0, missing[STEPS];
        for (int i = 0; i < STEPS; i++) {
            coupled apart = couple(&model, step[i], false);
            error = exit_distance(&apart.summary, &all);
            missing[i] = apart.missing / apart.work;
            printf("    %g ms: attitude and rates %.3g rad/s, of the work that goes over %.3g is "
                   "missed\n",
                   1e3 * step[i], error, missing[i]);
            CHECK_BELOW("the base's own balance [J]", apart.balance, 1e-9);
        }
        CHECK_WITHIN("order of the work that goes over, multibody base",
                     log2(missing[0] / missing[STEPS - 1]) / (STEPS - 1), 1.6, 2.4);
        CHECK_BELOW("exit attitude and rates at 0.2 ms, multibody base [rad/s]", error,
                    k ? 6e-5 : 2e-5);
        model_clear(&model);
    }
}

// What is in equilibrium stays there: the wrench at the start is that under which the vehicle
// rests.
static void rest_stays(void **state)
{
    (void)state;
    ld_model model;
    reference_vehicle(&model, 0);
    model.run.lead_in = 2;
    model.run.tolerance = 1e-8;
    coupled apart = couple(&model, 1e-3, true);
    CHECK_BELOW("the largest way in a second of rest [m], [rad]", apart.moved, 5e-11);
    reference_model_free(&model);
}

static void digital_loop(void **state)
{
    (void)state;
    ld_model model;
    marching_model(&model);
    ld_stabiliser *loop = &model.platform.elevation.stabiliser;
    loop->sample = 2e-3;
    loop->delay = 0.5e-3;
    ld_summary all = together(&model);
    coupled apart = couple(&model, 0.1e-3, false);
    CHECK_BELOW("exit attitude and rates, digital loop [rad/s]",
                exit_distance(&apart.summary, &all), 3e-6);
    reference_model_free(&model);
}

// Saved and loaded on the way: the same bits from there on.
static void saved_and_loaded(void **state)
{
    (void)state;
    unsigned char bytes[1 << 14];
    double row[2][512];
    size_t size;
    ld_error error;
    ld_model model;
    const ld_column *columns;
    ld_base_wrench wrench = {{100, -9000, 20}, {5, 40, -9000}};
    ld_vehicle_run *run, *again;
    marching_model(&model);
    ld_simulation *simulation = simulation_of(&model);
    assert_int_equal(ld_vehicle_run_begin(simulation, &run, &error), LD_OK);
    assert_int_equal(ld_vehicle_run_set_wrench(run, &wrench, &error), LD_OK);
    assert_int_equal(ld_vehicle_run_advance(run, -0.07, &error), LD_OK);
    wrench.force[1] -= 500;
    assert_int_equal(ld_vehicle_run_set_wrench(run, &wrench, &error), LD_OK);
    assert_int_equal(ld_vehicle_run_advance(run, -0.06, &error), LD_OK);
    const ld_base_wrench now = {{90, -9700, 30}, {5, 20, -9100}},
                         wrong = {{0, 1e4, 0}, {0, 0, 100}};
    assert_int_equal(ld_vehicle_run_set_wrench(run, &now, &error), LD_OK);
    assert_int_equal(ld_vehicle_run_save(run, bytes, sizeof bytes, &size, &error), LD_OK);
    printf("    %zu bytes\n", size);
    if (ld_vehicle_run_load(simulation, bytes, size, &again, &error))
        fail_msg("%s", error.text);
    for (int i = 0; i < 2; i++) {
        ld_vehicle_run *one = i ? again : run;
        if (i == 1) { // set again at the same time, it was not reported before
            assert_int_equal(ld_vehicle_run_set_wrench(one, &wrong, &error), LD_OK);
            assert_int_equal(ld_vehicle_run_set_wrench(one, &now, &error), LD_OK);
        }
        assert_int_equal(ld_vehicle_run_advance(one, -0.05, &error), LD_OK);
        wrench.force[1] = -8000;
        assert_int_equal(ld_vehicle_run_set_wrench(one, &wrench, &error), LD_OK);
        assert_int_equal(ld_vehicle_run_advance(one, 0.01, &error), LD_OK);
        assert_int_equal(ld_vehicle_run_row(one, row[i], &error), LD_OK);
    }
    size_t count = ld_vehicle_run_columns(simulation, &columns);
    CHECK_BELOW("columns that differ after loading", count_unequal(row[0], row[1], count), 0);
    ld_vehicle_run_end(again);
    bytes[size / 2] ^= 1;
    assert_int_equal(ld_vehicle_run_load(simulation, bytes, size, &again, &error), LD_ERR_INPUT);
    assert_string_equal(error.text, "the saved run of a vehicle is truncated or damaged");
    assert_null(again);
    assert_int_equal(ld_vehicle_run_save(run, bytes, 8, &size, &error), LD_ERR_INPUT);
    ld_vehicle_run_end(run);
    ld_simulation_free(simulation);
    reference_model_free(&model);
}

static void refused(const ld_model *model, const char *why)
{
    ld_error error;
    ld_vehicle_run *run;
    ld_simulation *simulation = simulation_of(model);
    assert_int_equal(ld_vehicle_run_begin(simulation, &run, &error), LD_ERR_INPUT);
    assert_null(run);
    assert_string_equal(error.text, why);
    ld_simulation_free(simulation);
}

static void refuses(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    refused(&model, "base.kind: a vehicle-only run requires kind: vehicle or multibody");
    reference_model_free(&model);
    reference_vehicle(&model, 0);
    ld_error error;
    ld_vehicle_run *run;
    ld_simulation *simulation = simulation_of(&model);
    assert_int_equal(ld_vehicle_run_begin(simulation, &run, &error), LD_OK);
    ld_base_wrench wrench = {{0, NAN, 0}, {0, 0, 0}};
    assert_int_equal(ld_vehicle_run_set_wrench(run, &wrench, &error), LD_ERR_INPUT);
    assert_string_equal(error.text, "the vehicle received a wrench that is not finite");
    assert_int_equal(ld_vehicle_run_advance(run, 0.01, &error), LD_OK);
    assert_int_equal(ld_vehicle_run_advance(run, 0, &error), LD_ERR_INPUT);
    assert_string_equal(error.text,
                        "the vehicle's run is at t = 0.01 s and cannot continue to t = 0 s");
    ld_vehicle_run_end(run);
    ld_simulation_free(simulation);
    model.firing_count = 2;
    model.firing[1] = model.firing[0];
    model.firing[1].at = 1;
    model.firing[1].tube = model.firing[0].tube + 1;
    refused(&model, "firing: found 2 rockets, expected 1 in a vehicle-only run");
    reference_model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(second_order),     cmocka_unit_test(multibody_bases),
        cmocka_unit_test(rest_stays),       cmocka_unit_test(digital_loop),
        cmocka_unit_test(saved_and_loaded), cmocka_unit_test(refuses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
