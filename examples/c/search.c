#include "search.h"

#include <math.h>
#include <nlopt.h>
#include <string.h>

// What was found at the latest point, and at the best.
typedef struct found {
    double x[SEARCH_MOST], value, constraint[SEARCH_MOST];
    double worst; // of the constraints, 0: all hold
} found;

typedef struct progress {
    const search *of;
    nlopt_opt optimiser;
    int outcome, looked;
    found now, best;
} progress;

static double worst_of(const search *of, const double *constraint)
{
    double worst = 0;
    for (int i = 0; i < of->constraints; i++)
        worst = fmax(worst, constraint[i]);
    return worst;
}

static int is_better(const found *a, const found *b)
{
    return a->worst != b->worst ? a->worst < b->worst : a->value < b->value;
}

// The optimiser asks for value and constraints one after the other.
static void look(progress *self, const double *x)
{
    const search *of = self->of;
    size_t size = (size_t)of->variables * sizeof *x;
    if (self->outcome || (self->looked > 0 && memcmp(x, self->now.x, size) == 0))
        return;
    memcpy(self->now.x, x, size);
    self->outcome = of->evaluate(of->self, x, &self->now.value, self->now.constraint);
    self->now.worst = worst_of(of, self->now.constraint);
    if (self->looked++ == 0 || is_better(&self->now, &self->best))
        self->best = self->now;
    if (self->outcome || self->looked >= of->evaluations)
        nlopt_force_stop(self->optimiser);
}

static double value_at(unsigned n, const double *x, double *gradient, void *data)
{
    (void)n, (void)gradient;
    progress *self = data;
    look(self, x);
    return self->now.value;
}

static void constraints_at(unsigned m, double *constraint, unsigned n, const double *x,
                           double *gradient, void *data)
{
    (void)n, (void)gradient;
    progress *self = data;
    look(self, x);
    memcpy(constraint, self->now.constraint, m * sizeof *constraint);
}

static nlopt_result set_up(progress *self)
{
    static const double exactly[SEARCH_MOST] = {0};
    const search *of = self->of;
    nlopt_opt to = self->optimiser;
    double step[SEARCH_MOST], precision[SEARCH_MOST];
    for (int i = 0; i < of->variables; i++) {
        step[i] = 0.125 * (of->high[i] - of->low[i]);
        precision[i] = of->precision * (of->high[i] - of->low[i]);
    }
    nlopt_result result = nlopt_set_lower_bounds(to, of->low);
    if (result > 0)
        result = nlopt_set_upper_bounds(to, of->high);
    if (result > 0)
        result = nlopt_set_initial_step(to, step);
    if (result > 0)
        result = nlopt_set_xtol_abs(to, precision);
    if (result > 0)
        result = nlopt_set_min_objective(to, value_at, self);
    if (result > 0 && of->constraints > 0)
        result = nlopt_add_inequality_mconstraint(to, (unsigned)of->constraints, constraints_at,
                                                  self, exactly);
    return result;
}

int search_minimum(const search *of, double *x)
{
    progress self = {.of = of};
    double value, at[SEARCH_MOST];
    self.optimiser = nlopt_create(NLOPT_LN_COBYLA, (unsigned)of->variables);
    nlopt_result result = self.optimiser ? set_up(&self) : NLOPT_OUT_OF_MEMORY;
    if (result > 0) {
        memcpy(at, x, (size_t)of->variables * sizeof *x);
        result = nlopt_optimize(self.optimiser, at, &value);
    }
    nlopt_destroy(self.optimiser);
    if (self.looked > 0)
        memcpy(x, self.best.x, (size_t)of->variables * sizeof *x);
    if (self.outcome)
        return self.outcome;
    // rounding: it has come as near as numbers go
    return result > 0 || result == NLOPT_FORCED_STOP || result == NLOPT_ROUNDOFF_LIMITED ? 0 : -1;
}
