#include "studies/plan/study.h"

#include <inttypes.h>
#include <stdlib.h>

#include "model/blocks/study.h"
#include "model/parts.h"

ld_status study_check(const ld_study *study, ld_error *error)
{
    if (model_scatter(study->nominal)->present || model_sweep_count(study->nominal) > 0)
        return LD_OK;
    return ld_fail(error, LD_ERR_INPUT,
                   "the scenario has neither scatter nor sweep: nothing to study");
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
    int64_t samples = plan_runs(model_scatter(model));
    if (number < 1 || number > samples)
        return no_such_sample(number, samples, error);
    ld_sample *self = calloc(1, sizeof *self);
    if (!self)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a sample");
    ld_status status = sampler_create(&self->sampler, model, error);
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

ld_status ld_study_sample(const ld_study *study, int64_t number, ld_sample **sample,
                          ld_error *error)
{
    ld_status status = study_check(study, error);
    if (status)
        return status;
    if (number < 1 || number > study->samples)
        return no_such_sample(number, study->samples, error);
    return ld_sample_create(study->sampler[study_point_of(study, number)].nominal,
                            study_draw_of(study, number), sample, error);
}

const ld_model *ld_sample_model(const ld_sample *self)
{
    return self->sample->model;
}

void ld_sample_free(ld_sample *self)
{
    if (!self)
        return;
    sampler_free(&self->sampler);
    sample_free(self->sample);
    free(self);
}
