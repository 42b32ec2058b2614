// The programs that give a launching subsystem's accelerations, as a test takes them in turn.
#ifndef LD_TESTS_SUPPORT_EVALUATORS_H
#define LD_TESTS_SUPPORT_EVALUATORS_H

#include "systems/launching/launching.h"

typedef launching_outcome (*evaluator)(const launching_system *, const launching_input *,
                                       const launching_phase *, const double *, launching_output *);

#endif
