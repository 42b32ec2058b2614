// Warnings about values that are allowed but implausible.
#ifndef LD_MODEL_PLAUSIBLE_H
#define LD_MODEL_PLAUSIBLE_H

#include <stdio.h>

#include "model/warnings/plausible_rule.h"

typedef struct plausible_note {
    const plausible_rule *rule;
    const char *path; // of the key, list members by number
    const char *unit;
    double value, other;
    int entry; // of the list in the rule's path, from 0
} plausible_note;

typedef void plausible_report(void *self, const plausible_note *note);

// Calls `report` for each rule that a model, which is complete and breaks no rule, falls under, but
// for those that rest on a key that gives a warning itself.
void plausible_check(const ld_model *model, plausible_report *report, void *self);

// The rules as Markdown, for docs/scenario.md.
void plausible_write_markdown(FILE *stream);

#endif
