/// What a run hands out: what does not change in it, columns with names and units, rows of numbers.
#ifndef LAUNCHDYN_RESULTS_H
#define LAUNCHDYN_RESULTS_H

#include <stddef.h>

#include "launchdyn/status.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/// One column of a history.
typedef struct ld_column {
    const char *name;        ///< e.g. "tip.y"
    const char *unit;        ///< SI, e.g. "m"
    const char *description; ///< one line, with frame
} ld_column;

/// Numbers of a launcher that do not change in a run: places, sizes, shapes of modes.
typedef struct ld_array {
    const char *name;        ///< e.g. "tube.station"
    const char *unit;        ///< SI, e.g. "m"
    const char *description; ///< one line, with frame
    size_t rows, columns;
    const double *value; ///< [rows][columns]
} ld_array;

/// Where rows go. `geometry`, of a launcher, then `begin` are called once, before the first row;
/// after the launcher's rows `flight` once for each rocket that flies on, before the rows of its
/// flight. All return an error status to stop the run. The run never frees or keeps `values`; it
/// frees what `geometry` is given.
typedef struct ld_sink {
    void *self;
    ld_status (*begin)(void *self, const ld_column *columns, size_t count, ld_error *error);
    ld_status (*row)(void *self, const double *values, size_t count, ld_error *error);
    /// Rows of the flight of rocket number `rocket` (from 1, in the order of firing) follow; NULL:
    /// no rows of flights are requested.
    ld_status (*flight)(void *self, int rocket, const ld_column *columns, size_t count,
                        ld_error *error);
    /// What is drawn of the launcher (docs/results.md); NULL: not requested.
    ld_status (*geometry)(void *self, const ld_array *arrays, size_t count, ld_error *error);
    const void *reserved[4]; ///< NULL: room for what later versions may be asked
} ld_sink;

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
