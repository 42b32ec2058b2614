// The air on a rocket on an open guide: all that it feels in free flight (model.md, section 8), by
// the same function, from its start on.
#ifndef LD_ELEMENTS_OPEN_AIR_H
#define LD_ELEMENTS_OPEN_AIR_H

#include "elements/rocket.h"

LD_INLINE void open_air_add(launching_instant *now)
{
    const rocket_state *rocket = &now->rocket;
    const moving_air *about = &now->input->air;
    launching_output *out = now->out;
    v3 c = now->inertia.c;
    size_t interval = 0;
    // velocity of the mass centre, and through the air in B
    v3 v_C = v3_add(rocket->v_O1, v3_cross(rocket->w_B, c));
    v3 slip = v3_sub(v_C, m3_apply_transposed(now->tube.A_IR, about->v));
    double speed = v3_norm(slip);
    const airflow flow = {.v = m3_apply_transposed(rocket->A_RB, slip),
                          .speed = speed,
                          .w = m3_apply_transposed(rocket->A_RB, rocket->w_B),
                          .c = now->input->mass.c,
                          .density = about->density,
                          .mach = speed / about->speed_of_sound};
    air_wrench wrench =
        aerodynamics_wrench(now->input->aerodynamics, &flow, now->input->power, &interval);
    v3 f = m3_apply(rocket->A_RB, wrench.f), m = m3_apply(rocket->A_RB, wrench.m);
    out->air_mach = flow.mach;
    out->air_force = f;
    out->air_moment = m;
    out->power[POWER_AIR] = v3_dot(f, v_C) + v3_dot(m, rocket->w_B);
    now->f = v3_add(now->f, f);
    now->m = v3_add(now->m, v3_add(m, v3_cross(c, f)));
}

#endif
