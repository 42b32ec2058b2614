// Directional derivatives of an instance's unknowns at its present, by differences to both sides.
#ifndef LD_FMU_FMU_DERIVATIVES_H
#define LD_FMU_FMU_DERIVATIVES_H

#include "fmu/fmu_instance.h"

// Value references.
typedef struct fmu_jacobian {
    const unsigned *unknown; // outputs; of model exchange rates and event indicators, too
    size_t unknowns;
    const unsigned *known; // inputs; of model exchange continuous states and time, too
    size_t knowns;
} fmu_jacobian;

// value[unknowns] = J seed[knowns]; adjoint: value[knowns] = J^T seed[unknowns]. The instance stays
// as it is. Errors are within 1e-6 of a derivative, or of what its unknown changes by along all
// states and inputs at once, scaled alike; `bent`: one is larger, up to 1e-2, as `error` says, and
// the mean of slopes that differ. LD_ERR_NUMERIC: larger still, as at a corner of a contact;
// LD_ERR_INPUT: not an unknown, or not a known; LD_ERR_MEMORY.
ld_status fmu_derivative_along(fmu_instance *self, const fmu_jacobian *of, const double *seed,
                               double *value, bool *bent, ld_error *error);
ld_status fmu_derivative_adjoint(fmu_instance *self, const fmu_jacobian *of, const double *seed,
                                 double *value, bool *bent, ld_error *error);

#endif
