// Accelerations of the launching subsystem by the reduced form in the fast layout of
// formulation.md, section 5.
#ifndef LD_SYSTEMS_LAUNCHING_DYNAMICS_H
#define LD_SYSTEMS_LAUNCHING_DYNAMICS_H

#include "systems/launching/launching.h"

// Finds them, one pass over the elements; or from the general mass matrix (launching_is_general).
launching_outcome launching_evaluate(const launching_system *self, const launching_input *input,
                                     const launching_phase *phase, const double *state,
                                     launching_output *output);

// Puts the rocket where the adaptors that are held have no offset from the axis, and removes the
// velocity drift of all constraints (formulation.md, section 3) from `state`; that keeps all
// momenta.
void launching_project(const launching_system *self, const launching_input *input,
                       const launching_phase *phase, double *state);

#endif
