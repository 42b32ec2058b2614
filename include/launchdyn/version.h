/// Which launchdyn this is: as compiled against, and as found at run time.
#ifndef LAUNCHDYN_VERSION_H
#define LAUNCHDYN_VERSION_H

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

#define LD_VERSION_MAJOR 0
#define LD_VERSION_MINOR 1
#define LD_VERSION_PATCH 0

#define LD_TEXT_OF(number) #number
#define LD_TEXT(number) LD_TEXT_OF(number)
/// The version of these headers, "0.1.0".
#define LD_VERSION                                                                                 \
    LD_TEXT(LD_VERSION_MAJOR) "." LD_TEXT(LD_VERSION_MINOR) "." LD_TEXT(LD_VERSION_PATCH)

/// The version of the library that runs, "0.1.0".
const char *ld_version(void);

/// The same as one number that grows: 10 000 major + 100 minor + patch.
int ld_version_number(void);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
