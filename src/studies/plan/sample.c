#include "studies/plan/sample.h"

#include <math.h>
#include <stdlib.h>

#include "base/sobol.h"
#include "model/fields/factor.h"
#include "model/model.h"
#include "model/parts.h"
#include "studies/plan/draw.h"

// Finds the numbers of factor `i`, whose first place is known.
static bool find_places(study_sampler *self, int i, char *why, size_t size)
{
    const ld_factor *factor = &self->nominal->scatter.factor[i];
    field_place *place = &self->place[self->first[i]];
    for (int k = 0; k < factor_numbers(factor); k++)
        if (!field_locate(self->nominal, factor_path(factor, k), &place[k], why, size))
            return false;
    self->nominal_value[i] = field_get(self->nominal, place);
    return true;
}

static ld_status check_dimensions(const ld_scatter *scatter, int rockets, ld_error *error)
{
    const int dimensions = plan_has_points(scatter) ? draw_dimensions(scatter, rockets) : 0;
    if (dimensions <= SOBOL_DIMENSIONS)
        return LD_OK;
    return ld_fail(
        error, LD_ERR_INPUT,
        "scatter.plan: Sobol points have at most %d coordinates, and these factors of %d "
        "rockets require %d; use random numbers",
        SOBOL_DIMENSIONS, rockets, dimensions);
}

ld_status sampler_create(study_sampler *self, const ld_model *nominal, ld_error *error)
{
    const ld_scatter *scatter = &nominal->scatter;
    char why[384];
    *self = (study_sampler){.nominal = nominal, .factor_count = scatter->factor_count};
    ld_status status = check_dimensions(scatter, nominal->firing_count, error);
    if (status)
        return status;
    size_t count = (size_t)scatter->factor_count + 1;
    int places = 0;
    self->first = calloc(count, sizeof *self->first);
    self->nominal_value = calloc(count, sizeof *self->nominal_value);
    for (int i = 0; self->first && i < scatter->factor_count; i++) {
        self->first[i] = places;
        places += factor_numbers(&scatter->factor[i]);
        *(scatter->factor[i].per_rocket ? &self->of_rocket : &self->of_sample) += 1;
    }
    self->place = calloc((size_t)places + 1, sizeof *self->place);
    if (!self->place || !self->first || !self->nominal_value) {
        sampler_free(self);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the study's factors");
    }
    for (int i = 0; i < scatter->factor_count; i++) {
        if (!find_places(self, i, why, sizeof why)) {
            sampler_free(self);
            return ld_fail(error, LD_ERR_INPUT, "scatter.factors.%s: %s", scatter->factor[i].path,
                           why);
        }
    }
    return LD_OK;
}

void sampler_free(study_sampler *self)
{
    free(self->place);
    free(self->first);
    free(self->nominal_value);
    *self = (study_sampler){0};
}

study_sample *sample_create(const study_sampler *sampler)
{
    study_sample *self = calloc(1, sizeof *self);
    if (!self)
        return NULL;
    int most = sampler->of_sample + LD_MAX_FIRINGS * sampler->of_rocket;
    self->model = calloc(1, sizeof *self->model);
    self->salvo = calloc(LD_MAX_FIRINGS, sizeof *self->salvo);
    self->drawn = calloc((size_t)most + 1, sizeof(double));
    if (self->model && self->salvo && self->drawn)
        return self;
    sample_free(self);
    return NULL;
}

void sample_free(study_sample *self)
{
    if (!self)
        return;
    free(self->model);
    free(self->salvo);
    free(self->drawn);
    free(self);
}

// Draws the values of rocket `rocket` (from 1; 0: those of the sample) into the model and to
// `drawn`; returns where the next ones go.
static double *draw_row(study_sample *self, const study_sampler *sampler, int64_t number,
                        int rocket, double *drawn)
{
    const ld_scatter *scatter = &sampler->nominal->scatter;
    for (int i = 0; i < sampler->factor_count; i++) {
        const ld_factor *factor = &scatter->factor[i];
        const field_place *place = &sampler->place[sampler->first[i]];
        if (factor->per_rocket != (rocket > 0))
            continue;
        double u = draw_uniform(scatter, factor, number, rocket);
        *drawn = draw_value(factor, place, sampler->nominal_value[i], u);
        for (int k = 0; k < factor_numbers(factor); k++)
            field_set(self->model, &place[k], *drawn);
        drawn++;
    }
    return drawn;
}

ld_status sample_draw(study_sample *self, const study_sampler *sampler, int64_t number,
                      ld_error *error)
{
    int rockets = sampler->nominal->firing_count;
    *self->model = *sampler->nominal;
    self->model->sample = (int)number;
    model_forget(self->model); // it follows from what is sampled, for each rocket
    double *drawn = draw_row(self, sampler, number, 0, self->drawn);
    ld_rocket shared = self->model->rocket;
    ld_status status = LD_OK;
    double stuck_time = NAN;
    for (int i = 1; i <= rockets; i++) {
        model_forget(self->model);
        self->model->rocket = shared;
        drawn = draw_row(self, sampler, number, i, drawn);
        model_complete(self->model);
        if (!status)
            status = model_check_drawn(self->model, error);
        self->salvo[i - 1] = self->model->rocket;
        stuck_time = fmax(stuck_time, self->model->run.stuck_time);
    }
    self->model->run.stuck_time = stuck_time;
    // a vehicle carries more rockets than are fired, which are as the scenario says
    bool apart = rockets > 1 || model_has_vehicle(self->model);
    self->model->rocket = apart ? shared : self->salvo[0];
    self->model->salvo = apart ? self->salvo : NULL;
    model_complete(self->model);
    return status;
}
