// Descent under parachutes against closed forms: fall to the terminal speed, in wind, filling,
// triggers, one in the place of another, the terminal speed of the standard's air, the run that
// ends at the highest point.
#include "support/check.h"

#include <stdlib.h>

#include "support/flight_text.h"

static const double g = 9.80665;

// Scenario text with a rocket of 4 kg without air forces of its own, and what is given.
static ld_model model_of(const char *environment, const char *parachutes, const char *rest)
{
    char text[2048];
    snprintf(text, sizeof text,
             "launchdyn: 1\nenvironment: {%s}\n"
             "rocket: {mass: 4 kg, center: 0.3 0.01 0 m, inertia: 0.1 1 1 kg.m2,\n"
             "  parachutes: [%s]}\n%s",
             environment, parachutes, rest);
    return read_text(text);
}

static ld_rocket_summary fly(const char *environment, const char *parachutes, const char *rest)
{
    ld_model model = model_of(environment, parachutes, rest);
    ld_rocket_summary rocket = fly_model(&model);
    model_clear(&model);
    return rocket;
}

#define UNIFORM "atmosphere: {density: 1.2 kg/m3, speed_of_sound: 340 m/s}"

// From rest: v = v_t tanh(g t/v_t), fallen v_t^2/g ln cosh(g t/v_t); across, with the wind. A
// rocket that turns, and a mass centre beside its axis, change nothing.
static void test_terminal_speed(void **state)
{
    (void)state;
    ld_rocket_summary rocket =
        fly(UNIFORM ", ground: none, wind: {speed: 6 m/s, heading: 90 deg}",
            "{name: only, drag_area: 0.5 m2, trigger: time, time: 0 s}",
            "flight: {point: center, position: 0 0 0 m, velocity: 0 0 6 m/s, rate: 3 1 2 rad/s}\n"
            "run: {end: 4 s, flight_tolerance: 1e-11}\n");
    double v = sqrt(2 * 4 * g / (1.2 * 0.5)), t = 4;
    CHECK_NEAR("speed [m/s]", -rocket.final.center_velocity[1], v * tanh(g * t / v), 1e-9);
    CHECK_NEAR("fallen [m]", -rocket.final.center[1], v * v / g * log(cosh(g * t / v)), 1e-9);
    CHECK_NEAR("drift [m]", rocket.final.center[2], 6 * t, 1e-9);
    CHECK_NEAR("opened [s]", rocket.parachute[0].t_open, 0, 0);
    CHECK_NEAR("rate [rad/s]", rocket.final.rate[0], 0, 0);
}

// Without gravity m v' = -rho A v^2/2, so 1/v grows by rho/(2 m) times the integral of A: nothing
// for 0.5 s, a drogue that fills in 0.4 s, and a main that takes its position at 1.5 s in 2 s, the
// motor's last second pushing nothing.
static void test_filling(void **state)
{
    (void)state;
    ld_model model = model_of(
        UNIFORM ", gravity: 0 m/s2, ground: none",
        "{name: main, drag_area: 3 m2, trigger: time, time: 1.2 s, lag: 0.3 s, filling: 2 s},"
        "{name: drogue, drag_area: 0.2 m2, trigger: time, time: 0.5 s, filling: 0.4 s}",
        "flight: {point: center, position: 0 0 0 m, velocity: 50 0 0 m/s}\n"
        "run: {end: 5 s, flight_tolerance: 1e-11}\n");
    recorded_run run;
    recorded_run_make(&run, &model);
    const ld_rocket_summary *rocket = &run.summary.rocket[0];
    double area = 0.2 * 0.4 / 2 + 0.2 * (1.5 - 0.9) + (0.2 + 3) / 2 * 2 + 3 * (5 - 3.5);
    CHECK_NEAR("speed at the end [m/s]", rocket->final.center_velocity[0],
               1 / (1 / 50.0 + 1.2 / 8 * area), 1e-9);
    CHECK_NEAR("main opened [s]", rocket->parachute[0].t_open, 1.5, 1e-15);
    CHECK_NEAR("drogue opened [s]", rocket->parachute[1].t_open, 0.5, 1e-15);
    CHECK_NEAR("airspeed at the drogue's opening [m/s]", rocket->parachute[1].airspeed, 50, 1e-12);
    double before = 0.2 * 0.4 / 2 + 0.2 * (1.5 - 0.9);
    CHECK_NEAR("airspeed at the main's opening [m/s]", rocket->parachute[0].airspeed,
               1 / (1 / 50.0 + 1.2 / 8 * before), 1e-9);
    double worst = 0;
    for (size_t i = 0; i < run.rows; i++) {
        double t = recorded_value(&run, i, recorded_column(&run, "t"));
        double due = t <= 0.5   ? 0
                     : t <= 0.9 ? 0.2 * (t - 0.5) / 0.4
                     : t <= 1.5 ? 0.2
                     : t <= 3.5 ? 0.2 + 2.8 * (t - 1.5) / 2
                                : 3;
        double area_now = recorded_value(&run, i, recorded_column(&run, "drag_area"));
        worst = fmax(worst, fabs(area_now - due));
        double attack = recorded_value(&run, i, recorded_column(&run, "angle_of_attack"));
        assert_true(isnan(attack) == (t > 0.5));
    }
    CHECK_BELOW("drag area [m2]", worst, 1e-14);
    recorded_run_free(&run);
    model_clear(&model);
}

// One that takes another's place while that one still fills begins with what has filled.
static void test_filling_in_another(void **state)
{
    (void)state;
    ld_rocket_summary rocket =
        fly(UNIFORM ", gravity: 0 m/s2, ground: none",
            "{name: drogue, drag_area: 0.2 m2, trigger: time, time: 0.5 s, filling: 2 s},"
            "{name: main, drag_area: 3 m2, trigger: time, time: 1.5 s, filling: 1 s}",
            "flight: {point: center, position: 0 0 0 m, velocity: 50 0 0 m/s}\n"
            "run: {end: 4 s, flight_tolerance: 1e-11}\n");
    double area = 0.1 / 2 * 1 + (0.1 + 3) / 2 * 1 + 3 * (4 - 2.5);
    CHECK_NEAR("speed at the end [m/s]", rocket.final.center_velocity[0],
               1 / (1 / 50.0 + 1.2 / 8 * area), 1e-9);
}

// A of the share x of time or way: drag areas below which the rocket is slowed without gravity.
typedef struct growth {
    double from, to, length, power; // [m2], [s] or [m]
} growth;

static double area_at(const growth *by, double at)
{
    return by->from + (by->to - by->from) * fmin(1, pow(at / by->length, by->power));
}

// Integral of A up to there.
static double swept(const growth *by, double at)
{
    double x = fmin(at, by->length), more = (by->to - by->from) * by->length / (by->power + 1);
    return by->from * x + more * pow(x / by->length, by->power + 1) + by->to * (at - x);
}

// In time (Pflanz): 1/v = 1/v0 + rho/(2 m) times that integral; with A = A_p x^j the deceleration
// is greatest at x^(j+1) = j/(B (j + 2)), B = rho v0 A_p T/(2 m (j + 1)).
static void test_filling_by_power(void **state)
{
    (void)state;
    const double power[] = {2, 6, 2.7};
    for (int i = 0; i < 3; i++) {
        growth by = {0, 3, 1.3, power[i]};
        char parachutes[256];
        snprintf(parachutes, sizeof parachutes,
                 "{name: only, drag_area: 3 m2, trigger: time, time: 0.4 s, filling: 1.3 s, "
                 "filling_power: %g}",
                 power[i]);
        ld_rocket_summary rocket =
            fly(UNIFORM ", gravity: 0 m/s2, ground: none, wind: {speed: 6 m/s, heading: 180 deg}",
                parachutes,
                "flight: {point: center, position: 0 0 0 m, velocity: 50 0 0 m/s}\n"
                "run: {end: 3 s, flight_tolerance: 1e-11}\n");
        double v0 = 56, B = 1.2 * v0 * 3 * 1.3 / (8 * (power[i] + 1));
        double x = pow(power[i] / (B * (power[i] + 2)), 1 / (power[i] + 1));
        double v = v0 / (1 + B * pow(x, power[i] + 1));
        CHECK_NEAR("speed at the end [m/s]", rocket.final.center_velocity[0] + 6,
                   1 / (1 / v0 + 1.2 / 8 * swept(&by, 2.6)), 2e-10);
        CHECK_NEAR("greatest deceleration, relative",
                   rocket.flight.max_acceleration / (0.6 * 3 * pow(x, power[i]) * v * v / 4), 1,
                   1e-4);
        CHECK_NEAR("at [s]", rocket.flight.t_max_acceleration, 0.4 + 1.3 * x, 5e-3);
    }
}

// Over the way s through the air v = v0 exp(-rho/(2 m) swept(s)), whence the time by quadrature.
static double time_over(const growth *by, double v0, double way)
{
    double sum = 0, cut[] = {0, fmin(way, by->length), way};
    for (int part = 0; part < 2; part++)
        for (int i = 0; i <= 2000; i++) {
            double s = cut[part] + (cut[part + 1] - cut[part]) * i / 2000;
            double weight = i % 2000 == 0 ? 1 : i % 2 ? 4 : 2;
            sum += (cut[part + 1] - cut[part]) / 6000 * weight / v0 * exp(1.2 / 8 * swept(by, s));
        }
    return sum;
}

static void test_filling_by_way(void **state)
{
    (void)state;
    const double power[] = {1, 2, 3.5};
    for (int i = 0; i < 3; i++) {
        char parachutes[512];
        snprintf(parachutes, sizeof parachutes,
                 "{name: drogue, drag_area: 0.2 m2, trigger: time, time: 0.5 s, filling_distance: "
                 "9 m, filling_power: %g},"
                 "{name: main, drag_area: 3 m2, trigger: time, time: %g s, filling_distance: 14 m, "
                 "filling_power: %g}",
                 power[i], i == 1 ? 0.6 : 1.5, power[2 - i]);
        ld_model model =
            model_of(UNIFORM ", gravity: 0 m/s2, ground: none, wind: {speed: 6 m/s}", parachutes,
                     "flight: {point: center, position: 0 0 0 m, velocity: 50 0 0 m/s}\n"
                     "run: {end: 4 s, flight_tolerance: 1e-11, output_step: {flight: 0.1 s}}\n");
        recorded_run run;
        recorded_run_make(&run, &model);
        growth by[] = {{0, 0.2, 9, power[i]}, {0.2, 3, 14, power[2 - i]}};
        double open[] = {0.5, i == 1 ? 0.6 : 1.5}, from = 0, v0 = 44, speed = 0, area = 0, late = 0;
        int opened = -1;
        for (size_t k = 0; k < run.rows; k++) {
            double t = recorded_value(&run, k, recorded_column(&run, "t"));
            double x = recorded_value(&run, k, recorded_column(&run, "center.x")) - 6 * t;
            double v = recorded_value(&run, k, recorded_column(&run, "center.vx")) - 6;
            double now = recorded_value(&run, k, recorded_column(&run, "drag_area"));
            if (opened >= 0) {
                double due = v0 * exp(-1.2 / 8 * swept(&by[opened], x - from));
                speed = fmax(speed, fabs(v - due));
                late = fmax(late, fabs(open[opened] + time_over(&by[opened], v0, x - from) - t));
            }
            if (opened < 1 && t > open[opened + 1] - 1e-9) {
                opened++;
                from = x;
                v0 = v;
                by[opened].from = now;
            }
            area = fmax(area, fabs(now - (opened < 0 ? 0 : area_at(&by[opened], x - from))));
        }
        assert_int_equal(opened, 1);
        CHECK_BELOW("speed over the way [m/s]", speed, 1e-9);
        CHECK_BELOW("time over the way [s]", late, 2e-10);
        CHECK_BELOW("drag area [m2]", area, 4e-12);
        recorded_run_free(&run);
        model_clear(&model);
    }
}

// Opened at its highest point it falls until it fills: (v^2)' = 2 g - rho A v^2/m over the way, so
// v^2 = exp(-P) times the integral of 2 g exp(P), P = rho/m times the integral of A.
static void test_filling_from_rest(void **state)
{
    (void)state;
    ld_rocket_summary rocket =
        fly(UNIFORM ", ground: none",
            "{name: only, drag_area: 3 m2, trigger: time, time: 0 s, filling_distance: 8 m, "
            "filling_power: 2}",
            "flight: {point: center, position: 0 0 0 m, velocity: 0 0 0 m/s}\n"
            "run: {end: 1.6 s, flight_tolerance: 1e-11}\n");
    growth by = {0, 3, 8, 2};
    double way = -rocket.final.center[1], sum = 0, cut[] = {0, 8, way};
    double P = 1.2 / 4 * swept(&by, way);
    assert_true(way > 8);
    for (int part = 0; part < 2; part++)
        for (int i = 0; i <= 2000; i++) {
            double s = cut[part] + (cut[part + 1] - cut[part]) * i / 2000;
            double weight = i % 2000 == 0 ? 1 : i % 2 ? 4 : 2;
            sum += (cut[part + 1] - cut[part]) / 6000 * weight * exp(1.2 / 4 * swept(&by, s) - P);
        }
    CHECK_NEAR("speed below what has filled [m/s]", -rocket.final.center_velocity[1],
               sqrt(2 * g * sum), 5e-11);
}

// A drogue that opens in the place of the main is reported.
static void test_lesser(void **state)
{
    (void)state;
    static const char *const order[] = {"main", "drogue"};
    for (int i = 0; i < 2; i++) {
        char parachutes[256];
        snprintf(parachutes, sizeof parachutes,
                 "{name: %s, drag_area: 3 m2, trigger: time, time: %d s},"
                 "{name: %s, drag_area: 0.2 m2, trigger: time, time: %d s}",
                 order[0], 1 + i, order[1], 2 - i);
        ld_model model =
            model_of(UNIFORM ", gravity: 0 m/s2, ground: none", parachutes,
                     "flight: {position: 0 0 0 m, velocity: 50 0 0 m/s}\nrun: {end: 3 s}\n");
        ld_summary summary = summary_of_run(&model);
        assert_int_equal(summary.note_count, i == 0);
        if (i == 0)
            assert_non_null(strstr(summary.note[0], "the drag falls"));
        model_clear(&model);
    }
}

// In air that hardly brakes: up v^2/(2 g) in v/g; the height's trigger where the way down has come
// there, or at the highest point where that is not above it.
static void test_triggers(void **state)
{
    (void)state;
    const char *thin = "atmosphere: {density: 1e-12 kg/m3, speed_of_sound: 340 m/s}, ground: -7 m";
    const char *parachutes =
        "{name: low, drag_area: 1 m2, trigger: height, height: 30 m, lag: 0.25 s},"
        "{name: top, drag_area: 1 m2, trigger: apogee},"
        "{name: late, drag_area: 1 m2, trigger: apogee, lag: 1.25 s, filling: 0.1 s},"
        "{name: high, drag_area: 1 m2, trigger: height, height: 500 m},"
        "{name: never, drag_area: 1 m2, trigger: time, time: 100 s}";
    ld_rocket_summary rocket = fly(thin, parachutes,
                                   "flight: {point: center, position: 0 0 0 m, velocity: 5 40 0 "
                                   "m/s, ignition: 0.5 s}\n");
    double v = 40, top = v * v / (2 * g), t_top = v / g - 0.5;
    CHECK_NEAR("apogee's trigger [s]", rocket.parachute[1].t_open, t_top, 1e-9);
    CHECK_NEAR("height there, over the ground [m]", rocket.parachute[1].height, top + 7, 1e-9);
    CHECK_NEAR("the one with a lag [s]", rocket.parachute[2].t_open, t_top + 1.25, 1e-9);
    CHECK_NEAR("height above the highest point [s]", rocket.parachute[3].t_open, t_top, 1e-9);
    CHECK_NEAR("height on the way down [s]", rocket.parachute[0].t_open,
               t_top + sqrt(2 * (top - 23) / g) + 0.25, 1e-9);
    assert_true(isnan(rocket.parachute[4].t_open));
    CHECK_NEAR("landing, as without a parachute [s]", rocket.flight.t_impact,
               t_top + sqrt(2 * (top + 7) / g), 1e-9);
}

// In air whose density grows slowly on the way down the speed follows that of the balance.
static void test_standard_air(void **state)
{
    (void)state;
    ld_rocket_summary rocket =
        fly("atmosphere: us1976", "{name: only, drag_area: 2 m2, trigger: time, time: 0 s}",
            "flight: {point: center, position: 0 800 0 m, velocity: 0 -5 0 m/s}\n");
    const double R = 8314.32 / 28.9644;
    double v = sqrt(2 * 4 * g / (101325 / (R * 288.15) * 2));
    // the density's scale height H; the balance with the deceleration v^2/(2 H) of v = sqrt(k/rho)
    double height = 288.15 / (g / R - 0.0065);
    CHECK_NEAR("speed at the landing, relative to the balance's", rocket.flight.impact_speed / v,
               1 + v * v / (4 * g * height), 1e-7);
}

static void test_end_at_apogee(void **state)
{
    (void)state;
    ld_rocket_summary rocket = fly("atmosphere: none", "",
                                   "flight: {point: center, position: 0 0 0 m, velocity: 5 40 0 "
                                   "m/s}\nrun: {end: apogee}\n");
    CHECK_NEAR("end [s]", rocket.final.t, 40 / g, 1e-12);
    CHECK_NEAR("height [m]", rocket.final.center[1], 1600 / (2 * g), 1e-12);
    CHECK_NEAR("rise [m/s]", rocket.final.center_velocity[1], 0, 1e-12);
    CHECK_NEAR("apogee [s]", rocket.flight.t_apogee, 40 / g, 1e-12);
    assert_true(isnan(rocket.flight.t_impact));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_terminal_speed),     cmocka_unit_test(test_filling),
        cmocka_unit_test(test_filling_in_another), cmocka_unit_test(test_filling_by_power),
        cmocka_unit_test(test_filling_by_way),     cmocka_unit_test(test_filling_from_rest),
        cmocka_unit_test(test_triggers),           cmocka_unit_test(test_standard_air),
        cmocka_unit_test(test_end_at_apogee),      cmocka_unit_test(test_lesser),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
