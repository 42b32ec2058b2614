// What a rule of plausibility compares.
#ifndef LD_MODEL_PLAUSIBLE_FIND_H
#define LD_MODEL_PLAUSIBLE_FIND_H

#include "model/blocks/limits.h"
#include "model/warnings/plausible_rule.h"

// `pattern` with `entry` in place of #.
void plausible_put_entry(char path[LD_MAX_PATH], const char *pattern, const char *entry);

// The pair of a rule for entry `i` (from 0), whose number or name stands for # in paths.
plausible_pair plausible_find(const plausible_rule *rule, const ld_model *model, int i,
                              const char *entry);

#endif
