#include "quantities/measuring.h"

#include <math.h>

#include "quantities/quantity_table.h"

// Whether measure i is one of what is measured here.
static bool is_here(const measuring *self, int i)
{
    const measure_plan *plan = &self->plans->plan[i];
    return plan->take != LD_TAKE_EXPRESSION && plan->flight == self->flight;
}

static double column_of(const void *self, int number)
{
    return ((const double *)self)[number];
}

// What measure i is of, in a row of columns.
static double value_in(const measuring *self, int i, const double *row)
{
    const measure_plan *plan = &self->plans->plan[i];
    return plan->column >= 0 ? row[plan->column]
                             : expression_value(&self->plans->code, plan->part, column_of, row);
}

void measuring_begin(measure_window *window, int count)
{
    for (int i = 0; i < count; i++)
        window[i] = (measure_window){.value = NAN, .reference = NAN};
}

bool measuring_is_there(const measuring *self)
{
    bool any = false;
    for (int i = 0; i < self->plans->count; i++)
        any |= is_here(self, i);
    return any;
}

bool measuring_is_open(const measuring *self)
{
    bool any = false;
    for (int i = 0; i < self->plans->count; i++)
        any |= self->window[i].open;
    return any;
}

// ---- windows

// How high a value stands above the reference, of which the largest is sought.
static double height(ld_take take, double away)
{
    return take == LD_TAKE_LARGEST ? away : take == LD_TAKE_LEAST ? -away : fabs(away);
}

static double integrand(ld_take take, double value)
{
    return take == LD_TAKE_RMS ? value * value : value;
}

// The window ends at t, with the value before what happens there.
static void finish(const measuring *self, int i, double t)
{
    const measure_plan *plan = &self->plans->plan[i];
    measure_window *window = &self->window[i];
    double from = window->t_from + plan->within[0], to = fmin(t, window->t_from + plan->within[1]);
    bool extends = plan->take != LD_TAKE_VALUE && to > from; // else a single instant
    bool change = plan->take == LD_TAKE_CHANGE;
    bool signed_peak = plan->take == LD_TAKE_LARGEST || plan->take == LD_TAKE_LEAST;
    double mean = extends ? window->sum / (to - from) : integrand(plan->take, window->value);
    double result = plan->take == LD_TAKE_RMS ? sqrt(mean) : mean;
    if (plan->take == LD_TAKE_PEAK || change)
        result = extends && !isnan(mean) ? window->peak : change ? 0 * mean : fabs(mean);
    if (signed_peak && extends && !isnan(mean))
        result = height(plan->take, window->peak);
    bool late = plan->take != LD_TAKE_VALUE && from > t;
    self->result[i] = late ? NAN : result;
    window->open = false;
    window->done = true;
}

// ---- steps

static double value_at(const measuring *self, int i, double t)
{
    double row[MEASURING_MOST_COLUMNS];
    self->row(self->self, t, row);
    return value_in(self, i, row);
}

// Of the stretch from a to b with its values there and in the middle: their largest magnitude, and
// that of the column where the parabola through them turns.
static void seek_peak(const measuring *self, int i, double a, double b, const double value[3])
{
    measure_window *window = &self->window[i];
    const ld_take take = self->plans->plan[i].take;
    double away[3];
    for (int k = 0; k < 3; k++) {
        away[k] = value[k] - window->reference;
        window->peak = fmax(window->peak, height(take, away[k]));
    }
    double slope = (away[2] - away[0]) / 2, bend = away[2] + away[0] - 2 * away[1];
    double turn = -slope / bend; // -1 at a, 1 at b
    if (fabs(turn) < 1 && height(take, away[1] + slope * turn / 2) > window->peak) {
        double t = a + (b - a) * (1 + turn) / 2;
        window->peak = fmax(window->peak, height(take, value_at(self, i, t) - window->reference));
    }
}

// What of the step from `from` to `to` lies in the window: Simpson's rule.
static void take_step(const measuring *self, int i, double from, double to, const double *middle,
                      const double *end)
{
    const measure_plan *plan = &self->plans->plan[i];
    measure_window *window = &self->window[i];
    double a = fmax(from, window->t_from + plan->within[0]);
    double b = fmin(to, window->t_from + plan->within[1]);
    bool whole = a == from && b == to;
    if (b > a) {
        const double value[3] = {
            a > from ? value_at(self, i, a) : window->value,
            whole ? value_in(self, i, middle) : value_at(self, i, a + (b - a) / 2),
            b < to ? value_at(self, i, b) : value_in(self, i, end),
        };
        if (isnan(window->reference)) {
            window->reference = plan->take == LD_TAKE_CHANGE ? value[0] : 0;
            window->peak = height(plan->take, 1) == height(plan->take, -1) ? 0 : -INFINITY;
        }
        double sides = integrand(plan->take, value[0]) + integrand(plan->take, value[2]);
        window->sum += (b - a) / 6 * (sides + 4 * integrand(plan->take, value[1]));
        seek_peak(self, i, a, b, value);
    }
    if (window->t_from + plan->within[1] <= to)
        finish(self, i, to);
}

void measuring_step(const measuring *self, double from, double to, const double *end)
{
    double middle[MEASURING_MOST_COLUMNS];
    if (measuring_is_open(self))
        self->row(self->self, from + (to - from) / 2, middle);
    for (int i = 0; i < self->plans->count; i++) {
        if (self->window[i].open)
            take_step(self, i, from, to, middle, end);
        self->window[i].value = end && is_here(self, i) ? value_in(self, i, end) : NAN;
    }
}

// ---- instants

void measuring_instant(const measuring *self, double t, const double *now)
{
    for (int i = 0; i < self->plans->count; i++) {
        const measure_plan *plan = &self->plans->plan[i];
        measure_window *window = &self->window[i];
        if (!is_here(self, i))
            continue;
        double after = value_in(self, i, now);
        if (!window->open && !window->done && self->has_come(self->self, plan->from)) {
            if (isnan(window->value)) // nothing was before
                window->value = after;
            window->open = true;
            window->t_from = t;
        }
        if (window->open && self->has_come(self->self, plan->to))
            finish(self, i, t);
        if (window->open)
            window->value = after;
    }
}

void measuring_end(const measuring *self, double t)
{
    for (int i = 0; i < self->plans->count; i++) {
        bool ends = is_here(self, i) && self->plans->plan[i].to.kind == INSTANT_END;
        bool value = self->plans->plan[i].take == LD_TAKE_VALUE;
        if (ends && !self->window[i].done && (self->window[i].open || value))
            finish(self, i, t);
    }
}

// ---- expressions

typedef struct known_results {
    const measure_plans *plans;
    const ld_rocket_summary *rocket;
} known_results;

static double result_of(const void *self, int number)
{
    const known_results *known = self;
    const measure_result *result = &known->plans->result[number];
    bool there = result->where.type == QUANTITY_NONE ||
                 quantity_number(&result->where, 0, known->rocket) != 0;
    return there ? quantity_number(&result->at, result->item, known->rocket) : NAN;
}

void measuring_express(const measure_plans *plans, ld_rocket_summary *rocket)
{
    const known_results known = {plans, rocket};
    for (int i = 0; i < plans->count; i++)
        if (plans->plan[i].take == LD_TAKE_EXPRESSION)
            rocket->measure[i] =
                expression_value(&plans->code, plans->plan[i].part, result_of, &known);
}
