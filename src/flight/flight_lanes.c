#include "flight/flight_lanes.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = FLIGHT_MOST_LANES };

typedef struct lane {
    bool flies;
    int changes; // of the phase, of which the block has the numbers
    lane_flight flight;
    flight_run run;
} lane;

// What makes so many lanes go.
typedef struct lane_width {
    int lanes;
    void (*rates)(const flight_lanes *lanes, const double *t, const double *state,
                  double *state_dot);
    void (*try)(double *block, int count, dormand_prince_slopes *f, void *self);
    unsigned (*watch)(const flight_lanes *lanes, const flight_step *step);
} lane_width;

static const lane_width widths[] = {
#ifdef LD_HAVE_AVX
    {4, flight_rates_avx2, dormand_prince_try_avx2, flight_watch_avx2},
    {8, flight_rates_avx512, dormand_prince_try_avx512, flight_watch_avx512},
#endif
    {1, NULL, NULL, NULL},
};

typedef struct lane_group {
    const lane_source *source;
    const lane_width *width;
    int count;
    lane *lane;        // [count]
    double *number;    // [FLIGHT_NUMBERS][count]
    double *step;      // [DORMAND_PRINCE_NUMBERS][count]
    double *extremes;  // [FLIGHT_EXTREMES][count]
    double *tables;    // [FLIGHT_TABLES][count]
    flight_lanes side; // the flights as their equations see them
    flight_step ends;  // in `step`
} lane_group;

int flight_lanes_here(void)
{
#ifdef LD_HAVE_AVX
    const char *given = getenv("LAUNCHDYN_LANES");
    long most = getenv("LAUNCHDYN_PLAIN") ? 1 : given ? strtol(given, NULL, 10) : MOST;
    if (most >= 8 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"))
        return 8;
    if (most >= 4 && __builtin_cpu_supports("avx2"))
        return 4;
#endif
    return 1;
}

// ---- a lane and its columns of the blocks

// `count` numbers into, or out of, column i.
static void put_column(double *block, const lane_group *self, int i, const void *numbers,
                       size_t count)
{
    const double *number = numbers;
    for (size_t k = 0; k < count; k++)
        block[k * (size_t)self->count + (size_t)i] = number[k];
}

static void get_column(const double *block, const lane_group *self, int i, void *numbers,
                       size_t count)
{
    double *number = numbers;
    for (size_t k = 0; k < count; k++)
        number[k] = block[k * (size_t)self->count + (size_t)i];
}

// A number of column i of the steps.
#define OF_STEP(self, i, member)                                                                   \
    (self)                                                                                         \
        ->step[offsetof(dormand_prince_numbers, member) / sizeof(double) * (size_t)(self)->count + \
               (size_t)(i)]

// A flight that is new in column i.
static void enter_column(lane_group *self, int i, const lane *one)
{
    static const flight_tables none;
    self->side.system[i] = one->flight.job.system;
    self->side.phase[i] = &one->run.phase;
    put_column(self->tables, self, i, &none, FLIGHT_TABLES);
}

// The flight of lane `from` into column i, from where it continues.
static void put_flight(lane_group *self, int i, int from)
{
    lane *one = &self->lane[from];
    const flight_run *run = &one->run;
    if (i != from || one->changes != run->phase.changes)
        put_column(self->number, self, i, &run->phase.number, FLIGHT_NUMBERS);
    put_column(self->step, self, i, &run->steps.step, DORMAND_PRINCE_NUMBERS);
    put_column(self->extremes, self, i, &run->extremes, FLIGHT_EXTREMES);
    one->changes = run->phase.changes;
}

static void end_lane(lane_group *self, int i, ld_status status)
{
    lane *one = &self->lane[i];
    one->flies = false;
    flight_run_end(&one->run, status, one->flight.state);
    self->source->done(self->source->self, i, &one->flight, status);
}

static void watch_lane(lane_group *self, int i, bool seen)
{
    flight_run *run = &self->lane[i].run;
    get_column(self->step, self, i, &run->steps.step, DORMAND_PRINCE_NUMBERS);
    get_column(self->extremes, self, i, &run->extremes, FLIGHT_EXTREMES);
    run->steps.open = false;
    ld_status status = flight_run_examine(run, seen);
    if (status || !flight_run_continues(run))
        end_lane(self, i, status);
    else
        put_flight(self, i, i);
}

static void fly_alone(lane_group *self, int i)
{
    flight_run *run = &self->lane[i].run;
    ld_status status = LD_OK;
    while (!status && flight_run_continues(run))
        status = flight_run_step(run);
    end_lane(self, i, status);
}

static int any_in_the_air(const lane_group *self)
{
    int i = 0;
    while (i < self->count && !self->lane[i].flies)
        i++;
    return i < self->count ? i : -1;
}

// The next flight into a free lane; false: there is none.
static bool load_next(lane_group *self, int i)
{
    lane *one = &self->lane[i];
    lane_flight *flight = &one->flight;
    if (!self->source->next(self->source->self, i, flight))
        return false;
    ld_status status = flight_run_begin(&one->run, &flight->job, flight->state, flight->rocket,
                                        flight->summary, flight->error);
    int other = any_in_the_air(self);
    if (status || !flight_run_continues(&one->run)) {
        end_lane(self, i, status);
    } else if (self->count == 1 || one->run.line || flight->job.system->canopies ||
               flight->job.system->own_filling ||
               (other >= 0 && !flight_is_like(flight->job.system, self->side.system[other]))) {
        fly_alone(self, i);
    } else {
        one->flies = true;
        one->changes = -1; // none is
        enter_column(self, i, one);
        put_flight(self, i, i);
    }
    return true;
}

// ---- all

static void slopes(const double *t, const double *y, double *y_dot, void *self)
{
    const lane_group *group = self;
    group->width->rates(&group->side, t, y, y_dot);
}

// Lanes that are free go along with one that flies.
static void fill_free_lanes(lane_group *self, int flying)
{
    for (int i = 0; i < self->count; i++)
        if (!self->lane[i].flies) {
            enter_column(self, i, &self->lane[flying]);
            put_flight(self, i, flying);
        }
}

// A trial of a step in every lane.
static void try_steps(lane_group *self, int flying)
{
    self->width->try(self->step, self->lane[flying].run.steps.count, slopes, self);
    unsigned seen = self->width->watch(&self->side, &self->ends);
    for (int i = 0; i < self->count; i++) {
        double outcome = OF_STEP(self, i, outcome);
        bool due = OF_STEP(self, i, steps) >= self->lane[i].run.next_check ||
                   OF_STEP(self, i, t) == OF_STEP(self, i, t_stop);
        bool look = seen >> i & 1, done = outcome == DORMAND_PRINCE_DONE && (due || look);
        if (self->lane[i].flies && (done || outcome == DORMAND_PRINCE_LOST))
            watch_lane(self, i, look);
    }
}

static void count_use(const lane_group *self)
{
    lane_use *use = self->source->use;
    for (int i = 0; use && i < self->count; i++) {
        use->lanes++;
        use->flying += self->lane[i].flies;
    }
}

static void fly(lane_group *self)
{
    for (;;) {
        for (int i = 0; i < self->count; i++)
            while (!self->lane[i].flies && load_next(self, i))
                ;
        int flying = any_in_the_air(self);
        if (flying < 0)
            return;
        fill_free_lanes(self, flying);
        count_use(self);
        try_steps(self, flying);
    }
}

// Blocks in `block`, and where in them the steps' ends stand.
static void lay_out(lane_group *self, double *block)
{
    self->side.number = self->number = block;
    self->step = self->number + FLIGHT_NUMBERS * self->count;
    self->extremes = self->step + DORMAND_PRINCE_NUMBERS * self->count;
    self->side.tables = self->tables = self->extremes + FLIGHT_EXTREMES * self->count;
    self->ends = (flight_step){
        .done = &OF_STEP(self, 0, outcome),
        .t0 = &OF_STEP(self, 0, t0),
        .t = &OF_STEP(self, 0, t),
        .y0 = &OF_STEP(self, 0, y0),
        .y0_dot = &OF_STEP(self, 0, k[0]),
        .y = &OF_STEP(self, 0, y),
        .y_dot = &OF_STEP(self, 0, k[DORMAND_PRINCE_STAGES - 1]),
        .extremes = self->extremes,
    };
}

ld_status flight_lanes_fly(int lanes, const lane_source *source, ld_error *error)
{
    // blocks and lanes want the alignment of the widest vectors
    enum {
        ALIGNMENT = 64,
        BLOCK = (FLIGHT_NUMBERS + DORMAND_PRINCE_NUMBERS + FLIGHT_EXTREMES + FLIGHT_TABLES) * MOST
    };
    lane_group self = {.source = source, .width = widths, .count = lanes};
    while (self.width->lanes != lanes)
        self.width++;
    double *block = aligned_alloc(ALIGNMENT, BLOCK * sizeof *block);
    self.lane = calloc((size_t)lanes, sizeof *self.lane);
    ld_status status = LD_OK;
    if (block && self.lane) {
        memset(block, 0, BLOCK * sizeof *block);
        lay_out(&self, block);
        fly(&self);
    } else {
        status = ld_fail(error, LD_ERR_MEMORY, "no memory for flights side by side");
    }
    free(self.lane);
    free(block);
    return status;
}
