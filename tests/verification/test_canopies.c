// Canopies as bodies on lines: snatch force, opening load, steady descent, double pendulum against
// closed forms; momentum, moment of momentum and energy without air; random descents against a
// small program of its own, by momentum about the ground's axes in short Runge-Kutta steps.
#include "support/check.h"

#include <stdlib.h>

#include "integration/dormand_prince.h"
#include "support/flight_text.h"
#include "systems/flight/canopy.h"

static const double g = 9.80665;

#define THIN "atmosphere: {density: 1e-12 kg/m3, speed_of_sound: 340 m/s}, ground: none"
#define DENSE "atmosphere: {density: 1.2 kg/m3, speed_of_sound: 340 m/s}, ground: none"

// Scenario text: a rocket without air forces of its own, its parachute, the rest.
static ld_model model_of(const char *environment, const char *rocket, const char *parachute,
                         const char *rest)
{
    char text[4096];
    snprintf(text, sizeof text,
             "launchdyn: 1\nenvironment: {%s}\nrocket: {%s,\n  parachutes: [{%s}]}\n%s",
             environment, rocket, parachute, rest);
    return read_text(text);
}

// ---- closed forms

// Force of lines that two masses apart with v0 stretch: m'' l'' = -k l - c l'.
static double snatch_of(double v0, double k, double reduced, double damping, double *when)
{
    double w = sqrt(k / reduced), wd = w * sqrt(1 - damping * damping), most = 0;
    for (int i = 0; i <= 200000; i++) {
        double t = i * 1e-5 * 3.2 / (2 * w);
        double stretch = v0 / wd * exp(-damping * w * t) * sin(wd * t);
        double rate = v0 * exp(-damping * w * t) * (cos(wd * t) - damping * w / wd * sin(wd * t));
        double force = k * stretch + 2 * damping * sqrt(k * reduced) * rate;
        *when = force > most ? t : *when;
        most = fmax(most, force);
    }
    return most;
}

// Without air and gravity the canopy leaves along the axis, or from a point beside it with a rocket
// that resists by its inertia, too: 1/mu = 1/m_c + 1/m' + (n x d)^2/J'.
static void test_snatch(void **state)
{
    (void)state;
    const double damping[] = {0, 0.3, 0.9};
    for (int i = 0; i < 3; i++) {
        char parachute[512];
        snprintf(parachute, sizeof parachute,
                 "name: only, drag_area: 1 m2, trigger: time, time: 0.25 s, canopy: {mass: 0.5 kg, "
                 "line_length: 4 m, line_stiffness: 12 kN, damping: %g, at: 1.2 0 0 m, ejection: 9 "
                 "0 0 m/s}",
                 damping[i]);
        ld_model model =
            model_of(THIN ", gravity: 0 m/s2",
                     "mass: 4 kg, center: 0.3 0 0 m, inertia: 0.1 3 3 kg.m2", parachute,
                     "flight: {position: 0 0 0 m, velocity: 3 4 5 m/s}\n"
                     "run: {end: 1 s, flight_tolerance: 1e-11}\n");
        ld_parachute_summary opened = fly_model(&model).parachute[0];
        double k = 12000 / 4.0, reduced = 0.5 * 3.5 / 4, when = 0;
        double due = snatch_of(9, k, reduced, damping[i], &when);
        if (i == 0)
            CHECK_NEAR("v0 sqrt(k mu) [N]", due, 9 * sqrt(k * reduced), 1e-8);
        CHECK_NEAR("snatch force [N]", opened.snatch, due, 5e-8);
        CHECK_NEAR("largest force [N]", opened.greatest_force, opened.snatch, 0);
        CHECK_NEAR("taut [s]", opened.t_taut, 0.25 + 4 / 9.0, 5e-15);
        CHECK_NEAR("greatest [s]", opened.t_greatest_force, opened.t_taut + when, 2e-7);
        model_clear(&model);
    }
}

static void test_snatch_across(void **state)
{
    (void)state;
    ld_model model = model_of(
        THIN ", gravity: 0 m/s2", "mass: 4 kg, center: 0.3 0 0 m, inertia: 0.1 3 2.95 kg.m2",
        "name: only, drag_area: 1 m2, trigger: time, time: 0 s, canopy: {mass: 0.5 kg, "
        "line_length: "
        "0.01 m, line_stiffness: 4 MN, damping: 0, at: 0.9 0 0 m, ejection: 0 2 0 m/s}",
        "flight: {position: 0 0 0 m, velocity: 3 4 5 m/s}\nrun: {end: 0.02 s, flight_tolerance: "
        "1e-11}\n");
    ld_parachute_summary opened = fly_model(&model).parachute[0];
    double d = 0.6 * 4 / 3.5, J = 2.95 - 0.5 * 4 / 3.5 * 0.36;
    double reduced = 1 / (1 / 0.5 + 1 / 3.5 + d * d / J);
    CHECK_NEAR("snatch force across, relative", opened.snatch / (2 * sqrt(4e8 * reduced)), 1, 2e-9);
    model_clear(&model);
}

// At the balance of both weights with the drag v = sqrt(2 m g/(rho A)) against the air; the lines
// carry the rocket alone.
static void test_steady(void **state)
{
    (void)state;
    ld_model model = model_of(
        DENSE ", wind: {speed: 6 m/s, heading: 90 deg}",
        "mass: 20 kg, center: 0.3 0 0 m, inertia: 0.2 30 30 kg.m2",
        "name: only, drag_area: 8 m2, trigger: time, time: 0.5 s, filling: 0.6 s, canopy: {mass: 2 "
        "kg, line_length: 6 m, line_stiffness: 20 kN, at: 1.5 0 0 m, ejection: 8 0 0 m/s, "
        "packed_area: 0.05 m2, air_volume: 4 m3, strength: 1.1 kN}",
        "flight: {point: center, position: 0 500 0 m, velocity: 0 -25 0 m/s, attitude: {pitch: 90 "
        "deg}}\nrun: {end: 300 s, flight_tolerance: 1e-9}\n");
    recorded_run run;
    recorded_run_make(&run, &model);
    const double *last = run.values + (run.rows - 1) * run.columns;
    double v = sqrt(2 * 20 * g / (1.2 * 8));
    CHECK_NEAR("speed down [m/s]", -last[recorded_column(&run, "center.vy")], v, 1e-7);
    CHECK_NEAR("with the wind [m/s]", last[recorded_column(&run, "center.vz")], 6, 5e-13);
    CHECK_NEAR("of the canopy [m/s]", -last[recorded_column(&run, "canopy.vy")], v, 1e-7);
    CHECK_NEAR("force of the lines [N]", last[recorded_column(&run, "canopy.line_force")], 18 * g,
               2e-5);
    double apart =
        last[recorded_column(&run, "canopy.y")] - last[recorded_column(&run, "center.y")];
    double arm = 1.2 * 20 / 18, stretch = 18 * g / (20000 / 6.0);
    CHECK_NEAR("canopy above the mass centre [m]", apart, 6 + arm + stretch, 5e-9);
    CHECK_NEAR("mass of the rocket [kg]", last[recorded_column(&run, "rocket.mass")], 18, 1e-14);
    CHECK_NEAR("drag area [m2]", last[recorded_column(&run, "drag_area")], 8, 1e-14);
    assert_int_equal(run.summary.note_count, 1);
    assert_non_null(strstr(run.summary.note[0], "strength"));
    recorded_run_free(&run);
    model_clear(&model);
}

// A rocket so heavy that it does not slow down: the load is that of the canopy's drag, greatest
// where it is full, and earlier 1/2 rho v^2 A(t) + rho V'(t) v.
static void test_infinite_mass(void **state)
{
    (void)state;
    ld_model model = model_of(
        DENSE ", gravity: 0 m/s2", "mass: 1e9 kg, center: 0 0 0 m, inertia: 1e9 1e9 1e9 kg.m2",
        "name: only, drag_area: 3 m2, trigger: time, time: 0.1 s, filling: 0.5 s, canopy: {mass: "
        "0.2 kg, line_length: 5 m, line_stiffness: 300 kN, damping: 1, ejection: -2 0 0 m/s, "
        "packed_area: 0.001 m2, air_volume: 2 m3}",
        "flight: {position: 0 0 0 m, velocity: 40 0 0 m/s}\n"
        "run: {end: 2.2 s, flight_tolerance: 1e-9, output_step: {flight: 5 ms}}\n");
    recorded_run run;
    recorded_run_make(&run, &model);
    const ld_parachute_summary *opened = &run.summary.rocket[0].parachute[0];
    double drag = 0.5 * 1.2 * 1600, worst = 0;
    for (size_t i = 0; i < run.rows; i++) {
        double t = recorded_value(&run, i, recorded_column(&run, "t")) - opened->t_taut;
        if (!(t > 0.1 && t < 0.499))
            continue;
        double area = 0.001 + 2.999 * t / 0.5, share = area / 3;
        double due = drag * area + 1.2 * 2 * 1.5 * sqrt(share) * 2.999 / 3 / 0.5 * 40;
        double force = recorded_value(&run, i, recorded_column(&run, "canopy.line_force"));
        worst = fmax(worst, fabs(force / due - 1));
    }
    CHECK_BELOW("load while it fills, relative", worst, 5e-3);
    CHECK_NEAR("when full, relative",
               recorded_value(&run, run.rows - 1, recorded_column(&run, "canopy.line_force")) /
                   (3 * drag),
               1, 3e-7);
    CHECK_NEAR("greatest: full, with the last air [s]", opened->t_greatest_force - opened->t_taut,
               0.5, 2e-9);
    CHECK_BELOW("then, relative",
                opened->greatest_force / (3 * drag + 1.2 * 2 * 1.5 * 2.999 / 3 / 0.5 * 40) - 1,
                5e-3);
    recorded_run_free(&run);
    model_clear(&model);
}

// Over a distance s the load of a rocket that does not slow down is greatest where the canopy is
// full, C_x times the steady one at any speed: C_x = 1 + 3 j V_p/(A_p s).
static void test_opening_infinite_mass(void **state)
{
    (void)state;
    const double power[] = {1, 2, 2}, speed[] = {40, 40, 90};
    for (int i = 0; i < 3; i++) {
        char parachute[512], rest[256];
        snprintf(parachute, sizeof parachute,
                 "name: only, drag_area: 3 m2, trigger: time, time: 0.1 s, filling_distance: 18 m, "
                 "filling_power: %g, canopy: {mass: 0.02 kg, line_length: 5 m, line_stiffness: %g "
                 "N, damping: 1, ejection: -2 0 0 m/s, air_volume: 2.2 m3}",
                 power[i], 3e6 * speed[i] * speed[i] / 1600); // which stretch as much
        snprintf(rest, sizeof rest,
                 "flight: {position: 0 0 0 m, velocity: %g 0 0 m/s}\nrun: {end: 3.2 s, "
                 "flight_tolerance: 1e-9}\n",
                 speed[i]);
        ld_model model =
            model_of(DENSE ", gravity: 0 m/s2",
                     "mass: 1e9 kg, center: 0 0 0 m, inertia: 1e9 1e9 1e9 kg.m2", parachute, rest);
        ld_parachute_summary opened = fly_model(&model).parachute[0];
        double steady = 0.6 * 3 * speed[i] * speed[i];
        double C_x = 1 + 3 * power[i] * 2.2 / (3 * 18);
        CHECK_NEAR("C_x", opened.greatest_force / steady, C_x, 2e-3);
        CHECK_NEAR("way until then [m]", speed[i] * (opened.t_greatest_force - opened.t_taut), 18,
                   0.015);
        model_clear(&model);
    }
}

// A canopy that weighs nothing, on stiff lines, slows m' down in the filling time T (Ludtke,
// Pflanz): v = v0/(1 + B x^(j + 1)), B = rho v0 A_p T/(2 m (j + 1)), the force greatest at x^(j +
// 1) = j/(B (j + 2)).
static void test_opening_finite_mass(void **state)
{
    (void)state;
    const double power[] = {1, 2, 6};
    for (int i = 0; i < 3; i++) {
        char parachute[512];
        snprintf(parachute, sizeof parachute,
                 "name: only, drag_area: 3 m2, trigger: time, time: 0.1 s, filling: 0.8 s, "
                 "filling_power: %g, canopy: {mass: 0.001 kg, line_length: 5 m, line_stiffness: 1 "
                 "MN, damping: 1, ejection: -4 0 0 m/s}",
                 power[i]);
        ld_model model =
            model_of(DENSE ", gravity: 0 m/s2",
                     "mass: 8 kg, center: 0 0 0 m, inertia: 0.1 3 3 kg.m2", parachute,
                     "flight: {position: 0 0 0 m, velocity: 60 0 0 m/s}\nrun: {end: 2.2 s, "
                     "flight_tolerance: 1e-9}\n");
        ld_parachute_summary opened = fly_model(&model).parachute[0];
        double j = power[i], B = 1.2 * 60 * 3 * 0.8 / (2 * 8 * (j + 1));
        double x = pow(j / (B * (j + 2)), 1 / (j + 1)), v = 60 / (1 + B * pow(x, j + 1));
        CHECK_NEAR("opening shock, relative", opened.greatest_force / (0.6 * 3 * pow(x, j) * v * v),
                   1, 2e-3);
        CHECK_NEAR("at, of the filling", (opened.t_greatest_force - opened.t_taut) / 0.8, x, 1e-3);
        model_clear(&model);
    }
}

// While the motor burns the canopy opens below a rocket of the mass of that instant, whose thrust
// ends.
static void test_opens_while_burning(void **state)
{
    (void)state;
    ld_model model = model_of(
        DENSE ", gravity: 0 m/s2",
        "mass: 12 kg, center: 0.3 0 0 m, inertia: 0.1 3 3 kg.m2, empty: {mass: 8 "
        "kg, center: 0.3 0 0 m, inertia: 0.1 3 3 kg.m2}, motor: {thrust: [[0 s, 600 N], [2 s, 600 "
        "N]]}",
        "name: only, drag_area: 1 m2, trigger: time, time: 0.5 s, canopy: {mass: 0.5 kg, "
        "line_length: 4 m, line_stiffness: 12 kN, damping: 0, ejection: 9 0 0 m/s}",
        "flight: {position: 0 0 0 m, velocity: 10 0 0 m/s}\n"
        "run: {end: 0.9 s, flight_tolerance: 1e-11, output_step: {flight: 0.1 s}}\n");
    recorded_run run;
    recorded_run_make(&run, &model);
    const double *last = run.values + (run.rows - 1) * run.columns;
    // 600 N over 12 - 2 t: v = 10 + 300 ln(12/11) at 0.5 s, 11 kg with the canopy
    double v = 10 + 300 * log(12 / 11.0);
    CHECK_NEAR("mass of the rocket [kg]", last[recorded_column(&run, "rocket.mass")], 10.5, 1e-14);
    CHECK_NEAR("thrust [N]", last[recorded_column(&run, "thrust")], 0, 0);
    CHECK_NEAR("momentum of both [kg m/s]",
               10.5 * last[recorded_column(&run, "center.vx")] +
                   0.5 * last[recorded_column(&run, "canopy.vx")],
               11 * v, 1e-9);
    CHECK_NEAR("they part at [m/s]",
               last[recorded_column(&run, "canopy.vx")] - last[recorded_column(&run, "center.vx")],
               9, 1e-11);
    assert_int_equal(run.summary.note_count, 1);
    assert_non_null(strstr(run.summary.note[0], "while the motor was burning"));
    recorded_run_free(&run);
    model_clear(&model);
}

// ---- a double pendulum

typedef struct hanging {
    flight_system system;
    flight_phase phase;
} hanging;

static void slopes(const double *t, const double *y, double *y_dot, void *self)
{
    hanging *one = self;
    flight_rates(&one->system, &one->phase, *t, y, y_dot);
}

// Below a canopy that so much air holds that it stays as fast as it is, lines (l) and rocket (d
// from its point to its mass centre) are a double pendulum: (M w^2 - K) x = 0 with M = [l^2, l d; l
// d, d^2 + J/m], K = g diag(l, d).
static void test_pendulum(void **state)
{
    (void)state;
    ld_model model = model_of(
        DENSE, "mass: 21 kg, center: 0.3 0 0 m, inertia: 0.2 30 30 kg.m2",
        "name: only, drag_area: 1 m2, trigger: time, time: 9 s, canopy: {mass: 1 kg, line_length: "
        "6 "
        "m, line_stiffness: 30 MN, damping: 0, at: 1.5 0 0 m, ejection: 8 0 0 m/s, air_volume: 1e7 "
        "m3}",
        "flight: {position: 0 0 0 m, velocity: 0 0 0 m/s}\nrun: {end: 1 s}\n");
    hanging one;
    assert_int_equal(flight_build(&one.system, &model, 0, NULL), LD_OK);
    one.phase = (flight_phase){.lowest_trigger = -INFINITY};
    flight_set_piece(&one.system, &one.phase, -1);
    double l = 6 + 20 * g / 5e6, d = 1.2 * 21 / 20, J = 30 - 1.0 * 21 / 20 * 1.44;
    double q = d * d + J / 20, a = l * l * q - l * l * d * d, b = -(g * l * q + g * d * l * l),
           c = g * g * l * d;
    for (int mode = 0; mode < 2; mode++) {
        double square = (-b + (mode ? 1 : -1) * sqrt(b * b - 4 * a * c)) / (2 * a);
        double share = (g * l / square - l * l) / (l * d); // of the rocket's angle to the lines'
        double y[DORMAND_PRINCE_STATES] = {0}, lines = 1e-4, turned = share * lines;
        y[FLIGHT_Q] = cos(M_PI / 4 + turned / 2), y[FLIGHT_Q + 3] = sin(M_PI / 4 + turned / 2);
        canopy_open(&one.system, &one.phase, 0, 0, y);
        canopy_switch(&one.phase, true);
        flight_hang(&one.system, &one.phase, 0, 1);
        assert_false(one.phase.hangs);
        for (int i = 0; i < 3; i++)
            y[FLIGHT_V + i] = y[FLIGHT_W + i] = y[FLIGHT_CANOPY_U + i] = 0;
        y[FLIGHT_CANOPY_S] = -d * sin(turned) - l * sin(lines);
        y[FLIGHT_CANOPY_S + 1] = d * cos(turned) + l * cos(lines);
        dormand_prince steps = {.f = slopes, .self = &one, .count = FLIGHT_ALL_STATES};
        for (int i = 0; i < FLIGHT_ALL_STATES; i++)
            steps.step.absolute[i] = 1e-11;
        dormand_prince_start(&steps, 0, y);
        double quarter = M_PI / 2 / sqrt(square), before = 0, found = NAN;
        while (steps.step.t < 1.1 * quarter) {
            assert_true(dormand_prince_step(&steps, 1.1 * quarter));
            double angle =
                -2 * M_PI / 4 + 2 * atan2(steps.step.y[FLIGHT_Q + 3], steps.step.y[FLIGHT_Q]);
            double rate = steps.step.y[FLIGHT_W + 2];
            if (before * turned > 0 && angle * turned <= 0)
                found = steps.step.t - angle / rate;
            before = angle;
        }
        CHECK_NEAR(mode ? "rocket's swing [rad/s]" : "swing on the lines [rad/s]", M_PI / 2 / found,
                   sqrt(square), 2e-6 * sqrt(square));
        one.phase.canopy.given = NULL;
    }
    flight_free(&one.system);
    model_clear(&model);
}

// ---- balances

typedef struct balance {
    v3 momentum, moment;
    double energy;
} balance;

static v3 three(const recorded_run *run, size_t row, const char *x, const char *y, const char *z)
{
    return v3_make(recorded_value(run, row, recorded_column(run, x)),
                   recorded_value(run, row, recorded_column(run, y)),
                   recorded_value(run, row, recorded_column(run, z)));
}

// |d|^2 E - d d^T
static m3 about(v3 d)
{
    double square = v3_dot(d, d);
    return m3_sub(m3_diagonal(square, square, square), m3_outer(d, d));
}

// The rocket without a canopy of mass `taken` at `at`: the three together are the whole again.
static m3 inertia_below(m3 whole, double mass, double taken, v3 c, v3 at)
{
    v3 rest = v3_scale(1 / (mass - taken), v3_sub(v3_scale(mass, c), v3_scale(taken, at)));
    m3 apart = m3_add(m3_scale(taken, about(v3_sub(at, c))),
                      m3_scale(mass - taken, about(v3_sub(rest, c))));
    return m3_sub(whole, apart);
}

static balance balance_of(const recorded_run *run, size_t row, m3 J, double stiffness,
                          double length, v3 arm)
{
    double m = recorded_value(run, row, recorded_column(run, "rocket.mass")), canopy = 0.7;
    v3 r = three(run, row, "center.x", "center.y", "center.z");
    v3 v = three(run, row, "center.vx", "center.vy", "center.vz");
    v3 w = three(run, row, "rocket.wx", "rocket.wy", "rocket.wz");
    quat q = {recorded_value(run, row, recorded_column(run, "rocket.q0")),
              recorded_value(run, row, recorded_column(run, "rocket.q1")),
              recorded_value(run, row, recorded_column(run, "rocket.q2")),
              recorded_value(run, row, recorded_column(run, "rocket.q3"))};
    m3 A = q_matrix(q);
    v3 spin = m3_apply(J, w);
    balance out = {v3_scale(m, v), v3_add(v3_scale(m, v3_cross(r, v)), m3_apply(A, spin)),
                   0.5 * (m * v3_dot(v, v) + v3_dot(w, spin))};
    v3 rc = three(run, row, "canopy.x", "canopy.y", "canopy.z");
    v3 vc = three(run, row, "canopy.vx", "canopy.vy", "canopy.vz");
    if (isnan(rc.x))
        return out;
    out.momentum = v3_axpy(out.momentum, canopy, vc);
    out.moment = v3_axpy(out.moment, canopy, v3_cross(rc, vc));
    out.energy += 0.5 * canopy * v3_dot(vc, vc);
    double stretch = v3_norm(v3_sub(rc, v3_add(r, m3_apply(A, arm)))) - length;
    out.energy += stretch > 0 ? 0.5 * stiffness * stretch * stretch : 0;
    return out;
}

// Without air and gravity: momentum and moment of momentum are those of the rocket before, from a
// point beside its axis, while it turns; lines without damping keep the energy through snatches.
static void test_balances(void **state)
{
    (void)state;
    ld_model model = model_of(
        THIN ", gravity: 0 m/s2",
        "mass: 5 kg, center: 0.3 0.02 -0.01 m, inertia: 0.4 3 2.8 kg.m2, products_of_inertia: 0.05 "
        "-0.03 0.1 kg.m2",
        "name: only, drag_area: 1 m2, trigger: time, time: 0.25 s, canopy: {mass: 0.7 kg, "
        "line_length: 3 m, line_stiffness: 6 kN, damping: 0, at: 1.2 0.15 0.1 m, ejection: 9 2 -3 "
        "m/s}",
        "flight: {position: 0 0 0 m, velocity: 3 4 5 m/s, rate: 2 1 -0.7 rad/s}\n"
        "run: {end: 6 s, flight_tolerance: 1e-11, output_step: {flight: 10 ms}}\n");
    recorded_run run;
    recorded_run_make(&run, &model);
    m3 whole = {{{0.4, 0.05, -0.03}, {0.05, 3, 0.1}, {-0.03, 0.1, 2.8}}};
    v3 c = {0.3, 0.02, -0.01}, at = {1.2, 0.15, 0.1};
    m3 below = inertia_below(whole, 5, 0.7, c, at);
    v3 arm = v3_scale(5 / 4.3, v3_sub(at, c));
    balance first = balance_of(&run, 0, whole, 2000, 3, arm), opened = {.energy = NAN};
    double momentum = 0, moment = 0, energy = 0;
    int snatches = 0;
    bool taut = false;
    for (size_t i = 0; i < run.rows; i++) {
        bool out = recorded_value(&run, i, recorded_column(&run, "t")) > 0.25;
        balance now = balance_of(&run, i, out ? below : whole, 2000, 3, arm);
        opened = out && isnan(opened.energy) ? now : opened;
        momentum = fmax(momentum, v3_norm(v3_sub(now.momentum, first.momentum)));
        moment = fmax(moment, v3_norm(v3_sub(now.moment, first.moment)));
        energy = out ? fmax(energy, fabs(now.energy / opened.energy - 1)) : 0;
        bool pulls = recorded_value(&run, i, recorded_column(&run, "canopy.line_force")) > 0;
        snatches += pulls && !taut;
        taut = pulls;
    }
    CHECK_WITHIN("snatches", snatches, 8, 12);
    CHECK_BELOW("momentum, relative", momentum / v3_norm(first.momentum), 2e-11);
    CHECK_BELOW("moment of momentum, relative", moment / v3_norm(first.moment), 3e-10);
    CHECK_BELOW("energy, relative", energy, 4e-10);
    double relative = 81 + 4 + 9;
    CHECK_WITHIN("energy of the ejection, of that of two points",
                 (opened.energy - first.energy) / (0.5 * 0.7 * 4.3 / 5 * relative), 0.9, 1);
    recorded_run_free(&run);
    model_clear(&model);
}

// ---- by a program of its own

typedef struct two_bodies {
    double mass, canopy, length, k, damping, packed, area, filling, volume, density;
    m3 J; // of the rocket without it
    v3 arm, wind;
    bool out, taut, fills;
    double t_filled; // from when it fills
    double greatest;
    double way, power; // over this distance, INFINITY: over the time; of the share of it
    bool full;
} two_bodies;

// x, v, moment of momentum about the mass centre, attitude; x, v of the canopy, its way as it fills
enum { X = 0, V = 3, H = 6, A = 9, XC = 18, VC = 21, WAY = 24, ALL = 25 };

static double tension_of(const two_bodies *self, const double *y, v3 *e, double *stretch)
{
    m3 turned;
    memcpy(&turned, y + A, sizeof turned);
    v3 w = m3_apply(turned, m3_apply(m3_symmetric_inverse(self->J),
                                     m3_apply_transposed(turned, v3_from(y + H))));
    v3 p = m3_apply(turned, self->arm);
    v3 reach = v3_sub(v3_from(y + XC), v3_add(v3_from(y + X), p));
    double length = v3_norm(reach);
    *e = length > 0 ? v3_scale(1 / length, reach) : v3_zero();
    v3 rate = v3_sub(v3_from(y + VC), v3_add(v3_from(y + V), v3_cross(w, p)));
    *stretch = length - self->length;
    return self->k * *stretch + self->damping * v3_dot(*e, rate);
}

static void two_rates(const two_bodies *self, double t, const double *y, double *f)
{
    m3 turned;
    memcpy(&turned, y + A, sizeof turned);
    v3 w = m3_apply(turned, m3_apply(m3_symmetric_inverse(self->J),
                                     m3_apply_transposed(turned, v3_from(y + H))));
    v3 e = v3_zero(), weight = v3_make(0, -g, 0);
    double stretch, pull = self->out ? tension_of(self, y, &e, &stretch) : 0;
    pull = self->taut ? pull : 0;
    v3_store(f + X, v3_from(y + V));
    v3_store(f + V, v3_axpy(weight, pull / self->mass, e));
    v3_store(f + H, v3_scale(pull, v3_cross(m3_apply(turned, self->arm), e)));
    m3 spun = m3_mul(m3_skew(w), turned);
    memcpy(f + A, &spun, sizeof spun);
    memset(f + XC, 0, 7 * sizeof *f);
    if (!self->out)
        return;
    v3 through = v3_sub(v3_from(y + VC), self->wind);
    double share = (t - self->t_filled) / self->filling, pace = 1 / self->filling;
    if (isfinite(self->way)) {
        share = y[WAY] / self->way;
        pace = v3_norm(through) / self->way;
        f[WAY] = self->fills ? v3_norm(through) : 0;
    }
    share = self->full ? 1 : fmax(0, share);
    double most = self->area - self->packed, area = self->packed + most * pow(share, self->power);
    double held = self->volume * pow(area / self->area, 1.5);
    double grows = self->fills ? most * self->power * pow(share, self->power - 1) * pace : 0;
    double gains = self->volume * 1.5 * sqrt(area / self->area) * grows / self->area;
    v3 load = v3_axpy(v3_scale(self->canopy, weight), -pull, e);
    load = v3_axpy(load, -self->density * (0.5 * area * v3_norm(through) + gains), through);
    v3_store(f + XC, v3_from(y + VC));
    v3_store(f + VC, v3_scale(1 / (self->canopy + self->density * held), load));
}

static void two_step(const two_bodies *self, double t, double h, const double *y, double *end)
{
    double k[4][ALL], at[ALL];
    const double part[4] = {0, 0.5, 0.5, 1};
    for (int stage = 0; stage < 4; stage++) {
        for (int i = 0; i < ALL; i++)
            at[i] = y[i] + (stage ? part[stage] * h * k[stage - 1][i] : 0);
        two_rates(self, t + part[stage] * h, at, k[stage]);
    }
    for (int i = 0; i < ALL; i++)
        end[i] = y[i] + h / 6 * (k[0][i] + 2 * (k[1][i] + k[2][i]) + k[3][i]);
}

// A step at whose end the lines are otherwise, or the canopy is full, is halved.
static void two_advance(two_bodies *self, double t, double h, double *y)
{
    double end[ALL], stretch, pull;
    v3 e;
    two_step(self, t, h, y, end);
    pull = tension_of(self, end, &e, &stretch);
    bool taut = self->out && stretch > 0 && pull > 0, full = self->full;
    if (self->fills && !full)
        full = isfinite(self->way) ? end[WAY] >= self->way
                                   : t + h >= self->t_filled + self->filling - 1e-12;
    if ((taut != self->taut || full != self->full) && h > 1e-12) {
        two_advance(self, t, 0.5 * h, y);
        two_advance(self, t + 0.5 * h, 0.5 * h, y);
        return;
    }
    memcpy(y, end, sizeof end);
    if (taut && isinf(self->t_filled)) {
        self->t_filled = t + h;
        self->fills = true;
    }
    self->taut = taut;
    self->full = full;
    self->fills = self->fills && !full;
    self->greatest = fmax(self->greatest, taut ? pull : 0);
}

// Velocity of the canopy against its point, and of the point, after an impulse on the canopy.
static void push(const two_bodies *self, v3 impulse, double *y)
{
    m3 turned;
    memcpy(&turned, y + A, sizeof turned);
    v3 p = m3_apply(turned, self->arm);
    v3_store(y + V, v3_axpy(v3_from(y + V), -1 / self->mass, impulse));
    v3_store(y + H, v3_sub(v3_from(y + H), v3_cross(p, impulse)));
    v3_store(y + VC, v3_axpy(v3_from(y + VC), 1 / self->canopy, impulse));
}

static v3 apart(const two_bodies *self, const double *y)
{
    m3 turned;
    memcpy(&turned, y + A, sizeof turned);
    v3 w = m3_apply(turned, m3_apply(m3_symmetric_inverse(self->J),
                                     m3_apply_transposed(turned, v3_from(y + H))));
    v3 point = v3_add(v3_from(y + V), v3_cross(w, m3_apply(turned, self->arm)));
    return v3_sub(v3_from(y + VC), point);
}

static double between(uint64_t *seed, double low, double high)
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(*seed >> 11) / 9007199254740992.0;
}

// The rocket that turns freely up to the opening, at t, and what it is then.
static void two_open(two_bodies *self, m3 whole, double mass, v3 c, v3 at, v3 ejection, double t,
                     double *y)
{
    two_bodies before = *self;
    before.J = whole;
    before.arm = v3_sub(at, c);
    for (int i = 0; i < 200; i++)
        two_advance(&before, i * t / 200, t / 200, y);
    m3 turned;
    memcpy(&turned, y + A, sizeof turned);
    v3 w = m3_apply(
        turned, m3_apply(m3_symmetric_inverse(whole), m3_apply_transposed(turned, v3_from(y + H))));
    v3 moved = m3_apply(turned, v3_scale(self->canopy / self->mass, v3_sub(c, at)));
    v3 out = m3_apply(turned, v3_sub(at, c)), v = v3_from(y + V), r = v3_from(y + X);
    v3_store(y + X, v3_add(r, moved));
    v3_store(y + V, v3_add(v, v3_cross(w, moved)));
    v3_store(y + XC, v3_add(r, out));
    v3_store(y + VC, v3_add(v, v3_cross(w, out)));
    self->J = inertia_below(whole, mass, self->canopy, c, at);
    v3_store(y + H, m3_apply(turned, m3_apply(self->J, m3_apply_transposed(turned, w))));
    self->arm = v3_scale(mass / self->mass, v3_sub(at, c));
    self->out = true;
    // by what unit impulses do
    m3 done;
    for (int i = 0; i < 3; i++) {
        double tried[ALL];
        memcpy(tried, y, sizeof tried);
        push(self, v3_make(i == 0, i == 1, i == 2), tried);
        v3 u = v3_sub(apart(self, tried), apart(self, y));
        done.a[0][i] = u.x, done.a[1][i] = u.y, done.a[2][i] = u.z;
    }
    push(self, m3_apply(m3_symmetric_inverse(done), m3_apply(turned, ejection)), y);
}

enum { LINEARLY, BY_POWER, BY_WAY };

static void check_random(uint64_t seed, int law)
{
    uint64_t s = seed, of_law = seed + 77;
    double mass = between(&s, 6, 30), canopy = between(&s, 0.3, 1.5);
    v3 c = {between(&s, 0.2, 0.6), between(&s, -0.02, 0.02), between(&s, -0.02, 0.02)};
    v3 at = {between(&s, 0.8, 1.6), between(&s, -0.1, 0.1), between(&s, -0.1, 0.1)};
    v3 ejection = {between(&s, 5, 15), between(&s, -3, 3), between(&s, -3, 3)};
    v3 v = {between(&s, -20, 30), between(&s, -20, 10), between(&s, -10, 10)};
    v3 w = {between(&s, -1, 1), between(&s, -1, 1), between(&s, -1, 1)};
    double across = between(&s, 8, 12);
    m3 whole = m3_diagonal(between(&s, 0.3, 0.5), across, across + between(&s, -0.2, 0.2));
    two_bodies two = {.mass = mass - canopy,
                      .canopy = canopy,
                      .length = between(&s, 2, 6),
                      .packed = between(&s, 0.02, 0.2),
                      .area = between(&s, 1, 9),
                      .filling = between(&s, 0.1, 0.8),
                      .volume = between(&s, 0, 8),
                      .density = 1.2,
                      .wind = {between(&s, -8, 8), 0, between(&s, -8, 8)},
                      .t_filled = INFINITY,
                      .way = INFINITY,
                      .power = 1};
    if (law != LINEARLY)
        two.power = between(&of_law, 2, 4);
    if (law == BY_WAY)
        two.way = between(&of_law, 2, 9);
    double stiffness = between(&s, 4e3, 3e4), damping = between(&s, 0, 0.5);
    two.k = stiffness / two.length;
    two.damping = 2 * damping * sqrt(two.k * canopy * two.mass / mass);
    char environment[512], rocket[512], parachute[1024], rest[512];
    snprintf(environment, sizeof environment,
             DENSE ", wind: {speed: %.17g m/s, heading: %.17g rad}", hypot(two.wind.x, two.wind.z),
             atan2(two.wind.z, two.wind.x));
    snprintf(rocket, sizeof rocket,
             "mass: %.17g kg, center: %.17g %.17g %.17g m, inertia: %.17g %.17g %.17g kg.m2", mass,
             c.x, c.y, c.z, whole.a[0][0], whole.a[1][1], whole.a[2][2]);
    snprintf(parachute, sizeof parachute,
             "name: only, drag_area: %.17g m2, trigger: time, time: 0.15 s, %s: %.17g %s, "
             "filling_power: %.17g, canopy: {mass: %.17g kg, line_length: %.17g m, line_stiffness: "
             "%.17g N, damping: "
             "%.17g, at: %.17g %.17g %.17g m, ejection: %.17g %.17g %.17g m/s, packed_area: %.17g "
             "m2, air_volume: %.17g m3}",
             two.area, law == BY_WAY ? "filling_distance" : "filling",
             law == BY_WAY ? two.way : two.filling, law == BY_WAY ? "m" : "s", two.power, canopy,
             two.length, stiffness, damping, at.x, at.y, at.z, ejection.x, ejection.y, ejection.z,
             two.packed, two.volume);
    snprintf(rest, sizeof rest,
             "flight: {point: center, position: 0 0 0 m, velocity: %.17g %.17g %.17g m/s, rate: "
             "%.17g %.17g %.17g rad/s}\nrun: {end: 2 s, flight_tolerance: 1e-10}\n",
             v.x, v.y, v.z, w.x, w.y, w.z);
    double y[ALL] = {0};
    m3 upright = m3_identity();
    memcpy(y + A, &upright, sizeof upright);
    v3_store(y + V, v);
    v3_store(y + H, m3_apply(whole, w));
    two_open(&two, whole, mass, c, at, ejection, 0.15, y);
    for (double t = 0.15, end; t < 2; t = end) {
        end = fmin(t + 1e-4, 2);
        two_advance(&two, t, end - t, y);
    }
    ld_model model = model_of(environment, rocket, parachute, rest);
    recorded_run run;
    recorded_run_make(&run, &model);
    size_t last = run.rows - 1;
    v3 r = three(&run, last, "center.x", "center.y", "center.z");
    v3 rc = three(&run, last, "canopy.x", "canopy.y", "canopy.z");
    const ld_parachute_summary *opened = &run.summary.rocket[0].parachute[0];
    CHECK_BELOW("mass centre [m]", v3_norm(v3_sub(r, v3_from(y + X))), 2e-9);
    CHECK_BELOW("canopy [m]", v3_norm(v3_sub(rc, v3_from(y + XC))), 2e-9);
    CHECK_NEAR("first taut [s]", opened->t_taut, two.t_filled, 1e-10);
    CHECK_BELOW("largest force, relative", opened->greatest_force / two.greatest - 1, 2e-6);
    recorded_run_free(&run);
    model_clear(&model);
}

static void test_random(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= OF_ALL(6, 1); seed++)
        for (int law = LINEARLY; law <= BY_WAY; law++)
            check_random(seed, law);
}

// ---- in flights

// The error falls with the tolerance through all instants at which lines become taut or slack.
static void test_convergence(void **state)
{
    (void)state;
    double far[4] = {0}, tolerance[] = {1e-6, 1e-8, 1e-10, 1e-13};
    v3 end[4];
    for (int i = 0; i < 4; i++) {
        char rest[256];
        snprintf(rest, sizeof rest,
                 "flight: {point: center, position: 0 300 0 m, velocity: 25 0 3 m/s, rate: 0 0.3 0 "
                 "rad/s}\nrun: {end: 4 s, flight_tolerance: %g}\n",
                 tolerance[i]);
        ld_model model = model_of(
            DENSE, "mass: 12 kg, center: 0.3 0.01 0 m, inertia: 0.2 9 9 kg.m2",
            "name: only, drag_area: 4 m2, trigger: time, time: 0.5 s, filling: 0.7 s, canopy: "
            "{mass: 0.8 kg, line_length: 5 m, line_stiffness: 15 kN, damping: 0.05, at: 1.2 0.05 0 "
            "m, ejection: 9 0 0 m/s, packed_area: 0.02 m2}",
            rest);
        end[i] = v3_from(fly_model(&model).final.center);
        model_clear(&model);
    }
    for (int i = 0; i < 3; i++)
        far[i] = v3_norm(v3_sub(end[i], end[3]));
    CHECK_BELOW("at a tolerance of 1e-6 [m]", far[0], 2e-5);
    CHECK_BELOW("1e-8 [m]", far[1], 1e-7);
    CHECK_BELOW("1e-10 [m]", far[2], 5e-10);
}

// Speed of a fall in balance, v that of a point: the canopy, above the mass centre by its lines and
// `arm`, is where the air is thinner, and the air in it slows down, too.
static double thinner(double v, double height, double mass, double arm)
{
    double scale = 288 / (g / 287.053 - 0.0065), held = 3 * 1.225 * exp(-height / scale);
    double apart = 5 + arm + (mass - 1) * g / 3000;
    return v + v / (2 * scale) * (apart + held * v * v / (2 * mass * g));
}

// Two, one after the other, on the turning Earth: it falls as a point below as much drag area.
static void test_on_earth(void **state)
{
    (void)state;
    static const char *const canopy[] = {
        "", ", canopy: {mass: 1 kg, line_length: 5 m, line_stiffness: 15 kN, damping: 0.3, at: 1.2 "
            "0 0 m, ejection: 9 0 0 m/s, air_volume: 3 m3}"};
    ld_rocket_summary rocket[2];
    for (int i = 0; i < 2; i++) {
        char parachutes[1024];
        snprintf(parachutes, sizeof parachutes,
                 "name: drogue, drag_area: 0.6 m2, trigger: time, time: 0.5 s%s}, {name: main, "
                 "drag_area: 7 m2, trigger: height, height: 300 m%s",
                 canopy[i], canopy[i]);
        ld_model model = model_of(
            "earth: wgs84, site: {latitude: 45 deg, azimuth: 60 deg}, wind: {speed: 4 m/s, "
            "heading: 60 deg}",
            "mass: 12 kg, center: 0.3 0 0 m, inertia: 0.2 9 9 kg.m2", parachutes,
            "flight: {position: 0 900 0 m, velocity: 0 -3 0 m/s, attitude: {pitch: 90 "
            "deg}}\n");
        rocket[i] = fly_model(&model);
        model_clear(&model);
    }
    // the drogue's canopy leaves with its mass
    double at_main = thinner(rocket[0].parachute[1].airspeed, 300, 12, 0.9 * 12 / 11);
    double down = sqrt(pow(rocket[0].flight.impact_speed, 2) - 16) * sqrt(11 / 12.0);
    CHECK_NEAR("airspeed below the drogue [m/s]", rocket[1].parachute[1].airspeed, at_main, 3e-4);
    CHECK_NEAR("landing speed below the main [m/s]", rocket[1].flight.impact_speed,
               hypot(4, thinner(down, 0, 11, (0.9 + 0.9 / 11) * 1.1)), 3e-4);
    CHECK_NEAR("main opened [m]", rocket[1].parachute[1].height, 300, 1e-7);
    assert_true(isnan(rocket[0].parachute[0].snatch) && rocket[1].parachute[0].snatch > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_snatch),
        cmocka_unit_test(test_snatch_across),
        cmocka_unit_test(test_steady),
        cmocka_unit_test(test_infinite_mass),
        cmocka_unit_test(test_opening_infinite_mass),
        cmocka_unit_test(test_opening_finite_mass),
        cmocka_unit_test(test_opens_while_burning),
        cmocka_unit_test(test_pendulum),
        cmocka_unit_test(test_balances),
        cmocka_unit_test(test_random),
        cmocka_unit_test(test_convergence),
        cmocka_unit_test(test_on_earth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
