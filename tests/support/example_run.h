// An example run into a folder of results, and its history read back.
#ifndef LD_TESTS_SUPPORT_EXAMPLE_RUN_H
#define LD_TESTS_SUPPORT_EXAMPLE_RUN_H

#include "results/history.h"

// Runs examples/NAME with `count` keys set ("path=value") and leaves the results in `folder`.
// `read` is to be freed by history_free().
void example_run(const char *folder, const char *name, const char *const *sets, size_t count,
                 ld_summary *summary, history_data *read);

#endif
