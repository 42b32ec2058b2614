// Dense eigenproblems of general matrices by LAPACK.
#ifndef LD_MATH_GENERAL_EIGEN_H
#define LD_MATH_GENERAL_EIGEN_H

#include "math/matrices/symmetric_eigen.h"

// Eigenvalues re[k] + i im[k] of A x = lambda x of order n, each with its conjugate behind it where
// im[k] > 0, and eigenvectors of unit length. A [n][n] by columns is destroyed; re [n], im [n];
// right [n][n] by columns (NULL: not requested, for half the time), of a pair real and imaginary
// part; left [n][n] (NULL: not requested), of y^H A = lambda y^H. Returns 0, or LAPACK's info: > 0
// when the iteration fails, EIGEN_NO_MEMORY, else < 0 when a number is not one.
int general_eigen(int n, double *A, double *re, double *im, double *left, double *right);

// The eigenvalues alone, rounded otherwise, in half the time that they take there.
int general_eigenvalues(int n, double *A, double *re, double *im);

#endif
