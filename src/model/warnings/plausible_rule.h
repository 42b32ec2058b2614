// A rule of plausibility: a row that compares two quantities of a model.
#ifndef LD_MODEL_PLAUSIBLE_RULE_H
#define LD_MODEL_PLAUSIBLE_RULE_H

#include <math.h>

#include "launchdyn/model.h"

// What a rule is about: a model, and of a list in the rule's path an entry, from 0. Of
// platform.#: 0 the azimuth's hinge, 1 the elevation's.
typedef struct plausible_entry {
    const ld_model *model;
    int i;
    double own; // value of the rule's key; NaN: the key is not a number
} plausible_entry;

// What a rule compares, in SI; NaN: it says nothing here.
typedef struct plausible_pair {
    double value, other;
    int row;           // number from 1 that stands for the # of the path; 0: that of the entry
    const char *entry; // name that stands for it, or NULL
    const char *unit;  // where the entry decides on it, or NULL
} plausible_pair;

// How the value of a rule follows from the terms a and b. A term is the path of a key or the name
// of an estimate (estimates.h); without a term a is the rule's own key.
typedef enum plausible_form {
    PLAUSIBLE_TERM,       // a
    PLAUSIBLE_DIFFERENCE, // a - b
    PLAUSIBLE_PRODUCT,    // a b
    PLAUSIBLE_RATIO,      // a/b
    PLAUSIBLE_GYRATION,   // sqrt(a/b), of an inertia and a mass; also a speed of waves
    PLAUSIBLE_RING,       // sqrt(2 a/b): radius of a thin ring, of its second moment and area
    PLAUSIBLE_FREQUENCY,  // sqrt(a/b)/(2 pi) [Hz], of a stiffness and what it holds
    PLAUSIBLE_DECAY,      // b/a [s], of a damper a > 0 and what it slows down
    PLAUSIBLE_DISTANCE,   // sqrt(a^2 + b^2)
    PLAUSIBLE_NORM,       // of the vector a
    PLAUSIBLE_GREATEST,   // greatest magnitude in the column of the table a, times b if given
} plausible_form;

typedef struct plausible_rule {
    const char *path;  // of the key that it is about; # stands for an entry of a list or a hinge
    const char *what;  // the quantity that follows from the key; NULL: the key's own value
    const char *other; // what it is compared with: a term, or words; NULL: 1 unit
    const char *unit;  // of both
    double low, high;  // of value/other: what lies outside gives a warning
    plausible_form form;
    int column;        // of the table (PLAUSIBLE_GREATEST), from 0
    const char *a, *b; // terms of the value
    const char *with;  // term that the words `other` stand for, if not an estimate's name
    const char *when;  // term that must be > 0, or the rule says nothing; NULL: always
    // in place of form and terms: mechanics of the rule's own
    plausible_pair (*find)(const plausible_entry *at);
    const char *of; // key that the quantity rests on, too, or a block of such keys; NULL: none
    const char *why;
} plausible_rule;

#define NO_LOW .low = -INFINITY
#define NO_HIGH .high = INFINITY

// Rules end with a row without path.
extern const plausible_rule plausible_of_tube[], plausible_of_base[], plausible_of_rocket[],
    plausible_of_vehicle[], plausible_of_stabiliser[], plausible_of_mechanism[], plausible_of_run[];

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
