// Solutions by the form of Hessenberg against LAPACK's of the whole.
#include "math/matrices/lapack.h"
#include <complex.h>
#include <stdlib.h>
#include <string.h>

#include "math/matrices/general_eigen.h"
#include "math/matrices/hessenberg.h"
#include "support/check.h"

enum { N = 37 };

static double drawn(unsigned *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state / 4294967296.0 - 0.5;
}

// X (i omega E - H)^-1 X^-1 b.
static void solve(hessenberg *self, double omega, const double *b, double complex *x)
{
    int n = self->n;
    double z[4 * N] = {0};
    for (int k = 0; k < n; k++)
        for (int j = 0; j < n; j++) {
            z[k] += self->inverse[j + n * k] * b[j];
            z[3 * n + k] -= 2 * self->inverse[j + n * k] * b[j];
        }
    assert_int_equal(hessenberg_solve(self, omega, 2, z), 0);
    for (int j = 0; j < n; j++) {
        x[j] = 0;
        for (int k = 0; k < n; k++) {
            x[j] += self->X[j + n * k] * (z[k] + I * z[n + k]);
            // the second one is -2 i of it
            assert_true(cabs(z[2 * n + k] + I * z[3 * n + k] + 2 * I * (z[k] + I * z[n + k])) <=
                        1e-12 * cabs(z[k] + I * z[n + k]));
        }
    }
}

// Entries of very different sizes, as those of mechanics are.
static void solutions_are_those_of_the_whole(void **state)
{
    (void)state;
    unsigned seed = 1;
    double A[N * N], b[N], worst = 0;
    double complex whole[N * N], x[N], exact[N];
    lapack_int pivot[N];
    hessenberg reduced;
    for (int i = 0; i < N * N; i++)
        A[i] = drawn(&seed) * pow(10, (i % N) % 7 - (i / N) % 7);
    for (int i = 0; i < N; i++)
        b[i] = drawn(&seed);
    A[3 * N + 5] = A[7] = 0;
    assert_int_equal(hessenberg_make(&reduced, N), 0);
    assert_int_equal(hessenberg_reduce(&reduced, A), 0);
    for (double omega = 0.01; omega < 1e4; omega *= 7) {
        for (int i = 0; i < N * N; i++)
            whole[i] = (i % (N + 1) == 0 ? I * omega : 0) - A[i];
        for (int i = 0; i < N; i++)
            exact[i] = b[i];
        assert_int_equal(LAPACKE_zgesv(LAPACK_COL_MAJOR, N, 1, whole, N, pivot, exact, N), 0);
        solve(&reduced, omega, b, x);
        for (int i = 0; i < N; i++)
            worst = fmax(worst, cabs(x[i] - exact[i]) / cabs(exact[i]));
    }
    CHECK_BELOW("against LU of the whole, relative", worst, 1e-9);
    hessenberg_free(&reduced);
}

static void an_eigenvalue_is_told(void **state)
{
    (void)state;
    hessenberg swing;
    double z[4] = {1, 0, 0, 0};
    assert_int_equal(hessenberg_make(&swing, 2), 0);
    assert_int_equal(hessenberg_reduce(&swing, (double[]){0, -4, 1, 0}), 0);
    assert_int_not_equal(hessenberg_solve(&swing, 2, 1, z), 0);
    hessenberg_free(&swing);
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// Eigenvalues alone against those that come with their vectors, and against the traces of A and
// A^2: small and large matrices, some of whose columns and rows are empty.
static void eigenvalues_alone(void **state)
{
    (void)state;
    static const int sizes[] = {1, 2, 3, 37, 64, 151, 170};
    enum { MOST = 170 };
    static double A[MOST * MOST], B[MOST * MOST], vectors[MOST * MOST];
    unsigned seed = 5;
    double worst[3] = {0};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        int n = sizes[k];
        double re[MOST], im[MOST], with[MOST], unused[MOST], size = 0, trace = 0, square = 0;
        for (int j = 0; j < n; j++)
            for (int i = 0; i < n; i++) {
                bool empty = n > 3 && (j == n / 2 || i == n / 3);
                A[i + n * j] = empty ? 0 : drawn(&seed) * pow(10, i % 5 - j % 5);
            }
        for (int j = 0; j < n; j++) {
            trace += A[j + n * j];
            for (int i = 0; i < n; i++)
                square += A[i + n * j] * A[j + n * i];
        }
        memcpy(B, A, sizeof B);
        assert_int_equal(general_eigen(n, B, with, unused, NULL, vectors), 0);
        memcpy(B, A, sizeof B);
        assert_int_equal(general_eigenvalues(n, B, re, im), 0);
        for (int i = 0; i < n; i++) {
            size = fmax(size, hypot(re[i], im[i]));
            trace -= re[i];
            square -= re[i] * re[i] - im[i] * im[i];
        }
        qsort(re, (size_t)n, sizeof *re, ascending);
        qsort(with, (size_t)n, sizeof *with, ascending);
        for (int i = 0; i < n; i++)
            worst[0] = fmax(worst[0], fabs(re[i] - with[i]) / size);
        worst[1] = fmax(worst[1], fabs(trace) / size);
        worst[2] = fmax(worst[2], fabs(square) / (size * size));
    }
    CHECK_BELOW("real parts apart, of the largest", worst[0], 5e-14);
    CHECK_BELOW("trace", worst[1], 5e-14);
    CHECK_BELOW("trace of the square", worst[2], 1e-13);
    A[0] = NAN;
    double re[MOST], im[MOST];
    assert_true(general_eigenvalues(2, A, re, im) != 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(solutions_are_those_of_the_whole),
        cmocka_unit_test(eigenvalues_alone),
        cmocka_unit_test(an_eigenvalue_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
