// Binary glTF 2 files from their JSON and numbers.
#ifndef LD_TESTS_SUPPORT_GLB_FILE_H
#define LD_TESTS_SUPPORT_GLB_FILE_H

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static inline size_t glb_chunk(uint8_t *to, const char *kind, const void *data, size_t size)
{
    uint32_t whole = (uint32_t)size;
    memcpy(to, &whole, 4);
    memcpy(to + 4, kind, 4);
    if (size > 0)
        memcpy(to + 8, data, size);
    return 8 + size;
}

// The bytes, to be freed; a file without numbers has no second chunk.
static inline uint8_t *glb_file(const void *json, size_t text, const void *numbers, size_t bytes,
                                size_t *length)
{
    uint8_t *file = malloc(28 + text + bytes);
    const uint32_t version = 2;
    if (!file)
        abort();
    *length = 12 + glb_chunk(file + 12, "JSON", json, text);
    if (bytes > 0)
        *length += glb_chunk(file + *length, "BIN\0", numbers, bytes);
    uint32_t whole = (uint32_t)*length;
    memcpy(file, "glTF", 4);
    memcpy(file + 4, &version, 4);
    memcpy(file + 8, &whole, 4);
    return file;
}

#endif
