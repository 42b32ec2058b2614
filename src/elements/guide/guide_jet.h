// A rocket's jet on its guide (model.md, section 5): on the front end, once it has left, and on a
// deflector behind it.
#ifndef LD_ELEMENTS_GUIDE_JET_H
#define LD_ELEMENTS_GUIDE_JET_H

#include "elements/section.h"

// On what is fixed to the section at x.
LD_INLINE void guide_push_add(const tube_system *guide, const guide_push *push, double x,
                              launching_instant *now)
{
    const int lanes = guide->flexible.nbp / 4;
    axis_section s;
    v3 w, v = axis_point_load(guide, &now->tube, x, &s, &w);
    v3 arm = m3_apply(s.A, push->at), force = m3_apply(s.A, push->force);
    now->out->power[POWER_GUIDE_JET] += v3_dot(force, v3_add(v, v3_cross(w, arm)));
    apply_at_section(lanes, guide, &s, v3_add(s.P, arm), force, &now->on_tube);
}

LD_OUTLINE void guide_jet_add(const tube_system *guide, launching_instant *now)
{
    const launching_input *input = now->input;
    if (input->jet_face.hit != 0)
        guide_push_add(guide, &input->jet_face, guide->flexible.length, now);
    if (input->deflector.hit == 0)
        return;
    guide_push push = input->deflector;
    double x = fmax(push.at.x, 0);
    push.at.x -= x; // of the tail, where it is behind the rear end
    guide_push_add(guide, &push, x, now);
}

#endif
