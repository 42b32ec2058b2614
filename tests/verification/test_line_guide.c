// A line that breaks or becomes taut while the rocket is in its guide, and containers that move,
// against closed forms of a rocket that slides without friction or weight along the line's way.
#include "support/check.h"

#include <stdlib.h>

#include "support/flight_text.h"
#include "support/reference_model.h"
#include "systems/flight/line.h"
#include "systems/launching/launcher.h"

static const v3 still = {0, 0, 0};
// The rocket, its guide, where the bridle is from the container at the start.
static const double M = 6, length = 3, start = 0.1, l_0 = 0.5;

// A rail, off the axes of I, and a rocket on it that nothing but its motor and the line moves.
static ld_model slider(const char *thrust, const char *line, const char *end)
{
    char text[2048];
    snprintf(
        text, sizeof text,
        "launchdyn: 1\nenvironment: {gravity: 0 m/s2, atmosphere: none, ground: none}\n"
        "base: {kind: fixed, elevation: 35 deg, azimuth: 20 deg}\n"
        "tubes:\n  length: %g m\n  sections: [{from: 0 m, inner_radius: 40 mm, outer_radius: 45 "
        "mm}]\n"
        "  material: {youngs_modulus: 70 GPa, poisson_ratio: 0.33, density: 2700 kg/m3}\n"
        "  modes: {bending: 2, torsion: 1, damping: 1 %%}\n  slot: none\n"
        "  supports:\n    - {at: 0.1 m, clamped: all}\n"
        "rocket:\n  start_at: %g m\n  mass: %g kg\n  center: 0.16 0 0 m\n"
        "  inertia: 0.003 0.03 0.03 kg.m2\n"
        "  adaptors: [{name: rear, at: 0 m, clearance: 0.2 mm}, {name: front, at: 0.3 m, "
        "clearance: "
        "0.2 mm}]\n"
        "  contact: {stiffness: 1e7 N/m, restitution: 0.5, friction: 0}\n  lock: none\n"
        "  motor: {thrust: %s}\n"
        "  line: {length: 80 m, diameter: 4 mm, container_on: launcher, container: %g 0 0 m, %s}\n"
        "run: {end: %s, tolerance: 1e-10}\n",
        length, start, M, thrust, start - l_0, line, end);
    return read_text(text);
}

static v3 place_of(const ld_rocket_summary *rocket, int i)
{
    return v3_make(rocket->line.place[i].x, rocket->line.place[i].y, rocket->line.place[i].z);
}

// ---- breaks

// Without the ramp of T_c below 0.1 m/s:  (M + m' l) u is the impulse of F - T_c, so with x^2 = s
// ds/dt = u gives dt = 2 (M + m' l) dx/sqrt(2 (F - T_c) (M + m' (l_0 + s/2))).
typedef struct pulling {
    double F, m, hold;
} pulling;

static double speed_at(const pulling *by, double s)
{
    double p = sqrt(2 * (by->F - by->hold) * s * (M + by->m * (l_0 + 0.5 * s)));
    return p / (M + by->m * (l_0 + s));
}

static double pull_at(const pulling *by, double s)
{
    double u = speed_at(by, s), l = l_0 + s;
    double a = (by->F - by->hold - by->m * u * u) / (M + by->m * l);
    return by->hold + by->m * u * u + by->m * l * a;
}

static double time_to(const pulling *by, double s)
{
    double sum = 0, X = sqrt(s);
    const int n = 400;
    for (int i = 0; i <= n; i++) {
        double at = pow(X * i / n, 2);
        sum += (i == 0 || i == n ? 1
                : i % 2          ? 4
                                 : 2) *
               2 * (M + by->m * (l_0 + at)) /
               sqrt(2 * (by->F - by->hold) * (M + by->m * (l_0 + 0.5 * at)));
    }
    return sum * X / (3 * n);
}

static v3 along(double s)
{
    const double degree = acos(-1) / 180;
    v3 x = {cos(35 * degree) * cos(20 * degree), sin(35 * degree),
            -cos(35 * degree) * sin(20 * degree)};
    return v3_scale(s, x);
}

static void test_breaks(void **state)
{
    (void)state;
    const pulling by = {900, 0.03, 15};
    const double breaking = 30;
    ld_model model = slider("[[0 s, 900 N], [1 s, 900 N]]",
                            "mass_per_length: 30 g/m, stiffness: 20 kN, tension: 15 N, "
                            "breaking_force: 30 N",
                            "0.4 s");
    recorded_run run;
    recorded_run_make(&run, &model);
    const ld_rocket_summary *rocket = &run.summary.rocket[0];
    double low = 0, high = length;
    for (int i = 0; i < 60; i++) {
        double middle = 0.5 * (low + high);
        *(pull_at(&by, middle) < breaking ? &low : &high) = middle;
    }
    double s = low, u = speed_at(&by, s), left = length - start - s;
    printf("  breaks %.6f m on its way, after %.6f s\n", s, time_to(&by, s));
    CHECK_WITHIN("breaks in the guide, on its way [m]", s, 0.3, length - 1);
    CHECK_NEAR("breaks [s]", rocket->line.t_break, time_to(&by, s), 1.2e-5);
    v3 off = v3_sub(v3_from(rocket->line.broken), along(start + s));
    CHECK_BELOW("where [m]", v3_norm(off), 4e-7);
    CHECK_BELOW("from the rocket [m]", rocket->line.broken_at, 0);
    CHECK_NEAR("exit speed [m/s]", rocket->exit_speed, sqrt(u * u + 2 * by.F * left / M), 3e-6);
    double greatest = 0, after = 0;
    for (size_t i = 0; i < run.rows; i++) {
        double t = recorded_value(&run, i, recorded_column(&run, "t"));
        double pull = recorded_value(&run, i, recorded_column(&run, "line.tension"));
        double *most = t > rocket->line.t_break + 1e-9 ? &after : &greatest;
        *most = fmax(*most, pull);
    }
    CHECK_NEAR("greatest pull in the guide [N]", greatest, breaking, 1e-12);
    CHECK_BELOW("pull after that [N]", after, 0);
    CHECK_BELOW("energy balance, relative", run.summary.energy.residual_relative, 1e-13);
    // in flight it is gone; what was out lies where it broke
    double t_out = 0.4 - rocket->t_rear;
    CHECK_NEAR("speed after the flight [m/s]", v3_norm(v3_from(rocket->final.center_velocity)),
               rocket->exit_speed + by.F / M * t_out, 2e-13);
    CHECK_BELOW("greatest pull in flight [N]", rocket->line.greatest_tension, 0);
    CHECK_NEAR("length out [m]", rocket->line.paid_out, l_0 + s, 4e-7);
    CHECK_NEAR("remaining [m]", rocket->line.remaining, 80 - l_0 - s, 4e-7);
    v3 out = along(l_0 + s);
    CHECK_NEAR("reach [m]", rocket->line.reach, hypot(out.x, out.z), 4e-7);
    off = v3_sub(place_of(rocket, LD_LINE_PLACES - 1), v3_from(rocket->line.broken));
    CHECK_BELOW("its last place [m]", v3_norm(off), 1e-12);
    off = v3_sub(place_of(rocket, 0), along(start - l_0));
    CHECK_BELOW("its first place [m]", v3_norm(off), 1e-12);
    assert_non_null(strstr(run.summary.note[run.summary.note_count - 1], "broke in the guide"));
    recorded_run_free(&run);
    model_clear(&model);
}

// A jump of the thrust makes m' l a pass the breaking force without a crossing.
static void test_breaks_at_once(void **state)
{
    (void)state;
    ld_model model =
        slider("[[0 s, 300 N], [20 ms, 300 N], [20 ms, 1800 N], [1 s, 1800 N]]",
               "mass_per_length: 30 g/m, stiffness: 20 kN, breaking_force: 3 N", "tip");
    ld_rocket_summary rocket = fly_model(&model);
    CHECK_NEAR("breaks at the jump [s]", rocket.line.t_break, 0.02, 1e-14);
    double u = 300 * 0.02 / (M + 0.03 * (l_0 + 0.01)), s = 0.5 * u * 0.02;
    CHECK_NEAR("exit speed [m/s]", rocket.exit_speed,
               sqrt(u * u + 2 * 1800 * (length - start - s) / M), 5e-6);
    model_clear(&model);
}

// ---- slack

// After its motor has burnt out it coasts with v_0 until the slack is drawn; with Z = sqrt(EA m'),
// L the length out, it then goes by M v' = -Z v until (M + m' l) v = M v_0, which stays.
static void test_slack(void **state)
{
    (void)state;
    const double m = 0.03, EA = 20e3, Z = sqrt(EA * m), slack = 0.6, L = l_0 + slack;
    const double v_0 = 30 / M, t_taut = 0.01 + (slack - 0.5 * v_0 * 0.01) / v_0;
    ld_model model = slider("[[0 s, 3 kN], [10 ms, 3 kN], [10 ms, 0 N]]",
                            "mass_per_length: 30 g/m, stiffness: 20 kN, slack: 0.6 m", "tip");
    recorded_run run;
    recorded_run_make(&run, &model);
    const ld_rocket_summary *rocket = &run.summary.rocket[0];
    double v_1 = v_0, off = 0, loose = 0;
    for (int i = 0; i < 50; i++) // M v_0 - Z x = M v_1 where x = (L + x) v_1 m'/Z
        v_1 = v_0 - Z / M * L * v_1 / (Z / m - v_1);
    double t_wave = M / Z * log(v_0 / v_1);
    size_t last = run.rows - 1, jerked = 0;
    for (size_t i = 0; i < run.rows; i++) {
        double t = recorded_value(&run, i, recorded_column(&run, "t"));
        double pull = recorded_value(&run, i, recorded_column(&run, "line.tension"));
        if (t < t_taut - 1e-8) {
            loose = fmax(loose, pull);
        } else if (t > t_taut + 1e-8 && t < t_taut + t_wave - 1e-8) {
            off = fmax(off, fabs(pull - Z * v_0 * exp(-Z / M * (t - t_taut))));
            jerked++;
        }
    }
    printf("  jerk of %.2f N for %.4f ms, %zu rows\n", Z * v_0, 1e3 * t_wave, jerked);
    assert_true(jerked > 5);
    CHECK_BELOW("pull of what lies slack [N]", loose, 0);
    CHECK_BELOW("pull while the wave runs, relative", off / (Z * v_0), 5e-14);
    double v_exit = M * v_0 / (M + m * (l_0 + length - start));
    CHECK_NEAR("exit speed [m/s]", rocket->exit_speed, v_exit, 2e-14);
    double work = recorded_value(&run, last, recorded_column(&run, "work.line"));
    CHECK_NEAR("work of the line, of the closed form",
               work / (0.5 * M * (v_exit * v_exit - v_0 * v_0)), 1, 1e-13);
    CHECK_NEAR("out at the end [m]",
               recorded_value(&run, last, recorded_column(&run, "line.paid_out")),
               l_0 + length - start, 1e-13);
    CHECK_NEAR("out at the start [m]",
               recorded_value(&run, 0, recorded_column(&run, "line.paid_out")), L, 1e-13);
    assert_true(isnan(rocket->line.t_break));
    recorded_run_free(&run);
    model_clear(&model);

    model = slider("[[0 s, 3 kN], [10 ms, 3 kN], [10 ms, 0 N]]",
                   "mass_per_length: 30 g/m, stiffness: 20 kN, slack: 0.6 m, breaking_force: 100 N",
                   "tip");
    ld_rocket_summary broken = fly_model(&model);
    CHECK_NEAR("breaks as it jerks [s]", broken.line.t_break, t_taut, 1e-14);
    CHECK_NEAR("goes on as before [m/s]", broken.exit_speed, v_0, 2e-14);
    model_clear(&model);
}

// A motor that burns makes Z u grow while the wave runs: u' = (F - Z u)/M.
static void test_breaks_in_the_wave(void **state)
{
    (void)state;
    const double m = 0.03, Z = sqrt(2e3 * m), F = 900, slack = 0.6, breaking = 105;
    ld_model model =
        slider("[[0 s, 900 N], [1 s, 900 N]]",
               "mass_per_length: 30 g/m, stiffness: 2 kN, slack: 0.6 m, breaking_force: "
               "105 N",
               "tip");
    ld_rocket_summary rocket = fly_model(&model);
    double u = sqrt(2 * F * slack / M), t = u * M / F;
    double wait = M / Z * log((F / Z - u) / (F / Z - breaking / Z));
    CHECK_WITHIN("of the time of the wave", wait / ((l_0 + slack) / sqrt(2e3 / m)), 0.1, 0.9);
    CHECK_NEAR("breaks [s]", rocket.line.t_break, t + wait, 1e-14);
    model_clear(&model);
}

// What is slack at the exit is refused.
static void test_slack_at_the_exit(void **state)
{
    (void)state;
    ld_model model = slider("[[0 s, 3 kN], [1 s, 3 kN]]",
                            "mass_per_length: 30 g/m, stiffness: 20 kN, slack: 4 m", "1 s");
    ld_simulation *simulation;
    ld_summary summary;
    ld_error error;
    assert_int_equal(ld_simulation_create(&model, &simulation, &error), LD_OK);
    assert_int_equal(ld_simulation_run(simulation, NULL, &summary, &error), LD_ERR_LAUNCH);
    assert_non_null(strstr(error.text, "rocket.line.slack"));
    ld_simulation_free(simulation);
    model_clear(&model);
}

// ---- a container that moves

static const double v_line[3] = {48, 14, -9};

static line_bridle winding(double t, v3 with, v3 gaining)
{
    v3 r = {2 + 60 * t, 8 * t * t, 3 * sin(3 * t)}, v = {60, 16 * t, 9 * cos(3 * t)};
    v3 a = {0, 16, -27 * sin(3 * t)};
    return (line_bridle){v3_axpy(v3_axpy(r, t, with), 0.5 * t * t, gaining),
                         v3_axpy(v3_add(v, with), t, gaining), v3_add(a, gaining)};
}

static line_bridle straight(double t, v3 with, v3 gaining)
{
    v3 e = v3_scale(1 / v3_norm(v3_from(v_line)), v3_from(v_line));
    v3 r = v3_scale(3 + 50 * t, e), v = v3_scale(50, e);
    return (line_bridle){v3_axpy(v3_axpy(r, t, with), 0.5 * t * t, gaining),
                         v3_axpy(v3_add(v, with), t, gaining), gaining};
}

typedef struct carrier {
    v3 v, a;
} carrier;

static line_bridle carried(const void *self, double t)
{
    const carrier *by = self;
    return (line_bridle){v3_axpy(v3_scale(t, by->v), 0.5 * t * t, by->a), v3_axpy(by->v, t, by->a),
                         by->a};
}

// What a container that moves sees is what one sees that stands (in a field of gravity against its
// acceleration, along the line).
static void test_carried(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        const ld_line given = {.present = true,
                               .length = 130,
                               .mass_per_length = 0.05,
                               .diameter = 0.01,
                               .stiffness = 2e4,
                               .damping = 0.1,
                               .breaking_force = NAN,
                               .tension = 5,
                               .segments = 40};
        line_bridle (*at)(double, v3, v3) = i ? straight : winding;
        const carrier by = {{-7, 3, 5}, i ? v3_scale(0.3, v3_from(v_line)) : still};
        const line_setting stands = {
            .given = &given, .gravity = v3_scale(-1, by.a), .ground = -INFINITY};
        const line_setting goes = {.given = &given,
                                   .container = {9, 9, 9},
                                   .ground = -INFINITY,
                                   .carried = carried,
                                   .carrier = &by};
        line_bridle one = at(0, still, still), other = at(0, by.v, by.a);
        flight_line *held = line_create(&stands, 0, &one), *taken = line_create(&goes, 0, &other);
        double off = 0, greatest = 0, apart = 0;
        // all is out after some 2 s, 2.6 s; then half of the last segment hangs on the container
        while (held->t < 2.5) {
            double t = held->t, to = t + line_step(held);
            one = at(t, still, still);
            other = at(t, by.v, by.a);
            line_advance(held, to, &one);
            line_advance(taken, to, &other);
            // while its first points arise it is slack at times: then half of its weight counts
            if (!i || t > 1)
                off = fmax(off, v3_norm(v3_sub(held->mean, taken->mean)));
            greatest = fmax(greatest, v3_norm(held->mean));
            v3 place = line_place(held, to, at(to, still, still).r, 0.3);
            v3 there = line_place(taken, to, at(to, by.v, by.a).r, 0.3);
            there = v3_sub(there, carried(&by, to).r);
            apart = fmax(apart, v3_norm(v3_sub(place, there)));
        }
        if (!i)
            CHECK_NEAR("all is out as early [s]", taken->t_ended, held->t_ended, 1e-9);
        CHECK_BELOW("force, of the greatest", off / greatest, i ? 1.5e-6 : 2e-13);
        CHECK_BELOW("place on the line [m]", apart, i ? 2.5e-6 : 4e-13);
        line_hold_still(taken);
        v3 rests = taken->hold.r;
        other = at(taken->t, by.v, by.a);
        line_advance(taken, taken->t + 1e-3, &other);
        CHECK_BELOW("held still [m]", v3_norm(v3_sub(taken->hold.r, rests)), 0);
        line_free(held);
        line_free(taken);
    }
}

static ld_rocket_summary thrown_from(const char *base, const char *around, const char *end)
{
    char text[2048];
    snprintf(text, sizeof text,
             "launchdyn: 1\nenvironment: {%s}\n"
             "base: {%s, elevation: 35 deg, azimuth: 25 deg}\n"
             "tubes:\n  length: 1.5 m\n  sections: [{from: 0 m, inner_radius: 40 mm, outer_radius: "
             "45 mm}]\n"
             "  material: {youngs_modulus: 70 GPa, poisson_ratio: 0.33, density: 2700 kg/m3}\n"
             "  modes: {bending: 2, torsion: 1, damping: 1 %%}\n  slot: none\n"
             "  supports:\n    - {at: 0.1 m, clamped: all}\n"
             "rocket:\n  start_at: 0.1 m\n  mass: 6 kg\n  center: 0.16 0 0 m\n"
             "  inertia: 0.003 0.03 0.03 kg.m2\n"
             "  adaptors: [{name: rear, at: 0 m, clearance: 0.2 mm}, {name: front, at: 0.3 m, "
             "clearance: "
             "0.2 mm}]\n"
             "  contact: {stiffness: 1e7 N/m, restitution: 0.5, friction: 0}\n  lock: none\n"
             "  motor: {thrust: [[0 s, 6 kN], [60 ms, 6 kN], [60 ms, 0 N]]}\n"
             "  aerodynamics: {model: body, area: 0.005 m2, drag: 0.4}\n"
             "  line: {length: 300 m, mass_per_length: 20 g/m, diameter: 4 mm, stiffness: 20 kN, "
             "tension: 3 N, "
             "container: -0.4 -0.1 0.2 m, container_on: launcher}\n"
             "run: {end: %s, tolerance: 1e-9, flight_tolerance: 1e-9}\n",
             around, base, end);
    ld_model model = read_text(text);
    ld_rocket_summary rocket = fly_model(&model);
    model_clear(&model);
    return rocket;
}

// A deck that moves steadily, in a wind as fast, throws as one that stands in still air; a
// container that stays on the ground would not.
static void test_steady_deck(void **state)
{
    (void)state;
    ld_rocket_summary stands = thrown_from("kind: fixed", "ground: none", "2.5 s");
    ld_rocket_summary goes =
        thrown_from("kind: prescribed, velocity: 6 0 0 m/s",
                    "ground: none, wind: {speed: 6 m/s, heading: 0 deg}", "2.5 s");
    v3 place = v3_sub(place_of(&goes, 0), place_of(&stands, 0));
    v3 end = v3_sub(place_of(&goes, LD_LINE_PLACES - 1), place_of(&stands, LD_LINE_PLACES - 1));
    printf("  %.4f m out, greatest pull %.4f N\n", goes.line.paid_out, goes.line.greatest_tension);
    CHECK_NEAR("length out [m]", goes.line.paid_out, stands.line.paid_out, 1e-6);
    CHECK_NEAR("greatest pull [N]", goes.line.greatest_tension, stands.line.greatest_tension, 6e-7);
    CHECK_NEAR("reach [m]", goes.line.reach, stands.line.reach, 1e-6);
    CHECK_NEAR("container, with the deck [m]", place.x, 6 * 2.5, 1e-12);
    CHECK_BELOW("end of the line, with the deck [m]", v3_norm(v3_sub(end, place)), 1e-6);
}

// A deck that heaves and rolls: where its container is at the end of the flight. By a table of its
// motion that ends before, it goes on as fast as there.
static void test_heaving_deck(void **state)
{
    (void)state;
    const double degree = acos(-1) / 180, roll = 7 * degree * sin(2 * acos(-1) * 0.17 * 2.5);
    ld_rocket_summary heaves = thrown_from(
        "kind: prescribed, motion: {heave: [{amplitude: 0.8 m, frequency: 0.3 Hz}], roll: "
        "[{amplitude: 7 deg, frequency: 0.17 Hz}]}",
        "ground: none", "2.5 s");
    m3 A =
        m3_mul(m3_rotation_x(roll), m3_mul(m3_rotation_y(25 * degree), m3_rotation_z(35 * degree)));
    v3 due = m3_apply(A, v3_make(-0.4, -0.1, 0.2));
    due.y += 0.8 * sin(2 * acos(-1) * 0.3 * 2.5);
    CHECK_BELOW("container on the deck [m]", v3_norm(v3_sub(place_of(&heaves, 0), due)), 1e-12);
    ld_rocket_summary measured =
        thrown_from("kind: prescribed, motion: {table: [[0 s, 0 m, 0 m, 0 m, 0 deg, 0 deg, 0 deg], "
                    "[0.5 s, 0.1 m, 0 m, 1 m, 0 deg, 0 deg, 0 deg], [1 s, 0.4 m, 0 m, 2 m, 0 deg, "
                    "0 deg, 0 deg], [1.5 s, 0.9 m, 0 m, 3 m, 0 deg, 0 deg, 0 deg]]}",
                    "ground: -5 m", "landing");
    m3 level = m3_mul(m3_rotation_y(25 * degree), m3_rotation_z(35 * degree));
    v3 rest = m3_apply(level, v3_make(-0.4, -0.1, 0.2));
    v3 place = v3_sub(place_of(&measured, 0), rest);
    double t = measured.final.t;
    CHECK_WITHIN("lands [s]", t, 2, 20);
    CHECK_NEAR("beyond the table, z [m]", place.z, 2 * t, 0.01); // the line is up to 5 ms ahead
    t = 0.5 * place.z;
    // x = 0.4 t^2 up to 1.5 s, by the spline, then as fast as there
    CHECK_NEAR("beyond the table, x [m]", place.x, 0.9 + 1.2 * (t - 1.5), 1e-13);
}

// A vehicle that marches is not known after the exit: the container goes on as then.
static void test_marching(void **state)
{
    (void)state;
    v3 place[2];
    double t[2];
    for (int i = 0; i < 2; i++) {
        ld_model model;
        reference_vehicle(&model, 5);
        model.run.end = LD_END_TIME;
        model.run.end_time = i ? 1.2 : 0.5;
        model.rocket.line = (ld_line){.present = true,
                                      .length = 300,
                                      .mass_per_length = 0.02,
                                      .diameter = 0.004,
                                      .stiffness = 2e4,
                                      .breaking_force = NAN,
                                      .container_on = LD_LINE_ON_LAUNCHER,
                                      .container = {-0.4, 0.2, 0},
                                      .segments = 20};
        ld_rocket_summary rocket = fly_model(&model);
        place[i] = place_of(&rocket, 0);
        t[i] = rocket.final.t;
        reference_model_free(&model);
    }
    v3 v = v3_scale(1 / (t[1] - t[0]), v3_sub(place[1], place[0]));
    printf("  from %.4f s to %.4f s by %.4f, %.4f, %.4f m/s\n", t[0], t[1], v.x, v.y, v.z);
    CHECK_NEAR("of the container [m/s]", v.x, 5, 0.012);
    CHECK_BELOW("aside", hypot(v.y, v.z), 0.008);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_breaks),
        cmocka_unit_test(test_breaks_at_once),
        cmocka_unit_test(test_slack),
        cmocka_unit_test(test_breaks_in_the_wave),
        cmocka_unit_test(test_slack_at_the_exit),
        cmocka_unit_test(test_carried),
        cmocka_unit_test(test_steady_deck),
        cmocka_unit_test(test_heaving_deck),
        cmocka_unit_test(test_marching),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
