// The texts that a scenario was read from, in an FMU's resources: each a file of its own in the
// folder source/, with a list of their names there and of the overrides.
#ifndef LD_FMU_FMU_SOURCE_H
#define LD_FMU_FMU_SOURCE_H

#include <stddef.h>
#include <stdio.h>

#include "launchdyn/model.h"
#include "launchdyn/status.h"

enum { FMU_SOURCE_NAME = 512 };

#define FMU_SOURCE_LIST "source/list"

// The name of file `index` of a source in the resources.
void fmu_source_name(const ld_source *source, size_t index, char name[FMU_SOURCE_NAME]);
void fmu_source_write_list(const ld_source *source, FILE *stream);

// Reads it all back from the folder of the resources; source_free() it. NULL: why stands in
// `error`.
ld_source *fmu_source_read(const char *resources, ld_error *error);

#endif
