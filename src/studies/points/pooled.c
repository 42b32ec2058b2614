#include "studies/points/pooled.h"

#include <stdlib.h>

#include "math/curves/distributions.h"
#include "math/functions.h"
#include "studies/statistics/quantile_difference.h"

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the study's pools");
}

void pooled_free(pooled *self)
{
    free(self->row);
    free(self->sample);
    free(self->value[0]);
    for (int k = 0; k < 2; k++)
        study_values_free(&self->read[k]);
    *self = (pooled){0};
}

// ---- rows

void pooled_begin(pooled *self, int columns)
{
    self->columns = columns;
    self->points = 0;
    self->count = 0;
}

static bool reserve(pooled *self, size_t more)
{
    size_t needed = self->count + more;
    if (needed <= self->capacity)
        return true;
    size_t capacity = needed > 2 * self->capacity ? needed : 2 * self->capacity;
    pooled_row *row = realloc(self->row, capacity * sizeof *row);
    self->row = row ? row : self->row;
    self->capacity = row ? capacity : self->capacity;
    return row;
}

static void append(pooled *self, const study_values *values, const double *const *reference)
{
    for (size_t i = 0; i < values->count; i++) {
        pooled_row *row = &self->row[self->count++];
        *row =
            (pooled_row){values->sample[i], values->group[i], self->points, values->rocket[i], {0}};
        for (int c = 0; c < self->columns; c++) {
            row->value[c] = values->value[c][i];
            row->value[POOLED_COLUMNS + c] = reference ? reference[c][i] : 0;
        }
    }
    self->points += values->count > 0;
}

ld_status pooled_add(pooled *self, const study_data *data, const study_point *point,
                     const study_point *reference, const study_column *const *column,
                     ld_error *error)
{
    const paired_points points = {data, point, reference};
    paired_values pairs = {0};
    ld_status status =
        reference ? against_read_pairs(&points, column, self->columns, self->read, &pairs, error)
                  : study_data_read(data, point, column, self->columns, &self->read[0], error);
    if (status)
        return status;
    if (!reserve(self, self->read[0].count))
        return no_memory(error);
    append(self, &self->read[0], reference ? pairs.reference : NULL);
    return LD_OK;
}

static int by_sample(const void *left, const void *right)
{
    const pooled_row *a = left, *b = right;
    if (a->sample != b->sample)
        return (a->sample > b->sample) - (a->sample < b->sample);
    return a->rocket - b->rocket;
}

ld_status pooled_end(pooled *self)
{
    size_t count = self->count;
    free(self->sample);
    free(self->value[0]);
    self->sample = malloc((2 * count + 1) * sizeof *self->sample);
    self->value[0] = malloc((POOLED_NUMBERS * count + 1) * sizeof(double));
    if (!self->sample || !self->value[0])
        return LD_ERR_MEMORY;
    self->group = self->sample + count;
    for (int k = 1; k < POOLED_NUMBERS; k++)
        self->value[k] = self->value[0] + (size_t)k * count;
    if (self->points > 1)
        qsort(self->row, count, sizeof *self->row, by_sample);
    for (size_t i = 0; i < count; i++) {
        self->sample[i] = self->row[i].sample;
        self->group[i] = self->row[i].group;
    }
    return LD_OK;
}

size_t pooled_groups(const pooled *self)
{
    size_t groups = 0;
    for (size_t i = 0; i < self->count; i++)
        groups += i == 0 || self->group[i] != self->group[i - 1];
    return groups;
}

// ---- points of equal weight

typedef struct point_sums {
    double count, mean;
} point_sums;

static void sum_points(const pooled *self, int number, point_sums *of)
{
    for (size_t i = 0; i < self->count; i++)
        of[self->row[i].point].count += 1;
    for (size_t i = 0; i < self->count; i++) {
        point_sums *sums = &of[self->row[i].point];
        sums->mean += self->row[i].value[number] / sums->count;
    }
}

// What a value's distance from its point's mean is multiplied by: for the mean, so that that of all
// values has the variance of the mean of the points' means; else, so that the variance of all
// values is the mean of the points' variances.
static double weight_of(const pooled *self, const point_sums *of, bool spread, double scattering)
{
    double n = (double)self->count;
    if (!spread)
        return n / (self->points * of->count);
    return of->count > 1 ? sqrt((n - 1) / (scattering * (of->count - 1))) : 0;
}

// Writes number `number` of all rows with the points' means moved to their mean.
static ld_status weigh(const pooled *self, int number, bool spread)
{
    double *to = self->value[number];
    for (size_t i = 0; i < self->count; i++)
        to[i] = self->row[i].value[number];
    if (self->points < 2)
        return LD_OK;
    double mean = 0, scattering = 0;
    point_sums *of = calloc((size_t)self->points, sizeof *of);
    if (!of)
        return LD_ERR_MEMORY;
    sum_points(self, number, of);
    for (int p = 0; p < self->points; p++) {
        mean += of[p].mean / self->points;
        scattering += of[p].count > 1;
    }
    for (size_t i = 0; i < self->count; i++) {
        const point_sums *own = &of[self->row[i].point];
        to[i] = mean + (to[i] - own->mean) * weight_of(self, own, spread, scattering);
    }
    free(of);
    return LD_OK;
}

// ---- estimates

ld_status pooled_mean(const pooled *self, uncertain *mean)
{
    ld_status status = weigh(self, 0, false);
    return status ? status : uncertain_mean_of(self->value[0], self->group, self->count, mean);
}

estimate interval_of(const uncertain *mean)
{
    double half =
        isnan(mean->variance) ? NAN : student_quantile(0.975, mean->freedom) * sqrt(mean->variance);
    return (estimate){mean->value, mean->value - half, mean->value + half};
}

// Whether some point has two values.
static bool scatters(const pooled *self)
{
    return self->count > (size_t)self->points;
}

ld_status pooled_deviation(const pooled *self, estimate *deviation)
{
    group_statistics of;
    *deviation = (estimate){NAN, NAN, NAN};
    if (!scatters(self))
        return LD_OK;
    ld_status status = weigh(self, 0, true);
    if (!status)
        status = moments_of(self->value[0], self->group, self->count, &of);
    if (!status)
        *deviation = of.deviation;
    return status;
}

ld_status pooled_quantile(const pooled *self, double q, estimate *quantile)
{
    for (size_t i = 0; i < self->count; i++)
        self->value[0][i] = self->row[i].value[0];
    return quantile_of_values(self->value[0], self->group, self->count, q, quantile);
}

ld_status pooled_quantile_difference(const pooled *self, double q, estimate *difference)
{
    double *const reference = self->value[POOLED_COLUMNS];
    const quantile_pairs pairs = {{self->value[0], reference}, self->group, self->count};
    for (size_t i = 0; i < self->count; i++) {
        self->value[0][i] = self->row[i].value[0];
        reference[i] = self->row[i].value[POOLED_COLUMNS];
    }
    return quantile_difference_of(&pairs, q, difference);
}

static ld_status compare(const pooled *self, bool spread, paired_statistics *of)
{
    paired_values pairs = {.columns = self->columns,
                           .sample = self->sample,
                           .group = self->group,
                           .count = self->count};
    ld_status status = LD_OK;
    for (int c = 0; c < self->columns && !status; c++) {
        pairs.value[c] = self->value[c];
        pairs.reference[c] = self->value[POOLED_COLUMNS + c];
        status = weigh(self, c, spread);
        if (!status)
            status = weigh(self, POOLED_COLUMNS + c, spread);
    }
    return status ? status : paired_statistics_of(&pairs, of);
}

ld_status pooled_pairs(const pooled *self, paired_statistics *of)
{
    static const estimate none = {NAN, NAN, NAN};
    paired_statistics spread;
    ld_status status = compare(self, false, of);
    if (status || self->points < 2)
        return status;
    of->spread = of->within = none;
    if (scatters(self) && (status = compare(self, true, &spread)) == LD_OK) {
        of->spread = spread.spread;
        of->within = spread.within;
    }
    return status;
}
