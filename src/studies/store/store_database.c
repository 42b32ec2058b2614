#include "studies/store/store_database.h"

#include <string.h>

// Of a result of SQLite's.
static ld_status status_of(int code)
{
    switch (code) {
    case SQLITE_NOMEM:
        return LD_ERR_MEMORY;
    case SQLITE_NOTADB:
    case SQLITE_CORRUPT:
    case SQLITE_ERROR:
    case SQLITE_SCHEMA:
    case SQLITE_MISMATCH:
    case SQLITE_CONSTRAINT:
        return LD_ERR_INPUT;
    default:
        return LD_ERR_FILE;
    }
}

static int latest_code(const study_store *self)
{
    return self->database ? sqlite3_errcode(self->database) : SQLITE_NOMEM;
}

ld_status store_status(const study_store *self)
{
    return status_of(latest_code(self));
}

ld_status store_fail_by(const study_store *self, int code, const char *path, const char *what,
                        ld_error *error)
{
    sqlite3 *database = self->database;
    const char *why =
        code == latest_code(self) && database ? sqlite3_errmsg(database) : sqlite3_errstr(code);
    bool of_system = database && (code == SQLITE_IOERR || code == SQLITE_CANTOPEN);
    int number = of_system ? sqlite3_system_errno(database) : 0;
    if (code == SQLITE_CORRUPT || code == SQLITE_NOTADB)
        return ld_fail(error, status_of(code), "%s is damaged: %s", path, why);
    if (code == SQLITE_BUSY)
        return ld_fail(error, status_of(code),
                       "cannot %s %s: another program is reading or writing it; wait until it "
                       "closes the study, then repeat",
                       what, path);
    return ld_fail(error, status_of(code), "cannot %s %s: %s%s%s%s", what, path, why,
                   number ? " (" : "", number ? strerror(number) : "", number ? ")" : "");
}

ld_status store_fail_at(const study_store *self, const char *path, const char *what,
                        ld_error *error)
{
    return store_fail_by(self, latest_code(self), path, what, error);
}

ld_status store_fail(const study_store *self, const char *what, ld_error *error)
{
    return store_fail_at(self, self->path, what, error);
}

sqlite3_stmt *store_prepare(study_store *self, const char *text, ld_error *error)
{
    sqlite3_stmt *statement = NULL;
    if (sqlite3_prepare_v2(self->database, text, -1, &statement, NULL) != SQLITE_OK)
        store_fail(self, "use", error);
    return statement;
}

sqlite3_stmt *store_prepare_built(study_store *self, sqlite3_str *text, ld_error *error)
{
    char *whole = sqlite3_str_finish(text);
    sqlite3_stmt *statement = whole ? store_prepare(self, whole, error) : NULL;
    if (!whole)
        ld_fail(error, LD_ERR_MEMORY, "no memory to use %s", self->path);
    sqlite3_free(whole);
    return statement;
}

ld_status store_execute(study_store *self, const char *text, ld_error *error)
{
    if (sqlite3_exec(self->database, text, NULL, NULL, NULL) != SQLITE_OK)
        return store_fail(self, "write", error);
    return LD_OK;
}

ld_status store_commit(study_store *self, ld_status status, ld_error *error)
{
    if (!status)
        status = store_execute(self, "COMMIT", error);
    if (status && !sqlite3_get_autocommit(self->database))
        sqlite3_exec(self->database, "ROLLBACK", NULL, NULL, NULL);
    return status;
}

// "INSERT INTO table VALUES (?, ?, ...)"
sqlite3_stmt *store_prepare_insert(study_store *self, const char *table, int columns,
                                   ld_error *error)
{
    sqlite3_str *text = sqlite3_str_new(self->database);
    sqlite3_str_appendf(text, "INSERT INTO %s VALUES (", table);
    for (int i = 0; i < columns; i++)
        sqlite3_str_appendall(text, i ? ", ?" : "?");
    sqlite3_str_appendall(text, ")");
    return store_prepare_built(self, text, error);
}

bool store_step(sqlite3_stmt *statement)
{
    int result = sqlite3_step(statement);
    sqlite3_reset(statement);
    return result == SQLITE_DONE;
}
