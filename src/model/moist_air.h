// Moist air as dry air of another temperature.
#ifndef LD_MODEL_MOIST_AIR_H
#define LD_MODEL_MOIST_AIR_H

#include "math/functions.h"

// Pressure of water vapour [Pa] at a temperature [K] and a relative humidity over water, by the
// Magnus formula with the numbers of the WMO (Guide to Instruments and Methods of Observation,
// WMO-No. 8, volume I, annex 4.B).
static inline double vapour_pressure(double temperature, double humidity)
{
    double celsius = temperature - 273.15;
    return humidity * 611.2 * exp(17.62 * celsius / (243.12 + celsius));
}

// The temperature [K] at which dry air of the same pressure is as dense: T/(1 - (1 - M_w/M_d) e/p).
static inline double virtual_temperature(double pressure, double temperature, double humidity)
{
    const double lighter = 1 - 18.01528 / 28.9644;
    return temperature / (1 - lighter * vapour_pressure(temperature, humidity) / pressure);
}

#endif
