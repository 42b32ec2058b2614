#include "math/matrices/general_eigen.h"

#include <lapacke_utils.h>
#include <stdlib.h>

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
