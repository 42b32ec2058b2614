// Runs a fuzz target on every file of its folder: seeds, and inputs that once failed.
#ifndef LD_TESTS_FUZZ_CORPUS_H
#define LD_TESTS_FUZZ_CORPUS_H

#include "support/check.h"

#include <dirent.h>
#include <stdlib.h>

static int run_file(const char *path, int (*target)(const uint8_t *, size_t))
{
    FILE *stream = fopen(path, "rb");
    if (!stream)
        return 0;
    uint8_t *data = malloc(1 << 20);
    assert_non_null(data);
    size_t size = fread(data, 1, 1 << 20, stream);
    fclose(stream);
    target(data, size);
    free(data);
    return 1;
}

static int run_folder(const char *folder, int (*target)(const uint8_t *, size_t))
{
    int count = 0;
    DIR *listing = opendir(folder);
    assert_non_null(listing);
    for (struct dirent *entry; (entry = readdir(listing));) {
        char path[1024];
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        if (entry->d_name[0] != '.')
            count += run_file(path, target);
    }
    closedir(listing);
    return count;
}

#endif
