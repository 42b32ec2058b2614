// A vehicle alone: the base of a launcher, taken forward under the given wrench.
//
// State: the base's | its works by kind of force | the work of the tube's wrench.
#include "run/vehicle_run.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "elements/held_wrench.h"
#include "integration/integrator.h"
#include "integration/saved_state.h"
#include "launchdyn/vehicle_run.h"
#include "model/parts.h"
#include "state/equilibrium.h"
#include "state/evaluation.h"
#include "state/launch_state.h"
#include "systems/bases/mechanism_base.h"

enum { MOST_STATES = BASE_MOST_STATES + BASE_MOST_WORKS + 1 };

struct ld_vehicle_run {
    const ld_simulation *system;
    base_system base; // the system's, with a workspace of its own
    base_rest rest;
    int work_at, tube_work_at, state_count;
    held_wrench wrench; // of the tube, about T's origin, in T
    double t_set;       // [s]
    held_wrench before; // what it was before it was given there, and when it was given then
    double t_before;
    double energy_start;
    integrator *integrator;
    struct { // of steps that an integrator outside takes, by vehicle_run.h
        bool is;
        double t, y[MOST_STATES];             // where that is
        double last, event[BASE_MOST_EVENTS]; // [s] where its last step ended, events there
    } outside;
    ld_status status; // what ended it, with its sentence
    ld_error error;
    struct { // the latest evaluation
        bool known;
        double t, y[MOST_STATES];
        base_frame tube;
        base_found found;
        v3 force, moment; // in T
        base_output out;
    } latest;
};

static ld_status copy_error(const ld_vehicle_run *self, ld_error *error)
{
    if (self->status && error)
        *error = self->error;
    return self->status;
}

static double time_of(const ld_vehicle_run *self)
{
    return self->outside.is ? self->outside.t : integrator_time(self->integrator);
}

static const double *state_of(const ld_vehicle_run *self)
{
    return self->outside.is ? self->outside.y : integrator_state(self->integrator);
}

// ---- the equations ----

// Fills `latest`; other than 0: there is no solution.
static int evaluate(ld_vehicle_run *self, double t, const double *y)
{
    size_t size = (size_t)self->work_at * sizeof *y;
    if (self->latest.known && self->latest.t == t &&
        memcmp((const char *)self->latest.y, (const char *)y, size) == 0)
        return 0;
    base_load load = {.rest = self->rest};
    held_wrench_at(&self->wrench, t - self->t_set, &load.force, &load.moment);
    const base_system *base = &self->base;
    self->latest.known = false;
    base->kind->find_frame(base, t, y, &self->latest.tube, &self->latest.found);
    if (base->kind->dynamics->evaluate(base, &self->latest.found, &load, y, &self->latest.out))
        return -1;
    self->latest.known = true;
    self->latest.t = t;
    self->latest.force = load.force;
    self->latest.moment = load.moment;
    memcpy(self->latest.y, y, size);
    return 0;
}

// Power [W] of the tube's wrench.
static double tube_power(const ld_vehicle_run *self)
{
    const base_frame *tube = &self->latest.tube;
    return v3_dot(m3_apply(tube->A, self->latest.force), tube->v) +
           v3_dot(m3_apply(tube->A, self->latest.moment), tube->w);
}

static int rhs(double t, const double *y, double *y_dot, void *user)
{
    ld_vehicle_run *self = user;
    if (evaluate(self, t, y))
        return -1;
    memcpy(y_dot, self->latest.out.rate, (size_t)self->work_at * sizeof *y_dot);
    memcpy(y_dot + self->work_at, self->latest.out.power,
           (size_t)self->base.work_count * sizeof *y_dot);
    y_dot[self->tube_work_at] = tube_power(self);
    double sum = 0; // NaN or infinity anywhere makes it not zero
    for (int i = 0; i < self->state_count; i++)
        sum += 0 * y_dot[i];
    return sum == 0 ? 0 : -1;
}

static int events(double t, const double *y, double *g, void *user)
{
    ld_vehicle_run *self = user;
    if (evaluate(self, t, y))
        return -1;
    for (int i = 0; i < self->base.event_count; i++)
        g[i] = self->latest.out.event[i] / 1e-3;
    return 0;
}

// ---- begin ----

// Whether the base has a motion of its own.
static bool moves_alone(const ld_model *model)
{
    return model_has_vehicle(model) || model_has_multibody(model);
}

static ld_status check_model(const ld_model *model, ld_error *error)
{
    if (!moves_alone(model))
        return ld_fail(error, LD_ERR_INPUT,
                       "base.kind: a vehicle-only run requires kind: vehicle or multibody");
    if (model_firing_count(model) > 1)
        return ld_fail(error, LD_ERR_INPUT,
                       "firing: found %d rockets, expected 1 in a vehicle-only run",
                       model_firing_count(model));
    if (model_has_jet(model))
        return ld_fail(error, LD_ERR_INPUT,
                       "platform.jet: a vehicle-only run does not have the rocket's position, "
                       "which the jet requires");
    return LD_OK;
}

static int project(double t, double *y, void *user)
{
    const ld_vehicle_run *self = user;
    self->base.kind->dynamics->project(&self->base, t, y);
    return 0;
}

static ld_status create_integrator(ld_vehicle_run *self, ld_error *error)
{
    const ld_run_settings *run = model_run(self->system->model);
    double atol[MOST_STATES];
    bool absolute[MOST_STATES] = {false};
    for (int i = 0; i < MOST_STATES; i++)
        atol[i] = INFINITY; // quadratures and what only changes at instants do not steer the step
    self->base.kind->dynamics->tolerances(&self->base, run->tolerance, atol, absolute);
    const integrator_settings settings = {
        .n = (size_t)self->state_count,
        .method = INTEGRATOR_CASH_KARP,
        .rtol = run->tolerance,
        .atol = atol,
        .absolute = absolute,
        .max_step = run->max_step,
        .rhs = rhs,
        .events = events,
        .project = self->base.drifts ? project : NULL,
        .event_count = self->base.event_count,
        .self = self,
    };
    return integrator_create(&settings, &self->integrator, error);
}

static ld_vehicle_run *create(const ld_simulation *simulation, ld_error *error)
{
    ld_vehicle_run *self = NULL;
    if (check_model(simulation->model, error))
        return NULL;
    self = calloc(1, sizeof *self);
    if (!self) {
        ld_fail(error, LD_ERR_MEMORY, "no memory for a run of the vehicle");
        return NULL;
    }
    self->system = simulation;
    ld_status status = base_share(&self->base, &simulation->launcher.base, error);
    self->work_at = self->base.state_count;
    self->tube_work_at = self->work_at + self->base.work_count;
    self->state_count = self->tube_work_at + 1;
    if (!status && self->base.kind->stations && mechanism_of(&self->base)->station_count > 0)
        status = ld_fail(error, LD_ERR_INPUT,
                         "tubes.on: supports on a beam move separately; a vehicle-only run has the "
                         "motion of one frame, the tubes on a body");
    if (!status)
        status = create_integrator(self, error);
    if (!status)
        return self;
    ld_vehicle_run_end(self);
    return NULL;
}

void ld_vehicle_run_end(ld_vehicle_run *self)
{
    if (!self)
        return;
    integrator_free(self->integrator);
    base_free_share(&self->base);
    free(self);
}

// The vehicle as it begins under tube and rocket, and what these do to it then.
static ld_status take_start(ld_vehicle_run *self, launch_state *launch, double t, double *y,
                            ld_error *error)
{
    const launcher_system *launcher = &launch->launcher;
    ld_equilibrium_summary unused;
    launcher_input input;
    launcher_output out;
    double whole[LD_MAX_STATES];
    ld_status status = simulation_start(launch, t, whole, &unused, error);
    if (status)
        return status;
    launch->phase.locked = launch->rocket->lock.present;
    simulation_input(launch, t, whole, &input);
    if (launcher_evaluate(launcher, &input, &launch->phase, whole, &out))
        return ld_fail(error, LD_ERR_NUMERIC, "the start at t = %.9g s has no solution", t);
    held_wrench_take(&self->wrench, out.launching.base_force, out.launching.base_moment, 0);
    self->rest = launch->rest;
    memcpy(y, whole + launcher->base_at, (size_t)self->work_at * sizeof *y);
    return LD_OK;
}

static double mechanical_energy(const ld_vehicle_run *self, const double *y)
{
    return self->base.kind->dynamics->kinetic_energy(&self->base, &self->latest.found, y) +
           self->latest.out.elastic;
}

static ld_status begin(ld_vehicle_run *self, ld_error *error)
{
    // its lanes want their alignment
    launch_state *launch = aligned_alloc(64, (sizeof *launch + 63) / 64 * 64);
    double t = simulation_start_time(self->system->model), y[MOST_STATES] = {0};
    if (!launch)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a run of the vehicle");
    ld_status status = launch_state_begin(launch, self->system, error);
    if (!status)
        status = take_start(self, launch, t, y, error);
    launch_state_end(launch);
    free(launch);
    if (status)
        return status;
    self->before = self->wrench;
    self->t_set = self->t_before = t;
    if (evaluate(self, t, y))
        return ld_fail(error, LD_ERR_NUMERIC, "the start at t = %.9g s has no solution", t);
    self->energy_start = mechanical_energy(self, y);
    return integrator_start(self->integrator, t, y, error);
}

ld_status ld_vehicle_run_begin(const ld_simulation *simulation, ld_vehicle_run **run,
                               ld_error *error)
{
    ld_vehicle_run *self = *run = create(simulation, error);
    if (!self)
        return error->status;
    ld_status status = begin(self, error);
    if (!status)
        return LD_OK;
    ld_vehicle_run_end(self);
    *run = NULL;
    return status;
}

// ---- forward ----

double ld_vehicle_run_time(const ld_vehicle_run *self)
{
    return time_of(self);
}

// To t, where a step ends: what is further than this by rounding alone is there.
static ld_status go_to(ld_vehicle_run *self, double t)
{
    integrator *stepper = self->integrator;
    const double begun = integrator_time(stepper), *y = integrator_state(stepper);
    double most = 20000 * fmax(1, (t - begun) / 1e-3);
    if (t - begun <= 100 * DBL_EPSILON * fmax(fabs(t), fabs(begun)))
        return integrator_start(stepper, t, y, &self->error);
    ld_status status = integrator_start(stepper, begun, y, &self->error);
    integrator_outcome outcome = INTEGRATOR_STEPPED;
    for (double steps = 0; !status && outcome != INTEGRATOR_STOPPED; steps++) {
        outcome = integrator_step(stepper, t, &self->error);
        if (outcome == INTEGRATOR_FAILED)
            status = integrator_failure(stepper);
        else if (steps > most)
            status = ld_fail(
                &self->error, LD_ERR_NUMERIC,
                "the steps became too short to continue: more than %.0f steps up to t = %.9g s; "
                "check for a damper or friction of the vehicle that is far too stiff",
                most, integrator_time(stepper));
    }
    return status;
}

// What acts on its own at the present, as a digital loop does.
static ld_status sample_base(ld_vehicle_run *self)
{
    const base_system *base = &self->base;
    double t = integrator_time(self->integrator), y[MOST_STATES];
    if (!base->kind->next_sample || base->kind->next_sample(base, nextafter(t, -INFINITY)) != t)
        return LD_OK;
    memcpy(y, integrator_state(self->integrator), (size_t)self->state_count * sizeof *y);
    base->kind->sample(base, t, y);
    self->latest.known = false;
    return integrator_start(self->integrator, t, y, &self->error);
}

// The first instant after t at which a step must end, not beyond `end`.
static double next_stop(const ld_vehicle_run *self, double t, double end)
{
    const base_system *base = &self->base;
    if (base->kind->next_corner)
        end = fmin(end, base->kind->next_corner(base, t));
    return base->kind->next_sample ? fmin(end, base->kind->next_sample(base, t)) : end;
}

ld_status ld_vehicle_run_advance(ld_vehicle_run *self, double t, ld_error *error)
{
    double now = integrator_time(self->integrator);
    if (self->status)
        return copy_error(self, error);
    if (!(t >= now) || !isfinite(t))
        return ld_fail(error, LD_ERR_INPUT,
                       "the vehicle's run is at t = %.9g s and cannot continue to t = %.9g s", now,
                       t);
    while (!self->status && now < t) {
        self->status = go_to(self, next_stop(self, now, t));
        if (!self->status)
            self->status = sample_base(self);
        now = integrator_time(self->integrator);
    }
    return copy_error(self, error);
}

// ---- what it receives, and reports ----

ld_status ld_vehicle_run_set_wrench(ld_vehicle_run *self, const ld_base_wrench *wrench,
                                    ld_error *error)
{
    double t = time_of(self), sum = 0;
    if (self->status)
        return copy_error(self, error);
    for (int i = 0; i < 3; i++)
        sum += 0 * wrench->force[i] + 0 * wrench->moment[i];
    if (sum != 0)
        return ld_fail(error, LD_ERR_INPUT, "the vehicle received a wrench that is not finite");
    base_frame tube;
    base_found unused;
    self->base.kind->find_frame(&self->base, t, state_of(self), &tube, &unused);
    // set again at the same time, it was not reported before
    if (t == self->t_set) {
        self->wrench = self->before;
    } else {
        self->before = self->wrench;
        self->t_before = self->t_set;
    }
    held_wrench_take(&self->wrench, m3_apply_transposed(tube.A, v3_from(wrench->force)),
                     m3_apply_transposed(tube.A, v3_from(wrench->moment)), t - self->t_before);
    self->t_set = t;
    self->latest.known = false;
    return LD_OK;
}

// Evaluates at the present.
static ld_status evaluate_present(ld_vehicle_run *self, ld_error *error)
{
    double t = time_of(self);
    if (self->status)
        return copy_error(self, error);
    return evaluate(self, t, state_of(self))
               ? ld_fail(error, LD_ERR_NUMERIC,
                         "the equations of motion gave no finite result at t = %.9g s", t)
               : LD_OK;
}

ld_status ld_vehicle_run_wrench(ld_vehicle_run *self, ld_base_wrench *wrench, ld_error *error)
{
    ld_status status = evaluate_present(self, error);
    if (status)
        return status;
    v3_store(wrench->force, m3_apply(self->latest.tube.A, self->latest.force));
    v3_store(wrench->moment, m3_apply(self->latest.tube.A, self->latest.moment));
    return LD_OK;
}

ld_status ld_vehicle_run_frame(ld_vehicle_run *self, ld_base_frame *frame, ld_error *error)
{
    ld_status status = evaluate_present(self, error);
    if (status)
        return status;
    const base_frame *tube = &self->latest.tube;
    v3_store(frame->position, tube->r);
    memcpy(frame->quaternion, &tube->q, sizeof frame->quaternion);
    v3_store(frame->velocity, tube->v);
    v3_store(frame->rate, tube->w);
    return LD_OK;
}

// ---- columns ----

typedef struct vehicle_moment {
    double t;
    base_instant of_base;
    double kinetic, elastic, residual; // [J]
    double work[BASE_MOST_WORKS], tube_work;
} vehicle_moment;

#define AT(member) .at = QUANTITY_AT(vehicle_moment, member)
#define BASE_WORK(place, name, is) {"work." name, "J", is, AT(work[place])},
#define MARCHING(place, name, is) BASE_WORK(VEHICLE_BODY_POWERS + place, name, is)
// clang-format off
static const quantity clock[] = {
    {"t", "s", "time on the run's clock", AT(t)},
};
static const quantity energies[] = {
    {"energy.kinetic", "J", "kinetic energy of the vehicle", AT(kinetic)},
    {"energy.elastic", "J", "elastic energy of its suspensions and springs", AT(elastic)},
};
static const quantity works[] = {VEHICLE_WORKS(BASE_WORK) MARCHING_WORKS(MARCHING)};
#define ROLLING(place, name, is) BASE_WORK(MECHANISM_POWERS + place, name, is)
static const quantity multibody_works[] = {MECHANISM_WORKS(BASE_WORK)};
static const quantity rolling_works[] = {MARCHING_WORKS(ROLLING)};
static const quantity tube_works[] = {
    {"work.tube", "J", "work of the tube on it", AT(tube_work)},
};
static const quantity balance[] = {
    {"energy.residual", "J", "energy residual of the vehicle", AT(residual)},
};
static const quantity_group clocks[] = {
    {.title = "time", QUANTITY_ROWS(clock)},
};
static const quantity_group balances[] = {
    {.title = "energy of the vehicle", QUANTITY_ROWS(energies)},
    {.title = "works since the start", .each = EACH_VEHICLE, QUANTITY_ROWS(works)},
    {.title = "works of a multibody base since the start", .each = EACH_MULTIBODY, QUANTITY_ROWS(multibody_works)},
    {.title = "works of its wheels since the start", .each = EACH_ROLLING, QUANTITY_ROWS(rolling_works)},
    {.title = "work of the tube", QUANTITY_ROWS(tube_works)},
    {.title = "energy balance of the vehicle", QUANTITY_ROWS(balance)},
};
// clang-format on

const quantity_table vehicle_clock_quantities = {clocks, sizeof clocks / sizeof *clocks};
const quantity_table vehicle_balance_quantities = {balances, sizeof balances / sizeof *balances};

ld_status vehicle_run_name_columns(ld_simulation *self, ld_error *error)
{
    if (!moves_alone(self->model))
        return LD_OK;
    const quantity_things things = quantity_things_of(self->model);
    const quantity_part parts[] = {
        {&vehicle_clock_quantities, 0},
        {self->launcher.base.kind->quantities, offsetof(vehicle_moment, of_base)},
        {&vehicle_balance_quantities, 0}};
    return quantity_columns_make(&self->vehicle_columns, parts, sizeof parts / sizeof *parts,
                                 &things, error);
}

size_t ld_vehicle_run_columns(const ld_simulation *simulation, const ld_column **columns)
{
    *columns = simulation->vehicle_columns.column;
    return (size_t)simulation->vehicle_columns.count;
}

ld_status ld_vehicle_run_row(ld_vehicle_run *self, double *values, ld_error *error)
{
    ld_status status = evaluate_present(self, error);
    if (status)
        return status;
    const double *y = state_of(self), *work = y + self->work_at;
    vehicle_moment now = {
        .t = time_of(self),
        .kinetic = self->base.kind->dynamics->kinetic_energy(&self->base, &self->latest.found, y),
        .elastic = self->latest.out.elastic,
        .tube_work = y[self->tube_work_at]};
    base_find(&self->base, &self->latest.found, &self->latest.out, y, &now.of_base);
    now.residual = now.kinetic + now.elastic - self->energy_start - now.tube_work;
    for (int i = 0; i < self->base.work_count; i++) {
        now.work[i] = work[i];
        now.residual -= work[i];
    }
    quantity_row(&self->system->vehicle_columns, &now, values);
    return LD_OK;
}

// ---- as bytes ----

static const saved_state saved_run = {0x686576206e796c6e, 1, "run of a vehicle"}; // "nlyn veh"

static void archive_vector(archive *bytes, v3 *v)
{
    archive_double(bytes, &v->x);
    archive_double(bytes, &v->y);
    archive_double(bytes, &v->z);
}

static void archive_all(ld_vehicle_run *self, archive *bytes)
{
    held_wrench *wrenches[] = {&self->wrench, &self->before};
    for (int i = 0; i < 2; i++) {
        archive_vector(bytes, &wrenches[i]->force);
        archive_vector(bytes, &wrenches[i]->moment);
        archive_vector(bytes, &wrenches[i]->force_rate);
        archive_vector(bytes, &wrenches[i]->moment_rate);
    }
    archive_double(bytes, &self->t_set);
    archive_double(bytes, &self->t_before);
    archive_doubles(bytes, self->rest.number, sizeof self->rest.number / sizeof(double));
    archive_double(bytes, &self->energy_start);
    integrator_archive(self->integrator, bytes);
    if (!self->outside.is)
        return;
    archive_double(bytes, &self->outside.t);
    archive_doubles(bytes, self->outside.y, self->state_count);
    archive_double(bytes, &self->outside.last);
    archive_doubles(bytes, self->outside.event, BASE_MOST_EVENTS);
}

ld_status ld_vehicle_run_save(ld_vehicle_run *self, void *bytes, size_t capacity, size_t *size,
                              ld_error *error)
{
    const ld_model *model = self->system->model;
    *size = 0;
    if (self->status)
        return copy_error(self, error);
    archive count = archive_save(NULL, 0), saved = archive_save(bytes, capacity);
    saved_state_head(&saved_run, model, &count, 0);
    archive_all(self, &count);
    saved_state_sum(&count);
    *size = count.at;
    if (capacity < *size)
        return ld_fail(error, LD_ERR_INPUT,
                       "the state of a vehicle's run requires %zu bytes, the buffer has %zu", *size,
                       capacity);
    saved_state_head(&saved_run, model, &saved, (int64_t)*size);
    archive_all(self, &saved);
    saved_state_sum(&saved);
    return LD_OK;
}

static ld_status load(const ld_simulation *simulation, bool outside, const void *bytes, size_t size,
                      ld_vehicle_run **run, ld_error *error)
{
    ld_vehicle_run *self = *run = create(simulation, error);
    if (!self)
        return error->status;
    self->outside.is = outside;
    ld_status status = saved_state_check(&saved_run, simulation->model, bytes, size, error);
    if (!status) {
        archive loaded = archive_load(bytes, size);
        saved_state_head(&saved_run, simulation->model, &loaded, (int64_t)size);
        archive_all(self, &loaded);
        if (loaded.failed || loaded.at + 8 != size)
            status = ld_fail(error, LD_ERR_INPUT, "the saved run of a vehicle is damaged");
    }
    if (!status)
        return LD_OK;
    ld_vehicle_run_end(self);
    *run = NULL;
    return status;
}

ld_status ld_vehicle_run_load(const ld_simulation *simulation, const void *bytes, size_t size,
                              ld_vehicle_run **run, ld_error *error)
{
    return load(simulation, false, bytes, size, run, error);
}

// ---- steps of an integrator outside

ld_status vehicle_exchange_load(const ld_simulation *simulation, const void *bytes, size_t size,
                                ld_vehicle_run **run, ld_error *error)
{
    return load(simulation, true, bytes, size, run, error);
}

ld_status vehicle_exchange_begin(const ld_simulation *simulation, ld_vehicle_run **run,
                                 ld_error *error)
{
    ld_status status = ld_vehicle_run_begin(simulation, run, error);
    if (status)
        return status;
    ld_vehicle_run *self = *run;
    size_t size = (size_t)self->state_count * sizeof(double);
    self->outside.t = self->outside.last = integrator_time(self->integrator);
    memcpy(self->outside.y, integrator_state(self->integrator), size);
    self->outside.is = true;
    status = vehicle_exchange_values(self, self->outside.event, error);
    if (!status)
        return LD_OK;
    ld_vehicle_run_end(self);
    *run = NULL;
    return status;
}

int vehicle_exchange_states(const ld_vehicle_run *self)
{
    return self->state_count;
}

int vehicle_exchange_indicators(const ld_vehicle_run *self)
{
    return self->base.event_count;
}

exchange_quantity vehicle_exchange_state(const ld_vehicle_run *self, int i)
{
    static const exchange_quantity of_tube = {"work.tube", "J", "W", "work of the tube on it"};
    return i < self->work_at        ? exchange_base_state(i)
           : i < self->tube_work_at ? exchange_base_work(&self->system->launcher, i - self->work_at)
                                    : of_tube;
}

void vehicle_exchange_nominals(const ld_vehicle_run *self, double *nominal)
{
    const double work = 1e9; // [J] what steers no step
    bool unused[MOST_STATES];
    for (int i = 0; i < self->state_count; i++)
        nominal[i] = INFINITY;
    self->base.kind->dynamics->tolerances(&self->base, 1, nominal, unused);
    for (int i = 0; i < self->state_count; i++)
        nominal[i] = nominal[i] < work ? nominal[i] : work;
}

ld_status vehicle_exchange_place(ld_vehicle_run *self, double t, const double *y,
                                 const ld_base_wrench *wrench, ld_error *error)
{
    self->outside.t = t;
    memcpy(self->outside.y, y, (size_t)self->state_count * sizeof *y);
    self->t_set = NAN; // each wrench is the first one there
    self->wrench = self->before = (held_wrench){.force = v3_zero()};
    ld_status status = ld_vehicle_run_set_wrench(self, wrench, error);
    self->wrench.force_rate = self->wrench.moment_rate = v3_zero();
    return status;
}

void vehicle_exchange_get(const ld_vehicle_run *self, double *y)
{
    memcpy(y, state_of(self), (size_t)self->state_count * sizeof *y);
}

static ld_status no_solution(const ld_vehicle_run *self, ld_error *error)
{
    return ld_fail(error, LD_ERR_NUMERIC,
                   "the equations of motion gave no finite result at t = %.9g s", time_of(self));
}

ld_status vehicle_exchange_rates(ld_vehicle_run *self, double *rate, ld_error *error)
{
    return rhs(time_of(self), state_of(self), rate, self) ? no_solution(self, error) : LD_OK;
}

ld_status vehicle_exchange_values(ld_vehicle_run *self, double *indicator, ld_error *error)
{
    return events(time_of(self), state_of(self), indicator, self) ? no_solution(self, error)
                                                                  : LD_OK;
}

double vehicle_exchange_next(const ld_vehicle_run *self)
{
    return next_stop(self, self->outside.last, INFINITY);
}

// Whether states have left their constraints by more than the tolerance; then those on them.
static bool has_drifted(const ld_vehicle_run *self, double *y)
{
    double atol[MOST_STATES];
    bool unused[MOST_STATES], drifted = false;
    memcpy(y, self->outside.y, (size_t)self->state_count * sizeof *y);
    if (!self->base.drifts)
        return false;
    for (int i = 0; i < self->state_count; i++)
        atol[i] = INFINITY;
    self->base.kind->dynamics->tolerances(&self->base, model_run(self->system->model)->tolerance,
                                          atol, unused);
    self->base.kind->dynamics->project(&self->base, self->outside.t, y);
    for (int i = 0; i < self->state_count; i++)
        drifted |= fabs(y[i] - self->outside.y[i]) > atol[i];
    return drifted;
}

// The next step begins here.
static ld_status begin_step(ld_vehicle_run *self, ld_error *error)
{
    self->outside.last = self->outside.t;
    return vehicle_exchange_values(self, self->outside.event, error);
}

ld_status vehicle_exchange_accept(ld_vehicle_run *self, bool *happens, ld_error *error)
{
    const double rounding = 1e-12, late = 1e-9;
    double value[BASE_MOST_EVENTS], y[MOST_STATES], next = vehicle_exchange_next(self);
    double t = self->outside.t, size = fmax(1, fabs(t));
    *happens = false;
    if (t < self->outside.last - late * size || t > next + late * size)
        return ld_fail(error, LD_ERR_INPUT,
                       "found a step that ends at %.17g s after one that ended at %.17g s; "
                       "expected at most the next event, at %.17g s",
                       t, self->outside.last, next);
    if (t >= next - rounding * size)
        self->outside.t = next;
    *happens = self->outside.t >= next || has_drifted(self, y);
    ld_status status = vehicle_exchange_values(self, value, error);
    for (int i = 0; i < self->base.event_count && !status; i++)
        *happens |= self->outside.event[i] * value[i] < 0;
    return status || *happens ? status : begin_step(self, error);
}

ld_status vehicle_exchange_pass_events(ld_vehicle_run *self, bool *happened, ld_error *error)
{
    const base_system *base = &self->base;
    double y[MOST_STATES], t;
    ld_status status = vehicle_exchange_accept(self, happened, error);
    if (status || !*happened)
        return status;
    t = self->outside.t;
    if (has_drifted(self, y))
        memcpy(self->outside.y, y, (size_t)self->state_count * sizeof *y);
    if (base->kind->next_sample && base->kind->next_sample(base, nextafter(t, -INFINITY)) == t)
        base->kind->sample(base, t, self->outside.y);
    self->latest.known = false;
    return begin_step(self, error);
}
