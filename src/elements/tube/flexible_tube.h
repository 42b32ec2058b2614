// The flexible tube as constant data: modes in tangent form and the inertia coefficients of
// formulation.md, section 5, computed once from the finite-element model of the tube.
//
// Modal coordinates q = (q_y [nb], q_z [nb], q_t [nt], q_a [na]); each bending plane has its own
// shapes b_y, b_z and frequencies.
//   u_y = b_y . q_y,  u_z = b_z . q_z,  u_x = a . q_a
//   phi_x = tau . q_t,  phi_y = -b_z' . q_z,  phi_z = b_y' . q_y
// Tangent form: b(0) = b'(0) = 0, tau(0) = 0, a(0) = 0; int b b^T dm = E in each plane, int rho I_p
// tau tau^T dx = E, int a a^T dm = E; stiffness K = diag(omega^2), damping D = diag(2 zeta omega).
// With geometric stiffness bending also draws axis points along x (shortening.h).
// Where b_y = b_z (most tubes) the planes share their shapes; else G = int b_y b_z^T dm says how
// they overlap. Lanes: counts padded to multiples of 4 with zeros (nbp, ntp, nap), so that loops
// have fixed length.
#ifndef LD_ELEMENTS_FLEXIBLE_TUBE_H
#define LD_ELEMENTS_FLEXIBLE_TUBE_H

#include "elements/tube/beam_finite_elements.h"

enum { LD_NB = LD_MAX_BENDING_MODES, LD_NT = LD_MAX_TORSION_MODES, LD_NA = LD_MAX_AXIAL_MODES };

// Shape functions of one finite element, as polynomials in xi = x - x0 [m]: cubic for bending,
// linear for torsion and stretch. Row k holds the coefficients of xi^k of all modes.
typedef struct tube_element {
    double x0, x1;                      // [m] the element's two ends
    _Alignas(64) double b[2][4][LD_NB]; // bending, by plane; aligned, and so is every row
    double tau[2][LD_NT];               // torsion
    double a[2][LD_NA];                 // stretch
} tube_element;

// G of shapes that differ, row by row for sums over the modes of a plane: [PLANE_Y] is G, whose
// rows belong to the modes of y, [PLANE_Z] its transpose. Zeros as padding.
typedef struct tube_overlap {
    _Alignas(64) double G[2][LD_NB][LD_NB];
} tube_overlap;

// Of a beam with shear, whose sections turn by the slope of the axis less a strain.
typedef struct tube_shear {
    double inertia[2];          // [kg m2] by plane: int rho I dx
    double turn[2][LD_NB];      // by plane: int rho I phi dx
    double (*strain)[2][LD_NB]; // by element and plane, owned
} tube_shear;

typedef struct flexible_tube {
    int nb, nt, na;     // modes: bending per plane, torsion, axial
    int nbp, ntp, nap;  // the same, padded
    double length;      // [m]
    double bore_radius; // [m] at the rear end
    // int dm, int x dm, int x^2 dm, int rho I_p dx (point masses included in the first three)
    double m, s0, j0, j;
    double ct[2][LD_NB], c[2][LD_NB]; // int b dm, int x b dm, by plane
    double at[LD_NA], ax[LD_NA];      // int a dm, int x a dm
    double AB[2][LD_NA][LD_NB];       // int a b^T dm, by plane
    double cp[LD_NT];                 // int rho I_p tau dx
    // diagonals of K [1/s2] and D [1/s]; bending: by plane
    double om2_b[2][LD_NB], dmp_b[2][LD_NB];
    double om2_t[LD_NT], dmp_t[LD_NT];
    double om2_a[LD_NA], dmp_a[LD_NA];
    double ctct[2], ctc[2], cc[2]; // by plane: ct.ct, ct.c, c.c
    double cpcp;                   // cp.cp
    int element_count;
    tube_element *element; // 64-byte aligned, owned
    tube_overlap *overlap; // 64-byte aligned, owned; NULL: the planes share their shapes, G = E
    struct tube_shortening *shortening; // of shortening_build; NULL: axis points move
                                        // across the axis alone
    tube_shear *shear;                  // owned; NULL: sections stay across the axis, without
                                        // rotary inertia across it
    struct flexible_tube *unslowed; // where modes.cut may slow some, with them as they are; owned
    int support_count;
    int support_element[LD_MAX_SUPPORTS]; // element that holds support k's station
} flexible_tube;

// Builds the tube of `model` (FE model, modes of the span asked for, tangent form, coefficients).
// Fails with a sentence naming what is wrong (more modes than the mesh has, singular mass, ...).
ld_status flexible_tube_build(flexible_tube *tube, const ld_tubes *model, ld_error *error);
void flexible_tube_free(flexible_tube *tube);

// Index of the element that holds station x (the first one for x < 0, the last for x >= L; at an
// inner node the one that begins there).
int flexible_tube_find(const flexible_tube *tube, double x);

#endif
