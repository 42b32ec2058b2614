#include "studies/store/store.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/lock_file.h"
#include "base/random.h"
#include "launchdyn/version.h"
#include "results/folder.h"
#include "studies/store/row_digest.h"
#include "studies/store/store_begin.h"
#include "studies/store/store_check.h"
#include "studies/store/store_text.h"

// ---- opening

enum { PATIENCE = 10000 }; // [ms] with another who reads or writes

void store_lock_name(const char *path, char name[4096])
{
    snprintf(name, 4096, "%.*s.lock", (int)(strlen(path) - strlen(".db")), path);
}

// "shard-03-of-64"
static void name_file(char *path, size_t size, const store_place *place)
{
    int digits = snprintf(NULL, 0, "%d", place->shards);
    if (place->shards > 0)
        snprintf(path, size, "%s/shard-%0*d-of-%d.db", place->folder, digits, place->shard,
                 place->shards);
    else
        snprintf(path, size, "%s/study.db", place->folder);
}

static ld_status prepare_all(study_store *self, ld_error *error)
{
    const study_shape *shape = &self->study->shape;
    self->insert_sample = store_prepare_insert(self, "sample", 5 + (int)shape->of_sample, error);
    if (self->insert_sample)
        self->insert_rocket =
            store_prepare_insert(self, "rocket", 2 + (int)record_width(shape), error);
    if (self->insert_rocket)
        self->find = store_prepare(self, "SELECT 1 FROM sample WHERE sample = ?", error);
    return self->find ? LD_OK : error->status;
}

// What acts of itself is none of a study's; what a view or a trigger of a forged one would do is
// not done, even before it is refused.
static int disable_triggers(sqlite3 *database)
{
    static const int options[] = {SQLITE_DBCONFIG_ENABLE_TRIGGER, SQLITE_DBCONFIG_ENABLE_VIEW,
                                  SQLITE_DBCONFIG_TRUSTED_SCHEMA};
    int result = SQLITE_OK;
    for (size_t i = 0; i < sizeof options / sizeof *options && result == SQLITE_OK; i++)
        result = sqlite3_db_config(database, options[i], 0, NULL);
    return result;
}

// From one kind of journal to another leads only what no one else has open; for that SQLite does
// not wait on its own.
static ld_status set_journal(study_store *self, ld_error *error)
{
    enum { PAUSE = 20 }; // [ms]
    const char *text = self->journal == STORE_AHEAD
                           ? "PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL"
                           : "PRAGMA journal_mode = TRUNCATE; PRAGMA synchronous = NORMAL";
    int result = sqlite3_exec(self->database, text, NULL, NULL, NULL);
    for (int waited = 0; result == SQLITE_BUSY && waited < PATIENCE; waited += PAUSE) {
        sqlite3_sleep(PAUSE);
        result = sqlite3_exec(self->database, text, NULL, NULL, NULL);
    }
    return result == SQLITE_OK ? LD_OK : store_fail(self, "write", error);
}

static ld_status open_database(study_store *self, store_journal journal, ld_error *error)
{
    // one thread at a time
    const int mode = SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX;
    if (sqlite3_open_v2(self->path, &self->database, mode, NULL) != SQLITE_OK ||
        disable_triggers(self->database) != SQLITE_OK)
        return store_fail(self, "open", error);
    self->journal = journal;
    ld_status status = set_journal(self, error);
    sqlite3_busy_timeout(self->database, PATIENCE);
    return status;
}

// ---- samples

ld_status store_count(study_store *self, ld_study_counts *counts, ld_error *error)
{
    sqlite3_stmt *count = store_prepare(
        self,
        "SELECT count(*), count(*) FILTER (WHERE status != 'ok'), (SELECT value FROM study WHERE "
        "name = 'samples') FROM sample",
        error);
    *counts = (ld_study_counts){0};
    if (!count)
        return store_status(self);
    bool read = sqlite3_step(count) == SQLITE_ROW;
    if (read) {
        counts->done = sqlite3_column_int64(count, 0);
        counts->failed = sqlite3_column_int64(count, 1);
        counts->samples = sqlite3_column_int64(count, 2);
    }
    sqlite3_finalize(count);
    return read ? LD_OK : store_fail(self, "read", error);
}

ld_status store_set_samples(study_store *self, int64_t samples, ld_error *error)
{
    ld_status status = store_execute(self, "BEGIN IMMEDIATE", error);
    if (!status)
        status = store_set_number(self, "samples", samples, error);
    if (!status)
        status = store_seal(self, error);
    return store_commit(self, status, error);
}

ld_status store_has(study_store *self, int64_t number, bool *there, ld_error *error)
{
    *there = false;
    if (number > self->opened)
        return LD_OK;
    sqlite3_bind_int64(self->find, 1, number);
    int result = sqlite3_step(self->find);
    sqlite3_reset(self->find);
    *there = result == SQLITE_ROW;
    return result == SQLITE_ROW || result == SQLITE_DONE ? LD_OK : store_fail(self, "read", error);
}

ld_status store_numbers(study_store *self, void (*found)(void *, int64_t), void *argument,
                        ld_error *error)
{
    sqlite3_stmt *numbers = store_prepare(self, "SELECT sample FROM sample", error);
    int result = SQLITE_ROW;
    if (!numbers)
        return store_status(self);
    while ((result = sqlite3_step(numbers)) == SQLITE_ROW)
        found(argument, sqlite3_column_int64(numbers, 0));
    sqlite3_finalize(numbers);
    return result == SQLITE_DONE ? LD_OK : store_fail(self, "read", error);
}

// A row on its way into the database, and the digest of what was bound so far.
typedef struct bound_row {
    sqlite3_stmt *insert;
    int columns;
    uint32_t digest;
} bound_row;

static void bind_integer(bound_row *row, int64_t value)
{
    sqlite3_bind_int64(row->insert, ++row->columns, value);
    row->digest = digest_integer(row->digest, value);
}

// A text that lasts until the step; NULL: none.
static void bind_text(bound_row *row, const char *text)
{
    sqlite3_bind_text(row->insert, ++row->columns, text, -1, SQLITE_STATIC);
    row->digest = text ? digest_text(row->digest, text, strlen(text)) : digest_null(row->digest);
}

static void bind_numbers(bound_row *row, const double *value, int64_t count)
{
    for (int64_t i = 0; i < count; i++) {
        row->columns++;
        if (isnan(value[i])) {
            sqlite3_bind_null(row->insert, row->columns);
            row->digest = digest_null(row->digest);
        } else {
            sqlite3_bind_double(row->insert, row->columns, value[i]);
            row->digest = digest_real(row->digest, value[i]);
        }
    }
}

static bool put_rocket(study_store *self, const study_record *record, int rocket, uint32_t *digest)
{
    bound_row row = {.insert = self->insert_rocket, .digest = *digest};
    const double *value = record->value + record_rocket(&record->shape, rocket - 1);
    bind_integer(&row, record->number);
    bind_integer(&row, rocket);
    bind_integer(&row, (int64_t)value[0]);
    bind_numbers(&row, value + 1, record_width(&record->shape) - 1);
    *digest = row.digest;
    return store_step(row.insert);
}

static bool put_sample(study_store *self, const study_record *record, uint32_t *digest)
{
    bound_row row = {.insert = self->insert_sample, .digest = *digest};
    bind_integer(&row, record->number);
    bind_integer(&row, study_point_of(self->study, record->number) + 1);
    bind_text(&row, ld_status_name((ld_status)record->outcome));
    bind_text(&row, record->outcome ? record->reason : NULL);
    bind_numbers(&row, record->value, record->shape.of_sample);
    *digest = row.digest;
    bind_integer(&row, (int32_t)*digest);
    return store_step(row.insert);
}

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_MONOTONIC, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static bool insert_record(study_store *self, const study_record *record)
{
    bool good = true;
    uint32_t digest = 0;
    for (int i = 1; i <= record->shape.rockets && good; i++)
        good = put_rocket(self, record, i, &digest);
    if (!good || !put_sample(self, record, &digest))
        return false;
    store_kept_add(&self->kept, record->number, digest);
    return true;
}

// Inserts what is pending; an earlier run may have committed some of it.
static ld_status insert_pending(study_store *self, ld_error *error)
{
    ld_status status = LD_OK;
    for (int i = 0; i < self->pending.count && !status; i++) {
        const study_record *record = pending_read(&self->pending, i);
        bool there;
        status = store_has(self, record->number, &there, error);
        if (!status && !there && !insert_record(self, record))
            status = store_fail(self, "write", error);
    }
    return status;
}

// A database whose name is gone takes rows all the same.
ld_status store_check_place(const study_store *self, ld_error *error)
{
    int moved = 0;
    sqlite3_file_control(self->database, "main", SQLITE_FCNTL_HAS_MOVED, &moved);
    return moved ? ld_fail(error, LD_ERR_FILE,
                           "cannot write %s: another program has removed or moved it", self->path)
                 : LD_OK;
}

ld_status store_settle(study_store *self, bool at_once, ld_error *error)
{
    const double often = 0.1; // [s]
    if (self->pending.count == 0 || (!at_once && now() - self->settled < often))
        return LD_OK;
    const store_kept before = self->kept;
    ld_status status = store_check_place(self, error);
    if (!status)
        status = store_execute(self, "BEGIN IMMEDIATE", error);
    if (!status)
        status = insert_pending(self, error);
    if (!status)
        status = store_write_kept(self, error);
    status = store_commit(self, status, error);
    if (!status)
        pending_clear(&self->pending);
    else
        self->kept = before;
    self->settled = now();
    return status;
}

ld_status store_put(study_store *self, const study_record *record, ld_error *error)
{
    ld_status status = LD_OK;
    if (self->pending.count == PENDING_MOST)
        status = store_settle(self, true, error);
    if (!status)
        pending_add(&self->pending, record);
    return status;
}

static ld_status open_pending(study_store *self, ld_error *error)
{
    char path[4096];
    snprintf(path, sizeof path, "%.*s.pending", (int)(strlen(self->path) - strlen(".db")),
             self->path);
    const store_view view = store_main(self);
    char *hash;
    ld_status status = store_view_text(&view, "hash", &hash, error);
    if (status)
        return status;
    uint64_t key = random_stream(hash ? hash : "") ^ random_stream(LD_VERSION);
    free(hash);
    status = pending_open(&self->pending, path, key, &self->study->shape, error);
    self->opened = INT64_MAX; // what an earlier run has left may be there
    if (!status)
        status = store_settle(self, true, error);
    self->opened = self->kept.greatest;
    return status;
}

// ---- the whole of it

static ld_status name_store(study_store *self, const store_place *place, char lock[4096],
                            ld_error *error)
{
    if (strlen(place->folder) + 64 > sizeof self->path)
        return ld_fail(error, LD_ERR_INPUT, "the name of the folder is too long");
    name_file(self->path, sizeof self->path, place);
    store_lock_name(self->path, lock);
    return LD_OK;
}

static ld_status open_locked(study_store *self, const store_place *place, ld_error *error)
{
    char lock[4096];
    ld_status status = name_store(self, place, lock, error);
    if (!status && place->lock > 0)
        self->lock = place->lock;
    else if (!status)
        status = lock_file_take(lock, self->path, &self->lock, error);
    return status ? status : open_database(self, place->journal, error);
}

ld_status store_try_lock(const char *folder, int *lock, ld_error *error)
{
    study_store store;
    char name[4096];
    *lock = -1;
    ld_status status = name_store(&store, &(store_place){.folder = folder}, name, error);
    if (status)
        return status;
    status = lock_file_try(name, store.path, lock, error);
    return status == LD_ERR_INPUT ? LD_OK : status;
}

ld_status store_open(study_store *self, const store_place *place, const ld_study *study,
                     ld_error *error)
{
    *self = (study_store){.study = study, .lock = -1};
    ld_status status = folder_ensure(place->folder, error);
    if (!status)
        status = open_locked(self, place, error);
    if (!status)
        status = store_begin(self, error);
    if (!status)
        status = prepare_all(self, error);
    if (!status)
        status = open_pending(self, error);
    if (status)
        store_close(self);
    return status;
}

// Checks a database that is not new.
static ld_status check_begun(study_store *self, ld_error *error)
{
    const store_view view = store_main(self);
    sqlite3_stmt *tables = store_prepare(self, "SELECT 1 FROM sqlite_master", error);
    if (!tables)
        return store_status(self);
    int result = sqlite3_step(tables);
    sqlite3_finalize(tables);
    if (result == SQLITE_DONE)
        return LD_OK;
    return result == SQLITE_ROW ? store_check(&view, &self->kept, error)
                                : store_fail(self, "read", error);
}

ld_status store_open_to_merge(study_store *self, const char *folder, ld_error *error)
{
    const store_place place = {.folder = folder, .journal = STORE_ROLLBACK};
    *self = (study_store){.lock = -1};
    ld_status status = open_locked(self, &place, error);
    if (!status)
        status = check_begun(self, error);
    if (status)
        store_close(self);
    return status;
}

// The file as a URI with a query, for sqlite3_free(); NULL: no memory.
static char *file_uri(const char *path, const char *query)
{
    sqlite3_str *text = sqlite3_str_new(NULL);
    sqlite3_str_appendall(text, "file:");
    for (; *path; path++)
        if (strchr("%?#", *path))
            sqlite3_str_appendf(text, "%%%02x", (unsigned char)*path);
        else
            sqlite3_str_appendchar(text, 1, *path);
    sqlite3_str_appendf(text, "?%s", query);
    return sqlite3_str_finish(text);
}

// A database in WAL mode requires its side files, which a reader may have to make; where it may not
// and none is there, no one writes.
static int open_to_read(study_store *self, const char *folder)
{
    char log[sizeof self->path + 8], *name;
    snprintf(log, sizeof log, "%s-wal", self->path);
    if (access(folder, W_OK) == 0)
        return sqlite3_open_v2(self->path, &self->database, SQLITE_OPEN_READWRITE, NULL);
    if (access(log, F_OK) == 0)
        return sqlite3_open_v2(self->path, &self->database, SQLITE_OPEN_READONLY, NULL);
    name = file_uri(self->path, "immutable=1");
    int result =
        name ? sqlite3_open_v2(name, &self->database, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, NULL)
             : SQLITE_NOMEM;
    sqlite3_free(name);
    return result;
}

ld_status store_open_to_read(study_store *self, const char *folder, ld_error *error)
{
    *self = (study_store){.lock = -1};
    snprintf(self->path, sizeof self->path, "%.4000s/study.db", folder);
    if (access(self->path, R_OK) != 0)
        return ld_fail(error, LD_ERR_INPUT, "%s contains no study: cannot read %s: %s", folder,
                       self->path, strerror(errno));
    ld_status status = LD_OK;
    if (open_to_read(self, folder) != SQLITE_OK || disable_triggers(self->database) != SQLITE_OK ||
        sqlite3_busy_timeout(self->database, PATIENCE) != SQLITE_OK ||
        sqlite3_exec(self->database, "PRAGMA query_only = 1; BEGIN; SELECT 1 FROM sqlite_master",
                     NULL, NULL, NULL) != SQLITE_OK)
        status = store_fail(self, "read", error);
    const store_view view = store_main(self);
    if (!status)
        status = store_read_kept(&view, &self->kept, error);
    if (status)
        store_close(self);
    return status;
}

void store_close(study_store *self)
{
    sqlite3_finalize(self->insert_sample);
    sqlite3_finalize(self->insert_rocket);
    sqlite3_finalize(self->find);
    if (self->journal == STORE_ROLLBACK) // takes the empty journal away
        sqlite3_exec(self->database, "PRAGMA journal_mode = DELETE", NULL, NULL, NULL);
    sqlite3_close(self->database);
    pending_close(&self->pending);
    lock_file_release(self->lock);
    *self = (study_store){.lock = -1};
}
