#include "math/matrices/dense.h"

#include <math.h>

int cholesky_factor(int n, double *A)
{
    for (int i = 0; i < n; i++) {
        double *row = A + i * n;
        for (int j = 0; j < i; j++) {
            const double *other = A + j * n;
            double sum = row[j];
            for (int k = 0; k < j; k++)
                sum -= row[k] * other[k];
            row[j] = sum / other[j];
        }
        double sum = row[i];
        for (int k = 0; k < i; k++)
            sum -= row[k] * row[k];
        if (!(sum > 0) || !isfinite(sum))
            return i + 1;
        row[i] = sqrt(sum);
    }
    return 0;
}

void cholesky_forward(int n, const double *G, double *b)
{
    for (int i = 0; i < n; i++) {
        double sum = b[i];
        for (int k = 0; k < i; k++)
            sum -= G[i * n + k] * b[k];
        b[i] = sum / G[i * n + i];
    }
}

void cholesky_solve(int n, const double *G, double *b)
{
    cholesky_forward(n, G, b);
    for (int i = n - 1; i >= 0; i--) {
        double sum = b[i];
        for (int k = i + 1; k < n; k++)
            sum -= G[k * n + i] * b[k];
        b[i] = sum / G[i * n + i];
    }
}

int lu_factor(int n, double *A, int *pivot)
{
    for (int j = 0; j < n; j++) {
        // the largest entry left in this column
        int best = j;
        for (int i = j + 1; i < n; i++)
            if (fabs(A[i * n + j]) > fabs(A[best * n + j]))
                best = i;
        pivot[j] = best;
        double largest = A[best * n + j];
        if (!(fabs(largest) > 0) || !isfinite(largest))
            return j + 1;
        if (best != j)
            for (int k = 0; k < n; k++) {
                double held = A[j * n + k];
                A[j * n + k] = A[best * n + k];
                A[best * n + k] = held;
            }
        // eliminate below it
        for (int i = j + 1; i < n; i++) {
            double factor = A[i * n + j] / A[j * n + j];
            A[i * n + j] = factor;
            for (int k = j + 1; k < n; k++)
                A[i * n + k] -= factor * A[j * n + k];
        }
    }
    return 0;
}

void lu_solve(int n, const double *LU, const int *pivot, double *b)
{
    for (int i = 0; i < n; i++) {
        double held = b[pivot[i]];
        b[pivot[i]] = b[i];
        b[i] = held;
    }
    for (int i = 1; i < n; i++)
        for (int k = 0; k < i; k++)
            b[i] -= LU[i * n + k] * b[k];
    for (int i = n - 1; i >= 0; i--) {
        for (int k = i + 1; k < n; k++)
            b[i] -= LU[i * n + k] * b[k];
        b[i] /= LU[i * n + i];
    }
}
