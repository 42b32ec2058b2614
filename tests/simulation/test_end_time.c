// A launch whose end is a time: the launcher moves on and the rockets fly until then, as they do on
// their way to the ground.
#include "model/model.h"
#include "support/check.h"

#include "scenario/scenario.h"
#include "support/recorded_run.h"

static ld_model fixed_model(const char *end)
{
    ld_model model;
    ld_messages messages;
    const char *set[] = {end, "run.output_step.tube=5 ms"};
    if (scenario_read(LD_SOURCE_DIR "/examples/fixed.yaml", set, 2, &model, &messages)) {
        ld_messages_print(&messages, stdout);
        fail();
    }
    return model;
}

typedef struct flight_rows {
    int flights, rows;
    double last[LD_MAX_FIRINGS], launcher;
    int flying;
} flight_rows;

static ld_status begin(void *self, const ld_column *columns, size_t count, ld_error *error)
{
    (void)self, (void)columns, (void)count, (void)error;
    return LD_OK;
}

static ld_status row(void *self, const double *values, size_t count, ld_error *error)
{
    flight_rows *rows = self;
    (void)count, (void)error;
    if (rows->flying)
        rows->last[rows->flying - 1] = values[0];
    else
        rows->launcher = values[0];
    rows->rows++;
    return LD_OK;
}

static ld_status flight(void *self, int number, const ld_column *columns, size_t count,
                        ld_error *error)
{
    (void)columns, (void)count, (void)error;
    ((flight_rows *)self)->flying = number;
    ((flight_rows *)self)->flights++;
    return LD_OK;
}

static ld_summary fly(const ld_model *model, flight_rows *rows)
{
    ld_summary summary = {0};
    ld_simulation *simulation;
    ld_error error;
    ld_sink sink = {.self = rows, .begin = begin, .row = row, .flight = flight};
    ld_run_options options = {.sink = &sink};
    *rows = (flight_rows){0};
    if (ld_simulation_create(model, &simulation, &error) ||
        ld_simulation_run(simulation, &options, &summary, &error))
        fail_msg("%s", error.text);
    ld_simulation_free(simulation);
    return summary;
}

// Both histories end there; the state is the one that the flight to the ground has there.
static void flies_until_then(void **state)
{
    (void)state;
    ld_model model = fixed_model("run.end=1.5 s");
    flight_rows rows;
    ld_summary summary = fly(&model, &rows);
    const ld_rocket_summary *rocket = &summary.rocket[0];
    assert_true(summary.complete && rocket->flown && rows.flights == 1);
    assert_true(summary.t_end == 1.5 && rows.launcher == 1.5);
    assert_true(rows.last[0] == 1.5 && rocket->final.t == 1.5);
    assert_true(isnan(rocket->flight.t_impact) && isnan(rocket->flight.range));
    // it rises still
    assert_true(rocket->final.center_velocity[1] > 0);
    assert_true(isnan(rocket->flight.apogee) && isnan(rocket->flight.apogee_altitude));
    assert_true(isnan(rocket->flight.t_apogee));
    model_clear(&model);

    // a nanosecond before it lands
    ld_model whole = fixed_model("run.end=landing");
    whole.run.flight_tolerance = 1e-11;
    whole.run.flight_limit = 100;
    ld_summary landed = fly(&whole, &rows);
    assert_true(isfinite(landed.rocket[0].flight.t_impact));
    model_clear(&whole);
    double t = landed.rocket[0].flight.t_impact;
    char end[64];
    snprintf(end, sizeof end, "run.end=%.17g s", t - 1e-9);
    ld_model before = fixed_model(end);
    before.run.flight_tolerance = 1e-11;
    ld_summary cut = fly(&before, &rows);
    const double *a = landed.rocket[0].final.center, *b = cut.rocket[0].final.center;
    assert_true(isnan(cut.rocket[0].flight.t_impact));
    CHECK_NEAR("apogee of the flight to the ground [m]", cut.rocket[0].flight.apogee,
               landed.rocket[0].flight.apogee, 0);
    CHECK_BELOW("a nanosecond before the ground [m]",
                fmax(fabs(a[0] - b[0]), fmax(fabs(a[1] - b[1]), fabs(a[2] - b[2]))), 1e-6);
    model_clear(&before);
}

// Later than the impact: the flight ends on the ground, the launcher's motion at the time given.
static void ends_on_the_ground(void **state)
{
    (void)state;
    ld_model model = fixed_model("run.end=1 s");
    model.environment.ground_height = -5;
    flight_rows rows;
    model.base.elevation = -0.1;
    ld_summary summary = fly(&model, &rows);
    assert_true(summary.t_end == 1 && rows.launcher == 1);
    printf("    on the ground after %.4f s\n", summary.rocket[0].flight.t_impact);
    assert_true(summary.rocket[0].flight.t_impact < 0.9);
    assert_true(rows.last[0] == summary.rocket[0].flight.t_impact);
    model_clear(&model);
}

// Below the ground nothing can fly; that the launcher continues is all that was asked for.
static void leaves_below_the_ground(void **state)
{
    (void)state;
    ld_model model = fixed_model("run.end=0.2 s");
    model.environment.ground_height = 10;
    flight_rows rows;
    ld_summary summary = fly(&model, &rows);
    assert_true(summary.complete && !summary.rocket[0].flown && rows.flights == 0);
    assert_true(rows.launcher == 0.2 && summary.note_count == 1);
    printf("    %s\n", summary.note[0]);
    assert_non_null(strstr(summary.note[0], "the rocket of tube 8 does not fly"));
    model_clear(&model);
}

// The end comes while the rocket is in the tube: it has not left, nothing flies.
static void ends_in_the_tube(void **state)
{
    (void)state;
    ld_model model = fixed_model("run.end=0.1 s");
    flight_rows rows;
    ld_summary summary = fly(&model, &rows);
    assert_true(summary.complete && !summary.rocket[0].flown && rows.flights == 0);
    assert_true(isnan(summary.rocket[0].t_rear) && rows.launcher == 0.1);
    model_clear(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flies_until_then),
        cmocka_unit_test(ends_on_the_ground),
        cmocka_unit_test(leaves_below_the_ground),
        cmocka_unit_test(ends_in_the_tube),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
