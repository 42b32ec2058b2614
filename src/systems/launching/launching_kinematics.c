#include "systems/launching/launching_kinematics.h"

void launching_rocket_pose(const launching_system *self, const double *state, launching_pose *pose,
                           launching_output *output)
{
    tube_state tube;
    rocket_state rocket;
    tube_load_motion(self->tube.flexible.nbp / 4, &self->tube, &self->layout, state, &tube);
    rocket_load(&self->tube, &self->layout, state, &tube, &rocket, output);
    *pose = (launching_pose){rocket.p1, rocket.at.A, rocket.A_RB, rocket.v_O1, rocket.w_B};
}

v3 launching_rocket_point(const launching_system *self, const double *state, v3 point)
{
    const launching_layout *at = &self->layout;
    const double *x = state + at->x;
    modal_state modal;
    element_motion motion;
    axis_section s;
    modal_load(self->tube.flexible.nbp / 4, &self->tube, at, state, &modal);
    s.index = flexible_tube_find(&self->tube.flexible, x[X_S]);
    element_load(&self->tube, &modal, s.index, &motion);
    section_load(&self->tube, &motion, x[X_S], &s);
    v3 r = v3_make(0, x[X_Y], x[X_Z]),
       turned = m3_apply(rocket_attitude(rocket_turns_of(x)), point);
    r = v3_add(s.P, m3_apply(s.A, v3_add(r, turned)));
    return v3_add(v3_from(state + at->r), m3_apply(q_matrix(q_from(state + at->quaternion)), r));
}

void launching_section_at(const launching_system *self, const double *state, double x,
                          launching_section *out)
{
    const launching_layout *at = &self->layout;
    v3 v = v3_from(state + at->v), w = v3_from(state + at->w);
    modal_state modal;
    element_motion motion;
    axis_section s;
    section_rates rates;
    modal_load(self->tube.flexible.nbp / 4, &self->tube, at, state, &modal);
    s.index = flexible_tube_find(&self->tube.flexible, x);
    element_load(&self->tube, &modal, s.index, &motion);
    motion.initial = NULL;
    section_load(&self->tube, &motion, x, &s);
    section_rates_load(&motion, &s, &rates);
    out->P = s.P;
    out->A = s.A;
    out->v = v3_add(v3_add(v, v3_cross(w, s.P)), rates.u_dot);
    out->w = v3_add(w, rates.w);
}

double launching_offset_rate(const launching_system *self, const double *state, int i)
{
    tube_state tube;
    rocket_state rocket;
    launching_output unused;
    adaptor_state adaptor;
    tube_load(self->tube.flexible.nbp / 4, &self->tube, &self->layout, state, &tube);
    rocket_load(&self->tube, &self->layout, state, &tube, &rocket, &unused);
    adaptor_load(&self->adaptors, &self->tube, &tube, &rocket, i, &adaptor);
    adaptor_rates(&tube, &rocket, &adaptor);
    double e = sqrt(adaptor.y * adaptor.y + adaptor.z * adaptor.z);
    return (adaptor.y * adaptor.y_dot + adaptor.z * adaptor.z_dot) / e;
}

double launching_surface_rate(const launching_system *self, const double *state, int i, int k)
{
    tube_state tube;
    rocket_state rocket;
    launching_output unused;
    shoe_state shoe;
    tube_load(self->tube.flexible.nbp / 4, &self->tube, &self->layout, state, &tube);
    rocket_load(&self->tube, &self->layout, state, &tube, &rocket, &unused);
    shoe_load(&self->adaptors, &self->tube, &tube, &rocket, i, &shoe);
    shoe_touch touch = shoe_touch_of(&tube, &rocket, &shoe);
    return surface_contact_of(&self->surfaces.surface[k], &rocket, &touch).rate;
}
