// Natural frequencies and mode shapes of a system linearised at an equilibrium.
//
// With small displacements d in the sense of the speeds, M d_ddot + C d_dot + K d = 0: M column by
// column from inverse dynamics (exact), C from the dampers (all velocity terms of the motion are of
// second order at rest), K from differences of the static forces. Prescribed hinges and loops leave
// the directions d = N z: N^T M N and so on, with the forces that keep the loops closed in the
// static forces, of constant size along directions that turn with the bodies.
#include <stdlib.h>
#include <string.h>

#include "math/functions.h"
#include "math/matrices/general_eigen.h"
#include "math/matrices/lapack.h"
#include "math/vectors/rotation_vector.h"
#include "systems/multibody/closing.h"
#include "systems/multibody/loop_rows.h"

// Step of the differences [rad], [m]; most by which they turn sections of beams with geometric
// stiffness [rad].
static const double step = 2e-3, most_turn = 0.01;

// q displaced by `size` along speed k of element e.
static void displace(const ld_mstmm *s, const double *q, int speed, double size, double *out)
{
    memcpy(out, q, (size_t)s->q_count * sizeof *q);
    int e = s->element_count - 1;
    while (s->element_u[e] > speed)
        e--;
    ld_hinge hinge = s->element[e].hinge;
    int k = speed - s->element_u[e], slides = hinge == LD_HINGE_FREE ? 3 : 0;
    double *at = out + s->element_q[e];
    if (k >= s->u_length[e]) {
        at[s->q_length[e] + k - s->u_length[e]] += size;
    } else if ((hinge == LD_HINGE_SPHERICAL || hinge == LD_HINGE_FREE) && k >= slides) {
        double half[3] = {0}, *c = at + slides;
        half[k - slides] = sin(0.5 * size);
        quat turned = q_multiply(q_from(c), (quat){cos(0.5 * size), half[0], half[1], half[2]});
        c[0] = turned.w;
        c[1] = turned.x;
        c[2] = turned.y;
        c[3] = turned.z;
    } else {
        at[k] += size;
    }
}

// Arrays of one analysis, n x n column by column.
typedef struct linear {
    int n;    // directions
    int full; // speeds
    double *M, *C, *K, *q, *zero, *unit, *force, *other;
    double *basis; // [n][full]; not used where all speeds are free
    bool reduced;
    double *state, *re, *im, *vectors; // of the eigenproblem of order 2 n
} linear;

static void damping_matrix(const ld_mstmm *s, linear *l)
{
    for (int e = 0; e < s->element_count; e++) {
        int at = s->element_u[e];
        for (int k = 0; k < s->u_length[e]; k++)
            l->C[(at + k) * l->n + at + k] = s->element[e].damping[k];
        if (!s->element[e].beam)
            continue;
        const flexible_tube *tube = &s->beams[s->element_beam[e]].tube;
        at += s->u_length[e];
        for (int plane = PLANE_Y; plane <= PLANE_Z; plane++)
            for (int k = 0; k < tube->nb; k++, at++)
                l->C[at * l->n + at] = tube->dmp_b[plane][k];
        for (int k = 0; k < tube->nt; k++, at++)
            l->C[at * l->n + at] = tube->dmp_t[k];
        for (int k = 0; k < tube->na; k++, at++)
            l->C[at * l->n + at] = tube->dmp_a[k];
    }
}

// The forces that hold the speeds u with the rates u_dot, the loops' forces in them, along the
// directions.
static void forces_along(ld_mstmm *s, const linear *l, const double *q, const double *u,
                         const double *u_dot, double *along)
{
    multibody_needed_forces(s, q, u, u_dot, l->force);
    for (int i = 0; i < l->n; i++) {
        along[i] = 0;
        for (int k = 0; k < l->full; k++)
            along[i] += l->basis[i * l->full + k] * l->force[k];
    }
}

// With directions: the loops' forces are those of the latest evaluation.
static void linearise_reduced(ld_mstmm *s, const double *q, linear *l)
{
    const int n = l->n;
    double *column = l->other;
    for (int j = 0; j < n; j++) {
        const double *d = l->basis + (size_t)j * (size_t)l->full;
        double *M = l->M + n * j, *C = l->C + n * j, *K = l->K + n * j;
        forces_along(s, l, q, l->zero, d, M);
        forces_along(s, l, q, l->zero, l->zero, column);
        for (int i = 0; i < n; i++)
            M[i] -= column[i];
        // what is odd in the speeds
        for (int k = 0; k < l->full; k++)
            l->unit[k] = -d[k];
        forces_along(s, l, q, d, l->zero, C);
        forces_along(s, l, q, l->unit, l->zero, column);
        for (int i = 0; i < n; i++)
            C[i] = 0.5 * (C[i] - column[i]);
        static const double at[4] = {-2, -1, 1, 2}, weight[4] = {1, -8, 8, -1};
        double h = fmin(step, most_turn / multibody_turn(s, d));
        for (int k = 0; k < 4; k++) {
            multibody_displace(s, q, at[k] * h, d, l->q);
            forces_along(s, l, l->q, l->zero, l->zero, column);
            for (int i = 0; i < n; i++)
                K[i] += weight[k] * column[i] / (12 * h);
        }
    }
    memset(l->unit, 0, (size_t)l->full * sizeof *l->unit);
}

static void linearise(ld_mstmm *s, const double *q, linear *l)
{
    int n = l->n;
    ld_mstmm_forces(s, q, l->zero, l->zero, NULL, l->other);
    for (int j = 0; j < n; j++) {
        l->unit[j] = 1;
        ld_mstmm_forces(s, q, l->zero, l->unit, NULL, l->force);
        double h = fmin(step, most_turn / multibody_turn(s, l->unit));
        l->unit[j] = 0;
        for (int i = 0; i < n; i++)
            l->M[i + n * j] = l->force[i] - l->other[i];

        // the force needed to hold grows by K d
        static const double at[4] = {-2, -1, 1, 2}, weight[4] = {1, -8, 8, -1};
        for (int k = 0; k < 4; k++) {
            displace(s, q, j, at[k] * h, l->q);
            ld_mstmm_forces(s, l->q, l->zero, l->zero, NULL, l->force);
            for (int i = 0; i < n; i++)
                l->K[i + n * j] += weight[k] * l->force[i] / (12 * h);
        }
    }
    damping_matrix(s, l);
}

// Whether tau holds the system at rest: the accelerations vanish against those of gravity or of
// single forces.
static ld_status check_equilibrium(ld_mstmm *s, const double *q, const double *tau, linear *l,
                                   ld_error *error)
{
    double off = 0, size = 0;
    if (l->reduced) {
        ld_status status = ld_mstmm_accelerations(s, q, l->zero, tau, NULL, l->other, error);
        if (status)
            return status;
        multibody_needed_forces(s, q, l->zero, l->zero, l->force);
    } else {
        ld_mstmm_forces(s, q, l->zero, l->zero, NULL, l->force);
    }
    for (int i = 1; i <= s->node_count; i++)
        size = fmax(size, fmax(v3_norm(s->wrench[i].linear), v3_norm(s->wrench[i].angular)));
    for (int k = 0; k < l->full; k++) {
        double held = tau ? tau[k] : 0;
        l->force[k] -= held;
        if (!l->reduced)
            off = fmax(off, fabs(l->force[k]));
        size = fmax(size, fabs(held));
    }
    for (int i = 0; l->reduced && i < l->n; i++) {
        double along = 0;
        for (int k = 0; k < l->full; k++)
            along += l->basis[i * l->full + k] * l->force[k];
        off = fmax(off, fabs(along));
    }
    if (!(off <= 1e-6 * fmax(size, 1e-9)))
        return ld_fail(error, LD_ERR_INPUT,
                       "the state is not an equilibrium: a force of %.3g N or N m is not balanced",
                       off);
    return LD_OK;
}

// Eigenvalues of the first-order form [d; d_dot]' = [0, E; -M^-1 K, -M^-1 C].
static ld_status solve(linear *l, ld_error *error)
{
    int n = l->n, width = 2 * n;
    lapack_int info = LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', n, l->M, n);
    if (!info)
        info = LAPACKE_dpotrs(LAPACK_COL_MAJOR, 'L', n, n, l->M, n, l->K, n);
    if (!info)
        info = LAPACKE_dpotrs(LAPACK_COL_MAJOR, 'L', n, n, l->M, n, l->C, n);
    for (int j = 0; j < n; j++) {
        l->state[j + width * (n + j)] = 1;
        for (int i = 0; i < n; i++) {
            l->state[n + i + width * j] = -l->K[i + n * j];
            l->state[n + i + width * (n + j)] = -l->C[i + n * j];
        }
    }
    if (!info)
        info = general_eigen(width, l->state, l->re, l->im, NULL, l->vectors);
    if (info == EIGEN_NO_MEMORY)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a vibration analysis");
    return info ? ld_fail(error, LD_ERR_NUMERIC,
                          "the eigenvalues of the linearised system cannot be computed")
                : LD_OK;
}

// Order of the eigenvalues by size, a real one after the complex ones of the same size.
typedef struct ranked {
    double size;
    int index;
} ranked;

static int compare(const void *a, const void *b)
{
    double x = ((const ranked *)a)->size, y = ((const ranked *)b)->size;
    return (x > y) - (x < y);
}

// Entry i of the displacement of eigenvector k.
static double entry_of(const linear *l, int i, int k)
{
    const double *vector = l->vectors + (size_t)(2 * l->n) * (size_t)k;
    if (!l->reduced)
        return vector[i];
    double sum = 0;
    for (int j = 0; j < l->n; j++)
        sum += l->basis[j * l->full + i] * vector[j];
    return sum;
}

// Displacement part of eigenvector k, its largest entry turned to 1.
static void shape_of(const linear *l, int k, double *out)
{
    int n = l->full, best = 0;
    bool vibrates = l->im[k] != 0;
    for (int i = 0; i < n; i++) {
        out[2 * i] = entry_of(l, i, k);
        out[2 * i + 1] = vibrates ? entry_of(l, i, k + 1) : 0;
        if (hypot(out[2 * i], out[2 * i + 1]) > hypot(out[2 * best], out[2 * best + 1]))
            best = i;
    }
    double re = out[2 * best], im = out[2 * best + 1], norm = re * re + im * im;
    for (int i = 0; norm > 0 && i < n; i++) {
        double x = out[2 * i], y = out[2 * i + 1];
        out[2 * i] = (x * re + y * im) / norm;
        out[2 * i + 1] = (y * re - x * im) / norm;
    }
}

static int collect(const linear *l, ranked *order, ld_mstmm_mode *modes, double *shapes)
{
    int found = 0, count = 0;
    for (int k = 0; k < 2 * l->n; k++)
        if (l->im[k] >= 0)
            order[found++] = (ranked){hypot(l->re[k], l->im[k]), k};
    qsort(order, (size_t)found, sizeof *order, compare);
    for (int i = 0; i < found && count < l->n; i++) {
        int k = order[i].index;
        double size = order[i].size;
        // of a pair of real eigenvalues near zero (a rigid motion) one is enough
        if (l->im[k] == 0 && i + 1 < found && l->im[order[i + 1].index] == 0 &&
            order[i + 1].size < 1e-3 && count + found - i > l->n)
            continue;
        modes[count] = (ld_mstmm_mode){.frequency = l->im[k] > 0 ? size / (2 * M_PI) : 0,
                                       .damping = size > 0 ? -l->re[k] / size : 0,
                                       .rate = l->re[k]};
        if (shapes)
            shape_of(l, k, shapes + (size_t)count * 2 * (size_t)l->full);
        count++;
    }
    return count;
}

// NOLINTNEXTLINE(readability-function-size): public
ld_status ld_mstmm_vibration(ld_mstmm *s, const double *q, const double *tau, ld_mstmm_mode *modes,
                             double *shapes, int *count, ld_error *error)
{
    size_t n = (size_t)s->u_count, square = n * n;
    *count = 0;
    if (n == 0)
        return LD_OK;
    linear l = {.n = s->u_count, .full = s->u_count, .reduced = s->loop_count > 0};
    for (int e = 0; e < s->element_count; e++)
        l.reduced |= s->prescribed[e];
    double *block =
        calloc(3 * square + (size_t)s->q_count + 4 * n + 9 * square + 4 * n, sizeof *block);
    ranked *order = calloc(2 * n, sizeof *order);
    if (!block || !order) {
        free(block);
        free(order);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a vibration analysis");
    }
    double *next = block;
    double **parts[] = {&l.M,     &l.C,     &l.K,       &l.q,  &l.zero, &l.unit, &l.force,
                        &l.other, &l.state, &l.vectors, &l.re, &l.im,   &l.basis};
    size_t sizes[] = {square, square, square, (size_t)s->q_count, n,
                      n,      n,      n,      4 * square,         4 * square,
                      2 * n,  2 * n,  square};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        *parts[k] = next;
        next += sizes[k];
    }
    ld_status status = l.reduced ? ld_mstmm_freedoms(s, q, l.basis, &l.n, error) : LD_OK;
    if (!status)
        status = check_equilibrium(s, q, tau, &l, error);
    if (!status && l.n > 0) {
        if (l.reduced)
            linearise_reduced(s, q, &l);
        else
            linearise(s, q, &l);
        status = solve(&l, error);
    }
    if (!status && l.n > 0)
        *count = collect(&l, order, modes, shapes);
    free(block);
    free(order);
    return status;
}
