#include "state/stepping/partitioned_steps.h"

#include <math.h>
#include <string.h>

#include "elements/held_frame.h"
#include "elements/held_wrench.h"
#include "model/parts.h"
#include "state/evaluation.h"
#include "state/stepping/integrated_steps.h"
#include "systems/bases/mechanism_base.h"
#include "systems/launching/launching_dynamics.h"
#include "systems/mechanism/mechanism_evaluation.h"
#include "systems/mechanism/mechanism_motion.h"

enum { BODIES_MOST = MECHANISM_MOST_STATES + MECHANISM_POWERS + 1 };
enum { MARCHING_MOST = WHEEL_STATES * LD_MAX_WHEELS + 1 + MARCHING_POWERS };

typedef struct partitioned_steps {
    integrated_steps launching;  // its integrator has the launching subsystem's states and works
    double state[LD_MAX_STATES]; // of the whole
    const mechanism_base *vehicle;
    int marching_at;  // where the wheels begin among the base's states
    double t, t_next; // [s] the last exchange and the next
    int64_t exchanges;
    double t_first; // [s] the instants count from here
    held_frame chassis, tube;
    held_wrench on_chassis, on_tube;
    integrator *bodies, *marching; // of the bodies; of the wheels, NULL: there are none
    int body_count, marching_count, marching_works;
    double from[LD_MAX_STATES], rate_from[LD_MAX_STATES]; // base states and works at the last
    double to[LD_MAX_STATES], rate_to[LD_MAX_STATES];     // exchange, and at the next
} partitioned_steps;

static launch_state *launch_of(const partitioned_steps *self)
{
    return self->launching.propagator.launch;
}

// ---- the subsystems' equations ----

static void find_launching_input(const partitioned_steps *self, double t, const double *y,
                                 launching_input *input)
{
    held_frame_at(&self->tube, t - self->t, &input->base);
    input->station = NULL;
    simulation_surround(launch_of(self), t, y, input);
}

static int launching_rhs(double t, const double *y, double *y_dot, void *user)
{
    partitioned_steps *self = user;
    launch_state *launch = launch_of(self);
    const launcher_system *launcher = &launch->launcher;
    launching_input input;
    launching_output *out = &launch->latest.out.launching;
    find_launching_input(self, t, y, &input);
    launch->latest.known = false; // not one of the whole
    launching_outcome outcome = launcher_evaluate_tube(
        launcher, model_run(launch->model)->formulation, &input, &launch->phase, y, out);
    simulation_note_outcome(launch, outcome);
    if (outcome)
        return -1;
    int count = launcher->launching.layout.count;
    launching_rates(&launcher->launching, y, out, launch->phase.rocket, y_dot);
    int works = launcher->launching.work_count;
    memcpy(y_dot + count, out->power, (size_t)works * sizeof *y_dot);
    return all_finite(count + works, y_dot) ? 0 : -1;
}

static int project_launching(double t, double *y, void *user)
{
    const partitioned_steps *self = user;
    launching_input input;
    find_launching_input(self, t, y, &input);
    launching_project(&launch_of(self)->launcher.launching, &input, &launch_of(self)->phase, y);
    return 0;
}

static int launching_events(double t, const double *y, double *g, void *user)
{
    partitioned_steps *self = user;
    double unused[LD_MAX_STATES];
    if (launching_rhs(t, y, unused, user))
        return -1;
    events_evaluate(&self->launching.propagator.events, launch_of(self),
                    &launch_of(self)->latest.out, g);
    return 0;
}

static int bodies_rhs(double t, const double *y, double *y_dot, void *user)
{
    partitioned_steps *self = user;
    const launch_state *launch = launch_of(self);
    const base_system *base = &launch->launcher.base;
    const mechanism_system *bodies = mechanism_of(base);
    double tau = t - self->t;
    mechanism_motion motion;
    mechanism_output out;
    mechanism_input input = {.rest = launch->rest.hold, .linear = launch->phase.frictionless};
    held_wrench_at(&self->on_chassis, tau, &input.wheel_force, &input.wheel_moment);
    held_wrench_at(&self->on_tube, tau, &input.tube_force, &input.tube_moment);
    base_frame carrier = mechanism_base_carrier(base, t);
    mechanism_move(bodies, t, &carrier, y, &motion);
    jet_wrench back = simulation_jets(launch, t, &motion.tube);
    input.tube_force = v3_add(input.tube_force, back.force);
    input.tube_moment = v3_add(input.tube_moment, back.moment);
    mechanism_base_find_air(self->vehicle, &motion, &input);
    if (mechanism_evaluate(bodies, &input, y, &motion, y_dot, &out))
        return -1;
    memcpy(y_dot + bodies->state_count, out.power,
           (size_t)self->vehicle->mechanism_works * sizeof *out.power);
    if (self->vehicle->has_jet)
        y_dot[self->body_count - 1] = jet_power(&back, &motion.tube);
    return all_finite(self->body_count, y_dot) ? 0 : -1;
}

static int project_bodies(double t, double *y, void *user)
{
    const partitioned_steps *self = user;
    const base_system *base = &launch_of(self)->launcher.base;
    base->kind->dynamics->project(base, t, y);
    return 0;
}

static int marching_rhs(double t, const double *y, double *y_dot, void *user)
{
    partitioned_steps *self = user;
    const marching_system *marching = &self->vehicle->marching;
    marching_output out;
    base_frame chassis;
    held_frame_at(&self->chassis, t - self->t, &chassis);
    marching_evaluate(marching, &chassis, false, NULL, y, y_dot, &out);
    memcpy(y_dot + marching->state_count, out.power, sizeof out.power);
    return all_finite(self->marching_count, y_dot) ? 0 : -1;
}

// Between the whole state and a subsystem's: its states, then its works.
static void part_of(const double *y, int at, int count, int works_at, int works, double *part)
{
    memcpy(part, y + at, (size_t)count * sizeof(double));
    memcpy(part + count, y + works_at, (size_t)works * sizeof(double));
}

static void put_part(const double *part, int at, int count, int works_at, int works, double *y)
{
    memcpy(y + at, part, (size_t)count * sizeof(double));
    memcpy(y + works_at, part + count, (size_t)works * sizeof(double));
}

static void split_launching(const launcher_system *launcher, const double *y, double *part)
{
    const launching_system *launching = &launcher->launching;
    part_of(y, 0, launching->layout.count, launcher->work_at, launching->work_count, part);
}

// Where the base's works begin in the whole state.
static int base_works_at(const launcher_system *launcher)
{
    return launcher->work_at + launcher->launching.work_count;
}

// The parts of bodies and wheels of the whole state. The work of jets is the base's last one.
static void split_base(const partitioned_steps *self, const double *y, double *bodies,
                       double *marching)
{
    const launcher_system *launcher = &launch_of(self)->launcher;
    int works = base_works_at(launcher), own = self->vehicle->mechanism_works;
    part_of(y, launcher->base_at, self->marching_at, works, own, bodies);
    part_of(y, launcher->base_at + self->marching_at, self->vehicle->marching.state_count,
            works + own, self->marching_works, marching);
    if (self->vehicle->has_jet)
        bodies[self->body_count - 1] = y[launcher->state_count - 1];
}

static void join_base(const partitioned_steps *self, const double *bodies, const double *marching,
                      double *y)
{
    const launcher_system *launcher = &launch_of(self)->launcher;
    int works = base_works_at(launcher), own = self->vehicle->mechanism_works;
    put_part(bodies, launcher->base_at, self->marching_at, works, own, y);
    put_part(marching, launcher->base_at + self->marching_at, self->vehicle->marching.state_count,
             works + own, self->marching_works, y);
    if (self->vehicle->has_jet)
        y[launcher->state_count - 1] = bodies[self->body_count - 1];
}

// The base's states at an instant between the last exchange and the next: cubic Hermite.
static void base_between(const partitioned_steps *self, double t, double *y)
{
    const launcher_system *launcher = &launch_of(self)->launcher;
    double h = self->t_next - self->t, x = h > 0 ? (t - self->t) / h : 0;
    double a = (1 + 2 * x) * (1 - x) * (1 - x), b = x * (1 - x) * (1 - x) * h;
    double c = x * x * (3 - 2 * x), d = -x * x * (1 - x) * h;
    for (int i = launcher->base_at; i < launcher->state_count; i++)
        if (i < launcher->work_at || i >= launcher->work_at + launcher->launching.work_count)
            y[i] =
                a * self->from[i] + b * self->rate_from[i] + c * self->to[i] + d * self->rate_to[i];
}

// The whole state at time t within the launching subsystem's last step, whose state is `y`.
static void join(const partitioned_steps *self, double t, const double *y, double *whole)
{
    const launcher_system *launcher = &launch_of(self)->launcher;
    const launching_system *launching = &launcher->launching;
    put_part(y, 0, launching->layout.count, launcher->work_at, launching->work_count, whole);
    base_between(self, t, whole);
}

// Takes a subsystem to the next exchange.
static ld_status go_to(integrator *part, double t_next, ld_error *error)
{
    double t = integrator_time(part), most = 20000 * fmax(1, (t_next - t) / 1e-3);
    for (int64_t steps = 0; integrator_time(part) < t_next; steps++) {
        if ((double)steps > most)
            return ld_fail(error, LD_ERR_NUMERIC,
                           "the steps became too short to continue: more than %.0f steps between "
                           "two exchanges of the subsystems, up to t = %.9g s; check for a damper "
                           "or friction of the vehicle that is far too stiff",
                           most, integrator_time(part));
        if (integrator_step(part, t_next, error) == INTEGRATOR_FAILED)
            return integrator_failure(part);
    }
    return LD_OK;
}

// Takes chassis and wheels from their part of the state y at the last exchange to the next.
static ld_status take_base_on(partitioned_steps *self, const double *y, ld_error *error)
{
    double bodies[BODIES_MOST], marching[MARCHING_MOST] = {0}, rate[2][LD_MAX_STATES];
    bool rolls = self->marching != NULL;
    memcpy(self->from, y, (size_t)launch_of(self)->launcher.state_count * sizeof(double));
    split_base(self, y, bodies, marching);
    ld_status status = integrator_start(self->bodies, self->t, bodies, error);
    if (!status && rolls)
        status = integrator_start(self->marching, self->t, marching, error);
    if (!status)
        status = go_to(self->bodies, self->t_next, error);
    if (!status && rolls)
        status = go_to(self->marching, self->t_next, error);
    if (status)
        return status;

    bodies_rhs(self->t, bodies, rate[0], self);
    if (rolls)
        marching_rhs(self->t, marching, rate[1], self);
    join_base(self, rate[0], rate[1], self->rate_from);
    const double *chassis = integrator_state(self->bodies);
    const double *marched = rolls ? integrator_state(self->marching) : marching;
    bodies_rhs(self->t_next, chassis, rate[0], self);
    if (rolls)
        marching_rhs(self->t_next, marched, rate[1], self);
    join_base(self, rate[0], rate[1], self->rate_to);
    join_base(self, chassis, marched, self->to);
    return LD_OK;
}

// Instant of the next exchange, of those after t; the corners of commands at `t_stop` before it.
static double next_exchange(partitioned_steps *self, double t, double t_stop)
{
    double step = model_run(launch_of(self)->model)->coupling_step;
    while (self->t_first + (double)self->exchanges * step <= t + 1e-9 * step)
        self->exchanges++;
    // a stop that the next exchange misses by rounding is that exchange: the accelerations that
    // frames continue with would be noise over such a step
    double next = self->t_first + (double)self->exchanges * step;
    return next > t_stop - 1e-9 * step ? t_stop : next;
}

// Exchange at t: frames and wrenches at the state y; then chassis and wheels continue to the next
// instant.
static ld_status exchange(partitioned_steps *self, double t, const double *y, double t_stop,
                          ld_error *error)
{
    launch_state *launch = launch_of(self);
    launcher_input input;
    launcher_output *out = &launch->latest.out;
    double since = t - self->t;
    simulation_input(launch, t, y, &input);
    launch->latest.known = false;
    if (launcher_evaluate(&launch->launcher, &input, &launch->phase, y, out))
        return ld_fail(error, LD_ERR_NUMERIC, "the exchange at t = %.9g s has no solution", t);
    held_frame_take(&self->tube, &input.found.mechanism.tube, since);
    if (self->marching) {
        base_frame chassis = mechanism_base_chassis(&launch->launcher.base, &input.found.mechanism);
        chassis.q = q_from_matrix(chassis.A);
        held_frame_take(&self->chassis, &chassis, since);
        const marching_output *wheels = &out->base.report.marching;
        held_wrench_take(&self->on_chassis, wheels->force, wheels->moment, since);
    }
    held_wrench_take(&self->on_tube, out->launching.base_force, out->launching.base_moment, since);
    self->t = t;
    self->t_next = next_exchange(self, t, t_stop);
    return take_base_on(self, y, error);
}

static ld_status create_base(partitioned_steps *self, const integrator_settings *whole,
                             const tolerances *all, ld_error *error)
{
    const launcher_system *launcher = &launch_of(self)->launcher;
    double atol[2][LD_MAX_STATES];
    bool absolute[2][LD_MAX_STATES] = {{false}};
    for (int i = 0; i < LD_MAX_STATES; i++)
        atol[0][i] = atol[1][i] = INFINITY;
    for (int i = 0; i < self->marching_at; i++) {
        atol[0][i] = all->atol[launcher->base_at + i];
        absolute[0][i] = all->absolute[launcher->base_at + i];
    }
    for (int i = 0; i < self->vehicle->marching.state_count; i++) {
        atol[1][i] = all->atol[launcher->base_at + self->marching_at + i];
        absolute[1][i] = all->absolute[launcher->base_at + self->marching_at + i];
    }
    self->body_count = self->marching_at + self->vehicle->mechanism_works + self->vehicle->has_jet;
    self->marching_works = self->vehicle->has_wheels ? MARCHING_POWERS : 0;
    self->marching_count = self->vehicle->marching.state_count + self->marching_works;
    integrator_settings settings = *whole;
    settings.events = NULL;
    settings.event_count = 0;
    settings.project = launcher->base.drifts ? project_bodies : NULL;
    settings.max_step = 0;
    settings.n = (size_t)self->body_count;
    settings.rhs = bodies_rhs;
    settings.atol = atol[0];
    settings.absolute = absolute[0];
    ld_status status = integrator_create(&settings, &self->bodies, error);
    if (status || !self->vehicle->has_wheels)
        return status;
    settings.project = NULL;
    settings.n = (size_t)self->marching_count;
    settings.rhs = marching_rhs;
    settings.atol = atol[1];
    settings.absolute = absolute[1];
    return integrator_create(&settings, &self->marching, error);
}

// ---- long steps ----

// All continues as now as if it were rigid: what carries the tube by its own rates, the tube with
// its base, wheels and the like straight on beside it.

bool partitioned_steps_apply(const launch_state *launch)
{
    const base_system *base = &launch->launcher.base;
    return (base_is_vehicle(base) || base_as_multibody(base)) &&
           model_run(launch->model)->coupling_step > 0;
}

static ld_status create(propagator *object, ld_error *error)
{
    partitioned_steps *self = (partitioned_steps *)object;
    const launching_system *launching = &object->launch->launcher.launching;
    self->vehicle = object->launch->launcher.base.own;
    self->marching_at = mechanism_base_marching_at(&object->launch->launcher.base);
    tolerances all;
    tolerances_find(object->launch, &all);
    integrator_settings settings = integrated_settings(object, &all);
    ld_status status = create_base(self, &settings, &all, error);
    int count = launching->layout.count, works = launching->work_count;
    for (int i = 0; i < works; i++) {
        all.atol[count + i] = INFINITY;
        all.absolute[count + i] = false;
    }
    settings.n = (size_t)(count + works);
    settings.rhs = launching_rhs;
    settings.project = settings.project ? project_launching : NULL;
    settings.events = launching_events;
    return status ? status : integrator_create(&settings, &self->launching.integrator, error);
}

static void release(propagator *object)
{
    const partitioned_steps *self = (const partitioned_steps *)object;
    integrator_free(self->launching.integrator);
    integrator_free(self->bodies);
    integrator_free(self->marching);
}

// ---- steps ----

static ld_status start(propagator *object, double t, const double *y, bool anew, ld_error *error)
{
    partitioned_steps *self = (partitioned_steps *)object;
    const launcher_system *launcher = &object->launch->launcher;
    size_t size = (size_t)launcher->state_count * sizeof *y;
    double launching[LD_MAX_STATES];
    if (anew) {
        memset(&self->on_chassis, 0, sizeof self->on_chassis);
        memset(&self->on_tube, 0, sizeof self->on_tube);
        memset(&self->chassis, 0, sizeof self->chassis);
        memset(&self->tube, 0, sizeof self->tube);
        self->exchanges = 0;
        self->t = self->t_next = self->t_first = t;
        memcpy(self->to, y, size);
        memcpy(self->from, y, size);
    }
    memmove(self->state, y, size);
    split_launching(launcher, y, launching);
    return integrator_start(self->launching.integrator, t, launching, error);
}

static void join_state(partitioned_steps *self)
{
    const integrator *launching = self->launching.integrator;
    join(self, integrator_time(launching), integrator_state(launching), self->state);
}

static integrator_outcome step(propagator *object, double t_stop, ld_error *error)
{
    partitioned_steps *self = (partitioned_steps *)object;
    double t = integrated_time(object), launching[LD_MAX_STATES];
    if (t >= self->t_next) {
        if (exchange(self, t, self->state, t_stop, error))
            return INTEGRATOR_FAILED;
        split_launching(&object->launch->launcher, self->state, launching);
        if (integrator_start(self->launching.integrator, t, launching, error))
            return INTEGRATOR_FAILED;
    }
    integrator_outcome outcome = integrated_step(object, fmin(t_stop, self->t_next), error);
    join_state(self);
    bool between = outcome == INTEGRATOR_STOPPED && integrated_time(object) < t_stop;
    return between ? INTEGRATOR_STEPPED : outcome;
}

static integrator_outcome go_back(propagator *object, double t, ld_error *error)
{
    integrator_outcome outcome = integrated_go_back(object, t, error);
    join_state((partitioned_steps *)object);
    return outcome;
}

static const double *state(const propagator *object)
{
    return ((const partitioned_steps *)object)->state;
}

static void interpolate(propagator *object, double t, double *y)
{
    double launching[LD_MAX_STATES];
    integrated_interpolate(object, t, launching);
    join((const partitioned_steps *)object, t, launching, y);
}

static int64_t most_steps(const propagator *object)
{
    const partitioned_steps *self = (const partitioned_steps *)object;
    int64_t most = integrated_count(object);
    for (int i = 0; i < 2; i++) {
        if (i && !self->marching)
            continue;
        int64_t steps = integrator_steps(i ? self->marching : self->bodies);
        most = steps > most ? steps : most;
    }
    return most;
}

static int64_t evaluations(const propagator *object)
{
    const partitioned_steps *self = (const partitioned_steps *)object;
    return integrated_evaluations(object) + integrator_evaluations(self->bodies) +
           (self->marching ? integrator_evaluations(self->marching) : 0);
}

// ---- saving and loading ----

static void archive_vector(archive *bytes, v3 *v)
{
    double *member[] = {&v->x, &v->y, &v->z};
    for (int i = 0; i < 3; i++)
        archive_double(bytes, member[i]);
}

static void archive_frame(archive *bytes, held_frame *held)
{
    base_frame *last = &held->last;
    archive_vector(bytes, &last->r);
    archive_vector(bytes, &last->v);
    archive_vector(bytes, &last->w);
    for (int i = 0; i < 3; i++)
        archive_doubles(bytes, last->A.a[i], 3);
    double *member[] = {&last->q.w, &last->q.x, &last->q.y, &last->q.z};
    for (int i = 0; i < 4; i++)
        archive_double(bytes, member[i]);
    archive_vector(bytes, &held->a);
    archive_vector(bytes, &held->alpha);
}

static void archive_wrench(archive *bytes, held_wrench *held)
{
    archive_vector(bytes, &held->force);
    archive_vector(bytes, &held->moment);
    archive_vector(bytes, &held->force_rate);
    archive_vector(bytes, &held->moment_rate);
}

static void archive_all(propagator *object, archive *bytes)
{
    partitioned_steps *self = (partitioned_steps *)object;
    const launch_state *launch = object->launch;
    integrator_archive(self->launching.integrator, bytes);
    archive_expect(bytes, false); // no long steps
    archive_expect(bytes, true);  // subsystems apart
    integrator_archive(self->bodies, bytes);
    if (self->marching)
        integrator_archive(self->marching, bytes);
    double *instants[] = {&self->t, &self->t_next, &self->t_first};
    for (int i = 0; i < 3; i++)
        archive_double(bytes, instants[i]);
    archive_count(bytes, &self->exchanges);
    // the exchanges are counted up to one that lies ahead
    double step = model_run(launch->model)->coupling_step;
    bytes->failed |= !(self->t_first + ((double)self->exchanges + 1) * step >= self->t);
    archive_frame(bytes, &self->chassis);
    archive_frame(bytes, &self->tube);
    archive_wrench(bytes, &self->on_chassis);
    archive_wrench(bytes, &self->on_tube);
    double *states[] = {self->state, self->from, self->rate_from, self->to, self->rate_to};
    for (int i = 0; i < 5; i++)
        archive_doubles(bytes, states[i], (size_t)launch->launcher.state_count);
}

const stepper partitioned_stepper = {
    .size = sizeof(partitioned_steps),
    .create = create,
    .release = release,
    .start = start,
    .step = step,
    .go_back = go_back,
    .time = integrated_time,
    .previous_time = integrated_previous_time,
    .state = state,
    .interpolate = interpolate,
    .event = integrated_event,
    .error = integrated_error,
    .steps = integrated_count,
    .most_steps = most_steps,
    .evaluations = evaluations,
    .archive = archive_all,
};
