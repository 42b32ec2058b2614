#include "state/stepping/long_steps.h"

#include <math.h>
#include <string.h>

#include "integration/exponential_steps.h"
#include "math/matrices/exponential.h"
#include "model/parts.h"
#include "state/stepping/integrated_steps.h"

typedef struct long_steps {
    integrated_steps between;
    exponential_steps *exponential;
    double t_explicit; // [s] until when the integrator's steps are taken instead
    int block[LD_MAX_STATES];
    bool place[LD_MAX_STATES]; // states that are places in I, x, y and z after each other
} long_steps;

// Once a long step is taken, until the integrator takes over.
static const stepper in_long_step;

// All continues as now as if it were rigid: what carries the tube by its own rates, the tube with
// its base, wheels and the like straight on beside it.
static void rigid_rates(double t, const double *y, const double *y_dot, double *rates, void *user)
{
    const long_steps *self = user;
    const launcher_system *launcher = &self->between.propagator.launch->launcher;
    const launching_layout *at = &launcher->launching.layout;
    launcher_input input;
    launcher_place(launcher, t, y, &input);
    const base_frame *tube = &input.launching.base;
    double v[3];
    v3_store(v, tube->v);
    for (int i = 0, k = 0; i < launcher->state_count; i++) {
        int of_base = i - launcher->base_at;
        bool carries = of_base >= 0 && of_base < launcher->base.speed_at;
        rates[i] = carries ? y_dot[i] : self->place[i] ? v[k % 3] : 0;
        k += self->place[i];
    }
    quat q = q_from(y + at->quaternion);
    v3 lever = v3_sub(v3_from(y + at->r), tube->r);
    quat q_dot = q_rate(q, m3_apply_transposed(q_matrix(q), tube->w));
    v3_store(rates + at->r, v3_add(tube->v, v3_cross(tube->w, lever)));
    memcpy(rates + at->quaternion, &q_dot, sizeof q_dot);
}

// Tube, rocket and what carries them have one Jacobian, other parts of a base one each; how many.
static int find_blocks(const launcher_system *launcher, int *block)
{
    const base_dynamics *base = launcher->base.kind->dynamics;
    int count = 1;
    for (int i = 0; i < launcher->state_count; i++) {
        int part = i < launcher->base_at ? 0
                   : i >= launcher->work_at || !base
                       ? EXPONENTIAL_NO_BLOCK
                       : base->part_of(&launcher->base, i - launcher->base_at);
        block[i] = part;
        count = part >= count ? part + 1 : count;
    }
    return count;
}

bool long_steps_apply(const launch_state *launch)
{
    const ld_run_settings *run = model_run(launch->model);
    const base_system *base = &launch->launcher.base;
    bool sampled = base->kind->next_sample && !isinf(base->kind->next_sample(base, -run->lead_in));
    return run->lead_in_method == LD_LEAD_IN_EXPONENTIAL && !base->kind->receive_frame && !sampled;
}

static ld_status create(propagator *object, ld_error *error)
{
    long_steps *self = (long_steps *)object;
    const launch_state *launch = object->launch;
    tolerances all;
    tolerances_find(launch, &all);
    integrator_settings equations = integrated_settings(object, &all);
    exponential_steps_settings settings = {
        .equations = &equations,
        .block = self->block,
        .block_count = find_blocks(&launch->launcher, self->block),
        .row = model_run(launch->model)->output_step_lead_in,
        .drift = rigid_rates,
    };
    memcpy(self->place, all.absolute, sizeof self->place);
    ld_status status = exponential_steps_create(&settings, &self->exponential, error);
    return status ? status : integrator_create(&equations, &self->between.integrator, error);
}

static void release(propagator *object)
{
    const long_steps *self = (const long_steps *)object;
    exponential_steps_free(self->exponential);
    integrator_free(self->between.integrator);
}

// Whether the equations are such that long steps pay: nothing drives a rocket through its tube.
static bool goes_slowly(const launch_state *launch)
{
    return !(launch->phase.rocket && launch_is_ignited(launch));
}

// What stands in the tube: nothing, a rocket, one that is held.
static int kind_of_equations(const launch_state *launch)
{
    return launch->phase.rocket ? 1 + launch->phase.locked : 0;
}

static ld_status start(propagator *object, double t, const double *y, bool anew, ld_error *error)
{
    long_steps *self = (long_steps *)object;
    if (anew)
        exponential_steps_count_from(self->exponential, t);
    self->t_explicit = -INFINITY;
    object->stepper = &long_stepper;
    int kind = kind_of_equations(object->launch);
    if (goes_slowly(object->launch) && exponential_steps_take(self->exponential, kind, error))
        return LD_ERR_MEMORY;
    return integrator_start(self->between.integrator, t, y, error);
}

// The integrator takes over where the last long step has ended, or from where it began.
static ld_status take_over(propagator *object, double t, const double *y, ld_error *error)
{
    long_steps *self = (long_steps *)object;
    object->stepper = &long_stepper;
    self->between.stopped = false;
    return integrator_start(self->between.integrator, t, y, error);
}

static integrator_outcome step(propagator *object, double t_stop, ld_error *error)
{
    long_steps *self = (long_steps *)object;
    double t = object->stepper->time(object);
    const double *y = object->stepper->state(object);
    bool slowly = goes_slowly(object->launch);
    if (slowly && t >= self->t_explicit) {
        if (object->stepper != &in_long_step)
            exponential_steps_start(self->exponential, t, y);
        object->stepper = &in_long_step;
        exponential_outcome outcome = exponential_steps_step(self->exponential, t_stop);
        if (outcome != EXPONENTIAL_REFUSED)
            return outcome == EXPONENTIAL_STOPPED ? INTEGRATOR_STOPPED : INTEGRATOR_STEPPED;
        self->t_explicit = exponential_steps_resume(self->exponential);
    }
    if (object->stepper == &in_long_step &&
        take_over(object, t, exponential_steps_state(self->exponential), error))
        return INTEGRATOR_FAILED;
    integrator_outcome outcome =
        integrated_step(object, slowly ? fmin(t_stop, self->t_explicit) : t_stop, error);
    bool between = outcome == INTEGRATOR_STOPPED && integrated_time(object) < t_stop;
    return between ? INTEGRATOR_STEPPED : outcome;
}

// The long step that has been taken is left for explicit ones, the first of which may end before t.
static integrator_outcome go_back_within(propagator *object, double t, ld_error *error)
{
    long_steps *self = (long_steps *)object;
    const exponential_steps *steps = self->exponential;
    if (take_over(object, exponential_steps_previous_time(steps), exponential_steps_previous(steps),
                  error))
        return INTEGRATOR_FAILED;
    self->t_explicit = t;
    integrator_outcome outcome = integrated_step(object, t, error);
    return outcome == INTEGRATOR_STOPPED ? INTEGRATOR_STEPPED : outcome;
}

static exponential_steps *exponential_of(const propagator *self)
{
    return ((const long_steps *)self)->exponential;
}

static double long_time(const propagator *self)
{
    return exponential_steps_time(exponential_of(self));
}

static double long_previous_time(const propagator *self)
{
    return exponential_steps_previous_time(exponential_of(self));
}

static const double *long_state(const propagator *self)
{
    return exponential_steps_state(exponential_of(self));
}

static void long_interpolate(propagator *self, double t, double *y)
{
    exponential_steps_interpolate(exponential_of(self), t, y);
}

static int64_t count(const propagator *self)
{
    return exponential_steps_count(exponential_of(self)) + integrated_count(self);
}

static int64_t evaluations(const propagator *self)
{
    return integrated_evaluations(self) + exponential_steps_evaluations(exponential_of(self));
}

static void archive_all(propagator *object, archive *bytes)
{
    long_steps *self = (long_steps *)object;
    bool in_one = object->stepper == &in_long_step;
    integrator_archive(self->between.integrator, bytes);
    archive_expect(bytes, true); // long steps
    archive_bool(bytes, &in_one);
    object->stepper = in_one ? &in_long_step : &long_stepper;
    archive_double(bytes, &self->t_explicit);
    exponential_steps_archive(self->exponential, bytes);
    archive_expect(bytes, false); // nothing apart
}

const stepper long_stepper = {
    .size = sizeof(long_steps),
    .create = create,
    .release = release,
    .start = start,
    .step = step,
    .go_back = integrated_go_back,
    .time = integrated_time,
    .previous_time = integrated_previous_time,
    .state = integrated_state,
    .interpolate = integrated_interpolate,
    .event = integrated_event,
    .error = integrated_error,
    .steps = count,
    .most_steps = count,
    .evaluations = evaluations,
    .archive = archive_all,
};

// Such a step ends on no event, and its error is not estimated.
static const stepper in_long_step = {
    .release = release,
    .start = start,
    .step = step,
    .go_back = go_back_within,
    .time = long_time,
    .previous_time = long_previous_time,
    .state = long_state,
    .interpolate = long_interpolate,
    .steps = count,
    .most_steps = count,
    .evaluations = evaluations,
    .archive = archive_all,
};
