// Transfer matrices of the elements (formulation.md, section 2). Everything is given along the same
// axes, any that suit at the instant (inertial ones, or those of a tube's floating frame).
#ifndef LD_ELEMENTS_TRANSFER_H
#define LD_ELEMENTS_TRANSFER_H

#include "launchdyn/status.h"
#include "math/vectors/transfer.h"

// A rigid body seen from its input point I.
typedef struct rigid_body {
    double mass; // [kg]
    v3 center;   // [m] r_IC: from I to the mass centre
    m3 inertia;  // [kg m2] about I
    v3 output;   // [m] r_IO: from I to the output point
} rigid_body;

// U of a rigid body of angular velocity w [rad/s] with gravity g [m/s2] and an applied wrench:
// force f [N] and moment m_I about I [N m].
void rigid_body_transfer(transfer_matrix *U, const rigid_body *body, v3 w, v3 g, v3 f, v3 m_I);

// The largest number of speeds of a flexible body: six of its frame and its modes.
enum { TRANSFER_SPEEDS = 80 };

// A flexible body M eta_dot = h - B N + L_I^T F_I - L_O^T F_O with n speeds, wrenches F = (f, m)
// about the connection points, whose accelerations are [a; alpha] = L eta_dot + gamma.
typedef struct flexible_body {
    int n;
    const double *M;                 // n x n, full, row by row
    const double *h;                 // n
    const double *B;                 // n, or NULL: direction of the generalised force -N
    const double *L_I, *L_O;         // 6 x n, row by row
    const double *gamma_I, *gamma_O; // 6
} flexible_body;

// U of a flexible body, eta_dot eliminated with Q = M^-1:
//   F_O = (L_I Q L_O^T)^-1 (L_I Q L_I^T F_I - [a; alpha]_I + L_I Q (h - B N) + gamma_I),
//   [a; alpha]_O = L_O Q (h - B N + L_I^T F_I - L_O^T F_O) + gamma_O.
// `condition` (may be NULL) gets the 1-norm condition of L_I Q L_O^T, rows and columns scaled by
// the mobilities of the two ends, so that it has no units. Fails (LD_ERR_NUMERIC) where M is not
// positive definite or that block is singular to rounding; then use the reduced form.
ld_status flexible_body_transfer(transfer_matrix *U, const flexible_body *body, double *condition,
                                 ld_error *error);

#endif
