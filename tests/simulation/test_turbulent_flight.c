// A flight through turbulence: what acts is the turbulence of the distance flown through the air,
// and it is the same at any tolerance.
#include "environment/turbulence.h"
#include "model/model.h"
#include "scenario/scenario.h"
#include "support/check.h"
#include "support/recorded_run.h"

// A ball of 0.2 m with a kick, in a side wind of 4 m/s.
static const char scenario[] =
    "launchdyn: 1\n"
    "environment:\n"
    "  wind: {speed: 4 m/s, heading: 90 deg, turbulence: {wind_at_6m: 8 m/s, seed: 3}}\n"
    "rocket:\n"
    "  mass: 10 kg\n"
    "  center: 0 0 0 m\n"
    "  inertia: 0.1 0.1 0.1 kg.m2\n"
    "  aerodynamics: {model: body, area: 0.03 m2, drag: 0.5}\n"
    "flight: {position: 0 2 0 m, velocity: 80 90 0 m/s}\n"
    "run: {end: landing, output_step: {flight: 0.25 ms}}\n";

static void read_model_of(const char *const *sets, size_t count, ld_model *model, double tolerance,
                          int seed)
{
    ld_messages messages = {0};
    if (scenario_read_text(scenario, sizeof scenario - 1, "ball", ".", sets, count, model,
                           &messages)) {
        ld_messages_print(&messages, stdout);
        fail();
    }
    model->run.flight_tolerance = tolerance;
    model->environment.wind.turbulence.seed = seed;
}

static void read_model(ld_model *model, double tolerance, int seed)
{
    read_model_of(NULL, 0, model, tolerance, seed);
}

// Along the recorded path, xi by the trapezoidal rule from the recorded velocity.
static void compare_along_path(const char *const *sets, size_t count)
{
    ld_model model;
    recorded_run run;
    turbulence air;
    read_model_of(sets, count, &model, 1e-9, 3);
    recorded_run_make(&run, &model);
    assert_int_equal(turbulence_build(&air, &model.environment.wind.turbulence, 0, NULL), LD_OK);
    size_t t = recorded_column(&run, "t"), altitude = recorded_column(&run, "altitude"),
           v = recorded_column(&run, "center.vx"), wind = recorded_column(&run, "wind.x");
    double xi_u = 0, xi_w = 0, rate_u = 0, rate_w = 0, error = 0, size = 0;
    for (size_t row = 0; row < run.rows; row++) {
        double across = recorded_value(&run, row, v + 2) - 4;
        double speed =
            hypot(hypot(recorded_value(&run, row, v), recorded_value(&run, row, v + 1)), across);
        turbulence_scales scales = turbulence_scales_at(&air, recorded_value(&run, row, altitude) -
                                                                  model.environment.ground_height);
        if (row > 0) {
            double step = recorded_value(&run, row, t) - recorded_value(&run, row - 1, t);
            xi_u += step * (rate_u + speed / scales.L_u) / 2;
            xi_w += step * (rate_w + speed / scales.L_w) / 2;
        }
        rate_u = speed / scales.L_u;
        rate_w = speed / scales.L_w;
        v3 expected = turbulence_velocity(&air, &scales, xi_u, xi_w);
        v3 found = v3_make(recorded_value(&run, row, wind), recorded_value(&run, row, wind + 1),
                           recorded_value(&run, row, wind + 2) - 4);
        error = fmax(error, v3_norm(v3_sub(found, expected)));
        size = fmax(size, v3_norm(found));
    }
    CHECK_WITHIN("largest turbulence [m/s]", size, 1, 6);
    CHECK_BELOW("less that of the path [m/s]", error, 3e-4);
    turbulence_free(&air);
    recorded_run_free(&run);
    model_clear(&model);
}

static void test_wind_of_the_path(void **state)
{
    (void)state;
    // on a round Earth the height is that above the ground there, not y of I
    const char *const round[] = {"environment.earth=round", "environment.ground=450 m",
                                 "environment.site={altitude: 500 m}"};
    compare_along_path(NULL, 0);
    compare_along_path(round, 3);
}

static ld_flight_summary fly(double tolerance, int seed)
{
    ld_model model;
    read_model(&model, tolerance, seed);
    ld_flight_summary flight = summary_of_run(&model).rocket[0].flight;
    model_clear(&model);
    return flight;
}

static double apart(ld_flight_summary a, ld_flight_summary b)
{
    return hypot(a.downrange - b.downrange, a.drift - b.drift);
}

static void test_same_at_any_tolerance(void **state)
{
    (void)state;
    ld_flight_summary exact = fly(1e-11, 3);
    CHECK_BELOW("impact at 1e-6 from that at 1e-11 [m]", apart(fly(1e-6, 3), exact), 5e-2);
    CHECK_BELOW("at 1e-7", apart(fly(1e-7, 3), exact), 1e-3);
    CHECK_BELOW("at 1e-8", apart(fly(1e-8, 3), exact), 5e-5);
    CHECK_BELOW("at 1e-9", apart(fly(1e-9, 3), exact), 5e-6);
    CHECK_WITHIN("another seed [m]", apart(fly(1e-8, 4), exact), 0.1, 50);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_wind_of_the_path),
        cmocka_unit_test(test_same_at_any_tolerance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
