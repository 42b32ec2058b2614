// Derivatives: the keys, and the summaries of the launches beside.
#ifndef LD_DERIVATIVES_H
#define LD_DERIVATIVES_H

#include "launchdyn/derivatives.h"
#include "launchdyn/summary.h"
#include "model/fields/field.h"
#include "quantities/study_results.h"

enum { DERIVATIVES_MOST_KEYS = 64 };

typedef struct derivative_key {
    field_place place;
    double value, step; // SI
} derivative_key;

struct ld_derivatives {
    const ld_model *model;
    quantity_things things;
    int keys;
    derivative_key key[DERIVATIVES_MOST_KEYS];
    ld_summary *summary; // [1 + 2 keys]: of the launch itself, left and right of each key
    bool *same_events;   // likewise
};

// That of a result by key `key`.
ld_derivative derivative_of(const ld_derivatives *self, const quantity_walk *result, int key);

#endif
