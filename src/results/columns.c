#include "results/columns.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/child.h"
#include "results/folder.h"
#include "results/history.h"

static ld_status make_folder(const char *folder, ld_error *error)
{
    char *path = strdup(folder);
    size_t there = 0;
    if (!path)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the folder's name");
    ld_status status = folder_make(path, &there, error);
    free(path);
    return status;
}

static ld_status write_file(const char *path, const ld_column *columns, const double *const *values,
                            size_t width, size_t rows, ld_error *error)
{
    history_csv *csv = NULL;
    ld_status status = history_csv_create(path, &csv, error);
    if (status)
        return status;
    double *row = malloc(width * sizeof *row);
    status = row ? history_csv_begin(csv, columns, width, error)
                 : ld_fail(error, LD_ERR_MEMORY, "no memory for a row of %zu columns", width);
    for (size_t i = 0; i < rows && !status; i++) {
        for (size_t j = 0; j < width; j++)
            row[j] = values[j][i];
        status = history_csv_row(csv, row, width, error);
    }
    free(row);
    ld_status closed = history_csv_close(csv, status ? NULL : error);
    return status ? status : closed;
}

ld_status columns_write(const char *folder, const char *name, const ld_column *columns,
                        const double *const *values, size_t width, size_t rows, ld_error *error)
{
    char path[4096], part[4096];
    if (!*folder || snprintf(part, sizeof part, "%s/%s.part", folder, name) >= (int)sizeof part)
        return ld_fail(error, LD_ERR_INPUT, "the folder has no name, or one that is too long");
    snprintf(path, sizeof path, "%.*s", (int)(strlen(part) - strlen(".part")), part);
    ld_status status = make_folder(folder, error);
    if (status)
        return status;
    child_writes(part);
    status = write_file(part, columns, values, width, rows, error);
    if (!status && rename(part, path) != 0)
        status = ld_fail(error, LD_ERR_FILE, "cannot write %s: %s", path, strerror(errno));
    if (status)
        unlink(part);
    child_wrote(part);
    return status;
}
