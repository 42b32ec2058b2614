// Columns of numbers as CSV.
#ifndef LD_RESULTS_COLUMNS_H
#define LD_RESULTS_COLUMNS_H

#include <stddef.h>

#include "launchdyn/results.h"
#include "launchdyn/status.h"

typedef struct number_columns {
    size_t width, rows;
    const ld_column *column;    // [width]
    const double *const *value; // [width][rows]
} number_columns;

// Writes the file `name` in the folder, which is made where it is not there.
ld_status columns_write(const char *folder, const char *name, const number_columns *columns,
                        ld_error *error);

#endif
