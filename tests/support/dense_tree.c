#include "support/dense_tree.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/draw.h"

jet jet_add(jet x, jet y)
{
    return (jet){{x.c[0] + y.c[0], x.c[1] + y.c[1], x.c[2] + y.c[2]}};
}

jet jet_multiply(jet x, jet y)
{
    return (jet){{x.c[0] * y.c[0], x.c[0] * y.c[1] + x.c[1] * y.c[0],
                  x.c[0] * y.c[2] + x.c[1] * y.c[1] + x.c[2] * y.c[0]}};
}

jet jet_scale(real s, jet x)
{
    return (jet){{s * x.c[0], s * x.c[1], s * x.c[2]}};
}

jet33 jet33_multiply(jet33 x, jet33 y)
{
    jet33 z;
    memset(&z, 0, sizeof z);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                z.a[i][j] = jet_add(z.a[i][j], jet_multiply(x.a[i][k], y.a[k][j]));
    return z;
}

jet3 jet33_apply(jet33 x, jet3 y)
{
    jet3 z;
    memset(&z, 0, sizeof z);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            z.a[i] = jet_add(z.a[i], jet_multiply(x.a[i][k], y.a[k]));
    return z;
}

jet3 jet3_constant(const double v[3])
{
    return (jet3){{{{v[0], 0, 0}}, {{v[1], 0, 0}}, {{v[2], 0, 0}}}};
}

jet3 jet3_add(jet3 x, jet3 y)
{
    for (int i = 0; i < 3; i++)
        x.a[i] = jet_add(x.a[i], y.a[i]);
    return x;
}

jet33 jet33_identity(void)
{
    jet33 z;
    memset(&z, 0, sizeof z);
    for (int i = 0; i < 3; i++)
        z.a[i][i].c[0] = 1;
    return z;
}

jet33 jet33_transpose(jet33 x)
{
    jet33 z;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            z.a[i][j] = x.a[j][i];
    return z;
}

// E + s ~e + v ~e^2
static jet33 rodrigues(const real e[3], jet s, jet v)
{
    jet33 z = jet33_identity();
    real skew[3][3] = {{0, -e[2], e[1]}, {e[2], 0, -e[0]}, {-e[1], e[0], 0}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            real square = 0;
            for (int k = 0; k < 3; k++)
                square += skew[i][k] * skew[k][j];
            z.a[i][j] = jet_add(z.a[i][j], jet_add(jet_scale(skew[i][j], s), jet_scale(square, v)));
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

jet33 jet33_quaternion(const double q[4])
{
    real w = q[0], x = q[1], y = q[2], z = q[3], n = 2 / (w * w + x * x + y * y + z * z);
    real m[3][3] = {{1 - n * (y * y + z * z), n * (x * y - w * z), n * (x * z + w * y)},
                    {n * (x * y + w * z), 1 - n * (x * x + z * z), n * (y * z - w * x)},
                    {n * (x * z - w * y), n * (y * z + w * x), 1 - n * (x * x + y * y)}};
    jet33 out = jet33_identity();
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out.a[i][j].c[0] = m[i][j];
    return out;
}

// Quaternion attitude turning on at constant angular velocity w in its own axes: R Exp(~w t).
static jet33 ball(const double q[4], const double w[3])
{
    real e[3] = {w[0], w[1], w[2]};
    return jet33_multiply(jet33_quaternion(q), rodrigues(e, (jet){{0, 1, 0}}, (jet){{0, 0, 0.5L}}));
}

// ---- a random tree

const int tree_coordinates[KINDS] = {0, 1, 1, 2, 2, 4, 7, 3};
const int tree_speeds[KINDS] = {0, 1, 1, 2, 2, 3, 6, 3};

void tree_fill(double *x, int n, double size, uint64_t *seed)
{
    for (int i = 0; i < n; i++)
        x[i] = size * draw(seed);
}

int tree_pick(int n, uint64_t *seed)
{
    return (int)((draw(seed) + 1) / 2 * n);
}

void tree_draw(specimen *s, int kinds, uint64_t *seed)
{
    memset(s, 0, sizeof *s);
    s->count = 2 + tree_pick(BODIES - 1, seed);
    for (int i = 0; i < s->count; i++) {
        ld_mstmm_element *e = &s->element[i];
        snprintf(s->name[i], sizeof s->name[i], "b%d", i);
        s->parent[i] = i == 0 || tree_pick(8, seed) == 0 ? -1 : tree_pick(i, seed);
        e->name = s->name[i];
        e->parent = s->parent[i] >= 0 ? s->name[s->parent[i]] : NULL;
        e->hinge = (ld_hinge)tree_pick(kinds, seed);
        tree_fill(e->at, 3, 0.5, seed);
        tree_fill(e->attitude, 4, 1, seed);
        tree_fill(e->axis, 3, 1, seed);
        tree_fill(e->axis_2, 3, 1, seed);
        tree_fill(e->center, 3, 0.3, seed);
        e->mass = 2 + 1.5 * draw(seed);
        m3 J = draw_inertia(seed, e->mass);
        double six[6] = {J.a[0][0], J.a[1][1], J.a[2][2], J.a[0][1], J.a[0][2], J.a[1][2]};
        memcpy(e->inertia, six, sizeof six);
        s->q_at[i] = s->q_count;
        s->u_at[i] = s->u_count;
        s->q_count += tree_coordinates[e->hinge];
        s->u_count += tree_speeds[e->hinge];
    }
    tree_fill(s->gravity, 3, 10, seed);
    tree_fill(s->q, s->q_count, 1.5, seed);
    tree_fill(s->u, s->u_count, 2, seed);
    tree_fill(s->tau, s->u_count, 20, seed);
    tree_fill(s->wrench, 6 * s->count, 20, seed);
}

// ---- its motion from positions

// Displacements along axis_2, less its part along the normal, and along normal x that.
static jet3 in_plane(const double axis[3], const double axis_2[3], const double *q, const double *v)
{
    real z[3], x[3], normal = 0, along = 0, size = 0;
    for (int k = 0; k < 3; k++)
        normal += (real)axis[k] * axis[k];
    for (int k = 0; k < 3; k++) {
        z[k] = axis[k] / sqrtl(normal);
        along += z[k] * axis_2[k];
    }
    for (int k = 0; k < 3; k++) {
        x[k] = axis_2[k] - along * z[k];
        size += x[k] * x[k];
    }
    for (int k = 0; k < 3; k++)
        x[k] /= sqrtl(size);
    jet3 slide;
    for (int k = 0; k < 3; k++) {
        real y = z[(k + 1) % 3] * x[(k + 2) % 3] - z[(k + 2) % 3] * x[(k + 1) % 3];
        slide.a[k] = (jet){{q[0] * x[k] + q[1] * y, v[0] * x[k] + v[1] * y, 0}};
    }
    return slide;
}

static jet3 along_axis(const double axis[3], double q, double v)
{
    real n = sqrtl((real)axis[0] * axis[0] + (real)axis[1] * axis[1] + (real)axis[2] * axis[2]);
    jet3 slide;
    for (int k = 0; k < 3; k++)
        slide.a[k] = (jet){{q * axis[k] / n, v * axis[k] / n, 0}};
    return slide;
}

void tree_joint(ld_hinge hinge, const double axis[3], const double axis_2[3], const double *x,
                const double *x_dot, jet3 *slide, jet33 *turned)
{
    memset(slide, 0, sizeof *slide);
    *turned = jet33_identity();
    switch (hinge) {
    case LD_HINGE_WELD:
        break;
    case LD_HINGE_REVOLUTE:
        *turned = turn(axis, x[0], x_dot[0]);
        break;
    case LD_HINGE_PRISMATIC:
        *slide = along_axis(axis, x[0], x_dot[0]);
        break;
    case LD_HINGE_CYLINDRICAL:
        *slide = along_axis(axis, x[0], x_dot[0]);
        *turned = turn(axis, x[1], x_dot[1]);
        break;
    case LD_HINGE_UNIVERSAL:
        *turned = jet33_multiply(turn(axis, x[0], x_dot[0]), turn(axis_2, x[1], x_dot[1]));
        break;
    case LD_HINGE_SPHERICAL:
        *turned = ball(x, x_dot);
        break;
    case LD_HINGE_FREE:
        for (int k = 0; k < 3; k++)
            slide->a[k] = (jet){{x[k], x_dot[k], 0}};
        *turned = ball(x + 3, x_dot + 3);
        break;
    case LD_HINGE_PLANAR:
        *slide = in_plane(axis, axis_2, x, x_dot);
        *turned = turn(axis, x[2], x_dot[2]);
        break;
    }
}

void tree_trace(const specimen *s, const double *u, moving *body)
{
    for (int i = 0; i < s->count; i++) {
        const ld_mstmm_element *e = &s->element[i];
        moving carrier = {.R = jet33_identity()};
        memset(&carrier.origin, 0, sizeof carrier.origin);
        if (s->parent[i] >= 0)
            carrier = body[s->parent[i]];
        jet33 R = jet33_multiply(carrier.R, jet33_quaternion(e->attitude)), own;
        jet3 slide;
        tree_joint(e->hinge, e->axis, e->axis_2, s->q + s->q_at[i], u + s->u_at[i], &slide, &own);
        body[i].origin =
            jet3_add(jet3_add(carrier.origin, jet33_apply(carrier.R, jet3_constant(e->at))),
                     jet33_apply(R, slide));
        body[i].R = jet33_multiply(R, own);
        body[i].center = jet3_add(body[i].origin, jet33_apply(body[i].R, jet3_constant(e->center)));
    }
}

void tree_rates(const jet33 *R, real w[3], real alpha[3])
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

void tree_assemble(const specimen *s, moving unit[SPEEDS][BODIES], real M[SPEEDS][SPEEDS],
                   real h[SPEEDS])
{
    static moving now[BODIES];
    tree_trace(s, s->u, now);
    for (int k = 0; k < s->u_count; k++) {
        double e[SPEEDS] = {0};
        e[k] = 1;
        tree_trace(s, e, unit[k]);
        h[k] = s->tau[k];
        for (int l = 0; l < s->u_count; l++)
            M[k][l] = 0;
    }
    for (int i = 0; i < s->count; i++) {
        const ld_mstmm_element *e = &s->element[i];
        real J[3][3], w[3], alpha[3], turn_k[SPEEDS][3], unused[3], spin[3] = {0}, need[3] = {0};
        inertia_in_space(e, &now[i].R, J);
        tree_rates(&now[i].R, w, alpha);
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
            tree_rates(&m->R, turn_k[k], unused);
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

real tree_solve(int n, int width, const real *A, const real *b, real *x)
{
    static real W[EQUATIONS][2 * EQUATIONS];
    real norm = 0, inverse_norm = 0;
    for (int j = 0; j < n; j++) {
        real sum = 0;
        for (int i = 0; i < n; i++) {
            W[i][j] = A[i * width + j];
            W[i][n + j] = i == j;
            sum += fabsl(W[i][j]);
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
            x[j] += W[j][n + k] * b[k];
    }
    return norm * inverse_norm;
}
