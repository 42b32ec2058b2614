// Power spectral densities from samples.
#ifndef LD_MATH_SPECTRUM_H
#define LD_MATH_SPECTRUM_H

#include <stddef.h>

#include "launchdyn/status.h"

// Two series of `count` samples, `step` apart.
typedef struct spectrum_series {
    size_t count;
    double step;
    const double *a, *b;
} spectrum_series;

// Bands edge[i] <= f < edge[i + 1], i < count, of frequency [1/unit of step], and arrays for the
// mean densities in them: of each series, and the real part of their cross-spectrum; NULL: not
// wanted.
typedef struct spectrum_bands {
    size_t count;
    const double *edge;
    double *aa, *bb, *ab;
} spectrum_bands;

// Fills the arrays of the bands with one-sided densities; NaN where a band holds no frequency
// m/(size step), size the power of 2 from the count of samples up. The series less their means are
// tapered (Hann) and transformed. (Bendat and Piersol, Random Data, ch. 11.)
ld_status spectrum_in_bands(const spectrum_series *series, const spectrum_bands *bands,
                            ld_error *error);

// One-sided density of a series at m/(size step), m < size/2, its first NaN: the mean over segments
// of `size` samples, a power of 2, each beginning in the middle of the one before, less a straight
// line each, tapered (Hann). (Welch, IEEE Trans. Audio Electroacoust. 15 (1967) 70.)
ld_status spectrum_of_segments(size_t count, double step, const double *a, size_t size,
                               double *density, ld_error *error);

#endif
