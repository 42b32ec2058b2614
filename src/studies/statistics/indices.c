#include "studies/statistics/indices.h"

#include <stdlib.h>
#include <string.h>

#include "math/curves/distributions.h"
#include "math/functions.h"

static const estimate unknown = {NAN, NAN, NAN};

enum { MOST_PARTS = 64 };

// Values less the mean of their part, and the terms of an estimate.
typedef struct frozen {
    const frozen_values *values;
    double mean[MOST_PARTS + 1];
    double variance;
    double *term; // [3][count] of S, of T, of their difference
} frozen;

static int part_of(const frozen_values *values, size_t i)
{
    return values->part ? values->part[i] : 0;
}

static void find_means(frozen *self)
{
    const frozen_values *v = self->values;
    double count[MOST_PARTS + 1] = {0}, first[MOST_PARTS + 1] = {0};
    for (size_t i = 0; i < v->count; i++) {
        int part = part_of(v, i);
        if (count[part] == 0)
            first[part] = v->a[i]; // differences from it lose no digits
        count[part] += 1;
        self->mean[part] += 0.5 * (v->a[i] - first[part] + v->b[i] - first[part]);
    }
    for (int part = 0; part <= MOST_PARTS; part++)
        self->mean[part] = first[part] + (count[part] > 0 ? self->mean[part] / count[part] : 0);
}

// A run's three values less their mean.
typedef struct triple {
    double a, b, swapped;
} triple;

static triple triple_of(const frozen *self, size_t i)
{
    const frozen_values *v = self->values;
    const double mean = self->mean[part_of(v, i)];
    return (triple){v->a[i] - mean, v->b[i] - mean, v->swapped[i] - mean};
}

// The share of a that the product of b with a run explains in that of b with the swapped one.
static double control_of(const frozen *self)
{
    double both = 0, square = 0, sum = 0, other = 0, n = (double)self->values->count;
    for (size_t i = 0; i < self->values->count; i++) {
        const triple t = triple_of(self, i);
        const double control = t.a * t.b, product = t.b * t.swapped;
        both += control * product;
        square += control * control;
        sum += control;
        other += product;
    }
    const double spread = square - sum * sum / n;
    return spread > 0 ? (both - sum * other / n) / spread : 1;
}

// The estimates, and in place of their terms what each adds to their errors.
static void find_terms(frozen *self, double *first, double *total)
{
    const size_t count = self->values->count;
    const double control = control_of(self), n = (double)count;
    double *s = self->term, *t = s + count, *both = t + count, *square = both;
    double sums[3] = {0};
    for (size_t i = 0; i < count; i++) {
        const triple of = triple_of(self, i);
        s[i] = of.b * (of.swapped - control * of.a);
        t[i] = 0.5 * (of.a - of.swapped) * (of.a - of.swapped);
        square[i] = 0.5 * (of.a * of.a + of.b * of.b);
        sums[0] += s[i];
        sums[1] += t[i];
        sums[2] += square[i];
    }
    self->variance = sums[2] / n;
    *first = sums[0] / sums[2];
    *total = sums[1] / sums[2];
    for (size_t i = 0; i < count; i++) {
        s[i] = (s[i] - *first * square[i]) / self->variance;
        t[i] = (t[i] - *total * square[i]) / self->variance;
        both[i] = t[i] - s[i];
    }
}

static ld_status find_interval(const frozen *self, int which, double value, estimate *of,
                               size_t *groups)
{
    const frozen_values *v = self->values;
    uncertain mean;
    ld_status status =
        uncertain_mean_of(self->term + (size_t)which * v->count, v->group, v->count, &mean);
    if (status)
        return status;
    double half = student_quantile(0.975, mean.freedom) * sqrt(mean.variance);
    *of = (estimate){value, value - half, value + half};
    *groups = (size_t)mean.freedom + 1;
    return LD_OK;
}

static size_t count_groups(const int64_t *group, size_t count)
{
    size_t groups = 0;
    for (size_t i = 0; i < count; i++)
        groups += i == 0 || group[i] != group[i - 1];
    return groups;
}

ld_status variance_indices_of(const frozen_values *values, variance_indices *result)
{
    frozen self = {.values = values};
    double first, total;
    *result = (variance_indices){.first = unknown, .total = unknown, .together = unknown};
    result->count = values->count;
    result->groups = count_groups(values->group, values->count);
    if (result->groups < 3)
        return LD_OK;
    self.term = malloc(3 * values->count * sizeof(double));
    if (!self.term)
        return LD_ERR_MEMORY;
    find_means(&self);
    find_terms(&self, &first, &total);
    ld_status status = LD_OK;
    if (self.variance > 0) {
        status = find_interval(&self, 0, first, &result->first, &result->groups);
        if (!status)
            status = find_interval(&self, 1, total, &result->total, &result->groups);
        if (!status)
            status = find_interval(&self, 2, total - first, &result->together, &result->groups);
    }
    free(self.term);
    return status;
}

ld_status elementary_effects_of(const double *effect, const int64_t *group, size_t count,
                                elementary_effects *result)
{
    group_statistics of;
    *result = (elementary_effects){.magnitude = unknown, .mean = unknown, .deviation = NAN};
    if (count == 0)
        return LD_OK;
    double *magnitude = malloc(count * sizeof *magnitude);
    if (!magnitude)
        return LD_ERR_MEMORY;
    for (size_t i = 0; i < count; i++)
        magnitude[i] = fabs(effect[i]);
    ld_status status = moments_of(magnitude, group, count, &of);
    result->magnitude = of.mean;
    if (!status)
        status = moments_of(effect, group, count, &of);
    if (!status) {
        result->mean = of.mean;
        result->deviation = of.deviation.value;
        result->count = of.count;
        result->groups = of.groups;
    }
    free(magnitude);
    return status;
}
