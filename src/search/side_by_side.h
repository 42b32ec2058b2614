// Tasks on several threads: each thread takes the next one.
#ifndef LD_SEARCH_SIDE_BY_SIDE_H
#define LD_SEARCH_SIDE_BY_SIDE_H

#include <stdbool.h>

#include "launchdyn/status.h"

typedef struct side_by_side {
    int tasks, threads;
    void *self;
    // Does task `task` as worker `worker`, from 0; false: no further task is begun. Called from all
    // threads at once.
    bool (*run)(void *self, int worker, int task);
} side_by_side;

// @return LD_OK, also where run() said false; LD_ERR_MISSING (a thread cannot be started: what runs
//         is ended first), LD_ERR_MEMORY
ld_status side_by_side_run(const side_by_side *work, ld_error *error);

#endif
