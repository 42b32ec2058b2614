// Natural frequencies and damping: eigenvalues of the equations linearised at rest.
#include "state/linearise.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "math/functions.h"
#include "math/matrices/dense.h"
#include "math/matrices/general_eigen.h"
#include "math/vectors/rotation_vector.h"
#include "model/parts.h"
#include "state/equilibrium.h"
#include "state/evaluation.h"
#include "state/launch_state.h"
#include "systems/launching/launching_dynamics.h"
#include "systems/launching/launching_kinematics.h"

static const double TWO_PI = 6.283185307179586476925286766559;
// Eigenvalues below this modulus [1/s] belong to the neutral directions of a base that moves.
static const double LEAST_RATE = 1e-2;
// Squares of frequencies nearer to each other than this, relative, are equal but for the
// differences' error.
static const double EQUAL = 1e-6;

// How far a straight tube on slides lies against their front stops [m], where its modes are found:
// beyond the differences' steps, so that no stop lifts.
static const double IN_BATTERY = 1e-6;

static const base_frame ORIGIN = {.A = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, .q = {1, 0, 0, 0}};

// Where in the state the base's speed of a displacement stands, and what has a rate alone.
static int base_speed_at(const launcher_system *launcher, int displacement)
{
    const base_system *base = &launcher->base;
    return launcher->base_at + base->kind->dynamics->speed_of(base, displacement);
}

static int base_extra_at(const launcher_system *launcher, int extra)
{
    const base_system *base = &launcher->base;
    return launcher->base_at + base->kind->dynamics->extra_of(base, extra);
}

void linear_displace(const launch_state *self, const linear_system *system, int unknown,
                     double change, double *y)
{
    const launcher_system *launcher = &self->launcher;
    const launching_layout *at = &launcher->launching.layout;
    const base_dynamics *base = launcher->base.kind->dynamics;
    int tube = system->tube, both = tube + system->rocket, half = system->half;
    if (unknown < tube)
        simulation_displace(self, unknown, change, y);
    else if (unknown < both)
        y[at->x + unknown - tube] += change;
    else if (unknown < half)
        base->displace_slightly(&launcher->base, unknown - both, change, y + launcher->base_at);
    else if (unknown < half + 6)
        y[at->v + unknown - half] += change; // v, then w
    else if (unknown < half + tube)
        y[at->q_dot + unknown - half - 6] += change;
    else if (unknown < half + both)
        y[at->V + unknown - half - tube] += change;
    else if (unknown < 2 * half && base->quicken)
        base->quicken(&launcher->base, unknown - half - both, change, y + launcher->base_at);
    else if (unknown < 2 * half)
        y[base_speed_at(launcher, unknown - half - both)] += change;
    else
        y[base_extra_at(launcher, unknown - 2 * half)] += change;
}

// How tube and rocket stand and move against what carries each: R's position and attitude against
// T, in T; v and w against T, V against the tube, in R.
typedef struct relative_motion {
    v3 r, turn, v, w, V, W;
} relative_motion;

// Velocity of the point of T at R's origin, and T's angular velocity, in R.
static void carried_by_base(const base_frame *base, const double *y, const launching_layout *at,
                            v3 *v, v3 *w)
{
    m3 A = q_matrix(q_from(y + at->quaternion));
    v3 arm = v3_sub(v3_from(y + at->r), base->r);
    *v = m3_apply_transposed(A, v3_add(base->v, v3_cross(base->w, arm)));
    *w = m3_apply_transposed(A, base->w);
}

static relative_motion relative_of(const launch_state *self, double t, const double *y)
{
    const launching_layout *at = &self->launcher.launching.layout;
    launcher_input input;
    launching_output unused;
    launching_pose pose;
    v3 v_T, w_T, v = v3_from(y + at->v), w = v3_from(y + at->w);
    launcher_place(&self->launcher, t, y, &input);
    launching_rocket_pose(&self->launcher.launching, y, &pose, &unused);
    const base_frame *base = &input.launching.base;
    carried_by_base(base, y, at, &v_T, &w_T);
    m3 A = m3_mul(m3_transpose(base->A), q_matrix(q_from(y + at->quaternion)));
    return (relative_motion){
        .r = m3_apply_transposed(base->A, v3_sub(v3_from(y + at->r), base->r)),
        .turn = rv_log(A),
        .v = v3_sub(v, v_T),
        .w = v3_sub(w, w_T),
        .V = v3_sub(v3_from(y + at->V), v3_add(v, v3_cross(w, pose.p1))),
        .W = v3_sub(v3_from(y + at->V + 3), w),
    };
}

// Puts tube and rocket on the base of y as `is` says.
static void set_relative(const launch_state *self, double t, const relative_motion *is, double *y)
{
    const launching_layout *at = &self->launcher.launching.layout;
    launcher_input input;
    launching_output unused;
    launching_pose pose;
    v3 v, w;
    launcher_place(&self->launcher, t, y, &input);
    const base_frame *base = &input.launching.base;
    quat q = q_multiply(base->q, rv_quaternion(is->turn));
    v3_store(y + at->r, v3_add(base->r, m3_apply(base->A, is->r)));
    memcpy(y + at->quaternion, &q, sizeof q);
    carried_by_base(base, y, at, &v, &w);
    v = v3_add(v, is->v);
    w = v3_add(w, is->w);
    v3_store(y + at->v, v);
    v3_store(y + at->w, w);
    launching_rocket_pose(&self->launcher.launching, y, &pose, &unused);
    v3_store(y + at->V, v3_add(is->V, v3_add(v, v3_cross(w, pose.p1))));
    v3_store(y + at->V + 3, v3_add(is->W, w));
}

static void displace_each(const launch_state *self, const linear_system *system,
                          const double *change, double share, double *y)
{
    memcpy(y, system->y, (size_t)self->launcher.state_count * sizeof *y);
    for (int i = 0; i < system->count; i++)
        linear_displace(self, system, i, share * change[i], y);
}

void linear_displace_all(const launch_state *self, const linear_system *system,
                         const double *change, double share, double *y)
{
    const double step = 1e-4; // of the unknown that changes most: rounding and third order are far
    double most = 0;
    for (int i = 0; i < system->count; i++)
        most = fmax(most, fabs(change[i]));
    double h = most > 0 ? step / most : 1;
    relative_motion is = relative_of(self, system->t, system->y), beside[2];
    for (int side = 0; side < 2; side++) {
        displace_each(self, system, change, side ? -h : h, y);
        beside[side] = relative_of(self, system->t, y);
    }
    v3 *part = &is.r, *plus = &beside[0].r, *minus = &beside[1].r;
    for (size_t i = 0; i < sizeof is / sizeof *part; i++)
        part[i] = v3_axpy(part[i], 0.5 * share / h, v3_sub(plus[i], minus[i]));
    displace_each(self, system, change, share, y);
    set_relative(self, system->t, &is, y);
}

// d/dt of the state of the whole, without thrust, and what holds the base's displacements still.
static int rates_of_whole(const launch_state *self, const linear_system *system, const double *y,
                          double *y_dot, double *held)
{
    const launcher_system *launcher = &self->launcher;
    const base_system *moving = &launcher->base;
    launcher_input input;
    launcher_output out;
    simulation_input(self, system->t, y, &input);
    input.formulation = LD_FORMULATION_REDUCED;
    input.launching.thrust = 0;
    input.launching.across = (motor_across){0};
    if (launcher_evaluate(launcher, &input, &system->phase, y, &out))
        return -1;
    launcher_rates(launcher, y, &out, system->phase.rocket, y_dot);
    for (int i = 0; i < moving->displacement_count; i++)
        held[i] = moving->kind->dynamics->held_by(moving, &out.base, i);
    return 0;
}

// d/dt of the state of the empty tube on a base at rest in the origin.
static int rates_of_tube(const launching_system *tube, const launching_phase *phase,
                         const double *y, double *y_dot)
{
    const launching_input input = {.base = ORIGIN};
    launching_output out;
    if (launching_evaluate(tube, &input, phase, y, &out))
        return -1;
    launching_rates(tube, y, &out, false, y_dot);
    return 0;
}

// Rates of the unknowns at state y, in the same order; then what holds the base's displacements.
static int rates(const launch_state *self, const linear_system *system,
                 const launching_system *alone, const double *y, double *r)
{
    const launcher_system *launcher = &self->launcher;
    const launching_layout *at = &launcher->launching.layout;
    double y_dot[LD_MAX_STATES];
    double *held = r + system->count;
    if (alone ? rates_of_tube(alone, &system->phase, y, y_dot)
              : rates_of_whole(self, system, y, y_dot, held))
        return -1;
    int tube = system->tube, both = tube + system->rocket, half = system->half;
    memcpy(r, y_dot + at->r, 3 * sizeof(double));
    memcpy(r + 3, y + at->w, 3 * sizeof(double)); // small rotations in R
    memcpy(r + 6, y_dot + at->q, (size_t)at->nq * sizeof(double));
    memcpy(r + half, y_dot + at->v, 6 * sizeof(double));
    memcpy(r + half + 6, y_dot + at->q_dot, (size_t)at->nq * sizeof(double));
    if (system->phase.rocket) {
        memcpy(r + tube, y_dot + at->x, X_COUNT * sizeof(double));
        memcpy(r + half + tube, y_dot + at->V, 6 * sizeof(double));
    }
    for (int i = 0; i < system->base; i++) {
        int place = base_speed_at(launcher, i);
        r[both + i] = y[place]; // angular velocity and small rotations in the base's axes
        r[half + both + i] = y_dot[place];
    }
    for (int i = 2 * half; i < system->count; i++)
        r[i] = y_dot[base_extra_at(launcher, i - 2 * half)];
    return 0;
}

int linear_rates(const launch_state *self, const linear_system *system, const double *y, double *r)
{
    return rates(self, system, NULL, y, r);
}

static void count_unknowns(const launch_state *self, bool alone, linear_system *system)
{
    const base_system *base = &self->launcher.base;
    system->tube = 6 + self->launcher.launching.layout.nq;
    system->rocket = system->phase.rocket ? 6 : 0;
    system->base = alone ? 0 : base->displacement_count;
    system->half = system->tube + system->rocket + system->base;
    system->count = 2 * system->half + (alone ? 0 : base->extra_count);
}

ld_status linear_rest(launch_state *self, linear_system *system, ld_error *error)
{
    ld_equilibrium_summary unused;
    *system = (linear_system){.t = -model_run(self->model)->lead_in,
                              .phase = simulation_start_phase(self)};
    system->phase.frictionless = true;
    self->piece = -1;
    self->pressure_piece = 0;
    count_unknowns(self, false, system);
    ld_status status = simulation_equilibrium(self, system->t, system->y, &unused, error);
    if (!status)
        simulation_move_with_base(self, system->t, system->y);
    return status;
}

// Rates where an unknown is h more, and less.
typedef struct difference {
    double h, plus[2 * LD_MAX_STATES], minus[2 * LD_MAX_STATES];
} difference;

// Those of unknown j by a step h.
static int rates_beside(const launch_state *self, const launching_system *alone,
                        const linear_system *system, int j, double h, difference *of)
{
    double trial[LD_MAX_STATES];
    of->h = h;
    size_t size = (size_t)self->launcher.state_count * sizeof(double);
    memcpy(trial, system->y, size);
    linear_displace(self, system, j, h, trial);
    int bad = rates(self, system, alone, trial, of->plus);
    memcpy(trial, system->y, size);
    linear_displace(self, system, j, -h, trial);
    return bad ? bad : rates(self, system, alone, trial, of->minus);
}

// Whether differences to both sides are not those of a straight line.
static bool is_bent(int n, const double *middle, const difference *of)
{
    double bend = 0, rise = 0; // squares
    for (int i = 0; i < n; i++) {
        double bent = of->plus[i] - 2 * middle[i] + of->minus[i],
               risen = of->plus[i] - of->minus[i];
        bend += bent * bent;
        rise += risen * risen;
    }
    return bend > 0.03 * 0.03 * rise;
}

// The same, by a step so small that nothing which is pressed in by little lets go within it, where
// there is one: else its stiffness would be that of neither state, and not the same back and forth.
static int straight_rates(const launch_state *self, const launching_system *alone,
                          const linear_system *system, int j, const double *middle, difference *of)
{
    const double coarse = j < system->half ? 1e-7 : 1e-5, fine = 0.01 * coarse;
    int bad = rates_beside(self, alone, system, j, coarse, of);
    if (bad || !is_bent(system->count, middle, of))
        return bad;
    bad = rates_beside(self, alone, system, j, fine, of);
    if (bad || !is_bent(system->count, middle, of))
        return bad;
    return rates_beside(self, alone, system, j, coarse, of);
}

// Finds the Jacobian by central differences about what stands in `system`, of the whole or of the
// tube `alone`.
static ld_status linearise(const launch_state *self, const launching_system *alone,
                           linear_system *system, ld_error *error)
{
    int n = system->count;
    difference of;
    double middle[2 * LD_MAX_STATES], *plus = of.plus, *minus = of.minus;
    system->J = calloc((size_t)n * (size_t)(n + system->base + 1), sizeof(double));
    if (!system->J)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the linearised equations");
    system->held = system->J + n * n;
    system->step = system->held + system->base * n;
    int bad = rates(self, system, alone, system->y, middle);
    for (int j = 0; j < n; j++) {
        if (bad || straight_rates(self, alone, system, j, middle, &of))
            return ld_fail(error, LD_ERR_NUMERIC, "the equations cannot be linearised");
        double h = system->step[j] = of.h;
        for (int i = 0; i < n; i++)
            system->J[i + n * j] = (plus[i] - minus[i]) / (2 * h);
        for (int i = 0; i < system->base; i++)
            system->held[i + system->base * j] = (plus[n + i] - minus[n + i]) / (2 * h);
    }
    return LD_OK;
}

enum {
    VERTICAL,
    LATERAL,
    ALONG,
    TWIST,
    ROCKET_Y,
    ROCKET_Z,
    ROCKET_ROLL,
    GROUPS, // and those of the base
};
static const char *const group_names[GROUPS] = {
    [VERTICAL] = "vertical plane",
    [LATERAL] = "lateral plane", // of the guide
    [ALONG] = "along its axis",
    [TWIST] = "twist",
    [ROCKET_Y] = "rocket, pitch and heave",
    [ROCKET_Z] = "rocket, yaw and sway",
    [ROCKET_ROLL] = "rocket, roll",
};

// Adds the name of a group to `shape`: "tube, vertical plane", or "rail, ...".
static void add_name(const launch_state *self, int group, char shape[LD_SHAPE_TEXT])
{
    const base_system *base = &self->launcher.base;
    size_t used = strlen(shape);
    snprintf(shape + used, LD_SHAPE_TEXT - used, "%s%s%s",
             group <= TWIST ? model_guide_word(self->model) : "", group <= TWIST ? ", " : "",
             group < GROUPS ? group_names[group]
                            : base->kind->dynamics->group_name(base, group - GROUPS));
}

// Kinetic energy of tube and rocket in an eigenvector's speed number i, by group.
static void add_launching_energy(const launch_state *self, int i, double amount, double *energy)
{
    const launching_system *launching = &self->launcher.launching;
    int nb = launching->tube.flexible.nb, nt = launching->tube.flexible.nt,
        nq = launching->layout.nq;
    double m = launching->tube.m, j = launching->tube.flexible.j0;
    const double mass[6] = {m, m, m, launching->tube.jx, j, j};
    static const int group[6] = {ALONG, VERTICAL, LATERAL, TWIST, LATERAL, VERTICAL};
    static const int rocket_group[6] = {ALONG, ROCKET_Y, ROCKET_Z, ROCKET_ROLL, ROCKET_Z, ROCKET_Y};
    const rocket_mass *full = &self->motor->full;
    double inertia[6] = {full->m,         full->m,         full->m,
                         full->J.a[0][0], full->J.a[1][1], full->J.a[2][2]};
    int k = i - 6;
    if (i < 6)
        energy[group[i]] += mass[i] * amount;
    else if (k < nq)
        energy[k < nb            ? VERTICAL
               : k < 2 * nb      ? LATERAL
               : k < 2 * nb + nt ? TWIST
                                 : ALONG] += amount;
    else
        energy[rocket_group[k - nq]] += inertia[k - nq] * amount;
}

// Names what moves most in an eigenvector: the group with the largest kinetic energy, and a second
// one that has at least a third of it. Returns twice the energy of all.
static double name_shape(const launch_state *self, const linear_system *system,
                         const double *squared_speeds, char shape[LD_SHAPE_TEXT])
{
    const base_system *base = &self->launcher.base;
    double energy[GROUPS + BASE_GROUPS] = {0};
    int both = system->tube + system->rocket, best = 0, second = -1;
    for (int i = 0; i < both; i++)
        add_launching_energy(self, i, squared_speeds[i], energy);
    for (int i = both; i < system->half; i++) {
        int group;
        double inertia = base->kind->dynamics->inertia_of(base, i - both, &group);
        energy[GROUPS + group] += inertia * squared_speeds[i];
    }
    double all = energy[0];
    for (int g = 1; g < GROUPS + BASE_GROUPS; g++) {
        all += energy[g];
        if (energy[g] > energy[best])
            best = g;
    }
    for (int g = 0; g < GROUPS + BASE_GROUPS; g++)
        if (g != best && energy[g] >= energy[best] / 3 &&
            (second < 0 || energy[g] > energy[second]))
            second = g;
    shape[0] = '\0';
    add_name(self, best, shape);
    if (second >= 0) {
        strcat(shape, "; ");
        add_name(self, second, shape);
    }
    return all;
}

// What general_eigen()'s `bad` means.
static ld_status eigenvalues_failed(int bad, ld_error *error)
{
    if (bad == EIGEN_NO_MEMORY)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the eigenvalues");
    return ld_fail(error, LD_ERR_NUMERIC, "the eigenvalues of the linearised equations failed");
}

// A shape of the undamped equations: omega^2 and the eigenvectors of K T.
typedef struct undamped {
    double square;
    const double *right, *left;
} undamped;

static int by_square(const void *a, const void *b)
{
    const undamped *p = a, *q = b;
    return (p->square > q->square) - (p->square < q->square);
}

static int by_damping(const void *a, const void *b)
{
    const ld_mode *p = a, *q = b;
    return (p->damping > q->damping) - (p->damping < q->damping);
}

// Whether speed number i is one of the tube or the rocket in the vertical plane.
static bool is_vertical(const launch_state *self, const linear_system *system, int i)
{
    int k = i < system->tube ? i : i - system->tube;
    return k == 1 || k == 5 || (i >= 6 && i < 6 + self->launcher.launching.tube.flexible.nb);
}

// Shapes of one frequency, any combination of which is a shape too, and matrices of count x count.
typedef struct equal_shapes {
    const undamped *shape;
    int count;
    double *products; // left^T right, by rows
    double *damped;   // left^T C right, C = -J's block of speeds on speeds, by columns
    double *vertical; // left^T right of the vertical speeds alone, by columns
    double *mix;      // what combines to modes, by columns
} equal_shapes;

enum { EQUAL_MATRICES = 4 };

// `work`: room for as many matrices.
static equal_shapes equal_of(const undamped *shape, int count, double *work)
{
    int square = count * count;
    return (equal_shapes){.shape = shape,
                          .count = count,
                          .products = work,
                          .damped = work + square,
                          .vertical = work + 2 * square,
                          .mix = work + 3 * square};
}

// Fills all but `mix`.
static void project(const launch_state *self, const linear_system *system, const equal_shapes *of)
{
    int n = system->half, count = of->count;
    const undamped *shape = of->shape;
    for (int a = 0; a < count; a++)
        for (int b = 0; b < count; b++) {
            const double *left = shape[a].left, *right = shape[b].right;
            double all = 0, damping = 0, some = 0;
            for (int j = 0; j < n; j++) {
                all += left[j] * right[j];
                if (is_vertical(self, system, j))
                    some += left[j] * right[j];
                for (int i = 0; i < n; i++)
                    damping -= left[i] * system->J[n + i + system->count * (n + j)] * right[j];
            }
            of->products[a * count + b] = all;
            of->damped[a + count * b] = damping;
            of->vertical[a + count * b] = some;
        }
}

// What the dampers do to the shapes: (left^T right)^-1 left^T C right, with the eigenvalues `rate`,
// 2 zeta omega [1/s], and eigenvectors in `mix`. Of shapes that are damped alike a trace more in
// the vertical plane takes those in the planes.
static int damp_shapes(const launch_state *self, const linear_system *system,
                       const equal_shapes *of, double *rate)
{
    int count = of->count, square = count * count, pivot[LD_MAX_STATES];
    double *products = of->products, *damped = of->damped, *vertical = of->vertical, sum = 0;
    double unused[LD_MAX_STATES];
    project(self, system, of);
    if (lu_factor(count, products, pivot))
        return -1;
    for (int b = 0; b < count; b++) {
        lu_solve(count, products, pivot, damped + count * b);
        lu_solve(count, products, pivot, vertical + count * b);
        sum += fabs(damped[b + count * b]);
    }
    for (int i = 0; i < square && count > 1; i++)
        damped[i] += 1e-9 * sum * vertical[i];
    return general_eigen(count, damped, rate, unused, NULL, of->mix);
}

// The modes that shapes of one frequency have, by ascending damping.
static int modes_of_shapes(const launch_state *self, const linear_system *system,
                           const equal_shapes *of, ld_mode *modes)
{
    int count = of->count;
    const undamped *shape = of->shape;
    double rate[LD_MAX_STATES], squares[LD_MAX_STATES], *mix = of->mix, mean = 0;
    int bad = damp_shapes(self, system, of, rate);
    if (bad)
        return bad;
    for (int i = 0; i < count; i++)
        mean += shape[i].square / count;
    for (int i = 0; i < count; i++) {
        double omega = sqrt(mean), damping = 0.5 * rate[i] / omega;
        for (int k = 0; k < system->half; k++) {
            double speed = 0;
            for (int b = 0; b < count; b++)
                speed += shape[b].right[k] * mix[b + count * i];
            squares[k] = speed * speed;
        }
        modes[i] =
            (ld_mode){.frequency = omega / TWO_PI, .damping = damping, .real = -damping * omega};
        name_shape(self, system, squares, modes[i].shape);
    }
    qsort(modes, (size_t)count, sizeof *modes, by_damping);
    return 0;
}

// Shapes of the undamped modes K T v = omega^2 v, from x_dot = T v, v_dot = -K x - C v, by
// ascending frequency; those that the constraints leave at zero are dropped. `work`: room for three
// n x n matrices and two rows, of which the first two matrices hold the eigenvectors afterwards.
static int undamped_shapes(const linear_system *system, undamped *shape, int *count, double *work)
{
    int n = system->half;
    double *left = work, *right = left + n * n, *KT = right + n * n, *wr = KT + n * n, *wi = wr + n;
    memset(KT, 0, (size_t)n * (size_t)n * sizeof *KT);
    for (int j = 0; j < n; j++)
        for (int k = 0; k < n; k++)
            for (int i = 0; i < n; i++)
                KT[i + n * j] -=
                    system->J[n + i + system->count * k] * system->J[k + system->count * (n + j)];
    int bad = general_eigen(n, KT, wr, wi, left, right);
    *count = 0;
    for (int i = 0; i < n && !bad; i++)
        if (wr[i] >= 1)
            shape[(*count)++] = (undamped){wr[i], right + n * i, left + n * i};
    qsort(shape, (size_t)*count, sizeof *shape, by_square);
    return bad;
}

// Undamped modes by ascending frequency, with the damping of each shape.
static ld_status undamped_modes(const launch_state *self, const linear_system *system,
                                ld_mode *modes, int capacity, int *count, ld_error *error)
{
    int n = system->half, shapes = 0, bad, equal;
    size_t square = (size_t)n * (size_t)n;
    undamped *shape = malloc((size_t)n * sizeof *shape);
    ld_mode *some = malloc((size_t)n * sizeof *some);
    double *work = malloc((2 + EQUAL_MATRICES) * square * sizeof *work);
    *count = 0;
    if (!shape || !some || !work) {
        free(shape);
        free(some);
        free(work);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the modes");
    }
    bad = undamped_shapes(system, shape, &shapes, work);
    for (int i = 0; i < shapes && !bad; i += equal) {
        equal = 1;
        while (i + equal < shapes && shape[i + equal].square <= (1 + EQUAL) * shape[i].square)
            equal++;
        const equal_shapes of = equal_of(shape + i, equal, work + 2 * square);
        bad = modes_of_shapes(self, system, &of, some);
        for (int k = 0; k < equal && !bad && *count < capacity; k++)
            modes[(*count)++] = some[k];
    }
    free(shape);
    free(some);
    free(work);
    return bad ? eigenvalues_failed(bad, error) : LD_OK;
}

static int by_size(const void *a, const void *b)
{
    const ld_pole *p = a, *q = b;
    double x = hypot(p->real, p->imaginary), y = hypot(q->real, q->imaginary);
    return (x > y) - (x < y);
}

// A growing motion, and the key of what feeds it.
typedef struct fed_pole {
    ld_pole pole;
    const char *feeder; // NULL: there is none
} fed_pole;

// What feeds a growing motion: of all that ought to hold a displacement of the base still, what
// does most work on it, if that is half of what the motion gains. `energy`: twice the kinetic one
// of the eigenvector; NULL: nothing of the kind.
static const char *feeder_of(const launch_state *self, const linear_system *system, double rate,
                             const double *real, const double *imaginary, double energy)
{
    const char *feeder = NULL;
    int first = system->half + system->tube + system->rocket;
    double most = rate * energy;
    for (int i = 0; i < system->base; i++) {
        double force[2] = {0};
        for (int j = 0; j < system->count; j++) {
            force[0] += system->held[i + system->base * j] * real[j];
            force[1] += imaginary ? system->held[i + system->base * j] * imaginary[j] : 0;
        }
        double power =
            force[0] * real[first + i] + (imaginary ? force[1] * imaginary[first + i] : 0);
        if (power > most) {
            most = power;
            feeder = self->launcher.base.kind->dynamics->holder_of(&self->launcher.base, i);
        }
    }
    return feeder;
}

// Eigenvalues as they are found: the first `capacity`, and, unless NULL, of those whose motion its
// holder feeds the one that grows fastest.
typedef struct pole_list {
    ld_pole *pole;
    int capacity, count;
    fed_pole *fed;
} pole_list;

// Eigenvalues of J with imaginary part >= 0, by ascending modulus, each with what moves in it;
// those below `least` [1/s], which constraints and neutral directions leave at zero, are dropped.
static ld_status eigenvalues(const launch_state *self, const linear_system *system, double least,
                             pole_list *to, ld_error *error)
{
    int n = system->count, half = system->half;
    size_t square = (size_t)n * (size_t)n;
    double *memory = malloc((2 * square + 3 * (size_t)n) * sizeof *memory);
    if (!memory)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the eigenvalues");
    double *J = memory, *right = J + square, *wr = right + square, *wi = wr + n, *squares = wi + n;
    memcpy(J, system->J, square * sizeof *J);
    int bad = general_eigen(n, J, wr, wi, NULL, right);
    to->count = 0;
    for (int i = 0; i < n && !bad && to->count < to->capacity; i++) {
        if (wi[i] < 0 || hypot(wr[i], wi[i]) < least)
            continue;
        ld_pole *pole = &to->pole[to->count++];
        *pole = (ld_pole){.real = wr[i], .imaginary = wi[i]};
        const double *real = right + n * i, *imaginary = wi[i] > 0 ? real + n : NULL;
        for (int k = 0; k < half; k++)
            squares[k] = real[half + k] * real[half + k] +
                         (imaginary ? imaginary[half + k] * imaginary[half + k] : 0);
        double energy = name_shape(self, system, squares, pole->shape);
        const char *feeder = to->fed && wr[i] >= fmax(least, to->fed->pole.real)
                                 ? feeder_of(self, system, wr[i], real, imaginary, energy)
                                 : NULL;
        if (feeder)
            *to->fed = (fed_pole){*pole, feeder};
    }
    free(memory);
    qsort(to->pole, (size_t)to->count, sizeof *to->pole, by_size);
    return bad ? eigenvalues_failed(bad, error) : LD_OK;
}

// Whether a motion may grow by more than `least` [1/s]: by the eigenvalues alone, which take a
// third of the time and are rounded otherwise, so half of it is asked for. True where they fail.
static bool may_grow(const linear_system *system, double least)
{
    int n = system->count;
    size_t square = (size_t)n * (size_t)n;
    double *J = malloc((square + 2 * (size_t)n) * sizeof *J);
    if (!J)
        return true;
    double *wr = J + square;
    memcpy(J, system->J, square * sizeof *J);
    bool may = general_eigenvalues(n, J, wr, wr + n) != 0;
    for (int i = 0; i < n && !may; i++)
        may = wr[i] > 0.5 * least;
    free(J);
    return may;
}

// Modes of a launcher whose base moves with it: its pairs of complex eigenvalues.
static void modes_of_poles(const ld_pole *poles, int pole_count, ld_mode *modes, int capacity,
                           int *count)
{
    *count = 0;
    for (int i = 0; i < pole_count && *count < capacity; i++) {
        if (poles[i].imaginary == 0)
            continue;
        double modulus = hypot(poles[i].real, poles[i].imaginary);
        ld_mode *mode = &modes[(*count)++];
        *mode = (ld_mode){.frequency = modulus / TWO_PI,
                          .damping = -poles[i].real / modulus,
                          .real = poles[i].real};
        memcpy(mode->shape, poles[i].shape, sizeof mode->shape);
    }
}

static bool on_slides(const ld_model *model)
{
    bool any = false;
    for (int k = 0; k < model_tubes(model)->support_count; k++)
        any |= model_tubes(model)->support[k].recoil.present;
    return any;
}

// The equations of the tube without rocket, linearised where it is straight. The state's tube has
// no weight from then on.
static ld_status linearise_tube(launch_state *self, linear_system *system, ld_error *error)
{
    // straight it rests without gravity alone, and no pose of the base counts
    launching_system *weightless = &self->launcher.launching;
    weightless->tube.gravity = 0;
    simulation_straight(self, &ORIGIN, system->y);
    if (on_slides(self->model))
        system->y[weightless->layout.r] += IN_BATTERY;
    count_unknowns(self, true, system);
    return linearise(self, weightless, system, error);
}

ld_status simulation_tube_modes(const ld_simulation *simulation, ld_mode *modes, int capacity,
                                int *count, ld_error *error)
{
    launch_state state, *self = &state;
    linear_system system = {.phase.frictionless = true}; // without a rocket
    *count = 0;
    if (!model_has_launcher(simulation->model))
        return LD_OK; // a flight alone has no tube
    ld_status status = launch_state_begin(self, simulation, error);
    if (status)
        return status;
    status = linearise_tube(self, &system, error);
    if (!status)
        status = undamped_modes(self, &system, modes, capacity, count, error);
    free(system.J);
    launch_state_end(self);
    return status;
}

ld_status simulation_tube_matrices(const ld_simulation *simulation, int *count, double *K,
                                   double *C, ld_error *error)
{
    launch_state state, *self = &state;
    linear_system system = {.phase.frictionless = true};
    ld_status status = launch_state_begin(self, simulation, error);
    if (status)
        return status;
    status = linearise_tube(self, &system, error);
    int n = *count = system.half, all = system.count;
    for (int i = 0; i < n && !status; i++)
        for (int j = 0; j < n; j++) {
            C[i * n + j] = -system.J[n + i + all * (n + j)];
            K[i * n + j] = 0;
            for (int k = 0; k < n; k++) // x_dot = T v
                K[i * n + j] -= system.J[n + i + all * k] * system.J[k + all * (n + j)];
        }
    free(system.J);
    launch_state_end(self);
    return status;
}

int ld_simulation_tube_modes(const ld_simulation *simulation, ld_mode *modes, int capacity)
{
    int count = simulation->mode_count < capacity ? simulation->mode_count : capacity;
    memcpy(modes, simulation->mode, (size_t)count * sizeof *modes);
    return count;
}

ld_status simulation_linearise(launch_state *self, bool rubbing, bool restored,
                               linear_system *system, ld_error *error)
{
    static const base_disturbance none;
    self->launcher.base.disturbed = &none;
    ld_status status = linear_rest(self, system, error);
    system->phase.frictionless = !rubbing;
    system->phase.restoring = restored ? RESTORING : 0;
    if (!status)
        status = linearise(self, NULL, system, error);
    self->launcher.base.disturbed = NULL;
    return status;
}

ld_status simulation_system_modes(const ld_simulation *simulation, system_modes *found,
                                  ld_error *error)
{
    linear_system system = {0};
    launch_state state, *self = &state;
    bool moving = simulation->launcher.base.kind->dynamics != NULL;
    ld_status status = launch_state_begin(self, simulation, error);
    if (status)
        return status;
    status = simulation_linearise(self, false, false, &system, error);
    pole_list poles = {.pole = found->pole, .capacity = found->pole_capacity};
    if (!status)
        status = eigenvalues(self, &system, moving ? LEAST_RATE : 1, &poles, error);
    found->pole_count = poles.count;
    if (!status && moving)
        modes_of_poles(found->pole, poles.count, found->mode, found->capacity, &found->count);
    else if (!status)
        status = undamped_modes(self, &system, found->mode, found->capacity, &found->count, error);
    free(system.J);
    launch_state_end(self);
    return status;
}

// A motion without stiffness and damping, as of a parked vehicle along its road, has the eigenvalue
// 0 twice; errors of the differences, relative to the largest rate's square, make a pair of it.
static bool is_neutral(const pole_list *found, const ld_pole *pole)
{
    double most = 0, opposite = INFINITY;
    for (int i = 0; i < found->count; i++) {
        const ld_pole *of = &found->pole[i];
        most = fmax(most, hypot(of->real, of->imaginary));
        if (of->imaginary == 0)
            opposite = fmin(opposite, fabs(of->real + pole->real));
    }
    return pole->imaginary == 0 && opposite < 1e-3 * pole->real &&
           pole->real * pole->real < 1e-9 * most * most;
}

ld_status simulation_check_stability(const ld_simulation *simulation, ld_pole *growing,
                                     ld_error *error)
{
    enum { MOST = 2 * LD_MAX_STATES };
    linear_system system = {0};
    fed_pole fed = {0};
    pole_list found = {.pole = malloc(MOST * sizeof *found.pole), .capacity = MOST, .fed = &fed};
    const base_dynamics *dynamics = simulation->launcher.base.kind->dynamics;
    *growing = (ld_pole){0};
    if (!found.pole)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the eigenvalues");
    launch_state state;
    ld_status status = launch_state_begin(&state, simulation, error);
    // without an equilibrium on a flat road there is nothing to say
    ld_error unused;
    if (!status && !simulation_linearise(&state, false, false, &system, &unused) &&
        may_grow(&system, LEAST_RATE))
        eigenvalues(&state, &system, LEAST_RATE, &found, &unused);
    // what grows by less than a thousandth of its rate is within the differences' error
    for (int i = 0; i < found.count; i++)
        if (found.pole[i].real >= LEAST_RATE &&
            found.pole[i].real > fmax(growing->real, 1e-3 * found.pole[i].imaginary) &&
            !is_neutral(&found, &found.pole[i]))
            *growing = found.pole[i];
    if (fed.feeder)
        status =
            ld_fail(error, LD_ERR_INPUT,
                    "%s: unstable: about its equilibrium a motion of %.3g Hz grows by %.3g 1/s "
                    "(launchdyn modes lists all)",
                    fed.feeder, fed.pole.imaginary / TWO_PI, fed.pole.real);
    else if (growing->real > 0 && growing->imaginary == 0 && dynamics->check_growing)
        status = dynamics->check_growing(&state.launcher.base, growing->real, error);
    launch_state_end(&state); // the feeder's name is the base's
    free(found.pole);
    free(system.J);
    return status;
}
