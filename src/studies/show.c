// What a study's folder holds: counts, statistics, tables.
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "io/numeric_locale.h"
#include "studies/statistics.h"
#include "studies/store.h"

// ---- columns out of the database

// Values of one or two results of all rockets of the samples that went well.
typedef struct values {
    size_t count, capacity;
    double *value[2];
    int64_t *group;
} values;

static void values_free(values *self)
{
    free(self->value[0]);
    free(self->value[1]);
    free(self->group);
    *self = (values){0};
}

static bool values_reserve(values *self)
{
    if (self->count < self->capacity)
        return true;
    size_t capacity = self->capacity ? 2 * self->capacity : 1024;
    double *first = realloc(self->value[0], capacity * sizeof *first);
    self->value[0] = first ? first : self->value[0];
    double *second = realloc(self->value[1], capacity * sizeof *second);
    self->value[1] = second ? second : self->value[1];
    int64_t *group = realloc(self->group, capacity * sizeof *group);
    self->group = group ? group : self->group;
    self->capacity = first && second && group ? capacity : self->capacity;
    return first && second && group;
}

// Samples of one hypercube are one group: it is the replicates that are independent.
static int64_t samples_per_group(study_store *self)
{
    char *text = store_text(self, "strata");
    int64_t strata = text ? atoll(text) : 1;
    free(text);
    return strata > 0 ? strata : 1;
}

// Reads the results of these names, rows in which both are there.
static ld_status read_values(study_store *self, const char *first, const char *second, values *all,
                             ld_error *error)
{
    char text[512];
    int64_t strata = samples_per_group(self);
    snprintf(text, sizeof text,
             "SELECT rocket.sample, rocket.\"%s\", rocket.\"%s\" FROM rocket JOIN sample USING "
             "(sample) WHERE sample.status = 'ok' ORDER BY rocket.sample, rocket.rocket",
             first, second);
    sqlite3_stmt *select = store_prepare(self, text, error);
    if (!select)
        return LD_ERR_FILE;
    int result;
    all->count = 0;
    while ((result = sqlite3_step(select)) == SQLITE_ROW) {
        if (sqlite3_column_type(select, 1) == SQLITE_NULL ||
            sqlite3_column_type(select, 2) == SQLITE_NULL)
            continue;
        if (!values_reserve(all)) {
            sqlite3_finalize(select);
            return ld_fail(error, LD_ERR_MEMORY, "no memory for the study's values");
        }
        all->group[all->count] = (sqlite3_column_int64(select, 0) - 1) / strata;
        all->value[0][all->count] = sqlite3_column_double(select, 1);
        all->value[1][all->count] = sqlite3_column_double(select, 2);
        all->count++;
    }
    sqlite3_finalize(select);
    return result == SQLITE_DONE ? LD_OK : store_fail(self, "read", error);
}

// ---- show

static ld_status print_counts(study_store *self, FILE *stream, ld_error *error)
{
    ld_study_counts counts;
    ld_status status = store_count(self, &counts, error);
    if (status)
        return status;
    fprintf(stream, "%" PRId64 " of %" PRId64 " samples, %" PRId64 " failed\n", counts.done,
            counts.samples, counts.failed);
    sqlite3_stmt *select = store_prepare(
        self,
        "SELECT count(*), min(sample), status, reason FROM sample WHERE status != 'ok' GROUP BY "
        "status, substr(reason, 1, 40) ORDER BY count(*) DESC, min(sample) LIMIT 20",
        error);
    if (!select)
        return LD_ERR_FILE;
    while (sqlite3_step(select) == SQLITE_ROW)
        fprintf(stream, "  %lld failed (%s), the first of them %lld: %s\n",
                (long long)sqlite3_column_int64(select, 0), sqlite3_column_text(select, 2),
                (long long)sqlite3_column_int64(select, 1), sqlite3_column_text(select, 3));
    sqlite3_finalize(select);
    return LD_OK;
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

static void print_statistics(FILE *stream, const study_result *r, const group_statistics *s)
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

static ld_status print_results(study_store *self, FILE *stream, values *all, ld_error *error)
{
    bool first = true;
    for (const study_result *r = study_results; r->name; r++) {
        group_statistics statistics;
        ld_status status = read_values(self, r->name, r->name, all, error);
        if (status)
            return status;
        if (all->count == 0)
            continue;
        statistics_of(all->value[0], all->group, all->count, &statistics);
        if (first)
            fprintf(
                stream,
                "%zu rockets, %zu independent groups; in brackets 95 %% intervals over groups\n\n"
                "%-27s  %-38s  %-38s  %8s  %11s  %11s  %11s\n",
                statistics.count, statistics.groups, "", "mean", "standard deviation", "skewness",
                "5 %", "median", "95 %");
        first = false;
        print_statistics(stream, r, &statistics);
    }
    return LD_OK;
}

static ld_status print_ellipses(study_store *self, FILE *stream, values *all, ld_error *error)
{
    static const char *const pairs[][3] = {
        {"downrange", "drift", "m"}, {"pitch", "yaw", "rad"}, {"pitch_rate", "yaw_rate", "rad/s"}};
    // a normal distribution has 95 % within so many deviations: sqrt(-2 ln 0.05)
    const double radius = 2.4477468306808161;
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        covariance_ellipse e;
        ld_status status = read_values(self, pairs[i][0], pairs[i][1], all, error);
        if (status)
            return status;
        if (all->count < 3)
            continue;
        covariance_ellipse_of(all->value[0], all->value[1], all->count, &e);
        fprintf(stream,
                "\n%s and %s: centre %.6g, %.6g %s; semi-axes of one deviation %.5g, %.5g %s, of "
                "95 %% %.5g, %.5g %s; the long one %.4g deg from %s towards %s",
                pairs[i][0], pairs[i][1], e.mean[0], e.mean[1], pairs[i][2], e.semi_axis[0],
                e.semi_axis[1], pairs[i][2], radius * e.semi_axis[0], radius * e.semi_axis[1],
                pairs[i][2], e.angle * 57.295779513082321, pairs[i][0], pairs[i][1]);
    }
    fputc('\n', stream);
    return LD_OK;
}

ld_status ld_study_show(const char *folder, FILE *stream, ld_error *error)
{
    study_store store;
    values all = {0};
    ld_status status = store_open_to_read(&store, folder, error);
    if (status)
        return status;
    locale_t before = numeric_locale_enter();
    status = print_counts(&store, stream, error);
    if (!status)
        status = print_results(&store, stream, &all, error);
    if (!status)
        status = print_ellipses(&store, stream, &all, error);
    numeric_locale_leave(before);
    values_free(&all);
    store_close(&store);
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
    list_columns(self, text, "sample", 3);
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
