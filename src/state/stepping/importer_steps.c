#include "state/stepping/importer_steps.h"

#include <math.h>
#include <string.h>

#include "state/evaluation.h"
#include "state/stepping/stepper.h"
#include "state/stepping/tolerances.h"

typedef struct exchange_point {
    double t; // [s]
    double y[LD_MAX_STATES], rate[LD_MAX_STATES];
} exchange_point;

// The point where the integrator is, the last one that counts as a step's end, and what has gone
// through zero between the two.
typedef struct importer_steps {
    propagator propagator;
    int states, events;
    exchange_point last, now;   // the rates of `now` once a step ends there
    bool accepted;              // one does
    double value[EVENTS_MOST];  // of the events, at `last`
    int direction[EVENTS_MOST]; // in which each goes through zero up to `now`, 0: it does not
    int64_t steps, evaluations;
} importer_steps;

void propagator_place(propagator *object, double t, const double *y)
{
    importer_steps *self = (importer_steps *)object;
    size_t size = (size_t)self->states * sizeof *y;
    if (t == self->now.t && memcmp((const char *)y, (const char *)self->now.y, size) == 0)
        return;
    self->now.t = t;
    memmove(self->now.y, y, size);
    self->accepted = false;
}

bool propagator_has_accepted(const propagator *object)
{
    return ((const importer_steps *)object)->accepted;
}

// Rates [states] and values of the events there.
static ld_status find_there(importer_steps *self, double *value, ld_error *error)
{
    launch_state *launch = self->propagator.launch;
    exchange_point *now = &self->now;
    bool known = simulation_is_latest(launch, now->t, now->y);
    if (known)
        launcher_rates(&launch->launcher, now->y, &launch->latest.out, launch->phase.rocket,
                       now->rate);
    self->evaluations += !known;
    if (known ? !all_finite(self->states, now->rate)
              : simulation_rates(launch, now->t, now->y, now->rate))
        return ld_fail(error, LD_ERR_NUMERIC,
                       "the equations of motion gave no finite result at t = %.9g s", now->t);
    events_evaluate(&self->propagator.events, launch, &launch->latest.out, value);
    return LD_OK;
}

// A value that begins at zero itself goes nowhere.
static int direction_of(double before, double now)
{
    return before > 0 && now <= 0 ? -1 : before < 0 && now >= 0 ? 1 : 0;
}

ld_status propagator_accept(propagator *object, bool *crossed, ld_error *error)
{
    importer_steps *self = (importer_steps *)object;
    double value[EVENTS_MOST];
    ld_status status = find_there(self, value, error);
    *crossed = false;
    if (status)
        return status;
    self->accepted = true;
    self->steps++;
    for (int i = 0; i < self->events; i++) {
        self->direction[i] = direction_of(self->value[i], value[i]);
        *crossed |= self->direction[i] != 0;
    }
    return LD_OK;
}

ld_status propagator_continue(propagator *object, ld_error *error)
{
    importer_steps *self = (importer_steps *)object;
    double value[EVENTS_MOST];
    ld_status status = find_there(self, value, error);
    if (status)
        return status;
    self->last = self->now;
    self->accepted = true;
    memcpy(self->value, value, (size_t)self->events * sizeof *value);
    memset(self->direction, 0, sizeof self->direction);
    return LD_OK;
}

bool propagator_project(propagator *object, double *y)
{
    const importer_steps *self = (const importer_steps *)object;
    const launch_state *launch = object->launch;
    const exchange_point *now = &self->now;
    tolerances all;
    memcpy(y, now->y, (size_t)self->states * sizeof *y);
    if (!launch->launcher.base.drifts && !launching_holds_places(&launch->launcher.launching))
        return false;
    simulation_project(launch, now->t, y);
    tolerances_find(launch, &all);
    for (int i = 0; i < self->states; i++)
        if (fabs(y[i] - now->y[i]) > all.atol[i])
            return true;
    return false;
}

static ld_status create(propagator *object, ld_error *error)
{
    importer_steps *self = (importer_steps *)object;
    (void)error;
    self->states = object->launch->launcher.state_count;
    self->events = object->events.count;
    return LD_OK;
}

static void release(propagator *object)
{
    (void)object;
}

static ld_status start(propagator *object, double t, const double *y, bool anew, ld_error *error)
{
    (void)anew;
    propagator_place(object, t, y);
    return propagator_continue(object, error);
}

static double time_now(const propagator *object)
{
    return ((const importer_steps *)object)->now.t;
}

static double previous_time(const propagator *object)
{
    return ((const importer_steps *)object)->last.t;
}

static const double *state(const propagator *object)
{
    return ((const importer_steps *)object)->now.y;
}

// Cubic Hermite interpolation between the two points.
static void interpolate(propagator *object, double t, double *y)
{
    const importer_steps *self = (const importer_steps *)object;
    const exchange_point *from = &self->last, *to = &self->now;
    double h = to->t - from->t, x = h > 0 ? (t - from->t) / h : 1;
    double a = (1 + 2 * x) * (1 - x) * (1 - x), b = x * (1 - x) * (1 - x) * h;
    double c = x * x * (3 - 2 * x), d = -x * x * (1 - x) * h;
    for (int i = 0; i < self->states; i++)
        y[i] = t == to->t ? to->y[i]
                          : a * from->y[i] + b * from->rate[i] + c * to->y[i] + d * to->rate[i];
}

static int direction(const propagator *object, int i)
{
    return ((const importer_steps *)object)->direction[i];
}

static int64_t count(const propagator *object)
{
    return ((const importer_steps *)object)->steps;
}

static int64_t evaluations(const propagator *object)
{
    return ((const importer_steps *)object)->evaluations;
}

static void archive_point(exchange_point *point, int states, archive *bytes)
{
    archive_double(bytes, &point->t);
    archive_doubles(bytes, point->y, (size_t)states);
    archive_doubles(bytes, point->rate, (size_t)states);
}

static void archive_all(propagator *object, archive *bytes)
{
    importer_steps *self = (importer_steps *)object;
    archive_point(&self->last, self->states, bytes);
    archive_point(&self->now, self->states, bytes);
    archive_bool(bytes, &self->accepted);
    archive_doubles(bytes, self->value, (size_t)self->events);
    for (int i = 0; i < self->events; i++)
        archive_int(bytes, &self->direction[i], -1, 1);
    archive_count(bytes, &self->steps);
    archive_count(bytes, &self->evaluations);
}

const stepper importer_stepper = {
    .size = sizeof(importer_steps),
    .create = create,
    .release = release,
    .start = start,
    .time = time_now,
    .previous_time = previous_time,
    .state = state,
    .interpolate = interpolate,
    .event = direction,
    .steps = count,
    .most_steps = count,
    .evaluations = evaluations,
    .archive = archive_all,
};
