// The list of constraints between rocket and tube, for every form of the launching subsystem.
#ifndef LD_SYSTEMS_LAUNCHING_CONSTRAINTS_H
#define LD_SYSTEMS_LAUNCHING_CONSTRAINTS_H

#include "systems/launching.h"

LD_INLINE void launching_constrain(const launching_system *self, const launching_instant *now,
                                   constraint_set *set)
{
    if (self->slot.present)
        slot_constrain(&self->slot, now, set);
    if (now->phase->locked)
        lock_constrain(&self->lock, now, set);
}

#endif
