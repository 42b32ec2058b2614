// The launches of a fit: residuals of data at points of the cube, computed side by side, or taken
// from what was kept.
#ifndef LD_FIT_LAUNCHES_H
#define LD_FIT_LAUNCHES_H

#include <pthread.h>

#include "fit/fit.h"
#include "launchdyn/history.h"
#include "launchdyn/simulation.h"
#include "search/search_state.h"

// One who simulates, one launch after the other.
typedef struct fit_worker {
    ld_model *model;
    ld_simulation *simulation; // of the launch run last
    ld_summary *summary;
    ld_history *history;
    fit_log_run log[FIT_MOST_LOGS]; // of the launch run last
} fit_worker;

typedef struct fit_launches {
    const ld_fit *fit;
    const ld_fit_options *options;
    search_state state;
    int threads;
    fit_worker *worker; // [threads]
    ld_fit_counts counts;
    char stage[192];
    char reason[LD_ERROR_TEXT]; // of the first launch that could not be; "" without
} fit_launches;

// Opens the folder (NULL: none), which is there.
// @param self to be closed in any case
ld_status fit_launches_open(fit_launches *self, const ld_fit *fit, const ld_fit_options *options,
                            ld_error *error);
void fit_launches_close(fit_launches *self);

// As evaluate() and stage() of fit_problem; `self` are fit_launches.
ld_status fit_launches_evaluate(void *self, int count, const double *points, double *residuals,
                                bool *there, ld_error *error);
void fit_launches_stage(void *self, const char *text, double chi2);

#endif
