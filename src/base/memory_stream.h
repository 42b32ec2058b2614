// A stream into memory.
#ifndef LD_BASE_MEMORY_STREAM_H
#define LD_BASE_MEMORY_STREAM_H

#include <stdio.h>

// What is written stands in *text, with a zero after its *length characters, once the stream was
// closed; to be freed. The C library's open_memstream() leaves out without a word what it has no
// room for: where this one has lacked memory, fclose() fails, and *text is NULL.
// Returns NULL, and *text NULL: no memory.
FILE *memory_stream(char **text, size_t *length);

#endif
