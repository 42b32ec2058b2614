// Transfer matrices of the elements: symplectic with determinant 1 (any element whose equations are
// M eta_dot = h + L_I^T F_I - L_O^T F_O must be), and against plain Newton-Euler equations.
#include "elements/tube/transfer.h"
#include "model/model.h"

#include <string.h>

#include "elements/tube/tube_dynamics.h"
#include "math/matrices/dense.h"
#include "support/check.h"
#include "support/draw.h"
#include "support/reference_model.h"

enum { CASES = 200 };

// Homogeneous part in the order [a; alpha; f; m].
static void homogeneous(const transfer_matrix *U, double H[12][12])
{
    static const int place[12] = {0, 1, 2, 3, 4, 5, 9, 10, 11, 6, 7, 8};
    for (int i = 0; i < 12; i++)
        for (int j = 0; j < 12; j++)
            H[i][j] = U->u[place[i]][place[j]];
}

// Largest entry of H^T S H - S over the largest product that enters it.
static double symplectic_error(const transfer_matrix *U)
{
    double H[12][12], error = 0, size = 1;
    homogeneous(U, H);
    for (int i = 0; i < 12; i++)
        for (int j = 0; j < 12; j++) {
            double sum = 0;
            for (int k = 0; k < 6; k++) {
                double forward = H[k][i] * H[6 + k][j], backward = H[6 + k][i] * H[k][j];
                sum += forward - backward;
                size = fmax(size, fmax(fabs(forward), fabs(backward)));
            }
            sum -= j == i + 6 ? 1 : i == j + 6 ? -1 : 0;
            error = fmax(error, fabs(sum));
        }
    return error / size;
}

static double determinant(const transfer_matrix *U)
{
    double H[12][12], det = 1;
    int pivot[12];
    homogeneous(U, H);
    if (lu_factor(12, &H[0][0], pivot))
        return 0;
    for (int i = 0; i < 12; i++)
        det *= pivot[i] == i ? H[i][i] : -H[i][i];
    return det;
}

static rigid_body draw_body(uint64_t *seed)
{
    rigid_body body = {.mass = 2 + draw(seed), .center = draw_v3(seed, 0.5)};
    m3 c = m3_skew(body.center);
    body.inertia = m3_sub(draw_inertia(seed, body.mass), m3_scale(body.mass, m3_mul(c, c)));
    return body;
}

static void test_rigid_body_is_symplectic(void **state)
{
    (void)state;
    uint64_t seed = 1;
    double error = 0, det = 0;
    for (int i = 0; i < CASES; i++) {
        transfer_matrix U;
        rigid_body body = draw_body(&seed);
        body.output = draw_v3(&seed, 1);
        v3 w = draw_v3(&seed, 5), g = draw_v3(&seed, 10);
        rigid_body_transfer(&U, &body, w, g, draw_v3(&seed, 20), draw_v3(&seed, 20));
        error = fmax(error, symplectic_error(&U));
        det = fmax(det, fabs(determinant(&U) - 1));
    }
    CHECK_BELOW("rigid body: U' S U - S", error, 1e-15);
    CHECK_BELOW("rigid body: det U - 1", det, 5e-15);
}

// The balances of momentum and of moment of momentum about the mass centre, written down afresh.
static void test_rigid_body_obeys_newton_and_euler(void **state)
{
    (void)state;
    uint64_t seed = 2;
    double error = 0;
    for (int i = 0; i < CASES; i++) {
        transfer_matrix U;
        rigid_body body = {.mass = 2 + draw(&seed), .center = draw_v3(&seed, 0.5)};
        m3 J = draw_inertia(&seed, body.mass), c = m3_skew(body.center);
        body.inertia = m3_sub(J, m3_scale(body.mass, m3_mul(c, c)));
        v3 r = draw_v3(&seed, 1), w = draw_v3(&seed, 5), g = draw_v3(&seed, 10);
        v3 f = draw_v3(&seed, 20), m_I = draw_v3(&seed, 20);
        body.output = r;
        rigid_body_transfer(&U, &body, w, g, f, m_I);

        double z_I[13], z_O[13];
        for (int k = 0; k < 12; k++)
            z_I[k] = 10 * draw(&seed);
        z_I[12] = 1;
        transfer_apply(z_O, &U, z_I, 3.0);
        v3 a_I = v3_from(z_I), alpha = v3_from(z_I + 3), mom_I = v3_from(z_I + 6);
        v3 f_I = v3_from(z_I + 9), mom_O = v3_from(z_O + 6), f_O = v3_from(z_O + 9);

        // momentum
        v3 a_C = v3_add(
            a_I, v3_add(v3_cross(alpha, body.center), v3_cross(w, v3_cross(w, body.center))));
        v3 weight = v3_scale(body.mass, g);
        v3 balance = v3_sub(v3_add(v3_add(f_I, f), weight), v3_add(f_O, v3_scale(body.mass, a_C)));
        error = fmax(error, v3_norm(balance));
        // moment of momentum about C: each force by its arm
        v3 r_CI = v3_neg(body.center), r_CO = v3_sub(r, body.center);
        v3 moment = v3_add(mom_I, v3_add(m_I, v3_cross(r_CI, v3_add(f_I, f))));
        moment = v3_sub(moment, v3_add(mom_O, v3_cross(r_CO, f_O)));
        v3 rate = v3_add(m3_apply(J, alpha), v3_cross(w, m3_apply(J, w)));
        error = fmax(error, v3_norm(v3_sub(moment, rate)));
        // kinematics
        v3 a_O = v3_add(a_I, v3_add(v3_cross(alpha, r), v3_cross(w, v3_cross(w, r))));
        error = fmax(error, v3_norm(v3_sub(a_O, v3_from(z_O))));
        error = fmax(error, v3_norm(v3_sub(alpha, v3_from(z_O + 3))));
    }
    CHECK_BELOW("rigid body: Newton-Euler balance", error, 1e-13);
}

// A flexible body with random well-conditioned data; its n speeds begin with those of a frame.
typedef struct flexible_case {
    int n;
    double M[TRANSFER_SPEEDS * TRANSFER_SPEEDS], h[TRANSFER_SPEEDS], B[TRANSFER_SPEEDS];
    double L_I[6 * TRANSFER_SPEEDS], L_O[6 * TRANSFER_SPEEDS], gamma_I[6], gamma_O[6];
} flexible_case;

static void draw_flexible(flexible_case *x, int n, uint64_t *seed)
{
    memset(x, 0, sizeof *x);
    x->n = n;
    for (int i = 0; i < n; i++) {
        x->h[i] = 10 * draw(seed);
        x->B[i] = draw(seed);
        for (int j = 0; j <= i; j++)
            x->M[i * n + j] = x->M[j * n + i] = i == j ? 4 + draw(seed) : draw(seed) / n;
    }
    for (int i = 0; i < 6; i++) {
        x->gamma_I[i] = draw(seed);
        x->gamma_O[i] = draw(seed);
        for (int j = 0; j < n; j++) {
            x->L_I[i * n + j] = i == j ? 1 : 0;
            x->L_O[i * n + j] = (i == j) + 0.3 * draw(seed);
        }
    }
}

static flexible_body view(const flexible_case *x, int with_B)
{
    return (flexible_body){x->n,   x->M,   x->h,       with_B ? x->B : NULL,
                           x->L_I, x->L_O, x->gamma_I, x->gamma_O};
}

static void test_flexible_body_is_symplectic(void **state)
{
    (void)state;
    static flexible_case x;
    uint64_t seed = 3;
    double error = 0, det = 0, worst = 0;
    for (int i = 0; i < CASES; i++) {
        transfer_matrix U;
        double condition;
        draw_flexible(&x, 6 + i % 20, &seed);
        flexible_body body = view(&x, 1);
        assert_int_equal(flexible_body_transfer(&U, &body, &condition, NULL), LD_OK);
        error = fmax(error, symplectic_error(&U));
        det = fmax(det, fabs(determinant(&U) - 1));
        worst = fmax(worst, condition);
    }
    CHECK_BELOW("flexible body: U' S U - S", error, 2e-14);
    CHECK_BELOW("flexible body: det U - 1", det, 2e-14);
    CHECK_WITHIN("flexible body: worst condition met", worst, 6, 12);
}

// eta_dot from the body's own equation with the wrenches that U gave: both ends must move as U
// says.
static void test_flexible_body_obeys_its_equation(void **state)
{
    (void)state;
    static flexible_case x;
    static double G[TRANSFER_SPEEDS * TRANSFER_SPEEDS];
    uint64_t seed = 4;
    double error = 0;
    for (int i = 0; i < CASES; i++) {
        transfer_matrix U;
        int n = 6 + i % 20;
        double z_I[13], z_O[13], eta_dot[TRANSFER_SPEEDS], N = 2 * draw(&seed);
        draw_flexible(&x, n, &seed);
        flexible_body body = view(&x, 1);
        assert_int_equal(flexible_body_transfer(&U, &body, NULL, NULL), LD_OK);
        for (int k = 0; k < 12; k++)
            z_I[k] = 3 * draw(&seed);
        z_I[12] = 1;
        transfer_apply(z_O, &U, z_I, N);
        for (int k = 0; k < n; k++) {
            eta_dot[k] = x.h[k] - x.B[k] * N;
            for (int j = 0; j < 3; j++) {
                eta_dot[k] += x.L_I[j * n + k] * z_I[9 + j] + x.L_I[(3 + j) * n + k] * z_I[6 + j];
                eta_dot[k] -= x.L_O[j * n + k] * z_O[9 + j] + x.L_O[(3 + j) * n + k] * z_O[6 + j];
            }
        }
        memcpy(G, x.M, (size_t)(n * n) * sizeof *G);
        assert_int_equal(cholesky_factor(n, G), 0);
        cholesky_solve(n, G, eta_dot);
        for (int j = 0; j < 6; j++) {
            double at_I = x.gamma_I[j] - z_I[j], at_O = x.gamma_O[j] - z_O[j];
            for (int k = 0; k < n; k++) {
                at_I += x.L_I[j * n + k] * eta_dot[k];
                at_O += x.L_O[j * n + k] * eta_dot[k];
            }
            error = fmax(error, fmax(fabs(at_I), fabs(at_O)));
        }
    }
    CHECK_BELOW("flexible body: equation of motion", error, 5e-14);
}

// A rigid body written as a flexible one with six speeds has the same U.
static void test_six_speeds_are_the_rigid_body(void **state)
{
    (void)state;
    uint64_t seed = 5;
    double error = 0;
    for (int i = 0; i < CASES; i++) {
        transfer_matrix rigid, flexible;
        rigid_body b = draw_body(&seed);
        v3 r = draw_v3(&seed, 1), w = draw_v3(&seed, 2);
        m3 mc = m3_scale(b.mass, m3_skew(b.center)), r_skew = m3_skew(r);
        double M[36] = {0}, h[6], L_I[36] = {0}, L_O[36] = {0}, gamma_I[6] = {0}, gamma_O[6] = {0};
        for (int j = 0; j < 3; j++) {
            M[6 * j + j] = b.mass;
            L_I[7 * j] = L_I[7 * j + 21] = L_O[7 * j] = L_O[7 * j + 21] = 1;
            for (int k = 0; k < 3; k++) {
                M[6 * j + 3 + k] = -mc.a[j][k];
                M[6 * (3 + j) + k] = mc.a[j][k];
                M[6 * (3 + j) + 3 + k] = b.inertia.a[j][k];
                L_O[6 * j + 3 + k] = -r_skew.a[j][k];
            }
        }
        v3_store(gamma_O, v3_cross(w, v3_cross(w, r)));
        v3_store(h, v3_scale(-b.mass, v3_cross(w, v3_cross(w, b.center))));
        v3_store(h + 3, v3_neg(v3_cross(w, m3_apply(b.inertia, w))));
        flexible_body body = {6, M, h, NULL, L_I, L_O, gamma_I, gamma_O};
        b.output = r;
        rigid_body_transfer(&rigid, &b, w, v3_zero(), v3_zero(), v3_zero());
        assert_int_equal(flexible_body_transfer(&flexible, &body, NULL, NULL), LD_OK);
        for (int j = 0; j < 13; j++)
            for (int k = 0; k < 14; k++)
                error = fmax(error, fabs(rigid.u[j][k] - flexible.u[j][k]));
    }
    CHECK_BELOW("flexible body of six speeds = rigid body", error, 2e-12);
}

// Products carry the column of N along: z through two elements one by one or at once.
static void test_product_is_the_chain(void **state)
{
    (void)state;
    static flexible_case x;
    uint64_t seed = 6;
    double error = 0;
    for (int i = 0; i < CASES; i++) {
        transfer_matrix tail, tube, both;
        rigid_body b = draw_body(&seed);
        b.output = draw_v3(&seed, 1);
        rigid_body_transfer(&tail, &b, draw_v3(&seed, 2), v3_zero(), v3_zero(), v3_zero());
        draw_flexible(&x, 12, &seed);
        flexible_body body = view(&x, 1);
        assert_int_equal(flexible_body_transfer(&tube, &body, NULL, NULL), LD_OK);
        double z[13] = {[12] = 1}, z_1[13], z_2[13], z_12[13], N = draw(&seed);
        for (int k = 0; k < 12; k++)
            z[k] = draw(&seed);
        transfer_multiply(&both, &tube, &tail);
        transfer_apply(z_1, &tail, z, N);
        transfer_apply(z_2, &tube, z_1, N);
        transfer_apply(z_12, &both, z, N);
        double size = 0;
        for (int k = 0; k < 13; k++)
            size = fmax(size, fabs(z_2[k]));
        for (int k = 0; k < 13; k++)
            error = fmax(error, fabs(z_2[k] - z_12[k]) / size);
    }
    CHECK_BELOW("product of U's against one by one", error, 5e-15);
}

// A bar with all its mass at its two ends: end-to-end mobility zero, refused with a reason.
static void test_singular_end_to_end_mobility_is_refused(void **state)
{
    (void)state;
    enum { n = 12 };
    double M[n * n] = {0}, h[n] = {0}, L_I[6 * n] = {0}, L_O[6 * n] = {0}, gamma[6] = {0};
    for (int i = 0; i < n; i++)
        M[i * n + i] = 1;
    for (int i = 0; i < 6; i++) {
        L_I[i * n + i] = 1;
        L_O[i * n + 6 + i] = 1;
    }
    flexible_body body = {n, M, h, NULL, L_I, L_O, gamma, gamma};
    transfer_matrix U;
    ld_error error;
    double condition = 0;
    assert_int_equal(flexible_body_transfer(&U, &body, &condition, &error), LD_ERR_NUMERIC);
    assert_true(condition > 1e14);
    assert_non_null(strstr(error.text, "reduced form"));
    M[5 * n + 5] = -1;
    assert_int_equal(flexible_body_transfer(&U, &body, &condition, &error), LD_ERR_NUMERIC);
    assert_non_null(strstr(error.text, "not positive definite"));
}

// The finite-element tube of the reference launcher, bent by centimetres and moving.
static void test_tube_is_symplectic(void **state)
{
    (void)state;
    ld_model model;
    ld_error error;
    flexible_tube tube;
    uint64_t seed = 9;
    double worst = 0, det = 0;
    reference_model(&model);
    assert_int_equal(flexible_tube_build(&tube, &model.tubes, &error), LD_OK);
    int modes = tube_mode_count(&tube);
    static double M[LD_TUBE_SPEEDS * LD_TUBE_SPEEDS], h[LD_TUBE_SPEEDS];
    for (int k = 0; k < CASES; k++) {
        double q[LD_TUBE_MODES], q_dot[LD_TUBE_MODES], condition;
        tube_section_state rear, tip;
        transfer_matrix U;
        v3 w = draw_v3(&seed, 3);
        for (int i = 0; i < modes; i++) {
            q[i] = 0.05 * draw(&seed) / (1 + i * i);
            q_dot[i] = draw(&seed);
        }
        const tube_motion motion = {w, draw_v3(&seed, 10), q, q_dot};
        tube_dynamics_assemble(&tube, &motion, M, h);
        tube_section(&tube, 0, w, q, q_dot, &rear);
        tube_section(&tube, tube.length, w, q, q_dot, &tip);
        flexible_body body = {.n = 6 + modes,
                              .M = M,
                              .h = h,
                              .L_I = rear.L,
                              .L_O = tip.L,
                              .gamma_I = rear.gamma,
                              .gamma_O = tip.gamma};
        assert_int_equal(flexible_body_transfer(&U, &body, &condition, &error), LD_OK);
        worst = fmax(worst, symplectic_error(&U));
        det = fmax(det, fabs(determinant(&U) - 1));
    }
    CHECK_BELOW("reference tube: U' S U - S", worst, 2e-15);
    CHECK_BELOW("reference tube: det U - 1", det, 3e-10);
    flexible_tube_free(&tube);
    reference_model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rigid_body_is_symplectic),
        cmocka_unit_test(test_rigid_body_obeys_newton_and_euler),
        cmocka_unit_test(test_flexible_body_is_symplectic),
        cmocka_unit_test(test_tube_is_symplectic),
        cmocka_unit_test(test_flexible_body_obeys_its_equation),
        cmocka_unit_test(test_six_speeds_are_the_rigid_body),
        cmocka_unit_test(test_product_is_the_chain),
        cmocka_unit_test(test_singular_end_to_end_mobility_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
