// The measures of a launch, taken as it goes.
#ifndef LD_LAUNCH_LAUNCH_MEASURES_H
#define LD_LAUNCH_LAUNCH_MEASURES_H

#include "launch/launch_run.h"

// At t a rocket's instants begin; those of the one before have ended.
void launch_begin_measures(ld_run *run, double t);
// Takes the step that has just ended, before anything that happens at its end has; only there, at
// an event or a stop (`lands`), are instants looked for.
void launch_measure_step(ld_run *run, bool lands);
// What has happened at t, in the state y: windows begin and end.
void launch_measure_instant(ld_run *run, double t, const double *y);
// The rocket's last instant, at the end of the last step.
void launch_end_measures(ld_run *run);

#endif
