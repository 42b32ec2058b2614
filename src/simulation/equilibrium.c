// The start of a launch: undeformed, or in static equilibrium found by Newton's method.
#include <lapacke.h>
#include <math.h>
#include <string.h>

#include "math/rotation_vector.h"
#include "simulation/simulation.h"

enum { MAX_FREEDOMS = 10 + LD_MAX_MODAL };

int simulation_freedoms(const ld_simulation *self)
{
    return 10 + self->launching.layout.nq;
}

void simulation_displace(const ld_simulation *self, int freedom, double change, double *y)
{
    const launching_layout *at = &self->launching.layout;
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
    } else {
        y[at->x + 1 + freedom - 6 - at->nq] += change;
    }
}

launching_phase simulation_start_phase(const ld_simulation *self)
{
    launching_phase phase = {.rocket = true, .locked = true};
    const ld_rocket *rocket = &self->model->rocket;
    for (int i = 0; i < rocket->adaptor_count; i++) {
        phase.passed[i] = rocket->start_at + rocket->adaptor[i].at >= self->model->tubes.length;
        phase.touch_speed[i] = rocket->contact.reference_speed;
    }
    return phase;
}

void simulation_undeformed(const ld_simulation *self, double t, double *y)
{
    const launching_layout *at = &self->launching.layout;
    base_frame base;
    base_motion_at(&self->base, t, &base);
    memset(y, 0, (size_t)self->state_count * sizeof(double));
    v3_store(y + at->r, base.r);
    memcpy(y + at->quaternion, &base.q, sizeof base.q);
    y[at->x] = self->model->rocket.start_at;
}

void simulation_move_with_base(const ld_simulation *self, double t, double *y)
{
    const launching_layout *at = &self->launching.layout;
    base_frame base;
    launching_output unused;
    launching_pose pose;
    base_motion_at(&self->base, t, &base);
    m3 A = q_matrix(q_from(y + at->quaternion));
    v3 r = v3_sub(v3_from(y + at->r), base.r);
    v3 w = m3_apply_transposed(A, base.w);
    v3 v = m3_apply_transposed(A, v3_add(base.v, v3_cross(base.w, r)));
    launching_rocket_pose(&self->launching, y, &pose, &unused);
    v3_store(y + at->v, v);
    v3_store(y + at->w, w);
    v3_store(y + at->V, v3_add(v, v3_cross(w, pose.p1)));
    v3_store(y + at->V + 3, w);
}

// What must vanish in equilibrium: all accelerations that the lock and the slot leave free.
static int residual(const ld_simulation *self, const launching_input *input,
                    const launching_phase *phase, const double *y, double *r)
{
    launching_output out;
    launching_pose pose;
    const launching_layout *at = &self->launching.layout;
    if (launching_evaluate(&self->launching, input, phase, y, &out))
        return -1;
    launching_rocket_pose(&self->launching, y, &pose, &out);
    v3_store(r, out.a);
    v3_store(r + 3, out.w_dot);
    memcpy(r + 6, out.q_ddot, (size_t)at->nq * sizeof(double));
    v3 a = m3_apply_transposed(pose.A_RS, out.a_O1);
    v3 alpha = m3_apply_transposed(pose.A_RS, out.alpha_B);
    double *rocket = r + 6 + at->nq;
    rocket[0] = a.y;
    rocket[1] = a.z;
    rocket[2] = alpha.z;
    rocket[3] = alpha.y;
    return 0;
}

static double norm(int n, const double *r)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += r[i] * r[i];
    return sqrt(sum);
}

// One Newton step by central differences: `step` := -J^-1 r.
static int newton_step(const ld_simulation *self, const launching_input *input,
                       const launching_phase *phase, const double *y, const double *r, double *step)
{
    int n = simulation_freedoms(self);
    double J[MAX_FREEDOMS * MAX_FREEDOMS], plus[MAX_FREEDOMS], minus[MAX_FREEDOMS];
    double trial[LD_MAX_STATES];
    lapack_int pivot[MAX_FREEDOMS];
    size_t size = (size_t)self->state_count * sizeof(double);
    for (int j = 0; j < n; j++) {
        double h = 1e-8;
        memcpy(trial, y, size);
        simulation_displace(self, j, h, trial);
        int bad = residual(self, input, phase, trial, plus);
        memcpy(trial, y, size);
        simulation_displace(self, j, -h, trial);
        if (bad || residual(self, input, phase, trial, minus))
            return -1;
        for (int i = 0; i < n; i++)
            J[i + n * j] = (plus[i] - minus[i]) / (2 * h);
        step[j] = -r[j];
    }
    return LAPACKE_dgesv(LAPACK_COL_MAJOR, n, 1, J, n, pivot, step, n);
}

// Newton with halved steps from the guess in y. Ends where no step makes the residual smaller.
static double newton(const ld_simulation *self, const launching_input *input,
                     const launching_phase *phase, double *y)
{
    int n = simulation_freedoms(self);
    size_t size = (size_t)self->state_count * sizeof(double);
    double r[MAX_FREEDOMS], step[MAX_FREEDOMS], trial[LD_MAX_STATES], r_trial[MAX_FREEDOMS];
    if (residual(self, input, phase, y, r))
        return INFINITY;
    double now = norm(n, r);
    for (int iteration = 0; iteration < 60; iteration++) {
        if (newton_step(self, input, phase, y, r, step))
            break;
        double share = 1, next = INFINITY;
        for (int halving = 0; halving < 25; halving++, share *= 0.5) {
            memcpy(trial, y, size);
            for (int j = 0; j < n; j++)
                simulation_displace(self, j, share * step[j], trial);
            if (residual(self, input, phase, trial, r_trial) == 0 &&
                (next = norm(n, r_trial)) < now)
                break;
        }
        if (!(next < now))
            break;
        bool rounding = now < 1e-6 && next > 0.1 * now;
        memcpy(y, trial, size);
        memcpy(r, r_trial, sizeof r);
        now = next;
        if (rounding)
            break;
    }
    return now;
}

// How far adaptor i moves from the axis under `load` [N], positive along it, pressed in by `extra`.
static double offset_under(const ld_rocket *rocket, int i, double load, double extra)
{
    const ld_contact *contact = &rocket->contact;
    double d_0 = contact->reference_penetration;
    if (contact->law == LD_CONTACT_BILATERAL)
        return load / contact->stiffness;
    double depth = d_0 * pow(fabs(load) / (contact->stiffness * d_0), 1 / contact->exponent);
    return copysign(rocket->adaptor[i].clearance + depth + extra, load);
}

// Guess: adaptors i and j carry the rocket, each on the side that its share of the weight presses
// it to (one of them on the upper side where the mass centre is not between them).
static void guess_contacts(const ld_simulation *self, int i, int j, v3 pull, double extra,
                           double *y)
{
    const ld_rocket *rocket = &self->model->rocket;
    double *x = y + self->launching.layout.x;
    double lean = hypot(pull.y, pull.z), weight = self->motor.full.m * lean;
    double from = rocket->adaptor[i].at, span = rocket->adaptor[j].at - from;
    double share = (self->motor.full.c.x - from) / span;
    double e_i = offset_under(rocket, i, (1 - share) * weight, extra);
    double e_j = offset_under(rocket, j, share * weight, extra);
    double slope = (e_j - e_i) / span;
    double e_0 = e_i - slope * from;
    x[1] = e_0 * pull.y / lean;
    x[2] = e_0 * pull.z / lean;
    x[3] = slope * pull.y / lean;
    x[4] = -slope * pull.z / lean;
}

static void report(const ld_simulation *self, const launching_input *input,
                   const launching_phase *phase, const double *y, ld_equilibrium_summary *summary)
{
    launching_output out;
    double r[MAX_FREEDOMS];
    launching_evaluate(&self->launching, input, phase, y, &out);
    residual(self, input, phase, y, r);
    tip_state tip = tip_state_of(self, &input->base, y);
    *summary = (ld_equilibrium_summary){
        .lock_force = out.lock_force, .slot_force = out.N, .tip_sag = {tip.offset.y, tip.offset.z}};
    for (int i = 0; i < self->launching.adaptor_count; i++)
        summary->contact_force[i] = phase->passed[i] ? 0 : out.adaptor[i].normal;
    for (int i = 0; i < simulation_freedoms(self); i++)
        summary->residual = fmax(summary->residual, fabs(r[i]));
}

// Newton's method from one pair of carrying adaptors after the other, the outermost first, until
// one succeeds. Returns the smallest residual; its state is in y.
static double try_pairs(const ld_simulation *self, double t, const launching_input *input,
                        const launching_phase *phase, double extra, double accepted, double *y)
{
    double best = INFINITY, trial[LD_MAX_STATES];
    v3 pull = m3_apply_transposed(input->base.A, v3_make(0, -self->model->gravity, 0));
    for (int j = self->launching.adaptor_count - 1; j > 0; j--)
        for (int i = 0; i < j; i++) {
            if (phase->passed[i] || phase->passed[j])
                continue;
            simulation_undeformed(self, t, trial);
            if (hypot(pull.y, pull.z) > 0)
                guess_contacts(self, i, j, pull, extra, trial);
            double reached = newton(self, input, phase, trial);
            if (reached < best) {
                best = reached;
                memcpy(y, trial, (size_t)self->state_count * sizeof(double));
            }
            if (best <= accepted)
                return best;
        }
    return best;
}

ld_status simulation_equilibrium(const ld_simulation *self, double t, double *y,
                                 ld_equilibrium_summary *summary, ld_error *error)
{
    launching_phase phase = simulation_start_phase(self);
    launching_input input;
    phase.frictionless = true;
    simulation_input(self, t, &input);
    input.base.v = input.base.w = v3_zero();
    input.thrust = 0;
    int inside = 0;
    for (int i = 0; i < self->launching.adaptor_count; i++)
        inside += !phase.passed[i];
    if (inside < 2)
        return ld_fail(error, LD_ERR_LAUNCH,
                       "no static equilibrium at the start: only the rear adaptor is in the tube; "
                       "\"run.start: undeformed\" starts without it");
    double accepted = 1e-6 * (1 + self->model->gravity);
    double best = INFINITY;
    // an adaptor that hardly carries is found from where it is pressed in [m]
    for (double extra = 0; extra < 1e-3 && best > accepted; extra = 10 * extra + 1e-6)
        best = fmin(best, try_pairs(self, t, &input, &phase, extra, accepted, y));
    if (!(best <= accepted))
        return ld_fail(
            error, LD_ERR_NUMERIC,
            "no static equilibrium was found for the start (smallest residual %.3g m/s2): "
            "is the rocket held by gravity on two adaptors? \"run.start: undeformed\" "
            "starts without it",
            best);
    report(self, &input, &phase, y, summary);
    return LD_OK;
}
