// What the files of rules share.
#ifndef LD_MODEL_RULES_H
#define LD_MODEL_RULES_H

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "model/fields/field.h"

typedef struct rule_set {
    const ld_model *model;
    rule_report *report;
    void *self;
} rule_set;

// Reports a broken rule; `index` (from 1; 0: none) replaces the # in `path`.
static inline void broken(const rule_set *rules, const char *path, int index, const char *format,
                          ...) LD_PRINTF(4, 5);
static inline void broken(const rule_set *rules, const char *path, int index, const char *format,
                          ...)
{
    char full_path[128], text[384];
    const char *place = strchr(path, '#');
    if (place)
        snprintf(full_path, sizeof full_path, "%.*s%d%s", (int)(place - path), path, index,
                 place + 1);
    else
        snprintf(full_path, sizeof full_path, "%s", path);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    rules->report(rules->self, full_path, text);
}

// The first column of a table must rise; with `jumps`, a value may stand twice.
void rising_rule(const rule_set *rules, const char *path, const ld_table *table, const char *unit,
                 bool jumps);
// Principal moments J of a body, with products J_xy, J_xz, J_yz (NULL: none), must be possible.
void inertia_rule(const rule_set *rules, const char *path, const double J[3],
                  const double products[3]);

// Rules of what guides the rocket.
void guide_rules(const rule_set *rules);
// Rules of the air on the rocket.
void aerodynamics_rules(const rule_set *rules);
// Rules of a base whose motion is given.
void base_rules(const rule_set *rules);
// Rules of a vehicle and its platforms.
void vehicle_rules(const rule_set *rules);

#endif
