// A base whose frame T comes from outside at instants, by whoever runs the launch; between them it
// continues as held_frame.h says.
//
// State, constant between the instants: what was given last, r, q_IT, v, w, with the accelerations
// and the time of it. So it is saved and restored with the rest of the state.
#include <string.h>

#include "elements/held_frame.h"
#include "model/model.h"
#include "systems/bases/base.h"

enum {
    TOLD_R = 0,
    TOLD_QUATERNION = 3,
    TOLD_V = 7,
    TOLD_W = 10,
    TOLD_A = 13,
    TOLD_ALPHA = 16,
    TOLD_T = 19,
    TOLD_STATES = 20
};
_Static_assert((int)TOLD_STATES <= (int)BASE_MOST_STATES, "more states than a base is allowed");

static ld_status build(base_system *self, ld_error *error)
{
    (void)error;
    self->state_count = TOLD_STATES;
    return LD_OK;
}

static void release(base_system *self)
{
    (void)self;
}

static held_frame held_in(const double *state)
{
    quat q = q_from(state + TOLD_QUATERNION);
    return (held_frame){
        .last = {.r = v3_from(state + TOLD_R),
                 .v = v3_from(state + TOLD_V),
                 .A = q_matrix(q),
                 .q = q,
                 .w = v3_from(state + TOLD_W)},
        .a = v3_from(state + TOLD_A),
        .alpha = v3_from(state + TOLD_ALPHA),
    };
}

static void find_frame(const base_system *self, double t, const double *state, base_frame *tube,
                       base_found *found)
{
    (void)self, (void)found;
    held_frame held = held_in(state);
    held_frame_at(&held, t - state[TOLD_T], tube);
}

static void receive_frame(const base_system *self, double t, bool first, const base_frame *now,
                          double *state)
{
    held_frame held = {.a = v3_zero()};
    if (!first)
        held = held_in(state);
    bool accelerates = self->model->base.extrapolation == LD_EXTRAPOLATION_ACCELERATION;
    held_frame_take(&held, now, first || !accelerates ? 0 : t - state[TOLD_T]);
    v3_store(state + TOLD_R, now->r);
    memcpy(state + TOLD_QUATERNION, &now->q, sizeof now->q);
    v3_store(state + TOLD_V, now->v);
    v3_store(state + TOLD_W, now->w);
    v3_store(state + TOLD_A, held.a);
    v3_store(state + TOLD_ALPHA, held.alpha);
    state[TOLD_T] = t;
}

const base_interface base_external = {
    .build = build, .free = release, .find_frame = find_frame, .receive_frame = receive_frame};
