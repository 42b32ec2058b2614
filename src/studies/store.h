// A study's database, SQLite. Tables:
//   study   (name, value): format, version, hash, scenario, resolved, samples (of all points),
//   strata origin  (kind, name, text): facts of each `program`, texts of each `file` and `set`
//   point   (point, then a text for each swept key)
//   sample  (sample, point, status, reason, then the factors drawn once a sample)
//   rocket  (sample, rocket, tube, then the factors drawn for every rocket, then the results)
// Numbers are stored with all their bits; what is not there is NULL. A study's folder holds
// study.db and, of jobs that ran a part of it, shard-I-of-N.db; each has a lock file beside it.
#ifndef LD_STUDIES_STORE_H
#define LD_STUDIES_STORE_H

#include <sqlite3.h>

#include "launchdyn/study.h"
#include "studies/pending.h"
#include "studies/record.h"
#include "studies/study.h"

// How a commit is made sure. The write-ahead log is quick and wants one machine's memory; the
// rollback journal serves files on a network too.
typedef enum store_journal { STORE_AHEAD, STORE_ROLLBACK } store_journal;

typedef struct study_store {
    sqlite3 *database;
    sqlite3_stmt *insert_sample, *insert_rocket, *find;
    const ld_study *study;
    store_journal journal;
    study_pending pending; // records put that are not settled
    double settled;        // [s] when, on a clock of its own
    int64_t greatest;      // number kept when it was opened
    int lock;              // descriptor of the locked file, -1: none
    char path[4096];
} study_store;

// Opens the database for `study`, making what is not there; refuses another scenario's,
// or one at which another process is at work. Of a shard (shards > 0) it is a database of its own.
ld_status store_open(study_store *self, const char *folder, int shard, int shards,
                     const ld_study *study, store_journal journal, ld_error *error);
// Opens study.db where it is there, for reading only.
ld_status store_open_to_read(study_store *self, const char *folder, ld_error *error);
// Opens study.db, which may be new and empty, to add what shards hold.
ld_status store_open_to_merge(study_store *self, const char *folder, ld_error *error);
// What is not settled waits in its file.
void store_close(study_store *self);

// The text of that name in the table `study`, to be freed; NULL where there is none.
char *store_text(study_store *self, const char *name);
// Counts what is kept.
ld_status store_count(study_store *self, ld_study_counts *counts, ld_error *error);
// How many samples are enough after all.
ld_status store_set_samples(study_store *self, int64_t samples, ld_error *error);
// Whether the sample is kept already.
ld_status store_has(study_store *self, int64_t number, bool *there, ld_error *error);

// Keeps a record; it outlives a kill at once and a loss of power when it is settled.
ld_status store_put(study_store *self, const study_record *record, ld_error *error);
// Commits what was put, where a tenth of a second has gone by since the last time, or now.
ld_status store_settle(study_store *self, bool now, ld_error *error);

// What the database's latest failure is: LD_ERR_INPUT, what it holds; LD_ERR_MEMORY; LD_ERR_FILE.
ld_status store_status(const study_store *self);
// Fails so, with the database's own words.
ld_status store_fail(const study_store *self, const char *what, ld_error *error);
// A statement, NULL after an error.
sqlite3_stmt *store_prepare(study_store *self, const char *text, ld_error *error);
ld_status store_execute(study_store *self, const char *text, ld_error *error);
// "INSERT INTO table VALUES (?, ?, ...)"
sqlite3_stmt *store_prepare_insert(study_store *self, const char *table, int columns,
                                   ld_error *error);
// Steps a statement that gives no rows.
bool store_step(sqlite3_stmt *statement);
ld_status store_set_number(study_store *self, const char *name, int64_t value, ld_error *error);
// Makes the tables, or refuses those of another study.
ld_status store_begin(study_store *self, ld_error *error);
static inline bool store_is_of_rocket(const study_store *self, int factor)
{
    return self->study->nominal->scatter.factor[factor].per_rocket;
}
// Opens and locks the lock file of the database at `path`; *lock -1: it could not be.
ld_status store_lock(const char *path, int *lock, ld_error *error);

#endif
