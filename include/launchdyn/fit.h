/// Fitting: keys of a scenario, between bounds, at which its launches have the results that were
/// measured, with their uncertainties (docs/fit.md).
#ifndef LAUNCHDYN_FIT_H
#define LAUNCHDYN_FIT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "launchdyn/model.h"
#include "launchdyn/status.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/// A key that is fitted; numbers as texts with units, as of --set.
typedef struct ld_fit_key {
    const char *path;             ///< of any number of the scenario but whole ones
    const char *from, *to;        ///< bounds
    const char *mean, *deviation; ///< what was known of it before; both NULL: nothing
} ld_fit_key;

typedef struct ld_fit ld_fit;

/// Reads measured launches and what is to be fitted to them.
/// @param model of one launch, which must outlive the fit
/// @param files CSV files of measured launches, one a row; none where logs are added
/// @param fit   filled on success (free with ld_fit_free())
/// @return LD_OK, LD_ERR_INPUT (no such key, bounds in the wrong order, wrong measured launches),
///         LD_ERR_FILE, LD_ERR_MEMORY
ld_status ld_fit_create(const ld_model *model, const ld_fit_key *keys, size_t key_count,
                        const char *const *files, size_t file_count, ld_fit **fit, ld_error *error);
void ld_fit_free(ld_fit *fit);

/// Adds logs of the scenario's launch, as of ld_compare(): series of sensors, at the instants and
/// in the windows that their descriptions state, and results with their uncertainties. What is not
/// known of clocks and sensors becomes keys of the fit. Runs the scenario once. To be called once.
/// @param sensors of each log its description; NULL, or NULL of a log: the file beside it
/// @return LD_OK, LD_ERR_INPUT (no such column, no noise, no sample in a window, too many), what
/// the
///         run returned, LD_ERR_FILE, LD_ERR_MEMORY
ld_status ld_fit_add_logs(ld_fit *fit, const char *const *logs, const char *const *sensors,
                          size_t count, ld_error *error);

/// How far a fit is.
typedef struct ld_fit_counts {
    int64_t launches;  ///< simulated, those of earlier runs of the same fit included
    double chi2;       ///< the least found so far; NaN: none
    const char *stage; ///< "start 2 of 4", "covariance", "interval of rocket.mass"
} ld_fit_counts;

/// What the caller requires; every member may be NULL or 0.
typedef struct ld_fit_options {
    const char *folder; ///< for fit.json, fitted.yaml and the state by which a fit that was stopped
                        ///< continues; NULL: nothing is written
    int threads;        ///< launches that run side by side; 0: one
    int starts;         ///< of the search: the scenario's values, then random ones; 0: four
    int64_t seed;       ///< of the random starts
    void *self;
    /// Called after launches, never twice at once.
    void (*progress)(void *self, const ld_fit_counts *counts);
    /// Called often, from all threads at once; false stops the fit, which keeps what it has.
    bool (*go_on)(void *self);
    const void *reserved[4]; ///< NULL: room for what later versions may be asked
} ld_fit_options;

/// Fits. Results are the same to the bit for any number of threads and any interruption.
/// @return LD_OK; LD_ERR_INPUT (more keys than results, a key without effect; the folder holds
/// another fit, or another
///         program works on it), LD_ERR_LAUNCH (no launch at any start), LD_ERR_FILE,
///         LD_ERR_MEMORY, LD_ERR_INTERRUPTED
ld_status ld_fit_run(ld_fit *fit, const ld_fit_options *options, ld_error *error);

/// Prints what was fitted: a table, or all of it as JSON in full precision (docs/fit.md). Not
/// before ld_fit_run() has returned LD_OK.
void ld_fit_print(const ld_fit *fit, FILE *stream);
void ld_fit_print_json(const ld_fit *fit, FILE *stream);

/// Draws measured and fitted series with their differences, differences of results, and how chi2
/// rises along each key; the ending of the file says the format (as ld_plot()).
/// @return LD_OK, LD_ERR_INPUT (unknown ending, the fit has not run), LD_ERR_MISSING (gnuplot),
///         LD_ERR_FILE, LD_ERR_MEMORY
ld_status ld_fit_draw(const ld_fit *fit, const char *file, ld_error *error);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
