#include "systems/launching/launching_general.h"

#include "math/matrices/dense.h"
#include "model/parts.h"

static void flatten(const launching_system *self, const tube_force *force, double *h)
{
    int nb = self->tube.flexible.nb, nt = self->tube.flexible.nt;
    v3_store(h, v3_add(v3_from(h), force->f));
    v3_store(h + 3, v3_add(v3_from(h + 3), force->m));
    for (int j = 0; j < nb; j++) {
        h[6 + j] += force->y[j];
        h[6 + nb + j] += force->z[j];
    }
    for (int j = 0; j < nt; j++)
        h[6 + 2 * nb + j] += force->t[j];
    for (int j = 0; j < self->tube.flexible.na; j++)
        h[6 + 2 * nb + nt + j] += force->a[j];
}

// Modal damping power and elastic energy, all families.
static void modal_energies(const launching_system *self, const double *state, launching_output *out)
{
    const flexible_tube *tube = &self->tube.flexible;
    out->power[POWER_MODAL_DAMPING] = tube_damping_power(tube, state + self->layout.q_dot);
    out->elastic = tube_elastic_energy(tube, state + self->layout.q);
}

// B = L(s)^T (f, m) of a direction's wrench on the section.
static void direction_force(int n, const tube_section_state *section, const constraint_direction *e,
                            double *B)
{
    double wrench[6];
    v3_store(wrench, e->force);
    v3_store(wrench + 3, e->moment);
    for (int j = 0; j < n; j++) {
        B[j] = 0;
        for (int i = 0; i < 6; i++)
            B[j] += section->L[i * n + j] * wrench[i];
    }
}

static void load_direction_forces(const launching_system *self, v3 w, const double *state,
                                  const constraint_set *set, double B[][LD_TUBE_SPEEDS])
{
    const double *q = state + self->layout.q, *q_dot = state + self->layout.q_dot;
    int n = 6 + self->layout.nq;
    for (int k = 0; k < set->section_count; k++) {
        tube_section_state section;
        const constraint_section *on = &set->section[k];
        const guide_station at = {&self->tube.flexible, on->motion->initial, on->at->x};
        guide_section(&at, w, q, q_dot, &section);
        for (int i = 0; i < set->count; i++)
            if (set->e[i].section == k)
                direction_force(n, &section, &set->e[i], B[i]);
        if (set->sliding && set->tangent.section == k)
            direction_force(n, &section, &set->tangent, B[LD_MAX_CONSTRAINTS]);
    }
}

void launching_uncouple(const launching_system *self, const launching_input *input,
                        const launching_phase *phase, const double *state, launching_uncoupled *u,
                        launching_output *out)
{
    const launching_layout *at = &self->layout;
    const flexible_tube *tube = &self->tube.flexible;
    const double *q = state + at->q, *q_dot = state + at->q_dot;
    launching_instant *now = &u->now;
    int lanes = tube->nbp / 4;
    now->input = input;
    now->phase = phase;
    now->out = out;
    memset(&now->on_tube, 0, sizeof now->on_tube);
    now->on_tube.record = input->record;
    memset(out->power, 0, sizeof out->power);
    out->fell_back = false;
    out->condition = 0;
    u->n = 6 + at->nq;
    tube_load(lanes, &self->tube, at, state, &now->tube);
    if (tube->shortening)
        now->on_tube.bent = &now->tube.modal;
    const tube_motion motion = {now->tube.w, now->tube.g, q, q_dot};
    tube_dynamics_assemble(tube, &motion, u->M, u->h);
    modal_energies(self, state, out);
    supports_add(lanes, &self->supports, &self->tube, now);
    if (input->load)
        load_tip(lanes, input->load, &self->tube, now);
    if (self->wind.count)
        guide_wind_add(&self->wind, &self->tube, now);
    out->guide_jet = input->jet_face.hit;
    out->deflector = input->deflector.hit;
    if (out->guide_jet != 0 || out->deflector != 0)
        guide_jet_add(&self->tube, now);
    if (phase->rocket)
        launching_load_rocket(lanes, self, state, now);
    tube_factor(lanes, &self->tube, &now->tube);
    launching_constrain(lanes, phase->rocket, true, self, now, &u->c);
    load_direction_forces(self, now->tube.w, state, &u->c.set, u->B);
    flatten(self, &now->on_tube, u->h);
}

void launching_store_tube(int n, const double *eta_dot, launching_output *out)
{
    out->a = v3_from(eta_dot);
    out->w_dot = v3_from(eta_dot + 3);
    memcpy(out->q_ddot, eta_dot + 6, (size_t)(n - 6) * sizeof(double));
}

// ---- reduced form ----

// M2, h2: the tail welded to the rear section, L(0)^T M_t L(0) and L(0)^T f_t.
static void add_tail(const launching_system *self, const tube_state *tube, int n, double *M2,
                     double *h2)
{
    const ld_tail *tail = &model_tubes(self->model)->tail;
    v3 w = tube->w, g = tube->g, c = v3_make(tail->center, 0, 0);
    m3 J = m3_diagonal(self->tube.tail_inertia.x, self->tube.tail_inertia.y,
                       self->tube.tail_inertia.z);
    m3 mc = m3_scale(tail->mass, m3_skew(c));
    for (int i = 0; i < 3; i++) {
        M2[i * n + i] += tail->mass;
        for (int j = 0; j < 3; j++) {
            M2[i * n + 3 + j] -= mc.a[i][j];
            M2[(3 + i) * n + j] += mc.a[i][j];
            M2[(3 + i) * n + 3 + j] += J.a[i][j];
        }
    }
    v3 f = v3_scale(tail->mass, v3_sub(g, v3_cross(w, v3_cross(w, c))));
    v3 m = v3_sub(v3_cross(c, v3_scale(tail->mass, g)), v3_cross(w, m3_apply(J, w)));
    v3_store(h2, v3_add(v3_from(h2), f));
    v3_store(h2 + 3, v3_add(v3_from(h2 + 3), m));
}

// M2 = [M_rr, C; C^T, E], as the modes have unit mass: G G^T = M_rr - C C^T.
typedef struct condensed_mass {
    int n;
    const double *M; // [n x n]
    double G[36];
} condensed_mass;

// False where that is not positive definite.
static bool condense(int n, const double *M, condensed_mass *to)
{
    to->n = n;
    to->M = M;
    for (int i = 0; i < 6; i++)
        for (int j = 0; j <= i; j++) {
            double sum = M[i * n + j];
            for (int k = 6; k < n; k++)
                sum -= M[i * n + k] * M[j * n + k];
            to->G[6 * i + j] = sum;
        }
    return cholesky_factor(6, to->G) == 0;
}

// b := M2^-1 b.
static void solve_condensed(const condensed_mass *by, double *b)
{
    int n = by->n;
    for (int i = 0; i < 6; i++)
        for (int k = 6; k < n; k++)
            b[i] -= by->M[i * n + k] * b[k];
    cholesky_solve(6, by->G, b);
    for (int i = 0; i < 6; i++)
        for (int k = 6; k < n; k++)
            b[k] -= by->M[i * n + k] * b[i];
}

// e = M2^-1 B of the directions, and their products.
static void load_products(const condensed_mass *M2, const constraint_set *set,
                          double B[][LD_TUBE_SPEEDS], double e[][LD_TUBE_SPEEDS],
                          constraint_products *D)
{
    int n = M2->n;
    for (int i = 0; i < set->count + set->sliding; i++) {
        int row = i < set->count ? i : LD_MAX_CONSTRAINTS;
        memcpy(e[row], B[row], sizeof(double) * (size_t)n);
        solve_condensed(M2, e[row]);
    }
    for (int i = 0; i < set->count; i++) {
        const constraint_direction *p = &set->e[i], *tangent = &set->tangent;
        for (int j = 0; j < set->count; j++)
            D->D[i][j] = v3_dot(p->G_f, set->e[j].r_a) + v3_dot(p->G_m, set->e[j].r_alpha) +
                         launching_dot(n, B[i], e[j]);
        if (set->sliding)
            D->Dt[i] = v3_dot(p->G_f, tangent->r_a) + v3_dot(p->G_m, tangent->r_alpha) +
                       launching_dot(n, B[i], e[LD_MAX_CONSTRAINTS]);
    }
}

launching_outcome launching_solve_reduced(const launching_system *self,
                                          const launching_phase *phase, launching_uncoupled *u,
                                          launching_output *out)
{
    int n = u->n, count = u->c.set.count;
    double M2[LD_TUBE_SPEEDS * LD_TUBE_SPEEDS], e_0[LD_TUBE_SPEEDS],
        e[LD_MAX_CONSTRAINTS + 1][LD_TUBE_SPEEDS];
    condensed_mass condensed;
    memcpy(M2, u->M, sizeof(double) * (size_t)(n * n));
    memcpy(e_0, u->h, sizeof(double) * (size_t)n);
    add_tail(self, &u->now.tube, n, M2, e_0);
    if (!condense(n, M2, &condensed))
        return LAUNCHING_NOT_FINITE;
    solve_condensed(&condensed, e_0);
    if (phase->rocket || count) {
        v3 r_a = v3_zero(), r_alpha = v3_zero();
        double r[LD_MAX_CONSTRAINTS];
        constraint_products D;
        if (phase->rocket)
            rocket_solve(&u->now.inertia, u->now.f, u->now.m, &r_a, &r_alpha);
        load_products(&condensed, &u->c.set, u->B, e, &D);
        for (int i = 0; i < count; i++) {
            const constraint_direction *p = &u->c.set.e[i];
            r[i] = -(v3_dot(p->G_f, r_a) + v3_dot(p->G_m, r_alpha) -
                     launching_dot(n, u->B[i], e_0) + p->beta);
        }
        if (count && !constraints_solve(&D, r, &u->c.set))
            return LAUNCHING_JAMMED;
        for (int i = 0; i < count + u->c.set.sliding; i++) {
            int row = i < count ? i : LD_MAX_CONSTRAINTS;
            const constraint_direction *p = i < count ? &u->c.set.e[i] : &u->c.set.tangent;
            double x = i < count ? u->c.set.x[i] : u->c.set.friction;
            r_a = v3_axpy(r_a, x, p->r_a);
            r_alpha = v3_axpy(r_alpha, x, p->r_alpha);
            for (int j = 0; j < n; j++)
                e_0[j] -= x * e[row][j];
        }
        out->a_O1 = r_a;
        out->alpha_B = r_alpha;
        launching_report(u->now.phase->rocket, true, self, &u->now, &u->c.set, out);
    }
    launching_store_tube(n, e_0, out);
    return LAUNCHING_OK;
}

void launching_impulse_general(const launching_system *self, const launching_instant *now,
                               const constraint_set *set, const double *state, const double *wrong,
                               launching_change *change)
{
    const launching_layout *at = &self->layout;
    int n = 6 + at->nq, count = set->count;
    double M2[LD_TUBE_SPEEDS * LD_TUBE_SPEEDS], h[LD_TUBE_SPEEDS], eta[LD_TUBE_SPEEDS] = {0},
                                                                   x[LD_MAX_CONSTRAINTS];
    double B[LD_MAX_CONSTRAINTS + 1][LD_TUBE_SPEEDS], e[LD_MAX_CONSTRAINTS + 1][LD_TUBE_SPEEDS];
    condensed_mass condensed;
    constraint_products D;
    *change = (launching_change){.a = v3_zero()};
    const tube_motion motion = {now->tube.w, now->tube.g, state + at->q, state + at->q_dot};
    tube_dynamics_assemble(&self->tube.flexible, &motion, M2, h);
    add_tail(self, &now->tube, n, M2, h);
    if (!condense(n, M2, &condensed))
        return;
    load_direction_forces(self, now->tube.w, state, set, B);
    load_products(&condensed, set, B, e, &D);
    ldl_factor(count, LD_MAX_CONSTRAINTS, D.D[0]);
    for (int i = 0; i < count; i++)
        x[i] = -wrong[i];
    ldl_solve(count, LD_MAX_CONSTRAINTS, D.D[0], x);
    for (int i = 0; i < count; i++) {
        change->a_O1 = v3_axpy(change->a_O1, x[i], set->e[i].r_a);
        change->alpha_B = v3_axpy(change->alpha_B, x[i], set->e[i].r_alpha);
        for (int j = 0; j < n; j++)
            eta[j] -= x[i] * e[i][j];
    }
    change->a = v3_from(eta);
    change->w_dot = v3_from(eta + 3);
    memcpy(change->q_ddot, eta + 6, (size_t)at->nq * sizeof(double));
}

launching_outcome launching_evaluate_general(const launching_system *self,
                                             const launching_input *input,
                                             const launching_phase *phase, const double *state,
                                             launching_output *out)
{
    launching_uncoupled u;
    launching_uncouple(self, input, phase, state, &u, out);
    launching_outcome outcome = launching_solve_reduced(self, phase, &u, out);
    constraints_record(&u.now, &u.c.set);
    return outcome;
}
