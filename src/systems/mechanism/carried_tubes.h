// The tubes that lie rigidly on the body of the launching one: their masses, and those of the
// rockets in them.
#ifndef LD_SYSTEMS_CARRIED_TUBES_H
#define LD_SYSTEMS_CARRIED_TUBES_H

#include "launchdyn/model.h"
#include "launchdyn/mstmm.h"
#include "math/vectors/mat3.h"
#include "model/blocks/tubes.h"

// Which tube launches now; those listed in `fired` [count] have no rocket any more.
typedef struct mechanism_tubes {
    int launching, fired_count;
    const int *fired;
} mechanism_tubes;

// Mass, its moment and its inertia about a body's origin, gathered from parts.
typedef struct carried_mass {
    double mass;
    v3 moment;  // [kg m]
    m3 inertia; // [kg m2]
} carried_mass;

// A body of that mass with its mass centre c and its inertia xx yy zz xy xz yz about it.
carried_mass carried_body(double mass, v3 c, const double inertia[6]);
// Rear end [m] of tube `number` (from 1) from that of tube 1, undeformed, in T.
v3 carried_tube_row(const ld_layout *layout, int number);
// Adds every tube but the launching one, undeformed in its place, full rockets in those that are
// neither empty nor fired; `mount`: axes of T against those of the body.
ld_status carried_tubes(carried_mass *all, const ld_model *model, const mechanism_tubes *tubes,
                        const m3 *mount, ld_error *error);
// Makes it the mass, mass centre and inertia of an element.
void carried_store(const carried_mass *all, ld_mstmm_element *element);

#endif
