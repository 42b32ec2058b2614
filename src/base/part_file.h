// A file that is written under a temporary name of its own, until it is whole.
#ifndef LD_BASE_PART_FILE_H
#define LD_BASE_PART_FILE_H

#include <stdbool.h>

#include "launchdyn/status.h"

typedef struct part_file {
    const char *name; // by reference: what it becomes
    char path[4096];  // where it is written
    bool replaces;    // `path` is a temporary name
} part_file;

// Makes an empty file NAME.part, or NAME.2.part and so on where that name is taken: by another
// program, or by one that was killed. Where NAME is not a regular file, as /dev/stdout, it is
// written itself.
// @return LD_OK; LD_ERR_INPUT, the name is too long; LD_ERR_FILE
ld_status part_file_begin(part_file *self, const char *name, ld_error *error);

// Gives the file its own name, or, where `status` is not LD_OK, removes it. After
// part_file_begin() alone.
// @return `status`, or LD_ERR_FILE
ld_status part_file_end(part_file *self, ld_status status, ld_error *error);

// "cannot write NAME: REASON", by an error number. LD_ERR_FILE.
ld_status part_file_failed(const part_file *self, int number, ld_error *error);

#endif
