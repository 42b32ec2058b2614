// A frame that is known at instants alone: how it continues until the next one.
#ifndef LD_ELEMENTS_HELD_FRAME_H
#define LD_ELEMENTS_HELD_FRAME_H

#include "elements/base_frame.h"
#include "math/vectors/rotation_vector.h"

// As it was last reported; it continues with the acceleration that its last two velocities report.
typedef struct held_frame {
    base_frame last;
    v3 a, alpha; // [m/s2], [rad/s2] in I
} held_frame;

// Takes what is reported `since` [s] after the last; 0: nothing of before continues.
static inline void held_frame_take(held_frame *self, const base_frame *now, double since)
{
    if (since > 0) {
        self->a = v3_scale(1 / since, v3_sub(now->v, self->last.v));
        self->alpha = v3_scale(1 / since, v3_sub(now->w, self->last.w));
    }
    self->last = *now;
}

// The frame tau [s] after the last instant.
static inline void held_frame_at(const held_frame *self, double tau, base_frame *frame)
{
    v3 turn = v3_add(v3_scale(tau, self->last.w), v3_scale(0.5 * tau * tau, self->alpha));
    v3 path = v3_add(v3_scale(tau, self->last.v), v3_scale(0.5 * tau * tau, self->a));
    frame->r = v3_add(self->last.r, path);
    frame->v = v3_add(self->last.v, v3_scale(tau, self->a));
    frame->w = v3_add(self->last.w, v3_scale(tau, self->alpha));
    frame->A = m3_mul(rv_exp(turn), self->last.A);
    frame->q = q_from_matrix(frame->A);
    frame->a = self->a;
    frame->alpha = self->alpha;
}

#endif
