// The launching subsystem: tail, flexible tube on its supports, rocket in the tube (model.md
// sections 3 to 5; formulation.md sections 3 to 5). Given state and base it finds all
// accelerations.
//
// State (flat array, offsets in launching_layout):
//   r_R [3] origin of R in I [m]      q_IR [4] quaternion of R         v, w [3 + 3] velocity of R's
//   origin and angular velocity of R, in R   q, q_dot [nq] modal coordinates  x [6] s, y_S, z_S,
//   psi, theta, gamma                             V [6] velocity of O1 and rate of B against I, in
//   R
#ifndef LD_SYSTEMS_LAUNCHING_H
#define LD_SYSTEMS_LAUNCHING_H

#include <stdbool.h>

#include "elements/contact.h"
#include "elements/flexible_tube.h"
#include "elements/motor.h"
#include "math/lanes.h"
#include "systems/base_motion.h"

enum {
    LD_MAX_MODAL = 2 * LD_NB + LD_NT + LD_NA,
    LD_FIXED_ROWS = 2 * LD_MAX_SUPPORTS + 4, // b and b' at each support, ct, c; padded
};

typedef struct launching_layout {
    int r, quaternion, v, w, q, q_dot, x, V;
    int nq;
    int count; // states in all
} launching_layout;

// Shapes of one finite element packed twice: by mode (four powers of xi side by side, for sums over
// modes) and by power (modes side by side, for forces on the modes).
typedef struct packed_element {
    double x0, x1;
    _Alignas(32) double by_mode[LD_NB][4];
    _Alignas(32) double by_power[4][LD_NB];
    double tau[LD_NT][2];
    double a[LD_NA][2];
    double ctb[4], cb[4]; // ct . b and c . b as polynomials
} packed_element;

typedef struct launching_support {
    double x;          // [m] station
    v3 K, C, Kr, Cr;   // springs and dampers, base axes
    bool isotropic;    // Kr the same about all three axes
    double tau[LD_NT]; // torsion shapes there
    double a[LD_NA];   // axial shapes there
} launching_support;

typedef struct launching_system {
    const ld_model *model;
    ld_tubes tubes; // what the tube was built of
    flexible_tube tube;
    launching_layout layout;
    double gravity; // [m/s2] along -y of I

    // tube and tail, tail folded in
    double m, Sx;    // [kg], [kg m] of both
    double jx;       // [kg m2] condensed inertia about x: j - cp . cp + tail
    v3 tail_inertia; // [kg m2] about the rear section's point

    int support_count;
    launching_support support[LD_MAX_SUPPORTS];
    int row_count; // 2 support_count + 2
    int row_lanes; // lanes of four rows
    // b, b' at the supports, then ct, c: by mode and by row
    _Alignas(32) double rows_by_mode[LD_NB][LD_FIXED_ROWS];
    _Alignas(32) double rows[LD_FIXED_ROWS][LD_NB];
    LANE_ARRAY(om2, LD_NB); // bending
    LANE_ARRAY(dmp, LD_NB);
    packed_element *packed; // [tube.element_count], 64-byte aligned

    int adaptor_count;
    double adaptor_at[LD_MAX_ADAPTORS];
    double clearance[LD_MAX_ADAPTORS];
    contact_law contact;

    bool slot; // helix (or straight) slot; false: smooth bore
    const ld_table *slot_angle;
    double knob_radius, knob_y, knob_z; // rho_E = (0, knob_y, knob_z)
    double slot_friction;
    bool wide_instructions; // AVX2 is there
} launching_system;

// What is switched by events.
typedef struct launching_phase {
    bool rocket; // in the tube
    bool locked;
    bool passed[LD_MAX_ADAPTORS];
    double touch_speed[LD_MAX_ADAPTORS]; // [m/s] at first touch (law lankarani-nikravesh)
    double breech;                       // [m] its station: it stops a rocket without a lock there
    double breech_speed;                 // [m/s] at which that one touched it last
    bool frictionless;                   // Coulomb friction off (equilibrium, linearisation)
} launching_phase;

// What comes from outside at one instant.
typedef struct launching_input {
    base_frame base;
    double thrust; // [N]
    rocket_mass mass;
} launching_input;

typedef struct adaptor_report {
    double s, y, z;     // [m] foot and offset
    double penetration; // [m]
    double normal;      // [N] normal force
    double force;       // [N] with friction
} adaptor_report;

// Powers by kind of force [W], in the order of ld_work.
enum launching_power {
    POWER_THRUST,
    POWER_GRAVITY_ROCKET,
    POWER_CONTACT_NORMAL, // of adaptors and breech
    POWER_CONTACT_FRICTION,
    POWER_SLOT,
    POWER_SLOT_FRICTION,
    POWER_LOCK,
    POWER_SUPPORT_DAMPING,
    POWER_MODAL_DAMPING,
    POWER_BASE,
    POWER_MASS_CHANGE,
    POWER_COUNT
};

typedef struct launching_output {
    v3 a, w_dot;                 // inertial acceleration of R's origin, derivative of w, in R
    double q_ddot[LD_MAX_MODAL]; // [nq]
    v3 a_O1, alpha_B;            // of the rocket against I, in R
    double x_dot[6];
    double y[6];          // s_dot, y_S_dot, z_S_dot, w_SB (in S)
    double N;             // [N] slot force
    double slot_friction; // [N] along tau on the rocket
    double lock_force;    // [N] carried, along +x (minus the force on the rocket)
    double breech_force;  // [N] on the rocket along +x
    double drift;         // [m/s] n . v_rel, zero but for the step error
    double power[POWER_COUNT];
    double elastic;             // [J] of supports and modes
    v3 base_force, base_moment; // [N], [N m] on the base, moment about T's origin, in T
    double y_dot[6];            // overall form alone: derivative of y
    double condition;           // overall form alone: of L_I Q L_O^T of the tube
    bool fell_back;             // overall form alone
    adaptor_report adaptor[LD_MAX_ADAPTORS];
} launching_output;

typedef enum launching_outcome {
    LAUNCHING_OK,
    LAUNCHING_JAMMED,     // no consistent sign of N: the knob jams
    LAUNCHING_NOT_FINITE, // NaN or infinity
} launching_outcome;

// What is found once from the tube's numbers, taken from one system to be used by the next.
typedef struct launching_tube {
    ld_tubes tubes;
    flexible_tube tube;
    packed_element *packed;
} launching_tube;

// Takes it from a system that is used no more.
launching_tube launching_take_tube(launching_system *self);
void launching_tube_free(launching_tube *self);

// Builds the system; with what was kept (or NULL) where the tube is the same to the bit, which it
// then owns.
ld_status launching_build(launching_system *self, const ld_model *model, launching_tube *kept,
                          ld_error *error);
// Takes the numbers of the rocket from the model again.
void launching_set_rocket(launching_system *self);
void launching_free(launching_system *self);

// Accelerations by the reduced form in its fast layout (formulation.md, section 5).
launching_outcome launching_evaluate(const launching_system *self, const launching_input *input,
                                     const launching_phase *phase, const double *state,
                                     launching_output *output);

// The same from the general mass matrix, in the reduced form or in the paper's overall form: tail
// and tube as 13 x 13 transfer matrices, 19 unknowns (20 while locked; formulation.md, section 4).
// The overall form also gives y_dot and the condition of the tube's transfer matrix; where that one
// cannot hold it falls back on the reduced form and says so in `fell_back`.
launching_outcome launching_evaluate_general(const launching_system *self,
                                             ld_formulation formulation,
                                             const launching_input *input,
                                             const launching_phase *phase, const double *state,
                                             launching_output *output);

// Derivative of the state from the accelerations found.
void launching_rates(const launching_system *self, const double *state,
                     const launching_output *output, bool rocket, double *state_dot);

// Where the rocket is and how it moves, in R.
typedef struct launching_pose {
    v3 p1; // [m] O1
    m3 A_RS, A_RB;
    v3 v_O1; // [m/s] inertial
    v3 w_B;  // [rad/s] against I
} launching_pose;

// Fills `pose` and, of `output`, x_dot and y.
void launching_rocket_pose(const launching_system *self, const double *state, launching_pose *pose,
                           launching_output *output);

// The section at station x (its point of the axis and frame, with their velocity and rate against
// I), in R.
typedef struct launching_section {
    v3 P;
    m3 A;
    v3 v, w;
} launching_section;

void launching_section_at(const launching_system *self, const double *state, double x,
                          launching_section *section);

// Rate [m/s] at which adaptor i's offset from the axis grows, the foot's motion included.
double launching_offset_rate(const launching_system *self, const double *state, int i);

// Feet of the adaptors on the axis [m] (only those not passed), for the events.
void launching_feet(const launching_system *self, const launching_phase *phase, const double *state,
                    double *feet);

// Kinetic energy of tube, tail and (if in the tube) rocket [J].
double launching_kinetic_energy(const launching_system *self, const launching_input *input,
                                const launching_phase *phase, const double *state);
// Potential energy of tube and tail in gravity [J], from the origin of I.
double launching_potential_energy(const launching_system *self, const double *state);

// Removes the velocity drift of the slot (formulation.md, section 3) from `state`; keeps all
// momenta.
void launching_project(const launching_system *self, const launching_input *input,
                       const launching_phase *phase, double *state);

#endif
