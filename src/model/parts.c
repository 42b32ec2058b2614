#include "model/parts.h"

#include "model/model.h"

const char *model_title(const ld_model *model)
{
    return model->title;
}

double model_gravity(const ld_model *model)
{
    return model->gravity;
}

int model_firing_count(const ld_model *model)
{
    return model->firing_count;
}

int model_measure_count(const ld_model *model)
{
    return model->measure_count;
}

int model_sweep_count(const ld_model *model)
{
    return model->sweep_count;
}

const ld_base *model_base(const ld_model *model)
{
    return &model->base;
}

const ld_environment *model_environment(const ld_model *model)
{
    return &model->environment;
}

const ld_flight *model_flight(const ld_model *model)
{
    return &model->flight;
}

const ld_platform *model_platform(const ld_model *model)
{
    return &model->platform;
}

const ld_rocket *model_rocket(const ld_model *model)
{
    return &model->rocket;
}

const ld_run_settings *model_run(const ld_model *model)
{
    return &model->run;
}

const ld_optimise *model_optimise(const ld_model *model)
{
    return &model->optimise;
}

const ld_scatter *model_scatter(const ld_model *model)
{
    return &model->scatter;
}

const ld_tubes *model_tubes(const ld_model *model)
{
    return &model->tubes;
}

const ld_firing *model_firing(const ld_model *model, int i)
{
    return &model->firing[i];
}

const ld_measure *model_measure(const ld_model *model, int i)
{
    return &model->measure[i];
}

const ld_sweep_axis *model_sweep(const ld_model *model, int i)
{
    return &model->sweep[i];
}

bool model_has_launcher(const ld_model *model)
{
    return model->base.kind != LD_BASE_NONE;
}

bool model_base_is_external(const ld_model *model)
{
    return model->base.kind == LD_BASE_EXTERNAL;
}

bool model_base_goes_by_time(const ld_model *model)
{
    return model->base.kind == LD_BASE_FIXED || model->base.kind == LD_BASE_PRESCRIBED;
}

void model_make_base_external(ld_model *model)
{
    model->base.kind = LD_BASE_EXTERNAL;
}

bool model_has_vehicle(const ld_model *model)
{
    return model->base.kind == LD_BASE_VEHICLE;
}

int model_hinge_count(const ld_model *model)
{
    return !model_has_vehicle(model) ? 0 : model->platform.has_azimuth ? 2 : 1;
}

static bool is_azimuth(const ld_model *model, int i)
{
    return i == 0 && model->platform.has_azimuth;
}

const ld_turret *model_hinge(const ld_model *model, int i)
{
    return is_azimuth(model, i) ? &model->platform.azimuth : &model->platform.elevation;
}

const char *model_hinge_name(const ld_model *model, int i)
{
    return is_azimuth(model, i) ? "azimuth" : "elevation";
}

bool model_has_multibody(const ld_model *model)
{
    return model->base.kind == LD_BASE_MULTIBODY;
}

bool model_has_surfaces(const ld_model *model)
{
    return model_has_launcher(model) && model->tubes.guide.present;
}

const char *model_guide_word(const ld_model *model)
{
    const ld_guide *guide = &model->tubes.guide;
    bool tower = guide->form == LD_GUIDE_TOWER;
    return !model_has_surfaces(model) ? "tube" : tower ? "tower" : "rail";
}

bool model_has_slot(const ld_model *model)
{
    return model_has_launcher(model) && model->tubes.slot.kind == LD_SLOT_HELIX;
}

bool model_has_crossflow(const ld_model *model)
{
    const ld_aerodynamics *given = &model->rocket.aerodynamics;
    return model_has_launcher(model) && given->present && given->emerged.present;
}

bool model_has_open_air(const ld_model *model)
{
    return model_has_surfaces(model) && model->rocket.aerodynamics.present;
}

bool model_feels_air(const ld_model *model)
{
    return model_has_crossflow(model) || model_has_open_air(model);
}

bool model_has_guide_wind(const ld_model *model)
{
    return model_has_launcher(model) && model->tubes.wind_drag_count > 0;
}

bool model_has_jet(const ld_model *model)
{
    return model_has_vehicle(model) && model->platform.jet.rows > 0;
}

bool model_has_guide_jet(const ld_model *model)
{
    const ld_tubes *tubes = &model->tubes;
    return model_has_launcher(model) &&
           (tubes->jet.rows > 0 || tubes->jet_face.present || tubes->deflector.present);
}

bool model_has_jets(const ld_model *model)
{
    return model_has_jet(model) || model_has_guide_jet(model);
}

bool model_has_pressure(const ld_model *model)
{
    return model_has_launcher(model) && model->tubes.pressure.present;
}

int model_slide_count(const ld_model *model)
{
    int count = 0;
    for (int i = 0; i < model->tubes.support_count; i++)
        count += model->tubes.support[i].recoil.present;
    return model_has_launcher(model) ? count : 0;
}
