#include "studies/run/ledger.h"

#include <inttypes.h>
#include <time.h>

static int64_t source_next(void *self)
{
    return ledger_next(self);
}

static void source_keep(void *self, const study_record *record)
{
    ledger_keep(self, record);
}

static void source_stop(void *self, ld_status status, const ld_error *error)
{
    ledger_stop(self, status, error);
}

sample_source ledger_source(study_ledger *self)
{
    return (sample_source){self,        self->study,      source_next,
                           source_keep, ledger_continues, source_stop};
}

bool ledger_continues(void *self)
{
    const study_ledger *ledger = self;
    return source_continues(&ledger->end, ledger->options);
}

void ledger_stop(study_ledger *self, ld_status status, const ld_error *error)
{
    pthread_mutex_lock(&self->at_work);
    source_end_with(&self->end, status, error);
    pthread_mutex_unlock(&self->at_work);
}

// ---- handing out

// The next number up to where the rule is checked that is not kept; 0: there is none.
static int64_t next_up_to_check(study_ledger *self)
{
    bool there = true;
    ld_error error;
    int64_t number = 0;
    while (there && self->next <= self->rule.look && ledger_continues(self)) {
        number = self->next;
        self->next += self->step;
        ld_status status = store_has(&self->store, number, &there, &error);
        if (status)
            source_end_with(&self->end, status, &error);
    }
    return there || self->end.stopped ? 0 : number;
}

// All samples up to where the rule is checked are kept.
static void check_rule(study_ledger *self)
{
    ld_error error;
    ld_study_counts *counts = self->counts;
    ld_status status = until_check(&self->rule, &self->store, self->folder, &error);
    counts->enough = self->rule.enough;
    if (self->rule.decided)
        counts->samples = self->rule.last;
    else
        counts->look = self->rule.look;
    if (status)
        source_end_with(&self->end, status, &error);
}

static int64_t next_number(study_ledger *self)
{
    for (;;) {
        int64_t number = next_up_to_check(self);
        self->running += number != 0;
        if (number != 0 || !ledger_continues(self) || self->rule.decided)
            return number;
        if (self->running > 0)
            return SAMPLE_WAIT;
        check_rule(self);
    }
}

int64_t ledger_next(study_ledger *self)
{
    int64_t number;
    pthread_mutex_lock(&self->at_work);
    number = next_number(self);
    pthread_mutex_unlock(&self->at_work);
    return number;
}

// ---- keeping

static ld_status put_record(study_ledger *self, const study_record *record, ld_error *error)
{
    ld_status status = store_put(&self->store, record, error);
    if (status)
        return status;
    // where it stops and a reader is in the way, the next run settles it
    status = store_settle(&self->store, false, error);
    return ledger_continues(self) ? status : LD_OK;
}

static void keep_record(study_ledger *self, const study_record *record)
{
    ld_error error;
    self->running -= record->number > 0;
    if (source_end_by(&self->end, record))
        return;
    ld_status status = put_record(self, record, &error);
    if (status) {
        source_end_with(&self->end, status, &error);
        return;
    }
    self->counts->done++;
    self->counts->now++;
    self->counts->failed += record->outcome != LD_OK;
    if (self->options->progress)
        self->options->progress(self->options->self, self->counts);
}

void ledger_keep(study_ledger *self, const study_record *record)
{
    pthread_mutex_lock(&self->at_work);
    keep_record(self, record);
    pthread_mutex_unlock(&self->at_work);
}

// ---- from begin to end

// Someone reads what the writer wants to write: wait as long as the study may continue.
static int wait_for_reader(void *self, int count)
{
    (void)count;
    nanosleep(&(struct timespec){.tv_nsec = 2000000}, NULL);
    return ledger_continues(self);
}

void ledger_open(study_ledger *self, const ld_study *study, const store_place *place,
                 const ld_study_options *options, ld_study_counts *counts, ld_error *error)
{
    int64_t shards = place->shards > 0 ? place->shards : 1;
    *self = (study_ledger){.options = options,
                           .counts = counts,
                           .study = study,
                           .folder = place->folder,
                           .next = place->shards > 0 ? place->shard : 1,
                           .step = shards,
                           .rule = until_begin(study),
                           .end = {.error = error},
                           .at_work = PTHREAD_MUTEX_INITIALIZER};
    *counts = (ld_study_counts){0};
    ld_status status = store_open(&self->store, place, study, error);
    if (!status) {
        self->open = true;
        sqlite3_busy_handler(self->store.database, wait_for_reader, self);
        status = store_count(&self->store, counts, error);
    }
    int64_t last = self->rule.last;
    counts->samples = last < self->next ? 0 : (last - self->next) / shards + 1;
    if (!self->rule.decided)
        counts->look = self->rule.look;
    if (status)
        source_end_with(&self->end, status, error);
}

ld_status ledger_close(study_ledger *self)
{
    bool interrupted = !ledger_continues(self) && self->counts->done < self->counts->samples;
    if (self->open) {
        ld_error error;
        ld_status status = store_settle(&self->store, true, &error);
        if (status && !interrupted)
            source_end_with(&self->end, status, &error);
        status = store_check_place(&self->store, &error);
        if (status) // there is nothing to continue with
            source_end_with(&self->end, status, &error);
        store_close(&self->store);
    }
    if (self->end.status || !interrupted)
        return self->end.status;
    return ld_fail(self->end.error, LD_ERR_INTERRUPTED,
                   "interrupted after %" PRId64 " of %" PRId64
                   " samples; the same command continues",
                   self->counts->done, self->counts->samples);
}
