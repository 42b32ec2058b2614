#include "fit/marquardt.h"

#include <cminpack.h>
#include <stdlib.h>
#include <string.h>

#include "math/functions.h"

// Stands for the rows where there is no launch: a step there is taken back.
static const double beyond = 1e150;
// A start is kept off the bounds, where no small change of u changes p.
static const double off_bound = 1e-4;

static double prior_row(const fit_problem *problem, const double *p, int key)
{
    return (p[key] - problem->prior_mean[key]) / problem->prior_deviation[key];
}

static void fill_priors(const fit_problem *problem, const double *p, double *row)
{
    for (int i = 0; i < problem->keys; i++)
        row[problem->residuals + i] =
            isfinite(problem->prior_deviation[i]) ? prior_row(problem, p, i) : 0;
}

static double sum_of_squares(const double *value, int count)
{
    double sum = 0;
    for (int i = 0; i < count; i++)
        sum += value[i] * value[i];
    return sum;
}

ld_status fit_point_compute(const fit_problem *problem, fit_point *point, ld_error *error)
{
    int rows = fit_rows(problem);
    double *own = point->residual ? NULL : calloc((size_t)rows, sizeof *own);
    double *row = own ? own : point->residual;
    if (!row)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the residuals");
    ld_status status = problem->evaluate(problem->self, 1, point->p, row, &point->there, error);
    if (!status && point->there) {
        fill_priors(problem, point->p, row);
        point->chi2 = sum_of_squares(row, rows);
    }
    free(own);
    return status;
}

// ---- derivatives

typedef struct differences {
    const fit_problem *problem;
    int count;              // columns to be computed
    int key[FIT_MOST_KEYS]; // of each
    double step[FIT_MOST_KEYS];
    bool there[FIT_MOST_KEYS];
    double *point, *residual; // [count][keys], [count][residuals]
} differences;

static ld_status compute_columns(differences *self, const double *p, ld_error *error)
{
    int keys = self->problem->keys;
    for (int i = 0; i < self->count; i++) {
        memcpy(&self->point[i * keys], p, (size_t)keys * sizeof *p);
        self->point[i * keys + self->key[i]] += self->step[i];
    }
    return self->problem->evaluate(self->problem->self, self->count, self->point, self->residual,
                                   self->there, error);
}

// Takes the columns that are there into the Jacobian; those that are not stay, to be computed on
// the other side.
static void take_columns(differences *self, const double *p, const double *row,
                         const int *column_of, double *jacobian)
{
    int rows = fit_rows(self->problem), data = self->problem->residuals, left = 0;
    for (int i = 0; i < self->count; i++) {
        int key = self->key[i];
        double *column = &jacobian[column_of[key] * rows];
        // as it was added
        double step = (p[key] + self->step[i]) - p[key];
        for (int k = 0; k < data && self->there[i]; k++)
            column[k] = (self->residual[i * data + k] - row[k]) / step;
        if (!self->there[i]) {
            self->key[left] = key;
            self->step[left++] = -self->step[i];
        }
    }
    self->count = left;
}

static ld_status both_sides(differences *self, const double *p, const double *row,
                            const int *column_of, double *jacobian, ld_error *error)
{
    ld_status status = LD_OK;
    for (int side = 0; side < 2 && self->count > 0 && !status; side++) {
        status = compute_columns(self, p, error);
        if (!status)
            take_columns(self, p, row, column_of, jacobian);
    }
    return status;
}

// NOLINTNEXTLINE(readability-function-size)
ld_status fit_derivatives(const fit_problem *problem, const double *p, const double *row,
                          const bool *held, const double *step, double *jacobian, bool *there,
                          ld_error *error)
{
    int keys = problem->keys, rows = fit_rows(problem), free_count = 0;
    int column_of[FIT_MOST_KEYS];
    differences self = {.problem = problem};
    for (int i = 0; i < keys; i++) {
        if (held[i])
            continue;
        column_of[i] = free_count++;
        self.key[self.count] = i;
        self.step[self.count++] = p[i] + step[i] <= 1 ? step[i] : -step[i];
    }
    memset(jacobian, 0, (size_t)(rows * free_count) * sizeof *jacobian);
    self.point = calloc((size_t)(keys * keys), sizeof(double));
    self.residual = calloc((size_t)(keys * problem->residuals) + 1, sizeof(double));
    ld_status status = self.point && self.residual
                           ? both_sides(&self, p, row, column_of, jacobian, error)
                           : ld_fail(error, LD_ERR_MEMORY, "no memory for the derivatives");
    free(self.point);
    free(self.residual);
    *there = self.count == 0;
    for (int i = 0; i < keys; i++)
        if (!held[i] && isfinite(problem->prior_deviation[i]))
            jacobian[column_of[i] * rows + problem->residuals + i] =
                1 / problem->prior_deviation[i];
    return status;
}

// ---- MINPACK

typedef struct marquardt {
    const fit_problem *problem;
    const bool *held;
    const double *step;
    fit_point point; // where the rows were asked for last
    bool begun;      // there is a launch at the start
    ld_status status;
    ld_error *error;
} marquardt;

enum { STOP = -1, CUT_OFF = 5, MOST_POINTS = 20 }; // answers of MINPACK; of one search

static void set_point(marquardt *self, const double *u)
{
    for (int i = 0, k = 0; i < self->problem->keys; i++)
        if (!self->held[i])
            self->point.p[i] = (1 + sin(u[k++])) / 2;
}

static int give_rows(marquardt *self, double *row)
{
    self->point.residual = row;
    self->status = fit_point_compute(self->problem, &self->point, self->error);
    if (self->status || (!self->point.there && !self->begun))
        return STOP;
    self->begun = true;
    for (int i = 0; i < fit_rows(self->problem) && !self->point.there; i++)
        row[i] = beyond;
    return 0;
}

static int give_jacobian(marquardt *self, const double *u, const double *row, double *jacobian)
{
    bool there;
    int rows = fit_rows(self->problem);
    self->status = fit_derivatives(self->problem, self->point.p, row, self->held, self->step,
                                   jacobian, &there, self->error);
    if (self->status || !there)
        return STOP;
    for (int i = 0, k = 0; i < self->problem->keys; i++) {
        if (self->held[i])
            continue;
        double slope = cos(u[k]) / 2;
        for (int r = 0; r < rows; r++)
            jacobian[k * rows + r] *= slope;
        k++;
    }
    return 0;
}

// NOLINTNEXTLINE(readability-function-size): MINPACK's
static int answer(void *user, int rows, int keys, const double *u, double *row, double *jacobian,
                  int leading, int asked)
{
    marquardt *self = user;
    (void)rows;
    (void)keys;
    (void)leading;
    set_point(self, u);
    if (asked == 1)
        return give_rows(self, row);
    return asked == 2 ? give_jacobian(self, u, row, jacobian) : 0;
}

// The angles of the free keys; returns their number.
static int find_angles(const fit_problem *problem, const bool *held, const double *p, double *u)
{
    int count = 0;
    for (int i = 0; i < problem->keys; i++)
        if (!held[i])
            u[count++] = asin(2 * fmin(fmax(p[i], off_bound), 1 - off_bound) - 1);
    return count;
}

// Its work space.
typedef struct workspace {
    double u[FIT_MOST_KEYS], scale[FIT_MOST_KEYS], qtf[FIT_MOST_KEYS];
    double work[3][FIT_MOST_KEYS];
    int pivot[FIT_MOST_KEYS];
    double *row, *jacobian, *long_work;
} workspace;

static int call_minpack(marquardt *self, workspace *w, int keys, double fall)
{
    enum { SCALE_BY_COLUMNS = 1, QUIET = 0 };
    const double least_step = 1e-7, least_angle = 0, first_step = 10;
    int points, jacobians, rows = fit_rows(self->problem);
    return lmder(answer, self, rows, keys, w->u, w->row, w->jacobian, rows, fall, least_step,
                 least_angle, MOST_POINTS, w->scale, SCALE_BY_COLUMNS, first_step, QUIET, &points,
                 &jacobians, w->pivot, w->qtf, w->work[0], w->work[1], w->work[2], w->long_work);
}

// One search; *ended: it was not cut off.
static ld_status search(marquardt *self, double fall, fit_point *point, bool *ended)
{
    size_t rows = (size_t)fit_rows(self->problem);
    workspace w;
    int keys = find_angles(self->problem, self->held, point->p, w.u);
    *ended = true;
    if (keys == 0)
        return fit_point_compute(self->problem, point, self->error);
    self->begun = false;
    self->point = *point;
    w.row = calloc(rows, sizeof *w.row);
    w.long_work = calloc(rows, sizeof *w.long_work);
    w.jacobian = calloc(rows * (size_t)keys, sizeof *w.jacobian);
    if (!w.row || !w.long_work || !w.jacobian) {
        self->status = ld_fail(self->error, LD_ERR_MEMORY, "no memory for the residuals");
    } else {
        int outcome = call_minpack(self, &w, keys, fall);
        *ended = outcome != CUT_OFF;
        set_point(self, w.u);
        point->there = outcome != STOP;
        memcpy(point->p, self->point.p, sizeof point->p);
        point->chi2 = sum_of_squares(w.row, (int)rows);
        if (point->residual)
            memcpy(point->residual, w.row, rows * sizeof *w.row);
    }
    free(w.row);
    free(w.long_work);
    free(w.jacobian);
    return self->status;
}

// ---- bounds

// Near a bound the angle makes steps ever shorter: a key that is no worse on the bound is held
// there. *found: one more is.
static ld_status hold_at_bounds(const fit_problem *problem, double near, fit_point *point,
                                bool *held, bool *found, ld_error *error)
{
    ld_status status = LD_OK;
    *found = false;
    for (int i = 0; i < problem->keys && !status; i++) {
        fit_point bound = *point;
        bound.p[i] = bound.p[i] < 0.5 ? 0 : 1;
        bound.residual = NULL;
        if (held[i] || fabs(bound.p[i] - point->p[i]) > near)
            continue;
        status = fit_point_compute(problem, &bound, error);
        if (status || !bound.there || bound.chi2 > point->chi2)
            continue;
        memcpy(point->p, bound.p, sizeof point->p);
        point->chi2 = bound.chi2;
        held[i] = *found = true;
    }
    return status;
}

// Lets keys go that are held at a bound without need: inwards chi2 falls. *found: one is.
static ld_status let_go(const fit_problem *problem, const bool *always, fit_point *point,
                        bool *held, bool *found, ld_error *error)
{
    ld_status status = LD_OK;
    *found = false;
    for (int i = 0; i < problem->keys && !status; i++) {
        fit_point inside = *point;
        inside.p[i] = inside.p[i] < 0.5 ? off_bound : 1 - off_bound;
        inside.residual = NULL;
        if (always[i] || !held[i])
            continue;
        status = fit_point_compute(problem, &inside, error);
        if (status || !inside.there || inside.chi2 >= point->chi2)
            continue;
        memcpy(point->p, inside.p, sizeof point->p);
        point->chi2 = inside.chi2;
        held[i] = false;
        *found = true;
    }
    return status;
}

// NOLINTNEXTLINE(readability-function-size)
ld_status marquardt_minimise(const fit_problem *problem, const bool *always, const double *step,
                             double fall, fit_point *point, ld_error *error)
{
    enum { ROUNDS = 10 };
    const double near[2] = {0.03, 1e-3}; // of a search that was cut off, or ended
    bool held[FIT_MOST_KEYS], ended = false, found = true;
    marquardt self = {.problem = problem, .held = held, .step = step, .error = error};
    memcpy(held, always, (size_t)problem->keys * sizeof *held);
    for (int i = 0; i < ROUNDS && (found || !ended); i++) {
        ld_status status = search(&self, fall, point, &ended);
        if (status || !point->there)
            return status;
        status = hold_at_bounds(problem, near[ended], point, held, &found, error);
        if (!status && ended && !found)
            status = let_go(problem, always, point, held, &found, error);
        if (status)
            return status;
    }
    return point->residual ? fit_point_compute(problem, point, error) : LD_OK;
}
