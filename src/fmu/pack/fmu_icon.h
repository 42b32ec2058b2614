// An FMU's icon: a pictogram of the part that it is, as SVG and PNG.
#ifndef LD_FMU_FMU_ICON_H
#define LD_FMU_FMU_ICON_H

#include <stdbool.h>
#include <stdio.h>

#include "launchdyn/fmu.h"

// Pixels of its width and height.
#define FMU_ICON_SIZE 128

// Writes it; what fails shows in the stream's error. False: no memory.
void fmu_icon_write_svg(const ld_model *model, ld_fmu_part part, FILE *stream);
bool fmu_icon_write_png(const ld_model *model, ld_fmu_part part, FILE *stream);

#endif
