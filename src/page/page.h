// What the page that simulates asks of its core: the worker around the core as WebAssembly calls it
// from JavaScript, launchdyn/live.h for a server. One run at a time; texts and columns are those of
// the last one.
#ifndef LD_PAGE_PAGE_H
#define LD_PAGE_PAGE_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct page_core page_core;

// What came of the last call, as text.
typedef enum page_text_kind {
    PAGE_MESSAGES, // errors and warnings, as the command prints them
    PAGE_SCENARIO, // the scenario as it was understood, in SI, which can be read again
    PAGE_SUMMARY,  // what summary.json has
    PAGE_DATA,     // what the report's scripts show, JSON
    PAGE_VALUES,   // of the keys that page_values() was asked for, a line each
    PAGE_TEXTS
} page_text_kind;

// Files that scenarios name are looked for in the folder. NULL: no memory.
page_core *page_new(const char *folder);
void page_free(page_core *self);

// From now on files that do not lie in the folder or below are refused.
void page_confine(page_core *self);

// A text in place of the file of that name. false: no memory.
bool page_add_file(page_core *self, const char *name, const char *text, size_t length);

// Runs a scenario with overrides, "path=value", a line each (changed meanwhile). An ld_status; of
// LD_ERR_LAUNCH and LD_ERR_NUMERIC there are results up to the end of the run.
int page_run(page_core *self, const char *scenario, char *sets);

// Runs end with LD_ERR_INTERRUPTED once *stop is true.
void page_heed(page_core *self, const atomic_bool *stop);

// Reads a scenario, and values of its keys ("61 kg"; empty: not given, or more than a line) by
// `paths`, a line each.
int page_values(page_core *self, const char *scenario, char *sets, const char *paths);

// Valid until the next call that writes it; "": there is none.
const char *page_text(const page_core *self, page_text_kind kind);

// Writes the columns of the launcher (rocket 0) or of a rocket's flight as history.csv and
// flights.csv have them, but for the rocket's number. LD_ERR_INPUT: there are none.
int page_write_csv(const page_core *self, int rocket, const char *path);

#endif
