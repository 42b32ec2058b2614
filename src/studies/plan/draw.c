#include "studies/plan/draw.h"

#include "base/random.h"
#include "base/sobol.h"
#include "math/curves/distributions.h"
#include "math/functions.h"
#include "model/fields/factor.h"

// How far a factor moves in a trajectory.
static const double trajectory_step = 0.6;

// What a factor's random numbers belong to.
typedef struct draw_key {
    uint64_t seed, stream, rocket;
} draw_key;

// Feistel network on pairs of halves, walked again while it leaves 0 ... n - 1 (Black and Rogaway,
// Ciphers with arbitrary finite domains, 2002).
int64_t draw_permuted(const uint64_t key[2], uint64_t first, uint64_t second, int64_t n, int64_t i)
{
    enum { ROUNDS = 8 };
    int bits = 1;
    while (n > (int64_t)1 << 2 * bits)
        bits++;
    uint64_t mask = ((uint64_t)1 << bits) - 1, x = (uint64_t)i;
    do {
        uint64_t left = x >> bits, right = x & mask;
        for (uint64_t round = 0; round < ROUNDS; round++) {
            uint64_t words[4];
            random_block(key, (uint64_t[]){first, second, round << 32 | right, 1}, words);
            uint64_t mixed = left ^ (words[0] & mask);
            left = right;
            right = mixed;
        }
        x = left << bits | right;
    } while (x >= (uint64_t)n);
    return (int64_t)x;
}

// Where a run stands in its plan.
typedef struct plan_place {
    int64_t sample; // from 1: the row
    int column;     // of the row
} plan_place;

static plan_place place_of(const ld_scatter *scatter, int64_t run)
{
    const int row = plan_row(scatter);
    return (plan_place){(run - 1) / row + 1, (int)((run - 1) % row)};
}

// ---- Sobol points

// Coordinates of the sample's factors come first, then those of each rocket's; seeds have none.
static int dimension_of(const ld_scatter *scatter, int factor, int rocket)
{
    int before = 0, of_sample = 0, of_rocket = 0;
    for (int i = 0; i < scatter->factor_count; i++) {
        const ld_factor *other = &scatter->factor[i];
        if (distribution_of(other->distribution)->traits & LD_SEED)
            continue;
        before += i < factor && other->per_rocket == (rocket > 0);
        *(other->per_rocket ? &of_rocket : &of_sample) += 1;
    }
    return before + (rocket > 0 ? of_sample + (rocket - 1) * of_rocket : 0);
}

int draw_dimensions(const ld_scatter *scatter, int rockets)
{
    int dimensions = dimension_of(scatter, scatter->factor_count, rockets);
    return scatter->plan == LD_PLAN_SALTELLI ? 2 * dimensions : dimensions;
}

// The number whose first bits are the scrambled coordinate's and whose others are u's: of 2^bits
// points of a net each of 2^bits intervals has one. `second`: of matrix B.
static double draw_point(const ld_scatter *scatter, const ld_factor *factor, const draw_key *key,
                         int64_t sample, bool second, double u)
{
    const int64_t points = plan_replicate(scatter), replicate = (sample - 1) / points;
    int bits = 0;
    while ((int64_t)1 << bits < points)
        bits++;
    int dimension = dimension_of(scatter, (int)(factor - scatter->factor), (int)key->rocket);
    if (scatter->plan == LD_PLAN_SALTELLI)
        dimension = 2 * dimension + second;
    uint32_t point = sobol_point(dimension, (uint32_t)((sample - 1) % points));
    uint32_t scrambled = sobol_scrambled(point, bits, (uint64_t[]){key->seed, key->stream},
                                         (uint64_t)replicate << 1 | second, key->rocket);
    return fmin(ldexp((double)scrambled + u, -bits), 1 - 0x1p-53);
}

// ---- the plans for sensitivities

int draw_turn(int seed, int factors, int64_t sample, int factor)
{
    const uint64_t key[] = {(uint64_t)seed, random_stream("morris")};
    return (int)draw_permuted(key, (uint64_t)sample, 0, factors, factor);
}

// A trajectory's steps are up from the two lower levels, down from the others. Rockets of a salvo
// go the same way.
double draw_step(int seed, const char *path, int64_t sample)
{
    double u = random_uniform((uint64_t)seed, random_stream(path), (uint64_t)sample, 0, 2);
    return u < 0.5 ? trajectory_step : -trajectory_step;
}

// One of four levels, 0.05, 0.35, 0.65, 0.95; after its turn the one two levels away.
static double draw_level(const ld_scatter *scatter, const ld_factor *factor, const draw_key *key,
                         int64_t sample, bool moved)
{
    bool up = draw_step(scatter->seed, factor->path, sample) > 0;
    double low = random_uniform(key->seed, key->stream, (uint64_t)sample, key->rocket, 3);
    return (low < 0.5 ? 0.05 : 0.35) + (up == moved ? trajectory_step : 0);
}

// Whether the run has the factor's number of matrix B, or after its step.
static bool is_second(const ld_scatter *scatter, const ld_factor *factor, plan_place at)
{
    if (!plan_has_rows(scatter))
        return false;
    const int number = (int)(factor - scatter->factor);
    if (scatter->plan == LD_PLAN_SALTELLI)
        return at.column == 1 || at.column == number + 2;
    return at.column > draw_turn(scatter->seed, scatter->factor_count, at.sample, number);
}

// The factor's number on its own, as if it were in no group.
static double draw_alone(const ld_scatter *scatter, const ld_factor *factor, int64_t run,
                         int rocket)
{
    const draw_key key = {(uint64_t)scatter->seed, random_stream(factor->path), (uint64_t)rocket};
    const plan_place at = place_of(scatter, run);
    const bool second = is_second(scatter, factor, at);
    double u = random_uniform(key.seed, key.stream, (uint64_t)at.sample, key.rocket, second);
    if (distribution_of(factor->distribution)->traits & LD_SEED)
        return u;
    if (plan_has_points(scatter))
        return draw_point(scatter, factor, &key, at.sample, second, u);
    if (scatter->plan == LD_PLAN_MORRIS)
        return draw_level(scatter, factor, &key, at.sample, second);
    if (scatter->plan != LD_PLAN_LHS)
        return u;
    int64_t strata = plan_replicate(scatter), i = at.sample - 1;
    int64_t stratum = draw_permuted((uint64_t[]){key.seed, key.stream}, (uint64_t)(i / strata),
                                    key.rocket, strata, i % strata);
    return ((double)stratum + u) / (double)strata;
}

// The number of member `member` of a group: that of the normal score sum_k L_ik z_k, z_k those of
// the first members on their own (Gaussian copula).
static double draw_in_group(const ld_scatter *scatter, const ld_correlated *group, int member,
                            int64_t sample, int rocket)
{
    double lower[LD_MAX_CORRELATED][LD_MAX_CORRELATED], score = 0;
    if (!correlated_factorise(group, lower))
        return NAN;
    for (int k = 0; k <= member; k++) {
        const ld_factor *factor = &scatter->factor[group->factor[k]];
        score += lower[member][k] * normal_quantile(draw_alone(scatter, factor, sample, rocket));
    }
    return fmin(normal_cumulative(score), 1 - 0x1p-53);
}

double draw_uniform(const ld_scatter *scatter, const ld_factor *factor, int64_t sample, int rocket)
{
    for (int g = 0; g < scatter->correlated_count; g++) {
        const ld_correlated *group = &scatter->correlated[g];
        for (int member = 1; member < group->count; member++)
            if (&scatter->factor[group->factor[member]] == factor)
                return draw_in_group(scatter, group, member, sample, rocket);
    }
    return draw_alone(scatter, factor, sample, rocket);
}

// Normal with mean 0 and deviation 1, kept between a and b; on the side where tails are accurate.
static double truncated_normal(double u, double a, double b)
{
    if (a > 0)
        return -truncated_normal(1 - u, -b, -a);
    double below = normal_cumulative(a), above = normal_cumulative(b);
    double z = normal_quantile(below + u * (above - below));
    return fmin(fmax(z, a), b);
}

static double draw_normal(const ld_factor *factor, double nominal, double u)
{
    double sigma = factor->deviation, low = -INFINITY, high = INFINITY;
    if (!isnan(factor->within)) {
        low = -factor->within;
        high = factor->within;
    } else if (!isnan(factor->between[0])) {
        low = (factor->between[0] - nominal) / sigma;
        high = (factor->between[1] - nominal) / sigma;
    }
    return nominal + sigma * truncated_normal(u, low, high);
}

static double draw_discrete(const ld_factor *factor, double u)
{
    double sum = 0, passed = 0;
    for (int i = 0; i < factor->value_count; i++)
        sum += factor->weight[i];
    int last = 0;
    for (int i = 0; i < factor->value_count; i++) {
        passed += factor->weight[i];
        if (factor->weight[i] > 0)
            last = i;
        if (u * sum < passed)
            return factor->value[i];
    }
    return factor->value[last];
}

double draw_value(const ld_factor *factor, const field_place *place, double nominal, double u)
{
    field_range range = place->row->range;
    double low = factor->between[0], high = factor->between[1];
    switch (factor->distribution) {
    case LD_NORMAL:
        return draw_normal(factor, nominal, u);
    case LD_LOGNORMAL:
        return nominal * exp(factor->deviation * normal_quantile(u));
    case LD_UNIFORM:
        return isnan(low) ? nominal + factor->spread * (2 * u - 1) : low + u * (high - low);
    case LD_DISCRETE:
        return draw_discrete(factor, u);
    case LD_EACH_SAMPLE:
        return range.low + floor(u * (range.high - range.low + 1));
    }
    return nominal;
}
