// Keeps the ranges of a study that others run, in any order and also twice: the one process that
// has the study's database open.
#ifndef LD_STUDIES_KEEPER_H
#define LD_STUDIES_KEEPER_H

#include "studies/run/ranges.h"
#include "studies/run/until.h"
#include "studies/store/store.h"

typedef struct study_keeper {
    const ld_study *study;
    const char *folder;
    study_store store;
    bool open;
    uint64_t key; // of the study, in the parts
    study_ranges ranges;
    int64_t *lacks;      // [ranges.count] samples that are not kept
    unsigned char *kept; // a bit for each sample, from number 1
    until_rule rule;     // ranges up to rule.look are to be run
    bool ruled;          // there is a stopping rule
    study_record *record;
    int64_t done, failed; // samples kept
} study_keeper;

// Opens the study's database. To be closed in any case.
ld_status keeper_open(study_keeper *self, const ld_study *study, const store_place *place,
                      ld_error *error);
ld_status keeper_close(study_keeper *self, ld_error *error);

// Whether a part is whole and of this study.
bool keeper_knows(const study_keeper *self, const void *part, size_t size);

// Keeps the records of a part, except those that are kept already.
// @return LD_OK; LD_ERR_INPUT, as of part_open(); LD_ERR_FILE, LD_ERR_MEMORY
ld_status keeper_put(study_keeper *self, const void *part, size_t size, ld_error *error);

// Checks the stopping rule where its samples are kept, as often as it can.
ld_status keeper_check(study_keeper *self, ld_error *error);

// Whether all samples of a range are kept; whether it is to be run at all, as is known now; whether
// all of the study is kept.
bool keeper_has(const study_keeper *self, int range);
bool keeper_wants(const study_keeper *self, int range);
bool keeper_is_complete(const study_keeper *self);

// The study's key: of what the scenario is, and of this version.
ld_status study_key(const ld_study *study, uint64_t *key, ld_error *error);

#endif
