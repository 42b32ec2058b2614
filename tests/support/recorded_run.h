// A run whose history is kept in memory, to be looked up by column names.
#ifndef LD_TESTS_SUPPORT_RECORDED_RUN_H
#define LD_TESTS_SUPPORT_RECORDED_RUN_H

#include "quantities/summary.h"

typedef struct recorded_run {
    ld_simulation *simulation; // kept for its columns
    ld_summary summary;
    size_t columns, rows, capacity;
    double *values; // [rows][columns]
} recorded_run;

// Runs the model (kept by reference); fails the test where the run fails. Free with
// recorded_run_free().
void recorded_run_make(recorded_run *run, const ld_model *model);
void recorded_run_free(recorded_run *run);

// Number of the column with this name; fails the test where there is none.
size_t recorded_column(const recorded_run *run, const char *name);

double recorded_value(const recorded_run *run, size_t row, size_t column);

// Summary of a run without history; fails the test where the run fails.
ld_summary summary_of_run(const ld_model *model);

#endif
