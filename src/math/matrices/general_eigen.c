#include "math/matrices/general_eigen.h"

#include <lapacke_utils.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "math/lanes.h"
#include "math/matrices/lapack.h"

// The interface's own workspace is not asked for: it prints where there is no memory.
int general_eigen(int n, double *A, double *re, double *im, double *left, double *right)
{
    const char of_left = left ? 'V' : 'N', of_right = right ? 'V' : 'N';
    double size;
    if (LAPACKE_dge_nancheck(LAPACK_COL_MAJOR, n, n, A, n))
        return -5;
    int info = LAPACKE_dgeev_work(LAPACK_COL_MAJOR, of_left, of_right, n, A, n, re, im, left, n,
                                  right, n, &size, -1);
    double *work = info ? NULL : malloc((size_t)size * sizeof *work);
    if (work)
        info = LAPACKE_dgeev_work(LAPACK_COL_MAJOR, of_left, of_right, n, A, n, re, im, left, n,
                                  right, n, work, (lapack_int)size);
    else if (!info)
        info = EIGEN_NO_MEMORY;
    free(work);
    return info;
}

// ---- eigenvalues alone

enum { WORK = 11 }; // columns of a workspace for LAPACK

// A matrix of n unknowns by columns of `lanes` lanes each, filled up by zeros, two vectors and a
// workspace.
typedef struct columns {
    int n, lanes;
    double *A, *v, *y, *work;
    bool wide_instructions; // AVX2 is there
} columns;

static double *column_of(const columns *self, int j)
{
    return self->A + (size_t)(4 * self->lanes) * (size_t)j;
}

// The reflection E - tau v v^T that takes column k to its first two parts, which it then holds; v
// is 0 down to row k. Returns tau; 0: there is nothing to be taken.
static double reflect(const columns *self, int k)
{
    int n = self->n;
    double *x = column_of(self, k), sum = 0, *v = self->v;
    for (int i = k + 2; i < n; i++)
        sum += x[i] * x[i];
    v[k] = 0;
    if (!(sum > 0))
        return 0;
    double first = x[k + 1], beta = -copysign(sqrt(first * first + sum), first);
    v[k + 1] = 1;
    for (int i = k + 2; i < n; i++) {
        v[i] = x[i] / (first - beta);
        x[i] = 0;
    }
    x[k + 1] = beta;
    return (beta - first) / beta;
}

// A := (E - tau v v^T) A (E - tau v v^T) in the columns behind k.
LD_ALWAYS_INLINE void apply_reflection(const columns *self, int k, double tau)
{
    int n = self->n, lanes = self->lanes, from = (k + 1) / 4;
    const v4d *v = v4d_lanes_of(self->v);
    v4d *y = v4d_lanes(self->y);
    memset(self->y, 0, (size_t)(4 * lanes) * sizeof *self->y);
    for (int j = k + 1; j < n; j++) {
        const v4d *a = v4d_lanes_of(column_of(self, j));
        v4d factor = v4d_all(tau * self->v[j]);
        for (int i = 0; i < lanes; i++)
            y[i] += a[i] * factor;
    }
    for (int j = k + 1; j < n; j++) {
        v4d *a = v4d_lanes(column_of(self, j)), sum = v4d_all(0);
        v4d factor = v4d_all(self->v[j]);
        for (int i = 0; i < from; i++)
            a[i] -= y[i] * factor;
        for (int i = from; i < lanes; i++) {
            a[i] -= y[i] * factor;
            sum += a[i] * v[i];
        }
        factor = v4d_all(tau * v4d_sum(sum));
        for (int i = from; i < lanes; i++)
            a[i] -= v[i] * factor;
    }
}

// The same code with the processor's wider instructions: the same bits.
LANES_AVX2 static void apply_wide(const columns *self, int k, double tau)
{
    apply_reflection(self, k, tau);
}

// To the form of Hessenberg by reflections (Golub and Van Loan, Matrix Computations, 7.4.3).
static void reduce(const columns *self)
{
    for (int k = 0; k + 2 < self->n; k++) {
        double tau = reflect(self, k);
        if (tau == 0)
            continue;
        if (self->wide_instructions)
            apply_wide(self, k, tau);
        else
            apply_reflection(self, k, tau);
    }
}

// LAPACK's double shifts for small matrices, which it leaves at 75 unknowns; they are faster up to
// twice as many.
void dlahqr_(const lapack_int *wantt, const lapack_int *wantz, const lapack_int *n,
             const lapack_int *ilo, const lapack_int *ihi, double *h, const lapack_int *ldh,
             double *wr, double *wi, const lapack_int *iloz, const lapack_int *ihiz, double *z,
             const lapack_int *ldz, lapack_int *info);

static int hessenberg_eigenvalues(const columns *self, double *re, double *im)
{
    enum { SMALL = 150 };
    const lapack_int n = self->n, row = 4 * self->lanes, one = 1, no = 0;
    double none;
    lapack_int info;
    if (n > SMALL)
        return LAPACKE_dhseqr_work(LAPACK_COL_MAJOR, 'E', 'N', n, 1, n, self->A, row, re, im, &none,
                                   1, self->work, WORK * row);
    dlahqr_(&no, &no, &n, &one, &n, self->A, &row, re, im, &one, &n, &none, &one, &info);
    return info;
}

// Eigenvalues of the columns and rows from `low` on, as many as `self` has, of a balanced A.
static int reduced_eigenvalues(int n, const double *A, int low, columns *self, double *re,
                               double *im)
{
    for (int j = 0; j < self->n; j++)
        memcpy(column_of(self, j), A + low + (size_t)n * (size_t)(low + j),
               (size_t)self->n * sizeof *A);
    reduce(self);
    return hessenberg_eigenvalues(self, re + low, im + low);
}

// Norms of row and column i of A from `low` on and before `high`.
typedef struct norms {
    double row, column;
} norms;

static norms norms_of(int n, const double *A, int low, int high, int i)
{
    norms of = {0};
    for (int j = low; j < high; j++) {
        double in_row = A[i + (size_t)n * (size_t)j], in_column = A[j + (size_t)n * (size_t)i];
        of.row += in_row * in_row;
        of.column += in_column * in_column;
    }
    return (norms){sqrt(of.row), sqrt(of.column)};
}

// Scales the unknowns from `low` on and before `high` by powers of two until rows and columns are
// of like size (James, Langou and Lowery, "On matrix balancing and eigenvector computation", 2014),
// in a fifth of the time that LAPACK takes.
static void balance(int n, double *A, int low, int high)
{
    enum { MOST_ROUNDS = 30 };
    bool scaled = true;
    for (int round = 0; round < MOST_ROUNDS && scaled; round++) {
        scaled = false;
        for (int i = low; i < high; i++) {
            norms of = norms_of(n, A, low, high, i);
            int power;
            if (!(of.row > 0 && of.column > 0))
                continue;
            frexp(of.row / of.column, &power);
            double f = ldexp(1, (power - (power & 1)) / 2); // f^2 next to row / column
            if (!(of.column * f + of.row / f < 0.95 * (of.column + of.row)))
                continue;
            scaled = true;
            for (int j = low; j < high; j++) {
                A[i + (size_t)n * (size_t)j] /= f;
                A[j + (size_t)n * (size_t)i] *= f;
            }
        }
    }
}

int general_eigenvalues(int n, double *A, double *re, double *im)
{
    lapack_int low, high;
    if (LAPACKE_dge_nancheck(LAPACK_COL_MAJOR, n, n, A, n))
        return -5;
    // what a permutation parts from the rest stands on the diagonal
    int info = LAPACKE_dgebal_work(LAPACK_COL_MAJOR, 'P', n, A, n, &low, &high, re);
    for (int i = 0; i < n; i++) {
        re[i] = A[i + (size_t)n * (size_t)i];
        im[i] = 0;
    }
    if (!info)
        balance(n, A, low - 1, high);
    columns self = {.n = high - low + 1, .lanes = (high - low + 4) / 4};
    size_t row = 4 * (size_t)self.lanes, count = row * ((size_t)self.n + 2 + WORK);
    self.A = info ? NULL : aligned_alloc(64, (count * sizeof *self.A + 63) / 64 * 64);
    if (!self.A)
        return info ? info : EIGEN_NO_MEMORY;
    memset(self.A, 0, count * sizeof *self.A);
    self.v = self.A + row * (size_t)self.n;
    self.y = self.v + row;
    self.work = self.y + row;
#if defined(__x86_64__)
    // valgrind does not know them all: LAUNCHDYN_PLAIN=1 does without
    self.wide_instructions = lanes_have_avx2();
#endif
    info = reduced_eigenvalues(n, A, low - 1, &self, re, im);
    free(self.A);
    return info;
}
