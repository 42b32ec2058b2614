#include "search/found_scenario.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "launchdyn/scenario.h"
#include "model/fields/source.h"
#include "model/model.h"

// Where the parts of two paths differ first: the number of characters before that part.
static size_t shared_parts(const char *a, const char *b)
{
    size_t shared = 0;
    for (size_t i = 0; a[i] && a[i] == b[i]; i++)
        if (a[i] == '.')
            shared = i + 1;
    return shared;
}

static int by_path(const void *left, const void *right)
{
    const found_key *a = *(const found_key *const *)left, *b = *(const found_key *const *)right;
    return strcmp(a->place->path, b->place->path);
}

// The keys as nested blocks, in the order of their paths; false: no memory.
static bool write_blocks(const found_scenario *self, FILE *stream)
{
    const found_key **sorted = calloc((size_t)self->keys + 1, sizeof(const found_key *));
    const char *before = "";
    if (!sorted)
        return false;
    for (int i = 0; i < self->keys; i++)
        sorted[i] = &self->key[i];
    qsort(sorted, (size_t)self->keys, sizeof(const found_key *), by_path);
    for (int i = 0; i < self->keys; i++) {
        const char *path = sorted[i]->place->path;
        size_t at = shared_parts(before, path);
        int depth = 0;
        for (size_t k = 0; k < at; k++)
            depth += path[k] == '.';
        for (const char *part = path + at; part; depth++) {
            int length = (int)strcspn(part, ".");
            fprintf(stream, "%*s%.*s:", 2 * depth, "", length, part);
            part = part[length] ? part + length + 1 : NULL;
            if (part)
                fputs("\n", stream);
        }
        char number[32];
        field_number_text(sorted[i]->value, number);
        fprintf(stream, " %s%s%s\n", number, sorted[i]->unit[0] ? " " : "", sorted[i]->unit);
        before = path;
    }
    free(sorted);
    return true;
}

// The way from a folder to the scenario's file, both absolute.
static void write_way(const char *folder, const char *file, FILE *stream)
{
    size_t shared = 0;
    for (size_t i = 0; folder[i] == file[i] && file[i]; i++)
        if (file[i] == '/')
            shared = i + 1;
    size_t length = strlen(folder);
    if (strncmp(folder, file, length) == 0 && file[length] == '/')
        shared = length + 1;
    for (size_t i = shared; i < length; i++)
        if (i == shared || folder[i] == '/')
            fputs("../", stream);
    fputs(file + shared, stream);
}

// Whether the scenario can be included: it is a file, as it stands.
static bool can_include(const ld_model *model, char file[PATH_MAX])
{
    const ld_source *source = ld_model_source(model);
    char path[PATH_MAX];
    if (!source || !source->folder || source->set_count > 0 || source->file_count == 0)
        return false;
    int length = snprintf(path, sizeof path, "%s%s%s", source->folder, source->folder[0] ? "/" : "",
                          source->file[0]->name);
    return length > 0 && length < PATH_MAX && realpath(path, file);
}

// With overrides or without a file: all of it; false: no memory.
static bool write_whole(const found_scenario *self, FILE *stream)
{
    ld_model *found = malloc(sizeof *found);
    if (!found)
        return false;
    *found = *self->model;
    model_forget(found);
    for (int i = 0; i < self->keys; i++)
        field_set(found, self->key[i].place, self->key[i].value);
    model_complete(found);
    ld_model_print(found, stream);
    free(found);
    return true;
}

typedef struct found_file {
    const found_scenario *found;
    const char *folder;
} found_file;

static ld_status write_scenario(void *user, FILE *stream, ld_error *error)
{
    const found_file *self = user;
    const found_scenario *found = self->found;
    char file[PATH_MAX], there[PATH_MAX];
    bool good;
    if (can_include(found->model, file) && realpath(self->folder, there)) {
        fprintf(stream, "# The scenario with the %s.\ninclude: \"", found->how);
        write_way(there, file, stream);
        fputs("\"\n", stream);
        good = write_blocks(found, stream);
    } else {
        good = write_whole(found, stream);
    }
    return good ? LD_OK : ld_fail(error, LD_ERR_MEMORY, "no memory for the scenario found");
}

ld_status found_file_write(csv_writer *write, void *self, const char *folder, const char *name,
                           ld_error *error)
{
    char path[PATH_MAX];
    if (snprintf(path, sizeof path, "%s/%s", folder, name) >= (int)sizeof path)
        return ld_fail(error, LD_ERR_INPUT, "the folder's name is too long");
    return table_file_print(write, self, path, error);
}

ld_status found_scenario_write(const found_scenario *self, const char *folder, const char *name,
                               ld_error *error)
{
    found_file file = {self, folder};
    return found_file_write(write_scenario, &file, folder, name, error);
}
