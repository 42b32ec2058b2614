/// Work in a process of its own: what a library does to a damaged file ends that process alone.
#ifndef LAUNCHDYN_CHILD_H
#define LAUNCHDYN_CHILD_H

#include "launchdyn/status.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/// Does `work` in a child of this process, with a copy of its memory, and waits for its end.
/// SIGHUP, SIGINT and SIGTERM that reach this process meanwhile are handed on. Of a child that a
/// signal ended, the files that the library was writing are removed. For programs with one thread.
/// @param work what it returns, 0 to 255, is the child's exit code; it prints for itself
/// @param code the exit code of the child, or 128 + the number of one of the three signals where
///             that ended it
/// @return LD_OK; LD_ERR_FILE where another signal ended the child, with a sentence that names the
///         signal and the file that was read or written; LD_ERR_MEMORY or LD_ERR_MISSING: it could
///         not be started
ld_status ld_child_run(int (*work)(void *data), void *data, int *code, ld_error *error);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
