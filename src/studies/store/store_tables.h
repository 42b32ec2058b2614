// The tables of a study's database:
//   study   (name, value): format, version, hash, scenario, resolved, samples (of all points),
//           strata, kept (store_check.h)
//   origin  (kind, name, text): facts of each `program`, texts of each `file` and `set`
//   point   (point, then a text for each swept key)
//   sample  (sample, point, status, reason, then the factors sampled once a sample, digest)
//   rocket  (sample, rocket, tube, then the factors sampled for every rocket, then the results)
// `digest` is that of the sample's rows in `rocket` and of its own (row_digest.h).
// Numbers are stored with all their bits; what is not there is NULL.
#ifndef LD_STUDIES_STORE_TABLES_H
#define LD_STUDIES_STORE_TABLES_H

#include "studies/store/store_text.h"

// Raised when they change.
#define STORE_FORMAT "10"

// The statements that make the tables of the store's study, for sqlite3_free().
ld_status store_tables_of_study(const study_store *self, char **text, ld_error *error);
// Refuses a database that has anything beside plain tables of a study: triggers, views, indices.
ld_status store_check_tables(const store_view *self, ld_error *error);
// The statements that make the tables which a database has, for sqlite3_free(); refuses one that
// was made by others, as with computed columns.
ld_status store_tables_of(const store_view *self, char **text, ld_error *error);

#endif
