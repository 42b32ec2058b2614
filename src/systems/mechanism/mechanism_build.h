// A mechanism from its model.
#ifndef LD_SYSTEMS_MECHANISM_BUILD_H
#define LD_SYSTEMS_MECHANISM_BUILD_H

#include "systems/mechanism/carried_tubes.h"
#include "systems/mechanism/mechanism.h"

// What a mechanism is built from.
typedef struct mechanism_plan {
    const ld_model *model;
    const ld_mechanism *given; // outlives the mechanism
    const char *carries;       // body or beam that the tubes are on
    m3 mount;                  // axes of T against those of that body
    bool overall;              // by the overall transfer equation: without loops and carrier
} mechanism_plan;

// Fails with a sentence that names the body or joint.
ld_status mechanism_build(mechanism_system *self, const mechanism_plan *plan,
                          const mechanism_tubes *tubes, ld_error *error);
void mechanism_free(mechanism_system *self);

#endif
