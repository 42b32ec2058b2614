// A study's database, SQLite. Tables:
//   study   (name, value): format, version, hash, scenario, resolved, samples (of all points),
//           strata, kept (see below)
//   origin  (kind, name, text): facts of each `program`, texts of each `file` and `set`
//   point   (point, then a text for each swept key)
//   sample  (sample, point, status, reason, then the factors drawn once a sample, digest)
//   rocket  (sample, rocket, tube, then the factors drawn for every rocket, then the results)
// `digest` is that of the sample's rows in `rocket` and of its own (row_digest.h).
// Numbers are stored with all their bits; what is not there is NULL. A study's folder holds
// study.db and, of jobs that ran a part of it, shard-I-of-N.db; each has a lock file beside it.
#ifndef LD_STUDIES_STORE_H
#define LD_STUDIES_STORE_H

#include <sqlite3.h>

#include "launchdyn/study.h"
#include "studies/plan/record.h"
#include "studies/plan/study.h"
#include "studies/store/pending.h"

// How a commit is made sure. The write-ahead log is quick and wants one machine's memory; the
// rollback journal serves files on a network too.
typedef enum store_journal { STORE_AHEAD, STORE_ROLLBACK } store_journal;

#define STORE_FORMAT "9"

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

// Opens the database for `study`, making what is not there; refuses another scenario's,
// or one at which another process is at work. Of a shard (shards > 0) it is a database of its own.
ld_status store_open(study_store *self, const char *folder, int shard, int shards,
                     const ld_study *study, store_journal journal, ld_error *error);
// Opens study.db where it is there, for reading only; what it says once is as it was written.
ld_status store_open_to_read(study_store *self, const char *folder, ld_error *error);
// Opens study.db, which may be new and empty, to add what shards hold.
ld_status store_open_to_merge(study_store *self, const char *folder, ld_error *error);
// What is not settled waits in its file.
void store_close(study_store *self);

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

// LD_ERR_FILE where the database has been removed or moved since it was opened.
ld_status store_check_place(const study_store *self, ld_error *error);

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
// Writes a row of the table `study`.
ld_status store_set_text(study_store *self, const char *name, const char *value, ld_error *error);
ld_status store_set_number(study_store *self, const char *name, int64_t value, ld_error *error);
// Makes the tables, or refuses those of another study.
ld_status store_begin(study_store *self, ld_error *error);
static inline bool store_is_of_rocket(const study_store *self, int factor)
{
    return self->study->nominal->scatter.factor[factor].per_rocket;
}
// The lock file of the database at `path`.
void store_lock_name(const char *path, char name[4096]);

// ---- its tables (store_tables.c)

// A database that is looked at: the store's own, "main", or one attached to it.
typedef struct store_view {
    study_store *store;
    const char *schema, *path;
} store_view;

static inline store_view store_main(study_store *self)
{
    return (store_view){self, "main", self->path};
}

// The statements that make the tables of the store's study, for sqlite3_free().
ld_status store_tables_of_study(const study_store *self, char **text, ld_error *error);
// Refuses a database that has anything beside plain tables of a study: triggers, views, indices.
ld_status store_check_tables(const store_view *self, ld_error *error);
// The statements that make the tables which a database has, for sqlite3_free(); refuses one that
// was made by others, as with computed columns.
ld_status store_tables_of(const store_view *self, char **text, ld_error *error);

// ---- what a database says of itself, so that damage is told (store_check.c)

// Each sample has a digest of its rows (row_digest.h), and the row `kept` of the table `study` says
// how many samples there are, the greatest number, the sum of their digests, and a digest of all
// that is said once (the tables themselves, `study`, `point`, `origin`) and of these three numbers.

// The text of that name in the table `study`, to be freed; NULL where there is none, no such table
// either.
ld_status store_view_text(const store_view *self, const char *name, char **text, ld_error *error);
// What a row has in a column, to be freed; NULL: nothing.
ld_status store_column_text(const store_view *self, sqlite3_stmt *row, int column, char **text,
                            ld_error *error);

// The first cell that a statement gives, to be freed; NULL: it gives none. The statement, NULL
// after an error, is finalized.
ld_status store_first_text(const store_view *self, sqlite3_stmt *row, char **text, ld_error *error);

// Reads the row `kept`; refuses another format, other tables, and what is said once where it is
// damaged.
ld_status store_read_kept(const store_view *self, store_kept *kept, ld_error *error);
// Writes it, in a transaction of the caller's: after what is said once has changed, and `kept`.
ld_status store_seal(study_store *self, ld_error *error);
// The same, where only samples were added.
ld_status store_write_kept(study_store *self, ld_error *error);

// A way through the samples that are as they were kept, in the order of their numbers; it goes on
// behind those that are not, also where the database's pages are damaged.
typedef struct store_walk {
    store_view view;
    store_kept kept;
    sqlite3_stmt *sample, *rocket;
    int64_t number, point; // of the sample at which it stands
    bool failed;           // its outcome
    int rockets;           // that it has
    uint32_t digest;
    int64_t intact, damaged, first_damaged; // samples so far
    int64_t all_rockets;                    // of the intact ones
    uint64_t sum;                           // of the digests of the intact ones
    ld_status status;                       // what ended it early: no memory, a disk that fails
} store_walk;

// `kept`: as read before. To be ended in any case.
ld_status store_walk_begin(store_walk *self, const store_view *view, const store_kept *kept,
                           ld_error *error);
bool store_walk_next(store_walk *self, ld_error *error);
// Begins again.
void store_walk_again(store_walk *self);
// What a walk to the end has found.
// @return LD_OK; LD_ERR_INPUT: the database is damaged, the sentence says in what; LD_ERR_FILE,
//         LD_ERR_MEMORY
ld_status store_walk_verdict(const store_walk *self, ld_error *error);
void store_walk_end(store_walk *self);

// All of it.
ld_status store_check(const store_view *self, store_kept *kept, ld_error *error);

#endif
