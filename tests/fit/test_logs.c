// Fits of a launcher whose keys are known to logs of its own launch: an accelerometer and a gyro
// with noise, white or correlated, on a clock of their own.
// ctest: slow
#include "support/found_fit.h"

#include "base/random.h"
#include "fit/fit_log.h"
#include "launchdyn/launchdyn.h"
#include "math/curves/distributions.h"
#include "support/coverage.h"
#include "support/scratch.h"

enum { KEYS = 2, SAMPLES = 290, ALL_KEYS = 5 };

// ---- the launcher

// The reference launcher on a fixed base, with a coarse tube.
static ld_model *make_model(const char *const *sets, size_t count)
{
    static const char *const coarse[] = {"tubes.modes.bending=1", "tubes.modes.torsion=0",
                                         "run.tolerance=1e-7", "run.max_step=2 ms",
                                         "run.output_step=0.5 ms"};
    enum { COARSE = sizeof coarse / sizeof *coarse };
    const char *all[COARSE + 8];
    ld_model *model;
    ld_messages messages;
    memcpy(all, coarse, sizeof coarse);
    for (size_t i = 0; i < count; i++)
        all[COARSE + i] = sets[i];
    assert_int_equal(ld_scenario_read(LD_SOURCE_DIR "/examples/fixed.yaml", all, COARSE + count,
                                      &model, &messages),
                     LD_OK);
    return model;
}

static const char *const truth[] = {"rocket.motor.thrust_scale=1.02",
                                    "rocket.lock.release_force=6 kN"};
static const ld_fit_key keys[KEYS] = {{"rocket.motor.thrust_scale", "0.9", "1.1", NULL, NULL},
                                      {"rocket.lock.release_force", "2 kN", "10 kN", NULL, NULL}};
// Those keys, then offset of the clock, bias and scale of the accelerometer.
static const double true_value[ALL_KEYS] = {1.02, 6000, -0.3, 0.2, 1};

// What is felt along the axis, and the roll rate, every half millisecond, at which there are rows;
// and the speed at the exit.
typedef struct felt {
    double t[SAMPLES], force[SAMPLES], rate[SAMPLES], exit_speed;
} felt;

static void launch(felt *all)
{
    ld_model *model = make_model(truth, KEYS);
    ld_simulation *simulation;
    ld_summary *summary = ld_summary_new();
    ld_history *history = ld_history_new(NULL);
    const ld_run_options options = {.sink = ld_history_sink(history)};
    ld_error error;
    size_t rows, n = 0;
    assert_int_equal(ld_simulation_create(model, &simulation, &error), LD_OK);
    assert_int_equal(ld_simulation_run(simulation, &options, summary, &error), LD_OK);
    assert_int_equal(ld_summary_number(summary, "rocket.1.exit_speed", &all->exit_speed, &error),
                     LD_OK);
    const double *t = ld_history_column(history, "t", &rows);
    const double *force = ld_history_column(history, "rocket.fx", NULL);
    const double *rate = ld_history_column(history, "rocket.wx", NULL);
    for (size_t i = 0; i < rows && n < SAMPLES; i++)
        if (fabs(t[i] - 0.5e-3 * (double)(n + 1)) < 1e-9) {
            all->t[n] = t[i];
            all->force[n] = force[i];
            all->rate[n++] = rate[i];
        }
    assert_int_equal(n, SAMPLES);
    ld_history_free(history);
    ld_summary_free(summary);
    ld_simulation_free(simulation);
    ld_model_free(model);
}

// ---- logs

static double deviate(int set, int sample, int of)
{
    return normal_quantile(random_uniform(31, (uint64_t)set, (uint64_t)sample, (uint64_t)of, 0));
}

enum { NOISY = 1 };
static const double noise[2] = {0.05, 1e-3}; // of samples [m/s2, rad/s]

// Without or with noise of a set, first order with correlation 0.6.
static void write_log(const felt *all, int set, int noisy)
{
    double e[2] = {0};
    FILE *stream = fopen(in("log.csv"), "w");
    assert_non_null(stream);
    fputs("time [ms],acc [m/s2],gyro [rad/s]\n", stream);
    for (int i = 0; i < SAMPLES; i++) {
        for (int k = 0; k < 2; k++)
            e[k] = 0.6 * e[k] + 0.8 * noisy * deviate(set, i, k);
        fprintf(stream, "%.17g,%.17g,%.17g\n", 1e3 * (all->t[i] - true_value[2]),
                all->force[i] + true_value[3] + noise[0] * e[0], all->rate[i] + noise[1] * e[1]);
    }
    assert_int_equal(fclose(stream), 0);
    stream = fopen(in("log.yaml"), "w");
    assert_non_null(stream);
    fprintf(stream,
            "clock: {find: acc, offset: -0.29 s, within: 50 ms}\n"
            "sensors:\n"
            "  - {column: acc, kind: accelerometer, axis: 1 0 0, noise: %g m/s2, to: 145 ms,\n"
            "     bias: 0.2 m/s2, bias_uncertainty: 1e-4 m/s2, scale_uncertainty: 2e-3}\n"
            "  - {column: gyro, kind: gyro, axis: 1 0 0, noise: %g rad/s, to: 145 ms}\n"
            "results:\n"
            "  - {of: exit_speed, measured: %.17g m/s, uncertainty: 0.05 m/s}\n"
            "  - {of: acc, take: max}\n",
            noise[0], noise[1], all->exit_speed);
    assert_int_equal(fclose(stream), 0);
}

// ---- what is found

static void read_found(const ld_fit *fit, found *of)
{
    char *text = json_of(fit);
    const char *at = strstr(read_keys(text, ALL_KEYS, of), "\"logs\"");
    of->offset = number_after(&at, "offset");
    for (int k = 0; k < 2; k++)
        of->correlation[k] = number_after(&at, "correlation");
    free(text);
}

static ld_fit *make_fit(const ld_model *model)
{
    ld_fit *fit;
    ld_error error;
    const char *log = in("log.csv");
    assert_int_equal(ld_fit_create(model, keys, KEYS, NULL, 0, &fit, &error), LD_OK);
    if (ld_fit_add_logs(fit, &log, NULL, 1, &error))
        fail_msg("%s", error.text);
    return fit;
}

static void fit_log_of(const ld_model *model, found *of)
{
    ld_error error;
    const ld_fit_options options = {.threads = 2, .starts = 2};
    ld_fit *fit = make_fit(model);
    if (ld_fit_run(fit, &options, &error))
        fail_msg("%s", error.text);
    read_found(fit, of);
    ld_fit_free(fit);
}

// ---- without noise

static void test_exact(void **state)
{
    (void)state;
    static const char *const names[ALL_KEYS] = {"thrust", "release force", "clock", "bias",
                                                "scale"};
    felt all;
    found of;
    ld_model *model = make_model(NULL, 0);
    launch(&all);
    write_log(&all, 0, 0);
    fit_log_of(model, &of);
    for (int i = 0; i < ALL_KEYS; i++) {
        CHECK_BELOW(names[i], (of.value[i] - true_value[i]) / of.deviation[i], 0.05);
    }
    CHECK_BELOW("offset of the log [s]", of.offset - of.value[2], 0);
    // the data know the bias thirty times less well than its prior
    CHECK_NEAR("deviation of the bias [m/s2]", of.deviation[3], 1e-4, 1e-6);
    ld_model_free(model);
}

// ---- with noise

// 10 kg, of which 2 kg burn with 300 N over 1 s and a tail to 1.05 s; 400 m high; the mass centre
// moves in the rocket by 0.1 m as it burns.
static const char flight[] =
    "launchdyn: 1\n"
    "environment: {atmosphere: none, ground: 0 m}\n"
    "rocket: {mass: 10 kg, center: 0.4 0 0 m, inertia: 0.1 1 1 kg.m2,\n"
    "  empty: {mass: 8 kg, center: 0.5 0 0 m, inertia: 0.08 0.8 0.8 kg.m2},\n"
    "  motor: {at: -0.5 0 0 m, thrust: [[0 s, 300 N], [1 s, 300 N], [1.05 s, 0 N]]}}\n"
    "flight: {ignition: 0 s, position: 0 400 0 m, speed: 30 m/s, attitude: {pitch: 90 deg},\n"
    "  rate: 14 0 0 rad/s}\n"
    "run: {end: apogee, output_step: {flight: 10 ms}, flight_tolerance: 1e-11}\n";

enum { FLOWN = 250, FINE = 100, SERIES = 3, FLIGHT_KEYS = 5 }; // samples at 100 Hz

static const ld_fit_key flight_keys[] = {{"rocket.motor.thrust_scale", "0.9", "1.1", NULL, NULL},
                                         {"flight.speed", "20 m/s", "40 m/s", NULL, NULL},
                                         {"flight.rate.x", "10 rad/s", "20 rad/s", NULL, NULL}};
// Those, offset of the clock, bias of the accelerometer along the axis.
static const double flown_value[FLIGHT_KEYS] = {1.01, 30.5, 15, -0.3, 0};
static const double flown_noise[SERIES] = {0.3, 0.2, 0.5}, flown_bias = 0.1;

typedef struct flown {
    double value[SERIES][FLOWN]; // along the axis, across it, height
} flown;

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

static double felt_at(double t)
{
    return flown_value[0] * thrust_at(t) / (10 - 2 * burnt_at(t));
}

// Speed and height by the midpoint rule in steps of 0.1 ms; the sensor across lies 60 mm off the
// axis.
static void fly_by_hand(flown *all)
{
    const double dt = 0.01 / FINE, g = 9.80665;
    double v = flown_value[1], h = 0;
    for (int i = 0; i < FLOWN; i++) {
        all->value[0][i] = felt_at(0.01 * i);
        all->value[1][i] = -flown_value[2] * flown_value[2] * 0.06;
        all->value[2][i] = h + 0.1 * burnt_at(0.01 * i);
        for (int k = 0; k < FINE; k++) {
            double a = felt_at(0.01 * i + (k + 0.5) * dt) - g;
            h += dt * (v + dt / 2 * a);
            v += dt * a;
        }
    }
}

// The log of one set; its noise is of first order with correlation rho from sample to sample.
static void write_flown(const flown *all, int set, double rho)
{
    double e[SERIES];
    double bias = flown_bias * deviate(set, FLOWN, SERIES);
    for (int k = 0; k < SERIES; k++)
        e[k] = deviate(set, FLOWN, k);
    FILE *stream = fopen(in("log.csv"), "w");
    assert_non_null(stream);
    fputs("time [s],along [m/s2],across [m/s2],height [m]\n", stream);
    for (int i = 0; i < FLOWN; i++) {
        fprintf(stream, "%.17g", 0.01 * i - flown_value[3]);
        for (int k = 0; k < SERIES; k++) {
            fprintf(stream, ",%.17g",
                    all->value[k][i] + flown_noise[k] * e[k] + (k == 0 ? bias : 0));
            e[k] = rho * e[k] + sqrt(1 - rho * rho) * deviate(set, i, k);
        }
        fputs("\n", stream);
    }
    assert_int_equal(fclose(stream), 0);
}

static void write_flown_sensors(void)
{
    FILE *stream = fopen(in("log.yaml"), "w");
    assert_non_null(stream);
    fprintf(stream,
            "clock: {find: along, offset: -0.25 s, within: 0.1 s}\n"
            "sensors:\n"
            "  - {column: along, kind: accelerometer, at: 1.2 0 0 m, axis: 1 0 0,\n"
            "     noise: %g m/s2, bias_uncertainty: %g m/s2, to: 2.4 s}\n"
            "  - {column: across, kind: accelerometer, at: 1.2 0.06 0 m, axis: 0 1 0,\n"
            "     noise: %g m/s2, to: 2.4 s}\n"
            "  - {column: height, kind: altimeter, noise: %g m, to: 2.4 s}\n",
            flown_noise[0], flown_bias, flown_noise[1], flown_noise[2]);
    assert_int_equal(fclose(stream), 0);
}

static ld_model *read_flight(void)
{
    ld_model *model;
    ld_messages messages;
    FILE *stream = fopen(in("flight.yaml"), "w");
    assert_non_null(stream);
    fputs(flight, stream);
    assert_int_equal(fclose(stream), 0);
    assert_int_equal(ld_scenario_read(in("flight.yaml"), NULL, 0, &model, &messages), LD_OK);
    ld_messages_free(&messages);
    return model;
}

static void fit_flown(const ld_model *model, found *of)
{
    ld_fit *fit;
    ld_error error;
    const char *log = in("log.csv");
    const ld_fit_options options = {.starts = 1};
    assert_int_equal(ld_fit_create(model, flight_keys, 3, NULL, 0, &fit, &error), LD_OK);
    if (ld_fit_add_logs(fit, &log, NULL, 1, &error) || ld_fit_run(fit, &options, &error))
        fail_msg("%s", error.text);
    read_found(fit, of);
    ld_fit_free(fit);
}

// How often the truth lies inside the 95 % intervals of `sets` fits.
static void check_coverage(const char *what, double rho, int sets)
{
    static const char *const names[FLIGHT_KEYS] = {"thrust [%]", "speed [%]", "roll rate [%]",
                                                   "clock [%]", "bias [%]"};
    flown all;
    int inside[FLIGHT_KEYS] = {0}, noisy = 0, least = least_of_95(sets);
    double correlation = 0;
    ld_model *model = read_flight();
    fly_by_hand(&all);
    write_flown_sensors();
    for (int set = 0; set < sets; set++) {
        found of;
        write_flown(&all, set, rho);
        fit_flown(model, &of);
        for (int i = 0; i < FLIGHT_KEYS; i++) {
            double expected = i == 4 ? flown_bias * deviate(set, FLOWN, SERIES) : flown_value[i];
            inside[i] += of.low[i] <= expected && expected <= of.high[i];
        }
        noisy += of.chance >= 0.05;
        correlation += (of.correlation[0] + of.correlation[1]) / 2 / sets;
    }
    printf("    %s, %d logs\n", what, sets);
    for (int i = 0; i < FLIGHT_KEYS; i++)
        CHECK_WITHIN(names[i], 100. * inside[i] / sets, 100. * least / sets, 100);
    // of white noise 1
    double expected = (1 + rho) / (1 - rho);
    CHECK_WITHIN("sum of the correlation", correlation, 0.8 * expected, 1.5 * expected);
    if (rho == 0)
        CHECK_WITHIN("residuals taken for noise [%]", 100. * noisy / sets, 100. * least / sets,
                     100);
    ld_model_free(model);
}

// scripts/prove repeats it with more sets (LD_FIT_SETS).
static void test_coverage(void **state)
{
    (void)state;
    int sets = getenv("LD_FIT_SETS") ? atoi(getenv("LD_FIT_SETS")) : OF_ALL(40, 4);
    check_coverage("white noise", 0, sets);
    check_coverage("correlated noise", 0.6, sets);
}

// ---- the sum of a correlation

static void test_correlation(void **state)
{
    (void)state;
    enum { N = 20000 };
    static double white[N], red[N];
    for (int i = 0; i < N; i++) {
        white[i] = deviate(7, i, 9);
        red[i] = i ? 0.8 * red[i - 1] + white[i] : 0;
    }
    CHECK_NEAR("white noise", fit_correlation_sum(white, N), 1, 0);
    CHECK_NEAR("first order, 0.8: (1 + 0.8)/(1 - 0.8)", fit_correlation_sum(red, N), 9, 0.9);
}

// ---- interruption, jobs

static void test_continues(void **state)
{
    (void)state;
    felt all;
    ld_error error;
    ld_model *model = make_model(NULL, 0);
    launch(&all);
    write_log(&all, 1, NOISY);
    ld_fit *fit = make_fit(model);
    assert_int_equal(ld_fit_run(fit, &(ld_fit_options){.starts = 1}, &error), LD_OK);
    char *whole = json_of(fit);
    patience some;
    ld_fit_options options = {
        .folder = in("fit"), .starts = 1, .self = &some, .go_on = wait_once_more};
    int stops = 0;
    for (some.left = 5000; ld_fit_run(fit, &options, &error) == LD_ERR_INTERRUPTED; stops++)
        some.left = 5000 + 5000 * stops;
    char *after = json_of(fit);
    assert_true(stops >= 3);
    assert_string_equal(whole, after);
    free(after);
    options = (ld_fit_options){.threads = 2, .starts = 1};
    assert_int_equal(ld_fit_run(fit, &options, &error), LD_OK);
    after = json_of(fit);
    assert_string_equal(whole, after);
    free(after);
    free(whole);
    ld_fit_free(fit);
    // a log with another value is another fit
    write_log(&all, 2, NOISY);
    fit = make_fit(model);
    options = (ld_fit_options){.folder = in("fit"), .starts = 1};
    assert_int_equal(ld_fit_run(fit, &options, &error), LD_ERR_INPUT);
    assert_non_null(strstr(error.text, "use another folder"));
    ld_fit_free(fit);
    ld_model_free(model);
}

// ---- what is refused

typedef struct refusal {
    const char *log, *sensors, *message;
} refusal;

#define HEAD "t [s],acc [m/s2]\n"
#define ACC "sensors: [{column: acc, kind: accelerometer, axis: 1 0 0, noise: 1 m/s2"

static void test_refused(void **state)
{
    (void)state;
    static const refusal cases[] = {
        {HEAD "0.1,200\n", "sensors: [{column: acc, kind: accelerometer, axis: 1 0 0}]\n",
         "acc: a fit requires the noise of its sensor, a number > 0"},
        {"t [s],acc_x [m/s2]\n0.1,200\n", ACC "}]\n", "wrong.csv has no column \"acc\""},
        {HEAD "0.1,200\n", ACC ", from: 1 s}]\n",
         "acc: none of its 1 samples lies between 1 s and"},
        {HEAD "0.1,200\n", ACC ", to: 50 ms}]\n", "acc: none of its 1 samples lies between"},
        {HEAD "5,200\n", ACC "}]\n", "acc: none of its 1 samples lies between"},
        {HEAD "0.1,200\n", ACC "}]\n", "2 keys without a prior, but 1 measured results"},
        {HEAD "0.1,200\n0.11,210\n", ACC "}]\nclock: {find: acc}\n",
         "clock.find: fewer than 8 samples of acc"},
        {HEAD "0.1,200\n", ACC ", rest: -2 -1 s}]\n", "acc: no sample lies in rest, -2 s to -1 s"},
        {HEAD "0.1,200\n",
         ACC "}]\nresults: [{of: exit_sped, measured: 1 m/s, uncertainty: 1 m/s}]\n",
         "results: no result is called exit_sped, did you mean \"exit_speed\"?"},
        {HEAD "0.1,200\n",
         ACC "}]\nresults: [{of: exit_speed, measured: 1 kg, uncertainty: 1 m/s}]\n",
         "results: exit_speed: measured: "},
        {HEAD "0.1,200\n",
         ACC "}]\nresults: [{of: exit_speed, measured: 1 m/s, uncertainty: 0 m/s}]\n",
         "results: exit_speed: expected an uncertainty > 0"}};
    ld_model *model = make_model(NULL, 0);
    const char *log = in("wrong.csv");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        ld_fit *fit;
        ld_error error = {0};
        FILE *stream = fopen(in("wrong.csv"), "w");
        fputs(cases[i].log, stream);
        fclose(stream);
        stream = fopen(in("wrong.yaml"), "w");
        fputs(cases[i].sensors, stream);
        fclose(stream);
        log = in("wrong.csv");
        assert_int_equal(ld_fit_create(model, keys, KEYS, NULL, 0, &fit, &error), LD_OK);
        ld_status status = ld_fit_add_logs(fit, &log, NULL, 1, &error);
        status = status ? status : ld_fit_run(fit, NULL, &error);
        if (status != LD_ERR_INPUT || !strstr(error.text, cases[i].message))
            fail_msg("case %zu: \"%s\" has no \"%s\"", i, error.text, cases[i].message);
        assert_null(strchr(error.text, '\n'));
        ld_fit_free(fit);
    }
    ld_model_free(model);
}

// Neither launches nor logs.
static void test_nothing(void **state)
{
    (void)state;
    ld_fit *fit;
    ld_error error;
    ld_model *model = make_model(NULL, 0);
    assert_int_equal(ld_fit_create(model, keys, KEYS, NULL, 0, &fit, &error), LD_OK);
    assert_int_equal(ld_fit_run(fit, NULL, &error), LD_ERR_INPUT);
    assert_string_equal(error.text, "expected a file of measured launches or a log");
    ld_fit_free(fit);
    ld_model_free(model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_exact),       cmocka_unit_test(test_coverage),
        cmocka_unit_test(test_correlation), cmocka_unit_test(test_continues),
        cmocka_unit_test(test_refused),     cmocka_unit_test(test_nothing)};
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
