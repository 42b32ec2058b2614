// Flights in 8 lanes.
#define LANES 8
#include "systems/flight/flight_code.h"

void flight_rates_avx512(const flight_lanes *lanes, const double *t, const double *state,
                         double *state_dot)
{
    flight_rates_of(lanes, t, state, state_dot);
}

unsigned flight_watch_avx512(const flight_lanes *lanes, const flight_step *step)
{
    return flight_watch_of(lanes, step);
}
