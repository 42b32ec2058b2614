// Butterworth low-pass filter: unit gain at rest, -3 dB at its cut-off (S. Butterworth, Wireless
// Engineer 7, 1930). Of order n with w = 2 pi cut-off it has the poles
//   p_k = w exp(i pi (2 k + n + 1)/(2 n)), k = 0 .. n - 1,
// and is the sum of r_k/(s - p_k), r_k = w^n / prod_{j != k} (p_k - p_j). Each of these equations,
// x' = p x + r u, is solved exactly for an input u that is linear between its points.
#ifndef LD_MATH_LOW_PASS_H
#define LD_MATH_LOW_PASS_H

#include <stdbool.h>

enum { LOW_PASS_MOST = 8 }; // order

typedef struct low_pass_number {
    double re, im;
} low_pass_number;

typedef struct low_pass {
    int terms;    // poles on or above the real axis
    bool odd;     // the last of them is real
    double input; // the latest
    low_pass_number pole[LOW_PASS_MOST], residue[LOW_PASS_MOST], state[LOW_PASS_MOST];
} low_pass;

// At rest at an input; cut-off [Hz], order 1 to LOW_PASS_MOST.
void low_pass_begin(low_pass *self, double cutoff, int order, double input);

// dt >= 0 [s] on, the input going linearly to its new value; 0: it jumps.
void low_pass_step(low_pass *self, double dt, double input);

double low_pass_output(const low_pass *self);

#endif
