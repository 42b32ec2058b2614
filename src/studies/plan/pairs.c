#include "studies/plan/pairs.h"

#include <stdlib.h>

#include "math/curves/distributions.h"
#include "math/functions.h"

// What is summed over pairs, and can be taken away again: a group is left out without another pass.
// `between`: of the squares and products of a sample's sums over the number of its pairs.
typedef struct pair_sums {
    double count, samples;
    struct side {
        double first[2], second[3], between[3];
    } side[2]; // of the value, of the reference
} pair_sums;

enum { SUMS = sizeof(pair_sums) / sizeof(double) };

static void add(pair_sums *sums, const pair_sums *more, double times)
{
    double *sum = (double *)sums;
    const double *summand = (const double *)more;
    for (int i = 0; i < SUMS; i++)
        sum[i] += times * summand[i];
}

// Squares of both columns, then their product.
static void add_products(double sum[3], const double of[2], double divisor)
{
    sum[0] += of[0] * of[0] / divisor;
    sum[1] += of[1] * of[1] / divisor;
    sum[2] += of[0] * of[1] / divisor;
}

// ---- sums over samples and groups

typedef struct pair_groups {
    const paired_values *pairs;
    double mean[2][2]; // of value and reference, each column
    size_t groups;
    pair_sums all;
    pair_sums *of; // [groups]
} pair_groups;

static double mean_of(const double *value, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += value[i] / (double)count;
    return sum;
}

static const double *column_of(const paired_values *pairs, int side, int column)
{
    return side ? pairs->reference[column] : pairs->value[column];
}

// Adds the sample whose pairs go from `from` to before `to`.
static void add_sample(const pair_groups *self, size_t from, size_t to, pair_sums *sums)
{
    sums->count += (double)(to - from);
    sums->samples += 1;
    for (int k = 0; k < 2; k++) {
        struct side *side = &sums->side[k];
        double sample[2] = {0};
        for (size_t i = from; i < to; i++) {
            double off[2] = {0};
            for (int c = 0; c < self->pairs->columns; c++) {
                off[c] = column_of(self->pairs, k, c)[i] - self->mean[k][c];
                sample[c] += off[c];
            }
            add_products(side->second, off, 1);
        }
        for (int c = 0; c < 2; c++)
            side->first[c] += sample[c];
        add_products(side->between, sample, (double)(to - from));
    }
}

static ld_status sum_groups(pair_groups *self)
{
    const paired_values *pairs = self->pairs;
    for (size_t i = 0; i < pairs->count; i++)
        self->groups += i == 0 || pairs->group[i] != pairs->group[i - 1];
    for (int k = 0; k < 2; k++)
        for (int c = 0; c < pairs->columns; c++)
            self->mean[k][c] = mean_of(column_of(pairs, k, c), pairs->count);
    self->of = calloc(self->groups + 1, sizeof *self->of);
    if (!self->of)
        return LD_ERR_MEMORY;
    for (size_t from = 0, to = 0, g = 0; from < pairs->count; from = to) {
        while (to < pairs->count && pairs->sample[to] == pairs->sample[from])
            to++;
        g += from > 0 && pairs->group[from] != pairs->group[from - 1];
        add_sample(self, from, to, &self->of[g]);
    }
    for (size_t g = 0; g < self->groups; g++)
        add(&self->all, &self->of[g], 1);
    return LD_OK;
}

// ---- ratios

// Logarithm of the standard deviation, of two columns of the ellipse's area.
static double log_spread(const pair_sums *sums, int side, int columns, bool within)
{
    const struct side *s = &sums->side[side];
    double variance[3], first[3] = {0};
    add_products(first, s->first, sums->count);
    double freedom = sums->count - (within ? sums->samples : 1);
    for (int i = 0; i < 3; i++)
        variance[i] = (s->second[i] - (within ? s->between[i] : first[i])) / freedom;
    double square =
        columns == 1 ? variance[0] : variance[0] * variance[1] - variance[2] * variance[2];
    return freedom > 0 && square > 0 ? 0.5 * log(square) : NAN;
}

static double log_ratio(const pair_groups *self, const pair_sums *sums, bool within)
{
    int columns = self->pairs->columns;
    return log_spread(sums, 0, columns, within) - log_spread(sums, 1, columns, within);
}

static estimate ratio_of(const pair_groups *self, bool within)
{
    double g = (double)self->groups, sum = 0, squares = 0,
           all = log_ratio(self, &self->all, within);
    for (size_t i = 0; i < self->groups; i++) {
        pair_sums rest = self->all;
        add(&rest, &self->of[i], -1);
        double apart = log_ratio(self, &rest, within) - all;
        sum += apart;
        squares += apart * apart;
    }
    double error = self->groups > 2 ? sqrt((g - 1) / g * fmax(0, squares - sum * sum / g)) : NAN;
    double half = self->groups > 2 ? student_quantile(0.975, g - 1) * error : NAN;
    return (estimate){exp(all), exp(all - half), exp(all + half)};
}

// ---- all of them

static ld_status mean_difference(const paired_values *pairs, estimate *difference)
{
    uncertain mean;
    double *apart = malloc((pairs->count + 1) * sizeof *apart);
    if (!apart)
        return LD_ERR_MEMORY;
    for (size_t i = 0; i < pairs->count; i++)
        apart[i] = pairs->value[0][i] - pairs->reference[0][i];
    ld_status status = uncertain_mean_of(apart, pairs->group, pairs->count, &mean);
    free(apart);
    double half =
        isnan(mean.variance) ? NAN : student_quantile(0.975, mean.freedom) * sqrt(mean.variance);
    *difference = (estimate){mean.value, mean.value - half, mean.value + half};
    return status;
}

ld_status paired_statistics_of(const paired_values *pairs, paired_statistics *result)
{
    static const estimate none = {NAN, NAN, NAN};
    pair_groups self = {.pairs = pairs};
    *result = (paired_statistics){pairs->count, 0, none, none, none};
    ld_status status = mean_difference(pairs, &result->difference);
    if (!status)
        status = sum_groups(&self);
    if (!status && pairs->count > 1) {
        result->groups = self.groups;
        result->spread = ratio_of(&self, false);
        result->within = ratio_of(&self, true);
    }
    free(self.of);
    return status;
}
