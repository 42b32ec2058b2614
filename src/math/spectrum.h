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

#endif
