// What makes the tables, and whether a database has these and no others, nor anything else that
// would act when it is written or read (triggers, views, computed columns).
#include "studies/store/store_tables.h"

#include <stdlib.h>
#include <string.h>

#include "model/blocks/study.h"
#include "model/parts.h"
#include "quantities/study_results.h"

// "BEGIN, "name" COLUMN, ..., "name" COLUMNEND": between what all studies' have stand the columns
// of this one.
typedef struct table {
    const char *name, *begin;
    int fixed;          // columns in `begin`
    const char *column; // type of this study's; NULL: there are none
    const char *end;
} table;

enum { STUDY, SAMPLE, POINT, ROCKET, ORIGIN, TABLES };

static const table tables[TABLES] = {
    {"study", "CREATE TABLE study (name TEXT PRIMARY KEY, value TEXT", 2, NULL, ") WITHOUT ROWID"},
    {"sample",
     "CREATE TABLE sample (sample INTEGER PRIMARY KEY, point INTEGER NOT NULL, status TEXT NOT "
     "NULL, reason TEXT",
     4, "REAL", ", digest INTEGER NOT NULL)"},
    {"point", "CREATE TABLE point (point INTEGER PRIMARY KEY", 1, "TEXT NOT NULL", ")"},
    {"rocket",
     "CREATE TABLE rocket (sample INTEGER NOT NULL, rocket INTEGER NOT NULL, tube INTEGER", 3,
     "REAL", ", PRIMARY KEY (sample, rocket)) WITHOUT ROWID"},
    {"origin", "CREATE TABLE origin (kind TEXT NOT NULL, name TEXT NOT NULL, text BLOB NOT NULL", 3,
     NULL, ")"},
};

static void append_column(sqlite3_str *text, int of, const char *name)
{
    sqlite3_str_appendf(text, ", \"%w\" %s", name, tables[of].column);
}

static ld_status no_memory(const char *path, ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the tables of %s", path);
}

static ld_status finish(const char *path, sqlite3_str *text, char **whole, ld_error *error)
{
    *whole = sqlite3_str_finish(text);
    return *whole ? LD_OK : no_memory(path, error);
}

// ---- of a study

static bool is_of_rocket(const study_store *self, int factor)
{
    return model_scatter(self->study->nominal)->factor[factor].per_rocket;
}

static void append_factors(sqlite3_str *text, const study_store *self, int of)
{
    const ld_scatter *scatter = model_scatter(self->study->nominal);
    for (int i = 0; i < scatter->factor_count; i++)
        if (is_of_rocket(self, i) == (of == ROCKET))
            append_column(text, of, scatter->factor[i].path);
}

static void append_swept(sqlite3_str *text, const study_store *self)
{
    for (int i = 0; i < model_sweep_count(self->study->nominal); i++)
        append_column(text, POINT, model_sweep(self->study->nominal, i)->path);
}

static void append_results(sqlite3_str *text, const study_store *self)
{
    char name[QUANTITY_NAME];
    quantity_walk at = study_result_first(&self->study->things);
    for (; at.row; study_result_next(&at)) {
        study_result_name(&at, name);
        append_column(text, ROCKET, name);
    }
}

ld_status store_tables_of_study(const study_store *self, char **text, ld_error *error)
{
    sqlite3_str *all = sqlite3_str_new(self->database);
    for (int of = 0; of < TABLES; of++) {
        sqlite3_str_appendf(all, "%s%s", of ? ";" : "", tables[of].begin);
        if (of == SAMPLE || of == ROCKET)
            append_factors(all, self, of);
        if (of == POINT)
            append_swept(all, self);
        if (of == ROCKET)
            append_results(all, self);
        sqlite3_str_appendall(all, tables[of].end);
    }
    return finish(self->path, all, text, error);
}

// ---- of a database

static ld_status append_own(const store_view *self, sqlite3_str *text, int of, ld_error *error)
{
    sqlite3_stmt *row = store_prepare(self->store,
                                      "SELECT name FROM pragma_table_info(?, ?) WHERE cid >= ? AND "
                                      "name != 'digest' ORDER BY cid",
                                      error);
    if (!row)
        return store_status(self->store);
    int result;
    const char *name = "";
    sqlite3_bind_text(row, 1, tables[of].name, -1, SQLITE_STATIC);
    sqlite3_bind_text(row, 2, self->schema, -1, SQLITE_STATIC);
    sqlite3_bind_int(row, 3, tables[of].fixed);
    while ((result = sqlite3_step(row)) == SQLITE_ROW &&
           (name = (const char *)sqlite3_column_text(row, 0)))
        append_column(text, of, name);
    ld_status status = !name                   ? no_memory(self->path, error)
                       : result == SQLITE_DONE ? LD_OK
                                               : store_view_fail(self, error);
    sqlite3_finalize(row);
    return status;
}

// What launchdyn would make the tables by that have these columns.
static ld_status own_tables(const store_view *self, char **text, ld_error *error)
{
    ld_status status = LD_OK;
    sqlite3_str *all = sqlite3_str_new(self->store->database);
    *text = NULL;
    for (int of = 0; of < TABLES && !status; of++) {
        sqlite3_str_appendf(all, "%s%s", of ? ";" : "", tables[of].begin);
        if (tables[of].column)
            status = append_own(self, all, of, error);
        sqlite3_str_appendall(all, tables[of].end);
    }
    if (!status)
        return finish(self->path, all, text, error);
    sqlite3_free(sqlite3_str_finish(all));
    return status;
}

// The statements by which the database has what it has.
static ld_status read_tables(const store_view *self, char **text, ld_error *error)
{
    sqlite3_str *query = sqlite3_str_new(self->store->database);
    sqlite3_str_appendf(query,
                        "SELECT group_concat(sql, ';') FROM (SELECT sql FROM %s.sqlite_master "
                        "WHERE sql NOT NULL ORDER BY rowid)",
                        self->schema);
    return store_first_text(self, store_prepare_built(self->store, query, error), text, error);
}

// Refuses it for what the query finds there, "trigger NAME", if it finds something.
static ld_status refuse_found(const store_view *self, sqlite3_str *query, ld_error *error)
{
    char *found;
    ld_status status =
        store_first_text(self, store_prepare_built(self->store, query, error), &found, error);
    if (found)
        status = ld_fail(error, LD_ERR_INPUT,
                         "%s is damaged or changed: its %.80s does not belong to a study",
                         self->path, found);
    free(found);
    return status;
}

ld_status store_check_tables(const store_view *self, ld_error *error)
{
    sqlite3_str *query = sqlite3_str_new(self->store->database);
    sqlite3_str_appendf(query,
                        "SELECT type || ' ' || name FROM %s.sqlite_master WHERE sql NOT NULL AND "
                        "NOT (type = 'table' AND sql LIKE 'CREATE TABLE%%' AND name IN (''",
                        self->schema);
    for (int of = 0; of < TABLES; of++)
        sqlite3_str_appendf(query, ", %Q", tables[of].name);
    sqlite3_str_appendall(query, "))");
    return refuse_found(self, query, error);
}

static ld_status refuse_other(const store_view *self, const char *own, ld_error *error)
{
    sqlite3_str *query = sqlite3_str_new(self->store->database);
    sqlite3_str_appendf(query,
                        "SELECT type || ' ' || name FROM %s.sqlite_master WHERE sql NOT NULL AND "
                        "instr(';' || %Q || ';', ';' || sql || ';') = 0",
                        self->schema, own);
    ld_status status = refuse_found(self, query, error);
    return status ? status
                  : ld_fail(error, LD_ERR_INPUT,
                            "%s is damaged or changed: it lacks tables of a study", self->path);
}

ld_status store_tables_of(const store_view *self, char **text, ld_error *error)
{
    char *there = NULL;
    ld_status status = own_tables(self, text, error);
    if (!status)
        status = read_tables(self, &there, error);
    if (!status && (!there || strcmp(there, *text) != 0))
        status = refuse_other(self, *text, error);
    free(there);
    if (status) {
        sqlite3_free(*text);
        *text = NULL;
    }
    return status;
}
