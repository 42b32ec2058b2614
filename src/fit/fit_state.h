// What a fit has computed so far, in the file DIR/fit.state: a fit that was stopped computes the
// same points in the same order and finds them there.
#ifndef LD_FIT_STATE_H
#define LD_FIT_STATE_H

#include <stdbool.h>
#include <stdio.h>

#include "fit/fit.h"

typedef struct fit_state {
    FILE *file; // NULL: nothing is kept
    int lock;
    char path[4096], lock_path[4096];
    int keys, residuals;
    char *text; // what was there
    size_t length, at;
    int uncut; // errno by which a damaged rest could not be cut off
} fit_state;

// Opens the file, which it may make; folder NULL: keeps nothing. `identity` says what the fit is
// of: a file of another one is refused.
// @return LD_OK, LD_ERR_INPUT, LD_ERR_FILE, LD_ERR_MEMORY
ld_status fit_state_open(fit_state *self, const ld_fit *fit, const char *folder,
                         const char *identity, ld_error *error);
// The next point that was kept, if it is this one; false: it, and all that follow, are not.
bool fit_state_next(fit_state *self, const double *point, double *residual, bool *there);
ld_status fit_state_put(fit_state *self, const double *point, const double *residual, bool there,
                        ld_error *error);
// What was put is on its way to the disk.
ld_status fit_state_flush(fit_state *self, ld_error *error);
void fit_state_close(fit_state *self);

#endif
