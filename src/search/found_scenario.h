// A scenario with values of keys that a search has found, as a scenario file.
#ifndef LD_SEARCH_FOUND_SCENARIO_H
#define LD_SEARCH_FOUND_SCENARIO_H

#include <stdbool.h>
#include <stdio.h>

#include "model/fields/field.h"

typedef struct found_key {
    const field_place *place;
    const char *unit; // SI
    double value;
} found_key;

typedef struct found_scenario {
    const ld_model *model; // with the values before
    const char *how;       // "fitted values (launchdyn fit)"
    int keys;
    const found_key *key; // [keys]
} found_scenario;

// Writes a file that will lie in `folder`: it includes the scenario's where that stands as it was
// read, else has all of it. False: no memory.
bool found_scenario_write(const found_scenario *self, const char *folder, FILE *stream);

#endif
