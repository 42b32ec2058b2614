// The initial shape of a guide: how the line that guides the rocket departs from a straight one in
// the unloaded tube (model.md, section 5).
//
// Offsets y_0(x), z_0(x) and a twist tau_0(x), small against the length: cubic splines through
// surveyed rows, sums of random half waves (splines, too) and rounded steps and kinks where two
// lengths meet (cubic, C1). A section that guides the rocket is where deflection and shape together
// put it:
//   P = x e_x + Phi q + (0, y_0, z_0),   t = e_x + Phi' q + (0, y_0', z_0')
//   th = Psi q + (tau_0, -z_0', y_0'),   k_0 = Psi' q + (tau_0', -z_0'', y_0'')
// Mass, stiffness, supports and what the tube's own columns report belong to the straight axis.
#ifndef LD_ELEMENTS_INITIAL_SHAPE_H
#define LD_ELEMENTS_INITIAL_SHAPE_H

#include "math/curves/curves.h"
#include "math/vec3.h"
#include "model/blocks/tubes.h"

typedef struct initial_shape {
    curves of; // y_0, z_0 and perhaps tau_0, owned
} initial_shape;

// Offset and turn of a section, and their first and second derivatives by the station.
typedef struct initial_section {
    v3 P, P1, P2;    // [m], [-], [1/m]
    v3 th, th1, th2; // [rad], [rad/m], [rad/m2]
} initial_section;

// NULL in *self where the tube has none.
ld_status initial_shape_build(const ld_tubes *tubes, initial_shape **self, ld_error *error);
void initial_shape_free(initial_shape *self);

// At station x, 0 to the tube's length.
void initial_shape_at(const initial_shape *self, double x, initial_section *at);

#endif
