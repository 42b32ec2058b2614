// The table of a study's rockets as CSV, or as HDF5.
#include "studies/show/export.h"

#include <inttypes.h>

#include "base/numeric_locale.h"
#include "launchdyn/study.h"
#include "studies/store/table_file.h"

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the table");
}

// ---- the table

// Factors stand before results.
static const study_column *column_at(const study_data *data, int i)
{
    int factors = data->column_count - data->result_count;
    return &data->column[i < factors ? data->result_count + i : i - factors];
}

const char *export_unit(const export_table *table, int column)
{
    return column < table->keys ? "" : column_at(table->data, column - table->keys)->unit;
}

static sqlite3_stmt *select_rows(const study_data *data, ld_error *error)
{
    study_store *store = study_data_store(data);
    sqlite3_str *text = sqlite3_str_new(store->database);
    sqlite3_str_appendall(text, "SELECT sample.sample, rocket.rocket, rocket.tube, sample.status");
    if (data->swept_count > 0)
        sqlite3_str_appendall(text, ", sample.point");
    for (int i = 0; i < data->swept_count; i++)
        sqlite3_str_appendf(text, ", point.\"%w\"", data->swept[i]);
    for (int i = 0; i < data->column_count; i++) {
        const study_column *column = column_at(data, i);
        sqlite3_str_appendf(text, ", %s.\"%w\"", column->per_rocket ? "rocket" : "sample",
                            column->name);
    }
    sqlite3_str_appendf(text,
                        " FROM sample JOIN rocket USING (sample)%s WHERE sample.sample = ? "
                        "ORDER BY rocket.rocket",
                        data->swept_count > 0 ? " JOIN point USING (point)" : "");
    return store_prepare_built(store, text, error);
}

// That the samples are those which were found intact when the study was opened.
static ld_status expect_as_before(const export_table *self, bool there, ld_error *error)
{
    const int64_t before = self->data->rockets;
    if (there ? self->rockets <= before : self->rockets == before)
        return LD_OK;
    return ld_fail(error, LD_ERR_FILE,
                   "cannot read %s: it is damaged, or its disk fails: read again, it gives other "
                   "samples",
                   self->walk.view.path);
}

ld_status export_next(export_table *self, bool *there, ld_error *error)
{
    int result = self->walk.number > 0 ? sqlite3_step(self->row) : SQLITE_DONE;
    ld_status status = LD_OK;
    while (result == SQLITE_DONE && store_walk_next(&self->walk, error)) {
        sqlite3_reset(self->row);
        sqlite3_bind_int64(self->row, 1, self->walk.number);
        result = sqlite3_step(self->row);
    }
    *there = result == SQLITE_ROW;
    self->rockets += *there;
    if (result == SQLITE_DONE)
        status = self->walk.status;
    else if (!*there)
        status = store_fail(self->walk.view.store, "read", error);
    return status ? status : expect_as_before(self, *there, error);
}

void export_begin(export_table *self)
{
    sqlite3_reset(self->row);
    store_walk_again(&self->walk);
    self->rockets = 0;
}

// ---- CSV

static void print_cell(FILE *stream, sqlite3_stmt *row, int column)
{
    int type = sqlite3_column_type(row, column);
    if (type == SQLITE_FLOAT) {
        fprintf(stream, "%.17g", sqlite3_column_double(row, column));
    } else if (type != SQLITE_NULL) {
        const char *text = (const char *)sqlite3_column_text(row, column);
        csv_text(stream, text ? text : ""); // NULL: no memory, which the next step tells
    }
}

static ld_status write_csv(void *self, FILE *stream, ld_error *error)
{
    export_table *table = self;
    bool there;
    ld_status status;
    export_begin(table);
    for (int i = 0; i < table->columns; i++) {
        const char *name = sqlite3_column_name(table->row, i);
        if (!name)
            return no_memory(error);
        fputs(i ? "," : "", stream);
        csv_text(stream, name);
    }
    fputc('\n', stream);
    while (!(status = export_next(table, &there, error)) && there) {
        for (int i = 0; i < table->columns; i++) {
            fputs(i ? "," : "", stream);
            print_cell(stream, table->row, i);
        }
        fputc('\n', stream);
    }
    return status;
}

// ---- both

static ld_status export_rows(const study_data *data, const char *csv, const char *hdf5,
                             ld_error *error)
{
    study_store *store = study_data_store(data);
    const store_view view = store_main(store);
    export_table table = {.data = data, .keys = EXPORT_KEYS};
    table.row = select_rows(data, error);
    if (!table.row)
        return error->status;
    table.keys += data->swept_count > 0 ? 1 + data->swept_count : 0;
    table.columns = sqlite3_column_count(table.row);
    ld_status status = store_walk_begin(&table.walk, &view, &store->kept, error);
    if (!status && csv)
        status = table_file_print(write_csv, &table, csv, error);
    if (!status && hdf5)
        status = table_file_write(export_hdf5, &table, hdf5, error);
    store_walk_end(&table.walk);
    sqlite3_finalize(table.row);
    return status;
}

// That not all samples are in what has been written, and what else has failed, if anything.
static ld_status tell_damage(const study_data *data, ld_status failed, ld_error *error)
{
    const ld_error also = failed && error ? *error : (ld_error){.text = ""};
    return ld_fail(error, failed ? failed : LD_ERR_INPUT,
                   "%s; the table holds what is intact, %" PRId64 " rockets%s%s", data->damage.text,
                   data->rockets, *also.text ? "; " : "", also.text);
}

ld_status ld_study_export(const char *folder, const char *csv, const char *hdf5, ld_error *error)
{
    study_data data;
    ld_status status = study_data_open_damaged(folder, &data, error);
    if (status)
        return status;
    locale_t before = numeric_locale_enter();
    status = export_rows(&data, csv, hdf5, error);
    numeric_locale_leave(before);
    if (data.damage.status)
        status = tell_damage(&data, status, error);
    study_data_close(&data);
    return status;
}
