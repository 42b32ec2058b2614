#include "studies/run/until.h"

#include <math.h>

#include "model/parts.h"
#include "studies/store/study_data.h"

int64_t until_next_check(const ld_scatter *scatter, int64_t samples)
{
    enum { LEAST_SAMPLES = 20, LEAST_HYPERCUBES = 5 };
    const double growth = 1.25;
    int64_t step = plan_strata(scatter);
    double least = step > 1 ? fmax(LEAST_HYPERCUBES * (double)step, LEAST_SAMPLES) : LEAST_SAMPLES;
    double wanted = samples == 0 ? least : growth * (double)samples;
    int64_t next = step * (int64_t)ceil(wanted / (double)step);
    return next < scatter->samples ? next : scatter->samples;
}

static ld_status holds_for(const study_data *data, const ld_until *until, int64_t last, bool *holds,
                           ld_error *error)
{
    const char *nearest;
    double half = INFINITY;
    const study_column *column = study_data_find(data, until->result, &nearest);
    if (!column)
        return ld_fail(error, LD_ERR_INPUT, "until: studies keep no result %s", until->result);
    ld_status status = study_data_half_width(data, column, until, last, &half, error);
    *holds = half <= until->half_width;
    return status;
}

ld_status until_holds(const ld_study *study, const char *folder, int64_t last, bool *holds,
                      ld_error *error)
{
    const ld_scatter *scatter = model_scatter(study->nominal);
    study_data data;
    *holds = true;
    ld_status status = study_data_open(folder, &data, error);
    if (status)
        return status;
    for (int i = 0; i < scatter->until_count && *holds && !status; i++)
        status = holds_for(&data, &scatter->until[i], last, holds, error);
    study_data_close(&data);
    return status;
}

until_rule until_begin(const ld_study *study)
{
    bool ruled = model_scatter(study->nominal)->until_count > 0;
    until_rule self = {.study = study, .last = study->samples, .decided = !ruled};
    if (ruled)
        until_look_further(&self);
    else
        self.look = self.last;
    return self;
}

void until_look_further(until_rule *self)
{
    int points = self->study->points;
    self->look =
        points * until_next_check(model_scatter(self->study->nominal), self->look / points);
}

ld_status until_check(until_rule *self, study_store *store, const char *folder, ld_error *error)
{
    ld_status status = store_settle(store, true, error);
    if (!status)
        status = until_holds(self->study, folder, self->look, &self->enough, error);
    self->decided = self->enough || self->look >= self->last;
    if (status || !self->decided) {
        until_look_further(self);
        return status;
    }
    self->last = self->look;
    return store_set_samples(store, self->last, error);
}
