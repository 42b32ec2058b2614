/// Supports of the tube and slides on which it recoils: the block `tubes.supports`.
#ifndef LD_MODEL_BLOCKS_SUPPORT_H
#define LD_MODEL_BLOCKS_SUPPORT_H

#include <stdbool.h>

#include "model/blocks/limits.h"

/// A slide on which the tube recoils along its x against a support: model.md, section 4.
typedef struct ld_recoil {
    bool present;
    double preload;           ///< [N] towards the front stop
    double stiffness;         ///< [N/m] of the return spring
    double damping;           ///< [N s/m]
    double quadratic_damping; ///< [N s2/m2]
    double friction;          ///< [N]
    double friction_speed;    ///< [m/s] at which the friction is at 71 %
    double stroke;            ///< [m] from one stop to the other; NaN: no stop behind
} ld_recoil;

/// Spring-damper between the tube's section at `at` and the base: model.md, section 4.
typedef struct ld_support {
    double at;                      ///< [m] station
    double stiffness[3];            ///< [N/m]
    double damping[3];              ///< [N s/m]
    double rotational_stiffness[3]; ///< [N m/rad]
    double rotational_damping[3];   ///< [N m s/rad]
    ld_recoil recoil;               ///< along x, between stops of that stiffness and damping
    unsigned clamped; ///< directions that are held rigidly: bits of ld_clamp; of these no spring
} ld_support;

/// Directions of a support, along and about the tube's axes.
typedef enum ld_clamp {
    LD_CLAMP_X,
    LD_CLAMP_Y,
    LD_CLAMP_Z,
    LD_CLAMP_ROLL,
    LD_CLAMP_YAW,   ///< about y
    LD_CLAMP_PITCH, ///< about z
    LD_CLAMPS
} ld_clamp;

/// Whether a support holds a direction rigidly.
static inline bool support_clamps(const ld_support *support, ld_clamp direction)
{
    return support->clamped >> direction & 1u;
}

/// Spring along or about an axis: 0 in directions held rigidly and where none is given.
static inline double support_spring(const ld_support *support, ld_clamp direction)
{
    if (support_clamps(support, direction))
        return 0;
    if (direction >= LD_CLAMP_ROLL)
        return support->rotational_stiffness[direction - LD_CLAMP_ROLL];
    double along = support->stiffness[direction];
    return along >= 0 ? along : 0;
}

#endif
