// What acts between rocket and guide, for every form of the launching subsystem: contact with bore
// or surfaces, and the list of constraints.
#ifndef LD_SYSTEMS_LAUNCHING_CONSTRAINTS_H
#define LD_SYSTEMS_LAUNCHING_CONSTRAINTS_H

#include "systems/launching/launching.h"

// Kept out of line: inlined, they make an evaluation in a bore slower, the second by 7 %.
static __attribute__((noinline)) void launching_fly(launching_instant *now)
{
    open_air_add(now);
}

static __attribute__((noinline)) void launching_draw(const ld_line *line, launching_instant *now)
{
    line_pull(line, now);
}

static __attribute__((noinline)) void launching_slide(const int lanes, const launching_system *self,
                                                      launching_instant *now)
{
    shoes_add(lanes, &self->surfaces, &self->adaptors, &self->tube, now);
}

static __attribute__((noinline)) void launching_drag(const int lanes, const launching_system *self,
                                                     launching_instant *now)
{
    drag_add(lanes, &self->drag, &self->adaptors, &self->tube, now);
}

LD_INLINE void launching_touch(const int lanes, const launching_system *self,
                               launching_instant *now)
{
    if (self->surfaces.count)
        launching_slide(lanes, self, now);
    else
        adaptors_add(lanes, &self->adaptors, &self->tube, now);
}

// The rocket and what acts on it and between it and the tube, besides constraints.
LD_INLINE void launching_load_rocket(const int lanes, const launching_system *self,
                                     const double *state, launching_instant *now)
{
    const launching_input *input = now->input;
    rocket_load(&self->tube, &self->layout, state, &now->tube, &now->rocket, now->out);
    rocket_inertia_load(&input->mass, now->rocket.A_RB, &now->inertia);
    rocket_forces(&self->rocket->motor, now);
    crossflow_add(&self->crossflow, &self->tube, now);
    if (input->aerodynamics)
        launching_fly(now);
    pressure_add(&self->pressure, now);
    if (input->load)
        load_rocket(input->load, now);
    launching_touch(lanes, self, now);
    if (__builtin_expect(self->drag.given != NULL, 0))
        launching_drag(lanes, self, now);
    breech_add(lanes, &self->adaptors.law, &self->tube, now);
    if (self->rocket->line.present)
        launching_draw(&self->rocket->line, now);
}

// The constraints in force at an instant, with what they stand on.
typedef struct launching_constraints {
    constraint_set set;
    adaptor_state adaptor[IDEAL_MOST_ADAPTORS];
    clamped_section clamped[LD_MAX_CLAMPED_STATIONS];
} launching_constraints;

// Constraints of the rocket, where it is in the tube, and of what is held in its place, where
// something is (`launching_holds_places`): an evaluation for which both are known when it is
// compiled is 15 % faster.
LD_INLINE void launching_constrain(const int lanes, const bool rocket, const bool holds,
                                   const launching_system *self, const launching_instant *now,
                                   launching_constraints *all)
{
    constraint_set *set = &all->set;
    constraints_begin(set);
    if (rocket) {
        rocket_section_add(lanes, &self->tube, now, set);
        if (self->slot.present)
            slot_constrain(&self->slot, now, set);
        if (now->phase->locked)
            lock_constrain(&self->lock, now, set);
        if (holds)
            ideal_constrain(lanes, &self->adaptors, &self->tube, now, all->adaptor, set);
    }
    set->clamp_row = set->count;
    if (holds)
        clamp_constrain(lanes, &self->supports, &self->tube, now, all->clamped, set);
}

// The forces found.
LD_INLINE void launching_report(const bool rocket, const bool holds, const launching_system *self,
                                const launching_instant *now, const constraint_set *set,
                                launching_output *out)
{
    if (rocket)
        constraints_report(set, out);
    if (rocket && holds)
        ideal_report(&self->adaptors, set, out);
    if (holds && set->clamp_row < set->count)
        clamp_report(now, set, out);
}

#endif
