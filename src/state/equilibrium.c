// The start of a launch: undeformed, or in static equilibrium found by Newton's method.
#include "state/equilibrium.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "math/functions.h"
#include "math/matrices/lapack.h"
#include "math/vectors/rotation_vector.h"
#include "model/blocks/firing.h"
#include "model/parts.h"
#include "state/carried.h"
#include "state/evaluation.h"
#include "state/exit_figures.h"
#include "state/launch_state.h"
#include "systems/bases/mechanism_base.h"
#include "systems/launching/launching_kinematics.h"

enum { MAX_FREEDOMS = 12 + LD_MAX_MODAL + BASE_MOST_FREEDOMS };

// Of the rocket on its way: y_S, z_S, psi, theta, and gamma on surfaces where no lock holds it.
static int rocket_freedoms(const launch_state *self)
{
    const launching_system *launching = &self->launcher.launching;
    bool held = self->rocket->lock.present && launching->lock.holds_roll;
    return launching->surfaces.count && !held ? 5 : 4;
}

// Unknowns of the launching subsystem: R's position and attitude (6), q, then those of the rocket,
// and s where the breech carries it.
static int launching_freedoms(const launch_state *self)
{
    return 6 + self->launcher.launching.layout.nq + rocket_freedoms(self) + self->on_breech;
}

int simulation_freedoms(const launch_state *self)
{
    return launching_freedoms(self) + self->launcher.base.freedom_count;
}

void simulation_displace(const launch_state *self, int freedom, double change, double *y)
{
    const launching_layout *at = &self->launcher.launching.layout;
    if (freedom < 3) {
        y[at->r + freedom] += change;
    } else if (freedom < 6) {
        double axis[3] = {0};
        axis[freedom - 3] = sin(0.5 * change);
        quat turn = {cos(0.5 * change), axis[0], axis[1], axis[2]};
        quat q = q_multiply(q_from(y + at->quaternion), turn);
        memcpy(y + at->quaternion, &q, sizeof q);
    } else if (freedom < 6 + at->nq) {
        y[at->q + freedom - 6] += change;
    } else if (freedom < 6 + at->nq + rocket_freedoms(self)) {
        y[at->x + X_Y + freedom - 6 - at->nq] += change;
    } else if (freedom < launching_freedoms(self)) {
        y[at->x + X_S] += change;
    } else {
        const base_system *base = &self->launcher.base;
        base->kind->dynamics->displace(base, freedom - launching_freedoms(self), change,
                                       y + self->launcher.base_at);
    }
}

// Gives tube and rocket the motion of a body that rides on the base as it moves.
static void ride_on_base(const launch_state *self, double t, double *y)
{
    const launcher_system *launcher = &self->launcher;
    const launching_layout *at = &launcher->launching.layout;
    launcher_input input;
    launching_output unused;
    launching_pose pose;
    simulation_input(self, t, y, &input);
    const base_frame *base = &input.launching.base;
    m3 A = q_matrix(q_from(y + at->quaternion));
    v3 r = v3_sub(v3_from(y + at->r), base->r);
    v3 w = m3_apply_transposed(A, base->w);
    v3 v = m3_apply_transposed(A, v3_add(base->v, v3_cross(base->w, r)));
    launching_rocket_pose(&launcher->launching, y, &pose, &unused);
    v3_store(y + at->v, v);
    v3_store(y + at->w, w);
    v3_store(y + at->V, v3_add(v, v3_cross(w, pose.p1)));
    v3_store(y + at->V + 3, w);
}

void simulation_move_with_base(const launch_state *self, double t, double *y)
{
    const base_system *base = &self->launcher.base;
    if (base->kind->dynamics)
        base->kind->dynamics->set_start_velocity(base, y + self->launcher.base_at);
    ride_on_base(self, t, y);
}

// Step of Newton's differences.
static const double DIFFERENCE = 1e-8;
// The phase in which equilibria are found.
static launching_phase resting_phase(const launch_state *self)
{
    launching_phase phase = simulation_start_phase(self);
    phase.frictionless = true;
    phase.restoring = RESTORING;
    return phase;
}

// O1, the rocket's axes and its section's, in I.
typedef struct rocket_place {
    v3 r;
    m3 A_IB, A_IS;
} rocket_place;

// What Newton's method solves: the unknowns from `first` on. With `dead` the tube and its rocket
// are a dead load on the base.
typedef struct problem {
    const launch_state *self;
    double t;
    const launching_phase *phase;
    int first, count;
    bool dead;
    double spring;              // [1/s2] holds the rocket's freedoms
    const rocket_place *place;  // to where it is in space, or, NULL,
    double rest[SHOE_FREEDOMS]; // where it is in the guide
    bool less_carried;          // less what surfaces carry, else all
    carried_directions carried; // what they do
    double accepted;            // [m/s2] residual of a state at rest
    double h;                   // [m, rad, ...] step of the differences
    double *jacobian;           // [count + 1][count + 1] of Newton's method, factored, and its
    lapack_int *pivot;          // row exchanges
    const base_frame *going;    // the base as it moves where it is not held still: through the air
} problem;

// Wrench on the platform of tube, tail and rocket as rigid bodies at rest, about T's origin, in T.
static void dead_load(const problem *the, const launcher_input *input, launching_output *out)
{
    const launch_state *self = the->self;
    const launching_system *launching = &self->launcher.launching;
    const rocket_mass *rocket = &self->motor->full;
    v3 down = m3_apply_transposed(input->launching.base.A, v3_make(0, -launching->tube.gravity, 0));
    v3 centre = v3_add(v3_make(self->rocket->start_at, 0, 0), rocket->c);
    v3 moment = v3_add(v3_make(launching->tube.Sx, 0, 0), v3_scale(rocket->m, centre));
    out->base_force = v3_scale(launching->tube.m + rocket->m, down);
    out->base_moment = v3_cross(moment, down);
}

static rocket_place place_at(const launch_state *self, const double *y, const launching_pose *pose)
{
    const launching_layout *at = &self->launcher.launching.layout;
    m3 A = q_matrix(q_from(y + at->quaternion));
    return (rocket_place){.r = v3_add(v3_from(y + at->r), m3_apply(A, pose->p1)),
                          .A_IB = m3_mul(A, pose->A_RB),
                          .A_IS = m3_mul(A, pose->A_RS)};
}

static launching_pose pose_of(const launch_state *self, const double *y)
{
    launching_pose pose;
    launching_output unused;
    launching_rocket_pose(&self->launcher.launching, y, &pose, &unused);
    return pose;
}

// How far the rocket stands from a place in space, in the axes of its section.
static void off_in_space(const rocket_place *now, const rocket_place *place,
                         double off[SHOE_FREEDOMS])
{
    v3 move = m3_apply_transposed(now->A_IS, v3_sub(now->r, place->r));
    v3 turn = rv_log(m3_mul(now->A_IB, m3_transpose(place->A_IB)));
    turn = m3_apply_transposed(now->A_IS, turn);
    off[0] = move.y;
    off[1] = move.z;
    off[2] = turn.z;
    off[3] = turn.y;
    off[4] = turn.x;
}

// How far the rocket, in that pose, stands from where the spring holds it, less what surfaces
// carry.
static void off_its_place(const problem *the, const double *y, const launching_pose *pose,
                          double off[SHOE_FREEDOMS])
{
    if (the->place) {
        rocket_place now = place_at(the->self, y, pose);
        off_in_space(&now, the->place, off);
        return;
    }
    const double *x = y + the->self->launcher.launching.layout.x + X_Y;
    for (int i = 0; i < SHOE_FREEDOMS; i++)
        off[i] = x[i] - the->rest[i];
    if (the->less_carried)
        carried_remove(&the->carried, off);
}

// Accelerations of tube and rocket that the lock and the slot leave free.
static void launching_residual(const problem *the, const double *y, const launching_output *given,
                               double *r)
{
    const launch_state *self = the->self;
    launching_pose pose;
    launching_output out = *given;
    int nq = self->launcher.launching.layout.nq;
    launching_rocket_pose(&self->launcher.launching, y, &pose, &out);
    v3_store(r, out.a);
    v3_store(r + 3, out.w_dot);
    memcpy(r + 6, out.q_ddot, (size_t)nq * sizeof(double));
    v3 a = m3_apply_transposed(pose.A_RS, out.a_O1);
    v3 alpha = m3_apply_transposed(pose.A_RS, out.alpha_B);
    double *rocket = r + 6 + nq;
    rocket[0] = a.y;
    rocket[1] = a.z;
    rocket[2] = alpha.z;
    rocket[3] = alpha.y;
    int count = rocket_freedoms(self);
    if (count > 4)
        rocket[4] = alpha.x;
    double off[SHOE_FREEDOMS];
    off_its_place(the, y, &pose, off);
    for (int i = 0; i < count; i++)
        rocket[i] -= the->spring * off[i];
    if (self->on_breech)
        rocket[count] = a.x;
}

// What acts in a state at rest: a base in its pose that does not move, no drive; the air goes past
// as it does where the base moves.
static void at_rest(const problem *the, const double *y, launcher_input *input)
{
    base_frame *base = &input->launching.base;
    const launch_state *self = the->self;
    simulation_input(self, the->t, y, input);
    base->v = base->w = base->a = base->alpha = v3_zero();
    input->launching.thrust = 0;
    input->launching.across = (motor_across){0};
    input->launching.pressure_piece = 0;
    input->formulation = LD_FORMULATION_REDUCED;
    if (!self->air || !the->going)
        return;
    input->launching.about.going = the->going;
    v3 center = launching_rocket_point(&self->launcher.launching, y, input->launching.mass.c);
    v3 v = v3_cross(the->going->w, v3_sub(center, the->going->r));
    input->launching.air.v = v3_sub(input->launching.air.v, v3_add(the->going->v, v));
}

// The base as it moves with the speeds of y.
static base_frame going_of(const launch_state *self, double t, const double *y)
{
    launcher_input input;
    launcher_place(&self->launcher, t, y, &input);
    return input.launching.base;
}

// The base as it moves where the run begins, in the pose of y.
static base_frame setting_off(const launch_state *self, double t, const double *y)
{
    const base_system *base = &self->launcher.base;
    double moving[LD_MAX_STATES];
    memcpy(moving, y, (size_t)self->launcher.state_count * sizeof *y);
    if (base->kind->dynamics)
        base->kind->dynamics->set_start_velocity(base, moving + self->launcher.base_at);
    return going_of(self, t, moving);
}

// What must vanish in equilibrium.
static int residual(const problem *the, const double *y, double *r)
{
    const launch_state *self = the->self;
    const launcher_system *launcher = &self->launcher;
    launcher_input input;
    launcher_output out;
    double all[MAX_FREEDOMS];
    at_rest(the, y, &input);
    input.held = true;
    const base_system *base = &launcher->base;
    if (base->kind->dynamics)
        base->kind->dynamics->rest_of(base, y + launcher->base_at, &input.rest);
    if (the->dead) {
        dead_load(the, &input, &out.launching);
        input.launching.station = NULL;
        if (launcher_evaluate_base(launcher, &input, the->phase, y, &out))
            return -1;
    } else {
        if (launcher_evaluate(launcher, &input, the->phase, y, &out))
            return -1;
        launching_residual(the, y, &out.launching, all);
    }
    if (base->kind->dynamics)
        base->kind->dynamics->residual(base, &out.base, all + launching_freedoms(self));
    memcpy(r, all + the->first, (size_t)the->count * sizeof *r);
    return 0;
}

static double norm(int n, const double *r)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += r[i] * r[i];
    return sqrt(sum);
}

// The Jacobian at y by central differences, factored.
static int find_jacobian(const problem *the, const double *y)
{
    int n = the->count;
    double h = the->h;
    double *J = the->jacobian, plus[MAX_FREEDOMS], minus[MAX_FREEDOMS];
    double trial[LD_MAX_STATES];
    size_t size = (size_t)the->self->launcher.state_count * sizeof(double);
    for (int j = 0; j < n; j++) {
        memcpy(trial, y, size);
        simulation_displace(the->self, the->first + j, h, trial);
        int bad = residual(the, trial, plus);
        memcpy(trial, y, size);
        simulation_displace(the->self, the->first + j, -h, trial);
        if (bad || residual(the, trial, minus))
            return -1;
        for (int i = 0; i < n; i++)
            J[i + n * j] = (plus[i] - minus[i]) / (2 * h);
    }
    return LAPACKE_dgetrf(LAPACK_COL_MAJOR, n, n, J, n, the->pivot);
}

// y := y - share J^-1 r
static void take_step(const problem *the, const double *r, double share, double *y)
{
    int n = the->count;
    double step[MAX_FREEDOMS];
    for (int j = 0; j < n; j++)
        step[j] = -r[j];
    LAPACKE_dgetrs(LAPACK_COL_MAJOR, 'N', n, 1, the->jacobian, n, the->pivot, step, n);
    for (int j = 0; j < n; j++)
        simulation_displace(the->self, the->first + j, share * step[j], y);
}

// Room for the Jacobian of a problem, to be freed: too large for a stack. It may get a freedom
// more.
static ld_status make_room(problem *the, ld_error *error)
{
    size_t most = (size_t)the->count + 1;
    the->jacobian = malloc(most * (most * sizeof *the->jacobian + sizeof *the->pivot));
    if (!the->jacobian)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the equilibrium");
    the->pivot = (lapack_int *)(the->jacobian + most * most);
    return LD_OK;
}

// A step that makes the residual so much smaller shows that its Jacobian serves for the next one.
static const double SERVES = 0.01;

// A state on the way of Newton's method, what is left there, and its norm.
typedef struct waypoint {
    double y[LD_MAX_STATES], r[MAX_FREEDOMS], size;
} waypoint;

static bool reach(const problem *the, waypoint *at)
{
    if (residual(the, at->y, at->r))
        return false;
    at->size = norm(the->count, at->r);
    return true;
}

// The first of the halved steps that makes the residual smaller; false: there is none.
static bool step_down(const problem *the, const waypoint *from, waypoint *to)
{
    double share = 1;
    for (int halving = 0; halving < 25; halving++, share *= 0.5) {
        memcpy(to->y, from->y, (size_t)the->self->launcher.state_count * sizeof(double));
        take_step(the, from->r, share, to->y);
        if (reach(the, to) && to->size < from->size)
            return true;
    }
    return false;
}

// Newton with halved steps from the guess in y. Ends where no step makes the residual smaller.
static double newton(const problem *the, double *y)
{
    size_t size = (size_t)the->self->launcher.state_count * sizeof(double);
    waypoint at, next;
    bool rounding = false;
    memcpy(at.y, y, size);
    if (!reach(the, &at))
        return INFINITY;
    for (int iteration = 0; iteration < 60 && !rounding; iteration++) {
        if (find_jacobian(the, at.y) || !step_down(the, &at, &next))
            break;
        rounding = at.size < 1e-6 && next.size > 0.1 * at.size;
        at = next;
    }
    memcpy(y, at.y, size);
    return at.size;
}

// Whether the rocket stands so far [m, rad] from its place in the guide.
static bool is_beyond(const problem *the, const double *y, double widest);

enum { CIRCLE = 4 }; // residuals ago

// Whether Newton's method has come back to a residual; remembers that of now.
static bool goes_round(int iteration, double now, double before[CIRCLE])
{
    bool circles = false;
    for (int i = 0; i < CIRCLE; i++)
        circles |= fabs(now - before[i]) < 1e-9 * now;
    before[iteration % CIRCLE] = now;
    return circles;
}

// Newton's method with whole steps: where surfaces are touched and released of it finds which of
// them carry, as halved steps, which stop at the kinks, do not. A Jacobian is kept while it serves.
// Ends, too, where steps go off or in a circle. Leaves the best state in y. `gone`: they went off.
static double newton_whole(const problem *the, double *y, bool *gone)
{
    const double far = 10; // [m, rad]
    size_t size = (size_t)the->self->launcher.state_count * sizeof(double);
    double best = INFINITY, former[CIRCLE] = {0};
    bool kept = false;
    waypoint at, before;
    *gone = false;
    memcpy(at.y, y, size);
    before.size = INFINITY;
    for (int iteration = 0; iteration < 30 && reach(the, &at); iteration++) {
        bool rounding = at.size > 0.1 * best && best < 1e-6;
        bool serves = iteration > 0 && at.size < SERVES * before.size;
        bool circles = goes_round(iteration, at.size, former);
        if (at.size < best) {
            best = at.size;
            memcpy(y, at.y, size);
        }
        if (rounding || circles)
            break;
        if (kept && !serves)
            at = before;
        else
            *gone = is_beyond(the, at.y, far);
        kept = serves;
        if (*gone || (!kept && find_jacobian(the, at.y)))
            break;
        before = at;
        take_step(the, at.r, 1, at.y);
    }
    return best;
}

// How deep a contact is pressed in by `load` [N].
static double depth_under(const ld_contact *contact, double load)
{
    double d_0 = contact->reference_penetration;
    return d_0 * pow(load / (contact->stiffness * d_0), 1 / contact->exponent);
}

// How far adaptor i moves from the axis under `load` [N], positive along it, pressed in by `extra`.
static double offset_under(const ld_rocket *rocket, int i, double load, double extra)
{
    const ld_contact *contact = &rocket->contact;
    if (contact_has(contact->law, LD_CONTACT_HELD))
        return 0;
    if (contact_has(contact->law, LD_CONTACT_TWO_SIDED))
        return load / contact->stiffness;
    return copysign(rocket->adaptor[i].clearance + depth_under(contact, fabs(load)) + extra, load);
}

// Guess: adaptors i and j carry the rocket, each on the side that its share of the weight presses
// it to (one of them on the upper side where the mass centre is not between them).
static void guess_contacts(const launch_state *self, int i, int j, v3 pull, double extra, double *y)
{
    const ld_rocket *rocket = self->rocket;
    double *x = y + self->launcher.launching.layout.x;
    double lean = hypot(pull.y, pull.z), weight = self->motor->full.m * lean;
    double from = rocket->adaptor[i].at, span = rocket->adaptor[j].at - from;
    double share = (self->motor->full.c.x - from) / span;
    double e_i = offset_under(rocket, i, (1 - share) * weight, extra);
    double e_j = offset_under(rocket, j, share * weight, extra);
    double slope = (e_j - e_i) / span;
    double e_0 = e_i - slope * from;
    x[X_Y] = e_0 * pull.y / lean;
    x[X_Z] = e_0 * pull.z / lean;
    x[X_PSI] = slope * pull.y / lean;
    x[X_THETA] = -slope * pull.z / lean;
}

static void report_wheels(const launcher_system *launcher, const marching_output *marching,
                          ld_equilibrium_summary *summary)
{
    summary->wheel_count = model_base(launcher->base.model)->vehicle.wheel_count;
    for (int j = 0; j < summary->wheel_count; j++) {
        const wheel_report *wheel = &marching->wheel[j];
        summary->wheel[j].tyre_force = wheel->normal;
        summary->wheel[j].tyre_deflection = wheel->deflection;
        v3_store(summary->wheel[j].suspension, wheel->travel);
    }
}

// Of a base that is a vehicle.
static void report_vehicle(const launcher_system *launcher, const launcher_output *out,
                           const double *y, ld_equilibrium_summary *summary)
{
    if (!base_is_vehicle(&launcher->base))
        return;
    const mechanism_system *vehicle = mechanism_of(&launcher->base);
    const double *base = y + launcher->base_at;
    m3 A = q_matrix(q_from(base + VEHICLE_QUATERNION));
    report_wheels(launcher, &out->base.report.marching, summary);
    summary->chassis.y = base[VEHICLE_R + 1];
    summary->chassis.pitch = asin(A.a[1][0]);
    summary->chassis.roll = atan2(-A.a[1][2], A.a[1][1]);
    for (int i = 0; i < vehicle->hold_count; i++) {
        summary->hinge[i].angle = base[vehicle->hold[i].q];
        summary->hinge[i].torque = base[vehicle->z_at + i];
    }
}

// Of a base of kind multibody.
static void report_multibody(const launcher_system *launcher, const launcher_input *input,
                             const launcher_output *out, const double *y,
                             ld_equilibrium_summary *summary)
{
    base_instant instant;
    const multibody_instant *now = &instant.multibody;
    const ld_mechanism *given = &model_base(launcher->base.model)->mechanism;
    if (!model_has_multibody(launcher->base.model))
        return;
    base_find(&launcher->base, &input->found, &out->base, y + launcher->base_at, &instant);
    report_wheels(launcher, &now->rolling.marching, summary);
    for (int i = 0; i < given->drive_count; i++) {
        summary->drive[i].measured = now->drive[i].measured;
        summary->drive[i].torque = now->drive[i].torque;
    }
    for (int i = 0; i < given->strut_count; i++)
        summary->strut_force[i] = now->strut[i].spring.force + now->strut[i].push;
    for (int i = 0; i < given->foot_count; i++)
        summary->foot_force[i] = now->foot[i].normal;
}

static void report(const problem *the, const double *y, ld_equilibrium_summary *summary)
{
    const launch_state *self = the->self;
    launcher_input input;
    launcher_output out;
    double r[MAX_FREEDOMS];
    at_rest(the, y, &input);
    launcher_evaluate(&self->launcher, &input, the->phase, y, &out);
    tip_state tip = tip_state_of(self, &input.launching.base, y);
    *summary = (ld_equilibrium_summary){.lock_force = out.launching.lock_force,
                                        .breech_force = out.launching.breech_force,
                                        .slot_force = out.launching.N,
                                        .tip_sag = {tip.offset.y, tip.offset.z}};
    for (int i = 0; i < self->launcher.launching.adaptors.count; i++)
        summary->contact_force[i] = the->phase->passed[i] ? 0 : out.launching.adaptor[i].normal;
    residual(the, y, r);
    for (int i = 0; i < the->count; i++)
        summary->residual = fmax(summary->residual, fabs(r[i]));
    report_vehicle(&self->launcher, &out, y, summary);
    report_multibody(&self->launcher, &input, &out, y, summary);
}

// Gravity [m/s2] in the axes of the undeformed tube on the base as it stands in y.
static v3 pull_at(const launch_state *self, double t, const double *y)
{
    launcher_input input;
    simulation_input(self, t, y, &input);
    return m3_apply_transposed(input.launching.base.A, v3_make(0, -model_gravity(self->model), 0));
}

static bool is_upright(const problem *the, const double *start)
{
    v3 pull = pull_at(the->self, the->t, start);
    return hypot(pull.y, pull.z) < 1e-2 * fabs(pull.x);
}

// Tube and rocket straight on the base as it stands in `start`.
static void guess_straight(const problem *the, const double *start, double *y)
{
    launcher_input input;
    simulation_input(the->self, the->t, start, &input);
    memcpy(y, start, (size_t)the->self->launcher.state_count * sizeof(double));
    simulation_straight(the->self, &input.launching.base, y);
}

// Newton's method from the guess in y; the tube alone before its base: it has the kinks.
static double solve_newton(const problem *the, double *y)
{
    problem tube = *the;
    tube.count = launching_freedoms(the->self);
    double reached = newton(&tube, y);
    return tube.count < the->count ? newton(the, y) : reached;
}

// Newton's method from one pair of carrying adaptors after the other, the outermost first, until
// one succeeds. `start` has the base in its place. Returns the smallest residual; its state is in
// y.
static double try_pairs(const problem *the, const double *start, double extra, double *y)
{
    const launch_state *self = the->self;
    double best = INFINITY, trial[LD_MAX_STATES];
    v3 pull = pull_at(self, the->t, start);
    size_t size = (size_t)self->launcher.state_count * sizeof(double);
    for (int j = self->launcher.launching.adaptors.count - 1; j > 0; j--)
        for (int i = 0; i < j; i++) {
            if (the->phase->passed[i] || the->phase->passed[j])
                continue;
            guess_straight(the, start, trial);
            if (hypot(pull.y, pull.z) > 0)
                guess_contacts(self, i, j, pull, extra, trial);
            double reached = solve_newton(the, trial);
            if (reached < best) {
                best = reached;
                memcpy(y, trial, size);
            }
            if (best <= the->accepted)
                return best;
        }
    return best;
}

// The largest acceleration that the spring must hold, and along or about what.
static double held_by_spring(const problem *the, const double *y, int *worst)
{
    double off[SHOE_FREEDOMS];
    launching_pose pose = pose_of(the->self, y);
    off_its_place(the, y, &pose, off);
    *worst = 0;
    for (int i = 1; i < rocket_freedoms(the->self); i++)
        if (fabs(off[i]) > fabs(off[*worst]))
            *worst = i;
    return the->spring * fabs(off[*worst]);
}

// Whether Newton's method has found in y a state that the spring need not hold.
static bool is_at_rest(const problem *the, const double *y, double reached)
{
    int unused;
    return reached <= the->accepted && held_by_spring(the, y, &unused) <= the->accepted;
}

// What nothing carries, as in an upright tube, stays on the axis: a spring, which must find nothing
// to pull, makes Newton's method regular. The rocket is pressed into the breech by `depth`.
static double try_centred(const problem *the, const double *start, double depth, double *y)
{
    int unused;
    problem held = *the;
    held.spring = 1e6;
    guess_straight(the, start, y);
    y[the->self->launcher.launching.layout.x + X_S] -= depth;
    double reached = solve_newton(&held, y), holds = held_by_spring(&held, y, &unused);
    return holds < 1e-9 * model_gravity(the->self->model) ? reached : INFINITY;
}

// One adaptor in the plane across the tube: its load, and where that presses it.
typedef struct lateral {
    double y, z;
} lateral;

static lateral pressed_to(const ld_rocket *rocket, int i, lateral load)
{
    double size = hypot(load.y, load.z);
    double offset = size > 0 ? offset_under(rocket, i, size, 0) / size : 0;
    return (lateral){offset * load.y, offset * load.z};
}

// Guess: adaptors i and j carry the rocket, which leans, so that its weight along the tube loads
// them too, and more the more it leans; or it hangs from O1 and i alone is touched (j = i).
static void guess_leaning(const launch_state *self, int i, int j, v3 pull, double *y)
{
    const ld_rocket *rocket = self->rocket;
    v3 c = self->motor->full.c;
    double *x = y + self->launcher.launching.layout.x, m = self->motor->full.m;
    double from = rocket->adaptor[i].at, span = rocket->adaptor[j].at - from, arm = c.x - from;
    lateral slope = {(pull.y * arm / pull.x - c.y) / c.x, (pull.z * arm / pull.x - c.z) / c.x};
    lateral at_i = pressed_to(rocket, i, (lateral){m * pull.y, m * pull.z});
    for (int k = 0; k < 20 && i < j; k++) {
        // moments about adaptor i; the axial forces act at O1 and at the mass centre
        if (k == 0)
            slope = (lateral){0};
        double off_y = c.y + slope.y * c.x, off_z = c.z + slope.z * c.x;
        lateral load_j = {m * (pull.y * arm - pull.x * off_y) / span,
                          m * (pull.z * arm - pull.x * off_z) / span};
        at_i = pressed_to(rocket, i, (lateral){m * pull.y - load_j.y, m * pull.z - load_j.z});
        lateral at_j = pressed_to(rocket, j, load_j);
        slope = (lateral){(at_j.y - at_i.y) / span, (at_j.z - at_i.z) / span};
    }
    x[X_Y] = at_i.y - slope.y * from;
    x[X_Z] = at_i.z - slope.z * from;
    x[X_PSI] = slope.y;
    x[X_THETA] = -slope.z;
}

// `best`: what the state in y has reached.
static double try_leaning(const problem *the, const double *start, double best, double *y)
{
    double trial[LD_MAX_STATES];
    const launcher_system *launcher = &the->self->launcher;
    v3 pull = pull_at(the->self, the->t, start);
    for (int j = launcher->launching.adaptors.count - 1; j >= 0; j--)
        for (int i = 0; i < j + (pull.x > 0) && best > the->accepted; i++) {
            if (the->phase->passed[i] || the->phase->passed[j])
                continue;
            guess_straight(the, start, trial);
            guess_leaning(the->self, i, j, pull, trial);
            double reached = solve_newton(the, trial);
            if (reached < best) {
                best = reached;
                memcpy(y, trial, (size_t)launcher->state_count * sizeof(double));
            }
        }
    return best;
}

// The rocket upright: on the axis where nothing pulls it off, else leaning.
static double try_upright(const problem *the, const double *start, double *y)
{
    double best = try_centred(the, start, 0, y);
    if (best <= the->accepted)
        return best;
    // what carries little is pressed in by little
    problem fine = *the;
    fine.accepted = 1e-3 * the->accepted;
    for (fine.h = 1e-9; fine.h > 1e-13 && best > fine.accepted; fine.h *= 0.1)
        best = try_leaning(&fine, start, best, y);
    return best;
}

// Which directions the surfaces carry in y.
static void find_carried(problem *the, const double *y)
{
    const launch_state *self = the->self;
    launcher_input input;
    launcher_output out;
    simulation_input(self, the->t, y, &input);
    launcher_evaluate(&self->launcher, &input, the->phase, y, &out);
    carried_find(&self->launcher.launching, the->phase, &out.launching, rocket_freedoms(self) > 4,
                 &the->carried);
}

// newton_whole() from the guess in `from`, with finer and finer differences: a surface that carries
// little is pressed in by little. From far away they bring nothing back.
static double newton_fine(problem *the, const double *from, double *y)
{
    double reached = INFINITY;
    bool gone = false;
    for (the->h = DIFFERENCE; the->h > 1e-12 && !(reached <= the->accepted) && !gone;
         the->h *= 0.1) {
        memcpy(y, from, (size_t)the->self->launcher.state_count * sizeof(double));
        reached = newton_whole(the, y, &gone);
    }
    return reached;
}

// Twice the kinetic energy that two small displacements have in common, taken as rates: gravity
// takes a rocket that is released where this is positive of its way and what pulls it.
static double in_common(const rocket_mass *rocket, const double a[SHOE_FREEDOMS],
                        const double b[SHOE_FREEDOMS])
{
    v3 turn_a = v3_make(a[4], a[3], a[2]), turn_b = v3_make(b[4], b[3], b[2]);
    v3 move_a = v3_add(v3_make(0, a[0], a[1]), v3_cross(turn_a, rocket->c));
    v3 move_b = v3_add(v3_make(0, b[0], b[1]), v3_cross(turn_b, rocket->c));
    return rocket->m * v3_dot(move_a, move_b) + v3_dot(turn_a, m3_apply(rocket->J, turn_b));
}

// Whether a rocket on surfaces stands so far from its centred place that they do not hold it. Round
// ones do not feel its roll.
static bool is_beyond(const problem *the, const double *y, double widest)
{
    int count = the->self->launcher.launching.surfaces.flat ? SHOE_FREEDOMS : SHOE_FREEDOMS - 1;
    double off[SHOE_FREEDOMS];
    problem centred = *the;
    launching_pose pose = pose_of(the->self, y);
    centred.place = NULL;
    off_its_place(&centred, y, &pose, off);
    for (int i = 0; i < count; i++)
        if (fabs(off[i]) > widest)
            return true;
    return false;
}

static bool is_away(const problem *the, const double *y)
{
    return is_beyond(the, y, 0.5);
}

// Whether the rocket has gone further than a small way, or once round.
static bool is_far(const launch_state *self, const double *from, const double *to)
{
    const double longest = 0.05; // [m, rad]
    int x = self->launcher.launching.layout.x + X_Y;
    for (int i = 0; i < SHOE_FREEDOMS; i++)
        if (fabs(to[x + i] - from[x + i]) > longest)
            return true;
    return false;
}

// Lets a rocket on surfaces go from y to where gravity takes it, in small ways: a spring holds it
// to where it is, then to where that took it, softer each time. Back over a top leads no way that
// gravity takes: the spring was too soft, as where Newton's method finds none. Ends where the
// spring has nothing to hold, or away from the guide. Returns the residual.
static double release_and_settle(const problem *the, double *y)
{
    const double softest = 1e-3, hardest = 1e9;
    const rocket_mass *rocket = &the->self->motor->full;
    double trial[LD_MAX_STATES], off[SHOE_FREEDOMS], before[SHOE_FREEDOMS] = {0};
    double best = INFINITY, ease = 0.1;
    int unused;
    // between round surfaces it may turn half round
    int most = the->self->launcher.launching.surfaces.flat ? 500 : 1000;
    problem held = *the;
    held.spring = 1e7;
    for (int step = 0; step < most && held.spring < hardest; step++) {
        launching_pose pose = pose_of(the->self, y);
        rocket_place place = place_at(the->self, y, &pose);
        held.place = &place;
        double reached = newton_fine(&held, y, trial);
        pose = pose_of(the->self, trial);
        off_its_place(&held, trial, &pose, off);
        if (reached > the->accepted || is_far(the->self, y, trial) ||
            in_common(rocket, off, before) < 0) {
            best = fmin(best, reached);
            held.spring /= ease * ease;
            ease = sqrt(ease);
            continue;
        }
        memcpy(y, trial, sizeof trial);
        memcpy(before, off, sizeof off);
        if (held_by_spring(&held, y, &unused) <= 0.1 * the->accepted || is_away(the, y))
            return reached;
        held.spring = fmax(softest, ease * held.spring);
        ease = fmax(0.1, ease * ease);
    }
    return best;
}

// Equilibrium of a rocket on surfaces, pressed into the breech by `depth`: upright in its centred
// place, where nothing pulls it off that, or from there, or from beside it by `nudge` [m, rad], to
// where gravity and the air take it. What the surfaces that it touches do not carry is centred if
// it also rests there, else it stays where it came to.
static double find_beside(problem *the, const double *start, double depth, const double *nudge,
                          double *y)
{
    const launch_state *self = the->self;
    double found[LD_MAX_STATES];
    the->rest[0] = self->launcher.launching.surfaces.line_y;
    the->rest[1] = self->launcher.launching.surfaces.line_z;
    the->carried = (carried_directions){.scale = {1, 1, 1, 1, 1}};
    the->less_carried = false;
    the->spring = 0;
    the->h = DIFFERENCE;
    if (!nudge && is_upright(the, start)) {
        double centred = try_centred(the, start, depth, y);
        if (centred <= the->accepted)
            return centred;
    }
    problem tube = *the;
    tube.count = launching_freedoms(self);
    guess_straight(the, start, found);
    found[self->launcher.launching.layout.x + X_S] -= depth;
    for (int i = 0; i < SHOE_FREEDOMS && nudge; i++)
        found[self->launcher.launching.layout.x + X_Y + i] += nudge[i];
    double reached = release_and_settle(&tube, found);
    if (the->count > tube.count && reached <= the->accepted)
        reached = release_and_settle(the, found);
    memcpy(y, found, sizeof found);
    the->less_carried = true;
    the->spring = 1e4;
    if (!(reached <= the->accepted) || is_away(the, y))
        return reached;
    find_carried(the, found);
    for (int i = 0; i < 2; i++) {
        reached = newton_fine(the, found, y);
        double before = INFINITY;
        for (int again = 0; again < 3 && reached < 0.9 * before; again++) {
            before = reached; // each ends at the first small gain
            reached = fmin(reached, newton(the, y));
        }
        if (is_at_rest(the, y, reached))
            break;
        memcpy(the->rest, found + self->launcher.launching.layout.x + X_Y, sizeof the->rest);
    }
    return reached;
}

// The same from the centred place and, where that finds nothing, from beside it: centred, Newton's
// method stands at the kink of surfaces that are touched without play. Where both find nothing,
// what is left is that of the centred place.
static double find_on_surfaces(problem *the, const double *start, double depth, double *y)
{
    const double aside[SHOE_FREEDOMS] = {1e-4};
    double reached = find_beside(the, start, depth, NULL, y);
    if (is_at_rest(the, y, reached))
        return reached;
    problem again = *the;
    double found[LD_MAX_STATES];
    double next = find_beside(&again, start, depth, aside, found);
    if (!is_at_rest(&again, found, next))
        return reached;
    *the = again;
    memcpy(y, found, sizeof found);
    return next;
}

enum { PLACES = 4 }; // of the rocket across its guide: y, z, psi, theta

// Places from the guide line with its rear and its foremost shoe, each on the same side or
// mirrored.
static void mirror(const launch_state *self, const double off[PLACES], double rear, double front,
                   double to[SHOE_FREEDOMS])
{
    double span = self->rocket->adaptor[self->rocket->adaptor_count - 1].at;
    double front_y = front * (off[0] + span * off[2]), front_z = front * (off[1] - span * off[3]);
    to[0] = rear * off[0];
    to[1] = rear * off[1];
    to[2] = (front_y - to[0]) / span;
    to[3] = -(front_z - to[1]) / span;
}

// Whether a rocket that is released at `from` comes to rest, at `to` from the guide line, elsewhere
// than at `off`, where it rests in y.
static bool rests_elsewhere(const problem *the, const double *start, const double *y,
                            const double *from, const double off[PLACES], double to[PLACES])
{
    const double apart = 1e-5; // [m, rad]
    const launching_system *launching = &the->self->launcher.launching;
    const int at = launching->layout.x;
    problem other = *the;
    double found[LD_MAX_STATES], depth = the->self->rocket->start_at - y[at + X_S];
    double reached = find_beside(&other, start, depth, from, found);
    if (!is_at_rest(&other, found, reached))
        return false;
    bool elsewhere = false;
    for (int i = 0; i < PLACES; i++) {
        to[i] = found[at + X_Y + i] - y[at + X_Y + i] + off[i];
        elsewhere |= fabs(to[i] - off[i]) > apart;
    }
    return elsewhere;
}

// Whether a rocket that leans in an upright guide would also rest elsewhere: started on the other
// side of the guide line, then with its rear or its front there, it stays away from where it rests
// in y.
static void look_elsewhere(const problem *the, const double *start, const double *y,
                           ld_equilibrium_summary *summary)
{
    static const double sides[][2] = {{-1, -1}, {-1, 1}, {1, -1}};
    const double least = 1e-5; // [m, rad]
    const launch_state *self = the->self;
    const launching_system *launching = &self->launcher.launching;
    const double *x = y + launching->layout.x;
    double off[PLACES] = {x[X_Y] - launching->surfaces.line_y, x[X_Z] - launching->surfaces.line_z,
                          x[X_PSI], x[X_THETA]};
    double size = 0, from[SHOE_FREEDOMS] = {0};
    for (int i = 0; i < PLACES; i++)
        size = fmax(size, fabs(off[i]));
    if (!launching->surfaces.count || !is_upright(the, start) || size < least)
        return;
    for (int k = 0; k < 3 && !summary->rests_elsewhere; k++) {
        mirror(self, off, sides[k][0], sides[k][1], from);
        summary->rests_elsewhere = rests_elsewhere(the, start, y, from, off, summary->other);
    }
    memcpy(summary->taken, off, sizeof off);
}

// Says so where gravity, or the air with it, pulls the rocket along a direction in which nothing
// carries it.
static ld_status check_carried(const problem *the, const double *y, ld_error *error)
{
    static const char *const names[] = {"along y of the guide", "along z of the guide",
                                        "about z of the guide", "about y of the guide",
                                        "about the guide line"};
    int worst;
    if (held_by_spring(the, y, &worst) <= the->accepted)
        return LD_OK;
    return ld_fail(error, LD_ERR_LAUNCH,
                   "run.start: no static equilibrium: %s the rocket %s, and no surface carries it "
                   "there; \"run.start: undeformed\" starts without it",
                   the->self->air ? "gravity and the air pull" : "gravity pulls", names[worst]);
}

// The rocket in its bore is let go from the axis. `best`: what the state in y has reached.
static double try_letting_go(const problem *the, const double *start, double best, double *y)
{
    problem tube = *the;
    double found[LD_MAX_STATES];
    tube.count = launching_freedoms(the->self);
    guess_straight(the, start, found);
    double reached = release_and_settle(&tube, found);
    if (the->count > tube.count && reached <= the->accepted)
        reached = release_and_settle(the, found);
    if (!(reached <= the->accepted) || is_away(the, found))
        return best;
    problem fine = *the;
    memcpy(y, found, sizeof found);
    fine.accepted = 1e-3 * the->accepted;
    return newton_fine(&fine, found, y);
}

// Equilibrium of tube and rocket, and of the base with them where that is among the unknowns, which
// stands in `start` in its place. Returns the residual; the state is in y.
static double find_rest(const problem *the, const double *start, double *y)
{
    double best = INFINITY;
    if (is_upright(the, start))
        best = try_upright(the, start, y);
    // an adaptor that hardly carries is found from where it is pressed in [m]
    for (double extra = 0; extra < 1e-3 && best > the->accepted; extra = 10 * extra + 1e-6)
        best = fmin(best, try_pairs(the, start, extra, y));
    // a hard contact is pressed in by less than the differences
    problem fine = *the;
    for (fine.h = 0.1 * the->h; fine.h > 1e-13 && best > the->accepted; fine.h *= 0.1)
        best = fmin(best, try_pairs(&fine, start, 0, y));
    return best > the->accepted ? try_letting_go(the, start, best, y) : best;
}

// Without a lock the breech carries a rocket that gravity presses on it by more than nothing: s is
// an unknown, too.
static void stand_on_breech(launch_state *self, problem *the, launching_phase *phase)
{
    self->on_breech = true;
    phase->locked = false;
    the->count++;
}

// From where the lock holds the rocket in y onto the breech, which it presses in by `depth`.
static double go_on_breech(launch_state *self, problem *the, launching_phase *phase, double depth,
                           double *y)
{
    double best = INFINITY;
    stand_on_breech(self, the, phase);
    y[self->launcher.launching.layout.x + X_S] -= depth;
    for (the->h = DIFFERENCE; the->h > 1e-11 && !(best <= 1e-3 * the->accepted); the->h *= 0.1)
        best = newton(the, y);
    return best;
}

// On surfaces and the breech at once or, where that finds nothing, from where a lock would hold the
// rocket: a first step may take it off the breech, on which no further one brings it back.
static double find_on_surfaces_and_breech(launch_state *self, problem *the, launching_phase *phase,
                                          const double *start, double depth, double *y)
{
    problem held = *the;
    double found[LD_MAX_STATES];
    stand_on_breech(self, the, phase);
    double reached = find_on_surfaces(the, start, depth, y);
    if (is_at_rest(the, y, reached))
        return reached;
    self->on_breech = false;
    phase->locked = true;
    double next = find_on_surfaces(&held, start, 0, found);
    bool rests = is_at_rest(&held, found, next);
    next = go_on_breech(self, &held, phase, depth, found);
    if (!rests || !is_at_rest(&held, found, next))
        return reached;
    *the = held;
    memcpy(y, found, sizeof found);
    return next;
}

// Finds the equilibrium as find_rest() does, with the lock closed, or on surfaces. Where there is
// none, and gravity presses the rocket on the breech, it goes there then, on surfaces at once.
static double find_start(launch_state *self, problem *the, launching_phase *phase,
                         const double *start, double *y)
{
    double pressed = -self->motor->full.m * pull_at(self, the->t, start).x;
    bool stands = !self->rocket->lock.present &&
                  pressed > 1e-9 * self->motor->full.m * model_gravity(self->model);
    double depth = stands ? depth_under(&self->rocket->contact, pressed) : 0;
    bool surfaces = self->launcher.launching.surfaces.count > 0;
    self->on_breech = false;
    if (surfaces && stands)
        return find_on_surfaces_and_breech(self, the, phase, start, depth, y);
    if (surfaces)
        return find_on_surfaces(the, start, 0, y);
    double best = find_rest(the, start, y);
    return stands && best <= the->accepted ? go_on_breech(self, the, phase, depth, y) : best;
}

// Residual [m/s2] of a state at rest.
static double accepted_residual(const launch_state *self)
{
    return 1e-6 * (1 + model_gravity(self->model));
}

// A base with a motion of its own in equilibrium under a tube that is a dead load; one that is
// stepped where it `stands`; others need nothing.
static ld_status settle_base(const launch_state *self, double t, const launching_phase *phase,
                             const double *stands, double *y, ld_error *error)
{
    memset(y, 0, (size_t)self->launcher.state_count * sizeof(double));
    const base_system *base = &self->launcher.base;
    const base_dynamics *dynamics = base->kind->dynamics;
    double *of_base = y + self->launcher.base_at;
    if (stands)
        memcpy(of_base, stands, (size_t)base->state_count * sizeof *of_base);
    if (base->kind->receive_frame && !self->reported)
        return ld_fail(error, LD_ERR_INPUT,
                       "base.kind: external: this base is driven by a program that steps the run; "
                       "the command cannot run it");
    if (base->kind->receive_frame)
        base->kind->receive_frame(base, t, true, self->reported, of_base);
    if (!dynamics)
        return LD_OK;
    dynamics->guess(base, self->launcher.launching.tube.m, self->motor->full.m, of_base);
    ld_status status = dynamics->check_held ? dynamics->check_held(base, error) : LD_OK;
    int first = launching_freedoms(self);
    if (status || simulation_freedoms(self) == first)
        return status;
    problem dead = {
        .self = self, .t = t, .phase = phase, .first = first, .dead = true, .h = DIFFERENCE};
    dead.accepted = accepted_residual(self);
    dead.count = simulation_freedoms(self) - first;
    status = make_room(&dead, error);
    if (status)
        return status;
    double reached = newton(&dead, y);
    free(dead.jacobian);
    if (reached <= dead.accepted)
        return LD_OK;
    return dynamics->report_no_rest(base, reached, error);
}

// Whether the run can begin in the equilibrium found, which its base keeps.
static ld_status keep_rest(launch_state *self, double t, const double *y, ld_error *error)
{
    const launcher_system *launcher = &self->launcher;
    const base_dynamics *dynamics = launcher->base.kind->dynamics;
    if (!dynamics)
        return LD_OK;
    const double *base = y + launcher->base_at;
    launcher_input input;
    simulation_input(self, t, y, &input);
    dynamics->rest_of(&launcher->base, base, &self->rest);
    return dynamics->check_rest(&launcher->base, &input.found, base, error);
}

// What is said of a start with one adaptor in the tube, or NULL.
static const char *held_by_one(const launching_phase *phase, int adaptors)
{
    int inside = 0;
    for (int i = 0; i < adaptors; i++)
        inside += !phase->passed[i];
    return inside < 2 ? "only the rear adaptor is in the tube" : NULL;
}

// What Newton's method came down to [m/s2], for a message; nothing where it met no finite number.
static const char *smallest_residual(double best, char text[64])
{
    text[0] = 0;
    if (isfinite(best))
        snprintf(text, 64, " (smallest residual %.3g m/s2)", best);
    return text;
}

// Residual of a state at rest for tube and rocket where the base stands in `start`. Kilometres from
// the origin it is the rounding of places, which strains the supports: what a move of the straight
// tube by some of it leaves.
static double accepted_at(const problem *the, const double *start)
{
    enum { ROUNDINGS = 4 };
    double y[LD_MAX_STATES], plus[MAX_FREEDOMS], minus[MAX_FREEDOMS], square = 0;
    double accepted = accepted_residual(the->self);
    guess_straight(the, start, y);
    v3 r = v3_from(y + the->self->launcher.launching.layout.r);
    for (int k = 0; k < 3; k++) {
        simulation_displace(the->self, k, the->h, y);
        int bad = residual(the, y, plus);
        simulation_displace(the->self, k, -2 * the->h, y);
        if (bad || residual(the, y, minus))
            return accepted;
        simulation_displace(the->self, k, the->h, y);
        for (int i = 0; i < the->count; i++)
            square += pow((plus[i] - minus[i]) / (2 * the->h), 2);
    }
    return fmax(accepted, ROUNDINGS * 0x1p-53 * v3_norm(r) * sqrt(square));
}

// The wrench of tube and rocket at rest on their base.
static ld_status resting_wrench(const launch_state *self, double t, const double *y,
                                base_wrench *wrench, ld_error *error)
{
    launching_phase phase = resting_phase(self);
    launcher_input input;
    launcher_output out;
    simulation_input(self, t, y, &input);
    if (launcher_evaluate(&self->launcher, &input, &phase, y, &out))
        return ld_fail(error, LD_ERR_NUMERIC,
                       "run.start: the equations of motion gave no finite result");
    const m3 *A = &input.launching.base.A;
    wrench->force = m3_apply(*A, out.launching.base_force);
    wrench->moment = m3_apply(*A, out.launching.base_moment);
    return LD_OK;
}

// A start on a base that stands, and is searched where it does.
typedef ld_status find_on_base(launch_state *self, double t, const double *stands, double *y,
                               ld_equilibrium_summary *summary, ld_error *error);

// A base that is stepped stands where its motion says under the wrench of a tube that rests where
// the base stands: in turns, until both agree. Others stand at once.
static ld_status find_with_base(launch_state *self, double t, find_on_base *find, double *y,
                                ld_equilibrium_summary *summary, ld_error *error)
{
    enum { MOST_TURNS = 50 };
    const double agreed = 1e-12, near = 1e-7; // [m], [rad]
    const base_system *base = &self->launcher.base;
    const base_stepping *stepping = base->kind->stepping;
    double state[BASE_MOST_STATES], moved = INFINITY;
    base_wrench on = {.force = v3_zero()};
    ld_status status = LD_OK;
    if (!stepping)
        return find(self, t, NULL, y, summary, error);
    for (int i = 0; i < MOST_TURNS && !status && moved > agreed; i++) {
        status = stepping->find_rest(base, t, &on, state, &moved, error);
        if (!status)
            status = find(self, t, state, y, summary, error);
        if (!status)
            status = resting_wrench(self, t, y, &on, error);
    }
    return status || moved <= near
               ? status
               : ld_fail(error, LD_ERR_NUMERIC,
                         "run.start: base and tube reach no common equilibrium: after %d exchanges "
                         "of the wrench the base still moves by %.3g m or rad",
                         MOST_TURNS, moved);
}

static ld_status undeformed_on(launch_state *self, double t, const double *stands, double *y,
                               ld_equilibrium_summary *summary, ld_error *error)
{
    (void)summary;
    launching_phase phase = resting_phase(self);
    const base_system *base = &self->launcher.base;
    const base_dynamics *dynamics = base->kind->dynamics;
    ld_status status = LD_OK;
    if (dynamics && dynamics->place_as_given) {
        memset(y, 0, (size_t)self->launcher.state_count * sizeof *y);
        dynamics->place_as_given(base, y + self->launcher.base_at);
        dynamics->rest_of(base, y + self->launcher.base_at, &self->rest);
    } else {
        status = settle_base(self, t, &phase, stands, y, error);
        if (!status)
            status = keep_rest(self, t, y, error);
    }
    if (status)
        return status;
    launcher_input input;
    simulation_input(self, t, y, &input);
    simulation_straight(self, &input.launching.base, y);
    return LD_OK;
}

ld_status simulation_undeformed(launch_state *self, double t, double *y, ld_error *error)
{
    return find_with_base(self, t, undeformed_on, y, NULL, error);
}

static ld_status equilibrium_on(launch_state *self, double t, const double *stands, double *y,
                                ld_equilibrium_summary *summary, ld_error *error)
{
    launching_phase phase = resting_phase(self);
    const char *why = held_by_one(&phase, self->launcher.launching.adaptors.count);
    if (why)
        return ld_fail(error, LD_ERR_LAUNCH,
                       "rocket.start_at: no static equilibrium at the start: %s; \"run.start: "
                       "undeformed\" starts without it",
                       why);
    double start[LD_MAX_STATES];
    self->on_breech = false;
    ld_status status = settle_base(self, t, &phase, stands, start, error);
    if (status)
        return status;
    base_frame going = setting_off(self, t, start);
    problem whole = {.self = self,
                     .t = t,
                     .phase = &phase,
                     .count = simulation_freedoms(self),
                     .h = DIFFERENCE,
                     .going = &going};
    status = make_room(&whole, error);
    if (status)
        return status;
    whole.accepted = accepted_at(&whole, start);
    double best = find_start(self, &whole, &phase, start, y);
    char left[64];
    if (!(best <= whole.accepted))
        status = ld_fail(error, LD_ERR_NUMERIC,
                         "run.start: no static equilibrium was found%s: check that gravity holds "
                         "the rocket on two adaptors; \"run.start: undeformed\" starts without it",
                         smallest_residual(best, left));
    if (!status)
        status = check_carried(&whole, y, error);
    if (!status)
        status = keep_rest(self, t, y, error);
    if (!status) {
        report(&whole, y, summary);
        look_elsewhere(&whole, start, y, summary);
    }
    free(whole.jacobian);
    return status;
}

ld_status simulation_equilibrium(launch_state *self, double t, double *y,
                                 ld_equilibrium_summary *summary, ld_error *error)
{
    return find_with_base(self, t, equilibrium_on, y, summary, error);
}

double simulation_start_time(const ld_model *model)
{
    return fmin(model_firing(model, 0)->at, 0 - model_run(model)->lead_in);
}

ld_status simulation_start(launch_state *self, double t, double *y, ld_equilibrium_summary *summary,
                           ld_error *error)
{
    const ld_simulation *system = self->system;
    if (system->stability)
        return ld_fail(error, system->stability, "%s", system->unstable.text);
    ld_status status = model_run(self->model)->start == LD_START_EQUILIBRIUM
                           ? simulation_equilibrium(self, t, y, summary, error)
                           : simulation_undeformed(self, t, y, error);
    if (!status)
        simulation_move_with_base(self, t, y);
    return status;
}

// ---- another tube ----

// Adds u to the speeds of the base, and to tube and rocket what that changes of the motion of a
// body that rides on it.
static void add_rigid_motion(const launch_state *self, double t, const double *u, double *y)
{
    const launcher_system *launcher = &self->launcher;
    const launching_layout *at = &launcher->launching.layout;
    launcher_input before, after;
    launching_output unused;
    launching_pose pose;
    launcher_place(launcher, t, y, &before);
    double *speed = y + launcher->base_at + launcher->base.speed_at;
    for (int i = 0; i < launcher->base.speed_count; i++)
        speed[i] += u[i];
    launcher_place(launcher, t, y, &after);
    const base_frame *base = &before.launching.base;
    m3 A = q_matrix(q_from(y + at->quaternion));
    v3 dw = v3_sub(after.launching.base.w, base->w), arm = v3_sub(v3_from(y + at->r), base->r);
    v3 dv = v3_add(v3_sub(after.launching.base.v, base->v), v3_cross(dw, arm));
    dw = m3_apply_transposed(A, dw);
    dv = m3_apply_transposed(A, dv);
    launching_rocket_pose(&launcher->launching, y, &pose, &unused);
    v3_store(y + at->v, v3_add(v3_from(y + at->v), dv));
    v3_store(y + at->w, v3_add(v3_from(y + at->w), dw));
    v3_store(y + at->V, v3_add(v3_from(y + at->V), v3_add(dv, v3_cross(dw, pose.p1))));
    v3_store(y + at->V + 3, v3_add(v3_from(y + at->V + 3), dw));
}

// The motions that the base can make: speeds of its joints, a row each.
typedef struct base_motions {
    int count, speeds;
    double *row; // [count][speeds]
} base_motions;

// Of a base whose loops tie speeds together those at which they stay closed.
static ld_status find_motions(const launch_state *self, const double *y, base_motions *all,
                              ld_error *error)
{
    const base_system *base = &self->launcher.base;
    const base_dynamics *dynamics = base->kind->dynamics;
    *all = (base_motions){.speeds = base->speed_count};
    all->row = calloc((size_t)(all->speeds * all->speeds), sizeof *all->row);
    if (!all->row)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the base's motions");
    for (int i = 0; i < base->displacement_count; i++) {
        double moved[LD_MAX_STATES];
        int at = dynamics->speed_of(base, i) - base->speed_at;
        double *row = all->row + all->count * all->speeds;
        if (at < 0 || at >= all->speeds)
            continue; // of a wheel
        all->count++;
        row[at] = 1;
        if (!dynamics->quicken)
            continue;
        memcpy(moved, y + self->launcher.base_at, (size_t)base->state_count * sizeof(double));
        memset(moved + base->speed_at, 0, (size_t)all->speeds * sizeof(double));
        dynamics->quicken(base, i, 1, moved);
        memcpy(row, moved + base->speed_at, (size_t)all->speeds * sizeof(double));
    }
    return LD_OK;
}

static void add_motion(const launch_state *self, double t, const base_motions *all, int i,
                       double speed, double *y)
{
    double u[BASE_MOST_SPEEDS];
    for (int k = 0; k < all->speeds; k++)
        u[k] = speed * all->row[i * all->speeds + k];
    add_rigid_motion(self, t, u, y);
}

// Generalised momentum of the base, tube and rocket in the sum: the derivative of the kinetic
// energy, a quadratic form, along each of its motions.
static void generalised_momentum(const launch_state *self, double t, const launching_phase *phase,
                                 const base_motions *all, const double *y, double *p)
{
    for (int j = 0; j < all->count; j++) {
        double energy[2];
        for (int side = 0; side < 2; side++) {
            double moved[LD_MAX_STATES];
            launcher_input input;
            memcpy(moved, y, (size_t)self->launcher.state_count * sizeof(double));
            add_motion(self, t, all, j, side ? 1 : -1, moved);
            simulation_input(self, t, moved, &input);
            energy[side] = launcher_kinetic_energy(&self->launcher, &input, phase, moved);
        }
        p[j] = 0.5 * (energy[1] - energy[0]);
    }
}

// What a carrier that moves gives of it to the base at rest and to what rides on that.
static void carried_momentum(const launch_state *self, double t, const launching_phase *phase,
                             const base_motions *all, const double *y, double *p)
{
    const launcher_system *launcher = &self->launcher;
    const launching_layout *at = &launcher->launching.layout;
    double still[LD_MAX_STATES];
    memcpy(still, y, (size_t)launcher->state_count * sizeof(double));
    memset(still + launcher->base_at + launcher->base.speed_at, 0,
           (size_t)all->speeds * sizeof(double));
    memset(still + at->q_dot, 0, (size_t)at->nq * sizeof(double));
    ride_on_base(self, t, still);
    generalised_momentum(self, t, phase, all, still, p);
}

// Its part of the motion against the carrier.
static void momentum_on_carrier(const launch_state *self, double t, const launching_phase *phase,
                                const base_motions *all, const double *y, double *p)
{
    double carried[BASE_MOST_SPEEDS];
    generalised_momentum(self, t, phase, all, y, p);
    carried_momentum(self, t, phase, all, y, carried);
    for (int i = 0; i < all->count; i++)
        p[i] -= carried[i];
}

// Speeds of the base, which stands, at which all, rigid as it now is, has the momentum p.
static ld_status speeds_from_momentum(const launch_state *self, double t, const base_motions *all,
                                      const double *p, double *y, ld_error *error)
{
    launching_phase phase = simulation_start_phase(self);
    double u[BASE_MOST_SPEEDS], speed[BASE_MOST_SPEEDS] = {0};
    lapack_int pivot[BASE_MOST_SPEEDS];
    int n = all->count;
    double *M = malloc((size_t)(n * n) * sizeof *M);
    if (!M)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the base's mass matrix");
    // columns of the mass matrix: momentum at unit speeds
    for (int j = 0; j < n; j++) {
        double moved[LD_MAX_STATES];
        memcpy(moved, y, (size_t)self->launcher.state_count * sizeof(double));
        add_motion(self, t, all, j, 1, moved);
        momentum_on_carrier(self, t, &phase, all, moved, M + n * j);
    }
    memcpy(u, p, (size_t)n * sizeof *u);
    bool singular = n > 0 && LAPACKE_dgesv(LAPACK_COL_MAJOR, n, 1, M, n, pivot, u, n) != 0;
    free(M);
    if (singular)
        return ld_fail(error, LD_ERR_NUMERIC, "the base's mass matrix is singular");
    for (int i = 0; i < n; i++)
        for (int k = 0; k < all->speeds; k++)
            speed[k] += u[i] * all->row[i * all->speeds + k];
    add_rigid_motion(self, t, speed, y);
    return LD_OK;
}

// Puts the next tube on the base as it stands and moves, in equilibrium there; the base stays.
static ld_status put_tube(launch_state *self, int next, double t, double *y, ld_error *error)
{
    launching_phase phase = resting_phase(self);
    const launcher_system *launcher = &self->launcher;
    double still[LD_MAX_STATES];
    size_t launching = (size_t)launcher->launching.layout.count * sizeof(double);
    launcher_select(&self->launcher, next);
    const char *why = held_by_one(&phase, launcher->launching.adaptors.count);
    if (why)
        return ld_fail(
            error, LD_ERR_LAUNCH,
            "rocket.start_at: tube %d has no static equilibrium when it takes over, t = %.6g s: %s",
            model_firing(self->model, next)->tube, t, why);

    // the new tube in equilibrium on the base held still
    base_frame going = going_of(self, t, y);
    memcpy(still, y, (size_t)launcher->state_count * sizeof(double));
    memset(still + launcher->base_at + launcher->base.speed_at, 0,
           (size_t)launcher->base.speed_count * sizeof(double));
    self->on_breech = false;
    problem tube = {.self = self,
                    .t = t,
                    .phase = &phase,
                    .count = launching_freedoms(self),
                    .h = DIFFERENCE,
                    .going = &going};
    ld_status status = make_room(&tube, error);
    if (status)
        return status;
    double found[LD_MAX_STATES];
    tube.accepted = accepted_at(&tube, still);
    double best = find_start(self, &tube, &phase, still, found);
    free(tube.jacobian);
    char left[64];
    if (!(best <= tube.accepted))
        return ld_fail(error, LD_ERR_NUMERIC,
                       "tube %d has no static equilibrium when it takes over, t = %.6g s%s",
                       model_firing(self->model, next)->tube, t, smallest_residual(best, left));
    status = check_carried(&tube, found, error);
    if (status)
        return status;
    memcpy(y, found, launching);
    return LD_OK;
}

ld_status simulation_change_tube(launch_state *self, int next, double t, double *y, ld_error *error)
{
    const base_system *base = &self->launcher.base;
    launching_phase without = {.rocket = false};
    double p[BASE_MOST_SPEEDS];
    base_motions all;
    if (base->speed_count == 0) {
        ld_status status = put_tube(self, next, t, y, error);
        if (!status)
            simulation_move_with_base(self, t, y);
        return status;
    }
    ld_status status = find_motions(self, y, &all, error);
    if (!status) {
        momentum_on_carrier(self, t, &without, &all, y, p);
        status = put_tube(self, next, t, y, error);
    }
    if (!status) {
        memset(y + self->launcher.base_at + base->speed_at, 0,
               (size_t)base->speed_count * sizeof(double));
        ride_on_base(self, t, y);
        status = speeds_from_momentum(self, t, &all, p, y, error);
    }
    free(all.row);
    return status;
}
