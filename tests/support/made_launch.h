// A launch that was never computed: columns like those of a run, rows from closed forms, a summary
// with known numbers. For tests of what is written, read and drawn.
#ifndef LD_TESTS_SUPPORT_MADE_LAUNCH_H
#define LD_TESTS_SUPPORT_MADE_LAUNCH_H

#include <stddef.h>

#include "launchdyn/results.h"
#include "quantities/summary.h"

enum { MADE_COLUMNS = 115 };

// MADE_COLUMNS columns; the first is t.
const ld_column *made_columns(void);

// Row `index` of a launch with rows every 0.1 ms; the rocket's columns are NaN from 160 ms on.
void made_row(size_t index, double *values);

// Hands columns and `rows` rows to the sink, stopping at its first failure.
ld_status made_run(const ld_sink *sink, size_t rows, ld_error *error);

// Title and three adaptors, nothing else: what the results take from a model. Owns nothing.
void made_model(ld_model *model);

// Fits that model; no middle instant where `middle` is 0.
void made_summary(ld_summary *summary, int middle);

#endif
