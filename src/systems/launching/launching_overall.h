// Accelerations of the launching subsystem in the paper's overall form: tail and tube as 13 x 13
// transfer matrices, 19 unknowns (20 while locked; formulation.md, section 4).
#ifndef LD_SYSTEMS_LAUNCHING_OVERALL_H
#define LD_SYSTEMS_LAUNCHING_OVERALL_H

#include "systems/launching/launching.h"

// As launching_evaluate. Also gives y_dot and the condition of the tube's transfer matrix; where
// this form cannot hold it falls back on the reduced one and says so in `fell_back`.
launching_outcome launching_evaluate_overall(const launching_system *self,
                                             const launching_input *input,
                                             const launching_phase *phase, const double *state,
                                             launching_output *output);

#endif
