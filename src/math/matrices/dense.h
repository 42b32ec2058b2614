// Small dense solvers, row by row in place: Cholesky for symmetric positive definite matrices, LU
// with partial pivoting for the others. Matrices are n x n without gaps between rows.
#ifndef LD_MATH_DENSE_H
#define LD_MATH_DENSE_H

// Lower Cholesky factor in place of A's lower triangle (the upper one is not touched). Returns 0,
// or i + 1 where pivot i is not positive or not finite.
int cholesky_factor(int n, double *A);

// b := A^-1 b from the factor.
void cholesky_solve(int n, const double *G, double *b);

// b := G^-1 b: the first half of a solve, for products Y A^-1 Y^T as (G^-1 Y^T)^T (G^-1 Y^T).
void cholesky_forward(int n, const double *G, double *b);

// LU factors in place, row exchanges in `pivot` [n]. Returns 0, or i + 1 where column i has no
// pivot.
int lu_factor(int n, double *A, int *pivot);

// b := A^-1 b from the factors.
void lu_solve(int n, const double *LU, const int *pivot, double *b);

#endif
