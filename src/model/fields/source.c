#include "model/fields/source.h"

#include <stdlib.h>
#include <string.h>

ld_source *source_new(const char *name, const char *folder)
{
    ld_source *self = calloc(1, sizeof *self);
    if (!self)
        return NULL;
    self->users = 1;
    self->name = strdup(name);
    self->folder = folder ? strdup(folder) : NULL;
    if (self->name && (self->folder || !folder))
        return self;
    source_free(self);
    return NULL;
}

const ld_source_file *source_add(ld_source *self, const char *name, char *text, size_t length)
{
    ld_source_file **list = realloc(self->file, (self->file_count + 1) * sizeof(ld_source_file *));
    ld_source_file *file = malloc(sizeof *file);
    char *own_name = strdup(name);
    self->file = list ? list : self->file;
    if (!list || !file || !own_name) {
        free(file);
        free(own_name);
        free(text);
        return NULL;
    }
    *file = (ld_source_file){own_name, text, length};
    return list[self->file_count++] = file;
}

bool source_add_set(ld_source *self, const char *text)
{
    char **list = realloc(self->set, (self->set_count + 1) * sizeof *list);
    char *own = strdup(text);
    self->set = list ? list : self->set;
    if (!list || !own) {
        free(own);
        return false;
    }
    list[self->set_count++] = own;
    return true;
}

const ld_source_file *source_find(const ld_source *self, const char *name)
{
    for (size_t i = 1; i < self->file_count; i++)
        if (strcmp(self->file[i]->name, name) == 0)
            return self->file[i];
    return NULL;
}

ld_source *source_hold(ld_source *self)
{
    if (self)
        atomic_fetch_add(&self->users, 1);
    return self;
}

ld_source *source_copy(const ld_source *self)
{
    ld_source *copy = source_new(self->name, self->folder);
    bool fine = copy != NULL;
    if (fine)
        copy->confined = self->confined;
    for (size_t i = 0; i < self->file_count && fine; i++) {
        const ld_source_file *file = self->file[i];
        char *text = malloc(file->length + 1);
        fine = text && source_add(copy, file->name, memcpy(text, file->text, file->length + 1),
                                  file->length);
    }
    for (size_t i = 0; i < self->set_count && fine; i++)
        fine = source_add_set(copy, self->set[i]);
    if (fine) {
        copy->set_before = self->set_before;
        return copy;
    }
    source_free(copy);
    return NULL;
}

void source_free(ld_source *self)
{
    if (!self || atomic_fetch_sub(&self->users, 1) > 1)
        return;
    for (size_t i = 0; i < self->file_count; i++) {
        free(self->file[i]->name);
        free(self->file[i]->text);
        free(self->file[i]);
    }
    for (size_t i = 0; i < self->set_count; i++)
        free(self->set[i]);
    free(self->name);
    free(self->folder);
    free(self->file);
    free(self->set);
    free(self);
}
