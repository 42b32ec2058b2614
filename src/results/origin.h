// Where results come from, in files: JSON of summary.json and of reports, groups of history.h5.
#ifndef LD_RESULTS_ORIGIN_H
#define LD_RESULTS_ORIGIN_H

#include <stdbool.h>
#include <stdio.h>

#include "launchdyn/origin.h"

// Adds a fact; false: no memory.
bool origin_add_fact(ld_origin *origin, const char *name, const char *text);

// {"version": ..., "commit": ..., ...} of the program; {"files": [{"name", "text"}], "set": [...],
// "point", "sample"} of the source. Indented by two blanks a level as members of an object.
void origin_write_program(FILE *json, const ld_origin *origin);
void origin_write_source(FILE *json, const ld_origin *origin);

// ld_origin_read() of the history at `path`, whatever its digest; an origin without a scenario
// where it is of an earlier version, which did not say.
ld_status origin_read_history(const char *path, ld_origin *origin, ld_error *error);

#endif
