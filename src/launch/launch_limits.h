// What ends a launch early.
#ifndef LD_LAUNCH_LAUNCH_LIMITS_H
#define LD_LAUNCH_LAUNCH_LIMITS_H

#include "launch/launch_run.h"

ld_status launch_check_tube(ld_run *run, double t, const double *y);
ld_status launch_check_base(ld_run *run, double t);
// After each step; each millisecond the caller hears of it.
ld_status launch_check_step(ld_run *run, double t, const double *y);

#endif
