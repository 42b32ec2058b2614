// Random trees with all kinds of hinges: the reduced sweep against a dense mass matrix built from
// positions alone. Every body's pose is a Taylor series in time, in extended precision; velocities
// and accelerations are its coefficients; the equations are d'Alembert's principle written body by
// body. No kinematics of the library enters.
#include "launchdyn/mstmm.h"

#include <stdlib.h>
#include <string.h>

#include "support/check.h"
#include "support/draw.h"

enum { TREES = 1000, BODIES = 9, SPEEDS = 6 * BODIES };

typedef long double real;

// ---- Taylor series in time to second order: value, rate, half the second derivative

typedef struct jet {
    real c[3];
} jet;
typedef struct jet3 {
    jet a[3];
} jet3;
typedef struct jet33 {
    jet a[3][3];
} jet33;

static jet add(jet x, jet y)
{
    return (jet){{x.c[0] + y.c[0], x.c[1] + y.c[1], x.c[2] + y.c[2]}};
}

static jet multiply(jet x, jet y)
{
    return (jet){{x.c[0] * y.c[0], x.c[0] * y.c[1] + x.c[1] * y.c[0],
                  x.c[0] * y.c[2] + x.c[1] * y.c[1] + x.c[2] * y.c[0]}};
}

static jet scale(real s, jet x)
{
    return (jet){{s * x.c[0], s * x.c[1], s * x.c[2]}};
}

static jet33 multiply33(jet33 x, jet33 y)
{
    jet33 z;
    memset(&z, 0, sizeof z);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                z.a[i][j] = add(z.a[i][j], multiply(x.a[i][k], y.a[k][j]));
    return z;
}

static jet3 apply33(jet33 x, jet3 y)
{
    jet3 z;
    memset(&z, 0, sizeof z);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            z.a[i] = add(z.a[i], multiply(x.a[i][k], y.a[k]));
    return z;
}

static jet3 constant3(const double v[3])
{
    return (jet3){{{{v[0], 0, 0}}, {{v[1], 0, 0}}, {{v[2], 0, 0}}}};
}

static jet3 add3(jet3 x, jet3 y)
{
    for (int i = 0; i < 3; i++)
        x.a[i] = add(x.a[i], y.a[i]);
    return x;
}

static jet33 identity33(void)
{
    jet33 z;
    memset(&z, 0, sizeof z);
    for (int i = 0; i < 3; i++)
        z.a[i][i].c[0] = 1;
    return z;
}

// E + s ~e + v ~e^2
static jet33 rodrigues(const real e[3], jet s, jet v)
{
    jet33 z = identity33();
    real skew[3][3] = {{0, -e[2], e[1]}, {e[2], 0, -e[0]}, {-e[1], e[0], 0}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            real square = 0;
            for (int k = 0; k < 3; k++)
                square += skew[i][k] * skew[k][j];
            z.a[i][j] = add(z.a[i][j], add(scale(skew[i][j], s), scale(square, v)));
        }
    return z;
}

// Turn about the direction `axis` by an angle with a constant rate.
static jet33 turn(const double axis[3], real angle, real rate)
{
    real n = sqrtl((real)axis[0] * axis[0] + (real)axis[1] * axis[1] + (real)axis[2] * axis[2]);
    real e[3] = {axis[0] / n, axis[1] / n, axis[2] / n}, s = sinl(angle), c = cosl(angle);
    jet sine = {{s, c * rate, -s * rate * rate / 2}};
    jet versine = {{1 - c, s * rate, c * rate * rate / 2}};
    return rodrigues(e, sine, versine);
}

static jet33 from_quaternion(const double q[4])
{
    real w = q[0], x = q[1], y = q[2], z = q[3], n = 2 / (w * w + x * x + y * y + z * z);
    real m[3][3] = {{1 - n * (y * y + z * z), n * (x * y - w * z), n * (x * z + w * y)},
                    {n * (x * y + w * z), 1 - n * (x * x + z * z), n * (y * z - w * x)},
                    {n * (x * z - w * y), n * (y * z + w * x), 1 - n * (x * x + y * y)}};
    jet33 out = identity33();
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out.a[i][j].c[0] = m[i][j];
    return out;
}

// Quaternion attitude turning on at constant angular velocity w in its own axes: R Exp(~w t).
static jet33 ball(const double q[4], const double w[3])
{
    real e[3] = {w[0], w[1], w[2]};
    return multiply33(from_quaternion(q), rodrigues(e, (jet){{0, 1, 0}}, (jet){{0, 0, 0.5L}}));
}

// ---- a random tree

typedef struct specimen {
    int count, q_count, u_count;
    char name[BODIES][8];
    int parent[BODIES], q_at[BODIES], u_at[BODIES];
    ld_mstmm_element element[BODIES];
    double gravity[3], q[8 * BODIES], u[SPEEDS], tau[SPEEDS], wrench[6 * BODIES];
} specimen;

enum { KINDS = LD_HINGE_PLANAR + 1 };
static const int coordinates_of[] = {0, 1, 1, 2, 2, 4, 7, 3},
                 speeds_of[] = {0, 1, 1, 2, 2, 3, 6, 3};

static void fill(double *x, int n, double size, uint64_t *seed)
{
    for (int i = 0; i < n; i++)
        x[i] = size * draw(seed);
}

static int pick(int n, uint64_t *seed)
{
    return (int)((draw(seed) + 1) / 2 * n);
}

// Hinges of the first `kinds` kinds.
static void draw_tree(specimen *s, int kinds, uint64_t *seed)
{
    memset(s, 0, sizeof *s);
    s->count = 2 + pick(BODIES - 1, seed);
    for (int i = 0; i < s->count; i++) {
        ld_mstmm_element *e = &s->element[i];
        snprintf(s->name[i], sizeof s->name[i], "b%d", i);
        s->parent[i] = i == 0 || pick(8, seed) == 0 ? -1 : pick(i, seed);
        e->name = s->name[i];
        e->parent = s->parent[i] >= 0 ? s->name[s->parent[i]] : NULL;
        e->hinge = (ld_hinge)pick(kinds, seed);
        fill(e->at, 3, 0.5, seed);
        fill(e->attitude, 4, 1, seed);
        fill(e->axis, 3, 1, seed);
        fill(e->axis_2, 3, 1, seed);
        fill(e->center, 3, 0.3, seed);
        e->mass = 2 + 1.5 * draw(seed);
        m3 J = draw_inertia(seed, e->mass);
        double six[6] = {J.a[0][0], J.a[1][1], J.a[2][2], J.a[0][1], J.a[0][2], J.a[1][2]};
        memcpy(e->inertia, six, sizeof six);
        s->q_at[i] = s->q_count;
        s->u_at[i] = s->u_count;
        s->q_count += coordinates_of[e->hinge];
        s->u_count += speeds_of[e->hinge];
    }
    fill(s->gravity, 3, 10, seed);
    fill(s->q, s->q_count, 1.5, seed);
    fill(s->u, s->u_count, 2, seed);
    fill(s->tau, s->u_count, 20, seed);
    fill(s->wrench, 6 * s->count, 20, seed);
}

// ---- its motion from positions

typedef struct moving {
    jet3 origin, center;
    jet33 R;
} moving;

// Displacements along axis_2, less its part along the normal, and along normal x that.
static jet3 in_plane(const ld_mstmm_element *e, const double *q, const double *v)
{
    real z[3], x[3], normal = 0, along = 0, size = 0;
    for (int k = 0; k < 3; k++)
        normal += (real)e->axis[k] * e->axis[k];
    for (int k = 0; k < 3; k++) {
        z[k] = e->axis[k] / sqrtl(normal);
        along += z[k] * e->axis_2[k];
    }
    for (int k = 0; k < 3; k++) {
        x[k] = e->axis_2[k] - along * z[k];
        size += x[k] * x[k];
    }
    for (int k = 0; k < 3; k++)
        x[k] /= sqrtl(size);
    jet3 slide;
    memset(&slide, 0, sizeof slide);
    for (int k = 0; k < 3; k++) {
        real y = z[(k + 1) % 3] * x[(k + 2) % 3] - z[(k + 2) % 3] * x[(k + 1) % 3];
        slide.a[k] = (jet){{q[0] * x[k] + q[1] * y, v[0] * x[k] + v[1] * y, 0}};
    }
    return slide;
}

// Poses of all bodies along the path with constant speeds u (rates of what u means).
static void trace(const specimen *s, const double *u, moving *body)
{
    for (int i = 0; i < s->count; i++) {
        const ld_mstmm_element *e = &s->element[i];
        const double *q = s->q + s->q_at[i], *v = u + s->u_at[i];
        moving carrier = {.R = identity33()};
        memset(&carrier.origin, 0, sizeof carrier.origin);
        if (s->parent[i] >= 0)
            carrier = body[s->parent[i]];
        jet33 R = multiply33(carrier.R, from_quaternion(e->attitude));
        jet3 slide;
        memset(&slide, 0, sizeof slide);
        jet33 own = identity33();
        real n = sqrtl((real)e->axis[0] * e->axis[0] + (real)e->axis[1] * e->axis[1] +
                       (real)e->axis[2] * e->axis[2]);
        switch (e->hinge) {
        case LD_HINGE_WELD:
            break;
        case LD_HINGE_REVOLUTE:
            own = turn(e->axis, q[0], v[0]);
            break;
        case LD_HINGE_CYLINDRICAL:
        case LD_HINGE_PRISMATIC:
            for (int k = 0; k < 3; k++)
                slide.a[k] = (jet){{q[0] * e->axis[k] / n, v[0] * e->axis[k] / n, 0}};
            if (e->hinge == LD_HINGE_CYLINDRICAL)
                own = turn(e->axis, q[1], v[1]);
            break;
        case LD_HINGE_UNIVERSAL:
            own = multiply33(turn(e->axis, q[0], v[0]), turn(e->axis_2, q[1], v[1]));
            break;
        case LD_HINGE_SPHERICAL:
            own = ball(q, v);
            break;
        case LD_HINGE_FREE:
            for (int k = 0; k < 3; k++)
                slide.a[k] = (jet){{q[k], v[k], 0}};
            own = ball(q + 3, v + 3);
            break;
        case LD_HINGE_PLANAR:
            slide = in_plane(e, q, v);
            own = turn(e->axis, q[2], v[2]);
            break;
        }
        body[i].origin =
            add3(add3(carrier.origin, apply33(carrier.R, constant3(e->at))), apply33(R, slide));
        body[i].R = multiply33(R, own);
        body[i].center = add3(body[i].origin, apply33(body[i].R, constant3(e->center)));
    }
}

// w of ~w = R_dot R^T, and alpha: the skew part of R_ddot R^T.
static void rotation_rates(const jet33 *R, real w[3], real alpha[3])
{
    real first[3][3], second[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            first[i][j] = second[i][j] = 0;
            for (int k = 0; k < 3; k++) {
                first[i][j] += R->a[i][k].c[1] * R->a[j][k].c[0];
                second[i][j] += 2 * R->a[i][k].c[2] * R->a[j][k].c[0];
            }
        }
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        w[i] = (first[k][j] - first[j][k]) / 2;
        alpha[i] = (second[k][j] - second[j][k]) / 2;
    }
}

static void inertia_in_space(const ld_mstmm_element *e, const jet33 *R, real J[3][3])
{
    const double *I = e->inertia;
    real own[3][3] = {{I[0], I[3], I[4]}, {I[3], I[1], I[5]}, {I[4], I[5], I[2]}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            J[i][j] = 0;
            for (int k = 0; k < 3; k++)
                for (int l = 0; l < 3; l++)
                    J[i][j] += R->a[i][k].c[0] * own[k][l] * R->a[j][l].c[0];
        }
}

// ---- the dense equations M u_dot = h

static void assemble(const specimen *s, real M[SPEEDS][SPEEDS], real h[SPEEDS])
{
    static moving now[BODIES], unit[SPEEDS][BODIES];
    trace(s, s->u, now);
    for (int k = 0; k < s->u_count; k++) {
        double e[SPEEDS] = {0};
        e[k] = 1;
        trace(s, e, unit[k]);
        h[k] = s->tau[k];
        for (int l = 0; l < s->u_count; l++)
            M[k][l] = 0;
    }
    for (int i = 0; i < s->count; i++) {
        const ld_mstmm_element *e = &s->element[i];
        real J[3][3], w[3], alpha[3], turn_k[SPEEDS][3], unused[3], spin[3] = {0}, need[3] = {0};
        inertia_in_space(e, &now[i].R, J);
        rotation_rates(&now[i].R, w, alpha);
        // moment of the rotation's inertia: J alpha + w x J w
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++) {
                spin[a] += J[a][b] * w[b];
                need[a] += J[a][b] * alpha[b];
            }
        for (int a = 0; a < 3; a++) {
            int b = (a + 1) % 3, c = (a + 2) % 3;
            need[a] += w[b] * spin[c] - w[c] * spin[b];
        }
        for (int k = 0; k < s->u_count; k++) {
            const moving *m = &unit[k][i];
            rotation_rates(&m->R, turn_k[k], unused);
            for (int a = 0; a < 3; a++) {
                real inertia_force = e->mass * (2 * now[i].center.a[a].c[2] - s->gravity[a]);
                h[k] -= m->center.a[a].c[1] * inertia_force + turn_k[k][a] * need[a];
                h[k] += m->origin.a[a].c[1] * s->wrench[6 * i + a] +
                        turn_k[k][a] * s->wrench[6 * i + 3 + a];
            }
        }
        for (int k = 0; k < s->u_count; k++)
            for (int l = 0; l < s->u_count; l++)
                for (int a = 0; a < 3; a++) {
                    M[k][l] += e->mass * unit[k][i].center.a[a].c[1] * unit[l][i].center.a[a].c[1];
                    for (int b = 0; b < 3; b++)
                        M[k][l] += turn_k[k][a] * J[a][b] * turn_k[l][b];
                }
    }
}

// Solves by Gauss-Jordan with the inverse beside; returns the 1-norm condition.
static real solve(int n, real M[SPEEDS][SPEEDS], const real *h, real *x)
{
    static real W[SPEEDS][2 * SPEEDS];
    real norm = 0, inverse_norm = 0;
    for (int j = 0; j < n; j++) {
        real sum = 0;
        for (int i = 0; i < n; i++) {
            W[i][j] = M[i][j];
            W[i][n + j] = i == j;
            sum += fabsl(M[i][j]);
        }
        norm = fmaxl(norm, sum);
    }
    for (int j = 0; j < n; j++) {
        int best = j;
        for (int i = j; i < n; i++)
            if (fabsl(W[i][j]) > fabsl(W[best][j]))
                best = i;
        for (int k = 0; k < 2 * n; k++) {
            real held = W[j][k];
            W[j][k] = W[best][k];
            W[best][k] = held;
        }
        real pivot = W[j][j];
        for (int k = 0; k < 2 * n; k++)
            W[j][k] /= pivot;
        for (int i = 0; i < n; i++) {
            real factor = W[i][j];
            for (int k = 0; i != j && k < 2 * n; k++)
                W[i][k] -= factor * W[j][k];
        }
    }
    for (int j = 0; j < n; j++) {
        real sum = 0;
        for (int i = 0; i < n; i++)
            sum += fabsl(W[i][n + j]);
        inverse_norm = fmaxl(inverse_norm, sum);
        x[j] = 0;
        for (int k = 0; k < n; k++)
            x[j] += W[j][n + k] * h[k];
    }
    return norm * inverse_norm;
}

// Largest differences over a number of random trees.
typedef struct differences {
    double conditioned, plain;     // of the accelerations, over the condition and as they are
    double back, back_conditioned; // of the forces that inverse dynamics gives back
    double condition;              // the largest one
    int largest;                   // speeds of the largest tree
} differences;

static differences compare_trees(int kinds, uint64_t seed)
{
    static specimen s;
    static real M[SPEEDS][SPEEDS];
    int hinges[KINDS] = {0};
    differences all = {0};
    for (int tree = 0; tree < TREES; tree++) {
        ld_mstmm *system;
        ld_error error = {0};
        real h[SPEEDS], expected[SPEEDS];
        double u_dot[SPEEDS], tau[SPEEDS], size = 0, off = 0, force = 0, back = 0;
        draw_tree(&s, kinds, &seed);
        for (int i = 0; i < s.count; i++)
            hinges[s.element[i].hinge]++;
        if (ld_mstmm_create(s.element, s.count, s.gravity, &system, &error))
            fail_msg("%s", error.text);
        assert_int_equal(ld_mstmm_coordinate_count(system), s.q_count);
        assert_int_equal(ld_mstmm_speed_count(system), s.u_count);
        if (ld_mstmm_accelerations(system, s.q, s.u, s.tau, s.wrench, u_dot, &error))
            fail_msg("%s", error.text);
        ld_mstmm_forces(system, s.q, s.u, u_dot, s.wrench, tau);
        assemble(&s, M, h);
        double condition = s.u_count ? (double)solve(s.u_count, M, h, expected) : 1;
        for (int k = 0; k < s.u_count; k++) {
            size = fmax(size, fabs((double)expected[k]));
            off = fmax(off, fabs((double)(u_dot[k] - expected[k])));
            force = fmax(force, fabs(s.tau[k]));
            back = fmax(back, fabs(tau[k] - s.tau[k]));
        }
        ld_mstmm_free(system);
        if (!s.u_count)
            continue;
        all.largest = s.u_count > all.largest ? s.u_count : all.largest;
        all.conditioned = fmax(all.conditioned, off / size / condition);
        all.plain = fmax(all.plain, off / size);
        all.back = fmax(all.back, back / force);
        all.back_conditioned = fmax(all.back_conditioned, back / force / condition);
        all.condition = fmax(all.condition, condition);
    }
    for (int i = 0; i < kinds; i++)
        assert_true(hinges[i] > 300);
    printf("    %d trees, up to %d speeds, condition up to %.1e\n", TREES, all.largest,
           all.condition);
    return all;
}

static void test_reduced_sweep_is_the_dense_solve(void **state)
{
    (void)state;
    differences seven = compare_trees(7, 2026);
    CHECK_BELOW("accelerations, relative, over the condition", seven.conditioned, 6e-15);
    CHECK_BELOW("accelerations, relative", seven.plain, 2e-13);
    CHECK_BELOW("inverse(forward) gives the forces back, relative", seven.back, 1e-12);
    differences all = compare_trees(KINDS, 2027);
    CHECK_BELOW("planar hinges too: accelerations, over the condition", all.conditioned, 6e-15);
    CHECK_BELOW("planar hinges too: forces, over the condition", all.back_conditioned, 6e-15);
}

// Some hinges prescribed: with their accelerations given the others' are those of the dense
// equations' free rows, and the forces found are what the prescribed rows need.
static void test_prescribed_hinges(void **state)
{
    (void)state;
    static specimen s;
    static real M[SPEEDS][SPEEDS], reduced[SPEEDS][SPEEDS];
    uint64_t seed = 77;
    double worst = 0, worst_force = 0;
    int given_kinds[KINDS] = {0};
    for (int tree = 0; tree < TREES / 4; tree++) {
        ld_mstmm *system, *copy;
        real h[SPEEDS], b[SPEEDS], x[SPEEDS], expected[SPEEDS];
        double u_dot[SPEEDS], again[SPEEDS], tau[SPEEDS], size = 0, off = 0, force = 0, missed = 0;
        int open[SPEEDS], count = 0;
        draw_tree(&s, KINDS, &seed);
        for (int i = 0; i < s.count; i++) {
            s.element[i].prescribed = pick(3, &seed) == 0;
            given_kinds[s.element[i].hinge] += s.element[i].prescribed;
            for (int k = 0; k < speeds_of[s.element[i].hinge] && !s.element[i].prescribed; k++)
                open[count++] = s.u_at[i] + k;
        }
        assert_int_equal(ld_mstmm_create(s.element, s.count, s.gravity, &system, NULL), LD_OK);
        assert_int_equal(ld_mstmm_copy(system, &copy, NULL), LD_OK);
        assert_int_equal(ld_mstmm_accelerations(system, s.q, s.u, s.tau, s.wrench, u_dot, NULL),
                         LD_OK);
        ld_mstmm_free(system);
        assert_int_equal(ld_mstmm_accelerations(copy, s.q, s.u, s.tau, s.wrench, again, NULL),
                         LD_OK);
        assert_memory_equal(u_dot, again, (size_t)s.u_count * sizeof *u_dot);
        ld_mstmm_forces(copy, s.q, s.u, u_dot, s.wrench, tau);
        ld_mstmm_free(copy);

        // h holds tau: what stands there for the prescribed rows is an acceleration
        assemble(&s, M, h);
        for (int k = 0; k < s.u_count; k++)
            expected[k] = s.tau[k];
        for (int k = 0; k < count; k++)
            expected[open[k]] = 0;
        for (int k = 0; k < count; k++) {
            b[k] = h[open[k]];
            for (int l = 0; l < s.u_count; l++)
                b[k] -= M[open[k]][l] * expected[l];
            for (int l = 0; l < count; l++)
                reduced[k][l] = M[open[k]][open[l]];
        }
        real condition = count ? solve(count, reduced, b, x) : 1;
        for (int k = 0; k < count; k++)
            expected[open[k]] = x[k];
        for (int k = 0; k < s.u_count; k++) {
            real need = s.tau[k] - h[k];
            for (int l = 0; l < s.u_count; l++)
                need += M[k][l] * expected[l];
            size = fmax(size, fabs((double)expected[k]));
            off = fmax(off, fabs((double)(u_dot[k] - expected[k])));
            force = fmax(force, fabs((double)need));
            missed = fmax(missed, fabs((double)(tau[k] - need)));
        }
        if (s.u_count) {
            worst = fmax(worst, off / size / (double)condition);
            worst_force = fmax(worst_force, missed / force / (double)condition);
        }
    }
    for (int i = 0; i < KINDS; i++)
        assert_true(given_kinds[i] > 20);
    CHECK_BELOW("prescribed hinges: accelerations, over the condition", worst, 6e-15);
    CHECK_BELOW("prescribed hinges: forces, over the condition", worst_force, 6e-15);
}

// Accelerations of points against the second derivatives of their positions, reactions against
// Newton's law of what hangs on a hinge.
static void test_points_and_reactions(void **state)
{
    (void)state;
    static specimen s;
    static moving now[BODIES];
    uint64_t seed = 5;
    double worst = 0, worst_force = 0;
    for (int tree = 0; tree < TREES / 4; tree++) {
        ld_mstmm *system;
        const double none[SPEEDS] = {0};
        double reaction[6 * BODIES], carried[BODIES][3] = {{0}}, size = 1e-9, at[3];
        draw_tree(&s, KINDS, &seed);
        fill(at, 3, 1, &seed);
        assert_int_equal(ld_mstmm_create(s.element, s.count, s.gravity, &system, NULL), LD_OK);
        // with u_dot = 0 the speeds are constant: the path of trace()
        trace(&s, s.u, now);
        ld_mstmm_reactions(system, s.q, s.u, none, s.wrench, reaction);
        for (int i = s.count - 1; i >= 0; i--) {
            double linear[3], angular[3];
            real w[3], alpha[3];
            jet3 point = add3(now[i].origin, apply33(now[i].R, constant3(at)));
            rotation_rates(&now[i].R, w, alpha);
            ld_mstmm_point_acceleration(system, s.q, s.u, none, i, at, linear, angular);
            for (int a = 0; a < 3; a++) {
                worst = fmax(worst, fabs(linear[a] - (double)(2 * point.a[a].c[2])));
                worst = fmax(worst, fabs(angular[a] - (double)alpha[a]));
                carried[i][a] +=
                    s.element[i].mass * ((double)(2 * now[i].center.a[a].c[2]) - s.gravity[a]) -
                    s.wrench[6 * i + a];
                size = fmax(size, fabs(carried[i][a]));
                worst_force = fmax(worst_force, fabs(reaction[6 * i + a] - carried[i][a]) / size);
                if (s.parent[i] >= 0)
                    carried[s.parent[i]][a] += carried[i][a];
            }
        }
        ld_mstmm_free(system);
    }
    CHECK_BELOW("accelerations of points [m/s2, rad/s2]", worst, 1e-12);
    CHECK_BELOW("forces in the hinges, relative", worst_force, 1e-13);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_reduced_sweep_is_the_dense_solve),
        cmocka_unit_test(test_prescribed_hinges),
        cmocka_unit_test(test_points_and_reactions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
