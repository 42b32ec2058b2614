/// The rocket: the block `rocket`.
#ifndef LD_MODEL_BLOCKS_ROCKET_H
#define LD_MODEL_BLOCKS_ROCKET_H

#include "model/blocks/aerodynamics.h"
#include "model/blocks/contact.h"
#include "model/blocks/drag_devices.h"
#include "model/blocks/line.h"
#include "model/blocks/motor.h"

/// Mass data of the rocket at one instant.
typedef struct ld_mass_data {
    double mass;       ///< [kg]
    double center[3];  ///< [m] in B
    double inertia[3]; ///< [kg m2] about the mass centre, in B
} ld_mass_data;

typedef enum ld_hold { LD_HOLD_BY_GUIDE, LD_HOLD_YES, LD_HOLD_NO } ld_hold;

typedef struct ld_lock {
    bool present;         ///< false: the rocket is free from the start
    double release_force; ///< [N]
    double hold_down;     ///< [s] from ignition, before which it releases under no force; 0: never
    double x, radius,
        angle;          ///< [m], [m], [rad] of the point held, in B: (x, radius cos, radius sin)
    ld_hold holds_roll; ///< by the guide: yes without slot and flat surfaces
} ld_lock;

typedef struct ld_rocket {
    double start_at; ///< [m] s of the rear adaptor at the start
    ld_mass_data full;
    ld_mass_data empty;
    double propellant;           ///< [kg] burnt mass; NaN: see model_complete()
    double products[3];          ///< [kg m2] J_xy, J_xz, J_yz of the matrix, full and empty
    double dynamic_imbalance[2]; ///< [-] delta_y, delta_z: the inertia's x axis points along
                                 ///< (1, delta_y, delta_z) of B, turned the shortest way
    double mass_error;           ///< [kg] at the mass centre, added to full and empty
    double eccentricity[2];      ///< [m] y, z, added to full and empty
    int adaptor_count;
    ld_adaptor adaptor[LD_MAX_ADAPTORS]; ///< the first is the rear one
    ld_contact contact;
    double knob_angle; ///< [rad] gamma_b
    ld_lock lock;
    ld_motor motor;
    int further_motor_count;
    ld_further_motor further_motor[LD_MAX_FURTHER_MOTORS];
    ld_aerodynamics aerodynamics;
    ld_air_brakes air_brakes;
    int parachute_count;
    ld_parachute parachute[LD_MAX_PARACHUTES];
    ld_line line;
} ld_rocket;

#endif
