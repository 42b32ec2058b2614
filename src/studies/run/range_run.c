// Ranges of samples that processes of other schedulers run, and the study that keeps them.
#include <assert.h>
#include <inttypes.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "studies/run/keeper.h"
#include "studies/run/part.h"
#include "studies/run/worker.h"

// ---- who runs one

typedef struct range_run {
    const ld_study_options *options;
    int64_t next, last;
    study_part part;
    source_end end;
    pthread_mutex_t at_work;
} range_run;

static bool run_continues(void *argument)
{
    const range_run *self = argument;
    return source_continues(&self->end, self->options);
}

static int64_t run_next(void *argument)
{
    range_run *self = argument;
    bool more = run_continues(self);
    pthread_mutex_lock(&self->at_work);
    int64_t number = more && self->next <= self->last ? self->next++ : 0;
    pthread_mutex_unlock(&self->at_work);
    return number;
}

static void run_stop(void *argument, ld_status status, const ld_error *error)
{
    range_run *self = argument;
    pthread_mutex_lock(&self->at_work);
    source_end_with(&self->end, status, error);
    pthread_mutex_unlock(&self->at_work);
}

static void run_keep(void *argument, const study_record *record)
{
    range_run *self = argument;
    ld_error error;
    pthread_mutex_lock(&self->at_work);
    ld_status status =
        source_end_by(&self->end, record) ? LD_OK : part_add(&self->part, record, &error);
    if (status)
        source_end_with(&self->end, status, &error);
    pthread_mutex_unlock(&self->at_work);
}

static ld_status check_range(const ld_study *study, int64_t first, int64_t last, ld_error *error)
{
    ld_status status = study_check(study, error);
    if (status || (first >= 1 && first <= last && last <= study->samples))
        return status;
    return ld_fail(error, LD_ERR_INPUT,
                   "there are no samples %" PRId64 " to %" PRId64 ": they go from 1 to %" PRId64,
                   first, last, study->samples);
}

ld_status ld_study_run_range(const ld_study *study, const ld_study_range *range,
                             const ld_study_options *options, void **part, size_t *size,
                             ld_error *error)
{
    assert(study && range && part && size);
    static const ld_study_options none = {0};
    ld_error own;
    uint64_t key = 0;
    error = error ? error : &own;
    *part = NULL;
    *size = 0;
    range_run self = {.options = options ? options : &none,
                      .next = range->first,
                      .last = range->last,
                      .end = {.error = error},
                      .at_work = PTHREAD_MUTEX_INITIALIZER};
    ld_status status = check_range(study, range->first, range->last, error);
    if (!status)
        status = study_key(study, &key, error);
    if (status)
        return status;
    const sample_source source = {&self, study, run_next, run_keep, run_continues, run_stop};
    worker_run_side_by_side(&source, self.options->threads);
    if (!self.end.status && self.part.count <= range->last - range->first)
        self.end.status = ld_fail(error, LD_ERR_INTERRUPTED, "interrupted");
    if (!self.end.status)
        self.end.status = part_seal(&self.part, key, error);
    if (self.end.status) {
        part_free(&self.part);
        return self.end.status;
    }
    *part = self.part.bytes;
    *size = self.part.size;
    return LD_OK;
}

// ---- who keeps them all

struct ld_study_keeper {
    study_keeper keeper;
    char *folder;
    int next; // range to be looked at
    int64_t now;
};

ld_status ld_study_keeper_open(const ld_study *study, const char *folder, ld_study_keeper **keeper,
                               ld_error *error)
{
    assert(study && folder && keeper);
    ld_error own;
    error = error ? error : &own;
    *keeper = NULL;
    ld_status status = study_check(study, error);
    if (status)
        return status;
    ld_study_keeper *self = calloc(1, sizeof *self);
    char *name = strdup(folder);
    if (!self || !name) {
        free(self);
        free(name);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a study");
    }
    const store_place place = {.folder = name, .journal = STORE_AHEAD};
    self->folder = name;
    status = keeper_open(&self->keeper, study, &place, error);
    if (status)
        ld_study_keeper_close(self, NULL);
    else
        *keeper = self;
    return status;
}

bool ld_study_keeper_next(ld_study_keeper *self, ld_study_range *range)
{
    const study_keeper *keeper = &self->keeper;
    const sample_range *item = keeper->ranges.item;
    while (self->next < keeper->ranges.count && item[self->next].last <= keeper->rule.look) {
        const int index = self->next++;
        if (keeper_has(keeper, index))
            continue;
        *range = (ld_study_range){item[index].first, item[index].last};
        return true;
    }
    return false;
}

ld_status ld_study_keeper_put(ld_study_keeper *self, const void *part, size_t size, ld_error *error)
{
    ld_error own;
    int64_t before = self->keeper.done;
    error = error ? error : &own;
    ld_status status = keeper_put(&self->keeper, part, size, error);
    self->now += self->keeper.done - before;
    return status ? status : keeper_check(&self->keeper, error);
}

void ld_study_keeper_counts(const ld_study_keeper *self, ld_study_counts *counts)
{
    const study_keeper *keeper = &self->keeper;
    *counts = (ld_study_counts){.samples = keeper->rule.last,
                                .look = keeper->ruled ? keeper->rule.look : 0,
                                .enough = keeper->rule.enough,
                                .done = keeper->done,
                                .failed = keeper->failed,
                                .now = self->now};
}

ld_status ld_study_keeper_close(ld_study_keeper *self, ld_error *error)
{
    ld_error own;
    if (!self)
        return LD_OK;
    ld_status status = keeper_close(&self->keeper, error ? error : &own);
    free(self->folder);
    free(self);
    return status;
}
