// A mechanism from its model.
#ifndef LD_SYSTEMS_MECHANISM_BUILD_H
#define LD_SYSTEMS_MECHANISM_BUILD_H

#include "systems/mechanism/carried_tubes.h"
#include "systems/mechanism/mechanism.h"

// Fails with a sentence that names the body or joint.
ld_status mechanism_build(mechanism_system *self, const ld_model *model,
                          const mechanism_tubes *tubes, ld_error *error);
void mechanism_free(mechanism_system *self);

#endif
