// Air: US Standard Atmosphere 1976 to 86 km, uniform, or none (model.md, section 8).
#ifndef LD_ENVIRONMENT_ATMOSPHERE_H
#define LD_ENVIRONMENT_ATMOSPHERE_H

#include "environment/atmosphere_layer.h"
#include "model/model.h"

typedef struct atmosphere {
    ld_atmosphere_kind kind;
    double density, speed_of_sound; // uniform
    double density_scale, temperature_offset;
    atmosphere_layer layer[ATMOSPHERE_LAYERS];
} atmosphere;

typedef struct air {
    double density;        // [kg/m3]
    double speed_of_sound; // [m/s], > 0 also where there is no air
} air;

void atmosphere_build(atmosphere *self, const ld_atmosphere *model);

// Air at a geometric altitude [m]. us1976: perfect gas in hydrostatic layers of constant lapse rate
// over geopotential height (U.S. Standard Atmosphere 1976, equations 18, 23, 33a, 33b, 42, 50);
// below the lowest layer that one goes on, above 86 km the density is 0.
air atmosphere_at(const atmosphere *self, double altitude);

// Temperature [K] (molecular-scale, as the standard's to 80 km) and pressure [Pa] of us1976,
// without offset and scale.
void atmosphere_state(const atmosphere *self, double altitude, double *temperature,
                      double *pressure);

#endif
