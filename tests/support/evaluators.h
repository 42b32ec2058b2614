// The programs that give a launching subsystem's accelerations, as a test takes them in turn.
#ifndef LD_TESTS_SUPPORT_EVALUATORS_H
#define LD_TESTS_SUPPORT_EVALUATORS_H

#include "systems/launching/launching.h"

typedef launching_outcome (*evaluator)(const launching_system *, const launching_input *,
                                       const launching_phase *, const double *, launching_output *);

static inline launching_outcome general(const launching_system *system,
                                        const launching_input *input, const launching_phase *phase,
                                        const double *state, launching_output *out)
{
    return launching_evaluate_general(system, LD_FORMULATION_REDUCED, input, phase, state, out);
}

static inline launching_outcome overall(const launching_system *system,
                                        const launching_input *input, const launching_phase *phase,
                                        const double *state, launching_output *out)
{
    return launching_evaluate_general(system, LD_FORMULATION_OVERALL, input, phase, state, out);
}

#endif
