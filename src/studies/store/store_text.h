// A database that is checked, and its texts: those of the table `study`, or what a row has.
#ifndef LD_STUDIES_STORE_TEXT_H
#define LD_STUDIES_STORE_TEXT_H

#include "studies/store/store_database.h"

// A database that is checked: the store's own, "main", or one attached to it.
typedef struct store_view {
    study_store *store;
    const char *schema, *path;
} store_view;

static inline store_view store_main(study_store *self)
{
    return (store_view){self, "main", self->path};
}

// Fails with what kept it from being read.
ld_status store_view_fail(const store_view *self, ld_error *error);
// A statement of a text in which "%s" is the database's name; NULL after an error.
sqlite3_stmt *store_view_prepare(const store_view *self, const char *format, ld_error *error);

// The text of that name in the table `study`, to be freed; NULL where there is none, no such table
// either.
ld_status store_view_text(const store_view *self, const char *name, char **text, ld_error *error);
// What a row has in a column, to be freed; NULL: nothing.
ld_status store_column_text(const store_view *self, sqlite3_stmt *row, int column, char **text,
                            ld_error *error);

// The first cell that a statement gives, to be freed; NULL: it gives none. The statement, NULL
// after an error, is finalized.
ld_status store_first_text(const store_view *self, sqlite3_stmt *row, char **text, ld_error *error);

// Writes a row of the table `study`.
ld_status store_set_text(study_store *self, const char *name, const char *value, ld_error *error);
ld_status store_set_number(study_store *self, const char *name, int64_t value, ld_error *error);

#endif
