#include "optimise/optimum.h"

#include <math.h>
#include <nlopt.h>
#include <string.h>

enum {
    MOST = LD_MAX_BOUNDS,
    MOST_LIMITS = 2 * LD_MAX_AIMS,
    ROW = 1 + MOST_LIMITS,
    ROUND_SIMPLICES = 4
};

static const struct {
    nlopt_algorithm algorithm;
    optimum_method traits;
} methods[] = {
    [LD_OPTIMISE_COBYLA] = {NLOPT_LN_COBYLA, {"COBYLA", true, true, false}},
    [LD_OPTIMISE_BOBYQA] = {NLOPT_LN_BOBYQA, {"BOBYQA", false, true, false}},
    [LD_OPTIMISE_SBPLX] = {NLOPT_LN_SBPLX, {"Sbplx", false, true, false}},
    [LD_OPTIMISE_SLSQP] = {NLOPT_LD_SLSQP, {"SLSQP", true, true, true}},
    [LD_OPTIMISE_CCSA] = {NLOPT_LD_CCSAQ, {"CCSA", true, true, true}},
    [LD_OPTIMISE_DIRECT] = {NLOPT_GN_DIRECT_L, {"DIRECT-L", false, false, false}},
    [LD_OPTIMISE_CRS] = {NLOPT_GN_CRS2_LM, {"CRS2", false, false, false}},
    [LD_OPTIMISE_ISRES] = {NLOPT_GN_ISRES, {"ISRES", true, false, false}},
};

const optimum_method *optimum_method_of(ld_optimise_method method)
{
    return &methods[method].traits;
}

// What was found at the point looked at last.
typedef struct progress {
    const optimum_problem *of;
    nlopt_opt optimiser;
    ld_status status;
    ld_error *error;
    int number; // of the next point
    optimum *result;
    optimum_found now, before; // `before`: the best a round ago
    int round_at;              // evaluations at which the round ends
    bool is_there, has_slopes;
    double slope[MOST], limit_slope[MOST_LIMITS * MOST];
    double scale;         // of values
    double highest;       // value so far
    bool stopped, enough; // why
} progress;

bool optimum_is_better(const optimum_found *a, const optimum_found *b)
{
    if (a->number < 0 || b->number < 0)
        return a->number >= 0;
    return a->worst != b->worst ? a->worst < b->worst : a->value < b->value;
}

static void stop(progress *self)
{
    self->stopped = true;
    nlopt_force_stop(self->optimiser);
}

// ---- points

static void take_point(progress *self, const double *x, const double *values)
{
    const optimum_problem *of = self->of;
    const double value = values[0], *limit = values + 1;
    optimum_found found = {.number = self->number, .value = value};
    memcpy(found.x, x, (size_t)of->keys * sizeof *x);
    for (int i = 0; i < of->limits; i++) {
        found.limit[i] = limit[i];
        found.worst = fmax(found.worst, limit[i]);
    }
    if (optimum_is_better(&found, &self->result->best))
        self->result->best = found;
    self->highest = fmax(self->highest, value);
    self->now = found;
}

// A point without a value is worse than all others, by as much as the worst is large, and breaks
// every constraint by all of it.
static void take_hole(progress *self, const double *x)
{
    const optimum_problem *of = self->of;
    self->now = (optimum_found){.number = self->number, .worst = of->limits ? 1 : 0};
    memcpy(self->now.x, x, (size_t)of->keys * sizeof *x);
    self->now.value = self->highest + fmax(fabs(self->highest), self->scale);
    for (int i = 0; i < of->limits; i++)
        self->now.limit[i] = 1;
}

static ld_status look_at(progress *self, int count, const double *points, double *values,
                         bool *there)
{
    self->status = self->of->evaluate(self->of->self, count, points, values, there, self->error);
    self->result->evaluations += count;
    return self->status;
}

// Derivatives by forward differences, backwards at the upper bound; 0 where there is no neighbour.
static void find_slopes(progress *self)
{
    const optimum_problem *of = self->of;
    double points[MOST * MOST] = {0}, values[MOST * ROW], step[MOST];
    bool there[MOST];
    int n = of->keys, row = 1 + of->limits;
    optimum_found at = self->now;
    for (int i = 0; i < n; i++) {
        step[i] = 0.1 * of->precision * (at.x[i] + 0.1 * of->precision > 1 ? -1 : 1);
        memcpy(&points[i * n], at.x, (size_t)n * sizeof *points);
        points[i * n + i] += step[i];
    }
    if (look_at(self, n, points, values, there))
        return;
    for (int i = 0; i < n; i++, self->number++) {
        const double *here = &values[i * row];
        self->slope[i] = there[i] ? (here[0] - at.value) / step[i] : 0;
        for (int k = 0; k < of->limits; k++)
            self->limit_slope[k * n + i] = there[i] ? (here[1 + k] - at.limit[k]) / step[i] : 0;
        if (there[i])
            take_point(self, &points[i * n], here);
    }
    self->now = at;
    self->has_slopes = true;
}

// ---- when to stop

static void end_round(progress *self)
{
    const optimum_problem *of = self->of;

    const optimum_found *best = &self->result->best;
    if (self->result->evaluations < self->round_at)
        return;
    if (of->is_enough && self->before.number >= 0 && self->before.worst == best->worst &&
        of->is_enough(of->self, self->before.number, best->number)) {
        self->enough = true;
        stop(self);
    }
    self->before = *best;
    self->round_at = self->result->evaluations + ROUND_SIMPLICES * (of->keys + 1);
}

static void check_end(progress *self)
{
    if (self->status || self->result->evaluations >= self->of->evaluations)
        stop(self);
    else if (methods[self->of->method].traits.local)
        end_round(self);
}

// The optimiser asks for value, constraints and their derivatives one after the other.
static void look(progress *self, const double *x, bool slopes)
{
    size_t size = (size_t)self->of->keys * sizeof *x;
    bool same = self->result->evaluations > 0 && memcmp(x, self->now.x, size) == 0;
    if (self->stopped)
        return;
    if (!same) {
        double values[ROW];
        self->has_slopes = false;
        if (look_at(self, 1, x, values, &self->is_there) == LD_OK) {
            if (self->is_there)
                take_point(self, x, values);
            else
                take_hole(self, x);
            self->number++;
        }
    }
    if (slopes && !self->has_slopes && !self->status) {
        memset(self->slope, 0, sizeof self->slope);
        memset(self->limit_slope, 0, sizeof self->limit_slope);
        if (self->is_there)
            find_slopes(self);
        self->has_slopes = true;
    }
    check_end(self);
}

static double value_at(unsigned n, const double *x, double *gradient, void *data)
{
    progress *self = data;
    look(self, x, gradient != NULL);
    for (unsigned i = 0; gradient && i < n; i++)
        gradient[i] = self->slope[i] / self->scale;
    return self->now.value / self->scale;
}

static void limits_at(unsigned m, double *limit, unsigned n, const double *x, double *gradient,
                      void *data)
{
    progress *self = data;
    look(self, x, gradient != NULL);
    memcpy(limit, self->now.limit, m * sizeof *limit);
    if (gradient)
        memcpy(gradient, self->limit_slope, (size_t)m * n * sizeof *gradient);
}

// ---- from start to end

static nlopt_result set_up(progress *self)
{
    static const double exactly[MOST_LIMITS] = {0};
    const optimum_problem *of = self->of;
    nlopt_opt to = self->optimiser;
    nlopt_result result = nlopt_set_lower_bounds1(to, 0);
    if (result > 0)
        result = nlopt_set_upper_bounds1(to, 1);
    if (result > 0)
        result = nlopt_set_initial_step1(to, 0.125);
    if (result > 0)
        result = nlopt_set_xtol_abs1(to, of->precision);
    if (result > 0)
        result = nlopt_set_min_objective(to, value_at, self);
    if (result > 0 && of->limits > 0)
        result =
            nlopt_add_inequality_mconstraint(to, (unsigned)of->limits, limits_at, self, exactly);
    return result;
}

static ld_status run(progress *self, const double *x)
{
    const optimum_problem *of = self->of;
    double at[MOST], value;
    nlopt_result result = set_up(self);
    nlopt_srand((unsigned long)of->seed + 1);
    memcpy(at, x, (size_t)of->keys * sizeof *x);
    if (result > 0)
        result = nlopt_optimize(self->optimiser, at, &value);
    self->result->end = self->enough    ? OPTIMUM_NOISE
                        : self->stopped ? OPTIMUM_EVALUATIONS
                                        : OPTIMUM_PRECISE;
    if (self->status)
        return self->status;
    // rounding: it has come as near as numbers go
    if (result > 0 || result == NLOPT_FORCED_STOP || result == NLOPT_ROUNDOFF_LIMITED)
        return LD_OK;
    return result == NLOPT_OUT_OF_MEMORY
               ? ld_fail(self->error, LD_ERR_MEMORY, "no memory for the search")
               : ld_fail(self->error, LD_ERR_NUMERIC, "%s of NLopt fails (%d)",
                         optimum_method_of(of->method)->name, (int)result);
}

ld_status optimum_search(const optimum_problem *of, const double *x, int number, optimum *result,
                         ld_error *error)
{
    progress self = {.of = of,
                     .error = error,
                     .number = number,
                     .result = result,
                     .before = {.number = -1},
                     .scale = 1};
    *result = (optimum){.best = {.number = -1}};
    double values[ROW];
    if (look_at(&self, 1, x, values, &self.is_there))
        return self.status;
    if (!self.is_there) {
        result->end = OPTIMUM_NOWHERE;
        return LD_OK;
    }
    self.highest = values[0];
    self.scale = values[0] != 0 ? fabs(values[0]) : 1;
    take_point(&self, x, values);
    self.number++;
    self.round_at = ROUND_SIMPLICES * (of->keys + 1);
    self.optimiser = nlopt_create(methods[of->method].algorithm, (unsigned)of->keys);
    if (!self.optimiser)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the search");
    ld_status status = run(&self, x);
    nlopt_destroy(self.optimiser);
    return status;
}
