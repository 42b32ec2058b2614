// Air: US Standard Atmosphere 1976 to 86 km, measured, uniform, or none (model.md, section 8).
#ifndef LD_ENVIRONMENT_ATMOSPHERE_H
#define LD_ENVIRONMENT_ATMOSPHERE_H

#include "environment/atmosphere_layer.h"
#include "math/curves/curves.h"
#include "model/blocks/environment.h"

typedef struct atmosphere {
    ld_atmosphere_kind kind;
    double density, speed_of_sound; // uniform
    double density_scale, temperature_offset;
    atmosphere_layer layer[ATMOSPHERE_LAYERS];
    curves profile; // measured: logarithm of the pressure [Pa] and virtual temperature [K] over the
                    // altitude [m]
    ld_table given; // that it is of, owned
} atmosphere;

typedef struct air {
    double density;        // [kg/m3]
    double speed_of_sound; // [m/s], > 0 also where there is no air
} air;

ld_status atmosphere_build(atmosphere *self, const ld_atmosphere *model, ld_error *error);
// The same of one that was built, or is all 0: an equal profile is kept.
ld_status atmosphere_renew(atmosphere *self, const ld_atmosphere *model, ld_error *error);
void atmosphere_free(atmosphere *self);

// Air at a geometric altitude [m]. us1976: perfect gas in hydrostatic layers of constant lapse rate
// over geopotential height (U.S. Standard Atmosphere 1976, equations 18, 23, 33a, 33b, 42, 50);
// below the lowest layer that one continues, above 86 km the density is 0. Measured: temperature by
// pchip over the altitude, the pressure's logarithm by the cubic that has the rows' pressures and
// is hydrostatic at the rows, dp/dz = -p g/(R T_v); where the rows end us1976 continues, T and log
// p scaled so that they meet and stay hydrostatic: s T(z), p(z)^(1/s).
air atmosphere_at(const atmosphere *self, double altitude);

// Temperature [K] (molecular-scale, as the standard's to 80 km) and pressure [Pa] of us1976,
// without offset and scale.
void atmosphere_state(const atmosphere *self, double altitude, double *temperature,
                      double *pressure);

#endif
