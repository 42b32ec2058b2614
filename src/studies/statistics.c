#include "studies/statistics.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "math/distributions.h"

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

// Sums over one group of the differences from the mean and of their squares.
typedef struct group_sums {
    size_t count;
    double first, second;
} group_sums;

// The sums of the group that begins at `from`; moves `from` to the next one.
static group_sums next_group(const double *value, const int64_t *group, size_t count, double mean,
                             size_t *from)
{
    group_sums sums = {0};
    int64_t this = group[*from];
    for (; *from < count && group[*from] == this; ++*from) {
        double d = value[*from] - mean;
        sums.count++;
        sums.first += d;
        sums.second += d * d;
    }
    return sums;
}

static double variance(double count, double first, double second)
{
    return (second - first * first / count) / (count - 1);
}

static const double confidence = 0.95;

// Half the width of the interval of the mean: deviation of the groups' means.
static void mean_interval(const double *value, const int64_t *group, size_t count,
                          group_statistics *result)
{
    double first = 0, second = 0, n = (double)result->groups;
    for (size_t i = 0; i < count;) {
        group_sums sums = next_group(value, group, count, result->mean.value, &i);
        double d = sums.first / (double)sums.count;
        first += d;
        second += d * d;
    }
    double t = student_quantile(0.5 + confidence / 2, n - 1);
    double half = t * sqrt(variance(n, first, second) / n);
    result->mean.low = result->mean.value - half;
    result->mean.high = result->mean.value + half;
}

// Jackknife: the logarithm of the deviation without each group in turn.
static void deviation_interval(const double *value, const int64_t *group, size_t count,
                               double second, group_statistics *result)
{
    double n = (double)count, groups = (double)result->groups, sum = 0, squares = 0;
    double all = log(result->deviation.value);
    for (size_t i = 0; i < count;) {
        group_sums sums = next_group(value, group, count, result->mean.value, &i);
        double left = n - (double)sums.count;
        double d = 0.5 * log(variance(left, -sums.first, second - sums.second)) - all;
        sum += d;
        squares += d * d;
    }
    double spread = sqrt((groups - 1) / groups * (squares - sum * sum / groups));
    double t = student_quantile(0.5 + confidence / 2, groups - 1);
    result->deviation.low = exp(all - t * spread);
    result->deviation.high = exp(all + t * spread);
}

static int by_value(const void *left, const void *right)
{
    double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

// The greatest k with P(X <= k - 1) <= p, X binomial with n and q.
static long order_below(long n, double q, double p)
{
    long low = 0, high = n;
    while (low < high) {
        long middle = (low + high + 1) / 2;
        if (binomial_cumulative(middle - 1, n, q) <= p)
            low = middle;
        else
            high = middle - 1;
    }
    return low;
}

// Quantile of sorted values, linear between them (Hyndman and Fan's definition 7).
static estimate quantile_of(const double *sorted, size_t count, double q, bool independent)
{
    double at = q * (double)(count - 1);
    size_t i = (size_t)at, next = i + 1 < count ? i + 1 : i;
    estimate result = {sorted[i] + (at - (double)i) * (sorted[next] - sorted[i]), NAN, NAN};
    long n = (long)count, low = order_below(n, q, (1 - confidence) / 2);
    long high = n - order_below(n, 1 - q, (1 - confidence) / 2) + 1;
    if (independent && low >= 1 && high <= n) {
        result.low = sorted[low - 1];
        result.high = sorted[high - 1];
    }
    return result;
}

void statistics_of(double *value, const int64_t *group, size_t count, group_statistics *result)
{
    double n = (double)count, first = 0, second = 0, third = 0;
    *result = (group_statistics){.count = count};
    result->mean = result->deviation = (estimate){NAN, NAN, NAN};
    result->skewness = result->least = result->greatest = NAN;
    for (int k = 0; k < STATISTICS_QUANTILES; k++)
        result->quantile[k] = (estimate){NAN, NAN, NAN};
    if (count == 0)
        return;
    for (size_t i = 0; i < count; i++)
        result->groups += i == 0 || group[i] != group[i - 1];
    double mean = result->mean.value = mean_of(value, count);
    for (size_t i = 0; i < count; i++) {
        double d = value[i] - mean;
        first += d;
        second += d * d;
        third += d * d * d;
    }
    double squares = variance(n, first, second);
    result->deviation.value = count > 1 ? sqrt(fmax(0, squares)) : NAN;
    if (count > 2 && second > 0)
        result->skewness = third / n / pow(second / n, 1.5) * sqrt(n * (n - 1)) / (n - 2);
    if (result->groups > 1)
        mean_interval(value, group, count, result);
    if (result->groups > 2 && squares > 0)
        deviation_interval(value, group, count, second, result);
    qsort(value, count, sizeof *value, by_value);
    result->least = value[0];
    result->greatest = value[count - 1];
    for (int k = 0; k < STATISTICS_QUANTILES; k++)
        result->quantile[k] =
            quantile_of(value, count, statistics_level[k], result->groups == count);
}

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
        .semi_axis = {sqrt(half + apart), sqrt(fmax(0, half - apart))},
        .angle = 0.5 * atan2(2 * xy, xx - yy),
    };
}
