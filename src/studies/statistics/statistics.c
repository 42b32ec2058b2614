#include "studies/statistics/statistics.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "math/curves/distributions.h"
#include "math/functions.h"

const double statistics_level[STATISTICS_QUANTILES] = {0.05, 0.5, 0.95};

static double mean_of(const double *value, size_t count)
{
    double sum = 0, rest = 0;
    for (size_t i = 0; i < count; i++)
        sum += value[i];
    double mean = sum / (double)count;
    for (size_t i = 0; i < count; i++)
        rest += value[i] - mean;
    return mean + rest / (double)count;
}

// ---- groups

// Sums over one group of the differences from the mean of all and of their squares.
typedef struct group_sums {
    double count, first, second;
} group_sums;

typedef struct grouped {
    const double *value;
    const int64_t *group;
    size_t count, groups;
    group_sums all;
    group_sums *of; // [groups]
} grouped;

static void add(group_sums *sums, group_sums more)
{
    sums->count += more.count;
    sums->first += more.first;
    sums->second += more.second;
}

static ld_status sum_groups(grouped *self, double mean)
{
    self->of = calloc(self->groups, sizeof *self->of);
    if (!self->of)
        return LD_ERR_MEMORY;
    for (size_t i = 0, g = 0; i < self->count; i++) {
        double d = self->value[i] - mean;
        g += i > 0 && self->group[i] != self->group[i - 1];
        add(&self->of[g], (group_sums){1, d, d * d});
    }
    for (size_t g = 0; g < self->groups; g++)
        add(&self->all, self->of[g]);
    return LD_OK;
}

static double variance(group_sums sums)
{
    return (sums.second - sums.first * sums.first / sums.count) / (sums.count - 1);
}

static const double confidence = 0.95;

static double student(const grouped *self)
{
    return student_quantile(0.5 + confidence / 2, (double)self->groups - 1);
}

// ---- mean

// Variance of the mean of all values: that of a ratio of sums over groups.
static double variance_of_mean(const grouped *self)
{
    double squares = 0, g = (double)self->groups, n = self->all.count;
    for (size_t i = 0; i < self->groups; i++)
        squares += self->of[i].first * self->of[i].first;
    return g / (g - 1) * squares / (n * n);
}

static void mean_interval(const grouped *self, estimate *mean)
{
    double half = student(self) * sqrt(variance_of_mean(self));
    mean->low = mean->value - half;
    mean->high = mean->value + half;
}

// ---- standard deviation

// Standard error of the logarithm of the variance: jackknife over groups.
static double jackknife_error(const grouped *self)
{
    double g = (double)self->groups, sum = 0, squares = 0, all = log(variance(self->all));
    for (size_t i = 0; i < self->groups; i++) {
        group_sums rest = self->all, of = self->of[i];
        add(&rest, (group_sums){-of.count, -of.first, -of.second});
        double d = log(variance(rest)) - all;
        sum += d;
        squares += d * d;
    }
    return sqrt((g - 1) / g * (squares - sum * sum / g));
}

// The same to first order, of the groups of these numbers.
static double linear_error(const grouped *self, const uint32_t *number, group_sums sums)
{
    double g = (double)self->groups, mean = sums.first / sums.count, squares = 0;
    double second = sums.second / sums.count - mean * mean;
    for (size_t i = 0; i < self->groups; i++) {
        group_sums of = self->of[number[i]];
        double d = of.second - mean * (2 * of.first - of.count * mean) - of.count * second;
        squares += d * d;
    }
    return sqrt(g / (g - 1) * squares) / (sums.count * second);
}

// Draws as many groups as there are, with replacement.
static group_sums draw_groups(const grouped *self, const uint32_t *drawn, uint32_t *number)
{
    group_sums sums = {0};
    for (size_t i = 0; i < self->groups; i++) {
        number[i] = (uint32_t)((uint64_t)drawn[i] * self->groups >> 32);
        add(&sums, self->of[number[i]]);
    }
    return sums;
}

static int by_value(const void *left, const void *right)
{
    double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

void sort_values(double *value, size_t count)
{
    qsort(value, count, sizeof *value, by_value);
}

// Fewer groups: resamples are degenerate; more: Student's t does as well.
enum { RESAMPLES = 999, FEWEST = 8, MOST = 1000 };
typedef struct resample {
    uint32_t drawn[MOST];
} resample;

// Resamples with at least so many random numbers, which are sampled once for all studies.
static const resample *draw_resamples(size_t count)
{
    static const uint64_t key[2] = {0x626f6f7473747261, 0x70}; // "bootstrap"
    static resample all[RESAMPLES];
    static size_t known = 0;
    static pthread_mutex_t drawing = PTHREAD_MUTEX_INITIALIZER;
    pthread_mutex_lock(&drawing);
    for (; known < count; known += 8)
        for (uint64_t b = 0; b < RESAMPLES; b++) {
            uint64_t words[4];
            random_block(key, (uint64_t[]){b, known / 8, 0, 0}, words);
            for (int i = 0; i < 8; i++)
                all[b].drawn[known + (size_t)i] = (uint32_t)(words[i / 2] >> i % 2 * 32);
        }
    pthread_mutex_unlock(&drawing);
    return all;
}

// Quantiles of the studentised logarithm of the variance, t[0] < 0 < t[1] (Efron and Tibshirani, An
// introduction to the bootstrap, 1993, section 12.5).
static void bootstrap_quantiles(const grouped *self, double t[2])
{
    const resample *resamples = draw_resamples(self->groups);
    double ratio[RESAMPLES], all = log(variance(self->all));
    uint32_t number[MOST];
    for (int b = 0; b < RESAMPLES; b++) {
        group_sums sums = draw_groups(self, resamples[b].drawn, number);
        double error = linear_error(self, number, sums);
        ratio[b] = error > 0 ? (log(variance(sums)) - all) / error : 0;
    }
    sort_values(ratio, RESAMPLES);
    int beyond = (int)((RESAMPLES + 1) * (1 - confidence) / 2);
    t[0] = ratio[beyond - 1];
    t[1] = ratio[RESAMPLES - beyond];
}

static void deviation_interval(const grouped *self, estimate *deviation)
{
    double error = jackknife_error(self), t[2] = {-student(self), student(self)};
    if (self->groups >= FEWEST && self->groups <= MOST)
        bootstrap_quantiles(self, t);
    deviation->low = deviation->value * exp(-0.5 * t[1] * error);
    deviation->high = deviation->value * exp(-0.5 * t[0] * error);
}

// ---- quantiles

// Value at the place `at`, from 0, among sorted ones, linear between them.
static double value_at(const double *sorted, size_t count, double at)
{
    size_t i = (size_t)at, next = i + 1 < count ? i + 1 : i;
    return sorted[i] + (at - (double)i) * (sorted[next] - sorted[i]);
}

double sorted_quantile(const double *sorted, size_t count, double level)
{
    return value_at(sorted, count, level * (double)(count - 1));
}

// The t at which the order statistic t (n + 1) of n independent values, as a real number, lies
// below their distribution's quantile q with this probability (Hutson, J. Appl. Statist. 26, 1999).
static double fractional_order(double n, double q, double probability)
{
    double low = 0, high = 1;
    for (int i = 0; i < 60; i++) {
        double t = 0.5 * (low + high);
        if (beta_cumulative((n + 1) * t, (n + 1) * (1 - t), q) > probability)
            low = t;
        else
            high = t;
    }
    return 0.5 * (low + high);
}

// How many independent values would tell the share of those up to `limit` as well as these groups
// do (Korn and Graubard, Survey Methodology 24, 1998).
static double effective_number(const grouped *self, double limit)
{
    double n = (double)self->count, g = (double)self->groups, below = 0, squares = 0;
    if (self->groups == self->count)
        return n;
    for (size_t i = 0; i < self->count; i++)
        below += self->value[i] <= limit;
    double share = below / n;
    for (size_t i = 0, k = 0; k < self->groups; k++) {
        double d = -share * self->of[k].count;
        for (size_t end = i + (size_t)self->of[k].count; i < end; i++)
            d += self->value[i] <= limit;
        squares += d * d;
    }
    // a group's number of values is whole: known no better than to a half
    double simple = share * (1 - share) / n;
    double of_share = fmax(g / (g - 1) * squares / (n * n), fmin(simple, g / (4 * n * n)));
    double t = student_quantile(0.5 + confidence / 2, n - 1) / student(self);
    return fmax(1, simple / of_share * n * t * t);
}

// No interval where its ends would lie beyond the least or greatest of `reach` independent values.
static estimate quantile_of(const grouped *self, const double *sorted, double q, double reach)
{
    double n = (double)self->count, tail = (1 - confidence) / 2;
    estimate result = {sorted_quantile(sorted, self->count, q), NAN, NAN};
    double low = fractional_order(reach, q, 1 - tail), high = fractional_order(reach, q, tail);
    if (low * (reach + 1) < 1 || (1 - high) * (reach + 1) < 1)
        return result;
    double number = effective_number(self, result.value);
    double from = fractional_order(number, q, 1 - tail) * (n + 1) - 1;
    double to = fractional_order(number, q, tail) * (n + 1) - 1;
    if (from >= 0 && to <= n - 1) {
        result.low = value_at(sorted, self->count, from);
        result.high = value_at(sorted, self->count, to);
    }
    return result;
}

static ld_status quantiles(const grouped *self, double reach, group_statistics *result)
{
    double *sorted = malloc(self->count * sizeof *sorted);
    if (!sorted)
        return LD_ERR_MEMORY;
    memcpy(sorted, self->value, self->count * sizeof *sorted);
    sort_values(sorted, self->count);
    result->least = sorted[0];
    result->greatest = sorted[self->count - 1];
    for (int k = 0; k < STATISTICS_QUANTILES; k++)
        result->quantile[k] = quantile_of(self, sorted, statistics_level[k], reach);
    free(sorted);
    return LD_OK;
}

// ---- all of them

static double skewness(const grouped *self, double mean)
{
    double n = self->all.count, third = 0, rest = self->all.first / n;
    for (size_t i = 0; i < self->count; i++) {
        double d = self->value[i] - mean - rest;
        third += d * d * d;
    }
    if (n < 3 || !(self->all.second > 0))
        return NAN;
    return third / n / pow(self->all.second / n, 1.5) * sqrt(n * (n - 1)) / (n - 2);
}

// Counts the groups and sums over them; mean and variance of all values, of which there is one or
// more.
static ld_status gather_groups(grouped *self, double *mean, double *squares)
{
    for (size_t i = 0; i < self->count; i++)
        self->groups += i == 0 || self->group[i] != self->group[i - 1];
    *mean = mean_of(self->value, self->count);
    ld_status status = sum_groups(self, *mean);
    if (status)
        return status;
    *squares = self->count > 1 ? variance(self->all) : NAN;
    *squares = *squares < 0 ? 0 : *squares; // that of infinite values stays NaN
    return LD_OK;
}

// All but the order of the values; *reach: how many independent ones would tell the mean as well.
static ld_status moments(grouped *self, group_statistics *result, double *reach)
{
    static const estimate none = {NAN, NAN, NAN};
    double squares;
    *result = (group_statistics){.count = self->count, .mean = none, .deviation = none};
    result->skewness = result->least = result->greatest = NAN;
    for (int k = 0; k < STATISTICS_QUANTILES; k++)
        result->quantile[k] = none;
    *reach = 0;
    if (self->count == 0)
        return LD_OK;
    ld_status status = gather_groups(self, &result->mean.value, &squares);
    if (status)
        return status;
    result->groups = self->groups;
    result->skewness = skewness(self, result->mean.value);
    result->deviation.value = sqrt(squares);
    if (self->groups > 1) {
        mean_interval(self, &result->mean);
        *reach = squares / variance_of_mean(self);
    }
    if (self->groups > 2 && squares > 0)
        deviation_interval(self, &result->deviation);
    return LD_OK;
}

ld_status uncertain_mean_of(const double *value, const int64_t *group, size_t count,
                            uncertain *mean)
{
    grouped self = {.value = value, .group = group, .count = count};
    double squares;
    *mean = (uncertain){NAN, NAN, NAN};
    ld_status status = count > 0 ? gather_groups(&self, &mean->value, &squares) : LD_OK;
    if (!status && self.groups > 1)
        *mean = (uncertain){mean->value, variance_of_mean(&self), (double)self.groups - 1};
    free(self.of);
    return status;
}

ld_status moments_of(const double *value, const int64_t *group, size_t count,
                     group_statistics *result)
{
    grouped self = {.value = value, .group = group, .count = count};
    double reach;
    ld_status status = moments(&self, result, &reach);
    free(self.of);
    return status;
}

ld_status statistics_of(const double *value, const int64_t *group, size_t count,
                        group_statistics *result)
{
    grouped self = {.value = value, .group = group, .count = count};
    double reach;
    ld_status status = moments(&self, result, &reach);
    if (!status && count > 0)
        status = quantiles(&self, reach, result);
    free(self.of);
    return status;
}

ld_status quantile_of_values(const double *value, const int64_t *group, size_t count, double q,
                             estimate *quantile)
{
    grouped self = {.value = value, .group = group, .count = count};
    group_statistics of;
    double reach, *sorted = malloc((count + 1) * sizeof *sorted);
    *quantile = (estimate){NAN, NAN, NAN};
    ld_status status = sorted ? moments(&self, &of, &reach) : LD_ERR_MEMORY;
    if (!status && count > 0) {
        memcpy(sorted, value, count * sizeof *sorted);
        sort_values(sorted, count);
        *quantile = quantile_of(&self, sorted, q, reach);
    }
    free(sorted);
    free(self.of);
    return status;
}

// ---- tails

ld_status tail_quantile_of(const double *value, const int64_t *group, size_t count, double q,
                           estimate *quantile, double *independent)
{
    grouped self = {.value = value, .group = group, .count = count};
    double mean, squares, n = (double)count, tail = (1 - confidence) / 2;
    double *sorted = malloc(count * sizeof *sorted);
    ld_status status = sorted ? gather_groups(&self, &mean, &squares) : LD_ERR_MEMORY;
    if (!status) {
        memcpy(sorted, value, count * sizeof *sorted);
        sort_values(sorted, count);
        *quantile = (estimate){value_at(sorted, count, fmax(0, q * (n + 1) - 1)), NAN, NAN};
        *independent = fmin(*independent, effective_number(&self, quantile->value));
        double from = fractional_order(*independent, q, 1 - tail) * (n + 1) - 1;
        double to = fractional_order(*independent, q, tail) * (n + 1) - 1;
        if (from >= 0)
            quantile->low = value_at(sorted, count, from);
        if (to <= n - 1)
            quantile->high = value_at(sorted, count, to);
    }
    free(sorted);
    free(self.of);
    return status;
}

// The x below which a beta distribution has this probability.
static double beta_quantile(double a, double b, double probability)
{
    double low = 0, high = 1;
    for (int i = 0; i < 60; i++) {
        double x = 0.5 * (low + high);
        if (beta_cumulative(a, b, x) < probability)
            low = x;
        else
            high = x;
    }
    return 0.5 * (low + high);
}

estimate share_below_quantile(double independent, double q)
{
    double a = q * (independent + 1), b = (1 - q) * (independent + 1);
    double tail = (1 - confidence) / 2;
    return (estimate){q, beta_quantile(a, b, tail), beta_quantile(a, b, 1 - tail)};
}

estimate share_interval(const uncertain *mean, size_t count)
{
    double p = mean->value, n = (double)count, groups = mean->freedom + 1, tail = confidence / 2;
    if (isnan(mean->variance))
        return (estimate){p, NAN, NAN};
    // a group's number is whole: known no better than to a half
    double simple = p * (1 - p) / n,
           of_share = fmax(mean->variance, fmin(simple, groups / (4 * n * n)));
    double t = student_quantile(0.5 + tail, n - 1) / student_quantile(0.5 + tail, mean->freedom);
    double number = simple > 0 ? fmin(fmax(1, simple / of_share * n * t * t), n) : groups;
    double x = p * number, rest = number - x, outside = 0.5 - tail;
    return (estimate){p, x > 0 ? beta_quantile(x, rest + 1, outside) : 0,
                      rest > 0 ? beta_quantile(x + 1, rest, 1 - outside) : 1};
}

const double ellipse_radius = 2.4477468306808161;

void covariance_ellipse_of(const double *x, const double *y, size_t count,
                           covariance_ellipse *result)
{
    double mx = mean_of(x, count), my = mean_of(y, count), xx = 0, xy = 0, yy = 0;
    for (size_t i = 0; i < count; i++) {
        xx += (x[i] - mx) * (x[i] - mx);
        xy += (x[i] - mx) * (y[i] - my);
        yy += (y[i] - my) * (y[i] - my);
    }
    double n = (double)count - 1, half = 0.5 * (xx + yy) / n;
    double apart = hypot(0.5 * (xx - yy), xy) / n;
    *result = (covariance_ellipse){
        .mean = {mx, my},
        .semi_axis = {sqrt(half + apart), half > apart ? sqrt(half - apart) : 0},
        .angle = 0.5 * atan2(2 * xy, xx - yy),
    };
}

ld_status covariance_ellipse_intervals(const double *x, const double *y, const int64_t *group,
                                       size_t count, const covariance_ellipse *ellipse,
                                       estimate semi_axis[2])
{
    double *along = malloc(count * sizeof *along);
    ld_status status = along ? LD_OK : LD_ERR_MEMORY;
    for (int k = 0; k < 2 && !status; k++) {
        group_statistics of;
        double cosine = cos(ellipse->angle), sine = sin(ellipse->angle);
        for (size_t i = 0; i < count; i++) {
            double dx = x[i] - ellipse->mean[0], dy = y[i] - ellipse->mean[1];
            along[i] = k ? dy * cosine - dx * sine : dx * cosine + dy * sine;
        }
        status = statistics_of(along, group, count, &of);
        semi_axis[k] = of.deviation;
    }
    free(along);
    return status;
}
