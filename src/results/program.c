// What is known of this program: how it was built, what it runs on, its libraries.
#include "results/program.h"
#include "launchdyn/version.h"

#include <gnu/libc-version.h>
#include <hdf5.h>
#include <sqlite3.h>
#include <stdio.h>
#include <string.h>
#include <sundials/sundials_version.h>
#include <sys/utsname.h>
#include <yaml.h>
#include <zlib.h>

// OpenBLAS, where that is the one.
extern char *openblas_get_config(void) __attribute__((weak));
extern void ilaver_(int *major, int *minor, int *patch);

// "model name : ..." of the first processor, or the kind of machine.
static void processor_name(char *text, size_t size)
{
    struct utsname machine;
    char line[256];
    FILE *file = fopen("/proc/cpuinfo", "r");
    snprintf(text, size, "%s", uname(&machine) == 0 ? machine.machine : "unknown");
    while (file && fgets(line, sizeof line, file)) {
        const char *colon = strchr(line, ':');
        if (strncmp(line, "model name", 10) != 0 || !colon)
            continue;
        snprintf(text, size, "%s", colon + 1 + strspn(colon + 1, " "));
        text[strcspn(text, "\n")] = '\0';
        break;
    }
    if (file)
        fclose(file);
}

void program_describe(program_fact *take, void *self)
{
    char text[256];
    unsigned major, minor, patch;
    int lapack[3];
    take(self, "version", LD_VERSION);
    take(self, "commit", program_commit);
    take(self, "compiler", LD_COMPILER);
    processor_name(text, sizeof text);
    take(self, "processor", text);
    take(self, "C library", gnu_get_libc_version());
    take(self, "SUNDIALS", SUNDIALSGetVersion(text, sizeof text) == 0 ? text : "unknown");
    ilaver_(&lapack[0], &lapack[1], &lapack[2]);
    snprintf(text, sizeof text, "%d.%d.%d", lapack[0], lapack[1], lapack[2]);
    take(self, "LAPACK", text);
    take(self, "BLAS", openblas_get_config ? openblas_get_config() : "unknown");
    H5get_libversion(&major, &minor, &patch);
    snprintf(text, sizeof text, "%u.%u.%u", major, minor, patch);
    take(self, "HDF5", text);
    take(self, "SQLite", sqlite3_libversion());
    take(self, "libyaml", yaml_get_version_string());
    take(self, "zlib", zlibVersion());
}
