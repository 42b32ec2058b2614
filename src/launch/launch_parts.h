// What drives and feet of a multibody base did from a rocket's ignition to its exit.
#ifndef LD_LAUNCH_PARTS_H
#define LD_LAUNCH_PARTS_H

#include "launch/launch_run.h"

// Nothing of another base, before the ignition and after the exit.
void launch_watch_parts(ld_run *run, double t, const double *y);

#endif
