// The table of a study's rockets as CSV, or as HDF5.
#include <inttypes.h>

#include "base/numeric_locale.h"
#include "launchdyn/study.h"
#include "studies/show/export_hdf5.h"
#include "studies/show/export_table.h"
#include "studies/store/table_file.h"

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the table");
}

// ---- CSV

static void print_cell(FILE *stream, sqlite3_stmt *row, int column)
{
    int type = sqlite3_column_type(row, column);
    if (type == SQLITE_FLOAT) {
        fprintf(stream, "%.17g", sqlite3_column_double(row, column));
    } else if (type != SQLITE_NULL) {
        const char *text = (const char *)sqlite3_column_text(row, column);
        csv_text(stream, text ? text : ""); // NULL: no memory, which the next step reports
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
    export_table table;
    ld_status status = export_open(&table, data, error);
    if (!status && csv)
        status = table_file_print(write_csv, &table, csv, error);
    if (!status && hdf5)
        status = table_file_write(export_hdf5, &table, hdf5, error);
    export_close(&table);
    return status;
}

// That not all samples are in what has been written, and what else has failed, if anything.
static ld_status report_damage(const study_data *data, ld_status failed, ld_error *error)
{
    const ld_error also = failed && error ? *error : (ld_error){.text = ""};
    return ld_fail(error, failed ? failed : LD_ERR_INPUT,
                   "%s; the table has what is intact, %" PRId64 " rockets%s%s", data->damage.text,
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
        status = report_damage(&data, status, error);
    study_data_close(&data);
    return status;
}
