// Symmetric positive definite systems of a few unknowns, in place and inline: A = L D L^T.
#ifndef LD_MATH_LDL_H
#define LD_MATH_LDL_H

#include "math/vec3.h"

// Factors the upper triangle of A [n x n, rows `stride` apart]: D on the diagonal, L^T above it.
LD_INLINE void ldl_factor(int n, int stride, double *A)
{
    for (int i = 0; i < n; i++)
        for (int j = i + 1; j < n; j++) {
            double l = A[i * stride + j] / A[i * stride + i];
            for (int k = j; k < n; k++)
                A[j * stride + k] -= l * A[i * stride + k];
        }
    for (int i = 0; i < n; i++)
        for (int j = i + 1; j < n; j++)
            A[i * stride + j] /= A[i * stride + i];
}

// x := A^-1 x with the factors.
LD_INLINE void ldl_solve(int n, int stride, const double *A, double *x)
{
    for (int i = 0; i < n; i++)
        for (int j = i + 1; j < n; j++)
            x[j] -= A[i * stride + j] * x[i];
    for (int i = n - 1; i >= 0; i--) {
        x[i] /= A[i * stride + i];
        for (int j = i + 1; j < n; j++)
            x[i] -= A[i * stride + j] * x[j];
    }
}

#endif
