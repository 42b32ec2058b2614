// One who runs samples, one after the other.
#ifndef LD_STUDIES_WORKER_H
#define LD_STUDIES_WORKER_H

#include <pthread.h>

#include "launchdyn/simulation.h"
#include "studies/plan/record.h"
#include "studies/plan/study.h"
#include "studies/run/sample_source.h"

typedef struct study_worker {
    const ld_study *study;
    study_sample *sample;
    ld_simulation *simulation; // of the sample run last
    ld_summary *summary;
    study_record *record; // of the sample run last
} study_worker;

ld_status worker_create(study_worker *self, const ld_study *study, ld_error *error);
void worker_free(study_worker *self);

// Runs sample `number` into the record. The outcomes LD_ERR_INTERRUPTED, where go_on(argument) said
// false, and LD_ERR_MEMORY are not the sample's: such a record is not to be kept.
void worker_run(study_worker *self, int64_t number, bool (*go_on)(void *), void *argument);

// The most samples that worker_run_all() has at once, on any processor.
int worker_samples_at_once(const ld_study *study);

// Runs samples that the source hands out until there are no more: the work of one thread.
void worker_run_all(const sample_source *from);

// Starts a thread with a stack of the size that launches need; returns 0, or why there is none (an
// errno).
int worker_start_thread(pthread_t *thread, void *(*work)(void *), void *data);

// Starts a thread that runs samples so; returns 0, or why there is none (an errno). The source must
// outlive it.
int worker_start(pthread_t *thread, const sample_source *from);

// Starts `count` of them, the last ones of `of`, into thread[count]; returns how many. Where one
// cannot be had, the source stops.
int worker_start_some(pthread_t *thread, int count, int of, const sample_source *from);

// The same on `threads` threads (fewer than 1 are one), of which the caller's is one.
void worker_run_side_by_side(const sample_source *from, int threads);

#endif
