/// Distributions of a factor.
#ifndef LD_MODEL_BLOCKS_DISTRIBUTION_H
#define LD_MODEL_BLOCKS_DISTRIBUTION_H

/// Distributions of a factor: each with its word, what a scenario says of it, and its traits. What
/// they make of a uniform number stands in studies/plan/draw.c (model.md, section 10).
#define LD_DISTRIBUTIONS(ROW)                                                                      \
    ROW(LD_NORMAL, "normal", LD_GIVEN_DEVIATION, LD_ABOUT_NOMINAL | LD_BOUNDED)                    \
    ROW(LD_UNIFORM, "uniform", LD_GIVEN_SPAN, 0)                                                   \
    ROW(LD_LOGNORMAL, "lognormal", LD_GIVEN_RATIO, LD_ABOUT_NOMINAL | LD_ABOVE_ZERO)               \
    ROW(LD_DISCRETE, "discrete", LD_GIVEN_VALUES, LD_FOR_WHOLE)                                    \
    ROW(LD_EACH_SAMPLE, "each", LD_GIVEN_SAMPLE, LD_FOR_WHOLE | LD_SEED)

#define LD_DISTRIBUTION_NAME(name, word, given, traits) name,
typedef enum ld_distribution { LD_DISTRIBUTIONS(LD_DISTRIBUTION_NAME) } ld_distribution;

#define LD_DISTRIBUTION_ONE(name, word, given, traits) +1
enum { LD_DISTRIBUTION_COUNT = LD_DISTRIBUTIONS(LD_DISTRIBUTION_ONE) };

/// What a scenario says of a distribution.
typedef enum ld_given {
    LD_GIVEN_DEVIATION, ///< `deviation` in the key's unit
    LD_GIVEN_RATIO,     ///< `deviation`, a plain number
    LD_GIVEN_SPAN,      ///< `between`, or `spread`
    LD_GIVEN_VALUES,    ///< `value` with `weight`
    LD_GIVEN_SAMPLE,    ///< the word `sample`
} ld_given;

/// Traits of a distribution.
enum {
    LD_ABOUT_NOMINAL = 1, ///< always about the scenario's value
    LD_BOUNDED = 2,       ///< may be kept `within` or `between`
    LD_ABOVE_ZERO = 4,    ///< of values > 0, whose median is the nominal one
    LD_FOR_WHOLE = 8,     ///< for whole numbers too
    LD_SEED = 16, ///< for whole numbers alone, another one of the key's range in each sample
};

typedef struct distribution_row {
    const char *word;
    ld_given given;
    unsigned traits;
} distribution_row;

static inline const distribution_row *distribution_of(ld_distribution distribution)
{
#define LD_DISTRIBUTION_ROW(name, word, given, traits) {word, given, traits},
    static const distribution_row row[] = {LD_DISTRIBUTIONS(LD_DISTRIBUTION_ROW)};
    return &row[distribution];
}

#endif
