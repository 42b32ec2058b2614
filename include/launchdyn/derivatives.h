/// Derivatives of a launch's results by keys of its scenario (docs/response.md).
#ifndef LAUNCHDYN_DERIVATIVES_H
#define LAUNCHDYN_DERIVATIVES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "launchdyn/model.h"
#include "launchdyn/status.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/// A key, and how far it is changed to either side; a number with a unit as of --set. NULL: by
/// 1e-4 of its value.
typedef struct ld_derivative_key {
    const char *path; ///< of any number of the scenario but whole ones
    const char *step;
} ld_derivative_key;

typedef struct ld_derivatives ld_derivatives;

/// What the caller requires; every member may be NULL or 0.
typedef struct ld_derivative_options {
    int threads; ///< launches that run side by side; 0: one
    void *self;
    /// Called after launches, never twice at once; `of`: how many there are.
    void (*progress)(void *self, int launches, int of);
    /// Called often, from all threads at once; false stops.
    bool (*go_on)(void *self);
    const void *reserved[4]; ///< NULL: room for what later versions may be asked
} ld_derivative_options;

/// Runs the launch, then two for each key, one on either side, by the steps of the first, so that
/// results change as smoothly as the equations let them, and takes central differences.
/// @param model of one launch, which must outlive the derivatives
/// @param out   free with ld_derivatives_free()
/// @return LD_OK; LD_ERR_INPUT (no such key, a step that leaves its range or is missing at 0, more
///         than one rocket, run.coupling); LD_ERR_LAUNCH and what else ends a run;
///         LD_ERR_MISSING (a thread cannot be started); LD_ERR_INTERRUPTED; LD_ERR_MEMORY
ld_status ld_derivatives_find(const ld_model *model, const ld_derivative_key *keys, size_t count,
                              const ld_derivative_options *options, ld_derivatives **out,
                              ld_error *error);
void ld_derivatives_free(ld_derivatives *self);

/// What is known of one derivative, in SI units.
typedef struct ld_derivative {
    double value;      ///< of the result
    double derivative; ///< of the result by the key; NaN: the launches beside it had no such result
    double left, right; ///< the differences on either side, whose distance tells of curvature, and
                        ///< of a strike that only one side has
    bool same_events;   ///< both sides had the events of the launch, in their order
} ld_derivative;

/// That of a result by key `key`, from 0 in their order.
/// @return LD_OK, LD_ERR_INPUT (no such result or key)
ld_status ld_derivatives_get(const ld_derivatives *self, const char *result, size_t key,
                             ld_derivative *value, ld_error *error);

/// Prints a table a key, or all as JSON in full precision.
/// @param results their names with commas between; NULL: the usual ones
/// @return LD_OK, LD_ERR_INPUT (no such result)
ld_status ld_derivatives_print(const ld_derivatives *self, const char *results, FILE *stream,
                               ld_error *error);
ld_status ld_derivatives_print_json(const ld_derivatives *self, const char *results, FILE *stream,
                                    ld_error *error);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
