#include "figures/glb.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory_stream.h"
#include "math/functions.h"
#include "results/json_text.h"

enum { FLOAT = 5126, UNSIGNED = 5125, CORNERS = 34962, INDICES = 34963 };

static const double PI = 3.14159265358979323846;

// Room for `count` more of elements of `size` bytes behind the `used` ones; NULL: no memory.
static void *grown(void *array, size_t size, size_t used, size_t count, size_t *room)
{
    if (used + count <= *room)
        return array;
    size_t wanted = 2 * (used + count) + 64;
    void *larger = realloc(array, wanted * size);
    if (larger)
        *room = wanted;
    return larger;
}

// ---- shapes ----

uint32_t glb_corner(glb_shape *shape, double x, double y, double z)
{
    float *corner =
        grown(shape->corner, 3 * sizeof *corner, shape->corners, 1, &shape->corner_room);
    shape->failed = shape->failed || !corner;
    if (!corner)
        return 0;
    shape->corner = corner;
    corner += 3 * shape->corners;
    corner[0] = (float)x;
    corner[1] = (float)y;
    corner[2] = (float)z;
    return (uint32_t)shape->corners++;
}

void glb_triangle(glb_shape *shape, uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t *index = grown(shape->index, sizeof *index, shape->indices, 3, &shape->index_room);
    shape->failed = shape->failed || !index;
    if (!index)
        return;
    shape->index = index;
    index += shape->indices;
    index[0] = a;
    index[1] = b;
    index[2] = c;
    shape->indices += 3;
}

void glb_box(glb_shape *shape, const double low[3], const double high[3])
{
    static const unsigned char face[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                             {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    uint32_t at[8];
    for (unsigned i = 0; i < 8; i++)
        at[i] = glb_corner(shape, i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1],
                           i & 4 ? high[2] : low[2]);
    for (int i = 0; i < 6; i++) {
        glb_triangle(shape, at[face[i][0]], at[face[i][1]], at[face[i][2]]);
        glb_triangle(shape, at[face[i][0]], at[face[i][2]], at[face[i][3]]);
    }
}

// Four sides are a rectangle of these half sizes.
uint32_t glb_ring(glb_shape *shape, double x, const double radius[2], int sides)
{
    double turn = sides == 4 ? PI / 4 : 0, wider = sides == 4 ? sqrt(2) : 1;
    uint32_t first = (uint32_t)shape->corners;
    for (int i = 0; i < sides; i++) {
        double angle = turn + 2 * PI * i / sides;
        glb_corner(shape, x, wider * radius[0] * cos(angle), wider * radius[1] * sin(angle));
    }
    return first;
}

void glb_between(glb_shape *shape, uint32_t first, uint32_t second, int sides)
{
    for (uint32_t i = 0; i < (uint32_t)sides; i++) {
        uint32_t next = (i + 1) % (uint32_t)sides;
        glb_triangle(shape, first + i, first + next, second + next);
        glb_triangle(shape, first + i, second + next, second + i);
    }
}

void glb_lathe(glb_shape *shape, const double (*point)[2], size_t points, int sides)
{
    uint32_t before = 0;
    for (size_t i = 0; i < points + 2; i++) {
        bool end = i == 0 || i == points + 1;
        const double *at = point[i == 0 ? 0 : i > points ? points - 1 : i - 1];
        double radius = end ? 0 : at[1];
        uint32_t ring = glb_ring(shape, at[0], (double[]){radius, radius}, sides);
        if (i > 0)
            glb_between(shape, before, ring, sides);
        before = ring;
    }
}

void glb_shape_free(glb_shape *shape)
{
    free(shape->corner);
    free(shape->index);
    *shape = (glb_shape){0};
}

// ---- the file ----

void glb_begin(glb *self)
{
    *self = (glb){0};
    for (int i = 0; i < GLB_LISTS; i++) {
        self->list[i] = memory_stream(&self->text[i], &self->length[i]);
        self->failed = self->failed || !self->list[i];
    }
}

// Where the next element of a list is written; NULL: no memory.
static FILE *next_of(glb *self, glb_list list)
{
    FILE *to = self->failed ? NULL : self->list[list];
    if (to && self->count[list]++)
        fputc(',', to);
    return to;
}

static void write_extremes(FILE *to, const float *value, size_t count, int columns)
{
    for (int side = 0; side < 2; side++) {
        fputs(side ? "],\"max\":[" : ",\"min\":[", to);
        for (int k = 0; k < columns; k++) {
            float most = value[k];
            for (size_t i = 1; i < count; i++) {
                float v = value[i * (size_t)columns + (size_t)k];
                most = (side ? v > most : v < most) ? v : most;
            }
            fprintf(to, "%s%.9g", k ? "," : "", (double)most);
        }
    }
    fputc(']', to);
}

// Takes numbers of four bytes each; the accessor. `target`: what a renderer does with them, 0:
// none.
static int add(glb *self, const void *value, size_t count, int columns, int target)
{
    static const char *const types[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    size_t words = count * (size_t)columns;
    uint32_t *word = grown(self->word, sizeof *word, self->words, words, &self->room);
    self->word = word ? word : self->word;
    self->failed = self->failed || !word;
    FILE *view = next_of(self, GLB_VIEWS), *accessor = next_of(self, GLB_ACCESSORS);
    if (!view || !accessor)
        return 0;
    memcpy(word + self->words, value, words * sizeof *word);
    fprintf(view, "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu", 4 * self->words,
            4 * words);
    if (target)
        fprintf(view, ",\"target\":%d", target);
    fputc('}', view);
    self->words += words;
    fprintf(accessor, "{\"bufferView\":%d,\"componentType\":%d,\"count\":%zu,\"type\":\"%s\"",
            self->count[GLB_VIEWS] - 1, target == INDICES ? UNSIGNED : FLOAT, count,
            types[columns]);
    if (target != INDICES)
        write_extremes(accessor, value, count, columns);
    fputc('}', accessor);
    return self->count[GLB_ACCESSORS] - 1;
}

int glb_keys(glb *self, const float *value, size_t count, int columns)
{
    return add(self, value, count, columns, 0);
}

// What screens show is not linear in the light; glTF has the light.
static double light(unsigned byte)
{
    double v = byte / 255.0;
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

int glb_mesh(glb *self, const glb_shape *shape, unsigned colour, const float *displaced,
             int targets)
{
    self->failed = self->failed || shape->failed || shape->indices == 0;
    if (self->failed)
        return 0;
    int corners = add(self, shape->corner, shape->corners, 3, CORNERS),
        indices = add(self, shape->index, shape->indices, 1, INDICES),
        first = self->count[GLB_ACCESSORS];
    for (int i = 0; i < targets; i++)
        add(self, displaced + (size_t)i * 3 * shape->corners, shape->corners, 3, CORNERS);
    FILE *material = next_of(self, GLB_MATERIALS), *mesh = next_of(self, GLB_MESHES);
    if (!material || !mesh)
        return 0;
    fprintf(material,
            "{\"doubleSided\":true,\"pbrMetallicRoughness\":{\"baseColorFactor\":[%.4f,%.4f,%.4f,1]"
            ",\"metallicFactor\":0.1,\"roughnessFactor\":0.7}}",
            light(colour >> 16 & 255), light(colour >> 8 & 255), light(colour & 255));
    fprintf(mesh,
            "{\"primitives\":[{\"attributes\":{\"POSITION\":%d},\"indices\":%d,\"material\":%d",
            corners, indices, self->count[GLB_MATERIALS] - 1);
    for (int i = 0; i < targets; i++)
        fprintf(mesh, "%s{\"POSITION\":%d}", i ? "," : ",\"targets\":[", first + i);
    fputs(targets ? "]}],\"weights\":[0" : "}]", mesh);
    for (int i = 1; i < targets; i++)
        fputs(",0", mesh);
    fputs(targets ? "]}" : "}", mesh);
    return self->count[GLB_MESHES] - 1;
}

int glb_add_node(glb *self, const char *name, int parent, int mesh)
{
    glb_node *node = realloc(self->node, (size_t)(self->nodes + 1) * sizeof *node);
    self->failed = self->failed || !node;
    if (!node)
        return 0;
    self->node = node;
    node[self->nodes] = (glb_node){.parent = parent, .mesh = mesh};
    snprintf(node[self->nodes].name, GLB_NAME, "%s", name);
    return self->nodes++;
}

static void move(glb *self, const char *target, const int sampled[2], const char *between)
{
    FILE *sampler = next_of(self, GLB_SAMPLERS), *channel = next_of(self, GLB_CHANNELS);
    if (!sampler || !channel)
        return;
    fprintf(sampler, "{\"input\":%d,\"output\":%d,\"interpolation\":\"%s\"}", sampled[0],
            sampled[1], between);
    fprintf(channel, "{\"sampler\":%d,\"target\":%s}", self->count[GLB_SAMPLERS] - 1, target);
}

void glb_move(glb *self, int node, const char *path, int times, int values)
{
    char target[64];
    snprintf(target, sizeof target, "{\"node\":%d,\"path\":\"%s\"}", node, path);
    move(self, target, (int[]){times, values}, "LINEAR");
}

void glb_step(glb *self, int node, const char *path, int times, int values)
{
    char target[64];
    snprintf(target, sizeof target, "{\"node\":%d,\"path\":\"%s\"}", node, path);
    move(self, target, (int[]){times, values}, "STEP");
}

static void write_children(FILE *json, const glb *self, int parent, const char *before)
{
    bool none = true;
    for (int i = 0; i < self->nodes; i++)
        if (self->node[i].parent == parent) {
            fprintf(json, "%s%d", none ? before : ",", i);
            none = false;
        }
    if (!none)
        fputc(']', json);
}

static void write_nodes(FILE *json, const glb *self)
{
    fputs(",\"nodes\":[", json);
    for (int i = 0; i < self->nodes; i++) {
        const glb_node *node = &self->node[i];
        fputs(i ? ",{\"name\":" : "{\"name\":", json);
        json_write_text(json, node->name);
        if (node->mesh >= 0)
            fprintf(json, ",\"mesh\":%d", node->mesh);
        if (node->at[0] != 0 || node->at[1] != 0 || node->at[2] != 0)
            fprintf(json, ",\"translation\":[%.9g,%.9g,%.9g]", (double)node->at[0],
                    (double)node->at[1], (double)node->at[2]);
        write_children(json, self, i, ",\"children\":[");
        fputc('}', json);
    }
    fputc(']', json);
}

static void write_json(FILE *json, const glb *self, const char *extras)
{
    static const char *const lists[] = {[GLB_VIEWS] = "bufferViews",
                                        [GLB_ACCESSORS] = "accessors",
                                        [GLB_MESHES] = "meshes",
                                        [GLB_MATERIALS] = "materials"};
    fprintf(json,
            "{\"asset\":{\"version\":\"2.0\",\"generator\":\"launchdyn %s\"},\"scene\":0,"
            "\"scenes\":[{\"extras\":%s",
            LD_VERSION, extras);
    write_children(json, self, -1, ",\"nodes\":[");
    fputs("}]", json);
    write_nodes(json, self);
    for (int i = 0; i <= GLB_MATERIALS; i++)
        fprintf(json, ",\"%s\":[%s]", lists[i], self->text[i]);
    fprintf(json, ",\"animations\":[{\"name\":\"launch\",\"samplers\":[%s],\"channels\":[%s]}]",
            self->text[GLB_SAMPLERS], self->text[GLB_CHANNELS]);
    fprintf(json, ",\"buffers\":[{\"byteLength\":%zu}]}", 4 * self->words);
}

// A chunk of whole words, filled with blanks; little-endian, as the machines we build for.
static void write_chunk(FILE *file, const char kind[4], const void *bytes, size_t length)
{
    uint32_t padded = (uint32_t)(length + 3) / 4 * 4;
    fwrite(&padded, 4, 1, file);
    fwrite(kind, 4, 1, file);
    fwrite(bytes, 1, length, file);
    for (size_t i = length; i < padded; i++)
        fputc(' ', file);
}

static bool write_file(const glb *self, const char *extras, FILE *file)
{
    char *text = NULL;
    size_t length = 0;
    FILE *json = memory_stream(&text, &length);
    if (!json)
        return false;
    write_json(json, self, extras);
    if (fclose(json) != 0)
        return false;
    uint32_t head[2] = {2, (uint32_t)(12 + 16 + (length + 3) / 4 * 4 + 4 * self->words)};
    fwrite("glTF", 4, 1, file);
    fwrite(head, 4, 2, file);
    write_chunk(file, "JSON", text, length);
    write_chunk(file, "BIN", self->word, 4 * self->words); // the text's zero is its fourth byte
    free(text);
    return true;
}

ld_status glb_write(glb *self, const char *extras, FILE *file, ld_error *error)
{
    bool fine = true;
    for (int i = 0; i < GLB_LISTS; i++)
        fine = self->list[i] && fclose(self->list[i]) == 0 && fine;
    fine = fine && !self->failed && write_file(self, extras, file);
    for (int i = 0; i < GLB_LISTS; i++)
        free(self->text[i]);
    free(self->word);
    free(self->node);
    return fine ? LD_OK : ld_fail(error, LD_ERR_MEMORY, "no memory for the scene");
}
