// A layer of the US Standard Atmosphere.
#ifndef LD_ENVIRONMENT_ATMOSPHERE_LAYER_H
#define LD_ENVIRONMENT_ATMOSPHERE_LAYER_H

enum { ATMOSPHERE_LAYERS = 7 };
enum { ATMOSPHERE_FUNCTIONS = 2 }; // of measured air

typedef struct atmosphere_layer {
    double base;        // [m] geopotential height where it begins
    double lapse;       // [K/m]
    double temperature; // [K] at the base
    double pressure;    // [Pa] at the base
    double density;     // [kg/m3] at the base
    double exponent;    // of T/T_b in the ratio of pressures, -g_0'/(R lapse); isothermal: 0
} atmosphere_layer;

#endif
