// Tubes and beams of a scene: each mode is a displacement of all corners, its coordinate the
// weight.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "figures/scene_parts.h"
#include "math/vectors/rotation_vector.h"

static const double *rows_of(const history_data *history, const char *of, const char *what,
                             size_t *rows, size_t *columns)
{
    char name[GLB_NAME];
    snprintf(name, sizeof name, "%s.%s", of, what);
    const history_array *array = history_array_named(history, name);
    *rows = array ? array->rows : 0;
    *columns = array ? array->columns : 0;
    return array ? array->value : NULL;
}

bool scene_find_shapes(const history_data *history, const char *of, const char *head,
                       scene_shapes *shapes)
{
    size_t rows, columns;
    *shapes = (scene_shapes){.head = head};
    shapes->station = rows_of(history, of, "station", &shapes->stations, &columns);
    shapes->bending[0] = rows_of(history, of, "bending", &rows, &shapes->nb);
    shapes->bending[1] = rows_of(history, of, "bending_z", &rows, &columns);
    shapes->slope[0] = rows_of(history, of, "bending_slope", &rows, &columns);
    shapes->slope[1] = rows_of(history, of, "bending_z_slope", &rows, &columns);
    shapes->torsion = rows_of(history, of, "torsion", &rows, &shapes->nt);
    shapes->axial = rows_of(history, of, "axial", &rows, &shapes->na);
    for (int plane = 0; plane < 2 && shapes->nb > 0; plane++)
        if (!shapes->bending[plane] || !shapes->slope[plane])
            return false;
    shapes->initial = rows_of(history, of, "initial_shape", &shapes->bends, &columns);
    if (shapes->bends < 2 || columns != 7)
        shapes->bends = 0;
    shapes->modes = 2 * shapes->nb + shapes->nt + shapes->na;
    for (size_t i = 0; i < shapes->modes && i < SCENE_MODES; i++) {
        char name[GLB_NAME];
        snprintf(name, sizeof name, "%sq%zu", head, i + 1);
        shapes->q[i] = history_column(history, name);
        if (!shapes->q[i])
            return false;
    }
    return shapes->stations > 1 && shapes->modes <= SCENE_MODES;
}

// What a mode does at a station.
static scene_section mode_at(const scene_shapes *shapes, size_t mode, size_t k)
{
    scene_section at = {.x = shapes->station[k]};
    if (mode < 2 * shapes->nb) {
        size_t plane = mode / shapes->nb, i = k * shapes->nb + mode % shapes->nb;
        at.u[plane] = shapes->bending[plane][i];
        at.slope[plane] = shapes->slope[plane][i];
    } else if (mode < 2 * shapes->nb + shapes->nt) {
        at.twist = shapes->torsion[k * shapes->nt + mode - 2 * shapes->nb];
    } else {
        at.stretch = shapes->axial[k * shapes->na + mode - 2 * shapes->nb - shapes->nt];
    }
    return at;
}

static scene_section node_at(const scene *self, const scene_shapes *shapes, size_t row, size_t k)
{
    scene_section sum = {.x = shapes->station[k]};
    for (size_t i = 0; i < shapes->modes; i++) {
        scene_section one = mode_at(shapes, i, k);
        double q = self->magnify * shapes->q[i][row];
        for (int plane = 0; plane < 2; plane++) {
            sum.u[plane] += q * one.u[plane];
            sum.slope[plane] += q * one.slope[plane];
        }
        sum.twist += q * one.twist;
        sum.stretch += q * one.stretch;
    }
    return sum;
}

// Cubic of values y, slopes d at the ends of an interval of length h; its slope in *slope.
static double hermite(double h, double xi, const double y[2], const double d[2], double *slope)
{
    double s = (y[1] - y[0]) / h, c = 3 * s - 2 * d[0] - d[1], e = d[0] + d[1] - 2 * s;
    *slope = d[0] + xi * (2 * c + 3 * xi * e);
    return y[0] + h * xi * (d[0] + xi * (c + xi * e));
}

// Adds the initial shape at a station of the tube, `times` as large.
static void add_initial(const scene_shapes *shapes, double x, double times, scene_section *at)
{
    size_t k = 0;
    double value[3], slope[3];
    if (shapes->bends == 0)
        return;
    while (k + 2 < shapes->bends && x > shapes->initial[7 * (k + 1)])
        k++;
    const double *a = shapes->initial + 7 * k, *b = a + 7;
    for (int i = 0; i < 3; i++)
        value[i] = hermite(b[0] - a[0], (x - a[0]) / (b[0] - a[0]), (double[]){a[1 + i], b[1 + i]},
                           (double[]){a[4 + i], b[4 + i]}, &slope[i]);
    for (int i = 0; i < 2; i++) {
        at->u[i] += times * value[i];
        at->slope[i] += times * slope[i];
    }
    at->twist += times * value[2];
}

// Beyond the ends the axis goes on straight.
scene_section scene_section_at(const scene *self, const scene_shapes *shapes, size_t row, double x)
{
    size_t k = 0;
    while (k + 2 < shapes->stations && x > shapes->station[k + 1])
        k++;
    scene_section a = node_at(self, shapes, row, k), b = node_at(self, shapes, row, k + 1), at;
    double h = b.x - a.x, inside = fmin(b.x, fmax(a.x, x)), xi = (inside - a.x) / h;
    at = (scene_section){.x = x,
                         .twist = a.twist + xi * (b.twist - a.twist),
                         .stretch = a.stretch + xi * (b.stretch - a.stretch)};
    for (int i = 0; i < 2; i++)
        at.u[i] = hermite(h, xi, (double[]){a.u[i], b.u[i]}, (double[]){a.slope[i], b.slope[i]},
                          &at.slope[i]);
    add_initial(shapes, inside, self->magnify, &at);
    for (int i = 0; i < 2; i++)
        at.u[i] += (x - inside) * at.slope[i];
    return at;
}

scene_pose scene_section_pose(const scene_section *at)
{
    return (scene_pose){v3_make(at->x + at->stretch, at->u[0], at->u[1]),
                        rv_exp(v3_make(at->twist, -at->slope[1], at->slope[0]))};
}

// ---- as a mesh ----

// Rings inside and outside at every station; the ends are closed by a ring's surface.
static void add_surface(glb_shape *shape, const scene_shapes *shapes, const double (*size)[4],
                        int sides)
{
    uint32_t inner = 0, outer = 0;
    for (size_t k = 0; k < shapes->stations; k++) {
        uint32_t in = glb_ring(shape, shapes->station[k], size[k], sides),
                 out = glb_ring(shape, shapes->station[k], size[k] + 2, sides);
        if (k == 0) {
            glb_between(shape, in, out, sides);
        } else {
            glb_between(shape, in, inner, sides);
            glb_between(shape, outer, out, sides);
        }
        inner = in;
        outer = out;
    }
    glb_between(shape, outer, inner, sides);
}

// The largest size of a mode's coordinate at the rows.
static double largest(const scene *self, const scene_shapes *shapes, size_t mode)
{
    double most = 0;
    for (size_t i = 0; i < self->launch.count; i++)
        most = fmax(most, fabs(shapes->q[mode][self->launch.row[i]]));
    return most;
}

// How a section that is `at`, q times, moves a corner: cross sections stay plane.
static void displace_corner(const scene_section *at, double q, const float *corner, float *to)
{
    double y = (double)corner[1], z = (double)corner[2];
    to[0] = (float)(q * (at->stretch - at->slope[0] * y - at->slope[1] * z));
    to[1] = (float)(q * (at->u[0] - at->twist * z));
    to[2] = (float)(q * (at->u[1] + at->twist * y));
}

// How a mode, at `q`, moves the corners.
static void displace(const scene_shapes *shapes, const glb_shape *shape, size_t mode, double q,
                     float *to)
{
    size_t each = shape->corners / shapes->stations;
    for (size_t i = 0; i < shape->corners; i++, to += 3) {
        scene_section at = mode_at(shapes, mode, i / each);
        displace_corner(&at, q, shape->corner + 3 * i, to);
    }
}

// The corners where the initial shape has them.
static void displace_initially(const scene *self, const scene_shapes *shapes, glb_shape *shape)
{
    size_t each = shape->corners / shapes->stations;
    for (size_t i = 0; shapes->bends > 0 && i < shape->corners; i++) {
        scene_section at = {0};
        float by[3], *corner = shape->corner + 3 * i;
        add_initial(shapes, shapes->station[i / each], self->magnify, &at);
        displace_corner(&at, 1, corner, by);
        for (int k = 0; k < 3; k++)
            corner[k] += by[k];
    }
}

// A drawing program takes weights from -1 to 1: a mode's displacement is that at its largest.
static int bend(scene *self, const scene_shapes *shapes, glb_shape *shape, int parent)
{
    size_t modes = shapes->modes, rows = self->launch.count, used = 0, each = 3 * shape->corners;
    float *moved = malloc((modes * each + 1) * sizeof *moved),
          *weight = malloc((modes * rows + 1) * sizeof *weight);
    size_t mode[SCENE_MODES];
    double most[SCENE_MODES];
    for (size_t i = 0; moved && i < modes; i++) {
        mode[used] = i;
        most[used] = largest(self, shapes, i);
        if (most[used] > 0 && isfinite(most[used])) {
            displace(shapes, shape, i, self->magnify * most[used], moved + used * each);
            used++;
        }
    }
    for (size_t i = 0; weight && i < rows * used; i++)
        weight[i] = (float)(shapes->q[mode[i % used]][self->launch.row[i / used]] / most[i % used]);
    int node = -1;
    displace_initially(self, shapes, shape);
    if (moved && weight) {
        char name[GLB_NAME];
        snprintf(name, sizeof name, "%sbent", shapes->head); // below the node of its frame
        int mesh = glb_mesh(&self->glb, shape, 0x2f7fd0, moved, (int)used);
        node = glb_add_node(&self->glb, *shapes->head ? name : "tube", parent, mesh);
        if (used > 0)
            glb_move(&self->glb, node, "weights", self->launch.times,
                     glb_keys(&self->glb, weight, rows * used, 1));
    }
    self->failed = self->failed || node < 0;
    free(moved);
    free(weight);
    return node;
}

int scene_add_bending(scene *self, const scene_shapes *shapes, const double (*size)[4], int sides,
                      int parent)
{
    glb_shape shape = {0};
    add_surface(&shape, shapes, size, sides);
    int node = -1;
    if (shape.failed)
        self->failed = true;
    else
        node = bend(self, shapes, &shape, parent);
    glb_shape_free(&shape);
    return node;
}
