// What the archives in a wheel's library lack there.
#include <nlopt.h>
#include <stdio.h>

// Debian's HDF5 is compiled for programs, which may lie beside their data: it gets streams of the library's own
// (linked with --wrap=stderr, --wrap=stdout).
extern FILE *__real_stderr, *__real_stdout;
extern FILE *__wrap_stderr, *__wrap_stdout;
FILE *__wrap_stderr, *__wrap_stdout;

__attribute__((constructor)) static void find_streams(void)
{
    __wrap_stderr = __real_stderr;
    __wrap_stdout = __real_stdout;
}

// NLopt's methods under the LGPL are left out. launchdyn asks for none of them (src/optimise/).
int luksan_plis(void);
int luksan_plip(void);
int luksan_pnet(void);

int luksan_plis(void)
{
    return NLOPT_INVALID_ARGS;
}

int luksan_plip(void)
{
    return NLOPT_INVALID_ARGS;
}

int luksan_pnet(void)
{
    return NLOPT_INVALID_ARGS;
}
