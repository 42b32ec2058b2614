/// What a study scatters and sweeps: the blocks `scatter` and `sweep`.
#ifndef LD_MODEL_BLOCKS_STUDY_H
#define LD_MODEL_BLOCKS_STUDY_H

#include <stdbool.h>

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

typedef enum ld_plan { LD_PLAN_RANDOM, LD_PLAN_LHS } ld_plan;

/// What a study scatters, and how often it runs.
typedef struct ld_scatter {
    bool present;
    int seed;
    int samples; ///< runs, each of all rockets of the firing; with `until`, at most
    ld_plan plan;
    int replicates; ///< independent Latin hypercubes, of samples/replicates each
    int factor_count;
    ld_factor *factor; ///< owned by the model
    int correlated_count;
    ld_correlated *correlated;    ///< groups of factors, owned by the model
    int until_count;              ///< 0: all samples are run
    ld_until until[LD_MAX_UNTIL]; ///< all of which must hold
} ld_scatter;

/// One key of the scenario that a study varies: a sweep is the product of its axes, the first
/// varying most slowly.
typedef struct ld_sweep_axis {
    char path[LD_MAX_PATH]; ///< list members by name, else by number from 1; of several: their name
    ld_together together;
    int count;
    char **value; ///< [count] as written, in one line of YAML
} ld_sweep_axis;

#endif
