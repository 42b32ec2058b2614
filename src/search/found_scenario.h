// What a search has found, as files: a scenario with the values of keys, and others.
#ifndef LD_SEARCH_FOUND_SCENARIO_H
#define LD_SEARCH_FOUND_SCENARIO_H

#include "model/fields/field.h"
#include "studies/store/table_file.h"

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

// Writes FOLDER/NAME: it includes the scenario's file where that stands as it was read, else has
// all of it. @return LD_OK, LD_ERR_INPUT (too long a name), LD_ERR_FILE, LD_ERR_MEMORY
ld_status found_scenario_write(const found_scenario *self, const char *folder, const char *name,
                               ld_error *error);

// Writes FOLDER/NAME as table_file_print() does.
ld_status found_file_write(csv_writer *write, void *self, const char *folder, const char *name,
                           ld_error *error);

#endif
