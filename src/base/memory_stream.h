// Text written piece by piece: into a stream of the C library, or into memory.
#ifndef LD_BASE_MEMORY_STREAM_H
#define LD_BASE_MEMORY_STREAM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "launchdyn/status.h"

// ---- a writer, which a launch makes do with: it needs nothing that is not in every C library

// {.stream = s}: into a stream. {0}: into memory that grows. {.text = t, .capacity = size, .fixed =
// true}: into `size` bytes; what has no room is cut.
typedef struct text_writer {
    FILE *stream;
    char *text; // ended by a zero once something was written
    size_t length, capacity;
    bool fixed, full; // full: something was left out
} text_writer;

void text_add(text_writer *self, const char *bytes, size_t size);
void text_put(text_writer *self, const char *text);
void text_print(text_writer *self, const char *format, ...) LD_PRINTF(2, 3);

// The text in memory that grows, to be freed, and its length; NULL: there was no memory.
char *text_take(text_writer *self, size_t *length);

// ---- a stream of the C library, for what prints to one

// What is written stands in *text, with a zero after its *length characters, once the stream was
// closed; to be freed. The C library's open_memstream() leaves out without a word what it has no
// room for: where this one has lacked memory, fclose() fails, and *text is NULL.
// Returns NULL, and *text NULL: no memory.
FILE *memory_stream(char **text, size_t *length);

#endif
