// What an archive of two FMUs needs of the export of one.
#ifndef LD_FMU_PACK_FMU_EXPORT_H
#define LD_FMU_PACK_FMU_EXPORT_H

#include "fmu/fmu_variables.h"

// A part of the model, and its variables, all of them; fmu_variables_free() is due in any case.
ld_status fmu_part_variables(ld_fmu_part which, const ld_model *model, fmu_part *part,
                             fmu_variables *variables, ld_error *error);

// ld_fmu_export(), but what is selected may not be there.
ld_status fmu_export_part(const ld_model *model, const ld_fmu_options *options, const char *file,
                          ld_error *error);

#endif
