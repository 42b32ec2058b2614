#include "scenario/foreign_tables.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/base64.h"
#include "math/vectors/quaternion.h"
#include "model/blocks/mechanism.h"

enum { HEAD = 12, CHUNK_HEAD = 8, MOST_ITEMS = 4096, MOST_DEPTH = 32, TRIANGLES = 4 };
enum { OF_BYTES = 5121, OF_SHORTS = 5123, OF_INTEGERS = 5125, OF_FLOATS = 5126 };
static const unsigned JSON_CHUNK = 0x4E4F534A, BINARY_CHUNK = 0x004E4942;
static const double FARTHEST = 1e6; // a coordinate

typedef struct mesh_reader {
    line_reader *lines;
    ld_table *table;
    const unsigned char *binary;
    size_t length; // of `binary`
    text_source json;
    const tree_node *root;
    int nodes; // placed so far
} mesh_reader;

// At a node of the JSON, or (NULL) of the file as a whole.
static void refuse(mesh_reader *self, const tree_node *at, const char *format, ...) LD_PRINTF(3, 4);
static void refuse(mesh_reader *self, const tree_node *at, const char *format, ...)
{
    char text[256];
    va_list arguments;
    line_reader *lines = self->lines;
    if (lines->failed)
        return;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    reader_refuse(lines->reader, at ? at->at : (text_place){lines->source, 0, 0}, lines->path, "%s",
                  text);
    lines->failed = true;
}

// ---- the file

static unsigned read_unsigned(const unsigned char *at, int bytes)
{
    unsigned value = 0;
    for (int i = bytes - 1; i >= 0; i--)
        value = value << 8 | at[i];
    return value;
}

// The chunk that begins at `at`; false after a message.
static bool take_chunk(mesh_reader *self, const unsigned char *file, size_t length, size_t *at)
{
    size_t room = length - *at;
    unsigned long size = room < CHUNK_HEAD ? 0 : read_unsigned(file + *at, 4);
    if (room < CHUNK_HEAD || size > room - CHUNK_HEAD) {
        refuse(self, NULL, "is cut off within a chunk");
        return false;
    }
    const unsigned char *data = file + *at + CHUNK_HEAD;
    unsigned kind = read_unsigned(data - 4, 4);
    if (kind == JSON_CHUNK && !self->json.text) {
        self->json.text = (const char *)data;
        self->json.length = size;
    } else if (kind == BINARY_CHUNK && !self->binary) {
        self->binary = data;
        self->length = size;
    }
    *at += CHUNK_HEAD + size;
    return true;
}

static bool take_chunks(mesh_reader *self, const unsigned char *file, size_t length)
{
    if (length < HEAD) {
        refuse(self, NULL, "is cut off: found %zu bytes; expected a binary glTF 2 file", length);
        return false;
    }
    unsigned version = read_unsigned(file + 4, 4), whole = read_unsigned(file + 8, 4);
    if (version != 2)
        refuse(self, NULL, "found glTF version %u; expected 2", version);
    else if (whole != length)
        refuse(self, NULL, "found %zu bytes; its head says %u", length, whole);
    size_t at = HEAD;
    while (!self->lines->failed && at < length && take_chunk(self, file, length, &at))
        ;
    if (!self->json.text)
        refuse(self, NULL, "found no chunk of JSON");
    return !self->lines->failed;
}

// ---- values of the JSON

// A whole number; `otherwise` without one or after a message.
static long whole_in(mesh_reader *self, const tree_node *node, const char *what, long otherwise)
{
    const char *reason = NULL, *end = NULL;
    double value = 0;
    if (!node)
        return otherwise;
    if (node->kind == NODE_SCALAR)
        end = number_parse(node->text, &value, &reason);
    if (end && *end == '\0' && value >= 0 && value <= INT_MAX && value == floor(value))
        return (long)value;
    refuse(self, node, "%s: expected a whole number >= 0", what);
    return otherwise;
}

static long whole_of(mesh_reader *self, const tree_node *map, const char *key, long otherwise)
{
    return whole_in(self, tree_member(map, key), key, otherwise);
}

// Some numbers; what is not there leaves them as they are.
static void numbers_of(mesh_reader *self, const tree_node *map, const char *key, double *to,
                       int count)
{
    const tree_node *node = tree_member(map, key);
    const char *reason;
    bool fine = !node || (node->kind == NODE_LIST && node->count == count);
    for (const tree_node *one = node ? node->first : NULL; fine && one; one = one->next, to++) {
        const char *end = one->kind == NODE_SCALAR ? number_parse(one->text, to, &reason) : NULL;
        fine = end && *end == '\0' && fabs(*to) <= FARTHEST;
    }
    if (!fine)
        refuse(self, node, "%s: expected a list of %d numbers from -%g to %g", key, count, FARTHEST,
               FARTHEST);
}

// The entry of a list at the root that `by` names; NULL after a message.
static const tree_node *item_of(mesh_reader *self, const char *list, long number,
                                const tree_node *by)
{
    const tree_node *all = tree_member(self->root, list);
    bool given = all && all->kind == NODE_LIST && all->count <= MOST_ITEMS;
    const tree_node *one = given ? all->first : NULL;
    for (long i = 0; one && i < number; i++)
        one = one->next;
    if (one && one->kind == NODE_MAP)
        return one;
    refuse(self, by, "%s[%ld] is not there, or there are more than %d", list, number, MOST_ITEMS);
    return NULL;
}

// ---- numbers of the binary chunk

typedef struct mesh_view {
    const unsigned char *at;
    size_t count, stride;
    int width; // [byte] of one number
} mesh_view;

// Bytes of a number; 0: it is of a kind that is not allowed.
static int width_of(long component, bool indices)
{
    if (!indices)
        return component == OF_FLOATS ? 4 : 0;
    return component == OF_BYTES      ? 1
           : component == OF_SHORTS   ? 2
           : component == OF_INTEGERS ? 4
                                      : 0;
}

// Where the numbers of an accessor stand; false after a message.
static bool place_view(mesh_reader *self, const tree_node *accessor, mesh_view *view, size_t size)
{
    const tree_node *part =
        item_of(self, "bufferViews", whole_of(self, accessor, "bufferView", 0), accessor);
    if (!part)
        return false;
    size_t from = (size_t)whole_of(self, accessor, "byteOffset", 0);
    size_t begin = (size_t)whole_of(self, part, "byteOffset", 0);
    size_t room = (size_t)whole_of(self, part, "byteLength", 0);
    view->stride = (size_t)whole_of(self, part, "byteStride", (long)size);
    size_t need = (view->count - 1) * view->stride + size;
    if (whole_of(self, part, "buffer", 0) != 0)
        refuse(self, part, "found a second buffer; expected the one in the file");
    else if (view->count == 0 || from + need > room || begin + room > self->length)
        refuse(self, accessor, "the accessor reaches beyond the %zu bytes of the buffer",
               self->length);
    else
        view->at = self->binary + begin + from;
    return !self->lines->failed;
}

static bool find_view(mesh_reader *self, const tree_node *by, long number, bool indices,
                      mesh_view *view)
{
    const char *expected = indices ? "SCALAR" : "VEC3";
    const tree_node *accessor = item_of(self, "accessors", number, by);
    if (!accessor)
        return false;
    const tree_node *type = tree_member(accessor, "type");
    view->width = width_of(whole_of(self, accessor, "componentType", 0), indices);
    view->count = (size_t)whole_of(self, accessor, "count", 0);
    if (tree_member(accessor, "sparse") || !tree_member(accessor, "bufferView"))
        refuse(self, accessor, "found a sparse accessor; expected one with a bufferView alone");
    else if (!type || type->kind != NODE_SCALAR || strcmp(type->text, expected) != 0 ||
             view->width == 0)
        refuse(self, accessor, "accessors[%ld]: expected type %s of %s", number, expected,
               indices ? "whole numbers without sign" : "floats");
    else
        return place_view(self, accessor, view, (size_t)view->width * (indices ? 1 : 3));
    return false;
}

// ---- triangles

// From the axes of a node to those of the scene.
typedef struct placement {
    m3 A;
    v3 r;
} placement;

// One corner; false after a message.
static bool read_corner(mesh_reader *self, const mesh_view *view, size_t number,
                        const placement *place, double *to)
{
    v3 local;
    double *number_of[3] = {&local.x, &local.y, &local.z};
    for (int i = 0; i < 3; i++) {
        unsigned bits = read_unsigned(view->at + number * view->stride + 4 * i, 4);
        float value;
        memcpy(&value, &bits, sizeof value);
        *number_of[i] = value;
    }
    v3 r = v3_add(place->r, m3_apply(place->A, local));
    bool fine =
        fabs(r.x) <= FARTHEST && fabs(r.y) <= FARTHEST && fabs(r.z) <= FARTHEST; // no NaN either
    if (!fine)
        refuse(self, NULL, "found a corner that is not within %g of the origin", FARTHEST);
    v3_store(to, r);
    return fine;
}

// Corners are those of `of`, by their numbers in `index`, where it has any.
static void read_triangles(mesh_reader *self, const mesh_view *of, const mesh_view *index,
                           const placement *place, const double *colour)
{
    double row[LD_MESH_COLUMNS];
    size_t count = index->width ? index->count : of->count;
    memcpy(row + 9, colour, 3 * sizeof *row);
    for (size_t k = 0; k < count; k++) {
        size_t corner =
            index->width ? read_unsigned(index->at + k * index->stride, index->width) : k;
        if (corner >= of->count)
            refuse(self, NULL, "found a triangle with corner %zu of %zu", corner, of->count);
        if (self->lines->failed || !read_corner(self, of, corner, place, row + 3 * (k % 3)))
            return;
        if (k % 3 < 2)
            continue;
        if (self->table->rows == LD_MAX_TRIANGLES)
            refuse(self, NULL, "found more than %d triangles", LD_MAX_TRIANGLES);
        else
            line_append(self->lines, self->table, LD_MESH_COLUMNS, row);
    }
}

static void read_colour(mesh_reader *self, const tree_node *primitive, double colour[4])
{
    long number = whole_of(self, primitive, "material", -1);
    const tree_node *material = number < 0 ? NULL : item_of(self, "materials", number, primitive);
    const tree_node *surface = material ? tree_member(material, "pbrMetallicRoughness") : NULL;
    if (surface)
        numbers_of(self, surface, "baseColorFactor", colour, 4);
    for (int i = 0; i < 3; i++)
        if (colour[i] < 0 || colour[i] > 1)
            refuse(self, surface, "baseColorFactor: found %g; expected 0 to 1", colour[i]);
}

static void read_primitive(mesh_reader *self, const tree_node *primitive, const placement *place)
{
    mesh_view corners = {0}, indices = {0};
    double colour[4] = {1, 1, 1, 1};
    const tree_node *attributes = tree_member(primitive, "attributes");
    long position = attributes ? whole_of(self, attributes, "POSITION", -1) : -1;
    long index = whole_of(self, primitive, "indices", -1);
    long mode = whole_of(self, primitive, "mode", TRIANGLES);
    if (mode != TRIANGLES)
        refuse(self, primitive, "found a primitive of mode %ld; expected 4, triangles", mode);
    else if (tree_member(primitive, "targets"))
        refuse(self, primitive, "found morph targets; expected a mesh without them");
    else if (position < 0)
        refuse(self, primitive, "found a primitive without POSITION");
    read_colour(self, primitive, colour);
    if (self->lines->failed || !find_view(self, attributes, position, false, &corners) ||
        (index >= 0 && !find_view(self, primitive, index, true, &indices)))
        return;
    if ((indices.width ? indices.count : corners.count) % 3)
        refuse(self, primitive, "found corners that are not three to a triangle");
    read_triangles(self, &corners, &indices, place, colour);
}

// ---- nodes

static placement place_of(mesh_reader *self, const tree_node *node)
{
    double M[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; // by columns
    double r[3] = {0}, q[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1};        // q: its scalar last
    if (tree_member(node, "matrix")) {
        numbers_of(self, node, "matrix", M, 16);
        return (placement){m3_columns(v3_from(M), v3_from(M + 4), v3_from(M + 8)), v3_from(M + 12)};
    }
    numbers_of(self, node, "translation", r, 3);
    numbers_of(self, node, "rotation", q, 4);
    numbers_of(self, node, "scale", s, 3);
    m3 A = q_matrix(q_from((double[]){q[3], q[0], q[1], q[2]}));
    return (placement){m3_mul(A, m3_diagonal(s[0], s[1], s[2])), v3_from(r)};
}

static void read_mesh(mesh_reader *self, const tree_node *node, const placement *place)
{
    long number = whole_of(self, node, "mesh", -1);
    const tree_node *mesh = number < 0 ? NULL : item_of(self, "meshes", number, node);
    const tree_node *all = mesh ? tree_member(mesh, "primitives") : NULL;
    for (const tree_node *one = all ? all->first : NULL; one && !self->lines->failed;
         one = one->next)
        read_primitive(self, one, place);
}

// Nodes by their numbers in a list, with all below them.
static void read_nodes(mesh_reader *self, const tree_node *list, const placement *above, int depth)
{
    const tree_node *number = list ? list->first : NULL;
    for (; number && !self->lines->failed; number = number->next) {
        const tree_node *node = item_of(self, "nodes", whole_in(self, number, "node", 0), number);
        if (depth > MOST_DEPTH || ++self->nodes > MOST_ITEMS)
            refuse(self, number, "found more than %d nodes, or nodes deeper than %d", MOST_ITEMS,
                   MOST_DEPTH);
        if (!node || self->lines->failed)
            return;
        placement own = place_of(self, node);
        own.r = v3_add(above->r, m3_apply(above->A, own.r));
        own.A = m3_mul(above->A, own.A);
        read_mesh(self, node, &own);
        read_nodes(self, tree_member(node, "children"), &own, depth + 1);
    }
}

// ---- all

// What would be seen otherwise than here.
static void check_root(mesh_reader *self)
{
    static const char *const without[] = {"extensionsRequired", "textures", "images", "animations",
                                          "skins"};
    for (size_t i = 0; i < sizeof without / sizeof *without; i++) {
        const tree_node *one = tree_member(self->root, without[i]);
        if (one)
            refuse(self, one, "found %s; expected nodes, meshes and base colours alone",
                   without[i]);
    }
    const tree_node *buffers = tree_member(self->root, "buffers");
    for (const tree_node *one = buffers ? buffers->first : NULL; one; one = one->next)
        if (tree_member(one, "uri"))
            refuse(self, one, "found a buffer in a file of its own; expected it in the .glb file");
}

static void read_scene(mesh_reader *self)
{
    const placement straight = {m3_identity(), {0, 0, 0}};
    const tree_node *scene =
        item_of(self, "scenes", whole_of(self, self->root, "scene", 0), self->root);
    if (scene)
        read_nodes(self, tree_member(scene, "nodes"), &straight, 1);
    if (self->table->rows == 0)
        refuse(self, NULL, "found no triangle");
}

void mesh_read(line_reader *lines, ld_table *table)
{
    const text_source *kept = lines->source;
    char quoted[64], head[5];
    mesh_reader self = {.lines = lines, .table = table, .json = {.first_line = 1, .json = true}};
    if (kept->length < strlen(MESH_FILE_KEPT) ||
        strncmp(kept->text, MESH_FILE_KEPT, strlen(MESH_FILE_KEPT)) != 0) {
        snprintf(head, sizeof head, "%s", kept->text);
        refuse(&self, NULL, "found %s at its beginning; expected a binary glTF 2 file",
               reader_quote(head, quoted));
        return;
    }
    unsigned char *file = pool_take(lines->reader, base64_room(kept->length));
    if (!file || !take_chunks(&self, file, base64_read(kept->text, kept->length, file)))
        return;
    self.json.name = kept->name;
    self.root = tree_parse(lines->reader, &self.json, self.json.text, self.json.length, 1);
    lines->failed = !self.root;
    if (!self.root)
        return;
    check_root(&self);
    read_scene(&self);
}
