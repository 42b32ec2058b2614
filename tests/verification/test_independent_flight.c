// The reference flight and others against a second formulation of free flight
// (support/dense_flight): where, when and how they land.
#include "model/model.h"
#include "support/check.h"

#include <stdlib.h>

#include "quantities/summary.h"
#include "scenario/scenario.h"
#include "support/dense_flight.h"

static ld_model read_model(const char *const *sets, size_t count)
{
    ld_model model;
    ld_messages messages;
    if (scenario_read(LD_SOURCE_DIR "/examples/flight.yaml", sets, count, &model, &messages)) {
        ld_messages_print(&messages, stdout);
        fail();
    }
    return model;
}

static double apart(const double *a, const double *b)
{
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

// Flies the example with changes both ways; `bound` [m] of the impact.
static void compare(const char *what, const char *const *sets, size_t count, double bound)
{
    ld_model model = read_model(sets, count);
    static ld_summary summary;
    ld_simulation *simulation;
    ld_error error;
    dense_flight_end other;
    model.run.flight_tolerance = 1e-12;
    assert_int_equal(ld_simulation_create(&model, &simulation, &error), LD_OK);
    if (ld_simulation_run(simulation, NULL, &summary, &error))
        fail_msg("%s: %s", what, error.text);
    dense_flight(&model, 1e-3, &other);
    const ld_final_state *ours = &summary.rocket[0].final;
    const double *q = ours->quaternion;
    const double axis[] = {1 - 2 * (q[2] * q[2] + q[3] * q[3]), 2 * (q[1] * q[2] + q[0] * q[3]),
                           2 * (q[1] * q[3] - q[0] * q[2])};
    printf("    %s: to x = %.3f m, z = %.3f m in %.3f s, apogee %.3f m, Mach %.3f\n", what,
           ours->center[0], ours->center[2], ours->t, summary.rocket[0].flight.apogee,
           summary.rocket[0].flight.max_mach);
    CHECK_BELOW("impact [m]", apart(ours->center, other.center), bound);
    CHECK_BELOW("rear adaptor at impact [m]", apart(ours->position, other.position), 10 * bound);
    CHECK_BELOW("velocity there [m/s]", apart(ours->center_velocity, other.velocity), bound);
    CHECK_BELOW("instant of impact [s]", ours->t - other.t, bound);
    CHECK_BELOW("its angle below the horizontal [rad]",
                summary.rocket[0].flight.impact_angle - other.angle, bound);
    CHECK_BELOW("axis there", apart(axis, other.axis), 10 * bound);
    CHECK_BELOW("rate there [rad/s]", apart(ours->rate_inertial, other.rate), 100 * bound);
    // its steps of 1 ms miss the apex by up to a h^2/8
    bool flat = model.environment.earth.kind == LD_EARTH_FLAT;
    double above = summary.rocket[0].flight.apogee + model.environment.ground_height - other.apogee;
    CHECK_BELOW("apogee above its highest step [m]", fmax(0, -above), flat ? 1e-9 : 2e-7);
    CHECK_BELOW("apogee over it", above, 1e-5);
    if (!flat)
        CHECK_NEAR("altitude of the impact [m]", ours->altitude, model.environment.ground_height,
                   5e-9);
    ld_simulation_free(simulation);
    model_clear(&model);
}

#define COMPARE(what, bound, ...)                                                                  \
    do {                                                                                           \
        const char *const sets[] = {__VA_ARGS__};                                                  \
        compare(what, sets, sizeof sets / sizeof sets[0], bound);                                  \
    } while (0)

static void test_reference(void **state)
{
    (void)state;
    COMPARE("reference", 2e-7, "title=reference");
    COMPARE("not balanced", 2e-7, "rocket.eccentricity=0.5 -0.3 mm",
            "rocket.motor.misalignment=0.3 0.5 mrad", "rocket.motor.at=0 0.2 0.1 mm",
            "rocket.products_of_inertia=0.02 -0.01 0.05 kg.m2", "rocket.mass_error=0.2 kg");
}

static void test_wind(void **state)
{
    (void)state;
    COMPARE("side wind", 2e-7, "environment.wind={speed: 6 m/s, heading: 70 deg}");
    COMPARE(
        "profile", 2e-7,
        "environment.wind={profile: [[0 m, 1 m/s, 2 m/s], [100 m, 3 m/s, 5 m/s], [400 m, 2 m/s, "
        "9 m/s], [900 m, -4 m/s, 8 m/s]], scale: 0.9, add: 0.3 0.1 -0.2 m/s}");
    COMPARE(
        "gusts, geographic", 2e-7, "environment.site={azimuth: 30 deg, altitude: 500 m}",
        "environment.wind={axes: geographic, profile: [[0 m, 1 m/s, 2 m/s], [900 m, 3 m/s, 5 "
        "m/s]], gust: [{start: 0.2 s, rise: 0.3 s, hold: 0.1 s, speed: 5 m/s, heading: 90 deg}, "
        "{start: 3 s, rise: 1 s, fall: 2 s, speed: 8 m/s, heading: 200 deg}]}");
}

static void test_round_earth(void **state)
{
    (void)state;
    COMPARE("round", 5e-6, "environment.earth=round",
            "environment.site={latitude: 35 deg, longitude: 20 deg, azimuth: 60 deg}");
    COMPARE(
        "WGS 84", 5e-6, "environment.earth=wgs84",
        "environment.site={latitude: -50 deg, longitude: 120 deg, altitude: 700 m, azimuth: 200 "
        "deg}",
        "environment.wind={speed: 4 m/s, heading: 20 deg}");
    COMPARE(
        "WGS 84, ground 300 m below the site, wind over height", 5e-6, "environment.earth=wgs84",
        "environment.site={latitude: 60 deg, longitude: 10 deg, altitude: 700 m, azimuth: 80 "
        "deg}",
        "environment.ground=400 m",
        "environment.wind={profile: [[0 m, 1 m/s, 2 m/s], [300 m, 3 m/s, 5 m/s], [400 m, 2 m/s, "
        "9 m/s], [900 m, -4 m/s, 8 m/s]]}");
}

static void test_odd_flights(void **state)
{
    (void)state;
    COMPARE("dropped from rest", 2e-7, "flight.ignition=-10 s", "flight.position=0 300 0 m",
            "flight.velocity=0 0 0 m/s", "flight.rate=0 0 0 rad/s",
            "flight.attitude={pitch: 40 deg}");
    COMPARE("tumbling backward", 2e-7, "flight.ignition=-10 s", "flight.position=0 500 0 m",
            "flight.velocity=-120 40 10 m/s", "flight.rate=3 1 -2 rad/s",
            "rocket.aerodynamics.crossflow={drag: 8, at: 1 m}",
            "rocket.aerodynamics.x_cp_shift=0.5 m");
    COMPARE("other scales", 2e-7, "rocket.aerodynamics.ca_scale=1.2",
            "rocket.aerodynamics.cn_scale=0.9", "rocket.motor.thrust_scale=1.05",
            "rocket.motor.time_scale=1.1", "environment.density_scale=1.03",
            "environment.temperature_offset=12 K", "environment.ground=-20 m",
            "flight.ignition=0.3 s", "flight.position=1 2 3 m",
            "flight.attitude=", "flight.quaternion=0.9 0.3 0.1 0.2", "flight.rate=3 0.1 0.2 rad/s");
    COMPARE("side force, nozzle that moves, rise", 2e-7, "flight.ignition=0.05 s",
            "rocket.motor.rise_scale=1.4", "rocket.motor.delay=30 ms",
            "rocket.motor.misalignment=0.3 0.5 mrad", "rocket.motor.at=0 0.2 0.1 mm",
            "rocket.motor.side_force={force: [[0 s, 20 N, 5 N], [0.1 s, -8 N, 30 N], [0.3 s, 2 N, "
            "1 N]], scale: 0.7, angle: 50 deg}",
            "rocket.motor.nozzle=[[0.05 s, 1 mrad, 0 rad, 0 m, 0.1 mm], [0.2 s, 0 rad, -2 mrad, 1 "
            "mm, 0 m], [0.7 s, 0 rad, 0 rad, 0 m, 0 m]]");
    COMPARE("two further motors, lit apart", 2e-7, "flight.ignition=0.05 s",
            "rocket.motor.misalignment=0.3 0.5 mrad", "rocket.motor.delay=30 ms",
            "rocket.motor.nozzle=[[0.05 s, 1 mrad, 0 rad, 0 m, 0.1 mm], [0.2 s, 0 rad, -2 mrad, 1 "
            "mm, 0 m]]",
            "rocket.further_motors=[{thrust: [[0 s, 300 N], [0.4 s, 500 N], [0.4 s, 100 N], [0.6 "
            "s, 50 N]], at: 0.1 0.05 0.02 m, misalignment: -20 10 mrad, delay: 0.11 s, "
            "thrust_scale: 1.1, time_scale: 0.9}, {thrust: [[0 s, 0 N], [0.3 s, 400 N], [0.5 s, 0 "
            "N]], at: 0.1 -0.05 0.02 m, delay: 0.17 s}]");
    COMPARE(
        "plain body", 2e-7, "flight.ignition=-10 s",
        "rocket.aerodynamics={model: body, area: 0.02 m2, drag: 0.8, damping: -1 -2 -3, lengths: "
        "0.1 0.8 0.9 m, reference_diameter: , fin_cant: , table: }");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_reference),
        cmocka_unit_test(test_wind),
        cmocka_unit_test(test_round_earth),
        cmocka_unit_test(test_odd_flights),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
