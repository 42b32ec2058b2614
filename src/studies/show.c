// What a study's folder holds: counts, statistics, tables.
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "io/numeric_locale.h"
#include "studies/statistics.h"
#include "studies/store.h"
#include "studies/study_data.h"

// ---- show

static ld_status print_counts(const study_data *data, const study_point *point, FILE *stream,
                              ld_error *error)
{
    enum { MOST = 20 };
    study_failure failure[MOST];
    int count;
    ld_status status = study_data_failures(data, point, failure, MOST, &count, error);
    fprintf(stream, "%" PRId64 " of %" PRId64 " samples, %" PRId64 " failed\n", point->done,
            point->asked, point->failed);
    for (int i = 0; i < count && !status; i++)
        fprintf(stream, "  %" PRId64 " failed (%s), the first of them %" PRId64 ": %s\n",
                failure[i].count, failure[i].status, failure[i].first, failure[i].reason);
    return status;
}

static void print_estimate(FILE *stream, estimate e)
{
    char text[64];
    if (isnan(e.low))
        snprintf(text, sizeof text, "%.6g", e.value);
    else
        snprintf(text, sizeof text, "%.6g [%.6g, %.6g]", e.value, e.low, e.high);
    fprintf(stream, "  %-38s", text);
}

static void print_statistics(FILE *stream, const study_column *r, const group_statistics *s)
{
    char name[64];
    snprintf(name, sizeof name, "%s%s%s%s", r->name, r->unit[0] ? " [" : "", r->unit,
             r->unit[0] ? "]" : "");
    fprintf(stream, "%-27s", name);
    print_estimate(stream, s->mean);
    print_estimate(stream, s->deviation);
    fprintf(stream, "  %8.3g", s->skewness);
    for (int k = 0; k < STATISTICS_QUANTILES; k++)
        fprintf(stream, "  %11.6g", s->quantile[k].value);
    fputc('\n', stream);
}

static ld_status print_results(const study_data *data, const study_point *point, FILE *stream,
                               study_values *values, ld_error *error)
{
    bool first = true;
    for (int i = 0; i < data->result_count; i++) {
        group_statistics statistics;
        const study_column *column = &data->column[i];
        ld_status status = study_data_read(data, point, &column, 1, values, error);
        if (status)
            return status;
        if (values->count == 0)
            continue;
        if (statistics_of(values->value[0], values->group, values->count, &statistics))
            return ld_fail(error, LD_ERR_MEMORY, "no memory for the study's statistics");
        if (first)
            fprintf(
                stream,
                "%zu rockets, %zu independent groups; in brackets 95 %% intervals over groups\n\n"
                "%-27s  %-38s  %-38s  %8s  %11s  %11s  %11s\n",
                statistics.count, statistics.groups, "", "mean", "standard deviation", "skewness",
                "5 %", "median", "95 %");
        first = false;
        print_statistics(stream, column, &statistics);
    }
    return LD_OK;
}

static ld_status print_ellipses(const study_data *data, const study_point *point, FILE *stream,
                                study_values *values, ld_error *error)
{
    for (size_t i = 0; i < STUDY_PAIRS; i++) {
        const char *const *name = study_pairs[i].name, *unit = study_pairs[i].unit;
        covariance_ellipse e;
        const char *nearest;
        const study_column *pair[] = {study_data_find(data, name[0], &nearest),
                                      study_data_find(data, name[1], &nearest)};
        if (!pair[0] || !pair[1])
            continue;
        ld_status status = study_data_read(data, point, pair, 2, values, error);
        if (status)
            return status;
        if (values->count < 3)
            continue;
        covariance_ellipse_of(values->value[0], values->value[1], values->count, &e);
        fprintf(stream,
                "\n%s and %s: centre %.6g, %.6g %s; semi-axes of one deviation %.5g, %.5g %s, of "
                "95 %% %.5g, %.5g %s; the long one %.4g deg from %s towards %s",
                name[0], name[1], e.mean[0], e.mean[1], unit, e.semi_axis[0], e.semi_axis[1], unit,
                ellipse_radius * e.semi_axis[0], ellipse_radius * e.semi_axis[1], unit,
                e.angle * 57.295779513082321, name[0], name[1]);
    }
    fputc('\n', stream);
    return LD_OK;
}

// "speed: 15 km/h, interval: 0.5 s"
static void print_heading(const study_data *data, const study_point *point, FILE *stream)
{
    if (data->swept_count == 0)
        return;
    fprintf(stream, "\n%" PRId64 ".", point->number);
    for (int k = 0; k < data->swept_count; k++)
        fprintf(stream, "%s %s: %s", k ? "," : "", data->swept[k], point->text[k]);
    fputs("\n", stream);
}

static ld_status print_point(const study_data *data, const study_point *point, FILE *stream,
                             study_values *values, ld_error *error)
{
    print_heading(data, point, stream);
    ld_status status = print_counts(data, point, stream, error);
    if (!status)
        status = print_results(data, point, stream, values, error);
    return status ? status : print_ellipses(data, point, stream, values, error);
}

ld_status ld_study_show(const char *folder, FILE *stream, ld_error *error)
{
    study_data data;
    study_values values = {0};
    ld_status status = study_data_open(folder, &data, error);
    if (status)
        return status;
    locale_t before = numeric_locale_enter();
    for (int i = 0; i < data.point_count && !status; i++)
        status = print_point(&data, &data.point[i], stream, &values, error);
    numeric_locale_leave(before);
    study_values_free(&values);
    study_data_close(&data);
    return status;
}

// ---- export

static void print_cell(FILE *stream, sqlite3_stmt *row, int column)
{
    int type = sqlite3_column_type(row, column);
    if (type == SQLITE_FLOAT)
        fprintf(stream, "%.17g", sqlite3_column_double(row, column));
    else if (type != SQLITE_NULL)
        fprintf(stream, "%s", (const char *)sqlite3_column_text(row, column));
}

static bool write_rows(FILE *stream, sqlite3_stmt *rows)
{
    int result, columns = sqlite3_column_count(rows);
    for (int i = 0; i < columns; i++)
        fprintf(stream, "%s%s", i ? "," : "", sqlite3_column_name(rows, i));
    fputc('\n', stream);
    while ((result = sqlite3_step(rows)) == SQLITE_ROW) {
        for (int i = 0; i < columns; i++) {
            fputs(i ? "," : "", stream);
            print_cell(stream, rows, i);
        }
        fputc('\n', stream);
    }
    return result == SQLITE_DONE;
}

// The columns of a table after the first few, each with its table and a comma before it.
static void list_columns(study_store *self, FILE *text, const char *table, int from)
{
    char query[64];
    snprintf(query, sizeof query, "PRAGMA table_info(%s)", table);
    sqlite3_stmt *columns = store_prepare(self, query, NULL);
    while (columns && sqlite3_step(columns) == SQLITE_ROW)
        if (sqlite3_column_int(columns, 0) >= from)
            fprintf(text, ", %s.\"%s\"", table, sqlite3_column_text(columns, 1));
    sqlite3_finalize(columns);
}

static ld_status export(study_store *self, const char *file, ld_error *error)
{
    char *query = NULL;
    size_t length;
    FILE *text = open_memstream(&query, &length);
    if (!text)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the table");
    fputs("SELECT sample.sample, rocket.rocket, rocket.tube, sample.status", text);
    list_columns(self, text, "sample", 4);
    list_columns(self, text, "rocket", 3);
    fputs(" FROM sample JOIN rocket USING (sample) ORDER BY sample.sample, rocket.rocket", text);
    fclose(text);
    sqlite3_stmt *rows = store_prepare(self, query, error);
    free(query);
    if (!rows)
        return LD_ERR_FILE;
    FILE *stream = fopen(file, "w");
    bool read = stream && write_rows(stream, rows);
    bool written = stream && !ferror(stream);
    written = stream && fclose(stream) == 0 && written;
    sqlite3_finalize(rows);
    if (!written)
        return ld_fail(error, LD_ERR_FILE, "cannot write %s", file);
    return read ? LD_OK : store_fail(self, "read", error);
}

ld_status ld_study_export(const char *folder, const char *file, ld_error *error)
{
    study_store store;
    ld_status status = store_open_to_read(&store, folder, error);
    if (status)
        return status;
    locale_t before = numeric_locale_enter();
    status = export(&store, file, error);
    numeric_locale_leave(before);
    store_close(&store);
    return status;
}
