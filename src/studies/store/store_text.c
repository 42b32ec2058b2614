#include "studies/store/store_text.h"

#include <inttypes.h>
#include <string.h>

ld_status store_view_fail(const store_view *self, ld_error *error)
{
    return store_fail_at(self->store, self->path, "read", error);
}

sqlite3_stmt *store_view_prepare(const store_view *self, const char *format, ld_error *error)
{
    char query[256];
    sqlite3_stmt *statement = NULL;
    sqlite3_snprintf(sizeof query, query, format, self->schema);
    if (sqlite3_prepare_v2(self->store->database, query, -1, &statement, NULL) != SQLITE_OK)
        store_view_fail(self, error);
    return statement;
}

ld_status store_column_text(const store_view *self, sqlite3_stmt *row, int column, char **text,
                            ld_error *error)
{
    const bool there = sqlite3_column_type(row, column) != SQLITE_NULL;
    const char *found = there ? (const char *)sqlite3_column_text(row, column) : NULL;
    *text = found ? strdup(found) : NULL;
    return !there || *text ? LD_OK
                           : ld_fail(error, LD_ERR_MEMORY, "no memory to read %s", self->path);
}

ld_status store_first_text(const store_view *self, sqlite3_stmt *row, char **text, ld_error *error)
{
    *text = NULL;
    if (!row)
        return error->status;
    ld_status status = LD_OK;
    int result = sqlite3_step(row);
    if (result == SQLITE_ROW)
        status = store_column_text(self, row, 0, text, error);
    else if (result != SQLITE_DONE)
        status = store_view_fail(self, error);
    sqlite3_finalize(row);
    return status;
}

ld_status store_view_text(const store_view *self, const char *name, char **text, ld_error *error)
{
    sqlite3_stmt *select =
        store_view_prepare(self, "SELECT value FROM %s.study WHERE name = ?", error);
    *text = NULL;
    if (!select) // SQLITE_ERROR: there is no such table
        return sqlite3_errcode(self->store->database) == SQLITE_ERROR ? LD_OK
                                                                      : store_status(self->store);
    sqlite3_bind_text(select, 1, name, -1, SQLITE_STATIC);
    return store_first_text(self, select, text, error);
}

// ---- rows of the table `study`

ld_status store_set_text(study_store *self, const char *name, const char *value, ld_error *error)
{
    sqlite3_stmt *insert =
        store_prepare(self, "INSERT OR REPLACE INTO study (name, value) VALUES (?, ?)", error);
    if (!insert)
        return store_status(self);
    sqlite3_bind_text(insert, 1, name, -1, SQLITE_STATIC);
    sqlite3_bind_text(insert, 2, value, -1, SQLITE_STATIC);
    int result = sqlite3_step(insert);
    sqlite3_finalize(insert);
    return result == SQLITE_DONE ? LD_OK : store_fail(self, "write", error);
}

ld_status store_set_number(study_store *self, const char *name, int64_t value, ld_error *error)
{
    char text[32];
    snprintf(text, sizeof text, "%" PRId64, value);
    return store_set_text(self, name, text, error);
}
