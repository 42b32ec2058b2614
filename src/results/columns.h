// Columns of numbers as CSV.
#ifndef LD_RESULTS_COLUMNS_H
#define LD_RESULTS_COLUMNS_H

#include <stddef.h>

#include "launchdyn/results.h"
#include "launchdyn/status.h"

// Writes the file `name` in the folder, which is made where it is not there: `width` columns with
// `rows` values each.
ld_status columns_write(const char *folder, const char *name, const ld_column *columns,
                        const double *const *values, size_t width, size_t rows, ld_error *error);

#endif
