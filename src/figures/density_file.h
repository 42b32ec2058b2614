// A power spectral density from a file.
#ifndef LD_FIGURES_DENSITY_FILE_H
#define LD_FIGURES_DENSITY_FILE_H

#include "launchdyn/status.h"
#include "model/blocks/table.h"

// Reads a CSV file of two columns, frequency [Hz] and density, of which the first line may name
// them and those that begin with # say nothing. The rows are to be freed.
ld_status density_file_read(const char *path, ld_table *density, ld_error *error);

#endif
