// Air brakes against closed forms: over time, over height, along the axis.
#include "support/check.h"

#include "support/flight_text.h"
#include "systems/flight/flight.h"

static ld_model model_of(const char *brakes, const char *rest)
{
    char text[2048];
    snprintf(text, sizeof text,
             "launchdyn: 1\n"
             "environment: {atmosphere: {density: 1.2 kg/m3, speed_of_sound: 340 m/s}, gravity: 0 "
             "m/s2, ground: -20 m}\n"
             "rocket: {mass: 4 kg, center: 0.3 0 0 m, inertia: 0.1 1 1 kg.m2,\n"
             "  air_brakes: {%s}}\n%s",
             brakes, rest);
    return read_text(text);
}

// m v' = -rho A v^2/2, so 1/v grows by rho/(2 m) times the integral of A: out between 1 and 1.4 s
// after an ignition at -0.5 s, in again by 3 s, the first value before and the last after.
static void test_over_time(void **state)
{
    (void)state;
    ld_model model = model_of(
        "over_time: [[1 s, 0.02 m2], [1.4 s, 0.3 m2], [2.5 s, 0.3 m2], [3 s, 0.01 m2]], scale: 1.5",
        "flight: {point: center, position: 0 0 0 m, velocity: 50 0 0 m/s, ignition: -0.5 s}\n"
        "run: {end: 5 s, flight_tolerance: 1e-11}\n");
    ld_rocket_summary rocket = fly_model(&model);
    double area = 0.5 * 0.02 + 0.4 * 0.16 + 1.1 * 0.3 + 0.5 * 0.155 + 2 * 0.01;
    CHECK_NEAR("speed [m/s]", rocket.final.center_velocity[0],
               1 / (1 / 50.0 + 1.2 / 8 * 1.5 * area), 1e-9);
    model_clear(&model);
}

// Upwards dv/dh = -rho A v/(2 m): ln v falls by rho/(2 m) times the integral of A over the height,
// which counts from the ground.
static void test_over_height(void **state)
{
    (void)state;
    ld_model model = model_of("over_height: [[60 m, 0 m2], [80 m, 0.2 m2], [140 m, 0.1 m2]]",
                              "flight: {point: center, position: 0 0 0 m, speed: 50 m/s, attitude: "
                              "{pitch: 90 deg}}\n"
                              "run: {end: 5 s, flight_tolerance: 1e-12}\n");
    ld_rocket_summary rocket = fly_model(&model);
    double h = rocket.final.center[1] + 20;
    assert_true(h > 140);
    double area = 20 * 0.1 + 60 * 0.15 + (h - 140) * 0.1;
    CHECK_NEAR("speed [m/s]", rocket.final.center_velocity[1], 50 * exp(-1.2 / 8 * area), 1e-8);
    model_clear(&model);
}

// A rocket 60 degrees beside its way: what it moves along its axis, by the whole speed, along it.
static void test_direction(void **state)
{
    (void)state;
    ld_model model = model_of("over_time: [[0 s, 0.2 m2]]",
                              "flight: {point: center, position: 0 0 0 m, velocity: 50 0 0 m/s, "
                              "attitude: {pitch: 60 deg}}\n");
    flight_system system;
    assert_int_equal(flight_build(&system, &model, 0, NULL), LD_OK);
    flight_phase phase = {.t_ignition = 0};
    double y[FLIGHT_STATES] = {0}, y_dot[FLIGHT_STATES];
    flight_set_piece(&system, &phase, -1);
    flight_start(&system, &phase, &model.flight, y);
    flight_rates(&system, &phase, 0, y, y_dot);
    double a = 0.5 * 1.2 * 0.2 * 50 * 50 * cos(M_PI / 3) / 4;
    CHECK_NEAR("against the way [m/s2]", y_dot[FLIGHT_V], -a * cos(M_PI / 3), 1e-13);
    CHECK_NEAR("down [m/s2]", y_dot[FLIGHT_V + 1], -a * sin(M_PI / 3), 1e-13);
    for (int i = 0; i < 3; i++)
        CHECK_NEAR("angular acceleration [rad/s2]", y_dot[FLIGHT_W + i], 0, 0);
    flight_free(&system);
    model_clear(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_over_time),
        cmocka_unit_test(test_over_height),
        cmocka_unit_test(test_direction),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
