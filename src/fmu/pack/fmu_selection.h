// Which outputs and parameters of an FMU its description lists: by patterns of their names, at
// export.
#ifndef LD_FMU_FMU_SELECTION_H
#define LD_FMU_FMU_SELECTION_H

#include "fmu/fmu_variables.h"

// Whether every pattern that `options` have applies to a variable of one of `count` lists.
// LD_ERR_INPUT: one that does not, with the name that was probably meant.
ld_status fmu_selection_check(const ld_fmu_options *options, const fmu_variables *list, int count,
                              ld_error *error);

// Takes out of the list what no pattern applies to, and what the version leaves out; value
// references stay. What connects parts with
// each other stays, too. Nothing can be found by its reference in the list afterwards.
void fmu_selection_take(const ld_fmu_options *options, fmu_variables *list);

#endif
