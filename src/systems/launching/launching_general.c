// Accelerations of the launching subsystem from the tube's general mass matrix: the reduced form
// with full matrices, and the paper's overall form with transfer matrices (formulation.md, section
// 4). Clear rather than fast; forces and constraints are those of the fast layout.
#include "elements/tube/transfer.h"
#include "elements/tube/tube_dynamics.h"
#include "math/matrices/dense.h"
#include "systems/launching/launching_constraints.h"

enum {
    SPEEDS = LD_TUBE_SPEEDS,
    MAX_CONSTRAINTS = LD_MAX_CONSTRAINTS,
    MAX_UNKNOWNS = 18 + MAX_CONSTRAINTS, // accelerations of both ends, y_dot, constraint forces
};

// Tube and rocket before they are coupled.
typedef struct uncoupled {
    int n;                     // speeds of the tube
    double M[SPEEDS * SPEEDS]; // tube alone
    double h[SPEEDS];          // tube alone, with supports and contacts
    launching_instant now;
    launching_constraints c;
    double B[MAX_CONSTRAINTS + 1][SPEEDS]; // generalised forces of the directions; last: tangent
    const tube_section_state *rear, *tip;  // of the tube, for the overall form
} uncoupled;

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
                                  const constraint_set *set, double B[][SPEEDS])
{
    const double *q = state + self->layout.q, *q_dot = state + self->layout.q_dot;
    int n = 6 + self->layout.nq;
    for (int k = 0; k < set->section_count; k++) {
        tube_section_state section;
        tube_section(&self->tube.flexible, set->section[k].at->x, w, q, q_dot, &section);
        for (int i = 0; i < set->count; i++)
            if (set->e[i].section == k)
                direction_force(n, &section, &set->e[i], B[i]);
        if (set->sliding && set->tangent.section == k)
            direction_force(n, &section, &set->tangent, B[MAX_CONSTRAINTS]);
    }
}

static void load_uncoupled(const launching_system *self, const launching_input *input,
                           const launching_phase *phase, const double *state, uncoupled *u,
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
    u->n = 6 + at->nq;
    tube_load(lanes, &self->tube, at, state, &now->tube);
    tube_dynamics_assemble(tube, now->tube.w, q, q_dot, now->tube.g, u->M, u->h);
    modal_energies(self, state, out);
    supports_add(lanes, &self->supports, &self->tube, now);
    if (input->load)
        load_tip(lanes, input->load, &self->tube, now);
    if (phase->rocket)
        launching_load_rocket(lanes, self, state, now);
    tube_factor(lanes, &self->tube, &now->tube);
    launching_constrain(lanes, phase->rocket, true, self, now, &u->c);
    load_direction_forces(self, now->tube.w, state, &u->c.set, u->B);
    flatten(self, &now->on_tube, u->h);
}

static double dot(int n, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

static void store_tube(int n, const double *eta_dot, launching_output *out)
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
    const ld_tail *tail = &self->model->tubes.tail;
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

// e = M2^-1 B of the directions, from the factor of M2 [n x n], and their products.
static void load_products(int n, const double *factor, const constraint_set *set,
                          double B[][SPEEDS], double e[][SPEEDS], constraint_products *D)
{
    for (int i = 0; i < set->count + set->sliding; i++) {
        int row = i < set->count ? i : MAX_CONSTRAINTS;
        memcpy(e[row], B[row], sizeof(double) * (size_t)n);
        cholesky_solve(n, factor, e[row]);
    }
    for (int i = 0; i < set->count; i++) {
        const constraint_direction *p = &set->e[i], *tangent = &set->tangent;
        for (int j = 0; j < set->count; j++)
            D->D[i][j] = v3_dot(p->G_f, set->e[j].r_a) + v3_dot(p->G_m, set->e[j].r_alpha) +
                         dot(n, B[i], e[j]);
        if (set->sliding)
            D->Dt[i] = v3_dot(p->G_f, tangent->r_a) + v3_dot(p->G_m, tangent->r_alpha) +
                       dot(n, B[i], e[MAX_CONSTRAINTS]);
    }
}

static launching_outcome solve_reduced(const launching_system *self, const launching_phase *phase,
                                       uncoupled *u, launching_output *out)
{
    int n = u->n, count = u->c.set.count;
    double M2[SPEEDS * SPEEDS], e_0[SPEEDS], e[MAX_CONSTRAINTS + 1][SPEEDS];
    memcpy(M2, u->M, sizeof(double) * (size_t)(n * n));
    memcpy(e_0, u->h, sizeof(double) * (size_t)n);
    add_tail(self, &u->now.tube, n, M2, e_0);
    if (cholesky_factor(n, M2))
        return LAUNCHING_NOT_FINITE;
    cholesky_solve(n, M2, e_0);
    if (phase->rocket || count) {
        v3 r_a = v3_zero(), r_alpha = v3_zero();
        double r[MAX_CONSTRAINTS];
        constraint_products D;
        if (phase->rocket)
            rocket_solve(&u->now.inertia, u->now.f, u->now.m, &r_a, &r_alpha);
        load_products(n, M2, &u->c.set, u->B, e, &D);
        for (int i = 0; i < count; i++) {
            const constraint_direction *p = &u->c.set.e[i];
            r[i] =
                -(v3_dot(p->G_f, r_a) + v3_dot(p->G_m, r_alpha) - dot(n, u->B[i], e_0) + p->beta);
        }
        if (count && !constraints_solve(&D, r, &u->c.set))
            return LAUNCHING_JAMMED;
        for (int i = 0; i < count + u->c.set.sliding; i++) {
            int row = i < count ? i : MAX_CONSTRAINTS;
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
    store_tube(n, e_0, out);
    return LAUNCHING_OK;
}

void launching_impulse_general(const launching_system *self, const launching_instant *now,
                               const constraint_set *set, const double *state, const double *wrong,
                               launching_change *change)
{
    const launching_layout *at = &self->layout;
    int n = 6 + at->nq, count = set->count;
    double M2[SPEEDS * SPEEDS], h[SPEEDS], eta[SPEEDS] = {0}, x[MAX_CONSTRAINTS];
    double B[MAX_CONSTRAINTS + 1][SPEEDS], e[MAX_CONSTRAINTS + 1][SPEEDS];
    constraint_products D;
    *change = (launching_change){.a = v3_zero()};
    tube_dynamics_assemble(&self->tube.flexible, now->tube.w, state + at->q, state + at->q_dot,
                           now->tube.g, M2, h);
    add_tail(self, &now->tube, n, M2, h);
    if (cholesky_factor(n, M2))
        return;
    load_direction_forces(self, now->tube.w, state, set, B);
    load_products(n, M2, set, B, e, &D);
    ldl_factor(count, MAX_CONSTRAINTS, D.D[0]);
    for (int i = 0; i < count; i++)
        x[i] = -wrong[i];
    ldl_solve(count, MAX_CONSTRAINTS, D.D[0], x);
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

// ---- overall form ----

// The rocket's relative kinematics [a_O1; alpha_B] = X eta_dot + Y y_dot + b (formulation.md,
// section 3), with the curvature's change along the tube.
typedef struct relative_kinematics {
    double X[6 * SPEEDS], Y[6][6], b[6];
} relative_kinematics;

static void load_relative(const launching_system *self, const double *state, const uncoupled *u,
                          relative_kinematics *k)
{
    const launching_layout *at = &self->layout;
    const rocket_state *rocket = &u->now.rocket;
    const axis_section *s = &rocket->at;
    const section_rates *r = &rocket->rates;
    tube_section_state at_rocket;
    v3 w = u->now.tube.w, Ad = rocket->Ad;
    double s_dot = rocket->s_dot;
    tube_section(&self->tube.flexible, rocket->s, w, state + at->q, state + at->q_dot, &at_rocket);
    // X: the section's L, moved from its axis point to O1
    for (int j = 0; j < u->n; j++) {
        v3 a = v3_make(at_rocket.L[j], at_rocket.L[u->n + j], at_rocket.L[2 * u->n + j]);
        v3 alpha = v3_make(at_rocket.L[3 * u->n + j], at_rocket.L[4 * u->n + j],
                           at_rocket.L[5 * u->n + j]);
        a = v3_add(a, v3_cross(alpha, Ad));
        double column[6] = {a.x, a.y, a.z, alpha.x, alpha.y, alpha.z};
        for (int i = 0; i < 6; i++)
            k->X[i * u->n + j] = column[i];
    }
    // Y = [t + Jl k0 x A d, A e_y, A e_z, 0; Jl k0, 0, 0, A]
    v3 twist = m3_apply(s->Jl, s->k0), column = v3_add(s->t, v3_cross(twist, Ad));
    memset(k->Y, 0, sizeof k->Y);
    double first[6] = {column.x, column.y, column.z, twist.x, twist.y, twist.z};
    for (int i = 0; i < 6; i++)
        k->Y[i][0] = first[i];
    for (int i = 0; i < 3; i++) {
        k->Y[i][1] = s->A.a[i][1];
        k->Y[i][2] = s->A.a[i][2];
        for (int j = 0; j < 3; j++)
            k->Y[3 + i][3 + j] = s->A.a[i][j];
    }
    // b: everything that speeds alone make
    v3 P2 = v3_zero(), Psi2 = v3_zero(); // beyond the ends the axis is straight
    if (s->beyond == 0) {
        P2 = v3_make(0, poly2(rocket->motion.y, s->xi), poly2(rocket->motion.z, s->xi));
        Psi2 = v3_make(0, -6 * rocket->motion.z[3], 6 * rocket->motion.y[3]);
    }
    v3 th_dot = v3_axpy(r->th_dot, s_dot, s->k0);
    v3 d_dot = m3_apply(s->A, v3_make(0, rocket->y_dot, rocket->z_dot));
    v3 Om = rocket->Om;
    v3 Om_dot = m3_apply(s->Jl, v3_axpy(v3_scale(2 * s_dot, r->k0_dot), s_dot * s_dot, Psi2));
    Om_dot = v3_add(Om_dot, rv_left_jacobian_derivative(s->th, th_dot, th_dot));
    v3 u1 = v3_add(v3_axpy(r->u_dot, s_dot, s->t), v3_add(v3_cross(Om, Ad), d_dot));
    v3 a = v3_add(v3_cross(w, v3_cross(w, rocket->p1)), v3_scale(2, v3_cross(w, u1)));
    a = v3_add(a, v3_axpy(v3_scale(2 * s_dot, r->u1_dot), s_dot * s_dot, P2));
    a = v3_add(a, v3_add(v3_cross(Om_dot, Ad), v3_cross(Om, v3_cross(Om, Ad))));
    a = v3_add(a, v3_scale(2, v3_cross(Om, d_dot)));
    v3 Aw = m3_apply(s->A, rocket->w_SB);
    v3 alpha = v3_add(Om_dot, v3_add(v3_cross(w, v3_add(Om, Aw)), v3_cross(Om, Aw)));
    v3_store(k->b, a);
    v3_store(k->b + 3, alpha);
}

// Tail and tube as one transfer matrix from the tail's mass centre to the tip; columns of the
// constraint directions apart. `input` gives the wrench on the tube's rear end from the tail.
typedef struct tube_transfer {
    transfer_matrix tail, whole;
    double direction[MAX_CONSTRAINTS][TRANSFER_ROWS]; // column of N for each direction
    double condition;
} tube_transfer;

static ld_status load_transfer(const launching_system *self, const uncoupled *u, int count,
                               double B[][SPEEDS], tube_transfer *transfer)
{
    const ld_tail *tail = &self->model->tubes.tail;
    rigid_body body = {.mass = tail->mass,
                       .inertia =
                           m3_diagonal(tail->inertia[0], tail->inertia[1], tail->inertia[2])};
    rigid_body_transfer(&transfer->tail, &body, v3_make(-tail->center, 0, 0), u->now.tube.w,
                        u->now.tube.g, v3_zero(), v3_zero());
    for (int i = 0; i < (count ? count : 1); i++) {
        transfer_matrix U;
        flexible_body tube = {.n = u->n,
                              .M = u->M,
                              .h = u->h,
                              .B = count ? B[i] : NULL,
                              .L_I = u->rear->L,
                              .L_O = u->tip->L,
                              .gamma_I = u->rear->gamma,
                              .gamma_O = u->tip->gamma};
        ld_status status = flexible_body_transfer(&U, &tube, &transfer->condition, NULL);
        if (status)
            return status;
        transfer_multiply(&transfer->whole, &U, &transfer->tail);
        for (int row = 0; row < TRANSFER_ROWS; row++)
            if (count)
                transfer->direction[i][row] = U.u[row][TRANSFER_N];
    }
    return LD_OK;
}

// eta_dot as an affine function of the unknowns: eta_dot = Q (h + L_I^T F_I - B x), with the wrench
// F_I = (f, m) that the tail hands on, linear in the accelerations of its free end.
typedef struct tube_solution {
    double constant[SPEEDS];
    double end[6][SPEEDS];                     // per unknown acceleration of the tail's end
    double direction[MAX_CONSTRAINTS][SPEEDS]; // per constraint force
} tube_solution;

// On a frame of its own: the matrix is large.
__attribute__((noinline)) static bool load_solution(const uncoupled *u, int count,
                                                    double B[][SPEEDS],
                                                    const tube_transfer *transfer,
                                                    tube_solution *solution)
{
    int n = u->n;
    double G[SPEEDS * SPEEDS];
    memcpy(G, u->M, sizeof(double) * (size_t)(n * n));
    if (cholesky_factor(n, G))
        return false;
    for (int column = 0; column < 7; column++) {
        int from = column < 6 ? column : TRANSFER_ONE;
        double *to = column < 6 ? solution->end[column] : solution->constant;
        for (int j = 0; j < n; j++) {
            to[j] = column < 6 ? 0 : u->h[j];
            for (int i = 0; i < 3; i++)
                to[j] += u->rear->L[i * n + j] * transfer->tail.u[TRANSFER_F + i][from] +
                         u->rear->L[(3 + i) * n + j] * transfer->tail.u[TRANSFER_M + i][from];
        }
        cholesky_solve(n, G, to);
    }
    for (int i = 0; i < count; i++) {
        for (int j = 0; j < n; j++)
            solution->direction[i][j] = -B[i][j];
        cholesky_solve(n, G, solution->direction[i]);
    }
    return true;
}

// Rows of the overall equation (Eq. 78 of the paper, with the rocket): unknowns are the
// accelerations of the tail's end (6) and of the tip (6), y_dot (6) and the constraint forces.
static void fill_tube_rows(int size, int count, const tube_transfer *transfer, double *A, double *b)
{
    for (int i = 0; i < 12; i++) {
        // at the tip: accelerations as unknown, wrench zero
        int row = i < 6 ? i : i - 6 + TRANSFER_M;
        for (int j = 0; j < 6; j++)
            A[i * size + j] = transfer->whole.u[row][j];
        if (i < 6)
            A[i * size + 6 + i] = -1;
        for (int k = 0; k < count; k++)
            A[i * size + 18 + k] = transfer->direction[k][row];
        b[i] = -transfer->whole.u[row][TRANSFER_ONE];
    }
}

static void fill_rocket_rows(int size, int count, const uncoupled *u, const relative_kinematics *k,
                             const tube_solution *solution, double G[][6], double *A, double *b)
{
    int n = u->n;
    // M3 about O1, in R
    double M3[6][6] = {{0}};
    v3 c = u->now.inertia.c;
    m3 mc = m3_scale(u->now.inertia.m, m3_skew(c));
    m3 J = m3_mul(u->now.inertia.A_RB, m3_mul(u->now.inertia.J, m3_transpose(u->now.inertia.A_RB)));
    J = m3_sub(J, m3_mul(mc, m3_skew(c)));
    for (int i = 0; i < 3; i++) {
        M3[i][i] = u->now.inertia.m;
        for (int j = 0; j < 3; j++) {
            M3[i][3 + j] = -mc.a[i][j];
            M3[3 + i][j] = mc.a[i][j];
            M3[3 + i][3 + j] = J.a[i][j];
        }
    }
    double h3[6];
    v3_store(h3, u->now.f);
    v3_store(h3 + 3, u->now.m);
    // accelerations of the rocket by unknown: columns of the tail's end, y_dot, forces; constant
    double V[6][MAX_UNKNOWNS] = {{0}}, V_0[6];
    for (int i = 0; i < 6; i++) {
        const double *X = k->X + i * n;
        V_0[i] = k->b[i] + dot(n, X, solution->constant);
        for (int j = 0; j < 6; j++) {
            V[i][j] = dot(n, X, solution->end[j]);
            V[i][12 + j] = k->Y[i][j];
        }
        for (int j = 0; j < count; j++)
            V[i][18 + j] = dot(n, X, solution->direction[j]);
    }
    for (int i = 0; i < 6; i++) {
        double *row = A + (12 + i) * size;
        b[12 + i] = h3[i];
        for (int l = 0; l < 6; l++) {
            b[12 + i] -= M3[i][l] * V_0[l];
            for (int j = 0; j < size; j++)
                row[j] += M3[i][l] * V[l][j];
        }
        for (int j = 0; j < count; j++)
            row[18 + j] -= G[j][i];
    }
}

// What a constraint on another section than the rocket's has of the tube's accelerations:
// (G^T X - B^T) eta_dot, which is 0 at the rocket's.
static void add_other_section(int size, int count, int i, const uncoupled *u, const double G[6],
                              const relative_kinematics *k, const tube_solution *solution,
                              double *A, double *b)
{
    int n = u->n;
    double row[SPEEDS];
    for (int j = 0; j < n; j++) {
        row[j] = -u->B[i][j];
        for (int l = 0; l < 6; l++)
            row[j] += G[l] * k->X[l * n + j];
    }
    b[18 + i] -= dot(n, row, solution->constant);
    for (int j = 0; j < 6; j++)
        A[(18 + i) * size + j] = dot(n, row, solution->end[j]);
    for (int j = 0; j < count; j++)
        A[(18 + i) * size + 18 + j] = dot(n, row, solution->direction[j]);
}

// G^T Y y_dot = -(beta + G^T b) of each constraint: c_y^T y_dot = -c_y_dot^T y.
static void fill_constraint_rows(int size, int count, const uncoupled *u,
                                 const relative_kinematics *k, const tube_solution *solution,
                                 double *A, double *b)
{
    for (int i = 0; i < count; i++) {
        const constraint_direction *e = &u->c.set.e[i];
        double G[6];
        v3_store(G, e->G_f);
        v3_store(G + 3, e->G_m);
        b[18 + i] = -(e->beta + dot(6, G, k->b));
        for (int j = 0; j < 6; j++)
            for (int l = 0; l < 6; l++)
                A[(18 + i) * size + 12 + j] += G[l] * k->Y[l][j];
        if (e->section > 0)
            add_other_section(size, count, i, u, G, k, solution, A, b);
    }
}

// One solve, with the slot's friction for the given sign of N (0: none). False: singular, or the
// tube's transfer matrix does not hold.
static bool solve_overall(const launching_system *self, const double *state, uncoupled *u, int sign,
                          launching_output *out)
{
    int count = u->c.set.count, size = 18 + count, n = u->n;
    double A[MAX_UNKNOWNS * MAX_UNKNOWNS] = {0}, x[MAX_UNKNOWNS] = {0};
    double B[MAX_CONSTRAINTS][SPEEDS], G[MAX_CONSTRAINTS][6];
    double rub = sign * (u->c.set.sliding ? u->c.set.rub : 0);
    for (int i = 0; i < count; i++) {
        memcpy(B[i], u->B[i], sizeof(double) * (size_t)n);
        v3_store(G[i], u->c.set.e[i].G_f);
        v3_store(G[i] + 3, u->c.set.e[i].G_m);
    }
    if (rub != 0) { // friction rides on N: G = G_n - rub G_tau, B alike
        const constraint_direction *tangent = &u->c.set.tangent;
        v3_store(G[0], v3_axpy(u->c.set.e[0].G_f, -rub, tangent->G_f));
        v3_store(G[0] + 3, v3_axpy(u->c.set.e[0].G_m, -rub, tangent->G_m));
        for (int j = 0; j < n; j++)
            B[0][j] -= rub * u->B[MAX_CONSTRAINTS][j];
    }
    tube_transfer transfer;
    tube_solution solution;
    relative_kinematics k;
    int pivot[MAX_UNKNOWNS];
    if (load_transfer(self, u, count, B, &transfer) ||
        !load_solution(u, count, B, &transfer, &solution))
        return false;
    load_relative(self, state, u, &k);
    fill_tube_rows(size, count, &transfer, A, x);
    fill_rocket_rows(size, count, u, &k, &solution, G, A, x);
    fill_constraint_rows(size, count, u, &k, &solution, A, x);
    if (lu_factor(size, A, pivot))
        return false;
    lu_solve(size, A, pivot, x);
    // back to the accelerations
    double eta_dot[SPEEDS], V[6];
    for (int j = 0; j < n; j++) {
        eta_dot[j] = solution.constant[j];
        for (int i = 0; i < 6; i++)
            eta_dot[j] += solution.end[i][j] * x[i];
        for (int i = 0; i < count; i++)
            eta_dot[j] += solution.direction[i][j] * x[18 + i];
    }
    for (int i = 0; i < 6; i++)
        V[i] = k.b[i] + dot(n, k.X + i * n, eta_dot) + dot(6, k.Y[i], x + 12);
    store_tube(n, eta_dot, out);
    out->a_O1 = v3_from(V);
    out->alpha_B = v3_from(V + 3);
    memcpy(out->y_dot, x + 12, sizeof out->y_dot);
    memcpy(u->c.set.x, x + 18, sizeof(double) * (size_t)count);
    u->c.set.friction = -rub * x[18];
    out->condition = transfer.condition;
    launching_report(u->now.phase->rocket, true, self, &u->now, &u->c.set, out);
    return true;
}

// Out of line: what it needs on the stack is not there where the reduced form alone is solved.
LD_OUTLINE launching_outcome evaluate_overall(const launching_system *self,
                                              const launching_phase *phase, const double *state,
                                              uncoupled *u, launching_output *out)
{
    const flexible_tube *tube = &self->tube.flexible;
    const double *q = state + self->layout.q, *q_dot = state + self->layout.q_dot;
    tube_section_state rear, tip;
    tube_section(tube, 0, u->now.tube.w, q, q_dot, &rear);
    tube_section(tube, tube->length, u->now.tube.w, q, q_dot, &tip);
    u->rear = &rear;
    u->tip = &tip;
    if (!u->c.set.sliding) {
        if (solve_overall(self, state, u, 0, out))
            return LAUNCHING_OK;
    } else {
        // the consistent one of the two signs of N
        bool plus = solve_overall(self, state, u, 1, out);
        if (plus && out->N >= 0)
            return LAUNCHING_OK;
        if (plus && solve_overall(self, state, u, -1, out))
            return out->N <= 0 ? LAUNCHING_OK : LAUNCHING_JAMMED;
    }
    out->fell_back = true;
    return solve_reduced(self, phase, u, out);
}

// Whether the reduced form finds that the knob jams. Out of line: its outputs are not on the stack
// together with the matrices.
LD_OUTLINE bool jams_reduced(const launching_system *self, const launching_input *input,
                             const launching_phase *phase, const double *state)
{
    launching_output reduced;
    launching_input apart = *input;
    apart.record = NULL;
    return launching_evaluate(self, &apart, phase, state, &reduced) == LAUNCHING_JAMMED;
}

launching_outcome launching_evaluate_general(const launching_system *self,
                                             ld_formulation formulation,
                                             const launching_input *input,
                                             const launching_phase *phase, const double *state,
                                             launching_output *out)
{
    uncoupled u;
    launching_outcome outcome;
    load_uncoupled(self, input, phase, state, &u, out);
    out->fell_back = false;
    out->condition = 0;
    if (formulation == LD_FORMULATION_OVERALL && phase->rocket) {
        // where both signs of N are consistent the knob jams too, which one solve does not show
        if (u.c.set.sliding && jams_reduced(self, input, phase, state))
            return LAUNCHING_JAMMED;
        outcome = evaluate_overall(self, phase, state, &u, out);
    } else {
        outcome = solve_reduced(self, phase, &u, out);
    }
    constraints_record(&u.now, &u.c.set);
    return outcome;
}
