// Central differences along a direction of the knowns, by steps each a quarter of the former,
// extrapolated to step zero (C. J. F. Ridders, Adv. Eng. Software 4 (1982) 75-76). Each unknown
// takes the step that is best for it: contacts are pressed in by 1e-9 to 1e-5 m, and rounding
// counts differently for each. The difference of the slopes to either side is extrapolated
// likewise: it is zero but at a corner.
#include "fmu/fmu_derivatives.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fmu/fmu_instance_own.h"

enum { LEVELS = 9 };
static const double FIRST_STEP = 1e-3; // of the nominals
static const double RATIO = 4;         // of a step to the next
// Errors relative to a derivative, or to its scale: one that suffices to end; the largest that is
// not reported; the largest at all, where slopes to either side differ as little as that.
static const double GOOD = 1e-9, QUIET = 1e-6, ALLOWED = 1e-2;

typedef struct differences {
    fmu_instance *self;
    const fmu_jacobian *of; // by places among the variables
    // of all variables, by place: along the direction; as they were set
    double *direction, *number;
    bool *changed;
    double t, x[LD_MAX_STATES]; // where an importer that takes the steps is
    // [unknowns]: at the present, a step further, a step back; what they change by along all
    // states and inputs at once, by their nominals; the best derivative yet, and its error
    double *middle, *plus, *minus, *scale, *best, *error;
    // [unknowns][LEVELS]: slope and difference of slopes by the last step, by how many times they
    // are extrapolated
    double *slope, *bend;
} differences;

// ---- at a point

// The knowns are `step` further along the direction than they were.
static void move_to(const differences *d, double step)
{
    fmu_instance *self = d->self;
    memcpy(self->exchange.x, d->x, sizeof self->exchange.x);
    self->exchange.t = d->t;
    for (size_t i = 0; i < self->variables.count; i++) {
        const fmu_variable *v = &self->variables.item[i];
        double by = step * d->direction[i];
        if (v->group == FMU_TIME)
            self->exchange.t += by;
        else if (v->group == FMU_STATE)
            self->exchange.x[v->index] += by;
        else if (v->group == FMU_PART_INPUT) {
            self->number[i] = d->number[i] + by;
            self->changed[i] = d->changed[i] || by != 0;
        }
    }
    self->exchange.moved = self->inputs_set = true;
    if (!self->going)
        fmu_end_run(self);
}

// Numbers that are reported once, by what has happened, change with nothing.
static ld_status find_unknowns(const differences *d, double step, double *value, ld_error *error)
{
    double rate[LD_MAX_STATES];
    bool known = false;
    move_to(d, step);
    ld_status status = fmu_begin(d->self, error);
    if (!status)
        status = fmu_place(d->self, error);
    for (size_t i = 0; i < d->of->unknowns && !status; i++) {
        const fmu_variable *v = &d->self->variables.item[d->of->unknown[i]];
        if (v->group == FMU_RATE) {
            status = known ? LD_OK : fmu_rates(d->self, rate, error);
            known = true;
            value[i] = status ? NAN : rate[v->index];
        } else if (v->group == FMU_RESULT)
            value[i] = 0;
        else
            status = fmu_get_number(d->self, v->reference, FMU_REAL, &value[i], error);
    }
    return status;
}

static ld_status find_sides(const differences *d, double step, ld_error *error)
{
    ld_status status = find_unknowns(d, step, d->plus, error);
    return status ? status : find_unknowns(d, -step, d->minus, error);
}

// ---- scales

// Changes that count as much as each other's; those of works feed their sums alone.
static void find_nominals(const differences *d, double *nominal)
{
    const fmu_instance *self = d->self;
    const double time = 0.01, wrench = 1e3, place = 0.01, motion = 1; // [s, N, N m, m, 1, m/s]
    double states[LD_MAX_STATES] = {0};
    if (self->exchange.is && self->run)
        self->variables.runner->exchanging->nominals(self->run, states);
    for (size_t i = 0; i < self->variables.count; i++) {
        const fmu_variable *v = &self->variables.item[i];
        nominal[i] = v->group == FMU_TIME                                        ? time
                     : v->group == FMU_STATE                                     ? states[v->index]
                     : v->group != FMU_PART_INPUT                                ? 0
                     : self->variables.runner->input_count == FMU_WRENCH_NUMBERS ? wrench
                     : v->index < 7                                              ? place
                                                                                 : motion;
    }
}

// The most along some directions of all at once, in signs of no order.
static void find_scales(const differences *d, const double *nominal)
{
    enum { DIRECTIONS = 3 };
    const double work = 1e6;
    ld_error unsolved;
    for (int k = 0; k < DIRECTIONS; k++) {
        for (size_t i = 0; i < d->self->variables.count; i++)
            d->direction[i] = nominal[i] < work && d->self->variables.item[i].group != FMU_TIME
                                  ? nominal[i] * sin((double)(i * i) + k)
                                  : 0;
        if (find_sides(d, FIRST_STEP, &unsolved))
            return;
        for (size_t i = 0; i < d->of->unknowns; i++) {
            double change = fmax(fabs(d->plus[i] - d->middle[i]), fabs(d->minus[i] - d->middle[i]));
            d->scale[i] = fmax(d->scale[i], change / FIRST_STEP);
        }
    }
}

// ---- differences

// Takes in the value of the next step: row[m] is that extrapolated m times, each time without
// another power of the step, which are `first`, `first` + 2, ...
static void extrapolate(double *row, int level, int first, double value)
{
    double factor = first == 1 ? RATIO : RATIO * RATIO;
    for (int m = 0; m <= level; m++, factor *= RATIO * RATIO) {
        double former = row[m];
        row[m] = value;
        value += (value - former) / (factor - 1);
    }
}

static void take_step(const differences *d, int level, double step)
{
    for (size_t i = 0; i < d->of->unknowns; i++) {
        double *slope = d->slope + LEVELS * i, *bend = d->bend + LEVELS * i, former[LEVELS];
        memcpy(former, slope, sizeof former);
        extrapolate(slope, level, 2, (d->plus[i] - d->minus[i]) / (2 * step));
        extrapolate(bend, level, 1, (d->plus[i] - 2 * d->middle[i] + d->minus[i]) / step);
        for (int m = 1; m <= level; m++) {
            double off = fmax(fabs(slope[m] - slope[m - 1]), fabs(slope[m] - former[m - 1]));
            off = fmax(off, fabs(bend[m]));
            if (off < d->error[i]) {
                d->error[i] = off;
                d->best[i] = slope[m];
            }
        }
    }
}

// By how much of its scale a derivative is uncertain. Of a force or moment that is nothing but
// rounding, as in a joint that is free, the scale is at least `least`.
static double uncertainty(const differences *d, size_t i)
{
    const double least = 1e3; // [N, N m] by a nominal
    double scale = fmax(fabs(d->best[i]), d->scale[i]);
    const char *unit = d->self->variables.item[d->of->unknown[i]].unit;
    if (strcmp(unit, "N") == 0 || strcmp(unit, "N.m") == 0)
        scale = fmax(scale, least);
    return isnan(d->middle[i]) || d->error[i] == 0 ? 0 : d->error[i] / scale;
}

// The unknown whose derivative is the most uncertain, by more than this; past all: none is.
static size_t find_worst(const differences *d, double share)
{
    size_t worst = d->of->unknowns;
    for (size_t i = 0; i < d->of->unknowns; i++) {
        double off = uncertainty(d, i);
        if (off <= share)
            continue;
        share = off;
        worst = i;
    }
    return worst;
}

// What became of the worst unknown.
static ld_status judge(const differences *d, bool *bent, ld_error *error)
{
    size_t worst = find_worst(d, ALLOWED);
    if (worst < d->of->unknowns)
        return ld_fail(error, LD_ERR_NUMERIC,
                       "%s has no directional derivative here: its slopes to either side differ, "
                       "or it bends too sharply, as where a contact begins",
                       d->self->variables.item[d->of->unknown[worst]].name);
    worst = find_worst(d, QUIET);
    *bent = worst < d->of->unknowns;
    if (*bent)
        ld_fail(error, LD_OK,
                "%s: the directional derivative is uncertain by %.1e of its scale, as where the "
                "slopes to either side differ; found their mean",
                d->self->variables.item[d->of->unknown[worst]].name, uncertainty(d, worst));
    return LD_OK;
}

static ld_status find_derivatives(const differences *d, bool *bent, ld_error *error)
{
    double step = FIRST_STEP;
    for (int level = 0; level < LEVELS; level++, step /= RATIO) {
        ld_status status = find_sides(d, step, error);
        if (status)
            return status;
        take_step(d, level, step);
        if (level >= 2 && find_worst(d, GOOD) == d->of->unknowns)
            break;
    }
    return judge(d, bent, error);
}

// ---- along one direction

// Scaled to the largest nominal; returns by how much. 0: there is no direction.
static double set_direction(const differences *d, const double *seed, const double *nominal)
{
    double most = 0;
    memset(d->direction, 0, d->self->variables.count * sizeof *d->direction);
    for (size_t k = 0; k < d->of->knowns; k++)
        d->direction[d->of->known[k]] += seed[k];
    for (size_t k = 0; k < d->of->knowns; k++)
        most = fmax(most, fabs(d->direction[d->of->known[k]]) / nominal[d->of->known[k]]);
    for (size_t i = 0; i < d->self->variables.count && most > 0; i++)
        d->direction[i] /= most;
    return most;
}

static ld_status differentiate(const differences *d, const double *seed, double *value, bool *bent,
                               ld_error *error)
{
    double *nominal = d->number + d->self->variables.count;
    ld_status status = find_unknowns(d, 0, d->middle, error);
    if (status)
        return status;
    find_nominals(d, nominal);
    find_scales(d, nominal);
    double size = set_direction(d, seed, nominal);
    for (size_t i = 0; i < d->of->unknowns; i++)
        d->error[i] = INFINITY;
    if (size > 0)
        status = find_derivatives(d, bent, error);
    for (size_t i = 0; i < d->of->unknowns && !status; i++)
        value[i] = isnan(d->middle[i]) ? NAN : size * d->best[i];
    return status;
}

// The place of a known or unknown among the variables.
static ld_status find_place(const fmu_instance *self, unsigned reference, bool is_known,
                            unsigned *place, ld_error *error)
{
    *place = (unsigned)fmu_variables_find(&self->variables, reference);
    if (*place >= self->variables.count)
        return ld_fail(error, LD_ERR_INPUT, "variable %u does not exist", reference);
    const fmu_variable *v = &self->variables.item[*place];
    bool follows = (fmu_is_output(v) || fmu_is_local(v)) && fmu_type_of(v) == FMU_REAL,
         placed =
             self->exchange.is && self->going && (v->group == FMU_STATE || v->group == FMU_TIME);
    if (is_known ? v->group == FMU_PART_INPUT || placed : follows)
        return LD_OK;
    return ld_fail(error, LD_ERR_INPUT,
                   is_known ? "%s: expected a continuous input%s" : "%s: expected an output%s",
                   v->name,
                   !self->exchange.is ? ""
                   : is_known         ? ", or, once the run has begun, a state or time"
                                      : ", a rate of a state or an event indicator");
}

// The same by places, of which `place` has room for all.
static ld_status find_places(const fmu_instance *self, const fmu_jacobian *of, unsigned *place,
                             fmu_jacobian *found, ld_error *error)
{
    ld_status status = LD_OK;
    *found = (fmu_jacobian){place, of->unknowns, place + of->unknowns, of->knowns};
    for (size_t i = 0; i < of->unknowns && !status; i++)
        status = find_place(self, of->unknown[i], false, &place[i], error);
    for (size_t k = 0; k < of->knowns && !status; k++)
        status = find_place(self, of->known[k], true, &place[of->unknowns + k], error);
    return status;
}

// All arrays are one block, which begins at `direction`.
static bool make_room(differences *d)
{
    size_t all = d->self->variables.count, unknowns = d->of->unknowns;
    double *at = calloc(4 * all + (6 + 2 * LEVELS) * unknowns + 1, sizeof *at);
    d->direction = at;
    if (!at)
        return false;
    d->number = at + all; // nominals follow them
    d->changed = (bool *)(at + 3 * all);
    at += 4 * all;
    d->middle = at;
    d->plus = at + unknowns;
    d->minus = at + 2 * unknowns;
    d->scale = at + 3 * unknowns;
    d->best = at + 4 * unknowns;
    d->error = at + 5 * unknowns;
    d->slope = at + 6 * unknowns;
    d->bend = at + (6 + LEVELS) * unknowns;
    return true;
}

// Inputs change a run for co-simulation, which is put back; one for model exchange is only placed.
static ld_status differentiate_aside(differences *d, const double *seed, double *value, bool *bent,
                                     ld_error *error)
{
    fmu_instance *self = d->self;
    fmu_state *before = NULL;
    bool inputs_set = self->inputs_set, put_back = self->going && !self->exchange.is;
    ld_error failure;
    ld_status status = put_back ? fmu_save(self, &before, error) : LD_OK;
    if (status)
        return status;
    memcpy(d->number, self->number, self->variables.count * sizeof *d->number);
    memcpy(d->changed, self->changed, self->variables.count * sizeof *d->changed);
    memcpy(d->x, self->exchange.x, sizeof d->x);
    d->t = self->exchange.t;
    status = differentiate(d, seed, value, bent, error);
    move_to(d, 0);
    self->inputs_set = inputs_set;
    if (put_back && fmu_load(self, before, &failure)) {
        *error = failure;
        status = failure.status;
    }
    free(before);
    return status;
}

ld_status fmu_derivative_along(fmu_instance *self, const fmu_jacobian *of, const double *seed,
                               double *value, bool *bent, ld_error *error)
{
    fmu_jacobian places;
    differences d = {.self = self, .of = &places};
    double sum = 0;
    *bent = false;
    unsigned *place = calloc(of->unknowns + of->knowns + 1, sizeof *place);
    ld_status status = place ? find_places(self, of, place, &places, error)
                             : ld_fail(error, LD_ERR_MEMORY, "no memory");
    for (size_t k = 0; k < of->knowns; k++)
        sum += 0 * seed[k];
    if (!status && sum != 0)
        status = ld_fail(error, LD_ERR_INPUT, "a seed is not a number");
    if (!status && make_room(&d))
        status = differentiate_aside(&d, seed, value, bent, error);
    else if (!status)
        status = ld_fail(error, LD_ERR_MEMORY, "no memory");
    free(d.direction);
    free(place);
    return status;
}

// Known by known.
ld_status fmu_derivative_adjoint(fmu_instance *self, const fmu_jacobian *of, const double *seed,
                                 double *value, bool *bent, ld_error *error)
{
    ld_error of_column;
    const double one = 1;
    double *column = calloc(of->unknowns + 1, sizeof *column);
    *bent = false;
    ld_status status = column ? LD_OK : ld_fail(error, LD_ERR_MEMORY, "no memory");
    for (size_t k = 0; k < of->knowns && !status; k++) {
        const fmu_jacobian along = {of->unknown, of->unknowns, of->known + k, 1};
        bool column_bent;
        status = fmu_derivative_along(self, &along, &one, column, &column_bent, &of_column);
        if (status || column_bent)
            *error = of_column;
        *bent |= column_bent;
        value[k] = 0;
        for (size_t i = 0; i < of->unknowns && !status; i++)
            value[k] += seed[i] * column[i];
    }
    free(column);
    return status;
}
