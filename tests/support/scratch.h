// A folder for the files of one test program.
#ifndef LD_TESTS_SUPPORT_SCRATCH_H
#define LD_TESTS_SUPPORT_SCRATCH_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static char folder[64];

// The path of `name` in the folder; valid for the next three calls.
static const char *in(const char *name)
{
    static char path[4][128];
    static int next;
    char *chosen = path[next++ % 4];
    snprintf(chosen, sizeof *path, "%s/%s", folder, name);
    return chosen;
}

// Makes the folder, new and empty, before a group of tests. 0, or -1 where it cannot be made.
static int scratch_make(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/launchdyn-test-XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

// Removes it with all that is in it, after them.
static int scratch_remove(void **state)
{
    (void)state;
    char command[128];
    snprintf(command, sizeof command, "rm -r %s", folder);
    return system(command);
}

#endif
