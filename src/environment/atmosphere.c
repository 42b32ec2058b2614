#include "environment/atmosphere.h"

#include <math.h>

static const double gravity = 9.80665;                // [m/s2] g_0'
static const double gas_constant = 8314.32 / 28.9644; // [J/(kg K)] R*/M_0
static const double ratio_of_heats = 1.4;             // gamma
static const double earth_radius = 6356766;           // [m] r_0
static const double top = 86000;                      // [m] geometric
static const double layer_base[] = {0, 11000, 20000, 32000, 47000, 51000, 71000};
static const double layer_lapse[] = {-6.5e-3, 0, 1e-3, 2.8e-3, 0, -2.8e-3, -2e-3};

// Ratio of the pressure at geopotential height H to that at the layer's base; T: temperature at H.
static double pressure_ratio(const atmosphere_layer *layer, double H, double T)
{
    if (layer->lapse == 0)
        return exp(-gravity * (H - layer->base) / (gas_constant * layer->temperature));
    return pow(T / layer->temperature, -gravity / (gas_constant * layer->lapse));
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
        *layer = (atmosphere_layer){layer_base[i], layer_lapse[i], T, p, p / (gas_constant * T)};
        if (i + 1 < ATMOSPHERE_LAYERS) {
            T += layer->lapse * (layer_base[i + 1] - layer->base);
            p *= pressure_ratio(layer, layer_base[i + 1], T);
        }
    }
}

static const atmosphere_layer *layer_at(const atmosphere *self, double H)
{
    int i = 0;
    while (i + 1 < ATMOSPHERE_LAYERS && H >= self->layer[i + 1].base)
        i++;
    return &self->layer[i];
}

static double geopotential(double altitude)
{
    return earth_radius * altitude / (earth_radius + altitude);
}

void atmosphere_state(const atmosphere *self, double altitude, double *temperature,
                      double *pressure)
{
    double H = geopotential(altitude);
    const atmosphere_layer *layer = layer_at(self, H);
    *temperature = layer->temperature + layer->lapse * (H - layer->base);
    *pressure = layer->pressure * pressure_ratio(layer, H, *temperature);
}

static air standard_air(const atmosphere *self, double altitude)
{
    double low = altitude < top ? altitude : top;
    double H = geopotential(low);
    const atmosphere_layer *layer = layer_at(self, H);
    double T = layer->temperature + layer->lapse * (H - layer->base);
    double warm = T + self->temperature_offset;
    double density = 0;
    // rho = p/(R T), the pressure being that of the standard whatever the offset
    if (altitude <= top)
        density = self->density_scale * layer->density * pressure_ratio(layer, H, T) *
                  layer->temperature / warm;
    return (air){density, sqrt(ratio_of_heats * gas_constant * warm)};
}

air atmosphere_at(const atmosphere *self, double altitude)
{
    if (self->kind == LD_ATMOSPHERE_US1976)
        return standard_air(self, altitude);
    if (self->kind == LD_ATMOSPHERE_UNIFORM)
        return (air){self->density_scale * self->density, self->speed_of_sound};
    return (air){0, 1};
}
