#include "systems/launcher.h"

#include <assert.h>
#include <string.h>

void launcher_select(launcher_system *self, int i)
{
    assert(i >= 0 && i < self->model->firing_count);
    self->tube = i;
    if (self->vehicle)
        self->orientating = self->of_tube[i];
}

static ld_status build_orientating(launcher_system *self, ld_error *error)
{
    const ld_model *model = self->model;
    int fired[LD_MAX_FIRINGS];
    for (int i = 0; i < model->firing_count; i++) {
        fired[i] = model->firing[i].tube;
        ld_status status = orientating_build(&self->of_tube[i], model, fired[i], fired, i, error);
        if (status)
            return status;
        self->tube_count++;
    }
    launcher_select(self, 0);
    return LD_OK;
}

ld_status launcher_build(launcher_system *self, const ld_model *model, launching_tube *kept,
                         double x0, double x1, ld_error *error)
{
    *self = (launcher_system){.model = model, .vehicle = model->base.kind == LD_BASE_VEHICLE};
    ld_status status = launching_build(&self->launching, model, kept, error);
    if (!status && !self->vehicle)
        status = base_motion_build(&self->motion, &model->base, error);
    if (!status && self->vehicle)
        status = build_orientating(self, error);
    if (!status && self->vehicle)
        status =
            marching_build(&self->marching, &model->base.vehicle, model->gravity, x0, x1, error);
    if (status) {
        launcher_free(self);
        return status;
    }
    self->orientating_at = self->launching.layout.count;
    self->marching_at = self->orientating_at + (self->vehicle ? ORIENTATING_STATES : 0);
    self->work_at = self->marching_at + (self->vehicle ? self->marching.state_count : 0);
    self->work_count = self->vehicle ? LAUNCHER_WORKS : POWER_COUNT;
    self->state_count = self->work_at + self->work_count;
    return LD_OK;
}

static void free_orientating(launcher_system *self)
{
    for (int i = 0; i < self->tube_count; i++)
        orientating_free(&self->of_tube[i]);
    self->tube_count = 0;
}

void launcher_free(launcher_system *self)
{
    launching_free(&self->launching);
    base_motion_free(&self->motion);
    free_orientating(self);
    marching_free(&self->marching);
}

ld_status launcher_share(launcher_system *self, const launcher_system *of, ld_error *error)
{
    *self = *of;
    self->tube_count = 0;
    ld_status status = self->vehicle ? build_orientating(self, error) : LD_OK;
    if (status)
        free_orientating(self);
    return status;
}

void launcher_free_share(launcher_system *self)
{
    free_orientating(self);
}

void launcher_place(const launcher_system *self, double t, const double *state,
                    launcher_input *input)
{
    if (!self->vehicle) {
        base_motion_at(&self->motion, t, &input->launching.base);
        return;
    }
    orientating_motion_at(&self->orientating, t, state + self->orientating_at, &input->motion);
    input->launching.base = input->motion.tube;
}

int launcher_evaluate_vehicle(const launcher_system *self, const launcher_input *input,
                              const launching_phase *phase, const double *state,
                              launcher_output *output)
{
    orientating_motion motion = input->motion;
    marching_evaluate(&self->marching, &motion.chassis, input->held, state + self->marching_at,
                      output->base_dot + ORIENTATING_STATES, &output->marching);
    orientating_input wrenches = {
        .chassis_force = output->marching.force,
        .chassis_moment = output->marching.moment,
        .tube_force = output->launching.base_force,
        .tube_moment = output->launching.base_moment,
        .rest = {input->rest[0], input->rest[1]},
        .held = input->held,
        .frictionless = phase->frictionless,
    };
    int outcome = orientating_evaluate(&self->orientating, &wrenches, state + self->orientating_at,
                                       &motion, output->base_dot, &output->orientating);
    memcpy(output->hinge, motion.hinge, sizeof output->hinge);
    return outcome;
}

launching_outcome launcher_evaluate_tube(const launcher_system *self, ld_formulation formulation,
                                         const launching_input *input, const launching_phase *phase,
                                         const double *state, launching_output *output)
{
    if (formulation == LD_FORMULATION_OVERALL)
        return launching_evaluate_general(&self->launching, formulation, input, phase, state,
                                          output);
    return launching_evaluate(&self->launching, input, phase, state, output);
}

launching_outcome launcher_evaluate(const launcher_system *self, const launcher_input *input,
                                    const launching_phase *phase, const double *state,
                                    launcher_output *output)
{
    launching_outcome outcome = launcher_evaluate_tube(self, input->formulation, &input->launching,
                                                       phase, state, &output->launching);
    if (outcome || !self->vehicle)
        return outcome;
    return launcher_evaluate_vehicle(self, input, phase, state, output) ? LAUNCHING_NOT_FINITE
                                                                        : LAUNCHING_OK;
}

void launcher_rates(const launcher_system *self, const double *state, const launcher_output *output,
                    bool rocket, double *state_dot)
{
    launching_rates(&self->launching, state, &output->launching, rocket, state_dot);
    double *work = state_dot + self->work_at;
    memcpy(work, output->launching.power, sizeof output->launching.power);
    if (!self->vehicle)
        return;
    memcpy(state_dot + self->orientating_at, output->base_dot,
           (size_t)(self->work_at - self->orientating_at) * sizeof(double));
    memcpy(work + POWER_COUNT, output->orientating.power, sizeof output->orientating.power);
    memcpy(work + POWER_COUNT + ORIENTATING_POWERS, output->marching.power,
           sizeof output->marching.power);
}

double launcher_kinetic_energy(const launcher_system *self, const launcher_input *input,
                               const launching_phase *phase, const double *state)
{
    double energy = launching_kinetic_energy(&self->launching, &input->launching, phase, state);
    if (self->vehicle)
        energy += orientating_kinetic_energy(&self->orientating, state + self->orientating_at) +
                  marching_kinetic_energy(&self->marching, state + self->marching_at);
    return energy;
}
