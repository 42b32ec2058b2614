// A text file, read whole.
#ifndef LD_BASE_TEXT_FILE_H
#define LD_BASE_TEXT_FILE_H

#include <stddef.h>
#include <stdio.h>

#include "launchdyn/status.h"

// Reads the regular file `path` ("-": standard input) into memory to be freed, with a zero after
// its end. Fails with a sentence without the name, e.g. "cannot be read: No such file or
// directory".
ld_status text_file_read(const char *path, size_t limit, char **text, size_t *length,
                         ld_error *error);

// What an error number means where a file is read: LD_ERR_INPUT, it is not there or nothing to be
// read; LD_ERR_FILE or LD_ERR_MEMORY, the system cannot for itself.
ld_status text_file_status(int number);

// "cannot be read: REASON", of errno.
ld_status text_file_failed(ld_error *error);

#endif
