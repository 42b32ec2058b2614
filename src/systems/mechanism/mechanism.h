// A base of bodies, joints and force elements (model/blocks/mechanism.h) as a multibody system of
// the transfer matrix method: a tree of bodies with loops, stabilisers on joints and struts,
// bushings, jacks, wheels, loads, drag. It takes the wrench of the tube and gives frame T.
//
// State: q coordinates and u speeds of the tree (launchdyn/mstmm.h); z of each hold, the integral
// of its stabiliser or the torque of its equilibrium [N m], [N]; where one has a drive of its own,
// what all drives have [DRIVE_STATES each] (stabiliser.h); of each lock that closes later its
// joint's coordinate then; of each foot xi, eta [m], the ground's deflections along x and z of I;
// the marching subsystem's (marching.h), where there are wheels.
#ifndef LD_SYSTEMS_MECHANISM_H
#define LD_SYSTEMS_MECHANISM_H

#include <stdint.h>

#include "elements/base_frame.h"
#include "elements/guide_forces.h"
#include "elements/tube/work.h"
#include "launchdyn/model.h"
#include "launchdyn/mstmm.h"
#include "model/blocks/mechanism.h"
#include "systems/mechanism/marching.h"
#include "systems/mechanism/stabiliser.h"

enum {
    // each force element may have a point of a beam at each end, so may the tube and its supports
    MECHANISM_MOST_POINTS = 2 * LD_MAX_STRUTS + 2 * LD_MAX_BUSHINGS + LD_MAX_FEET + LD_MAX_LOADS +
                            LD_MAX_DRAGS + 1 + LD_MAX_SUPPORTS,
    MECHANISM_MOST_ELEMENTS = LD_MAX_BODIES + LD_MAX_BEAMS + MECHANISM_MOST_POINTS + 1, // carrier
    MECHANISM_MOST_COORDINATES = 192, // the carrier's included
    MECHANISM_MOST_SPEEDS = 160,
    MECHANISM_MOST_HOLDS = LD_MAX_JOINTS + LD_MAX_STRUTS, // a drive or a lock on each joint
    MECHANISM_MOST_STATES = MECHANISM_MOST_COORDINATES + MECHANISM_MOST_SPEEDS +
                            (1 + DRIVE_STATES) * MECHANISM_MOST_HOLDS + LD_MAX_JOINTS +
                            2 * LD_MAX_FEET + WHEEL_STATES * LD_MAX_WHEELS + 1,
};

// Powers [W] by kind of force, and their works [J].
#define MECHANISM_WORKS(X)                                                                         \
    X(MECHANISM_HOLDS, "drives", "work of the drives and locks of joints and struts")              \
    X(MECHANISM_FRICTION, "joint_friction", "work of friction and dampers in the joints")          \
    X(MECHANISM_GRAVITY, "gravity_bodies", "work of gravity on the bodies")                        \
    X(MECHANISM_BUSHINGS, "bushing_damping", "work of the dampers of bushings and struts")         \
    X(MECHANISM_BEAMS, "beam_damping", "work of the modal damping of the beams")                   \
    X(MECHANISM_FEET, "feet", "work of the ground on the feet")                                    \
    X(MECHANISM_LOADS, "loads", "work of loads and drag")                                          \
    X(MECHANISM_CARRYING, "carrier", "work of the moving carrier")

enum mechanism_power { MECHANISM_WORKS(WORK_PLACE) MECHANISM_POWERS };

enum { MECHANISM_GROUND = -1, MECHANISM_CARRIER = -2 };

// A point of an element of the tree, of the carrier, or of the ground.
typedef struct mechanism_point {
    int element;
    v3 at;   // [m]
    m3 axes; // of what acts there, against the element's
} mechanism_point;

// What holds a joint's coordinate or a strut's length: a stabiliser, a lock, or both.
typedef struct mechanism_hold {
    char name[LD_MAX_NAME];
    char stream[2 * LD_MAX_NAME]; // of its sensors' noise
    const ld_stabiliser *control; // NULL: none
    const ld_hinge_lock *lock;    // in place of the control; NULL: none that closes at the start
    int joint, strut;             // -1: none
    int q, u;                     // of the joint
    ld_follows follows;
    int of;         // element whose yaw or pitch it follows; -1: the tube
    double command; // where there is no control
    int drive;      // where its drive begins in the state; -1: it has none
} mechanism_hold;

typedef struct hold_rest {
    double angle;  // [rad], [m]
    double torque; // [N m], [N]
} hold_rest;

typedef struct mechanism_strut {
    mechanism_point from, to;
    double length; // [m] unloaded
} mechanism_strut;

typedef struct mechanism_bushing {
    mechanism_point from, to;
    m3 turned; // axes of `to` against those of `from` without moment
} mechanism_bushing;

typedef struct mechanism_later_lock {
    int joint, q, u;
    int state; // where it stands
} mechanism_later_lock;

// A joint of the tree with one axis.
typedef struct single_axis {
    int joint, q, u;
    bool resists; // by friction or stops
} single_axis;

// As it was built; constant but for the workspace of its chain.
typedef struct mechanism_system {
    const ld_model *model;
    const ld_mechanism *given;
    ld_mstmm *chain;
    bool overall; // accelerations by the overall transfer equation
    int element_count;
    int q_count, u_count;             // in the state: without the carrier's
    int joint_element[LD_MAX_JOINTS]; // that it carries; -1: it closes a loop,
    int joint_loop[LD_MAX_JOINTS];    // whose number this is
    int seen_count;                   // elements whose motion forces and frames need
    int seen[MECHANISM_MOST_ELEMENTS];
    bool straight[MECHANISM_MOST_ELEMENTS]; // its node in the chain has the body's axes
    int axis_count;
    single_axis axis[LD_MAX_JOINTS];
    int hold_count, z_at, drive_count;
    mechanism_hold hold[MECHANISM_MOST_HOLDS];
    int later_count;
    mechanism_later_lock later[LD_MAX_JOINTS];
    mechanism_strut strut[LD_MAX_STRUTS];
    mechanism_bushing bushing[LD_MAX_BUSHINGS];
    v3 anchor[LD_MAX_FEET]; // [m] where each foot is set down, in I
    mechanism_point foot[LD_MAX_FEET], load[LD_MAX_LOADS], drag[LD_MAX_DRAGS];
    mechanism_point tube; // T's origin, and its axes
    bool tube_turned;     // those are not the body's
    int station_count;    // supports that a beam carries, 0: a body carries them
    mechanism_point station[LD_MAX_SUPPORTS]; // T as fixed to the section that carries one
    int freedom_count;                        // speeds that the others follow (mechanism_loops.h)
    int freedom[MECHANISM_MOST_SPEEDS];
    int feet_at, state_count; // without the marching subsystem's
    int wheels;               // element on which they are; MECHANISM_GROUND: none
    int carrier;  // element that moves as the carrier, the last one; MECHANISM_GROUND: none
    bool carried; // it stands on the carrier, or forces do
    double mass;  // [kg] of all bodies, carried tubes included
} mechanism_system;

typedef struct foot_report {
    double deflection; // [m] into the ground
    double normal;     // [N]
    v3 force;          // [N] on the body, in I
} foot_report;

typedef struct strut_report {
    double length, rate; // [m], [m/s]
    double force;        // [N] pushing, without its actuator's
} strut_report;

typedef struct mechanism_report {
    hinge_report hold[MECHANISM_MOST_HOLDS];
    foot_report foot[LD_MAX_FEET];
    strut_report strut[LD_MAX_STRUTS];
    v3 bushing[LD_MAX_BUSHINGS];    // [N] on `to`, in the bushing's axes
    double friction[LD_MAX_JOINTS]; // [N m], [N]
} mechanism_report;

// Where a body is and how it moves, in I.
typedef struct body_motion {
    v3 r, v; // [m], [m/s] its origin
    m3 A;
    v3 w; // [rad/s]
} body_motion;

// The whole at an instant: frame T, the motions of elements, coordinates and speeds of the chain.
typedef struct mechanism_motion {
    base_frame tube;
    base_frame station[LD_MAX_SUPPORTS];
    base_frame carrier;
    double t; // [s]
    const ld_mstmm *chain;
    uint64_t move; // that of the chain which found this
    double q[MECHANISM_MOST_COORDINATES], u[MECHANISM_MOST_SPEEDS];
    body_motion body[MECHANISM_MOST_ELEMENTS]; // of those that are seen
} mechanism_motion;

typedef struct mechanism_input {
    v3 tube_force, tube_moment;   // [N], [N m] on the tube's body about T's origin, in T
    const guide_wrench *station;  // and on each station, in its axes; NULL: on none
    v3 wheel_force, wheel_moment; // on the wheels' body, about its origin, in I
    const double *command, *rate; // [hold_count] added to commands and their rates; NULL: nothing
    double density;               // [kg/m3] of the air
    v3 wind;                      // [m/s] its velocity in I
    const hold_rest *rest;        // [hold_count] of locks and of what is held
    bool held;                    // holds carry their rest's torque (equilibrium)
    bool linear;                  // no Coulomb friction, drives as linear ones
} mechanism_input;

typedef struct mechanism_output {
    double power[MECHANISM_POWERS];
    double elastic; // [J]
    double loss;    // overall form: largest difference from the reduced sweep, relative
    mechanism_report report;
    // what acts on each element [N], [N m] about its origin, in I, but for joints
    double wrench[6 * MECHANISM_MOST_ELEMENTS];
} mechanism_output;

#endif
