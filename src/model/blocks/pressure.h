/// The pressure that drives the rocket out: the block `tubes.pressure`.
#ifndef LD_MODEL_BLOCKS_PRESSURE_H
#define LD_MODEL_BLOCKS_PRESSURE_H

#include <stdbool.h>

#include "model/blocks/table.h"

typedef enum ld_pressure_form {
    LD_PRESSURE_OVER_TIME,
    LD_PRESSURE_OVER_TRAVEL,
    LD_PRESSURE_OF_GAS,
} ld_pressure_form;

/// Pressure on the rocket's rear while it is in its tube: model.md, section 5.
typedef struct ld_pressure {
    bool present;
    ld_pressure_form form;
    ld_table over_time;   ///< t [s] since the ignition, p [Pa]; linear between, 0 after the last; a
                          ///< time given twice is a jump
    ld_table over_travel; ///< s - start_at [m], p [Pa]; pchip, up to the tip
    double scale;         ///< [-] factor on the pressure
    double pressure;      ///< [Pa] p_0 of cold gas, absolute
    double volume;        ///< [m3] V_0 at the start
    double exponent;      ///< [-] kappa
    double ambient;       ///< [Pa] p_a, before the rocket
} ld_pressure;

#endif
