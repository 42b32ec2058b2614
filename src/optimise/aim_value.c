#include "optimise/aim_value.h"

#include <math.h>

#include "math/curves/distributions.h"
#include "studies/statistics/statistics.h"

static const double pi = 3.14159265358979323846;

aim_blocks aim_blocks_of(const aim_plan *aim, int samples, int hypercubes)
{
    enum { LEAST = 20, HALVES = 100 }; // samples of a quantile
    if (hypercubes > 0)
        return (aim_blocks){hypercubes, false};
    if (aim->take == LD_AIM_QUANTILE)
        return (aim_blocks){samples < LEAST ? 0 : HALVES, true};
    return (aim_blocks){samples, false};
}

// A part of the samples; -1: all.
typedef struct rest {
    const aim_samples *of;
    aim_blocks blocks;
    int part;
} rest;

// One of the two samples of each pair, by a bit of a mixed number.
static bool is_in_half(int half, int sample)
{
    uint64_t z = ((uint64_t)half << 32 | (uint64_t)(sample / 2)) * 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return ((z >> 40) & 1u) == (uint64_t)(sample % 2);
}

static bool is_left(const rest *self, int sample)
{
    int64_t n = self->of->samples, count = self->blocks.count;
    if (self->part < 0)
        return true;
    if (self->blocks.halves)
        return is_in_half(self->part, sample);
    return sample < n * self->part / count || sample >= n * (self->part + 1) / count;
}

static double at(const rest *self, int sample, int rocket, int result)
{
    const aim_samples *of = self->of;
    return of->value[(sample * of->rockets + rocket) * of->results + result];
}

// Copies a result of all rockets; returns how many.
static size_t gather(const rest *self, int result, double *work)
{
    size_t count = 0;
    for (int i = 0; i < self->of->samples; i++)
        for (int k = 0; k < self->of->rockets && is_left(self, i); k++)
            work[count++] = at(self, i, k, result);
    return count;
}

static double mean_of(const double *value, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += value[i];
    return sum / (double)count;
}

static double variance(const rest *self, int result, double *work)
{
    size_t count = gather(self, result, work);
    double mean = mean_of(work, count), sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += (work[i] - mean) * (work[i] - mean);
    return sum / (double)(count - 1);
}

static double mean_greatest(const rest *self, int result, double *work)
{
    size_t count = 0;
    for (int i = 0; i < self->of->samples; i++) {
        if (!is_left(self, i))
            continue;
        work[count] = at(self, i, 0, result);
        for (int k = 1; k < self->of->rockets; k++)
            work[count] = fmax(work[count], at(self, i, k, result));
        count++;
    }
    return mean_of(work, count);
}

// Of two results.
static double covariance(const rest *self, int first, int second, double *work)
{
    size_t count = gather(self, second, work), i = 0;
    double mean = mean_of(work, count), sum = 0;
    for (int s = 0; s < self->of->samples; s++)
        for (int k = 0; k < self->of->rockets && is_left(self, s); k++)
            sum += at(self, s, k, first) * (work[i++] - mean);
    return sum / (double)(count - 1);
}

// Of the ellipse that holds 95 % of a normal distribution: pi r^2 sqrt(det C).
static double ellipse_area(const rest *self, const aim_plan *aim, double *work)
{
    double xx = variance(self, aim->first, work), yy = variance(self, aim->second, work);
    double xy = covariance(self, aim->first, aim->second, work);
    return pi * ellipse_radius * ellipse_radius * sqrt(fmax(xx * yy - xy * xy, 0));
}

double aim_value(const aim_plan *aim, const aim_samples *of, aim_blocks blocks, int part,
                 double *work)
{
    const rest self = {of, blocks, part};
    size_t count;
    switch (aim->take) {
    case LD_AIM_MEAN:
        count = gather(&self, aim->first, work);
        return mean_of(work, count);
    case LD_AIM_DEVIATION:
        return sqrt(variance(&self, aim->first, work) +
                    (aim->second >= 0 ? variance(&self, aim->second, work) : 0));
    case LD_AIM_GREATEST:
        return mean_greatest(&self, aim->first, work);
    case LD_AIM_QUANTILE:
        count = gather(&self, aim->first, work);
        sort_values(work, count);
        return sorted_quantile(work, count, aim->level);
    case LD_AIM_FOOTPRINT:
        return ellipse_area(&self, aim, work);
    case LD_AIM_GAIN_MARGIN:
    case LD_AIM_PHASE_MARGIN: // not of samples
        break;
    }
    return NAN;
}

ld_estimate aim_estimate(const aim_plan *aim, const aim_samples *of, const aim_samples *from,
                         aim_blocks blocks, double *work)
{
    const double upper = 0.975;
    double sum = 0, square = 0, n = blocks.count;
    double value =
        aim_value(aim, of, blocks, -1, work) - (from ? aim_value(aim, from, blocks, -1, work) : 0);
    if (blocks.count < 2)
        return (ld_estimate){value, NAN, NAN};
    for (int i = 0; i < blocks.count; i++) {
        double part = aim_value(aim, of, blocks, i, work) -
                      (from ? aim_value(aim, from, blocks, i, work) : 0) - value;
        sum += part;
        square += part * part;
    }
    double variance_of = blocks.halves ? square / n : fmax(square - sum * sum / n, 0) * (n - 1) / n;
    double half = student_quantile(upper, n - 1) * sqrt(variance_of);
    return (ld_estimate){value, value - half, value + half};
}
