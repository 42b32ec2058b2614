// Random trees of bodies on all kinds of hinges, and their dense equations of motion built from
// positions alone. Every body's pose is a Taylor series in time, in extended precision; velocities
// and accelerations are its coefficients; the equations are d'Alembert's principle written body by
// body. No kinematics of the library enters.
#ifndef LD_TESTS_SUPPORT_DENSE_TREE_H
#define LD_TESTS_SUPPORT_DENSE_TREE_H

#include "launchdyn/mstmm.h"

#include <stdint.h>

enum { BODIES = 9, SPEEDS = 6 * BODIES, EQUATIONS = SPEEDS + 24, KINDS = LD_HINGE_PLANAR + 1 };

typedef long double real;

// Taylor series in time to second order: value, rate, half the second derivative.
typedef struct jet {
    real c[3];
} jet;
typedef struct jet3 {
    jet a[3];
} jet3;
typedef struct jet33 {
    jet a[3][3];
} jet33;

jet jet_add(jet x, jet y);
jet jet_scale(real s, jet x);
jet jet_multiply(jet x, jet y);
jet3 jet3_add(jet3 x, jet3 y);
jet3 jet3_constant(const double v[3]);
jet33 jet33_identity(void);
jet33 jet33_multiply(jet33 x, jet33 y);
jet33 jet33_transpose(jet33 x);
jet3 jet33_apply(jet33 x, jet3 y);
// The constant rotation of a quaternion of any length.
jet33 jet33_quaternion(const double q[4]);

typedef struct specimen {
    int count, q_count, u_count;
    char name[BODIES][8];
    int parent[BODIES], q_at[BODIES], u_at[BODIES];
    ld_mstmm_element element[BODIES];
    double gravity[3], q[8 * BODIES], u[SPEEDS], tau[SPEEDS], wrench[6 * BODIES];
} specimen;

// Coordinates and speeds of each kind of hinge.
extern const int tree_coordinates[KINDS], tree_speeds[KINDS];

void tree_fill(double *x, int n, double size, uint64_t *seed);
int tree_pick(int n, uint64_t *seed);

// Hinges of the first `kinds` kinds.
void tree_draw(specimen *s, int kinds, uint64_t *seed);

typedef struct moving {
    jet3 origin, center;
    jet33 R;
} moving;

// What a joint does: displacement and turn of its second frame in the first one, coordinates x with
// constant speeds.
void tree_joint(ld_hinge hinge, const double axis[3], const double axis_2[3], const double *x,
                const double *x_dot, jet3 *slide, jet33 *turned);

// Poses of all bodies along the path with constant speeds u (rates of what u means).
void tree_trace(const specimen *s, const double *u, moving *body);

// w of ~w = R_dot R^T, and alpha: the skew part of R_ddot R^T.
void tree_rates(const jet33 *R, real w[3], real alpha[3]);

// The dense equations M u_dot = h; unit: poses along the paths of unit speeds.
void tree_assemble(const specimen *s, moving unit[SPEEDS][BODIES], real M[SPEEDS][SPEEDS],
                   real h[SPEEDS]);

// Solves A x = b, n rows of `width`, by Gauss-Jordan with the inverse beside; returns the 1-norm
// condition.
real tree_solve(int n, int width, const real *A, const real *b, real *x);

#endif
