// A package from elsewhere (FMI 2.0.4 section 2.3.1, FMI 3.0.2 section 2.5.1: a zip archive) is
// unpacked into a private folder. What it holds is not trusted: no name leads out of the folder, no
// link is made, and what it may take is bounded.
#ifndef LD_FOREIGN_UNPACK_H
#define LD_FOREIGN_UNPACK_H

#include "launchdyn/status.h"

// The folders of binaries for this machine, in FMI 2 and 3.
#if defined(__aarch64__)
#define FOREIGN_BINARIES_2 "aarch64-linux"
#define FOREIGN_BINARIES_3 "aarch64-linux"
#else
#define FOREIGN_BINARIES_2 "linux64"
#define FOREIGN_BINARIES_3 "x86_64-linux"
#endif

// What a package may hold.
enum { FOREIGN_MOST_ENTRIES = 20000, FOREIGN_LONGEST_NAME = 512, FOREIGN_MOST_RATIO = 200 };
#define FOREIGN_MOST_BYTES ((uint64_t)1 << 30) // [byte] unpacked

// Unpacks the description, the resources and this machine's binaries of the archive `path` into
// `folder`, which is there; the names of all else are checked, too. After a failure, one sentence
// that names the archive, the folder may hold some of it.
ld_status foreign_unpack(const char *path, const char *folder, ld_error *error);

#endif
