// Folders for results.
#ifndef LD_RESULTS_FOLDER_H
#define LD_RESULTS_FOLDER_H

#include <stddef.h>

#include "launchdyn/status.h"

// Makes the folder, parents first; *there becomes the length of the part that was there before, all
// of it where nothing had to be made.
ld_status folder_make(char *path, size_t *there, ld_error *error);

// The same of a name that stays as it is. LD_ERR_INPUT: it is empty or too long.
ld_status folder_ensure(const char *path, ld_error *error);

// Removes what folder_make() made, as far as it is empty.
void folder_remove(char *path, size_t there);

#endif
