// The equations of motion of a mechanism.
#ifndef LD_SYSTEMS_MECHANISM_EVALUATION_H
#define LD_SYSTEMS_MECHANISM_EVALUATION_H

#include "systems/mechanism/mechanism.h"

// Rates of the state, and what else there is to say. Other than 0: singular or not finite.
int mechanism_evaluate(const mechanism_system *self, const mechanism_input *input,
                       const double *state, const mechanism_motion *motion, double *state_dot,
                       mechanism_output *output);

#endif
