#include "fit/minimum.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "math/matrices/lapack.h"

// Steps of the differences before the standard deviations are known, and their limits.
static const double first_step = 1e-4, least_step = 1e-7, most_step = 1e-2;
// Of a deviation: above rounding and the steps of the integrator, far below curvature.
static const double share_of_deviation = 0.3;
// Relative falls of chi2 at which a search ends: at starts and in profiles, at the minimum.
static const double rough = 1e-6, fine = 1e-9;

void fit_minimum_free(fit_minimum *minimum)
{
    free(minimum->best.residual);
    free(minimum->start);
    *minimum = (fit_minimum){0};
}

// ---- keys without effect

static ld_status compare_ends(const fit_problem *problem, const double *p, double *point,
                              double *residual, bool *idle, ld_error *error)
{
    const double end[2] = {0.25, 0.75}, least_effect = 1e-6;
    int keys = problem->keys, rows = problem->residuals;
    bool there[2 * FIT_MOST_KEYS];
    for (int i = 0; i < 2 * keys; i++) {
        memcpy(&point[i * keys], p, (size_t)keys * sizeof *p);
        point[i * keys + i / 2] = end[i % 2];
    }
    ld_status status = problem->evaluate(problem->self, 2 * keys, point, residual, there, error);
    for (int i = 0; i < keys && !status; i++) {
        double change = 0;
        for (int k = 0; k < rows; k++)
            change =
                fmax(change, fabs(residual[(2 * i + 1) * rows + k] - residual[2 * i * rows + k]));
        idle[i] = there[2 * i] && there[2 * i + 1] && change < least_effect;
    }
    return status;
}

ld_status fit_find_idle(const fit_problem *problem, const double *p, bool *idle, ld_error *error)
{
    size_t points = 2 * (size_t)problem->keys;
    double *point = calloc(points * (size_t)problem->keys, sizeof *point);
    double *residual = calloc(points * (size_t)problem->residuals + 1, sizeof *residual);
    ld_status status = point && residual
                           ? compare_ends(problem, p, point, residual, idle, error)
                           : ld_fail(error, LD_ERR_MEMORY, "no memory for the residuals");
    free(point);
    free(residual);
    return status;
}

// ---- starts

static void choose_start(const fit_problem *problem, const double *first, uint64_t seed,
                         const uint64_t *stream, int number, double *p)
{
    for (int i = 0; i < problem->keys; i++)
        p[i] = number == 0 || i >= problem->keys - problem->steady
                   ? first[i]
                   : random_uniform(seed, stream[i], (uint64_t)number, 0, 0);
}

// NOLINTNEXTLINE(readability-function-size)
static ld_status try_starts(const fit_problem *problem, const double *first, uint64_t seed,
                            const uint64_t *stream, fit_minimum *minimum, ld_error *error)
{
    double step[FIT_MOST_KEYS];
    ld_status status = LD_OK;
    for (int i = 0; i < problem->keys; i++)
        step[i] = first_step;
    for (int number = 0; number < minimum->starts && !status; number++) {
        char text[64];
        fit_start *start = &minimum->start[number];
        fit_point point = {0};
        snprintf(text, sizeof text, "start %d of %d", number + 1, minimum->starts);
        problem->stage(problem->self, text, minimum->best.there ? minimum->best.chi2 : NAN);
        choose_start(problem, first, seed, stream, number, start->from);
        memcpy(point.p, start->from, sizeof point.p);
        status = marquardt_minimise(problem, minimum->at_bound, step, rough, &point, error);
        memcpy(start->to, point.p, sizeof point.p);
        start->chi2 = point.there ? point.chi2 : NAN;
        if (!status && point.there && !(minimum->best.there && minimum->best.chi2 <= point.chi2)) {
            point.residual = minimum->best.residual;
            minimum->best = point;
        }
    }
    return status;
}

// ---- around the minimum

// Where the rows would not rise on a bound nearby, the key is held there.
static ld_status find_bounds(const fit_problem *problem, fit_minimum *minimum, ld_error *error)
{
    const double near = 2e-4, matters = 1e-3;
    ld_status status = LD_OK;
    for (int i = 0; i < problem->keys && !status; i++) {
        fit_point bound = minimum->best;
        bound.p[i] = bound.p[i] < 0.5 ? 0 : 1;
        bound.residual = NULL;
        if (fabs(bound.p[i] - minimum->best.p[i]) > near)
            continue;
        status = fit_point_compute(problem, &bound, error);
        if (status || !bound.there || bound.chi2 > minimum->best.chi2 + matters)
            continue;
        bound.residual = minimum->best.residual;
        minimum->best = bound;
        minimum->at_bound[i] = true;
    }
    return status;
}

// Singular values and right singular vectors of a matrix by columns, which it overwrites; rows <
// columns: the rest are 0.
static bool decompose(double *matrix, int rows, int columns, double *value, double *vector)
{
    double *work = NULL, room = 0, none = 0;
    for (int i = 0; i < columns; i++)
        value[i] = 0;
    int info = LAPACKE_dgesvd_work(LAPACK_COL_MAJOR, 'N', 'A', rows, columns, matrix, rows, value,
                                   &none, 1, vector, columns, &room, -1);
    work = info ? NULL : calloc((size_t)room, sizeof *work);
    if (work)
        info = LAPACKE_dgesvd_work(LAPACK_COL_MAJOR, 'N', 'A', rows, columns, matrix, rows, value,
                                   &none, 1, vector, columns, work, (int)room);
    free(work);
    return work && info == 0;
}

// The covariance of the free keys, by way of the singular values of their derivatives.
static void fill_covariance(fit_minimum *minimum, int keys, const bool *held, const double *value,
                            const double *vector, int free_count)
{
    const double least = 1e-9; // of the largest singular value
    int number[FIT_MOST_KEYS];
    for (int i = 0, k = 0; i < keys; i++)
        number[i] = held[i] ? -1 : k++;
    minimum->singular = free_count > 0 && !(value[free_count - 1] > least * value[0]);
    for (int i = 0; i < keys; i++)
        for (int j = 0; j < keys; j++) {
            bool known = !minimum->singular && number[i] >= 0 && number[j] >= 0;
            double sum = known ? 0 : NAN;
            for (int k = 0; k < free_count && known; k++)
                sum += vector[number[i] * free_count + k] * vector[number[j] * free_count + k] /
                       (value[k] * value[k]);
            minimum->covariance[i * FIT_MOST_KEYS + j] = sum;
        }
}

// The derivatives by all keys, the data's alone: singular values and directions, whose largest part
// is positive.
static bool find_directions(const fit_problem *problem, fit_minimum *minimum,
                            const double *jacobian, double *matrix)
{
    int keys = problem->keys, rows = problem->residuals;
    double vector[FIT_MOST_KEYS * FIT_MOST_KEYS];
    for (int k = 0; k < keys; k++)
        memcpy(&matrix[k * rows], &jacobian[k * fit_rows(problem)], (size_t)rows * sizeof *matrix);
    if (!decompose(matrix, rows, keys, minimum->singular_value, vector))
        return false;
    for (int k = 0; k < keys; k++) {
        double largest = 0;
        for (int i = 0; i < keys; i++)
            if (fabs(vector[i * keys + k]) > fabs(largest))
                largest = vector[i * keys + k];
        for (int i = 0; i < keys; i++)
            minimum->direction[k][i] = copysign(1, largest) * vector[i * keys + k];
    }
    return true;
}

static bool find_covariance(const fit_problem *problem, fit_minimum *minimum,
                            const double *jacobian, double *matrix)
{
    int keys = problem->keys, rows = fit_rows(problem), count = 0;
    double value[FIT_MOST_KEYS], vector[FIT_MOST_KEYS * FIT_MOST_KEYS];
    for (int k = 0; k < keys; k++)
        if (!minimum->at_bound[k])
            memcpy(&matrix[count++ * rows], &jacobian[k * rows], (size_t)rows * sizeof *matrix);
    if (count > 0 && !decompose(matrix, rows, count, value, vector))
        return false;
    fill_covariance(minimum, keys, minimum->at_bound, value, vector, count);
    return true;
}

static void choose_steps(fit_minimum *minimum, int keys)
{
    for (int i = 0; i < keys; i++) {
        double variance = minimum->covariance[i * FIT_MOST_KEYS + i];
        minimum->step[i] =
            variance > 0 ? fmin(fmax(share_of_deviation * sqrt(variance), least_step), most_step)
                         : first_step;
    }
}

static ld_status differentiate(const fit_problem *problem, fit_minimum *minimum, double *jacobian,
                               double *matrix, ld_error *error)
{
    static const bool none[FIT_MOST_KEYS];
    bool there;
    ld_status status = fit_derivatives(problem, minimum->best.p, minimum->best.residual, none,
                                       minimum->step, jacobian, &there, error);
    if (!status && !there)
        status = ld_fail(error, LD_ERR_LAUNCH,
                         "there is no launch on either side of the best fit: choose narrower "
                         "bounds");
    if (!status && !(find_directions(problem, minimum, jacobian, matrix) &&
                     find_covariance(problem, minimum, jacobian, matrix)))
        status = ld_fail(error, LD_ERR_NUMERIC, "the derivatives have no singular values");
    return status;
}

// Minimises again with steps that fit the deviations, until these are known.
static ld_status refine(const fit_problem *problem, fit_minimum *minimum, ld_error *error)
{
    enum { TIMES = 2 };
    size_t size = (size_t)fit_rows(problem) * (size_t)problem->keys;
    double *jacobian = calloc(size, sizeof *jacobian), *matrix = calloc(size, sizeof *matrix);
    if (!jacobian || !matrix) {
        free(jacobian);
        free(matrix);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the derivatives");
    }
    ld_status status = fit_point_compute(problem, &minimum->best, error);
    for (int i = 0; i < problem->keys; i++)
        minimum->step[i] = first_step;
    problem->stage(problem->self, "covariance", minimum->best.chi2);
    for (int i = 0; i < TIMES && !status; i++) {
        status = differentiate(problem, minimum, jacobian, matrix, error);
        fit_point again = minimum->best;
        again.residual = NULL;
        if (!status) {
            choose_steps(minimum, problem->keys);
            status =
                marquardt_minimise(problem, minimum->at_bound, minimum->step, fine, &again, error);
        }
        if (!status && again.there && again.chi2 <= minimum->best.chi2) {
            again.residual = minimum->best.residual;
            minimum->best = again;
            status = fit_point_compute(problem, &minimum->best, error);
        }
    }
    if (!status)
        status = differentiate(problem, minimum, jacobian, matrix, error);
    free(jacobian);
    free(matrix);
    return status;
}

static ld_status settle(const fit_problem *problem, fit_minimum *minimum, ld_error *error)
{
    memset(minimum->at_bound, 0, sizeof minimum->at_bound);
    ld_status status = find_bounds(problem, minimum, error);
    return status ? status : refine(problem, minimum, error);
}

// NOLINTNEXTLINE(readability-function-size)
ld_status fit_minimise(const fit_problem *problem, int starts, const double *first, uint64_t seed,
                       const uint64_t *stream, fit_minimum *minimum, ld_error *error)
{
    *minimum = (fit_minimum){.starts = starts};
    minimum->start = calloc((size_t)starts, sizeof *minimum->start);
    minimum->best.residual = calloc((size_t)fit_rows(problem), sizeof(double));
    if (!minimum->start || !minimum->best.residual)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the starts");
    ld_status status = try_starts(problem, first, seed, stream, minimum, error);
    if (!status && !minimum->best.there)
        status = ld_fail(error, LD_ERR_LAUNCH, "there is no launch at any of %d starts", starts);
    return status ? status : settle(problem, minimum, error);
}

ld_status fit_minimise_again(const fit_problem *problem, fit_minimum *minimum, ld_error *error)
{
    ld_status status = fit_point_compute(problem, &minimum->best, error);
    return status ? status : settle(problem, minimum, error);
}

// ---- profiles

typedef struct profile {
    const fit_problem *problem;
    fit_minimum *minimum;
    int key;
    fit_point latest;            // where the others were minimised last
    double slope[FIT_MOST_KEYS]; // of the others' change by the key's
} profile;

// How far the others go with the key, to begin with.
static void find_slopes(profile *self)
{
    const double *row = &self->minimum->covariance[self->key * FIT_MOST_KEYS];
    for (int i = 0; i < self->problem->keys; i++) {
        double slope = row[i] / row[self->key];
        self->slope[i] = isfinite(slope) ? slope : 0;
    }
}

// The root of the rise of the minimum over the others with the key at p; infinite: no launch.
static ld_status find_rise(profile *self, double p, double *rise, ld_error *error)
{
    bool held[FIT_MOST_KEYS] = {false};
    const double *best = self->minimum->best.p;
    fit_point *at = &self->latest;
    *at = (fit_point){0};
    held[self->key] = true;
    for (int i = 0; i < self->problem->keys; i++)
        at->p[i] = fmin(fmax(best[i] + self->slope[i] * (p - best[self->key]), 0), 1);
    at->p[self->key] = p;
    ld_status status =
        marquardt_minimise(self->problem, held, self->minimum->step, rough, at, error);
    *rise = at->there ? sqrt(fmax(at->chi2 - self->minimum->best.chi2, 0)) : INFINITY;
    fit_trace *trace = &self->minimum->trace[self->key];
    if (!status && at->there && trace->count < FIT_MOST_TRACE) {
        trace->p[trace->count] = p;
        trace->rise[trace->count++] = *rise * *rise;
    }
    return status;
}

// Whether the latest point lies below the minimum by more than rounding.
static bool is_lower(const profile *self)
{
    const double matters = 0.01; // a tenth of a deviation
    return self->latest.there && self->latest.chi2 < self->minimum->best.chi2 - matters;
}

// What is known of an end: where the rise is below z, and where it is above (NaN: not yet).
typedef struct bracket {
    double inside, outside;         // p
    double below, above, z;         // rise - z there
    bool latest_outside, has_moved; // which of them moved last
} bracket;

// Takes a point in; the side that stays a second time counts half (Illinois).
static void narrow(bracket *self, double p, double excess)
{
    bool outside = excess > 0;
    if (self->has_moved && outside == self->latest_outside)
        *(outside ? &self->below : &self->above) /= 2;
    *(outside ? &self->outside : &self->inside) = p;
    *(outside ? &self->above : &self->below) = excess;
    self->latest_outside = outside;
    self->has_moved = true;
}

// The next place, by the rises, which are straight lines where chi2 is a parabola.
static double next_place(const bracket *self, double best, double bound)
{
    double width = self->outside - self->inside;
    if (!isnan(self->outside)) {
        double share = self->below / (self->below - self->above);
        return self->inside + (isinf(self->above) ? 0.5 : fmin(fmax(share, 0.02), 0.98)) * width;
    }
    // beyond what is inside: at least a little, at most to twice as far from the minimum
    double gone = fabs(self->inside - best), go = gone;
    double slope = (self->below + self->z) / gone;
    if (slope > 0)
        go = fmin(fmax(-1.02 * self->below / slope, 0.02 * gone), gone);
    return bound > best ? fmin(self->inside + go, bound) : fmax(self->inside - go, bound);
}

// Goes outwards, then between.
static ld_status find_end(profile *self, double z, double first, double bound, fit_end *end,
                          ld_error *error)
{
    enum { MOST = 25 };
    const double close = 1e-3; // of z
    double best = self->minimum->best.p[self->key], p = first, rise = 0;
    bracket ends = {.inside = best, .outside = NAN, .below = -z, .z = z};
    *end = (fit_end){bound, true};
    for (int i = 0; i < MOST; i++) {
        ld_status status = find_rise(self, p, &rise, error);
        bool at_bound = p == bound && rise <= z;
        if (at_bound)
            *end = (fit_end){bound, true};
        if (status || is_lower(self) || at_bound)
            return status;
        *end = (fit_end){p, isinf(rise)};
        if (fabs(rise - z) <= close * z)
            return LD_OK;
        narrow(&ends, p, rise - z);
        p = next_place(&ends, best, bound);
    }
    *end = (fit_end){ends.inside, isinf(ends.above)};
    return LD_OK;
}

static void move_to(profile *self)
{
    self->latest.residual = self->minimum->best.residual;
    self->minimum->best = self->latest;
}

// NOLINTNEXTLINE(readability-function-size)
ld_status fit_profile(const fit_problem *problem, fit_minimum *minimum, int key, double z,
                      fit_end end[2], bool *lower, ld_error *error)
{
    profile self = {.problem = problem, .minimum = minimum, .key = key};
    double best = minimum->best.p[key];
    double variance = minimum->covariance[key * FIT_MOST_KEYS + key];
    double reach = variance > 0 ? z * sqrt(variance) : 0.1;
    ld_status status = LD_OK;
    *lower = false;
    minimum->trace[key].count = 0;
    find_slopes(&self);
    for (int side = 0; side < 2 && !status && !*lower; side++) {
        double bound = side, first = side ? fmin(best + reach, 1) : fmax(best - reach, 0);
        end[side] = (fit_end){bound, true};
        if (best == bound)
            continue;
        status = find_end(&self, z, first, bound, &end[side], error);
        *lower = !status && is_lower(&self);
    }
    if (!*lower)
        return status;
    move_to(&self);
    return settle(problem, minimum, error);
}
