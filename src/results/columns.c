#include "results/columns.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/part_file.h"
#include "results/folder.h"
#include "results/history.h"

static ld_status write_file(const char *path, const number_columns *columns, ld_error *error)
{
    const size_t width = columns->width;
    history_csv *csv = NULL;
    ld_status status = history_csv_create(path, &csv, error);
    if (status)
        return status;
    double *row = malloc(width * sizeof *row);
    status = row ? history_csv_begin(csv, columns->column, width, error)
                 : ld_fail(error, LD_ERR_MEMORY, "no memory for a row of %zu columns", width);
    for (size_t i = 0; i < columns->rows && !status; i++) {
        for (size_t j = 0; j < width; j++)
            row[j] = columns->value[j][i];
        status = history_csv_row(csv, row, width, error);
    }
    free(row);
    ld_status closed = history_csv_close(csv, status ? NULL : error);
    return status ? status : closed;
}

ld_status columns_write(const char *folder, const char *name, const number_columns *columns,
                        ld_error *error)
{
    char path[4096];
    part_file part;
    if (!*folder || snprintf(path, sizeof path, "%s/%s", folder, name) >= (int)sizeof path)
        return ld_fail(error, LD_ERR_INPUT, "the folder has no name, or one that is too long");
    ld_status status = folder_ensure(folder, error);
    if (!status)
        status = part_file_begin(&part, path, error);
    if (status)
        return status;
    status = write_file(part.path, columns, error);
    return part_file_end(&part, status, error);
}
