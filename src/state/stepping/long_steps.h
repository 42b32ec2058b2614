// Long exponential steps while no rocket is driven through its tube, the integrator's in between
// (run.lead_in_method).
#ifndef LD_STATE_STEPPING_LONG_STEPS_H
#define LD_STATE_STEPPING_LONG_STEPS_H

#include "state/stepping/stepper.h"

// Whether a launch has such steps: they are asked for, and its base is neither reported nor sampled
// at instants of its own, too near to each other.
bool long_steps_apply(const launch_state *launch);

extern const stepper long_stepper;

#endif
