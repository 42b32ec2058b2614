// State vectors and transfer matrices of the transfer matrix method (formulation.md, section 2).
//
// At a connection point z = (a, alpha, m, f, 1): linear and angular acceleration, moment and force,
// all along common axes. At an input end the wrench acts ON the element, at an output end it is
// what the element exerts on the next one; so z_O of an element is z_I of the next.
// Column TRANSFER_N counts one scalar unknown N more (a generalised force inside the element):
// z_O = U z_I + u_N N. It is zero for elements without one.
#ifndef LD_MATH_TRANSFER_H
#define LD_MATH_TRANSFER_H

#include "math/vectors/mat3.h"

enum {
    TRANSFER_A = 0,     // linear acceleration
    TRANSFER_ALPHA = 3, // angular acceleration
    TRANSFER_M = 6,     // moment about the connection point
    TRANSFER_F = 9,     // force
    TRANSFER_ONE = 12,  // the constant 1
    TRANSFER_N = 13,    // the unknown N
    TRANSFER_ROWS = 13,
    TRANSFER_COLUMNS = 14,
};

typedef struct transfer_matrix {
    double u[TRANSFER_ROWS][TRANSFER_COLUMNS];
} transfer_matrix;

// E: the weld of two connection points that coincide.
LD_INLINE void transfer_identity(transfer_matrix *U)
{
    for (int i = 0; i < TRANSFER_ROWS; i++)
        for (int j = 0; j < TRANSFER_COLUMNS; j++)
            U->u[i][j] = i == j;
}

// The elements one after the other: `product` := `later` `earlier` (all three different objects).
LD_INLINE void transfer_multiply(transfer_matrix *product, const transfer_matrix *later,
                                 const transfer_matrix *earlier)
{
    for (int i = 0; i < TRANSFER_ROWS; i++) {
        for (int j = 0; j < TRANSFER_COLUMNS; j++) {
            double sum = j == TRANSFER_N ? later->u[i][j] : 0;
            for (int k = 0; k < TRANSFER_ROWS; k++)
                sum += later->u[i][k] * earlier->u[k][j];
            product->u[i][j] = sum;
        }
    }
}

// z_O = U z_I + u_N N
LD_INLINE void transfer_apply(double z_O[TRANSFER_ROWS], const transfer_matrix *U,
                              const double z_I[TRANSFER_ROWS], double N)
{
    for (int i = 0; i < TRANSFER_ROWS; i++) {
        double sum = U->u[i][TRANSFER_N] * N;
        for (int k = 0; k < TRANSFER_ROWS; k++)
            sum += U->u[i][k] * z_I[k];
        z_O[i] = sum;
    }
}

// U[row.., column..] += B
LD_INLINE void transfer_add_block(transfer_matrix *U, int row, int column, m3 B)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            U->u[row + i][column + j] += B.a[i][j];
}

// U[row.., column] += v
LD_INLINE void transfer_add_column(transfer_matrix *U, int row, int column, v3 v)
{
    U->u[row][column] += v.x;
    U->u[row + 1][column] += v.y;
    U->u[row + 2][column] += v.z;
}

#endif
