// What a child is at, for the process that waits for it (launchdyn/child.h); elsewhere these do
// nothing.
#ifndef LD_BASE_CHILD_H
#define LD_BASE_CHILD_H

#include "launchdyn/child.h"

// The foreign file that is read from now on, until the next one; NULL: none.
void child_reads(const char *path);

// A file that is not whole under this name, until it has been renamed or removed.
void child_writes(const char *path);
void child_wrote(const char *path);

// The lock file (lock_file.h) that guards what it writes; NULL: none.
void child_locks(const char *path);

#endif
