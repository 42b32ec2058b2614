// A chain of 10,000 bodies against an articulated-body recursion in extended precision, written
// here in body axes with full 6 x 6 matrices (angular part first): another form, other axes, other
// code.
#include "launchdyn/mstmm.h"

#include <stdlib.h>
#include <string.h>

#include "support/check.h"
#include "support/draw.h"

enum { N = 10000 };

typedef long double real;

static ld_mstmm_element element[N];
static char name[N][8];
static double q[N], u[N], tau[N], u_dot[N];

// Angles, rates and torques at random. Angles up to +-`spread`: with 3 rad the chain is crumpled
// and soon forgets what happens far away; with 1 rad it is a long stiff spiral that passes twist
// and pull on, and its accelerations answer to the last bit of the description accordingly.
static void draw_chain(uint64_t seed, double spread)
{
    for (int i = 0; i < N; i++) {
        double r[16];
        for (int k = 0; k < 16; k++)
            r[k] = draw(&seed);
        snprintf(name[i], sizeof name[i], "%d", i);
        element[i] =
            (ld_mstmm_element){.name = name[i],
                               .parent = i ? name[i - 1] : NULL,
                               .at = {i ? 0.2 + 0.02 * r[0] : 0, 0.01 * r[1], 0.02 * r[2]},
                               .hinge = LD_HINGE_REVOLUTE,
                               .axis = {0.3 * r[3], i % 2 ? 1 : 0.3 * r[4], i % 2 ? 0.3 * r[5] : 1},
                               .mass = 1.3 + 0.3 * r[6],
                               .center = {0.1 + 0.01 * r[7], 0.012 * r[8], 0.008 * r[9]},
                               .inertia = {0.0021 + 0.0001 * r[10], 0.0058, 0.0062, 0.0002 * r[11],
                                           0.0001 * r[12], 0.00015}};
        q[i] = spread * r[13];
        u[i] = r[14];
        tau[i] = r[15];
    }
}

// X: motion transform from parent axes and origin to the body's (angular first), from E (parent to
// body axes) and r (body's origin in parent axes).
static void transform(real X[6][6], real E[3][3], const double r[3])
{
    real skew[3][3] = {{0, -r[2], r[1]}, {r[2], 0, -r[0]}, {-r[1], r[0], 0}};
    memset(X, 0, 36 * sizeof X[0][0]);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            X[i][j] = X[3 + i][3 + j] = E[i][j];
            for (int k = 0; k < 3; k++)
                X[3 + i][j] -= E[i][k] * skew[k][j];
        }
}

static void cross(const real a[3], const real b[3], real out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static void articulated_bodies(real *out)
{
    static real X[N][6][6], S[N][6], v[N][6], c[N][6], IA[N][6][6], p[N][6], U[N][6], D[N], b[N];
    for (int i = 0; i < N; i++) {
        const ld_mstmm_element *e = &element[i];
        real n = 0, axis[3], s = sinl(q[i]), h = 1 - cosl(q[i]), E[3][3];
        for (int k = 0; k < 3; k++)
            n += (real)e->axis[k] * e->axis[k];
        for (int k = 0; k < 3; k++)
            axis[k] = e->axis[k] / sqrtl(n);
        // E = rotation by -q about the axis
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                E[j][k] = h * axis[j] * axis[k] + (j == k ? 1 - h : 0);
        for (int j = 0; j < 3; j++) {
            int k = (j + 1) % 3, l = (j + 2) % 3;
            E[j][k] += s * axis[l];
            E[k][j] -= s * axis[l];
        }
        transform(X[i], E, e->at);
        for (int j = 0; j < 6; j++) {
            S[i][j] = j < 3 ? axis[j] : 0;
            v[i][j] = S[i][j] * u[i];
            for (int k = 0; i > 0 && k < 6; k++)
                v[i][j] += X[i][j][k] * v[i - 1][k];
        }
        // bias v x S u, inertia about the origin, gyroscopic wrench v x* I v
        real spin[3] = {S[i][0] * u[i], S[i][1] * u[i], S[i][2] * u[i]};
        cross(v[i], spin, c[i]);
        cross(v[i] + 3, spin, c[i] + 3);
        real m = e->mass, mc[3] = {m * e->center[0], m * e->center[1], m * e->center[2]};
        const double *J = e->inertia;
        real I[3][3] = {{J[0], J[3], J[4]}, {J[3], J[1], J[5]}, {J[4], J[5], J[2]}};
        real skew[3][3] = {{0, -mc[2], mc[1]}, {mc[2], 0, -mc[0]}, {-mc[1], mc[0], 0}};
        memset(IA[i], 0, sizeof IA[i]);
        for (int j = 0; j < 3; j++) {
            IA[i][3 + j][3 + j] = m;
            for (int k = 0; k < 3; k++) {
                IA[i][j][k] = I[j][k];
                for (int l = 0; l < 3; l++)
                    IA[i][j][k] -= skew[j][l] * skew[l][k] / m;
                IA[i][j][3 + k] = skew[j][k];
                IA[i][3 + j][k] = -skew[j][k];
            }
        }
        real momentum[6], first[3], second[3];
        for (int j = 0; j < 6; j++) {
            momentum[j] = 0;
            for (int k = 0; k < 6; k++)
                momentum[j] += IA[i][j][k] * v[i][k];
        }
        cross(v[i], momentum, first);
        cross(v[i] + 3, momentum + 3, second);
        for (int j = 0; j < 3; j++)
            p[i][j] = first[j] + second[j];
        cross(v[i], momentum + 3, p[i] + 3);
    }
    for (int i = N - 1; i >= 0; i--) {
        D[i] = 0;
        b[i] = tau[i];
        for (int j = 0; j < 6; j++) {
            U[i][j] = 0;
            for (int k = 0; k < 6; k++)
                U[i][j] += IA[i][j][k] * S[i][k];
        }
        for (int j = 0; j < 6; j++) {
            D[i] += S[i][j] * U[i][j];
            b[i] -= S[i][j] * p[i][j];
        }
        if (i == 0)
            break;
        real Ia[6][6], pa[6], XI[6][6];
        for (int j = 0; j < 6; j++)
            for (int k = 0; k < 6; k++)
                Ia[j][k] = IA[i][j][k] - U[i][j] * U[i][k] / D[i];
        for (int j = 0; j < 6; j++) {
            pa[j] = p[i][j] + U[i][j] * b[i] / D[i];
            for (int k = 0; k < 6; k++)
                pa[j] += Ia[j][k] * c[i][k];
        }
        for (int j = 0; j < 6; j++)
            for (int k = 0; k < 6; k++) {
                XI[j][k] = 0;
                for (int l = 0; l < 6; l++)
                    XI[j][k] += X[i][l][j] * Ia[l][k];
            }
        for (int j = 0; j < 6; j++) {
            for (int k = 0; k < 6; k++)
                p[i - 1][j] += X[i][k][j] * pa[k];
            for (int k = 0; k < 6; k++)
                for (int l = 0; l < 6; l++)
                    IA[i - 1][j][k] += XI[j][l] * X[i][l][k];
        }
    }
    real a[6] = {0, 0, 0, 0, 0, 9.81};
    for (int i = 0; i < N; i++) {
        real here[6];
        for (int j = 0; j < 6; j++) {
            here[j] = c[i][j];
            for (int k = 0; k < 6; k++)
                here[j] += X[i][j][k] * a[k];
        }
        out[i] = b[i] / D[i];
        for (int j = 0; j < 6; j++)
            out[i] -= U[i][j] * here[j] / D[i];
        for (int j = 0; j < 6; j++)
            a[j] = here[j] + S[i][j] * out[i];
    }
}

// Largest error over the largest acceleration; `sensitivity`: the same for the exact solution after
// a change of the description by one unit in the last place.
static double error_of_chain(uint64_t seed, double spread, double *sensitivity)
{
    static real expected[N], moved[N];
    const double gravity[3] = {0, 0, -9.81};
    ld_mstmm *system;
    ld_error error = {0};
    double size = 0, off = 0, change = 0;
    draw_chain(seed, spread);
    if (ld_mstmm_create(element, N, gravity, &system, &error))
        fail_msg("%s", error.text);
    assert_int_equal(ld_mstmm_accelerations(system, q, u, tau, NULL, u_dot, &error), LD_OK);
    ld_mstmm_free(system);
    articulated_bodies(expected);
    for (int i = 1; i < N; i++)
        element[i].at[0] = nextafter(element[i].at[0], draw(&seed));
    articulated_bodies(moved);
    for (int i = 0; i < N; i++) {
        size = fmax(size, (double)fabsl(expected[i]));
        off = fmax(off, (double)fabsl(u_dot[i] - expected[i]));
        change = fmax(change, (double)fabsl(moved[i] - expected[i]));
    }
    *sensitivity = change / size;
    return off / size;
}

static void test_ten_thousand_bodies(void **state)
{
    (void)state;
    double crumpled = 0, stiff = 0, sensitivity;
    for (uint64_t seed = 5; seed < 9; seed++) {
        crumpled = fmax(crumpled, error_of_chain(seed, 3, &sensitivity));
        double off = error_of_chain(seed, 1, &sensitivity);
        stiff = fmax(stiff, off / sensitivity);
        printf("    stiff spiral: error %.1e, one unit in the last place of the description "
               "gives %.1e\n",
               off, sensitivity);
    }
    CHECK_BELOW("10,000 bodies: error over the largest acceleration", crumpled, 1e-13);
    CHECK_BELOW("stiff spiral: error over that of one unit", stiff, 5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_ten_thousand_bodies)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
