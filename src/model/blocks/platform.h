/// Chassis and platforms of a vehicle, with their hinges: the block `platform`.
#ifndef LD_MODEL_BLOCKS_PLATFORM_H
#define LD_MODEL_BLOCKS_PLATFORM_H

#include <stdbool.h>

#include "model/blocks/stabiliser.h"
#include "model/blocks/table.h"

typedef struct ld_hinge_friction {
    double viscous; ///< [N m s/rad]
    double coulomb; ///< [N m]
    double rate;    ///< [rad/s] w_eps, at which Coulomb friction reaches 71 %
} ld_hinge_friction;

/// Spring-damper in place of a stabiliser, at rest in the equilibrium.
typedef struct ld_hinge_lock {
    bool present;
    double stiffness; ///< [N m/rad]
    double damping;   ///< [N m s/rad]
} ld_hinge_lock;

/// A platform and the hinge that carries it: azimuth about y, elevation about z.
typedef struct ld_turret {
    double hinge_at[3]; ///< [m] in the axes of the body that carries it, from that one's origin
                        ///< (the chassis' is its mass centre)
    double mass;        ///< [kg] of the frame, without any tube
    double center[3];   ///< [m] mass centre from its hinge, own axes
    double inertia[3];  ///< [kg m2] about its own mass centre
    ld_stabiliser stabiliser;
    ld_hinge_friction friction;
    ld_hinge_lock lock;
} ld_turret;

/// Chassis, azimuth and elevation platform: model.md, section 6. Without the azimuth platform the
/// elevation platform is hinged to the chassis.
typedef struct ld_platform {
    double chassis_mass;       ///< [kg]
    double chassis_inertia[3]; ///< [kg m2]
    ld_table jet;              ///< distance from a tube's exit [m], force of a jet [N]; empty: none
    double jet_scale;          ///< [-] factor on the force
    bool has_azimuth;
    ld_turret azimuth;
    ld_turret elevation;
} ld_platform;

#endif
