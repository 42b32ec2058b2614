// A folder for the studies of a benchmark.
#ifndef LD_BENCH_SCRATCH_H
#define LD_BENCH_SCRATCH_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static inline void make_folder(char folder[32])
{
    strcpy(folder, "/tmp/launchdyn-bench-XXXXXX");
    if (!mkdtemp(folder))
        exit(1);
}

static inline void remove_folder(const char *folder)
{
    char command[64];
    snprintf(command, sizeof command, "rm -r %s", folder);
    if (system(command)) // NOLINT(cert-env33-c): the folder above, nothing given
        exit(1);
}

#endif
