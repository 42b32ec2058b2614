// Plausibility of a base of bodies, joints and force elements.
#include "math/functions.h"
#include "model/model.h"
#include "model/warnings/plausible_rule.h"

#define PI 3.14159265358979323846

static const ld_mechanism *mechanism_of(const plausible_entry *at)
{
    return &at->model->base.mechanism;
}

static double mass_of_beam(const ld_beam *beam)
{
    double mass = 0;
    for (int i = 0; i < beam->section_count; i++) {
        double end = i + 1 < beam->section_count ? beam->section[i + 1].from : beam->length;
        mass += beam->section[i].mass_per_length * (end - beam->section[i].from);
    }
    return mass;
}

static double mass_of_all(const ld_mechanism *given)
{
    double mass = 0;
    for (int i = 0; i < given->body_count; i++)
        mass += given->body[i].mass;
    for (int i = 0; i < given->beam_count; i++)
        mass += mass_of_beam(&given->beam[i]);
    return mass;
}

static plausible_pair body_mass(const plausible_entry *at)
{
    double mass = mechanism_of(at)->body[at->i].mass;
    return mass > 0 ? plausible_compare(mass, mass_of_all(mechanism_of(at))) : plausible_nothing();
}

// Load of a foot over its stiffness [m].
static plausible_pair foot_sag(const plausible_entry *at)
{
    const ld_mechanism *given = mechanism_of(at);
    double load = mass_of_all(given) * at->model->gravity / given->foot_count;
    return plausible_alone(load / given->foot[at->i].stiffness[1]);
}

// [kg] infinity: it does not move.
static double mass_of_end(const ld_mechanism *given, const char *name)
{
    int body = mechanism_body(given, name);
    if (body < 0)
        return INFINITY;
    return body < given->body_count ? given->body[body].mass
                                    : mass_of_beam(&given->beam[body - given->body_count]);
}

// Frequency [Hz] of the lighter end on a spring.
static plausible_pair end_frequency(const ld_mechanism *given, const char *from, const char *to,
                                    double stiffness)
{
    double mass = fmin(mass_of_end(given, from), mass_of_end(given, to));
    return mass > 0 ? plausible_alone(sqrt(stiffness / mass) / (2 * PI)) : plausible_nothing();
}

static plausible_pair strut_frequency(const plausible_entry *at)
{
    const ld_strut *strut = &mechanism_of(at)->strut[at->i];
    return end_frequency(mechanism_of(at), strut->from, strut->to, strut->stiffness);
}

static plausible_pair bushing_frequency(const plausible_entry *at)
{
    const ld_bushing *bushing = &mechanism_of(at)->bushing[at->i];
    double most = fmax(bushing->stiffness[0], fmax(bushing->stiffness[1], bushing->stiffness[2]));
    return end_frequency(mechanism_of(at), bushing->from, bushing->to, most);
}

#define GYRATION(axis)                                                                             \
    {                                                                                              \
        "base.bodies.#.inertia." axis, "the radius of gyration about " axis,                       \
            .unit = "m", .low = 1e-3, .high = 100, .form = PLAUSIBLE_GYRATION,                     \
            .b = "base.bodies.#.mass", .when = "base.bodies.#.inertia." axis,                      \
            .of = "base.bodies.#.mass",                                                            \
            .why = "a body is about as large as its radius of gyration"                            \
    }

const plausible_rule plausible_of_mechanism[] = {
    {"base.bodies.#.mass", .unit = "kg", .other = "the mass of all bodies", .low = 1e-6, NO_HIGH,
     .find = body_mass, .why = "the integrator needs many short steps to follow a body so light"},
    GYRATION("x"),
    GYRATION("y"),
    GYRATION("z"),
    {"base.feet.#.stiffness.y", "the static deflection of the foot", .unit = "m", .low = 1e-7,
     .high = 0.3, .find = foot_sag, .of = "base.bodies.#.mass",
     .why = "a foot stands on the ground and gives way by millimetres"},
    {"base.feet.#.friction", .unit = "", .low = 0.05, .high = 1.5,
     .why = "steel on ice has 0.1, rubber on asphalt 1"},
    {"base.struts.#.stiffness", "the frequency of its lighter end", .unit = "Hz", NO_LOW,
     .high = 1e4, .find = strut_frequency, .of = "base.bodies.#.mass",
     .why = "the integrator needs many short steps to follow it"},
    {"base.bushings.#.stiffness", "the frequency of its lighter end", .unit = "Hz", NO_LOW,
     .high = 1e4, .find = bushing_frequency, .of = "base.bodies.#.mass",
     .why = "the integrator needs many short steps to follow it"},
    {"base.drag.#.area", "its norm", .unit = "m2", NO_LOW, .high = 3000, .form = PLAUSIBLE_NORM,
     .why = "that is the sail of a ship"},
    {0}};
