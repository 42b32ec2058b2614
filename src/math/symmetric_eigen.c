#include "math/symmetric_eigen.h"

#include <float.h>
#include <lapacke.h>
#include <stdlib.h>

_Static_assert(EIGEN_NO_MEMORY == LAPACK_WORK_MEMORY_ERROR, "it is LAPACKE's");

int symmetric_eigen(int n, double *A, double *B, int wanted, double *values, double *vectors)
{
    lapack_int found, *failed = malloc((size_t)n * sizeof *failed), first = n - wanted + 1;
    double most_exact = 2 * DBL_MIN; // of the bisection
    if (!failed)
        return EIGEN_NO_MEMORY;
    int info = B ? LAPACKE_dsygvx(LAPACK_COL_MAJOR, 1, 'V', 'I', 'L', n, A, n, B, n, 0, 0, first, n,
                                  most_exact, &found, values, vectors, n, failed)
                 : LAPACKE_dsyevx(LAPACK_COL_MAJOR, 'V', 'I', 'L', n, A, n, 0, 0, first, n,
                                  most_exact, &found, values, vectors, n, failed);
    free(failed);
    return info;
}
