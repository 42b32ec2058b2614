// What is known of this program: how it was built, what it runs on, its libraries.
#include "results/program.h"
#include "launchdyn/version.h"

#if defined(__x86_64__) || defined(__i386__)
#include <cpuid.h>
#endif
#include <stdio.h>
#include <string.h>
#include <sundials/sundials_version.h>
#include <sys/utsname.h>
#include <yaml.h>
#include <zlib.h>
#ifndef __EMSCRIPTEN__ // the page that simulates has no files
#include <gnu/libc-version.h>
#include <hdf5.h>
#include <sqlite3.h>
#endif

extern void ilaver_(int *major, int *minor, int *patch);

// The processor's name by its own word, or the kind of machine.
static void processor_name(char *text, size_t size)
{
    struct utsname machine;
    snprintf(text, size, "%s", uname(&machine) == 0 ? machine.machine : "unknown");
#if defined(__x86_64__) || defined(__i386__)
    unsigned word[13] = {0};
    for (unsigned i = 0; i < 12; i += 4)
        if (!__get_cpuid(0x80000002 + i / 4, word + i, word + i + 1, word + i + 2, word + i + 3))
            return;
    const char *name = (const char *)word;
    snprintf(text, size, "%s", name + strspn(name, " "));
#endif
}

void program_describe(program_fact *take, void *self)
{
    char text[256];
    int lapack[3];
    take(self, "version", LD_VERSION);
    take(self, "commit", program_commit);
    take(self, "compiler", LD_COMPILER);
    processor_name(text, sizeof text);
    take(self, "processor", text);
#ifndef __EMSCRIPTEN__
    take(self, "C library", gnu_get_libc_version());
#endif
    take(self, "SUNDIALS", SUNDIALSGetVersion(text, sizeof text) == 0 ? text : "unknown");
    ilaver_(&lapack[0], &lapack[1], &lapack[2]);
    snprintf(text, sizeof text, "%d.%d.%d", lapack[0], lapack[1], lapack[2]);
    take(self, "LAPACK", text);
    take(self, "BLAS", LD_BLAS);
#ifndef __EMSCRIPTEN__
    // not asked: that starts the library, which dies without memory; it refuses another version
    snprintf(text, sizeof text, "%d.%d.%d", H5_VERS_MAJOR, H5_VERS_MINOR, H5_VERS_RELEASE);
    take(self, "HDF5", text);
    take(self, "SQLite", sqlite3_libversion());
#endif
    take(self, "libyaml", yaml_get_version_string());
    take(self, "zlib", zlibVersion());
}
