// What a run gives beside a log: readings of its sensors, results.
#ifndef LD_COMPARE_EVALUATION_H
#define LD_COMPARE_EVALUATION_H

#include "compare/comparison.h"

// Fills the values of a run; `summary` NULL: results that are not instants stay unknown.
// @return LD_OK, LD_ERR_INPUT, LD_ERR_MEMORY
ld_status comparison_evaluate(const ld_comparison *self, const run_series *run,
                              const ld_summary *summary, run_values *values, ld_error *error);

// A number of the sensor's values at the times that count, within the result's window; NaN: none.
double comparison_take(const ld_comparison *self, const log_result *result, const double *value);

// How many samples lie in the result's window.
size_t comparison_count(const ld_comparison *self, const log_result *result);

// The instant of the run with that name; -1: none.
int comparison_instant(const char *name);

#endif
