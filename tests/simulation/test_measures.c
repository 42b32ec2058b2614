// Measures against closed forms, against rows of 2 us of the same run, and against what the summary
// reports otherwise; on the march, in a sequence, with windows that begin and end with the run.
#include "model/model.h"
#include "support/check.h"

#include "launchdyn/simulation.h"
#include "quantities/summary.h"
#include "scenario/scenario.h"

enum { MOST = LD_MAX_MEASURES };

// ---- a run, its measures by a second route

// Integral and largest magnitude by the trapezoid rule on rows, whose windows are those of the
// summary.
typedef struct reference {
    const ld_model *model;
    int t, column[MOST];
    double from[MOST], to[MOST], before[MOST], t_before[MOST], sum[MOST], length[MOST], peak[MOST];
} reference;

static ld_status begin_rows(void *user, const ld_column *columns, size_t count, ld_error *error)
{
    (void)error;
    reference *self = user;
    for (int k = 0; k < self->model->measure_count; k++)
        for (size_t i = 0; i < count; i++)
            if (strcmp(columns[i].name, self->model->measure[k].of) == 0)
                self->column[k] = (int)i;
    return LD_OK;
}

static ld_status take_row(void *user, const double *row, size_t count, ld_error *error)
{
    (void)error, (void)count;
    reference *self = user;
    for (int k = 0; k < self->model->measure_count; k++) {
        double value = row[self->column[k]], h = row[0] - self->t_before[k];
        bool squares = self->model->measure[k].take == LD_TAKE_RMS;
        double now = squares ? value * value : value;
        if (row[0] < self->from[k] - 1e-12 || row[0] > self->to[k] + 1e-12)
            continue;
        if (self->length[k] > 0 || row[0] > self->from[k] + 1e-12) {
            self->sum[k] += h * (now + self->before[k]) / 2;
            self->length[k] += h;
        }
        self->peak[k] = fmax(self->peak[k], fabs(value));
        self->t_before[k] = row[0];
        self->before[k] = now;
    }
    return LD_OK;
}

static double result_of(const reference *self, int k)
{
    double mean = self->sum[k] / self->length[k];
    ld_take take = self->model->measure[k].take;
    return take == LD_TAKE_RMS ? sqrt(mean) : take == LD_TAKE_PEAK ? self->peak[k] : mean;
}

static void read_example(const char *file, const char *const *sets, size_t count, ld_model *model)
{
    char path[256];
    ld_messages messages = {0};
    snprintf(path, sizeof path, "%s/examples/%s", LD_SOURCE_DIR, file);
    if (scenario_read(path, sets, count, model, &messages)) {
        ld_messages_print(&messages, stderr);
        fail_msg("%s", file);
    }
}

static void run_model(const ld_model *model, ld_sink *sink, ld_summary *summary)
{
    ld_simulation *simulation;
    ld_error error;
    if (ld_simulation_create(model, &simulation, &error) ||
        ld_simulation_run(simulation, &(ld_run_options){.sink = sink}, summary, &error))
        fail_msg("%s", error.text);
    ld_simulation_free(simulation);
}

static ld_summary first, second; // of a run without rows, of one with them

// The measure of that name of rocket i.
static double measured(const ld_model *model, int i, const char *name)
{
    for (int k = 0; k < model->measure_count; k++)
        if (strcmp(model->measure[k].name, name) == 0)
            return first.rocket[i].measure[k];
    fail_msg("no measure %s", name);
    return NAN;
}

// ---- tests

// What is a derivative has the mean that follows from what it is the derivative of; t itself has an
// rms of its own, and thrust, linear between its corners, its mean.
static void test_closed_forms(void **state)
{
    (void)state;
    const char *sets[] = {
        "measures=[{name: speed, of: rocket.s_dot, take: mean, from: t_ignition, to: t_rear}, "
        "{name: s_0, of: rocket.s, take: value, at: t_ignition}, "
        "{name: s_1, of: rocket.s, take: value, at: t_rear}, "
        "{name: rate, of: tip.pitch_rate, take: mean, from: t_middle, to: t_rear}, "
        "{name: pitch_0, of: tip.pitch, take: value, at: t_middle}, "
        "{name: pitch_1, of: tip.pitch, take: value, at: t_exit.rear}, "
        "{name: rate_rms, of: tip.pitch_rate, take: rms, from: t_middle, to: t_rear}, "
        "{name: t, of: t, take: rms, from: t_ignition, to: end}, "
        "{name: thrust, of: thrust, take: mean, from: start, to: t_exit.front}, "
        "{name: thrust_peak, of: thrust, take: peak, from: start, to: t_front}, "
        "{name: lock, of: lock.force, take: value, at: t_release}, "
        "{name: loose, of: lock.force, take: peak, from: t_release, to: t_rear}, "
        "{name: loose_mean, of: lock.force, take: mean, from: t_release, to: t_rear}, "
        "{name: off, of: tip_off.pitch_rate, take: value, at: t_rear}]"};
    static ld_model model;
    read_example("fixed.yaml", sets, 1, &model);
    run_model(&model, NULL, &first);
    const ld_rocket_summary *rocket = &first.rocket[0];
    double T = rocket->t_rear, out = T - rocket->t_middle;
    double way = measured(&model, 0, "s_1") - measured(&model, 0, "s_0");
    double turn = measured(&model, 0, "pitch_1") - measured(&model, 0, "pitch_0");
    CHECK_NEAR("mean speed [m/s]", measured(&model, 0, "speed"), way / T, 1e-8);
    CHECK_BELOW("mean tip rate less its angle's change, of its rms",
                (measured(&model, 0, "rate") - turn / out) / measured(&model, 0, "rate_rms"), 1e-5);
    CHECK_NEAR("rms of t [s]", measured(&model, 0, "t"), T / sqrt(3), 1e-15);
    CHECK_NEAR("mean thrust [N]", measured(&model, 0, "thrust"),
               15e3 * (1 - 0.005 / rocket->t_front), 1e-7);
    CHECK_NEAR("peak thrust [N]", measured(&model, 0, "thrust_peak"), 15e3, 0);
    CHECK_NEAR("lock as it lets go [N]", measured(&model, 0, "lock"), 5e3, 1e-6);
    CHECK_NEAR("lock from there on [N]", measured(&model, 0, "loose"), 0, 0);
    CHECK_NEAR("mean of that [N]", measured(&model, 0, "loose_mean"), 0, 0);
    CHECK_NEAR("tip-off rate [rad/s]", measured(&model, 0, "off"), rocket->tip_off.pitch_rate,
               1e-12);
    model_clear(&model);
}

// A base that swings by a sine, over whole periods of it.
static void test_sine(void **state)
{
    (void)state;
    const char *sets[] = {
        "base={kind: prescribed, azimuth: 0 deg, elevation: 30 deg, motion: {heave: [{amplitude: "
        "20 mm, frequency: 25 Hz}]}}",
        "base.motion.heave=[{amplitude: 20 mm, frequency: 25 Hz}]", "run.lead_in=0.4 s",
        "measures=[{name: rms, of: base.y, take: rms, from: start, to: t_ignition}, "
        "{name: mean, of: base.y, take: mean, from: start, to: t_ignition}, "
        "{name: peak, of: base.y, take: peak, from: start, to: t_ignition}]"};
    static ld_model model;
    read_example("fixed.yaml", sets, 4, &model);
    run_model(&model, NULL, &first);
    // the tube's rear end lies off the base's origin by what does not move
    double off = measured(&model, 0, "mean"), a = 0.02;
    CHECK_BELOW("rms of a sine", measured(&model, 0, "rms") / sqrt(a * a / 2 + off * off) - 1,
                1e-6);
    CHECK_BELOW("peak of a sine", measured(&model, 0, "peak") / (fabs(off) + a) - 1, 1e-9);
    model_clear(&model);
}

// Each measure against the rows, of its rms.
static void test_rows(void **state)
{
    (void)state;
    static const char *const columns[] = {"tip.pitch_rate",     "tip.yaw_rate", "rocket.pitch_rate",
                                          "contact.rear.force", "slot.force",   "tip.vy",
                                          "azimuth.angle"};
    enum { COLUMNS = sizeof columns / sizeof *columns };
    static const char *const takes[] = {"rms", "mean", "peak"};
    static ld_model model;
    char text[4096] = "measures=[";
    for (int i = 0; i < 3 * COLUMNS; i++)
        snprintf(text + strlen(text), sizeof text - strlen(text),
                 "%s{name: m%d, of: %s, take: %s, from: t_front, to: t_rear}", i ? ", " : "", i,
                 columns[i / 3], takes[i % 3]);
    strcat(text, "]");
    const char *sets[] = {
        text, "run={lead_in: 0.2 s, end: tip, tolerance: 1e-7, output_step: {tube: 2 us}}"};
    read_example("marching/30-kmh.yaml", sets, 2, &model);
    run_model(&model, NULL, &first);
    reference rows = {.model = &model};
    for (int k = 0; k < model.measure_count; k++) {
        rows.from[k] = first.rocket[0].t_front;
        rows.to[k] = first.rocket[0].t_rear;
    }
    ld_sink sink = {.self = &rows, .begin = begin_rows, .row = take_row};
    run_model(&model, &sink, &second);
    assert_memory_equal(first.rocket, second.rocket, sizeof first.rocket);
    for (int k = 0; k < 3 * COLUMNS; k += 3) {
        double rms = result_of(&rows, k);
        for (int i = 0; i < 3; i++) {
            char what[80];
            snprintf(what, sizeof what, "%s of %s, of its rms", takes[i], columns[k / 3]);
            CHECK_BELOW(what, (first.rocket[0].measure[k + i] - result_of(&rows, k + i)) / rms,
                        5e-6);
        }
    }
    model_clear(&model);
}

// Of a sequence each rocket has its own; the windows from the start and to the end meet where the
// next tube takes the place of the one before, 0.2 s before its firing.
static void test_sequence(void **state)
{
    (void)state;
    const char *sets[] = {
        "firing=[{tube: 8, at: 0 s}, {tube: 9, at: 0.45 s}]", "run={lead_in: 0.1 s, end: 0.3 s}",
        "measures=[{name: begins, of: t, take: value, at: start}, "
        "{name: ends, of: t, take: value, at: end}, "
        "{name: middle, of: t, take: mean, from: start, to: end}, "
        "{name: lit, of: t, take: value, at: t_ignition}, "
        "{name: tip, of: tip.pitch_rate, take: value, at: t_rear}, "
        "{name: thrust, of: thrust, take: mean, from: t_ignition, to: t_rear}, "
        "{name: let_go, of: rocket.s, take: rms, from: t_ignition, to: t_release}]"};
    static const double begins[] = {-0.1, 0.25}, ends[] = {0.25, 0.75}, lit[] = {0, 0.45};
    static ld_model model;
    read_example("fixed.yaml", sets, 3, &model);
    run_model(&model, NULL, &first);
    for (int i = 0; i < 2; i++) {
        CHECK_NEAR("start [s]", measured(&model, i, "begins"), begins[i], 1e-12);
        CHECK_NEAR("end [s]", measured(&model, i, "ends"), ends[i], 1e-12);
        CHECK_NEAR("middle [s]", measured(&model, i, "middle"), (begins[i] + ends[i]) / 2, 1e-12);
        CHECK_NEAR("ignition [s]", measured(&model, i, "lit"), lit[i], 1e-12);
        CHECK_NEAR("tip rate at the exit [rad/s]", measured(&model, i, "tip"),
                   first.rocket[i].tip.pitch_rate, 1e-12);
        CHECK_NEAR("mean thrust [N]", measured(&model, i, "thrust"),
                   15e3 * (1 - 0.005 / first.rocket[i].t_rear), 1e-6);
        CHECK_NEAR("travel on the lock [m]", measured(&model, i, "let_go"), 0.1, 1e-12);
    }
    assert_int_equal(first.note_count, 0);
    model_clear(&model);
}

// Of a window what lies between two times, and how far a column goes from what it was where that
// begins; t is its own measure.
static void test_within(void **state)
{
    (void)state;
    const char *sets[] = {
        "run.end=0.3 s",
        "measures=[{name: mean, of: t, take: mean, from: t_ignition, to: end, within: 10.03 20.01 "
        "ms}, "
        "{name: rms, of: t, take: rms, from: t_ignition, to: t_rear, within: 0 37.77 ms}, "
        "{name: peak, of: t, take: peak, from: t_ignition, to: t_rear, within: 50 60.05 ms}, "
        "{name: change, of: t, take: change, from: t_ignition, to: end, within: 1.11 4.44 ms}, "
        "{name: way, of: rocket.s, take: change, from: t_middle, to: t_rear}, "
        "{name: s_0, of: rocket.s, take: value, at: t_middle}, "
        "{name: s_1, of: rocket.s, take: value, at: t_rear}, "
        "{name: cut, of: t, take: mean, from: t_ignition, to: t_rear, within: 0.1 9 s}, "
        "{name: late, of: t, take: mean, from: t_ignition, to: t_rear, within: 5 6 s}]"};
    static ld_model model;
    read_example("fixed.yaml", sets, 2, &model);
    run_model(&model, NULL, &first);
    double T = first.rocket[0].t_rear;
    CHECK_NEAR("mean of t [s]", measured(&model, 0, "mean"), (10.03e-3 + 20.01e-3) / 2, 1e-15);
    CHECK_NEAR("rms of t [s]", measured(&model, 0, "rms"), 37.77e-3 / sqrt(3), 1e-15);
    CHECK_NEAR("peak of t [s]", measured(&model, 0, "peak"), 60.05e-3, 1e-15);
    CHECK_NEAR("change of t [s]", measured(&model, 0, "change"), 3.33e-3, 1e-15);
    CHECK_NEAR("change of the way [m]", measured(&model, 0, "way"),
               measured(&model, 0, "s_1") - measured(&model, 0, "s_0"), 1e-15);
    CHECK_NEAR("mean of t until the exit [s]", measured(&model, 0, "cut"), (0.1 + T) / 2, 1e-15);
    assert_true(isnan(measured(&model, 0, "late")));
    model_clear(&model);
}

// A body thrown in a vacuum.
static void test_thrown(void **state)
{
    (void)state;
    const char *sets[] = {
        "environment.atmosphere=none", "rocket.motor=", "rocket.empty=",
        "flight={ignition: 0 s, point: center, position: 0 0 0 m, velocity: 50 30 0 m/s}",
        "measures=[{name: up, of: center.vy, take: rms, from: start, to: t_apogee}, "
        "{name: rise, of: center.vy, take: mean, from: start, to: t_apogee}, "
        "{name: lost, of: center.vy, take: change, from: start, to: t_impact}, "
        "{name: top, of: center.y, take: value, at: t_apogee}, "
        "{name: height, of: center.y, take: peak, from: start, to: end}, "
        "{name: at_top, of: t, take: value, at: t_apogee}, "
        "{name: down, of: center.vy, take: value, at: t_impact}, "
        "{name: fall, of: center.vy, take: mean, from: t_apogee, to: t_impact, within: 0 1 s}, "
        "{name: ends, of: t, take: value, at: end}, "
        "{name: burnt, of: t, take: value, at: t_burnout}]"};
    static ld_model model;
    const double g = 9.80665, v = 30;
    read_example("flight.yaml", sets, 5, &model);
    run_model(&model, NULL, &first);
    CHECK_NEAR("rms of a speed [m/s]", measured(&model, 0, "up"), v / sqrt(3), 1e-9);
    CHECK_NEAR("mean speed [m/s]", measured(&model, 0, "rise"), v / 2, 1e-9);
    CHECK_NEAR("speed lost [m/s]", measured(&model, 0, "lost"), 2 * v, 1e-9);
    CHECK_NEAR("apogee [m]", measured(&model, 0, "top"), v * v / (2 * g), 1e-9);
    CHECK_NEAR("greatest height [m]", measured(&model, 0, "height"), v * v / (2 * g), 1e-9);
    CHECK_NEAR("time of the apogee [s]", measured(&model, 0, "at_top"), v / g, 1e-9);
    CHECK_NEAR("speed at the impact [m/s]", measured(&model, 0, "down"), -v, 1e-9);
    CHECK_NEAR("speed in the first second [m/s]", measured(&model, 0, "fall"), -g / 2, 1e-9);
    CHECK_NEAR("end [s]", measured(&model, 0, "ends"), first.rocket[0].flight.t_impact, 1e-12);
    assert_true(isnan(measured(&model, 0, "burnt")));
    model_clear(&model);
}

// The flights' rows; those of the launch are passed over.
static ld_status begin_launch(void *user, const ld_column *columns, size_t count, ld_error *error)
{
    (void)user, (void)columns, (void)count, (void)error;
    return LD_OK;
}

static bool flying;

static ld_status begin_flight(void *user, int rocket, const ld_column *columns, size_t count,
                              ld_error *error)
{
    (void)rocket;
    flying = true;
    return begin_rows(user, columns, count, error);
}

static ld_status take_flight_row(void *user, const double *row, size_t count, ld_error *error)
{
    return flying ? take_row(user, row, count, error) : LD_OK;
}

// Rates, Mach number and thrust of a flight against its rows of 1 ms, of their rms.
static void test_flight_rows(void **state)
{
    (void)state;
    static const char *const columns[] = {"rocket.pitch_rate", "rocket.yaw_rate", "mach",
                                          "angle_of_attack", "thrust"};
    static const char *const takes[] = {"rms", "mean", "peak"};
    static ld_model model;
    char text[4096] = "measures=[{name: burnt, of: t, take: value, at: t_burnout}, "
                      "{name: top, of: t, take: value, at: t_apogee}";
    for (int i = 0; i < 15; i++)
        snprintf(text + strlen(text), sizeof text - strlen(text),
                 ", {name: m%d, of: %s, take: %s, from: %s, to: %s}", i, columns[i / 3],
                 takes[i % 3], i < 6 ? "t_burnout" : "t_rear", i < 9 ? "t_apogee" : "t_burnout");
    strcat(text, "]");
    const char *sets[] = {text, "run={end: landing, output_step: {flight: 1 ms}}"};
    read_example("fixed.yaml", sets, 2, &model);
    run_model(&model, NULL, &first);
    CHECK_NEAR("burnout [s]", first.rocket[0].measure[0], 2.55, 1e-12);
    reference rows = {.model = &model};
    for (int k = 2; k < model.measure_count; k++) {
        rows.from[k] = k < 8 ? 2.55 : first.rocket[0].t_rear;
        rows.to[k] = k < 11 ? first.rocket[0].measure[1] : 2.55;
    }
    ld_sink sink = {
        .self = &rows, .begin = begin_launch, .row = take_flight_row, .flight = begin_flight};
    flying = false;
    run_model(&model, &sink, &second);
    for (int k = 2; k < model.measure_count; k++) {
        double rms = result_of(&rows, 2 + (k - 2) / 3 * 3);
        char what[80];
        snprintf(what, sizeof what, "%s of %s, of its rms", takes[(k - 2) % 3],
                 columns[(k - 2) / 3]);
        CHECK_BELOW(what, (first.rocket[0].measure[k] - result_of(&rows, k)) / rms,
                    k == 12 ? 2e-4 : 2e-5);
    }
    model_clear(&model);
}

// ---- expressions

static const struct {
    const char *in_full, *expression; // of a measure, and the same in words
} same[] = {
    {"of: contact.rear.force, take: peak, from: t_front, to: t_rear",
     "peak(contact.rear.force from t_front to t_rear)"},
    {"of: tip.y, take: change, from: t_release, to: t_rear",
     "change(tip.y from t_release to t_rear)"},
    {"of: tip.pitch_rate, take: rms, from: t_ignition, to: t_rear", "rms(tip.pitch_rate)"},
    {"of: thrust, take: mean, from: start, to: t_exit.front",
     "mean(thrust from start to t_exit.front)"},
    {"of: tip.y, take: least, from: t_ignition, to: t_rear", "-largest(-tip.y)"},
    {"of: tip.z, take: largest, from: t_ignition, to: t_rear", "-least(-tip.z)"},
    {"of: tip.y, take: peak, from: t_ignition, to: t_rear", "max(largest(tip.y), -least(tip.y))"},
    {"of: tip.y, take: peak, from: t_ignition, to: t_rear", "largest(abs(tip.y))"},
    {"of: tip.y, take: value, at: t_release", "tip.y at t_release"},
    {"of: mach, take: peak, from: t_rear, to: t_impact", "peak(mach from t_rear to t_impact)"},
    {"of: altitude, take: value, at: t_burnout", "altitude at t_burnout"},
};
enum { SAME = sizeof same / sizeof *same };

// The figures of an expression are those of a measure, to the bit; results are those of the
// summary.
static void test_expressions(void **state)
{
    (void)state;
    static ld_model model;
    char text[6000] = "measures={";
    for (int i = 0; i < SAME; i++)
        snprintf(text + strlen(text), sizeof text - strlen(text), "a%d: {%s}, b%d: \"%s\", ", i,
                 same[i].in_full, i, same[i].expression);
    strcat(text, "off: \"hypot(yaw_rate, pitch_rate)\", twice: 2 * measure.off, "
                 "far: sqrt(downrange^2 + drift^2), fast: (exit_speed > 37 m/s) + (apogee < 0), "
                 "path: (rocket.s at t_rear) - (rocket.s at t_ignition)}");
    const char *sets[] = {text, "run.end=landing"};
    read_example("fixed.yaml", sets, 2, &model);
    run_model(&model, NULL, &first);
    const ld_rocket_summary *rocket = &first.rocket[0];
    for (int i = 0; i < SAME; i++) {
        const double full = rocket->measure[2 * i], expressed = rocket->measure[2 * i + 1];
        if (!(full == expressed && full != 0))
            fail_msg("%s: %.17g, %s: %.17g", same[i].in_full, full, same[i].expression, expressed);
        assert_string_equal(model.measure[2 * i + 1].unit, i == 0   ? "N"
                                                           : i == 2 ? "rad/s"
                                                           : i == 3 ? "N"
                                                           : i == 9 ? ""
                                                                    : "m");
    }
    double off = sqrt(pow(rocket->yaw_rate, 2) + pow(rocket->pitch_rate, 2));
    CHECK_NEAR("rate off the axis [rad/s]", measured(&model, 0, "off"), off, 1e-16);
    CHECK_NEAR("twice that [rad/s]", measured(&model, 0, "twice"), 2 * off, 2e-16);
    CHECK_NEAR("range [m]", measured(&model, 0, "far"), rocket->flight.range, 1e-11);
    CHECK_NEAR("comparisons", measured(&model, 0, "fast"), rocket->exit_speed > 37, 0);
    CHECK_NEAR("path in the tube [m]", measured(&model, 0, "path"), 2.9, 0.5);
    assert_int_equal(first.note_count, 0);
    model_clear(&model);
}

// Of a body thrown in a vacuum kinetic and potential energy sum to the same all the way, and its
// speed is least at the top; of a sequence each rocket has its own.
static void test_expressions_closed(void **state)
{
    (void)state;
    const char *thrown[] = {
        "environment.atmosphere=none", "rocket.motor=", "rocket.empty=",
        "flight={ignition: 0 s, point: center, position: 0 0 0 m, velocity: 50 30 0 m/s}",
        "measures={mean: mean(center.vy^2 / 2 + 9.80665 m/s2 * center.y), slow: "
        "'least(hypot(center.vx, center.vy) from start to t_impact)', fall: '(t at end) - (t at "
        "t_apogee)', rise: least(center.vy) / 1 m/s, steep: 'largest(atan2(center.vy, "
        "center.vx))'}"};
    const char *sequence[] = {
        "firing=[{tube: 8, at: 0 s}, {tube: 9, at: 0.45 s}]", "run={lead_in: 0.1 s, end: 0.3 s}",
        ("measures={lasts: (t at end) - (t at start), mean: mean(t), moved: largest(rocket.s "
         "from t_release to t_rear) - rocket.s at t_ignition}")};
    static ld_model model;
    read_example("flight.yaml", thrown, 5, &model);
    run_model(&model, NULL, &first);
    CHECK_NEAR("energy over mass [m2/s2]", measured(&model, 0, "mean"), 450, 1e-12);
    CHECK_NEAR("least speed [m/s]", measured(&model, 0, "slow"), 50, 1e-9);
    CHECK_NEAR("fall [s]", measured(&model, 0, "fall"), 30 / 9.80665, 1e-14);
    CHECK_NEAR("least rate of climb", measured(&model, 0, "rise"), -30, 1e-9);
    CHECK_NEAR("steepest [rad]", measured(&model, 0, "steep"), atan2(30, 50), 1e-12);
    model_clear(&model);
    read_example("fixed.yaml", sequence, 3, &model);
    run_model(&model, NULL, &first);
    CHECK_NEAR("first in its tube [s]", measured(&model, 0, "lasts"), 0.35, 1e-12);
    CHECK_NEAR("second in its tube [s]", measured(&model, 1, "lasts"), 0.5, 1e-12);
    CHECK_NEAR("mean t until the exit [s]", measured(&model, 0, "mean"), first.rocket[0].t_rear / 2,
               1e-15);
    CHECK_NEAR("path less that of the first [m]", measured(&model, 1, "moved"),
               measured(&model, 0, "moved"), 1e-3);
    model_clear(&model);
}

// What is asked for changes nothing else, and a window that does not come gives a warning.
static void test_nothing_else(void **state)
{
    (void)state;
    const char *sets[] = {
        "run.end=0.1 s",
        "measures=[{name: late, of: tip.pitch, take: rms, from: t_front, to: t_rear}, "
        "{name: soon, of: tip.pitch, take: rms, from: t_ignition, to: t_front}]"};
    static ld_model model;
    read_example("fixed.yaml", sets, 2, &model);
    run_model(&model, NULL, &first);
    assert_true(isnan(measured(&model, 0, "late")));
    assert_true(measured(&model, 0, "soon") > 0);
    assert_int_equal(first.note_count, 1);
    assert_string_equal(first.note[0], "measure.late of tube 8 has no value: its window did not "
                                       "occur, or tip.pitch is missing in a part of it");
    model_clear(&model);
    const char *missing[] = {sets[0], "measures={soon: tip.y at t_front, off: 2 * yaw_rate}"};
    read_example("fixed.yaml", missing, 2, &model);
    run_model(&model, NULL, &first);
    assert_true(isnan(measured(&model, 0, "off")) && !isnan(measured(&model, 0, "soon")));
    assert_string_equal(first.note[0], "measure.off of tube 8 has no value: a result in it is "
                                       "missing, or it is not defined");
    model_clear(&model);
    read_example("fixed.yaml", sets, 1, &model);
    run_model(&model, NULL, &second);
    assert_memory_equal(&first.energy, &second.energy, sizeof first.energy);
    assert_int_equal(first.statistics.steps, second.statistics.steps);
    assert_int_equal(first.statistics.rhs_evaluations, second.statistics.rhs_evaluations);
    model_clear(&model);
}

// A model filled by hand is held to the same.
static void test_by_hand(void **state)
{
    (void)state;
    static ld_model model;
    ld_simulation *simulation = NULL;
    ld_error error;
    read_example("fixed.yaml", NULL, 0, &model);
    model.measure_count = 1;
    model.measure[0] = (ld_measure){.name = "x", .of = "tip.pich", .from = "t_rear"};
    assert_int_equal(ld_simulation_create(&model, &simulation, &error), LD_ERR_INPUT);
    assert_string_equal(error.text, "measures.1.of: found \"tip.pich\", which is not a column of "
                                    "the launch; did you mean \"tip.pitch\"?");
    model_clear(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_closed_forms),
        cmocka_unit_test(test_sine),
        cmocka_unit_test(test_rows),
        cmocka_unit_test(test_sequence),
        cmocka_unit_test(test_nothing_else),
        cmocka_unit_test(test_by_hand),
        cmocka_unit_test(test_within),
        cmocka_unit_test(test_thrown),
        cmocka_unit_test(test_flight_rows),
        cmocka_unit_test(test_expressions),
        cmocka_unit_test(test_expressions_closed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
