// Simulated sensors against closed forms: a turning body with a lever arm, rest on a rail, free
// fall, the columns of a flight against differences of its velocities; on a launcher: a body that
// turns about a skew axis, one that is shaken, a tube that bends under its weight.
#include "support/check.h"

#include <stdlib.h>

#include "compare/sensor_reading.h"
#include "launchdyn/scenario.h"
#include "launchdyn/summary.h"
#include "math/vectors/mat3.h"
#include "math/vectors/quaternion.h"

static const double g = 9.80665;

// ---- made columns

enum { ROWS = 101, FINE_ROWS = 1001, COLUMNS = 20 };
static const char *const names[COLUMNS] = {
    "t",         "rocket.fx",  "rocket.fy",     "rocket.fz",     "rocket.wx",
    "rocket.wy", "rocket.wz",  "rocket.wx_dot", "rocket.wy_dot", "rocket.wz_dot",
    "center.y",  "body.b.yaw", "body.b.pitch",  "body.b.roll",   "body.b.vx",
    "body.b.vy", "body.b.vz",  "body.b.wx",     "body.b.wy",     "body.b.wz"};
enum { OF_BODY = 10 }; // in a row without t

typedef struct made_run {
    double value[COLUMNS][FINE_ROWS];
    const char *name[COLUMNS], *unit[COLUMNS];
    const double *column[COLUMNS];
    run_series series;
} made_run;

static made_run made;

// `fill` gives the row of time t, without t; from -0.1 s to 0.9 s.
static const run_series *make_rows(int rows, void (*fill)(double t, double row[COLUMNS - 1]))
{
    for (int i = 0; i < rows; i++) {
        double row[COLUMNS - 1] = {0}, t = (double)i / (rows - 1) - 0.1;
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
    made.series = (run_series){.launch = {COLUMNS, (size_t)rows, made.name, made.unit, made.column},
                               .t_first = -INFINITY,
                               .t_last = INFINITY,
                               .gravity = g};
    return &made.series;
}

static const run_series *make_run(void (*fill)(double t, double row[COLUMNS - 1]))
{
    return make_rows(ROWS, fill);
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

// ---- on a launcher

// A body that turns by 0.4 + 3 t + 10 t^2 about an axis that is none of its own or of I's, through
// a point that is not its origin.
static const v3 skew = {0.36, 0.48, 0.8};

static m3 turned_by(double angle)
{
    m3 K = m3_skew(skew);
    return m3_add(m3_identity(),
                  m3_add(m3_scale(sin(angle), K), m3_scale(1 - cos(angle), m3_mul(K, K))));
}

static m3 skew_frame(double t)
{
    return m3_mul(turned_by(0.4 + 3 * t + 10 * t * t), m3_rotation_x(0.7));
}

static const v3 arm = {0.9, -0.4, 0.3}; // from the point on the axis to the origin, at angle 0

static void turn_skew(double t, double row[COLUMNS - 1])
{
    m3 A = skew_frame(t);
    v3 w = v3_scale(3 + 20 * t, skew);
    v3 r = m3_apply(turned_by(0.4 + 3 * t + 10 * t * t), arm);
    m3_yaw_pitch_roll(&A, row + OF_BODY);
    v3_store(row + OF_BODY + 3, v3_cross(w, r));
    v3_store(row + OF_BODY + 6, m3_apply_transposed(A, w));
}

// Largest error of an accelerometer off the origin against its centripetal and tangential
// acceleration and gravity.
static double skew_error(int rows)
{
    const run_series *run = make_rows(rows, turn_skew);
    const double t[] = {0.1, 0.2503, 0.4, 0.6997, 0.85};
    double reading[5], worst = 0;
    sensor of = plain(SENSOR_ACCELEROMETER);
    of.on = (char *)"body.b";
    v3_store(of.at, v3_make(-0.2, 0.5, 0.7));
    v3_store(of.axis, v3_make(0.6, -0.64, 0.48));
    read_at(&of, run, 5, t, reading);
    for (int i = 0; i < 5; i++) {
        m3 A = skew_frame(t[i]);
        double w = 3 + 20 * t[i];
        v3 p = v3_add(m3_apply(turned_by(0.4 + 3 * t[i] + 10 * t[i] * t[i]), arm),
                      m3_apply(A, v3_from(of.at)));
        v3 across = v3_sub(p, v3_scale(v3_dot(p, skew), skew));
        v3 a = v3_axpy(v3_scale(20, v3_cross(skew, across)), -w * w, across);
        a.y += g;
        worst = fmax(worst, fabs(v3_dot(m3_apply(A, v3_from(of.axis)), a) - reading[i]));
    }
    return worst;
}

static void test_skew_axis(void **state)
{
    (void)state;
    double coarse = skew_error(501), fine = skew_error(FINE_ROWS), t = 0.5, rate;
    CHECK_BELOW("about a skew axis, up to 370 m/s2, rows of 1 ms [m/s2]", fine, 3e-2);
    CHECK_WITHIN("of rows twice as far apart, over that", coarse / fine, 3.5, 4.5);
    sensor of = plain(SENSOR_GYRO);
    of.on = (char *)"body.b";
    v3_store(of.axis, v3_make(0.6, -0.64, 0.48));
    read_at(&of, &made.series, 1, &t, &rate);
    double expected = 13 * v3_dot(m3_apply(skew_frame(t), v3_from(of.axis)), skew);
    CHECK_NEAR("rate about a skew axis [rad/s]", rate, expected, 1e-5);
}

// A body that falls freely, is stopped within no time at 0.4 s and then stands: the jump between
// two rows at one time is no acceleration, nor is the rounding between rows that are nearly one.
static void test_jump(void **state)
{
    (void)state;
    static double t[] = {0, 0.1, 0.2, 0.3, 0.4, 0.4, 0.5, 0.6, 0.6 + 1e-12, 0.7};
    enum { JUMP_ROWS = sizeof t / sizeof *t };
    const run_series *run = make_rows(JUMP_ROWS, turn_skew);
    memcpy(made.value[0], t, sizeof t);
    for (int i = 0; i < JUMP_ROWS; i++) {
        for (int k = 1; k < COLUMNS; k++)
            made.value[k][i] = 0;
        made.value[OF_BODY + 5][i] = i < 5 ? -g * t[i] : 1e-9 * (i == 8);
    }
    sensor of = plain(SENSOR_ACCELEROMETER);
    const double at[] = {0.2, 0.34, 0.46, 0.6};
    double reading[4];
    of.on = (char *)"body.b";
    of.axis[0] = 0;
    of.axis[1] = 1;
    read_at(&of, run, 4, at, reading);
    CHECK_BELOW("falling [m/s2]", fmax(fabs(reading[0]), fabs(reading[1])), 1e-13);
    CHECK_BELOW("standing [m/s2]", fmax(fabs(reading[2] - g), fabs(reading[3] - g)), 1e-7);
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
    run->series.gravity = g;
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

// A tube that stands at 20 deg on a base that leans by 40 deg: beyond the supports it is a
// cantilever under its own weight, of mu [kg/m] with g in the section's axes. At (y, z) of the
// section
//   strain = mu l (g_x/(E A) - (y g_y + z g_z) l/(2 E I))
static void test_strain(void **state)
{
    (void)state;
    kept_run run;
    keep_run(&run, "include: fixed.yaml\n"
                   "base: {kind: prescribed, elevation: 20 deg, motion: {\n"
                   "  roll: [{amplitude: 40 deg, frequency: 1e-4 Hz, phase: 90 deg}]}}\n"
                   "tubes: {loads: [{at: 2.3 m}]}\n"
                   "run: {lead_in: 5 ms}\n");
    const double R = 0.085, r = 0.0825, pi = acos(-1), E = 2.1e11, l = 0.7, t[] = {-0.002};
    const double A = pi * (R * R - r * r), I = pi / 4 * (R * R * R * R - r * r * r * r);
    m3 stands = m3_mul(m3_rotation_x(2 * pi / 9), m3_rotation_z(pi / 9));
    v3 weight = m3_apply_transposed(stands, v3_make(0, -7850 * A * g, 0));
    double along, above, beside, reading[3];
    sensor of = plain(SENSOR_STRAIN), level = plain(SENSOR_ACCELEROMETER);
    of.on = level.on = (char *)"station.1";
    read_at(&of, &run.series, 1, t, &along);
    CHECK_NEAR("strain of the axis", along, weight.x * l / (E * A), 4e-11);
    of.at[1] = 0.06;
    read_at(&of, &run.series, 1, t, &above);
    of.at[2] = 0.05;
    read_at(&of, &run.series, 1, t, &beside);
    double by_y = -0.06 * weight.y * l * l / (2 * E * I),
           by_z = -0.05 * weight.z * l * l / (2 * E * I);
    CHECK_NEAR("strain of bending, 6 cm above the axis", above - along, by_y, 1e-4 * fabs(by_y));
    CHECK_NEAR("and 5 cm beside it", beside - above, by_z, 1e-4 * fabs(by_z));
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 3; i++)
            level.axis[i] = i == k;
        read_at(&level, &run.series, 1, t, &reading[k]);
    }
    v3 f = v3_from(reading), felt = m3_apply_transposed(stands, v3_make(0, g, 0));
    CHECK_NEAR("specific force at rest [m/s2]", v3_norm(f), g, 1e-6);
    CHECK_BELOW("its direction, but for the sag [m/s2]", v3_norm(v3_sub(f, felt)), 2e-3);
    free_run(&run);
}

// A launcher at rest on a base that is shaken: of the tube at 30 deg of elevation each place feels
// the base's acceleration and gravity, but for what the tube gives way.
static void test_shaken(void **state)
{
    (void)state;
    kept_run run;
    keep_run(&run, "include: fixed.yaml\n"
                   "base: {kind: prescribed, elevation: 30 deg, motion: {\n"
                   "  surge: [{amplitude: 0.2 m, frequency: 0.7 Hz, phase: 20 deg}],\n"
                   "  heave: [{amplitude: 0.3 m, frequency: 0.5 Hz, phase: 50 deg}]}}\n"
                   "tubes: {loads: [{at: 0.4 m}, {at: 1.1 m}]}\n"
                   "run: {lead_in: 1 s, output_step: {lead_in: 2 ms, tube: 1 ms}}\n");
    const double t[] = {-0.7, -0.4, -0.2}, pi = acos(-1);
    double reading[3], worst = 0;
    sensor of = plain(SENSOR_ACCELEROMETER);
    of.on = (char *)"station.2";
    of.at[1] = -0.08;
    v3_store(of.axis, v3_make(0.48, 0.6, 0.64));
    read_at(&of, &run.series, 3, t, reading);
    for (int i = 0; i < 3; i++) {
        double w1 = 2 * pi * 0.7, w2 = 2 * pi * 0.5;
        // the run's clock is 0 at the ignition, the base moves by it
        v3 f = {-w1 * w1 * 0.2 * sin(w1 * t[i] + pi / 9), g, 0};
        f.y -= w2 * w2 * 0.3 * sin(w2 * t[i] + pi / 3.6);
        v3 seen = m3_apply_transposed(m3_rotation_z(pi / 6), f);
        worst = fmax(worst, fabs(v3_dot(seen, v3_from(of.axis)) - reading[i]));
    }
    CHECK_BELOW("on a shaken base, of 11 m/s2 [m/s2]", worst, 3e-4);
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
        cmocka_unit_test(test_skew_axis), cmocka_unit_test(test_jump),
        cmocka_unit_test(test_strain),    cmocka_unit_test(test_shaken),
        cmocka_unit_test(test_flight),    cmocka_unit_test(test_altimeter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
