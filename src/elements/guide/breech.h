// The breech: an axial stop behind the rocket, which a rocket without a lock rests on (model.md,
// section 5).
//
// Penetration p = s_0 - s, p_dot = -s_dot; where p > 0 and no lock holds, the contact law's force
// acts on the rocket along e_x of S at O1, the opposite on section s_0 at the same point. A law
// without stiffness, whose rocket a lock holds, has no breech.
#ifndef LD_ELEMENTS_BREECH_H
#define LD_ELEMENTS_BREECH_H

#include "elements/guide/contact.h"
#include "elements/rocket.h"

LD_INLINE void breech_add(const int lanes, const contact_law *law, const tube_system *guide,
                          launching_instant *now)
{
    const tube_state *tube = &now->tube;
    const rocket_state *rocket = &now->rocket;
    const launching_phase *phase = now->phase;
    double penetration = phase->breech - rocket->s;
    now->out->breech_force = 0;
    if (penetration <= 0 || phase->locked || isnan(law->k))
        return;
    element_motion motion;
    axis_section wall;
    section_rates rates;
    wall.index = flexible_tube_find(&guide->flexible, phase->breech);
    element_load(guide, &tube->modal, wall.index, &motion);
    section_load(guide, &motion, phase->breech, &wall);
    section_rates_load(&motion, &wall, &rates);
    double normal = contact_normal(law, penetration, -rocket->s_dot, phase->breech_speed);
    v3 force = v3_scale(normal, m3_column(rocket->at.A, 0));
    v3 turning = v3_cross(rates.w, v3_sub(rocket->p1, wall.P));
    v3 v_wall =
        v3_add(v3_add(tube->v, v3_cross(tube->w, rocket->p1)), v3_add(rates.u_dot, turning));
    now->out->breech_force = normal;
    now->out->power[POWER_CONTACT_NORMAL] += v3_dot(force, v3_sub(rocket->v_O1, v_wall));
    now->f = v3_add(now->f, force);
    apply_at_section(lanes, guide, &wall, rocket->p1, v3_neg(force), &now->on_tube);
}

#endif
