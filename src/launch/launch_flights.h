// The flights of the rockets that have left their tubes.
#ifndef LD_LAUNCH_LAUNCH_FLIGHTS_H
#define LD_LAUNCH_LAUNCH_FLIGHTS_H

#include "launch/launch_run.h"

// Every rocket that has left its tube flies to the ground, or until the run's end.
ld_status launch_fly_all(ld_run *run);
// The rocket that left its tube at t, the state of the launcher there being y, has a jet; the next
// one, whose tube's mouth was there.
ld_status launch_begin_jet(ld_run *run, double t, const double *y);
ld_status launch_add_jet(ld_run *run, const jet_place *mouth, ld_error *error);

#endif
