#include "support/random_model.h"

#include <stdlib.h>

#include "model/guide.h"
#include "model/model.h"
#include "model/parts.h"
#include "quantities/summary.h"
#include "support/check.h"
#include "support/draw.h"
#include "support/reference_model.h"

// ---- drawing ----

double between(uint64_t *seed, double low, double high)
{
    return low + 0.5 * (1 + draw(seed)) * (high - low);
}

bool chance(uint64_t *seed, double probability)
{
    return between(seed, 0, 1) < probability;
}

int choice(uint64_t *seed, int count)
{
    return (int)between(seed, 0, count);
}

void scale(uint64_t *seed, double *value)
{
    double factor = exp(between(seed, log(0.3), log(3)));
    if (chance(seed, 0.75))
        *value *= factor;
}

void scale_all(uint64_t *seed, int count, double *value)
{
    for (int i = 0; i < count; i++)
        scale(seed, &value[i]);
}

void scale_together(uint64_t *seed, int count, double *value)
{
    double factor = 1;
    scale(seed, &factor);
    for (int i = 0; i < count; i++)
        value[i] *= factor;
}

static void draw_sines(uint64_t *seed, double size, ld_sines *sines)
{
    sines->count = choice(seed, 3);
    for (int i = 0; i < sines->count; i++)
        sines->term[i] =
            (ld_sine){size * between(seed, 0, 1), between(seed, 0.1, 10), between(seed, -3, 3)};
}

static void draw_base(uint64_t *seed, ld_base *base)
{
    base->elevation = between(seed, -1.57, 1.57);
    if (chance(seed, 0.5))
        return;
    base->kind = LD_BASE_PRESCRIBED;
    base->azimuth = between(seed, -3, 3);
    for (int i = 0; i < 3; i++)
        base->velocity[i] = 10 * draw(seed);
    ld_sines *path[3] = {&base->surge, &base->heave, &base->sway};
    ld_sines *turn[3] = {&base->yaw, &base->pitch, &base->roll};
    for (int i = 0; i < 3; i++) {
        draw_sines(seed, 0.05, path[i]);
        draw_sines(seed, 0.05, turn[i]);
    }
}

static void draw_slot(uint64_t *seed, ld_slot *slot)
{
    slot->kind = chance(seed, 0.25) ? LD_SLOT_NONE : LD_SLOT_HELIX;
    scale(seed, &slot->angle.data[1]);
    slot->angle.data[1] *= draw(seed);
    slot->friction = chance(seed, 0.2) ? 0 : between(seed, 0, 0.5);
    if (chance(seed, 0.3)) {
        free(slot->angle.data);
        slot->angle = reference_table(
            3, 2, (double[]){0, 0.3 * draw(seed), 1, 0.3 * draw(seed), 2, 0.3 * draw(seed)});
    }
}

// A bending stiffness of each plane; by draws of its own, so that the others stay as they are.
static void draw_planes(uint64_t seed, ld_tubes *tubes)
{
    if (!chance(&seed, 0.3))
        return;
    for (int i = 0; i < tubes->section_count; i++) {
        ld_section *s = &tubes->section[i];
        s->form = LD_SECTION_PLANES;
        s->bending_stiffness_y = s->bending_stiffness_z = s->bending_stiffness;
        scale(&seed, &s->bending_stiffness_y);
        s->bending_stiffness = NAN;
    }
}

static void draw_tubes(uint64_t *seed, ld_tubes *tubes)
{
    ld_section *section = tubes->section;
    scale(seed, &section->mass_per_length);
    scale(seed, &section->bending_stiffness);
    scale(seed, &section->torsion_stiffness);
    scale(seed, &section->axial_stiffness);
    scale(seed, &section->polar_inertia);
    scale(seed, &tubes->length);
    if (chance(seed, 0.3)) {
        section[1] = section[0];
        section[1].from = between(seed, 0.2, 0.8) * tubes->length;
        scale(seed, &section[1].bending_stiffness);
        tubes->section_count = 2;
    }
    if (chance(seed, 0.3))
        tubes->point_mass[tubes->point_mass_count++] =
            (ld_point_mass){between(seed, 0, tubes->length), between(seed, 0, 3)};
    tubes->modes = (ld_modes){.bending = 1 + choice(seed, 8),
                              .torsion = choice(seed, 4),
                              .axial = choice(seed, 3),
                              .elements = 10 + choice(seed, 30),
                              .span = (ld_mode_span)choice(seed, 3),
                              .damping = between(seed, 0, 0.05)};
    scale(seed, &tubes->tail.mass);
    scale_together(seed, 3, tubes->tail.inertia);
    tubes->support_count = 1 + choice(seed, 4);
    for (int k = 0; k < tubes->support_count; k++) {
        ld_support *support = &tubes->support[k];
        *support = tubes->support[0];
        support->at = between(seed, 0, tubes->length);
        scale_all(seed, 3, support->stiffness);
        scale_all(seed, 3, support->damping);
        scale_all(seed, 3, support->rotational_stiffness);
        scale_all(seed, 3, support->rotational_damping);
    }
    draw_slot(seed, &tubes->slot);
    draw_planes(*seed ^ 0x5bd1e995, tubes);
}

static void draw_contact(uint64_t *seed, ld_contact *contact)
{
    contact->law = (ld_contact_law)choice(seed, 5);
    scale(seed, &contact->stiffness);
    bool linear = contact->law == LD_CONTACT_BILATERAL || contact->law == LD_CONTACT_KELVIN_VOIGT;
    contact->exponent = linear ? 1 : between(seed, 1, 1.5);
    contact->restitution = between(seed, 0.1, 1);
    scale(seed, &contact->reference_speed);
    if (linear)
        contact->damping = between(seed, 0, 2e4);
    bool held = contact_has(contact->law, LD_CONTACT_TWO_SIDED);
    contact->friction = held ? 0 : between(seed, 0, 0.5);
    scale(seed, &contact->friction_speed);
}

static void draw_rocket(uint64_t *seed, double length, ld_rocket *rocket)
{
    rocket->start_at = chance(seed, 0.2) ? between(seed, 0, length) : between(seed, 0, 0.3);
    scale(seed, &rocket->full.mass);
    rocket->propellant = rocket->full.mass * between(seed, 0, 0.6);
    rocket->empty.mass = rocket->full.mass - rocket->propellant;
    rocket->empty.center[0] = between(seed, -0.3, 2.2);
    rocket->full.center[0] = between(seed, -0.3, 2.2);
    scale_together(seed, 3, rocket->full.inertia);
    for (int i = 0; i < 3; i++)
        rocket->empty.inertia[i] = 0.7 * rocket->full.inertia[i];
    for (int i = 0; i < 2; i++) {
        rocket->eccentricity[i] = 1e-3 * draw(seed);
        rocket->motor.misalignment[i] = 3e-3 * draw(seed);
        rocket->motor.at[1 + i] = 1e-3 * draw(seed);
        rocket->products[i] = 1e-3 * rocket->full.inertia[1] * draw(seed);
    }
    rocket->adaptor_count = 2 + choice(seed, 3);
    rocket->adaptor[3] = rocket->adaptor[2];
    snprintf(rocket->adaptor[3].name, LD_MAX_NAME, "fourth");
    for (int i = 0; i < rocket->adaptor_count; i++) {
        rocket->adaptor[i].at = i == 0 ? 0 : between(seed, 0.2, 2.5);
        rocket->adaptor[i].clearance = between(seed, 1e-6, 2e-3);
    }
    rocket->knob_angle = between(seed, -3, 3);
    rocket->lock.present = chance(seed, 0.8);
    scale(seed, &rocket->lock.release_force);
    for (size_t i = 0; i < rocket->motor.thrust.rows; i++)
        scale(seed, &rocket->motor.thrust.data[2 * i + 1]);
    scale(seed, &rocket->motor.time_scale);
    if (chance(seed, 0.1)) // hardly any thrust
        rocket->motor.thrust_scale = 0.02;
    draw_contact(seed, &rocket->contact);
    if (rocket->contact.law == LD_CONTACT_IDEAL) // two at most
        rocket->adaptor_count = 2;
}

// A lock beside the axis, an inertia that is turned, air on what has come out of the tube.
static void draw_rocket_options(uint64_t *seed, ld_rocket *rocket)
{
    if (chance(seed, 0.5)) {
        rocket->lock.x = between(seed, -0.2, 2);
        rocket->lock.radius = between(seed, 0, 0.0825);
        rocket->lock.angle = between(seed, -3, 3);
    }
    for (int i = 0; i < 2 && chance(seed, 0.5); i++)
        rocket->dynamic_imbalance[i] = 1e-2 * draw(seed);
    if (chance(seed, 0.3)) {
        ld_aerodynamics *air = &rocket->aerodynamics;
        air->present = air->emerged.present = true;
        air->model = LD_AERODYNAMICS_BODY;
        air->area = 0.02;
        air->drag = 0.4;
        air->emerged.nose = between(seed, 2.5, 3.5);
        air->emerged.drag = between(seed, 0.1, 2);
        air->emerged.diameter = between(seed, 0.05, 0.165);
    }
}

// A gas behind the rocket, with the motor or without; supports that are slides.
static void draw_drive(uint64_t *seed, ld_model *model)
{
    ld_pressure *gas = &model->tubes.pressure;
    if (chance(seed, 0.2)) {
        *gas = (ld_pressure){.present = true, .form = LD_PRESSURE_OF_GAS, .scale = 1};
        gas->pressure = between(seed, 3e5, 3e6);
        gas->volume = between(seed, 0.01, 0.1);
        gas->exponent = between(seed, 1, 1.6);
        gas->ambient = chance(seed, 0.5) ? 1e5 : 0;
    }
    for (int k = 0; k < model->tubes.support_count && gas->present; k++)
        model->tubes.support[k].recoil = (ld_recoil){.present = true,
                                                     .preload = between(seed, 0, 5e3),
                                                     .stiffness = between(seed, 0, 5e4),
                                                     .damping = between(seed, 0, 1e3),
                                                     .quadratic_damping = between(seed, 0, 200),
                                                     .friction = between(seed, 0, 500),
                                                     .friction_speed = 0.01,
                                                     .stroke = between(seed, 0.05, 1)};
}

// What slides in what the rocket has as adaptors; shoes may add to the gaps.
static void draw_guide(uint64_t seed, ld_tubes *tubes, ld_rocket *rocket)
{
    if (!chance(&seed, 0.25) || tubes->pressure.present)
        return;
    ld_guide *guide = &tubes->guide;
    guide->present = true;
    guide->form = (ld_guide_form)choice(&seed, 3);
    for (int i = 0; i < 2; i++)
        guide->line[i] = chance(&seed, 0.5) ? 0.15 * draw(&seed) : 0;
    double gap = chance(&seed, 0.2) ? 0 : between(&seed, 1e-6, 2e-3);
    guide->t_slot = (ld_t_slot){{0.08 * draw(&seed), 0.04 * draw(&seed)},
                                between(&seed, 0.01, 0.1),
                                gap,
                                chance(&seed, 0.2) ? 0 : between(&seed, 1e-6, 2e-3)};
    guide->tower =
        (ld_tower){3 + choice(&seed, 4), between(&seed, -3, 3), gap, between(&seed, 0.05, 0.1)};
    ld_surface_shape shape = (ld_surface_shape)choice(&seed, 2);
    guide->surface_count = guide->form == LD_GUIDE_SURFACES ? 4 + choice(&seed, 3) : 0;
    for (int k = 0; k < guide->surface_count; k++) { // all around, each beside its place
        double angle = 1.5707963 * (k % 4) + 0.2 * draw(&seed), off = 0.03 * draw(&seed);
        ld_surface *surface = &guide->surface[k];
        *surface = (ld_surface){
            .at = {0.08 * cos(angle) - off * sin(angle), 0.08 * sin(angle) + off * cos(angle)},
            .normal = angle,
            .gap = gap,
            .shape = shape};
        snprintf(surface->name, LD_MAX_NAME, "surface_%d", k);
    }
    tubes->slot.kind = LD_SLOT_NONE;
    rocket->contact.law = (ld_contact_law)choice(&seed, LD_CONTACT_BILATERAL);
    bool linear = rocket->contact.law == LD_CONTACT_KELVIN_VOIGT;
    rocket->contact.exponent = linear ? 1 : between(&seed, 1, 1.5);
    rocket->contact.damping = linear ? between(&seed, 0, 2e4) : 0;
    rocket->contact.friction = chance(&seed, 0.3) ? 0 : between(&seed, 0, 0.5);
    bool carries_roll = guide_is_flat(guide) && chance(&seed, 0.5);
    rocket->lock.holds_roll = carries_roll ? LD_HOLD_NO : (ld_hold)choice(&seed, 2);
    for (int i = 0; i < rocket->adaptor_count; i++)
        rocket->adaptor[i].clearance = chance(&seed, 0.7) ? NAN : 1e-3 * between(&seed, 0, 1);
}

// Supports that hold directions rigidly, mostly as many as the modes can follow.
static void draw_clamps(uint64_t seed, ld_model *model)
{
    ld_tubes *tubes = &model->tubes;
    static const unsigned held[] = {
        (1u << LD_CLAMPS) - 1, // all
        1u << LD_CLAMP_Y | 1u << LD_CLAMP_Z,
        1u << LD_CLAMP_Y | 1u << LD_CLAMP_Z | 1u << LD_CLAMP_ROLL,
        1u << LD_CLAMP_X | 1u << LD_CLAMP_Y,
        1u << LD_CLAMP_YAW | 1u << LD_CLAMP_PITCH,
    };
    int most = chance(&seed, 0.3) ? 1 + choice(&seed, 2) : 0;
    for (int k = 0; k < tubes->support_count && k < most; k++) {
        ld_support *support = &tubes->support[k];
        support->clamped = held[choice(&seed, 5)];
        if (support->recoil.present || (k > 0 && tubes->modes.axial < 1))
            support->clamped &= ~(1u << LD_CLAMP_X);
        model->run.formulation = LD_FORMULATION_REDUCED;
    }
}

static void draw_stations(uint64_t seed, ld_tubes *tubes)
{
    tubes->station_count = chance(&seed, 0.3) ? 1 + choice(&seed, 3) : 0;
    if (isnan(tubes->material.youngs_modulus) && tubes->station_count)
        tubes->material.youngs_modulus = 2.1e11;
    for (int i = 0; i < tubes->station_count; i++) {
        ld_station *station = &tubes->station[i];
        station->at = i == 0 && chance(&seed, 0.3) ? 0 : between(&seed, 0, tubes->length);
        for (int k = 0; k < 2; k++)
            station->outer_fibre[k] = chance(&seed, 0.5) ? NAN : between(&seed, 0.05, 0.2);
    }
}

// A pressure that is given in place of a gas; no motor beside it.
static void draw_given_pressure(uint64_t seed, ld_model *model)
{
    ld_pressure *pressure = &model->tubes.pressure;
    if (!pressure->present)
        return;
    if (chance(&seed, 0.6)) {
        double most = pressure->pressure, rise = between(&seed, 1e-4, 0.01);
        *pressure = (ld_pressure){.present = true, .scale = between(&seed, 0.5, 1)};
        if (chance(&seed, 0.5)) {
            pressure->form = LD_PRESSURE_OVER_TIME;
            pressure->over_time = reference_table(
                4, 2, (double[]){0, 0, rise, most, 5 * rise, 0.3 * most, 5 * rise, 0.1 * most});
        } else {
            pressure->form = LD_PRESSURE_OVER_TRAVEL;
            pressure->over_travel =
                reference_table(3, 2, (double[]){0, most, 1, most / 2, 10, most / 10});
        }
    }
    if (chance(&seed, 0.3)) {
        ld_rocket *rocket = &model->rocket;
        free(rocket->motor.thrust.data);
        rocket->motor.thrust = (ld_table){0};
        rocket->motor.absent = true;
        rocket->empty = rocket->full;
        rocket->propellant = 0;
    }
}

// A guide that is bent by up to a millimetre a metre, and twisted.
static void draw_initial_shape(uint64_t seed, ld_tubes *tubes)
{
    double row[16], length = tubes->length;
    int rows = 2 + choice(&seed, 3), columns = 3 + choice(&seed, 2);
    if (chance(&seed, 0.7))
        return;
    for (int i = 0; i < rows; i++) {
        double *to = row + i * columns;
        to[0] = length * i / (rows - 1);
        for (int k = 1; k < columns; k++)
            to[k] = between(&seed, -2e-4, 2e-4) * length / rows * (k < 3 ? 1 : 10);
    }
    tubes->initial_shape =
        (ld_initial_shape){.present = true,
                           .scale = {between(&seed, -2, 2), between(&seed, -2, 2)},
                           .twist_scale = between(&seed, -2, 2),
                           .offsets = reference_table((size_t)rows, (size_t)columns, row)};
}

// A wind that the guide feels.
static void draw_wind_drag(uint64_t seed, ld_model *model)
{
    ld_tubes *tubes = &model->tubes;
    ld_wind *wind = &model->environment.wind;
    if (chance(&seed, 0.7))
        return;
    tubes->wind_drag_count = 1 + choice(&seed, 3);
    for (int i = 0; i < tubes->wind_drag_count; i++) {
        ld_wind_drag *one = &tubes->wind_drag[i];
        one->from = between(&seed, 0, 0.9) * tubes->length;
        one->to = between(&seed, one->from, tubes->length);
        one->width = between(&seed, 0, 0.5);
        one->coefficient = between(&seed, 0.1, 3);
    }
    wind->present = true;
    wind->speed = between(&seed, -20, 20);
    wind->heading = between(&seed, -3, 3);
    wind->turbulence.present = chance(&seed, 0.5);
    wind->turbulence.wind_at_6m = between(&seed, 1, 10);
}

// Columns that every launch has, taken in all ways, between instants that every rocket has.
static void draw_measures(uint64_t *seed, ld_model *model)
{
    static const char *const column[] = {"tip.pitch_rate", "rocket.s_dot", "lock.force", "tip.y"};
    static const char *const instant[] = {"t_ignition", "t_front", "t_rear"};
    for (int i = choice(seed, 4); i > 0; i--) {
        ld_measure *measure = &model->measure[model->measure_count++];
        int from = choice(seed, 2);
        measure->take = (ld_take)choice(seed, 5);
        measure->within[1] = 1e5;
        snprintf(measure->name, sizeof measure->name, "m%d", i);
        snprintf(measure->of, sizeof measure->of, "%s", column[choice(seed, 4)]);
        snprintf(measure->from, sizeof measure->from, "%s", instant[from]);
        if (measure->take != LD_TAKE_VALUE)
            snprintf(measure->to, sizeof measure->to, "%s", instant[from + 1]);
    }
}

// Ends of the guide of their own: the rear adaptor's last, some together with it or another one.
static void draw_ends(uint64_t seed, const ld_tubes *tubes, ld_rocket *rocket)
{
    if (!chance(&seed, 0.25))
        return;
    double start = rocket->start_at, last = between(&seed, start, tubes->length), early[2];
    rocket->adaptor[0].leaves_at = last;
    for (int k = 0; k < 2; k++)
        early[k] = between(&seed, start, last);
    for (int i = 1; i < rocket->adaptor_count; i++) {
        ld_adaptor *one = &rocket->adaptor[i];
        double with_rear = fmin(tubes->length, last + one->at);
        one->leaves_at = fmin(with_rear, early[choice(&seed, 2)] + one->at);
        if (chance(&seed, 0.3))
            one->leaves_at = with_rear;
    }
    for (int i = 0; i < rocket->adaptor_count; i++) {
        ld_adaptor *one = &rocket->adaptor[i];
        if (start + one->at >= one->leaves_at || chance(&seed, 0.5))
            continue;
        one->falls_off.present = true;
        one->falls_off.mass = rocket->empty.mass * between(&seed, 1e-3, 0.02);
        one->falls_off.center[0] = between(&seed, -0.02, 0.02);
        one->falls_off.inertia[0] = 1e-3 * rocket->empty.inertia[0];
    }
}

// Two corners of a table over time that begins at 0: y, z of each row.
static ld_table draw_rows(uint64_t *seed, size_t columns, double size)
{
    double row[15] = {0};
    for (size_t i = 0; i < 3; i++)
        for (size_t k = 0; k < columns; k++)
            row[i * columns + k] =
                k == 0 ? 0.03 * (double)i * between(seed, 0.7, 1) : size * draw(seed);
    return reference_table(3, columns, row);
}

// Thrust as it is: late, across the axis, by a nozzle that moves, of several motors; a guide whose
// drag goes with the speed.
static void draw_thrust(uint64_t seed, ld_rocket *rocket)
{
    ld_motor *motor = &rocket->motor;
    if (chance(&seed, 0.2))
        rocket->contact.drag_over_speed =
            reference_table(2, 2,
                            (double[]){between(&seed, 0, 3), between(&seed, 0, 500),
                                       between(&seed, 4, 30), between(&seed, 0, 500)});
    if (motor->absent || chance(&seed, 0.5))
        return;
    motor->delay = 0.01 * between(&seed, 0, 1);
    scale(&seed, &motor->rise_scale);
    ld_side_force *side = &motor->side_force;
    side->present = chance(&seed, 0.7);
    side->scale = between(&seed, -1, 1);
    side->angle = between(&seed, -3, 3);
    if (side->present)
        side->force = draw_rows(&seed, 3, 200);
    side->noise.present = side->present && chance(&seed, 0.5);
    side->noise.corner = between(&seed, 5, 100);
    side->noise.seed = choice(&seed, 100);
    side->noise.harmonics = 1 + choice(&seed, 30);
    if (side->noise.present)
        side->noise.deviation = reference_table(1, 2, (double[]){0, between(&seed, 0, 100)});
    if (chance(&seed, 0.5))
        motor->nozzle = draw_rows(&seed, 5, 1e-3);
    rocket->further_motor_count = choice(&seed, 4);
    for (int i = 0; i < rocket->further_motor_count; i++) {
        ld_further_motor *one = &rocket->further_motor[i];
        double force = between(&seed, 100, 3e3), end = between(&seed, 0.02, 2);
        *one = (ld_further_motor){.thrust_scale = 1, .time_scale = 1};
        one->thrust = reference_table(3, 2, (double[]){0, force, 0.01, force, end, 0.3 * force});
        scale(&seed, &one->thrust_scale);
        scale(&seed, &one->time_scale);
        one->delay = 0.1 * between(&seed, 0, 1);
        for (int k = 0; k < 3; k++)
            one->at[k] = 0.1 * draw(&seed);
        for (int k = 0; k < 2; k++)
            one->misalignment[k] = 0.05 * draw(&seed);
    }
}

void draw_random_model(uint64_t seed, ld_model *model)
{
    reference_model(model);
    for (int i = 0; i < 5; i++)
        draw(&seed);
    scale(&seed, &model->gravity);
    if (chance(&seed, 0.05))
        model->gravity = 0;
    draw_base(&seed, &model->base);
    draw_tubes(&seed, &model->tubes);
    draw_rocket(&seed, model->tubes.length, &model->rocket);
    draw_rocket_options(&seed, &model->rocket);
    draw_measures(&seed, model);
    draw_drive(&seed, model);
    ld_run_settings *run = &model->run;
    run->start = chance(&seed, 0.3) ? LD_START_UNDEFORMED : LD_START_EQUILIBRIUM;
    run->formulation = chance(&seed, 0.1) ? LD_FORMULATION_OVERALL : LD_FORMULATION_REDUCED;
    run->tolerance = pow(10, between(&seed, -7, -3));
    run->lead_in = chance(&seed, 0.3) ? 0.02 : 0;
    run->stuck_time = 0.3;
    model->firing[0].at = chance(&seed, 0.3) ? between(&seed, 0, 0.02) : 0;
    if (chance(&seed, 0.1)) {
        run->end = LD_END_TIME;
        run->end_time = between(&seed, 0.01, 0.3);
    }
    // by draws of their own, so that the others stay as they are
    draw_given_pressure(seed ^ 0x94d049bb, model);
    if (run->formulation == LD_FORMULATION_REDUCED) // the other one takes ten times the work
        draw_guide(seed ^ 0x85ebca6b, &model->tubes, &model->rocket);
    draw_clamps(seed ^ 0x9e3779b9, model);
    draw_stations(seed ^ 0x7f4a7c15, &model->tubes);
    draw_initial_shape(seed ^ 0x2545f491, &model->tubes);
    draw_wind_drag(seed ^ 0x6a09e667, model);
    draw_ends(seed ^ 0x1b873593, &model->tubes, &model->rocket);
    draw_thrust(seed ^ 0x3c6ef372, &model->rocket);
}

void draw_joint(uint64_t seed, ld_model *model)
{
    ld_initial_shape *shape = &model->tubes.initial_shape;
    double length = model->tubes.length;
    seed ^= 0x3c6ef372;
    if (chance(&seed, 0.6))
        return;
    if (!shape->present)
        *shape = (ld_initial_shape){.present = true, .scale = {1, 1}, .twist_scale = 1};
    ld_rail_joint *joint = &shape->joint[0];
    shape->joint_count = 1;
    joint->at = between(&seed, 0, length);
    joint->length = between(&seed, 0.01, 0.2);
    for (int k = 0; k < 2; k++) {
        joint->step[k] = between(&seed, -2e-4, 2e-4);
        joint->kink[k] = between(&seed, -5e-4, 5e-4);
    }
    shape->seed = choice(&seed, 100);
    shape->random.present = chance(&seed, 0.7);
    shape->random.deviation = between(&seed, 0, 3e-4) * length;
    shape->random.terms = 1 + choice(&seed, 8);
    shape->random.decay = between(&seed, 1, 3);
}

// ---- running ----

// When a column's number may be none.
typedef enum absence { NEVER, WITHOUT_ROCKET, AT_TIMES } absence;

typedef struct watcher {
    size_t columns;
    absence *none;
    char (*name)[LD_MAX_QUANTITY];
    long rows, not_finite, again; // `again`: at the instant of the row before
    double last;
    bool ascending;
} watcher;

// A passed adaptor has no place in the tube, a section without outer fibre no stress, before the
// ignition nothing is against its axes; a rocket that has left has no numbers.
static absence absence_of(const char *column)
{
    static const char *const at_times[] = {"contact.", "shoe.", "since_ignition."};
    static const char *const rocket[] = {"rocket.", "tip_off.",   "thrust",    "slot.",  "lock.",
                                         "breech.", "crossflow.", "pressure.", "center."};
    for (size_t i = 0; i < sizeof at_times / sizeof *at_times; i++)
        if (strncmp(column, at_times[i], strlen(at_times[i])) == 0)
            return AT_TIMES;
    size_t length = strlen(column);
    if (strncmp(column, "station.", 8) == 0 && strcmp(column + length - 7, ".stress") == 0)
        return AT_TIMES;
    for (size_t i = 0; i < sizeof rocket / sizeof *rocket; i++)
        if (strncmp(column, rocket[i], strlen(rocket[i])) == 0)
            return WITHOUT_ROCKET;
    return NEVER;
}

static ld_status begin(void *self, const ld_column *columns, size_t count, ld_error *error)
{
    (void)error;
    watcher *watch = self;
    *watch = (watcher){.columns = count, .ascending = true};
    watch->none = malloc(count * sizeof *watch->none);
    watch->name = malloc(count * sizeof *watch->name);
    assert_true(watch->none && watch->name);
    for (size_t i = 0; i < count; i++) {
        watch->none[i] = absence_of(columns[i].name);
        snprintf(watch->name[i], sizeof watch->name[i], "%s", columns[i].name);
    }
    return LD_OK;
}

static ld_status row(void *self, const double *values, size_t count, ld_error *error)
{
    (void)error;
    watcher *watch = self;
    bool gone = values[1] == 3; // phase
    watch->ascending = watch->ascending && (watch->rows == 0 || values[0] >= watch->last);
    watch->again += watch->rows > 0 && values[0] == watch->last;
    watch->last = values[0];
    watch->rows++;
    for (size_t i = 0; i < count; i++) {
        absence none = watch->none[i];
        bool may = none == AT_TIMES || (none == WITHOUT_ROCKET && gone);
        if (!isfinite(values[i]) && !may && watch->not_finite++ < 10)
            printf("      %s is %g in row %ld\n", watch->name[i], values[i], watch->rows);
    }
    return LD_OK;
}

static void check_sentence(const char *text)
{
    assert_true(strlen(text) > 20);
    assert_null(strstr(text, "nan"));
    assert_null(strstr(text, "inf"));
}

// What the balance misses, of the largest work and of what lifts the rocket by 1 m: a launcher at
// rest does hardly any work.
static void check_balance(const ld_model *model, const ld_energy *energy)
{
    double largest = 0, lift = model->rocket.full.mass * model->gravity;
    for (int i = 0; i < LD_MAX_WORKS; i++)
        largest = fmax(largest, fabs(energy->work[i]));
    // subsystems apart hear late of a slide's jumps: of first order in the step
    double late = model_slide_count(model) > 0 ? 10 * model->run.coupling_step : 0; // [s] * [1/s]
    double missed = fabs(energy->residual) / (largest + lift);
    bool much = !(missed < 10 * model->run.tolerance + late);
    if (much)
        printf("      the energy balance misses %.3g of %.3g J\n", energy->residual, largest);
    assert_false(much);
}

// Of rockets that have left: measures, and of a vehicle how its hinges were held.
static void check_results(const ld_model *model, const ld_summary *summary)
{
    for (int i = 0; i < summary->rocket_count; i++) {
        const ld_rocket_summary *rocket = &summary->rocket[i];
        bool left = isfinite(rocket->t_rear), held = model->base.kind == LD_BASE_VEHICLE;
        bool passes = left && isfinite(rocket->t_front); // it may have been out at the start
        for (int k = 0; k < model->measure_count && passes; k++)
            assert_true(isfinite(rocket->measure[k]));
        for (int k = 0; k < 2 && left && held; k++) {
            const ld_hinge_summary *hinge = &rocket->hinge[k];
            const double rounding = 1 + 1e-9;
            assert_true(hinge->error_rms >= 0);
            assert_true(hinge->torque_rms <= hinge->torque_peak * rounding);
            assert_true(hinge->power_mean <= hinge->power_peak * rounding);
            assert_true(hinge->saturated >= 0 && hinge->saturated <= rocket->t_rear + 1e-9);
        }
    }
}

// 0: refused, 1: could not happen, 2: happened.
static int run_random_model(int number, const ld_model *model)
{
    ld_error error = {0};
    ld_simulation *simulation = NULL;
    static ld_summary summary;
    watcher watch = {0};
    ld_sink sink = {.self = &watch, .begin = begin, .row = row};
    if (model_check(model, &error) || ld_simulation_create(model, &simulation, &error)) {
        printf("  %3d refused: %s\n", number, error.text);
        check_sentence(error.text);
        return 0;
    }
    ld_status status =
        ld_simulation_run(simulation, &(ld_run_options){.sink = &sink}, &summary, &error);
    ld_simulation_free(simulation);
    free(watch.none);
    free(watch.name);
    printf("  %3d %s%s: %ld rows, %lld steps, %.2f s\n", number, status ? "stopped: " : "went well",
           error.text, watch.rows, (long long)summary.statistics.steps,
           summary.statistics.cpu_seconds);
    assert_true(watch.not_finite == 0);
    assert_true(watch.rows == 0 || watch.ascending);
    assert_true(watch.again < model->firing_count); // where another tube takes its place
    assert_true(isfinite(summary.t_end));
    assert_true(summary.complete == (status == LD_OK));
    if (status) {
        bool vehicle = model->base.kind == LD_BASE_VEHICLE;
        assert_true(status == LD_ERR_LAUNCH || status == LD_ERR_NUMERIC ||
                    (vehicle && status == LD_ERR_INPUT));
        assert_string_equal(summary.stopped, error.text);
        check_sentence(error.text);
        return 1;
    }
    const ld_rocket_summary *rocket = &summary.rocket[0];
    if (model->run.end == LD_END_TIP) {
        assert_true(isfinite(rocket->t_rear) && isfinite(rocket->pitch_rate));
        assert_true(rocket->exit_speed > 0);
    }
    check_balance(model, &summary.energy);
    check_results(model, &summary);
    return 2;
}

static int from_environment(const char *name, int otherwise)
{
    const char *text = getenv(name);
    return text ? atoi(text) : otherwise;
}

void run_random_models(void (*draw_one)(uint64_t seed, ld_model *model), int otherwise)
{
    int count = from_environment("LD_RANDOM_MODELS", otherwise);
    int first = from_environment("LD_RANDOM_FIRST", 1), ends[3] = {0};
    for (int i = first; i < first + count; i++) {
        ld_model model;
        draw_one((uint64_t)i, &model);
        ends[run_random_model(i, &model)]++;
        reference_model_free(&model);
    }
    printf("  %d models: %d refused, %d could not happen, %d happened\n", count, ends[0], ends[1],
           ends[2]);
}

void run_random_model_again(void (*draw_one)(uint64_t seed, ld_model *model), int number)
{
    ld_model model;
    draw_one((uint64_t)number, &model);
    run_random_model(number, &model);
    reference_model_free(&model);
}
