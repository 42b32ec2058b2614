// The texts that a model was read from, being gathered: the scenario, what it includes, its tables.
#ifndef LD_MODEL_SOURCE_H
#define LD_MODEL_SOURCE_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

#include "launchdyn/model.h"

/// A file that a scenario was read from: the scenario itself, one that it includes, a table.
typedef struct ld_source_file {
    char *name;    ///< as seen from the scenario's folder; of the scenario without its folder
    char *text;    ///< with a zero after its end
    size_t length; ///< of the text
} ld_source_file;

/// All that a scenario was read from, so that it can be read again without its files.
struct ld_source {
    char *name;    ///< of the scenario, in messages
    char *folder;  ///< where files that it names are searched; NULL: `file` has all there are
    bool confined; ///< those that do not lie there or below are refused
    size_t file_count;
    ld_source_file **file; ///< [file_count] the scenario first
    size_t set_count;
    char **set;        ///< [set_count] overrides (as of --set)
    size_t set_before; ///< so many of them were there when the others were laid over them
    atomic_int users;  ///< models that share it, on any threads
};

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
// Gives one share of it up; the last one frees it. May be NULL.
void source_free(ld_source *source);

#endif
