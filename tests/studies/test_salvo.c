// Salvos from the vehicle: rockets drawn alike are a sequence of such rockets, the platform carries
// what was sampled, and a drawn interval moves the ignitions.
// ctest: slow
#include "model/model.h"
#include "support/check.h"

#include <stdlib.h>

#include "launchdyn/study.h"
#include "quantities/study_results.h"
#include "scenario/scenario.h"
#include "support/recorded_run.h"

#define LAUNCHER                                                                                   \
    "include: marching/stationary.yaml\n"                                                          \
    "run: {end: tip, lead_in: 0.1 s}\n"
#define THREE "firing: {order: [1, 18, 8], interval: 0.5 s}\n"
#define SCATTER "scatter:\n  samples: 3\n  factors:\n"

static ld_model read_text(const char *text)
{
    ld_model model;
    ld_messages messages;
    ld_status status = scenario_read_text(text, strlen(text), "text", LD_SOURCE_DIR "/examples",
                                          NULL, 0, &model, &messages);
    ld_messages_print(&messages, stdout);
    assert_int_equal(status, LD_OK);
    return model;
}

static ld_sample *draw(const ld_model *model, int number)
{
    ld_sample *sample;
    ld_error error;
    if (ld_sample_create(model, number, &sample, &error))
        fail_msg("%s", error.text);
    return sample;
}

// Results of all rockets that differ in any bit.
static int differences(const ld_model *model, const ld_summary *a, const ld_summary *b)
{
    int count = 0;
    const quantity_things things = quantity_things_of(model);
    assert_int_equal(a->rocket_count, b->rocket_count);
    for (int i = 0; i < a->rocket_count; i++)
        for (quantity_walk r = study_result_first(&things); r.row; study_result_next(&r)) {
            double x = quantity_value(&r, &a->rocket[i]), y = quantity_value(&r, &b->rocket[i]);
            count += memcmp(&x, &y, sizeof x) != 0;
        }
    return count;
}

static void compare(const char *what, const char *plain, const char *scattered)
{
    ld_model sequence = read_text(plain), study = read_text(scattered);
    ld_sample *sample = draw(&study, 1);
    static ld_summary a, b;
    a = summary_of_run(&sequence);
    b = summary_of_run(ld_sample_model(sample));
    assert_int_equal(a.rocket_count, 3);
    assert_false(isnan(a.rocket[2].t_rear));
    CHECK_BELOW(what, differences(&sequence, &a, &b), 0);
    ld_sample_free(sample);
    model_clear(&sequence);
    model_clear(&study);
}

static void test_rockets_alike(void **state)
{
    (void)state;
    compare("nothing scattered: results unlike the sequence's", LAUNCHER THREE,
            LAUNCHER THREE SCATTER "    rocket.mass_error: {discrete: [0 kg]}\n");
    // every rocket aboard is fired, so that all of them are sampled
#define FULL "tubes: {layout: {rows: 1, columns: 3}}\nfiring: {order: [3, 1, 2], interval: 0.5 s}\n"
    compare("each 2 kg more and 1 % stronger: unlike the sequence's",
            LAUNCHER FULL "rocket: {mass_error: 2 kg, motor: {thrust_scale: 1.01}}\n",
            LAUNCHER FULL SCATTER "    rocket.mass_error: {discrete: [2 kg]}\n"
                                  "    rocket.motor.thrust_scale: {discrete: [1.01]}\n");
}

static bool stop(void *self, double share)
{
    (void)self, (void)share;
    return false;
}

// [N] on all tyres, at the equilibrium before the first step.
static double tyre_forces(const ld_model *model)
{
    static ld_summary summary;
    ld_simulation *simulation;
    ld_run_options options = {.progress = stop};
    ld_error error;
    double sum = 0;
    assert_int_equal(ld_simulation_create(model, &simulation, &error), LD_OK);
    assert_int_equal(ld_simulation_run(simulation, &options, &summary, &error), LD_ERR_INTERRUPTED);
    ld_simulation_free(simulation);
    for (int j = 0; j < summary.equilibrium.wheel_count; j++)
        sum += summary.equilibrium.wheel[j].tyre_force;
    return sum;
}

// The tyres carry the plain vehicle's weight and that of the mass errors drawn.
static void check_weight(const char *what, const char *text)
{
    ld_model model = read_text(text), plain = read_text(LAUNCHER);
    double weight = tyre_forces(&plain);
    for (int number = 1; number <= 3; number++) {
        ld_sample *sample = draw(&model, number);
        const ld_model *drawn = ld_sample_model(sample);
        double errors = 0;
        for (int i = 0; i < drawn->firing_count; i++)
            errors += (drawn->salvo ? drawn->salvo[i] : drawn->rocket).mass_error;
        printf("  %s, sample %d: mass errors of %.3f kg\n", what, number, errors);
        CHECK_BELOW("tyre forces less the weight, over it",
                    (tyre_forces(drawn) - weight - errors * model.gravity) / weight, 5e-15);
        ld_sample_free(sample);
    }
    model_clear(&model);
    model_clear(&plain);
}

static void test_masses_aboard(void **state)
{
    (void)state;
    check_weight("three of 18", LAUNCHER THREE SCATTER "    rocket.mass_error: {normal: 2 kg}\n");
    check_weight("one of 18", LAUNCHER "firing: [{tube: 8, at: 0 s}]\n" SCATTER
                                       "    rocket.mass_error: {normal: 2 kg}\n");
}

static void test_interval(void **state)
{
    (void)state;
    ld_model model = read_text(LAUNCHER THREE SCATTER "    firing.start: {uniform: 0 0.1 s}\n"
                                                      "    firing.interval: {uniform: +-0.1 s}\n");
    double intervals[3];
    for (int number = 1; number <= 3; number++) {
        ld_sample *sample = draw(&model, number);
        static ld_summary summary;
        summary = summary_of_run(ld_sample_model(sample));
        const ld_firing_order *order = &ld_sample_model(sample)->firing_order;
        for (int i = 0; i < 3; i++)
            CHECK_NEAR("ignition [s]", summary.rocket[i].t_ignition,
                       order->start + i * order->interval, 0);
        intervals[number - 1] = order->interval;
        ld_sample_free(sample);
    }
    CHECK_WITHIN("intervals differ [s]", fabs(intervals[0] - intervals[1]), 1e-3, 0.2);
    model_clear(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rockets_alike),
        cmocka_unit_test(test_masses_aboard),
        cmocka_unit_test(test_interval),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
