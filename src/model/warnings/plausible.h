// Notes on values that are allowed but hardly meant: each rule compares two quantities of a model.
#ifndef LD_MODEL_PLAUSIBLE_H
#define LD_MODEL_PLAUSIBLE_H

#include <math.h>
#include <stdio.h>

#include "model/fields/field.h"

// Entry `i` (from 0) of the list in a rule's path.
typedef struct plausible_entry {
    const ld_model *model;
    int i;
} plausible_entry;

// What a rule compares, in SI; NaN: it says nothing here.
typedef struct plausible_pair {
    double value, other;
    int row;           // number from 1 that stands for the # of the path; 0: that of the entry
    const char *entry; // name that stands for it, or NULL
    const char *unit;  // where the entry decides on it, or NULL
} plausible_pair;

typedef struct plausible_rule {
    const char *path;  // of the key that it is about; # stands for an entry of a list
    const char *what;  // the quantity that follows from the key; NULL: the key's own value
    const char *other; // what it is compared with: a key's path, or words; NULL: with 1 unit
    const char *unit;  // of both
    double low, high;  // of value/other: what lies outside is noted
    // NULL: the key's value, and that of the key `other`
    plausible_pair (*find)(const plausible_entry *at);
    const char *of; // key that the quantity rests on, too, or a block of such keys; NULL: none
    const char *why;
} plausible_rule;

// Rules end with a row without path.
extern const plausible_rule plausible_of_tube[], plausible_of_base[], plausible_of_rocket[],
    plausible_of_vehicle[], plausible_of_stabiliser[], plausible_of_run[];

typedef struct plausible_note {
    const plausible_rule *rule;
    const char *path; // of the key, list members by number
    const char *unit;
    double value, other;
} plausible_note;

typedef void plausible_report(void *self, const plausible_note *note);

// Calls `report` for each rule that a model, which is complete and breaks no rule, falls under, but
// for those that rest on a key that is noted itself.
void plausible_look(const ld_model *model, plausible_report *report, void *self);

// The rules as Markdown, for docs/scenario.md.
void plausible_write_markdown(FILE *stream);

// ---- quantities that rules share

// Of a rule that says nothing.
static inline plausible_pair plausible_nothing(void)
{
    return (plausible_pair){.value = NAN, .other = NAN};
}

static inline plausible_pair plausible_compare(double value, double other)
{
    return (plausible_pair){.value = value, .other = other};
}

// A value that is compared with the rule's bounds alone.
static inline plausible_pair plausible_alone(double value)
{
    return plausible_compare(value, 1);
}

static inline double plausible_norm(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

#endif
