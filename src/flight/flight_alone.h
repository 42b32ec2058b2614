// A model without launcher: the state that the scenario gives, flown to its end.
#ifndef LD_FLIGHT_FLIGHT_ALONE_H
#define LD_FLIGHT_FLIGHT_ALONE_H

#include "flight/free_flight.h"
#include "state/simulation.h"

// Its system, but for its measures.
ld_status flight_alone_create(ld_simulation *self, ld_error *error);
// Whether the flight can begin.
ld_status flight_alone_begin(const ld_simulation *self, ld_error *error);
// The flight from `state`, without rows; clears the summary for it.
void flight_alone_prepare(const ld_simulation *self, const ld_run_options *options,
                          free_flight *job, double *state, ld_summary *summary);
ld_status flight_alone_run(const ld_simulation *self, const ld_run_options *options,
                           ld_summary *summary, ld_error *error);

#endif
