// How much of a result's variance a factor makes, alone and with the others, from the plan of A.
// Saltelli; how far it moves the result, from that of M. D. Morris.
#ifndef LD_STUDIES_INDICES_H
#define LD_STUDIES_INDICES_H

#include "studies/statistics/statistics.h"

// A result in the runs of matrix A, of matrix B, and of A with the column of the factor from B.
typedef struct frozen_values {
    const double *a, *b, *swapped; // [count] no NaN
    const int64_t *group;          // [count] of the independent unit, rises
    const int *part; // [count] a number from 1 to 64 of what has a mean of its own, as a rocket of
                     // a salvo; NULL: nothing
    size_t count;
} frozen_values;

typedef struct variance_indices {
    estimate first, total; // Sobol's S and T
    estimate together;     // T - S: the share that the factor makes with others
    size_t count, groups;
} variance_indices;

// First order: the mean of b (swapped - c a) over the variance, values less their mean, where c,
// the regression of b swapped on b a, whose mean is 0, leaves least variance (A. Saltelli et al.,
// Comput. Phys. Commun. 181, 2010, have c = 1). Total: half the mean of (a - swapped)^2 over the
// variance (M. J. W. Jansen, Comput. Phys. Commun. 117, 1999). Intervals: Student's t with the
// variance over groups of the estimates' linear terms (delta method).
// @return LD_OK (all NaN where the result does not scatter or there are fewer than three groups),
//         LD_ERR_MEMORY
ld_status variance_indices_of(const frozen_values *values, variance_indices *result);

typedef struct elementary_effects {
    estimate magnitude; // mu*, the mean of their magnitudes
    estimate mean;      // mu
    double deviation;   // sigma
    size_t count, groups;
} elementary_effects;

// Statistics of elementary effects [count], no NaN, in the order of their groups (M. D. Morris,
// Technometrics 33, 1991; F. Campolongo et al., Environ. Model. Softw. 22, 2007).
// @return LD_OK, LD_ERR_MEMORY
ld_status elementary_effects_of(const double *effect, const int64_t *group, size_t count,
                                elementary_effects *result);

#endif
