// What a database says of itself, so that damage is reported. Each sample has a digest of its rows
// (row_digest.h), and the row `kept` of the table `study` says how many samples there are, the
// greatest number, the sum of their digests, and a digest of all that is said once (the tables
// themselves, `study`, `point`, `origin`) and of these three numbers.
#ifndef LD_STUDIES_STORE_CHECK_H
#define LD_STUDIES_STORE_CHECK_H

#include "studies/store/store_text.h"

// Reads the row `kept`; refuses another format, other tables, and what is said once where it is
// damaged.
ld_status store_read_kept(const store_view *self, store_kept *kept, ld_error *error);
// Writes it, in a transaction of the caller's: after what is said once has changed, and `kept`.
ld_status store_seal(study_store *self, ld_error *error);
// The same, where only samples were added.
ld_status store_write_kept(study_store *self, ld_error *error);

// A way through the samples that are as they were kept, in the order of their numbers; it continues
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
