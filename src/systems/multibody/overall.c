// The overall transfer equation (formulation.md, section 2): state vectors from the ground outwards
// through the elements' 13 x 13 matrices, as affine functions of what is unknown at the start; the
// tips, where the wrench vanishes, and the hinges, where it is known along the axes, close them.
//
// Unknown are the wrench at every hinge on the ground (and, at a branching body, of every child but
// the last) and the hinge accelerations. The paper's form eliminates these one by one: each by the
// next equation of a hinge met on the way outwards.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "elements/tube/transfer.h"
#include "math/matrices/dense.h"
#include "systems/multibody/multibody.h"

enum { ROWS = TRANSFER_ROWS };

// Columns 0 .. n - 1 belong to the unknowns, column n is what is known.
typedef struct overall {
    ld_mstmm *system;
    const double *q, *u, *tau, *wrench;
    bool paper;
    int n, width;
    int unknowns;      // given out so far
    int *rate_unknown; // unknown of each speed
    double *state;     // [node][ROWS][width] at a node's input after its hinge
    double *equation;  // [n][width], sum over unknowns + known = 0
    int equation_count;
    double *rule;    // [n][width]: the eliminated unknown as a row of the others and 1
    int *eliminated; // the unknown of each rule
    bool *gone;      // unknown is eliminated
    int rule_count;
    int *children_left; // of each node
} overall;

static double *state_of(const overall *o, int i)
{
    return o->state + (size_t)i * ROWS * (size_t)o->width;
}

// row of z as a row of the state matrix
static double *row_of(const overall *o, int i, int row)
{
    return state_of(o, i) + (size_t)row * (size_t)o->width;
}

// target += s source, over the whole width
static void add_row(const overall *o, double *target, double s, const double *source)
{
    for (int k = 0; k < o->width; k++)
        target[k] += s * source[k];
}

// Replaces unknown p in a row by its rule.
static void substitute(const overall *o, double *row, int rule)
{
    int p = o->eliminated[rule];
    double factor = row[p];
    if (factor == 0)
        return;
    row[p] = 0;
    add_row(o, row, factor, o->rule + (size_t)rule * (size_t)o->width);
}

// z := U z for the columns of node i's state.
static void apply(const overall *o, int from, int to, const transfer_matrix *U)
{
    for (int k = 0; k < o->width; k++) {
        double z[ROWS], out[ROWS];
        for (int r = 0; r < ROWS; r++)
            z[r] = row_of(o, from, r)[k];
        transfer_apply(out, U, z, 0);
        for (int r = 0; r < ROWS; r++)
            row_of(o, to, r)[k] = out[r];
    }
}

// One row of a hinge: the wrench along e equals tau. The paper's form spends it on a hinge
// acceleration met before; otherwise it stays an equation.
static void close_axis(overall *o, int i, int first_row, v3 e, double tau)
{
    double *row = o->equation + (size_t)o->equation_count * (size_t)o->width;
    memset(row, 0, (size_t)o->width * sizeof *row);
    add_row(o, row, e.x, row_of(o, i, first_row));
    add_row(o, row, e.y, row_of(o, i, first_row + 1));
    add_row(o, row, e.z, row_of(o, i, first_row + 2));
    row[o->n] -= tau;

    // the largest hinge acceleration in it
    int pivot = -1;
    for (int k = 0; o->paper && k < o->system->u_count; k++) {
        int p = o->rate_unknown[k];
        if (p >= 0 && !o->gone[p] && row[p] != 0 && (pivot < 0 || fabs(row[p]) > fabs(row[pivot])))
            pivot = p;
    }
    if (pivot < 0) {
        o->equation_count++;
        return;
    }
    double *rule = o->rule + (size_t)o->rule_count * (size_t)o->width;
    for (int k = 0; k < o->width; k++)
        rule[k] = k == pivot ? 0 : -row[k] / row[pivot];
    o->eliminated[o->rule_count] = pivot;
    o->gone[pivot] = true;
    o->rule_count++;
    for (int r = 0; r < ROWS; r++)
        substitute(o, row_of(o, i, r), o->rule_count - 1);
}

// A hinge acceleration along e as a new unknown of the state.
static void open_axis(overall *o, int i, int first_row, v3 e, int speed)
{
    int p = o->unknowns++;
    double along[3] = {e.x, e.y, e.z};
    o->rate_unknown[speed] = p;
    for (int r = 0; r < 3; r++)
        row_of(o, i, first_row + r)[p] += along[r];
}

// Through the hinge of node i: its equations first, then its accelerations and bias, and what is
// applied to its body.
static void cross_hinge(overall *o, int i)
{
    const ld_mstmm *s = o->system;
    const node *n = &s->node[i];
    const node_motion *m = &s->motion[i];
    m3 A = node_axes(s, i), H = node_hinge_axes(s, i);
    int slides = n->hinge == NODE_FREE ? 3 : n->hinge == NODE_SLIDE;
    int turns = n->hinge == NODE_FREE || n->hinge == NODE_BALL ? 3 : n->hinge == NODE_TURN;
    bool single = slides + turns == 1;
    for (int pass = 0; pass < 2; pass++)
        for (int k = 0; k < slides + turns; k++) {
            bool turn = k >= slides;
            v3 e = single ? m3_column(A, 2) : turn ? m3_column(A, k - slides) : m3_column(H, k);
            if (pass == 0)
                close_axis(o, i, turn ? TRANSFER_M : TRANSFER_F, e, o->tau[n->u + k]);
            else
                open_axis(o, i, turn ? TRANSFER_ALPHA : TRANSFER_A, e, n->u + k);
        }
    // what the bias has beyond the parent's own w x (w x r)
    v3 w = v4d_v3(s->motion[n->parent].w), r = v4d_v3(m->r);
    v3 a = v3_sub(v4d_v3(m->bias_a), v3_cross(w, v3_cross(w, r))), alpha = v4d_v3(m->bias_alpha);
    double bias[6] = {a.x, a.y, a.z, alpha.x, alpha.y, alpha.z};
    for (int k = 0; k < 6 && n->body != NODE_SECTION; k++)
        row_of(o, i, TRANSFER_A + k)[o->n] += bias[k];
    const double *applied = o->wrench && n->element >= 0 ? o->wrench + 6 * n->element : NULL;
    for (int k = 0; applied && k < 3; k++) {
        row_of(o, i, TRANSFER_F + k)[o->n] += applied[k];
        row_of(o, i, TRANSFER_M + k)[o->n] += applied[3 + k];
    }
}

// A new unknown wrench on node i; on the parent's body it acts the other way round, at r.
static void open_wrench(overall *o, int i, int parent, v3 r)
{
    m3 skew = m3_skew(r);
    for (int k = 0; k < 3; k++) {
        int f = o->unknowns++, m = o->unknowns++;
        row_of(o, i, TRANSFER_F + k)[f] = 1;
        row_of(o, i, TRANSFER_M + k)[m] = 1;
        if (parent) {
            row_of(o, parent, TRANSFER_F + k)[f] -= 1;
            row_of(o, parent, TRANSFER_M + k)[m] -= 1;
            for (int j = 0; j < 3; j++)
                row_of(o, parent, TRANSFER_M + j)[f] -= skew.a[j][k];
        }
    }
}

// U of a node's rigid body to the point r.
static void body_transfer(const overall *o, int i, v3 r, transfer_matrix *U)
{
    const ld_mstmm *s = o->system;
    const node_inertia *given = &s->inertia[i];
    m3 A = node_axes(s, i);
    double m = given->mass;
    v3 c = m > 0 ? v3_scale(1 / m, m3_apply(A, given->moment)) : v3_zero();
    rigid_body body = {m, c, sym3_full(sym3_turn(A, given->inertia)), r};
    rigid_body_transfer(U, &body, v4d_v3(s->motion[i].w), v3_zero(), v3_zero(), v3_zero());
}

// The beam's U from its input to its output section (its tip where it carries nothing), all along
// R's axes.
static ld_status beam_transfer(overall *o, int i, transfer_matrix *U, ld_error *error)
{
    ld_mstmm *s = o->system;
    const node_beam *b = &s->beam_of[i];
    beam *body = b->body;
    int n = body->n;
    double L_I[6 * LD_TUBE_SPEEDS] = {0}, gamma_I[6] = {0};
    for (int k = 0; k < 6; k++)
        L_I[k * n + k] = 1;
    for (int k = 0; k < body->modes; k++)
        body->h[6 + k] += o->tau[b->modes_u + k];
    tube_section_state out;
    tube_section(&body->tube, body->output_count ? body->output[0].station : body->tube.length,
                 body->w, o->q + b->modes_q, o->u + b->modes_u, &out);
    flexible_body given = {n, body->M, body->h, NULL, L_I, out.L, gamma_I, out.gamma};
    return flexible_body_transfer(U, &given, NULL, error);
}

// All state rows from inertial to R axes or back.
static void turn_state(const overall *o, int i, m3 A)
{
    for (int k = 0; k < o->width; k++)
        for (int block = 0; block < 12; block += 3) {
            v3 part = v3_make(row_of(o, i, block)[k], row_of(o, i, block + 1)[k],
                              row_of(o, i, block + 2)[k]);
            double turned[3];
            v3_store(turned, m3_apply(A, part));
            for (int r = 0; r < 3; r++)
                row_of(o, i, block + r)[k] = turned[r];
        }
}

// The state at node i's input, before its hinge.
static ld_status enter_node(overall *o, int i, ld_error *error)
{
    ld_mstmm *s = o->system;
    const node *n = &s->node[i];
    v3 r = v4d_v3(s->motion[i].r);
    transfer_matrix U;
    size_t size = (size_t)(ROWS * o->width) * sizeof(double);
    if (n->parent == 0) {
        v3 a = s->base.linear;
        memset(state_of(o, i), 0, size);
        row_of(o, i, TRANSFER_A)[o->n] = a.x;
        row_of(o, i, TRANSFER_A + 1)[o->n] = a.y;
        row_of(o, i, TRANSFER_A + 2)[o->n] = a.z;
        row_of(o, i, TRANSFER_ONE)[o->n] = 1;
        open_wrench(o, i, 0, r);
        return LD_OK;
    }
    for (int rule = 0; rule < o->rule_count; rule++)
        for (int row = 0; row < ROWS; row++)
            substitute(o, row_of(o, n->parent, row), rule);
    if (n->body == NODE_SECTION) {
        ld_status status = beam_transfer(o, n->parent, &U, error);
        if (status)
            return status;
        m3 A_R = node_body_axes(s, n->parent);
        memcpy(state_of(o, i), state_of(o, n->parent), size);
        turn_state(o, i, m3_transpose(A_R));
        apply(o, i, i, &U);
        turn_state(o, i, A_R);
        return LD_OK;
    }
    body_transfer(o, n->parent, r, &U);
    apply(o, n->parent, i, &U);
    if (--o->children_left[n->parent] > 0) {
        // not the last child: its wrench is unknown
        for (int row = TRANSFER_M; row < TRANSFER_ONE; row++)
            memset(row_of(o, i, row), 0, (size_t)o->width * sizeof(double));
        open_wrench(o, i, n->parent, r);
    }
    return LD_OK;
}

// A tip: no wrench beyond it. The ground's state serves as scratch.
static ld_status leave_node(overall *o, int i, ld_error *error)
{
    transfer_matrix U;
    memcpy(state_of(o, 0), state_of(o, i), (size_t)(ROWS * o->width) * sizeof(double));
    if (o->system->node[i].body == NODE_BEAM) {
        ld_status status = beam_transfer(o, i, &U, error);
        if (status)
            return status;
        turn_state(o, 0, m3_transpose(node_body_axes(o->system, i)));
    } else {
        body_transfer(o, i, v3_zero(), &U);
    }
    apply(o, 0, 0, &U);
    for (int k = 0; k < 6; k++)
        memcpy(o->equation + (size_t)o->equation_count++ * (size_t)o->width,
               row_of(o, 0, TRANSFER_M + k), (size_t)o->width * sizeof(double));
    return LD_OK;
}

// Solves the equations left and puts the eliminated unknowns back; x [n].
static ld_status solve(overall *o, double *x, ld_error *error)
{
    int left = 0, *index = malloc(((size_t)o->n * 2 + 1) * sizeof *index);
    size_t count = (size_t)o->equation_count;
    double *A = malloc((count * (count + 1) + 1) * sizeof *A);
    if (!index || !A) {
        free(index);
        free(A);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the overall equation");
    }
    for (int p = 0; p < o->n; p++)
        if (!o->gone[p])
            index[left++] = p;
    double *b = A + (size_t)left * (size_t)left;
    for (int e = 0; e < o->equation_count; e++) {
        double *row = o->equation + (size_t)e * (size_t)o->width;
        for (int rule = 0; rule < o->rule_count; rule++)
            substitute(o, row, rule);
        for (int k = 0; k < left; k++)
            A[e * left + k] = row[index[k]];
        b[e] = -row[o->n];
    }
    int singular = left != o->equation_count || lu_factor(left, A, index + o->n);
    if (!singular) {
        lu_solve(left, A, index + o->n, b);
        for (int k = 0; k < left; k++)
            x[index[k]] = b[k];
        for (int rule = o->rule_count - 1; rule >= 0; rule--) {
            const double *row = o->rule + (size_t)rule * (size_t)o->width;
            double sum = row[o->n];
            for (int p = 0; p < o->n; p++)
                if (row[p] != 0)
                    sum += row[p] * x[p];
            x[o->eliminated[rule]] = sum;
        }
    }
    free(index);
    free(A);
    return singular ? ld_fail(error, LD_ERR_NUMERIC,
                              "the overall transfer equation is singular to rounding: use the "
                              "reduced sweep")
                    : LD_OK;
}

// Rows of a node's state with the unknowns known, into inertial axes.
static void known_rows(const overall *o, int i, int first, const double *x, double z[6])
{
    for (int k = 0; k < 6; k++) {
        const double *row = row_of(o, i, first + k);
        z[k] = row[o->n];
        for (int p = 0; p < o->n; p++)
            if (row[p] != 0)
                z[k] += row[p] * x[p];
    }
}

// A beam's modes: M_qq q_ddot = h_q - M_qr [a; alpha]_I - (L_O^T F_O)_q.
static ld_status beam_modes(const overall *o, int i, int carried, const double *x, double *u_dot,
                            ld_error *error)
{
    const ld_mstmm *s = o->system;
    const node_beam *b = &s->beam_of[i];
    const beam *body = b->body;
    int n = body->n, modes = body->modes;
    m3 back = m3_transpose(node_body_axes(s, i));
    double G[LD_TUBE_MODES * LD_TUBE_MODES], z[6], F[6] = {0}, *q_ddot = u_dot + b->modes_u;
    if (carried) {
        known_rows(o, carried, TRANSFER_M, x, z);
        v3_store(F, m3_apply(back, v3_from(z + 3)));
        v3_store(F + 3, m3_apply(back, v3_from(z)));
    }
    known_rows(o, i, TRANSFER_A, x, z);
    v3_store(z, m3_apply(back, v3_from(z)));
    v3_store(z + 3, m3_apply(back, v3_from(z + 3)));
    for (int k = 0; k < modes; k++) {
        memcpy(G + k * modes, body->M + (6 + k) * n + 6, (size_t)modes * sizeof *G);
        q_ddot[k] = body->h[6 + k];
        for (int j = 0; j < 6; j++) {
            q_ddot[k] -= body->M[(6 + k) * n + j] * z[j];
            if (carried)
                q_ddot[k] -= body->output[0].section.L[j * n + 6 + k] * F[j];
        }
    }
    if (cholesky_factor(modes, G))
        return multibody_singular(s, i, error);
    cholesky_solve(modes, G, q_ddot);
    return LD_OK;
}

// Through all nodes outwards, the solution, and what follows from it.
static ld_status transfer_all(overall *o, double *x, double *u_dot, ld_error *error)
{
    ld_mstmm *s = o->system;
    ld_status status = LD_OK;
    for (int i = 1; !status && i <= s->node_count; i++) {
        status = enter_node(o, i, error);
        if (!status)
            cross_hinge(o, i);
        if (!status && o->children_left[i] == 0)
            status = leave_node(o, i, error);
    }
    if (!status)
        status = solve(o, x, error);
    for (int k = 0; !status && k < s->u_count; k++)
        if (o->rate_unknown[k] >= 0)
            u_dot[k] = x[o->rate_unknown[k]];
    for (int i = 1; !status && i <= s->node_count; i++)
        if (s->node[i].body == NODE_BEAM)
            status = beam_modes(o, i, o->children_left[i] ? i + 1 : 0, x, u_dot, error);
    return status;
}

// Largest difference of u_dot from the reduced sweep over its largest acceleration.
// NOLINTNEXTLINE(readability-function-size)
static double loss_of(ld_mstmm *s, const double *q, const double *u, const double *tau,
                      const double *wrench, const double *u_dot, double *reduced)
{
    double off = 0, size = 0;
    if (ld_mstmm_accelerations(s, q, u, tau, wrench, reduced, NULL))
        return INFINITY;
    for (int k = 0; k < s->u_count; k++) {
        double miss = fabs(u_dot[k] - reduced[k]);
        off = miss <= off ? off : miss; // a NaN stays
        size = fmax(size, fabs(reduced[k]));
    }
    return size > 0 ? off / size : off;
}

static ld_status check_size(const ld_mstmm *s, int unknowns, ld_error *error)
{
    double bytes = 8.0 * (ROWS * (s->node_count + 1.0) + 2.0 * unknowns) * (unknowns + 1.0);
    for (int i = 0; i < s->beam_count; i++)
        if (s->beams[i].output_count > 1)
            return ld_fail(error, LD_ERR_INPUT,
                           "the overall transfer equation takes beams with one output; use the "
                           "reduced sweep");
    if (s->loop_count > 0)
        return ld_fail(
            error, LD_ERR_INPUT,
            "the overall transfer equation takes no closed loops; use the reduced sweep");
    for (int i = 1; i <= s->node_count; i++)
        if (s->pass[i] == PASS_GIVEN)
            return ld_fail(error, LD_ERR_INPUT,
                           "the overall transfer equation takes no prescribed hinges; use the "
                           "reduced sweep");
    if (bytes > 1e9)
        return ld_fail(
            error, LD_ERR_INPUT,
            "%d unknowns are too many for the overall transfer equation; use the reduced "
            "sweep",
            unknowns);
    return LD_OK;
}

// NOLINTNEXTLINE(readability-function-size): public
ld_status ld_mstmm_accelerations_overall(ld_mstmm *s, ld_mstmm_form form, const double *q,
                                         const double *u, const double *tau, const double *wrench,
                                         double *u_dot, ld_mstmm_overall *report, ld_error *error)
{
    overall o = {.system = s, .q = q, .u = u, .wrench = wrench, .paper = form == LD_MSTMM_PAPER};
    int *children = calloc((size_t)s->node_count + 1, sizeof *children);
    o.rate_unknown = malloc(((size_t)s->u_count + 1) * sizeof *o.rate_unknown);
    if (!children || !o.rate_unknown) {
        free(children);
        free(o.rate_unknown);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the overall equation");
    }

    // unknowns: wrenches at the ground and of all children but the last, hinge accelerations
    for (int i = 1; i <= s->node_count; i++)
        children[s->node[i].parent]++;
    o.n = 6 * children[0] + s->axis_count;
    for (int i = 1; i <= s->node_count; i++)
        o.n += children[i] > 1 ? 6 * (children[i] - 1) : 0;
    o.width = o.n + 1;
    o.children_left = children;
    size_t n = (size_t)o.n, width = (size_t)o.width;
    ld_status status = check_size(s, o.n, error);
    if (!status) {
        o.state = calloc((size_t)(s->node_count + 1) * ROWS * width, sizeof *o.state);
        o.equation = calloc((n + 6) * width, sizeof *o.equation);
        o.rule = calloc(n * width, sizeof *o.rule);
        o.eliminated = calloc(n, sizeof *o.eliminated);
        o.gone = calloc(n, sizeof *o.gone);
    }
    double *x = calloc(n + (size_t)s->u_count, sizeof *x);
    for (int k = 0; k < s->u_count; k++)
        o.rate_unknown[k] = -1;
    if (!status && (!o.state || !o.equation || !o.rule || !o.eliminated || !o.gone || !x))
        status = ld_fail(error, LD_ERR_MEMORY, "no memory for the overall equation");
    if (!status) {
        o.tau = multibody_hinge_forces(s, q, u, tau);
        multibody_move(s, q, u);
        status = transfer_all(&o, x, u_dot, error);
    }
    if (!status) {
        double loss = loss_of(s, q, u, tau, wrench, u_dot, x + n);
        if (report) {
            *report = (ld_mstmm_overall){.order = o.equation_count, .loss = loss};
            if (!(loss < 1e-9))
                snprintf(report->warning, sizeof report->warning,
                         "the overall form fails on this system: its error is %.1e of the largest "
                         "acceleration; use the reduced sweep",
                         loss);
        }
        if (!(loss < 0.1))
            status = ld_fail(error, LD_ERR_NUMERIC,
                             "the overall form loses all digits on this system (%d hinge "
                             "accelerations); use the reduced sweep",
                             s->axis_count);
    }
    void *blocks[] = {children, o.rate_unknown, o.state, o.equation,
                      o.rule,   o.eliminated,   o.gone,  x};
    for (size_t k = 0; k < sizeof blocks / sizeof *blocks; k++)
        free(blocks[k]);
    return status;
}
