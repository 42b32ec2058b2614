// Runs in memory of what a folder's results were made of: with tighter numerics, or with sampled
// inputs.
#ifndef LD_COMPARE_FURTHER_RUNS_H
#define LD_COMPARE_FURTHER_RUNS_H

#include "compare/run_series.h"
#include "launchdyn/origin.h"
#include "launchdyn/summary.h"

typedef struct further_runs {
    ld_origin origin;
    ld_model *model; // of the folder's point of the sweep
    ld_run_options options;
} further_runs;

// What is done with a run while its series are there.
typedef ld_status run_taker(void *self, const run_series *run, const ld_summary *summary,
                            ld_error *error);

// A run of a model in memory, handed to `take`.
typedef struct series_run {
    const ld_model *model;
    ld_run_options options; // but for its sink
    int rocket;
    run_taker *take;
    void *data;
} series_run;

// @return what the run or `take` returns
ld_status series_run_make(const series_run *self, ld_error *error);

// `options` hold for each run, but for its sink.
// @return LD_OK, LD_ERR_INPUT (the folder does not keep what its run was made of), LD_ERR_MEMORY
ld_status further_runs_open(further_runs *self, const char *folder, const ld_run_options *options,
                            ld_error *error);
// Of a study's nominal scenario, for its samples.
ld_status further_runs_open_study(further_runs *self, const char *folder,
                                  const ld_run_options *options, ld_error *error);
void further_runs_close(further_runs *self);

// [m/s2] in the run of that folder.
// @return what further_runs_open() returns
ld_status further_runs_gravity(const char *folder, double *gravity, ld_error *error);

// Texts as of --set.
typedef struct run_overrides {
    const char *const *set; // [count]
    size_t count;
} run_overrides;

// Runs it with overrides (NULL: as it was) and hands rocket `rocket` to `take`; of a folder that is
// of a sample, that sample.
// @return what the run or `take` returns
ld_status further_run(const further_runs *self, const run_overrides *overrides, int rocket,
                      run_taker *take, void *data, ld_error *error);

// The same of sample `number` (from 1) of the scatter.
ld_status further_run_sample(const further_runs *self, int number, int rocket, run_taker *take,
                             void *data, ld_error *error);

#endif
