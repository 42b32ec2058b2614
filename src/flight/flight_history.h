// The history of a flight: its columns and their values at an instant.
#ifndef LD_FLIGHT_FLIGHT_HISTORY_H
#define LD_FLIGHT_FLIGHT_HISTORY_H

#include "quantities/quantity_table.h"
#include "systems/flight/flight.h"

enum { FLIGHT_MAX_COLUMNS = 128 };

extern const quantity_table flight_quantities;

// Its columns, to be freed, and the values of a row.
ld_status flight_columns(const flight_system *system, quantity_columns *columns, ld_error *error);
void flight_row(const flight_system *system, const quantity_columns *columns,
                const flight_phase *phase, double t, const double *state,
                double row[FLIGHT_MAX_COLUMNS]);

#endif
