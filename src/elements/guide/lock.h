// The lock: holds the rocket at its position in the tube until it is released (model.md, section
// 5).
//
// Held is e_x . v_rel = 0 at a point L of the rocket, by a force along e_x of the section at s (the
// foot of O1), moved rigidly to L; where the lock holds roll also w_SB . e_x = 0, by a moment about
// e_x.
#ifndef LD_ELEMENTS_LOCK_H
#define LD_ELEMENTS_LOCK_H

#include "elements/guide/constraint.h"
#include "math/functions.h"
#include "model/blocks/rocket.h"

typedef struct lock_system {
    v3 at; // [m] L in B
    bool holds_roll;
} lock_system;

LD_INLINE void roll_constrain(const launching_instant *now, constraint_set *set)
{
    const rocket_state *rocket = &now->rocket;
    constraint_direction *roll = &set->e[set->count++];
    v3 axis = m3_column(rocket->at.A, 0);
    roll->section = 0;
    const unit_wrench unit = {v3_zero(), axis, v3_zero(), v3_zero()};
    direction_load(now, &set->section[0], &unit, roll);
    v3 axis_dot = v3_cross(v3_add(now->tube.w, rocket->Om), axis);
    v3 w_rel = v3_sub(rocket->w_B, rocket->w_P);
    roll->work = POWER_LOCK;
    roll->beta = v3_dot(axis_dot, w_rel) - v3_dot(axis, set->section[0].bias.gw);
    roll->drift = v3_dot(axis, w_rel);
}

LD_INLINE void lock_constrain(const lock_system *self, const launching_instant *now,
                              constraint_set *set)
{
    const rocket_state *rocket = &now->rocket;
    v3 rho = m3_apply(rocket->A_RB, self->at);
    const unit_wrench axial = {m3_column(rocket->at.A, 0), v3_zero(), v3_add(rocket->Ad, rho), rho};
    set->lock_row = set->count;
    constrain_force(now, 0, &axial, v3_zero(), POWER_LOCK, set);
    if (self->holds_roll)
        roll_constrain(now, set);
}

// `carried`: slot or guide hold the roll on their own.
LD_INLINE void lock_build(const ld_lock *lock, bool carried, lock_system *self)
{
    self->at = v3_make(lock->x, lock->radius * cos(lock->angle), lock->radius * sin(lock->angle));
    self->holds_roll =
        lock->holds_roll == LD_HOLD_YES || (lock->holds_roll == LD_HOLD_BY_GUIDE && !carried);
}

#endif
