#include "systems/bases/multibody_rest.h"

#include <stdlib.h>
#include <string.h>

#include "math/functions.h"
#include "math/matrices/lapack.h"
#include "math/matrices/symmetric_eigen.h"
#include "model/model.h"
#include "systems/bases/mechanism_base.h"
#include "systems/mechanism/mechanism_loops.h"
#include "systems/mechanism/mechanism_motion.h"
#include "systems/mechanism/mechanism_state.h"

// Less than this resists a displacement that nothing holds [1/s2].
static const double NEUTRAL = 1e-4;
static const double STEP = 1e-7; // of differences [m, rad]
enum { MOST_TURNS = 200 };

// Unknowns: displacements in the sense of the speeds, but for those that drives set; then wheels.
typedef struct rest_problem {
    const base_system *base;
    const mechanism_base *own;
    const mechanism_system *mechanism;
    double t;
    int count, wheels_from;
    int unknown[MECHANISM_MOST_SPEEDS + 3 * LD_MAX_WHEELS];
    double dead; // [N] weight of tube and rocket
} rest_problem;

// ---- the equations

static void displace(const rest_problem *the, int i, double change, double *state)
{
    const base_dynamics *dynamics = the->base->kind->dynamics;
    if (i < the->wheels_from)
        mechanism_settle(the->mechanism, the->unknown[i], change, state);
    else
        dynamics->displace_slightly(the->base, the->unknown[i], change, state);
}

// Drives hold what they follow; actuators of struts push as their proportional part says.
static void set_holds(const rest_problem *the, double *state)
{
    const mechanism_system *mechanism = the->mechanism;
    base_frame tube;
    base_found found;
    for (int turn = 0; turn < 3; turn++) {
        bool moved = false;
        the->base->kind->find_frame(the->base, the->t, state, &tube, &found);
        for (int i = 0; i < mechanism->hold_count; i++) {
            const mechanism_hold *hold = &mechanism->hold[i];
            hinge_report report;
            mechanism_stand(mechanism, &found.mechanism);
            mechanism_watch(mechanism, i, &found.mechanism, &report);
            moved |= hold->strut < 0 && report.error != 0;
            if (hold->strut < 0)
                state[hold->q] += report.error;
            else
                state[mechanism->z_at + i] = hold->control->kp * report.error;
        }
        if (moved && mechanism_assemble(mechanism, &found.mechanism.carrier, state, NULL))
            return;
    }
}

// Accelerations of the unknowns.
static int accelerations(const rest_problem *the, double *state, double *a)
{
    base_frame tube;
    base_found found;
    base_output output;
    const base_dynamics *dynamics = the->base->kind->dynamics;
    set_holds(the, state);
    base_frame carrier = mechanism_base_carrier(the->base, the->t);
    mechanism_plant(the->mechanism, &carrier, state);
    the->base->kind->find_frame(the->base, the->t, state, &tube, &found);
    v3 down = m3_apply_transposed(tube.A, v3_make(0, -the->dead, 0));
    double half = 0.5 * the->own->model->tubes.length;
    base_load load = {
        .force = down, .moment = v3_cross(v3_make(half, 0, 0), down), .held = true, .linear = true};
    dynamics->rest_of(the->base, state, &load.rest);
    if (dynamics->evaluate(the->base, &found, &load, state, &output))
        return -1;
    for (int i = 0; i < the->count; i++)
        a[i] = output.rate[i < the->wheels_from
                               ? the->mechanism->q_count + the->mechanism->freedom[the->unknown[i]]
                               : dynamics->speed_of(the->base, the->unknown[i])];
    return 0;
}

static int jacobian(const rest_problem *the, const double *state, double *J)
{
    int n = the->count;
    double *plus = malloc(2 * (size_t)n * sizeof *plus), *minus = plus + n;
    double trial[BASE_MOST_STATES];
    size_t size = (size_t)the->base->state_count * sizeof *trial;
    int bad = !plus;
    for (int j = 0; j < n && !bad; j++) {
        memcpy(trial, state, size);
        displace(the, j, STEP, trial);
        bad = accelerations(the, trial, plus);
        memcpy(trial, state, size);
        displace(the, j, -STEP, trial);
        bad = bad || accelerations(the, trial, minus);
        for (int i = 0; i < n; i++)
            J[i + n * j] = (plus[i] - minus[i]) / (2 * STEP);
    }
    free(plus);
    return bad;
}

static double norm(int n, const double *x)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += x[i] * x[i];
    return sqrt(sum);
}

// ---- the way to the rest

// One step of a motion that loses its speed: (E/tau^2 - J) d = a, no longer than `most`.
static int step_of(const rest_problem *the, const double *J, double *work, double tau,
                   const double *a, double *d)
{
    const double most = 0.05; // [m, rad]
    int n = the->count;
    lapack_int pivot[MECHANISM_MOST_SPEEDS + 3 * LD_MAX_WHEELS];
    for (int i = 0; i < n * n; i++)
        work[i] = -J[i];
    for (int i = 0; i < n; i++) {
        work[i + n * i] += 1 / (tau * tau);
        d[i] = a[i];
    }
    if (LAPACKE_dgesv(LAPACK_COL_MAJOR, n, 1, work, n, pivot, d, n))
        return -1;
    double longest = 0;
    for (int i = 0; i < n; i++)
        longest = fmax(longest, fabs(d[i]));
    for (int i = 0; i < n && longest > most; i++)
        d[i] *= most / longest;
    return 0;
}

static void relax(const rest_problem *the, double *J, double *work, double *state)
{
    int n = the->count;
    double a[MECHANISM_MOST_SPEEDS + 3 * LD_MAX_WHEELS],
        d[MECHANISM_MOST_SPEEDS + 3 * LD_MAX_WHEELS];
    double accepted = 1e-7 * (1 + the->own->model->gravity), tau = 0.05;
    if (n == 0 || accelerations(the, state, a))
        return;
    double now = norm(n, a);
    for (int turn = 0; turn < MOST_TURNS && now > accepted; turn++) {
        if (jacobian(the, state, J) || step_of(the, J, work, tau, a, d))
            return;
        for (int i = 0; i < n; i++)
            displace(the, i, d[i], state);
        double next = accelerations(the, state, a) ? INFINITY : norm(n, a);
        if (!isfinite(next))
            return;
        tau *= fmin(4, fmax(0.4, now / next));
        now = next;
    }
}

// ---- what nothing holds

// Whether moving along `along` changes the accelerations by less than NEUTRAL.
static bool is_neutral(const rest_problem *the, const double *state, const double *along)
{
    const double far = 1e-3; // [m, rad]
    int n = the->count;
    double plus[MECHANISM_MOST_SPEEDS + 3 * LD_MAX_WHEELS],
        minus[MECHANISM_MOST_SPEEDS + 3 * LD_MAX_WHEELS];
    double trial[BASE_MOST_STATES];
    size_t size = (size_t)the->base->state_count * sizeof *trial;
    for (int side = 0; side < 2; side++) {
        memcpy(trial, state, size);
        for (int i = 0; i < n; i++)
            displace(the, i, side ? -far * along[i] : far * along[i], trial);
        if (accelerations(the, trial, side ? minus : plus))
            return false;
    }
    for (int i = 0; i < n; i++)
        plus[i] = (plus[i] - minus[i]) / (2 * far);
    return norm(n, plus) < NEUTRAL;
}

// Marks the unknown of the bodies, the first ones, that moves most along a direction that nothing
// holds, and takes its part out of the other directions.
static void hold_most(int n, int bodies, int directions, double *V, bool *held)
{
    for (int k = 0; k < directions; k++) {
        int best = 0, by = k;
        double most = -1;
        for (int l = k; l < directions; l++)
            for (int i = 0; i < bodies; i++)
                if (!held[i] && fabs(V[i + n * l]) > most) {
                    most = fabs(V[i + n * l]);
                    best = i;
                    by = l;
                }
        for (int i = 0; i < n; i++) {
            double swap = V[i + n * k];
            V[i + n * k] = V[i + n * by];
            V[i + n * by] = swap;
        }
        held[best] = true;
        for (int l = 0; l < directions; l++) {
            double share = V[best + n * l] / V[best + n * k];
            for (int i = 0; i < n && l != k; i++)
                V[i + n * l] -= share * V[i + n * k];
        }
    }
}

// J^T J, whose eigenvectors with the least eigenvalues move with the least resistance.
static void square_of(int n, const double *J, double *S)
{
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) {
            S[i + n * j] = 0;
            for (int k = 0; k < n; k++)
                S[i + n * j] += J[k + n * i] * J[k + n * j];
        }
}

static ld_status find_held(const rest_problem *the, const double *state, const double *J,
                           double *work, bool *held, ld_error *error)
{
    const double weak = 1e-8; // of the largest eigenvalue, a square
    int n = the->count, neutral = 0;
    size_t square = (size_t)(n * n);
    double *all = malloc((2 * square + (size_t)n) * sizeof *all);
    double *E = all, *V = all + square, *value = V + square;
    ld_status status = LD_OK;
    square_of(n, J, work);
    if (!all)
        status = ld_fail(error, LD_ERR_MEMORY, "no memory for the base's equilibrium");
    else if (symmetric_eigen(n, work, NULL, n, value, E))
        status = ld_fail(error, LD_ERR_NUMERIC, "the base's equilibrium cannot be judged");
    for (int k = 0; !status && k < n && value[k] < weak * value[n - 1]; k++) {
        memcpy(V + n * neutral, E + n * k, (size_t)n * sizeof *V);
        neutral += is_neutral(the, state, V + n * neutral);
    }
    if (!status)
        hold_most(n, the->wheels_from, neutral, V, held);
    free(all);
    return status;
}

// ---- what falls, what moved

// The unknown that accelerates most along directions that nothing holds.
static void find_falling(const rest_problem *the, double *state, const bool *held)
{
    mechanism_base *own = the->base->own;
    double a[MECHANISM_MOST_SPEEDS + 3 * LD_MAX_WHEELS];
    double least = 1e-3 * (1 + own->model->gravity);
    own->falling = -1;
    if (accelerations(the, state, a))
        return;
    for (int i = 0; i < the->wheels_from; i++)
        if (held[i] && fabs(a[i]) > least) {
            least = own->falls_with = fabs(a[i]);
            own->falling = the->mechanism->freedom[the->unknown[i]];
        }
}

static double turn_between(const double *a, const double *b)
{
    double cosine = fabs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]);
    return 2 * acos(fmin(cosine, 1));
}

// How far a joint of the tree stands from its start, over what is sag at most; how far it turned
// [rad] or slid [m].
static double measure_moved(const ld_joint *joint, const double *start, const double *q,
                            mechanism_moved *moved)
{
    const double most_turn = 0.2, most_slide = 0.5; // [rad], [m]
    int slides = joint->kind == LD_JOINT_PRISMATIC ? 1 : joint->kind == LD_JOINT_FREE ? 3 : 0;
    double slid = 0, turned = 0;
    for (int k = 0; k < slides; k++)
        slid = hypot(slid, q[k] - start[k]);
    if (joint->kind == LD_JOINT_REVOLUTE)
        turned = fabs(q[0] - start[0]);
    if (joint->kind == LD_JOINT_SPHERICAL || joint->kind == LD_JOINT_FREE)
        turned = turn_between(q + slides, start + slides);
    moved->turns = turned / most_turn > slid / most_slide;
    moved->by = moved->turns ? turned : slid;
    return moved->by / (moved->turns ? most_turn : most_slide);
}

// The joint of the tree that stands farthest from its start.
static void find_moved(const rest_problem *the, const double *start, const double *state)
{
    mechanism_base *own = the->base->own;
    const mechanism_system *mechanism = the->mechanism;
    double most = 1;
    own->moved.joint = NULL;
    for (int i = 0; i < mechanism->given->joint_count; i++) {
        int element = mechanism->joint_element[i];
        mechanism_moved moved = {.joint = &mechanism->given->joint[i]};
        if (element < 0)
            continue;
        int q = ld_mstmm_coordinate_offset(mechanism->chain, element);
        double far = measure_moved(moved.joint, start + q, state + q, &moved);
        if (far > most) {
            most = far;
            own->moved = moved;
        }
    }
}

// ---- all

// Place and heading of a body on wheels: nothing holds them.
static bool is_heading(const mechanism_system *mechanism, int i)
{
    int rolling = mechanism_rolling(mechanism), k = mechanism->freedom[i];
    return rolling >= 0 && (k == rolling || k == rolling + 2 || k == rolling + 4);
}

static bool is_driven(const mechanism_system *mechanism, int freedom)
{
    for (int i = 0; i < mechanism->hold_count; i++)
        if (mechanism->hold[i].strut < 0 && mechanism->hold[i].u == mechanism->freedom[freedom])
            return true;
    return false;
}

static void list_unknowns(rest_problem *the, const double *state)
{
    (void)state;
    for (int k = 0; k < the->mechanism->freedom_count; k++)
        if (!is_driven(the->mechanism, k) && !is_heading(the->mechanism, k))
            the->unknown[the->count++] = k;
    the->wheels_from = the->count;
    for (int k = 0; k < 3 * the->own->marching.wheel_count; k++)
        the->unknown[the->count++] =
            the->base->displacement_count - 3 * the->own->marching.wheel_count + k;
}

static double dead_weight(const ld_model *model)
{
    double mass = model->tubes.tail.mass + model->rocket.full.mass;
    for (int k = 0; k < model->tubes.section_count; k++) {
        const ld_section *section = &model->tubes.section[k];
        double end = k + 1 < model->tubes.section_count ? section[1].from : model->tubes.length;
        mass += section->mass_per_length * (end - section->from);
    }
    for (int k = 0; k < model->tubes.point_mass_count; k++)
        mass += model->tubes.point_mass[k].mass;
    return model->gravity * mass;
}

ld_status multibody_rest_find(base_system *base, ld_error *error)
{
    mechanism_base *own = base->own;
    rest_problem the = {.base = base,
                        .own = own,
                        .mechanism = &own->of_tube[0],
                        .t = -own->model->run.lead_in,
                        .dead = dead_weight(own->model)};
    list_unknowns(&the, own->rest);
    size_t square = (size_t)(the.count * the.count) + 1;
    double *J = malloc(2 * square * sizeof *J);
    if (!J)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the base's rest");
    bool held[MECHANISM_MOST_SPEEDS + 3 * LD_MAX_WHEELS] = {0};
    double start[BASE_MOST_STATES];
    ld_status status = LD_OK;
    memcpy(start, own->rest, (size_t)base->state_count * sizeof *start);
    relax(&the, J, J + square, own->rest);
    find_moved(&the, start, own->rest);
    if (the.count && !jacobian(&the, own->rest, J))
        status = find_held(&the, own->rest, J, J + square, held, error);
    find_falling(&the, own->rest, held);
    free(J);
    own->freedom_count = 0;
    for (int i = 0; i < the.wheels_from; i++)
        if (!held[i])
            own->freedom[own->freedom_count++] = the.unknown[i];
    for (int k = 0; k < the.mechanism->freedom_count; k++)
        if (is_driven(the.mechanism, k))
            own->freedom[own->freedom_count++] = k;
    return status;
}
