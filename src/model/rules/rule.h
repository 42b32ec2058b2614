// A rule that a model must keep: how a broken one is reported, and those of several blocks.
#ifndef LD_MODEL_RULE_H
#define LD_MODEL_RULE_H

#include "launchdyn/status.h"
#include "model/blocks/table.h"
#include "model/fields/field.h"

typedef struct rule_set {
    const ld_model *model;
    rule_report *report;
    void *self;
} rule_set;

// Reports a broken rule; `index` (from 1; 0: none) replaces the # in `path`.
void report_broken(const rule_set *rules, const char *path, int index, const char *format, ...)
    LD_PRINTF(4, 5);

// The first column of a table must rise; with `jumps`, a value may stand twice.
void rising_rule(const rule_set *rules, const char *path, const ld_table *table, const char *unit,
                 bool jumps);
// Principal moments J of a body, with products J_xy, J_xz, J_yz (NULL: none), must be possible.
void inertia_rule(const rule_set *rules, const char *path, const double J[3],
                  const double products[3]);

#endif
