#include "fmu/fmu_source.h"

#include <stdlib.h>
#include <string.h>

#include "base/text_file.h"
#include "model/fields/source.h"

enum { PATH_SIZE = 4096, TEXT_BYTES = 64 << 20 };

void fmu_source_name(const ld_source *source, size_t index, char name[FMU_SOURCE_NAME])
{
    const char *whole = source->file[index]->name, *last = strrchr(whole, '/');
    snprintf(name, FMU_SOURCE_NAME, "source/%zu-%.400s", index + 1, last ? last + 1 : whole);
}

// A line says how many bytes follow it on the next ones.
static void write_item(FILE *stream, const char *what, const char *text)
{
    fprintf(stream, "%s %zu\n%s\n", what, strlen(text), text);
}

void fmu_source_write_list(const ld_source *source, FILE *stream)
{
    char name[FMU_SOURCE_NAME];
    write_item(stream, "scenario", source->name);
    for (size_t i = 0; i < source->file_count; i++) {
        fmu_source_name(source, i, name);
        write_item(stream, "text", name);
        write_item(stream, "named", source->file[i]->name);
    }
    for (size_t i = 0; i < source->set_count; i++)
        write_item(stream, "set", source->set[i]);
}

// ---- reading ----

typedef struct reader {
    const char *resources;
    char *next, *end;
    ld_source *source;
    char text_name[FMU_SOURCE_NAME]; // of the text whose own name comes next
} reader;

// The next item; its text is ended in place. False: there is none.
static bool next_item(reader *self, const char **what, char **text)
{
    char *end, *line = self->next, *line_end;
    if (self->next >= self->end || !(line_end = strchr(line, '\n')))
        return false;
    char *blank = strchr(line, ' ');
    unsigned long length = blank && blank < line_end ? strtoul(blank, &end, 10) : 0;
    if (!blank || blank > line_end || end != line_end ||
        length >= (size_t)(self->end - line_end - 1))
        return false;
    *blank = '\0';
    *what = line;
    *text = line_end + 1;
    (*text)[length] = '\0';
    self->next = *text + length + 1;
    return true;
}

static ld_status add_text(reader *self, const char *name, ld_error *error)
{
    char path[PATH_SIZE], *text;
    size_t length;
    ld_error why;
    snprintf(path, sizeof path, "%.3000s/%s", self->resources, self->text_name);
    ld_status status = text_file_read(path, TEXT_BYTES, &text, &length, &why);
    if (status)
        return ld_fail(error, status, "%.300s %s", path, why.text);
    return source_add(self->source, name, text, length)
               ? LD_OK
               : ld_fail(error, LD_ERR_MEMORY, "no memory");
}

static ld_status take_item(reader *self, const char *what, const char *text, ld_error *error)
{
    if (strcmp(what, "scenario") == 0 && !self->source) {
        self->source = source_new(text, NULL);
        return self->source ? LD_OK : ld_fail(error, LD_ERR_MEMORY, "no memory");
    }
    if (!self->source)
        return ld_fail(error, LD_ERR_INPUT, "the list of texts does not begin with the scenario");
    if (strcmp(what, "text") == 0)
        snprintf(self->text_name, sizeof self->text_name, "%s", text);
    else if (strcmp(what, "named") == 0)
        return add_text(self, text, error);
    else if (strcmp(what, "set") == 0 && !source_add_set(self->source, text))
        return ld_fail(error, LD_ERR_MEMORY, "no memory");
    return LD_OK;
}

ld_source *fmu_source_read(const char *resources, ld_error *error)
{
    char path[PATH_SIZE], *list, *text;
    const char *what;
    size_t length;
    ld_error why;
    snprintf(path, sizeof path, "%.3000s/" FMU_SOURCE_LIST, resources);
    ld_status status = text_file_read(path, TEXT_BYTES, &list, &length, &why);
    if (status) {
        ld_fail(error, status, "%.300s %s", path, why.text);
        return NULL;
    }
    reader self = {.resources = resources, .next = list, .end = list + length};
    while (!status && next_item(&self, &what, &text))
        status = take_item(&self, what, text, error);
    if (!status && (self.next != self.end || !self.source || self.source->file_count == 0))
        status = ld_fail(error, LD_ERR_INPUT, "%.300s is damaged", path);
    free(list);
    if (!status)
        return self.source;
    source_free(self.source);
    return NULL;
}
