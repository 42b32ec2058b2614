// A base by its coordinates: place, yaw, pitch, roll.
#ifndef LD_SYSTEMS_BASE_COORDINATES_H
#define LD_SYSTEMS_BASE_COORDINATES_H

#include "systems/bases/base.h"

// Those of the base_inputs that a base with a given motion has.
extern const quantity_table base_motion_inputs;

// Frame T of a base with these coordinates, x, y, z [m], yaw, pitch, roll [rad], their rates u and
// accelerations a, its tube mounted so: A_base,tube.
void base_frame_at(const double x[6], const double u[6], const double a[6], const m3 *mount,
                   base_frame *tube);
// The same frame with its origin elsewhere: `arm` [m] from it, in T.
void base_frame_go(base_frame *tube, v3 arm);

#endif
