#include "math/symmetric_eigen.h"

#include <lapacke.h>

_Static_assert(EIGEN_NO_MEMORY == LAPACK_WORK_MEMORY_ERROR, "it is LAPACKE's");

// There only if the BLAS in use is OpenBLAS.
extern void openblas_set_num_threads(int count) __attribute__((weak));

int symmetric_eigen(eigen_problem problem, int n, double *A, double *B, double *values)
{
    if (openblas_set_num_threads)
        openblas_set_num_threads(1);
    if (problem == EIGEN_STANDARD)
        return LAPACKE_dsyevd(LAPACK_COL_MAJOR, 'V', 'L', n, A, n, values);
    return LAPACKE_dsygvd(LAPACK_COL_MAJOR, problem == EIGEN_PRODUCT ? 2 : 1, 'V', 'L', n, A, n, B,
                          n, values);
}
