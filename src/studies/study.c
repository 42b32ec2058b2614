// Samples side by side on the threads of one process.
#include <stdlib.h>

#include "studies/ledger.h"
#include "studies/worker.h"

// One thread: runs samples until there are no more.
static void work(study_ledger *ledger, const study_plan *plan)
{
    study_worker worker;
    ld_error error;
    ld_status status = worker_create(&worker, plan, &error);
    if (status) {
        ledger_stop(ledger, status, &error);
        return;
    }
    for (int64_t number; (number = ledger_next(ledger)) != 0;) {
        worker_run(&worker, number, ledger_goes_on, ledger);
        ledger_keep(ledger, (const study_record *[]){worker.record}, 1);
    }
    worker_free(&worker);
}

// OpenBLAS, where that is the one: samples run side by side, each on its own thread alone.
extern void openblas_set_num_threads(int count) __attribute__((weak));

static ld_status require_scatter(const ld_model *model, ld_error *error)
{
    if (model->scatter.present)
        return LD_OK;
    return ld_fail(error, LD_ERR_INPUT, "the scenario has no scatter: nothing to study");
}

static ld_status check_shard(const ld_study_options *options, ld_error *error)
{
    if (options->shards == 0 || (options->shard >= 1 && options->shard <= options->shards))
        return LD_OK;
    return ld_fail(error, LD_ERR_INPUT, "there is no shard %d of %d: they go from 1/%d to %d/%d",
                   options->shard, options->shards, options->shards, options->shards,
                   options->shards);
}

ld_status ld_study_run(const ld_model *model, const char *folder, const ld_study_options *options,
                       ld_study_counts *counts, ld_error *error)
{
    static const ld_study_options none = {0};
    ld_error own;
    study_plan plan;
    study_ledger ledger;
    error = error ? error : &own;
    options = options ? options : &none;
    *counts = (ld_study_counts){0};
    ld_status status = require_scatter(model, error);
    if (!status)
        status = check_shard(options, error);
    if (!status)
        status = plan_create(&plan, model, 1, error);
    if (status)
        return status;
    if (openblas_set_num_threads)
        openblas_set_num_threads(1);
    ledger_open(&ledger, &plan, folder, options->shards > 0 ? STORE_ROLLBACK : STORE_AHEAD, options,
                counts, error);
#pragma omp parallel num_threads(options->threads > 1 ? options->threads : 1)
    work(&ledger, &plan);
    status = ledger_close(&ledger);
    plan_free(&plan);
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
    self->sample = status ? NULL : sample_create(model->scatter.factor_count);
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
