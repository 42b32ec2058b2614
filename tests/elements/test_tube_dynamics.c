// The tube's equation of motion against d'Alembert's principle for its mass points: positions in
// space alone, differentiated twice in time by differences of the whole path, integrated by Gauss
// quadrature. Nothing of sections 1 and 5 of the formulation enters the expected values but the
// displacement field.
#include "elements/tube/tube_dynamics.h"

#include <string.h>

#include "elements/tube/shortening.h"
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
static bool planes_differ, shortened;

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

// Slopes of the bending shapes.
static void slopes_at(double x, double slope[2][NB])
{
    double late = x > 0.5 * length ? x - 0.5 * length : 0;
    double raw[2][NB] = {{2 * x, 3 * x * x, 3 * late * late}, {2 * x, 3 * x * x, 3 * late * late}};
    if (planes_differ)
        raw[1][0] = 3 * x * x - 4 * x * x * x, raw[1][2] = 2 * late;
    memset(slope, 0, 2 * sizeof *slope);
    for (int plane = 0; plane < 2; plane++)
        for (int i = 0; i < NB; i++)
            for (int j = 0; j < NB; j++)
                slope[plane][i] += coefficient[plane][i][j] * raw[plane][j];
}

// int_0^x of the product of two slopes.
static double slope_product(double x, int plane, int i, int j)
{
    double middle = 0.5 * length, ends[3] = {0, fmin(x, middle), fmax(x, middle)}, sum = 0;
    for (int half = 0; half < (x > middle ? 2 : 1); half++)
        for (int k = 0; k < POINTS; k++) {
            double slope[2][NB], h = 0.5 * (ends[half + 1] - ends[half]);
            slopes_at(ends[half] + h * (1 + gauss_x[k]), slope);
            sum += h * gauss_w[k] * slope[plane][i] * slope[plane][j];
        }
    return sum;
}

// How far bending draws the point at x back, for two vectors of the modes.
static double drawn(double x, const double *p, const double *q)
{
    double sum = 0;
    for (int plane = 0; plane < 2 && shortened; plane++)
        for (int i = 0; i < NB; i++)
            for (int j = 0; j < NB; j++)
                sum += p[plane * NB + i] * slope_product(x, plane, i, j) * q[plane * NB + j];
    return sum;
}

static tube_shortening *make_shortening(void)
{
    static double first[2][NB][NB], second[2][NB][NB];
    static tube_shortening self = {2, NB * NB, first[0][0], second[0][0], NULL};
    memset(first, 0, sizeof first);
    memset(second, 0, sizeof second);
    for (int k = 0; k < 2 * POINTS; k++) {
        double dx, x = station(k, &dx), dm = line_mass * dx;
        for (int plane = 0; plane < 2; plane++)
            for (int i = 0; i < NB; i++)
                for (int j = 0; j < NB; j++) {
                    double H = slope_product(x, plane, i, j);
                    first[plane][i][j] += H * dm;
                    second[plane][i][j] += x * H * dm;
                }
    }
    return shortened ? &self : NULL;
}

static flexible_tube make_tube(void)
{
    static tube_overlap overlap;
    flexible_tube tube = {.nb = NB, .nbp = NB, .nt = NT, .na = NA, .length = length};
    memset(&overlap, 0, sizeof overlap);
    tube.overlap = planes_differ ? &overlap : NULL;
    orthonormalise(OF_Y, NB, line_mass);
    orthonormalise(OF_Z, NB, line_mass);
    orthonormalise(OF_TAU, NT, line_polar);
    orthonormalise(OF_A, NA, line_mass);
    tube.shortening = make_shortening();
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

// Its position in space at time t on the path with constant v, w (in space) and q_dot: R(0) = E; or
// that of R's origin, or what foreshortening adds to a position.
typedef enum part_kind { BENT, ORIGIN, DRAWN } part_kind;

typedef struct path {
    v3 v;
    tube_motion m;
} path;

static v3 place(part_kind part, const path *on, double t, double x)
{
    double now[MODES];
    for (int i = 0; i < MODES; i++)
        now[i] = on->m.q[i] + t * on->m.q_dot[i];
    v3 p = part == BENT     ? axis_point(x, now)
           : part == ORIGIN ? v3_zero()
                            : v3_make(-0.5 * drawn(x, now, now), 0, 0);
    v3 turned = m3_apply(rv_exp(v3_scale(t, on->m.w)), p);
    return part == DRAWN ? turned : v3_add(v3_scale(t, on->v), turned);
}

// Its acceleration: sixth-order central difference.
static v3 path_acceleration(part_kind part, const path *on, double x)
{
    static const double weight[4] = {-49.0 / 18, 3.0 / 2, -3.0 / 20, 1.0 / 90};
    const double t = 2e-3;
    v3 a = v3_scale(weight[0], place(part, on, 0, x));
    for (int i = 1; i < 4; i++) {
        v3 pair = v3_add(place(part, on, i * t, x), place(part, on, -i * t, x));
        a = v3_axpy(a, weight[i], pair);
    }
    return v3_scale(1 / (t * t), a);
}

// Partial velocities of a part.
static void partials(part_kind part, const path *on, double x, v3 partial[SPEEDS])
{
    shapes s = shapes_at(x);
    v3 p = place(part, on, 0, x);
    memset(partial, 0, SPEEDS * sizeof *partial);
    if (part != DRAWN)
        partial[0].x = partial[1].y = partial[2].z = 1;
    for (int i = 0; i < 3; i++)
        partial[3 + i] = v3_cross(m3_column(m3_identity(), i), p);
    for (int i = 0; part == BENT && i < NB; i++) {
        partial[6 + i].y = s.b[PLANE_Y][i];
        partial[6 + NB + i].z = s.b[PLANE_Z][i];
    }
    for (int i = 0; part == BENT && i < NA; i++)
        partial[6 + 2 * NB + NT + i].x = s.a[i];
    for (int i = 0; part == DRAWN && i < 2 * NB; i++) {
        double unit[MODES] = {0};
        unit[i] = 1;
        partial[6 + i].x = -drawn(x, unit, on->m.q);
    }
}

// Equations of motion of a mass point with the kinetic energy 1/2 |V|^2 + V_origin . V_drawn.
typedef struct equations {
    double M[SPEEDS][SPEEDS], h[SPEEDS];
} equations;

// The part of the product of the velocities of two parts, half of it where they are the same.
static void add_product(const part_kind of[2], const path *on, double x, double dm, equations *to)
{
    v3 partial[2][SPEEDS], a[2];
    double weight = of[0] == of[1] ? 0.5 * dm : dm;
    for (int i = 0; i < 2; i++) {
        partials(of[i], on, x, partial[i]);
        a[i] = path_acceleration(of[i], on, x);
    }
    const v3 *weighs = partial[of[0] == BENT ? 0 : 1];
    for (int i = 0; i < SPEEDS; i++) {
        to->h[i] -= weight * (v3_dot(partial[0][i], a[1]) + v3_dot(partial[1][i], a[0]));
        to->h[i] += dm * v3_dot(weighs[i], on->m.g);
        for (int j = 0; j < SPEEDS; j++)
            to->M[i][j] += weight * (v3_dot(partial[0][i], partial[1][j]) +
                                     v3_dot(partial[1][i], partial[0][j]));
    }
}

// Share e = -q . int x H dm q/j0 of the second moment that foreshortening takes.
static double share_of(const flexible_tube *tube, const double *q)
{
    double sum = 0;
    for (int k = 0; k < 2 * POINTS; k++) {
        double dx, x = station(k, &dx);
        sum -= x * drawn(x, q, q) * line_mass * dx;
    }
    return sum / tube->j0;
}

// Of the kinetic energy e (j0 (w_y^2 + w_z^2)/2 + w_z c_y . q_y_dot - w_y c_z . q_z_dot): momenta
// of the speeds.
static void share_momenta(const flexible_tube *tube, v3 w, const double *q, const double *rate,
                          double p[SPEEDS])
{
    double share = share_of(tube, q);
    memset(p, 0, SPEEDS * sizeof *p);
    p[4] = share * tube->j0 * w.y;
    p[5] = share * tube->j0 * w.z;
    for (int i = 0; i < NB; i++) {
        p[4] -= share * tube->c[PLANE_Z][i] * rate[NB + i];
        p[5] += share * tube->c[PLANE_Y][i] * rate[i];
        p[6 + i] = share * w.z * tube->c[PLANE_Y][i];
        p[6 + NB + i] = -share * w.y * tube->c[PLANE_Z][i];
    }
}

// The equations of Boltzmann and Hamel for it: derivatives in time and along q by differences, both
// of polynomials of the second degree.
static void add_share(const flexible_tube *tube, const tube_motion *motion, equations *to)
{
    const double step = 1e-3, *q = motion->q, *q_dot = motion->q_dot;
    v3 w = motion->w;
    double *h = to->h;
    double p[SPEEDS], before[SPEEDS], after[SPEEDS], moved[2][MODES], still[MODES] = {0};
    for (int i = 0; i < MODES; i++)
        for (int side = 0; side < 2; side++)
            moved[side][i] = q[i] + (2 * side - 1) * step * q_dot[i];
    share_momenta(tube, w, q, q_dot, p);
    share_momenta(tube, w, moved[0], q_dot, before);
    share_momenta(tube, w, moved[1], q_dot, after);
    for (int i = 0; i < SPEEDS; i++)
        h[i] -= (after[i] - before[i]) / (2 * step);
    v3 turned = v3_cross(w, v3_from(p + 3));
    v3_store(h + 3, v3_sub(v3_from(h + 3), turned));
    for (int i = 0; i < MODES; i++) {
        double beside[MODES], energy[2];
        for (int side = 0; side < 2; side++) {
            memcpy(beside, q, sizeof beside);
            beside[i] += (2 * side - 1) * step;
            share_momenta(tube, w, beside, q_dot, p);
            energy[side] = 0.5 * v3_dot(v3_from(p + 3), w);
            for (int k = 0; k < MODES; k++)
                energy[side] += 0.5 * p[6 + k] * q_dot[k];
        }
        h[6 + i] += (energy[1] - energy[0]) / (2 * step);
    }
    for (int j = 3; j < SPEEDS; j++) {
        double unit[MODES] = {0};
        if (j >= 6)
            unit[j - 6] = 1;
        share_momenta(tube, v3_make(j == 3, j == 4, j == 5), q, j < 6 ? still : unit, p);
        for (int i = 0; i < SPEEDS; i++)
            to->M[i][j] += p[i];
    }
}

// Polar inertia, from T = 1/2 int rho I_p (w_x + tau . q_dot)^2 dx: the angular momentum l along
// R's x axis turns with R.
static void add_polar(double x, double dx, const tube_motion *motion, equations *to)
{
    shapes s = shapes_at(x);
    double turn[SPEEDS] = {[3] = 1}, rate = motion->w.x;
    for (int i = 0; i < NT; i++) {
        turn[6 + 2 * NB + i] = s.tau[i];
        rate += s.tau[i] * motion->q_dot[2 * NB + i];
    }
    for (int i = 0; i < SPEEDS; i++)
        for (int j = 0; j < SPEEDS; j++)
            to->M[i][j] += line_polar * dx * turn[i] * turn[j];
    to->h[4] -= line_polar * dx * rate * motion->w.z;
    to->h[5] += line_polar * dx * rate * motion->w.y;
}

static void add_springs(const flexible_tube *tube, const tube_motion *motion, equations *to)
{
    const double *q = motion->q, *q_dot = motion->q_dot;
    for (int i = 0; i < NB; i++) {
        to->h[6 + i] -= tube->om2_b[PLANE_Y][i] * q[i] + tube->dmp_b[PLANE_Y][i] * q_dot[i];
        to->h[6 + NB + i] -=
            tube->om2_b[PLANE_Z][i] * q[NB + i] + tube->dmp_b[PLANE_Z][i] * q_dot[NB + i];
    }
    for (int i = 0; i < NT; i++) {
        int k = 2 * NB + i, l = k + NT;
        to->h[6 + k] -= tube->om2_t[i] * q[k] + tube->dmp_t[i] * q_dot[k];
        to->h[6 + l] -= tube->om2_a[i] * q[l] + tube->dmp_a[i] * q_dot[l];
    }
}

static equations expected(const flexible_tube *tube, const path *on)
{
    equations e = {{{0}}, {0}};
    for (int k = 0; k < 2 * POINTS; k++) {
        double dx, x = station(k, &dx), dm = line_mass * dx;
        add_product((part_kind[]){BENT, BENT}, on, x, dm, &e);
        if (shortened)
            add_product((part_kind[]){ORIGIN, DRAWN}, on, x, dm, &e);
        add_polar(x, dx, &on->m, &e);
    }
    add_share(tube, &on->m, &e);
    add_springs(tube, &on->m, &e);
    return e;
}

static void check_equation_of_motion(void)
{
    flexible_tube tube = make_tube();
    uint64_t seed = 11;
    double mass_error = 0, force_error = 0, force_size = 0, energy_error = 0;
    for (int sample = 0; sample < 20; sample++) {
        double q[MODES], q_dot[MODES], M[SPEEDS * SPEEDS], h[SPEEDS];
        v3 v = draw_v3(&seed, 3), w = draw_v3(&seed, 3), g = draw_v3(&seed, 10);
        for (int i = 0; i < MODES; i++) {
            q[i] = 0.3 * draw(&seed);
            q_dot[i] = 2 * draw(&seed);
        }
        const path on = {v, {w, g, q, q_dot}};
        tube_dynamics_assemble(&tube, &on.m, M, h);
        equations e = expected(&tube, &on);
        double eta[SPEEDS] = {v.x, v.y, v.z, w.x, w.y, w.z}, energy = 0;
        memcpy(eta + 6, q_dot, sizeof q_dot);
        for (int i = 0; i < SPEEDS; i++) {
            force_error = fmax(force_error, fabs(h[i] - e.h[i]));
            force_size = fmax(force_size, fabs(h[i]));
            for (int j = 0; j < SPEEDS; j++) {
                mass_error = fmax(mass_error, fabs(M[i * SPEEDS + j] - e.M[i][j]));
                energy += 0.5 * eta[i] * e.M[i][j] * eta[j];
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

// With foreshortening, the kinetic energy ends with the second order of the modes.
static void test_geometric_stiffness(void **state)
{
    (void)state;
    shortened = true;
    for (int i = 0; i < 2; i++) {
        planes_differ = i;
        check_equation_of_motion();
    }
    shortened = false;
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_equation_of_motion),
                                       cmocka_unit_test(test_planes_with_shapes_of_their_own),
                                       cmocka_unit_test(test_geometric_stiffness)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
