// The launch, and those beside it by its steps.
#include "derivatives/derivatives.h"

#include <assert.h>
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "base/printed.h"
#include "integration/step_course.h"
#include "launchdyn/scenario.h"
#include "model/model.h"
#include "model/parts.h"
#include "quantities/summary.h"
#include "run/run.h"
#include "run/simulation_build.h"
#include "search/side_by_side.h"

// A change of this share of a key: curvature adds some 1e-8 to a derivative, rounding as much to
// one that changes the result by so many per cent as the key.
static const double SHARE_CHANGED = 1e-4;

static ld_status no_memory(ld_error *error)
{
    return ld_fail(error, LD_ERR_MEMORY, "no memory for the launches of the derivatives");
}

// ---- keys

static ld_status read_step(const ld_derivative_key *asked, derivative_key *self, ld_error *error)
{
    const field_row *row = self->place.row;
    ld_error why;
    char text[128];
    if (asked->step) {
        if (ld_read_quantity(asked->step, row->unit ? row->unit : "", &self->step, &why))
            return ld_fail(error, LD_ERR_INPUT, "%s: step: %s", self->place.path, why.text);
    } else {
        self->step = SHARE_CHANGED * fabs(self->value);
    }
    if (!(self->step > 0))
        return ld_fail(error, LD_ERR_INPUT,
                       asked->step ? "%s: expected a step > 0"
                                   : "%s is 0: expected the step by which to change it, %s=STEP",
                       self->place.path, self->place.path);
    if (field_in_range(row->range, self->value - self->step) &&
        field_in_range(row->range, self->value + self->step))
        return LD_OK;
    field_range_text(row, text, sizeof text);
    return ld_fail(error, LD_ERR_INPUT,
                   "%s: a step to either side leaves its range, %s: expected a smaller one",
                   self->place.path, text);
}

static ld_status read_key(ld_derivatives *all, const ld_derivative_key *asked, ld_error *error)
{
    char why[384];
    derivative_key *self = &all->key[all->keys];
    if (!field_locate(all->model, asked->path, &self->place, why, sizeof why))
        return ld_fail(error, LD_ERR_INPUT, "%.200s: %s", VISIBLE(asked->path), why);
    if (self->place.whole)
        return ld_fail(error, LD_ERR_INPUT, "%s: a whole number has no derivatives",
                       self->place.path);
    for (int i = 0; i < all->keys; i++)
        if (strcmp(all->key[i].place.path, self->place.path) == 0)
            return ld_fail(error, LD_ERR_INPUT, "%s is given twice", self->place.path);
    self->value = field_get(all->model, &self->place);
    all->keys++;
    return read_step(asked, self, error);
}

static ld_status check_model(const ld_model *model, size_t keys, ld_error *error)
{
    if (keys < 1 || keys > DERIVATIVES_MOST_KEYS)
        return ld_fail(error, LD_ERR_INPUT, "expected 1 to %d keys, found %zu",
                       DERIVATIVES_MOST_KEYS, keys);
    if (model_firing_count(model) > 1)
        return ld_fail(error, LD_ERR_INPUT,
                       "derivatives are of single launches; the scenario fires %d rockets",
                       model_firing_count(model));
    if (model_run(model)->coupling_step > 0)
        return ld_fail(error, LD_ERR_INPUT,
                       "run.coupling: derivatives are of launches integrated as a whole: expected "
                       "no run.coupling");
    return LD_OK;
}

// ---- launches

typedef struct derivative_worker {
    ld_model *model;
    ld_simulation *simulation;
} derivative_worker;

// Launch `number` is that itself (0), left (odd) or right of key (number - 1) / 2.
typedef struct job {
    ld_derivatives *all;
    const ld_derivative_options *options;
    step_course course;        // of the launch itself
    derivative_worker *worker; // [threads]
    int launches, threads, done;
    pthread_mutex_t at_work;
    ld_status status;
    ld_error *error;
} job;

static bool may_continue(void *self, double share)
{
    const ld_derivative_options *options = self;
    (void)share;
    return !options->go_on || options->go_on(options->self);
}

static ld_status change_model(const ld_derivatives *all, int number, ld_model *model,
                              ld_error *error)
{
    *model = *all->model;
    model_forget(model); // it follows from what is set
    if (number > 0) {
        const derivative_key *key = &all->key[(number - 1) / 2];
        field_set(model, &key->place, key->value + (number % 2 ? -key->step : key->step));
    }
    model_complete(model);
    return model_check_drawn(model, error);
}

static ld_status launch_beside(job *self, derivative_worker *by, int number, step_course *course,
                               ld_error *error)
{
    ld_derivative_options asked = *self->options;
    const ld_run_options options = {.self = &asked, .progress = may_continue};
    ld_status status = change_model(self->all, number, by->model, error);
    if (!status)
        status = simulation_renew(&by->simulation, by->model, error);
    if (!status)
        status = run_course(by->simulation, &options, course, &self->all->summary[number], error);
    self->all->same_events[number] = !status && !step_course_differs(course);
    return status;
}

// Keeps its steps; then again by them.
static ld_status launch_itself(job *self, ld_error *error)
{
    ld_status status = launch_beside(self, &self->worker[0], 0, &self->course, error);
    if (status)
        return status;
    step_course_follow(&self->course);
    status = launch_beside(self, &self->worker[0], 0, &self->course, error);
    self->done = !status;
    return status;
}

static bool run_task(void *user, int worker, int task)
{
    job *self = user;
    ld_error error;
    step_course course = step_course_of(&self->course);
    ld_status status = launch_beside(self, &self->worker[worker], task + 1, &course, &error);
    pthread_mutex_lock(&self->at_work);
    if (status && !self->status) {
        self->status = status;
        *self->error = error;
    }
    self->done += !status;
    if (self->options->progress)
        self->options->progress(self->options->self, self->done, self->launches);
    pthread_mutex_unlock(&self->at_work);
    return !status;
}

static ld_status make_workers(job *self, ld_error *error)
{
    self->worker = calloc((size_t)self->threads, sizeof *self->worker);
    for (int i = 0; self->worker && i < self->threads; i++)
        if (!(self->worker[i].model = calloc(1, sizeof *self->worker[i].model)))
            return no_memory(error);
    return self->worker ? LD_OK : no_memory(error);
}

static void free_workers(const job *self)
{
    for (int i = 0; self->worker && i < self->threads; i++) {
        ld_simulation_free(self->worker[i].simulation);
        free(self->worker[i].model);
    }
    free(self->worker);
}

static ld_status run_all(ld_derivatives *all, const ld_derivative_options *options, ld_error *error)
{
    const int beside = 2 * all->keys, asked = options->threads > 1 ? options->threads : 1;
    job self = {.all = all,
                .options = options,
                .launches = 1 + beside,
                .threads = asked < beside ? asked : beside,
                .error = error,
                .at_work = PTHREAD_MUTEX_INITIALIZER};
    const side_by_side work = {
        .tasks = beside, .threads = self.threads, .self = &self, .run = run_task};
    ld_status status = make_workers(&self, error);
    if (!status)
        status = launch_itself(&self, error);
    if (!status)
        status = side_by_side_run(&work, error);
    free_workers(&self);
    step_course_free(&self.course);
    status = status ? status : self.status;
    return status == LD_ERR_INTERRUPTED
               ? ld_fail(error, status, "interrupted after %d of %d launches", self.done,
                         self.launches)
               : status;
}

// ---- from begin to end

ld_status ld_derivatives_find(const ld_model *model, const ld_derivative_key *keys, size_t count,
                              const ld_derivative_options *options, ld_derivatives **out,
                              ld_error *error)
{
    static const ld_derivative_options none;
    assert(model && keys && out);
    ld_error own;
    error = error ? error : &own;
    *out = NULL;
    ld_status status = check_model(model, count, error);
    if (status)
        return status;
    ld_derivatives *self = calloc(1, sizeof *self);
    if (!self)
        return no_memory(error);
    self->model = model;
    self->things = quantity_things_of(model);
    self->summary = calloc(1 + 2 * count, sizeof *self->summary);
    self->same_events = calloc(1 + 2 * count, sizeof *self->same_events);
    status = self->summary && self->same_events ? LD_OK : no_memory(error);
    for (size_t i = 0; i < count && !status; i++)
        status = read_key(self, &keys[i], error);
    if (!status)
        status = run_all(self, options ? options : &none, error);
    if (status)
        ld_derivatives_free(self);
    else
        *out = self;
    return status;
}

void ld_derivatives_free(ld_derivatives *self)
{
    if (!self)
        return;
    free(self->summary);
    free(self->same_events);
    free(self);
}

ld_derivative derivative_of(const ld_derivatives *self, const quantity_walk *result, int key)
{
    const ld_summary *beside = &self->summary[1 + 2 * key];
    double value = quantity_value(result, &self->summary[0].rocket[0]);
    double left = quantity_value(result, &beside[0].rocket[0]);
    double right = quantity_value(result, &beside[1].rocket[0]), step = self->key[key].step;
    return (ld_derivative){.value = value,
                           .derivative = (right - left) / (2 * step),
                           .left = (value - left) / step,
                           .right = (right - value) / step,
                           .same_events =
                               self->same_events[1 + 2 * key] && self->same_events[2 + 2 * key]};
}

ld_status ld_derivatives_get(const ld_derivatives *self, const char *result, size_t key,
                             ld_derivative *value, ld_error *error)
{
    quantity_walk at = study_result_find(&self->things, result);
    if (!at.row)
        return ld_fail(error, LD_ERR_INPUT, "there is no result \"%s\"", VISIBLE(result));
    if (key >= (size_t)self->keys)
        return ld_fail(error, LD_ERR_INPUT, "there are %d keys: expected one from 0 to %d",
                       self->keys, self->keys - 1);
    *value = derivative_of(self, &at, (int)key);
    return LD_OK;
}
