/// Parachutes and air brakes: the blocks `rocket.parachutes` and `rocket.air_brakes`.
#ifndef LD_MODEL_BLOCKS_DRAG_DEVICES_H
#define LD_MODEL_BLOCKS_DRAG_DEVICES_H

#include <stdbool.h>

#include "model/blocks/limits.h"
#include "model/blocks/table.h"

typedef enum ld_trigger { LD_TRIGGER_APOGEE, LD_TRIGGER_TIME, LD_TRIGGER_HEIGHT } ld_trigger;

/// The canopy of a parachute as a body of its own, on lines: model.md, section 8.
typedef struct ld_canopy {
    bool present;
    double mass;           ///< [kg] of the rocket's until it opens
    double line_length;    ///< [m] unstretched, from the rocket to the canopy
    double line_stiffness; ///< [N] EA of all lines: tension over strain
    double damping;        ///< [-] of canopy against rocket, of the critical one
    double at[3];          ///< [m] where the lines are attached, in B
    double ejection[3];    ///< [m/s] against that point, in B
    double packed_area;    ///< [m2] C_D S until the lines are taut
    double air_volume;     ///< [m3] of air that moves with it when full
    double strength;       ///< [N] of the lines; NaN: not checked
} ld_canopy;

/// A parachute, which takes the place of the one before it: model.md, section 8.
typedef struct ld_parachute {
    char name[LD_MAX_NAME];
    double drag_area; ///< [m2] C_D S when full, with all that hangs below it
    ld_trigger trigger;
    double time;             ///< [s] from ignition
    double height;           ///< [m] above the ground, falling
    double lag;              ///< [s] from the trigger until it opens
    double filling;          ///< [s] in which the drag area grows
    double filling_distance; ///< [m] through the air, instead; NaN: by time
    double filling_power;    ///< [-] of the growth, 1: linear
    ld_canopy canopy;
} ld_parachute;

typedef enum ld_brakes_form { LD_BRAKES_OVER_TIME, LD_BRAKES_OVER_HEIGHT } ld_brakes_form;

/// Drag of surfaces that are put out by a schedule, in free flight: model.md, section 8.
typedef struct ld_air_brakes {
    bool present;
    ld_brakes_form form;
    ld_table over_time;   ///< t [s] from ignition, A [m2]; linear between, constant outside
    ld_table over_height; ///< h [m] of the mass centre above the ground, A [m2]; likewise
    double scale;         ///< [-] on the area
} ld_air_brakes;

#endif
