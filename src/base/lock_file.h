// A lock file (flock), which keeps a second program away from the files beside it.
#ifndef LD_BASE_LOCK_FILE_H
#define LD_BASE_LOCK_FILE_H

#include <stdbool.h>

#include "launchdyn/status.h"

// Makes the file `name` and locks it. Waits up to 2 s for its holder: a process that was killed
// holds it until it has ended.
// @param guarded what it protects, for the sentence
// @param lock    its descriptor, closed on exec and in a forked process; -1 after an error
// @return LD_OK; LD_ERR_INPUT, another process or descriptor holds it; LD_ERR_MISSING, the file
//         system has no locks; LD_ERR_FILE
ld_status lock_file_take(const char *name, const char *guarded, int *lock, ld_error *error);

// The same without waiting.
ld_status lock_file_try(const char *name, const char *guarded, int *lock, ld_error *error);

// Gives up the lock; the file stays. -1: does nothing.
void lock_file_release(int lock);

// Removes the file, then gives up its lock; -1: does nothing.
void lock_file_remove(const char *name, int lock);

#endif
