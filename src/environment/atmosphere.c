#define LANES 1
#include "environment/atmosphere.h"

#include "environment/atmosphere_real.h"

static const double layer_base[] = {0, 11000, 20000, 32000, 47000, 51000, 71000};
static const double layer_lapse[] = {-6.5e-3, 0, 1e-3, 2.8e-3, 0, -2.8e-3, -2e-3};

static double pressure_ratio(const atmosphere_layer *layer, double H, double T)
{
    const real_layer here = {layer->base, layer->lapse, layer->temperature, layer->density,
                             layer->exponent};
    return atmosphere_pressure_ratio(&here, H, T);
}

void atmosphere_build(atmosphere *self, const ld_atmosphere *model)
{
    *self = (atmosphere){.kind = model->kind,
                         .density = model->density,
                         .speed_of_sound = model->speed_of_sound,
                         .density_scale = model->density_scale,
                         .temperature_offset = model->temperature_offset};
    double T = 288.15, p = 101325;
    for (int i = 0; i < ATMOSPHERE_LAYERS; i++) {
        atmosphere_layer *layer = &self->layer[i];
        double lapse = layer_lapse[i];
        *layer = (atmosphere_layer){
            .base = layer_base[i],
            .lapse = lapse,
            .temperature = T,
            .pressure = p,
            .density = p / (ATMOSPHERE_GAS_CONSTANT * T),
            .exponent = lapse == 0 ? 0 : -ATMOSPHERE_GRAVITY / (ATMOSPHERE_GAS_CONSTANT * lapse),
        };
        if (i + 1 < ATMOSPHERE_LAYERS) {
            T += layer->lapse * (layer_base[i + 1] - layer->base);
            p *= pressure_ratio(layer, layer_base[i + 1], T);
        }
    }
}

void atmosphere_state(const atmosphere *self, double altitude, double *temperature,
                      double *pressure)
{
    double H = atmosphere_geopotential(altitude);
    const atmosphere_layer *layer = self->layer + atmosphere_layer_number(self->layer, H);
    *temperature = layer->temperature + layer->lapse * (H - layer->base);
    *pressure = layer->pressure * pressure_ratio(layer, H, *temperature);
}

air atmosphere_at(const atmosphere *self, double altitude)
{
    air out = {0, 1};
    if (self->kind == LD_ATMOSPHERE_US1976)
        atmosphere_standard(self->layer, altitude, self->density_scale, self->temperature_offset,
                            &out.density, &out.speed_of_sound);
    else if (self->kind == LD_ATMOSPHERE_UNIFORM)
        out = (air){self->density_scale * self->density, self->speed_of_sound};
    return out;
}
