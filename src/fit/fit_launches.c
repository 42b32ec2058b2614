#include "fit/fit_launches.h"

#include <errno.h>
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory_stream.h"
#include "launchdyn/scenario.h"
#include "model/model.h"
#include "quantities/summary.h"
#include "run/simulation_build.h"
#include "state/simulation.h"
#include "studies/run/worker.h"

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
    for (int i = 0; i < fit->keys; i++)
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

static ld_status simulate(const fit_launches *self, fit_worker *worker, const fit_launch *launch,
                          const double *p, double *residual, ld_error *error)
{
    ld_fit_options asked = *self->options;
    const ld_run_options options = {.self = &asked, .progress = may_continue};
    ld_status status = make_model(self->fit, launch, p, worker->model, error);
    if (!status)
        status = simulation_renew(&worker->simulation, worker->model, error);
    if (!status)
        status = ld_simulation_run(worker->simulation, &options, worker->summary, error);
    return status ? status : weigh(self->fit, launch, worker->summary, residual, error);
}

// ---- side by side

// A batch: every launch at each point; task k is launch k % launches at point k / launches.
typedef struct batch {
    fit_launches *self;
    int count;
    const double *points;
    double *residuals;
    bool *there;
    atomic_int next, worker;
    atomic_bool stopped;
    pthread_mutex_t at_work;
    int first_failed; // task
    ld_status status; // what ends the fit
    ld_error *error;
} batch;

static void take_outcome(batch *self, int task, ld_status status, const ld_error *error)
{
    fit_launches *all = self->self;
    pthread_mutex_lock(&self->at_work);
    all->counts.launches++;
    if (status == LD_ERR_INTERRUPTED || status == LD_ERR_MEMORY) {
        self->status = status;
        *self->error = *error;
        self->stopped = true;
    } else if (status) {
        self->there[task / (int)all->fit->data.launches] = false;
        if (task < self->first_failed)
            snprintf(all->reason, sizeof all->reason, "%s", error->text);
        self->first_failed = task < self->first_failed ? task : self->first_failed;
    }
    if (all->options->progress)
        all->options->progress(all->options->self, &all->counts);
    pthread_mutex_unlock(&self->at_work);
}

static void *work(void *user)
{
    batch *self = user;
    const fit_launches *all = self->self;
    const ld_fit *fit = all->fit;
    int launches = (int)fit->data.launches, task;
    fit_worker *worker = &all->worker[self->worker++];
    while (!self->stopped && (task = self->next++) < self->count * launches) {
        ld_error error;
        int point = task / launches;
        const fit_launch *launch = &fit->data.launch[task % launches];
        double *residual = &self->residuals[point * fit->data.residuals + launch->first];
        ld_status status =
            simulate(all, worker, launch, &self->points[point * fit->keys], residual, &error);
        take_outcome(self, task, status, &error);
    }
    return NULL;
}

static ld_status work_side_by_side(batch *self)
{
    fit_launches *all = self->self;
    int tasks = self->count * (int)all->fit->data.launches, started = 0, problem = 0;
    int others = (all->threads < tasks ? all->threads : tasks) - 1;
    pthread_t *thread = calloc((size_t)(others > 0 ? others : 0) + 1, sizeof *thread);
    if (!thread)
        return no_memory(self->error);
    while (!problem && started < others) {
        problem = worker_start_thread(&thread[started], work, self);
        started += !problem;
    }
    if (problem) {
        self->status = ld_fail(self->error, LD_ERR_MISSING, "cannot start thread %d of %d: %s",
                               started + 2, all->threads, strerror(problem));
        self->stopped = true;
    }
    work(self);
    while (started > 0)
        pthread_join(thread[--started], NULL);
    free(thread);
    return self->status;
}

static ld_status compute(fit_launches *self, int count, const double *points, double *residuals,
                         bool *there, ld_error *error)
{
    batch all = {.self = self,
                 .count = count,
                 .points = points,
                 .residuals = residuals,
                 .there = there,
                 .first_failed = self->reason[0] ? -1 : count * (int)self->fit->data.launches,
                 .error = error,
                 .at_work = PTHREAD_MUTEX_INITIALIZER};
    for (int i = 0; i < count; i++)
        there[i] = true;
    return work_side_by_side(&all);
}

ld_status fit_launches_evaluate(void *user, int count, const double *points, double *residuals,
                                bool *there, ld_error *error)
{
    fit_launches *self = user;
    int keys = self->fit->keys, rows = self->fit->data.residuals, known = 0;
    while (known < count && search_state_next(&self->state, &points[known * keys],
                                              &residuals[known * rows], &there[known]))
        known++;
    self->counts.launches += known * (int64_t)self->fit->data.launches;
    if (known == count)
        return LD_OK;
    ld_status status = compute(self, count - known, &points[known * keys], &residuals[known * rows],
                               &there[known], error);
    for (int i = known; i < count && !status; i++)
        status = search_state_put(&self->state, &points[i * keys], &residuals[i * rows], there[i],
                                  error);
    return status ? status : search_state_flush(&self->state, error);
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
        fprintf(stream, "%s %a %a %a %a\n", fit->key[i].place.path, fit->key[i].low,
                fit->key[i].width, fit->key[i].mean, fit->key[i].deviation);
    fprintf(stream, "%d %lld\n", options->starts, (long long)options->seed);
    write_data(&fit->data, stream);
    return fclose(stream) == 0 ? text : NULL;
}

static ld_status make_workers(fit_launches *self, ld_error *error)
{
    self->worker = calloc((size_t)self->threads, sizeof *self->worker);
    for (int i = 0; self->worker && i < self->threads; i++) {
        fit_worker *worker = &self->worker[i];
        worker->model = calloc(1, sizeof *worker->model);
        worker->summary = calloc(1, sizeof *worker->summary);
        if (!worker->model || !worker->summary)
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
    }
    free(self->worker);
    self->worker = NULL;
}
