/// Optimising: values of keys, between bounds, at which a number of the launches is least under
/// constraints (docs/optimise.md). What is sought stands in the scenario's block `optimise`.
#ifndef LAUNCHDYN_OPTIMISE_H
#define LAUNCHDYN_OPTIMISE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "launchdyn/model.h"
#include "launchdyn/status.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

typedef struct ld_optimisation ld_optimisation;

/// Prepares what the model's block `optimise` asks for.
/// @param model        must outlive the optimisation
/// @param optimisation filled on success (free with ld_optimise_free())
/// @return LD_OK, LD_ERR_INPUT (nothing to optimise, a start outside the bounds, constraints that
///         the method does not take, a deviation of a single value), LD_ERR_MEMORY
ld_status ld_optimise_create(const ld_model *model, ld_optimisation **optimisation,
                             ld_error *error);
void ld_optimise_free(ld_optimisation *optimisation);

/// How far an optimisation is.
typedef struct ld_optimise_counts {
    int64_t launches;  ///< simulated, those of earlier runs of the same one included
    int candidates;    ///< whose launches are all done
    double least;      ///< the least value that meets the constraints, in SI; NaN: none yet
    const char *stage; ///< "start 1 of 2", "other samples"
} ld_optimise_counts;

/// What the caller requires; every member may be NULL or 0.
typedef struct ld_optimise_options {
    const char *folder; ///< for optimise.json, optimised.yaml and the state by which one that was
                        ///< stopped continues; NULL: nothing is written
    int threads;        ///< launches that run side by side; 0: one
    void *self;
    /// Called after launches, never twice at once.
    void (*progress)(void *self, const ld_optimise_counts *counts);
    /// Called often, from all threads at once; false stops, keeping what is done.
    bool (*go_on)(void *self);
    const void *reserved[4]; ///< NULL: room for what later versions may be asked
} ld_optimise_options;

/// Optimises. Results are the same to the bit for any number of threads and any interruption.
/// @return LD_OK; LD_ERR_INPUT (the folder holds another one, or another program works on it),
///         LD_ERR_LAUNCH (no launch at any start), LD_ERR_FILE, LD_ERR_NUMERIC, LD_ERR_MEMORY,
///         LD_ERR_INTERRUPTED
ld_status ld_optimise_run(ld_optimisation *optimisation, const ld_optimise_options *options,
                          ld_error *error);

/// Prints what was found: a table with what was shown and what was not, or all of it as JSON in
/// full precision. Not before ld_optimise_run() has returned LD_OK.
void ld_optimise_print(const ld_optimisation *optimisation, FILE *stream);
void ld_optimise_print_json(const ld_optimisation *optimisation, FILE *stream);

/// Draws its course, candidate by candidate, by gnuplot.
/// @param file ends in .svg, .pdf or .png
/// @return LD_OK, LD_ERR_INPUT, LD_ERR_FILE, LD_ERR_MISSING (no gnuplot), LD_ERR_MEMORY
ld_status ld_optimise_plot(const ld_optimisation *optimisation, const char *file, ld_error *error);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
