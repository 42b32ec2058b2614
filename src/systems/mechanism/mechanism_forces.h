// What bushings, struts, feet, loads and drag do to the bodies of a mechanism.
//
// Bushing, in its axes on `from`: d = A^T (r_to - r_from), phi the rotation vector of `to` against
// `from` from where there is no moment; on `to` at its point
//   f = -K d' - C d_dot,   m = -J_l(phi)^-T K_r phi - C_r w_rel,
// d' = d less its clearance, 0 within it, a stop's stiffness added beyond; on `from` the opposite
// at the same point, as a support of the tube (elements/guide/support.h).
// Strut: with e from its first end to its second one, F = preload - K (l - l_0) - C l_dot pushes
// them apart. Foot: as a parked tyre (marching.h): p = height - y, F_n = max(0, K_y p + C_y p_dot)
// while p > 0, f_x = -K_x xi - C_x v_x with xi_dot = v_x, limited by mu F_n. Drag:
// rho/2 |v| (A_x v_x, A_y v_y, A_z v_z), v of the air against the point, body axes.
#ifndef LD_SYSTEMS_MECHANISM_FORCES_H
#define LD_SYSTEMS_MECHANISM_FORCES_H

#include "systems/mechanism/mechanism_motion.h"

// Where the forces of an instant are gathered.
typedef struct force_sum {
    const mechanism_system *self;
    const mechanism_motion *motion;
    double *wrench; // [6 per element] about its origin, in I
    mechanism_output *output;
} force_sum;

// Force and moment [N], [N m] in I, at the place r [m] of I, on the body of a point.
void force_add(const force_sum *sum, const mechanism_point *point, v3 r, v3 force, v3 moment);

void mechanism_add_bushings(const force_sum *sum);
// Actuators push with `push` [N] of each strut besides.
void mechanism_add_struts(const force_sum *sum, const double *push);
// `state`, `state_dot`: of the feet, two each.
void mechanism_add_feet(const force_sum *sum, const double *state, double *state_dot);
// The air has this density [kg/m3] and this velocity [m/s] in I.
void mechanism_add_loads(const force_sum *sum, double t, double density, v3 wind);

#endif
