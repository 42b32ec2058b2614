// What a launcher looks like: places, sizes and mode shapes, for whoever draws its motion.
#include "state/geometry.h"

#include <math.h>
#include <stdlib.h>

#include "elements/air/barrowman.h"
#include "model/blocks/platform.h"
#include "model/guide.h"
#include "model/parts.h"
#include "model/salvo.h"
#include "state/geometry_arrays.h"
#include "systems/mechanism/carried_tubes.h"

// ---- tube ----

// None where nothing is clamped.
static void add_clamps(geometry *all, const ld_tubes *tubes)
{
    unsigned clamped = 0;
    for (int i = 0; i < tubes->support_count; i++)
        clamped |= tubes->support[i].clamped;
    double *held = geometry_add(
        all, "tube.clamped", "1", clamped ? (size_t)tubes->support_count : 0, LD_CLAMPS,
        "1 where a support holds rigidly along x, y, z, about x, y, z; else 0");
    for (int i = 0; clamped && i < tubes->support_count * LD_CLAMPS; i++)
        held[i] = support_clamps(&tubes->support[i / LD_CLAMPS], (ld_clamp)(i % LD_CLAMPS));
}

static void add_tube(geometry *all, const ld_tubes *tubes)
{
    geometry_add_sections(all, "tube", tubes->section, tubes->section_count);
    double *support = geometry_add(all, "tube.support", "m", (size_t)tubes->support_count, 1,
                                   "stations of the supports");
    for (int i = 0; i < tubes->support_count; i++)
        support[i] = tubes->support[i].at;
    add_clamps(all, tubes);
}

// Half height and half width of the solid rectangle that has a section's polar inertia over its
// mass and the ratio of its bending stiffnesses; NaN where there is no such.
static void section_outline(const ld_section *section, double outline[2])
{
    // what deflections along y and z meet
    double y = section_stiffness_z(section), z = section_stiffness_y(section);
    double radius2 = section->polar_inertia / section->mass_per_length;
    outline[0] = sqrt(3 * radius2 * y / (y + z));
    outline[1] = sqrt(3 * radius2 * z / (y + z));
}

static void add_guide(geometry *all, const ld_tubes *tubes)
{
    ld_surface surface[LD_MAX_SURFACES];
    size_t count = (size_t)guide_surfaces(&tubes->guide, surface);
    if (count == 0)
        return;
    double form = tubes->guide.form + 1;
    geometry_add_row(all, "guide.form", "1", 1, &form,
                     "a guide of 1 surfaces, 2 a T-slot, 3 a tower's rails");
    geometry_add_row(all, "guide.line", "m", 2, tubes->guide.line, "y, z of the guide line in R");
    double *at = geometry_add(all, "guide.surface", "m", count, 2,
                              "y, z of each surface's point, from the line");
    double *normal = geometry_add(all, "guide.normal", "rad", count, 1,
                                  "direction from the shoe to each surface, from y towards z");
    double *gap = geometry_add(all, "guide.gap", "m", count, 1,
                               "gap of each surface; of a shoe its clearance more");
    double *round =
        geometry_add(all, "guide.round", "1", count, 1, "1: the surface is round, 0: flat");
    for (size_t k = 0; k < count; k++) {
        at[2 * k] = surface[k].at[0];
        at[2 * k + 1] = surface[k].at[1];
        normal[k] = surface[k].normal;
        gap[k] = surface[k].gap;
        round[k] = surface[k].shape == LD_SURFACE_ROUND;
    }
    double *outline =
        geometry_add(all, "guide.outline", "m", (size_t)tubes->section_count, 2,
                     "half height and half width of a solid rectangle like each section");
    for (int i = 0; i < tubes->section_count; i++)
        section_outline(&tubes->section[i], outline + 2 * i);
}

static void add_layout(geometry *all, const ld_tubes *tubes)
{
    int count = tubes->layout.rows * tubes->layout.columns;
    double *place =
        geometry_add(all, "tubes.rear_end", "m", (size_t)count, 3,
                     "rear end of each tube, undeformed, axes of the elevation platform");
    for (int i = 0; i < count; i++)
        v3_store(place + 3 * i,
                 v3_add(v3_from(tubes->layout.first), carried_tube_row(&tubes->layout, i + 1)));
    double *empty = geometry_add(all, "tubes.empty", "1", (size_t)tubes->empty_count, 1,
                                 "numbers of the tubes without a rocket from the start");
    for (int i = 0; i < tubes->empty_count; i++)
        empty[i] = tubes->empty[i];
}

// ---- rocket, base ----

enum { NOSE_STEPS = 16 }; // of a nose's curve

// The curve of a nose, close where it is blunt; of a body and a tail both ends.
static int outline_of(const ld_air_surface *of, double (*to)[2])
{
    bool nose = of->kind == LD_AIR_NOSE, tail = of->kind == LD_AIR_TAIL;
    int steps = nose ? NOSE_STEPS : 1;
    for (int i = 0; i <= steps; i++) {
        double x = pow((double)i / steps, 2), front = tail ? of->front_radius : of->radius;
        to[i][0] = of->at - x * of->length;
        to[i][1] = nose ? of->radius * barrowman_nose_radius(of->shape, of->length / of->radius, x)
                        : front + x * ((tail ? of->rear_radius : of->radius) - front);
    }
    return steps + 1;
}

static bool is_body(const ld_air_surface *of)
{
    return of->kind == LD_AIR_NOSE || of->kind == LD_AIR_BODY || of->kind == LD_AIR_TAIL;
}

static void add_fins(geometry *all, const ld_aerodynamics *aero)
{
    size_t fins = 0;
    for (int i = 0; i < aero->surface_count; i++)
        fins += aero->surface[i].kind == LD_AIR_FINS;
    double *fin =
        geometry_add(all, "rocket.fins", "m", fins, 7,
                     "x in B of the root's front end, root chord, tip chord, span, sweep length, "
                     "radius of the body; number of fins");
    for (int i = 0; i < aero->surface_count; i++) {
        const ld_air_surface *of = &aero->surface[i];
        if (of->kind != LD_AIR_FINS)
            continue;
        const double row[7] = {of->at,           of->root_chord, of->tip_chord, of->span,
                               of->sweep_length, of->radius,     of->count};
        for (int k = 0; k < 7; k++)
            *fin++ = row[k];
    }
}

// Body and fins, where the air is given by surface and a nose is among them.
static void add_outline(geometry *all, const ld_aerodynamics *aero)
{
    const ld_air_surface *sorted[LD_MAX_AIR_SURFACES];
    double outline[LD_MAX_AIR_SURFACES * (NOSE_STEPS + 1)][2];
    int bodies = 0, points = 0;
    bool nose = false;
    for (int i = 0; i < aero->surface_count; i++) {
        const ld_air_surface *of = &aero->surface[i];
        nose = nose || of->kind == LD_AIR_NOSE;
        if (!is_body(of))
            continue;
        int k = bodies++;
        for (; k > 0 && sorted[k - 1]->at < of->at; k--) // from the tip backwards
            sorted[k] = sorted[k - 1];
        sorted[k] = of;
    }
    if (!nose)
        return;
    for (int i = 0; i < bodies; i++)
        points += outline_of(sorted[i], outline + points);
    double *body = geometry_add(all, "rocket.outline", "m", (size_t)points, 2,
                                "x in B and radius along the body from its tip; straight between");
    for (int i = 0; i < 2 * points; i++)
        body[i] = outline[i / 2][i % 2];
    add_fins(all, aero);
}

static void add_rocket(geometry *all, const ld_model *model)
{
    const ld_rocket *rocket = salvo_rocket(model, 0);
    int count = rocket->adaptor_count,
        firings = salvo_is_given(model) ? model_firing_count(model) : 1;
    double *at = geometry_add(all, "rocket.adaptor", "m", (size_t)count, 1,
                              "centres of the adaptors on the axis, from the rear one's");
    double *clearance = geometry_add(
        all, "rocket.clearance", "m", (size_t)firings, (size_t)count,
        "radial clearance of each adaptor, added to a shoe's gaps; by firing where rockets differ");
    for (int i = 0; i < count; i++)
        at[i] = rocket->adaptor[i].at;
    for (int i = 0; i < firings * count; i++)
        clearance[i] = salvo_rocket(model, i / count)->adaptor[i % count].clearance;
    double center[2] = {rocket->full.center[0], rocket->empty.center[0]};
    geometry_add_row(all, "rocket.center", "m", 2, center,
                     "x of the mass centre in B, full and empty");
    if (rocket->aerodynamics.present)
        geometry_add_row(all, "rocket.diameter", "m", 1, &rocket->aerodynamics.reference_diameter,
                         "reference diameter of the aerodynamics");
    add_outline(all, &rocket->aerodynamics);
}

static void add_base(geometry *all, const base_system *base)
{
    const ld_model *model = base->model;
    const ld_base *given = model_base(model);
    const ld_vehicle *vehicle = &given->vehicle;
    if (base_as_multibody(base)) {
        geometry_add_mechanism(all, base_as_multibody(base));
        return;
    }
    if (!base_is_vehicle(base)) {
        double mount[2] = {given->azimuth, given->elevation};
        geometry_add_row(all, "base.mount", "rad", 2, mount,
                         "tube against the base: azimuth, elevation");
        double looks = given->looks;
        geometry_add_row(all, "base.looks", "1", looks != LD_LOOKS_PLAIN, &looks,
                         "what the base is drawn as: 1 ship, 2 aircraft; a plain one has none");
        return;
    }
    geometry_add_row(all, "azimuth.hinge", "m", model_platform(model)->has_azimuth ? 3 : 0,
                     model_platform(model)->azimuth.hinge_at,
                     "hinge of the azimuth platform, axes of the chassis, from its mass centre");
    geometry_add_row(all, "elevation.hinge", "m", 3, model_platform(model)->elevation.hinge_at,
                     "hinge of the elevation platform, axes of the azimuth platform, from its "
                     "hinge; without one axes of the chassis, from its mass centre");
    double *mount = geometry_add(all, "wheel.mount", "m", (size_t)vehicle->wheel_count, 3,
                                 "wheel centres with unloaded suspension, axes of the chassis");
    for (int i = 0; i < 3 * vehicle->wheel_count; i++)
        mount[i] = vehicle->wheel[i / 3].mount[i % 3];
    geometry_add_row(all, "wheel.radius", "m", 1, &vehicle->tyre.radius, "radius of the tyres");
}

// Numbers that the arrays hold, at most.
static size_t room_for(const ld_simulation *self)
{
    const flexible_tube *tube = &self->launcher.launching.tube.flexible;
    return geometry_shapes_room(tube) +
           geometry_initial_shape_room(self->launcher.launching.tube.initial) +
           3 * LD_MAX_SECTIONS + 2 * LD_MAX_SECTIONS + (1 + LD_CLAMPS) * LD_MAX_SUPPORTS +
           5 * LD_MAX_SURFACES + 4 * LD_MAX_TUBES + (1 + LD_MAX_FIRINGS) * LD_MAX_ADAPTORS +
           3 * LD_MAX_WHEELS + LD_MAX_AIR_SURFACES * (2 * (NOSE_STEPS + 1) + 7) + 20 +
           geometry_mechanism_room(base_as_multibody(&self->launcher.base));
}

ld_status simulation_geometry(const ld_simulation *self, const ld_sink *sink, ld_error *error)
{
    geometry all = {.value = NULL};
    if (!sink->geometry)
        return LD_OK;
    all.value = malloc(room_for(self) * sizeof *all.value);
    if (!all.value)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the geometry");
    geometry_add_shapes(&all, "tube", &self->launcher.launching.tube.flexible);
    geometry_add_initial_shape(&all, self->launcher.launching.tube.initial);
    add_tube(&all, model_tubes(self->model));
    add_guide(&all, model_tubes(self->model));
    add_layout(&all, model_tubes(self->model));
    add_rocket(&all, self->model);
    add_base(&all, &self->launcher.base);
    ld_status status = sink->geometry(sink->self, all.array, all.count, error);
    free(all.value);
    return status;
}
