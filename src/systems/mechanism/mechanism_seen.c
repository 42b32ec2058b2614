#include "systems/mechanism/mechanism_seen.h"

#include "systems/multibody/multibody.h"

static void see(mechanism_system *self, int element)
{
    for (int i = 0; i < self->seen_count; i++)
        if (self->seen[i] == element)
            return;
    if (element >= 0)
        self->seen[self->seen_count++] = element;
}

static void find_elements(mechanism_system *self)
{
    const ld_mechanism *given = self->given;
    const ld_mstmm *chain = self->chain;
    for (int e = 0; e < self->element_count; e++)
        self->straight[e] = m3_is_identity(&chain->body_axes[e]);
    see(self, self->tube.element);
    see(self, self->wheels);
    for (int k = 0; k < self->station_count; k++)
        see(self, self->station[k].element);
    for (int i = 0; i < self->hold_count; i++) {
        int joint = self->hold[i].joint;
        see(self, joint < 0 ? -1 : self->joint_element[joint]);
        see(self, self->hold[i].of);
    }
    for (int i = 0; i < given->strut_count; i++) {
        see(self, self->strut[i].from.element);
        see(self, self->strut[i].to.element);
    }
    for (int i = 0; i < given->bushing_count; i++) {
        see(self, self->bushing[i].from.element);
        see(self, self->bushing[i].to.element);
    }
    for (int i = 0; i < given->foot_count; i++)
        see(self, self->foot[i].element);
    for (int i = 0; i < given->load_count; i++)
        see(self, self->load[i].element);
    for (int i = 0; i < given->drag_count; i++)
        see(self, self->drag[i].element);
}

static void find_axes(mechanism_system *self)
{
    for (int i = 0; i < self->given->joint_count; i++) {
        const ld_joint *joint = &self->given->joint[i];
        int element = self->joint_element[i];
        bool single = joint->kind == LD_JOINT_REVOLUTE || joint->kind == LD_JOINT_PRISMATIC;
        if (element < 0 || !single)
            continue;
        self->axis[self->axis_count++] = (single_axis){
            .joint = i,
            .q = ld_mstmm_coordinate_offset(self->chain, element),
            .u = ld_mstmm_speed_offset(self->chain, element),
            .resists =
                joint->friction.viscous > 0 || joint->friction.coulomb > 0 || joint->stops.present,
        };
    }
}

void mechanism_find_seen(mechanism_system *self)
{
    find_elements(self);
    find_axes(self);
}
