// Who hands out the numbers of samples and takes their records, whoever runs them: a ledger, a
// range of samples, ranges that processes share. All functions may be called from several threads
// at once.
#ifndef LD_STUDIES_SAMPLE_SOURCE_H
#define LD_STUDIES_SAMPLE_SOURCE_H

#include <stdatomic.h>
#include <stdbool.h>

#include "studies/plan/record.h"
#include "studies/plan/study.h"

enum { SAMPLE_WAIT = -1 };

typedef struct sample_source {
    void *self;
    const ld_study *study;
    int64_t (*next)(void *self); // 0: no more; SAMPLE_WAIT: it is not known yet, ask again
    // An outcome that is not the sample's stops the study.
    void (*keep)(void *self, const study_record *record);
    bool (*continues)(void *self); // whether samples are still requested
    void (*stop)(void *self, ld_status status, const ld_error *error);
} sample_source;

// What ended the work of a source. Who holds it guards it where it is written.
typedef struct source_end {
    ld_status status; // why it stopped
    ld_error *error;
    atomic_bool stopped;
} source_end;

// Whether samples are still requested.
bool source_continues(const source_end *self, const ld_study_options *options);
// Stops; the first error is the one that is kept.
void source_end_with(source_end *self, ld_status status, const ld_error *error);
// Whether an outcome is not the sample's; then the source has stopped.
bool source_end_by(source_end *self, const study_record *record);

#endif
