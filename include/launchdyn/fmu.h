/// Functional Mock-up Units: a launcher for other people's simulators.
#ifndef LAUNCHDYN_FMU_H
#define LAUNCHDYN_FMU_H

#include "launchdyn/model.h"
#include "launchdyn/status.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/// Writes an FMU of the launch for co-simulation (docs/fmi.md), under a temporary name that then
/// becomes its own.
/// @param version of FMI: 2 (2.0) or 3 (3.0)
/// @return LD_OK; LD_ERR_INPUT (another version, a flight alone), what ld_run_begin() returns where
///         no run of it begins, LD_ERR_FILE, LD_ERR_MEMORY, LD_ERR_MISSING (built without)
ld_status ld_fmu_export(const ld_model *model, int version, const char *file, ld_error *error);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
