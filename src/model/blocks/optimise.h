/// What an optimisation varies and what it makes least: the block `optimise`.
#ifndef LD_MODEL_BLOCKS_OPTIMISE_H
#define LD_MODEL_BLOCKS_OPTIMISE_H

#include <stdbool.h>

#include "model/blocks/limits.h"

/// A key with its bounds, in SI.
typedef struct ld_bounds {
    char path[LD_MAX_PATH];
    double from, to;
    bool log; ///< searched by its logarithm
} ld_bounds;

typedef enum ld_aim_take {
    LD_AIM_MEAN,         ///< of all rockets of all samples; of one launch its value
    LD_AIM_DEVIATION,    ///< standard deviation; of two results the root of the sum of squares
    LD_AIM_GREATEST,     ///< mean over the samples of the greatest of a sample's rockets
    LD_AIM_QUANTILE,     ///< of all rockets of all samples
    LD_AIM_FOOTPRINT,    ///< area of the ellipse with 95 % of normal landings [m2]
    LD_AIM_GAIN_MARGIN,  ///< of a loop: factor by which gains may rise or fall
    LD_AIM_PHASE_MARGIN, ///< of a loop [rad]
} ld_aim_take;

/// A number that follows from the samples of a study, or from the linear equations.
typedef struct ld_aim {
    ld_aim_take take;
    char of[LD_MAX_QUANTITY];     ///< result; of a margin the hinge or drive
    char beside[LD_MAX_QUANTITY]; ///< a second result of a deviation; "": none
    double level;                 ///< of a quantile
    double at_most, at_least;     ///< of a constraint, in `unit`; NaN: not given
    char unit[LD_MAX_UNIT];       ///< SI, follows from the result
} ld_aim;

typedef enum ld_optimise_method {
    LD_OPTIMISE_COBYLA,
    LD_OPTIMISE_BOBYQA,
    LD_OPTIMISE_SBPLX,
    LD_OPTIMISE_SLSQP,
    LD_OPTIMISE_CCSA,
    LD_OPTIMISE_DIRECT,
    LD_OPTIMISE_CRS,
    LD_OPTIMISE_ISRES,
} ld_optimise_method;

typedef struct ld_optimise {
    bool present;
    int key_count;
    ld_bounds key[LD_MAX_BOUNDS];
    ld_aim least;
    int limit_count;
    ld_aim limit[LD_MAX_AIMS];
    ld_optimise_method method;
    int starts;       ///< the scenario's values, then random ones
    int evaluations;  ///< at most so many candidates a start
    double precision; ///< of the keys, of the width of their bounds
    int others;       ///< samples by which the gain is measured; 0: as many as the search has
    int seed;         ///< of the random starts
} ld_optimise;

#endif
