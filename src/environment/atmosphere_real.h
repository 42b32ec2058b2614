// The US Standard Atmosphere over reals (math/real.h).
#ifndef LD_ENVIRONMENT_ATMOSPHERE_REAL_H
#define LD_ENVIRONMENT_ATMOSPHERE_REAL_H

#include "environment/atmosphere_layer.h"
#include "math/curves/curves_real.h"
#include "math/real_functions.h"

#define ATMOSPHERE_GRAVITY 9.80665                  // [m/s2] g_0'
#define ATMOSPHERE_GAS_CONSTANT (8314.32 / 28.9644) // [J/(kg K)] R*/M_0
#define ATMOSPHERE_RATIO_OF_HEATS 1.4               // gamma
#define ATMOSPHERE_EARTH_RADIUS 6356766.0           // [m] r_0
#define ATMOSPHERE_TOP 86000.0                      // [m] geometric

typedef struct real_layer {
    real base, lapse, temperature, density; // as in atmosphere_layer
    real exponent;
} real_layer;

LD_INLINE int atmosphere_layer_number(const atmosphere_layer *layer, double H)
{
    int i = 0;
    while (i + 1 < ATMOSPHERE_LAYERS && H >= layer[i + 1].base)
        i++;
    return i;
}

// The layer of the geopotential height H.
LD_INLINE real_layer atmosphere_layer_at(const atmosphere_layer *layer, real H)
{
    real_layer out = {real_all(layer->base), real_all(layer->lapse), real_all(layer->temperature),
                      real_all(layer->density), real_all(layer->exponent)};
    for (int i = 1; i < ATMOSPHERE_LAYERS; i++) {
        real_condition above = H >= layer[i].base;
        if (!real_any(above))
            break;
        out.base = real_select(above, real_all(layer[i].base), out.base);
        out.lapse = real_select(above, real_all(layer[i].lapse), out.lapse);
        out.temperature = real_select(above, real_all(layer[i].temperature), out.temperature);
        out.density = real_select(above, real_all(layer[i].density), out.density);
        out.exponent = real_select(above, real_all(layer[i].exponent), out.exponent);
    }
    return out;
}

LD_INLINE real atmosphere_geopotential(real altitude)
{
    return ATMOSPHERE_EARTH_RADIUS * altitude / (ATMOSPHERE_EARTH_RADIUS + altitude);
}

// Ratio of the pressure at geopotential height H to that at the layer's base; T: temperature at H.
LD_INLINE real atmosphere_pressure_ratio(const real_layer *layer, real H, real T)
{
    real_condition isothermal = layer->lapse == 0.0;
    real_pair log_ratio = {real_all(0), real_all(0)};
    if (real_any(layer->lapse != 0.0))
        log_ratio = real_log_power(T, layer->temperature, layer->exponent);
    if (real_any(isothermal)) {
        real fall =
            ATMOSPHERE_GRAVITY * (H - layer->base) / (ATMOSPHERE_GAS_CONSTANT * layer->temperature);
        log_ratio.high = real_select(isothermal, -fall, log_ratio.high);
        log_ratio.low = real_select(isothermal, real_all(0), log_ratio.low);
    }
    return real_exp(log_ratio);
}

// Air at an altitude.
typedef struct real_air {
    real density, speed_of_sound; // [kg/m3], [m/s]
} real_air;

// Of this density up to the top at the temperature, nothing above.
LD_INLINE real_air atmosphere_air(real altitude, real density, real temperature)
{
    return (real_air){real_select(altitude <= ATMOSPHERE_TOP, density, real_all(0)),
                      real_sqrt(ATMOSPHERE_RATIO_OF_HEATS * ATMOSPHERE_GAS_CONSTANT * temperature)};
}

// At a geometric altitude [m].
LD_INLINE real_air atmosphere_standard(const atmosphere_layer *layers, real altitude,
                                       real density_scale, real temperature_offset)
{
    real H = atmosphere_geopotential(
        real_select(altitude < ATMOSPHERE_TOP, altitude, real_all(ATMOSPHERE_TOP)));
    real_layer layer = atmosphere_layer_at(layers, H);
    real T = layer.temperature + layer.lapse * (H - layer.base), warm = T + temperature_offset;
    // rho = p/(R T), the pressure being that of the standard whatever the offset
    real rho = density_scale * layer.density * atmosphere_pressure_ratio(&layer, H, T) *
               layer.temperature / warm;
    return atmosphere_air(altitude, rho, warm);
}

// Measured air at an altitude, its interval kept.
LD_INLINE real_air atmosphere_measured(const real *kept, real altitude, real density_scale,
                                       real temperature_offset)
{
    real held = real_select(altitude < ATMOSPHERE_TOP, altitude, real_all(ATMOSPHERE_TOP));
    real k[ATMOSPHERE_FUNCTIONS];
    curves_kept_values(kept, held, ATMOSPHERE_FUNCTIONS, k);
    real T = k[1], warm = T + temperature_offset;
    real rho =
        density_scale * real_exp((real_pair){k[0], real_all(0)}) / (ATMOSPHERE_GAS_CONSTANT * warm);
    return atmosphere_air(altitude, rho, warm);
}

#endif
