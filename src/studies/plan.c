#include "studies/plan.h"

#include <stdlib.h>

ld_status plan_create(study_plan *self, const ld_model *model, int points, ld_error *error)
{
    const ld_scatter *scatter = &model->scatter;
    *self = (study_plan){.points = points,
                         .model = model,
                         .samples = (int64_t)points * (scatter->present ? scatter->samples : 1),
                         .sampler = calloc((size_t)points, sizeof *self->sampler)};
    if (!self->sampler)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the study's points");
    for (int i = 0; i < points; i++) {
        ld_status status = sampler_create(&self->sampler[i], &model[i], error);
        if (status) {
            plan_free(self);
            return status;
        }
        if (model[i].firing_count > self->rockets)
            self->rockets = model[i].firing_count;
    }
    return LD_OK;
}

void plan_free(study_plan *self)
{
    for (int i = 0; self->sampler && i < self->points; i++)
        sampler_free(&self->sampler[i]);
    free(self->sampler);
    *self = (study_plan){0};
}
