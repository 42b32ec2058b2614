// Dense symmetric eigenproblems by LAPACK.
#ifndef LD_MATH_SYMMETRIC_EIGEN_H
#define LD_MATH_SYMMETRIC_EIGEN_H

enum { EIGEN_NO_MEMORY = -1010 };

// The `wanted` highest eigenvalues of A x = lambda B x, x^T B x = 1, of order n with B positive
// definite (NULL: 1). A [n][n] and B [n][n], of which one triangle is read, are destroyed. values
// [n]: the requested ones first, ascending; vectors [requested][n] one a row. Returns 0, or
// LAPACK's info: > n when B is not positive definite, 1..n when the iteration fails,
// EIGEN_NO_MEMORY, else < 0 when a number is not one.
int symmetric_eigen(int n, double *A, double *B, int wanted, double *values, double *vectors);

#endif
