// The ledger of a study: hands out the numbers of samples that are not kept yet and keeps the
// records that come back, whoever runs them. All its functions may be called from several threads
// at once.
#ifndef LD_STUDIES_LEDGER_H
#define LD_STUDIES_LEDGER_H

#include <pthread.h>

#include "studies/run/sample_source.h"
#include "studies/run/until.h"
#include "studies/store/store.h"

typedef struct study_ledger {
    const ld_study_options *options;
    ld_study_counts *counts;
    const ld_study *study;
    const char *folder;
    study_store store;
    bool open;
    int64_t next, step; // number to be checked, from one to the next
    until_rule rule;
    int running; // samples handed out that have not come back
    source_end end;
    pthread_mutex_t at_work; // held by whom the ledger serves
} study_ledger;

// Opens the folder, which it may make; error and counts are written to until it is closed. Where
// this fails the ledger is there all the same and hands out nothing.
void ledger_open(study_ledger *self, const ld_study *study, const store_place *place,
                 const ld_study_options *options, ld_study_counts *counts, ld_error *error);
// @return LD_OK: all samples are kept; LD_ERR_INTERRUPTED; or what went wrong first
ld_status ledger_close(study_ledger *self);

// The ledger as a source, whose functions are the following ones.
sample_source ledger_source(study_ledger *self);

// The number of a sample to be run; 0: no more; SAMPLE_WAIT: it is not known yet, ask again.
int64_t ledger_next(study_ledger *self);
// Keeps a record; an outcome that is not the sample's stops the study.
void ledger_keep(study_ledger *self, const study_record *record);
// Stops: what runs is not waited for.
void ledger_stop(study_ledger *self, ld_status status, const ld_error *error);
// Whether samples are still requested; `self` is a ledger.
bool ledger_continues(void *self);

#endif
