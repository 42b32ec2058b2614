#include "elements/tube/transfer.h"

#include <math.h>
#include <string.h>

#include "math/matrices/dense.h"

void rigid_body_transfer(transfer_matrix *U, const rigid_body *body, v3 w, v3 g, v3 f, v3 m_I)
{
    double m = body->mass;
    v3 c = body->center, r = body->output;
    m3 r_skew = m3_skew(r), mc_skew = m3_scale(m, m3_skew(c));
    transfer_identity(U);

    // a_O = a_I + alpha x r + w x (w x r)
    transfer_add_block(U, TRANSFER_A, TRANSFER_ALPHA, m3_scale(-1, r_skew));
    transfer_add_column(U, TRANSFER_A, TRANSFER_ONE, v3_cross(w, v3_cross(w, r)));

    // f_O = f_I + f + m g - m (a_I + alpha x c + w x (w x c))
    v3 f_0 = v3_axpy(f, m, v3_sub(g, v3_cross(w, v3_cross(w, c))));
    transfer_add_block(U, TRANSFER_F, TRANSFER_A, m3_diagonal(-m, -m, -m));
    transfer_add_block(U, TRANSFER_F, TRANSFER_ALPHA, mc_skew);
    transfer_add_column(U, TRANSFER_F, TRANSFER_ONE, f_0);

    // m_O = m_I + m_I,applied + c x m g - J alpha - w x J w - m c x a_I - r x f_O
    v3 m_0 =
        v3_sub(v3_add(m_I, v3_cross(c, v3_scale(m, g))), v3_cross(w, m3_apply(body->inertia, w)));
    transfer_add_block(U, TRANSFER_M, TRANSFER_A, m3_sub(m3_scale(m, r_skew), mc_skew));
    transfer_add_block(U, TRANSFER_M, TRANSFER_ALPHA,
                       m3_scale(-1, m3_add(body->inertia, m3_mul(r_skew, mc_skew))));
    transfer_add_block(U, TRANSFER_M, TRANSFER_F, m3_scale(-1, r_skew));
    transfer_add_column(U, TRANSFER_M, TRANSFER_ONE, v3_sub(m_0, v3_cross(r, f_0)));
}

// D [6 x 6] := X^T Y for the columns x_i, y_j [n] of two half-solved mappings.
static void fill_gram(int n, double X[6][TRANSFER_SPEEDS], double Y[6][TRANSFER_SPEEDS],
                      double D[6][6])
{
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++) {
            D[i][j] = 0;
            for (int k = 0; k < n; k++)
                D[i][j] += X[i][k] * Y[j][k];
        }
}

// Inverse of the 6 x 6 matrix D, its rows scaled by 1/row, its columns by 1/column; returns the
// 1-norm condition of the scaled matrix (infinite where it is singular).
static double scaled_inverse(double D[6][6], const double row[6], const double column[6],
                             double inverse[6][6])
{
    double factors[36], norm = 0, inverse_norm = 0;
    int pivot[6];
    for (int j = 0; j < 6; j++) {
        double sum = 0;
        for (int i = 0; i < 6; i++) {
            factors[6 * i + j] = D[i][j] / (row[i] * column[j]);
            sum += fabs(factors[6 * i + j]);
        }
        norm = fmax(norm, sum);
    }
    if (lu_factor(6, factors, pivot))
        return INFINITY;
    for (int j = 0; j < 6; j++) {
        double e[6] = {0}, sum = 0;
        e[j] = 1;
        lu_solve(6, factors, pivot, e);
        for (int i = 0; i < 6; i++) {
            sum += fabs(e[i]);
            inverse[i][j] = e[i] / (column[i] * row[j]);
        }
        inverse_norm = fmax(inverse_norm, sum);
    }
    return norm * inverse_norm;
}

ld_status flexible_body_transfer(transfer_matrix *U, const flexible_body *body, double *condition,
                                 ld_error *error)
{
    // the columns of G^-1 L^T, G^-1 h and G^-1 B, so that X Q Y^T are plain products
    enum { N = TRANSFER_SPEEDS };
    double G[N * N], X_I[6][N], X_O[6][N], load[2][N] = {{0}};
    int n = body->n;
    if (n > N)
        return ld_fail(error, LD_ERR_INPUT,
                       "a flexible element has %d speeds; at most %d are allowed", n, N);
    memcpy(G, body->M, (size_t)(n * n) * sizeof *G);
    if (cholesky_factor(n, G))
        return ld_fail(error, LD_ERR_NUMERIC,
                       "the mass matrix of a flexible element is not positive definite");
    for (int i = 0; i < 6; i++) {
        memcpy(X_I[i], body->L_I + i * n, (size_t)n * sizeof **X_I);
        memcpy(X_O[i], body->L_O + i * n, (size_t)n * sizeof **X_O);
        cholesky_forward(n, G, X_I[i]);
        cholesky_forward(n, G, X_O[i]);
    }
    for (int k = 0; k < n; k++) {
        load[0][k] = body->h[k];
        load[1][k] = body->B ? -body->B[k] : 0;
    }
    cholesky_forward(n, G, load[0]);
    cholesky_forward(n, G, load[1]);

    // mobilities D_XY = L_X Q L_Y^T
    double D_II[6][6], D_IO[6][6], D_OI[6][6], D_OO[6][6], inverse[6][6], row[6], column[6];
    fill_gram(n, X_I, X_I, D_II);
    fill_gram(n, X_I, X_O, D_IO);
    fill_gram(n, X_O, X_I, D_OI);
    fill_gram(n, X_O, X_O, D_OO);
    for (int i = 0; i < 6; i++) {
        row[i] = sqrt(D_II[i][i]);
        column[i] = sqrt(D_OO[i][i]);
    }
    double kappa = scaled_inverse(D_IO, row, column, inverse);
    if (condition)
        *condition = kappa;
    if (!(kappa < 1e14))
        return ld_fail(error, LD_ERR_NUMERIC,
                       "a flexible element has no transfer matrix: its mobility from end to end is "
                       "singular (condition %.1e); use the reduced form",
                       kappa);

    // what the right-hand sides of [a; alpha] are per unit of (a_I, alpha_I, f_I, m_I, 1, N)
    double end_I[6][14], end_O[6][14], F_O[6][14];
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 14; j++) {
            double unit_I = 0, unit_O = 0;
            if (j < 6) {
                unit_I = -(i == j);
            } else if (j < 12) {
                unit_I = D_II[i][j - 6];
                unit_O = D_OI[i][j - 6];
            } else {
                for (int k = 0; k < n; k++) {
                    unit_I += X_I[i][k] * load[j - 12][k];
                    unit_O += X_O[i][k] * load[j - 12][k];
                }
                unit_I += j == 12 ? body->gamma_I[i] : 0;
                unit_O += j == 12 ? body->gamma_O[i] : 0;
            }
            end_I[i][j] = unit_I;
            end_O[i][j] = unit_O;
        }
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 14; j++) {
            F_O[i][j] = 0;
            for (int k = 0; k < 6; k++)
                F_O[i][j] += inverse[i][k] * end_I[k][j];
        }
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 14; j++)
            for (int k = 0; k < 6; k++)
                end_O[i][j] -= D_OO[i][k] * F_O[k][j];

    // into the order of z: moment before force
    static const int place[14] = {0, 1, 2, 3, 4, 5, 9, 10, 11, 6, 7, 8, 12, 13};
    memset(U, 0, sizeof *U);
    U->u[TRANSFER_ONE][TRANSFER_ONE] = 1;
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 14; j++) {
            U->u[place[i]][place[j]] = end_O[i][j];
            U->u[place[6 + i]][place[j]] = F_O[i][j];
        }
    return LD_OK;
}
