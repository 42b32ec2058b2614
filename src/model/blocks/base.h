/// What carries the tube, and the kinds of it: the block `base`.
#ifndef LD_MODEL_BLOCKS_BASE_H
#define LD_MODEL_BLOCKS_BASE_H

#include "model/blocks/fmu_base.h"
#include "model/blocks/limits.h"
#include "model/blocks/mechanism.h"
#include "model/blocks/sea.h"
#include "model/blocks/table.h"
#include "model/blocks/vehicle.h"

/// One sinusoid `amplitude sin(2 pi frequency t + phase)`.
typedef struct ld_sine {
    double amplitude; ///< [m] or [rad]
    double frequency; ///< [Hz], cycles per second
    double phase;     ///< [rad]
} ld_sine;

typedef struct ld_sines {
    int count;
    ld_sine term[LD_MAX_SINES];
} ld_sines;

/// What carries the tube: a kind, its word, its number in digests. External: driven by whoever runs
/// the launch, step by step. FMU: imported, stepped beside the launch.
#define LD_BASE_KINDS(KIND)                                                                        \
    KIND(LD_BASE_FIXED, fixed, 0)                                                                  \
    KIND(LD_BASE_PRESCRIBED, prescribed, 1)                                                        \
    KIND(LD_BASE_VEHICLE, vehicle, 2)                                                              \
    KIND(LD_BASE_EXTERNAL, external, 4)                                                            \
    KIND(LD_BASE_FMU, fmu, 5)                                                                      \
    KIND(LD_BASE_MULTIBODY, multibody, 6)

#define LD_BASE_KIND_NUMBER(name, word, number) name = (number),
typedef enum ld_base_kind {
    LD_BASE_KINDS(LD_BASE_KIND_NUMBER) LD_BASE_NONE = 3, ///< no launcher: a flight alone
} ld_base_kind;

/// What a base without wheels is drawn as; nothing of its mechanics.
typedef enum ld_looks { LD_LOOKS_PLAIN, LD_LOOKS_SHIP, LD_LOOKS_AIRCRAFT } ld_looks;

/// How an external base continues between the instants at which it is given.
typedef enum ld_extrapolation {
    LD_EXTRAPOLATION_ACCELERATION, ///< with the acceleration that its last two velocities report
    LD_EXTRAPOLATION_VELOCITY,     ///< with its last velocity
} ld_extrapolation;

/// The base that carries the tube: model.md, section 2.
typedef struct ld_base {
    ld_base_kind kind;
    double azimuth;              ///< [rad] of the tube against the base, about +y
    double elevation;            ///< [rad] of the tube against the base, about +z
    double velocity[3];          ///< [m/s] constant velocity along I (prescribed)
    ld_sines surge, heave, sway; ///< [m] along I's x, y, z (prescribed)
    ld_sines yaw, pitch, roll;   ///< [rad] base pose Ry(yaw) Rz(pitch) Rx(roll) (prescribed)
    ld_table motion;      ///< t [s], x, y, z [m], yaw, pitch, roll [rad] or q0, q1, q2, q3; cubic
                          ///< spline; empty: none
    double motion_origin; ///< [s] whole seconds that are left out of its times; 0 but of late ones
    double motion_start;  ///< [s] of the table's clock: 0 of the run's
    ld_sea sea;           ///< added to sines and velocity (prescribed)
    double at[3];         ///< [m] T's origin in the frame that moves so, or that an FMU reports
                          ///< (prescribed, fmu)
    ld_vehicle vehicle;
    ld_mechanism mechanism;         ///< (multibody)
    ld_extrapolation extrapolation; ///< (external)
    ld_fmu_base fmu;
    ld_looks looks; ///< (not of a vehicle)
} ld_base;

#endif
