// What the commands share that run a model.
#ifndef LD_CLI_RUN_H
#define LD_CLI_RUN_H

#include "launchdyn/model.h"

typedef struct run_wishes {
    char **sets;
    char *folder; // NULL: print the table only
    int csv, report, json, strict;
} run_wishes;

// Runs the model, prints the table or the summary as JSON, and writes the folder; returns the exit
// code.
int run_model(const ld_model *model, void *wishes);

#endif
