// Who hands out the numbers of samples and takes their records, whoever runs them: a ledger, a
// range of samples, ranges that processes share. All functions may be called from several threads
// at once.
#ifndef LD_STUDIES_SAMPLE_SOURCE_H
#define LD_STUDIES_SAMPLE_SOURCE_H

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

#endif
