// Each subsystem of a vehicle by an integrator of its own, with exchanges at fixed instants
// (run.coupling; coupling.md).
#ifndef LD_STATE_STEPPING_PARTITIONED_STEPS_H
#define LD_STATE_STEPPING_PARTITIONED_STEPS_H

#include "state/stepping/stepper.h"

// Whether a launch asks for that.
bool partitioned_steps_apply(const launch_state *launch);

extern const stepper partitioned_stepper;

#endif
