// Runs a fuzz target as a test: on every file of its folder, seeds and inputs that once failed, and
// on random changes of them, the same each time.
#ifndef LD_TESTS_FUZZ_CORPUS_H
#define LD_TESTS_FUZZ_CORPUS_H

#include "support/check.h"

#include <dirent.h>
#include <stdlib.h>

enum { CORPUS_FILES = 200, CORPUS_INPUT = 1 << 14, CORPUS_EDITS = 4 };

static struct {
    uint8_t *data;
    size_t size;
} corpus[CORPUS_FILES];
static size_t corpus_count;

static size_t corpus_random(size_t below)
{
    static uint64_t state = 0x9e3779b97f4a7c15u;
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return below ? (size_t)(state % below) : 0;
}

// Runs the target on a copy that ends where its memory ends.
static void corpus_run(const uint8_t *data, size_t size)
{
    uint8_t *copy = malloc(size + !size);
    assert_non_null(copy);
    memcpy(copy, data, size);
    LLVMFuzzerTestOneInput(copy, size);
    free(copy);
}

static void corpus_read(const char *path)
{
    FILE *stream = fopen(path, "rb");
    uint8_t *data = malloc(CORPUS_INPUT);
    assert_non_null(stream);
    assert_non_null(data);
    assert_true(corpus_count < CORPUS_FILES);
    corpus[corpus_count].data = data;
    corpus[corpus_count++].size = fread(data, 1, CORPUS_INPUT, stream);
    fclose(stream);
}

static int corpus_has_name(const struct dirent *entry)
{
    return entry->d_name[0] != '.';
}

static void corpus_read_folder(const char *folder)
{
    struct dirent **entry;
    int count = scandir(folder, &entry, corpus_has_name, alphasort);
    assert_true(count > 0);
    for (int i = 0; i < count; i++) {
        char path[1024];
        snprintf(path, sizeof path, "%.500s/%.255s", folder, entry[i]->d_name);
        corpus_read(path);
        free(entry[i]);
    }
    free(entry);
}

// Puts `size` bytes of some input in the place of up to `size` others.
static size_t corpus_paste(uint8_t *data, size_t length, size_t at, size_t size)
{
    size_t other = corpus_random(corpus_count), gone = corpus_random(size + 1);
    size_t from = corpus_random(corpus[other].size);
    size = size < corpus[other].size - from ? size : corpus[other].size - from;
    gone = gone < length - at ? gone : length - at;
    if (length - gone + size > CORPUS_INPUT)
        return length;
    memmove(data + at + size, data + at + gone, length - at - gone);
    memcpy(data + at, corpus[other].data + from, size);
    return length - gone + size;
}

// One change of an input of `length` bytes; returns the new length.
static size_t corpus_change(uint8_t *data, size_t length)
{
    size_t at = corpus_random(length + 1);
    switch (corpus_random(5)) {
    case 0: // bytes of another
        return corpus_paste(data, length, at, 1 + corpus_random(16));
    case 1:
        return corpus_paste(data, length, at, 1 + corpus_random(256));
    case 2: // a bit
        if (at < length)
            data[at] ^= (uint8_t)(1 << corpus_random(8));
        return length;
    case 3: // a byte
        if (at < length)
            data[at] = (uint8_t)corpus_random(256);
        return length;
    default: // an end
        return corpus_random(4) ? length : at;
    }
}

static void corpus_run_changed(void)
{
    static uint8_t data[CORPUS_INPUT];
    size_t chosen = corpus_random(corpus_count), length = corpus[chosen].size;
    memcpy(data, corpus[chosen].data, length);
    for (size_t edits = 1 + corpus_random(CORPUS_EDITS); edits > 0; edits--)
        length = corpus_change(data, length);
    corpus_run(data, length);
}

// Of the folder tests/fuzz/`name`; so many changed inputs.
static void corpus_test(const char *name, int changes)
{
    char folder[512];
    snprintf(folder, sizeof folder, "%s/tests/fuzz/%s", LD_SOURCE_DIR, name);
    corpus_read_folder(folder);
    for (size_t i = 0; i < corpus_count; i++)
        corpus_run(corpus[i].data, corpus[i].size);
    for (int i = 0; i < changes; i++)
        corpus_run_changed();
    printf("    inputs run: %zu of the folder, %d changed\n", corpus_count, changes);
    for (size_t i = 0; i < corpus_count; i++)
        free(corpus[i].data);
}

#endif
