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

/// Where rows go. `begin` is called once, before the first row; after the launcher's rows `flight`
/// once for each rocket that flies on, before the rows of its flight. All return an error status to
/// stop the run. The run never frees or keeps `values`.
typedef struct ld_sink {
    void *self;
    ld_status (*begin)(void *self, const ld_column *columns, size_t count, ld_error *error);
    ld_status (*row)(void *self, const double *values, size_t count, ld_error *error);
    /// Rows of the flight of rocket number `rocket` (from 1, in the order of firing) follow; NULL:
    /// no rows of flights are wanted.
    ld_status (*flight)(void *self, int rocket, const ld_column *columns, size_t count,
                        ld_error *error);
} ld_sink;

#ifdef __cplusplus
}
#endif

#endif
