#include "studies/statistics/normality.h"

#include <string.h>

#include "math/curves/distributions.h"
#include "math/functions.h"
#include "studies/statistics/statistics.h"

// The third moments of two numbers and the fourth of their distance.
enum { MOMENTS = 5, FOURTH = 4 };

const double normality_level = 0.05;

// Axes in which a cloud has the covariance 1, about its mean; its deviations have n in the
// denominator.
typedef struct standard_axes {
    double mean[2], deviation[2], cosine, sine;
} standard_axes;

static standard_axes axes_of(const double *x, const double *y, size_t count)
{
    covariance_ellipse e;
    covariance_ellipse_of(x, y, count, &e);
    double less = sqrt(((double)count - 1) / (double)count);
    return (standard_axes){
        .mean = {e.mean[0], e.mean[1]},
        .deviation = {e.semi_axis[0] * less, e.semi_axis[1] * less},
        .cosine = cos(e.angle),
        .sine = sin(e.angle),
    };
}

// A point's part in each moment: Hermite's polynomials, whose mean is 0 and which are uncorrelated
// of a normal distribution; their means over a cloud in its own axes are its moments.
static void polynomials(const standard_axes *axes, double x, double y, double h[MOMENTS])
{
    double dx = x - axes->mean[0], dy = y - axes->mean[1];
    double u = (dx * axes->cosine + dy * axes->sine) / axes->deviation[0];
    double v = (dy * axes->cosine - dx * axes->sine) / axes->deviation[1];
    double square = u * u + v * v;
    h[0] = u * (u * u - 3);
    h[1] = v * (u * u - 1);
    h[2] = u * (v * v - 1);
    h[3] = v * (v * v - 3);
    h[FOURTH] = square * square - 8 * square + 8;
}

// How many times as large the variance of the moments' sums over groups is as that of their points.
static double design_effect(const standard_axes *axes, const double *x, const double *y,
                            const int64_t *group, size_t count, const double mean[MOMENTS])
{
    double of_groups[MOMENTS] = {0}, of_points[MOMENTS] = {0}, sum[MOMENTS] = {0}, h[MOMENTS];
    for (size_t i = 0; i < count; i++) {
        polynomials(axes, x[i], y[i], h);
        bool last = i + 1 == count || group[i + 1] != group[i];
        for (int k = 0; k < MOMENTS; k++) {
            double off = h[k] - mean[k];
            of_points[k] += off * off;
            sum[k] += off;
            of_groups[k] += last ? sum[k] * sum[k] : 0;
        }
        if (last)
            memset(sum, 0, sizeof sum);
    }
    double effect = 0;
    for (int k = 0; k < MOMENTS; k++)
        effect += of_groups[k] / of_points[k] / MOMENTS;
    return fmax(1, effect);
}

normality normality_of(const double *x, const double *y, const int64_t *group, size_t count)
{
    standard_axes axes = axes_of(x, y, count);
    double mean[MOMENTS] = {0}, h[MOMENTS];
    normality result = {.chance = {NAN, NAN}, .skewness = NAN, .kurtosis = NAN};
    if (count < 3 || !(axes.deviation[1] > 1e-9 * axes.deviation[0]))
        return result; // no cloud, but a line
    for (size_t i = 0; i < count; i++) {
        polynomials(&axes, x[i], y[i], h);
        for (int k = 0; k < MOMENTS; k++)
            mean[k] += h[k] / (double)count;
    }
    result.skewness =
        mean[0] * mean[0] + 3 * (mean[1] * mean[1] + mean[2] * mean[2]) + mean[3] * mean[3];
    result.kurtosis = mean[FOURTH] + 8;
    result.effective = (double)count / design_effect(&axes, x, y, group, count, mean);
    double chi = result.effective * result.skewness / 6;
    double sigma = mean[FOURTH] / sqrt(64 / result.effective);
    result.chance[0] = exp(-0.5 * chi) * (1 + 0.5 * chi); // above chi, with 4 degrees of freedom
    result.chance[1] = 2 * normal_cumulative(-fabs(sigma));
    result.tested = result.effective >= NORMALITY_LEAST;
    result.normal =
        result.tested && fmin(result.chance[0], result.chance[1]) > 0.5 * normality_level;
    return result;
}
