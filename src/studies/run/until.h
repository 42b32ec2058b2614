// When a study with a stopping rule (`scatter.until`) has samples enough. The rule is checked after
// fixed numbers of samples only, when all of these are kept, so that the same study stops at the
// same sample however it is run.
#ifndef LD_STUDIES_UNTIL_H
#define LD_STUDIES_UNTIL_H

#include "model/blocks/study.h"
#include "studies/plan/study.h"

// Samples of each point after which the rule is checked next: of 0, the first time.
int64_t until_next_check(const ld_scatter *scatter, int64_t samples);

// Whether the rule holds for the samples up to number `last` that the folder keeps.
ld_status until_holds(const ld_study *study, const char *folder, int64_t last, bool *holds,
                      ld_error *error);

#endif
