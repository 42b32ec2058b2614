// A launch from its start to its end, step by step.
#ifndef LD_LAUNCH_LAUNCH_H
#define LD_LAUNCH_LAUNCH_H

#include "launch/launch_run.h"

// Finds the start; the run's state has begun.
ld_status launch_begin(ld_run *run);
// Continues until the integrator's time has reached t, or the launch is finished, or (`to_event`)
// something happens. The present is then t, or where that was.
ld_status launch_advance(ld_run *run, double t, bool to_event);
// What happens at the end of the step; what to say of one that failed.
ld_status launch_arrive(ld_run *run);
ld_status launch_step_failed(ld_run *run);
// Takes the step under way again so that it ends at the present.
ld_status launch_find_rest(ld_run *run);

#endif
