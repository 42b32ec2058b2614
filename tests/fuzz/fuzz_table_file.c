// Any text, read as a RASP .eng file and as a motion and a road in CSV, ends with messages or with
// a table.
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <unistd.h>

#include "scenario/scenario.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static const char scenario[] =
    "launchdyn: 1\nbase: {kind: fixed}\ntubes:\n  length: 3 m\n"
    "  sections: [{from: 0 m, inner_radius: 80 mm, outer_radius: 85 mm}]\n"
    "  material: {youngs_modulus: 210 GPa, poisson_ratio: 0.3, density: 7850 kg/m3}\n"
    "  supports: [{at: 1 m, stiffness: 1 1 1 N/m, rotational_stiffness: 1 1 1 N.m/rad}]\n"
    "  slot: none\nrocket:\n  mass: 60 kg\n  center: 1 0 0 m\n  inertia: 1 24 24 kg.m2\n"
    "  empty: {mass: 40 kg, center: 1 0 0 m, inertia: 1 18 18 kg.m2}\n"
    "  adaptors: [{name: a, at: 0 m, clearance: 1 mm}, {name: b, at: 1 m, clearance: 1 mm}]\n"
    "  contact: {stiffness: 5e7 N/m}\n  lock: none\n"
    "  motor: {thrust: [[0 s, 1 N], [1 s, 0 N]]}\n";

static void read_with(const char *set)
{
    ld_model model;
    ld_messages messages;
    ld_status status =
        scenario_read_text(scenario, sizeof scenario - 1, "fuzz", "", &set, 1, &model, &messages);
    if ((status == LD_OK) != (messages.count == 0) || status == LD_ERR_MEMORY)
        abort();
    if (status == LD_OK)
        model_clear(&model);
    ld_messages_free(&messages);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const struct {
        const char *set, *ending;
    } tables[] = {{"rocket.motor.thrust=%s", "eng"},
                  {"base={kind: prescribed, motion: {table: %s}}", "csv"},
                  {"base={kind: vehicle, road: {table: %s}}", "csv"}};
    char name[64], set[160];
    for (int i = 0; i < 3; i++) {
        snprintf(name, sizeof name, "/tmp/launchdyn-fuzz-%ld.%s", (long)getpid(), tables[i].ending);
        FILE *stream = fopen(name, "wb");
        if (!stream || fwrite(data, 1, size, stream) != size || fclose(stream) != 0)
            abort();
        snprintf(set, sizeof set, tables[i].set, name);
        read_with(set);
        unlink(name);
    }
    return 0;
}
