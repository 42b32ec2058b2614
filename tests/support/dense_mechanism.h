// An independent mechanism: every body of a base of kind multibody free in space, all joints, those
// of the tree and those that close loops, as Lagrange multipliers at acceleration level. A joint is
// what it keeps of two frames' positions and directions; series in time give the rows of its
// constraints and their terms in the velocities. Force elements as docs/scenario.md and the headers
// of systems/mechanism word them.
//
// States and rates have the layout of systems/mechanism/mechanism.h; no code of the program but its
// vectors, tables and air is used. Bodies are rigid; roads as those of support/dense_vehicle.h.
#ifndef LD_TESTS_SUPPORT_DENSE_MECHANISM_H
#define LD_TESTS_SUPPORT_DENSE_MECHANISM_H

#include "support/dense_tree.h"
#include "systems/bases/base.h"

// A rigid body about its origin, body axes.
typedef struct dense_body {
    double mass;
    v3 moment;  // [kg m] mass times mass centre
    m3 inertia; // [kg m2]
} dense_body;

// What holds a joint's coordinate or a strut's length.
typedef struct dense_hold {
    int drive, joint, strut; // -1: none
} dense_hold;

typedef struct dense_mechanism {
    const ld_model *model;
    const ld_mechanism *given;
    dense_body body[LD_MAX_BODIES];
    int tube_body;
    v3 tube_at; // T on its body
    m3 tube_axes;
    int joint_of[LD_MAX_BODIES]; // that carries the body
    bool closes[LD_MAX_JOINTS];  // joints that close loops
    int q_at[LD_MAX_BODIES], u_at[LD_MAX_BODIES], q_count, u_count;
    int hold_count;
    dense_hold hold[MECHANISM_MOST_HOLDS];
    int z_at, drive_at; // -1: no drives in the state
    int later_at[LD_MAX_JOINTS];
    int feet_at, wheels_at, state_count;
    // of the start
    double strut_length[LD_MAX_STRUTS];
    v3 bushing_at[LD_MAX_BUSHINGS];
    m3 bushing_turn[LD_MAX_BUSHINGS]; // axes without moment against those of `to`
} dense_mechanism;

// Prepares `self` (keeps the model) while tube number `launching` launches; the `fired` ones have
// no rocket. What counts from the start is missing until dense_mechanism_begin().
void dense_mechanism_create(dense_mechanism *self, const ld_model *model, int launching,
                            const int *fired, int fired_count);

// The coordinates that the scenario gives, before loops are closed.
void dense_mechanism_start(const dense_mechanism *self, double *state);
// What counts from the start: lengths of struts, places where bushings meet.
void dense_mechanism_begin(dense_mechanism *self, const base_frame *carrier, const double *start);

typedef struct dense_mechanism_input {
    double t;
    const double *state;
    const base_frame *carrier;
    v3 tube_force, tube_moment;   // [N], [N m] in T, about T's origin
    const struct hold_rest *rest; // of holds
    bool held, linear;
} dense_mechanism_input;

typedef struct dense_frame {
    v3 r, v, w; // in I
    m3 A;
    v3 a, alpha;
} dense_frame;

typedef struct dense_mechanism_output {
    double rate[BASE_MOST_STATES];
    double power[MULTIBODY_POWERS], tube_power;
    double elastic, kinetic;
    dense_frame body[LD_MAX_BODIES];
    base_frame tube;
    struct {
        v3 force, moment; // on the body, about its joint's point there, in I, springs and all
        double position[2], rate[2]; // along, then about the axis of those that have one
    } joint[LD_MAX_JOINTS];
    hinge_report hold[MECHANISM_MOST_HOLDS];
    foot_report foot[LD_MAX_FEET];
    strut_report strut[LD_MAX_STRUTS];
    v3 bushing[LD_MAX_BUSHINGS];
    double friction[LD_MAX_JOINTS];
    struct {
        double deflection, normal, along, side;
    } wheel[LD_MAX_WHEELS];
    double inconsistent; // largest part of an acceleration that no joint lets happen
    double open;         // largest gap of a constraint [m, -]
    int rows, redundant; // constraints of all joints
} dense_mechanism_output;

// Returns false where the dense system is singular.
bool dense_mechanism_evaluate(const dense_mechanism *self, const dense_mechanism_input *input,
                              dense_mechanism_output *output);

// Motion of the bodies alone.
void dense_mechanism_place(const dense_mechanism *self, const dense_mechanism_input *input,
                           dense_mechanism_output *output);

#endif
