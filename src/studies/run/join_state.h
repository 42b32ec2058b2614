// What the keeper of a shared study knows, for the processes that run its ranges: the file
// DIR/ranges/state. It is renewed often, by which others see that there is a keeper.
#ifndef LD_STUDIES_JOIN_STATE_H
#define LD_STUDIES_JOIN_STATE_H

#include "studies/run/claims.h"
#include "studies/run/keeper.h"

typedef struct join_state {
    uint64_t key;    // of the scenario, its samples and rule, and the version
    int64_t samples; // that are requested
    int64_t look;    // ranges up to this sample are to be run
    int64_t done, failed;
    int ruled, enough; // there is a stopping rule; it holds
    int complete;
    int count;   // of ranges
    char *kept;  // [count] '1': all samples of the range are kept
    double time; // [s] when it was written
} join_state;

ld_status join_key(const ld_study *study, uint64_t *key, ld_error *error);

// What the keeper knows; self->key as it is.
ld_status join_state_take(join_state *self, const study_keeper *keeper, ld_error *error);
ld_status join_state_write(const join_state *self, const study_claims *claims, ld_error *error);
// Reads a state that was written after this process has begun; false: there is none, and self is as
// before.
bool join_state_read(join_state *self, const study_claims *claims);
void join_state_free(join_state *self);

#endif
