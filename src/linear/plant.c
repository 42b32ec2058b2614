#include "linear/plant.h"

#include <stdlib.h>
#include <string.h>

#include "state/history.h"
#include "state/launch_state.h"
#include "state/linearise.h"

static size_t plant_size(const plant *self)
{
    size_t n = (size_t)self->states, m = (size_t)self->inputs, p = (size_t)self->outputs;
    return n * (n + 3 * m) + p * (n + 3 * m) + p;
}

static ld_status take_room(plant *self, ld_error *error)
{
    size_t n = (size_t)self->states, m = (size_t)self->inputs, p = (size_t)self->outputs;
    self->A = calloc(plant_size(self), sizeof(double));
    if (!self->A)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the linearised equations");
    self->B = self->A + n * n;
    self->B_rate = self->B + n * m;
    self->B_bend = self->B_rate + n * m;
    self->C = self->B_bend + n * m;
    self->D = self->C + p * n;
    self->D_rate = self->D + p * m;
    self->D_bend = self->D_rate + p * m;
    self->rest = self->D_bend + p * m;
    return LD_OK;
}

ld_status plant_make_room(plant *self, const plant *as, ld_error *error)
{
    *self = (plant){
        .states = as->states, .inputs = as->inputs, .outputs = as->outputs, .bends = as->bends};
    return take_room(self, error);
}

void plant_free(plant *self)
{
    free(self->A);
    *self = (plant){0};
}

void plant_between(const plant *a, const plant *b, double share, plant *to)
{
    size_t size = plant_size(to);
    for (size_t i = 0; i < size; i++)
        to->A[i] = a->A[i] + share * (b->A[i] - a->A[i]);
}

void plant_add(plant *to, double factor, const plant *what)
{
    size_t size = plant_size(to);
    for (size_t i = 0; i < size; i++)
        to->A[i] += factor * what->A[i];
}

ld_status plant_inputs(const ld_simulation *simulation, quantity_columns *inputs, ld_error *error)
{
    quantity_things things = quantity_things_of(simulation->model);
    const quantity_part parts[] = {{simulation->launcher.base.kind->inputs, 0},
                                   {&launcher_inputs, 0}};
    return quantity_columns_make(inputs, parts, 2, &things, error);
}

// What differences are taken with.
typedef struct bench {
    launch_state launch;
    linear_system system;
    base_disturbance disturbed;
    double y[LD_MAX_STATES];
    // on both sides
    double rates[2][2 * LD_MAX_STATES], row[2][LD_MAX_COLUMNS];
} bench;

static int differentiate(bench *self, int side)
{
    history_row(&self->launch, self->system.t, self->y, 0, self->row[side]);
    return linear_rates(&self->launch, &self->system, self->y, self->rates[side]);
}

static void go_to_rest(bench *self)
{
    memcpy(self->y, self->system.y, (size_t)self->launch.launcher.state_count * sizeof *self->y);
}

static void divide(int count, const double *side, const double *other, double by, double *to)
{
    for (int i = 0; i < count; i++)
        to[i] = (side[i] - other[i]) / by;
}

// C, of unknown j.
static int see_unknown(bench *self, int j, plant *to)
{
    double h = self->system.step[j];
    int bad = 0;
    for (int side = 0; side < 2; side++) {
        go_to_rest(self);
        linear_displace(&self->launch, &self->system, j, side ? -h : h, self->y);
        bad |= differentiate(self, side);
    }
    divide(to->outputs, self->row[0], self->row[1], 2 * h, to->C + to->outputs * j);
    return bad;
}

// A column of B and of D, of the input at `place`.
static int see_input(bench *self, double *place, double h, double *B, double *D, const plant *to)
{
    int bad = 0;
    go_to_rest(self);
    for (int side = 0; side < 2; side++) {
        *place = side ? -h : h;
        bad |= differentiate(self, side);
    }
    *place = 0;
    divide(to->states, self->rates[0], self->rates[1], 2 * h, B);
    divide(to->outputs, self->row[0], self->row[1], 2 * h, D);
    return bad;
}

static int see_all(bench *self, const quantity_columns *inputs, plant *to)
{
    int bad = 0;
    launch_state *launch = &self->launch;
    launch->phase = self->system.phase;
    launch->launcher.base.disturbed = &self->disturbed;
    memcpy(to->A, self->system.J, (size_t)to->states * (size_t)to->states * sizeof(double));
    for (int j = 0; j < to->states && !bad; j++)
        bad = see_unknown(self, j, to);
    for (int i = 0; i < to->inputs && !bad; i++) {
        double h = *inputs->column[i].unit == 'N' ? 1 : 1e-6; // forces move little
        size_t offset = inputs->cell[i].offset;
        double *input = (double *)(void *)((char *)&self->disturbed.input + offset);
        double *rate = (double *)(void *)((char *)&self->disturbed.rate + offset);
        double *bend = (double *)(void *)((char *)&self->disturbed.acceleration + offset);
        int n = to->states * i, p = to->outputs * i;
        bad = see_input(self, input, h, to->B + n, to->D + p, to) ||
              see_input(self, rate, h, to->B_rate + n, to->D_rate + p, to) ||
              (to->bends && see_input(self, bend, h, to->B_bend + n, to->D_bend + p, to));
    }
    go_to_rest(self);
    history_row(launch, self->system.t, self->y, 0, to->rest);
    return bad;
}

ld_status plant_make(plant *self, const ld_simulation *simulation, bool rubbing,
                     const quantity_columns *inputs, ld_error *error)
{
    *self = (plant){.inputs = inputs->count,
                    .outputs = simulation->columns.count,
                    .bends = simulation->launcher.launching.supports.clamps};
    bench *at = aligned_alloc(64, (sizeof *at + 63) / 64 * 64);
    if (!at)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the linearised equations");
    memset(at, 0, sizeof *at);
    ld_status status = launch_state_begin(&at->launch, simulation, error);
    if (!status)
        status = simulation_linearise(&at->launch, rubbing, true, &at->system, error);
    self->states = at->system.count;
    if (!status)
        status = take_room(self, error);
    if (!status && see_all(at, inputs, self))
        status = ld_fail(error, LD_ERR_NUMERIC, "the equations cannot be linearised");
    free(at->system.J);
    launch_state_end(&at->launch);
    free(at);
    return status;
}
