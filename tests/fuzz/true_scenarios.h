// Scenarios that hold, for what is laid over them.
#ifndef LD_TESTS_FUZZ_TRUE_SCENARIOS_H
#define LD_TESTS_FUZZ_TRUE_SCENARIOS_H

#include "fuzz/model_checks.h"

enum { TRUE_FIXED, TRUE_VEHICLE, TRUE_STUDY, TRUE_FLIGHT, TRUE_SCENARIOS };

// Read at its first use.
static inline const ld_model *true_scenario(int which)
{
    static const char *const path[TRUE_SCENARIOS] = {
        LD_SOURCE_DIR "/examples/fixed.yaml", LD_SOURCE_DIR "/tests/fuzz/scenario/vehicle.yaml",
        LD_SOURCE_DIR "/tests/fuzz/scenario/study.yaml", LD_SOURCE_DIR "/examples/flight.yaml"};
    static ld_model model[TRUE_SCENARIOS];
    ld_messages messages;
    if (!model[which].source)
        must(scenario_read(path[which], NULL, 0, &model[which], &messages) == LD_OK);
    return &model[which];
}

// The same overrides as those of its file from the start.
static inline ld_status read_with_sets(int which, const char *const *sets, size_t count,
                                       ld_model *model)
{
    ld_messages messages;
    const ld_source_file *file = true_scenario(which)->source->file[0];
    ld_status status = scenario_read_text(file->text, file->length, file->name,
                                          LD_SOURCE_DIR "/examples", sets, count, model, &messages);
    check_reading(status, &messages);
    return status;
}

#endif
