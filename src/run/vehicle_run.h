// A vehicle's run alone: the columns of its history (launchdyn/vehicle_run.h has the run).
#ifndef LD_RUN_VEHICLE_RUN_H
#define LD_RUN_VEHICLE_RUN_H

#include "quantities/quantity_table.h"
#include "state/simulation.h"

// Before and after those of the base.
extern const quantity_table vehicle_clock_quantities, vehicle_balance_quantities;

// Names them, once.
ld_status vehicle_run_name_columns(ld_simulation *self, ld_error *error);

#endif
