// launchdyn compare on logs that a small program of its own makes: a spinning rocket that rises in
// vacuum, by closed forms; its sensors through filters integrated in small steps, with noise. Then
// verdicts, clocks, samples left out, and what is wrong with logs.
#include "support/check.h"
#include "support/draw.h"
#include "support/shell.h"

#include "launchdyn/compare.h"

static const double g = 9.80665;

// ---- a flight by hand

// 10 kg, of which 2 kg burn with 300 N over 1 s and a tail to 1.05 s, which one of the tests sets
// to none; 400 m high, 30 m/s upwards; spin 15 rad/s.
static const char scenario[] =
    "launchdyn: 1\n"
    "environment: {atmosphere: none, ground: 0 m}\n"
    "rocket: {mass: 10 kg, center: 0.4 0 0 m, inertia: 0.1 1 1 kg.m2,\n"
    "  empty: {mass: 8 kg, center: 0.5 0 0 m, inertia: 0.08 0.8 0.8 kg.m2},\n"
    "  motor: {at: -0.5 0 0 m, thrust: [[0 s, 300 N], [1 s, 300 N], [1.05 s, 0 N]]}}\n"
    "flight: {ignition: 0 s, position: 0 400 0 m, speed: 30 m/s, attitude: {pitch: 90 deg},\n"
    "  rate: 15 0 0 rad/s}\n"
    "run: {end: apogee, output_step: {flight: 2 ms}, flight_tolerance: 1e-11}\n"
    "scatter:\n"
    "  samples: 100\n"
    "  seed: 3\n"
    "  factors: {rocket.motor.thrust_scale: {normal: 1 %}}\n";

enum { SPAN = 400, FINE = 100 }; // samples at 100 Hz, steps of the program between them

typedef struct truth {
    double t[SPAN], along[SPAN], across[SPAN], height[SPAN];
} truth;

static double thrust_at(double t)
{
    return t < 1 ? 300 : t < 1.05 ? 300 * (1.05 - t) / 0.05 : 0;
}

// Share of the propellant that is burnt.
static double burnt_at(double t)
{
    double late = fmin(fmax(t - 1, 0), 0.05);
    return (300 * fmin(t, 1) + 300 * (late - 10 * late * late)) / 307.5;
}

// Specific force along the axis.
static double felt_at(double t)
{
    return thrust_at(t) / (10 - 2 * burnt_at(t));
}

// From t = 0: the force through a Butterworth filter of order 2, x'' = w^2 (u - x) - sqrt(2) w x',
// by the midpoint rule in steps of 0.1 ms; speed and height likewise. The mass centre moves in the
// rocket by 0.1 m as it burns.
static void fly_by_hand(truth *all, double cutoff)
{
    const double w = 2 * acos(-1) * cutoff, dt = 0.01 / FINE;
    double x = 30, x_dot = 0, v = 30, h = 0;
    for (int i = 0; i < SPAN; i++) {
        double t = 0.01 * i;
        all->t[i] = t;
        all->along[i] = x;
        all->across[i] = -15.0 * 15 * 0.06;
        all->height[i] = h + 0.1 * burnt_at(t);
        for (int k = 0; k < FINE; k++) {
            double now = t + k * dt, u = felt_at(now + dt / 2);
            double x_mid = x + dt / 2 * x_dot,
                   dot_mid = x_dot + dt / 2 * (w * w * (u - x) - sqrt(2) * w * x_dot);
            x += dt * dot_mid;
            x_dot += dt * (w * w * (u - x_mid) - sqrt(2) * w * dot_mid);
            h += dt * (v + dt / 2 * (felt_at(now) - g));
            v += dt * (u - g);
        }
    }
}

static char path_of[256];

static const char *in(const char *name)
{
    snprintf(path_of, sizeof path_of, "%.100s/%.100s", shell.folder, name);
    return path_of;
}

static void write_text(const char *name, const char *text)
{
    FILE *file = fopen(in(name), "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

// A deviate of a normal distribution (Box and Muller).
static double normal(uint64_t *draws)
{
    double u = 0.5 * (1 - draw(draws)), v = draw(draws);
    return sqrt(-2 * log(u)) * cos(acos(-1) * v);
}

static const double noise[3] = {0.3, 0.2, 0.5};

// The log's clock shows `late` more than the run's; values in g, mm/s2 and feet.
static void write_log(const char *name, double late, double noisy, uint64_t seed)
{
    static truth all;
    fly_by_hand(&all, 20);
    FILE *file = fopen(in(name), "w");
    assert_non_null(file);
    fputs("# made\ntime [ms],across [g],along [mm/s2],unused,height [ft]\n", file);
    for (int i = 0; i < SPAN; i++)
        fprintf(file, "%.6f,%.17g,%.9f,x,%.12f\n", 1000 * (all.t[i] + late),
                (all.across[i] + noisy * noise[1] * normal(&seed)) / g,
                (all.along[i] + noisy * noise[0] * normal(&seed)) * 1000,
                (all.height[i] + noisy * noise[2] * normal(&seed)) / 0.3048);
    fclose(file);
}

static const char sensors[] =
    "clock: {find: along, offset: -0.3 s, within: 0.2 s, from: 0 s, to: 2 s}\n"
    "sensors:\n"
    "  - {column: along, kind: accelerometer, at: 1.2 0 0 m, axis: 1 0 0, low_pass: 20 Hz,\n"
    "     noise: 0.3 m/s2}\n"
    "  - {column: across, kind: accelerometer, at: 1.2 0.06 0 m, axis: 0 1 0, noise: 0.2 m/s2}\n"
    "  - {column: height, kind: altimeter, noise: 0.5 m}\n"
    "results:\n"
    "  - {of: along, name: burn, take: mean, from: 0.2 s, to: 0.9 s}\n"
    "  - {of: height, take: max}\n"
    "  - {of: height, name: apogee at, take: t_max}\n"
    "  - {of: t_apogee, measured: 5.37 s, uncertainty: 0.01 s}\n";

static void make_run(const char *more)
{
    char line[256];
    write_text("s.yaml", scenario);
    snprintf(line, sizeof line, "launchdyn run s.yaml --out out %s", more);
    if (run(line))
        fail_msg("%s", shell.err);
}

static ld_comparison *compare(const char *log, const ld_compare_options *options)
{
    ld_comparison *found = NULL;
    ld_error error = {0};
    char folder[256], file[256];
    snprintf(folder, sizeof folder, "%s", in("out"));
    snprintf(file, sizeof file, "%s", in(log));
    if (ld_compare(folder, file, options, &found, &error))
        fail_msg("%s", error.text);
    return found;
}

// Without noise the command's sensors are those of the small program.
static void test_series(void **state)
{
    (void)state;
    make_run("");
    write_log("log.csv", 0, 0, 1);
    write_text("log.yaml", sensors);
    write_text("given.yaml",
               "sensors:\n"
               "  - {column: along, kind: accelerometer, at: 1.2 0 0 m, axis: 2 0 0,\n"
               "     low_pass: 20 Hz}\n"
               "  - {column: across, kind: accelerometer, at: 0.4 0.06 0 m,\n"
               "     axis: 0 1 0}\n"
               "  - {column: height, kind: altimeter}\n");
    char given[256];
    snprintf(given, sizeof given, "%s", in("given.yaml"));
    ld_comparison *found = compare("log.csv", &(ld_compare_options){.sensors = given});
    const double bound[] = {3e-4, 1e-14, 2e-7};
    for (int i = 0; i < 3; i++) {
        const ld_compared_series *series = ld_comparison_series(found, i);
        CHECK_BELOW(series->name, series->largest, bound[i]);
        assert_int_equal(series->count, SPAN);
    }
    ld_comparison_free(found);
}

// Of many noisy logs with a late clock: the offset is found with its uncertainty, E is the noise,
// and everything agrees.
static void test_noise(void **state)
{
    (void)state;
    enum { LOGS = OF_ALL(200, 10) };
    int within = 0, agree = 0;
    double squares = 0, rms = 0, uncertainty = 0;
    make_run("");
    write_text("log.yaml", sensors);
    for (int i = 0; i < LOGS; i++) {
        write_log("log.csv", 0.237, 1, 100 + (uint64_t)i);
        ld_comparison *found = compare("log.csv", NULL);
        const ld_compared_clock *clock = ld_comparison_clock(found);
        double miss = clock->offset + 0.237;
        within += fabs(miss) <= 2 * clock->uncertainty;
        squares += miss * miss / LOGS;
        uncertainty += clock->uncertainty / LOGS;
        for (int k = 0; k < 3; k++)
            agree += ld_comparison_series(found, k)->of.verdict == LD_VERDICT_AGREE;
        rms += ld_comparison_series(found, 1)->of.error / LOGS;
        ld_comparison_free(found);
    }
    CHECK_WITHIN("offset within 2 u, share", (double)within / LOGS, 0.9, 1);
    CHECK_WITHIN("rms of the offset's error over its u", sqrt(squares) / uncertainty, 0.85, 1.15);
    CHECK_BELOW("error of the offset, rms [s]", sqrt(squares), 1e-3);
    CHECK_WITHIN("E of a true sensor over its noise", rms / noise[1], OF_ALL(0.99, 0.95),
                 OF_ALL(1.01, 1.05));
    CHECK_WITHIN("series that agree, share", agree / (3.0 * LOGS), 1, 1);
}

// A wrong lever arm, a limit finer than the noise, extremes and times of a series, u_num, u_input.
static void test_verdicts(void **state)
{
    (void)state;
    make_run("--set 'rocket.motor.thrust=[[0 s, 300 N], [1 s, 300 N]]'");
    write_log("log.csv", 0, 1, 7);
    write_text("log.yaml",
               "sensors:\n"
               "  - {column: across, kind: accelerometer, at: 0.4 0.07 0 m, axis: 0 1 0,\n"
               "     noise: 0.2 m/s2}\n"
               "  - {column: height, kind: altimeter, noise: 0.5 m, limit: 0.9 m}\n"
               "results:\n"
               "  - {of: height, take: max}\n"
               "  - {of: across, name: mean, take: mean, from: 1 s, to: 2 s}\n"
               "  - {of: t_apogee, measured: 6.47 s, uncertainty: 10 ms, limit: 40 ms}\n"
               "  - {of: apogee, measured: 0.5 km, uncertainty: 1 m}\n");
    ld_comparison *found =
        compare("log.csv", &(ld_compare_options){.refine = true, .samples = OF_ALL(40, 6)});
    const ld_compared_series *across = ld_comparison_series(found, 0);
    assert_int_equal(across->of.verdict, LD_VERDICT_DISAGREE);
    CHECK_NEAR("E of 1 cm of lever arm [m/s2]", across->mean, -225 * 0.01, 0.05);
    assert_int_equal(ld_comparison_series(found, 1)->of.verdict, LD_VERDICT_CANNOT_TELL);
    const ld_compared_result *highest = ld_comparison_result(found, 0),
                             *mean = ld_comparison_result(found, 1),
                             *instant = ld_comparison_result(found, 2),
                             *apogee = ld_comparison_result(found, 3);
    CHECK_NEAR("u_D of a mean of 101 samples [m/s2]", mean->of.u_data, 0.2 / sqrt(101), 1e-12);
    CHECK_NEAR("u_D of a greatest value [m]", highest->of.u_data, 0.5, 1e-12);
    // closed form: speed and height at burnout, then a parabola; thrust of 1 % scatters it
    double burn = 150 * log(10. / 8), v = 30 + burn - g;
    double h = 30 - g / 2 + 150 * (1 - 4 * log(10. / 8)) + 0.1, top = h + v * v / (2 * g);
    CHECK_NEAR("apogee above the ground [m]", apogee->simulated, 400.4 + top, 1e-10);
    CHECK_NEAR("instant of the apogee [s]", instant->simulated, 1 + v / g, 1e-11);
    // d apogee/d thrust: by 1 % of the burn's part of speed and height
    double slope = 0.01 * (150 * (1 - 4 * log(10. / 8)) + v / g * burn);
    CHECK_WITHIN("u_input of the apogee over 1 % of thrust", apogee->of.u_input / slope,
                 OF_ALL(0.75, 0.4), OF_ALL(1.25, 1.7));
    CHECK_WITHIN("u_num of the apogee [m]", apogee->of.u_num, 1e-12, 1e-3);
    CHECK_NEAR("u_val", apogee->of.u_val,
               sqrt(1 + pow(apogee->of.u_input, 2) + pow(apogee->of.u_num, 2)), 1e-12);
    assert_int_equal(instant->of.verdict, LD_VERDICT_CANNOT_TELL);
    ld_comparison_free(found);
}

// Saturated samples, gaps, what lies outside, a bias found at rest.
static void test_left_out(void **state)
{
    (void)state;
    make_run("");
    write_text("log.csv", "t [s],w [deg/s],h [m]\n"
                          "-0.5,870,0\n-0.4,872,\n0.1,860,\n0.2,,7\n0.3,2000,9\n0.4,859,12\n"
                          "60,859,12\n");
    write_text("log.yaml", "sensors:\n"
                           "  - {column: w, kind: gyro, axis: 1 0 0, range: -2000 2000 deg/s,\n"
                           "     rest: -1 -0.1 s, noise: 2 deg/s}\n");
    ld_comparison *found = compare("log.csv", NULL);
    const ld_compared_series *series = ld_comparison_series(found, 0);
    double degree = acos(-1) / 180;
    assert_int_equal(series->count, 2);
    assert_int_equal(series->saturated, 1);
    assert_int_equal(series->gaps, 1);
    assert_int_equal(series->outside, 3);
    CHECK_NEAR("bias at rest [rad/s]", series->bias, 871 * degree - 15, 1e-12);
    CHECK_NEAR("its uncertainty [rad/s]", series->bias_uncertainty, 2 * degree / sqrt(2), 1e-12);
    CHECK_NEAR("mean of E [rad/s]", series->mean, 871 * degree - 859.5 * degree, 1e-12);
    ld_comparison_free(found);
}

// Columns by their names; the command's tables.
static void test_command(void **state)
{
    (void)state;
    make_run("");
    write_text("log.csv", "t [s],center.y [m],mine [m]\n0,400,1\n1,436,2\n2,470,3\n");
    if (run("launchdyn compare out log.csv"))
        fail_msg("%s", shell.err);
    expect_in(shell.out, "clock: time from ignition = time of the log +0 s");
    expect_in(shell.out, "center.y [m]              3 ");
    write_log("made.csv", 0.237, 1, 7);
    write_text("made.yaml", sensors);
    assert_int_equal(
        run("launchdyn compare out made.csv --json >a && jq -e '.series | length == 3' a"
            " && jq -r '.results[2].name' a"),
        0);
    expect_in(shell.out, "apogee at");
    // the report has the same, and without a log nothing of it
    assert_int_equal(
        run("launchdyn report out --log made.csv -o a.html && launchdyn report out -o b.html"
            " && grep -c "
            "'\"compared\":{\"log\":\"made.csv\",\"series\":.{\"name\":\"along\",\"unit\":"
            "\"mm/s2\",\"verdict\":\"agree\"' a.html"
            " && grep -c '\"compared\":null' b.html"),
        0);
    expect_complaint("launchdyn report out out --log made.csv -o c.html", 2,
                     "--log requires one run");
    expect_complaint("launchdyn report out --log none.csv", 2, "none.csv cannot be read");
    assert_int_equal(run("launchdyn compare out made.csv -q --plot a.svg && grep -c 'u_val' a.svg"),
                     0);
}

// u_input of a study: of a result what its samples have, of a series the first of them run again,
// which are those that --samples runs of the same scenario.
static void test_study(void **state)
{
    (void)state;
    enum { SAMPLES = OF_ALL(12, 3) };
    char study[256], line[128];
    make_run("");
    snprintf(line, sizeof line, "launchdyn study s.yaml --out study -q --set scatter.samples=%d",
             SAMPLES);
    if (run(line))
        fail_msg("%s", shell.err);
    write_log("log.csv", 0, 1, 7);
    write_text("log.yaml", "sensors:\n"
                           "  - {column: height, kind: altimeter, noise: 0.5 m}\n"
                           "results:\n"
                           "  - {of: height, take: max}\n"
                           "  - {of: t_apogee, measured: 6.47 s, uncertainty: 10 ms}\n");
    snprintf(study, sizeof study, "%s", in("study"));
    ld_comparison *of[] = {
        compare("log.csv", &(ld_compare_options){.samples = SAMPLES}),
        compare("log.csv", &(ld_compare_options){.study = study}),
        compare("log.csv", &(ld_compare_options){.study = study, .samples = SAMPLES})};
    double series[3], highest[3], late[3];
    for (int i = 0; i < 3; i++) {
        series[i] = ld_comparison_series(of[i], 0)->of.u_input;
        highest[i] = ld_comparison_result(of[i], 0)->of.u_input;
        late[i] = ld_comparison_result(of[i], 1)->of.u_input;
    }
    assert_true(isnan(series[1]) && isnan(highest[1]) && series[0] > 0.1 && highest[0] > 0.1);
    assert_non_null(strstr(ld_comparison_note(of[1], 0), "u_input of series requires --samples"));
    CHECK_NEAR("u_input of a series, its study run again [m]", series[2], series[0], 1e-12);
    CHECK_NEAR("of a number of the series [m]", highest[2], highest[0], 1e-12);
    CHECK_NEAR("of a result, from the study [s]", late[1], late[0], 1e-12);
    CHECK_NEAR("and with both [s]", late[2], late[0], 1e-12);
    for (int i = 0; i < 3; i++)
        ld_comparison_free(of[i]);
}

// On a vehicle at rest: chassis and elevation platform feel gravity along their axes, the chassis'
// gyro nothing; a gauge in um/m; what parts there are.
static void test_launcher(void **state)
{
    (void)state;
    if (run("launchdyn run " LD_SOURCE_DIR "/examples/reference.yaml --out out -q"
            " --set base.road='{class: , tracks: , seed: , harmonics: , wavelengths: , flat: "
            "true}' --set base.speed='0 m/s' --set 'tubes.loads=[{at: 2.5 m}]'"
            " --set run.lead_in='20 ms' --set run.end='2 ms'"))
        fail_msg("%s", shell.err);
    write_text("log.csv", "t [s],up [g],along [m/s2],turn [deg/s],gauge [um/m]\n"
                          "-0.015,1,3.3219,0,0\n-0.01,1,3.3219,0,0\n-0.005,1,3.3219,0,0\n");
    write_text("log.yaml",
               "sensors:\n"
               "  - {column: up, kind: accelerometer, on: chassis, at: 1 0.5 0.3 m, axis: 0 1 0}\n"
               "  - {column: along, kind: accelerometer, on: elevation, at: 0.5 0.2 0 m,\n"
               "     axis: 1 0 0}\n"
               "  - {column: turn, kind: gyro, on: azimuth, axis: 0 1 0}\n"
               "  - {column: gauge, kind: strain, on: station.1, at: 0 0.085 0 m}\n");
    ld_comparison *found = compare("log.csv", NULL);
    const ld_compared_series *of[4];
    for (int i = 0; i < 4; i++)
        of[i] = ld_comparison_series(found, i);
    CHECK_BELOW("at rest on the chassis, up [m/s2]", of[0]->largest, 2e-6);
    CHECK_BELOW("on the platform, along the tube [m/s2]", of[1]->largest, 5e-5);
    CHECK_BELOW("of the azimuth platform [rad/s]", of[2]->largest, 1e-12);
    // half a metre of tube beyond it, 19.8 deg steep: of bending less of its weight along it
    const double R = 0.085, r = 0.0825, E = 2.1e11, steep = 19.8 * acos(-1) / 180;
    double load = 7850 * g * 0.5 / E; // of rho g l/E
    double bent = load * cos(steep) * R * 0.5 / 2 / ((R * R + r * r) / 4);
    CHECK_NEAR("strain above the axis", of[3]->simulated[1], bent - load * sin(steep), 1e-9);
    assert_string_equal(of[3]->unit, "");
    ld_comparison_free(found);
}

static void refused(const char *log, const char *yaml, const char *why)
{
    write_text("bad.csv", log);
    if (yaml)
        write_text("bad.yaml", yaml);
    else
        assert_int_equal(run("rm -f bad.yaml"), 0);
    expect_complaint("launchdyn compare out bad.csv", 2, why);
}

#define ONE(keys) "sensors:\n  - {column: w, kind: gyro, axis: 1 0 0" keys "}\n"

static void test_refusals(void **state)
{
    (void)state;
    make_run("");
    refused("", ONE(""), "bad.csv:0:1: the file is empty");
    refused("w [rad/s]\n1\n", ONE(""), "bad.csv has no column of times, \"t [s]\" or \"time [s]\"");
    refused("t [s],rates [rad/s]\n0,1\n", "sensors:\n  - {column: rate, kind: gyro, axis: 1 0 0}\n",
            "bad.csv has no column \"rate\", did you mean \"rates\"?");
    refused("t [kg],w [rad/s]\n0,1\n", ONE(""), "1:1: t: found the unit \"kg\"; expected one of s");
    refused("t [s],w [m]\n0,1\n", ONE(""), "1:7: w: found the unit \"m\"; expected one of rad/s");
    refused("t [s],w [rad/ss]\n0,1\n", ONE(""), "w: found the unit \"rad/ss\"");
    refused("t [s],w [rad/s]\n0,1\n0.1,2\n0.05,3\n", ONE(""),
            "bad.csv:4:1: t: the clock runs backwards here");
    refused("t [s],w [rad/s]\n0,1\n,2\n", ONE(""), "3:1: t: no time; expected a number");
    refused("t [s],w [rad/s]\n0,1\n0.1,a\n", ONE(""), "3:5: w: found \"a\"; expected a number");
    refused("t [s],w [rad/s]\n0,1,2\n", ONE(""), "2:1: t: found 3 fields; expected 2");
    refused("t [s],w [rad/s]\n", ONE(""), "no row follows the header");
    refused("t [s],w [rad/s],w [rad/s]\n0,1,2\n", ONE(""), "w: is given in an earlier column, too");
    refused("t [s],w [rad/s]\n100,1\n101,2\n", ONE(""),
            "the log begins 100 s after the ignition, after the run's end at ");
    refused("t [s],w [rad/s]\n-2,1\n-1,2\n", ONE(""),
            "the log ends -1 s after the ignition, before the run's start at 0 s");
    refused("t [s],w [rad/s]\n0,1\n1,2\n", ONE(", from: 1.2 s, to: 2 s"),
            "w: none of its 2 samples lies between 1.2 s and 2 s within its range");
    refused("t [s],w [rad/s]\n0,1\n1,2\n", ONE(", rest: -2 -1 s"),
            "w: no sample lies in rest, -2 s to -1 s");
    refused("t [s],w [rad/s]\n0,1\n1,2\n", NULL,
            "no column of bad.csv has the name of one of the run's");
    refused("t [s],w [rad/s]\n0,1\n", ONE(", axes: 1 0 0"),
            "bad.yaml:2:42: sensors.1.axes: unknown key, did you mean \"axis\"?");
    refused("t [s],w [rad/s]\n0,1\n", ONE(", noise: 2 m"),
            "sensors.1.noise: found \"2 m\", a unit of");
    refused("t [s],w [rad/s]\n0,1\n", ONE(", at: 0 0 0 m"),
            "sensors.1.at: is not allowed with kind: gyro");
    refused("t [s],w [rad/s]\n0,1\n", "sensors:\n  - {column: w, kind: column, of: rocket.wxy}\n",
            "sensors.1.of: the run has no column \"rocket.wxy\", did you mean \"rocket.wx\"?");
    refused("t [s],w [rad/s]\n0,1\n", ONE(", on: chassi"),
            "bad.yaml:2:46: sensors.1.on: the run has no column \"chassi.wx\"");
    refused("t [s],w [rad/s]\n0,1\n", ONE(", on: rock"),
            "sensors.1.on: the run has no column \"rock.wx\", did you mean \"rocket\"?");
    refused("t [s],w\n0,1\n", "sensors:\n  - {column: w, kind: strain}\n",
            "sensors.1.on: required, a station of the tube: station.1");
    refused("t [s],w [m]\n0,1\n", "sensors:\n  - {column: w, kind: altimeter, on: chassis}\n",
            "sensors.1.on: is not allowed with kind: altimeter");
    refused("t [s],w [rad/s]\n0,1\n", "clock: {find: v}\n" ONE(""),
            "clock.find: expected the column of a sensor");
    refused("t [s],w [rad/s]\n0,1\n1,1\n", "clock: {find: w}\n" ONE(""),
            "clock.find: fewer than 8 samples of w lie between ");
    refused("t [s],w [rad/s]\n0,1\n", ONE("") "results:\n  - {of: w, take: max, from: 1 s}\n",
            "results.1, w: no sample lies in its window");
    refused("t [s],w [rad/s]\n0,1\n",
            ONE("") "results:\n  - {of: exit_sped, measured: 1 m/s, uncertainty: 1 m/s}\n",
            "exit_sped");
    refused("t [s],w [rad/s]\n0,1\n", "sensors: 3\n", "sensors: expected a list of blocks of keys");
    expect_complaint("launchdyn compare out", 2, "compare requires DIR LOG;");
    expect_complaint("launchdyn compare nowhere bad.csv", 2,
                     "no results in nowhere: there is no history.h5");
    expect_complaint("launchdyn compare out bad.csv --rocket 2", 2, "there is no rocket 2");
    expect_complaint("launchdyn compare out nothing.csv", 2, "nothing.csv cannot be read");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, shell_make, shell_remove)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_series),  TEST(test_noise),    TEST(test_verdicts), TEST(test_left_out),
        TEST(test_command), TEST(test_launcher), TEST(test_study),    TEST(test_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
