#include "systems/launching/launching_overall.h"

#include "elements/tube/transfer.h"
#include "math/matrices/dense.h"
#include "model/parts.h"
#include "systems/launching/launching_dynamics.h"
#include "systems/launching/launching_general.h"

enum {
    MAX_UNKNOWNS = 18 + LD_MAX_CONSTRAINTS, // accelerations of both ends, y_dot, constraint forces
};

// The rocket's relative kinematics [a_O1; alpha_B] = X eta_dot + Y y_dot + b (formulation.md,
// section 3), with the curvature's change along the tube.
typedef struct relative_kinematics {
    double X[6 * LD_TUBE_SPEEDS], Y[6][6], b[6];
} relative_kinematics;

static void load_relative(const launching_system *self, const double *state,
                          const launching_uncoupled *u, relative_kinematics *k)
{
    const launching_layout *at = &self->layout;
    const rocket_state *rocket = &u->now.rocket;
    const axis_section *s = &rocket->at;
    const section_rates *r = &rocket->rates;
    tube_section_state at_rocket;
    v3 w = u->now.tube.w, Ad = rocket->Ad;
    double s_dot = rocket->s_dot;
    const guide_station station = {&self->tube.flexible, rocket->motion.initial, rocket->s};
    guide_section(&station, w, state + at->q, state + at->q_dot, &at_rocket);
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
        if (rocket->motion.shortened)
            P2.x = shortened_bend(&rocket->motion, s->xi);
        Psi2 = v3_make(0, -6 * rocket->motion.z[3], 6 * rocket->motion.y[3]);
        if (rocket->motion.initial) {
            initial_section initial;
            initial_shape_at(rocket->motion.initial, rocket->s, &initial);
            P2 = v3_add(P2, initial.P2);
            Psi2 = v3_add(Psi2, initial.th2);
        }
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
    if (rocket->motion.shortened)
        a.x += shortened_to(&rocket->motion, s->xi).pull;
    v3 Aw = m3_apply(s->A, rocket->w_SB);
    v3 alpha = v3_add(Om_dot, v3_add(v3_cross(w, v3_add(Om, Aw)), v3_cross(Om, Aw)));
    v3_store(k->b, a);
    v3_store(k->b + 3, alpha);
}

// Tail and tube as one transfer matrix from the tail's mass centre to the tip; columns of the
// constraint directions apart. `input` gives the wrench on the tube's rear end from the tail.
typedef struct tube_transfer {
    transfer_matrix tail, whole;
    double direction[LD_MAX_CONSTRAINTS][TRANSFER_ROWS]; // column of N for each direction
    double condition;
} tube_transfer;

static ld_status load_transfer(const launching_system *self, const launching_uncoupled *u,
                               int count, double B[][LD_TUBE_SPEEDS], tube_transfer *transfer)
{
    const ld_tail *tail = &model_tubes(self->model)->tail;
    rigid_body body = {.mass = tail->mass,
                       .inertia = m3_diagonal(tail->inertia[0], tail->inertia[1], tail->inertia[2]),
                       .output = v3_make(-tail->center, 0, 0)};
    rigid_body_transfer(&transfer->tail, &body, u->now.tube.w, u->now.tube.g, v3_zero(), v3_zero());
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
    double constant[LD_TUBE_SPEEDS];
    double end[6][LD_TUBE_SPEEDS]; // per unknown acceleration of the tail's end
    double direction[LD_MAX_CONSTRAINTS][LD_TUBE_SPEEDS]; // per constraint force
} tube_solution;

// On a frame of its own: the matrix is large.
__attribute__((noinline)) static bool load_solution(const launching_uncoupled *u, int count,
                                                    double B[][LD_TUBE_SPEEDS],
                                                    const tube_transfer *transfer,
                                                    tube_solution *solution)
{
    int n = u->n;
    double G[LD_TUBE_SPEEDS * LD_TUBE_SPEEDS];
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

// The overall equation A x = b (Eq. 78 of the paper, with the rocket): unknowns are the
// accelerations of the tail's end (6) and of the tip (6), y_dot (6) and the constraint forces.
typedef struct overall_equation {
    int size, count;                 // unknowns, and of them constraint forces
    double G[LD_MAX_CONSTRAINTS][6]; // wrench of each constraint on the rocket, with friction
    double A[MAX_UNKNOWNS * MAX_UNKNOWNS], b[MAX_UNKNOWNS];
} overall_equation;

static void fill_tube_rows(const tube_transfer *transfer, overall_equation *to)
{
    int size = to->size, count = to->count;
    double *A = to->A, *b = to->b;
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

static void fill_rocket_rows(const launching_uncoupled *u, const relative_kinematics *k,
                             const tube_solution *solution, overall_equation *to)
{
    int n = u->n, size = to->size, count = to->count;
    double *b = to->b;
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
        V_0[i] = k->b[i] + launching_dot(n, X, solution->constant);
        for (int j = 0; j < 6; j++) {
            V[i][j] = launching_dot(n, X, solution->end[j]);
            V[i][12 + j] = k->Y[i][j];
        }
        for (int j = 0; j < count; j++)
            V[i][18 + j] = launching_dot(n, X, solution->direction[j]);
    }
    for (int i = 0; i < 6; i++) {
        double *row = to->A + (12 + i) * size;
        b[12 + i] = h3[i];
        for (int l = 0; l < 6; l++) {
            b[12 + i] -= M3[i][l] * V_0[l];
            for (int j = 0; j < size; j++)
                row[j] += M3[i][l] * V[l][j];
        }
        for (int j = 0; j < count; j++)
            row[18 + j] -= to->G[j][i];
    }
}

// What constraint i, of wrench G, on another section than the rocket's has of the tube's
// accelerations: (G^T X - B^T) eta_dot, which is 0 at the rocket's.
static void add_other_section(const launching_uncoupled *u, const relative_kinematics *k,
                              const tube_solution *solution, int i, const double G[6],
                              overall_equation *to)
{
    int n = u->n;
    double row[LD_TUBE_SPEEDS], *of_A = to->A + (18 + i) * to->size;
    for (int j = 0; j < n; j++) {
        row[j] = -u->B[i][j];
        for (int l = 0; l < 6; l++)
            row[j] += G[l] * k->X[l * n + j];
    }
    to->b[18 + i] -= launching_dot(n, row, solution->constant);
    for (int j = 0; j < 6; j++)
        of_A[j] = launching_dot(n, row, solution->end[j]);
    for (int j = 0; j < to->count; j++)
        of_A[18 + j] = launching_dot(n, row, solution->direction[j]);
}

// G^T Y y_dot = -(beta + G^T b) of each constraint: c_y^T y_dot = -c_y_dot^T y.
static void fill_constraint_rows(const launching_uncoupled *u, const relative_kinematics *k,
                                 const tube_solution *solution, overall_equation *to)
{
    for (int i = 0; i < to->count; i++) {
        const constraint_direction *e = &u->c.set.e[i];
        double G[6];
        v3_store(G, e->G_f);
        v3_store(G + 3, e->G_m);
        to->b[18 + i] = -(e->beta + launching_dot(6, G, k->b));
        for (int j = 0; j < 6; j++)
            for (int l = 0; l < 6; l++)
                to->A[(18 + i) * to->size + 12 + j] += G[l] * k->Y[l][j];
        if (e->section > 0)
            add_other_section(u, k, solution, i, G, to);
    }
}

// One solve, with the slot's friction for the given sign of N (0: none). False: singular, or the
// tube's transfer matrix does not hold.
static bool solve_overall(const launching_system *self, const double *state, launching_uncoupled *u,
                          int sign, launching_output *out)
{
    int count = u->c.set.count, n = u->n;
    overall_equation equation = {.size = 18 + count, .count = count};
    double B[LD_MAX_CONSTRAINTS][LD_TUBE_SPEEDS], (*G)[6] = equation.G, *x = equation.b;
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
            B[0][j] -= rub * u->B[LD_MAX_CONSTRAINTS][j];
    }
    tube_transfer transfer;
    tube_solution solution;
    relative_kinematics k;
    int pivot[MAX_UNKNOWNS];
    if (load_transfer(self, u, count, B, &transfer) ||
        !load_solution(u, count, B, &transfer, &solution))
        return false;
    load_relative(self, state, u, &k);
    fill_tube_rows(&transfer, &equation);
    fill_rocket_rows(u, &k, &solution, &equation);
    fill_constraint_rows(u, &k, &solution, &equation);
    if (lu_factor(equation.size, equation.A, pivot))
        return false;
    lu_solve(equation.size, equation.A, pivot, x);
    // back to the accelerations
    double eta_dot[LD_TUBE_SPEEDS], V[6];
    for (int j = 0; j < n; j++) {
        eta_dot[j] = solution.constant[j];
        for (int i = 0; i < 6; i++)
            eta_dot[j] += solution.end[i][j] * x[i];
        for (int i = 0; i < count; i++)
            eta_dot[j] += solution.direction[i][j] * x[18 + i];
    }
    for (int i = 0; i < 6; i++)
        V[i] = k.b[i] + launching_dot(n, k.X + i * n, eta_dot) + launching_dot(6, k.Y[i], x + 12);
    launching_store_tube(n, eta_dot, out);
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
                                              launching_uncoupled *u, launching_output *out)
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
    return launching_solve_reduced(self, phase, u, out);
}

// Whether the reduced form finds that the knob jams. Out of line: its outputs are not on the stack
// together with the matrices.
LD_OUTLINE bool jams_reduced(const launching_system *self, const launching_input *input,
                             const launching_phase *phase, const double *state)
{
    launching_output reduced;
    launching_input planes_differ = *input;
    planes_differ.record = NULL;
    return launching_evaluate(self, &planes_differ, phase, state, &reduced) == LAUNCHING_JAMMED;
}

launching_outcome launching_evaluate_overall(const launching_system *self,
                                             const launching_input *input,
                                             const launching_phase *phase, const double *state,
                                             launching_output *out)
{
    launching_uncoupled u;
    if (!phase->rocket)
        return launching_evaluate_general(self, input, phase, state, out);
    launching_uncouple(self, input, phase, state, &u, out);
    // where both signs of N are consistent the knob jams too, which one solve does not show
    if (u.c.set.sliding && jams_reduced(self, input, phase, state))
        return LAUNCHING_JAMMED;
    launching_outcome outcome = evaluate_overall(self, phase, state, &u, out);
    constraints_record(&u.now, &u.c.set);
    return outcome;
}
