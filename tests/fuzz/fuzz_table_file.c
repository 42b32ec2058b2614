// Any text, read as a RASP .eng file, a sounding or one of the tables that may lie in a CSV file,
// ends with messages or with a model that holds what model_checks.h says. The first byte chooses
// the table.
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
    {TRUE_FLIGHT, "table.csv", "environment.atmosphere={profile: %s}"},
    {TRUE_FLIGHT, "table.txt", "environment.atmosphere={profile: %s}"},
    {TRUE_FIXED, "table.rse", "rocket.motor.thrust=%s"},
    {TRUE_FIXED, "table.rse", "rocket.motor.masses=%s"},
    {TRUE_FIXED, "table.csv", "rocket.air_brakes={over_height: %s}"},
};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char text[256];
    const char *set = text;
    ld_model model;
    if (size < 1)
        return 0;
    size_t chosen = (uint8_t)(data[0] - '0') % (sizeof tables / sizeof *tables); // '0': the first
    write_in_memory(tables[chosen].name, data + 1, size - 1);
    snprintf(text, sizeof text, tables[chosen].set, in_memory(tables[chosen].name));
    if (read_with_sets(tables[chosen].scenario, &set, 1, &model))
        return 0;
    check_model(&model);
    model_clear(&model);
    return 0;
}
