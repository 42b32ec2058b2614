#include "environment/road_class.h"

#include <stdlib.h>

#include "environment/road.h"
#include "math/curves/distributions.h"
#include "math/curves/spectrum.h"
#include "math/functions.h"

static const double N0 = 0.1, LOWEST = 0.011, HIGHEST = 2.83; // [1/m]

// Waves in a segment from which on its spectrum is trusted.
enum { WAVES = 4, CLASSES = 8 };

int road_class_of(double density)
{
    int found = 0;
    while (found < CLASSES - 1 && density > 2 * road_class_density(found, N0))
        found++;
    return found;
}

// The longest power of 2 of which four, half overlapping, lie in the record, no longer than the
// lowest frequency requires.
static size_t segment_of(size_t count, double step)
{
    size_t size = 8;
    while (5 * size <= count && (double)size * step < WAVES / LOWEST)
        size *= 2;
    return size;
}

// Mean and standard error of ln G_d (n/n0)^2 over thirds of octaves, bins of each by their mean.
static void fit(const double *density, double resolution, road_estimate *estimate)
{
    double sum = 0, square = 0;
    int bands = 0;
    size_t m = (size_t)ceil(estimate->from / resolution);
    for (double edge = estimate->from; edge * 1.1 < estimate->to;) {
        double mean = 0, n;
        int bins = 0;
        edge *= pow(10, 0.1);
        for (; (n = (double)m * resolution) < fmin(edge, estimate->to); m++, bins++)
            mean += density[m] * n * n / (N0 * N0);
        if (bins == 0)
            continue;
        double level = log(mean / bins);
        sum += level;
        square += level * level;
        bands++;
    }
    double mean = sum / bands;
    estimate->density = exp(mean);
    estimate->factor = exp(student_quantile(0.975, bands - 1) *
                           sqrt(fmax(square / bands - mean * mean, 0) / (bands - 1)));
}

ld_status road_classify(const road_record *record, road_estimate *estimate, ld_error *error)
{
    size_t count = record->count, size = segment_of(count, record->step);
    double step = record->step, resolution = 1 / ((double)size * step);
    *estimate = (road_estimate){.from = fmax(fmax(record->from, LOWEST), WAVES * resolution),
                                .to = fmin(fmin(record->to, HIGHEST), 0.25 / step),
                                .density = NAN};
    // n0 and the octave above it are to be seen
    if (2 * size > count || estimate->from > N0 || estimate->to < 2 * N0)
        return LD_OK;
    double *density = malloc(size / 2 * sizeof *density);
    if (!density)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a spectrum of %zu samples", size);
    ld_status status = spectrum_of_segments(count, step, record->height, size, density, error);
    if (!status) {
        fit(density, resolution, estimate);
        estimate->nearest = road_class_of(estimate->density);
        estimate->lowest = road_class_of(estimate->density / estimate->factor);
        estimate->highest = road_class_of(estimate->density * estimate->factor);
    }
    free(density);
    return status;
}
