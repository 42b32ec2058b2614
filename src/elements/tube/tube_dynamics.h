// The flexible tube as an element in general form (formulation.md, sections 1 and 5): mass matrix,
// forces and section kinematics, clear rather than fast.
//
// Speeds eta = (v, w, q_dot) in R coordinates with q = (q_y, q_z, q_t, q_a) without padding.
#ifndef LD_ELEMENTS_TUBE_DYNAMICS_H
#define LD_ELEMENTS_TUBE_DYNAMICS_H

#include "elements/tube/flexible_tube.h"
#include "elements/tube/initial_shape.h"
#include "math/vectors/mat3.h"

enum { LD_TUBE_MODES = 2 * LD_NB + LD_NT + LD_NA, LD_TUBE_SPEEDS = 6 + LD_TUBE_MODES };

// Number of modal coordinates, 2 nb + nt + na.
int tube_mode_count(const flexible_tube *tube);

// How the tube moves and what gravity does to it, in R.
typedef struct tube_motion {
    v3 w;                    // [rad/s] of R
    v3 g;                    // [m/s2]
    const double *q, *q_dot; // of the modes
} tube_motion;

// Mass matrix M [n x n, full] and forces h [n], n = 6 + tube_mode_count: inertial, gravity, modal
// stiffness and damping, no wrenches (formulation.md, section 1).
void tube_dynamics_assemble(const flexible_tube *tube, const tube_motion *motion, double *M,
                            double *h);

// Kinetic energy 1/2 eta^T M eta and elastic energy 1/2 q^T K q [J].
double tube_kinetic_energy(const flexible_tube *tube, v3 v, v3 w, const double *q,
                           const double *q_dot);
double tube_elastic_energy(const flexible_tube *tube, const double *q);

// Power -q_dot^T D q_dot of the modes' damping [W].
double tube_damping_power(const flexible_tube *tube, const double *q_dot);

// First moment S = int p dm in R [kg m].
v3 tube_first_moment(const flexible_tube *tube, const double *q);

// One section of the deformed tube, in R coordinates.
typedef struct tube_section_state {
    v3 position;                  // [m] p = x e_x + Phi q
    v3 velocity;                  // [m/s] Phi q_dot: of the axis point against R
    m3 rotation;                  // A_RP = Exp(Psi q)
    v3 rotation_vector;           // [rad] Psi q
    v3 spin;                      // [rad/s] Jl Psi q_dot: of the section against R
    double gamma[6];              // [a; alpha] - L eta_dot
    double L[6 * LD_TUBE_SPEEDS]; // 6 x n, row by row: [a; alpha] = L eta_dot + gamma
} tube_section_state;

// Section at station x (formulation.md, section 1); beyond the ends it continues straight and
// rigid.
void tube_section(const flexible_tube *tube, double x, v3 w, const double *q, const double *q_dot,
                  tube_section_state *section);

// A station of what guides a rocket, with its initial shape.
typedef struct guide_station {
    const flexible_tube *tube;
    const initial_shape *initial; // NULL: straight
    double x;
} guide_station;

void guide_section(const guide_station *at, v3 w, const double *q, const double *q_dot,
                   tube_section_state *section);

#endif
