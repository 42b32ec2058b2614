#include "math/matrices/symmetric_eigen.h"

#include <float.h>
#include <lapacke_utils.h>
#include <stdlib.h>

#include "math/matrices/lapack.h"

// What LAPACK is given: the problem, and its work space, [size] and [5 n].
typedef struct eigenproblem {
    int n, wanted;
    double *A, *B, *values, *vectors;
    double *work;
    lapack_int size; // -1: the best is asked for, and stands in work[0]
    lapack_int *integers, *failed;
} eigenproblem;

static int solve(const eigenproblem *p)
{
    const double most_exact = 2 * DBL_MIN; // of the bisection
    lapack_int n = p->n, first = n - p->wanted + 1, found;
    return p->B ? LAPACKE_dsygvx_work(LAPACK_COL_MAJOR, 1, 'V', 'I', 'L', n, p->A, n, p->B, n, 0, 0,
                                      first, n, most_exact, &found, p->values, p->vectors, n,
                                      p->work, p->size, p->integers, p->failed)
                : LAPACKE_dsyevx_work(LAPACK_COL_MAJOR, 'V', 'I', 'L', n, p->A, n, 0, 0, first, n,
                                      most_exact, &found, p->values, p->vectors, n, p->work,
                                      p->size, p->integers, p->failed);
}

// The interface's own workspace is not asked for: it prints where there is no memory.
int symmetric_eigen(int n, double *A, double *B, int wanted, double *values, double *vectors)
{
    double size;
    eigenproblem p = {n, wanted, A, B, values, vectors, &size, -1, NULL, NULL};
    if (LAPACKE_dsy_nancheck(LAPACK_COL_MAJOR, 'L', n, A, n) ||
        (B && LAPACKE_dsy_nancheck(LAPACK_COL_MAJOR, 'L', n, B, n)))
        return -6;
    int info = solve(&p);
    if (info)
        return info;
    p.size = (lapack_int)size;
    p.work = malloc((size_t)size * sizeof *p.work);
    p.integers = malloc(6 * (size_t)n * sizeof *p.integers);
    p.failed = p.integers ? p.integers + 5 * n : NULL;
    info = p.work && p.integers ? solve(&p) : EIGEN_NO_MEMORY;
    free(p.integers);
    free(p.work);
    return info;
}
