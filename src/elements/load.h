// Forces and moments put on tube and rocket, where the launcher is linearised.
#ifndef LD_ELEMENTS_LOAD_H
#define LD_ELEMENTS_LOAD_H

#include "elements/rocket.h"

// On the tube's tip; a moment as a couple about each axis, its arm 1 m along the next one.
LD_INLINE void load_tip(const int lanes, const launching_load *self, const tube_system *guide,
                        launching_instant *now)
{
    element_motion motion;
    axis_section tip;
    double length = guide->flexible.length;
    tip.index = flexible_tube_find(&guide->flexible, length);
    element_load(guide, &now->tube.modal, tip.index, &motion);
    motion.initial = NULL;
    section_load(guide, &motion, length, &tip);
    apply_at_section(lanes, guide, &tip, tip.P, self->tip_force, &now->on_tube);
    const v3 axis[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const double moment[3] = {self->tip_moment.x, self->tip_moment.y, self->tip_moment.z};
    for (int i = 0; i < 3; i++) {
        v3 arm = axis[(i + 1) % 3], force = v3_scale(moment[i], axis[(i + 2) % 3]);
        apply_at_section(lanes, guide, &tip, v3_add(tip.P, arm), force, &now->on_tube);
        apply_at_section(lanes, guide, &tip, tip.P, v3_neg(force), &now->on_tube);
    }
}

LD_INLINE void load_rocket(const launching_load *self, launching_instant *now)
{
    v3 force = self->rocket_force, center = m3_apply(now->rocket.A_RB, now->input->mass.c);
    now->f = v3_add(now->f, force);
    now->m = v3_add(now->m, v3_add(self->rocket_moment, v3_cross(center, force)));
}

#endif
