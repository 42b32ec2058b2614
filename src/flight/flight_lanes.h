// Free flights side by side: each lane has a flight with its own time and steps and takes the next
// one when that has landed. Every flight has the bits that it has alone.
#ifndef LD_FLIGHT_FLIGHT_LANES_H
#define LD_FLIGHT_FLIGHT_LANES_H

#include "flight/free_flight.h"

// A flight as free_flight_run is given it; the lane keeps it until it is done.
typedef struct lane_flight {
    free_flight job;
    double state[FLIGHT_STATES];
    ld_rocket_summary *rocket;
    ld_summary *summary;
    ld_error *error;
} lane_flight;

// How many steps were tried in lanes, and how many of them of flights.
typedef struct lane_use {
    int64_t lanes, flying;
} lane_use;

// Who has flights to be flown.
typedef struct lane_source {
    // The next flight for this lane; false: there is none now, it is asked for again after the next
    // one has landed.
    bool (*next)(void *self, int lane, lane_flight *flight);
    // It has ended as free_flight_run ends.
    void (*done)(void *self, int lane, lane_flight *flight, ld_status status);
    void *self;
    lane_use *use; // added to; may be NULL
} lane_source;

// Lanes that this processor has: 4 with AVX2, 8 with AVX-512, else, or where the environment has
// LAUNCHDYN_PLAIN, 1. Never more than LAUNCHDYN_LANES in the environment.
int flight_lanes_here(void);

// Flies until there is none. A flight unlike those in the air (flight_is_like), with a
// line, with canopies of a mass or that do not fill linearly in time is flown alone.
// @return LD_OK or LD_ERR_MEMORY, where none has been asked for
ld_status flight_lanes_fly(int lanes, const lane_source *source, ld_error *error);

#endif
