// The candidates of an optimisation: the samples of its study at points of the unit cube, computed
// side by side or taken from what was kept. All candidates have the same sampled numbers.
#ifndef LD_OPTIMISE_CANDIDATES_H
#define LD_OPTIMISE_CANDIDATES_H

#include "launchdyn/simulation.h"
#include "optimise/optimise.h"
#include "search/search_state.h"
#include "studies/run/worker.h"

typedef struct candidates {
    ld_optimisation *of;
    const ld_optimise_options *options;
    search_state state;
    int threads;
    study_worker *worker; // [threads]
    ld_study study;       // of the candidates of a batch, as the points of a sweep
    double *work;         // for statistics
    int start;            // of the candidates to come
    ld_optimise_counts counts;
    char stage[64];
} candidates;

// Opens the folder (NULL: none), which is there.
// @param self to be closed in any case
ld_status candidates_open(candidates *self, ld_optimisation *of, const ld_optimise_options *options,
                          ld_error *error);
void candidates_close(candidates *self);

// As evaluate() of optimum_problem; `self` are candidates. Adds them to the optimisation's.
ld_status candidates_evaluate(void *self, int count, const double *points, double *values,
                              bool *there, ld_error *error);

// As is_enough() of optimum_problem.
bool candidates_are_enough(void *self, int before, int now);

// Further samples at a point, numbered behind those of the search; *number stays NULL where one of
// them fails.
ld_status candidates_try_others(candidates *self, const double *x, double **number,
                                ld_error *error);

void candidates_stage(candidates *self, const char *text);

#endif
