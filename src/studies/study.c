// Samples side by side, one writer.
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>

#include "launchdyn/study.h"
#include "simulation/simulation.h"
#include "studies/store.h"

typedef struct study {
    const ld_model *model;
    const ld_study_options *options;
    study_sampler sampler;
    pthread_mutex_t mutex; // of all below
    study_store store;
    int64_t next; // sample to be looked at
    ld_study_counts *counts;
    ld_status status;
    ld_error *error;
    atomic_bool stopped; // read without the mutex
} study;

// ---- one sample

static bool may_go_on(void *self, double share)
{
    study *all = self;
    (void)share;
    return !all->stopped && (!all->options->go_on || all->options->go_on(all->options->self));
}

// `simulation`: that of the sample before, NULL for the first.
static ld_status run_sample(study *self, ld_simulation **simulation, const study_sample *sample,
                            ld_summary *summary, ld_error *error)
{
    ld_run_options options = {.self = self, .progress = may_go_on};
    ld_status status = simulation_renew(simulation, &sample->model, error);
    return status ? status : ld_simulation_run(*simulation, &options, summary, error);
}

// ---- what the threads share

static void stop(study *self, ld_status status, const ld_error *error)
{
    if (!self->status) {
        self->status = status;
        *self->error = *error;
    }
    self->stopped = true;
}

// The next sample that is not kept yet; 0: there is none, or the study stops.
static int64_t next_sample(study *self)
{
    bool there = true;
    ld_error error;
    int64_t number = 0;
    pthread_mutex_lock(&self->mutex);
    while (there && !self->stopped && self->next < self->counts->samples) {
        number = ++self->next;
        ld_status status = store_has(&self->store, number, &there, &error);
        if (status)
            stop(self, status, &error);
    }
    bool go_on = may_go_on(self, 0);
    pthread_mutex_unlock(&self->mutex);
    return there || self->stopped || !go_on ? 0 : number;
}

static void keep(study *self, int64_t number, const study_sample *sample, ld_status outcome,
                 const ld_error *reason, const ld_summary *summary)
{
    ld_error error;
    pthread_mutex_lock(&self->mutex);
    ld_status status =
        store_put(&self->store, number, sample, outcome, reason->text, summary, &error);
    if (status) {
        stop(self, status, &error);
    } else {
        self->counts->done++;
        self->counts->now++;
        self->counts->failed += outcome != LD_OK;
        if (self->options->progress)
            self->options->progress(self->options->self, self->counts);
    }
    pthread_mutex_unlock(&self->mutex);
}

static void *work(void *argument)
{
    study *self = argument;
    ld_summary *summary = calloc(1, sizeof *summary);
    study_sample *sample = sample_create(&self->sampler);
    ld_simulation *simulation = NULL;
    ld_error error = {LD_ERR_MEMORY, "no memory for a sample"};
    ld_status outcome = summary && sample ? LD_OK : LD_ERR_MEMORY;
    for (int64_t number; outcome != LD_ERR_MEMORY && (number = next_sample(self));) {
        outcome = sample_draw(sample, &self->sampler, number, &error);
        bool possible = !outcome;
        if (possible)
            outcome = run_sample(self, &simulation, sample, summary, &error);
        if (outcome == LD_ERR_INTERRUPTED)
            break;
        if (outcome != LD_ERR_MEMORY)
            keep(self, number, sample, outcome, &error,
                 possible && summary->rocket_count ? summary : NULL);
    }
    if (outcome == LD_ERR_MEMORY) {
        pthread_mutex_lock(&self->mutex);
        stop(self, outcome, &error);
        pthread_mutex_unlock(&self->mutex);
    }
    ld_simulation_free(simulation);
    sample_free(sample);
    free(summary);
    return NULL;
}

// OpenBLAS, where that is the one: samples run side by side, each on its own thread alone.
extern void openblas_set_num_threads(int count) __attribute__((weak));

enum { MOST_THREADS = 1024 };

static void run_threads(study *self)
{
    pthread_t thread[MOST_THREADS];
    int wanted = self->options->threads, count = 0;
    wanted = wanted < 1 ? 1 : wanted > MOST_THREADS ? MOST_THREADS : wanted;
    if (openblas_set_num_threads)
        openblas_set_num_threads(1);
    while (count < wanted - 1 && pthread_create(&thread[count], NULL, work, self) == 0)
        count++;
    work(self);
    for (int i = 0; i < count; i++)
        pthread_join(thread[i], NULL);
}

static ld_status require_scatter(const ld_model *model, ld_error *error)
{
    if (model->scatter.present)
        return LD_OK;
    return ld_fail(error, LD_ERR_INPUT, "the scenario has no scatter: nothing to study");
}

ld_status ld_study_run(const ld_model *model, const char *folder, const ld_study_options *options,
                       ld_study_counts *counts, ld_error *error)
{
    static const ld_study_options none = {0};
    ld_error own;
    study self = {.model = model,
                  .options = options ? options : &none,
                  .mutex = PTHREAD_MUTEX_INITIALIZER,
                  .counts = counts,
                  .error = error ? error : &own};
    *counts = (ld_study_counts){0};
    ld_status status = require_scatter(model, error);
    if (!status)
        status = sampler_create(&self.sampler, model, error);
    if (status)
        return status;
    status = store_open(&self.store, folder, model, error);
    if (!status)
        status = store_count(&self.store, counts, error);
    if (!status) {
        run_threads(&self);
        status = self.status;
        if (!status && !may_go_on(&self, 0) && counts->done < counts->samples)
            status = ld_fail(error, LD_ERR_INTERRUPTED,
                             "interrupted after %lld of %lld samples; the same command goes on",
                             (long long)counts->done, (long long)counts->samples);
    }
    store_close(&self.store);
    sampler_free(&self.sampler);
    return status;
}

// ---- one sample alone

struct ld_sample {
    study_sampler sampler;
    study_sample *sample;
};

ld_status ld_sample_create(const ld_model *model, int64_t number, ld_sample **out, ld_error *error)
{
    ld_status status = require_scatter(model, error);
    if (status)
        return status;
    if (number < 1 || number > model->scatter.samples)
        return ld_fail(error, LD_ERR_INPUT, "there is no sample %lld: they go from 1 to %d",
                       (long long)number, model->scatter.samples);
    ld_sample *self = calloc(1, sizeof *self);
    if (!self)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a sample");
    status = sampler_create(&self->sampler, model, error);
    self->sample = status ? NULL : sample_create(&self->sampler);
    if (!status && !self->sample)
        status = ld_fail(error, LD_ERR_MEMORY, "no memory for a sample");
    if (!status)
        status = sample_draw(self->sample, &self->sampler, number, error);
    if (status) {
        ld_sample_free(self);
        return status;
    }
    *out = self;
    return LD_OK;
}

const ld_model *ld_sample_model(const ld_sample *self)
{
    return &self->sample->model;
}

void ld_sample_free(ld_sample *self)
{
    if (!self)
        return;
    sampler_free(&self->sampler);
    sample_free(self->sample);
    free(self);
}
