// The launching subsystem: tail, flexible tube on its supports, rocket in the tube (model.md
// sections 3 to 5; formulation.md sections 3 to 5). Given state and base it finds all
// accelerations.
#ifndef LD_SYSTEMS_LAUNCHING_H
#define LD_SYSTEMS_LAUNCHING_H

#include "elements/guide/adaptor.h"
#include "elements/guide/breech.h"
#include "elements/guide/clamp.h"
#include "elements/guide/crossflow.h"
#include "elements/guide/drag.h"
#include "elements/guide/guide_cut.h"
#include "elements/guide/guide_jet.h"
#include "elements/guide/guide_wind.h"
#include "elements/guide/ideal.h"
#include "elements/guide/line_pull.h"
#include "elements/guide/lock.h"
#include "elements/guide/open_air.h"
#include "elements/guide/pressure.h"
#include "elements/guide/shoe.h"
#include "elements/guide/slot.h"
#include "elements/guide/support.h"
#include "elements/load.h"
#include "launchdyn/model.h"

typedef struct launching_system {
    const ld_model *model;
    const ld_rocket *rocket; // in the tube
    ld_tubes tubes;          // what the tube was built of
    launching_layout layout;
    // the elements
    tube_system tube; // with its tail
    support_set supports;
    adaptor_set adaptors;
    surface_set surfaces; // of a guide that is not a bore
    drag_system drag;
    slot_system slot;
    lock_system lock;
    crossflow_body crossflow;
    pressure_system pressure;
    guide_wind wind;
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
// Takes, once, the same tube without the cut of its modes, for a system that shows them as they
// are; to be freed. Without a cut, or later, there is none: its `packed` is NULL.
ld_status launching_take_unslowed(launching_system *self, launching_tube *to, ld_error *error);
void launching_tube_free(launching_tube *self);

// Builds the system; with what was kept (or NULL) where the tube is the same to the bit, which it
// then owns.
ld_status launching_build(launching_system *self, const ld_model *model, launching_tube *kept,
                          ld_error *error);
// Takes the numbers of the rocket that comes into the tube; the first is that of the first firing.
void launching_set_rocket(launching_system *self, const ld_rocket *rocket);
void launching_free(launching_system *self);

// Derivative of the state from the accelerations found.
void launching_rates(const launching_system *self, const double *state,
                     const launching_output *output, bool rocket, double *state_dot);

// Whether the tube has what the fast layout has not: axial modes, geometric stiffness, shear.
bool launching_is_general(const launching_system *self);

// Whether constraints hold something in its place, from which the state must not drift.
bool launching_holds_places(const launching_system *self);

#endif
