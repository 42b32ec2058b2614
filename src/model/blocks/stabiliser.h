/// The loop that moves a hinge of a platform: the blocks `stabiliser` of `platform`.
#ifndef LD_MODEL_BLOCKS_STABILISER_H
#define LD_MODEL_BLOCKS_STABILISER_H

#include <stdbool.h>

#include "model/blocks/table.h"

/// Two loops in place of a stabiliser's kp, ki, kd: the angle's gives the rate's command.
typedef struct ld_cascade {
    bool present;
    double kp;      ///< [1/s]
    double rate_kp; ///< [N m s/rad]
    double rate_ki; ///< [N m/rad]
} ld_cascade;

/// What a sensor of angle and rate does to each of its samples.
typedef struct ld_sensor_noise {
    double angle; ///< [rad] rms
    double rate;  ///< [rad/s] rms
    int seed;
} ld_sensor_noise;
typedef struct ld_resolution {
    double angle; ///< [rad] 0: none
    double rate;  ///< [rad/s] 0: none
} ld_resolution;

/// Between a drive's motor and its hinge, all as seen from the hinge.
typedef struct ld_gear {
    bool present;
    double stiffness; ///< [N m/rad]
    double damping;   ///< [N m s/rad]
    double inertia;   ///< [kg m2] of the motor
    double backlash;  ///< [rad] free travel between both sides of the teeth
} ld_gear;

/// Moves a platform to its commanded angle: model.md, section 6.
typedef struct ld_stabiliser {
    ld_table command;    ///< t [s], pitch or yaw [rad]; one row: constant; linear between rows,
                         ///< constant outside
    double kp;           ///< [N m/rad]
    double ki;           ///< [N m/(rad s)]
    double kd;           ///< [N m s/rad]
    double torque_limit; ///< [N m]; a locked hinge needs none of these four
    double feedforward;  ///< [-] of the chassis' rate along the hinge, against it a rate command
    ld_cascade cascade;
    double bandwidth; ///< [Hz] of the actuator's lag; 0: none
    double slew;      ///< [N m/s] greatest rate of the lagging torque; 0: any
    double sample;    ///< [s] period of a digital loop; 0: continuous
    double delay;     ///< [s] from a sample until its torque is given out, <= sample
    ld_sensor_noise noise;
    ld_resolution resolution;
    ld_gear gear;
} ld_stabiliser;

#endif
