#include "run/simulation_build.h"

#include <assert.h>
#include <stdlib.h>

#include "base/cpu_time.h"
#include "flight/flight_alone.h"
#include "model/model.h"
#include "model/parts.h"
#include "model/salvo.h"
#include "run/measures.h"
#include "run/vehicle_run.h"
#include "state/history.h"
#include "state/linearise.h"

static ld_status create_flights(ld_simulation *self, ld_error *error)
{
    const ld_model *model = self->model;
    if (!model_feels_air(model) && !model_has_jets(model) && !model_has_guide_wind(model))
        return LD_OK;
    self->flight_of = calloc((size_t)model_firing_count(model), sizeof *self->flight_of);
    if (!self->flight_of)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the air about the rockets");
    ld_status status = LD_OK;
    for (int i = 0; i < model_firing_count(model) && !status; i++) {
        status = flight_build(&self->flight_of[i], model, i, error);
        self->flight_count += !status;
    }
    return status;
}

static ld_status create_launch(ld_simulation *self, launcher_kept *kept, ld_error *error)
{
    const ld_model *model = self->model;
    ld_status status = launcher_build(&self->launcher, model, kept, error);
    int count = salvo_is_given(model) ? model_firing_count(model) : 1;
    for (int i = 0; i < count && !status; i++) {
        status = motor_build(&self->motor_of[i], salvo_rocket(model, i), i, error);
        self->motor_count += !status;
    }
    if (!status)
        status = create_flights(self, error);
    if (status)
        return status;
    status = history_build(self, error);
    if (!status)
        status = measures_build(model, &self->measure, error);
    if (!status && self->launcher.base.kind->dynamics)
        self->stability = simulation_check_stability(self, &self->growing, &self->unstable);
    return status;
}

static ld_status renew_launch(ld_simulation *self, const ld_model *model, ld_error *error)
{
    launcher_kept kept = launcher_hand_over(&self->launcher);
    simulation_clear(self);
    self->model = model;
    ld_status status = create_launch(self, &kept, error);
    launcher_kept_free(&kept);
    return status;
}

static ld_status renew_flight(ld_simulation *self, const ld_model *model, ld_error *error)
{
    if (self->flight.rocket) {
        // after another flight alone there is no launcher to be cleared
        quantity_columns_free(&self->columns);
    } else {
        simulation_clear(self);
    }
    self->model = model;
    ld_status status = flight_alone_create(self, error);
    return status ? status : measures_build(model, &self->measure, error);
}

ld_status simulation_renew(ld_simulation **simulation, const ld_model *model, ld_error *error)
{
    if (!*simulation)
        *simulation = simulation_make(error);
    ld_simulation *self = *simulation;
    if (!self)
        return LD_ERR_MEMORY;
    ld_status status = model_has_launcher(model) ? renew_launch(self, model, error)
                                                 : renew_flight(self, model, error);
    if (status)
        simulation_clear(self);
    return status;
}

// ---- modes ----

// The simulation with the tube's modes unslowed (`tubes.modes.cut`): the given one, or one of
// `model`, allocated, to be freed as that is. What was kept of the tube may be used.
static ld_status unslow(const ld_simulation *of, launcher_kept *kept, ld_model **model,
                        ld_simulation **plain, ld_error *error)
{
    *model = NULL;
    *plain = NULL;
    if (of->model->tubes.modes.cut == 0)
        return LD_OK;
    *model = malloc(sizeof **model);
    if (!*model)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the modes");
    **model = *of->model;
    (*model)->tubes.modes.cut = 0;
    *plain = simulation_make(error);
    if (!*plain)
        return LD_ERR_MEMORY;
    (*plain)->model = *model;
    return create_launch(*plain, kept, error);
}

static ld_status find_tube_modes(ld_simulation *self, ld_error *error)
{
    ld_model *model = NULL;
    ld_simulation *plain = NULL;
    launcher_kept kept = {0};
    ld_status status = launching_take_unslowed(&self->launcher.launching, &kept.tube, error);
    if (!status)
        status = unslow(self, &kept, &model, &plain, error);
    if (!status)
        status = simulation_tube_modes(plain ? plain : self, self->mode, 6 + LD_MAX_MODES,
                                       &self->mode_count, error);
    launcher_kept_free(&kept);
    ld_simulation_free(plain);
    free(model);
    return status;
}

// NOLINTNEXTLINE(readability-function-size): public
ld_status ld_simulation_system_modes(const ld_simulation *simulation, ld_mode *modes, int capacity,
                                     int *count, ld_pole *poles, int pole_capacity, int *pole_count,
                                     ld_error *error)
{
    system_modes found = {
        .mode = modes, .capacity = capacity, .pole = poles, .pole_capacity = pole_capacity};
    ld_model *model = NULL;
    ld_simulation *plain = NULL;
    ld_status status = model_has_launcher(simulation->model)
                           ? unslow(simulation, NULL, &model, &plain, error)
                           : ld_fail(error, LD_ERR_INPUT,
                                     "a scenario of flight only has no launcher and no modes");
    if (!status)
        status = simulation_system_modes(plain ? plain : simulation, &found, error);
    *count = found.count;
    *pole_count = found.pole_count;
    ld_simulation_free(plain);
    free(model);
    return status;
}

ld_status ld_simulation_create(const ld_model *model, ld_simulation **out, ld_error *error)
{
    assert(model && out);
    double start = cpu_time_now();
    ld_simulation *self = NULL;
    ld_status status = simulation_renew(&self, model, error);
    if (!status)
        status = find_tube_modes(self, error);
    if (!status)
        status = vehicle_run_name_columns(self, error);
    if (status) {
        ld_simulation_free(self);
        return status;
    }
    self->cpu_seconds_setup = cpu_time_now() - start;
    *out = self;
    return LD_OK;
}
