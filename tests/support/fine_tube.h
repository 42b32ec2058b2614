// The launcher's tube without modes, on a base at rest, under loads that are given: to see what a
// series of modes leaves out. Nothing of the program is used but the model's numbers.
//
// Bending, in each plane: finite elements of Hermite cubics with all their nodal freedoms, the
// trapezoidal rule in time. Twist: the wave equation by its characteristics, exact between the
// stations where something acts, and under loads that travel.
#ifndef LD_TESTS_SUPPORT_FINE_TUBE_H
#define LD_TESTS_SUPPORT_FINE_TUBE_H

#include "launchdyn/model.h"
#include "model/blocks/limits.h"

enum { FINE_MOST_NODES = 301, FINE_MOST_LOADS = 4, FINE_BAND = 4 };

// What acts on the tube at a station, in the axes of the undeformed tube. A station at or beyond
// the tip: nothing acts.
typedef struct fine_load {
    double x;         // [m] station
    double x_dot;     // [m/s] its speed
    double force[2];  // [N] along y and z
    double moment[2]; // [N m] that the slopes w_y' and w_z' work on: about z, and about -y
    double torque;    // [N m] about x
} fine_load;

typedef struct fine_loads {
    int count;
    fine_load load[FINE_MOST_LOADS];
} fine_loads;

// A symmetric matrix of lower bands: row i, band k is the element (i, i - k).
typedef double fine_matrix[2 * FINE_MOST_NODES][FINE_BAND];
typedef double fine_vector[2 * FINE_MOST_NODES]; // of each node w [m], then w' [rad]

typedef struct fine_bending {
    int nodes;
    double h, step;                          // [m] of elements, [s] of time
    fine_matrix K[2], C[2], M[2], factor[2]; // by plane; L D L^T of M + step/2 C + step^2/4 K
    fine_vector weight[2];                   // of gravity, along y and z
    fine_vector u[2], u_dot[2], a[2];        // by plane: y, z
} fine_bending;

// Prepares the tube of `model` (one section, no point masses, supports at nodes) with elements of
// length h and steps of `step`, in gravity as at the fixed base's elevation.
void fine_bending_create(fine_bending *self, const ld_model *model, double h, double step);
// At rest in equilibrium under the loads.
void fine_bending_rest(fine_bending *self, const fine_loads *loads);
// One step on, to the instant of the loads.
void fine_bending_step(fine_bending *self, const fine_loads *loads);

// The tip in a plane (0: y, 1: z): w, w', their rates.
typedef struct fine_tip {
    double w, slope, w_dot, slope_dot;
} fine_tip;
fine_tip fine_bending_tip(const fine_bending *self, int plane);

typedef struct fine_twist {
    int nodes;
    double h, c, step, stiffness;                // [m], [m/s], [s] = h/c, [N m2]
    int support_count, support[LD_MAX_SUPPORTS]; // nodes
    double spring[LD_MAX_SUPPORTS], damper[LD_MAX_SUPPORTS];
    double angle[LD_MAX_SUPPORTS], speed[LD_MAX_SUPPORTS]; // [rad], [rad/s] of the tube there
    double tail;                                           // [kg m2] at x = 0
    double rate[FINE_MOST_NODES];                          // [rad/s] of the twist
    double right[FINE_MOST_NODES], left[FINE_MOST_NODES];  // waves that leave: rate -+ c twist'
} fine_twist;

// The same tube, at rest and without twist; its steps are h/c, c the speed of waves of twist.
void fine_twist_create(fine_twist *self, const ld_model *model, double h);
// One step on, under loads that travel steadily during it from where `loads` has them at its
// middle.
void fine_twist_step(fine_twist *self, const fine_loads *loads);
// Rate of the twist at a load at x: mean of both sides, which differ by the load's own jump.
double fine_twist_rate(const fine_twist *self, double x);

#endif
