#include "studies/store/table_file.h"

#include <errno.h>
#include <stdbool.h>
#include <string.h>

#include "base/part_file.h"

static ld_status cannot_write(const char *file, int number, ld_error *error)
{
    return ld_fail(error, LD_ERR_FILE, "cannot write %.400s: %s", file, strerror(number));
}

ld_status table_file_write(table_writer *write, void *self, const char *name, ld_error *error)
{
    part_file part;
    ld_status status = part_file_begin(&part, name, error);
    if (status)
        return status;
    status = write(self, part.path, name, error);
    return part_file_end(&part, status, error);
}

typedef struct printed_table {
    csv_writer *write;
    void *self;
} printed_table;

static ld_status print_table(void *table, const char *file, const char *name, ld_error *error)
{
    const printed_table *self = table;
    errno = 0;
    FILE *stream = fopen(file, "w");
    if (!stream)
        return cannot_write(name, errno, error);
    ld_status status = self->write(self->self, stream, error);
    bool written = !ferror(stream);
    int number = errno;
    if (fclose(stream) != 0 && written) {
        written = false;
        number = errno;
    }
    return status || written ? status : cannot_write(name, number, error);
}

ld_status table_file_print(csv_writer *write, void *self, const char *name, ld_error *error)
{
    printed_table table = {write, self};
    return table_file_write(print_table, &table, name, error);
}

void csv_text(FILE *stream, const char *text)
{
    if (!text[strcspn(text, ",\"\r\n")]) {
        fputs(text, stream);
        return;
    }
    fputc('"', stream);
    for (; *text; text++) {
        fputs(*text == '"' ? "\"" : "", stream);
        fputc(*text, stream);
    }
    fputc('"', stream);
}
