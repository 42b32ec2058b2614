// A vehicle's run alone: the columns of its history (launchdyn/vehicle_run.h has the run).
#ifndef LD_RUN_VEHICLE_RUN_H
#define LD_RUN_VEHICLE_RUN_H

#include "launch/launch_exchange_names.h"
#include "launchdyn/vehicle_run.h"
#include "quantities/quantity_table.h"
#include "state/simulation.h"

// Before and after those of the base.
extern const quantity_table vehicle_clock_quantities, vehicle_balance_quantities;

// Names them, once.
ld_status vehicle_run_name_columns(ld_simulation *self, ld_error *error);

// ---- a run whose steps an integrator outside takes: launch/launch_exchange.h says what each does.
// The wrench is that at the present, without a rate.

ld_status vehicle_exchange_begin(const ld_simulation *simulation, ld_vehicle_run **run,
                                 ld_error *error);
ld_status vehicle_exchange_load(const ld_simulation *simulation, const void *bytes, size_t size,
                                ld_vehicle_run **run, ld_error *error);
int vehicle_exchange_states(const ld_vehicle_run *run);
int vehicle_exchange_indicators(const ld_vehicle_run *run);
exchange_quantity vehicle_exchange_state(const ld_vehicle_run *run, int i);
void vehicle_exchange_nominals(const ld_vehicle_run *run, double *nominal);
ld_status vehicle_exchange_place(ld_vehicle_run *run, double t, const double *y,
                                 const ld_base_wrench *wrench, ld_error *error);
void vehicle_exchange_get(const ld_vehicle_run *run, double *y);
ld_status vehicle_exchange_rates(ld_vehicle_run *run, double *rate, ld_error *error);
ld_status vehicle_exchange_values(ld_vehicle_run *run, double *indicator, ld_error *error);
double vehicle_exchange_next(const ld_vehicle_run *run);
ld_status vehicle_exchange_accept(ld_vehicle_run *run, bool *happens, ld_error *error);
ld_status vehicle_exchange_pass_events(ld_vehicle_run *run, bool *happened, ld_error *error);

#endif
