#include "systems/multibody/loop_system.h"

#include <math.h>
#include <string.h>

// Block of loop i's rows with loop j's.
static double *block(const ld_mstmm *system, double *blocks, int i, int j)
{
    return blocks + (size_t)(j - system->loop[i].first) * 36;
}

// X_ij = (S_ij - sum_k X_ik X_jk^T) L_j^-T for all rows of i and the pivot rows of j, j < i.
static void reduce_row(const ld_mstmm *system, int i, int j)
{
    const loop_work *w = &system->loop_work[i], *other = &system->loop_work[j];
    const double *S = block(system, w->S, i, j);
    double *X = block(system, w->X, i, j);
    int k_first = system->loop[i].first;
    if (k_first < system->loop[j].first)
        k_first = system->loop[j].first;
    for (int a = 0; a < w->active; a++)
        for (int b = 0; b < other->rank; b++) {
            const int row = other->order[b];
            double sum = S[6 * a + row];
            for (int k = k_first; k < j; k++) {
                const double *X_i = block(system, w->X, i, k) + 6 * a;
                const double *X_j = block(system, other->X, j, k) + 6 * row;
                for (int c = 0; c < system->loop_work[k].rank; c++)
                    sum -= X_i[c] * X_j[c];
            }
            for (int c = 0; c < b; c++)
                sum -= X[6 * a + c] * other->L[b][c];
            X[6 * a + b] = sum / other->L[b][b];
        }
}

// What is left of the own block; its lower triangle.
static void reduce_own(const ld_mstmm *system, int i, double shift, double D[6][6])
{
    const loop_work *w = &system->loop_work[i];
    const double *S = block(system, w->S, i, i);
    for (int a = 0; a < w->active; a++)
        for (int b = 0; b <= a; b++) {
            double sum = S[6 * a + b];
            for (int k = system->loop[i].first; k < i; k++) {
                const double *X = block(system, w->X, i, k);
                for (int c = 0; c < system->loop_work[k].rank; c++)
                    sum -= X[6 * a + c] * X[6 * b + c];
            }
            D[a][b] = sum;
            if (a == b)
                D[a][a] += shift * w->scale[a];
        }
}

// Swaps rows and columns a < b of a symmetric matrix kept by its lower triangle.
static void swap_rows(int n, double D[6][6], int a, int b)
{
    double held;
#define SWAP(x, y) (held = (x), (x) = (y), (y) = held)
    for (int k = 0; k < a; k++)
        SWAP(D[a][k], D[b][k]);
    for (int k = a + 1; k < b; k++)
        SWAP(D[k][a], D[b][k]);
    for (int k = b + 1; k < n; k++)
        SWAP(D[k][a], D[k][b]);
    SWAP(D[a][a], D[b][b]);
#undef SWAP
}

// Cholesky with the largest pivot, in its row's scale, first. Returns the least pivot taken or
// missed.
static double factor_own(loop_work *w, const loop_pivots *pivots, double D[6][6])
{
    const int n = w->active, most = pivots->limited ? w->limit : n;
    double least = 1;
    for (int a = 0; a < n; a++)
        w->order[a] = a;
    for (w->rank = 0; w->rank < most; w->rank++) {
        const int p = w->rank;
        int best = p;
        for (int a = p + 1; a < n; a++)
            if (D[a][a] * w->scale[w->order[best]] > D[best][best] * w->scale[w->order[a]])
                best = a;
        double pivot = D[best][best] / w->scale[w->order[best]];
        if (pivots->limited || pivot > pivots->least)
            least = pivot < least ? pivot : least;
        if (!(pivot > pivots->least))
            return least;
        if (best > p) {
            int held = w->order[p];
            w->order[p] = w->order[best];
            w->order[best] = held;
            swap_rows(n, D, p, best);
        }
        D[p][p] = sqrt(D[p][p]);
        for (int a = p + 1; a < n; a++)
            D[a][p] /= D[p][p];
        for (int a = p + 1; a < n; a++)
            for (int b = p + 1; b <= a; b++)
                D[a][b] -= D[a][p] * D[b][p];
    }
    return least;
}

double loop_system_factor(ld_mstmm *system, const loop_pivots *pivots, int *where)
{
    double least = 1;
    *where = -1;
    for (int i = 0; i < system->loop_count; i++) {
        loop_work *w = &system->loop_work[i];
        for (int j = system->loop[i].first; j < i; j++)
            reduce_row(system, i, j);
        reduce_own(system, i, pivots->shift, w->L);
        double own = factor_own(w, pivots, w->L);
        // NaN too
        if (!(own >= least)) {
            least = own;
            *where = i;
        }
    }
    return least;
}

void loop_system_solve(ld_mstmm *system)
{
    // forwards, in the order of the pivots
    for (int i = 0; i < system->loop_count; i++) {
        loop_work *w = &system->loop_work[i];
        for (int b = 0; b < w->rank; b++) {
            const int row = w->order[b];
            double sum = -w->gap[row];
            for (int j = system->loop[i].first; j < i; j++) {
                const double *X = block(system, w->X, i, j) + 6 * row;
                for (int c = 0; c < system->loop_work[j].rank; c++)
                    sum -= X[c] * system->loop_work[j].found[c];
            }
            for (int c = 0; c < b; c++)
                sum -= w->L[b][c] * w->found[c];
            w->found[b] = sum / w->L[b][b];
        }
    }
    // backwards
    for (int i = system->loop_count - 1; i >= 0; i--) {
        loop_work *w = &system->loop_work[i];
        memset(w->force, 0, sizeof w->force);
        for (int b = w->rank - 1; b >= 0; b--) {
            double sum = w->found[b];
            for (int c = b + 1; c < w->rank; c++)
                sum -= w->L[c][b] * w->found[c];
            w->found[b] = sum / w->L[b][b];
            w->force[w->active_row[w->order[b]]] = w->found[b];
        }
        for (int j = system->loop[i].first; j < i; j++)
            for (int c = 0; c < system->loop_work[j].rank; c++)
                for (int b = 0; b < w->rank; b++)
                    system->loop_work[j].found[c] -=
                        block(system, w->X, i, j)[6 * w->order[b] + c] * w->found[b];
    }
}

// ---- near singular poses

// Rows of all loops as vectors over the speeds, v = Y D^-1/2: S = V V^T.
static int gather_rows(const ld_mstmm *system, double *V, double *scale)
{
    const size_t n = (size_t)system->u_count;
    int rows = 0;
    for (int i = 0; i < system->loop_count; i++) {
        const loop *l = &system->loop[i];
        const loop_work *w = &system->loop_work[i];
        for (int a = 0; a < w->active; a++, rows++) {
            double *v = V + (size_t)rows * n;
            memset(v, 0, n * sizeof *v);
            for (int k = 0; k < l->slot_count; k++) {
                double y = w->Y[a * l->slot_count + k], z = w->Z[a * l->slot_count + k];
                v[l->slot[k]] = y < 0 ? -sqrt(y * z) : sqrt(y * z);
            }
            scale[rows] = w->scale[a];
        }
    }
    return rows;
}

static double product(int n, const double *x, const double *y)
{
    double sum = 0;
    for (int k = 0; k < n; k++)
        sum += x[k] * y[k];
    return sum;
}

// Modified Gram-Schmidt: V = R^T Q, the row with the largest rest in its scale next; R [row][p].
// Returns how many rows are independent, at most `most`.
// NOLINTNEXTLINE(readability-function-size)
static int orthogonalise(int rows, int n, int most, double least, dense_rows *d, double *smallest,
                         int *last)
{
    *smallest = 1;
    for (int r = 0; r < rows; r++)
        d->order[r] = r;
    for (int p = 0; p < most; p++) {
        int best = p;
        double pivot = -1;
        for (int r = p; r < rows; r++) {
            const double *v = d->V + (size_t)d->order[r] * (size_t)n;
            double rest = product(n, v, v) / d->scale[d->order[r]];
            if (rest > pivot) {
                pivot = rest;
                best = r;
            }
        }
        const int row = d->order[best];
        d->order[best] = d->order[p];
        d->order[p] = row;
        if (pivot < *smallest) {
            *smallest = pivot;
            *last = row;
        }
        if (!(pivot > least))
            return p;
        double *q = d->V + (size_t)row * (size_t)n;
        const double size = sqrt(product(n, q, q));
        for (int k = 0; k < n; k++)
            q[k] /= size;
        d->R[(size_t)row * (size_t)rows + (size_t)p] = size;
        for (int r = p + 1; r < rows; r++) {
            double *v = d->V + (size_t)d->order[r] * (size_t)n, part = product(n, q, v);
            d->R[(size_t)d->order[r] * (size_t)rows + (size_t)p] = part;
            for (int k = 0; k < n; k++)
                v[k] -= part * q[k];
        }
    }
    return most;
}

double loop_system_solve_dense(ld_mstmm *system, double least, int *where)
{
    dense_rows *d = &system->dense;
    int most = 0, last = 0;
    double smallest;
    if (!d->V)
        return -1;
    for (int i = 0; i < system->loop_count; i++)
        most += system->loop_work[i].limit;
    const int rows = gather_rows(system, d->V, d->scale);
    const int rank = orthogonalise(rows, system->u_count, most, least, d, &smallest, &last);
    // R^T R force = -gap
    for (int i = 0, r = 0; i < system->loop_count; i++)
        for (int a = 0; a < system->loop_work[i].active; a++, r++) {
            d->gap[r] = system->loop_work[i].gap[a];
            if (r == last)
                *where = i;
        }
    for (int p = 0; p < rank; p++) {
        const double *R = d->R + (size_t)d->order[p] * (size_t)rows;
        double sum = -d->gap[d->order[p]];
        for (int k = 0; k < p; k++)
            sum -= R[k] * d->found[k];
        d->found[p] = sum / R[p];
    }
    memset(d->gap, 0, (size_t)rows * sizeof *d->gap);
    for (int p = rank - 1; p >= 0; p--) {
        double sum = d->found[p];
        for (int k = p + 1; k < rank; k++)
            sum -= d->R[(size_t)d->order[k] * (size_t)rows + (size_t)p] * d->gap[d->order[k]];
        d->gap[d->order[p]] = sum / d->R[(size_t)d->order[p] * (size_t)rows + (size_t)p];
    }
    for (int i = 0, r = 0; i < system->loop_count; i++) {
        loop_work *w = &system->loop_work[i];
        memset(w->force, 0, sizeof w->force);
        for (int a = 0; a < w->active; a++, r++)
            w->force[w->active_row[a]] = d->gap[r];
    }
    return smallest;
}

double loop_system_rest(const ld_mstmm *system, int i)
{
    const loop_work *w = &system->loop_work[i];
    double worst = 0;
    for (int a = 0; a < w->active; a++) {
        double sum = w->gap[a], size = fabs(sum);
        for (int j = 0; j < system->loop_count; j++) {
            const loop_work *other = &system->loop_work[j];
            const bool before = j <= i;
            if (before ? j < system->loop[i].first : i < system->loop[j].first)
                continue;
            for (int b = 0; b < other->active; b++) {
                double S = before ? block(system, w->S, i, j)[6 * a + b]
                                  : block(system, other->S, j, i)[6 * b + a];
                double part = S * other->force[other->active_row[b]];
                sum += part;
                size += fabs(part);
            }
        }
        worst = fmax(worst, size > 0 ? fabs(sum) / size : 0);
    }
    return worst;
}
