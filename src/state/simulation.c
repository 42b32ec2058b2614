#include "state/simulation.h"

#include <stdlib.h>
#include <string.h>

#include "base/numeric_locale.h"
#include "model/salvo.h"

ld_simulation *simulation_make(ld_error *error)
{
    // its lanes want their alignment
    ld_simulation *self = aligned_alloc(64, (sizeof *self + 63) / 64 * 64);
    if (self)
        memset(self, 0, sizeof *self);
    else
        ld_fail(error, LD_ERR_MEMORY, "no memory for the simulation");
    return self;
}

void simulation_clear(ld_simulation *self)
{
    launcher_free(&self->launcher);
    flight_free(&self->flight);
    for (int i = 0; i < self->flight_count; i++)
        flight_free(&self->flight_of[i]);
    free(self->flight_of);
    for (int i = 0; i < self->motor_count; i++)
        motor_free(&self->motor_of[i]);
    quantity_columns_free(&self->columns);
    quantity_columns_free(&self->vehicle_columns);
    memset(self, 0, sizeof *self);
}

void ld_simulation_free(ld_simulation *self)
{
    if (self)
        simulation_clear(self);
    free(self);
}

void ld_simulation_describe(const ld_simulation *self, FILE *stream)
{
    const base_system *base = &self->launcher.base;
    if (!base->kind || !base->kind->describe)
        return;
    locale_t before = numeric_locale_enter();
    base->kind->describe(base, stream);
    numeric_locale_leave(before);
}

const motor *simulation_motor(const ld_simulation *self, int i)
{
    return &self->motor_of[salvo_is_given(self->model) ? i : 0];
}

const flight_system *simulation_flight(const ld_simulation *self, int i)
{
    return self->flight_of ? &self->flight_of[i] : NULL;
}
