// An optimisation: keys, aims, and what was found.
#ifndef LD_OPTIMISE_OPTIMISE_H
#define LD_OPTIMISE_OPTIMISE_H

#include "launchdyn/optimise.h"
#include "model/fields/field.h"
#include "optimise/aim_value.h"
#include "optimise/optimum.h"
#include "quantities/study_results.h"

enum { OPTIMISE_AIMS = 1 + LD_MAX_AIMS, OPTIMISE_RESULTS = 2 * OPTIMISE_AIMS };

typedef struct optimise_key {
    field_place place;
    const char *unit; // SI
    double from, to;  // SI
    double low, high; // of the key, or of its logarithm
    bool log;
} optimise_key;

// An aim: what is made least, or a constraint.
typedef struct optimise_aim {
    const ld_aim *as; // in the model
    aim_plan plan;
    aim_blocks blocks;
    int margin;       // its place among a candidate's margins; -1: none
    double scale;     // of a constraint
    study_unit shown; // unit in which people read it
} optimise_aim;

// A point that was looked at.
typedef struct optimise_candidate {
    double x[LD_MAX_BOUNDS]; // in the unit cube
    double value;            // of the aim
    double worst;            // of the constraints, <= 0: all hold
    int start;               // from 0
    bool there;
    double *number; // [samples][rockets][results], at their end [margins]; to be freed
} optimise_candidate;

struct ld_optimisation {
    const ld_model *model;
    const ld_optimise *as; // in the model
    int keys;
    optimise_key key[LD_MAX_BOUNDS];
    int aims; // the first is made least
    optimise_aim aim[OPTIMISE_AIMS];
    int samples, rockets, hypercubes;
    int others_count; // samples behind those of the search
    int results, margins;
    char result[OPTIMISE_RESULTS][QUANTITY_NAME];
    const ld_aim *margin[OPTIMISE_AIMS];

    // What was found.
    bool done;
    int64_t simulated;
    int candidates, room;
    optimise_candidate *candidate; // [candidates]
    int failed;                    // candidates without launches
    char reason[LD_ERROR_TEXT];    // of the first of them
    int starts;
    optimum start[1000];
    int best;          // number of the candidate
    double *others[2]; // the same of further samples: of the
                       // scenario's values, of the best; NULL
};

// Numbers that are kept of a candidate.
static inline size_t optimise_numbers(const ld_optimisation *self)
{
    int most = self->samples > self->others_count ? self->samples : self->others_count;
    return (size_t)most * (size_t)self->rockets * (size_t)self->results + (size_t)self->margins;
}

// A key's value at a coordinate of the unit cube, in SI, and back.
double optimise_key_value(const optimise_key *key, double x);
double optimise_key_place(const optimise_key *key, double value);

// Whether intervals are known: there are samples.
static inline bool optimise_is_noisy(const ld_optimisation *self)
{
    return self->samples > 1;
}

// Aim `i` of the numbers of a candidate, in SI, and how far its constraint is from holding, in its
// scale: not above 0 where it holds.
double optimise_aim_of(const ld_optimisation *self, int i, const double *number, double *work);
double optimise_excess(const optimise_aim *aim, double value, bool lower);

// With its interval, of numbers of the search or of other samples; `from`: of the difference from
// those numbers, or NULL. Of a margin without.
typedef struct optimise_pair {
    const double *number, *from;
    bool others;
} optimise_pair;
ld_estimate optimise_estimate(const ld_optimisation *self, int i, const optimise_pair *of);

// Writes optimise.json and optimised.yaml into a folder that is there.
ld_status optimise_write(const ld_optimisation *self, const char *folder, ld_error *error);

#endif
