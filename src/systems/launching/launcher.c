#include "systems/launching/launcher.h"

#include <assert.h>
#include <string.h>

#include "model/parts.h"
#include "systems/launching/launching_dynamics.h"
#include "systems/launching/launching_figures.h"
#include "systems/launching/launching_overall.h"

launcher_kept launcher_hand_over(launcher_system *self)
{
    return (launcher_kept){launching_take_tube(&self->launching), base_take_road(&self->base)};
}

void launcher_kept_free(launcher_kept *self)
{
    launching_tube_free(&self->tube);
    road_free(self->road);
    self->road = NULL;
}

ld_status launcher_build(launcher_system *self, const ld_model *model, launcher_kept *kept,
                         ld_error *error)
{
    *self = (launcher_system){.model = model};
    ld_status status = launching_build(&self->launching, model, kept ? &kept->tube : NULL, error);
    if (!status)
        status = base_build(&self->base, model, kept ? &kept->road : NULL, error);
    if (status) {
        launcher_free(self);
        return status;
    }
    self->base_at = self->launching.layout.count;
    self->work_at = self->base_at + self->base.state_count;
    self->work_count = self->launching.work_count + self->base.work_count;
    self->state_count = self->work_at + self->work_count;
    return LD_OK;
}

void launcher_free(launcher_system *self)
{
    launching_free(&self->launching);
    base_free(&self->base);
}

ld_status launcher_share(launcher_system *self, const launcher_system *of, ld_error *error)
{
    *self = *of;
    return base_share(&self->base, &of->base, error);
}

void launcher_free_share(launcher_system *self)
{
    base_free_share(&self->base);
}

void launcher_select(launcher_system *self, int i)
{
    assert(i >= 0 && i < model_firing_count(self->model));
    self->base.tube = i;
}

void launcher_place(const launcher_system *self, double t, const double *state,
                    launcher_input *input)
{
    self->base.kind->find_frame(&self->base, t, state + self->base_at, &input->launching.base,
                                &input->found);
    input->launching.station =
        self->base.kind->stations ? self->base.kind->stations(&self->base, &input->found) : NULL;
}

int launcher_evaluate_base(const launcher_system *self, const launcher_input *input,
                           const launching_phase *phase, const double *state,
                           launcher_output *output)
{
    base_load load = {
        .force = output->launching.base_force,
        .moment = output->launching.base_moment,
        .station = input->launching.station ? output->launching.station : NULL,
        .jet = input->jet,
        .rest = input->rest,
        .held = input->held,
        .linear = phase->frictionless,
    };
    return self->base.kind->dynamics->evaluate(&self->base, &input->found, &load,
                                               state + self->base_at, &output->base);
}

launching_outcome launcher_evaluate_tube(const launcher_system *self, ld_formulation formulation,
                                         const launching_input *input, const launching_phase *phase,
                                         const double *state, launching_output *output)
{
    if (formulation == LD_FORMULATION_OVERALL)
        return launching_evaluate_overall(&self->launching, input, phase, state, output);
    return launching_evaluate(&self->launching, input, phase, state, output);
}

launching_outcome launcher_evaluate(const launcher_system *self, const launcher_input *input,
                                    const launching_phase *phase, const double *state,
                                    launcher_output *output)
{
    launching_outcome outcome = launcher_evaluate_tube(self, input->formulation, &input->launching,
                                                       phase, state, &output->launching);
    if (outcome || !self->base.kind->dynamics)
        return outcome;
    return launcher_evaluate_base(self, input, phase, state, output) ? LAUNCHING_NOT_FINITE
                                                                     : LAUNCHING_OK;
}

void launcher_rates(const launcher_system *self, const double *state, const launcher_output *output,
                    bool rocket, double *state_dot)
{
    launching_rates(&self->launching, state, &output->launching, rocket, state_dot);
    double *base = state_dot + self->base_at, *work = state_dot + self->work_at;
    int launching = self->launching.work_count;
    memcpy(work, output->launching.power, (size_t)launching * sizeof *work);
    if (!self->base.kind->dynamics) {
        memset(base, 0, (size_t)self->base.state_count * sizeof *base);
        return;
    }
    memcpy(base, output->base.rate, (size_t)self->base.state_count * sizeof *base);
    memcpy(work + launching, output->base.power, (size_t)self->base.work_count * sizeof *work);
}

double launcher_kinetic_energy(const launcher_system *self, const launcher_input *input,
                               const launching_phase *phase, const double *state)
{
    double energy = launching_kinetic_energy(&self->launching, &input->launching, phase, state);
    if (self->base.kind->dynamics)
        energy += self->base.kind->dynamics->kinetic_energy(&self->base, &input->found,
                                                            state + self->base_at);
    return energy;
}

double launcher_elastic_energy(const launcher_system *self, const launcher_output *output)
{
    return output->launching.elastic + (self->base.kind->dynamics ? output->base.elastic : 0);
}

// clang-format off
#define INPUT(member) .at = QUANTITY_AT(base_inputs, launching.member)
static const quantity loads[] = {
    {"tip.force_x", "N", "force on the tube at its tip, along the tube", INPUT(tip_force.x)},
    {"tip.force_y", "N", "force on the tube at its tip, upwards from it", INPUT(tip_force.y)},
    {"tip.force_z", "N", "force on the tube at its tip, to its right", INPUT(tip_force.z)},
    {"tip.moment_x", "N.m", "moment on the tube at its tip about the tube's x axis", INPUT(tip_moment.x)},
    {"tip.moment_y", "N.m", "moment on the tube at its tip about the tube's y axis", INPUT(tip_moment.y)},
    {"tip.moment_z", "N.m", "moment on the tube at its tip about the tube's z axis", INPUT(tip_moment.z)},
    {"rocket.force_x", "N", "force on the rocket at its mass centre, along the tube", INPUT(rocket_force.x)},
    {"rocket.force_y", "N", "force on the rocket at its mass centre, upwards from it", INPUT(rocket_force.y)},
    {"rocket.force_z", "N", "force on the rocket at its mass centre, to its right", INPUT(rocket_force.z)},
    {"rocket.moment_x", "N.m", "moment on the rocket about the tube's x axis", INPUT(rocket_moment.x)},
    {"rocket.moment_y", "N.m", "moment on the rocket about the tube's y axis", INPUT(rocket_moment.y)},
    {"rocket.moment_z", "N.m", "moment on the rocket about the tube's z axis", INPUT(rocket_moment.z)},
};
// clang-format on
static const quantity_group load_groups[] = {
    {.title = "loads on tube and rocket", QUANTITY_ROWS(loads)},
};
const quantity_table launcher_inputs = {load_groups, 1};
