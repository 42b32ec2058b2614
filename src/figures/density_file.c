#include "figures/density_file.h"

#include <stdlib.h>

#include "base/text_file.h"
#include "base/text_lines.h"
#include "scenario/scenario_reader.h"

enum { MOST_BYTES = 16 << 20 };

static ld_status refuse(const char *path, const text_lines *at, int field, const char *text,
                        ld_error *error)
{
    return ld_fail(error, LD_ERR_INPUT, "%.300s:%d:%d: %s", path, at->number,
                   text_lines_column(at, field), text);
}

static bool is_number(const char *text, double *value)
{
    const char *reason, *end = number_parse(text, value, &reason);
    return end && *end == '\0';
}

static ld_status read_row(const char *path, const text_lines *at, double *row, ld_error *error)
{
    if (at->count != 2)
        return refuse(path, at, 0, "expected two numbers, a frequency in Hz and a density", error);
    for (int i = 0; i < 2; i++)
        if (!is_number(at->field[i], &row[i]) || row[i] < 0)
            return refuse(path, at, i, "expected a number >= 0", error);
    return LD_OK;
}

static ld_status read_rows(const char *path, text_lines *at, ld_table *density, ld_error *error)
{
    ld_status status = LD_OK;
    for (bool first = true; !status && text_lines_next(at, '#', true); first = false) {
        double *row = density->data + 2 * density->rows;
        double unused;
        if (first && !is_number(at->field[0], &unused))
            continue;
        status = read_row(path, at, row, error);
        if (!status && density->rows > 0 && row[0] <= row[-2])
            status = refuse(path, at, 0, "the frequencies must rise", error);
        density->rows++;
    }
    if (!status && at->wrong)
        status = refuse(path, at, 0, at->wrong, error);
    if (!status && density->rows < 2)
        status =
            ld_fail(error, LD_ERR_INPUT, "%.300s: expected two lines of numbers or more", path);
    return status;
}

ld_status density_file_read(const char *path, ld_table *density, ld_error *error)
{
    char *text;
    size_t length, lines = 1;
    ld_error why;
    *density = (ld_table){.columns = 2};
    ld_status status = text_file_read(path, MOST_BYTES, &text, &length, &why);
    if (status)
        return ld_fail(error, status, "%.300s: %.600s", path, why.text);
    for (size_t i = 0; i < length; i++)
        lines += text[i] == '\n';
    text_lines at = text_lines_begin(text, length);
    density->data = malloc(2 * lines * sizeof *density->data);
    status = density->data ? read_rows(path, &at, density, error)
                           : ld_fail(error, LD_ERR_MEMORY, "no memory for a spectral density");
    free(text);
    return status;
}
