// A folder in memory, for what is read by its name; one of each process.
#ifndef LD_TESTS_FUZZ_MEMORY_FOLDER_H
#define LD_TESTS_FUZZ_MEMORY_FOLDER_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static inline void must(bool so)
{
    if (!so)
        abort();
}

static char memory_folder[64];

static void memory_remove(void)
{
    char command[128];
    snprintf(command, sizeof command, "rm -r %s", memory_folder);
    must(system(command) == 0);
}

// The path of `name` in it, valid for the next seven calls; makes the folder at first use.
static inline const char *in_memory(const char *name)
{
    static char path[8][128];
    static int next;
    if (!memory_folder[0]) {
        bool shared = access("/dev/shm", W_OK) == 0;
        snprintf(memory_folder, sizeof memory_folder, "%s/launchdyn-fuzz-XXXXXX",
                 shared ? "/dev/shm" : "/tmp");
        must(mkdtemp(memory_folder) != NULL);
        atexit(memory_remove);
    }
    char *chosen = path[next++ % 8];
    snprintf(chosen, sizeof *path, "%s/%.50s", memory_folder, name);
    return chosen;
}

static inline void write_in_memory(const char *name, const void *data, size_t size)
{
    FILE *stream = fopen(in_memory(name), "wb");
    must(stream && fwrite(data, 1, size, stream) == size && fclose(stream) == 0);
}

// The bytes of a file, to be freed.
static inline uint8_t *read_in_memory(const char *name, size_t *size)
{
    FILE *stream = fopen(in_memory(name), "rb");
    must(stream && fseek(stream, 0, SEEK_END) == 0);
    *size = (size_t)ftell(stream);
    uint8_t *data = malloc(*size + 1);
    rewind(stream);
    must(data && fread(data, 1, *size, stream) == *size);
    fclose(stream);
    return data;
}

#endif
