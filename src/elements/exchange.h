// What the elements of the launching subsystem are given at an instant, and what they report.
#ifndef LD_ELEMENTS_EXCHANGE_H
#define LD_ELEMENTS_EXCHANGE_H

#include <stdbool.h>

#include "elements/air/aerodynamics.h"
#include "elements/base_frame.h"
#include "elements/guide_forces.h"
#include "elements/motor.h"
#include "elements/tube/flexible_tube.h"
#include "elements/tube/work.h"

enum { LD_MAX_MODAL = 2 * LD_NB + LD_NT + LD_NA };

// Offsets in the state of the launching subsystem: r_R [3] origin of R in I [m]; q_IR [4]
// quaternion of R; v, w [3 + 3] velocity of R's origin and angular velocity of R, in R; q, q_dot
// [nq] modal coordinates; x [6] the rocket's coordinates in the tube; V [6] velocity of O1 and rate
// of B against I, in R.
typedef struct launching_layout {
    int r, quaternion, v, w, q, q_dot, x, V;
    int nq;
    int count; // states in all
} launching_layout;

// The rocket's coordinates in the tube, from `x` on: travel [m], offsets [m], angles [rad] of A_SB.
enum { X_S, X_Y, X_Z, X_PSI, X_THETA, X_GAMMA, X_COUNT };

enum { LD_SLIDE_STOPS = 2 }; // of a recoil slide: the front one, the one behind

// What a line does that the rocket pulls: as fast as the rocket, slack, drawn taut up to where the
// wave has come, or broken.
typedef enum line_state { LINE_TAUT, LINE_SLACK, LINE_JERKED, LINE_BROKEN } line_state;

// What is switched by events.
typedef struct launching_phase {
    bool rocket; // in the tube
    bool locked;
    bool passed[LD_MAX_ADAPTORS];
    double touch_speed[LD_MAX_ADAPTORS]; // [m/s] at first touch (law lankarani-nikravesh)
    double surface_speed[LD_MAX_ADAPTORS][LD_MAX_SURFACES]; // [m/s] the same of each surface
    double breech;       // [m] its station: it stops a rocket without a lock there
    double breech_speed; // [m/s] at which that one touched it last
    // each stop of the recoil slides: pushes (1), does not (-1), or as it lies and moves (0)
    int pushing[LD_MAX_SUPPORTS][LD_SLIDE_STOPS];
    line_state line;
    double line_out;   // [m] length of a line that is out, unless it is LINE_TAUT
    bool frictionless; // Coulomb friction off (equilibrium, linearisation)
    // [1/s2] what constraints hold in place is pulled back there by so much (equilibrium); else 0
    double restoring;
} launching_phase;

// What is put on tube and rocket, in R: on the section at the tube's tip, on the rocket at its mass
// centre.
typedef struct launching_load {
    v3 tip_force, tip_moment, rocket_force, rocket_moment; // [N], [N m]
} launching_load;

// The air along the guide at one instant, where the guide feels it.
typedef struct air_about {
    moving_air (*at)(const void *self, double t, v3 r); // without turbulence, at r of I; NULL: none
    const void *self;
    double t;
    v3 turbulence; // [m/s] in I, the same all along the guide
    const base_frame
        *going; // the base held still goes like this through the air; NULL: it does not
} air_about;

// A jet on a part of the guide that is fixed to one of its sections.
typedef struct guide_push {
    double hit; // [N] force of the jet that hits it
    v3 force;   // [N] on the part, in axes of the section
    v3 at;      // [m] where, from the section's axis point
} guide_push;

// What comes from outside at one instant.
typedef struct launching_input {
    base_frame base;
    const base_frame *station; // of a flexible base, by support: T as the section that carries it
                               // goes; NULL: the base carries all
    double thrust;             // [N]
    motor_across across;       // of the motor
    double since;              // [s] the ignition, for the pressure
    int pressure_piece;        // of its table over time, from 1; else 1; 0: not lit
    rocket_mass mass;
    moving_air air;                   // about the rocket; read where it feels it
    air_about about;                  // the guide
    guide_push jet_face, deflector;   // of the rocket's jet; no hit: none
    const aerodynamics *aerodynamics; // of the whole rocket, on an open guide; NULL: none
    bool power;                       // the thrust table has not ended: for those
    const launching_load *load;       // where it is linearised; NULL: none
    guide_forces *record;             // of what acts on the tube; NULL: none is kept
} launching_input;

typedef struct adaptor_report {
    double s, y, z;     // [m] foot and offset
    double penetration; // [m]
    double normal;      // [N] normal force, of several surfaces their sum
    double force;       // [N] with friction
} adaptor_report;

// What the surfaces of a guide do to a shoe, in the axes of the section at its foot.
typedef struct shoe_report {
    double penetration[LD_MAX_SURFACES]; // [m] of each surface, negative: gap
    double force_y, force_z;             // [N] on the rocket
    double moment_x;                     // [N m] on it, about the guide line
} shoe_report;

// Powers [W] by kind of force, and the works [J] that they add up to.
#define DRIVING_WORKS(X)                                                                           \
    X(POWER_THRUST, "thrust", "work of the thrust")                                                \
    X(POWER_GRAVITY_ROCKET, "gravity_rocket", "work of gravity on the rocket")                     \
    X(POWER_CONTACT_NORMAL, "contact_normal", "work of the normal forces of adaptors and breech")  \
    X(POWER_CONTACT_FRICTION, "contact_friction", "work of the contact friction")
// Where there is a slot.
#define SLOT_WORKS(X)                                                                              \
    X(POWER_SLOT, "slot", "work of the slot force (zero but for step errors)")                     \
    X(POWER_SLOT_FRICTION, "slot_friction", "work of the slot friction")
#define HOLDING_WORKS(X)                                                                           \
    X(POWER_LOCK, "lock", "work of the lock (zero but for step errors)")                           \
    X(POWER_SUPPORT_DAMPING, "support_damping", "work of the support dampers")                     \
    X(POWER_MODAL_DAMPING, "modal_damping", "work of the modal damping")                           \
    X(POWER_BASE, "base", "work of the moving base through the supports")                          \
    X(POWER_MASS_CHANGE, "mass_change", "kinetic energy carried off by burnt propellant")
#define LAUNCHING_WORKS(X) DRIVING_WORKS(X) SLOT_WORKS(X) HOLDING_WORKS(X)

// That of the air, where it acts before the release: in a bore on what has emerged, on an open
// guide on the whole rocket. Never both: they have one place.
#define CROSSFLOW_WORKS(X)                                                                         \
    X(POWER_AIR, "crossflow", "work of the air on the emerged part of the rocket")
#define OPEN_AIR_WORKS(X) X(POWER_AIR, "air", "work of the air on the rocket on its guide")

// That of the pressure behind the rocket, and of slides on which the tube recoils, likewise.
#define PRESSURE_WORKS(X) X(POWER_PRESSURE, "pressure", "work of the pressure on rocket and tube")
#define RECOIL_WORKS(X)                                                                            \
    X(POWER_RECOIL, "recoil", "work of damping and friction of the recoil slides")

// That of a line that the rocket draws out of its container.
#define LINE_WORKS(X) X(POWER_LINE, "line", "work of the line on the rocket")

// That of the wind on the guide itself.
#define GUIDE_WIND_WORKS(X) X(POWER_GUIDE_WIND, "guide_wind", "work of the wind on the guide")

// That of the jet on the guide's front end.
#define GUIDE_JET_WORKS(X) X(POWER_GUIDE_JET, "guide_jet", "work of the jet on guide and deflector")

enum launching_power {
    LAUNCHING_WORKS(WORK_PLACE) CROSSFLOW_WORKS(WORK_PLACE) PRESSURE_WORKS(WORK_PLACE)
        RECOIL_WORKS(WORK_PLACE) LINE_WORKS(WORK_PLACE) GUIDE_WIND_WORKS(WORK_PLACE)
            GUIDE_JET_WORKS(WORK_PLACE) POWER_COUNT,
    POWER_ALWAYS = POWER_AIR, // those that are always there come first
};

// A slide on which the tube recoils.
typedef struct slide_report {
    double travel, rate; // [m], [m/s] travel back from the front stop
    double force;        // [N] on the tube, along x of the base's tube axes
} slide_report;

typedef struct launching_output {
    v3 a, w_dot;                 // inertial acceleration of R's origin, derivative of w, in R
    double q_ddot[LD_MAX_MODAL]; // [nq]
    v3 a_O1, alpha_B;            // of the rocket against I, in R
    double x_dot[X_COUNT];
    double y[6];              // the theory's relative speeds: s_dot, y_S_dot, z_S_dot, w_SB (in S)
    double N;                 // [N] slot force
    double slot_friction;     // [N] along tau on the rocket
    double lock_force;        // [N] carried, along +x (minus the force on the rocket)
    double breech_force;      // [N] on the rocket along +x
    double pressure;          // [Pa] net, where there is one
    double pressure_force;    // [N] on the rocket along +x
    double line_tension;      // [N] pull of a line on the rocket
    double line_paid;         // [m] its length that is out
    double line_left;         // falls through zero where its line_state changes
    double emerged;           // [m] length of the rocket that is out of the tube, in the air
    v3 crossflow;             // [N] force of the air on it, in R
    double guide_jet;         // [N] of the jet on the guide's front end
    double deflector;         // [N] of the jet that hits it
    v3 guide_wind;            // [N] of the wind on the guide, where it feels it, in R
    double air_mach;          // of the mass centre through the air, where all of it feels that
    v3 air_force, air_moment; // [N], [N m] of the air on it, about the mass centre, in R
    double drift;             // [m/s] n . v_rel, zero but for the step error
    double power[POWER_COUNT];
    double elastic;                        // [J] of supports and modes
    v3 base_force, base_moment;            // [N], [N m] on the base, moment about T's origin, in T
    guide_wrench station[LD_MAX_SUPPORTS]; // in its place where there are stations: on each, about
                                           // its origin, in its axes
    double y_dot[6];                       // overall form alone: derivative of y
    double condition;                      // overall form alone: of L_I Q L_O^T of the tube
    bool fell_back;                        // overall form alone
    adaptor_report adaptor[LD_MAX_ADAPTORS];
    slide_report slide[LD_MAX_SUPPORTS]; // of the supports that are slides, in their order
    shoe_report shoe[LD_MAX_ADAPTORS];   // on surfaces alone
} launching_output;

#endif
