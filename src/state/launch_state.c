#include "state/launch_state.h"

#include <assert.h>
#include <string.h>

#include "model/blocks/firing.h"
#include "model/parts.h"
#include "model/salvo.h"

ld_status launch_state_begin(launch_state *self, const ld_simulation *system, ld_error *error)
{
    memset(self, 0, sizeof *self);
    self->system = system;
    self->model = self->jets.model = system->model;
    ld_status status = launcher_share(&self->launcher, &system->launcher, error);
    if (!status)
        launch_state_select(self, 0);
    return status;
}

void launch_state_end(launch_state *self)
{
    launcher_free_share(&self->launcher);
    jets_free(&self->jets);
}

launching_phase simulation_start_phase(const launch_state *self)
{
    launching_phase phase = {.rocket = true, .locked = true};
    const ld_rocket *rocket = self->rocket;
    phase.breech = rocket->start_at;
    phase.breech_speed = rocket->contact.reference_speed;
    const adaptor_set *adaptors = &self->launcher.launching.adaptors;
    for (int i = 0; i < rocket->adaptor_count; i++) {
        // so near its end that rounding and the tube's bend decide, an adaptor counts as out
        phase.passed[i] = rocket->start_at + rocket->adaptor[i].at >= adaptors->end[i] - 1e-6;
        phase.touch_speed[i] = rocket->contact.reference_speed;
        for (int k = 0; k < LD_MAX_SURFACES; k++)
            phase.surface_speed[i][k] = rocket->contact.reference_speed;
    }
    return phase;
}

void simulation_straight(const launch_state *self, const base_frame *base, double *y)
{
    const launching_layout *at = &self->launcher.launching.layout;
    memset(y, 0, (size_t)at->count * sizeof(double));
    v3_store(y + at->r, base->r);
    memcpy(y + at->quaternion, &base->q, sizeof base->q);
    y[at->x + X_S] = self->rocket->start_at;
    y[at->x + X_Y] = self->launcher.launching.surfaces.line_y;
    y[at->x + X_Z] = self->launcher.launching.surfaces.line_z;
}

void launch_state_select(launch_state *self, int i)
{
    assert(i >= 0 && i < model_firing_count(self->model));
    self->current = i;
    self->motor = simulation_motor(self->system, i);
    bool feels = model_feels_air(self->model) || model_has_guide_wind(self->model);
    self->air = feels ? simulation_flight(self->system, i) : NULL;
    self->rocket = salvo_rocket(self->model, i);
    launching_set_rocket(&self->launcher.launching, self->rocket);
    self->t_ignition = model_firing(self->model, i)->at;
    self->phase = simulation_start_phase(self);
    self->piece = -1;
    self->pressure_piece = 0;
    self->held_down = self->rocket->lock.present && self->rocket->lock.hold_down > 0;
    self->jammed = false;
}
