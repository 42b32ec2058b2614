#include "systems/mechanism/mechanism_joints.h"

#include <string.h>

#include "model/model.h"

void mechanism_joint_loads(const mechanism_system *self, const mechanism_motion *motion,
                           const double *state_dot, const mechanism_output *output,
                           joint_load load[LD_MAX_JOINTS])
{
    double u_dot[MECHANISM_MOST_SPEEDS], reaction[6 * MECHANISM_MOST_ELEMENTS];
    memcpy(u_dot, state_dot + self->q_count, (size_t)self->u_count * sizeof *u_dot);
    if (self->carrier >= 0) {
        const base_frame *carrier = &motion->carrier;
        v3_store(u_dot + self->u_count, carrier->a);
        v3_store(u_dot + self->u_count + 3, m3_apply_transposed(carrier->A, carrier->alpha));
    }
    ld_mstmm_reactions(self->chain, motion->q, motion->u, u_dot, output->wrench, reaction);
    for (int i = 0; i < self->given->joint_count; i++) {
        double closing[6];
        const double *from = closing;
        if (self->joint_element[i] < 0)
            ld_mstmm_loop_force(self->chain, self->joint_loop[i], closing);
        else
            from = reaction + 6 * self->joint_element[i];
        load[i] = (joint_load){v3_from(from), v3_from(from + 3)};
    }
}

void mechanism_joint_state(const mechanism_system *self, const mechanism_motion *motion, int joint,
                           double q[JOINT_MOST_COORDINATES], double u[JOINT_MOST_SPEEDS])
{
    static const struct {
        int q, u;
    } count[] = {
        [LD_JOINT_FIXED] = {0, 0},     [LD_JOINT_REVOLUTE] = {1, 1},
        [LD_JOINT_PRISMATIC] = {1, 1}, [LD_JOINT_CYLINDRICAL] = {2, 2},
        [LD_JOINT_UNIVERSAL] = {2, 2}, [LD_JOINT_SPHERICAL] = {4, 3},
        [LD_JOINT_PLANAR] = {3, 3},    [LD_JOINT_FREE] = {7, 6},
    };
    int element = self->joint_element[joint];
    ld_joint_kind kind = self->given->joint[joint].kind;
    if (element < 0) {
        ld_mstmm_loop_state(self->chain, motion->q, motion->u, self->joint_loop[joint], q, u);
        return;
    }
    memcpy(q, motion->q + ld_mstmm_coordinate_offset(self->chain, element),
           (size_t)count[kind].q * sizeof *q);
    memcpy(u, motion->u + ld_mstmm_speed_offset(self->chain, element),
           (size_t)count[kind].u * sizeof *u);
}
