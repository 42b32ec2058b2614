// Where a base of kind multibody comes to rest under a dead load, and which of its displacements
// nothing holds: a vehicle's place and heading.
#ifndef LD_SYSTEMS_MULTIBODY_REST_H
#define LD_SYSTEMS_MULTIBODY_REST_H

#include "systems/bases/base.h"

// Fills the rest and the freedoms of a base that is else built. Where no rest is found the state is
// the one that came nearest.
ld_status multibody_rest_find(base_system *base, ld_error *error);

#endif
