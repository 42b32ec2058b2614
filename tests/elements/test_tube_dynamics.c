// The tube's equation of motion against d'Alembert's principle for its mass points: positions in
// space alone, differentiated twice in time by differences of the whole path, integrated by Gauss
// quadrature. Nothing of sections 1 and 5 of the formulation enters the expected values but the
// displacement field.
#include "elements/tube/tube_dynamics.h"

#include <string.h>

#include "math/vectors/rotation_vector.h"
#include "support/check.h"
#include "support/draw.h"

enum { NB = 3, NT = 2, NA = 2, MODES = 2 * NB + NT + NA, SPEEDS = 6 + MODES, POINTS = 7 };

// One element of length 1.3 m; shapes are polynomials without constant (and slope) at x = 0,
// made orthonormal in the mass 9 kg/m or the polar inertia 0.4 kg m.
static const double length = 1.3, line_mass = 9, line_polar = 0.4;
static const double gauss_x[POINTS] = {
    -0.9491079123427585, -0.7415311855993945, -0.4058451513773972, 0,
    0.4058451513773972,  0.7415311855993945,  0.9491079123427585};
static const double gauss_w[POINTS] = {0.1294849661688697, 0.2797053914892766, 0.3818300505051189,
                                       0.4179591836734694, 0.3818300505051189, 0.2797053914892766,
                                       0.1294849661688697};

// The shapes as functions of x: bending along y has cubics with b = b' = 0 at 0 on two halves of
// the tube, along z the same or, where the planes differ, others.
typedef struct shapes {
    double b[2][NB], tau[NT], a[NA];
} shapes;

enum { OF_Y, OF_Z, OF_TAU, OF_A, FAMILIES };

static double coefficient[FAMILIES][NB][NB];
static bool planes_differ;

static shapes raw_shapes(double x)
{
    double late = x > 0.5 * length ? x - 0.5 * length : 0, x2 = x * x, x3 = x2 * x;
    shapes raw = {
        {{x2, x3, late * late * late}, {x2, x3, late * late * late}}, {x, late}, {x, late}};
    if (planes_differ)
        raw.b[PLANE_Z][0] = x3 - x3 * x, raw.b[PLANE_Z][2] = late * late;
    return raw;
}

static shapes shapes_at(double x)
{
    shapes raw = raw_shapes(x), s = {0};
    for (int i = 0; i < NB; i++)
        for (int j = 0; j < NB; j++)
            for (int plane = PLANE_Y; plane <= PLANE_Z; plane++)
                s.b[plane][i] += coefficient[plane][i][j] * raw.b[plane][j];
    for (int i = 0; i < NT; i++)
        for (int j = 0; j < NT; j++) {
            s.tau[i] += coefficient[OF_TAU][i][j] * raw.tau[j];
            s.a[i] += coefficient[OF_A][i][j] * raw.a[j];
        }
    return s;
}

// Station and weight dx of quadrature point k of 2 POINTS (half by half: exact for these shapes).
static double station(int k, double *dx)
{
    double middle = length * (k < POINTS ? 0.25 : 0.75);
    *dx = gauss_w[k % POINTS] * length / 4;
    return middle + gauss_x[k % POINTS] * length / 4;
}

// Gram-Schmidt in the weight per length; `pick` returns raw shape j of the family at x.
static void orthonormalise(int family, int count, double per_length)
{
    double(*C)[NB] = coefficient[family];
    memset(C, 0, sizeof coefficient[family]);
    for (int i = 0; i < count; i++) {
        C[i][i] = 1;
        for (int pass = 0; pass < 2 * i + 1; pass++) {
            int other = pass < 2 * i ? pass % i : i;
            double inner = 0, dx;
            for (int k = 0; k < 2 * POINTS; k++) {
                double x = station(k, &dx);
                shapes s = shapes_at(x);
                const double *values = family <= OF_Z     ? s.b[family]
                                       : family == OF_TAU ? s.tau
                                                          : s.a;
                inner += per_length * values[i] * values[other] * dx;
            }
            for (int j = 0; j < count; j++) {
                if (other < i)
                    C[i][j] -= inner * C[other][j];
                else
                    C[i][j] /= sqrt(inner);
            }
        }
    }
}

static flexible_tube make_tube(void)
{
    static tube_overlap overlap;
    flexible_tube tube = {.nb = NB, .nt = NT, .na = NA, .length = length};
    memset(&overlap, 0, sizeof overlap);
    tube.overlap = planes_differ ? &overlap : NULL;
    orthonormalise(OF_Y, NB, line_mass);
    orthonormalise(OF_Z, NB, line_mass);
    orthonormalise(OF_TAU, NT, line_polar);
    orthonormalise(OF_A, NA, line_mass);
    for (int k = 0; k < 2 * POINTS; k++) {
        double dx, x = station(k, &dx), dm = line_mass * dx;
        shapes s = shapes_at(x);
        tube.m += dm;
        tube.s0 += x * dm;
        tube.j0 += x * x * dm;
        tube.j += line_polar * dx;
        for (int i = 0; i < NB; i++) {
            for (int plane = PLANE_Y; plane <= PLANE_Z; plane++) {
                tube.ct[plane][i] += s.b[plane][i] * dm;
                tube.c[plane][i] += x * s.b[plane][i] * dm;
            }
            for (int j = 0; j < NB; j++) {
                overlap.G[PLANE_Y][i][j] += s.b[PLANE_Y][i] * s.b[PLANE_Z][j] * dm;
                overlap.G[PLANE_Z][i][j] += s.b[PLANE_Z][i] * s.b[PLANE_Y][j] * dm;
            }
        }
        for (int i = 0; i < NT; i++)
            tube.cp[i] += line_polar * s.tau[i] * dx;
        for (int i = 0; i < NA; i++) {
            tube.at[i] += s.a[i] * dm;
            tube.ax[i] += x * s.a[i] * dm;
            for (int j = 0; j < NB; j++)
                for (int plane = PLANE_Y; plane <= PLANE_Z; plane++)
                    tube.AB[plane][i][j] += s.a[i] * s.b[plane][j] * dm;
        }
    }
    for (int i = 0; i < NB; i++) {
        tube.om2_b[PLANE_Y][i] = 300 * (i + 1);
        tube.om2_b[PLANE_Z][i] = 200 * (i + 2);
        tube.dmp_b[PLANE_Y][i] = 2 + i;
        tube.dmp_b[PLANE_Z][i] = 5 + i;
    }
    for (int i = 0; i < NT; i++) {
        tube.om2_t[i] = 500 * (i + 1);
        tube.dmp_t[i] = 3 + i;
        tube.om2_a[i] = 700 * (i + 1);
        tube.dmp_a[i] = 4 + i;
    }
    return tube;
}

// Axis point in R.
static v3 axis_point(double x, const double *q)
{
    shapes s = shapes_at(x);
    v3 p = v3_make(x, 0, 0);
    for (int i = 0; i < NB; i++) {
        p.y += s.b[PLANE_Y][i] * q[i];
        p.z += s.b[PLANE_Z][i] * q[NB + i];
    }
    for (int i = 0; i < NA; i++)
        p.x += s.a[i] * q[2 * NB + NT + i];
    return p;
}

// Its position in space at time t on the path with constant v, w (in space) and q_dot: R(0) = E.
static v3 place(double t, double x, v3 v, v3 w, const double *q, const double *q_dot)
{
    double now[MODES];
    for (int i = 0; i < MODES; i++)
        now[i] = q[i] + t * q_dot[i];
    return v3_add(v3_scale(t, v), m3_apply(rv_exp(v3_scale(t, w)), axis_point(x, now)));
}

static void check_equation_of_motion(void)
{
    flexible_tube tube = make_tube();
    uint64_t seed = 11;
    double mass_error = 0, force_error = 0, force_size = 0, energy_error = 0;
    for (int sample = 0; sample < 20; sample++) {
        double q[MODES], q_dot[MODES], M[SPEEDS * SPEEDS], h[SPEEDS];
        double M_expected[SPEEDS][SPEEDS] = {{0}}, h_expected[SPEEDS] = {0};
        v3 v = draw_v3(&seed, 3), w = draw_v3(&seed, 3), g = draw_v3(&seed, 10);
        for (int i = 0; i < MODES; i++) {
            q[i] = 0.3 * draw(&seed);
            q_dot[i] = 2 * draw(&seed);
        }
        tube_dynamics_assemble(&tube, &(tube_motion){w, g, q, q_dot}, M, h);

        for (int k = 0; k < 2 * POINTS; k++) {
            double dx, x = station(k, &dx), dm = line_mass * dx, t = 2e-3;
            shapes s = shapes_at(x);
            // partial velocities of this mass point
            v3 p = axis_point(x, q), partial[SPEEDS] = {{0, 0, 0}};
            partial[0].x = partial[1].y = partial[2].z = 1;
            for (int i = 0; i < 3; i++)
                partial[3 + i] = v3_cross(m3_column(m3_identity(), i), p);
            for (int i = 0; i < NB; i++) {
                partial[6 + i].y = s.b[PLANE_Y][i];
                partial[6 + NB + i].z = s.b[PLANE_Z][i];
            }
            for (int i = 0; i < NA; i++)
                partial[6 + 2 * NB + NT + i].x = s.a[i];
            // acceleration on a path with constant v, w, q_dot: sixth-order central difference
            static const double weight[4] = {-49.0 / 18, 3.0 / 2, -3.0 / 20, 1.0 / 90};
            v3 a = v3_scale(weight[0], p);
            for (int i = 1; i < 4; i++) {
                v3 pair = v3_add(place(i * t, x, v, w, q, q_dot), place(-i * t, x, v, w, q, q_dot));
                a = v3_axpy(a, weight[i], pair);
            }
            a = v3_scale(1 / (t * t), a);
            for (int i = 0; i < SPEEDS; i++) {
                h_expected[i] += dm * v3_dot(partial[i], v3_sub(g, a));
                for (int j = 0; j < SPEEDS; j++)
                    M_expected[i][j] += dm * v3_dot(partial[i], partial[j]);
            }
            // polar inertia, from T = 1/2 int rho I_p (w_x + tau . q_dot)^2 dx: the angular
            // momentum l along R's x axis turns with R
            double turn[SPEEDS] = {[3] = 1}, rate = w.x;
            for (int i = 0; i < NT; i++) {
                turn[6 + 2 * NB + i] = s.tau[i];
                rate += s.tau[i] * q_dot[2 * NB + i];
            }
            for (int i = 0; i < SPEEDS; i++)
                for (int j = 0; j < SPEEDS; j++)
                    M_expected[i][j] += line_polar * dx * turn[i] * turn[j];
            h_expected[4] -= line_polar * dx * rate * w.z;
            h_expected[5] += line_polar * dx * rate * w.y;
        }
        for (int i = 0; i < NB; i++) {
            h_expected[6 + i] -= tube.om2_b[PLANE_Y][i] * q[i] + tube.dmp_b[PLANE_Y][i] * q_dot[i];
            h_expected[6 + NB + i] -=
                tube.om2_b[PLANE_Z][i] * q[NB + i] + tube.dmp_b[PLANE_Z][i] * q_dot[NB + i];
        }
        for (int i = 0; i < NT; i++) {
            int k = 2 * NB + i, l = k + NT;
            h_expected[6 + k] -= tube.om2_t[i] * q[k] + tube.dmp_t[i] * q_dot[k];
            h_expected[6 + l] -= tube.om2_a[i] * q[l] + tube.dmp_a[i] * q_dot[l];
        }
        double eta[SPEEDS] = {v.x, v.y, v.z, w.x, w.y, w.z}, energy = 0;
        memcpy(eta + 6, q_dot, sizeof q_dot);
        for (int i = 0; i < SPEEDS; i++) {
            force_error = fmax(force_error, fabs(h[i] - h_expected[i]));
            force_size = fmax(force_size, fabs(h[i]));
            for (int j = 0; j < SPEEDS; j++) {
                mass_error = fmax(mass_error, fabs(M[i * SPEEDS + j] - M_expected[i][j]));
                energy += 0.5 * eta[i] * M_expected[i][j] * eta[j];
            }
        }
        double given = tube_kinetic_energy(&tube, v, w, q, q_dot);
        energy_error = fmax(energy_error, fabs(given / energy - 1));
    }
    CHECK_BELOW("mass matrix against quadrature of mass points", mass_error, 6e-15);
    CHECK_BELOW("forces against differentiated paths, relative", force_error / force_size, 1e-11);
    CHECK_BELOW("kinetic energy, relative", energy_error, 2e-15);
}

static void test_equation_of_motion(void **state)
{
    (void)state;
    planes_differ = false;
    check_equation_of_motion();
}

static void test_planes_with_shapes_of_their_own(void **state)
{
    (void)state;
    planes_differ = true;
    check_equation_of_motion();
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_equation_of_motion),
                                       cmocka_unit_test(test_planes_with_shapes_of_their_own)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
