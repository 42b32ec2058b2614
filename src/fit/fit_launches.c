#include "fit/fit_launches.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory_stream.h"
#include "launchdyn/scenario.h"
#include "model/model.h"
#include "model/parts.h"
#include "quantities/summary.h"
#include "run/simulation_build.h"
#include "search/side_by_side.h"
#include "state/simulation.h"

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the launches of the fit");
}

// ---- one launch

static bool may_continue(void *self, double share)
{
    const ld_fit_options *options = self;
    (void)share;
    return !options->go_on || options->go_on(options->self);
}

static ld_status make_model(const ld_fit *fit, const fit_launch *launch, const double *p,
                            ld_model *model, ld_error *error)
{
    *model = *fit->model;
    model_forget(model); // it follows from what is set
    for (int i = 0; i < fit->data.settings; i++)
        field_set(model, &fit->data.setting[i], launch->setting[i]);
    for (int i = 0; i < fit->own_keys; i++)
        field_set(model, &fit->key[i].place, fit_key_value(&fit->key[i], p[i]));
    model_complete(model);
    return model_check_drawn(model, error);
}

// Residuals: how far the launch's results are from the means, weighted.
static ld_status weigh(const ld_fit *fit, const fit_launch *launch, const ld_summary *summary,
                       double *residual, ld_error *error)
{
    double apart[FIT_MOST_RESULTS];
    int n = launch->cells;
    for (int i = 0; i < n; i++) {
        const char *name = fit->data.result[launch->result[i]].name;
        const quantity_walk at = study_result_find(&fit->data.things, name);
        apart[i] = quantity_value(&at, &summary->rocket[0]) - launch->mean[i];
        if (isnan(apart[i]))
            return ld_fail(error, LD_ERR_LAUNCH, "%s: the launch has no such result", name);
    }
    for (int i = 0; i < n; i++) {
        residual[i] = 0;
        for (int j = i; j < n; j++)
            residual[i] += launch->root[j * n + i] * apart[j];
    }
    return LD_OK;
}

static bool has_logs(const ld_fit *fit, const fit_launch *launch)
{
    return fit->logs > 0 && launch == &fit->data.launch[fit->log_launch];
}

// The series of the launch run last.
static ld_status take_series(const ld_fit *fit, fit_worker *worker, ld_error *error)
{
    run_series series;
    ld_status status = run_series_of_run(&series, worker->history, worker->summary, 1, error);
    series.gravity = model_gravity(worker->model);
    for (int i = 0; i < fit->logs && !status; i++) {
        fit_log_run_free(&worker->log[i]);
        status = fit_log_take(&fit->log[i], &series, &worker->log[i], error);
    }
    run_series_free(&series);
    return status;
}

// Runs a launch with the scenario's keys at p.
static ld_status simulate(const fit_launches *self, fit_worker *worker, const fit_launch *launch,
                          const double *p, ld_error *error)
{
    ld_fit_options asked = *self->options;
    bool logged = has_logs(self->fit, launch);
    const ld_run_options options = {.self = &asked,
                                    .progress = may_continue,
                                    .sink = logged ? ld_history_sink(worker->history) : NULL};
    ld_status status = make_model(self->fit, launch, p, worker->model, error);
    if (!status)
        status = simulation_renew(&worker->simulation, worker->model, error);
    if (!status)
        status = ld_simulation_run(worker->simulation, &options, worker->summary, error);
    return status || !logged ? status : take_series(self->fit, worker, error);
}

// Residuals of the launch run last, with all keys at p, into residual[all].
static ld_status weigh_all(const ld_fit *fit, const fit_worker *worker, const fit_launch *launch,
                           const double *p, double *residual, ld_error *error)
{
    double key[FIT_MOST_KEYS];
    ld_status status = weigh(fit, launch, worker->summary, &residual[launch->first], error);
    for (int i = 0; i < fit->keys; i++)
        key[i] = fit_key_value(&fit->key[i], p[i]);
    for (int i = 0; i < fit->logs && has_logs(fit, launch) && !status; i++) {
        const fit_log *log = &fit->log[i];
        status = fit_log_weigh_series(log, &worker->log[i], key, residual, error);
        if (!status)
            status =
                fit_log_weigh_scalars(log, worker->summary, &fit->data.things, residual, error);
    }
    return status;
}

// ---- side by side

// A batch: every launch at each point. Points that differ in keys of logs alone share the launches
// of the first of them, their leader; task k is launch k % launches of the leader k / launches.
typedef struct batch {
    fit_launches *self;
    int count, known; // points; those before `known` are
    const double *points;
    double *residuals;
    bool *there;
    int *leader;  // [count] number of a point
    int *leading; // [leaders] points that lead those to be computed
    int leaders;
    atomic_bool stopped;
    pthread_mutex_t at_work;
    int first_failed; // task
    ld_status status; // what ends the fit
    ld_error *error;
} batch;

// Takes the outcome of a launch at a point.
static void take_outcome(batch *self, int task, int point, ld_status status, const ld_error *error)
{
    fit_launches *all = self->self;
    pthread_mutex_lock(&self->at_work);
    if (status == LD_ERR_INTERRUPTED || status == LD_ERR_MEMORY) {
        self->status = status;
        *self->error = *error;
        self->stopped = true;
    } else if (status) {
        self->there[point] = false;
        if (task < self->first_failed)
            snprintf(all->reason, sizeof all->reason, "%s", error->text);
        self->first_failed = task < self->first_failed ? task : self->first_failed;
    }
    pthread_mutex_unlock(&self->at_work);
}

static void count_launch(batch *self, bool again)
{
    fit_launches *all = self->self;
    pthread_mutex_lock(&self->at_work);
    all->counts.launches += !again;
    if (all->options->progress)
        all->options->progress(all->options->self, &all->counts);
    pthread_mutex_unlock(&self->at_work);
}

// One launch, and its residuals at each of its leader's points that are not known.
static void compute_task(batch *self, fit_worker *worker, int task)
{
    const fit_launches *all = self->self;
    const ld_fit *fit = all->fit;
    const int launches = (int)fit->data.launches, first = self->leading[task / launches];
    const fit_launch *launch = &fit->data.launch[task % launches];
    ld_error error;
    ld_status ran = simulate(all, worker, launch, &self->points[first * fit->keys], &error);
    count_launch(self, first < self->known);
    for (int i = first < self->known ? self->known : first; i < self->count; i++) {
        ld_status status = ran;
        if (self->leader[i] != first)
            continue;
        if (!status)
            status = weigh_all(fit, worker, launch, &self->points[i * fit->keys],
                               &self->residuals[i * fit->data.residuals], &error);
        take_outcome(self, task, i, status, &error);
    }
}

static bool run_task(void *user, int worker, int task)
{
    batch *self = user;
    compute_task(self, &self->self->worker[worker], task);
    return !self->stopped;
}

static ld_status work_side_by_side(batch *self)
{
    const fit_launches *all = self->self;
    const side_by_side work = {.tasks = self->leaders * (int)all->fit->data.launches,
                               .threads = all->threads,
                               .self = self,
                               .run = run_task};
    ld_status status = side_by_side_run(&work, self->error);
    return status ? status : self->status;
}

// Finds who leads whom; returns how many launches' worth of points the known ones are.
static int find_leaders(batch *self)
{
    const ld_fit *fit = self->self->fit;
    size_t size = (size_t)fit->own_keys * sizeof *self->points;
    int known = 0;
    for (int i = 0; i < self->count; i++) {
        int first = 0;
        while (memcmp(&self->points[first * fit->keys], &self->points[i * fit->keys], size) != 0)
            first++;
        self->leader[i] = first;
        known += first == i && i < self->known;
        bool led = false;
        for (int k = 0; k < self->leaders && !led; k++)
            led = self->leading[k] == first;
        if (i >= self->known && !led)
            self->leading[self->leaders++] = first;
    }
    return known;
}

// Computes the points that are not known.
static ld_status compute(batch *self)
{
    fit_launches *all = self->self;
    const int launches = (int)all->fit->data.launches;
    self->leader = calloc(2 * (size_t)self->count, sizeof *self->leader);
    if (!self->leader)
        return no_memory(self->error);
    self->leading = self->leader + self->count;
    all->counts.launches += (int64_t)find_leaders(self) * launches;
    self->first_failed = all->reason[0] ? -1 : self->leaders * launches;
    for (int i = self->known; i < self->count; i++)
        self->there[i] = true;
    ld_status status = self->leaders > 0 ? work_side_by_side(self) : LD_OK;
    free(self->leader);
    return status;
}

ld_status fit_launches_evaluate(void *user, int count, const double *points, double *residuals,
                                bool *there, ld_error *error)
{
    fit_launches *self = user;
    int keys = self->fit->keys, rows = self->fit->data.residuals, known = 0;
    while (known < count && search_state_next(&self->state, &points[known * keys],
                                              &residuals[known * rows], &there[known]))
        known++;
    batch all = {.self = self,
                 .count = count,
                 .known = known,
                 .points = points,
                 .residuals = residuals,
                 .there = there,
                 .error = error,
                 .at_work = PTHREAD_MUTEX_INITIALIZER};
    ld_status status = compute(&all);
    for (int i = known; i < count && !status; i++)
        status = search_state_put(&self->state, &points[i * keys], &residuals[i * rows], there[i],
                                  error);
    return status || known == count ? status : search_state_flush(&self->state, error);
}

void fit_launches_stage(void *user, const char *text, double chi2)
{
    fit_launches *self = user;
    snprintf(self->stage, sizeof self->stage, "%s", text);
    self->counts.stage = self->stage;
    self->counts.chi2 = chi2;
}

// ---- from begin to end

static void write_data(const fit_data *data, FILE *stream)
{
    for (size_t i = 0; i < data->launches; i++) {
        const fit_launch *launch = &data->launch[i];
        for (int k = 0; k < data->settings; k++)
            fprintf(stream, "%s %a\n", data->setting[k].path, launch->setting[k]);
        for (int k = 0; k < launch->cells; k++) {
            fprintf(stream, "%s %a", data->result[launch->result[k]].name, launch->mean[k]);
            for (int j = 0; j <= k; j++)
                fprintf(stream, " %a", launch->root[k * launch->cells + j]);
            fprintf(stream, "\n");
        }
    }
}

static void write_window(const window_end *end, FILE *stream)
{
    fprintf(stream, " %d %a", end->kind, end->t);
}

static void write_log(const fit_log *log, FILE *stream)
{
    const log_clock *clock = &log->log.clock;
    fprintf(stream, "clock %a %a %a", clock->offset, log->given_offset, clock->within);
    write_window(&clock->from, stream);
    write_window(&clock->to, stream);
    for (int k = 0; k < log->log.sensors; k++) {
        const sensor *of = &log->log.sensor[k];
        const fit_series *series = &log->series[k];
        fprintf(stream, "\n%s %d %s %s %d", of->column, of->kind, of->of, of->on ? of->on : "",
                of->order);
        for (int i = 0; i < 3; i++)
            fprintf(stream, " %a %a", of->at[i], of->axis[i]);
        fprintf(stream, " %a %a %a %a %a %a", of->cutoff, of->delay, of->scale, of->bias,
                of->range[0], of->range[1]);
        fprintf(stream, " %a\n", series->noise);
        for (size_t i = 0; i < series->count; i++)
            fprintf(stream, "%a %a\n", series->t[i], series->value[i]);
    }
    for (int i = 0; i < log->scalars; i++)
        fprintf(stream, "%s %a %a\n", log->scalar[i].name, log->scalar[i].measured,
                log->scalar[i].uncertainty);
}

// What the fit is of, as text; NULL: no memory.
static char *identity_of(const ld_fit *fit, const ld_fit_options *options)
{
    char *text = NULL;
    size_t length;
    FILE *stream = memory_stream(&text, &length);
    if (!stream)
        return NULL;
    ld_model_print(fit->model, stream);
    for (int i = 0; i < fit->keys; i++)
        fprintf(stream, "%s %a %a %a %a\n", fit->key[i].name, fit->key[i].low, fit->key[i].width,
                fit->key[i].mean, fit->key[i].deviation);
    fprintf(stream, "%d %lld\n", options->starts, (long long)options->seed);
    write_data(&fit->data, stream);
    for (int i = 0; i < fit->logs; i++)
        write_log(&fit->log[i], stream);
    return fclose(stream) == 0 ? text : NULL;
}

static ld_status make_workers(fit_launches *self, ld_error *error)
{
    self->worker = calloc((size_t)self->threads, sizeof *self->worker);
    for (int i = 0; self->worker && i < self->threads; i++) {
        fit_worker *worker = &self->worker[i];
        worker->model = calloc(1, sizeof *worker->model);
        worker->summary = calloc(1, sizeof *worker->summary);
        worker->history = self->fit->logs > 0 ? ld_history_new(NULL) : NULL;
        if (!worker->model || !worker->summary || (self->fit->logs > 0 && !worker->history))
            return no_memory(error);
    }
    return self->worker ? LD_OK : no_memory(error);
}

ld_status fit_launches_open(fit_launches *self, const ld_fit *fit, const ld_fit_options *options,
                            ld_error *error)
{
    *self = (fit_launches){.fit = fit,
                           .options = options,
                           .state = {.lock = -1},
                           .threads = options->threads > 1 ? options->threads : 1,
                           .counts = {.chi2 = NAN, .stage = ""}};
    char *identity = identity_of(fit, options);
    ld_status status = identity ? make_workers(self, error) : no_memory(error);
    const search_kind kind = {"fit", fit->keys, fit->data.residuals};
    if (!status)
        status = search_state_open(&self->state, &kind, options->folder, identity, error);
    free(identity);
    return status;
}

void fit_launches_close(fit_launches *self)
{
    search_state_close(&self->state);
    for (int i = 0; self->worker && i < self->threads; i++) {
        ld_simulation_free(self->worker[i].simulation);
        free(self->worker[i].model);
        free(self->worker[i].summary);
        ld_history_free(self->worker[i].history);
        for (int k = 0; k < FIT_MOST_LOGS; k++)
            fit_log_run_free(&self->worker[i].log[k]);
    }
    free(self->worker);
    self->worker = NULL;
}
