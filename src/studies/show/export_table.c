#include "studies/show/export_table.h"

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

ld_status export_open(export_table *self, const study_data *data, ld_error *error)
{
    study_store *store = study_data_store(data);
    const store_view view = store_main(store);
    *self = (export_table){.data = data, .keys = EXPORT_KEYS};
    self->row = select_rows(data, error);
    if (!self->row)
        return error->status;
    self->keys += data->swept_count > 0 ? 1 + data->swept_count : 0;
    self->columns = sqlite3_column_count(self->row);
    return store_walk_begin(&self->walk, &view, &store->kept, error);
}

void export_close(export_table *self)
{
    store_walk_end(&self->walk);
    sqlite3_finalize(self->row);
}

// That the samples are those which were found intact when the study was opened.
static ld_status expect_as_before(const export_table *self, bool there, ld_error *error)
{
    const int64_t before = self->data->rockets;
    if (there ? self->rockets <= before : self->rockets == before)
        return LD_OK;
    return ld_fail(
        error, LD_ERR_FILE,
        "cannot read %s: a second reading gives other samples: it is damaged, or its disk fails",
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
