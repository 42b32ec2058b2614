// The launching subsystem: tail, flexible tube on its supports, rocket in the tube (model.md
// sections 3 to 5; formulation.md sections 3 to 5). Given state and base it finds all
// accelerations.
#ifndef LD_SYSTEMS_LAUNCHING_H
#define LD_SYSTEMS_LAUNCHING_H

#include "elements/guide/adaptor.h"
#include "elements/guide/breech.h"
#include "elements/guide/clamp.h"
#include "elements/guide/crossflow.h"
#include "elements/guide/guide_cut.h"
#include "elements/guide/ideal.h"
#include "elements/guide/lock.h"
#include "elements/guide/open_air.h"
#include "elements/guide/pressure.h"
#include "elements/guide/shoe.h"
#include "elements/guide/slot.h"
#include "elements/guide/support.h"
#include "elements/load.h"

typedef struct launching_system {
    const ld_model *model;
    const ld_rocket *rocket; // in the tube
    ld_tubes tubes;          // what the tube was built of
    launching_layout layout;
    // the elements
    tube_system tube; // with its tail
    support_set supports;
    adaptor_set adaptors;
    surface_set surfaces; // of a guide that is no bore
    slot_system slot;
    lock_system lock;
    crossflow_body crossflow;
    pressure_system pressure;
    guide_cut *cut; // [tubes.station_count] at the stations where loads are asked for, owned
    int work_count; // of the powers: the first so many
    bool wide_instructions; // AVX2 is there
} launching_system;

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
// Takes the numbers of the rocket that comes into the tube; the first is that of the first firing.
void launching_set_rocket(launching_system *self, const ld_rocket *rocket);
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

// What an impulse changes speeds by (or, along the same directions, places): as accelerations of
// the tube and of the rocket.
typedef struct launching_change {
    v3 a, w_dot, a_O1, alpha_B;
    double q_ddot[LD_MAX_MODAL];
} launching_change;

// The impulse of the set's constraints that takes `wrong` [set->count] out of their rates, from the
// general mass matrix; none where that is not positive definite.
void launching_impulse_general(const launching_system *self, const launching_instant *now,
                               const constraint_set *set, const double *state, const double *wrong,
                               launching_change *change);

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

// Where the rocket's point (of B [m]) is in I [m].
v3 launching_rocket_point(const launching_system *self, const double *state, v3 point);

// The section at station x (its point of the axis and frame, with their velocity and rate against
// I), in R.
typedef struct launching_section {
    v3 P;
    m3 A;
    v3 v, w;
} launching_section;

void launching_section_at(const launching_system *self, const double *state, double x,
                          launching_section *section);

// What the tube carries at the stations asked for, and what each support puts on it.
typedef struct launching_loads {
    guide_load station[LD_MAX_STATIONS];
    guide_wrench support[LD_MAX_SUPPORTS]; // at the support's station, in base axes
} launching_loads;

// From the output of an evaluation and the record that it was given in `input`.
void launching_find_loads(const launching_system *self, const launching_input *input,
                          const double *state, const launching_output *output,
                          launching_loads *loads);

// Rate [m/s] at which adaptor i's offset from the axis grows, the foot's motion included.
double launching_offset_rate(const launching_system *self, const double *state, int i);
// Rate [m/s] at which adaptor i goes into surface k of the guide.
double launching_surface_rate(const launching_system *self, const double *state, int i, int k);

// Kinetic energy of tube, tail and (if in the tube) rocket [J].
double launching_kinetic_energy(const launching_system *self, const launching_input *input,
                                const launching_phase *phase, const double *state);
// Potential energy of tube and tail in gravity [J], from the origin of I.
double launching_potential_energy(const launching_system *self, const double *state);

// Whether constraints hold something in its place, from which the state must not drift.
bool launching_holds_places(const launching_system *self);

// Puts the rocket where the adaptors that are held have no offset from the axis, and removes the
// velocity drift of all constraints (formulation.md, section 3) from `state`; that keeps all
// momenta.
void launching_project(const launching_system *self, const launching_input *input,
                       const launching_phase *phase, double *state);

#endif
