// A rigid rocket at rest on the surfaces of a rigid, straight guide: the places in which its
// energy, that of its weight and of the surfaces pressed in, is least. Nothing of the program is
// used but the model's numbers.
#ifndef LD_TESTS_SUPPORT_RIGID_REST_H
#define LD_TESTS_SUPPORT_RIGID_REST_H

#include <stdbool.h>

#include "launchdyn/model.h"
#include "math/vectors/quaternion.h"

// In the guide's axes.
typedef struct rigid_pose {
    v3 r; // [m] O1 from the elastic axis' point beside it
    m3 A; // the rocket's axes
} rigid_pose;

typedef struct rigid_rest {
    rigid_pose pose;
    double energy; // [J] less that of the centred place without contact
    double off;    // [m, rad] from the centred place, the larger of way and turn, which between
                   // round surfaces alone is that of the axis
    bool found;    // no further off than 0.6
} rigid_rest;

// The rocket on the guide line, unturned.
rigid_pose rigid_centre(const ld_model *model);

// Where the rocket comes to from `pose` if nothing but gravity [m/s2, guide's axes] and surfaces
// act and no motion carries it on; `rolls`: nothing else holds its roll.
rigid_rest rigid_rest_from(const ld_model *model, v3 gravity, bool rolls, const rigid_pose *pose);

#endif
