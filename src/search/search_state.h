// What a search (a fit, an optimisation) has computed so far, in a file: a search that was stopped
// computes the same points in the same order and finds them there.
#ifndef LD_SEARCH_STATE_H
#define LD_SEARCH_STATE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "launchdyn/status.h"

typedef struct search_state {
    FILE *file; // NULL: nothing is kept
    int lock;
    char path[4096], lock_path[4096];
    int keys, numbers;
    char *text; // what was there
    size_t length, at;
    int uncut; // errno by which a damaged rest could not be cut off
} search_state;

// What is kept of each point: so many keys, and so many numbers that were found there.
typedef struct search_kind {
    const char *what; // "fit": the file is DIR/fit.state; a constant
    int keys, numbers;
} search_kind;

// Opens the file, which it may make; folder NULL: keeps nothing. `identity` says what the search is
// of: a file of another one is refused.
// @return LD_OK, LD_ERR_INPUT, LD_ERR_FILE, LD_ERR_MEMORY
ld_status search_state_open(search_state *self, const search_kind *kind, const char *folder,
                            const char *identity, ld_error *error);
// The next point that was kept, if it is this one; false: it, and all that follow, are not.
bool search_state_next(search_state *self, const double *point, double *number, bool *there);
ld_status search_state_put(search_state *self, const double *point, const double *number,
                           bool there, ld_error *error);
// What was put is on its way to the disk.
ld_status search_state_flush(search_state *self, ld_error *error);
void search_state_close(search_state *self);

#endif
