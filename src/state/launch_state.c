#include "state/launch_state.h"

#include <assert.h>
#include <string.h>

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

void launch_state_select(launch_state *self, int i)
{
    assert(i >= 0 && i < self->model->firing_count);
    self->current = i;
    self->motor = simulation_motor(self->system, i);
    self->air = model_feels_air(self->model) ? simulation_flight(self->system, i) : NULL;
    self->rocket = salvo_rocket(self->model, i);
    launching_set_rocket(&self->launcher.launching, self->rocket);
    self->t_ignition = self->model->firing[i].at;
    self->phase = simulation_start_phase(self);
    self->piece = -1;
    self->pressure_piece = 0;
    self->held_down = self->rocket->lock.present && self->rocket->lock.hold_down > 0;
    self->jammed = false;
}
