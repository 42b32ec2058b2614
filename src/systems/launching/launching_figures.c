#include "systems/launching/launching_figures.h"

#include "elements/tail.h"
#include "elements/tube/tube_dynamics.h"
#include "model/parts.h"
#include "systems/launching/launching_kinematics.h"

void launching_find_loads(const launching_system *self, const launching_input *input,
                          const double *state, const launching_output *out, launching_loads *loads)
{
    const launching_layout *at = &self->layout;
    m3 A_IR = q_matrix(q_from(state + at->quaternion));
    v3 g = m3_apply_transposed(A_IR, v3_make(0, -self->tube.gravity, 0));
    guide_motion motion = {.w = v3_from(state + at->w),
                           .a = v3_sub(out->a, g),
                           .w_dot = out->w_dot,
                           .q = state + at->q,
                           .q_dot = state + at->q_dot,
                           .q_ddot = out->q_ddot};
    for (int i = 0; i < input->record->count; i++) {
        launching_section section;
        launching_section_at(self, state, self->cut[i].at, &section);
        loads->station[i] = guide_cut_load(&self->cut[i], &self->tube.flexible, &motion, section.P,
                                           section.A, &input->record->beyond[i]);
    }
    memcpy(loads->support, input->record->support, sizeof loads->support);
}

double launching_kinetic_energy(const launching_system *self, const launching_input *input,
                                const launching_phase *phase, const double *state)
{
    const launching_layout *at = &self->layout;
    v3 v = v3_from(state + at->v), w_R = v3_from(state + at->w);
    double energy =
        tube_kinetic_energy(&self->tube.flexible, v, w_R, state + at->q, state + at->q_dot) +
        tail_kinetic_energy(&model_tubes(self->model)->tail, v, w_R);
    if (phase->rocket) {
        launching_output out;
        launching_pose pose;
        launching_rocket_pose(self, state, &pose, &out);
        const rocket_mass *mass = &input->mass;
        v3 v_C = v3_add(pose.v_O1, v3_cross(pose.w_B, m3_apply(pose.A_RB, mass->c)));
        v3 w = m3_apply_transposed(pose.A_RB, pose.w_B);
        energy += 0.5 * (mass->m * v3_norm2(v_C) + v3_dot(w, m3_apply(mass->J, w)));
    }
    return energy;
}

double launching_potential_energy(const launching_system *self, const double *state)
{
    const launching_layout *at = &self->layout;
    const ld_tail *tail = &model_tubes(self->model)->tail;
    v3 S = tube_first_moment(&self->tube.flexible, state + at->q);
    S.x += tail->mass * tail->center;
    m3 A_IR = q_matrix(q_from(state + at->quaternion));
    return self->tube.gravity * (self->tube.m * state[at->r + 1] + m3_apply(A_IR, S).y);
}
