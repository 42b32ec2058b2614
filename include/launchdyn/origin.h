/// Where results come from: the program that computed them, the scenario, every text that it was
/// read from. Results keep it (docs/results.md), so that a run can be repeated from its folder
/// alone.
#ifndef LAUNCHDYN_ORIGIN_H
#define LAUNCHDYN_ORIGIN_H

#include <stdbool.h>
#include <stddef.h>

#include "launchdyn/model.h"
#include "launchdyn/status.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/// Something known of a program: "version", "commit", "compiler", "processor", "HDF5", ...
typedef struct ld_fact {
    char *name;
    char *text; ///< "unknown" where it is not known
} ld_fact;

typedef struct ld_origin {
    size_t fact_count;
    ld_fact *fact;     ///< [fact_count] of the program, version first, the libraries last
    char *scenario;    ///< what was understood, as ld_model_print() prints it
    ld_source *source; ///< NULL: the model was filled by hand
    int point;         ///< of the sweep; 0: the nominal values
    int sample;        ///< of the point, drawn for a study; 0: none
} ld_origin;

/// This program, and a model's scenario.
/// @param origin filled on success (free with ld_origin_free()); it has a share of model->source
/// @return LD_OK, LD_ERR_MEMORY
ld_status ld_origin_of(const ld_model *model, ld_origin *origin, ld_error *error);

/// Reads it back from the run in `folder`: from history.h5, or the history.h5.part of a run that
/// was killed. Its source has no folder: everything must be among its texts.
/// @return LD_OK; LD_ERR_INPUT (no results there, damaged ones, or none that say where they come
///         from), LD_ERR_MEMORY
ld_status ld_origin_read(const char *folder, ld_origin *origin, ld_error *error);

/// Says in what of version, commit, compiler, processor and libraries this program is another one
/// than that of the results, "version 0.1.0, here 0.2.0; ..."; what is too long is cut.
/// @return whether there is any difference
bool ld_origin_differs(const ld_origin *origin, char *text, size_t size);

void ld_origin_free(ld_origin *origin);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
