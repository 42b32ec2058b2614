/// Functional Mock-up Units: launchers and vehicles for other people's simulators.
#ifndef LAUNCHDYN_FMU_H
#define LAUNCHDYN_FMU_H

#include <stdbool.h>

#include "launchdyn/model.h"
#include "launchdyn/status.h"

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/// What of a launch an FMU is.
typedef enum ld_fmu_part {
    LD_FMU_ALL,     ///< the launch as the model has it
    LD_FMU_VEHICLE, ///< its vehicle alone, which receives the wrench of the tube
    LD_FMU_LAUNCHER ///< the launcher of its vehicle, which receives its frame
} ld_fmu_part;

/// What is exported. Names in lists are joined by commas, `*` in them stands for any letters.
typedef struct ld_fmu_options {
    ld_fmu_part part;       ///< of an archive vehicle and launcher, whatever this is
    int version;            ///< of FMI: 2 (2.0) or 3 (3.0)
    const char *outputs;    ///< those that it has, "tip.y,summary.*"; NULL: all
    const char *parameters; ///< likewise, by name or key, "rocket.*"; NULL: all
    bool arrays;            ///< vectors are one variable each (FMI 3.0, not in an archive)
    void *reserved[3];
} ld_fmu_options;

/// Writes an FMU (docs/fmi.md), under a temporary name that then becomes its own.
/// @return LD_OK; LD_ERR_INPUT (another version, arrays where there can be none, a flight alone, no
/// such part, output or parameter),
///         what ld_run_begin() or ld_vehicle_run_begin() returns where no run of it begins,
///         LD_ERR_FILE, LD_ERR_MEMORY, LD_ERR_MISSING (built without)
ld_status ld_fmu_export(const ld_model *model, const ld_fmu_options *options, const char *file,
                        ld_error *error);

/// Writes an archive of System Structure and Parameterization 1.0: vehicle and launcher of the
/// model as FMUs, connected with each other. Arguments and what it returns as of ld_fmu_export().
ld_status ld_ssp_export(const ld_model *model, const ld_fmu_options *options, const char *file,
                        ld_error *error);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif

#endif
