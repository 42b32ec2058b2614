// The history of a launch: its columns, and their values at an instant.
#ifndef LD_STATE_HISTORY_H
#define LD_STATE_HISTORY_H

#include "state/launch_state.h"

// Before and after those of the base.
extern const quantity_table launch_quantities, balance_quantities;

// Names the columns of the history, once.
ld_status history_build(ld_simulation *self, ld_error *error);

// A row of the history.
void history_row(const launch_state *self, double t, const double *y, double energy_start,
                 double *row);

#endif
