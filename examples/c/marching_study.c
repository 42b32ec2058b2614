// The study of docs/marching.md: every scenario on several roads (seeds 1, 2, ..), figures of each
// run, and tables of their mean and standard deviation over the roads; of the last scenario against
// the others differences and ratios with intervals of 95 %.
//
//     marching_study SEEDS SCENARIO.yaml... [PATH=VALUE...]
#include <launchdyn/history.h>
#include <launchdyn/scenario.h>
#include <launchdyn/simulation.h>
#include <launchdyn/summary.h>

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { THREADS = 2, MOST_SCENARIOS = 8, MOST_SETS = 16 };

static const double pi = 3.141592653589793;

// ---- columns that the figures are made of ----

enum {
    T,
    TIP_VY,
    TIP_PITCH_RATE,
    TIP_YAW_RATE,
    TIP_Y_I,
    TIP_Z_I,
    TIP_PITCH_RATE_I,
    TIP_YAW_RATE_I,
    PSI,
    THETA,
    GAMMA,
    PITCH,
    YAW,
    CHASSIS_Y,
    CHASSIS_PITCH,
    CHASSIS_YAW,
    CHASSIS_ROLL,
    PITCH_ERROR,
    YAW_ERROR,
    PITCH_TORQUE,
    FORCE_REAR,
    FORCE_MIDDLE,
    FORCE_FRONT,
    COLUMNS
};

static const char *const column_name[COLUMNS] = {
    [T] = "t",
    [TIP_VY] = "tip.vy",
    [TIP_PITCH_RATE] = "tip.pitch_rate",
    [TIP_YAW_RATE] = "tip.yaw_rate",
    [TIP_Y_I] = "tip.inertial_y",
    [TIP_Z_I] = "tip.inertial_z",
    [TIP_PITCH_RATE_I] = "tip.inertial_pitch_rate",
    [TIP_YAW_RATE_I] = "tip.inertial_yaw_rate",
    [PSI] = "rocket.psi",
    [THETA] = "rocket.theta",
    [GAMMA] = "rocket.gamma",
    [PITCH] = "rocket.pitch",
    [YAW] = "rocket.yaw",
    [CHASSIS_Y] = "chassis.y",
    [CHASSIS_PITCH] = "chassis.pitch",
    [CHASSIS_YAW] = "chassis.yaw",
    [CHASSIS_ROLL] = "chassis.roll",
    [PITCH_ERROR] = "elevation.error",
    [YAW_ERROR] = "azimuth.error",
    [PITCH_TORQUE] = "elevation.torque",
    [FORCE_REAR] = "contact.rear.force",
    [FORCE_MIDDLE] = "contact.middle.force",
    [FORCE_FRONT] = "contact.front.force",
};

// The columns of one run.
typedef struct record {
    size_t rows;
    const double *value[COLUMNS];
    double t_ignition;
} record;

static ld_status take_columns(record *run, const ld_history *history, ld_error *error)
{
    for (int i = 0; i < COLUMNS; i++) {
        run->value[i] = ld_history_column(history, column_name[i], &run->rows);
        if (!run->value[i])
            return ld_fail(error, LD_ERR_INPUT, "no column %s", column_name[i]);
    }
    return LD_OK;
}

// From ignition.
static double time_of(const record *run, size_t i)
{
    return run->value[T][i] - run->t_ignition;
}

// The last row not later than t.
static size_t row_at(const record *run, double t)
{
    size_t low = 0, high = run->rows;
    while (high - low > 1) {
        size_t middle = (low + high) / 2;
        *(time_of(run, middle) <= t + 1e-9 ? &low : &high) = middle;
    }
    return low;
}

static double at(const record *run, int column, double t)
{
    return run->value[column][row_at(run, t)];
}

// Linear between rows.
static double between(const record *run, int column, double t)
{
    size_t i = row_at(run, t);
    const double *y = run->value[column], last = time_of(run, i);
    if (i + 1 >= run->rows || time_of(run, i + 1) <= last)
        return y[i];
    return y[i] + (y[i + 1] - y[i]) * (t - last) / (time_of(run, i + 1) - last);
}

static double mean_of(const record *run, int column, double from, double to)
{
    double sum = 0;
    size_t first = row_at(run, from), last = row_at(run, to);
    for (size_t i = first; i <= last; i++)
        sum += run->value[column][i];
    return sum / (double)(last - first + 1);
}

// Root mean square of a column about `about`.
static double rms_about(const record *run, int column, double from, double to, double about)
{
    double sum = 0;
    size_t first = row_at(run, from), last = row_at(run, to);
    for (size_t i = first; i <= last; i++) {
        double v = run->value[column][i] - about;
        sum += v * v;
    }
    return sqrt(sum / (double)(last - first + 1));
}

// About its mean.
static double rms(const record *run, int column, double from, double to)
{
    return rms_about(run, column, from, to, mean_of(run, column, from, to));
}

// Farthest from `about`.
static double farthest(const record *run, int column, double from, double to, double about)
{
    double most = 0;
    for (size_t i = row_at(run, from), last = row_at(run, to); i <= last; i++)
        most = fmax(most, fabs(run->value[column][i] - about));
    return most;
}

// ---- the tip after the rocket has left: equal steps, spectra ----

// 2 kHz from the exit on.
enum { AFTER = 3000, STEPS_A_SECOND = 2000 };
// Signals: tip against the platform, tip in I.
enum { REL_VY, REL_PITCH, IN_VY, IN_VZ, IN_PITCH, IN_YAW, SIGNALS };
// Spectrum of the last second, lines of 1 Hz.
enum { LINES = 600, FIRST_OF_SPECTRUM = AFTER - STEPS_A_SECOND };

static const char *const signal_name[SIGNALS] = {
    [REL_VY] = "tip against platform, vertical velocity",
    [REL_PITCH] = "tip against platform, pitch rate",
    [IN_VY] = "tip in I, vertical velocity",
    [IN_VZ] = "tip in I, sideways velocity",
    [IN_PITCH] = "tip in I, pitch rate",
    [IN_YAW] = "tip in I, yaw rate",
};

typedef struct after_exit {
    double value[SIGNALS][AFTER];
} after_exit;

static void sample_after_exit(const record *run, double t_rear, after_exit *after)
{
    const double h = 1.0 / STEPS_A_SECOND;
    for (int i = 0; i < AFTER; i++) {
        double t = t_rear + (i + 1) * h;
        after->value[REL_VY][i] = between(run, TIP_VY, t);
        after->value[REL_PITCH][i] = between(run, TIP_PITCH_RATE, t);
        after->value[IN_PITCH][i] = between(run, TIP_PITCH_RATE_I, t);
        after->value[IN_YAW][i] = between(run, TIP_YAW_RATE_I, t);
        // positions in I to velocities by central differences
        after->value[IN_VY][i] =
            (between(run, TIP_Y_I, t + h / 2) - between(run, TIP_Y_I, t - h / 2)) / h;
        after->value[IN_VZ][i] =
            (between(run, TIP_Z_I, t + h / 2) - between(run, TIP_Z_I, t - h / 2)) / h;
    }
}

// Root mean square over a stretch of steps.
static double rms_of(const double *v, int first, int last)
{
    double sum = 0;
    for (int i = first; i < last; i++)
        sum += v[i] * v[i];
    return sqrt(sum / (last - first));
}

// One-sided power of the last second by lines of 1 Hz, under a Hann window: their sum is the mean
// square.
static void spectrum(const double *v, double power[LINES])
{
    enum { N = STEPS_A_SECOND };
    double cosine[N], windowed[N], mean = 0;
    for (int i = 0; i < N; i++) {
        cosine[i] = cos(2 * pi * i / N);
        mean += v[FIRST_OF_SPECTRUM + i] / N;
    }
    for (int i = 0; i < N; i++)
        windowed[i] = (v[FIRST_OF_SPECTRUM + i] - mean) * (1 - cosine[i]);
    for (int k = 0; k < LINES; k++) {
        double real = 0, imaginary = 0;
        for (int i = 0; i < N; i++) {
            real += windowed[i] * cosine[(long)k * i % N];
            imaginary += windowed[i] * cosine[((long)k * i + N / 4) % N];
        }
        // the window's mean square is 1.5
        power[k] = (k ? 2 : 1) * (real * real + imaginary * imaginary) / (1.5 * N * N);
    }
}

// ---- the figures of a run ----

enum { MOST_MEASURES = 96 };

// A line of the table: what is measured, in which unit, times which factor.
typedef struct line {
    char text[96];
    const char *unit;
    double factor;
} line;

// What the runs of one scenario gave.
typedef struct result {
    int count;
    line line[MOST_MEASURES];
    double value[MOST_MEASURES];
    double power[SIGNALS][LINES];
    char problem[LD_ERROR_TEXT]; // "" if there is none
} result;

static void put(result *out, const char *text, const char *unit, double factor, double value)
{
    line *to = &out->line[out->count];
    snprintf(to->text, sizeof to->text, "%s", text);
    to->unit = unit;
    to->factor = factor;
    out->value[out->count++] = value;
}

// A heading within the table.
static void put_heading(result *out, const char *text)
{
    put(out, text, NULL, 0, 0);
}

static void measure_after_exit(const record *run, double t_rear, result *out)
{
    static const struct {
        const char *text;
        double from, to;
    } stretch[] = {{"0 to 0.1 s", 0, 0.1}, {"0.1 to 0.5 s", 0.1, 0.5}, {"0.5 to 1.5 s", 0.5, 1.5}};
    after_exit *after = malloc(sizeof *after);
    char text[96];
    put_heading(out, "(a) after the exit, root mean square");
    if (!after)
        return;
    sample_after_exit(run, t_rear, after);
    for (int i = 0; i < SIGNALS; i++) {
        bool speed = i == REL_VY || i == IN_VY || i == IN_VZ;
        for (int j = 0; j < 3; j++) {
            snprintf(text, sizeof text, "%s, %s", signal_name[i], stretch[j].text);
            put(out, text, speed ? "mm/s" : "mrad/s", 1e3,
                rms_of(after->value[i], (int)(stretch[j].from * STEPS_A_SECOND),
                       (int)(stretch[j].to * STEPS_A_SECOND)));
        }
        spectrum(after->value[i], out->power[i]);
    }
    free(after);
}

// Change of the tip's rates within 2 ms of an instant, against their size in the 2 ms before; the
// same within 15 ms; the peaks of the forces within 15 ms.
static void measure_jump(const record *run, const char *instant, double t, result *out)
{
    const double soon = 2e-3, later = 15e-3, tiny = 1e-6;
    static const struct {
        int column;
        const char *name;
    } rate[] = {{TIP_PITCH_RATE, "pitch rate"}, {TIP_YAW_RATE, "yaw rate"}},
      force[] = {{FORCE_REAR, "rear"}, {FORCE_MIDDLE, "middle"}, {FORCE_FRONT, "front"}};
    char text[96];
    for (int i = 0; i < 2; i++) {
        double before = at(run, rate[i].column, t);
        snprintf(text, sizeof text, "%s: %s, rms over 2 ms before", instant, rate[i].name);
        put(out, text, "mrad/s", 1e3, rms_about(run, rate[i].column, t - soon, t - tiny, 0));
        snprintf(text, sizeof text, "%s: %s, change within 2 ms", instant, rate[i].name);
        put(out, text, "mrad/s", 1e3, farthest(run, rate[i].column, t, t + soon, before));
        snprintf(text, sizeof text, "%s: %s, change within 15 ms", instant, rate[i].name);
        put(out, text, "mrad/s", 1e3, farthest(run, rate[i].column, t, t + later, before));
    }
    for (int i = 0; i < 3; i++) {
        snprintf(text, sizeof text, "%s: force %s, before", instant, force[i].name);
        put(out, text, "N", 1, at(run, force[i].column, t - 1e-4));
        snprintf(text, sizeof text, "%s: force %s, peak within 15 ms after", instant,
                 force[i].name);
        put(out, text, "N", 1, farthest(run, force[i].column, t + 2e-4, t + later, 0));
    }
}

// A result of the first rocket.
static double number(const ld_summary *summary, const char *name)
{
    char path[64];
    double value;
    snprintf(path, sizeof path, "rocket.1.%s", name);
    ld_summary_number(summary, path, &value, NULL);
    return value;
}

static void measure_jumps(const record *run, const ld_summary *rocket, result *out)
{
    put_heading(out, "(b) the three jumps");
    measure_jump(run, "release", number(rocket, "t_release"), out);
    measure_jump(run, "front out", number(rocket, "t_front"), out);
    measure_jump(run, "middle out", number(rocket, "t_middle"), out);
}

enum { ANGLES = 4 };

static const struct {
    const char *name;
    int column;
} angle[ANGLES] = {
    {"relative pitch", PSI}, {"relative yaw", THETA}, {"pitch in I", PITCH}, {"yaw in I", YAW}};

static void measure_rocket(const record *run, const ld_summary *rocket, result *out)
{
    put_heading(out, "(c) travel and spin");
    put(out, "time in the tube", "ms", 1e3, number(rocket, "t_rear"));
    put(out, "muzzle speed", "m/s", 1, number(rocket, "muzzle_speed"));
    put(out, "spin rate at exit", "rad/s", 1, number(rocket, "spin_rate"));
    put(out, "roll at exit", "deg", 180 / pi, number(rocket, "relative.gamma"));
    put_heading(out, "(d) pitch and yaw");
    const struct {
        const char *name;
        double t;
    } instant[] = {{"release", number(rocket, "t_release")},
                   {"front out", number(rocket, "t_front")},
                   {"middle out", number(rocket, "t_middle")},
                   {"rear out", number(rocket, "t_rear") - 1e-6}};
    char text[96];
    for (int i = 0; i < ANGLES; i++)
        for (int j = 0; j < 4; j++) {
            snprintf(text, sizeof text, "%s, %s", angle[i].name, instant[j].name);
            put(out, text, "mrad", 1e3, at(run, angle[i].column, instant[j].t));
        }
    put(out, "pitch rate in I, rear out", "mrad/s", 1e3, number(rocket, "pitch_rate"));
    put(out, "yaw rate in I, rear out", "mrad/s", 1e3, number(rocket, "yaw_rate"));
}

// Largest values from before the ramp of examples/marching/ramp.yaml on.
static void measure_stabilisers(const record *run, result *out)
{
    const double from = -2, from_largest = -2.6;
    put_heading(out, "(e) stabilisers, 2 s before ignition (largest: 2.6 s)");
    put(out, "chassis height, rms", "mm", 1e3, rms(run, CHASSIS_Y, from, 0));
    put(out, "chassis pitch, rms", "mrad", 1e3, rms(run, CHASSIS_PITCH, from, 0));
    put(out, "platform's pitch error, rms", "mrad", 1e3, rms_about(run, PITCH_ERROR, from, 0, 0));
    put(out, "platform's pitch error, rms from 2 to 0.6 s before", "mrad", 1e3,
        rms_about(run, PITCH_ERROR, from, -0.6, 0));
    put(out, "platform's pitch error, largest", "mrad", 1e3,
        farthest(run, PITCH_ERROR, from_largest, 0, 0));
    put(out, "platform's pitch error at ignition", "mrad", 1e3, at(run, PITCH_ERROR, 0));
    put(out, "chassis roll, rms", "mrad", 1e3, rms(run, CHASSIS_ROLL, from, 0));
    put(out, "chassis yaw, rms", "mrad", 1e3, rms(run, CHASSIS_YAW, from, 0));
    put(out, "platform's yaw error, rms", "mrad", 1e3, rms_about(run, YAW_ERROR, from, 0, 0));
    put(out, "platform's yaw error, largest", "mrad", 1e3,
        farthest(run, YAW_ERROR, from_largest, 0, 0));
    put(out, "elevation torque, largest", "kN m", 1e-3,
        farthest(run, PITCH_TORQUE, from_largest, 0, 0));
}

// ---- the runs ----

typedef struct study {
    int seeds, scenarios, sets;
    const char *scenario[MOST_SCENARIOS];
    const char *set[MOST_SETS];
    result *result; // [scenarios][seeds]
    atomic_int next;
} study;

static ld_status run_model(const ld_model *model, result *out, ld_error *error)
{
    ld_simulation *simulation = NULL;
    ld_summary *summary = ld_summary_new();
    ld_history *history = ld_history_new(NULL);
    ld_run_options options = {.sink = ld_history_sink(history)};
    record kept;
    ld_status status = ld_model_number(model, "firing.1.at", &kept.t_ignition, error);
    if (!status)
        status = ld_simulation_create(model, &simulation, error);
    if (!status)
        status = ld_simulation_run(simulation, &options, summary, error);
    if (!status)
        status = take_columns(&kept, history, error);
    if (!status) {
        measure_after_exit(&kept, number(summary, "t_rear"), out);
        measure_jumps(&kept, summary, out);
        measure_rocket(&kept, summary, out);
        measure_stabilisers(&kept, out);
    }
    ld_simulation_free(simulation);
    ld_summary_free(summary);
    ld_history_free(history);
    return status;
}

// One scenario on one road.
static void run_one(const study *self, int scenario, int seed)
{
    result *out = &self->result[scenario * self->seeds + seed];
    const char *set[MOST_SETS + 4];
    char seed_text[48];
    int sets = self->sets;
    snprintf(seed_text, sizeof seed_text, "base.road.seed=%d", seed + 1);
    memcpy(set, self->set, sizeof self->set);
    set[sets++] = seed_text;
    set[sets++] = "run.end=1.7 s";
    set[sets++] = "run.output_step={lead_in: 5 ms, tube: 0.1 ms}";
    ld_model *model;
    ld_messages messages = {0};
    ld_error error = {0};
    if (ld_scenario_read(self->scenario[scenario], set, (size_t)sets, &model, &messages)) {
        ld_messages_print(&messages, stderr);
        ld_messages_free(&messages);
        snprintf(out->problem, sizeof out->problem, "cannot read it");
        return;
    }
    if (run_model(model, out, &error))
        snprintf(out->problem, sizeof out->problem, "%.*s", LD_ERROR_TEXT - 1, error.text);
    ld_model_free(model);
}

static void *work(void *self_)
{
    study *self = self_;
    int i, count = self->scenarios * self->seeds;
    while ((i = atomic_fetch_add(&self->next, 1)) < count)
        run_one(self, i / self->seeds, i % self->seeds);
    return NULL;
}

// ---- what the roads together say: numbers with intervals of 95 % ----

enum { MOST_ROADS = 1000 };

// What is taken of the roads' values: their mean, the root of it (of powers), their deviation.
typedef enum of_roads { MEAN, ROOT_OF_MEAN, DEVIATION } of_roads;

typedef struct interval {
    double value, low, high;
} interval;

// Student's t at 97.5 %, by its expansion about the normal quantile: to 3e-3 from 10 degrees of
// freedom on, to 2e-5 from 50 on.
static double student(int freedom)
{
    const double z = 1.959964, z3 = z * z * z, n = freedom;
    return z + (z3 + z) / (4 * n) + (5 * z3 * z * z + 16 * z3 + 3 * z) / (96 * n * n);
}

// Of all roads but one (-1: of all).
static double taken(of_roads kind, const double *x, int count, int left_out)
{
    double mean = 0, square = 0;
    int n = left_out < 0 ? count : count - 1;
    for (int i = 0; i < count; i++)
        mean += i == left_out ? 0 : x[i] / n;
    for (int i = 0; i < count; i++)
        square += i == left_out ? 0 : (x[i] - mean) * (x[i] - mean);
    return kind == MEAN ? mean : sqrt(kind == ROOT_OF_MEAN ? mean : square / (n - 1));
}

// How many times as large y's is as x's, road by road the same roads. Jackknife over the roads of
// the ratio's logarithm, for neither normal values nor independence of x and y is given (R. G.
// Miller, "Jackknifing variances", Ann. Math. Statist. 39, 1968).
static interval ratio(of_roads kind, const double *x, const double *y, int count)
{
    double without[MOST_ROADS], mean = 0, square = 0;
    for (int i = 0; i < count; i++) {
        without[i] = log(taken(kind, y, count, i) / taken(kind, x, count, i));
        mean += without[i] / count;
    }
    for (int i = 0; i < count; i++)
        square += (without[i] - mean) * (without[i] - mean);
    double error = sqrt(square * (count - 1) / count), half = student(count - 1) * error;
    double all = taken(kind, y, count, -1) / taken(kind, x, count, -1);
    return (interval){all, all * exp(-half), all * exp(half)};
}

// "-" where there is none: nothing scatters, or means of values of both signs.
static void print_ratio(of_roads kind, const double *x, const double *y, int count)
{
    interval r = ratio(kind, x, y, count);
    bool sign = x[0] > 0, ratios = r.value > 0 && r.high < INFINITY;
    for (int i = 0; i < count && kind == MEAN; i++)
        ratios = ratios && (x[i] > 0) == sign && (y[i] > 0) == sign;
    if (ratios)
        printf(" x %.3g (%.3g to %.3g) |", r.value, r.low, r.high);
    else
        printf(" - |");
}

// ---- tables ----

static void gather(const study *self, int scenario, int measure, double values[MOST_ROADS])
{
    const result *of = &self->result[scenario * self->seeds];
    for (int i = 0; i < self->seeds; i++)
        values[i] = of[i].value[measure] * of->line[measure].factor;
}

// Its file's name without the ending.
static void print_name(const study *self, int scenario)
{
    const char *slash = strrchr(self->scenario[scenario], '/');
    const char *name = slash ? slash + 1 : self->scenario[scenario];
    printf("%.*s", (int)strcspn(name, "."), name);
}

// The last scenario against the one before.
static void print_against(const study *self, const char *what)
{
    printf(" %s, ", what);
    print_name(self, self->scenarios - 1);
    printf(" against ");
    print_name(self, self->scenarios - 2);
    printf(" |");
}

static void print_head(const study *self, const char *first)
{
    printf("\n| %s |", first);
    for (int s = 0; s < self->scenarios; s++) {
        printf(" ");
        print_name(self, s);
        printf(" |");
    }
}

static void print_rule(int columns)
{
    printf("\n|");
    for (int i = 0; i < columns; i++)
        printf(" --- |");
    printf("\n");
}

static void print_head_of_measures(const study *self, const char *first)
{
    bool several = self->scenarios > 1;
    print_head(self, first);
    if (several) {
        printf(" mean, ");
        print_name(self, self->scenarios - 1);
        printf(" less ");
        print_name(self, 0);
        printf(" |");
        print_against(self, "mean");
        print_against(self, "deviation");
    }
    print_rule(1 + self->scenarios + 3 * several);
}

// Mean and standard deviation over the roads.
static void print_value(const study *self, const double *x)
{
    printf(" %.5g ± %.2g |", taken(MEAN, x, self->seeds, -1), taken(DEVIATION, x, self->seeds, -1));
}

// The mean of the differences, road by road, and half its interval.
static void print_difference(const double *x, const double *y, int count)
{
    double difference[MOST_ROADS];
    for (int i = 0; i < count; i++)
        difference[i] = y[i] - x[i];
    printf(" %.3g ± %.2g |", taken(MEAN, difference, count, -1),
           student(count - 1) * taken(DEVIATION, difference, count, -1) / sqrt(count));
}

static void print_measures(const study *self)
{
    double first[MOST_ROADS], before[MOST_ROADS], last[MOST_ROADS] = {0};
    for (int i = 0; i < self->result->count; i++) {
        const line *of = &self->result->line[i];
        if (!of->unit) {
            print_head_of_measures(self, of->text);
            continue;
        }
        printf("| %s [%s] |", of->text, of->unit);
        for (int s = 0; s < self->scenarios; s++) {
            memcpy(before, last, sizeof before);
            gather(self, s, i, last);
            print_value(self, last);
        }
        if (self->scenarios > 1) {
            gather(self, 0, i, first);
            print_difference(first, last, self->seeds);
            print_ratio(MEAN, before, last, self->seeds);
            print_ratio(DEVIATION, before, last, self->seeds);
        }
        printf("\n");
    }
}

static int find(const study *self, const char *text)
{
    int i = 0;
    while (i < self->result->count && strcmp(self->result->line[i].text, text) != 0)
        i++;
    return i;
}

// How much more the roads scatter an angle at the rear adaptor's exit than at the middle one's.
static void print_half_binding(const study *self)
{
    double x[MOST_ROADS], y[MOST_ROADS];
    char middle[96], rear[96];
    print_head(self, "half-binding period, growth of the deviation");
    print_rule(1 + self->scenarios);
    for (int i = 0; i < ANGLES; i++) {
        snprintf(middle, sizeof middle, "%s, middle out", angle[i].name);
        snprintf(rear, sizeof rear, "%s, rear out", angle[i].name);
        printf("| %s |", angle[i].name);
        for (int s = 0; s < self->scenarios; s++) {
            gather(self, s, find(self, middle), x);
            gather(self, s, find(self, rear), y);
            print_ratio(DEVIATION, x, y, self->seeds);
        }
        printf("\n");
    }
}

static void print_strongest_lines(const study *self, int signal)
{
    printf("| %s, strongest line [Hz] |", signal_name[signal]);
    for (int s = 0; s < self->scenarios; s++) {
        double power[LINES] = {0};
        int peak = 1;
        for (int i = 0; i < self->seeds; i++)
            for (int k = 0; k < LINES; k++)
                power[k] += self->result[s * self->seeds + i].power[signal][k];
        for (int k = 1; k < LINES; k++)
            peak = power[k] > power[peak] ? k : peak;
        printf(" %d |", peak);
    }
    printf("%s\n", self->scenarios > 1 ? " - |" : "");
}

// Of each road, from one line to below another [unit^2].
static void power_of_band(const study *self, int scenario, int signal, const int edge[2],
                          double power[MOST_ROADS])
{
    for (int i = 0; i < self->seeds; i++) {
        power[i] = 0;
        for (int k = edge[0]; k < edge[1]; k++)
            power[i] += self->result[scenario * self->seeds + i].power[signal][k];
    }
}

static void print_band(const study *self, int signal, const int edge[2])
{
    bool speed = signal == REL_VY || signal == IN_VY || signal == IN_VZ;
    double before[MOST_ROADS], last[MOST_ROADS] = {0};
    printf("| %s, %d to %d Hz, rms [%s] |", signal_name[signal], edge[0], edge[1],
           speed ? "mm/s" : "mrad/s");
    for (int s = 0; s < self->scenarios; s++) {
        memcpy(before, last, sizeof before);
        power_of_band(self, s, signal, edge, last);
        printf(" %.3g |", 1e3 * taken(ROOT_OF_MEAN, last, self->seeds, -1));
    }
    if (self->scenarios > 1)
        print_ratio(ROOT_OF_MEAN, before, last, self->seeds);
    printf("\n");
}

static void print_spectra(const study *self)
{
    static const int edge[] = {1, 5, 20, 50, 100, LINES};
    print_head(self, "spectrum of 0.5 to 1.5 s after the exit");
    if (self->scenarios > 1)
        print_against(self, "rms");
    print_rule(1 + self->scenarios + (self->scenarios > 1));
    for (int signal = 0; signal < SIGNALS; signal++) {
        print_strongest_lines(self, signal);
        for (int band = 0; band < 5; band++)
            print_band(self, signal, &edge[band]);
    }
}

static int report_problems(const study *self)
{
    int problems = 0;
    for (int i = 0; i < self->scenarios * self->seeds; i++)
        if (*self->result[i].problem) {
            fprintf(stderr, "marching_study: %s, road %d: %s\n", self->scenario[i / self->seeds],
                    i % self->seeds + 1, self->result[i].problem);
            problems++;
        }
    return problems;
}

static bool read_arguments(int argc, char **argv, study *self)
{
    self->seeds = argc > 1 ? atoi(argv[1]) : 0;
    for (int i = 2; i < argc; i++)
        if (strchr(argv[i], '=') && self->sets < MOST_SETS)
            self->set[self->sets++] = argv[i];
        else if (!strchr(argv[i], '=') && self->scenarios < MOST_SCENARIOS)
            self->scenario[self->scenarios++] = argv[i];
        else
            return false;
    return self->seeds > 1 && self->seeds <= MOST_ROADS && self->scenarios > 0;
}

int main(int argc, char **argv)
{
    study self = {0};
    if (!read_arguments(argc, argv, &self)) {
        fprintf(stderr, "usage: marching_study SEEDS SCENARIO.yaml... [PATH=VALUE...]\n");
        return 2;
    }
    self.result = calloc((size_t)(self.scenarios * self.seeds), sizeof *self.result);
    if (!self.result)
        return 1;
    pthread_t thread[THREADS];
    int started = 0;
    while (started < THREADS && pthread_create(&thread[started], NULL, work, &self) == 0)
        started++;
    for (int i = 0; i < started; i++)
        pthread_join(thread[i], NULL);
    int problems = report_problems(&self);
    if (!problems) {
        print_measures(&self);
        print_half_binding(&self);
        print_spectra(&self);
    }
    free(self.result);
    return problems ? 1 : 0;
}
