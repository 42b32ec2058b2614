// What a saved run begins and ends with: what it is, in which form, of which model, how long; at
// its end a checksum.
#ifndef LD_INTEGRATION_SAVED_STATE_H
#define LD_INTEGRATION_SAVED_STATE_H

#include <stddef.h>

#include "base/archive.h"
#include "launchdyn/model.h"
#include "launchdyn/status.h"

typedef struct saved_state {
    int64_t magic, form; // `form` goes up when the bytes change
    const char *name;    // "run"
} saved_state;

// `length` is that of all, in bytes.
void saved_state_head(const saved_state *self, const ld_model *model, archive *bytes,
                      int64_t length);
void saved_state_sum(archive *bytes);

// Whether the bytes are those of such a state of this model, whole. LD_OK or LD_ERR_INPUT.
ld_status saved_state_check(const saved_state *self, const ld_model *model, const void *bytes,
                            size_t size, ld_error *error);

#endif
