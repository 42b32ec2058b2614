// Any bytes, read as a mesh of a body, end with messages or with a model that holds what
// model_checks.h says. Inputs that begin with 'j' are the JSON and, after a zero byte, the numbers
// of a file whose frame is right.
#include <stdint.h>

#include "fuzz/true_scenarios.h"
#include "support/glb_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void write_input(const uint8_t *data, size_t size)
{
    if (size == 0 || data[0] != 'j') {
        write_in_memory("mesh.glb", data, size);
        return;
    }
    const uint8_t *json = data + 1, *end = memchr(json, '\0', size - 1);
    size_t text = end ? (size_t)(end - json) : size - 1, length;
    size_t bytes = end ? size - 2 - text : 0;
    uint8_t *file = glb_file(json, text, end ? end + 1 : NULL, bytes, &length);
    write_in_memory("mesh.glb", file, length);
    free(file);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char text[512];
    const char *const sets[] = {text, "tubes.on=mount"};
    ld_model model;
    write_input(data, size);
    snprintf(text, sizeof text,
             "base={kind: multibody, bodies: [{name: mount, mass: 1 kg, inertia: 1 1 1 kg.m2, "
             "looks: {shape: mesh, mesh: %s}}], joints: [{name: root, kind: fixed, parent: "
             "ground, body: mount}]}",
             in_memory("mesh.glb"));
    if (read_with_sets(TRUE_FIXED, sets, 2, &model))
        return 0;
    check_model(&model);
    model_clear(&model);
    return 0;
}
