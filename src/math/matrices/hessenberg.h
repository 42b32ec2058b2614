// Solutions of (i omega E - A) x = b for many omega and one real A, which is reduced once to the
// form of Hessenberg, H = X^-1 A X: n^2 operations each in place of n^3/3.
#ifndef LD_MATH_HESSENBERG_H
#define LD_MATH_HESSENBERG_H

#include <stdbool.h>

typedef struct hessenberg {
    int n;
    double *H;              // [n][n] by rows
    double *X, *inverse;    // [n][n] by columns: X, and X^-T
    double *rows, *spare;   // [n][2 n], [2 n]: a workspace
    bool wide_instructions; // AVX2 is there
} hessenberg;

// Room for matrices of n unknowns. Other than 0: no memory. Free with hessenberg_free().
int hessenberg_make(hessenberg *self, int n);
void hessenberg_free(hessenberg *self);

// Reduces A [n][n] by columns, which is balanced first. Other than 0: it cannot (what LAPACKE
// says).
int hessenberg_reduce(hessenberg *self, const double *A);

// z := (i omega E - H)^-1 z for `count` vectors, each its real parts [n], then imaginary ones [n].
// Other than 0: i omega is an eigenvalue.
int hessenberg_solve(const hessenberg *self, double omega, int count, double *z);

#endif
