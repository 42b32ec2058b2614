/// The page that simulates with this library behind it: what a server hands to a browser and gets
/// back (docs/command.md#live). Nothing here listens or connects.
#ifndef LAUNCHDYN_LIVE_H
#define LAUNCHDYN_LIVE_H

#include <stddef.h>
#include <stdio.h>

#include "launchdyn/status.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

typedef struct ld_live ld_live;

/// @param file the scenario that the page begins with; a launch opens no file outside its folder
/// @param sets `count` texts "path=value", what the page lays over it at first
/// @param live filled on success (free with ld_live_free()); NULL on failure
/// @return LD_OK, LD_ERR_INPUT (no such file, or an override without "="), LD_ERR_FILE,
///         LD_ERR_MEMORY; a scenario with errors is none: the page shows them
ld_status ld_live_create(const char *file, const char *const *sets, size_t count, ld_live **live,
                         ld_error *error);
void ld_live_free(ld_live *live);

/// Writes the page, HTML, with the scenario file as it is now. It fetches nothing, and posts to
/// "launch" beside its own address.
/// @return LD_OK, or as ld_live_create()
ld_status ld_live_page(const ld_live *live, FILE *page, ld_error *error);

/// Launches what the page has posted and writes the answer: texts with a zero after each, the
/// launch's ld_status as a number, messages, the scenario as it was understood, summary, what is
/// drawn, values of keys. Threads may call it side by side: one launches after the other.
/// @param request names and texts, a zero after each: "text" (of the scenario), "sets" and "paths"
///                by lines, "file NAME" (a text in place of a file that a scenario names)
/// @return LD_OK, also of a scenario that cannot be launched; LD_ERR_INPUT (no such request),
///         LD_ERR_INTERRUPTED, LD_ERR_MEMORY: then nothing was written
ld_status ld_live_launch(ld_live *live, const char *request, size_t length, FILE *answer,
                         ld_error *error);

/// Ends the launch that runs, and those to come; from any thread.
void ld_live_stop(ld_live *live);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
