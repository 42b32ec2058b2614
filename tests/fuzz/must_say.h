// A call that goes well, or says why not.
#ifndef LD_TESTS_FUZZ_MUST_SAY_H
#define LD_TESTS_FUZZ_MUST_SAY_H

#include "fuzz/memory_folder.h"
#include "launchdyn/status.h"

static inline void must_say(ld_status status, const ld_error *error)
{
    bool said = !status || (error->status == status && error->text[0] && status != LD_ERR_MEMORY);
    if (!said)
        fprintf(stderr, "%s: \"%s\"\n", ld_status_name(status), error->text);
    must(said);
}

#endif
