// A study's database, SQLite: what it has kept, what comes to it (its tables: store_tables.h).
// A study's folder holds study.db and, of jobs that ran a part of it, shard-I-of-N.db; each has a
// lock file beside it.
#ifndef LD_STUDIES_STORE_H
#define LD_STUDIES_STORE_H

#include "launchdyn/study.h"
#include "studies/plan/record.h"
#include "studies/store/store_database.h"

// Where a database is. Of a shard (shards > 0) it is one of its own.
typedef struct store_place {
    const char *folder;
    int shard, shards;
    store_journal journal;
    int lock; // a descriptor that has the database's lock, and is the store's from now on; 0: none
} store_place;

// Locks study.db of the folder, which is there, without waiting; *lock: the descriptor, -1 where
// another process has it.
ld_status store_try_lock(const char *folder, int *lock, ld_error *error);

// Opens the database for `study`, making what is not there; refuses another scenario's,
// or one at which another process is at work.
ld_status store_open(study_store *self, const store_place *place, const ld_study *study,
                     ld_error *error);
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

// Calls `found` for the number of each sample that is kept.
ld_status store_numbers(study_store *self, void (*found)(void *, int64_t), void *argument,
                        ld_error *error);

// Keeps a record; it outlives a kill at once and a loss of power when it is settled.
ld_status store_put(study_store *self, const study_record *record, ld_error *error);
// Commits what was put, where a tenth of a second has gone by since the last time, or now.
ld_status store_settle(study_store *self, bool now, ld_error *error);

// LD_ERR_FILE where the database has been removed or moved since it was opened.
ld_status store_check_place(const study_store *self, ld_error *error);

// The lock file of the database at `path`.
void store_lock_name(const char *path, char name[4096]);

#endif
