#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/numeric_locale.h"
#include "results/history.h"

enum { BUFFER = 1 << 17, NUMBER = 32 };

struct history_csv {
    FILE *file;
    char *path;
    char buffer[BUFFER];
};

static ld_status failed(const history_csv *history, ld_error *error)
{
    return ld_fail(error, LD_ERR_FILE, "cannot write %s: %s", history->path, strerror(errno));
}

ld_status history_csv_create(const char *path, history_csv **history, ld_error *error)
{
    history_csv *created = calloc(1, sizeof *created);
    char *copy = strdup(path);
    if (!created || !copy) {
        free(created);
        free(copy);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the history");
    }
    created->path = copy;
    created->file = fopen(path, "w");
    if (!created->file) {
        ld_status status = failed(created, error);
        free(created->path);
        free(created);
        return status;
    }
    setvbuf(created->file, created->buffer, _IOFBF, sizeof created->buffer);
    *history = created;
    return LD_OK;
}

// A field in quotes where it holds a comma, a quote or a line break (RFC 4180).
static void write_heading(FILE *file, const ld_column *column)
{
    const char *quote = strpbrk(column->name, ",\"\r\n") ? "\"" : "";
    fputs(quote, file);
    for (const char *letter = column->name; *letter; letter++) {
        if (*letter == '"')
            fputc('"', file);
        fputc(*letter, file);
    }
    fprintf(file, " [%s]%s", column->unit, quote);
}

ld_status history_csv_begin(history_csv *history, const ld_column *columns, size_t count,
                            ld_error *error)
{
    for (size_t i = 0; i < count; i++) {
        if (i)
            fputc(',', history->file);
        write_heading(history->file, &columns[i]);
    }
    fputc('\n', history->file);
    return ferror(history->file) ? failed(history, error) : LD_OK;
}

ld_status history_csv_row(history_csv *history, const double *values, size_t count, ld_error *error)
{
    locale_t before = numeric_locale_enter();
    for (size_t i = 0; i < count; i++) {
        char text[NUMBER];
        double value = isnan(values[i]) ? NAN : values[i]; // which has no sign
        int length = snprintf(text, sizeof text, "%.17g%c", value, i + 1 < count ? ',' : '\n');
        fwrite(text, 1, (size_t)length, history->file);
    }
    numeric_locale_leave(before);
    return ferror(history->file) ? failed(history, error) : LD_OK;
}

ld_status history_csv_close(history_csv *history, ld_error *error)
{
    bool wrong = ferror(history->file) != 0;
    wrong |= fclose(history->file) != 0;
    ld_status status = wrong ? failed(history, error) : LD_OK;
    free(history->path);
    free(history);
    return status;
}
