// The folder of a study: one SQLite database, study.db. Tables:
//   study   (name, value): format, version, hash, scenario, samples, strata
//   sample  (sample, status, reason, then the factors drawn once a sample)
//   rocket  (sample, rocket, tube, then the factors drawn for every rocket, then the results)
// Numbers are stored with all their bits; what is not there is NULL. Each sample is one
// transaction.
#ifndef LD_STUDIES_STORE_H
#define LD_STUDIES_STORE_H

#include <sqlite3.h>

#include "io/study_results.h"
#include "launchdyn/study.h"
#include "studies/sample.h"

typedef struct study_store {
    sqlite3 *database;
    sqlite3_stmt *insert_sample, *insert_rocket, *find;
    const ld_model *model;
    int lock; // descriptor of the locked file, -1: none
    char path[4096];
} study_store;

// Opens the folder for the study of `model`, making what is not there; refuses another scenario's,
// or one at which another process is at work.
ld_status store_open(study_store *self, const char *folder, const ld_model *model, ld_error *error);
// Opens what is there, for reading only.
ld_status store_open_to_read(study_store *self, const char *folder, ld_error *error);
void store_close(study_store *self);

// The text of that name in the table `study`, to be freed; NULL where there is none.
char *store_text(study_store *self, const char *name);
// Counts what is kept.
ld_status store_count(study_store *self, ld_study_counts *counts, ld_error *error);
// Whether the sample is kept already.
ld_status store_has(study_store *self, int64_t number, bool *there, ld_error *error);
// Keeps a sample with what came of it.
ld_status store_put(study_store *self, int64_t number, const study_sample *sample,
                    ld_status outcome, const char *reason, const ld_summary *summary,
                    ld_error *error);

// Fails with the database's own words.
ld_status store_fail(const study_store *self, const char *what, ld_error *error);
// A statement, NULL after an error.
sqlite3_stmt *store_prepare(study_store *self, const char *text, ld_error *error);

#endif
