// documentation/index.html of an FMU: what it is, how to couple it, its variables.
#ifndef LD_FMU_FMU_PAGE_H
#define LD_FMU_FMU_PAGE_H

#include "fmu/fmu_description.h"

// Writes it; what fails shows in the stream's error. `icon`: the file, from the page's folder.
void fmu_page_write(const fmu_description *self, const ld_model *model, const char *icon,
                    FILE *stream);

#endif
