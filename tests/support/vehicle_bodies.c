#include "support/vehicle_bodies.h"

#include <stdlib.h>
#include <string.h>

#include "model/model.h"
#include "systems/bases/vehicle_mechanism.h"
#include "systems/mechanism/mechanism_evaluation.h"
#include "systems/mechanism/mechanism_motion.h"
#include "systems/mechanism/mechanism_state.h"
#include "systems/multibody/multibody.h"

enum { CHASSIS, AZIMUTH, ELEVATION };

static const base_frame ORIGIN = {.A = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, .q = {1, 0, 0, 0}};

ld_status vehicle_bodies_build(vehicle_bodies *self, const ld_model *model, int launching,
                               const int *fired, int count, ld_error *error)
{
    *self = (vehicle_bodies){.given = calloc(1, sizeof *self->given)};
    if (!self->given)
        return ld_fail(error, LD_ERR_MEMORY, "no memory");
    vehicle_describe(model, self->given);
    mechanism_plan plan = vehicle_plan(model, self->given);
    mechanism_tubes tubes = {launching, count, fired};
    ld_status status = mechanism_build(&self->mechanism, &plan, &tubes, error);
    if (status)
        return status;
    vehicle_name_streams(&self->mechanism);
    const ld_mstmm_element *platform = &self->mechanism.chain->element[ELEVATION];
    self->state_count = self->mechanism.state_count;
    self->mass = self->mechanism.mass;
    self->elevation_mass = platform->mass;
    self->elevation_center = v3_from(platform->center);
    self->tube_at = self->mechanism.tube.at;
    return LD_OK;
}

void vehicle_bodies_free(vehicle_bodies *self)
{
    mechanism_free(&self->mechanism);
    free(self->given);
    *self = (vehicle_bodies){0};
}

void vehicle_bodies_move(const vehicle_bodies *self, double t, const double *state,
                         vehicle_motion *motion)
{
    const mechanism_system *mechanism = &self->mechanism;
    double momentum[3], angular[3];
    ld_mstmm_momentum(mechanism->chain, state, state + VEHICLE_V, momentum, angular);
    mechanism_move(mechanism, t, &ORIGIN, state, &motion->all);
    const body_motion *chassis = &motion->all.body[CHASSIS];
    motion->momentum = v3_from(momentum);
    motion->tube = motion->all.tube;
    motion->chassis =
        (base_frame){.r = chassis->r, .v = chassis->v, .A = chassis->A, .w = chassis->w};
    for (int i = 0; i < HINGES; i++)
        mechanism_watch(mechanism, i, &motion->all, &motion->hinge[i]);
}

int vehicle_bodies_evaluate(const vehicle_bodies *self, const vehicle_input *input,
                            const double *state, vehicle_motion *motion, double *state_dot,
                            vehicle_output *output)
{
    const mechanism_input given = {.tube_force = input->tube_force,
                                   .tube_moment = input->tube_moment,
                                   .wheel_force = input->chassis_force,
                                   .wheel_moment = input->chassis_moment,
                                   .rest = input->rest,
                                   .held = input->held,
                                   .linear = input->linear};
    mechanism_output found;
    int outcome =
        mechanism_evaluate(&self->mechanism, &given, state, &motion->all, state_dot, &found);
    memcpy(output->power, found.power, sizeof output->power);
    output->loss = found.loss;
    for (int i = 0; i < HINGES; i++) {
        motion->hinge[i] = found.report.hold[i];
        motion->hinge[i].friction = found.report.friction[self->mechanism.hold[i].joint];
    }
    return outcome;
}

void vehicle_bodies_rest(const vehicle_bodies *self, double *state)
{
    mechanism_set_off(&self->mechanism, state);
}

double vehicle_bodies_next_sample(const vehicle_bodies *self, double t)
{
    return mechanism_next_sample(&self->mechanism, t);
}

void vehicle_bodies_sample(const vehicle_bodies *self, double t, double *state)
{
    mechanism_motion motion;
    mechanism_move(&self->mechanism, t, &ORIGIN, state, &motion);
    mechanism_sample(&self->mechanism, &motion, state);
}

double vehicle_bodies_kinetic_energy(const vehicle_bodies *self, const double *state)
{
    return ld_mstmm_energy(self->mechanism.chain, state, state + VEHICLE_V).kinetic;
}
