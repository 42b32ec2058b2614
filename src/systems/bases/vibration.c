// Natural frequencies and mode shapes of a system linearised at an equilibrium.
//
// With small displacements d in the sense of the speeds, M d_ddot + C d_dot + K d = 0: M column by
// column from inverse dynamics (exact), C from the dampers (all velocity terms of the motion are of
// second order at rest), K from differences of the static forces.
#include <stdlib.h>
#include <string.h>

#include "math/functions.h"
#include "math/matrices/general_eigen.h"
#include "math/matrices/lapack.h"
#include "math/vectors/rotation_vector.h"
#include "systems/multibody/multibody.h"

// Step of the differences [rad], [m] and its fourth-order weights.
static const double step = 2e-3;

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
    int n;
    double *M, *C, *K, *q, *zero, *unit, *force, *other;
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

static void linearise(ld_mstmm *s, const double *q, linear *l)
{
    int n = l->n;
    ld_mstmm_forces(s, q, l->zero, l->zero, NULL, l->other);
    for (int j = 0; j < n; j++) {
        l->unit[j] = 1;
        ld_mstmm_forces(s, q, l->zero, l->unit, NULL, l->force);
        l->unit[j] = 0;
        for (int i = 0; i < n; i++)
            l->M[i + n * j] = l->force[i] - l->other[i];

        // the force needed to hold grows by K d
        static const double at[4] = {-2, -1, 1, 2}, weight[4] = {1, -8, 8, -1};
        for (int k = 0; k < 4; k++) {
            displace(s, q, j, at[k] * step, l->q);
            ld_mstmm_forces(s, l->q, l->zero, l->zero, NULL, l->force);
            for (int i = 0; i < n; i++)
                l->K[i + n * j] += weight[k] * l->force[i] / (12 * step);
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
    ld_mstmm_forces(s, q, l->zero, l->zero, NULL, l->force);
    for (int i = 1; i <= s->node_count; i++)
        size = fmax(size, fmax(v3_norm(s->wrench[i].linear), v3_norm(s->wrench[i].angular)));
    for (int k = 0; k < l->n; k++) {
        double held = tau ? tau[k] : 0;
        off = fmax(off, fabs(l->force[k] - held));
        size = fmax(size, fabs(held));
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

// Displacement part of eigenvector k, its largest entry turned to 1.
static void shape_of(const linear *l, int k, double *out)
{
    int n = l->n, width = 2 * n, best = 0;
    bool vibrates = l->im[k] != 0;
    for (int i = 0; i < n; i++) {
        out[2 * i] = l->vectors[i + width * k];
        out[2 * i + 1] = vibrates ? l->vectors[i + width * (k + 1)] : 0;
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
            shape_of(l, k, shapes + (size_t)count * 2 * (size_t)l->n);
        count++;
    }
    return count;
}

ld_status ld_mstmm_vibration(ld_mstmm *s, const double *q, const double *tau, ld_mstmm_mode *modes,
                             double *shapes, int *count, ld_error *error)
{
    size_t n = (size_t)s->u_count, square = n * n;
    *count = 0;
    if (n == 0)
        return LD_OK;
    linear l = {.n = s->u_count};
    double *block =
        calloc(3 * square + (size_t)s->q_count + 4 * n + 8 * square + 4 * n, sizeof *block);
    ranked *order = calloc(2 * n, sizeof *order);
    if (!block || !order) {
        free(block);
        free(order);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a vibration analysis");
    }
    double *next = block;
    double **parts[] = {&l.M,     &l.C,     &l.K,     &l.q,       &l.zero, &l.unit,
                        &l.force, &l.other, &l.state, &l.vectors, &l.re,   &l.im};
    size_t sizes[] = {square, square, square,     (size_t)s->q_count, n,     n,
                      n,      n,      4 * square, 4 * square,         2 * n, 2 * n};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        *parts[k] = next;
        next += sizes[k];
    }
    ld_status status = check_equilibrium(s, q, tau, &l, error);
    if (!status) {
        linearise(s, q, &l);
        status = solve(&l, error);
    }
    if (!status)
        *count = collect(&l, order, modes, shapes);
    free(block);
    free(order);
    return status;
}
