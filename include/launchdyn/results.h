/// What a run hands out: columns with names and units, and rows of numbers.
#ifndef LAUNCHDYN_RESULTS_H
#define LAUNCHDYN_RESULTS_H

#include <stddef.h>

#include "launchdyn/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/// One column of a history.
typedef struct ld_column {
    const char *name;        ///< e.g. "tip.y"
    const char *unit;        ///< SI, e.g. "m"
    const char *description; ///< one line, with frame
} ld_column;

/// Where rows go. `begin` is called once, before the first row; both return an error status to stop
/// the run. The run never frees or keeps `values`.
typedef struct ld_sink {
    void *self;
    ld_status (*begin)(void *self, const ld_column *columns, size_t count, ld_error *error);
    ld_status (*row)(void *self, const double *values, size_t count, ld_error *error);
} ld_sink;

#ifdef __cplusplus
}
#endif

#endif
