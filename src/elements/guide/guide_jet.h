// The jet of the rocket that has left on the guide's front end (model.md, section 5): a force
// against the x axis of the section at the tip, there.
#ifndef LD_ELEMENTS_GUIDE_JET_H
#define LD_ELEMENTS_GUIDE_JET_H

#include "elements/section.h"

LD_OUTLINE void guide_jet_add(const tube_system *guide, launching_instant *now)
{
    const int lanes = guide->flexible.nbp / 4;
    const double length = guide->flexible.length;
    const tube_state *tube = &now->tube;
    element_motion motion;
    section_rates rates;
    axis_section tip;
    tip.index = flexible_tube_find(&guide->flexible, length);
    element_load(guide, &tube->modal, tip.index, &motion);
    motion.initial = NULL;
    section_load(guide, &motion, length, &tip);
    section_rates_load(&motion, &tip, &rates);
    v3 force = v3_scale(-now->input->guide_jet, m3_column(tip.A, 0));
    v3 v = v3_add(v3_add(tube->v, v3_cross(tube->w, tip.P)), rates.u_dot);
    now->out->power[POWER_GUIDE_JET] = v3_dot(force, v);
    apply_at_section(lanes, guide, &tip, tip.P, force, &now->on_tube);
}

#endif
