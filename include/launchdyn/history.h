/// Columns in memory: a sink that keeps every row of a run.
#ifndef LAUNCHDYN_HISTORY_H
#define LAUNCHDYN_HISTORY_H

#include "launchdyn/results.h"
#include "launchdyn/status.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/// The rows of a run, column by column.
typedef struct ld_history ld_history;

/// An empty one.
/// @param next gets everything too, after this one (NULL: no one), e.g. ld_output_sink()
/// @return NULL: no memory
ld_history *ld_history_new(const ld_sink *next);
/// May be NULL.
void ld_history_free(ld_history *history);

/// Where the rows come from: for ld_run_options.sink. Valid as long as `history`. A run that begins
/// takes the place of what was there.
const ld_sink *ld_history_sink(ld_history *history);

size_t ld_history_rows(const ld_history *history);

/// Names, units and descriptions of the columns, in order; valid until the next run begins.
const ld_column *ld_history_columns(const ld_history *history, size_t *count);

/// A column by its name ("t", "tip.y"), in SI; valid until another row comes.
/// @param count number of rows; may be NULL
/// @return [rows], NaN where a row has no value; NULL: no such column, or no row yet
const double *ld_history_column(const ld_history *history, const char *name, size_t *count);

/// The flight of rocket number `rocket` (from 1, in the order of firing) after the launch; NULL: it
/// has not flown. It belongs to `history`.
const ld_history *ld_history_flight(const ld_history *history, int rocket);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
