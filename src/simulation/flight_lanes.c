#include "simulation/flight_lanes.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = FLIGHT_MOST_LANES };

typedef struct lane {
    bool flies;
    int piece; // of the thrust curve, of which the block has the numbers
    lane_flight flight;
    flight_run run;
} lane;

// What makes so many lanes go.
typedef struct lane_width {
    int lanes;
    void (*rates)(const flight_lanes *lanes, const double *t, const double *state,
                  double *state_dot);
    void (*try)(double *block, int count, dormand_prince_slopes *f, void *self);
} lane_width;

static const lane_width widths[] = {
#ifdef LD_HAVE_AVX
    {4, flight_rates_avx2, dormand_prince_try_avx2},
    {8, flight_rates_avx512, dormand_prince_try_avx512},
#endif
    {1, NULL, NULL},
};

typedef struct lane_group {
    const lane_source *source;
    const lane_width *width;
    int count;
    lane *lane;        // [count]
    double *number;    // [FLIGHT_NUMBERS][count]
    double *step;      // [DORMAND_PRINCE_NUMBERS][count]
    flight_lanes side; // the flights as their equations see them
} lane_group;

int flight_lanes_here(void)
{
#ifdef LD_HAVE_AVX
    if (getenv("LAUNCHDYN_PLAIN"))
        return 1;
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"))
        return 8;
    if (__builtin_cpu_supports("avx2"))
        return 4;
#endif
    return 1;
}

// ---- blocks

// `count` numbers into, or out of, a lane's column of a block.
static void put(double *block, const lane_group *self, int i, size_t first, const double *number,
                size_t count)
{
    for (size_t k = 0; k < count; k++)
        block[(first + k) * (size_t)self->count + (size_t)i] = number[k];
}

static void get(const double *block, const lane_group *self, int i, size_t first, double *number,
                size_t count)
{
    for (size_t k = 0; k < count; k++)
        number[k] = block[(first + k) * (size_t)self->count + (size_t)i];
}

// Numbers of a lane's step into, or out of, its column.
#define STEP_AT(member) (offsetof(dormand_prince_numbers, member) / sizeof(double))
#define PUT_STEP(self, i, member, count)                                                           \
    put((self)->step, self, i, STEP_AT(member),                                                    \
        (const double *)&(self)->lane[i].run.steps.step.member, count)
#define GET_STEP(self, i, member, count)                                                           \
    get((self)->step, self, i, STEP_AT(member), (double *)&(self)->lane[i].run.steps.step.member,  \
        count)

// ---- a lane

static void end(lane_group *self, int i, ld_status status)
{
    lane *one = &self->lane[i];
    one->flies = false;
    flight_run_end(&one->run, status, one->flight.state);
    self->source->done(self->source->self, i, &one->flight, status);
}

// Begins the next step, or ends the flight.
static void go_on(lane_group *self, int i)
{
    flight_run *run = &self->lane[i].run;
    dormand_prince *steps = &run->steps;
    if (!flight_run_goes_on(run)) {
        end(self, i, LD_OK);
        return;
    }
    if (self->lane[i].piece != run->phase.piece)
        put(self->number, self, i, 0, (const double *)&run->phase.number, FLIGHT_NUMBERS);
    self->lane[i].piece = run->phase.piece;
    dormand_prince_begin(steps, flight_run_stop(run));
    PUT_STEP(self, i, t0, 1);
    PUT_STEP(self, i, y0, DORMAND_PRINCE_STATES);
    PUT_STEP(self, i, k[0], DORMAND_PRINCE_STATES);
}

static void choose(lane_group *self, int i)
{
    flight_run *run = &self->lane[i].run;
    if (dormand_prince_choose(&run->steps))
        PUT_STEP(self, i, size, 1);
    else
        end(self, i, flight_run_lost(run));
}

// After a trial.
static void judge(lane_group *self, int i)
{
    flight_run *run = &self->lane[i].run;
    dormand_prince *steps = &run->steps;
    steps->evaluations += DORMAND_PRINCE_STAGES - 1;
    GET_STEP(self, i, error, 1);
    if (!dormand_prince_judge(steps))
        return;
    GET_STEP(self, i, y, DORMAND_PRINCE_STATES);
    GET_STEP(self, i, k[6], DORMAND_PRINCE_STATES);
    ld_status status = flight_run_stepped(run);
    if (status)
        end(self, i, status);
    else
        go_on(self, i);
}

static void fly_alone(lane_group *self, int i)
{
    flight_run *run = &self->lane[i].run;
    ld_status status = LD_OK;
    while (!status && flight_run_goes_on(run))
        status = dormand_prince_step(&run->steps, flight_run_stop(run)) ? flight_run_stepped(run)
                                                                        : flight_run_lost(run);
    end(self, i, status);
}

static int any_in_the_air(const lane_group *self)
{
    int i = 0;
    while (i < self->count && !self->lane[i].flies)
        i++;
    return i < self->count ? i : -1;
}

// The next flight into a free lane; false: there is none.
static bool take(lane_group *self, int i)
{
    lane *one = &self->lane[i];
    lane_flight *flight = &one->flight;
    if (!self->source->next(self->source->self, i, flight))
        return false;
    ld_status status = flight_run_begin(&one->run, &flight->job, flight->state, flight->rocket,
                                        flight->summary, flight->error);
    int other = any_in_the_air(self);
    if (status) {
        end(self, i, status);
    } else if (self->count == 1 ||
               (other >= 0 && !flight_is_like(flight->job.system, self->side.system[other]))) {
        fly_alone(self, i);
    } else {
        one->flies = true;
        one->piece = -2; // none is
        self->side.system[i] = flight->job.system;
        self->side.phase[i] = &one->run.phase;
        PUT_STEP(self, i, absolute, DORMAND_PRINCE_STATES);
        PUT_STEP(self, i, relative, DORMAND_PRINCE_STATES);
        go_on(self, i);
    }
    return true;
}

// ---- all

static void slopes(const double *t, const double *y, double *y_dot, void *self)
{
    const lane_group *group = self;
    group->width->rates(&group->side, t, y, y_dot);
}

// A trial of a step in every lane; those that are free go along with one that flies.
static void try_steps(lane_group *self, int flying)
{
    for (int i = 0; i < self->count; i++)
        if (!self->lane[i].flies) {
            self->side.system[i] = self->side.system[flying];
            self->side.phase[i] = self->side.phase[flying];
        }
    self->width->try(self->step, self->lane[flying].run.steps.count, slopes, self);
}

static void fly(lane_group *self)
{
    for (;;) {
        for (int i = 0; i < self->count; i++)
            while (!self->lane[i].flies && take(self, i))
                ;
        int flying = any_in_the_air(self);
        if (flying < 0)
            return;
        for (int i = 0; i < self->count; i++)
            if (self->lane[i].flies)
                choose(self, i);
        flying = any_in_the_air(self);
        if (flying < 0)
            continue;
        try_steps(self, flying);
        for (int i = 0; i < self->count; i++)
            if (self->lane[i].flies)
                judge(self, i);
    }
}

ld_status flight_lanes_fly(int lanes, const lane_source *source, ld_error *error)
{
    // blocks and lanes want the alignment of the widest vectors
    enum { ALIGNMENT = 64, BLOCK = (FLIGHT_NUMBERS + DORMAND_PRINCE_NUMBERS) * MOST };
    lane_group self = {.source = source, .width = widths, .count = lanes};
    while (self.width->lanes != lanes)
        self.width++;
    double *block = aligned_alloc(ALIGNMENT, BLOCK * sizeof *block);
    self.lane = calloc((size_t)lanes, sizeof *self.lane);
    ld_status status = LD_OK;
    if (block && self.lane) {
        memset(block, 0, BLOCK * sizeof *block);
        self.side.number = self.number = block;
        self.step = block + FLIGHT_NUMBERS * MOST;
        fly(&self);
    } else {
        status = ld_fail(error, LD_ERR_MEMORY, "no memory for flights side by side");
    }
    free(self.lane);
    free(block);
    return status;
}
