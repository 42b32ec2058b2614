// What a study's samples are: a model for each point of the sweep (one point where there is none)
// and, found once, where its factors are. Sample numbers go round the points, so that a study with
// more samples goes on with the numbers that follow; at all points the same numbers are drawn.
#ifndef LD_STUDIES_PLAN_H
#define LD_STUDIES_PLAN_H

#include "studies/sample.h"

typedef struct study_plan {
    int points;
    const ld_model *model;  // [points]
    study_sampler *sampler; // [points]
    int64_t samples;        // their numbers go from 1 to this
    int rockets;            // most that a sample fires
} study_plan;

// `model` [points] must outlive the plan.
ld_status plan_create(study_plan *self, const ld_model *model, int points, ld_error *error);
void plan_free(study_plan *self);

// Samples of each point.
static inline int64_t plan_draws(const study_plan *self)
{
    return self->samples / self->points;
}

// The point of a sample, from 0.
static inline int plan_point(const study_plan *self, int64_t number)
{
    return (int)((number - 1) % self->points);
}

// Its number among those of its point, from 1.
static inline int64_t plan_draw(const study_plan *self, int64_t number)
{
    return (number - 1) / self->points + 1;
}

#endif
