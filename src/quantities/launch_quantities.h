// The tables of a launch's columns, of which those of the base stand between
// (systems/bases/base.h), and of those of a flight, and of a vehicle alone.
#ifndef LD_SIMULATION_LAUNCH_QUANTITIES_H
#define LD_SIMULATION_LAUNCH_QUANTITIES_H

#include "model/quantity.h"

extern const quantity_table launch_quantities, balance_quantities, flight_quantities;
extern const quantity_table vehicle_clock_quantities, vehicle_balance_quantities;

#endif
