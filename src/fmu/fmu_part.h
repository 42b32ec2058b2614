// Which part of a launch an FMU is: all of it, the vehicle alone, or the launcher alone, whose base
// is then reported.
#ifndef LD_FMU_FMU_PART_H
#define LD_FMU_FMU_PART_H

#include <stdio.h>

#include "fmu/fmu_runner.h"
#include "launchdyn/fmu.h"

typedef struct fmu_part {
    ld_fmu_part which;
    double
        start[FMU_MOST_NUMBERS]; // what it receives until it receives another; NaN: what it finds
} fmu_part;

// A part of the model that `whole` simulates, as it begins. LD_ERR_INPUT where it has no such part,
// or why no run of it begins.
ld_status fmu_part_find(ld_fmu_part which, const ld_simulation *whole, fmu_part *part,
                        ld_error *error);

// Makes the model that of the part.
void fmu_part_take(ld_fmu_part which, ld_model *model);

// What runs the part, of the model that is its.
const fmu_runner *fmu_part_runner(ld_fmu_part which, const ld_model *model);

// In an FMU's resources.
#define FMU_PART_FILE "part"
void fmu_part_write(const fmu_part *part, FILE *stream);
ld_status fmu_part_read(const char *resources, fmu_part *part, ld_error *error);

// "vehicle", "launcher", "all".
const char *fmu_part_name(ld_fmu_part which);

#endif
