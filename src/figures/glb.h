// Animated scenes as binary glTF 2.0 files (ISO/IEC 12113): metres, y upwards, as our own axes.
#ifndef LD_FIGURES_GLB_H
#define LD_FIGURES_GLB_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "launchdyn/status.h"
#include "launchdyn/version.h"

typedef enum glb_list {
    GLB_VIEWS,
    GLB_ACCESSORS,
    GLB_MESHES,
    GLB_MATERIALS,
    GLB_SAMPLERS,
    GLB_CHANNELS,
    GLB_LISTS
} glb_list;

enum { GLB_NAME = 96 };

typedef struct glb_node {
    char name[GLB_NAME];
    int parent, mesh; // -1: none
    float at[3];      // of one that does not move
} glb_node;

// A file under way. Where memory lacks, it goes on, and glb_write() fails.
typedef struct glb {
    uint32_t *word; // all numbers, four bytes each
    size_t words, room;
    FILE *list[GLB_LISTS]; // JSON, its elements separated by commas
    char *text[GLB_LISTS];
    size_t length[GLB_LISTS];
    int count[GLB_LISTS];
    glb_node *node;
    int nodes;
    bool failed;
} glb;

// Triangles: corners [3 corners], three indices each. Grows.
typedef struct glb_shape {
    float *corner;
    uint32_t *index;
    size_t corners, indices, corner_room, index_room;
    bool failed;
} glb_shape;

uint32_t glb_corner(glb_shape *shape, double x, double y, double z); // its index
void glb_triangle(glb_shape *shape, uint32_t a, uint32_t b, uint32_t c);
void glb_box(glb_shape *shape, const double low[3], const double high[3]);
// A ring of corners at x, (y, z) on an ellipse; the index of the first.
uint32_t glb_ring(glb_shape *shape, double x, const double radius[2], int sides);
// The surface between two rings; it faces outwards where the second is further along x.
void glb_between(glb_shape *shape, uint32_t first, uint32_t second, int sides);
// A closed body of revolution about x, `point` [x, radius] along it.
void glb_lathe(glb_shape *shape, const double (*point)[2], size_t points, int sides);
void glb_shape_free(glb_shape *shape);

void glb_begin(glb *self);
// Numbers of so many columns (1, 3 or 4) that keys of an animation take; the accessor.
int glb_keys(glb *self, const float *value, size_t count, int columns);
// A mesh of a shape in one colour (0xrrggbb), with `targets` displacements of all its corners
// [targets][3 corners], NULL: none; its number.
int glb_mesh(glb *self, const glb_shape *shape, unsigned colour, const float *displaced,
             int targets);
int glb_add_node(glb *self, const char *name, int parent, int mesh);
// How a node moves: `path` is translation, rotation (x, y, z, w), scale or weights.
void glb_move(glb *self, int node, const char *path, int times, int values);
// The same, from key to key at once.
void glb_step(glb *self, int node, const char *path, int times, int values);
// Writes the file; `extras`: a JSON object about the scene. Frees what `self` holds in any case.
ld_status glb_write(glb *self, const char *extras, FILE *file, ld_error *error);

#endif
