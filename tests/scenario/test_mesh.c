// Meshes of binary glTF 2 files: corners through nodes of every kind, indices of every width,
// colours; what is refused.
#include "support/check.h"

#include "model/blocks/mechanism.h"
#include "model/fields/source.h"
#include "model/model.h"
#include "scenario/scenario.h"
#include "support/glb_file.h"
#include "support/scratch.h"

#define EXAMPLE LD_SOURCE_DIR "/examples/multibody/erector.yaml"

static void write_file(const void *bytes, size_t size)
{
    FILE *stream = fopen(in("mesh.glb"), "wb");
    assert_non_null(stream);
    assert_int_equal(fwrite(bytes, 1, size, stream), size);
    assert_int_equal(fclose(stream), 0);
}

// The erector with mesh.glb.
static ld_status read_mesh(ld_model *model, ld_messages *messages)
{
    char set[160];
    const char *const sets[] = {set};
    snprintf(set, sizeof set, "base.bodies.boom.looks.mesh=%s", in("mesh.glb"));
    return scenario_read(EXAMPLE, sets, 1, model, messages);
}

static ld_status read_glb(const char *json, const void *numbers, size_t bytes, ld_model *model,
                          ld_messages *messages)
{
    size_t length;
    uint8_t *file = glb_file(json, strlen(json), numbers, bytes, &length);
    write_file(file, length);
    free(file);
    return read_mesh(model, messages);
}

// Four corners of 12 byte, the same with 4 byte between them, then their numbers in three widths.
typedef struct mesh_numbers {
    float corner[4][3];
    float apart[4][4];
    uint8_t bytes[8];
    uint16_t shorts[4];
    uint32_t integers[3];
} mesh_numbers;

static const mesh_numbers some = {.corner = {{1, 2, 4}, {-3, 5, 0.5f}, {0, -1, 2}, {7, 8, 9}},
                                  .apart = {{1, 2, 4}, {-3, 5, 0.5f}, {0, -1, 2}, {7, 8, 9}},
                                  .bytes = {2, 0, 1, 3, 2, 1},
                                  .shorts = {0, 3, 2},
                                  .integers = {1, 0, 3}};

// A turned, stretched node with a mesh; below it one with a matrix that mirrors x.
static const char *const tree =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":1,\"scenes\":[{},{\"nodes\":[1]}],\"nodes\":["
    "{\"matrix\":[-1,0,0,0, 0,1,0,0, 0,0,1,0, 0.5,0,1,1],\"mesh\":1},"
    "{\"translation\":[1,2,3],\"rotation\":[0,0,0.70710678118654752,0.70710678118654752],"
    "\"scale\":[2,1,1],\"mesh\":0,\"children\":[0]}],\"meshes\":[{\"primitives\":["
    "{\"attributes\":{\"POSITION\":0},\"indices\":2,\"material\":0},"
    "{\"attributes\":{\"POSITION\":1},\"indices\":3,\"mode\":4}]},"
    "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":4,\"material\":1},"
    "{\"attributes\":{\"POSITION\":5}}]}],"
    "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.25,0.5,1,1]}},{}],"
    "\"accessors\":["
    "{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
    "{\"bufferView\":1,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
    "{\"bufferView\":2,\"componentType\":5121,\"count\":6,\"type\":\"SCALAR\"},"
    "{\"bufferView\":3,\"componentType\":5123,\"count\":3,\"type\":\"SCALAR\"},"
    "{\"bufferView\":3,\"byteOffset\":8,\"componentType\":5125,\"count\":3,\"type\":\"SCALAR\"},"
    "{\"bufferView\":0,\"byteOffset\":12,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},"
    "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":64,\"byteStride\":16},"
    "{\"buffer\":0,\"byteOffset\":112,\"byteLength\":8},"
    "{\"buffer\":0,\"byteOffset\":120,\"byteLength\":20}],"
    "\"buffers\":[{\"byteLength\":140}]}";

// A corner of that scene, stretched, turned by 90 deg about z, moved.
static void place_corner(int number, bool below, double to[3])
{
    const float *at = some.corner[number];
    double x = below ? 0.5 - at[0] : at[0], z = below ? at[2] + 1 : at[2];
    to[0] = 1 - at[1];
    to[1] = 2 + 2 * x;
    to[2] = 3 + z;
}

static void test_corners(void **state)
{
    (void)state;
    static const int corner[5][3] = {{2, 0, 1}, {3, 2, 1}, {0, 3, 2}, {1, 0, 3}, {1, 2, 3}};
    static const double colour[5][3] = {
        {0.25, 0.5, 1}, {0.25, 0.5, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}};
    ld_model model;
    ld_messages messages;
    ld_status status = read_glb(tree, &some, sizeof some, &model, &messages);
    ld_messages_print(&messages, stdout);
    assert_int_equal(status, LD_OK);
    const ld_table *mesh = &model.base.mechanism.body[0].appearance.mesh;
    assert_true(mesh->rows == 5 && mesh->columns == LD_MESH_COLUMNS);
    double most = 0, tint = 0;
    for (int i = 0; i < 5; i++)
        for (int k = 0; k < 3; k++) {
            const double *row = mesh->data + (ptrdiff_t)LD_MESH_COLUMNS * i;
            double expected[3];
            place_corner(corner[i][k], i > 2, expected);
            for (int n = 0; n < 3; n++)
                most = fmax(most, fabs(row[3 * k + n] - expected[n]));
            tint = fmax(tint, fabs(row[9 + k] - colour[i][k]));
        }
    CHECK_BELOW("corners of five triangles [m]", most, 1e-15);
    CHECK_BELOW("colours", tint, 0);
    model_clear(&model);
}

// A run keeps the file as text, and reads the same from it where the file is gone.
static void test_kept(void **state)
{
    (void)state;
    ld_model model, again;
    ld_messages messages;
    assert_int_equal(read_glb(tree, &some, sizeof some, &model, &messages), LD_OK);
    ld_source *source = source_copy(model.source);
    free(source->folder);
    source->folder = NULL;
    remove(in("mesh.glb"));
    ld_status status = scenario_read_source(source, 0, &again, &messages);
    ld_messages_print(&messages, stdout);
    assert_int_equal(status, LD_OK);
    const ld_table *a = &model.base.mechanism.body[0].appearance.mesh;
    const ld_table *b = &again.base.mechanism.body[0].appearance.mesh;
    assert_int_equal(a->rows, b->rows);
    assert_memory_equal(a->data, b->data, a->rows * a->columns * sizeof(double));
    model_clear(&model);
    model_clear(&again);
    source_free(source);
}

// ---- what is refused

static void expect_message(ld_status status, ld_messages *messages, const char *text)
{
    assert_int_equal(status, LD_ERR_INPUT);
    assert_int_equal(messages->count, 1);
    printf("    %s\n", messages->item[0].text);
    if (!strstr(messages->item[0].text, text))
        fail_msg("expected \"%s\"", text);
    bool of_json = strncmp(text, "not valid", 9) == 0; // points into it, at no key
    assert_string_equal(messages->item[0].path, of_json ? "" : "base.bodies.boom.looks.mesh");
    ld_messages_free(messages);
}

static void test_no_file(void **state)
{
    (void)state;
    static const struct {
        const char *head;
        size_t size;
        const char *text;
    } cases[] = {
        {"PK\3\4", 4, "found \"PK\3\4\" at its beginning; expected a binary glTF 2 file"},
        {"{}", 2, "found \"{}\" at its beginning"},
        {"", 0, "found \"\" at its beginning"},
        {"glTF\2\0\0\0", 8, "is cut off: found 8 bytes; expected a binary glTF 2 file"},
        {"glTF\1\0\0\0\14\0\0\0", 12, "found glTF version 1; expected 2"},
        {"glTF\2\0\0\0\15\0\0\0", 12, "found 12 bytes; its head says 13"},
        {"glTF\2\0\0\0\14\0\0\0", 12, "found no chunk of JSON"},
        {"glTF\2\0\0\0\17\0\0\0abc", 15, "is cut off within a chunk"},
        {"glTF\2\0\0\0\25\0\0\0\2\0\0\0JSON{", 21, "is cut off within a chunk"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        ld_model model;
        ld_messages messages;
        write_file(cases[i].head, cases[i].size);
        expect_message(read_mesh(&model, &messages), &messages, cases[i].text);
    }
}

// The scene above with one piece of its JSON changed.
static void test_scenes(void **state)
{
    (void)state;
    static const struct {
        const char *from, *to, *text;
    } cases[] = {
        {"\"asset\"", "\"textures\":[{}],\"asset\"", "found textures; expected nodes, meshes and"},
        {"\"asset\"", "\"animations\":[],\"asset\"", "found animations; expected nodes"},
        {"\"asset\"", "\"extensionsRequired\":[\"KHR_draco\"],\"asset\"",
         "found extensionsRequired"},
        {"\"scene\":1", "\"scene\":2", "scenes[2] is not there"},
        {"{\"nodes\":[1]}", "{\"nodes\":[3]}", "nodes[3] is not there"},
        {"{\"nodes\":[1]}", "{}", "found no triangle"},
        {"\"children\":[0]", "\"children\":[1]", "found more than 4096 nodes, or nodes deeper"},
        {"\"children\":[0]", "\"children\":[-1]", "node: expected a whole number >= 0"},
        {"[1,2,3]", "[1,2]", "translation: expected a list of 3 numbers"},
        {"[1,2,3]", "[1,2,3e6]", "translation: expected a list of 3 numbers from -1e+06 to"},
        {"\"mode\":4", "\"mode\":1", "found a primitive of mode 1; expected 4, triangles"},
        {"\"mode\":4", "\"targets\":[]", "found morph targets"},
        {"{\"POSITION\":1}", "{\"NORMAL\":1}", "found a primitive without POSITION"},
        {"0.25,0.5", "0.25,2.5", "baseColorFactor: found 2.5; expected 0 to 1"},
        {"\"material\":1", "\"material\":2", "materials[2] is not there"},
        {"\"count\":4,\"type\":\"VEC3\"", "\"count\":4,\"sparse\":{}", "found a sparse accessor"},
        {"\"count\":4,\"type\":\"VEC3\"", "\"count\":4,\"type\":\"VEC4\"",
         "accessors[0]: expected type VEC3 of floats"},
        {"\"componentType\":5121", "\"componentType\":5120",
         "accessors[2]: expected type SCALAR of whole numbers without sign"},
        {"\"count\":4,\"type\":\"VEC3\"", "\"count\":5,\"type\":\"VEC3\"",
         "the accessor reaches beyond the 140 bytes of the buffer"},
        {"\"count\":6", "\"count\":0", "the accessor reaches beyond the 140 bytes of the buffer"},
        {"\"byteLength\":20", "\"byteLength\":21", "the accessor reaches beyond the 140 bytes"},
        {"\"count\":4,\"type\":\"VEC3\"", "\"count\":2,\"type\":\"VEC3\"",
         "found a triangle with corner 2 of 2"},
        {"\"count\":6", "\"count\":5", "found corners that are not three to a triangle"},
        {"{\"buffer\":0,\"byteLength\":48}", "{\"buffer\":1,\"byteLength\":48}",
         "found a second buffer"},
        {"{\"byteLength\":140}", "{\"uri\":\"a.bin\",\"byteLength\":140}",
         "found a buffer in a file of its own"},
        {"\"scale\":[2,1,1]", "\"scale\":[1e6,1,1]", "found a corner that is not within 1e+06"},
        {"\"rotation\":[0,0,0.70710678118654752,0.70710678118654752]", "\"rotation\":[0,0,0,0]",
         "found a corner that is not within"},
        {"\"scenes\":[", "\"scenes\"[", "not valid JSON"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char json[4096];
        const char *at = strstr(tree, cases[i].from);
        ld_model model;
        ld_messages messages;
        assert_non_null(at);
        snprintf(json, sizeof json, "%.*s%s%s", (int)(at - tree), tree, cases[i].to,
                 at + strlen(cases[i].from));
        ld_status status = read_glb(json, &some, sizeof some, &model, &messages);
        expect_message(status, &messages, cases[i].text);
    }
}

// A fan of so many triangles.
static ld_status read_fan(int triangles, ld_model *model, ld_messages *messages)
{
    char json[512];
    snprintf(json, sizeof json,
             "{\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":"
             "[{\"attributes\":{\"POSITION\":0}}]}],\"accessors\":[{\"bufferView\":0,"
             "\"componentType\":5126,\"count\":%d,\"type\":\"VEC3\"}],\"bufferViews\":[{\"buffer\":"
             "0,\"byteLength\":%d}]}",
             3 * triangles, 36 * triangles);
    float *numbers = calloc((size_t)triangles, 36);
    assert_non_null(numbers);
    ld_status status = read_glb(json, numbers, (size_t)triangles * 36, model, messages);
    free(numbers);
    return status;
}

static void test_most(void **state)
{
    (void)state;
    ld_model model;
    ld_messages messages;
    assert_int_equal(read_fan(LD_MAX_TRIANGLES, &model, &messages), LD_OK);
    assert_int_equal(model.base.mechanism.body[0].appearance.mesh.rows, LD_MAX_TRIANGLES);
    model_clear(&model);
    expect_message(read_fan(LD_MAX_TRIANGLES + 1, &model, &messages), &messages,
                   "found more than 5000 triangles");
    char first[160], second[160];
    const char *const sets[] = {first, second};
    snprintf(first, sizeof first, "base.bodies.boom.looks.mesh=%s", in("mesh.glb"));
    snprintf(second, sizeof second, "base.bodies.rod.looks={shape: mesh, mesh: %s}",
             in("mesh.glb"));
    assert_int_equal(read_fan(2501, &model, &messages), LD_OK);
    model_clear(&model);
    assert_int_equal(scenario_read(EXAMPLE, sets, 2, &model, &messages), LD_ERR_INPUT);
    printf("    %s\n", messages.item[0].text);
    assert_string_equal(messages.item[0].text,
                        "found 5002 triangles in all meshes; expected at most 5000");
    ld_messages_free(&messages);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_corners), cmocka_unit_test(test_kept), cmocka_unit_test(test_no_file),
        cmocka_unit_test(test_scenes),  cmocka_unit_test(test_most),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
