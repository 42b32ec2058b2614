#include "quantities/measuring.h"

#include <math.h>

// Whether measure i is one of what is measured here.
static bool is_here(const measuring *self, int i)
{
    return self->plan[i].flight == self->flight;
}

void measuring_begin(measure_window *window, int count)
{
    for (int i = 0; i < count; i++)
        window[i] = (measure_window){.value = NAN, .reference = NAN};
}

bool measuring_is_there(const measuring *self)
{
    bool any = false;
    for (int i = 0; i < self->count; i++)
        any |= is_here(self, i);
    return any;
}

bool measuring_is_open(const measuring *self)
{
    bool any = false;
    for (int i = 0; i < self->count; i++)
        any |= self->window[i].open;
    return any;
}

// ---- windows

static double integrand(ld_take take, double value)
{
    return take == LD_TAKE_RMS ? value * value : value;
}

// The window ends at t, with the value before what happens there.
static void finish(const measuring *self, int i, double t)
{
    const measure_plan *plan = &self->plan[i];
    measure_window *window = &self->window[i];
    double from = window->t_from + plan->within[0], to = fmin(t, window->t_from + plan->within[1]);
    bool extends = plan->take != LD_TAKE_VALUE && to > from; // else a single instant
    bool change = plan->take == LD_TAKE_CHANGE;
    double mean = extends ? window->sum / (to - from) : integrand(plan->take, window->value);
    double result = plan->take == LD_TAKE_RMS ? sqrt(mean) : mean;
    if (plan->take == LD_TAKE_PEAK || change)
        result = extends && !isnan(mean) ? window->peak : change ? 0 * mean : fabs(mean);
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
    return row[self->plan[i].column];
}

// Of the stretch from a to b with its values there and in the middle: their largest magnitude, and
// that of the column where the parabola through them turns.
static void seek_peak(const measuring *self, int i, double a, double b, const double value[3])
{
    measure_window *window = &self->window[i];
    double away[3];
    for (int k = 0; k < 3; k++) {
        away[k] = value[k] - window->reference;
        window->peak = fmax(window->peak, fabs(away[k]));
    }
    double slope = (away[2] - away[0]) / 2, bend = away[2] + away[0] - 2 * away[1];
    double turn = -slope / bend; // -1 at a, 1 at b
    if (fabs(turn) < 1 && fabs(away[1] + slope * turn / 2) > window->peak) {
        double t = a + (b - a) * (1 + turn) / 2;
        window->peak = fmax(window->peak, fabs(value_at(self, i, t) - window->reference));
    }
}

// What of the step from `from` to `to` lies in the window: Simpson's rule.
static void take_step(const measuring *self, int i, double from, double to, const double *middle,
                      const double *end)
{
    const measure_plan *plan = &self->plan[i];
    measure_window *window = &self->window[i];
    double a = fmax(from, window->t_from + plan->within[0]);
    double b = fmin(to, window->t_from + plan->within[1]);
    bool whole = a == from && b == to;
    if (b > a) {
        const double value[3] = {
            a > from ? value_at(self, i, a) : window->value,
            whole ? middle[plan->column] : value_at(self, i, a + (b - a) / 2),
            b < to ? value_at(self, i, b) : end[plan->column],
        };
        if (isnan(window->reference))
            window->reference = plan->take == LD_TAKE_CHANGE ? value[0] : 0;
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
    for (int i = 0; i < self->count; i++) {
        if (self->window[i].open)
            take_step(self, i, from, to, middle, end);
        self->window[i].value = end && is_here(self, i) ? end[self->plan[i].column] : NAN;
    }
}

// ---- instants

void measuring_instant(const measuring *self, double t, const double *now)
{
    for (int i = 0; i < self->count; i++) {
        const measure_plan *plan = &self->plan[i];
        measure_window *window = &self->window[i];
        if (!is_here(self, i))
            continue;
        double after = now[plan->column];
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
    for (int i = 0; i < self->count; i++) {
        bool ends = is_here(self, i) && self->plan[i].to.kind == INSTANT_END;
        bool value = self->plan[i].take == LD_TAKE_VALUE;
        if (ends && !self->window[i].done && (self->window[i].open || value))
            finish(self, i, t);
    }
}
