/// What a study scatters and sweeps: the blocks `scatter` and `sweep`.
#ifndef LD_MODEL_BLOCKS_STUDY_H
#define LD_MODEL_BLOCKS_STUDY_H

#include <stdbool.h>
#include <stdint.h>

#include "model/blocks/distribution.h"
#include "model/blocks/limits.h"
#include "model/blocks/table.h"

/// Several keys under one name, which always have the same value.
typedef struct ld_together {
    int count; ///< 0: not several
    char path[LD_MAX_TOGETHER][LD_MAX_PATH];
} ld_together;

/// One scattered number of the scenario. Units are those of the key, in SI.
typedef struct ld_factor {
    char path[LD_MAX_PATH]; ///< keys joined by dots; list members by name, else by number from 1;
                            ///< components of vectors by .w, .x, .y, .z; of several: their name
    ld_together together;
    ld_distribution distribution;
    double deviation;  ///< standard deviation, or that of the logarithm [-]
    double within;     ///< [-] kept within so many standard deviations; NaN: not
    double between[2]; ///< kept between these; of a span its ends; NaN: not given
    double spread;     ///< of a span: nominal +- this, where `between` is NaN
    int value_count;
    double value[LD_MAX_CHOICES];
    double weight[LD_MAX_CHOICES];
    bool per_rocket; ///< drawn for every rocket (keys of the rocket only)
} ld_factor;

/// Factors whose normal scores are correlated (Gaussian copula): of normal factors the matrix is
/// that of their own correlations.
typedef struct ld_correlated {
    int count;
    int factor[LD_MAX_CORRELATED];                       ///< numbers from 0 in ld_scatter.factor
    double matrix[LD_MAX_CORRELATED][LD_MAX_CORRELATED]; ///< symmetric, 1 on the diagonal
} ld_correlated;

typedef enum ld_statistic { LD_STATISTIC_MEAN, LD_STATISTIC_DEVIATION } ld_statistic;

/// How well a statistic of a result must be known for a study to stop before its last sample.
typedef struct ld_until {
    char result[2 * LD_MAX_NAME]; ///< name of the result's column, e.g. "t_rear"
    ld_statistic statistic;
    double half_width; ///< of the 95 % interval, in SI or, where relative, as a share of the
                       ///< statistic's magnitude
    bool relative;
} ld_until;

/// How samples are planned. Of LD_PLAN_SALTELLI and LD_PLAN_MORRIS a sample is a row of several
/// runs.
typedef enum ld_plan {
    LD_PLAN_RANDOM,
    LD_PLAN_LHS,
    LD_PLAN_SOBOL,
    LD_PLAN_SALTELLI,
    LD_PLAN_MORRIS,
} ld_plan;

/// What a study scatters, and how often it runs.
typedef struct ld_scatter {
    bool present;
    int seed;
    int samples; ///< runs, or rows of them, each of all rockets of the firing; with `until`, at
                 ///< most
    ld_plan plan;
    int replicates; ///< independent Latin hypercubes or scramblings, of samples/replicates each; of
                    ///< LD_PLAN_SALTELLI 1: random numbers
    int factor_count;
    ld_factor *factor; ///< owned by the model
    int correlated_count;
    ld_correlated *correlated;    ///< groups of factors, owned by the model
    int until_count;              ///< 0: all samples are run
    ld_until until[LD_MAX_UNTIL]; ///< all of which must hold
} ld_scatter;

/// Runs of a row: of A. Saltelli's plan A, B and for each factor A with that factor of B; of a
/// trajectory of M. D. Morris its start and a step for each factor.
static inline int plan_row(const ld_scatter *scatter)
{
    return scatter->plan == LD_PLAN_SALTELLI ? scatter->factor_count + 2
           : scatter->plan == LD_PLAN_MORRIS ? scatter->factor_count + 1
                                             : 1;
}

/// Whether the coordinates are those of scrambled Sobol points.
static inline bool plan_has_points(const ld_scatter *scatter)
{
    return scatter->plan == LD_PLAN_SOBOL ||
           (scatter->plan == LD_PLAN_SALTELLI && scatter->replicates > 1);
}

/// Whether samples come in replicates, each of which is one group; else more may be added.
static inline bool plan_is_replicated(const ld_scatter *scatter)
{
    return scatter->plan == LD_PLAN_LHS || plan_has_points(scatter);
}

/// Whether it is made for sensitivities.
static inline bool plan_has_rows(const ld_scatter *scatter)
{
    return scatter->plan == LD_PLAN_SALTELLI || scatter->plan == LD_PLAN_MORRIS;
}

/// Samples of a replicate, 1 of random numbers.
static inline int plan_replicate(const ld_scatter *scatter)
{
    return plan_is_replicated(scatter) ? scatter->samples / scatter->replicates : 1;
}

/// Runs of an independent group; of all samples.
static inline int64_t plan_strata(const ld_scatter *scatter)
{
    return (int64_t)plan_row(scatter) * plan_replicate(scatter);
}

static inline int64_t plan_runs(const ld_scatter *scatter)
{
    return scatter->present ? (int64_t)plan_row(scatter) * scatter->samples : 1;
}

/// One key of the scenario that a study varies: a sweep is the product of its axes, the first
/// varying most slowly.
typedef struct ld_sweep_axis {
    char path[LD_MAX_PATH]; ///< list members by name, else by number from 1; of several: their name
    ld_together together;
    int count;
    char **value; ///< [count] as written, in one line of YAML
} ld_sweep_axis;

#endif
