// One sample of a study: the scenario's model with the values sampled for it.
#ifndef LD_STUDIES_SAMPLE_H
#define LD_STUDIES_SAMPLE_H

#include <stdint.h>

#include "launchdyn/status.h"
#include "model/fields/field.h"

// What is found once: where the factors' numbers are in a model, and their nominal values.
typedef struct study_sampler {
    const ld_model *nominal;
    int factor_count;
    int of_sample, of_rocket; // factors sampled once a sample, and for every rocket
    field_place *place;    // of each factor as many as it has numbers, one factor after the other
    int *first;            // [factors] its first place
    double *nominal_value; // [factors]
} study_sampler;

ld_status sampler_create(study_sampler *self, const ld_model *nominal, ld_error *error);
void sampler_free(study_sampler *self);

typedef struct study_sample {
    ld_model *model;         // its tables are the nominal model's
    struct ld_rocket *salvo; // [LD_MAX_FIRINGS]
    double *drawn; // [of_sample] values of the sample, then [of_rocket] of each rocket fired
} study_sample;

study_sample *sample_create(const study_sampler *sampler);
void sample_free(study_sample *self);

// Fills the sample with the values that belong to its number, from 1.
// @return LD_OK, or LD_ERR_INPUT where they make no possible model
ld_status sample_draw(study_sample *self, const study_sampler *sampler, int64_t number,
                      ld_error *error);

#endif
