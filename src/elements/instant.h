// One evaluation of the launching subsystem: the tube's constants, what the elements have loaded of
// the state, and what acts. An element reads what launching_load_rocket() has loaded before it and
// adds to the forces. Letters as in formulation.md.
#ifndef LD_ELEMENTS_INSTANT_H
#define LD_ELEMENTS_INSTANT_H

#include <string.h>

#include "elements/exchange.h"
#include "elements/tube/initial_shape.h"
#include "math/lanes.h"
#include "math/vectors/rotation_vector.h"

enum { LD_FIXED_ROWS = 2 * LD_MAX_SUPPORTS + 4 }; // b and b' at each support, ct, c; padded

// Bending shapes of one finite element packed twice: by mode (four powers of xi side by side, for
// sums over modes) and by power (modes side by side, for forces on the modes).
typedef struct packed_shapes {
    _Alignas(32) double by_mode[LD_NB][4];
    _Alignas(32) double by_power[4][LD_NB];
    double ctb[4], cb[4]; // ct . b and c . b as polynomials
} packed_shapes;

// What the fast layout has by plane stands in arrays of two, of which [self->z] is that of z: the
// first, where the planes share their shapes.
typedef struct packed_element {
    double x0, x1;
    packed_shapes plane[2];
    double tau[LD_NT][2];
    double a[LD_NA][2];
} packed_element;

// The flexible tube with its tail: constants of the fast layout.
typedef struct tube_system {
    flexible_tube flexible;
    packed_element *packed; // [flexible.element_count], 64-byte aligned, owned
    double gravity;         // [m/s2] along -y of I
    initial_shape *initial; // of the guide, owned; NULL: it is straight

    // tube and tail, tail folded in
    double m, Sx;    // [kg], [kg m] of both
    double jx;       // [kg m2] condensed inertia about x: j - cp . cp + tail
    v3 tail_inertia; // [kg m2] about the rear section's point

    int z; // PLANE_Z where the planes have shapes of their own, else PLANE_Y
    // rows that never change: b, b' at the supports (2 k, 2 k + 1), then ct, c; by mode and by row
    int ct, c;     // their rows
    int row_lanes; // lanes of four rows
    _Alignas(32) double rows_by_mode[2][LD_NB][LD_FIXED_ROWS];
    _Alignas(32) double rows[2][LD_FIXED_ROWS][LD_NB];
    LANE_ARRAY(om2_y, LD_NB); // bending: diagonals of stiffness and damping
    LANE_ARRAY(om2_z, LD_NB);
    LANE_ARRAY(dmp_y, LD_NB);
    LANE_ARRAY(dmp_z, LD_NB);
} tube_system;

// Modal coordinates and speeds, in lanes (padded with zeros) and torsion apart.
typedef struct modal_state {
    LANE_ARRAY(y, LD_NB);
    LANE_ARRAY(z, LD_NB);
    LANE_ARRAY(y_dot, LD_NB);
    LANE_ARRAY(z_dot, LD_NB);
    const double *t, *t_dot; // torsion
    const double *a, *a_dot; // axial
    bool planes_differ; // the planes have shapes of their own; then, of tube_load: G z, G z_dot,
                        // G^T y, ...
    LANE_ARRAY(z_on_y, LD_NB);
    LANE_ARRAY(z_dot_on_y, LD_NB);
    LANE_ARRAY(y_on_z, LD_NB);
    LANE_ARRAY(y_dot_on_z, LD_NB);
} modal_state;

// A plane's coordinates as the modes of the other one meet them: int b_y u_z dm and so on.
LD_INLINE const double *z_on_y(const modal_state *q)
{
    return q->planes_differ ? q->z_on_y : q->z;
}
LD_INLINE const double *z_dot_on_y(const modal_state *q)
{
    return q->planes_differ ? q->z_dot_on_y : q->z_dot;
}
LD_INLINE const double *y_on_z(const modal_state *q)
{
    return q->planes_differ ? q->y_on_z : q->y;
}
LD_INLINE const double *y_dot_on_z(const modal_state *q)
{
    return q->planes_differ ? q->y_dot_on_z : q->y_dot;
}

// How far bending draws a point of the axis along x, with geometric stiffness: -1/2 q . H q, its
// rate, and its acceleration without those of q.
typedef struct foreshortening {
    double shift, rate, pull; // [m], [m/s], [m/s2]
} foreshortening;

// The deflection of one element as polynomials in xi.
typedef struct element_motion {
    const packed_element *element;
    LANE_ARRAY(y, 4); // coefficients of xi^0..3
    LANE_ARRAY(z, 4);
    LANE_ARRAY(y_dot, 4);
    LANE_ARRAY(z_dot, 4);
    double t[2], t_dot[2]; // torsion: value at x0, slope
    double a[2], a_dot[2]; // stretch, likewise
    bool shortened;        // by bending
    foreshortening before; // then: at x0
    bool sheared;
    double strain[2], strain_dot[2]; // then: by plane
    const initial_shape *initial;    // of the guide; NULL: straight, or a section of the tube alone
} element_motion;

// A cubic with coefficients c of x^0..3, its first and its second derivative.
LD_INLINE double poly0(const double *c, double x)
{
    return c[0] + x * (c[1] + x * (c[2] + x * c[3]));
}
LD_INLINE double poly1(const double *c, double x)
{
    return c[1] + x * (2 * c[2] + x * (3 * c[3]));
}
LD_INLINE double poly2(const double *c, double x)
{
    return 2 * c[2] + 6 * c[3] * x;
}

// Section at station x (formulation.md, sections 1 and 3); all vectors in R. Beyond the ends the
// axis continues straight (model.md, section 3): forces then act through the end section at `root`.
typedef struct axis_section {
    int index;     // element
    double x;      // station
    double beyond; // x less the end's station, outside the tube
    double xi;     // of the shapes, from the element's x0
    v3 P;          // point of the axis
    v3 root;       // axis point of the section that carries forces (P itself inside the tube)
    v3 t;          // dP/dx
    v3 th;         // rotation vector
    v3 k0;         // d th/dx
    m3 A;          // A_RP
    m3 Jl;         // left Jacobian
} axis_section;

// Speeds of the section's material relative to R, in R.
typedef struct section_rates {
    v3 u_dot;  // Phi q_dot
    v3 u1_dot; // Phi' q_dot
    v3 th_dot; // Psi q_dot
    v3 k0_dot; // Psi' q_dot
    v3 w;      // Jl Psi q_dot
} section_rates;

// Shapes at a section, for products between forces there.
typedef struct plane_shapes {
    LANE_ARRAY(b, LD_NB);
    LANE_ARRAY(b1, LD_NB);
    double ct0, ct1, c0, c1; // ct . b, ct . b', c . b, c . b'
    double bb, bb1, b1b1;
} plane_shapes;

typedef struct section_shapes {
    plane_shapes plane[2];
    int z; // of them that of z
    double tau[LD_NT];
    double tt, cp_tau;
    double uy, uy1, uz, uz1; // y . G b_z, y . G b_z', z . G^T b_y, ...: deflections and slopes
} section_shapes;

// Generalised force on the tube: the rigid part about R's origin, the modal part in lanes.
typedef struct tube_force {
    v3 f, m;
    LANE_ARRAY(y, LD_NB);
    LANE_ARRAY(z, LD_NB);
    double t[LD_NT];
    double a[LD_NA];
    guide_forces *record;    // of each force by its position; NULL: none is kept
    const modal_state *bent; // the deflection, with geometric stiffness; else NULL
} tube_force;

// Everything of the tube that does not depend on forces.
typedef struct tube_state {
    v3 r;
    m3 A_IR;
    quat q_IR;
    v3 v, w, g;
    modal_state modal;
    double qy_qy, qz_qz, qy_qz;
    LANE_ARRAY(row_y, LD_FIXED_ROWS); // fixed rows on q_y, q_z
    LANE_ARRAY(row_z, LD_FIXED_ROWS);
    LANE_ARRAY(row_y_dot, LD_FIXED_ROWS);
    LANE_ARRAY(row_z_dot, LD_FIXED_ROWS);
    double ct_y, ct_z, c_y, c_z; // ct . q_y ...
    double cp_t_dot;             // cp . q_t_dot
    // factors of the condensed 6 x 6 matrix: see tube_factor()
    double per_m, per_my, per_jx, per_dy, per_dz, l_yx, l_yz, l_zx, l_zy, l_zwy;
    double per_mz, l_xy, l_xz, l_ywx, l_zwx; // where the planes have shapes of their own, too
} tube_state;

typedef struct rocket_state {
    double s, y, z;
    m3 A_SB, A_RB;
    v3 d, p1;     // in S; in R
    v3 v_O1, w_B; // inertial, in R
    element_motion motion;
    axis_section at; // section at s
    section_rates rates;
    v3 Ad;       // A d
    v3 v_P, w_P; // section's material velocity and rate, inertial, in R
    v3 Om;       // rate of S against R
    double s_dot, y_dot, z_dot;
    v3 w_SB; // in S
} rocket_state;

// Inverse of the rocket's 6 x 6 mass matrix, by its inertia about the mass centre.
typedef struct rocket_inertia {
    double m;
    v3 c;            // in R
    m3 J, J_inverse; // about the mass centre, in B
    m3 A_RB;
} rocket_inertia;

typedef struct launching_instant {
    const launching_input *input;
    const launching_phase *phase;
    tube_state tube;
    tube_force on_tube; // h: besides constraint forces
    rocket_state rocket;
    rocket_inertia inertia;
    v3 f, m; // [N], [N m] on the rocket about O1, in R: besides constraint forces
    launching_output *out;
} launching_instant;

#endif
