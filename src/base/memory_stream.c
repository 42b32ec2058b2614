#define _GNU_SOURCE // fopencookie; NOLINT(bugprone-reserved-identifier)
#include "base/memory_stream.h"

#include <errno.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

typedef struct memory_writer {
    char **text;
    size_t *length, capacity;
    bool full; // something was left out
} memory_writer;

// Room for `size` more characters and a zero.
static bool reserve(memory_writer *self, size_t size)
{
    size_t wanted = *self->length + size + 1;
    if (wanted <= self->capacity)
        return true;
    size_t capacity = wanted > 2 * self->capacity ? wanted : 2 * self->capacity;
    char *larger = realloc(*self->text, capacity);
    if (!larger)
        return false;
    *self->text = larger;
    self->capacity = capacity;
    return true;
}

static ssize_t write_bytes(void *writer, const char *bytes, size_t size)
{
    memory_writer *self = writer;
    self->full = self->full || !reserve(self, size);
    if (self->full)
        return 0;
    memcpy(*self->text + *self->length, bytes, size);
    *self->length += size;
    (*self->text)[*self->length] = '\0';
    return (ssize_t)size;
}

static int close_text(void *writer)
{
    memory_writer *self = writer;
    bool full = self->full;
    if (full) {
        free(*self->text);
        *self->text = NULL;
        *self->length = 0;
        errno = ENOMEM;
    }
    free(self);
    return full ? -1 : 0;
}

FILE *memory_stream(char **text, size_t *length)
{
    static const cookie_io_functions_t calls = {.write = write_bytes, .close = close_text};
    memory_writer *self = malloc(sizeof *self);
    FILE *stream = NULL;
    *text = calloc(1, 1);
    *length = 0;
    if (self && *text) {
        *self = (memory_writer){.text = text, .length = length, .capacity = 1};
        stream = fopencookie(self, "w", calls);
    }
    if (!stream) {
        free(self);
        free(*text);
        *text = NULL;
    }
    return stream;
}
