// Records that are not committed to the database yet, in a small file beside it, study.pending,
// that lies in memory: adding one costs next to nothing, and outlives a kill of the program all the
// same.
#ifndef LD_STUDIES_PENDING_H
#define LD_STUDIES_PENDING_H

#include <stdbool.h>

#include "studies/plan/record.h"

enum { PENDING_MOST = 256 }; // records

typedef struct study_pending {
    unsigned char *slot; // [PENDING_MOST] of slot_size bytes; NULL: closed
    size_t slot_size;
    study_shape shape; // the most that a record holds
    uint64_t key;      // of the study
    int count;
    char path[4096];
} study_pending;

// Opens the file at `path`, making it where it is not there, for records of up to this shape. It
// holds those that an earlier run of the study with the same key has left and that are whole; the
// others are as if they had never been run.
ld_status pending_open(study_pending *self, const char *path, uint64_t key,
                       const study_shape *shape, ld_error *error);
// Removes the file if nothing is in it.
void pending_close(study_pending *self);

// Adds a record; there must be room.
void pending_add(study_pending *self, const study_record *record);
// Takes all records out.
void pending_clear(study_pending *self);

// Record `index`, from 0 to count - 1.
const study_record *pending_read(const study_pending *self, int index);

#endif
