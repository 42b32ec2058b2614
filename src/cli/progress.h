// How far a run is, on stderr: a line that moves on a terminal, elsewhere now and then a line of
// its own; and the wish to stop it.
#ifndef LD_CLI_PROGRESS_H
#define LD_CLI_PROGRESS_H

#include <stdbool.h>

#include "launchdyn/fit.h"
#include "launchdyn/optimise.h"
#include "launchdyn/study.h"

typedef struct run_progress {
    bool shown;           // draw a line at all
    bool terminal;        // on one that moves
    bool drawn;           // there is one on the terminal
    double start, latest; // [s] of the start and of the line last drawn
    double share;         // done then, where that is known
} run_progress;

// From now on SIGINT, SIGTERM and, unless it is ignored (nohup), SIGHUP ask for a stop; a second
// one of a kind ends the program at once, but for what a waiting parent hands on.
void progress_start(run_progress *progress, bool quiet);

// For ld_run_options.progress: false once a stop was asked for.
bool progress_share(void *self, double share);

// The same for ld_study_options: how many samples are done; whether to continue.
void progress_samples(void *self, const ld_study_counts *counts);
bool progress_resume(void *self);
// For ld_fit_options: how many launches are done.
void progress_launches(void *self, const ld_fit_counts *counts);
// For ld_derivative_options: how many launches of them are done.
void progress_derivatives(void *self, int launches, int of);

// For ld_optimise_options: how many candidates are done.
void progress_candidates(void *self, const ld_optimise_counts *counts);

// Takes the line away.
void progress_end(run_progress *progress);

// The signal that asked for a stop, 0 if none did.
int progress_signal(void);

#endif
