// The base of a launch: an externally driven one, one that acts on its own at instants, and the
// wrench on any.
#ifndef LD_LAUNCH_LAUNCH_BASE_H
#define LD_LAUNCH_LAUNCH_BASE_H

#include "launch/launch_run.h"

// Takes what the options say of it at the start.
ld_status launch_begin_base(ld_run *run);
// Refuses a base that goes where its kind says.
ld_status launch_base_listens(const base_system *base, ld_error *error);
// The frame as it is given.
ld_status launch_read_frame(const ld_base_frame *given, base_frame *frame, ld_error *error);
// The first instant after t at which the base changes its state on its own [s]; it does so where
// the present is one.
double launch_next_sample(const ld_run *run, double t);
ld_status launch_sample_base(ld_run *run);
// Takes a base that is stepped from the instant t, where all is in the state y, to its next; others
// nowhere.
ld_status launch_step_base(ld_run *run, double t, double *y);
// On any base, in the state y of the present.
ld_status launch_wrench(ld_run *run, const double *y, ld_base_wrench *wrench, ld_error *error);

#endif
