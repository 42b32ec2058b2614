#include "base/archive.h"

#include <string.h>

enum { WORD = 8 };

archive archive_save(unsigned char *bytes, size_t size)
{
    return (archive){.bytes = bytes, .size = size};
}

archive archive_load(const unsigned char *bytes, size_t size)
{
    return (archive){.loading = true, .bytes = (unsigned char *)bytes, .size = size};
}

static void save_word(archive *self, uint64_t word)
{
    if (self->size >= WORD && self->at <= self->size - WORD)
        for (int i = 0; i < WORD; i++)
            self->bytes[self->at + (size_t)i] = (unsigned char)(word >> 8 * i);
    else
        self->failed = true;
    self->at += WORD;
}

static uint64_t load_word(archive *self)
{
    if (self->failed || self->size < WORD || self->at > self->size - WORD) {
        self->failed = true;
        return 0;
    }
    uint64_t word = 0;
    for (int i = 0; i < WORD; i++)
        word |= (uint64_t)self->bytes[self->at + (size_t)i] << 8 * i;
    self->at += WORD;
    return word;
}

void archive_int64(archive *self, int64_t *value)
{
    if (self->loading)
        *value = (int64_t)load_word(self);
    else
        save_word(self, (uint64_t)*value);
}

void archive_double(archive *self, double *value)
{
    uint64_t word = 0;
    memcpy(&word, value, sizeof word);
    if (self->loading) {
        word = load_word(self);
        memcpy(value, &word, sizeof word);
    } else {
        save_word(self, word);
    }
}

void archive_doubles(archive *self, double *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        archive_double(self, &values[i]);
}

// Loads `least` where the number is beyond the range.
static int64_t ranged(archive *self, int64_t value, int64_t least, int64_t most)
{
    archive_int64(self, &value);
    bool fits = value >= least && value <= most;
    self->failed |= !fits;
    return fits ? value : least;
}

void archive_int(archive *self, int *value, int least, int most)
{
    *value = (int)ranged(self, *value, least, most);
}

void archive_count(archive *self, int64_t *value)
{
    *value = ranged(self, *value, 0, INT64_C(1) << 53);
}

void archive_bool(archive *self, bool *value)
{
    *value = ranged(self, *value, 0, 1) == 1;
}

void archive_text(archive *self, char *text, size_t size)
{
    for (size_t at = 0; at + WORD <= size; at += WORD) {
        uint64_t word = 0;
        for (int i = 0; i < WORD; i++)
            word |= (uint64_t)(unsigned char)text[at + (size_t)i] << 8 * i;
        int64_t both = (int64_t)word;
        archive_int64(self, &both);
        for (int i = 0; i < WORD; i++)
            text[at + (size_t)i] = (char)(unsigned char)((uint64_t)both >> 8 * i);
    }
    self->failed |= text[size - 1] != 0;
    text[size - 1] = 0;
}

void archive_expect(archive *self, int64_t value)
{
    int64_t found = value;
    archive_int64(self, &found);
    self->failed |= found != value;
}
