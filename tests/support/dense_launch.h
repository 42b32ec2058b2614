// An independent launching subsystem: the equations of motion from positions alone.
//
// Tube, tail and rocket are sums of mass points. Their positions are written once, as functions of
// the generalised coordinates, in jet arithmetic (support/jet.h), which gives Jacobians and
// velocity-dependent accelerations; slot and lock are rows of a dense system with multipliers. No
// mechanics of the program is used, only its data: the model and the mode shapes.
//
// Frames: I inertial, R of the tube (origin at the rear end), S section of the tube at the rocket's
// rear adaptor, B rocket. Quaternions (w, x, y, z) turn coordinates in the second frame into the
// first. Modal coordinates in the order of flexible_tube.h, without padding: q_y, q_z, q_t, q_a.
#ifndef LD_TESTS_SUPPORT_DENSE_LAUNCH_H
#define LD_TESTS_SUPPORT_DENSE_LAUNCH_H

#include <stdbool.h>

#include "elements/tube/flexible_tube.h"
#include "launchdyn/model.h"

enum { DENSE_MAX_MODES = 28, DENSE_MAX_COORDINATES = DENSE_MAX_MODES + 12 };

// A point of the tube's axis that carries mass [kg] and polar inertia [kg m2].
typedef struct dense_tube_point {
    double at, mass, polar;
} dense_tube_point;

// A plane of a rail beside one shoe, or what a round shoe touches of it.
typedef struct dense_surface {
    int shoe;                 // an adaptor
    double y, z, normal, gap; // [m] from the guide line; [rad] from y towards z; [m]
    bool round;               // the shoe's centre counts, not the body's point at (y, z)
} dense_surface;

enum { DENSE_MAX_SURFACES = 256 };

// A model made ready: quadrature points along the tube, surfaces of every shoe.
typedef struct dense_launch {
    const ld_model *model;
    const flexible_tube *tube;
    double line[2]; // [m] guide line from the tube's axis, y and z
    int surface_count;
    dense_surface surface[DENSE_MAX_SURFACES];
    int mode_count; // 2 nb + nt + na
    // stiffness int EI b'' b''^T dx and damping 2 zeta K^(1/2) of bending along y, along z
    double K[2][LD_NB][LD_NB], D[2][LD_NB][LD_NB]; // [1/s2], [1/s]
    int point_count;
    dense_tube_point *point;
} dense_launch;

// Prepares `dense` (keeps both pointers). Free with dense_launch_free().
void dense_launch_create(dense_launch *dense, const ld_model *model, const flexible_tube *tube);
void dense_launch_free(dense_launch *dense);

// Whether the lock holds roll: as the model says, or in smooth bores and on round surfaces alone.
bool dense_launch_holds_roll(const dense_launch *dense);

// The base that carries the tube: the frame that the undeformed tube's rear end has on it.
typedef struct dense_base {
    double r[3];           // [m] in I
    double A[3][3];        // from tube axes to I (base pose, azimuth and elevation together)
    double v[3];           // [m/s] in I
    double w[3];           // [rad/s] in I
    double a[3], alpha[3]; // [m/s2], [rad/s2] in I; where a support is clamped
} dense_base;

// What acts at one instant, beside the state.
typedef struct dense_conditions {
    dense_base base;
    double mass;        // [kg] of the rocket
    double center[3];   // [m] in B, eccentricity included
    double inertia[3];  // [kg m2] about the mass centre, in B
    double products[3]; // [kg m2] J_xy, J_xz, J_yz of the matrix
    double thrust;      // [N] of the first motor
    // of each further motor the force [N] and where it acts [m], in B
    struct {
        double force[3], at[3];
    } further[LD_MAX_FURTHER_MOTORS];
    double across[6]; // [N] side force y, z, [-] direction (1, y, z) and [m] y, z of the nozzle
    double pressure;  // [Pa] net, behind the rocket, where the travel does not say it
    bool pressed;     // the pressure is on
    int slot_piece; // stretch of the slot's table: 0 as s says, 1 before its first point, 2 between
                    // the first and the second, ... (held by an integrator while it passes a point)
    bool locked;    // lock closed (slot friction off; slot `none`: roll held too)
    bool frictionless;                   // all friction off (for the equilibrium)
    bool passed[LD_MAX_ADAPTORS];        // adaptor has left the tube
    double touch_speed[LD_MAX_ADAPTORS]; // [m/s] of Lankarani-Nikravesh; 0: the reference speed
    double surface_touch_speed[DENSE_MAX_SURFACES]; // the same, where the guide has surfaces
    double breech, breech_speed;          // [m] station of the breech; [m/s] touched at, likewise
    double air[3], density;               // [m/s] velocity of the air, in I; [kg/m3]
    double sound;                         // [m/s] speed of sound
    double jet_face[3], jet_face_at[3];   // [N], [m] in axes of the section at the tip
    double deflector[3], deflector_at[3]; // likewise, behind the rear end or on the guide
    bool power;                           // the thrust table has not ended
    int slide_stop[LD_MAX_SUPPORTS][2]; // front and rear stop of a support's slide: 0 as its travel
                                        // says, 1 pushes, -1 does not (held by an integrator)
} dense_conditions;

// State as the program has it: rocket relative to the tube, speeds absolute, in R axes.
typedef struct dense_launch_input {
    double r[3];                   // [m] origin of R in I
    double quaternion[4];          // A_IR
    double v[3], w[3];             // [m/s], [rad/s] of R in R axes
    double q[DENSE_MAX_MODES];     // modal coordinates
    double q_dot[DENSE_MAX_MODES]; // and speeds
    double s, y, z;                // [m] of O1: station and offset in S
    double psi, theta, gamma;      // [rad] A_SB = Rz(psi) Ry(theta) Rx(gamma)
    double V[6];                   // [m/s], [rad/s] v_O1, w_B in R axes
    dense_conditions conditions;
} dense_launch_input;

typedef struct dense_launch_output {
    double a[3];     // [m/s2] inertial acceleration of R's origin, in R axes
    double w_dot[3]; // [rad/s2] in R axes
    double q_ddot[DENSE_MAX_MODES];
    double a_O1[3];      // [m/s2] inertial acceleration of O1, in R axes
    double alpha_B[3];   // [rad/s2] inertial angular acceleration of B, in R axes
    double slot_force;   // [N] N; 0 without slot
    double lock_force;   // [N] carried along +x (minus the force on the rocket); 0 when open
    double lock_moment;  // [N m] on the rocket along e_x of S (slot none, locked)
    double breech_force; // [N] on the rocket along e_x of S
    double gas_force;    // [N] of the pressure on the rocket
    double slide_force;  // [N] of all recoil slides on the tube, along the base's x
    double slide_press[LD_MAX_SUPPORTS][2]; // [N] positive where its front or rear stop pushes
    double emerged;                     // [m] of the rocket out of the tube, where it feels the air
    double crossflow[3];                // [N] of the air on it, in R
    double guide_wind[3];               // [N] of the air on the guide, in R
    double air_force[3], air_moment[3]; // [N], [N m] on all of it, about its mass centre, in R
    double slot_drift;                  // [m/s] n . v_rel
    double lock_drift;                  // [m/s] e_x . v_rel at its point, locked
    double lock_roll; // [rad/s] about e_x of S against the tube there (slot none, locked)
    double s, s_dot;  // [m], [m/s] station of O1
    double y, z, psi, theta, gamma; // of the rocket in S, as in the input
    double w_SB[3];                 // [rad/s] rate of B against S (which moves on with s), in S
    struct {
        double s;                // [m] foot
        double penetration;      // [m] p, negative: apart
        double penetration_rate; // [m/s]
        double normal;           // [N] F_n
        double force[3];         // [N] on the rocket, normal and friction, in I
        double moment[3];        // [N m] the same about the shoe's centre (surfaces alone)
    } contact[LD_MAX_ADAPTORS];  // with surfaces: deepest penetration, sum of forces
    struct {
        double penetration, penetration_rate, normal; // [m], [m/s], [N]
    } surface[DENSE_MAX_SURFACES];
    double base_force[3], base_moment[3]; // on the base, in its axes, about its origin
    double kinetic;                       // [J] of everything
    double potential; // [J] modes, support springs, gravity of everything (from I's origin)
    double power;     // [W] of all that is not in kinetic or potential (fixed base): contacts,
                      // thrust, damping, lock, slot
    double momentum[3], angular_momentum[3]; // of everything, in I about its origin
} dense_launch_output;

// Accelerations and forces of one state. Returns false where the dense system is singular or no
// sign of the slot force is consistent.
bool dense_launch_evaluate(const dense_launch *dense, const dense_launch_input *input,
                           dense_launch_output *output);

// The same in absolute coordinates, for an integrator: attitudes as matrices, rocket by O1 and
// A_IB.
typedef struct dense_state {
    double r[3], A_R[3][3], v[3]; // in I
    double w[3];                  // of R in R
    double q[DENSE_MAX_MODES], q_dot[DENSE_MAX_MODES];
    double r_O1[3], A_B[3][3], v_O1[3]; // in I
    double w_B[3];                      // of B in B
    double s;                           // [m] a guess of O1's station
} dense_state;

// Accelerations of a dense_state, its equilibrium residual and the directions of its multipliers.
typedef struct dense_rates {
    double x_ddot[DENSE_MAX_COORDINATES]; // a_R in I, w_dot in R, q_ddot, a_O1 in I, w_B_dot in B
    double h[DENSE_MAX_COORDINATES];      // generalised forces without multipliers
    double G[3][DENSE_MAX_COORDINATES];   // of unit lock force (on the rocket), slot force, moment
} dense_rates;

// `rates` or `output` may be NULL.
bool dense_launch_rates(const dense_launch *dense, const dense_state *state,
                        const dense_conditions *conditions, dense_rates *rates,
                        dense_launch_output *output);

// The tip against the undeformed tube on the base, in its axes: y, z, pitch and yaw of the
// section's x axis, and the time derivatives of the four.
void dense_launch_tip(const dense_launch *dense, const dense_state *state, const dense_base *base,
                      double tip[8]);

// Absolute state of a relative one.
void dense_launch_place(const dense_launch *dense, const dense_launch_input *input,
                        dense_state *state);

#endif
