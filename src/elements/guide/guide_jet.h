// The jet of the rocket that has left on the guide's front end (model.md, section 5): a force
// against the x axis of the section at the tip, there or off its axis.
#ifndef LD_ELEMENTS_GUIDE_JET_H
#define LD_ELEMENTS_GUIDE_JET_H

#include "elements/section.h"

LD_OUTLINE void guide_jet_add(const tube_system *guide, launching_instant *now)
{
    const int lanes = guide->flexible.nbp / 4;
    axis_section tip;
    v3 w, v = axis_point_load(guide, &now->tube, guide->flexible.length, &tip, &w);
    const double *at = now->input->guide_jet_at;
    v3 arm = m3_apply(tip.A, v3_make(0, at[0], at[1]));
    v3 force = v3_scale(-now->input->guide_jet, m3_column(tip.A, 0));
    now->out->power[POWER_GUIDE_JET] = v3_dot(force, v3_add(v, v3_cross(w, arm)));
    apply_at_section(lanes, guide, &tip, v3_add(tip.P, arm), force, &now->on_tube);
}

#endif
