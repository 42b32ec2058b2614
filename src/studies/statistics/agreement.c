#include "studies/statistics/agreement.h"

#include <stdlib.h>

#include "math/curves/distributions.h"
#include "math/functions.h"

// The difference of two estimates with its interval; *chance: p.
static estimate welch(const uncertain *first, const uncertain *second, double *chance)
{
    double difference = first->value - second->value;
    double variance = first->variance + second->variance;
    double freedom = variance * variance /
                     (first->variance * first->variance / first->freedom +
                      second->variance * second->variance / second->freedom);
    *chance = NAN;
    if (!(variance > 0) || !isfinite(freedom))
        return (estimate){isfinite(difference) ? difference : NAN, NAN, NAN};
    *chance = student_beyond(difference / sqrt(variance), freedom);
    double half = student_quantile(0.975, freedom) * sqrt(variance);
    return (estimate){difference, difference - half, difference + half};
}

// The logarithm of the mean distance from the median.
static ld_status log_distance(grouped_values of, uncertain *result)
{
    double *distance = malloc((of.count + 1) * sizeof *distance);
    uncertain mean;
    *result = (uncertain){NAN, NAN, NAN};
    if (!distance)
        return LD_ERR_MEMORY;
    for (size_t i = 0; i < of.count; i++)
        distance[i] = of.value[i];
    sort_values(distance, of.count);
    double median = of.count ? sorted_quantile(distance, of.count, 0.5) : NAN;
    for (size_t i = 0; i < of.count; i++)
        distance[i] = fabs(of.value[i] - median);
    ld_status status = uncertain_mean_of(distance, of.group, of.count, &mean);
    if (!status && mean.freedom > 1 && mean.value > 0)
        *result =
            (uncertain){log(mean.value), mean.variance / (mean.value * mean.value), mean.freedom};
    free(distance);
    return status;
}

static ld_status mean_and_distance(grouped_values of, uncertain *mean, uncertain *distance)
{
    ld_status status = uncertain_mean_of(of.value, of.group, of.count, mean);
    return status ? status : log_distance(of, distance);
}

ld_status agreement_of(grouped_values first, grouped_values second, agreement *result)
{
    uncertain mean[2], distance[2];
    ld_status status = mean_and_distance(first, &mean[0], &distance[0]);
    if (!status)
        status = mean_and_distance(second, &mean[1], &distance[1]);
    if (status)
        return status;
    estimate ratio = welch(&distance[0], &distance[1], &result->deviation_chance);
    result->mean = welch(&mean[0], &mean[1], &result->mean_chance);
    result->deviation = (estimate){exp(ratio.value), exp(ratio.low), exp(ratio.high)};
    return LD_OK;
}
