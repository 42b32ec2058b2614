// Simulated sensors against closed forms: a turning body with a lever arm, rest on a rail, free
// fall, the columns of a flight against differences of its velocities.
#include "support/check.h"

#include <stdlib.h>

#include "compare/sensor_reading.h"
#include "launchdyn/scenario.h"
#include "launchdyn/summary.h"
#include "math/vectors/mat3.h"
#include "math/vectors/quaternion.h"

static const double g = 9.80665;

// ---- made columns

enum { ROWS = 101, COLUMNS = 11 };
static const char *const names[COLUMNS] = {
    "t",         "rocket.fx",     "rocket.fy",     "rocket.fz",     "rocket.wx", "rocket.wy",
    "rocket.wz", "rocket.wx_dot", "rocket.wy_dot", "rocket.wz_dot", "center.y"};

typedef struct made_run {
    double value[COLUMNS][ROWS];
    const char *name[COLUMNS], *unit[COLUMNS];
    const double *column[COLUMNS];
    run_series series;
} made_run;

static made_run made;

// `fill` gives the row of time t, without t.
static const run_series *make_run(void (*fill)(double t, double row[COLUMNS - 1]))
{
    for (int i = 0; i < ROWS; i++) {
        double row[COLUMNS - 1] = {0}, t = 0.01 * i - 0.1;
        fill(t, row);
        made.value[0][i] = t;
        for (int k = 1; k < COLUMNS; k++)
            made.value[k][i] = row[k - 1];
    }
    for (int k = 0; k < COLUMNS; k++) {
        made.name[k] = names[k];
        made.unit[k] = "1";
        made.column[k] = made.value[k];
    }
    made.series = (run_series){.launch = {COLUMNS, ROWS, made.name, made.unit, made.column},
                               .t_first = -INFINITY,
                               .t_last = INFINITY};
    return &made.series;
}

static sensor plain(sensor_kind kind)
{
    return (sensor){.kind = kind,
                    .column = (char *)"x",
                    .axis = {1, 0, 0},
                    .cutoff = NAN,
                    .order = 2,
                    .scale = 1,
                    .range = {NAN, NAN},
                    .rest = {NAN, NAN}};
}

static void read_at(const sensor *of, const run_series *run, size_t n, const double *t,
                    double *reading)
{
    run_signal signal;
    ld_error error;
    assert_int_equal(sensor_signal(of, run, &signal, &error), LD_OK);
    assert_int_equal(sensor_read(of, &signal, n, t, reading, &error), LD_OK);
    run_signal_free(&signal);
}

// A body that spins up about its x axis, w = 3 + 20 t, its rear end at rest in free fall: at radius
// r from the axis -w^2 r inwards and w_dot r across; along x nothing.
static void spin_up(double t, double row[COLUMNS - 1])
{
    row[3] = 3 + 20 * t;
    row[6] = 20;
}

static void test_lever_arm(void **state)
{
    (void)state;
    const run_series *run = make_run(spin_up);
    const double t[] = {0, 0.25, 0.505, 0.9}, r = 0.13;
    double y[4], z[4], x[4], rate[4], worst[4] = {0};
    sensor of = plain(SENSOR_ACCELEROMETER), gyro = plain(SENSOR_GYRO);
    of.at[0] = 1.7;
    of.at[1] = r;
    read_at(&of, run, 4, t, x);
    of.axis[0] = 0;
    of.axis[1] = 1;
    read_at(&of, run, 4, t, y);
    of.axis[1] = 0;
    of.axis[2] = 1;
    read_at(&of, run, 4, t, z);
    read_at(&gyro, run, 4, t, rate);
    for (int i = 0; i < 4; i++) {
        double w = 3 + 20 * t[i];
        worst[0] = fmax(worst[0], fabs(x[i]));
        worst[1] = fmax(worst[1], fabs(y[i] + w * w * r));
        worst[2] = fmax(worst[2], fabs(z[i] - 20 * r));
        worst[3] = fmax(worst[3], fabs(rate[i] - w));
    }
    CHECK_BELOW("along the axis of spin [m/s2]", worst[0], 1e-15);
    CHECK_BELOW("centripetal, between rows too [m/s2]", worst[1], 2e-7);
    CHECK_BELOW("tangential [m/s2]", worst[2], 1e-14);
    CHECK_BELOW("rate [rad/s]", worst[3], 1e-14);
}

// A body that turns about z at w and whose rear end moves in I: every place reads f of the rear end
// and -w^2 r along r.
static void pitch_over(double t, double row[COLUMNS - 1])
{
    (void)t;
    row[0] = 30;
    row[1] = 4;
    row[5] = 2;
}

static void test_reading(void **state)
{
    (void)state;
    const run_series *run = make_run(pitch_over);
    const double t[] = {0.2};
    double reading[1];
    sensor of = plain(SENSOR_ACCELEROMETER);
    of.at[0] = 0.8;
    read_at(&of, run, 1, t, reading);
    CHECK_NEAR("f - w^2 r [m/s2]", reading[0], 30 - 4 * 0.8, 1e-14);
    of.scale = 1.02;
    of.bias = -0.5;
    read_at(&of, run, 1, t, reading);
    CHECK_NEAR("scale and bias [m/s2]", reading[0], 1.02 * (30 - 4 * 0.8) - 0.5, 1e-14);
    of.range[0] = -16;
    of.range[1] = 16;
    read_at(&of, run, 1, t, reading);
    CHECK_NEAR("at the end of the range [m/s2]", reading[0], 16, 0);
}

// A jump at 0 through a delay and a low pass of order 1; the signal is linear between its rows.
static void jump(double t, double row[COLUMNS - 1])
{
    row[3] = t < 0.395 ? 0 : 1;
}

static void test_low_pass(void **state)
{
    (void)state;
    const run_series *run = make_run(jump);
    const double t[] = {0.3, 0.42, 0.45, 0.7}, w = 2 * acos(-1) * 5, rise = 0.01, at = 0.39;
    double reading[4], worst = 0;
    sensor of = plain(SENSOR_GYRO);
    of.cutoff = 5;
    of.order = 1;
    of.delay = 0.01;
    read_at(&of, run, 4, t, reading);
    for (int i = 0; i < 4; i++) {
        // a ramp over 10 ms: y = (s - (1 - exp(-w s))/w)/rise, less the same after its end
        double s = fmax(t[i] - 0.01 - at, 0), later = fmax(s - rise, 0);
        double expected = (s - (1 - exp(-w * s)) / w - later + (1 - exp(-w * later)) / w) / rise;
        worst = fmax(worst, fabs(reading[i] - expected));
    }
    CHECK_BELOW("a ramp through order 1, 10 ms late", worst, 1e-13);
}

// ---- runs

typedef struct kept_run {
    ld_model *model;
    ld_simulation *simulation;
    ld_summary *summary;
    ld_history *history;
    run_series series;
} kept_run;

static void keep_run(kept_run *run, const char *text)
{
    ld_messages messages;
    ld_error error;
    ld_status status = ld_scenario_read_text(text, strlen(text), "test", LD_SOURCE_DIR "/examples",
                                             NULL, 0, &run->model, &messages);
    if (status)
        ld_messages_print(&messages, stdout);
    assert_int_equal(status, LD_OK);
    run->summary = ld_summary_new();
    run->history = ld_history_new(NULL);
    assert_int_equal(ld_simulation_create(run->model, &run->simulation, &error), LD_OK);
    const ld_run_options options = {.sink = ld_history_sink(run->history)};
    assert_int_equal(ld_simulation_run(run->simulation, &options, run->summary, &error), LD_OK);
    assert_int_equal(run_series_of_run(&run->series, run->history, run->summary, 1, &error), LD_OK);
}

static void free_run(kept_run *run)
{
    run_series_free(&run->series);
    ld_summary_free(run->summary);
    ld_history_free(run->history);
    ld_simulation_free(run->simulation);
    ld_model_free(run->model);
}

// On the breech of a tube at 20 deg of elevation: gravity along its axis and across it, wherever
// the sensor is.
static void test_rest(void **state)
{
    (void)state;
    kept_run run;
    keep_run(&run, "include: fixed.yaml\n"
                   "base: {elevation: 20 deg}\n"
                   "run: {lead_in: 5 ms}\n");
    sensor of = plain(SENSOR_ACCELEROMETER);
    const double t[] = {-0.002};
    double x[1], y[1], z[1], pitch = 20 * acos(-1) / 180;
    of.at[0] = 0.7;
    of.at[1] = -0.05;
    read_at(&of, &run.series, 1, t, x);
    of.axis[0] = 0;
    of.axis[1] = 1;
    read_at(&of, &run.series, 1, t, y);
    of.axis[1] = 0;
    of.axis[2] = 1;
    read_at(&of, &run.series, 1, t, z);
    // the tube sags a little, and a twisted rocket may have rolled
    CHECK_NEAR("along the axis, at rest [m/s2]", x[0], g * sin(pitch), 1e-3);
    CHECK_NEAR("across it [m/s2]", hypot(y[0], z[0]), g * cos(pitch), 4e-4);
    CHECK_NEAR("in all [m/s2]", sqrt(x[0] * x[0] + y[0] * y[0] + z[0] * z[0]), g, 1e-11);
    free_run(&run);
}

static const char flight_text[] =
    "launchdyn: 1\n"
    "environment: {atmosphere: none, ground: 0 m}\n"
    "rocket: {mass: 10 kg, center: 0.4 0.02 -0.01 m, inertia: 0.1 1 1.05 kg.m2,\n"
    "  empty: {mass: 8 kg, center: 0.55 0.02 -0.01 m, inertia: 0.08 0.8 0.85 kg.m2},\n"
    "  motor: {at: -0.5 0.01 0 m, thrust: [[0 s, 300 N], [0.5 s, 500 N], [0.5 s, 0 N]]}}\n"
    "flight: {ignition: 0 s, position: 0 500 0 m, speed: 150 m/s,\n"
    "  attitude: {pitch: 40 deg, yaw: 10 deg}, rate: 12 1 -2 rad/s}\n"
    "run: {end: 2 s, output_step: {flight: 0.5 ms}, flight_tolerance: 1e-12}\n";

static size_t take(const run_series *run, const char *const *columns, size_t width,
                   run_signal *signal)
{
    ld_error error;
    assert_int_equal(run_series_take(run, columns, width, signal, &error), LD_OK);
    return signal->count;
}

// In free fall every sensor at the mass centre reads nothing, one beside it the centripetal terms.
// With thrust the specific force at the rear adaptor is its acceleration, by differences of its
// velocity, less gravity.
static void test_flight(void **state)
{
    static const char *const columns[] = {
        "rocket.vx",     "rocket.vy", "rocket.vz", "rocket.q0", "rocket.q1",     "rocket.q2",
        "rocket.q3",     "rocket.fx", "rocket.fy", "rocket.fz", "rocket.wx_dot", "rocket.wy_dot",
        "rocket.wz_dot", "rocket.wx", "rocket.wy", "rocket.wz"};
    (void)state;
    kept_run run;
    run_signal signal;
    keep_run(&run, flight_text);
    size_t count = take(&run.series, columns, 16, &signal);
    double worst = 0, turned = 0, falling = 0;
    for (size_t i = 1; i + 1 < count; i++) {
        const double *row = signal.value + 16 * i, *before = row - 16, *after = row + 16;
        double dt = signal.t[i + 1] - signal.t[i - 1];
        double uneven = fabs(signal.t[i + 1] - 2 * signal.t[i] + signal.t[i - 1]);
        if (uneven > 1e-9 || fabs(signal.t[i] - 0.5) < 2e-3 || signal.t[i] < 2e-3)
            continue;
        v3 a = v3_scale(1 / dt, v3_sub(v3_from(after), v3_from(before)));
        a.y += g;
        m3 A = q_matrix((quat){row[3], row[4], row[5], row[6]});
        worst = fmax(worst, v3_norm(v3_sub(m3_apply_transposed(A, a), v3_from(row + 7))));
        v3 w_dot = v3_scale(1 / dt, v3_sub(v3_from(after + 13), v3_from(before + 13)));
        turned = fmax(turned, v3_norm(v3_sub(w_dot, v3_from(row + 10))));
        if (signal.t[i] > 0.5) {
            v3 c = {0.55, 0.02, -0.01}, w = v3_from(row + 13);
            v3 felt = v3_add(v3_from(row + 7),
                             v3_add(v3_cross(v3_from(row + 10), c), v3_cross(w, v3_cross(w, c))));
            falling = fmax(falling, v3_norm(felt));
        }
    }
    CHECK_BELOW("specific force against differences [m/s2]", worst, 2e-4);
    CHECK_BELOW("angular acceleration against differences [rad/s2]", turned, 4e-4);
    CHECK_BELOW("mass centre in free fall [m/s2]", falling, 1e-10);
    run_signal_free(&signal);
    free_run(&run);
}

// Heights of the altimeter go on from launch to flight, from 0 at the ignition.
static void test_altimeter(void **state)
{
    (void)state;
    kept_run run;
    keep_run(&run, "include: student-rocket/student-rocket.yaml\nrun: {end: apogee}\n");
    sensor of = plain(SENSOR_ALTIMETER);
    double exit = run.series.instant[SERIES_REAR];
    const double t[] = {0, exit - 1e-9, exit + 1e-9, 7};
    double height[4], altitude, start;
    read_at(&of, &run.series, 4, t, height);
    static const char *const columns[] = {"altitude", "center.y"};
    run_signal flight, launch;
    take(&run.series, columns, 1, &flight);
    take(&run.series, columns + 1, 1, &launch);
    start = launch.value[0];
    sensor direct = plain(SENSOR_COLUMN);
    snprintf(direct.of, sizeof direct.of, "altitude");
    read_at(&direct, &run.series, 1, &t[3], &altitude);
    CHECK_BELOW("height at the ignition [m]", height[0], 1e-9);
    CHECK_BELOW("jump at the exit [m]", height[2] - height[1], 1e-7);
    // the site's altitude is that of I's origin
    CHECK_NEAR("height after 7 s [m]", height[3], altitude - 206 - start, 1e-8);
    run_signal_free(&flight);
    run_signal_free(&launch);
    free_run(&run);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lever_arm), cmocka_unit_test(test_reading),
        cmocka_unit_test(test_low_pass),  cmocka_unit_test(test_rest),
        cmocka_unit_test(test_flight),    cmocka_unit_test(test_altimeter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
