// Linear response: frequency responses, spectra and root mean squares from the linearised
// equations.
#include "launchdyn/response.h"
#include "model/model.h"
#include "model/parts.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/suggestion.h"
#include "environment/road.h"
#include "linear/plant.h"
#include "linear/response_state.h"
#include "math/functions.h"
#include "math/matrices/hessenberg.h"
#include "run/simulation_build.h"

static const double TWO_PI = 6.283185307179586476925286766559;

// Inputs that move together, each by its share of the road that is `along` in front of the chassis.
typedef struct excitation {
    int count, input[LD_MAX_WHEELS];
    double along[LD_MAX_WHEELS]; // [m]
    double share[LD_MAX_WHEELS];
} excitation;

// Those of the road, in front of the others.
enum { ROAD_OF_BOTH, ROAD_OF_LEFT, ROAD_OF_RIGHT, ROAD_INPUTS };
static const ld_column road_inputs[ROAD_INPUTS] = {
    {"road", "m", "height of the road under the chassis' mass centre, both tracks"},
    {"road.left", "m", "height of its left track there"},
    {"road.right", "m", "height of its right track there"},
};

struct ld_response {
    const ld_model *model;
    const ld_watch *watch; // NULL: no one
    bool rubbing;          // the adaptors, which hardly slide
    ld_model at[2];        // on a flat road, at both ends of the speeds
    ld_simulation *simulation;
    quantity_columns inputs; // of the plant
    excitation road[ROAD_INPUTS];
    ld_column *input; // all that can be asked for
    size_t input_count;
    road_line *line;
    size_t line_count;

    // The equations depend on the speed as on a straight line: at both ends, and now.
    double speed[2], speed_now; // [m/s] not a number: nothing is ready
    plant end[2], now;
    hessenberg solver;
    int chosen_count, *chosen; // columns
    // Where the hinges rub: what a unit of viscous friction in each adds to the plant (without
    // states: nothing), what their friction amounts to now [N m s/rad].
    bool hinges_have_friction;
    plant viscous[HINGES];
    double friction[HINGES];
    // B, B', B" of the reduced states; C of the chosen columns on them, by rows
    double *B, *B_rate, *B_bend, *C;
};

// ---- life ----

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the linear response");
}

// What grows has no steady response.
static ld_status check_stability(const ld_simulation *simulation, ld_error *error)
{
    const ld_pole *growing = &simulation->growing;
    if (simulation->stability) {
        *error = simulation->unstable;
        return simulation->stability;
    }
    if (growing->real > 0)
        return ld_fail(error, LD_ERR_INPUT,
                       "there is no steady response: a motion of %.3g Hz (%s) grows by %.3g 1/s "
                       "(launchdyn modes lists all)",
                       growing->imaginary / TWO_PI, growing->shape, growing->real);
    return LD_OK;
}

static ld_status make_end(ld_response *self, int end, ld_error *error)
{
    ld_model *model = &self->at[end];
    ld_simulation *simulation = NULL;
    *model = *self->model;
    model->tubes.modes.cut = 0; // frequencies are those of the tube itself
    if (model_has_vehicle(model)) {
        model->base.vehicle.road.form = LD_ROAD_FLAT;
        model->base.vehicle.speed = self->speed[end];
    }
    ld_status status = simulation_renew(&simulation, model, error);
    if (!status)
        status = check_stability(simulation, error);
    if (!status && end == 0)
        status = plant_inputs(simulation, &self->inputs, error);
    if (!status)
        status = plant_make(&self->end[end], simulation, self->rubbing, &self->inputs, error);
    if (end == 0)
        self->simulation = simulation; // it has the columns' texts
    else
        ld_simulation_free(simulation);
    return status;
}

double response_rest(const ld_response *self, const char *column)
{
    const quantity_columns *columns = &self->simulation->columns;
    for (int i = 0; i < columns->count; i++)
        if (strcmp(columns->column[i].name, column) == 0)
            return self->end[0].rest[i];
    return NAN;
}

const ld_model *response_model(const ld_response *self)
{
    return self->model;
}

const road_line *response_lines(const ld_response *self, size_t *count)
{
    *count = self->line_count;
    return self->line;
}

int response_unknowns(const ld_response *self)
{
    return self->now.states;
}

// Which of the inputs are the road under the wheels of each track.
static void find_tracks(ld_response *self)
{
    const ld_vehicle *vehicle = &self->model->base.vehicle;
    char name[QUANTITY_NAME];
    double x = response_rest(self, "chassis.x");
    for (int j = 0; j < vehicle->wheel_count; j++) {
        snprintf(name, sizeof name, "wheel.%s.x", vehicle->wheel[j].name);
        double along = response_rest(self, name) - x;
        snprintf(name, sizeof name, "wheel.%s.road", vehicle->wheel[j].name);
        int input = 0;
        while (strcmp(self->inputs.column[input].name, name) != 0)
            input++;
        double right = road_right_share(&vehicle->road, vehicle->wheel[j].mount[2]);
        const double share[ROAD_INPUTS] = {1, 1 - right, right};
        for (int k = 0; k < ROAD_INPUTS; k++) {
            excitation *on = &self->road[k];
            if (share[k] == 0)
                continue;
            on->input[on->count] = input;
            on->along[on->count] = along;
            on->share[on->count++] = share[k];
        }
    }
}

static ld_status list_inputs(ld_response *self, ld_error *error)
{
    size_t own = (size_t)self->inputs.count, first = model_has_vehicle(self->model) ? 3 : 0;
    self->input_count = first + own;
    self->input = malloc(self->input_count * sizeof *self->input);
    if (!self->input)
        return no_memory(error);
    memcpy(self->input, road_inputs, first * sizeof *self->input);
    memcpy(self->input + first, self->inputs.column, own * sizeof *self->input);
    if (!first)
        return LD_OK;
    find_tracks(self);
    return road_lines(&self->model->base.vehicle.road, &self->line, &self->line_count, error);
}

static ld_status set_speeds(ld_response *self, double slowest, double fastest, ld_error *error)
{
    double own = model_has_vehicle(self->model) ? self->model->base.vehicle.speed : 0;
    self->speed[0] = isnan(slowest) ? own : slowest;
    self->speed[1] = isnan(fastest) ? own : fastest;
    if (!(self->speed[0] >= 0 && self->speed[0] <= self->speed[1] && self->speed[1] <= 1000))
        return ld_fail(
            error, LD_ERR_INPUT,
            "found speeds from %g m/s to %g m/s, expected a rising range from 0 to 1000 m/s",
            self->speed[0], self->speed[1]);
    // what stands has other tyres than what rolls
    if (self->speed[0] == 0)
        self->speed[0] = 0.5 * self->speed[1];
    return LD_OK;
}

static ld_status build(ld_response *self, ld_error *error)
{
    ld_status status = make_end(self, 0, error);
    if (!status && self->speed[1] > self->speed[0])
        status = make_end(self, 1, error);
    if (!status)
        status = plant_make_room(&self->now, &self->end[0], error);
    if (!status && hessenberg_make(&self->solver, self->now.states))
        status = no_memory(error);
    if (!status)
        status = list_inputs(self, error);
    if (status)
        return status;
    size_t size = (size_t)self->now.states * (size_t)self->now.inputs;
    self->B = calloc(3 * size + 1, sizeof *self->B);
    if (!self->B)
        return no_memory(error);
    self->B_rate = self->B + size;
    self->B_bend = self->B_rate + size;
    return LD_OK;
}

ld_status response_create(const ld_model *model, double slowest, double fastest, bool rubbing,
                          ld_response **response, ld_error *error)
{
    *response = NULL;
    if (!model_has_launcher(model))
        return ld_fail(error, LD_ERR_INPUT,
                       "a scenario of flight only has no launcher and no response");
    ld_response *self = calloc(1, sizeof *self);
    if (!self)
        return no_memory(error);
    self->model = model;
    self->rubbing = rubbing;
    self->speed_now = NAN;
    ld_status status = set_speeds(self, slowest, fastest, error);
    if (!status)
        status = build(self, error);
    if (status)
        ld_response_free(self);
    else
        *response = self;
    return status;
}

ld_status ld_response_create(const ld_model *model, double slowest, double fastest,
                             ld_response **response, ld_error *error)
{
    return response_create(model, slowest, fastest, true, response, error);
}

void ld_response_free(ld_response *self)
{
    if (!self)
        return;
    for (int end = 0; end < 2; end++)
        plant_free(&self->end[end]);
    for (int i = 0; i < HINGES; i++)
        plant_free(&self->viscous[i]);
    plant_free(&self->now);
    hessenberg_free(&self->solver);
    quantity_columns_free(&self->inputs);
    ld_simulation_free(self->simulation);
    free(self->input);
    free(self->line);
    free(self->B);
    free(self->chosen);
    free(self->C);
    free(self);
}

// ---- names ----

size_t ld_response_inputs(const ld_response *response, const ld_column **inputs)
{
    *inputs = response->input;
    return response->input_count;
}

size_t ld_response_columns(const ld_response *response, const ld_column **columns)
{
    return ld_simulation_columns(response->simulation, columns);
}

static ld_status find(const ld_column *columns, size_t count, const char *what, const char *name,
                      int *found, ld_error *error)
{
    char now[LD_MAX_QUANTITY];
    name_suggestion best = suggestion_begin(name);
    if (!ld_current_name(name, now, sizeof now))
        now[0] = '\0';
    for (size_t i = 0; i < count; i++) {
        if (strcmp(columns[i].name, name) == 0 || strcmp(columns[i].name, now) == 0) {
            *found = (int)i;
            return LD_OK;
        }
        suggestion_offer(&best, columns[i].name);
    }
    if (best.name)
        return ld_fail(error, LD_ERR_INPUT, "unknown %s \"%s\", did you mean \"%s\"?", what, name,
                       best.name);
    return ld_fail(error, LD_ERR_INPUT, "unknown %s \"%s\"", what, name);
}

ld_status ld_response_choose(ld_response *self, const char *const *names, size_t count,
                             ld_error *error)
{
    const ld_column *columns;
    size_t all = ld_response_columns(self, &columns);
    int *chosen = malloc((count + 1) * sizeof *chosen);
    double *C = malloc((count * (size_t)self->now.states + 1) * sizeof *C);
    ld_status status = chosen && C ? LD_OK : no_memory(error);
    for (size_t i = 0; i < count && !status; i++)
        status = find(columns, all, "quantity", names[i], &chosen[i], error);
    if (status) {
        free(chosen);
        free(C);
        return status;
    }
    free(self->chosen);
    free(self->C);
    self->chosen = chosen;
    self->C = C;
    self->chosen_count = (int)count;
    self->speed_now = NAN;
    return LD_OK;
}

// ---- at a speed ----

// X^-1 B by columns.
static void reduce_inputs(const hessenberg *solver, int count, const double *B, double *to)
{
    int n = solver->n;
    for (int i = 0; i < count; i++)
        for (int k = 0; k < n; k++) {
            double sum = 0;
            for (int j = 0; j < n; j++)
                sum += solver->inverse[j + n * k] * B[j + n * i];
            to[k + n * i] = sum;
        }
}

// C X, the rows chosen.
static void reduce_outputs(ld_response *self)
{
    int n = self->now.states, rows = self->now.outputs;
    for (int i = 0; i < self->chosen_count; i++)
        for (int k = 0; k < n; k++) {
            double sum = 0;
            for (int j = 0; j < n; j++)
                sum += self->now.C[self->chosen[i] + rows * j] * self->solver.X[j + n * k];
            self->C[k + n * i] = sum;
        }
}

// The plant at a speed, with what its hinges' friction amounts to.
static ld_status set_plant(ld_response *self, double speed, ld_error *error)
{
    const double *range = self->speed;
    bool single = range[0] == range[1];
    double share = single ? 0 : (speed - range[0]) / (range[1] - range[0]);
    plant_between(&self->end[0], &self->end[single ? 0 : 1], share, &self->now);
    for (int i = 0; i < HINGES && self->hinges_have_friction; i++)
        if (self->viscous[i].states)
            plant_add(&self->now, self->friction[i], &self->viscous[i]);
    if (hessenberg_reduce(&self->solver, self->now.A))
        return ld_fail(error, LD_ERR_NUMERIC, "the linearised equations cannot be reduced");
    reduce_inputs(&self->solver, self->now.inputs, self->now.B, self->B);
    reduce_inputs(&self->solver, self->now.inputs, self->now.B_rate, self->B_rate);
    if (self->now.bends)
        reduce_inputs(&self->solver, self->now.inputs, self->now.B_bend, self->B_bend);
    reduce_outputs(self);
    self->speed_now = speed;
    return LD_OK;
}

static ld_status find_friction(ld_response *self, double speed, ld_error *error);

static ld_status go_at(ld_response *self, double speed, ld_error *error)
{
    const double *range = self->speed;
    if (!model_has_vehicle(self->model))
        speed = 0;
    if (speed == self->speed_now)
        return LD_OK;
    bool single = range[0] == range[1];
    if (!(single ? speed == range[0] : speed > 0 && speed <= range[1]))
        return ld_fail(error, LD_ERR_INPUT,
                       "a speed of %g m/s is not within the range that was linearised", speed);
    if (self->hinges_have_friction && speed > 0)
        return find_friction(self, speed, error);
    return set_plant(self, speed, error);
}

// share e^(i omega along/speed).
static ld_phasor turn_of(const ld_response *self, const excitation *by, int k, double omega)
{
    double angle = by->along[k] == 0 ? 0 : omega * by->along[k] / self->speed_now;
    return (ld_phasor){by->share[k] * cos(angle), by->share[k] * sin(angle)};
}

// (B + i omega B' - omega^2 B") u.
static void excite(const ld_response *self, const excitation *by, double omega, double *z)
{
    int n = self->now.states;
    memset(z, 0, 2 * (size_t)n * sizeof *z);
    for (int k = 0; k < by->count; k++) {
        int first = n * by->input[k];
        const double *B = self->B + first, *B_rate = self->B_rate + first,
                     *B_bend = self->B_bend + first;
        ld_phasor turn = turn_of(self, by, k, omega);
        for (int i = 0; i < n; i++) {
            double a = B[i] - omega * omega * B_bend[i], b = omega * B_rate[i];
            z[i] += a * turn.real - b * turn.imaginary;
            z[n + i] += a * turn.imaginary + b * turn.real;
        }
    }
}

// C x + (D + i omega D' - omega^2 D") u.
static void output_phasors(const ld_response *self, const excitation *by, double omega,
                           const double *z, ld_phasor *y)
{
    int n = self->now.states, rows = self->now.outputs;
    for (int i = 0; i < self->chosen_count; i++) {
        const double *C = self->C + n * i;
        y[i] = (ld_phasor){0, 0};
        for (int j = 0; j < n; j++) {
            y[i].real += C[j] * z[j];
            y[i].imaginary += C[j] * z[n + j];
        }
        for (int k = 0; k < by->count; k++) {
            int at = self->chosen[i] + rows * by->input[k];
            double d = self->now.D[at] - omega * omega * self->now.D_bend[at];
            double d_rate = omega * self->now.D_rate[at];
            ld_phasor turn = turn_of(self, by, k, omega);
            y[i].real += d * turn.real - d_rate * turn.imaginary;
            y[i].imaginary += d * turn.imaginary + d_rate * turn.real;
        }
    }
}

// What excitations make of the states, z [excitations][2][states], and what the columns chosen
// answer, y [excitations][chosen].
typedef struct answers {
    double *z;
    ld_phasor *y;
} answers;

// To each of `count` excitations.
static ld_status respond(ld_response *self, const excitation *by, int count, double frequency,
                         const answers *to, ld_error *error)
{
    int n = self->now.states;
    double *z = to->z;
    double omega = TWO_PI * frequency;
    if (!(frequency > 0 && isfinite(frequency)))
        return ld_fail(error, LD_ERR_INPUT, "found %g Hz, expected a frequency above 0", frequency);
    for (int i = 0; i < count; i++)
        excite(self, &by[i], omega, z + 2 * n * i);
    if (hessenberg_solve(&self->solver, omega, count, z))
        return ld_fail(error, LD_ERR_NUMERIC,
                       "at %g Hz the response of an undamped motion is unbounded", frequency);
    for (int i = 0; i < count; i++)
        output_phasors(self, &by[i], omega, z + 2 * n * i, to->y + self->chosen_count * i);
    return LD_OK;
}

// Room for those to two excitations; its z is to be freed.
static ld_status make_room(const ld_response *self, answers *room, ld_error *error)
{
    size_t n = (size_t)self->now.states, count = (size_t)self->chosen_count;
    room->z = malloc((4 * n + 4 * count) * sizeof *room->z);
    room->y = (ld_phasor *)(void *)(room->z + 4 * n);
    return room->z ? LD_OK : no_memory(error);
}

// ---- what is asked ----

ld_status response_check_road(const ld_response *self, double speed, ld_error *error)
{
    if (!model_has_vehicle(self->model))
        return ld_fail(error, LD_ERR_INPUT, "there is no road: the base is not a vehicle");
    return speed > 0
               ? LD_OK
               : ld_fail(error, LD_ERR_INPUT, "the response to the road requires a speed above 0");
}

// What an input is among those of the plant.
static ld_status excitation_of(const ld_response *self, const char *name, double speed,
                               excitation *by, ld_error *error)
{
    int found;
    ld_status status = find(self->input, self->input_count, "input", name, &found, error);
    int first = model_has_vehicle(self->model) ? ROAD_INPUTS : 0;
    if (status)
        return status;
    if (found < first) {
        *by = self->road[found];
        return response_check_road(self, speed, error);
    }
    *by = (excitation){.count = 1, .input = {found - first}, .share = {1}};
    return LD_OK;
}

// NOLINTNEXTLINE(readability-function-size): public
ld_status ld_response_gain(ld_response *self, double speed, const char *input,
                           const double *frequency, size_t count, ld_phasor *gain, ld_error *error)
{
    answers room;
    excitation by;
    ld_status status = excitation_of(self, input, speed, &by, error);
    if (!status)
        status = go_at(self, speed, error);
    if (status || (status = make_room(self, &room, error)))
        return status;
    for (size_t i = 0; i < count && !status; i++) {
        const answers to = {room.z, gain + i * (size_t)self->chosen_count};
        status = respond(self, &by, 1, frequency[i], &to, error);
    }
    free(room.z);
    return status;
}

// At the speed on its road, with room for what is answered.
static ld_status continue_on_road(ld_response *self, double speed, answers *room, ld_error *error)
{
    ld_status status = response_check_road(self, speed, error);
    if (!status)
        status = go_at(self, speed, error);
    return status ? status : make_room(self, room, error);
}

ld_status response_states(ld_response *self, double speed, double frequency, ld_phasor *state,
                          ld_error *error)
{
    int n = self->now.states;
    answers room;
    ld_status status = continue_on_road(self, speed, &room, error);
    if (status)
        return status;
    status = respond(self, &self->road[ROAD_OF_LEFT], 2, frequency, &room, error);
    for (int k = 0; k < 2 && !status; k++)
        for (int i = 0; i < n; i++) {
            ld_phasor sum = {0, 0};
            for (int j = 0; j < n; j++) {
                sum.real += self->solver.X[i + n * j] * room.z[2 * n * k + j];
                sum.imaginary += self->solver.X[i + n * j] * room.z[2 * n * k + n + j];
            }
            state[n * k + i] = sum;
        }
    free(room.z);
    return status;
}

// Mean squares of the columns chosen per mean square of a road's line: |L + shared R|^2 + (1 -
// shared^2) |R|^2, L and R what they answer to the tracks.
static ld_status square_on_road(ld_response *self, double frequency, double shared,
                                const answers *room, double *square, ld_error *error)
{
    const ld_phasor *y = room->y;
    bool same = shared == 1;
    int count = self->chosen_count;
    ld_status status = respond(self, &self->road[same ? ROAD_OF_BOTH : ROAD_OF_LEFT], same ? 1 : 2,
                               frequency, room, error);
    for (int i = 0; i < count && !status; i++) {
        ld_phasor left = y[i], right = same ? (ld_phasor){0, 0} : y[count + i];
        square[i] = left.real * left.real + left.imaginary * left.imaginary +
                    right.real * right.real + right.imaginary * right.imaginary +
                    2 * shared * (left.real * right.real + left.imaginary * right.imaginary);
    }
    return status;
}

ld_status ld_response_on_road(ld_response *self, double speed, double *rms, double *strongest,
                              ld_error *error)
{
    size_t count = (size_t)self->chosen_count;
    answers room;
    ld_status status = continue_on_road(self, speed, &room, error);
    if (status)
        return status;
    double *square = calloc(2 * count + 1, sizeof *square), *most = square + count;
    if (!square)
        status = no_memory(error);
    memset(rms, 0, count * sizeof *rms);
    for (size_t i = 0; i < count && strongest; i++)
        strongest[i] = NAN;
    for (size_t k = 0; k < self->line_count && !status; k++) {
        const road_line *line = &self->line[k];
        double frequency = line->n * speed;
        status = square_on_road(self, frequency, line->shared, &room, square, error);
        for (size_t i = 0; i < count && !status; i++) {
            rms[i] += line->square * square[i];
            if (strongest && line->square * square[i] > most[i]) {
                most[i] = line->square * square[i];
                strongest[i] = frequency;
            }
        }
    }
    for (size_t i = 0; i < count; i++)
        rms[i] = sqrt(rms[i]);
    free(square);
    free(room.z);
    return status;
}

// ---- hinges that rub ----

// The mean of d/db b/sqrt(b^2 + r^2) over a normal rate b of deviation s, times r: by t = tanh u, b
// = r sinh u.
static double mean_slope(double ratio)
{
    enum { STEPS = 400 };
    double sum = 0;
    if (!(ratio > 1e-3))
        return 1;
    for (int i = 0; i < STEPS; i++) {
        double t = (i + 0.5) / STEPS;
        sum += exp(-t * t / (2 * ratio * ratio * (1 - t * t)));
    }
    return 2 * sum / (STEPS * ratio * sqrt(TWO_PI));
}

static const ld_hinge_friction *friction_of(const ld_response *self, int hinge)
{
    return &model_hinge(self->model, hinge)->friction;
}

// How fast the hinges move on the road, root mean square.
static ld_status find_rates(ld_response *self, double speed, double rate[HINGES], ld_error *error)
{
    double square[HINGES];
    answers room;
    ld_status status = make_room(self, &room, error);
    int hinges = model_hinge_count(self->model);
    for (int i = 0; i < hinges; i++)
        rate[i] = 0;
    for (size_t k = 0; k < self->line_count && !status; k++) {
        status = square_on_road(self, self->line[k].n * speed, self->line[k].shared, &room, square,
                                error);
        for (int i = 0; i < hinges && !status; i++)
            rate[i] += self->line[k].square * square[i];
    }
    for (int i = 0; i < hinges; i++)
        rate[i] = sqrt(rate[i]);
    free(room.z);
    return status;
}

// Each hinge's friction amounts to a viscous one, the mean of its slope over the rates that the
// road gives the hinge, which depend on it.
static ld_status iterate_friction(ld_response *self, double speed, ld_error *error)
{
    enum { MOST = 40 };
    double off = 1;
    int hinges = model_hinge_count(self->model);
    ld_status status = LD_OK;
    for (int i = 0; i < hinges; i++)
        self->friction[i] = 0;
    for (int k = 0; k < MOST && off > 1e-4 && !status; k++) {
        double rate[HINGES];
        status = set_plant(self, speed, error);
        if (!status)
            status = find_rates(self, speed, rate, error);
        off = 0;
        for (int i = 0; i < hinges && !status; i++) {
            const ld_hinge_friction *given = friction_of(self, i);
            double slope = given->coulomb / given->rate;
            double next = slope * mean_slope(rate[i] / given->rate);
            off = fmax(off, slope > 0 ? fabs(next - self->friction[i]) / slope : 0);
            self->friction[i] = slope > 0 ? next : 0;
        }
    }
    return status;
}

static ld_status find_friction(ld_response *self, double speed, ld_error *error)
{
    static const char *const rates[HINGES] = {"azimuth.rate", "elevation.rate"};
    int *chosen = self->chosen, count = self->chosen_count;
    double *C = self->C;
    self->chosen = NULL;
    self->C = NULL;
    size_t hinges = (size_t)model_hinge_count(self->model);
    ld_status status = ld_response_choose(self, rates + HINGES - hinges, hinges, error);
    if (!status)
        status = iterate_friction(self, speed, error);
    free(self->chosen);
    free(self->C);
    self->chosen = chosen;
    self->chosen_count = count;
    self->C = C;
    return status ? status : set_plant(self, speed, error);
}

// What a unit of viscous friction in a hinge adds, from as much as its own is at most.
static ld_status make_viscous(ld_response *self, int hinge, ld_error *error)
{
    const ld_hinge_friction *given = friction_of(self, hinge);
    ld_simulation *simulation = NULL;
    ld_model *model = malloc(sizeof *model);
    if (!model)
        return no_memory(error);
    double most = given->coulomb / given->rate;
    *model = self->at[0];
    ld_platform *platform = &model->platform;
    bool azimuth = model_hinge(model, hinge) == &platform->azimuth;
    (azimuth ? &platform->azimuth : &platform->elevation)->friction.viscous += most;
    plant *to = &self->viscous[hinge];
    ld_status status = simulation_renew(&simulation, model, error);
    if (!status)
        status = plant_make(to, simulation, self->rubbing, &self->inputs, error);
    if (!status) {
        plant_add(to, -1, &self->end[0]);
        plant_add(to, 1 / most - 1, to);
    }
    ld_simulation_free(simulation);
    free(model);
    return status;
}

void ld_response_watch(ld_response *self, const ld_watch *watch)
{
    self->watch = watch;
}

bool response_continues(const ld_response *self)
{
    return !self->watch || self->watch->go_on(self->watch->self);
}

ld_status ld_response_friction(ld_response *self, bool friction, ld_error *error)
{
    ld_status status = LD_OK;
    for (int i = 0; i < model_hinge_count(self->model) && friction && !status; i++)
        if (friction_of(self, i)->coulomb > 0 && !self->viscous[i].A)
            status = make_viscous(self, i, error);
    self->hinges_have_friction = friction && !status;
    self->speed_now = NAN;
    return status;
}

ld_status ld_response_density(ld_response *self, double speed, const double *frequency,
                              size_t count, double *density, ld_error *error)
{
    answers room;
    ld_status status = continue_on_road(self, speed, &room, error);
    if (status)
        return status;
    for (size_t k = 0; k < count && !status; k++) {
        double shared, *to = density + k * (size_t)self->chosen_count;
        double height =
            road_density(&self->model->base.vehicle.road, frequency[k] / speed, &shared);
        status = square_on_road(self, frequency[k], shared, &room, to, error);
        for (int i = 0; i < self->chosen_count && !status; i++)
            to[i] *= height / speed;
    }
    free(room.z);
    return status;
}

// ---- an input that is random ----

// Points of Gauss and Legendre's rule in [0, 1], and its weights.
enum { GAUSS = 3 };
static const double gauss_at[GAUSS] = {0.11270166537925831, 0.5, 0.88729833462074169};
static const double gauss_weight[GAUSS] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
// Steps of the integral over the frequency, of the frequency itself and of the last one: motions
// damped by more than a thousandth are met many times.
static const double STEP = 1e-3, LEAST_STEP = 2e-5;

static ld_status check_density(const double *frequency, const double *density, size_t points,
                               ld_error *error)
{
    bool good = points >= 2 && frequency[0] >= 0;
    for (size_t i = 0; i < points && good; i++)
        good = isfinite(frequency[i]) && isfinite(density[i]) && density[i] >= 0 &&
               (i == 0 || frequency[i] > frequency[i - 1]);
    return good ? LD_OK
                : ld_fail(error, LD_ERR_INPUT,
                          "a spectral density requires at least two points, with rising "
                          "frequencies and no value below 0");
}

// What the columns' mean squares have of the frequencies around one.
typedef struct driven {
    ld_response *response;
    const excitation *by;
    answers room;
    double *square, *most, *strongest; // [columns chosen]
} driven;

static ld_status add_band(driven *self, double frequency, double density, double width,
                          ld_error *error)
{
    ld_status status = respond(self->response, self->by, 1, frequency, &self->room, error);
    const ld_phasor *y = self->room.y;
    for (int i = 0; i < self->response->chosen_count && !status; i++) {
        double gain = y[i].real * y[i].real + y[i].imaginary * y[i].imaginary;
        self->square[i] += width * density * gain;
        if (density * gain > self->most[i]) {
            self->most[i] = density * gain;
            self->strongest[i] = frequency;
        }
    }
    return status;
}

// Between two points of the density, which is a straight line there.
static ld_status add_stretch(driven *self, const double f[2], const double density[2], double last,
                             ld_error *error)
{
    ld_status status = LD_OK;
    for (double from = f[0]; from < f[1] && !status;) {
        double to = fmin(from + fmax(STEP * from, LEAST_STEP * last), f[1]);
        for (int k = 0; k < GAUSS && !status; k++) {
            double at = from + gauss_at[k] * (to - from), share = (at - f[0]) / (f[1] - f[0]);
            double here = density[0] + share * (density[1] - density[0]);
            status = add_band(self, at, here, gauss_weight[k] * (to - from), error);
        }
        from = to;
    }
    return status;
}

// NOLINTNEXTLINE(readability-function-size): public
ld_status ld_response_random(ld_response *self, double speed, const char *input,
                             const double *frequency, const double *density, size_t points,
                             double *rms, double *strongest, ld_error *error)
{
    size_t count = (size_t)self->chosen_count;
    excitation by;
    driven sum = {.response = self, .by = &by, .square = rms, .strongest = strongest};
    ld_status status = check_density(frequency, density, points, error);
    if (!status)
        status = excitation_of(self, input, speed, &by, error);
    if (!status)
        status = go_at(self, speed, error);
    if (status || (status = make_room(self, &sum.room, error)))
        return status;
    sum.most = calloc(count + 1, sizeof *sum.most);
    if (!sum.most)
        status = no_memory(error);
    for (size_t i = 0; i < count; i++) {
        rms[i] = 0;
        strongest[i] = NAN;
    }
    for (size_t k = 0; k + 1 < points && !status; k++)
        status = add_stretch(&sum, frequency + k, density + k, frequency[points - 1], error);
    for (size_t i = 0; i < count; i++)
        rms[i] = sqrt(rms[i]);
    free(sum.most);
    free(sum.room.z);
    return status;
}
