// Rows of a launch to who listens.
#ifndef LD_LAUNCH_LAUNCH_ROWS_H
#define LD_LAUNCH_LAUNCH_ROWS_H

#include "launch/launch_run.h"

// Hands geometry and columns to the sink.
ld_status launch_open_output(ld_run *run);
// A row at t and state y; one instant gives one row.
ld_status launch_write_row(ld_run *run, double t, const double *y);
// Rows that fell into the last step.
ld_status launch_write_rows(ld_run *run);
// Output instants count from t on, at the step that holds there.
void launch_restart_output(ld_run *run, double t);
// A run that ends early has its last state as its last row.
void launch_write_last_row(ld_run *run);

#endif
