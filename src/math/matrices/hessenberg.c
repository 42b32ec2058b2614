#include "math/matrices/hessenberg.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "math/lanes.h"
#include "math/matrices/lapack.h"

int hessenberg_make(hessenberg *self, int n)
{
    size_t square = (size_t)n * (size_t)n, row = 2 * (size_t)n;
    self->n = n;
    self->H = malloc((5 * square + row) * sizeof *self->H);
    if (!self->H)
        return 1;
    self->wide_instructions = lanes_have_avx2();
    self->X = self->H + square;
    self->inverse = self->X + square;
    self->rows = self->inverse + square;
    self->spare = self->rows + 2 * square;
    return 0;
}

void hessenberg_free(hessenberg *self)
{
    free(self->H);
    *self = (hessenberg){0};
}

int hessenberg_reduce(hessenberg *self, const double *A)
{
    int n = self->n, low, high;
    double *H = self->rows, *scale = self->spare, *tau = self->spare + n; // by columns for now
    size_t square = (size_t)n * (size_t)n, size = square * sizeof *H;
    double *work = H + square; // a workspace of LAPACK's own prints where there is no memory
    memcpy(H, A, size);
    int bad = LAPACKE_dgebal(LAPACK_COL_MAJOR, 'B', n, H, n, &low, &high, scale);
    if (!bad)
        bad = LAPACKE_dgehrd_work(LAPACK_COL_MAJOR, n, low, high, H, n, tau, work, n * n);
    if (bad)
        return bad;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            self->H[n * i + j] = i > j + 1 ? 0 : H[i + n * j];
    // X = D Q, X^-T = D^-1 Q, D the balancing
    memcpy(self->X, H, size);
    bad = LAPACKE_dorghr_work(LAPACK_COL_MAJOR, n, low, high, self->X, n, tau, work, n * n);
    memcpy(self->inverse, self->X, size);
    if (!bad)
        bad = LAPACKE_dgebak(LAPACK_COL_MAJOR, 'B', 'R', n, low, high, scale, n, self->X, n);
    if (!bad)
        bad = LAPACKE_dgebak(LAPACK_COL_MAJOR, 'B', 'L', n, low, high, scale, n, self->inverse, n);
    return bad;
}

// A row of the matrix, real and imaginary parts [n].
typedef struct row {
    double *re, *im;
} row;

static void exchange(double *a, double *b)
{
    double before = *a;
    *a = *b;
    *b = before;
}

// How a row is eliminated: whether it became the pivot, and the factor of the pivot that was taken
// from the other one.
typedef struct elimination {
    bool swapped;
    double re, im;
} elimination;

// to := from - m pivot, behind column k.
LD_ALWAYS_INLINE void subtract(int n, int k, elimination m, row pivot, row from, row to)
{
    for (int j = k + 1; j < n; j++) {
        double p = pivot.re[j], q = pivot.im[j];
        to.re[j] = from.re[j] - (m.re * p - m.im * q);
        to.im[j] = from.im[j] - (m.re * q + m.im * p);
    }
}

// Row k of i omega E - H, from the element left of its diagonal on.
LD_ALWAYS_INLINE void load(const hessenberg *self, double omega, int k, row to)
{
    int n = self->n, first = k > 0 ? k - 1 : 0;
    for (int j = first; j < n; j++) {
        to.re[j] = -self->H[n * k + j];
        to.im[j] = 0;
    }
    to.im[k] = omega;
}

// Eliminates what stands below element k of the row `now` in the row `next`: the rest into `to`.
// The larger one is the pivot and stays in `now`.
LD_ALWAYS_INLINE elimination eliminate(int n, int k, row now, row next, row to)
{
    double p = now.re[k], q = now.im[k], below = next.re[k], square = p * p + q * q;
    if (square < below * below) {
        elimination m = {true, p / below, q / below};
        subtract(n, k, m, next, now, to);
        memcpy(now.re + k, next.re + k, (size_t)(n - k) * sizeof(double));
        memcpy(now.im + k, next.im + k, (size_t)(n - k) * sizeof(double));
        return m;
    }
    elimination m = {false, square > 0 ? below * p / square : 0,
                     square > 0 ? -below * q / square : 0};
    subtract(n, k, m, now, next, to);
    return m;
}

// The same with elements k and k + 1 of the right-hand sides.
LD_ALWAYS_INLINE void eliminate_sides(int n, int k, elimination m, int count, double *z)
{
    for (int i = 0; i < count; i++, z += 2 * n) {
        double *x = z + k, *y = z + n + k;
        if (m.swapped) {
            exchange(x, x + 1);
            exchange(y, y + 1);
        }
        x[1] -= m.re * x[0] - m.im * y[0];
        y[1] -= m.re * y[0] + m.im * x[0];
    }
}

static row row_at(const hessenberg *self, int k)
{
    double *place = self->rows + 2 * (size_t)self->n * (size_t)k;
    return (row){place, place + self->n};
}

LD_ALWAYS_INLINE v4d four(const double *from)
{
    v4d lanes;
    memcpy(&lanes, from, sizeof lanes);
    return lanes;
}

// Other than 0: a row's pivot is nothing.
LD_ALWAYS_INLINE int substitute(const hessenberg *self, double *re, double *im)
{
    int n = self->n;
    for (int k = n - 1; k >= 0; k--) {
        row U = row_at(self, k);
        double p = U.re[k], q = U.im[k], square = p * p + q * q;
        if (!(square > 0))
            return k + 1;
        v4d x = {re[k], 0, 0, 0}, y = {im[k], 0, 0, 0};
        int j = k + 1;
        for (; j + 4 <= n; j += 4) {
            v4d u = four(U.re + j), v = four(U.im + j), c = four(re + j), d = four(im + j);
            x -= u * c - v * d;
            y -= u * d + v * c;
        }
        double a = v4d_sum(x), b = v4d_sum(y);
        for (; j < n; j++) {
            a -= U.re[j] * re[j] - U.im[j] * im[j];
            b -= U.re[j] * im[j] + U.im[j] * re[j];
        }
        re[k] = (a * p + b * q) / square;
        im[k] = (b * p - a * q) / square;
    }
    return 0;
}

LD_ALWAYS_INLINE int solve(const hessenberg *self, double omega, int count, double *z)
{
    int n = self->n, bad = 0;
    row next = {self->spare, self->spare + n};
    load(self, omega, 0, row_at(self, 0));
    for (int k = 0; k + 1 < n; k++) {
        load(self, omega, k + 1, next);
        elimination m = eliminate(n, k, row_at(self, k), next, row_at(self, k + 1));
        eliminate_sides(n, k, m, count, z);
    }
    for (int i = 0; i < count && !bad; i++, z += 2 * n)
        bad = substitute(self, z, z + n);
    return bad;
}

// The same code with the processor's wider instructions: the same bits.
LANES_AVX2 static int solve_wide(const hessenberg *self, double omega, int count, double *z)
{
    return solve(self, omega, count, z);
}

int hessenberg_solve(const hessenberg *self, double omega, int count, double *z)
{
    if (self->wide_instructions)
        return solve_wide(self, omega, count, z);
    return solve(self, omega, count, z);
}
