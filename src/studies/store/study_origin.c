// Where a study comes from, read back from its database.
#include <stdlib.h>
#include <string.h>

#include "model/fields/source.h"
#include "results/origin.h"
#include "studies/store/store.h"
#include "studies/store/store_text.h"
#include "studies/store/study_data.h"

static char *copy_of(const char *text, size_t length)
{
    char *copy = malloc(length + 1);
    if (!copy)
        return NULL;
    memcpy(copy, text, length);
    copy[length] = '\0';
    return copy;
}

// Takes one row; false: no memory.
static bool take_row(ld_origin *origin, const char *kind, const char *name, const char *text,
                     size_t length)
{
    char *own = copy_of(text, length);
    bool fine = own != NULL;
    if (own && strcmp(kind, "file") == 0) {
        fine = source_add(origin->source, name, own, length) != NULL;
        own = NULL;
    } else if (own && strcmp(kind, "set") == 0) {
        fine = source_add_set(origin->source, own);
    } else if (own) {
        fine = origin_add_fact(origin, name, own);
    }
    free(own);
    return fine;
}

static ld_status read_rows(study_store *store, ld_origin *origin, ld_error *error)
{
    bool fine = true;
    sqlite3_stmt *row =
        store_prepare(store, "SELECT kind, name, text FROM origin ORDER BY rowid", error);
    int result = SQLITE_DONE;
    if (!row)
        return store_status(store);
    while (fine && (result = sqlite3_step(row)) == SQLITE_ROW) {
        const char *kind = (const char *)sqlite3_column_text(row, 0);
        const char *name = (const char *)sqlite3_column_text(row, 1);
        const char *text = sqlite3_column_blob(row, 2);
        fine = kind && name &&
               take_row(origin, kind, name, text ? text : "", (size_t)sqlite3_column_bytes(row, 2));
    }
    sqlite3_finalize(row);
    if (!fine)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the texts of the study");
    return result == SQLITE_DONE ? LD_OK : store_fail(store, "read", error);
}

// Without a scenario where the study does not say.
static ld_status read_origin(study_store *store, ld_origin *origin, ld_error *error)
{
    origin->source = source_new("", NULL);
    const store_view view = store_main(store);
    if (!origin->source)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the texts of the study");
    ld_status status = store_view_text(&view, "resolved", &origin->scenario, error);
    if (!status)
        status = read_rows(store, origin, error);
    if (status || (origin->scenario && origin->source->file_count > 0))
        return status;
    source_free(origin->source);
    origin->source = NULL;
    return LD_OK;
}

// The same, with the scenario's name.
static ld_status read_named_origin(study_store *store, ld_origin *origin, ld_error *error)
{
    *origin = (ld_origin){0};
    ld_status status = read_origin(store, origin, error);
    if (!status && origin->source) {
        free(origin->source->name);
        origin->source->name = strdup(origin->source->file[0]->name);
        if (!origin->source->name)
            status = ld_fail(error, LD_ERR_MEMORY, "no memory for the study's name");
    }
    if (status)
        ld_origin_free(origin);
    return status;
}

ld_status study_data_origin(const study_data *data, ld_origin *origin, ld_error *error)
{
    return read_named_origin(study_data_store(data), origin, error);
}

ld_status ld_study_read_origin(const char *folder, ld_origin *origin, ld_error *error)
{
    study_store store;
    *origin = (ld_origin){0};
    ld_status status = store_open_to_read(&store, folder, error);
    if (status)
        return status;
    status = read_named_origin(&store, origin, error);
    if (!status && !origin->scenario) {
        ld_origin_free(origin);
        status = ld_fail(error, LD_ERR_INPUT, "%.300s is damaged: its scenario cannot be read",
                         store.path);
    }
    store_close(&store);
    return status;
}
