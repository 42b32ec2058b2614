// Bytes as text (base64, RFC 4648).
#ifndef LD_BASE_BASE64_H
#define LD_BASE_BASE64_H

#include <stddef.h>

#include "base/memory_stream.h"

void base64_write(text_writer *to, const void *bytes, size_t count);

// Room for the bytes of a text of `length` letters.
size_t base64_room(size_t length);
// Reads a text into `bytes`, until its first other letter; how many they are.
size_t base64_read(const char *text, size_t length, unsigned char *bytes);

#endif
