// What bodies, beams, joints and force elements of a base look like. Bodies are numbered as their
// columns stand, beams behind them; -1 is the ground, -2 the carrier.
#include <math.h>
#include <stdio.h>

#include "math/functions.h"
#include "math/matrices/symmetric_eigen.h"
#include "math/vectors/mat3.h"
#include "model/parts.h"
#include "state/geometry_arrays.h"
#include "systems/mechanism/mechanism_state.h"

static void put(double **to, const double *from, int count)
{
    for (int i = 0; i < count; i++)
        *(*to)++ = from[i];
}

// ---- bodies

static const double POINT = 2000; // [kg/m3] of a body without moments of inertia, drawn as a cube
static const double THINNEST = 0.03; // of a box, over its longest side

// The box of the same mass and moments of inertia.
static ld_appearance box_of_inertia(const ld_body *body)
{
    const double *J = body->inertia, *P = body->products;
    double matrix[9] = {J[0], P[0], P[1], P[0], J[1], P[2], P[1], P[2], J[2]};
    double unit[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, moment[3] = {J[0], J[1], J[2]};
    double axes[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, longest = 0;
    ld_appearance box = {.shape = body->mass > 0 ? LD_SHAPE_BOX : LD_SHAPE_NONE};
    bool turned = P[0] != 0 || P[1] != 0 || P[2] != 0;
    if (turned && symmetric_eigen(3, matrix, unit, 3, moment, axes) == 0) {
        v3 x = v3_from(axes), y = v3_from(axes + 3), z = v3_cross(x, y);
        m3 A = {{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}}};
        m3_yaw_pitch_roll(&A, box.attitude);
    }
    double sum = moment[0] + moment[1] + moment[2];
    for (int i = 0; i < 3; i++) {
        box.at[i] = body->center[i];
        box.size[i] = body->mass > 0 ? sqrt(fmax(0, 6 * (sum - 2 * moment[i]) / body->mass)) : 0;
        longest = fmax(longest, box.size[i]);
    }
    for (int i = 0; i < 3; i++)
        box.size[i] =
            longest > 0 ? fmax(box.size[i], THINNEST * longest) : pow(body->mass / POINT, 1 / 3.0);
    return box;
}

enum { MESH_ROW = 1 + LD_MESH_COLUMNS };
static const double FINENESS = 1e-5; // [m] of a mesh's corners: a report writes them as text

// Puts the triangles of body `number` there, in which place and size become those of the box about
// them; returns the place behind them.
static double *put_mesh(double *to, int number, ld_appearance *looks)
{
    v3 low = {INFINITY, INFINITY, INFINITY}, high = v3_scale(-1, low);
    const double *from = looks->mesh.data;
    for (size_t k = 0; k < 3 * looks->mesh.rows; k++) {
        v3 r = v3_scale(looks->scale, v3_from(from + k / 3 * LD_MESH_COLUMNS + k % 3 * 3));
        low = v3_make(fmin(low.x, r.x), fmin(low.y, r.y), fmin(low.z, r.z));
        high = v3_make(fmax(high.x, r.x), fmax(high.y, r.y), fmax(high.z, r.z));
    }
    v3 middle = v3_scale(0.5, v3_add(low, high));
    for (size_t k = 0; k < looks->mesh.rows; k++, from += 12) {
        *to++ = number;
        for (int i = 0; i < 9; i++)
            *to++ = FINENESS * round((looks->scale * from[i] - (&middle.x)[i % 3]) / FINENESS);
        put(&to, from + 9, 3);
    }
    m3 A = m3_mul(m3_mul(m3_rotation_y(looks->attitude[0]), m3_rotation_z(looks->attitude[1])),
                  m3_rotation_x(looks->attitude[2]));
    v3_store(looks->at, v3_add(v3_from(looks->at), m3_apply(A, middle)));
    v3_store(looks->size, v3_sub(high, low));
    return to;
}

static void add_bodies(geometry *all, const ld_mechanism *given)
{
    size_t count = (size_t)given->body_count;
    static const double code[] = {
        [LD_SHAPE_NONE] = 0,      [LD_SHAPE_BOX] = 1,  [LD_SHAPE_CYLINDER] = 2,
        [LD_SHAPE_ELLIPSOID] = 3, [LD_SHAPE_MESH] = 4,
    };
    double *shape = geometry_add(
        all, "body.shape", "1", count, 1,
        "what each body is drawn as: 0 nothing, 1 a box, 2 a cylinder, 3 an ellipsoid, 4 "
        "a mesh");
    double *at = geometry_add(all, "body.at", "m", count, 3, "its centre, body axes");
    double *attitude = geometry_add(all, "body.attitude", "rad", count, 3,
                                    "yaw, pitch, roll of its axes against the body's");
    double *size = geometry_add(all, "body.size", "m", count, 3,
                                "lengths along its axes; a cylinder's axis is x");
    double *mesh = geometry_add(all, "body.mesh", "m", mechanism_triangles(given), MESH_ROW,
                                "triangles: number of the body, x, y, z of three corners in the "
                                "axes of its shape from its centre; red, green, blue [1]");
    for (int i = 0; i < given->body_count; i++) {
        ld_appearance looks = given->body[i].appearance;
        if (looks.shape == LD_SHAPE_INERTIA)
            looks = box_of_inertia(&given->body[i]);
        else if (looks.shape == LD_SHAPE_MESH)
            mesh = put_mesh(mesh, i, &looks);
        *shape++ = code[looks.shape];
        put(&at, looks.at, 3);
        put(&attitude, looks.attitude, 3);
        put(&size, looks.size, 3);
    }
}

static void add_beams(geometry *all, const mechanism_system *self)
{
    for (int i = 0; i < self->given->beam_count; i++) {
        char of[16];
        snprintf(of, sizeof of, "beam.%d", i + 1);
        geometry_add_shapes(all, of, mechanism_beam(self, i));
        geometry_add_sections(all, of, self->given->beam[i].section,
                              self->given->beam[i].section_count);
    }
}

// ---- joints

static void add_joints(geometry *all, const ld_mechanism *given)
{
    size_t count = (size_t)given->joint_count;
    double *kind = geometry_add(all, "joint.kind", "1", count, 1,
                                "0 fixed, 1 revolute, 2 prismatic, 3 cylindrical, 4 universal, 5 "
                                "spherical, 6 planar, 7 free");
    double *link = geometry_add(all, "joint.link", "1", count, 2,
                                "parent and body: their numbers from 0, beams behind the bodies; "
                                "-1 the ground, -2 the carrier");
    double *at = geometry_add(all, "joint.at", "m", count, 3,
                              "its position on the parent; on a beam station, then y, z there");
    double *attitude = geometry_add(all, "joint.attitude", "rad", count, 3,
                                    "yaw, pitch, roll of its axes against the parent's");
    double *axis = geometry_add(all, "joint.axis", "1", count, 3, "its axis, in its axes");
    for (int i = 0; i < given->joint_count; i++) {
        const ld_joint *joint = &given->joint[i];
        *kind++ = joint->kind;
        *link++ = mechanism_body(given, joint->parent);
        *link++ = mechanism_body(given, joint->body);
        put(&at, joint->at, 3);
        put(&attitude, joint->attitude, 3);
        put(&axis, joint->axis, 3);
    }
}

// ---- force elements

static void add_struts(geometry *all, const ld_mechanism *given)
{
    size_t count = (size_t)given->strut_count;
    double *link =
        geometry_add(all, "strut.link", "1", count, 2, "what its ends are on, as joints");
    double *at = geometry_add(all, "strut.at", "m", count, 6, "its ends, there");
    double *driven = geometry_add(all, "strut.driven", "1", count, 1, "1 where it has an actuator");
    for (int i = 0; i < given->strut_count; i++) {
        const ld_strut *strut = &given->strut[i];
        *link++ = mechanism_body(given, strut->from);
        *link++ = mechanism_body(given, strut->to);
        put(&at, strut->at, 3);
        put(&at, strut->to_at, 3);
        *driven++ = strut->driven;
    }
}

static void add_bushings(geometry *all, const ld_mechanism *given)
{
    size_t count = (size_t)given->bushing_count;
    double *on = geometry_add(all, "bushing.on", "1", count, 1, "what `from` is, as of joints");
    double *at = geometry_add(all, "bushing.at", "m", count, 3, "position, there");
    for (int i = 0; i < given->bushing_count; i++) {
        *on++ = mechanism_body(given, given->bushing[i].from);
        put(&at, given->bushing[i].at, 3);
    }
}

static void add_feet(geometry *all, const ld_mechanism *given)
{
    size_t count = (size_t)given->foot_count;
    double *on = geometry_add(all, "foot.on", "1", count, 1, "the body that stands on it");
    double *at = geometry_add(all, "foot.at", "m", count, 3, "position, there");
    double *height = geometry_add(all, "foot.height", "m", count, 1, "y of the ground under it");
    for (int i = 0; i < given->foot_count; i++) {
        *on++ = mechanism_body(given, given->foot[i].body);
        put(&at, given->foot[i].at, 3);
        *height++ = given->foot[i].height;
    }
}

// ---- all

size_t geometry_mechanism_room(const mechanism_system *self)
{
    size_t room = 0;
    if (!self)
        return 0;
    for (int i = 0; i < self->given->beam_count; i++)
        room += geometry_shapes_room(mechanism_beam(self, i)) + 3 * LD_MAX_BEAM_SECTIONS;
    room += MESH_ROW * mechanism_triangles(self->given);
    return room + 10 * LD_MAX_BODIES + 12 * LD_MAX_JOINTS + 9 * LD_MAX_STRUTS +
           4 * LD_MAX_BUSHINGS + 5 * LD_MAX_FEET + 2;
}

void geometry_add_mechanism(geometry *all, const mechanism_system *self)
{
    const ld_base *base = model_base(self->model);
    double on = mechanism_body(self->given, model_tubes(self->model)->on);
    double wheels = self->wheels, looks = base->looks;
    add_bodies(all, self->given);
    add_beams(all, self);
    add_joints(all, self->given);
    add_struts(all, self->given);
    add_bushings(all, self->given);
    add_feet(all, self->given);
    geometry_add_row(all, "tubes.on", "1", 1, &on, "what carries the tubes, as of joints");
    if (self->wheels >= 0) {
        geometry_add_row(all, "wheel.on", "1", 1, &wheels, "the body that the wheels carry");
        geometry_add_row(all, "wheel.radius", "m", 1, &base->vehicle.tyre.radius,
                         "radius of the tyres");
    }
    if (looks != LD_LOOKS_PLAIN)
        geometry_add_row(all, "base.looks", "1", 1, &looks,
                         "what the carrier is drawn as: 1 ship, 2 aircraft");
}
