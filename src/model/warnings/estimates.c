// Estimates from a model's keys that several rules of plausibility share.
#include "model/warnings/estimates.h"

#include "math/functions.h"
#include "model/fields/field.h"
#include "model/model.h"
#include "model/parts.h"

#define PI 3.14159265358979323846

double estimate_bore(const ld_model *model)
{
    bool guides = model_has_launcher(model) && !model_has_surfaces(model);
    return guides ? model->tubes.section[0].bore_radius : NAN;
}

double estimate_tube_mass(const ld_tubes *tubes)
{
    double mass = tubes->tail.mass;
    for (int i = 0; i < tubes->section_count; i++) {
        const ld_section *s = &tubes->section[i];
        double end = i + 1 < tubes->section_count ? s[1].from : tubes->length;
        mass += s->mass_per_length * (end - s->from);
    }
    for (int i = 0; i < tubes->point_mass_count; i++)
        mass += tubes->point_mass[i].mass;
    return mass;
}

double estimate_peak_thrust(const ld_motor *motor)
{
    double peak = 0;
    for (size_t i = 0; i < motor->thrust.rows; i++)
        peak = fmax(peak, motor->thrust.data[2 * i + 1]);
    return peak * motor->thrust_scale;
}

double estimate_impulse(const ld_motor *motor)
{
    double impulse = 0;
    for (size_t i = 1; i < motor->thrust.rows; i++) {
        const double *a = &motor->thrust.data[2 * (i - 1)], *b = &motor->thrust.data[2 * i];
        impulse += (b[0] - a[0]) * (fmax(a[1], 0) + fmax(b[1], 0)) / 2;
    }
    return impulse * motor->thrust_scale * motor->time_scale;
}

double estimate_burn_time(const ld_motor *motor)
{
    const ld_table *thrust = &motor->thrust;
    return thrust->rows > 0 ? thrust->data[2 * (thrust->rows - 1)] * motor->time_scale : 0;
}

double estimate_peak_pressure(const ld_model *model)
{
    const ld_pressure *given = &model->tubes.pressure;
    const ld_table *table =
        given->form == LD_PRESSURE_OVER_TIME ? &given->over_time : &given->over_travel;
    double bore = estimate_bore(model), peak = 0;
    if (!model_has_pressure(model))
        return 0;
    for (size_t i = 0; i < table->rows; i++)
        peak = fmax(peak, table->data[2 * i + 1]);
    if (given->form == LD_PRESSURE_OF_GAS)
        peak = given->pressure;
    return fmax(0, given->scale * peak - given->ambient) * PI * bore * bore;
}

double estimate_peak_drive(const ld_model *model)
{
    return estimate_peak_thrust(&model->rocket.motor) + estimate_peak_pressure(model);
}

double estimate_weight_along(const ld_model *model)
{
    const ld_table *command = &model->platform.elevation.stabiliser.command;
    double lowest = field_number(model, "base.elevation");
    for (size_t i = 0; i < command->rows && model_has_vehicle(model); i++)
        lowest = fmin(lowest, command->data[2 * i + 1]);
    return model->rocket.full.mass * model->gravity * sin(lowest);
}

double estimate_time_in_tube(const ld_model *model)
{
    double weight = estimate_weight_along(model);
    double force = estimate_peak_drive(model) - (isnan(weight) ? 0 : weight);
    double way = model->tubes.length - model->rocket.start_at;
    return force > 0 ? sqrt(2 * way * model->rocket.full.mass / force) : NAN;
}

double estimate_front(const ld_model *model)
{
    double front = NAN;
    for (int i = 0; i < model->rocket.adaptor_count && model_has_launcher(model); i++)
        front = fmax(front, model->rocket.adaptor[i].at);
    return front;
}

double estimate_carried_mass(const ld_model *model)
{
    const ld_tubes *tubes = &model->tubes;
    int count = tubes->layout.rows * tubes->layout.columns;
    return model->platform.azimuth.mass + model->platform.elevation.mass +
           count * estimate_tube_mass(tubes) +
           (count - tubes->empty_count) * model->rocket.full.mass;
}

double estimate_sprung_mass(const ld_model *model)
{
    return model->platform.chassis_mass + estimate_carried_mass(model);
}

double estimate_heave_frequency(const ld_model *model)
{
    const ld_vehicle *vehicle = &model->base.vehicle;
    double stiffness = vehicle->wheel_count * vehicle->suspension.stiffness[1];
    return sqrt(stiffness / estimate_sprung_mass(model)) / (2 * PI);
}

double estimate_tubes_inertia(const ld_model *model)
{
    const ld_tubes *tubes = &model->tubes;
    int count = tubes->layout.rows * tubes->layout.columns;
    double mass =
        count * estimate_tube_mass(tubes) + (count - tubes->empty_count) * model->rocket.full.mass;
    double arm = tubes->layout.first[0] + tubes->length / 2;
    return mass * (tubes->length * tubes->length / 12 + arm * arm);
}
