// Plausibility of tubes and their supports.
#include "math/functions.h"
#include "model/guide.h"
#include "model/model.h"
#include "model/parts.h"
#include "model/warnings/estimates.h"
#include "model/warnings/plausible_rule.h"

#define PI 3.14159265358979323846

// Frequency of the highest bending mode, about that of a clamped tube, beside that of steps.
static plausible_pair highest_mode(const plausible_entry *at)
{
    const ld_tubes *tubes = &at->model->tubes;
    const ld_section *s = tubes->section;
    double k = (tubes->modes.bending - 0.5) * PI / tubes->length;
    double stiffness = fmax(section_stiffness_y(s), section_stiffness_z(s));
    double frequency = k * k * sqrt(stiffness / s->mass_per_length) / (2 * PI);
    if (tubes->modes.cut > 0)
        frequency = fmin(frequency, tubes->modes.cut);
    return plausible_compare(tubes->modes.bending > 0 ? frequency : NAN,
                             1 / at->model->run.max_step);
}

static plausible_pair cut(const plausible_entry *at)
{
    double frequency = at->model->tubes.modes.cut;
    return plausible_compare(frequency > 0 ? frequency : NAN, 1 / at->model->run.max_step);
}

static plausible_pair support_frequency(const plausible_entry *at)
{
    const ld_tubes *tubes = &at->model->tubes;
    double stiffness = 0;
    for (int i = 0; i < tubes->support_count; i++)
        stiffness += support_clamps(&tubes->support[i], LD_CLAMP_Y)
                         ? NAN
                         : support_spring(&tubes->support[i], LD_CLAMP_Y);
    double mass = estimate_tube_mass(at) + at->model->rocket.full.mass;
    return plausible_alone(stiffness > 0 ? sqrt(stiffness / mass) / (2 * PI) : NAN);
}

// Time [s] in which the supports' dampers take the tube's motion along an axis, the shortest.
static plausible_pair support_time(const plausible_entry *at)
{
    const ld_tubes *tubes = &at->model->tubes;
    double greatest = 0;
    for (int axis = 0; axis < 3; axis++) {
        double damping = 0;
        for (int i = 0; i < tubes->support_count; i++)
            damping += tubes->support[i].damping[axis];
        greatest = fmax(greatest, damping);
    }
    return plausible_compare(greatest > 0 ? estimate_tube_mass(at) / greatest : NAN,
                             at->model->run.max_step);
}

// Shortest decay time [s] of the tube's rotation by their rotational dampers; across the axis as of
// a rod.
static plausible_pair support_turning_time(const plausible_entry *at)
{
    const ld_tubes *tubes = &at->model->tubes;
    double rod = estimate_tube_mass(at) * tubes->length * tubes->length / 12;
    const double inertia[3] = {tubes->section->polar_inertia * tubes->length, rod, rod};
    double shortest = INFINITY;
    for (int axis = 0; axis < 3; axis++) {
        double damping = 0;
        for (int i = 0; i < tubes->support_count; i++)
            damping += tubes->support[i].rotational_damping[axis];
        if (damping > 0)
            shortest = fmin(shortest, inertia[axis] / damping);
    }
    return plausible_compare(isfinite(shortest) ? shortest : NAN, at->model->run.max_step);
}

static double greatest_spring(const ld_support *support)
{
    double greatest = 0;
    for (ld_clamp axis = LD_CLAMP_X; axis <= LD_CLAMP_Z; axis++)
        greatest = fmax(greatest, support_spring(support, axis));
    return greatest;
}

// The stiffness of a support that has springs along the axes alone, if any, beside that of the
// stiffest one.
static plausible_pair support_stiffness(const plausible_entry *at)
{
    const ld_tubes *tubes = &at->model->tubes;
    const ld_support *support = &tubes->support[at->i];
    double stiffest = 0;
    for (int i = 0; i < tubes->support_count; i++)
        stiffest = fmax(stiffest, greatest_spring(&tubes->support[i]));
    if (support->clamped || plausible_norm(support->rotational_stiffness) > 0)
        return plausible_nothing();
    return plausible_compare(greatest_spring(support), stiffest);
}

// The distance of a station that is clamped from the nearest of those before it.
static plausible_pair clamped_distance(const plausible_entry *at)
{
    const ld_support *support = at->model->tubes.support;
    double nearest = NAN;
    for (int k = 0; k < at->i; k++)
        if (support[k].clamped && support[at->i].clamped)
            nearest = fmin(nearest, fabs(support[k].at - support[at->i].at));
    return plausible_compare(nearest, at->model->tubes.length);
}

// Where the outer fibre lies beside the radius of gyration of its direction, the nearer of both.
static plausible_pair outer_fibre(const plausible_entry *at)
{
    const ld_tubes *tubes = &at->model->tubes;
    const ld_station *station = &tubes->station[at->i];
    const ld_section *s = tubes->section;
    for (int k = 1; k < tubes->section_count && tubes->section[k].from <= station->at; k++)
        s = &tubes->section[k];
    double y = sqrt(section_stiffness_z(s) / s->axial_stiffness);
    double z = sqrt(section_stiffness_y(s) / s->axial_stiffness);
    bool along_y = station->outer_fibre[0] / y < station->outer_fibre[1] / z;
    return plausible_compare(station->outer_fibre[along_y ? 0 : 1], along_y ? y : z);
}

// What the return springs carry beside the weight that pulls the tube off its front stop.
static plausible_pair preload(const plausible_entry *at)
{
    const ld_model *model = at->model;
    const ld_tubes *tubes = &model->tubes;
    double mass = estimate_tube_mass(at) + model->rocket.full.mass, preload = 0;
    double weight = estimate_weight_along(at) / model->rocket.full.mass * mass;
    for (int i = 0; i < tubes->support_count; i++)
        preload += tubes->support[i].recoil.present ? tubes->support[i].recoil.preload : 0;
    return plausible_compare(preload, weight > 0 ? weight : NAN);
}

// ---- guide of surfaces

// Angle that the widest gap and the opposite one leave the rocket between its outer shoes.
static plausible_pair play(const plausible_entry *at)
{
    ld_surface surface[LD_MAX_SURFACES];
    int count = guide_surfaces(&at->model->tubes.guide, surface);
    double widest = 0, front = estimate_front(at);
    for (int k = 0; k < count; k++)
        widest = fmax(widest, surface[k].gap);
    return plausible_alone(count > 0 ? 2 * widest / front : NAN);
}

// Friction of what presses all shoes in their centred place between surfaces [N], by gaps below 0,
// beside the greatest thrust.
static plausible_pair grip(const plausible_entry *at)
{
    ld_surface surface[LD_MAX_SURFACES];
    const ld_rocket *rocket = &at->model->rocket;
    const ld_contact *contact = &rocket->contact;
    int count = guide_surfaces(&at->model->tubes.guide, surface);
    double d_0 = contact->reference_penetration, normal = 0;
    for (int i = 0; i < rocket->adaptor_count; i++)
        for (int k = 0; k < count; k++) {
            double in = -(surface[k].gap + guide_clearance(&rocket->adaptor[i]));
            normal += in > 0 ? contact->stiffness * d_0 * pow(in / d_0, contact->exponent) : 0;
        }
    return plausible_compare(contact->friction * normal, estimate_peak_thrust(at));
}

// The steepest slope of the initial shape between two rows, of y and z together.
static plausible_pair initial_slope(const plausible_entry *at)
{
    const ld_initial_shape *shape = &at->model->tubes.initial_shape;
    const ld_table *table = &shape->offsets;
    double steepest = 0;
    for (size_t i = 1; i < table->rows; i++) {
        const double *to = table->data + i * table->columns, *from = to - table->columns;
        double y = shape->scale[0] * (to[1] - from[1]), z = shape->scale[1] * (to[2] - from[2]);
        steepest = fmax(steepest, hypot(y, z) / (to[0] - from[0]));
    }
    return plausible_alone(table->rows > 1 ? steepest : NAN);
}

// ---- slot

#define BORE .other = "the bore's radius"

const plausible_rule plausible_of_tube[] = {
    {"tubes.length", .unit = "m", BORE, .low = 2, .high = 500,
     .why = "a launch tube is 2 to 500 bore radii long"},
    {"tubes.sections.#.outer_radius", "the wall's thickness", .unit = "m",
     .other = "the section's inner radius", .low = 0.002, .high = 1, .form = PLAUSIBLE_DIFFERENCE,
     .b = "tubes.sections.#.inner_radius", .with = "tubes.sections.#.inner_radius",
     .why = "walls of tubes lie in this range"},
    {"tubes.sections.#.area", .unit = "m2", .other = "the area of the bore", .low = 0.004,
     .high = 3, .with = "the area of the section's bore",
     .why = "walls of tubes lie in this range"},
    {"tubes.sections.#.second_moment", "the wall's mean radius by its moment and area", .unit = "m",
     BORE, .low = 0.5, .high = 3, .form = PLAUSIBLE_RING, .b = "tubes.sections.#.area",
     .with = "the section's bore", .why = "a wall lies around its bore"},
    {"tubes.sections.#.torsion_constant", .unit = "m4", .other = "tubes.sections.#.second_moment",
     .low = 1e-5, .high = 2.5,
     .why = "that of a ring is twice its second moment, of an open one less"},
    {"tubes.sections.#.bending_stiffness", "the wall's mean radius by its stiffnesses", .unit = "m",
     BORE, .low = 0.5, .high = 3, .form = PLAUSIBLE_RING, .b = "tubes.sections.#.axial_stiffness",
     .with = "the section's bore", .why = "a wall lies around its bore"},
    {"tubes.sections.#.bending_stiffness_y", .unit = "N.m2",
     .other = "tubes.sections.#.bending_stiffness_z", .low = 0.002, .high = 500,
     .why = "a section so much stiffer in one plane is a sheet"},
    {"tubes.sections.#.bending_stiffness_z", "the radius of gyration by its stiffnesses",
     .unit = "m", .other = "tubes.length", .low = 2e-4, .high = 0.2, .form = PLAUSIBLE_GYRATION,
     .b = "tubes.sections.#.axial_stiffness", .why = "guides are slender beams"},
    {"tubes.sections.#.torsion_stiffness", .unit = "N.m2",
     .other = "tubes.sections.#.bending_stiffness", .low = 1e-5, .high = 2.5,
     .why = "that of a ring is a little less than its bending stiffness"},
    {"tubes.sections.#.axial_stiffness", "the speed of sound along the wall", .unit = "m/s",
     .low = 100, .high = 20000, .form = PLAUSIBLE_GYRATION, .b = "tubes.sections.#.mass_per_length",
     .why = "that of steel is 5200 m/s"},
    {"tubes.sections.#.mass_per_length", "mass over volume of the wall", .unit = "kg/m3",
     .low = 300, .high = 40000, .form = PLAUSIBLE_RATIO, .b = "tubes.sections.#.area",
     .why = "that of steel is 7850 kg/m3"},
    {"tubes.sections.#.polar_inertia", "the mean radius of the mass", .unit = "m", BORE, .low = 0.5,
     .high = 5, .form = PLAUSIBLE_GYRATION, .b = "tubes.sections.#.mass_per_length",
     .with = "the section's bore", .why = "a wall lies around its bore"},
    {"tubes.material.density", .unit = "kg/m3", .low = 500, .high = 23000,
     .why = "wood has 500 kg/m3, steel 7850 kg/m3, no metal more than 22600 kg/m3"},
    {"tubes.material.youngs_modulus", .unit = "Pa", .low = 1e8, .high = 1e12,
     .why = "that of plastics is some 1e9 Pa, that of steel 2.1e11 Pa"},
    {"tubes.material.shear_modulus", .unit = "Pa", .other = "tubes.material.youngs_modulus",
     .low = 0.005, .high = 0.6, .why = "that of a metal is about 0.4 times Young's modulus"},
    {"tubes.material.poisson_ratio", .unit = "", .low = 0, NO_HIGH,
     .why = "auxetic materials are rare"},
    {"tubes.modes.damping", .unit = "", NO_LOW, .high = 0.2,
     .why = "the structure of a tube damps a few percent"},
    {"tubes.modes.cut", .unit = "Hz", .other = "1/run.max_step", .low = 0.3, NO_HIGH, .find = cut,
     .of = "run.max_step", .why = "slower modes change the launch and save no steps"},
    {"tubes.modes.bending", "the estimated frequency of the highest mode", .unit = "Hz",
     .other = "1/run.max_step", NO_LOW, .high = 20, .find = highest_mode, .of = "run.max_step",
     .why = "the integrator needs many short steps to follow it"},
    {"tubes.tail.mass", .unit = "kg", .other = "the mass of the tube", NO_LOW, .high = 20,
     .with = "the mass of the rest of the tube", .of = "tubes.material.density",
     .why = "a tail is a part of the tube"},
    {"tubes.tail.center", .unit = "m", .other = "tubes.length", .low = -1, .high = 1,
     .why = "a tail is welded to the rear end"},
    {"tubes.point_masses.#.mass", .unit = "kg", .other = "the mass of the rest of the tube", NO_LOW,
     .high = 20, .of = "tubes.material.density", .why = "a guide ring is a part of the tube"},
    {"tubes.supports", "the frequency of tube and rocket on their stiffness along y", .unit = "Hz",
     .low = 0.5, .high = 10000, .find = support_frequency, .of = "tubes.material.density",
     .why = "supports are stiffer than rubber and softer than rock"},
    {"tubes.supports", "the decay time of the tube's motion by their damping", .unit = "s",
     .other = "run.max_step", .low = 0.05, NO_HIGH, .find = support_time,
     .of = "tubes.material.density", .why = "the integrator needs many short steps to follow it"},
    {"tubes.supports", "the decay time of the tube's rotation by their rotational damping",
     .unit = "s", .other = "run.max_step", .low = 0.05, NO_HIGH, .find = support_turning_time,
     .of = "tubes.material.density", .why = "the integrator needs many short steps to follow it"},
    {"tubes.supports.#.stiffness", "its greatest stiffness", .unit = "N/m",
     .other = "that of the stiffest support", .low = 1e-6, NO_HIGH, .find = support_stiffness,
     .why = "a support without springs holds nothing"},
    {"tubes.supports.#.recoil.damping", "the decay time of the recoil", .unit = "s",
     .other = "run.max_step", .low = 0.05, NO_HIGH, .form = PLAUSIBLE_DECAY,
     .b = "the whole mass of the tube", .of = "tubes.material.density",
     .why = "the slide does not move"},
    {"tubes.supports.#.recoil.preload", "the preload of all slides", .unit = "N",
     .other = "the weight of tube and rocket towards the rear", .low = 1, NO_HIGH, .find = preload,
     .of = "tubes.material.density", .why = "the tube rests off its front stop"},
    {"tubes.supports.#.recoil.stroke", .unit = "m", .other = "tubes.length", NO_LOW, .high = 1,
     .why = "a slide is shorter than its tube"},
    {"tubes.supports.#.recoil.friction", .unit = "N", .other = "tubes.supports.#.recoil.preload",
     NO_LOW, .high = 1, .why = "the tube does not return to its front stop"},
    {"tubes.supports.#.at", "the distance from the nearest clamped station before it", .unit = "m",
     .other = "tubes.length", .low = 0.005, NO_HIGH, .find = clamped_distance,
     .why = "clamps so close act as one, with unbounded forces"},
    {"tubes.loads.#.outer_fibre", .unit = "m", .other = "the radius of gyration of its direction",
     .low = 0.99, .high = 20, .find = outer_fibre,
     .why = "the corner lies farther out than the material on average"},
    {"tubes.pressure", "the greatest pressure", .unit = "Pa", NO_LOW, .high = 1e9,
     .form = PLAUSIBLE_RATIO, .a = "the greatest force of the pressure",
     .b = "the area of the bore", .why = "expected at most 10000 bar"},
    {"tubes.pressure", "its greatest force", .unit = "N", .other = "the weight towards the rear",
     .low = 1, NO_HIGH, .a = "the greatest force of the pressure", .when = "no motor",
     .why = "the rocket never leaves"},
    {"tubes.pressure.volume", .unit = "m3", .other = "the volume of the bore before the rocket",
     .low = 0.001, .high = 1000, .why = "a reservoir is about as large as what it fills"},
    {"tubes.pressure.exponent", .unit = "", .low = 1, .high = 1.7,
     .why = "isothermal gas has 1, adiabatic gas at most 1.67"},
    {"tubes.pressure.ambient", .unit = "Pa", .other = "the pressure of the gas at the exit", NO_LOW,
     .high = 1, .of = "tubes.pressure.exponent",
     .why = "the net pressure falls below 0 before the exit"},
    {"tubes.pressure.scale", .unit = "", .low = 0.1, .high = 10,
     .why = "it is a correction of the pressure"},
    {"tubes.layout.pitch", .unit = "m", .other = "the bore's diameter", NO_LOW, .high = 20,
     .when = "several tubes", .why = "tubes of one launcher lie side by side"},
    {"tubes.layout.first", "the distance of tube 1 from the platform's origin", .unit = "m",
     .other = "tubes.length", NO_LOW, .high = 5, .form = PLAUSIBLE_NORM,
     .why = "tubes lie on their platform"},
    {"tubes.guide.line", "its distance from the elastic axis", .unit = "m", .other = "tubes.length",
     NO_LOW, .high = 0.2, .form = PLAUSIBLE_NORM, .why = "the guide line runs along its beam"},
    {"tubes.guide", "the friction of shoes pressed by gaps below 0", .unit = "N",
     .other = "the greatest thrust", NO_LOW, .high = 1, .find = grip, .of = "rocket.contact",
     .when = "a motor", .why = "the rocket never leaves"},
    {"tubes.guide.t_slot.lips", .unit = "m", .other = "tubes.length", NO_LOW, .high = 0.2,
     .why = "a rail is long and narrow"},
    {"tubes.guide.t_slot.gap", .unit = "m", .other = "tubes.guide.t_slot.lips", NO_LOW, .high = 0.2,
     .why = "a gap is a small part of the slot"},
    {"tubes.guide.t_slot.side_gap", .unit = "m", .other = "tubes.guide.t_slot.lips", NO_LOW,
     .high = 0.2, .why = "a gap is a small part of the slot"},
    {"tubes.guide.tower.radius", .unit = "m", .other = "tubes.length", NO_LOW, .high = 0.5,
     .why = "a tower is longer than wide"},
    {"tubes.guide.tower.gap", .unit = "m", .other = "tubes.guide.tower.radius", NO_LOW, .high = 0.1,
     .why = "a gap is a small part of the width"},
    {"tubes.guide.surfaces.#.at", "its distance from the guide line", .unit = "m",
     .other = "tubes.length", NO_LOW, .high = 0.2, .form = PLAUSIBLE_NORM,
     .why = "surfaces lie around the guide line"},
    {"tubes.guide.surfaces.#.gap", .unit = "m", NO_LOW, .high = 0.03,
     .why = "gaps are a few millimetres"},
    {"rocket.adaptors.#.clearance", .unit = "m", NO_LOW, .high = 0.03,
     .when = "surfaces to slide on", .why = "it is added to the gaps of this shoe"},
    {"rocket.adaptors", "the angle that the widest gap leaves between the outer shoes",
     .unit = "rad", NO_LOW, .high = 5 * PI / 180, .find = play, .of = "tubes.guide",
     .why = "shoes so close give little guidance"},
    {"tubes.initial_shape.offsets", "its steepest slope between two rows", .unit = "", NO_LOW,
     .high = 0.01, .find = initial_slope, .of = "tubes.initial_shape.scale",
     .why = "guides are straight to a millimetre or two in a metre"},
    {"tubes.initial_shape.random.deviation", .unit = "m", .other = "tubes.length", NO_LOW,
     .high = 0.002, .why = "guides are straight to a millimetre or two in a metre"},
    {"tubes.initial_shape.joints.#.step", "its size", .unit = "m", NO_LOW, .high = 0.002,
     .form = PLAUSIBLE_NORM, .why = "lengths of a rail meet within a millimetre or two"},
    {"tubes.initial_shape.joints.#.kink", "its size", .unit = "rad", NO_LOW, .high = 0.01,
     .form = PLAUSIBLE_NORM, .why = "lengths of a rail are in line within half a degree"},
    {"tubes.jet", "the greatest force", .unit = "N", .other = "the greatest thrust", NO_LOW,
     .high = 1, .form = PLAUSIBLE_GREATEST, .column = 1, .b = "tubes.jet_scale",
     .why = "the force of a jet is at most the thrust"},
    {"tubes.wind_drag.#.width", .unit = "m", .other = "tubes.length", NO_LOW, .high = 1,
     .why = "a guide is longer than wide"},
    {"tubes.wind_drag.#.coefficient", .unit = "", .low = 0.1, .high = 3,
     .why = "that of a cylinder across the wind is 1.2, of bars with edges 2"},
    {"tubes.slot.radius", .unit = "m", BORE, .low = 0.5, .high = 2,
     .why = "the slot lies in the wall around the bore"},
    {"tubes.slot.angle", "its greatest angle", .unit = "rad", NO_LOW, .high = 45 * PI / 180,
     .form = PLAUSIBLE_GREATEST, .column = 1, .why = "a steeper slot brakes and jams"},
    {"tubes.slot.friction", .unit = "", NO_LOW, .high = 1.5,
     .why = "dry metal on metal has below 1"},
    {0}};
