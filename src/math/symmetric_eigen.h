// Dense symmetric eigenproblems by LAPACK.
#ifndef LD_MATH_SYMMETRIC_EIGEN_H
#define LD_MATH_SYMMETRIC_EIGEN_H

typedef enum eigen_problem {
    EIGEN_STANDARD,    // A x = lambda x,    x^T x = 1 (B unused, may be NULL)
    EIGEN_GENERALISED, // A x = lambda B x,  x^T B x = 1
    EIGEN_PRODUCT,     // A B x = lambda x,  x^T B x = 1
} eigen_problem;

enum { EIGEN_NO_MEMORY = -1010 };

// Solves one symmetric eigenproblem of order n with B positive definite.
// A [n][n] is replaced by the eigenvectors, one a row; B [n][n] is destroyed; values [n] ascend.
// Returns 0, or LAPACK's info: > n when B is not positive definite, 1..n when the iteration fails,
// EIGEN_NO_MEMORY, else < 0 when a number is not finite. OpenBLAS is set to one thread, which it
// then keeps: several cost more than they give at these orders, and the bits must not depend on
// their number.
int symmetric_eigen(eigen_problem problem, int n, double *A, double *B, double *values);

#endif
