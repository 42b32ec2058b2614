// Gains of both stabilisers with which the tip-off rates scatter least over random roads (seeds 1,
// 2, ..), under margins of 6 dB and 30 degrees of each loop and nine tenths of each torque limit;
// compared with the scenario's own gains on other roads, with intervals of 95 %. Scatter: root of
// the sum of the variances of pitch and yaw rate at the exit, of the first rocket.
//
//     tune_stabiliser ROADS EVALUATIONS OTHER_ROADS SCENARIO.yaml [PATH=VALUE...]
#include <launchdyn/loop.h>
#include <launchdyn/scenario.h>
#include <launchdyn/simulation.h>
#include <launchdyn/summary.h>

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "search.h"

enum {
    HINGES = 2,
    RATES = 2,
    GAINS = 6,
    CONSTRAINTS = 3 * HINGES,
    THREADS = 2,
    MOST_SETS = 32,
    TEXT = 128
};

static const double pi = 3.141592653589793;
static const double range = 20;         // gains may be so many times as large or small
static const double gain_margin = 2;    // 6 dB
static const double phase_margin = 30;  // degrees
static const double torque_share = 0.9; // of the limit
static const int first_other = 1001;    // road that is not tuned on

static const char *const hinges[HINGES] = {"azimuth", "elevation"};
static const char *const rates[RATES] = {"pitch_rate", "yaw_rate"}; // [rad/s]
static const struct {
    const char *name, *unit;
} gains[] = {{"kp", "N.m/rad"}, {"ki", "N.m/rad/s"}, {"kd", "N.m.s/rad"}};

typedef struct tuning {
    const char *scenario;
    const char *set[MOST_SETS];
    int sets, roads;
    int gain_count;
    char path[GAINS][TEXT];
    const char *unit[GAINS];
    double own[GAINS], limit[HINGES];
    double before; // scatter [rad/s] with the scenario's gains, on the roads to tune on
    ld_error error;
} tuning;

// ---- launches ----

// What one launch gave.
typedef struct launch {
    double rate[RATES], torque[HINGES];
    ld_error error;
} launch;

typedef struct campaign {
    const tuning *of;
    const double *x; // logarithms of gains over the scenario's own
    int first, count;
    launch *launch; // [count]
    atomic_int next;
} campaign;

static ld_status read_scenario(const tuning *self, const double *x, int road, ld_model **model,
                               ld_error *error)
{
    char text[GAINS + 2][2 * TEXT];
    const char *set[MOST_SETS + GAINS + 2];
    int count = self->sets;
    ld_messages messages;
    memcpy(set, self->set, (size_t)count * sizeof *set);
    for (int i = 0; i < self->gain_count; i++)
        snprintf(text[i], sizeof text[i], "%s=%.17g %s", self->path[i],
                 self->own[i] * exp(x ? x[i] : 0), self->unit[i]);
    snprintf(text[self->gain_count], sizeof text[0], "base.road.seed=%d", road);
    snprintf(text[self->gain_count + 1], sizeof text[0], "run.end=tip");
    for (int i = 0; i < self->gain_count + 2; i++)
        set[count++] = text[i];
    ld_status status = ld_scenario_read(self->scenario, set, (size_t)count, model, &messages);
    if (status) {
        if (messages.count)
            ld_fail(error, status, "%s: %s", messages.item[0].path, messages.item[0].text);
        else
            ld_fail(error, status, "%s: cannot be read", self->scenario);
        ld_messages_free(&messages);
    }
    return status;
}

static ld_status launch_on(const tuning *self, const double *x, int road, launch *to)
{
    ld_model *model = NULL;
    ld_simulation *simulation = NULL;
    ld_summary *summary = ld_summary_new();
    char name[TEXT];
    ld_status status = read_scenario(self, x, road, &model, &to->error);
    if (!status)
        status = ld_simulation_create(model, &simulation, &to->error);
    if (!status)
        status = ld_simulation_run(simulation, NULL, summary, &to->error);
    for (int r = 0; r < RATES && !status; r++) {
        snprintf(name, sizeof name, "rocket.1.%s", rates[r]);
        status = ld_summary_number(summary, name, &to->rate[r], &to->error);
    }
    for (int h = 0; h < HINGES && !status; h++) {
        snprintf(name, sizeof name, "rocket.1.%s.torque_peak", hinges[h]);
        status = ld_summary_number(summary, name, &to->torque[h], &to->error);
    }
    ld_summary_free(summary);
    ld_simulation_free(simulation);
    ld_model_free(model);
    return status;
}

static void *work(void *data)
{
    campaign *self = data;
    for (int i; (i = atomic_fetch_add(&self->next, 1)) < self->count;)
        self->launch[i].error.status =
            launch_on(self->of, self->x, self->first + i, &self->launch[i]);
    return NULL;
}

// Launches on roads first, first + 1, .., the scenario's gains times e^x (NULL: 1).
static ld_status launch_all(const tuning *of, const double *x, int first, int count, launch *to,
                            ld_error *error)
{
    campaign all = {.of = of, .x = x, .first = first, .count = count, .launch = to};
    pthread_t thread;
    memset(to, 0, (size_t)count * sizeof *to);
    bool beside = THREADS > 1 && pthread_create(&thread, NULL, work, &all) == 0;
    work(&all);
    if (beside)
        pthread_join(thread, NULL);
    for (int i = 0; i < count; i++)
        if (to[i].error.status) {
            *error = to[i].error;
            return error->status;
        }
    return LD_OK;
}

// Of all launches but one; -1: of all.
static double variance(const launch *of, int count, int rate, int without)
{
    double sum = 0, square = 0, n = 0;
    for (int i = 0; i < count; i++) {
        double d = of[i].rate[rate] - of[0].rate[rate];
        sum += i == without ? 0 : d;
        square += i == without ? 0 : d * d;
        n += i != without;
    }
    return (square - sum * sum / n) / (n - 1);
}

// [rad/s]
static double scatter(const launch *of, int count, int without)
{
    double sum = 0;
    for (int r = 0; r < RATES; r++)
        sum += variance(of, count, r, without);
    return sqrt(sum);
}

static double greatest_torque(const launch *of, int count, int hinge)
{
    double most = 0;
    for (int i = 0; i < count; i++)
        most = fmax(most, of[i].torque[hinge]);
    return most;
}

// ---- what is sought ----

// Margins of a hinge's loop: least factor of its gains, least phase [rad]; LD_ERR_INPUT: unstable.
static ld_status find_margins(const ld_model *model, int hinge, double *factor, double *phase,
                              ld_error *error)
{
    ld_loop *loop;
    ld_loop_margins margins;
    ld_status status = ld_loop_create(model, hinges[hinge], &loop, error);
    if (status)
        return status;
    ld_loop_margins_of(loop, &margins);
    ld_loop_free(loop);
    *factor = fmin(margins.raise, 1 / margins.lower);
    *phase = fmin(margins.phase, pi);
    return LD_OK;
}

// The constraints of the loops; where one is unstable all are broken.
static ld_status constrain_loops(const tuning *self, const double *x, double *constraint,
                                 bool *stable, ld_error *error)
{
    ld_model *model = NULL;
    ld_status status = read_scenario(self, x, 1, &model, error);
    *stable = true;
    for (int h = 0; h < HINGES && !status; h++) {
        double factor = 1, phase = 0;
        status = find_margins(model, h, &factor, &phase, error);
        *stable &= status == LD_OK;
        status = status == LD_ERR_INPUT ? LD_OK : status;
        constraint[2 * h] = fmax(log(gain_margin / factor), -1);
        constraint[2 * h + 1] = fmax(1 - phase / (phase_margin * pi / 180), -1);
    }
    ld_model_free(model);
    return status;
}

static int evaluate(void *data, const double *x, double *value, double *constraint)
{
    tuning *self = data;
    bool stable = false;
    launch *all = malloc((size_t)self->roads * sizeof *all);
    ld_status status = all ? constrain_loops(self, x, constraint, &stable, &self->error)
                           : ld_fail(&self->error, LD_ERR_MEMORY, "no memory");
    *value = 2;
    constraint[4] = constraint[5] = 0;
    if (!status && stable) {
        status = launch_all(self, x, 1, self->roads, all, &self->error);
        *value = scatter(all, self->roads, -1) / self->before;
        for (int h = 0; h < HINGES; h++)
            constraint[2 * HINGES + h] =
                greatest_torque(all, self->roads, h) / (torque_share * self->limit[h]) - 1;
    }
    free(all);
    if (!status && stable)
        fprintf(stderr, "tip-off rates x %.4f\n", *value);
    return (int)status;
}

// ---- what is reported ----

static ld_status print_state(const tuning *self, const char *title, const double *x,
                             ld_error *error)
{
    ld_model *model = NULL;
    ld_status status = read_scenario(self, x, 1, &model, error);
    if (status)
        return status;
    printf("%s\n", title);
    for (int i = 0; i < self->gain_count; i++)
        printf("  %-36s %12.4g %s\n", self->path[i], self->own[i] * exp(x ? x[i] : 0),
               self->unit[i]);
    for (int h = 0; h < HINGES && !status; h++) {
        double factor, phase;
        status = find_margins(model, h, &factor, &phase, error);
        if (!status)
            printf("  margins of the %-21s %12.4g dB, %.4g degrees\n", hinges[h],
                   20 * log10(factor), 180 / pi * phase);
        else
            printf("  the %s's loop is unstable\n", hinges[h]);
    }
    ld_model_free(model);
    return LD_OK;
}

// Quantile 0.975 of Student's t, to 1 % from four degrees of freedom on.
static double student(int freedoms)
{
    double n = freedoms;
    return 1.959964 + 2.372 / n + 2.82 / (n * n);
}

// How many times as large the scatter is, by the jackknife of its logarithm over the roads.
static void print_ratio(const launch *own, const launch *tuned, int count)
{
    double sum = 0, square = 0;
    double all = log(scatter(tuned, count, -1) / scatter(own, count, -1));
    for (int i = 0; i < count; i++) {
        double d = log(scatter(tuned, count, i) / scatter(own, count, i));
        sum += d;
        square += d * d;
    }
    double half = student(count - 1) * sqrt((square - sum * sum / count) * (count - 1.0) / count);
    printf("\nOn %d other roads: scatter of the tip-off rates %.4g in place of %.4g mrad/s, x %.3f "
           "(%.3f to %.3f)\n",
           count, 1e3 * scatter(tuned, count, -1), 1e3 * scatter(own, count, -1), exp(all),
           exp(all - half), exp(all + half));
    for (int r = 0; r < RATES; r++)
        printf("  deviation of %-19s %12.4g in place of %.4g mrad/s\n", rates[r],
               1e3 * sqrt(variance(tuned, count, r, -1)), 1e3 * sqrt(variance(own, count, r, -1)));
    for (int h = 0; h < HINGES; h++)
        printf("  greatest torque of the %-9s %12.4g in place of %.4g N.m\n", hinges[h],
               greatest_torque(tuned, count, h), greatest_torque(own, count, h));
}

// ---- from start to end ----

static ld_status begin(tuning *self, ld_error *error)
{
    ld_model *model = NULL;
    char path[TEXT];
    ld_status status = read_scenario(self, NULL, 1, &model, error);
    if (status)
        return status;
    for (int h = 0; h < HINGES && !status; h++) {
        snprintf(path, sizeof path, "platform.%s.stabiliser.torque_limit", hinges[h]);
        status = ld_model_number(model, path, &self->limit[h], error);
        for (int k = 0; k < 3 && !status; k++) {
            double value = NAN;
            snprintf(path, sizeof path, "platform.%s.stabiliser.%s", hinges[h], gains[k].name);
            status = ld_model_number(model, path, &value, error);
            if (!(value > 0))
                continue; // a gain that is not there stays away
            memcpy(self->path[self->gain_count], path, sizeof path);
            self->unit[self->gain_count] = gains[k].unit;
            self->own[self->gain_count++] = value;
        }
    }
    ld_model_free(model);
    if (!status && self->gain_count == 0)
        status = ld_fail(error, LD_ERR_INPUT, "there are no gains to tune");
    return status;
}

static ld_status tune(tuning *self, int evaluations, int others, ld_error *error)
{
    double low[GAINS], high[GAINS], x[GAINS] = {0};
    launch *own = malloc(2 * (size_t)(others + self->roads) * sizeof *own);
    if (!own)
        return ld_fail(error, LD_ERR_MEMORY, "no memory");
    launch *tuned = own + others + self->roads;
    for (int i = 0; i < GAINS; i++) {
        high[i] = log(range);
        low[i] = -high[i];
    }
    const search sought = {.variables = self->gain_count,
                           .constraints = CONSTRAINTS,
                           .low = low,
                           .high = high,
                           .evaluations = evaluations,
                           .precision = 1e-3,
                           .self = self,
                           .evaluate = evaluate};
    ld_status status = launch_all(self, NULL, 1, self->roads, own, error);
    self->before = scatter(own, self->roads, -1);
    if (!status && search_minimum(&sought, x))
        status = ld_fail(error, LD_ERR_NUMERIC, "the search ended: %s", self->error.text);
    if (!status)
        status = launch_all(self, x, 1, self->roads, tuned, error);
    if (!status)
        status = print_state(self, "The scenario's own gains", NULL, error);
    if (!status)
        status = print_state(self, "Tuned", x, error);
    if (!status)
        printf("\nOn the %d roads that it was tuned on: scatter of the tip-off rates %.4g in place "
               "of %.4g mrad/s\n",
               self->roads, 1e3 * scatter(tuned, self->roads, -1), 1e3 * self->before);
    if (!status)
        status = launch_all(self, NULL, first_other, others, own, error);
    if (!status)
        status = launch_all(self, x, first_other, others, tuned, error);
    if (!status)
        print_ratio(own, tuned, others);
    free(own);
    return status;
}

int main(int argc, char **argv)
{
    tuning self = {0};
    ld_error error = {0};
    int evaluations = argc > 2 ? atoi(argv[2]) : 0, others = argc > 3 ? atoi(argv[3]) : 0;
    self.roads = argc > 1 ? atoi(argv[1]) : 0;
    if (argc < 5 || argc > 5 + MOST_SETS || self.roads < 2 || evaluations < 1 || others < 5) {
        fprintf(stderr, "usage: tune_stabiliser ROADS EVALUATIONS OTHER_ROADS SCENARIO.yaml "
                        "[PATH=VALUE...]\n");
        return 2;
    }
    self.scenario = argv[4];
    for (int i = 5; i < argc; i++)
        self.set[self.sets++] = argv[i];
    ld_status status = begin(&self, &error);
    if (!status)
        status = tune(&self, evaluations, others, &error);
    if (status)
        fprintf(stderr, "tune_stabiliser: %s\n", error.text);
    return status ? 1 : 0;
}
