#include "math/functions.h"
#include "model/fields/field.h"
#include "model/fields/source.h"
#include "model/model.h"
#include "model/parts.h"

#include <stdlib.h>
#include <string.h>

#include "model/masses.h"
#include "model/motor_clock.h"

void model_init(ld_model *model)
{
    memset(model, 0, sizeof *model);
    field_initialise(&scenario_block, model);
    model->firing_count = 1;
    model->firing[0] = (ld_firing){.tube = 1};
    model->environment.ground_height = NAN;
}

void model_clear(ld_model *model)
{
    field_release(&scenario_block, model);
    source_free(model->source);
    model_init(model);
}

void ld_model_free(ld_model *model)
{
    if (model)
        model_clear(model);
    free(model);
}

// Saint-Venant torsion and polar inertia of a ring; E A, E I, G I_t.
static void complete_section(ld_section *section, const ld_material *material)
{
    double E = material->youngs_modulus, nu = material->poisson_ratio;
    double G = isnan(nu) ? material->shear_modulus : E / (2 * (1 + nu));
    if (section->form == LD_SECTION_STIFFNESS || section->form == LD_SECTION_PLANES)
        return;
    if (section->form == LD_SECTION_ANNULUS) {
        double r = section->bore_radius, R = section->outer_radius;
        double pi = 3.14159265358979323846;
        double area = pi * (R - r) * (R + r);
        section->area = area;
        section->second_moment = area * (R * R + r * r) / 4;
        section->torsion_constant = 2 * section->second_moment;
        section->mass_per_length = material->density * area;
        section->polar_inertia = material->density * section->torsion_constant;
    }
    section->axial_stiffness = E * section->area;
    section->bending_stiffness = E * section->second_moment;
    section->torsion_stiffness = G * section->torsion_constant;
}

// A flight alone may leave out what its rocket has not.
static void complete_flight(ld_model *model)
{
    ld_rocket *rocket = &model->rocket;
    for (int i = 0; i < 3; i++)
        if (isnan(rocket->full.center[i]))
            rocket->full.center[i] = 0;
    rocket->motor.absent = rocket->motor.absent || rocket->motor.thrust.rows == 0;
    if (model->run.end == LD_END_TIP)
        model->run.end = LD_END_LANDING;
}

// Where there is none fills in the value, which is then one that was completed.
static void complete_number(double *number, double value, bool *completed)
{
    if (!isnan(*number))
        return;
    *number = value;
    *completed = true;
}

// What is not said of the empty rocket is as in the last row of its masses, or as of the full one.
static void complete_empty(ld_model *model)
{
    ld_mass_data *empty = &model->rocket.empty;
    const ld_rocket *rocket = &model->rocket;
    size_t rows = rocket->motor.masses.rows;
    ld_mass_data last = rows > 0 ? masses_at(rocket, rows - 1) : rocket->full;
    if (rows > 0 && rocket->further_motor_count > 0) {
        v3 center;
        m3 grown = masses_of_parts(rocket, INFINITY, &last.mass, &center);
        v3_store(last.center, center);
        for (int i = 0; i < 3; i++)
            last.inertia[i] = rocket->full.inertia[i] + grown.a[i][i];
    }
    complete_number(&empty->mass, last.mass, &model->completed.empty_mass);
    for (int i = 0; i < 3; i++) {
        complete_number(&empty->center[i], last.center[i], &model->completed.empty_center[i]);
        complete_number(&empty->inertia[i], last.inertia[i], &model->completed.empty_inertia[i]);
    }
}

static void complete_firing(ld_model *model)
{
    const ld_firing_order *order = &model->firing_order;
    if (!order->present)
        return;
    model->firing_count = order->tube_count;
    for (int i = 0; i < order->tube_count; i++)
        model->firing[i] = (ld_firing){order->tube[i], order->start + i * order->interval};
}

// A step's error grows with its fifth power; at 1e-5 and below the step that touches need is
// enough. Many modes allow no longer one, for stability.
static double longest_step(double tolerance)
{
    return 2e-4 * pow(fmax(1, tolerance / 1e-5), 0.2);
}

// Time of the last row of a table over time; 0 without one.
static double last_time(const ld_table *table)
{
    return table->rows > 0 ? table->data[(table->rows - 1) * table->columns] : 0;
}

// When a rocket that has not left is given up: what is driven by no clock has ten seconds.
static double time_to_leave(const ld_model *model)
{
    const ld_motor *motor = &model->rocket.motor;
    double end = fmax(motor_clock(motor, last_time(&motor->thrust)),
                      last_time(&model->tubes.pressure.over_time));
    for (int i = 0; i < model->rocket.further_motor_count; i++) {
        const ld_further_motor *further = &model->rocket.further_motor[i];
        end = fmax(end, further_motor_clock(further, last_time(&further->thrust)));
    }
    return end > 0 ? end + 1 : 10;
}

static void complete_run(ld_model *model)
{
    ld_run_settings *run = &model->run;
    if (model->rocket.motor.thrust.rows > 0 || model_has_pressure(model))
        complete_number(&run->stuck_time, time_to_leave(model), &model->completed.stuck_time);
    complete_number(&run->max_step, longest_step(run->tolerance), &model->completed.max_step);
}

// Joints by kind, and the stiffnesses of beams.
static void complete_mechanism(ld_mechanism *mechanism)
{
    int names = 0;
    for (int kind = 0; kind < LD_JOINT_KINDS; kind++) {
        mechanism->named[kind].first = names;
        for (int i = 0; i < mechanism->joint_count; i++)
            if ((int)mechanism->joint[i].kind == kind)
                memcpy(mechanism->joint_name[names++], mechanism->joint[i].name,
                       sizeof mechanism->joint[i].name);
        mechanism->named[kind].count = names - mechanism->named[kind].first;
    }
    for (int i = 0; i < mechanism->beam_count; i++)
        for (int k = 0; k < mechanism->beam[i].section_count; k++)
            complete_section(&mechanism->beam[i].section[k], &mechanism->beam[i].material);
}

void model_complete(ld_model *model)
{
    complete_mechanism(&model->base.mechanism);
    ld_environment *environment = &model->environment;
    bool flat = environment->earth.kind == LD_EARTH_FLAT;
    complete_number(&environment->ground_height, flat ? 0 : environment->site.altitude,
                    &model->completed.ground_height);
    complete_firing(model);
    ld_tubes *tubes = &model->tubes;
    ld_rocket *rocket = &model->rocket;
    for (int i = 0; i < tubes->section_count; i++)
        complete_section(&tubes->section[i], &tubes->material);
    if (!model_has_launcher(model))
        complete_flight(model);
    complete_empty(model);
    complete_number(&rocket->propellant, rocket->full.mass - rocket->empty.mass,
                    &model->completed.propellant);
    complete_run(model);
}

static void forget(double *number, bool *completed)
{
    *number = *completed ? NAN : *number;
    *completed = false;
}

void model_forget(ld_model *model)
{
    ld_mass_data *empty = &model->rocket.empty;
    forget(&model->environment.ground_height, &model->completed.ground_height);
    forget(&empty->mass, &model->completed.empty_mass);
    for (int i = 0; i < 3; i++) {
        forget(&empty->center[i], &model->completed.empty_center[i]);
        forget(&empty->inertia[i], &model->completed.empty_inertia[i]);
    }
    forget(&model->rocket.propellant, &model->completed.propellant);
    forget(&model->run.stuck_time, &model->completed.stuck_time);
    forget(&model->run.max_step, &model->completed.max_step);
}
