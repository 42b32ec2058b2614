// Launches whose lead-in goes by long exponential steps against those by short explicit ones, a
// thousandfold tighter: exit
// figures, rows, measures, energies, what base and road there is; far fewer evaluations.
#include <stdio.h>
#include <string.h>

#include "model/model.h"
#include "scenario/scenario.h"
#include "support/check.h"
#include "support/recorded_run.h"

enum { MOST_SETS = 6 };

typedef struct pair {
    ld_model model[2]; // explicit, exponential
    recorded_run run[2];
} pair;

static void read(const char *name, const char *const *sets, const char *method, ld_model *model)
{
    char path[512];
    const char *all[MOST_SETS + 1];
    size_t count = 0;
    ld_messages messages = {0};
    for (; sets[count]; count++)
        all[count] = sets[count];
    all[count++] = method;
    snprintf(path, sizeof path, "%s/examples/%s", LD_SOURCE_DIR, name);
    if (scenario_read(path, all, count, model, &messages)) {
        ld_messages_print(&messages, stderr);
        fail_msg("%s", path);
    }
}

static void run_both(const char *name, const char *const *sets, double tight, pair *both)
{
    static const char *const methods[] = {"run.lead_in_method=explicit",
                                          "run.lead_in_method=exponential"};
    for (int k = 0; k < 2; k++) {
        read(name, sets, methods[k], &both->model[k]);
        if (k == 0)
            both->model[k].run.tolerance *= tight;
        recorded_run_make(&both->run[k], &both->model[k]);
    }
}

static void free_both(pair *both)
{
    for (int k = 0; k < 2; k++) {
        recorded_run_free(&both->run[k]);
        model_clear(&both->model[k]);
    }
}

// [mrad/s] the larger difference of a rocket's exit rates.
static double rates_apart(const pair *both, int rocket)
{
    const ld_rocket_summary *a = &both->run[0].summary.rocket[rocket];
    const ld_rocket_summary *b = &both->run[1].summary.rocket[rocket];
    return 1e3 * fmax(fabs(a->pitch_rate - b->pitch_rate), fabs(a->yaw_rate - b->yaw_rate));
}

static double share_of_evaluations(const pair *both)
{
    return (double)both->run[1].summary.statistics.rhs_evaluations /
           (double)both->run[0].summary.statistics.rhs_evaluations;
}

// Largest difference of a column before the ignition against its own largest magnitude there; the
// rows have the same instants.
static double column_apart(const pair *both, const char *name)
{
    const recorded_run *a = &both->run[0], *b = &both->run[1];
    size_t time = recorded_column(a, "t"), column = recorded_column(a, name);
    double most = 0, apart = 0;
    assert_true(a->rows > 0);
    for (size_t i = 0; i < a->rows && recorded_value(a, i, time) <= 0; i++) {
        assert_true(fabs(recorded_value(a, i, time) - recorded_value(b, i, time)) < 1e-12);
        double value = recorded_value(a, i, column);
        most = fmax(most, fabs(value));
        apart = fmax(apart, fabs(value - recorded_value(b, i, column)));
    }
    return apart / most;
}

static void a_vehicle_on_the_move(void **state)
{
    (void)state;
    pair both;
    const char *const sets[] = {
        "run={lead_in: 0.5 s, end: tip, output_step: {lead_in: 3.1 ms, tube: 1 ms}}",
        "measures=[{name: shake, of: tip.pitch_rate, take: rms, from: start, to: t_ignition}, "
        "{name: most, of: tip.pitch_rate, take: peak, from: start, to: t_ignition}]",
        NULL};
    run_both("reference.yaml", sets, 1e-3, &both);
    const ld_rocket_summary *a = both.run[0].summary.rocket, *b = both.run[1].summary.rocket;
    CHECK_BELOW("exit rates [mrad/s]", rates_apart(&both, 0), 0.03);
    CHECK_BELOW("energy residual, of the largest work",
                both.run[1].summary.energy.residual_relative, 1e-6);
    CHECK_BELOW("rows: the tube's tip, upwards", column_apart(&both, "tip.y"), 1e-4);
    CHECK_BELOW("rows: its pitch rate", column_apart(&both, "tip.pitch_rate"), 5e-3);
    CHECK_BELOW("rms of that", b->measure[0] / a->measure[0] - 1, 1e-4);
    CHECK_BELOW("its peak", b->measure[1] / a->measure[1] - 1, 1e-3);
    CHECK_BELOW("evaluations, of the explicit ones", share_of_evaluations(&both), 0.4);
    free_both(&both);
}

// Wheels leave it, and adaptors their tube.
static void a_bad_road(void **state)
{
    (void)state;
    pair both;
    const char *const sets[] = {"run={lead_in: 0.3 s, end: tip}", "base.speed=60 km/h",
                                "base.road.class=E", NULL};
    run_both("reference.yaml", sets, 1e-3, &both);
    CHECK_BELOW("exit rates [mrad/s]", rates_apart(&both, 0), 0.3);
    CHECK_BELOW("energy residual, of the largest work",
                both.run[1].summary.energy.residual_relative, 5e-6);
    CHECK_BELOW("evaluations, of the explicit ones", share_of_evaluations(&both), 0.6);
    free_both(&both);
}

// Slewing from one rocket to the next.
static void a_sequence(void **state)
{
    (void)state;
    pair both;
    const char *const sets[] = {
        "run={lead_in: 0.1 s, end: tip}", "firing=[{tube: 8, at: 0 s}, {tube: 9, at: 0.6 s}]",
        "platform.azimuth.stabiliser.command=[[0.1 s, 0 deg], [0.8 s, 7 deg]]", NULL};
    run_both("sequence.yaml", sets, 1e-3, &both);
    for (int i = 0; i < 2; i++)
        CHECK_BELOW("exit rates [mrad/s]", rates_apart(&both, i), 0.03);
    CHECK_BELOW("energy residual, of the largest work",
                both.run[1].summary.energy.residual_relative, 2e-6);
    free_both(&both);
}

// A base that time moves, which turns in every axis.
static void a_ship(void **state)
{
    (void)state;
    pair both;
    const char *const sets[] = {"run.lead_in=0.5 s", "run.end=tip", NULL};
    run_both("ship.yaml", sets, 1e-3, &both);
    CHECK_BELOW("exit rates [mrad/s]", rates_apart(&both, 0), 0.03);
    CHECK_BELOW("energy residual, of the largest work",
                both.run[1].summary.energy.residual_relative, 1e-6);
    CHECK_BELOW("evaluations, of the explicit ones", share_of_evaluations(&both), 0.5);
    free_both(&both);
}

// A lock that holds for long on a ship that makes 6 m/s: the rocket stays where it is in the tube.
static void a_long_wait_on_a_ship(void **state)
{
    (void)state;
    ld_model model;
    recorded_run run;
    const char *const sets[] = {"run={lead_in: 10.1 s, end: tip, output_step: {lead_in: 1 s}}",
                                NULL};
    read("ship-sea.yaml", sets, "run.lead_in_method=exponential", &model);
    recorded_run_make(&run, &model);
    size_t t = recorded_column(&run, "t"), s = recorded_column(&run, "rocket.s");
    double moved = 0;
    for (size_t i = 0; i < run.rows && recorded_value(&run, i, t) <= 0; i++)
        moved = fmax(moved, fabs(recorded_value(&run, i, s) - model.rocket.start_at));
    CHECK_BELOW("the rocket slips through its lock by [m]", moved, 5e-9);
    recorded_run_free(&run);
    model_clear(&model);
}

// Not where the base has instants of its own, or is integrated apart: the same numbers.
static void where_they_do_not_go(void **state)
{
    (void)state;
    static const char *const others[] = {"run.coupling.step=0.5 ms",
                                         "platform.azimuth.stabiliser.sample=1 ms"};
    for (int k = 0; k < 2; k++) {
        pair both;
        const char *const sets[] = {"run={lead_in: 20 ms, end: tip}", others[k], NULL};
        run_both("reference.yaml", sets, 1, &both);
        assert_int_equal(rates_apart(&both, 0) * 1e20, 0);
        free_both(&both);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_vehicle_on_the_move),
        cmocka_unit_test(a_bad_road),
        cmocka_unit_test(a_sequence),
        cmocka_unit_test(a_ship),
        cmocka_unit_test(a_long_wait_on_a_ship),
        cmocka_unit_test(where_they_do_not_go),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
