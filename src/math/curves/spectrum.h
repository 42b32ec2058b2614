// Power spectral densities from samples.
#ifndef LD_MATH_SPECTRUM_H
#define LD_MATH_SPECTRUM_H

#include <stddef.h>

#include "launchdyn/status.h"

// One-sided densities of two series of `count` samples, `step` apart, over frequency [1/unit of
// step]: their means in the bands edge[i] <= f < edge[i + 1], i < bands; NaN where a band holds no
// frequency m/(size step), size the power of 2 from `count` up. The series less their means are
// tapered (Hann) and transformed. aa and bb: the series' own; ab: real part of the cross-spectrum;
// each may be NULL. (Bendat and Piersol, Random Data, ch. 11.)
ld_status spectrum_in_bands(size_t count, double step, const double *a, const double *b,
                            size_t bands, const double *edge, double *aa, double *bb, double *ab,
                            ld_error *error);

// One-sided density of a series at m/(size step), m < size/2, its first NaN: the mean over segments
// of `size` samples, a power of 2, each beginning in the middle of the one before, less a straight
// line each, tapered (Hann). (Welch, IEEE Trans. Audio Electroacoust. 15 (1967) 70.)
ld_status spectrum_of_segments(size_t count, double step, const double *a, size_t size,
                               double *density, ld_error *error);

#endif
