#include "studies/plan/draw.h"

#include "base/random.h"
#include "math/curves/distributions.h"
#include "math/functions.h"
#include "model/fields/factor.h"

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

// The factor's number on its own, as if it were in no group.
static double draw_alone(const ld_scatter *scatter, const ld_factor *factor, int64_t sample,
                         int rocket)
{
    uint64_t seed = (uint64_t)scatter->seed, stream = random_stream(factor->path);
    double u = random_uniform(seed, stream, (uint64_t)sample, (uint64_t)rocket, 0);
    if (scatter->plan != LD_PLAN_LHS || (distribution_of(factor->distribution)->traits & LD_SEED))
        return u;
    int64_t strata = scatter->samples / scatter->replicates, i = sample - 1;
    int64_t stratum = draw_permuted((uint64_t[]){seed, stream}, (uint64_t)(i / strata),
                                    (uint64_t)rocket, strata, i % strata);
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
