// A study that processes on any machines share by its folder alone (claims.h). The threads run
// samples of the ranges that this process has taken; the process itself says that it lives, and
// where it has the database's lock, keeps what all have run. If it dies, another one takes the
// lock.
#include <assert.h>
#include <inttypes.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/lock_file.h"
#include "results/folder.h"
#include "studies/run/join_state.h"
#include "studies/run/worker.h"

// [s]
static const double TICK = 0.05; // pause of the process between two looks
static const double READ = 0.2;  // between two readings of the state, or of the parts
static const double WRITE = 1;   // between two states that say the same
static const double SILENCE = 3; // of a keeper, after which its lock is tried
static const double LEAST_SEARCH = 0.02, MOST_SEARCH = 1; // after a search for a range in vain
static const double EXPIRY = 60;

// A range that this process has taken.
typedef struct open_range {
    int range;
    int64_t next, back; // number to be handed out; samples that have come back
    study_part part;
} open_range;

typedef struct study_join {
    const ld_study *study;
    const ld_study_options *options;
    const char *folder;
    ld_study_counts *counts;
    study_claims claims;
    study_ranges ranges;
    study_keeper keeper;
    bool keeping, removed; // the folder of ranges has gone, as at the end
    bool publish;          // the keeper has something new to say
    uint64_t key, whole;   // in the parts, in the state
    join_state state;      // the latest; count 0: none yet
    claim_kind *kind;      // [ranges.count]
    open_range *open;      // [open_count]
    int open_count;
    double begun, search,
        pause; // [s] when it began, when a range is searched again, the pause then
    double renewed, read, written, heard, told; // [s] when
    int64_t told_done;
    source_end end;
    pthread_mutex_t at_work; // over state, kind, open, status
} study_join;

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static bool join_continues(void *argument)
{
    const study_join *self = argument;
    return source_continues(&self->end, self->options);
}

static void join_stop(void *argument, ld_status status, const ld_error *error)
{
    study_join *self = argument;
    pthread_mutex_lock(&self->at_work);
    source_end_with(&self->end, status, error);
    pthread_mutex_unlock(&self->at_work);
}

// ---- taking ranges

static int64_t length_of(const study_join *self, int range)
{
    return self->ranges.item[range].last - self->ranges.item[range].first + 1;
}

static bool is_open_here(const study_join *self, int range)
{
    int i = 0;
    while (i < self->open_count && self->open[i].range != range)
        i++;
    return i < self->open_count;
}

static bool is_wanted(const study_join *self, int range)
{
    return self->state.count == self->ranges.count && self->state.kept[range] == '0' &&
           self->ranges.item[range].last <= self->state.look && self->kind[range] != CLAIM_PART &&
           !is_open_here(self, range);
}

// Takes a range, and looks once more whether it is to be run: its part may have been there.
static ld_status try_range(study_join *self, int range, bool *taken, ld_error *error)
{
    ld_status status = claims_take(&self->claims, range, taken, error);
    if (status || !*taken)
        return status;
    if (!self->keeping)
        join_state_read(&self->state, &self->claims);
    if (!claims_has_part(&self->claims, range) && self->state.count == self->ranges.count &&
        self->state.kept[range] == '0')
        return LD_OK;
    claims_release(&self->claims, range);
    *taken = false;
    return LD_OK;
}

// Ranges that no one has, then those that someone has, who may be dead. They begin at different
// ones, that fewer processes try the same.
static ld_status search_range(study_join *self, int *range, ld_error *error)
{
    enum { SPREAD = 64 };
    memset(self->kind, 0, (size_t)self->ranges.count * sizeof *self->kind);
    ld_status status = claims_list(&self->claims, self->kind, self->ranges.count, error);
    int free_ones = 0, skipped = 0;
    for (int i = 0; i < self->ranges.count; i++)
        free_ones += is_wanted(self, i) && self->kind[i] == CLAIM_NONE;
    int spread = free_ones < SPREAD ? free_ones : SPREAD;
    int skip = spread > 0 ? (int)getpid() % spread : 0;
    for (int pass = 0; pass < 3 && !status; pass++)
        for (int i = 0; i < self->ranges.count && !status; i++) {
            bool taken = false;
            if (!is_wanted(self, i) || (self->kind[i] == CLAIM_TAKEN) != (pass == 2) ||
                (pass == 0 && skipped++ < skip))
                continue;
            status = try_range(self, i, &taken, error);
            if (taken) {
                *range = i;
                return status;
            }
        }
    return status;
}

static ld_status open_next(study_join *self, ld_error *error)
{
    int range = -1;
    ld_status status = search_range(self, &range, error);
    if (status || range < 0)
        return status;
    open_range *open = realloc(self->open, (size_t)(self->open_count + 1) * sizeof *open);
    if (!open) {
        claims_release(&self->claims, range);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a range of samples");
    }
    self->open = open;
    open[self->open_count++] = (open_range){.range = range, .next = self->ranges.item[range].first};
    return LD_OK;
}

// The next number of a range that is open; 0: there is none.
static int64_t next_here(study_join *self)
{
    for (int i = 0; i < self->open_count; i++)
        if (self->open[i].next <= self->ranges.item[self->open[i].range].last)
            return self->open[i].next++;
    return 0;
}

static int64_t next_number(study_join *self)
{
    ld_error error;
    int64_t number = next_here(self);
    double time = now();
    if (number || self->state.complete)
        return number;
    if (self->state.count == 0 || time < self->search)
        return SAMPLE_WAIT;
    ld_status status = open_next(self, &error);
    if (status)
        source_end_with(&self->end, status, &error);
    number = next_here(self);
    if (!number)
        self->search = time + self->pause;
    double longer = 2 * self->pause < MOST_SEARCH ? 2 * self->pause : MOST_SEARCH;
    self->pause = number ? LEAST_SEARCH : longer;
    return number ? number : SAMPLE_WAIT;
}

static int64_t join_next(void *argument)
{
    study_join *self = argument;
    if (!join_continues(self))
        return 0;
    pthread_mutex_lock(&self->at_work);
    int64_t number = next_number(self);
    pthread_mutex_unlock(&self->at_work);
    return number;
}

// ---- records that come back

// Writes what a range has of records and gives it up.
static ld_status close_range(study_join *self, int index, ld_error *error)
{
    open_range *open = &self->open[index];
    bool whole = open->back == length_of(self, open->range);
    ld_status status = LD_OK;
    if (open->part.count > 0)
        status = part_seal(&open->part, self->key, error);
    if (!status && open->part.count > 0)
        status = claims_put_part(&self->claims, open->range, whole, &open->part, error);
    claims_release(&self->claims, open->range);
    part_free(&open->part);
    self->open[index] = self->open[--self->open_count];
    return status;
}

static ld_status keep_record(study_join *self, const study_record *record, ld_error *error)
{
    int index = 0, range = ranges_find(&self->ranges, record->number);
    while (self->open[index].range != range)
        index++;
    open_range *open = &self->open[index];
    ld_status status = part_add(&open->part, record, error);
    if (status)
        return status;
    open->back++;
    self->counts->now++;
    return open->back == length_of(self, range) ? close_range(self, index, error) : LD_OK;
}

static void join_keep(void *argument, const study_record *record)
{
    study_join *self = argument;
    ld_error error;
    pthread_mutex_lock(&self->at_work);
    ld_status status =
        source_end_by(&self->end, record) ? LD_OK : keep_record(self, record, &error);
    if (status)
        source_end_with(&self->end, status, &error);
    pthread_mutex_unlock(&self->at_work);
}

// ---- the keeper

// Someone may read the database: the writer waits as long as the study may continue.
static int wait_for_reader(void *argument, int count)
{
    (void)count;
    nanosleep(&(struct timespec){.tv_nsec = 2000000}, NULL);
    return join_continues(argument);
}

// Others hear that there is a keeper before it has opened the database, which it checks.
static ld_status keep(study_join *self, int lock, ld_error *error)
{
    const store_place place = {.folder = self->folder, .journal = STORE_ROLLBACK, .lock = lock};
    const join_state beginning = {.key = self->whole, .kept = ""};
    self->keeping = self->publish = true;
    ld_status status = join_state_write(&beginning, &self->claims, error);
    if (status) {
        lock_file_release(lock);
        return status;
    }
    status = keeper_open(&self->keeper, self->study, &place, error);
    if (!status)
        sqlite3_busy_handler(self->keeper.store.database, wait_for_reader, self);
    return status;
}

static ld_status try_to_keep(study_join *self, ld_error *error)
{
    int lock;
    ld_status status = store_try_lock(self->folder, &lock, error);
    return status || lock < 0 ? status : keep(self, lock, error);
}

// What the keeper knows becomes the state of this process, and of all.
static ld_status publish_state(study_join *self, double time, ld_error *error)
{
    join_state state = {.key = self->whole};
    ld_status status = join_state_take(&state, &self->keeper, error);
    if (!status)
        status = join_state_write(&state, &self->claims, error);
    if (status) {
        join_state_free(&state);
        return status;
    }
    pthread_mutex_lock(&self->at_work);
    join_state_free(&self->state);
    self->state = state;
    pthread_mutex_unlock(&self->at_work);
    self->written = time;
    self->publish = false;
    return LD_OK;
}

// Keeps parts that are there, so many at once; whether there may be more. They are removed once
// they are settled and the state says so; a damaged one, as after a loss of power, is as if its
// range had not been run.
static ld_status keep_some_parts(study_join *self, double time, bool *more, ld_error *error)
{
    enum { MOST = 256 };
    char(*kept)[CLAIMS_NAME] = malloc(MOST * sizeof *kept);
    claims_parts parts;
    int count = 0;
    *more = false;
    if (!kept)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the parts of the study");
    ld_status status = claims_parts_begin(&parts, &self->claims, error);
    while (!status && count < MOST && claims_parts_next(&parts)) {
        if (keeper_knows(&self->keeper, parts.bytes, parts.size))
            status = keeper_put(&self->keeper, parts.bytes, parts.size, error);
        memcpy(kept[count++], parts.path, sizeof parts.path);
    }
    claims_parts_end(&parts);
    if (!status && count > 0)
        status = store_settle(&self->keeper.store, true, error);
    if (!status)
        status = keeper_check(&self->keeper, error);
    if (!status && (count > 0 || self->publish || time - self->written > WRITE))
        status = publish_state(self, time, error);
    for (int i = 0; i < count && !status; i++)
        unlink(kept[i]);
    free(kept);
    *more = !status && count == MOST;
    return status;
}

static ld_status keep_all_parts(study_join *self, ld_error *error)
{
    bool more = true;
    ld_status status = LD_OK;
    while (more)
        status = keep_some_parts(self, now(), &more, error);
    return status;
}

// ---- all others

// No keeper, and no file of this process: the study is complete, or the folder was removed.
static ld_status read_end(study_join *self, ld_error *error)
{
    study_store store;
    ld_study_counts counts = {0};
    ld_status status = store_open_to_read(&store, self->folder, error);
    if (!status) {
        status = store_count(&store, &counts, error);
        store_close(&store);
    }
    const until_rule rule = until_begin(self->study);
    if (!status && !rule.decided)
        status = until_holds(self->study, self->folder, counts.samples, &counts.enough, error);
    if (status || counts.done < counts.samples)
        return ld_fail(error, LD_ERR_FILE, "another program has removed or moved %s",
                       self->claims.folder);
    pthread_mutex_lock(&self->at_work);
    self->state.samples = self->state.look = counts.samples;
    self->state.done = counts.done;
    self->state.failed = counts.failed;
    self->state.ruled = !rule.decided;
    self->state.enough = counts.enough;
    self->state.complete = 1;
    pthread_mutex_unlock(&self->at_work);
    return LD_OK;
}

static ld_status check_state(const study_join *self, double time, ld_error *error)
{
    const double patience = 30; // [s] with a folder that others read late
    if (self->state.time == 0 && time - self->begun > patience)
        return ld_fail(error, LD_ERR_INPUT,
                       "another launchdyn process uses %s/study.db: wait until it ends, or use "
                       "another folder",
                       self->folder);
    if (self->state.time == 0 || self->state.key == self->whole)
        return LD_OK;
    return ld_fail(error, LD_ERR_INPUT,
                   "other processes compute another study in %s: another scenario, number of "
                   "samples, stopping rule or version of launchdyn; use another folder, or wait "
                   "until they end",
                   self->folder);
}

static ld_status read_state(study_join *self, double time, ld_error *error)
{
    pthread_mutex_lock(&self->at_work);
    double before = self->state.time;
    join_state_read(&self->state, &self->claims);
    if (self->state.time != before)
        self->heard = time;
    ld_status status = check_state(self, time, error);
    pthread_mutex_unlock(&self->at_work);
    return status;
}

// ---- the process

static void tell(study_join *self, double time)
{
    ld_study_counts *counts = self->counts;
    pthread_mutex_lock(&self->at_work);
    if (self->state.count > 0 || self->state.complete) {
        counts->samples = self->state.samples;
        counts->done = self->state.done;
        counts->failed = self->state.failed;
        counts->enough = self->state.enough;
        counts->look = self->state.ruled ? self->state.look : 0;
    }
    ld_study_counts told = *counts;
    pthread_mutex_unlock(&self->at_work);
    if (!self->options->progress || time - self->told < READ || told.done == self->told_done)
        return;
    self->told = time;
    self->told_done = told.done;
    self->options->progress(self->options->self, &told);
}

static ld_status renew(study_join *self, double time, ld_error *error)
{
    bool there;
    pthread_mutex_lock(&self->at_work);
    ld_status status = claims_renew(&self->claims, &there, error);
    pthread_mutex_unlock(&self->at_work);
    self->renewed = time;
    self->removed = !status && !there;
    return status;
}

static ld_status serve(study_join *self, double time, ld_error *error)
{
    ld_status status = LD_OK;
    bool due = time - self->read >= READ, more;
    if (time - self->renewed > self->claims.expiry / 6 || (due && self->state.count == 0))
        status = renew(self, time, error);
    if (!status && self->removed)
        return self->keeping
                   ? ld_fail(error, LD_ERR_FILE, "another program has removed or moved %s",
                             self->claims.folder)
                   : read_end(self, error);
    if (!status && due && !self->keeping && time - self->heard > SILENCE)
        status = try_to_keep(self, error);
    if (!status && due && self->keeping)
        status = keep_some_parts(self, time, &more, error);
    else if (!status && due)
        status = read_state(self, time, error);
    if (due)
        self->read = time;
    return status;
}

static void serve_until_end(study_join *self)
{
    ld_error error;
    while (join_continues(self) && !self->state.complete) {
        double time = now();
        ld_status status = serve(self, time, &error);
        if (status)
            join_stop(self, status, &error);
        tell(self, time);
        nanosleep(&(struct timespec){.tv_nsec = (long)(TICK * 1e9)}, NULL);
    }
}

// What the ranges have so far is left for the keeper, this process or another.
static void give_up_ranges(study_join *self)
{
    ld_error error;
    while (self->open_count > 0) {
        ld_status status = close_range(self, self->open_count - 1, &error);
        if (status)
            source_end_with(&self->end, status, &error);
    }
}

static ld_status prepare(study_join *self, ld_error *error)
{
    double expiry = self->options->expiry > 0 ? self->options->expiry : EXPIRY;
    ld_status status = ranges_create(&self->ranges, self->study, error);
    if (status)
        return status;
    self->kind = calloc((size_t)self->ranges.count + 1, sizeof *self->kind);
    if (!self->kind)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the ranges of samples");
    status = study_key(self->study, &self->key, error);
    if (!status)
        status = join_key(self->study, &self->whole, error);
    if (!status)
        status = folder_ensure(self->folder, error);
    if (!status)
        status = claims_open(&self->claims, self->folder, expiry, error);
    return status ? status : try_to_keep(self, error);
}

static ld_status end(study_join *self)
{
    ld_error error;
    give_up_ranges(self);
    if (self->keeping && self->keeper.open && !self->end.status && self->claims.me[0]) {
        ld_status status = keep_all_parts(self, &error);
        if (status && join_continues(self))
            source_end_with(&self->end, status, &error);
    }
    bool complete = self->state.complete;
    tell(self, now() + READ);
    if (self->keeping) {
        ld_status status = keeper_close(&self->keeper, &error);
        if (status && (complete || join_continues(self)))
            source_end_with(&self->end, status, &error);
    }
    if (self->keeping && self->end.status) // what it says is not so, or not long
        claims_remove(&self->claims, "state");
    claims_close(&self->claims, self->keeping && complete && !self->end.status);
    ranges_free(&self->ranges);
    join_state_free(&self->state);
    free(self->kind);
    free(self->open);
    if (self->end.status || complete)
        return self->end.status;
    return ld_fail(self->end.error, LD_ERR_INTERRUPTED,
                   "interrupted after %" PRId64 " of %" PRId64
                   " samples; the same command continues",
                   self->counts->done, self->counts->samples);
}

ld_status ld_study_join(const ld_study *study, const char *folder, const ld_study_options *options,
                        ld_study_counts *counts, ld_error *error)
{
    assert(study && folder && counts);
    static const ld_study_options none = {0};
    ld_error own;
    error = error ? error : &own;
    options = options ? options : &none;
    *counts = (ld_study_counts){.samples = study->samples};
    ld_status status = study_check(study, error);
    if (status)
        return status;
    study_join self = {.study = study,
                       .options = options,
                       .folder = folder,
                       .counts = counts,
                       .pause = LEAST_SEARCH,
                       .end = {.error = error},
                       .at_work = PTHREAD_MUTEX_INITIALIZER};
    self.begun = self.heard = now();
    ld_error reason;
    status = prepare(&self, &reason);
    if (status)
        source_end_with(&self.end, status, &reason);
    const sample_source source = {&self, study, join_next, join_keep, join_continues, join_stop};
    int threads = options->threads > 1 ? options->threads : 1, started = 0;
    pthread_t *thread = calloc((size_t)threads, sizeof *thread);
    if (!thread)
        source_end_with(&self.end, ld_fail(&reason, LD_ERR_MEMORY, "no memory for threads"),
                        &reason);
    else if (!self.end.stopped)
        started = worker_start_some(thread, threads, threads, &source);
    serve_until_end(&self);
    while (started > 0)
        pthread_join(thread[--started], NULL);
    free(thread);
    return end(&self);
}
