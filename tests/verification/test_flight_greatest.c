// What a flight says of its greatest values, against closed forms: dynamic pressure within a step
// and at a corner of the thrust, acceleration on both sides of a corner, apogee, stability margin.
#include "support/check.h"

#include <stdlib.h>

#include "support/flight_text.h"

static const double g = 9.80665;

static ld_flight_summary fly(const char *text)
{
    ld_model model = read_text(text);
    ld_flight_summary flight = fly_model(&model).flight;
    model_clear(&model);
    return flight;
}

// Straight up from 11.5 km by a constant acceleration a through the isothermal layer of the
// standard, where the density falls as exp(-H g/(R T)) with the geopotential height H = r z/(r +
// z): the dynamic pressure is greatest where 2/t = g/(R T) dH/dz a t. Then on without thrust to the
// top.
static void test_within_a_step(void **state)
{
    (void)state;
    ld_flight_summary flight =
        fly("launchdyn: 1\n"
            "rocket: {mass: 10 kg, inertia: 0.1 1 1 kg.m2,\n"
            "  motor: {thrust: [[0 s, 498.0665 N], [20 s, 498.0665 N], [20 s, 0 N]]}}\n"
            "flight: {position: 0 11500 0 m, velocity: 0 0 0 m/s, attitude: {pitch: 90 deg}}\n"
            "run: {end: 103 s}\n");
    const double a = 40, r = 6356766, H = 8314.32 / 28.9644 * 216.65 / g, z0 = 11500;
    double t = sqrt(2 * H / a), z = z0;
    for (int i = 0; i < 50; i++) {
        z = z0 + a * t * t / 2;
        t = sqrt(2 * H / a) * (r + z) / r;
    }
    double above = r * z / (r + z) - 11000;
    double p = 101325 * pow(216.65 / 288.15, g / (8314.32 / 28.9644 * 0.0065)); // at 11 km
    double density = p / (8314.32 / 28.9644 * 216.65) * exp(-above / H);
    CHECK_NEAR("time of the greatest dynamic pressure [s]", flight.t_max_dynamic_pressure, t, 2e-6);
    CHECK_NEAR("greatest dynamic pressure, relative",
               flight.max_dynamic_pressure / (density * a * t * a * t / 2), 1, 2e-14);
    CHECK_NEAR("greatest acceleration [m/s2]", flight.max_acceleration, a, 1e-12);
    double v = a * 20;
    CHECK_NEAR("time of the apogee [s]", flight.t_apogee, 20 + v / g, 1e-12);
    CHECK_NEAR("apogee [m]", flight.apogee, z0 + a * 200 + v * v / (2 * g), 1e-10);
}

// The same downwards, braked by a: the pressure grows by the density and falls by the speed, and is
// greatest where 2 a/v = g/(R T) dH/dz v.
static void test_within_a_step_of_a_fall(void **state)
{
    (void)state;
    ld_flight_summary flight =
        fly("launchdyn: 1\n"
            "rocket: {mass: 10 kg, inertia: 0.1 1 1 kg.m2,\n"
            "  motor: {thrust: [[0 s, 498.0665 N], [20 s, 498.0665 N], [20 s, 0 N]]}}\n"
            "flight: {position: 0 19500 0 m, velocity: 0 -800 0 m/s, attitude: {pitch: 90 deg}}\n"
            "run: {end: 6 s}\n");
    const double a = 40, r = 6356766, H = 8314.32 / 28.9644 * 216.65 / g, v0 = 800;
    double t = 0;
    for (int i = 0; i < 50; i++)
        t = (v0 - sqrt(2 * a * H) * (r + 19500 - v0 * t + a * t * t / 2) / r) / a;
    CHECK_NEAR("time of the greatest dynamic pressure of a fall [s]", flight.t_max_dynamic_pressure,
               t, 1e-7);
}

// A mass that halves: thrust over the mass is greatest where the thrust ends; of a thrust that
// begins with its peak, at the ignition, which the clock counts from.
static void test_at_corners(void **state)
{
    (void)state;
    ld_flight_summary flight =
        fly("launchdyn: 1\n"
            "environment: {atmosphere: {density: 1.2 kg/m3, speed_of_sound: 340 m/s}}\n"
            "rocket: {mass: 10 kg, inertia: 0.1 1 1 kg.m2,\n"
            "  empty: {mass: 5 kg, center: 0 0 0 m, inertia: 0.1 1 1 kg.m2},\n"
            "  motor: {thrust: [[0 s, 500 N], [2 s, 500 N], [2 s, 0 N]]}}\n"
            "flight: {ignition: 0.5 s, position: 0 100 0 m, velocity: 0 50 0 m/s,\n"
            "  attitude: {pitch: 90 deg}}\n"
            "run: {end: 3 s}\n");
    CHECK_NEAR("greatest acceleration [m/s2]", flight.max_acceleration, 500 / 5.0 - g, 1e-11);
    CHECK_NEAR("its time [s]", flight.t_max_acceleration, 2, 1e-14);
    double v = 50 - 0.5 * g - 2 * g + 500 * 2 / 5.0 * log(2);
    CHECK_NEAR("greatest dynamic pressure, relative", flight.max_dynamic_pressure / (0.6 * v * v),
               1, 1e-8);
    CHECK_NEAR("its time [s]", flight.t_max_dynamic_pressure, 2, 1e-14);
    flight = fly("launchdyn: 1\n"
                 "environment: {atmosphere: none}\n"
                 "rocket: {mass: 10 kg, inertia: 0.1 1 1 kg.m2,\n"
                 "  motor: {thrust: [[0 s, 2 kN], [2 s, 500 N], [2 s, 0 N]]}}\n"
                 "flight: {ignition: 0.5 s, position: 0 100 0 m, velocity: 0 50 0 m/s,\n"
                 "  attitude: {pitch: 90 deg}}\n");
    CHECK_NEAR("greatest acceleration at ignition [m/s2]", flight.max_acceleration, 200 - g, 1e-11);
    CHECK_NEAR("its time [s]", flight.t_max_acceleration, 0, 1e-14);
    CHECK_NEAR("dynamic pressure without air [Pa]", flight.max_dynamic_pressure, 0, 0);
}

// Half the density times the square of the airspeed in wind; the margin by a centre of pressure
// that goes evenly with the Mach number, held beyond the table, and a mass centre that moves.
static void test_columns(void **state)
{
    (void)state;
    ld_model model = read_text(
        "launchdyn: 1\n"
        "environment: {atmosphere: {density: 1.2 kg/m3, speed_of_sound: 340 m/s},\n"
        "  wind: {speed: 10 m/s, heading: 0 deg}}\n"
        "rocket: {mass: 10 kg, center: 1.1 0 0 m, inertia: 0.1 1 1 kg.m2,\n"
        "  empty: {mass: 5 kg, center: 1.2 0 0 m, inertia: 0.1 1 1 kg.m2},\n"
        "  motor: {thrust: [[0 s, 500 N], [2 s, 500 N], [2 s, 0 N]]},\n"
        "  aerodynamics: {reference_diameter: 0.1 m, interpolation: linear,\n"
        "    beyond_table: hold,\n"
        "    table: [[0, 0.3, 0.3, 8, 0.4 m, 0, 0, 0], [0.5, 0.3, 0.3, 8, 0.6 m, 0, 0, "
        "0]]}}\n"
        "flight: {position: 0 0 0 m, velocity: 80 30 0 m/s, attitude: {pitch: 20 deg}}\n");
    recorded_run run;
    recorded_run_make(&run, &model);
    const ld_flight_summary *flight = &run.summary.rocket[0].flight;
    CHECK_NEAR("margin at the start", flight->stability_margin,
               (1.1 - (0.4 + 0.4 * sqrt(70 * 70 + 30 * 30) / 340)) / 0.1, 1e-13);
    double worst[3] = {0}, top = -1, t_top = 0, greatest = 0;
    for (size_t i = 0; i < run.rows; i++) {
#define OF(name) recorded_value(&run, i, recorded_column(&run, name))
        double speed = hypot(OF("center.vx") - 10, OF("center.vy")), mach = speed / 340;
        double burnt = OF("t") < 2 ? OF("t") / 2 : 1;
        double margin = (1.1 + 0.1 * burnt - 0.4 - 0.4 * fmin(mach, 0.5)) / 0.1;
        worst[0] = fmax(worst[0], fabs(OF("dynamic_pressure") - 0.6 * speed * speed));
        worst[1] = fmax(worst[1], fabs(OF("stability_margin") - margin));
        t_top = OF("altitude") > top ? OF("t") : t_top;
        top = fmax(top, OF("altitude"));
        greatest = fmax(greatest, OF("acceleration"));
    }
#undef OF
    CHECK_BELOW("dynamic pressure [Pa]", worst[0], 1e-10);
    CHECK_BELOW("stability margin", worst[1], 1e-12);
    CHECK_NEAR("time of the apogee [s]", flight->t_apogee, t_top, 1e-12);
    CHECK_BELOW("greatest acceleration of the rows over the summary's",
                greatest - flight->max_acceleration, 1e-12);
    recorded_run_free(&run);
    model_clear(&model);
}

// A rocket whose centre of pressure lies before its mass centre gives a warning, unless it spins
// fast enough: J_x^2 p^2 = 4 J_t M'.
static void test_unstable(void **state)
{
    (void)state;
    const double S = acos(-1) * 0.0025, slope = 0.5 * 1.2 * 6400 * S * 2 * 0.07;
    const double spin = sqrt(4 * 1.5 * slope) / 0.03;
    const double rate[] = {0, 0.999 * spin, 1.001 * spin};
    printf("    spin at which it stands: %.4g rad/s\n", spin);
    for (int i = 0; i < 3; i++) {
        ld_model model = read_text(
            "launchdyn: 1\n"
            "environment: {atmosphere: {density: 1.2 kg/m3, speed_of_sound: 340 m/s}}\n"
            "rocket: {mass: 10 kg, center: 1 0 0 m, inertia: 0.03 1.5 1.5 kg.m2,\n"
            "  aerodynamics: {reference_diameter: 0.1 m,\n"
            "    table: [[0, 0.3, 0.3, 2, 1.07 m, 0, 0, 0], [3, 0.3, 0.3, 2, 1.07 m, 0, 0, 0]]}}\n"
            "flight: {position: 0 9 0 m, velocity: 80 0 0 m/s}\n"
            "run: {end: 1 ms}\n");
        model.flight.rate[0] = rate[i];
        recorded_run run;
        recorded_run_make(&run, &model);
        CHECK_NEAR("margin", run.summary.rocket[0].flight.stability_margin, -0.7, 1e-14);
        assert_int_equal(run.summary.note_count, i < 2);
        if (i < 2) {
            printf("    %s\n", run.summary.note[0]);
            assert_non_null(strstr(run.summary.note[0], "its stability margin is -0.70 calibres"));
        }
        recorded_run_free(&run);
        model_clear(&model);
    }
}

// A plain body has no centre of pressure.
static void test_no_margin(void **state)
{
    (void)state;
    ld_flight_summary flight = fly("launchdyn: 1\n"
                                   "rocket: {mass: 3 kg, inertia: 1 1 1 kg.m2,\n"
                                   "  aerodynamics: {model: body, area: 0.1 m2, drag: 0.5}}\n"
                                   "flight: {position: 0 10 0 m, velocity: 0 0 0 m/s}\n");
    assert_true(isnan(flight.stability_margin));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_within_a_step), cmocka_unit_test(test_within_a_step_of_a_fall),
        cmocka_unit_test(test_at_corners),    cmocka_unit_test(test_columns),
        cmocka_unit_test(test_no_margin),     cmocka_unit_test(test_unstable),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
