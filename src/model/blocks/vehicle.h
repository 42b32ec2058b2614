/// Wheels, suspension, tyres, drive: what the block `base` holds of a vehicle.
#ifndef LD_MODEL_BLOCKS_VEHICLE_H
#define LD_MODEL_BLOCKS_VEHICLE_H

#include <stdbool.h>

#include "model/blocks/limits.h"
#include "model/blocks/road.h"
#include "model/blocks/table.h"

typedef struct ld_wheel {
    char name[LD_MAX_NAME];
    double mount[3]; ///< [m] wheel centre with unloaded suspension, chassis axes from its mass
                     ///< centre
    double mass;     ///< [kg]
    bool driven;
} ld_wheel;

/// Spring-damper between chassis and wheel, chassis axes; bump stops add `stiffness` times what
/// the travel along y exceeds `compression` (wheel up) or `extension` (wheel down).
typedef struct ld_suspension {
    double stiffness[3]; ///< [N/m]
    double damping[3];   ///< [N s/m]
    struct {
        double compression, extension; ///< [m] from the unloaded position, > 0; NaN: no stop
        double stiffness;              ///< [N/m]
    } bump_stop;
} ld_suspension;

typedef struct ld_tyre {
    double radius;            ///< [m] R
    double stiffness[3];      ///< [N/m] along, vertical, across
    double damping[3];        ///< [N s/m]
    double relaxation_length; ///< [m] sigma
    double friction;          ///< [-] mu
} ld_tyre;

/// Holds the marching speed: F = kp (speed - v) + ki z_d, shared among the driven wheels.
typedef struct ld_drive {
    double kp; ///< [N s/m]
    double ki; ///< [N/m]
} ld_drive;

/// Wheels, suspension, tyres and road of a vehicle: model.md, section 7.
typedef struct ld_vehicle {
    double speed; ///< [m/s] marching speed, >= 0; 0: parked
    ld_road road;
    ld_drive drive;
    int wheel_count;
    ld_wheel wheel[LD_MAX_WHEELS];
    ld_suspension suspension;
    ld_tyre tyre;
} ld_vehicle;

#endif
