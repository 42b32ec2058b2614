#include "studies/statistics/quantile_difference.h"

#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "math/curves/distributions.h"
#include "math/functions.h"

enum { FEWEST_GROUPS = 8, MOST_RESAMPLES = 999, LEAST_RESAMPLES = 199 };
static const double most_work = 1e8; // values summed in all resamples

typedef struct bootstrap {
    const quantile_pairs *pairs;
    size_t groups;
    size_t *order[2];  // [count] places of the values of a side in their order
    size_t *number;    // [count] of its group, from 0
    double *size;      // [groups] values in it
    double *share;     // [count + 1] weight of the first k of `count` values
    uint32_t *drawn;   // [groups] how often each is in a resample
    double *resampled; // [MOST_RESAMPLES]
} bootstrap;

static void free_all(bootstrap *self)
{
    free(self->order[0]);
    free(self->order[1]);
    free(self->number);
    free(self->size);
    free(self->share);
    free(self->drawn);
    free(self->resampled);
}

// ---- orders

typedef struct placed {
    double value;
    size_t place;
} placed;

static int by_value(const void *left, const void *right)
{
    const placed *a = left, *b = right;
    if (a->value != b->value)
        return (a->value > b->value) - (a->value < b->value);
    return (a->place > b->place) - (a->place < b->place);
}

static ld_status sort_places(const double *value, size_t count, size_t *order)
{
    placed *all = malloc(count * sizeof *all);
    if (!all)
        return LD_ERR_MEMORY;
    for (size_t i = 0; i < count; i++)
        all[i] = (placed){value[i], i};
    qsort(all, count, sizeof *all, by_value);
    for (size_t i = 0; i < count; i++)
        order[i] = all[i].place;
    free(all);
    return LD_OK;
}

static ld_status begin(bootstrap *self, double q)
{
    const quantile_pairs *pairs = self->pairs;
    const size_t n = pairs->count;
    const double up = (double)(n + 1) * q, down = (double)(n + 1) * (1 - q);
    self->order[0] = malloc(n * sizeof(size_t));
    self->order[1] = malloc(n * sizeof(size_t));
    self->number = malloc(n * sizeof(size_t));
    self->size = calloc(n, sizeof(double));
    self->share = malloc((n + 1) * sizeof(double));
    self->drawn = malloc(n * sizeof(uint32_t));
    self->resampled = malloc(MOST_RESAMPLES * sizeof(double));
    if (!self->order[0] || !self->order[1] || !self->number || !self->size || !self->share ||
        !self->drawn || !self->resampled)
        return LD_ERR_MEMORY;
    for (size_t i = 0; i < n; i++) {
        self->groups += i == 0 || pairs->group[i] != pairs->group[i - 1];
        self->number[i] = self->groups - 1;
        self->size[self->number[i]] += 1;
    }
    for (size_t k = 0; k <= n; k++)
        self->share[k] = k == n ? 1 : beta_cumulative(up, down, (double)k / (double)n);
    ld_status status = sort_places(pairs->value[0], n, self->order[0]);
    return status ? status : sort_places(pairs->value[1], n, self->order[1]);
}

// ---- estimates

// The weight of a part of a sample, linear between whole numbers of values.
static double share_at(const bootstrap *self, double part)
{
    double at = part * (double)self->pairs->count;
    size_t k = (size_t)at;
    if (k >= self->pairs->count)
        return 1;
    return self->share[k] + (at - (double)k) * (self->share[k + 1] - self->share[k]);
}

// Harrell and Davis's estimator of a side, each group as often as it was drawn: of so many values.
static double estimate_of(const bootstrap *self, int side, double values)
{
    double sum = 0, before = 0, below = 0;
    for (size_t i = 0; i < self->pairs->count; i++) {
        size_t place = self->order[side][i];
        uint32_t times = self->drawn[self->number[place]];
        if (times == 0)
            continue;
        below += times;
        double share = share_at(self, below / values);
        sum += (share - before) * self->pairs->value[side][place];
        before = share;
    }
    return sum;
}

static double difference_of(const bootstrap *self)
{
    double values = 0;
    for (size_t g = 0; g < self->groups; g++)
        values += self->drawn[g] * self->size[g];
    return estimate_of(self, 0, values) - estimate_of(self, 1, values);
}

// Draws as many groups as there are, with replacement.
static void draw(bootstrap *self, uint64_t resample)
{
    static const uint64_t key[2] = {0x7175616e74696c65, 0x70}; // "quantile"
    uint64_t words[4];
    memset(self->drawn, 0, self->groups * sizeof *self->drawn);
    for (size_t i = 0; i < self->groups; i++) {
        if (i % 8 == 0)
            random_block(key, (uint64_t[]){resample, i / 8, 0, 0}, words);
        uint32_t number = (uint32_t)(words[i % 8 / 2] >> i % 2 * 32);
        self->drawn[(uint64_t)number * self->groups >> 32]++;
    }
}

static void find_interval(bootstrap *self, estimate *difference)
{
    double work = (double)(2 * self->pairs->count + self->groups);
    int resamples = (int)fmin(fmax(most_work / work, LEAST_RESAMPLES), MOST_RESAMPLES);
    for (int b = 0; b < resamples; b++) {
        draw(self, (uint64_t)b);
        self->resampled[b] = difference_of(self);
    }
    sort_values(self->resampled, (size_t)resamples);
    int beyond = (int)((resamples + 1) * 0.025);
    difference->low = self->resampled[beyond - 1];
    difference->high = self->resampled[resamples - beyond];
}

// Whether both sides have values enough for an interval of their quantile.
static ld_status check_reach(const quantile_pairs *pairs, double q, bool *reaches)
{
    ld_status status = LD_OK;
    *reaches = true;
    for (int side = 0; side < 2 && !status; side++) {
        estimate own;
        status = quantile_of_values(pairs->value[side], pairs->group, pairs->count, q, &own);
        *reaches &= !isnan(own.low);
    }
    return status;
}

ld_status quantile_difference_of(const quantile_pairs *pairs, double q, estimate *difference)
{
    bootstrap self = {.pairs = pairs};
    bool reaches;
    *difference = (estimate){NAN, NAN, NAN};
    if (pairs->count == 0)
        return LD_OK;
    ld_status status = begin(&self, q);
    if (!status)
        status = check_reach(pairs, q, &reaches);
    if (!status) {
        for (size_t g = 0; g < self.groups; g++)
            self.drawn[g] = 1;
        difference->value = difference_of(&self);
        if (reaches && self.groups >= FEWEST_GROUPS)
            find_interval(&self, difference);
    }
    free_all(&self);
    return status;
}
