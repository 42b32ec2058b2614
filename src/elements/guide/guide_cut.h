// What the tube carries at a station, by equilibrium of the part that lies beyond it, towards the
// tip (model.md, section 3). That part's mass moves as p = sum of f_k P_k, with f = (1, x, b, a):
// the axis' station, bending shapes (of both planes where these are not the same) and axial ones;
// so a part's inertia is a Gram matrix of the f_k.
//
//   p(xi) - P(x) = sum f_k P_k,   a(xi) - g = sum f_k A_k,   B_k = sum_l G_kl A_l,   G = int_x^L f
//   f' dm f = sum of the forces on the part - B_0 m = sum of their moments about P(x) - sum P_k x
//   B_k - d/dt int_x^L rho I_p (w_x + phi_x_dot) e_x
//
// is the wrench of the part beyond on the part behind. In the section's axes f_x > 0 is tension,
// and with no more than small deflections m_y = -E I u_z'', m_z = E I u_y'', m_x = G I_t phi_x'.
#ifndef LD_ELEMENTS_GUIDE_CUT_H
#define LD_ELEMENTS_GUIDE_CUT_H

#include "elements/instant.h"

enum { GUIDE_FUNCTIONS = 2 + 2 * LD_NB + LD_NA };

// A station with all that does not change.
typedef struct guide_cut {
    double at;                                     // [m]
    double gram[GUIDE_FUNCTIONS][GUIDE_FUNCTIONS]; // int_x^L f f' dm
    double polar, twist[LD_NT];                    // int_x^L rho I_p dx, int_x^L rho I_p tau dx
    double fibre_y, fibre_z; // E z/(E I_y), E y/(E I_z) [1/m3] at the outer fibre; NaN: not known
    bool round;              // one outer radius all around
    double EA, EI_y, EI_z;   // [N], [N m2] of the section
} guide_cut;

// Of a station of the tube built of `model`. What acts, and what has mass, at the station
// itself counts as beyond; its section is that behind it.
void guide_cut_build(guide_cut *self, const flexible_tube *tube, const ld_tubes *model,
                     const ld_station *station);

// How the tube moves at an instant: speeds and accelerations of R and of the modes.
typedef struct guide_motion {
    v3 w, a, w_dot; // a: inertial acceleration of R's origin less gravity; all in R
    const double *q, *q_dot, *q_ddot; // [2 nb + nt + na]
} guide_motion;

// What the section carries.
typedef struct guide_load {
    guide_wrench wrench; // of the part beyond on the part behind at the axis' point, in its axes
    double bending;      // [N m] magnitude of the bending moment
    double stress;       // [Pa] largest bending stress; NaN: the outer fibre is not known
    // at (y, z) from the elastic axis the strain along it is strain - y curvature_y - z curvature_z
    double strain, curvature_y, curvature_z; // of the axis; [1/m] u_y'', u_z''
} guide_load;

// P, A: the section's point of the axis and frame in R; `beyond`: the sum of the forces on the part
// beyond, about R's origin, in R.
guide_load guide_cut_load(const guide_cut *self, const flexible_tube *tube,
                          const guide_motion *motion, v3 P, m3 A, const guide_wrench *beyond);

#endif
