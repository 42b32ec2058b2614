// What a state holds, as bytes and back: one walk over its members, in one order, saves it or loads
// it, so that the two cannot differ. Numbers of 8 bytes, the lowest first, whatever the machine.
#ifndef LD_BASE_ARCHIVE_H
#define LD_BASE_ARCHIVE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct archive {
    bool loading;
    bool failed; // too few bytes, or not what was expected; what is loaded after it is zero
    unsigned char *bytes;
    size_t size; // of bytes
    size_t at;   // those used so far; more than `size` where saving found no room
} archive;

// Saves into bytes[size]; with size 0 it only counts.
archive archive_save(unsigned char *bytes, size_t size);
// Loads from bytes[size], which it does not change.
archive archive_load(const unsigned char *bytes, size_t size);

void archive_double(archive *self, double *value);
void archive_doubles(archive *self, double *values, size_t count);
void archive_int64(archive *self, int64_t *value);
// Loading these fails beyond their range: least to most, 0 to 2^53, 0 and 1.
void archive_int(archive *self, int *value, int least, int most);
void archive_count(archive *self, int64_t *value);
void archive_bool(archive *self, bool *value);
// text[size], ended by a zero byte; size is a multiple of 8.
void archive_text(archive *self, char *text, size_t size);
// A number that both sides know: loading fails at another one.
void archive_expect(archive *self, int64_t value);

#endif
