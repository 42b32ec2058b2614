// What a random road makes of the exit: launches from the states that its sines leave, over what
// follows of it.
//
// Height and state are linear in the cosines and sines that the road is a sum of. Either their
// phases are sampled, launch by launch. Or Gram-Schmidt's method, with pivots, finds the few
// independent combinations of them, patterns, by which all that the launch begins with and drives
// over can vary; a launch on each, and one on its opposite, give what it adds to the variance.
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "launch/launch_run.h"
#include "launchdyn/response.h"
#include "linear/response_state.h"
#include "math/functions.h"
#include "model/model.h"
#include "quantities/study_results.h"
#include "run/run.h"
#include "run/simulation_build.h"
#include "state/linearise.h"

static const double TWO_PI = 6.283185307179586476925286766559;
// A pattern is left out where all that is left is this share of each number's own deviation.
static const double LEAST_SHARE = 1e-3;
// [s] that a drawn launch stays on its road before the ignition: motions that are not linear in the
// road, as adaptors rolling in the bore, come to what they are there.
static const double SETTLING = 0.2;
// Points of the road to its shortest wave, at which the launch sees it by a cubic spline.
enum { POINTS_A_WAVE = 12, MOST_POINTS = 2000 };

// Numbers that the road's sines make, each a row over the sines' cosines and sines.
typedef struct road_rows {
    int unknowns, points; // of the state; of the road
    double from, step;    // [m] the points
    double start;         // [m] where the chassis is as the launch begins
    size_t columns;
    int count, pivots; // rows; the first ones, which count for whether a pattern is left out
    double *value;     // [count][columns]
} road_rows;

// Where the rows begin: state, its rate, slopes of both tracks, their heights.
enum { STATE, RATE, SLOPE, HEIGHT, PARTS };

static int row_at(const road_rows *self, int part)
{
    int n = self->unknowns, m = self->points;
    const int at[PARTS] = {0, n, 2 * n, 2 * n + 2 * m};
    return at[part];
}

// The launch that the road disturbs.
typedef struct exit_bench {
    ld_response *response;
    int launches; // so far
    ld_model model;
    ld_simulation *simulation;
    launch_state state;
    bool begun;
    linear_system rest;
    ld_summary summary;
    launch_start start;
    ld_road under;
    road_rows rows;
    double *profile; // [points][3] x, left, right
    quantity_things things;
    int figures;
    quantity_walk *figure; // that are asked for
    double *value;         // [3][figures] of a launch, of its opposite, from rest
    int seed;              // of the draws: the road's
} exit_bench;

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the scatter of the exit");
}

// ---- figures ----

static ld_status find_figure(const quantity_things *things, const char *name, quantity_walk *found,
                             ld_error *error)
{
    char near[QUANTITY_NAME], now[QUANTITY_NAME];
    *found = study_result_find(things, name);
    if (!found->row && ld_current_name(name, now, sizeof now))
        *found = study_result_find(things, now);
    if (found->row && found->group->where.type != QUANTITY_NONE)
        return ld_fail(error, LD_ERR_INPUT, "\"%s\" is a result of the flight, not of the exit",
                       name);
    if (found->row)
        return LD_OK;
    study_result_near(things, name, near);
    if (near[0])
        return ld_fail(error, LD_ERR_INPUT,
                       "unknown result of a launch \"%s\", did you mean \"%s\"?", name, near);
    return ld_fail(error, LD_ERR_INPUT, "unknown result of a launch \"%s\"", name);
}

static ld_status find_figures(exit_bench *self, const char *const *names, size_t count,
                              ld_error *error)
{
    self->things = quantity_things_of(&self->model);
    self->figures = (int)count;
    self->figure = malloc((count + 1) * sizeof *self->figure);
    self->value = malloc((3 * count + 1) * sizeof *self->value);
    ld_status status = self->figure && self->value ? LD_OK : no_memory(error);
    for (size_t i = 0; i < count && !status; i++)
        status = find_figure(&self->things, names[i], &self->figure[i], error);
    return status;
}

static void read_figures(const exit_bench *self, double *value)
{
    for (int i = 0; i < self->figures; i++)
        value[i] = quantity_value(&self->figure[i], &self->summary.rocket[0]);
}

// ---- the launch ----

// The scenario's first rocket alone, ignited after `settling` [s] on a flat road.
static void set_model(exit_bench *self, const ld_model *of, double speed, double settling)
{
    ld_model *model = &self->model;
    *model = *of;
    model->tubes.modes.cut = 0; // as in the response, whose states it takes
    model->firing_count = 1;
    model->firing[0].at = 0;
    model->run.lead_in = settling;
    model->run.start = LD_START_EQUILIBRIUM;
    model->run.end = LD_END_TIP;
    model->base.vehicle.speed = speed;
    self->seed = of->base.vehicle.road.seed;
    model->base.vehicle.road.form = LD_ROAD_FLAT;
}

// Runs on a road from the state `start->y`.
static ld_status run_on(exit_bench *self, const ld_road *under, ld_error *error)
{
    if (!response_continues(self->response))
        return ld_fail(error, LD_ERR_INTERRUPTED, "interrupted after %d launches", self->launches);
    self->launches++;
    ld_status status = road_build(under, 0, 0, &self->start.road, error);
    if (!status)
        status = run_from(self->simulation, &self->start, &self->summary, error);
    road_free(self->start.road);
    return status;
}

// Runs on the road `under`, from the state of rest with the pattern's part `share` of it.
static ld_status launch(exit_bench *self, const double *pattern, double share, ld_error *error)
{
    const road_rows *rows = &self->rows;
    const double *height = pattern + row_at(rows, HEIGHT);
    linear_displace_all(&self->state, &self->rest, pattern, share, self->start.y);
    for (int i = 0; i < rows->points; i++) {
        double *point = self->profile + 3 * i;
        point[0] = rows->from + i * rows->step;
        point[1] = share * height[i];
        point[2] = share * height[rows->points + i];
    }
    return run_on(self, &self->under, error);
}

static ld_status find_rest(exit_bench *self, ld_error *error)
{
    ld_status status = simulation_renew(&self->simulation, &self->model, error);
    if (!status)
        status = launch_state_begin(&self->state, self->simulation, error);
    self->begun = !status;
    if (!status)
        status = linear_rest(&self->state, &self->rest, error);
    self->start.rest = self->state.rest;
    self->start.on_breech = self->state.on_breech;
    return status;
}

// ---- rows ----

// The stretch under the wheels, longer than a launch by a tenth.
static void set_points(exit_bench *self, double speed, double shortest)
{
    const ld_model *model = &self->model;
    double rear = INFINITY, front = -INFINITY;
    for (int j = 0; j < model->base.vehicle.wheel_count; j++) {
        rear = fmin(rear, model->base.vehicle.wheel[j].mount[0]);
        front = fmax(front, model->base.vehicle.wheel[j].mount[0]);
    }
    double margin = 0.2, step = shortest / POINTS_A_WAVE;
    double lasts = model->run.lead_in + 1.1 * self->summary.rocket[0].t_rear; // [s]
    double length = front - rear + 2 * margin + speed * lasts;
    self->rows.start = -speed * model->run.lead_in;
    self->rows.points = (int)fmin(ceil(length / step), MOST_POINTS) + 4;
    self->rows.from = self->rows.start + rear - margin;
    self->rows.step = length / (self->rows.points - 4);
}

static double *row(const road_rows *self, int part, int i)
{
    return self->value + self->columns * (size_t)(row_at(self, part) + i);
}

// One normal number: the state, times e^(i k x), and the heights of the tracks' sines.
static void put_columns(const road_rows *self, size_t column, const road_line *line, double omega,
                        const ld_phasor *state, const double height[2])
{
    double a = sqrt(line->square), k = TWO_PI * line->n;
    double cosine, sine;
    sincos(k * self->start, &sine, &cosine);
    for (int i = 0; i < self->unknowns; i++) {
        double real = a * (cosine * state[i].real - sine * state[i].imaginary);
        double imaginary = a * (cosine * state[i].imaginary + sine * state[i].real);
        row(self, STATE, i)[column] = real;
        row(self, STATE, i)[column + 1] = -imaginary;
        row(self, RATE, i)[column] = -omega * imaginary;
        row(self, RATE, i)[column + 1] = -omega * real;
    }
    for (int track = 0; track < 2; track++)
        for (int i = 0; i < self->points; i++) {
            double x = self->from + i * self->step, b = a * height[track], s, c;
            int at = track * self->points + i;
            sincos(k * x, &s, &c);
            row(self, HEIGHT, at)[column] = b * c;
            row(self, HEIGHT, at)[column + 1] = -b * s;
            row(self, SLOPE, at)[column] = -b * k * s;
            row(self, SLOPE, at)[column + 1] = -b * k * c;
        }
}

static ld_status fill_rows(road_rows *self, ld_response *response, double speed, ld_error *error)
{
    size_t lines;
    const road_line *line = response_lines(response, &lines);
    int n = self->unknowns;
    ld_phasor *state = malloc(3 * (size_t)n * sizeof *state), *both = state + 2 * n;
    ld_status status = state ? LD_OK : no_memory(error);
    for (size_t k = 0; k < lines && !status; k++) {
        double shared = line[k].shared, own = sqrt(fmax(0, 1 - shared * shared));
        status = response_states(response, speed, line[k].n * speed, state, error);
        for (int i = 0; i < n && !status; i++) {
            both[i].real = state[i].real + shared * state[n + i].real;
            both[i].imaginary = state[i].imaginary + shared * state[n + i].imaginary;
            state[n + i].real *= own;
            state[n + i].imaginary *= own;
        }
        if (status)
            break;
        double omega = TWO_PI * line[k].n * speed;
        put_columns(self, 4 * k, &line[k], omega, both, (double[]){1, shared});
        put_columns(self, 4 * k + 2, &line[k], omega, state + n, (double[]){0, own});
    }
    free(state);
    return status;
}

static ld_status make_rows(exit_bench *self, double speed, ld_error *error)
{
    size_t lines;
    double highest = 0;
    ld_response *response = self->response;
    road_rows *rows = &self->rows;
    const road_line *line = response_lines(response, &lines);
    for (size_t k = 0; k < lines; k++)
        highest = fmax(highest, line[k].n);
    rows->unknowns = response_unknowns(response);
    set_points(self, speed, 1 / highest);
    rows->columns = 4 * lines;
    rows->pivots = row_at(rows, HEIGHT);
    rows->count = rows->pivots + 2 * rows->points;
    rows->value = malloc(((size_t)rows->count * rows->columns + 1) * sizeof *rows->value);
    self->profile = malloc(3 * (size_t)rows->points * sizeof *self->profile);
    if (!rows->value || !self->profile)
        return no_memory(error);
    self->under = (ld_road){.iso_class = LD_ROAD_SMOOTH,
                            .form = LD_ROAD_SUM,
                            .profile = {(size_t)rows->points, 3, self->profile}};
    return fill_rows(rows, response, speed, error);
}

// ---- patterns ----

static double product(const double *a, const double *b, size_t count)
{
    double sum[4] = {0};
    for (size_t i = 0; i < count; i += 4) // a road's sine has four columns
        for (size_t k = 0; k < 4; k++)
            sum[k] += a[i + k] * b[i + k];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

// What the next pattern makes of every row, which is then taken out of them; false: there is none.
// `all`: the squares of the rows as they were. `direction`: room for a row.
static bool next_pattern(const road_rows *self, const double *all, double *direction,
                         double *pattern)
{
    int best = -1;
    double most = LEAST_SHARE * LEAST_SHARE;
    for (int i = 0; i < self->pivots; i++) {
        const double *it = self->value + self->columns * (size_t)i;
        double share = all[i] > 0 ? product(it, it, self->columns) / all[i] : 0;
        if (share > most) {
            most = share;
            best = i;
        }
    }
    if (best < 0)
        return false;
    memcpy(direction, self->value + self->columns * (size_t)best,
           self->columns * sizeof *direction);
    double size = sqrt(most * all[best]);
    for (size_t k = 0; k < self->columns; k++)
        direction[k] /= size;
    for (int i = 0; i < self->count; i++) {
        double *it = self->value + self->columns * (size_t)i;
        pattern[i] = product(it, direction, self->columns);
        for (size_t k = 0; k < self->columns; k++)
            it[k] -= pattern[i] * direction[k];
    }
    return true;
}

// Launches on a pattern and on its opposite.
static ld_status add_pattern(exit_bench *self, const double *pattern, double *variance,
                             ld_error *error)
{
    double *up = self->value, *down = up + self->figures;
    ld_status status = launch(self, pattern, 1, error);
    read_figures(self, up);
    if (!status)
        status = launch(self, pattern, -1, error);
    read_figures(self, down);
    for (int i = 0; i < self->figures; i++)
        variance[i] += 0.25 * (up[i] - down[i]) * (up[i] - down[i]);
    return status;
}

static ld_status add_patterns(exit_bench *self, double *variance, ld_error *error)
{
    const road_rows *rows = &self->rows;
    size_t count = (size_t)rows->count;
    double *room = malloc((2 * count + rows->columns) * sizeof *room);
    if (!room)
        return no_memory(error);
    double *pattern = room, *all = room + count, *direction = all + count;
    for (size_t i = 0; i < count; i++) {
        const double *it = rows->value + rows->columns * i;
        all[i] = product(it, it, rows->columns);
    }
    ld_status status = LD_OK;
    while (!status && next_pattern(rows, all, direction, pattern))
        status = add_pattern(self, pattern, variance, error);
    free(room);
    return status;
}

// ---- draws ----

// Phases of all sines: a cosine and a sine of unit variance each.
static void draw_phases(const exit_bench *self, int draw, double *number)
{
    uint64_t seed = (uint64_t)self->seed, stream = random_stream("exit");
    for (size_t k = 0; k < self->rows.columns; k += 2) {
        double phase = TWO_PI * random_uniform(seed, stream, (uint64_t)draw, k, 0);
        number[k] = sqrt(2) * cos(phase);
        number[k + 1] = sqrt(2) * sin(phase);
    }
}

// Mean and squares of what differs from rest, over launches on roads of drawn phases; at last the
// variance.
static ld_status add_draws(exit_bench *self, int draws, const double *rest, double *mean,
                           double *variance, ld_error *error)
{
    const road_rows *rows = &self->rows;
    double *pattern = malloc(((size_t)rows->count + rows->columns) * sizeof *pattern);
    if (!pattern)
        return no_memory(error);
    double *number = pattern + rows->count;
    ld_status status = LD_OK;
    for (int k = 0; k < draws && !status; k++) {
        draw_phases(self, k, number);
        for (int i = 0; i < rows->count; i++)
            pattern[i] = product(rows->value + rows->columns * (size_t)i, number, rows->columns);
        status = launch(self, pattern, 1, error);
        read_figures(self, self->value);
        for (int i = 0; i < self->figures; i++) {
            double off = self->value[i] - rest[i], from_mean = off - mean[i];
            mean[i] += from_mean / (k + 1);
            variance[i] += from_mean * (off - mean[i]);
        }
    }
    for (int i = 0; i < self->figures; i++)
        variance[i] /= draws - 1;
    free(pattern);
    return status;
}

// ---- what is asked ----

static void bench_free(exit_bench *self)
{
    if (!self)
        return;
    if (self->begun)
        launch_state_end(&self->state);
    ld_simulation_free(self->simulation);
    free(self->rows.value);
    free(self->profile);
    free(self->figure);
    free(self->value);
    free(self);
}

// From rest, on a flat road.
static ld_status launch_from_rest(exit_bench *self, ld_error *error)
{
    static const ld_road flat = {.iso_class = LD_ROAD_SMOOTH};
    memcpy(self->start.y, self->rest.y, sizeof self->start.y);
    return run_on(self, &flat, error);
}

static ld_status scatter(exit_bench *self, double speed, int draws, double *mean, double *deviation,
                         ld_error *error)
{
    double *rest = self->value + 2 * self->figures;
    ld_status status = find_rest(self, error);
    if (!status)
        status = launch_from_rest(self, error);
    if (status)
        return status;
    read_figures(self, rest);
    for (int i = 0; i < self->figures; i++)
        mean[i] = deviation[i] = 0;
    status = make_rows(self, speed, error);
    if (!status)
        status = draws ? add_draws(self, draws, rest, mean, deviation, error)
                       : add_patterns(self, deviation, error);
    for (int i = 0; i < self->figures; i++) {
        mean[i] += rest[i];
        deviation[i] = sqrt(deviation[i]);
    }
    return status;
}

// NOLINTNEXTLINE(readability-function-size): public
ld_status ld_response_exit(ld_response *response, double speed, int draws, const char *const *names,
                           size_t count, double *mean, double *deviation, ld_error *error)
{
    ld_status status = response_check_road(response, speed, error);
    if (!status && (draws < 0 || draws == 1))
        status =
            ld_fail(error, LD_ERR_INPUT, "found %d draws, expected 0 (none) or at least 2", draws);
    if (status)
        return status;
    exit_bench *self = aligned_alloc(64, (sizeof *self + 63) / 64 * 64);
    if (!self)
        return no_memory(error);
    memset(self, 0, sizeof *self);
    self->response = response;
    set_model(self, response_model(response), speed, draws ? SETTLING : 0);
    status = find_figures(self, names, count, error);
    if (!status)
        status = scatter(self, speed, draws, mean, deviation, error);
    bench_free(self);
    return status;
}
