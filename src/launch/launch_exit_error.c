// The error of the state, e, is carried along with the run: each step adds its estimated error,
// and between steps e moves as a twin of the run does that is off by e,
//
//   e_dot = f(t, y + e) - f(t, y),
//
// by the symplectic rule of Euler, speeds first, then places; f(t, y) is known. It takes one more
// evaluation a step, and the nearness of e to 0 decides how accurate it is, not the step. The rule
// is stable up to h omega = 2, the run's steps are longer: so what the twin's speeds change by is
// softened as an implicit step would, by (1 + h C/2 + h^2 K/4)^-1 of the tube on its supports. What
// carries the launcher moves as in the run.
#include "launch/launch_exit_error.h"

#include <stdlib.h>
#include <string.h>

#include "math/functions.h"
#include "math/matrices/dense.h"
#include "model/parts.h"
#include "state/evaluation.h"
#include "state/exit_figures.h"
#include "state/linearise.h"
#include "systems/launching/launching_kinematics.h"

// Estimated errors are those of the lower order; those that kinks leave, which come and go between
// two of its stages, are larger. So many times e are reported: of 400 random launches 97 % are then
// within three times what is reported (simulation.exit_error). Kinks fall more slowly with the
// tolerance than the estimate does: below the usual tolerance more is reported.
static const double TOLD = 3;
static const double USUAL_TOLERANCE = 1e-5;
// Rates below this [rad/s] are as good as none.
static const double LEAST_RATES = 1e-3;

struct exit_error {
    launcher_output out;        // of the twin
    double t;                   // [s] where the step under way began
    double y[LD_MAX_STATES];    // the run there
    double e[LD_MAX_STATES];    // of tube and rocket
    double run[LD_MAX_STATES];  // d/dt of y
    double rate[LD_MAX_STATES]; // d/dt of e
    bool under_way;             // a step in which e moves
    bool lost;                  // e has grown beyond what the equations bear
    int count;                  // of speeds of the tube
    double *K, *C, *LU;         // [count * count] by rows; LU: the factors of 1 + h C/2 + h^2 K/4
    int pivot[6 + LD_MAX_MODAL];
    double h; // [s] of the factors; 0: none
};

// ---- life

ld_status exit_error_create(const ld_simulation *simulation, exit_error **out, ld_error *error)
{
    int most = 6 + simulation->launcher.launching.layout.nq;
    size_t square = (size_t)most * (size_t)most;
    exit_error *self = aligned_alloc(64, (sizeof *self + 63) / 64 * 64);
    double *matrices = malloc(3 * square * sizeof *matrices);
    *out = self;
    if (self)
        memset(self, 0, sizeof *self);
    if (!self || !matrices) {
        free(matrices);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the error of the steps");
    }
    self->K = matrices;
    self->C = matrices + square;
    self->LU = matrices + 2 * square;
    ld_status status = simulation_tube_matrices(simulation, &self->count, self->K, self->C, error);
    if (!status || status == LD_ERR_MEMORY)
        return status;
    exit_error_free(self);
    *out = NULL;
    return LD_OK;
}

void exit_error_free(exit_error *self)
{
    if (self)
        free(self->K);
    free(self);
}

// ---- steps

enum { PAIRS = 4 };
// Places in the state and the speeds of the same.
typedef struct pair {
    int place, places, speed, speeds;
} pair;

static void find_pairs(const launching_layout *at, pair of[PAIRS])
{
    of[0] = (pair){at->r, 3, at->v, 3};
    of[1] = (pair){at->quaternion, 4, at->w, 3};
    of[2] = (pair){at->q, at->nq, at->q_dot, at->nq};
    of[3] = (pair){at->x, X_COUNT, at->V, 6};
}

// The state of the twin at y.
static void find_twin(const exit_error *self, int count, const double *y, double *twin)
{
    for (int i = 0; i < count; i++)
        twin[i] = y[i] + self->e[i];
}

static void drop_estimate(exit_error *self)
{
    memset(self->e, 0, sizeof self->e);
    self->under_way = false;
    self->lost = true;
}

// e begins at the ignition.
void exit_error_begin_step(exit_error *self, ld_run *run)
{
    launch_state *launch = &run->launch;
    const launcher_system *launcher = &launch->launcher;
    double twin[LD_MAX_STATES], moved[LD_MAX_STATES];
    int count = launcher->base_at;
    self->under_way = launch->phase.rocket && launch_is_ignited(launch);
    if (!self->under_way) {
        memset(self->e, 0, sizeof self->e);
        self->lost = false;
        return;
    }
    self->t = propagator_time(run->propagator);
    memcpy(self->y, propagator_state(run->propagator),
           (size_t)launcher->state_count * sizeof(double));
    memcpy(twin, self->y, (size_t)launcher->state_count * sizeof(double));
    find_twin(self, count, self->y, twin);
    launcher_input input;
    simulation_input(launch, self->t, twin, &input);
    const launcher_output *out = simulation_output(launch, self->t, self->y);
    if (!out ||
        launcher_evaluate_tube(launcher, model_run(launch->model)->formulation, &input.launching,
                               &launch->phase, twin, &self->out.launching)) {
        drop_estimate(self);
        return;
    }
    launching_rates(&launcher->launching, self->y, &out->launching, true, self->run);
    launching_rates(&launcher->launching, twin, &self->out.launching, true, moved);
    for (int i = 0; i < count; i++)
        self->rate[i] = moved[i] - self->run[i];
}

// Factors serve shorter steps, too.
static void factor(exit_error *self, double h)
{
    if (h <= self->h && h > 0.5 * self->h)
        return;
    int n = self->count;
    self->h = 1.25 * h;
    for (int i = 0; i < n * n; i++)
        self->LU[i] = 0.5 * self->h * self->C[i] + 0.25 * self->h * self->h * self->K[i];
    for (int i = 0; i < n; i++)
        self->LU[i * n + i] += 1;
    if (lu_factor(n, self->LU, self->pivot))
        drop_estimate(self);
}

// What the tube's speeds change by in a step of h, as an implicit one has it.
static void soften(exit_error *self, const launching_layout *at, double h, double *change)
{
    double v[6 + LD_MAX_MODAL];
    size_t modal = (size_t)at->nq * sizeof *v;
    factor(self, h);
    memcpy(v, change + at->v, 3 * sizeof *v);
    memcpy(v + 3, change + at->w, 3 * sizeof *v);
    memcpy(v + 6, change + at->q_dot, modal);
    lu_solve(self->count, self->LU, self->pivot, v);
    memcpy(change + at->v, v, 3 * sizeof *v);
    memcpy(change + at->w, v + 3, 3 * sizeof *v);
    memcpy(change + at->q_dot, v + 6, modal);
}

// Speeds by their rates where the step began, then places by the rates that these speeds give.
static void advance_state(exit_error *self, const launcher_system *launcher, double h)
{
    const launching_system *launching = &launcher->launching;
    const launching_layout *at = &launching->layout;
    double change[LD_MAX_STATES], twin[LD_MAX_STATES], moved[LD_MAX_STATES];
    launching_pose pose;
    pair of[PAIRS];
    find_pairs(at, of);
    for (int i = 0; i < launcher->base_at; i++)
        change[i] = h * self->rate[i];
    soften(self, at, h, change);
    for (int k = 0; k < PAIRS; k++)
        for (int i = of[k].speed; i < of[k].speed + of[k].speeds; i++)
            self->e[i] += change[i];
    find_twin(self, launcher->base_at, self->y, twin);
    launching_rocket_pose(launching, twin, &pose, &self->out.launching);
    launching_rates(launching, twin, &self->out.launching, true, moved);
    for (int k = 0; k < PAIRS; k++)
        for (int i = of[k].place; i < of[k].place + of[k].places; i++)
            self->e[i] += h * (moved[i] - self->run[i]);
}

void exit_error_end_step(exit_error *self, ld_run *run)
{
    const launcher_system *launcher = &run->launch.launcher;
    double added[LD_MAX_STATES], size = 0;
    if (!self->under_way)
        return;
    advance_state(self, launcher, propagator_time(run->propagator) - self->t);
    propagator_error(run->propagator, added);
    for (int i = 0; i < launcher->base_at; i++) {
        self->e[i] += added[i];
        size += fabs(self->e[i]);
    }
    if (!isfinite(size))
        drop_estimate(self);
}

// ---- what is reported

static ld_tip_off tip_off_at(const ld_run *run, const launcher_input *input, const double *y)
{
    const launching_system *launching = &run->launch.launcher.launching;
    launching_output unused;
    launching_pose pose;
    launching_rocket_pose(launching, y, &pose, &unused);
    rocket_motion motion = rocket_motion_of(&pose, input->launching.mass.c, y, &launching->layout);
    return tip_off_of(&input->launching.base, &motion);
}

// Never less than the tolerance of the rates.
void exit_error_record(const exit_error *self, ld_run *run, double t, const double *y)
{
    launch_state *launch = &run->launch;
    ld_rocket_summary *rocket = &run->summary.rocket[launch->current];
    double twin[LD_MAX_STATES];
    launcher_input input;
    simulation_input(launch, t, y, &input);
    find_twin(self, launch->launcher.base_at, y, twin);
    ld_tip_off of_twin = tip_off_at(run, &input, twin), *own = &rocket->tip_off;
    double rates = hypot(own->pitch_rate, own->yaw_rate);
    double apart = hypot(of_twin.pitch_rate - own->pitch_rate, of_twin.yaw_rate - own->yaw_rate);
    double tolerance = model_run(launch->model)->tolerance;
    double estimate =
        TOLD * fmax(1, pow(USUAL_TOLERANCE / tolerance, 0.3)) * fmax(apart, tolerance * rates);
    if (self->lost || !isfinite(estimate))
        estimate = fmax(rates, LEAST_RATES);
    rocket->exit_error.rates = estimate;
    rocket->exit_error.yaw_rate = estimate / fabs(cos(rocket->pitch));
    rocket->exit_error.relative = estimate / fmax(rates, LEAST_RATES);
}

void exit_error_note(ld_run *run)
{
    const ld_rocket_summary *worst = &run->summary.rocket[0];
    for (int i = 1; i < run->summary.rocket_count; i++)
        if (run->summary.rocket[i].exit_error.relative > worst->exit_error.relative)
            worst = &run->summary.rocket[i];
    if (worst->exit_error.relative > EXIT_ERROR_NOTED)
        summary_note(&run->summary,
                     "the exit rates of %s %d may be off by %.2g %%: integration errors grow in "
                     "its guide; reduce run.tolerance",
                     model_guide_word(run->launch.model), worst->tube,
                     100 * worst->exit_error.relative);
}
