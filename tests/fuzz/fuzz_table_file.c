// Any text, read as a RASP .eng file and as each of the tables that may lie in a CSV file, ends
// with messages or with a model that holds what model_checks.h says.
#include <stdint.h>

#include "fuzz/true_scenarios.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static const struct {
    int scenario;
    const char *name, *set;
} tables[] = {
    {TRUE_FIXED, "table.eng", "rocket.motor.thrust=%s"},
    {TRUE_FIXED, "table.csv", "base={kind: prescribed, motion: {table: %s}}"},
    {TRUE_VEHICLE, "table.csv", "base.road={table: %s}"},
    {TRUE_VEHICLE, "table.csv", "platform.azimuth.stabiliser.command=%s"},
    {TRUE_FLIGHT, "table.csv", "environment.wind={profile: %s}"},
    {TRUE_FLIGHT, "table.csv", "rocket.aerodynamics.table=%s"},
};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    write_in_memory("table.eng", data, size);
    write_in_memory("table.csv", data, size);
    for (size_t i = 0; i < sizeof tables / sizeof *tables; i++) {
        char text[256];
        const char *set = text;
        ld_model model;
        snprintf(text, sizeof text, tables[i].set, in_memory(tables[i].name));
        if (read_with_sets(tables[i].scenario, &set, 1, &model))
            continue;
        check_model(&model);
        model_clear(&model);
    }
    return 0;
}
