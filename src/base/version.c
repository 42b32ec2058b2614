#include "launchdyn/version.h"

const char *ld_version(void)
{
    return LD_VERSION;
}

int ld_version_number(void)
{
    return 10000 * LD_VERSION_MAJOR + 100 * LD_VERSION_MINOR + LD_VERSION_PATCH;
}
