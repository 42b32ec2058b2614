#include "state/propagator.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "elements/held_frame.h"
#include "elements/held_wrench.h"
#include "integration/exponential_steps.h"
#include "math/matrices/exponential.h"
#include "state/evaluation.h"
#include "state/outside_steps.h"
#include "systems/launching/launching_dynamics.h"
#include "systems/launching/launching_figures.h"
#include "systems/launching/launching_kinematics.h"

// ---- tolerances ----

// Absolute tolerance per kind of state; positions in I have no relative one: a vehicle may be far
// from the origin. Works are quadratures: they do not steer the step, with infinity for a
// tolerance, whose shares of the error are zero and not denormal numbers.
typedef struct tolerances {
    double atol[LD_MAX_STATES];
    bool absolute[LD_MAX_STATES];
} tolerances;

static void find_tolerances(const launch_state *self, tolerances *all)
{
    const launching_layout *at = &self->launcher.launching.layout;
    double tolerance = self->model->run.tolerance, *atol = all->atol;
    memset(all->absolute, 0, sizeof all->absolute);
    for (int i = 0; i < LD_MAX_STATES; i++)
        atol[i] = INFINITY;
    for (int i = 0; i < 3; i++) {
        atol[at->r + i] = 1e-2 * tolerance;
        all->absolute[at->r + i] = true;
        atol[at->v + i] = atol[at->w + i] = tolerance;
        atol[at->V + i] = atol[at->V + 3 + i] = tolerance;
    }
    for (int i = 0; i < X_COUNT; i++)
        atol[at->x + i] = i == X_S ? tolerance : 1e-2 * tolerance;
    for (int i = 0; i < 4; i++)
        atol[at->quaternion + i] = 1e-2 * tolerance;
    for (int i = 0; i < at->nq; i++) {
        atol[at->q + i] = 1e-2 * tolerance;
        atol[at->q_dot + i] = tolerance;
    }
    const base_dynamics *base = self->launcher.base.kind->dynamics;
    int base_at = self->launcher.base_at;
    if (base)
        base->tolerances(&self->launcher.base, tolerance, atol + base_at, all->absolute + base_at);
}

enum { ORIENTATING_MOST = ORIENTATING_MOST_STATES + ORIENTATING_POWERS + 1 };
enum { MARCHING_MOST = WHEEL_STATES * LD_MAX_WHEELS + 1 + MARCHING_POWERS };

struct propagator {
    launch_state *launch;
    event_list events;
    integrator *integrator; // of all, or of the launching subsystem
    bool stopped;           // its last step landed on a stop
    outside_steps *outside; // in its place; NULL: it takes the steps
    double state[LD_MAX_STATES];

    // together alone
    exponential_steps *exponential; // while no rocket is driven through its tube; NULL: never
    bool long_step;                 // the last step was one of them
    double t_explicit;              // [s] until when the integrator's steps are taken instead
    int block[LD_MAX_STATES];
    bool place[LD_MAX_STATES]; // states that are places in I, x, y and z after each other

    // apart alone
    bool apart;
    const vehicle_system *vehicle;
    double t, t_next; // [s] the last exchange and the next
    int64_t exchanges;
    double t_first; // [s] the instants count from here
    held_frame chassis, tube;
    held_wrench on_chassis, on_tube;
    integrator *orientating, *marching;
    bool jet; // the orientating subsystem has the work of jets, too, behind its own
    int orientating_count, marching_count;
    double from[LD_MAX_STATES], rate_from[LD_MAX_STATES]; // base states and works at the last
    double to[LD_MAX_STATES], rate_to[LD_MAX_STATES];     // exchange, and at the next
};

// ---- together ----

static int rhs(double t, const double *y, double *y_dot, void *user)
{
    return simulation_rates(((propagator *)user)->launch, t, y, y_dot);
}

static int project(double t, double *y, void *user)
{
    simulation_project(((propagator *)user)->launch, t, y);
    return 0;
}

static int events(double t, const double *y, double *g, void *user)
{
    propagator *self = user;
    const launcher_output *out = simulation_output(self->launch, t, y);
    if (!out)
        return -1;
    events_evaluate(&self->events, self->launch, out, g);
    return 0;
}

// ---- steps taken outside ----

void propagator_place(propagator *self, double t, const double *y)
{
    outside_steps_place(self->outside, t, y);
}

// Rates [states] and values of the events there.
static ld_status find_there(propagator *self, double *value, ld_error *error)
{
    launch_state *launch = self->launch;
    outside_point *now = &self->outside->now;
    bool known = simulation_is_latest(launch, now->t, now->y);
    if (known)
        launcher_rates(&launch->launcher, now->y, &launch->latest.out, launch->phase.rocket,
                       now->rate);
    self->outside->evaluations += !known;
    if (known ? !all_finite(self->outside->states, now->rate)
              : rhs(now->t, now->y, now->rate, self))
        return ld_fail(error, LD_ERR_NUMERIC,
                       "the equations of motion gave no finite result at t = %.9g s", now->t);
    events_evaluate(&self->events, launch, &launch->latest.out, value);
    return LD_OK;
}

const event_list *propagator_events(const propagator *self)
{
    return &self->events;
}

bool propagator_has_accepted(const propagator *self)
{
    return self->outside->accepted;
}

ld_status propagator_accept(propagator *self, bool *crossed, ld_error *error)
{
    double value[EVENTS_MOST];
    ld_status status = find_there(self, value, error);
    *crossed = !status && outside_steps_accept(self->outside, value);
    return status;
}

ld_status propagator_go_on(propagator *self, ld_error *error)
{
    double value[EVENTS_MOST];
    ld_status status = find_there(self, value, error);
    if (!status)
        outside_steps_begin(self->outside, value);
    return status;
}

bool propagator_project(propagator *self, double *y)
{
    const launch_state *launch = self->launch;
    const outside_point *now = &self->outside->now;
    tolerances all;
    memcpy(y, now->y, (size_t)self->outside->states * sizeof *y);
    if (!launching_holds_places(&launch->launcher.launching))
        return false;
    project(now->t, y, self);
    find_tolerances(launch, &all);
    for (int i = 0; i < self->outside->states; i++)
        if (fabs(y[i] - now->y[i]) > all.atol[i])
            return true;
    return false;
}

void propagator_sizes(const propagator *self, double *size)
{
    tolerances all;
    find_tolerances(self->launch, &all);
    for (int i = 0; i < self->launch->launcher.state_count; i++)
        size[i] = isinf(all.atol[i]) ? 0 : all.atol[i] / self->launch->model->run.tolerance;
}

static ld_status create_outside(propagator *self, ld_error *error)
{
    self->outside = calloc(1, sizeof *self->outside);
    if (!self->outside)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the integration");
    self->outside->states = self->launch->launcher.state_count;
    self->outside->events = self->events.count;
    return LD_OK;
}

// ---- subsystems apart ----

static void launching_input_apart(const propagator *self, double t, const double *y,
                                  launching_input *input)
{
    held_frame_at(&self->tube, t - self->t, &input->base);
    simulation_surround(self->launch, t, y, input);
}

static int launching_rhs(double t, const double *y, double *y_dot, void *user)
{
    propagator *self = user;
    launch_state *launch = self->launch;
    const launcher_system *launcher = &launch->launcher;
    launching_input input;
    launching_output *out = &launch->latest.out.launching;
    launching_input_apart(self, t, y, &input);
    launch->latest.known = false; // not one of the whole
    launching_outcome outcome = launcher_evaluate_tube(launcher, launch->model->run.formulation,
                                                       &input, &launch->phase, y, out);
    simulation_note_outcome(launch, outcome);
    if (outcome)
        return -1;
    int count = launcher->launching.layout.count;
    launching_rates(&launcher->launching, y, out, launch->phase.rocket, y_dot);
    int works = launcher->launching.work_count;
    memcpy(y_dot + count, out->power, (size_t)works * sizeof *y_dot);
    return all_finite(count + works, y_dot) ? 0 : -1;
}

static int launching_project_apart(double t, double *y, void *user)
{
    const propagator *self = user;
    launching_input input;
    launching_input_apart(self, t, y, &input);
    launching_project(&self->launch->launcher.launching, &input, &self->launch->phase, y);
    return 0;
}

static int launching_events_apart(double t, const double *y, double *g, void *user)
{
    propagator *self = user;
    double unused[LD_MAX_STATES];
    if (launching_rhs(t, y, unused, user))
        return -1;
    events_evaluate(&self->events, self->launch, &self->launch->latest.out, g);
    return 0;
}

static int orientating_rhs(double t, const double *y, double *y_dot, void *user)
{
    propagator *self = user;
    const launch_state *launch = self->launch;
    double tau = t - self->t;
    orientating_motion motion;
    orientating_output out;
    orientating_input input = {
        .rest = {launch->rest.hinge[0], launch->rest.hinge[1]},
        .linear = launch->phase.frictionless,
    };
    held_wrench_at(&self->on_chassis, tau, &input.chassis_force, &input.chassis_moment);
    held_wrench_at(&self->on_tube, tau, &input.tube_force, &input.tube_moment);
    const orientating_system *orientating = &self->vehicle->of_tube[launch->launcher.base.tube];
    orientating_motion_at(orientating, t, y, &motion);
    jet_wrench back = simulation_jets(launch, t, &motion.tube);
    input.tube_force = v3_add(input.tube_force, back.force);
    input.tube_moment = v3_add(input.tube_moment, back.moment);
    if (orientating_evaluate(orientating, &input, y, &motion, y_dot, &out))
        return -1;
    memcpy(y_dot + orientating->state_count, out.power, sizeof out.power);
    if (self->jet)
        y_dot[self->orientating_count - 1] = jet_power(&back, &motion.tube);
    return all_finite(self->orientating_count, y_dot) ? 0 : -1;
}

static int marching_rhs(double t, const double *y, double *y_dot, void *user)
{
    propagator *self = user;
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

// The orientating and marching parts of the whole state.
static void split_base(const propagator *self, const double *y, double *orientating,
                       double *marching)
{
    const launcher_system *launcher = &self->launch->launcher;
    int works = launcher->work_at + launcher->launching.work_count;
    part_of(y, launcher->base_at, self->vehicle->marching_at, works, ORIENTATING_POWERS,
            orientating);
    part_of(y, launcher->base_at + self->vehicle->marching_at, self->vehicle->marching.state_count,
            works + ORIENTATING_POWERS, MARCHING_POWERS, marching);
    if (self->jet)
        orientating[self->orientating_count - 1] = y[works + VEHICLE_JET];
}

static void join_base(const propagator *self, const double *orientating, const double *marching,
                      double *y)
{
    const launcher_system *launcher = &self->launch->launcher;
    int works = launcher->work_at + launcher->launching.work_count;
    put_part(orientating, launcher->base_at, self->vehicle->marching_at, works, ORIENTATING_POWERS,
             y);
    put_part(marching, launcher->base_at + self->vehicle->marching_at,
             self->vehicle->marching.state_count, works + ORIENTATING_POWERS, MARCHING_POWERS, y);
    if (self->jet)
        y[works + VEHICLE_JET] = orientating[self->orientating_count - 1];
}

// The base's states at an instant between the last exchange and the next: cubic Hermite.
static void base_between(const propagator *self, double t, double *y)
{
    const launcher_system *launcher = &self->launch->launcher;
    double h = self->t_next - self->t, x = h > 0 ? (t - self->t) / h : 0;
    double a = (1 + 2 * x) * (1 - x) * (1 - x), b = x * (1 - x) * (1 - x) * h;
    double c = x * x * (3 - 2 * x), d = -x * x * (1 - x) * h;
    for (int i = launcher->base_at; i < launcher->state_count; i++)
        if (i < launcher->work_at || i >= launcher->work_at + launcher->launching.work_count)
            y[i] =
                a * self->from[i] + b * self->rate_from[i] + c * self->to[i] + d * self->rate_to[i];
}

// The whole state at time t within the launching subsystem's last step, whose state is `y`.
static void join(const propagator *self, double t, const double *y, double *whole)
{
    const launcher_system *launcher = &self->launch->launcher;
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
                           "the steps became too short to go on: more than %.0f between two "
                           "exchanges of the subsystems, up to t = %.9g s; is a damper or a "
                           "friction of the vehicle far too hard?",
                           most, integrator_time(part));
        if (integrator_step(part, t_next, error) == INTEGRATOR_FAILED)
            return integrator_failure(part);
    }
    return LD_OK;
}

// Exchange at t: frames and wrenches at the state y; then chassis and wheels go on to the next
// instant, the corners of commands at `t_stop` before it.
static ld_status exchange(propagator *self, double t, const double *y, double t_stop,
                          ld_error *error)
{
    launch_state *launch = self->launch;
    const launcher_system *launcher = &launch->launcher;
    launcher_input input;
    launcher_output *out = &launch->latest.out;
    double since = t - self->t, orientating[ORIENTATING_MOST], marching[MARCHING_MOST];
    simulation_input(launch, t, y, &input);
    launch->latest.known = false;
    if (launcher_evaluate(launcher, &input, &launch->phase, y, out))
        return ld_fail(error, LD_ERR_NUMERIC, "the exchange at t = %.9g s has no solution", t);
    held_frame_take(&self->chassis, &input.found.vehicle.chassis, since);
    held_frame_take(&self->tube, &input.found.vehicle.tube, since);
    const marching_output *wheels = &out->base.report.vehicle.marching;
    held_wrench_take(&self->on_chassis, wheels->force, wheels->moment, since);
    held_wrench_take(&self->on_tube, out->launching.base_force, out->launching.base_moment, since);
    self->t = t;
    double step = launch->model->run.coupling_step;
    while (self->t_first + (double)self->exchanges * step <= t + 1e-9 * step)
        self->exchanges++;
    // a stop that the next exchange misses by rounding is that exchange: the accelerations that
    // frames go on with would be noise over such a step
    double next = self->t_first + (double)self->exchanges * step;
    self->t_next = next > t_stop - 1e-9 * step ? t_stop : next;

    memcpy(self->from, y, (size_t)launcher->state_count * sizeof(double));
    split_base(self, y, orientating, marching);
    ld_status status = integrator_start(self->orientating, t, orientating, error);
    if (!status)
        status = integrator_start(self->marching, t, marching, error);
    if (!status)
        status = go_to(self->orientating, self->t_next, error);
    if (!status)
        status = go_to(self->marching, self->t_next, error);
    if (status)
        return status;

    double rate[2][LD_MAX_STATES];
    orientating_rhs(t, orientating, rate[0], self);
    marching_rhs(t, marching, rate[1], self);
    join_base(self, rate[0], rate[1], self->rate_from);
    const double *chassis = integrator_state(self->orientating);
    const double *marched = integrator_state(self->marching);
    orientating_rhs(self->t_next, chassis, rate[0], self);
    marching_rhs(self->t_next, marched, rate[1], self);
    join_base(self, rate[0], rate[1], self->rate_to);
    join_base(self, chassis, marched, self->to);
    return LD_OK;
}

static ld_status create_base(propagator *self, const integrator_settings *whole,
                             const tolerances *all, ld_error *error)
{
    const launcher_system *launcher = &self->launch->launcher;
    double atol[2][LD_MAX_STATES];
    bool absolute[2][LD_MAX_STATES] = {{false}};
    for (int i = 0; i < LD_MAX_STATES; i++)
        atol[0][i] = atol[1][i] = INFINITY;
    for (int i = 0; i < self->vehicle->marching_at; i++) {
        atol[0][i] = all->atol[launcher->base_at + i];
        absolute[0][i] = all->absolute[launcher->base_at + i];
    }
    for (int i = 0; i < self->vehicle->marching.state_count; i++) {
        atol[1][i] = all->atol[launcher->base_at + self->vehicle->marching_at + i];
        absolute[1][i] = all->absolute[launcher->base_at + self->vehicle->marching_at + i];
    }
    self->jet = model_has_jet(self->launch->model);
    self->orientating_count = self->vehicle->marching_at + ORIENTATING_POWERS + self->jet;
    self->marching_count = self->vehicle->marching.state_count + MARCHING_POWERS;
    integrator_settings settings = *whole;
    settings.events = NULL;
    settings.event_count = 0;
    settings.project = NULL;
    settings.max_step = 0;
    settings.n = (size_t)self->orientating_count;
    settings.rhs = orientating_rhs;
    settings.atol = atol[0];
    settings.absolute = absolute[0];
    ld_status status = integrator_create(&settings, &self->orientating, error);
    settings.n = (size_t)self->marching_count;
    settings.rhs = marching_rhs;
    settings.atol = atol[1];
    settings.absolute = absolute[1];
    return status ? status : integrator_create(&settings, &self->marching, error);
}

// ---- long steps ----

// All goes on as now as if it were rigid: what carries the tube by its own rates, the tube with its
// base, wheels and the like straight on beside it.
static void drift(double t, const double *y, const double *y_dot, double *rates, void *user)
{
    const propagator *self = user;
    const launcher_system *launcher = &self->launch->launcher;
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

// Tube, rocket and what carries them have one Jacobian, other parts of a base one each.
static void find_blocks(propagator *self, int *count)
{
    const launcher_system *launcher = &self->launch->launcher;
    const base_dynamics *base = launcher->base.kind->dynamics;
    *count = 1;
    for (int i = 0; i < launcher->state_count; i++) {
        int part = i < launcher->base_at ? 0
                   : i >= launcher->work_at || !base
                       ? EXPONENTIAL_NO_BLOCK
                       : base->part_of(&launcher->base, i - launcher->base_at);
        self->block[i] = part;
        *count = part >= *count ? part + 1 : *count;
    }
}

// Whether something changes the base's state at instants of its own.
static bool has_samples(const base_system *base, double t)
{
    return base->kind->next_sample && !isinf(base->kind->next_sample(base, t));
}

// Not where the base is told or sampled at instants of its own, too near to each other.
static ld_status create_exponential(propagator *self, const integrator_settings *equations,
                                    ld_error *error)
{
    const ld_run_settings *run = &self->launch->model->run;
    const base_system *base = &self->launch->launcher.base;
    bool sampled = base->kind->tell || has_samples(base, -run->lead_in);
    if (run->lead_in_method != LD_LEAD_IN_EXPONENTIAL || sampled)
        return LD_OK;
    exponential_steps_settings settings = {
        .equations = equations,
        .block = self->block,
        .row = run->output_step_lead_in,
        .drift = drift,
    };
    find_blocks(self, &settings.block_count);
    memcpy(self->place, equations->absolute, sizeof self->place);
    return exponential_steps_create(&settings, &self->exponential, error);
}

// Whether the equations are such that long steps pay: nothing drives a rocket through its tube.
static bool goes_slowly(const propagator *self)
{
    const launch_state *launch = self->launch;
    return self->exponential && !(launch->phase.rocket && launch_is_lit(launch));
}

// What stands in the tube: nothing, a rocket, one that is held.
static int kind_of_equations(const launch_state *launch)
{
    return launch->phase.rocket ? 1 + launch->phase.locked : 0;
}

// ---- both ----

// Where nothing comes and goes, adaptors being held on both sides, accuracy leaves steps as long as
// stability does, unless much of it is asked for: then the method that is stable for the longest.
static integrator_method choose_method(const launch_state *launch)
{
    bool held = launch->launcher.launching.adaptors.law.held;
    return held && launch->model->run.tolerance >= 1e-6 ? INTEGRATOR_OSCILLATING
                                                        : INTEGRATOR_CASH_KARP;
}

// Whether the end of each step is put back onto the constraints: with what they hold in places, and
// where a lock holds for long on a base that is moved. Its speed, that of a ship, has the error of
// the steps, by which the rocket would drift along the tube: 2 mm in 100 s at 6 m/s.
static bool puts_back(const launch_state *launch)
{
    const double long_lead_in = 10; // [s]
    const base_system *base = &launch->launcher.base;
    bool moved = !base->kind->dynamics && !base->kind->stepping && !base->kind->tell;
    return launching_holds_places(&launch->launcher.launching) ||
           (moved && launch->model->run.lead_in > long_lead_in);
}

static ld_status create_integrators(propagator *self, ld_error *error)
{
    const launch_state *launch = self->launch;
    const launcher_system *launcher = &launch->launcher;
    tolerances all;
    find_tolerances(launch, &all);
    integrator_settings settings = {
        .n = (size_t)launcher->state_count,
        .method = choose_method(launch),
        .rtol = launch->model->run.tolerance,
        .atol = all.atol,
        .absolute = all.absolute,
        .max_step = launch->model->run.max_step,
        .rhs = rhs,
        .project = puts_back(launch) ? project : NULL,
        .events = events,
        .event_count = self->events.count,
        .self = self,
    };
    if (!self->apart) {
        ld_status status = create_exponential(self, &settings, error);
        return status ? status : integrator_create(&settings, &self->integrator, error);
    }
    ld_status status = create_base(self, &settings, &all, error);
    int count = launcher->launching.layout.count, works = launcher->launching.work_count;
    for (int i = 0; i < works; i++) {
        all.atol[count + i] = INFINITY;
        all.absolute[count + i] = false;
    }
    settings.n = (size_t)(count + works);
    settings.rhs = launching_rhs;
    settings.project = settings.project ? launching_project_apart : NULL;
    settings.events = launching_events_apart;
    return status ? status : integrator_create(&settings, &self->integrator, error);
}

ld_status propagator_create(launch_state *launch, bool outside, propagator **out, ld_error *error)
{
    propagator *self = calloc(1, sizeof *self);
    if (!self)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the integration");
    self->launch = launch;
    self->vehicle = base_as_vehicle(&launch->launcher.base);
    self->apart = self->vehicle && launch->model->run.coupling_step > 0;
    self->events = events_of(launch, !self->apart);
    ld_status status = outside ? create_outside(self, error) : create_integrators(self, error);
    if (status)
        propagator_free(self);
    else
        *out = self;
    return status;
}

void propagator_free(propagator *self)
{
    if (!self)
        return;
    exponential_steps_free(self->exponential);
    free(self->outside);
    integrator_free(self->integrator);
    integrator_free(self->orientating);
    integrator_free(self->marching);
    free(self);
}

ld_status propagator_start(propagator *self, double t, const double *y, bool anew, ld_error *error)
{
    if (self->outside) {
        outside_steps_place(self->outside, t, y);
        return propagator_go_on(self, error);
    }
    if (!self->apart) {
        if (self->exponential && anew)
            exponential_steps_count_from(self->exponential, t);
        self->t_explicit = -INFINITY;
        self->long_step = false;
        int kind = kind_of_equations(self->launch);
        if (goes_slowly(self) && exponential_steps_take(self->exponential, kind, error))
            return LD_ERR_MEMORY;
        return integrator_start(self->integrator, t, y, error);
    }
    const launcher_system *launcher = &self->launch->launcher;
    double launching[LD_MAX_STATES];
    if (anew) {
        memset(&self->on_chassis, 0, sizeof self->on_chassis);
        memset(&self->on_tube, 0, sizeof self->on_tube);
        memset(&self->chassis, 0, sizeof self->chassis);
        memset(&self->tube, 0, sizeof self->tube);
        self->exchanges = 0;
        self->t = self->t_next = self->t_first = t;
        memcpy(self->to, y, (size_t)launcher->state_count * sizeof(double));
        memcpy(self->from, y, (size_t)launcher->state_count * sizeof(double));
    }
    memmove(self->state, y, (size_t)launcher->state_count * sizeof(double));
    split_launching(launcher, y, launching);
    return integrator_start(self->integrator, t, launching, error);
}

// The integrator's step; after a stop it starts anew, as one does that was saved there.
static integrator_outcome step(propagator *self, double t_stop, ld_error *error)
{
    integrator *stepper = self->integrator;
    if (self->stopped &&
        integrator_start(stepper, integrator_time(stepper), integrator_state(stepper), error))
        return INTEGRATOR_FAILED;
    integrator_outcome outcome = integrator_step(stepper, t_stop, error);
    self->stopped = outcome == INTEGRATOR_STOPPED;
    return outcome;
}

// The integrator takes over where the last long step has ended, or from where it began.
static ld_status take_over(propagator *self, double t, const double *y, ld_error *error)
{
    self->long_step = self->stopped = false;
    return integrator_start(self->integrator, t, y, error);
}

static integrator_outcome step_together(propagator *self, double t_stop, ld_error *error)
{
    double t = propagator_time(self);
    bool slowly = goes_slowly(self);
    if (slowly && t >= self->t_explicit) {
        if (!self->long_step)
            exponential_steps_start(self->exponential, t, propagator_state(self));
        self->long_step = true;
        exponential_outcome outcome = exponential_steps_step(self->exponential, t_stop);
        if (outcome != EXPONENTIAL_REFUSED)
            return outcome == EXPONENTIAL_STOPPED ? INTEGRATOR_STOPPED : INTEGRATOR_STEPPED;
        self->t_explicit = exponential_steps_resume(self->exponential);
    }
    if (self->long_step && take_over(self, t, propagator_state(self), error))
        return INTEGRATOR_FAILED;
    integrator_outcome outcome =
        step(self, slowly ? fmin(t_stop, self->t_explicit) : t_stop, error);
    bool between = outcome == INTEGRATOR_STOPPED && propagator_time(self) < t_stop;
    return between ? INTEGRATOR_STEPPED : outcome;
}

integrator_outcome propagator_step(propagator *self, double t_stop, ld_error *error)
{
    if (!self->apart)
        return step_together(self, t_stop, error);
    double t = integrator_time(self->integrator), launching[LD_MAX_STATES];
    const launcher_system *launcher = &self->launch->launcher;
    if (t >= self->t_next) {
        if (exchange(self, t, self->state, t_stop, error))
            return INTEGRATOR_FAILED;
        split_launching(launcher, self->state, launching);
        if (integrator_start(self->integrator, t, launching, error))
            return INTEGRATOR_FAILED;
    }
    integrator_outcome outcome = step(self, fmin(t_stop, self->t_next), error);
    t = integrator_time(self->integrator);
    join(self, t, integrator_state(self->integrator), self->state);
    return outcome == INTEGRATOR_STOPPED && t < t_stop ? INTEGRATOR_STEPPED : outcome;
}

// The long step that has been taken is left for explicit ones, the first of which may end before t.
static integrator_outcome return_within(propagator *self, double t, ld_error *error)
{
    exponential_steps *steps = self->exponential;
    if (take_over(self, exponential_steps_previous_time(steps), exponential_steps_previous(steps),
                  error))
        return INTEGRATOR_FAILED;
    self->t_explicit = t;
    integrator_outcome outcome = step(self, t, error);
    return outcome == INTEGRATOR_STOPPED ? INTEGRATOR_STEPPED : outcome;
}

integrator_outcome propagator_return(propagator *self, double t, ld_error *error)
{
    if (self->long_step)
        return return_within(self, t, error);
    integrator_outcome outcome = integrator_return(self->integrator, t, error);
    if (self->apart)
        join(self, integrator_time(self->integrator), integrator_state(self->integrator),
             self->state);
    return outcome;
}

double propagator_time(const propagator *self)
{
    return self->outside     ? self->outside->now.t
           : self->long_step ? exponential_steps_time(self->exponential)
                             : integrator_time(self->integrator);
}

double propagator_previous_time(const propagator *self)
{
    return self->outside     ? self->outside->last.t
           : self->long_step ? exponential_steps_previous_time(self->exponential)
                             : integrator_previous_time(self->integrator);
}

const double *propagator_state(const propagator *self)
{
    return self->apart       ? self->state
           : self->outside   ? self->outside->now.y
           : self->long_step ? exponential_steps_state(self->exponential)
                             : integrator_state(self->integrator);
}

void propagator_interpolate(propagator *self, double t, double *y)
{
    if (self->outside) {
        outside_steps_interpolate(self->outside, t, y);
        return;
    }
    if (self->long_step) {
        exponential_steps_interpolate(self->exponential, t, y);
        return;
    }
    if (!self->apart) {
        integrator_interpolate(self->integrator, t, y);
        return;
    }
    double launching[LD_MAX_STATES];
    integrator_interpolate(self->integrator, t, launching);
    join(self, t, launching, y);
}

int propagator_event(const propagator *self, event_kind kind, int index)
{
    int i = event_find(&self->events, kind, index);
    if (self->outside)
        return i < 0 ? 0 : self->outside->direction[i];
    return i < 0 || self->long_step ? 0 : integrator_event(self->integrator, i);
}

void propagator_error(propagator *self, double *error)
{
    size_t size = (size_t)self->launch->launcher.base_at * sizeof *error;
    double all[LD_MAX_STATES] = {0};
    if (!self->outside && !self->long_step)
        integrator_error(self->integrator, all);
    memcpy(error, all, size);
}

int64_t propagator_steps(const propagator *self)
{
    if (self->outside)
        return self->outside->steps;
    int64_t longer = self->exponential ? exponential_steps_count(self->exponential) : 0;
    return longer + integrator_steps(self->integrator);
}

int64_t propagator_most_steps(const propagator *self)
{
    int64_t most = propagator_steps(self);
    for (int i = 0; self->apart && i < 2; i++) {
        int64_t steps = integrator_steps(i ? self->marching : self->orientating);
        most = steps > most ? steps : most;
    }
    return most;
}

int64_t propagator_evaluations(const propagator *self)
{
    if (self->outside)
        return self->outside->evaluations;
    int64_t sum = integrator_evaluations(self->integrator);
    if (self->exponential)
        sum += exponential_steps_evaluations(self->exponential);
    if (self->apart)
        sum += integrator_evaluations(self->orientating) + integrator_evaluations(self->marching);
    return sum;
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

static void archive_long_steps(propagator *self, archive *bytes)
{
    archive_bool(bytes, &self->long_step);
    archive_double(bytes, &self->t_explicit);
    exponential_steps_archive(self->exponential, bytes);
}

void propagator_archive(propagator *self, archive *bytes)
{
    if (self->outside) {
        outside_steps_archive(self->outside, bytes);
        return;
    }
    integrator_archive(self->integrator, bytes);
    archive_expect(bytes, self->exponential != NULL);
    if (self->exponential)
        archive_long_steps(self, bytes);
    archive_expect(bytes, self->apart);
    if (!self->apart)
        return;
    integrator_archive(self->orientating, bytes);
    integrator_archive(self->marching, bytes);
    double *instants[] = {&self->t, &self->t_next, &self->t_first};
    for (int i = 0; i < 3; i++)
        archive_double(bytes, instants[i]);
    archive_count(bytes, &self->exchanges);
    // the exchanges are counted up to one that lies ahead
    double step = self->launch->model->run.coupling_step;
    bytes->failed |= !(self->t_first + ((double)self->exchanges + 1) * step >= self->t);
    archive_frame(bytes, &self->chassis);
    archive_frame(bytes, &self->tube);
    archive_wrench(bytes, &self->on_chassis);
    archive_wrench(bytes, &self->on_tube);
    double *states[] = {self->state, self->from, self->rate_from, self->to, self->rate_to};
    for (int i = 0; i < 5; i++)
        archive_doubles(bytes, states[i], (size_t)self->launch->launcher.state_count);
}
