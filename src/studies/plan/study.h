// A study as read: the scenario's model at each point of its sweep (one point where there is none)
// and, found once, where its factors are. Sample numbers go round the points, so that a study with
// more samples continues with the numbers that follow; at all points the same numbers are sampled.
#ifndef LD_STUDIES_STUDY_H
#define LD_STUDIES_STUDY_H

#include "launchdyn/study.h"
#include "quantities/study_results.h"
#include "studies/plan/record.h"
#include "studies/plan/sample.h"

struct ld_study {
    ld_model *nominal; // the scenario's
    int points;
    ld_model *model;        // [points] of the sweep; without one the nominal one
    study_sampler *sampler; // [points]
    int64_t samples;        // their numbers go from 1 to this
    quantity_things things; // of the nominal model: adaptors, of which each has results
    study_shape shape;      // the most that a sample's record holds
};

// Samples of each point.
static inline int64_t study_draws(const ld_study *self)
{
    return self->samples / self->points;
}

// The point of a sample, from 0.
static inline int study_point_of(const ld_study *self, int64_t number)
{
    return (int)((number - 1) % self->points);
}

// Its number among those of its point, from 1.
static inline int64_t study_draw_of(const ld_study *self, int64_t number)
{
    return (number - 1) / self->points + 1;
}

// Refuses a study that varies nothing.
ld_status study_check(const ld_study *self, ld_error *error);

#endif
