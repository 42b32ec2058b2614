// Records of samples as one piece of bytes, which goes from who runs them to who keeps them:
// through a file of a shared folder, or as what a process of another scheduler returns. It names
// the study that it is of, and has a digest.
#ifndef LD_STUDIES_PART_H
#define LD_STUDIES_PART_H

#include <stdbool.h>

#include "launchdyn/status.h"
#include "studies/plan/record.h"

typedef struct study_part {
    unsigned char *bytes; // the part; NULL: nothing in it yet
    size_t size, room;
    int64_t count; // of records
} study_part;

// Adds a record.
// @return LD_OK, LD_ERR_MEMORY
ld_status part_add(study_part *self, const study_record *record, ld_error *error);
// Makes it whole: after the last record. `key` is that of the study.
ld_status part_seal(study_part *self, uint64_t key, ld_error *error);
void part_free(study_part *self);

// Reads the records of a whole part.
typedef struct part_reader {
    const unsigned char *next, *end;
    study_shape shape;    // the most that a record holds
    study_record *record; // that was read last, of the caller's
} part_reader;

// Begins; shape and record are set.
// @return LD_OK; LD_ERR_INPUT, of another study, another version of launchdyn, or damaged
ld_status part_open(part_reader *self, const void *bytes, size_t size, uint64_t key,
                    ld_error *error);
// The next record; false: there is none.
bool part_next(part_reader *self);

#endif
