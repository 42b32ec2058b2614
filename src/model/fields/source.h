// The texts that a model was read from, being gathered: the scenario, what it includes, its tables.
#ifndef LD_MODEL_SOURCE_H
#define LD_MODEL_SOURCE_H

#include "model/model.h"

// One without files, with one user; `folder` NULL: none are to be opened. NULL: no memory.
ld_source *source_new(const char *name, const char *folder);
// Adds a file, whose text becomes the source's own in any case; NULL: no memory. The pointer lasts
// as long as the source.
const ld_source_file *source_add(ld_source *self, const char *name, char *text, size_t length);
// Adds an override; false: no memory.
bool source_add_set(ld_source *self, const char *text);
// A copy with a user of its own; NULL: no memory.
ld_source *source_copy(const ld_source *self);
// The file of that name beside the scenario itself, or NULL.
const ld_source_file *source_find(const ld_source *self, const char *name);
// One user more, who frees it too.
ld_source *source_hold(ld_source *self);

#endif
