// When a study with a stopping rule (`scatter.until`) has samples enough. The rule is checked after
// fixed numbers of samples only, when all of these are kept, so that the same study stops at the
// same sample however it is run.
#ifndef LD_STUDIES_UNTIL_H
#define LD_STUDIES_UNTIL_H

#include "model/blocks/study.h"
#include "studies/plan/study.h"
#include "studies/store/store.h"

// Samples of each point after which the rule is checked next: of 0, the first time.
int64_t until_next_check(const ld_scatter *scatter, int64_t samples);

// Whether the rule holds for the samples up to number `last` that the folder keeps.
ld_status until_holds(const ld_study *study, const char *folder, int64_t last, bool *holds,
                      ld_error *error);

// How far a study is with its rule.
typedef struct until_rule {
    const ld_study *study;
    int64_t look, last; // numbers of samples: after which the rule is checked, the last one
    bool decided;       // there is no rule, or it was checked for the last time
    bool enough;        // the rule holds
} until_rule;

// Before any sample. Without a rule, `look` is the last sample.
until_rule until_begin(const ld_study *study);
// The numbers after which the rule is checked, one after the other, without looking at results.
void until_look_further(until_rule *self);
// Checks the rule: all samples up to `look` are kept in the store. Decides, or looks further.
ld_status until_check(until_rule *self, study_store *store, const char *folder, ld_error *error);

#endif
