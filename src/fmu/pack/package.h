// A zip archive that is written whole or not at all, the same bytes for the same contents.
#ifndef LD_FMU_PACKAGE_H
#define LD_FMU_PACKAGE_H

#include <stddef.h>

#include "launchdyn/status.h"

typedef struct package package;

// Adds a file of that name to the package.
void package_put(package *self, const char *name, const void *bytes, size_t size);

// Writes what `put_all` puts, under a temporary name that then becomes `file`. LD_OK, LD_ERR_FILE.
ld_status package_write(const char *file, void put_all(package *self, const void *data),
                        const void *data, ld_error *error);

#endif
