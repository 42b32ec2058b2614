// A study's database as SQLite knows it: statements, transactions, failures.
#ifndef LD_STUDIES_STORE_DATABASE_H
#define LD_STUDIES_STORE_DATABASE_H

#include <sqlite3.h>

#include "launchdyn/status.h"
#include "studies/plan/study.h"
#include "studies/store/pending.h"

// How a commit is made sure. The write-ahead log is quick and requires one machine's memory; the
// rollback journal serves files on a network too.
typedef enum store_journal { STORE_AHEAD, STORE_ROLLBACK } store_journal;

// How many samples are kept, the greatest of their numbers, the sum of their digests; the digest of
// what is said once.
typedef struct store_kept {
    int64_t samples, greatest;
    uint64_t sum;
    uint32_t facts;
} store_kept;

static inline void store_kept_add(store_kept *self, int64_t number, uint32_t digest)
{
    self->samples++;
    self->greatest = number > self->greatest ? number : self->greatest;
    self->sum += digest;
}

typedef struct study_store {
    sqlite3 *database;
    sqlite3_stmt *insert_sample, *insert_rocket, *find;
    const ld_study *study;
    store_journal journal;
    study_pending pending; // records put that are not settled
    double settled;        // [s] when, on a clock of its own
    store_kept kept;
    int64_t opened; // greatest number kept when it was opened
    int lock;       // descriptor of the locked file, -1: none
    char path[4096];
} study_store;

// What the database's latest failure is: LD_ERR_INPUT, what it holds; LD_ERR_MEMORY; LD_ERR_FILE.
ld_status store_status(const study_store *self);
// Fails so, with the database's own words.
ld_status store_fail(const study_store *self, const char *what, ld_error *error);
// By a result that may not be SQLite's latest, of the database at `path`: the store's own, or one
// attached to it.
ld_status store_fail_by(const study_store *self, int code, const char *path, const char *what,
                        ld_error *error);
// Of the database at `path`, which is attached.
ld_status store_fail_at(const study_store *self, const char *path, const char *what,
                        ld_error *error);

// A statement, NULL after an error.
sqlite3_stmt *store_prepare(study_store *self, const char *text, ld_error *error);
// Of a text that SQLite has put together, which is freed. Names of columns stand in it as
// "\"%w\"": what a forged database calls them is a name and no more.
sqlite3_stmt *store_prepare_built(study_store *self, sqlite3_str *text, ld_error *error);
ld_status store_execute(study_store *self, const char *text, ld_error *error);
// Ends a transaction: commits it, or, after a failure, takes it back.
ld_status store_commit(study_store *self, ld_status status, ld_error *error);
// "INSERT INTO table VALUES (?, ?, ...)"
sqlite3_stmt *store_prepare_insert(study_store *self, const char *table, int columns,
                                   ld_error *error);
// Steps a statement that gives no rows.
bool store_step(sqlite3_stmt *statement);

#endif
