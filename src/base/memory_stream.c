#define _GNU_SOURCE // fopencookie; NOLINT(bugprone-reserved-identifier)
#include "base/memory_stream.h"

#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

// Room for `size` more characters and a zero; how many of them there is room for.
static size_t reserve(text_writer *self, size_t size)
{
    size_t wanted = self->length + size + 1;
    if (wanted <= self->capacity)
        return size;
    if (self->fixed)
        return self->capacity - self->length - 1;
    size_t capacity = wanted > 2 * self->capacity ? wanted : 2 * self->capacity;
    char *larger = realloc(self->text, capacity);
    if (!larger)
        return 0;
    self->text = larger;
    self->capacity = capacity;
    return size;
}

void text_add(text_writer *self, const char *bytes, size_t size)
{
    if (self->stream) {
        fwrite(bytes, 1, size, self->stream);
        return;
    }
    size_t room = self->full ? 0 : reserve(self, size);
    self->full = self->full || room < size;
    if (!self->text)
        return;
    memcpy(self->text + self->length, bytes, room);
    self->length += room;
    self->text[self->length] = '\0';
}

void text_put(text_writer *self, const char *text)
{
    text_add(self, text, strlen(text));
}

void text_print(text_writer *self, const char *format, ...)
{
    char some[256], *whole = some;
    va_list first, again;
    va_start(first, format);
    va_copy(again, first);
    int length = self->stream ? vfprintf(self->stream, format, first)
                              : vsnprintf(some, sizeof some, format, first);
    if (!self->stream && length >= (int)sizeof some) {
        whole = malloc((size_t)length + 1);
        if (whole)
            vsnprintf(whole, (size_t)length + 1, format, again);
    }
    va_end(again);
    va_end(first);
    if (!self->stream && whole && length >= 0)
        text_add(self, whole, (size_t)length);
    self->full = self->full || !whole;
    if (whole != some)
        free(whole);
}

char *text_take(text_writer *self, size_t *length)
{
    if (!self->full) // also of nothing
        text_add(self, "", 0);
    char *text = self->full ? NULL : self->text;
    if (!text)
        free(self->text);
    *length = text ? self->length : 0;
    *self = (text_writer){0};
    return text;
}

#ifndef _WIN32 // where streams are the C library's alone

typedef struct memory_writer {
    text_writer to;
    char **text;
    size_t *length;
} memory_writer;

static ssize_t write_bytes(void *writer, const char *bytes, size_t size)
{
    memory_writer *self = writer;
    text_add(&self->to, bytes, size);
    return self->to.full ? 0 : (ssize_t)size;
}

static int close_text(void *writer)
{
    memory_writer *self = writer;
    *self->text = text_take(&self->to, self->length);
    bool full = !*self->text;
    free(self);
    errno = full ? ENOMEM : errno;
    return full ? -1 : 0;
}

FILE *memory_stream(char **text, size_t *length)
{
    static const cookie_io_functions_t calls = {.write = write_bytes, .close = close_text};
    memory_writer *self = malloc(sizeof *self);
    FILE *stream = NULL;
    *text = NULL;
    *length = 0;
    if (self) {
        *self = (memory_writer){.text = text, .length = length};
        stream = fopencookie(self, "w", calls);
    }
    if (!stream)
        free(self);
    return stream;
}

FILE *ld_text_open(char **text, size_t *length)
{
    return memory_stream(text, length);
}

ld_status ld_text_close(FILE *stream)
{
    return fclose(stream) == 0 ? LD_OK : LD_ERR_MEMORY;
}

void ld_free(void *memory)
{
    free(memory);
}

#endif
