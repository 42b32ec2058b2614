// What a launch is reported from outside: where its base is, that its motor is ignited.
#ifndef LD_LAUNCH_LAUNCH_DRIVE_H
#define LD_LAUNCH_LAUNCH_DRIVE_H

#include "launch/launch_run.h"

// Where the base is at the present, of which a step then ends. Only what was given is to blame for
// what it returns.
ld_status launch_drive_base(ld_run *run, const ld_base_frame *given, ld_error *error);
// Ignites the rocket at the present, at which a step ends.
ld_status launch_ignite(ld_run *run);

#endif
