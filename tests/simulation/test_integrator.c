// The integrator's adapter against closed forms: order, events, interpolation, repetition.
#include "simulation/integrator.h"
#include "support/check.h"

// Oscillator y'' = -y: y = (sin t, cos t); event: y[0] = 0.5 first at pi/6.
static int oscillator(double t, const double *y, double *y_dot, void *self)
{
    (void)t, (void)self;
    y_dot[0] = y[1];
    y_dot[1] = -y[0];
    return 0;
}

static int half(double t, const double *y, double *g, void *self)
{
    (void)t, (void)self;
    g[0] = 0.5 - y[0];
    return 0;
}

static integrator *make(double rtol, integrator_events events)
{
    double atol[2] = {rtol, rtol};
    integrator_settings settings = {.n = 2,
                                    .rtol = rtol,
                                    .atol = atol,
                                    .rhs = oscillator,
                                    .events = events,
                                    .event_count = events ? 1 : 0};
    integrator *self = NULL;
    ld_error error;
    assert_int_equal(integrator_create(&settings, &self, &error), LD_OK);
    assert_int_equal(integrator_start(self, 0, (double[]){0, 1}, &error), LD_OK);
    return self;
}

static void error_follows_tolerance(void **state)
{
    (void)state;
    double bounds[] = {1e-6, 5e-8, 8e-10, 1e-11};
    for (int k = 0; k < 4; k++) {
        double rtol = pow(10, -5 - 2 * k);
        integrator *self = make(rtol, NULL);
        while (integrator_step(self, 10.0, NULL) == INTEGRATOR_STEPPED)
            ;
        CHECK_BELOW("oscillator at t = 10: error", integrator_state(self)[0] - sin(10.0),
                    bounds[k]);
        integrator_free(self);
    }
}

static void event_is_a_step_end(void **state)
{
    (void)state;
    integrator *self = make(1e-10, half);
    integrator_outcome outcome;
    do
        outcome = integrator_step(self, 10.0, NULL);
    while (outcome == INTEGRATOR_STEPPED);
    assert_int_equal(outcome, INTEGRATOR_EVENT);
    assert_int_equal(integrator_event(self, 0), -1);
    CHECK_BELOW("event time less pi/6", integrator_time(self) - acos(-1.0) / 6, 5e-12);
    CHECK_BELOW("state at the event, against sin t there",
                integrator_state(self)[0] - sin(integrator_time(self)), 5e-12);
    integrator_free(self);
}

static void interpolation_lies_on_the_solution(void **state)
{
    (void)state;
    integrator *self = make(1e-8, NULL);
    double worst = 0;
    while (integrator_time(self) < 3) {
        integrator_step(self, 3.0, NULL);
        for (double x = 0.1; x < 1; x += 0.2) {
            double t0 = integrator_previous_time(self), y[2];
            double t = t0 + x * (integrator_time(self) - t0);
            integrator_interpolate(self, t, y);
            worst = fmax(worst, fabs(y[0] - sin(t)));
        }
    }
    CHECK_BELOW("cubic Hermite between steps", worst, 2e-7);
    integrator_free(self);
}

static int not_finite(double t, const double *y, double *y_dot, void *self)
{
    (void)y, (void)self;
    y_dot[0] = 1;
    return t > 1;
}

static void failing_equations_are_reported(void **state)
{
    (void)state;
    double atol = 1e-6;
    integrator_settings settings = {.n = 1, .rtol = 1e-6, .atol = &atol, .rhs = not_finite};
    integrator *self = NULL;
    ld_error error;
    assert_int_equal(integrator_create(&settings, &self, &error), LD_OK);
    assert_int_equal(integrator_start(self, 0, (double[]){0}, &error), LD_OK);
    integrator_outcome outcome;
    do
        outcome = integrator_step(self, 10.0, &error);
    while (outcome == INTEGRATOR_STEPPED);
    assert_int_equal(outcome, INTEGRATOR_FAILED);
    assert_non_null(strstr(error.text, "gave no finite result at t ="));
    integrator_free(self);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(error_follows_tolerance),
        cmocka_unit_test(event_is_a_step_end),
        cmocka_unit_test(interpolation_lies_on_the_solution),
        cmocka_unit_test(failing_equations_are_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
