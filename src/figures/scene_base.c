// What carries the tubes in a scene: a vehicle, the bodies and beams of a mechanism, another base.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "figures/scene_parts.h"

enum { VEHICLE = 0x8f989f, PLATFORM = 0xaab2b8, WHEEL = 0x33383d };

static double number(const history_data *history, const char *name, size_t i, double otherwise)
{
    const history_array *array = history_array_named(history, name);
    return array && i < array->rows * array->columns ? array->value[i] : otherwise;
}

// The text between `head` and `tail` of the columns, one after the other: that of number `i`.
static bool named(const history_data *history, const char *head, const char *tail, size_t i,
                  char name[GLB_NAME])
{
    size_t before = strlen(head), after = strlen(tail), found = 0;
    for (size_t k = 0; k < history->columns; k++) {
        const char *column = history->name[k];
        size_t length = strlen(column);
        if (length <= before + after || strncmp(column, head, before) != 0 ||
            strcmp(column + length - after, tail) != 0 || found++ < i)
            continue;
        snprintf(name, GLB_NAME, "%.*s", (int)(length - before - after), column + before);
        return true;
    }
    return false;
}

static int mesh_of(scene *self, glb_shape *shape, unsigned colour)
{
    int mesh = glb_mesh(&self->glb, shape, colour, NULL, 0);
    glb_shape_free(shape);
    return mesh;
}

static int wheel_mesh(scene *self, double radius)
{
    glb_shape shape = {0};
    const double width = 0.17; // as the report draws it
    glb_lathe(&shape, (const double[][2]){{-width, radius}, {width, radius}}, 2, SCENE_SIDES);
    for (size_t i = 0; i < shape.corners; i++) { // about z
        float *corner = shape.corner + 3 * i, x = corner[0];
        corner[0] = corner[2];
        corner[2] = x;
    }
    return mesh_of(self, &shape, WHEEL);
}

// ---- vehicle ----

// Column wheel.NAME.LAST.
static double of_wheel(const scene *self, const char *name, const char *last, size_t row)
{
    char column[2 * GLB_NAME];
    snprintf(column, sizeof column, "wheel.%s.%s", name, last);
    return scene_value(self->history, column, row);
}

// The wheels at their centres, upright as the body that has them: columns BODY.yaw and so on.
static void add_wheels(scene *self, const char *body)
{
    char name[GLB_NAME], title[2 * GLB_NAME];
    double radius = number(self->history, "wheel.radius", 0, 0.5);
    int mesh = wheel_mesh(self, radius);
    scene_track track;
    for (size_t i = 0; named(self->history, "wheel.", ".travel", i, name); i++) {
        snprintf(title, sizeof title, "wheel %s", name);
        int node = glb_add_node(&self->glb, title, -1, mesh);
        if (!scene_begin_track(self, &track, self->launch.count))
            return;
        for (size_t k = 0; k < self->launch.count; k++) {
            size_t row = self->launch.row[k];
            v3 r = v3_make(of_wheel(self, name, "x", row), of_wheel(self, name, "y", row),
                           of_wheel(self, name, "z", row));
            m3 A = scene_pose_of(self->history, body, row).A;
            scene_add_key(&track, (scene_pose){r, m3_mul(A, m3_rotation_z(-r.x / radius))});
        }
        scene_end_track(self, &track, node, self->launch.times);
    }
}

// A deck from the rearmost to the foremost wheel, up to the hinge of the azimuth platform.
static int chassis_mesh(scene *self, const history_array *mount)
{
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    double radius = number(self->history, "wheel.radius", 0, 0.5);
    for (size_t i = 0; i < 3 * mount->rows; i++) {
        low[i % 3] = fmin(low[i % 3], mount->value[i]);
        high[i % 3] = fmax(high[i % 3], mount->value[i]);
    }
    low[0] -= 1.3 * radius;
    high[0] += 1.3 * radius;
    double deck = number(self->history, "azimuth.hinge", 1,
                         number(self->history, "elevation.hinge", 1, high[1] + 2 * radius));
    low[1] = fmin(high[1] + 0.55 * radius, deck - 0.2);
    high[1] = deck;
    low[2] += 0.2;
    high[2] -= 0.2;
    glb_shape shape = {0};
    glb_box(&shape, low, high);
    return mesh_of(self, &shape, VEHICLE);
}

// The azimuth platform: a disc about its hinge and a post to the elevation platform's.
static void add_azimuth(scene *self, int chassis)
{
    const history_array *hinge = history_array_named(self->history, "azimuth.hinge"),
                        *next = history_array_named(self->history, "elevation.hinge");
    glb_shape shape = {0};
    scene_track track;
    if (!hinge || !next || !scene_begin_track(self, &track, self->launch.count))
        return;
    const double *e = next->value, disc = 0.75, half = 0.12;
    glb_box(&shape, (double[]){-disc, -0.12, -disc}, (double[]){disc, 0.1, disc});
    glb_box(&shape, (double[]){e[0] - half, 0, e[2] - half},
            (double[]){e[0] + half, e[1], e[2] + half});
    int node = glb_add_node(&self->glb, "azimuth", chassis, mesh_of(self, &shape, PLATFORM));
    for (size_t k = 0; k < self->launch.count; k++) {
        double angle = scene_value(self->history, "azimuth.angle", self->launch.row[k]);
        scene_add_key(&track, (scene_pose){v3_from(hinge->value), m3_rotation_y(angle)});
    }
    scene_end_track(self, &track, node, self->launch.times);
}

static void add_vehicle(scene *self, const history_array *mount)
{
    add_azimuth(self, scene_add_body(self, "chassis", chassis_mesh(self, mount)));
    add_wheels(self, "chassis");
}

// ---- mechanism ----

enum { SHAPE_NONE, SHAPE_BOX, SHAPE_CYLINDER, SHAPE_ELLIPSOID, SHAPE_MESH }; // body.shape

// Rings across x: of a cylinder about it or an ellipsoid.
static void add_round(glb_shape *shape, const double size[3], bool ellipsoid)
{
    double point[13][2];
    for (int i = 0; i <= 12; i++) {
        double x = i / 6.0 - 1;
        point[i][0] = 0.5 * size[0] * x;
        point[i][1] = ellipsoid ? 0.5 * sqrt(1 - x * x) : 0.5;
    }
    glb_lathe(shape, (const double(*)[2])point, 13, SCENE_SIDES);
    for (size_t i = 0; i < shape->corners; i++) {
        shape->corner[3 * i + 1] *= (float)size[1];
        shape->corner[3 * i + 2] *= (float)size[2];
    }
}

static void add_triangles(glb_shape *shape, const history_array *mesh, size_t body)
{
    for (size_t i = 0; mesh && i < mesh->rows; i++) {
        const double *row = mesh->value + i * mesh->columns;
        if ((size_t)row[0] != body)
            continue;
        uint32_t at[3];
        for (int k = 0; k < 3; k++)
            at[k] = glb_corner(shape, row[1 + 3 * k], row[2 + 3 * k], row[3 + 3 * k]);
        glb_triangle(shape, at[0], at[1], at[2]);
    }
}

// The shape of a body in its axes; none of one that is drawn as nothing.
static int body_mesh(scene *self, size_t body)
{
    const history_data *history = self->history;
    glb_shape shape = {0};
    double at[3], angle[3], size[3], half[3], low[3];
    for (size_t k = 0; k < 3; k++) {
        at[k] = number(history, "body.at", 3 * body + k, 0);
        angle[k] = number(history, "body.attitude", 3 * body + k, 0);
        size[k] = number(history, "body.size", 3 * body + k, 0);
        half[k] = 0.5 * size[k];
        low[k] = -half[k];
    }
    int kind = (int)number(history, "body.shape", body, SHAPE_NONE);
    if (kind == SHAPE_BOX)
        glb_box(&shape, low, half);
    else if (kind == SHAPE_CYLINDER || kind == SHAPE_ELLIPSOID)
        add_round(&shape, size, kind == SHAPE_ELLIPSOID);
    else if (kind == SHAPE_MESH)
        add_triangles(&shape, history_array_named(history, "body.mesh"), body);
    if (shape.indices == 0) {
        glb_shape_free(&shape);
        return -1;
    }
    m3 A =
        m3_mul(m3_mul(m3_rotation_y(angle[0]), m3_rotation_z(angle[1])), m3_rotation_x(angle[2]));
    for (size_t i = 0; i < shape.corners; i++) {
        float *to = shape.corner + 3 * i;
        v3 r = m3_apply(A, v3_make((double)to[0], (double)to[1], (double)to[2]));
        to[0] = (float)(at[0] + r.x);
        to[1] = (float)(at[1] + r.y);
        to[2] = (float)(at[2] + r.z);
    }
    return mesh_of(self, &shape, body % 2 ? PLATFORM : VEHICLE);
}

// A beam of round sections as wide as they are; of other ones as wide as 0.015 of its length.
static void add_beam(scene *self, size_t i, const char *name)
{
    char of[GLB_NAME], body[GLB_NAME + 8], head[GLB_NAME + 8], sections[2 * GLB_NAME];
    scene_shapes shapes;
    snprintf(of, sizeof of, "beam.%zu", i + 1);
    snprintf(body, sizeof body, "beam.%s", name);
    snprintf(head, sizeof head, "beam.%s.", name);
    snprintf(sections, sizeof sections, "%s.section", of);
    const history_array *section = history_array_named(self->history, sections);
    if (!scene_find_shapes(self->history, of, head, &shapes))
        return;
    double(*size)[4] = calloc(shapes.stations, sizeof *size);
    self->failed = self->failed || !size;
    for (size_t k = 0; size && k < shapes.stations; k++) {
        double radius = NAN;
        for (size_t s = 0; section && s < section->rows; s++)
            if (section->value[3 * s] <= shapes.station[k])
                radius = section->value[3 * s + 2];
        size[k][2] = size[k][3] =
            isfinite(radius) ? radius : 0.015 * shapes.station[shapes.stations - 1];
    }
    if (size)
        scene_add_bending(self, &shapes, (const double(*)[4])size, SCENE_SIDES / 2,
                          scene_add_body(self, body, -1));
    free(size);
}

static void add_mechanism(scene *self)
{
    char name[GLB_NAME], body[2 * GLB_NAME];
    for (size_t i = 0; named(self->history, "body.", ".yaw", i, name); i++) {
        snprintf(body, sizeof body, "body.%s", name);
        scene_add_body(self, body, body_mesh(self, i));
    }
    for (size_t i = 0; named(self->history, "beam.", ".yaw", i, name); i++)
        add_beam(self, i, name);
    if (history_array_named(self->history, "wheel.on") &&
        named(self->history, "body.", ".yaw", (size_t)number(self->history, "wheel.on", 0, 0),
              name)) {
        snprintf(body, sizeof body, "body.%s", name);
        add_wheels(self, body);
    }
}

void scene_add_base(scene *self)
{
    const history_array *mount = history_array_named(self->history, "wheel.mount");
    if (mount && mount->columns == 3 && history_column(self->history, "chassis.yaw"))
        add_vehicle(self, mount);
    else if (history_array_named(self->history, "joint.kind"))
        add_mechanism(self);
    else
        scene_add_body(self, "base", -1);
}
