// The pressure behind the rocket, until it leaves its tube (model.md, section 5).
//
// Net pressure p over the time since the ignition, over the travel s' = s - start_at, or of cold
// gas p_0 (V_0/(V_0 + A s'))^kappa - p_a; force p A along e_x of S on the rocket at O1, and against
// e_x of P(0) on the tube there, R's origin.
#ifndef LD_ELEMENTS_PRESSURE_H
#define LD_ELEMENTS_PRESSURE_H

#include "elements/rocket.h"
#include "math/curves/curves.h"

typedef struct pressure_system {
    const ld_pressure *given; // NULL: there is none
    double area;              // [m2] A of the bore
    double start;             // [m] s at which the travel is 0
    curves over_travel;       // owned
} pressure_system;

ld_status pressure_build(const ld_tubes *tubes, pressure_system *self, ld_error *error);
void pressure_free(pressure_system *self);

// Pieces: 0 before the ignition; k from row k of a table over time on, 1 of another pressure. When
// the one after `piece` begins, after the ignition [s]; infinity: there is none.
double pressure_next_corner(const ld_pressure *given, int piece);

// Net pressure [Pa] in a piece: at the time since the ignition, at the rocket's station s.
double pressure_at(const pressure_system *self, int piece, double since, double s);

LD_INLINE void pressure_add(const pressure_system *self, launching_instant *now)
{
    const rocket_state *rocket = &now->rocket;
    const launching_input *input = now->input;
    launching_output *out = now->out;
    if (!self->given)
        return;
    bool on = input->pressure_piece > 0 && !now->phase->passed[0];
    out->pressure = on ? pressure_at(self, input->pressure_piece, input->since, rocket->s) : 0;
    double force = out->pressure_force = out->pressure * self->area;
    v3 axis = m3_column(rocket->at.A, 0);
    now->f = v3_axpy(now->f, force, axis);
    now->on_tube.f.x -= force;
    if (__builtin_expect(now->on_tube.record != NULL, 0))
        guide_forces_add(now->on_tube.record, 0, v3_make(-force, 0, 0), v3_zero());
    out->power[POWER_PRESSURE] = force * (v3_dot(axis, rocket->v_O1) - now->tube.v.x);
}

#endif
