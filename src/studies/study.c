// Samples side by side on the threads of one process.
#include <inttypes.h>
#include <stdlib.h>

#include "studies/ledger.h"
#include "studies/worker.h"

// OpenBLAS, where that is the one.
extern void openblas_set_num_threads(int count) __attribute__((weak));

void study_calm_blas(void)
{
    if (openblas_set_num_threads)
        openblas_set_num_threads(1);
}

ld_status study_check(const ld_study *study, ld_error *error)
{
    if (study->nominal->scatter.present || study->nominal->sweep_count > 0)
        return LD_OK;
    return ld_fail(error, LD_ERR_INPUT,
                   "the scenario has neither scatter nor sweep: nothing to study");
}

static ld_status check_shard(const ld_study *study, const ld_study_options *options,
                             ld_error *error)
{
    if (options->shards > 0 && study->nominal->scatter.until_count > 0)
        return ld_fail(error, LD_ERR_INPUT,
                       "scatter.until wants all samples, of which a shard knows its own only: run "
                       "the shards with --set scatter.until=, or the study as a whole");
    if (options->shards == 0 || (options->shard >= 1 && options->shard <= options->shards))
        return LD_OK;
    return ld_fail(error, LD_ERR_INPUT, "there is no shard %d of %d: they go from 1/%d to %d/%d",
                   options->shard, options->shards, options->shards, options->shards,
                   options->shards);
}

ld_status ld_study_run(const ld_study *study, const char *folder, const ld_study_options *options,
                       ld_study_counts *counts, ld_error *error)
{
    static const ld_study_options none = {0};
    ld_error own;
    study_ledger ledger;
    error = error ? error : &own;
    options = options ? options : &none;
    *counts = (ld_study_counts){0};
    ld_status status = study_check(study, error);
    if (!status)
        status = check_shard(study, options, error);
    if (status)
        return status;
    study_calm_blas();
    ledger_open(&ledger, study, folder, options->shards > 0 ? STORE_ROLLBACK : STORE_AHEAD, options,
                counts, error);
#pragma omp parallel num_threads(options->threads > 1 ? options->threads : 1)
    worker_run_all(study, &ledger);
    return ledger_close(&ledger);
}

// ---- one sample alone

struct ld_sample {
    study_sampler sampler;
    study_sample *sample;
};

static ld_status no_such_sample(int64_t number, int64_t last, ld_error *error)
{
    return ld_fail(error, LD_ERR_INPUT,
                   "there is no sample %" PRId64 ": they go from 1 to %" PRId64, number, last);
}

ld_status ld_sample_create(const ld_model *model, int64_t number, ld_sample **out, ld_error *error)
{
    int samples = model->scatter.present ? model->scatter.samples : 1;
    if (number < 1 || number > samples)
        return no_such_sample(number, samples, error);
    ld_sample *self = calloc(1, sizeof *self);
    if (!self)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a sample");
    ld_status status = sampler_create(&self->sampler, model, error);
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

ld_status ld_study_sample(const ld_study *study, int64_t number, ld_sample **sample,
                          ld_error *error)
{
    ld_status status = study_check(study, error);
    if (status)
        return status;
    if (number < 1 || number > study->samples)
        return no_such_sample(number, study->samples, error);
    return ld_sample_create(&study->model[study_point_of(study, number)],
                            study_draw_of(study, number), sample, error);
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
