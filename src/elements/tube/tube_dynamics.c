#include "elements/tube/tube_dynamics.h"

#include <string.h>

#include "elements/tube/shortening.h"

// Offsets of the four parts of q.
typedef struct parts {
    int nb, nt, na, y, z, t, a, count;
} parts;

static parts parts_of(const flexible_tube *tube)
{
    int nb = tube->nb, nt = tube->nt, na = tube->na;
    return (parts){nb, nt, na, 0, nb, 2 * nb, 2 * nb + nt, 2 * nb + nt + na};
}

int tube_mode_count(const flexible_tube *tube)
{
    return parts_of(tube).count;
}

static double dot(int n, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

// The integrals over the deformed tube that mass matrix and forces share.
typedef struct integrals {
    v3 S;                     // int p dm
    m3 p2;                    // int p p^T dm
    double bend[2][3][LD_NB]; // int p_a b dm by plane, a = x, y, z
    double stretch[3][LD_NA]; // int p_a a dm
    m3 W;                     // int p_a u_b dm, u = Phi q_dot
    // of foreshortening, by plane: int H dm q, int x H dm q; rate of S_x, q_dot . int H dm q_dot;
    // its share e of the second moment, and the rate of that
    double drawn[2][LD_NB], drawn_x[2][LD_NB];
    double drawing, bending_on, share, share_rate;
} integrals;

// What foreshortening adds: to the momentum all, to the angular momentum a share of what the
// straight line and its small motion have (theory-tube.md).
static void shorten(const flexible_tube *tube, const double *q, const double *q_dot,
                    integrals *value)
{
    const tube_shortening *self = tube->shortening;
    int nb = tube->nb;
    memset(value->drawn, 0, sizeof value->drawn);
    memset(value->drawn_x, 0, sizeof value->drawn_x);
    value->drawing = value->bending_on = value->share = value->share_rate = 0;
    for (int plane = PLANE_Y; plane <= PLANE_Z && self; plane++) {
        const double *bent = q + plane * nb, *rate = q_dot + plane * nb;
        const double *first = shortening_matrix(self, self->first, plane);
        const double *second = shortening_matrix(self, self->second, plane);
        double *drawn = value->drawn[plane], *drawn_x = value->drawn_x[plane], of_rate[LD_NB];
        shortening_apply(tube, first, bent, drawn);
        shortening_apply(tube, first, rate, of_rate);
        shortening_apply(tube, second, bent, drawn_x);
        value->S.x -= 0.5 * dot(nb, bent, drawn);
        value->drawing -= dot(nb, rate, drawn);
        value->bending_on += dot(nb, rate, of_rate);
        value->share -= dot(nb, bent, drawn_x) / tube->j0;
        value->share_rate -= 2 * dot(nb, rate, drawn_x) / tube->j0;
    }
}

// int b u dm of a plane's shapes with the deflection that q makes in the other plane.
static void cross_shapes(const flexible_tube *tube, int plane, const double *q, double *to)
{
    for (int i = 0; i < tube->nb; i++)
        to[i] = tube->overlap ? dot(tube->nb, tube->overlap->G[plane][i], q) : q[i];
}

static void integrate(const flexible_tube *tube, const double *q, const double *q_dot,
                      integrals *value)
{
    parts k = parts_of(tube);
    const double *q_y = q + k.y, *q_z = q + k.z, *q_a = q + k.a;
    double(*of_y)[LD_NB] = value->bend[PLANE_Y], (*of_z)[LD_NB] = value->bend[PLANE_Z];
    for (int plane = PLANE_Y; plane <= PLANE_Z; plane++)
        for (int j = 0; j < k.nb; j++) {
            value->bend[plane][0][j] = tube->c[plane][j];
            for (int i = 0; i < k.na; i++)
                value->bend[plane][0][j] += q_a[i] * tube->AB[plane][i][j];
        }
    memcpy(of_y[1], q_y, (size_t)k.nb * sizeof *q_y);
    memcpy(of_z[2], q_z, (size_t)k.nb * sizeof *q_z);
    cross_shapes(tube, PLANE_Y, q_z, of_y[2]);
    cross_shapes(tube, PLANE_Z, q_y, of_z[1]);
    for (int i = 0; i < k.na; i++) {
        value->stretch[0][i] = tube->ax[i] + q_a[i];
        value->stretch[1][i] = dot(k.nb, tube->AB[PLANE_Y][i], q_y);
        value->stretch[2][i] = dot(k.nb, tube->AB[PLANE_Z][i], q_z);
    }
    value->S = v3_make(tube->s0 + dot(k.na, tube->at, q_a), dot(k.nb, tube->ct[PLANE_Y], q_y),
                       dot(k.nb, tube->ct[PLANE_Z], q_z));
    double xx = tube->j0 + 2 * dot(k.na, tube->ax, q_a) + dot(k.na, q_a, q_a);
    double xy = dot(k.nb, of_y[0], q_y), xz = dot(k.nb, of_z[0], q_z);
    double yz = dot(k.nb, q_y, of_y[2]);
    value->p2 = (m3){{{xx, xy, xz}, {xy, dot(k.nb, q_y, q_y), yz}, {xz, yz, dot(k.nb, q_z, q_z)}}};
    for (int i = 0; i < 3; i++) {
        value->W.a[i][0] = dot(k.na, value->stretch[i], q_dot + k.a);
        value->W.a[i][1] = dot(k.nb, of_y[i], q_dot + k.y);
        value->W.a[i][2] = dot(k.nb, of_z[i], q_dot + k.z);
    }
    shorten(tube, q, q_dot, value);
}

static double trace(m3 m)
{
    return m.a[0][0] + m.a[1][1] + m.a[2][2];
}

// Rotary inertia of the sections about y and z of R, as they stand unbent.
static void add_rotary_mass(const flexible_tube *tube, double *M)
{
    parts k = parts_of(tube);
    int n = 6 + k.count;
    const tube_shear *shear = tube->shear;
    M[4 * n + 4] += shear->inertia[PLANE_Z];
    M[5 * n + 5] += shear->inertia[PLANE_Y];
    for (int i = 0; i < k.nb; i++) {
        M[(6 + k.y + i) * n + 5] += shear->turn[PLANE_Y][i];
        M[(6 + k.z + i) * n + 4] -= shear->turn[PLANE_Z][i];
    }
}

// M: [m E, -~S, Ct; ~S, J, Cr; Ct^T, Cr^T, E]
static void assemble_mass(const flexible_tube *tube, const integrals *value, double *M)
{
    parts k = parts_of(tube);
    int n = 6 + k.count;
    memset(M, 0, (size_t)(n * n) * sizeof *M);

    // rigid block
    m3 S = m3_skew(value->S);
    m3 J = m3_sub(m3_scale(trace(value->p2), m3_identity()), value->p2);
    J.a[0][0] += tube->j;
    J.a[1][1] += value->share * tube->j0;
    J.a[2][2] += value->share * tube->j0;
    for (int i = 0; i < 3; i++) {
        M[i * n + i] = tube->m;
        for (int j = 0; j < 3; j++) {
            M[(3 + i) * n + j] = S.a[i][j];
            M[(3 + i) * n + 3 + j] = J.a[i][j];
        }
    }

    // coupling of the frame with the modes, lower triangle: rows of Ct^T and Cr^T
    for (int i = 0; i < k.nb; i++) {
        double *row_y = M + (6 + k.y + i) * n, *row_z = M + (6 + k.z + i) * n;
        row_y[0] -= value->drawn[PLANE_Y][i];
        row_z[0] -= value->drawn[PLANE_Z][i];
        row_y[1] = tube->ct[PLANE_Y][i];
        row_y[3] = -value->bend[PLANE_Y][2][i];
        row_y[5] = value->bend[PLANE_Y][0][i] + value->share * tube->c[PLANE_Y][i];
        row_z[2] = tube->ct[PLANE_Z][i];
        row_z[3] = value->bend[PLANE_Z][1][i];
        row_z[4] = -value->bend[PLANE_Z][0][i] - value->share * tube->c[PLANE_Z][i];
    }
    for (int i = 0; i < k.nt; i++)
        M[(6 + k.t + i) * n + 3] = tube->cp[i];
    for (int i = 0; i < k.na; i++) {
        double *row = M + (6 + k.a + i) * n;
        row[0] = tube->at[i];
        row[4] = value->stretch[2][i];
        row[5] = -value->stretch[1][i];
    }
    if (tube->shear)
        add_rotary_mass(tube, M);
    for (int i = 6; i < n; i++)
        M[i * n + i] = 1;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < i; j++)
            M[j * n + i] = M[i * n + j];
}

// One family of shapes, in direction `axis`, with its integrals.
typedef struct shape_family {
    int count, axis;
    const double *constant;  // int shape dm
    const double *moment[3]; // int p_a shape dm
    const double *along[3];  // int shape u_b dm, b != axis
} shape_family;

// Forces on its modes: centrifugal, Coriolis, gravity.
static void assemble_modal(const shape_family *of, const tube_motion *motion, double *h)
{
    v3 w = motion->w, g = motion->g;
    double w_of[3] = {w.x, w.y, w.z}, g_of[3] = {g.x, g.y, g.z};
    int axis = of->axis, next = (axis + 1) % 3, last = (axis + 2) % 3;
    for (int i = 0; i < of->count; i++) {
        double sum = of->constant[i] * g_of[axis] + v3_norm2(w) * of->moment[axis][i];
        for (int b = 0; b < 3; b++)
            sum -= w_of[axis] * w_of[b] * of->moment[b][i];
        sum -= 2 * (w_of[next] * of->along[last][i] - w_of[last] * of->along[next][i]);
        h[i] += sum;
    }
}

// Those of the bending modes of a plane.
static void assemble_plane(const flexible_tube *tube, const integrals *value, int plane,
                           const tube_motion *motion, double *h)
{
    parts k = parts_of(tube);
    const double *q_dot = motion->q_dot;
    int own = plane == PLANE_Y ? k.y : k.z, other = plane == PLANE_Y ? k.z : k.y;
    double u_x[LD_NB] = {0}, u_other[LD_NB];
    for (int i = 0; i < k.na; i++)
        for (int j = 0; j < k.nb; j++)
            u_x[j] += tube->AB[plane][i][j] * q_dot[k.a + i];
    cross_shapes(tube, plane, q_dot + other, u_other);
    const double(*bend)[LD_NB] = value->bend[plane];
    const shape_family bending = {.count = k.nb,
                                  .axis = 1 + plane,
                                  .constant = tube->ct[plane],
                                  .moment = {bend[0], bend[1], bend[2]},
                                  .along = {u_x, plane == PLANE_Y ? q_dot + k.y : u_other,
                                            plane == PLANE_Y ? u_other : q_dot + k.z}};
    assemble_modal(&bending, motion, h + 6 + own);
}

// Those of foreshortening; of the angular momentum what its share of j0 w + c q_dot has.
static void add_shortening(const flexible_tube *tube, const integrals *value,
                           const tube_motion *motion, double *h)
{
    parts k = parts_of(tube);
    v3 w = motion->w, g = motion->g;
    const double *q_dot = motion->q_dot;
    const double *c_y = tube->c[PLANE_Y], *c_z = tube->c[PLANE_Z];
    double turn_y = -dot(k.nb, c_z, q_dot + k.z), turn_z = dot(k.nb, c_y, q_dot + k.y);
    v3 l = v3_make(0, tube->j0 * w.y + turn_y, tube->j0 * w.z + turn_z);
    v3 m = v3_axpy(v3_scale(value->share, v3_cross(w, l)), value->share_rate, l);
    v3_store(h + 3, v3_sub(v3_from(h + 3), m));
    h[0] += value->bending_on;
    double outwards = w.y * w.y + w.z * w.z + 2 / tube->j0 * (w.y * turn_y + w.z * turn_z);
    for (int i = 0; i < k.nb; i++) {
        h[6 + k.y + i] -= g.x * value->drawn[PLANE_Y][i] + outwards * value->drawn_x[PLANE_Y][i] +
                          value->share_rate * w.z * c_y[i];
        h[6 + k.z + i] -= g.x * value->drawn[PLANE_Z][i] + outwards * value->drawn_x[PLANE_Z][i] -
                          value->share_rate * w.y * c_z[i];
    }
}

// Gyroscopic moment of that rotary inertia.
static void add_rotary_moment(const flexible_tube *tube, const tube_motion *motion, double *h)
{
    parts k = parts_of(tube);
    const tube_shear *shear = tube->shear;
    v3 w = motion->w;
    double turning_y = dot(k.nb, shear->turn[PLANE_Y], motion->q_dot + k.y);
    double turning_z = dot(k.nb, shear->turn[PLANE_Z], motion->q_dot + k.z);
    v3 l = v3_make(0, shear->inertia[PLANE_Z] * w.y - turning_z,
                   shear->inertia[PLANE_Y] * w.z + turning_y);
    v3_store(h + 3, v3_sub(v3_from(h + 3), v3_cross(w, l)));
}

// Stiffness and damping of one plane.
static void add_bending(const flexible_tube *tube, int plane, const double *q, const double *q_dot,
                        double *h)
{
    for (int i = 0; i < tube->nb; i++)
        h[i] -= tube->om2_b[plane][i] * q[i] + tube->dmp_b[plane][i] * q_dot[i];
}

static void assemble_forces(const flexible_tube *tube, const integrals *value,
                            const tube_motion *motion, double *h)
{
    parts k = parts_of(tube);
    v3 w = motion->w, g = motion->g;
    const double *q = motion->q, *q_dot = motion->q_dot;
    memset(h, 0, (size_t)(6 + k.count) * sizeof *h);

    // translation: -(w x (w x S) + 2 w x Ct q_dot) + m g
    v3 Ct_q = v3_make(dot(k.na, tube->at, q_dot + k.a) + value->drawing,
                      dot(k.nb, tube->ct[PLANE_Y], q_dot + k.y),
                      dot(k.nb, tube->ct[PLANE_Z], q_dot + k.z));
    v3 f = v3_scale(tube->m, g);
    f = v3_sub(f, v3_cross(w, v3_axpy(v3_cross(w, value->S), 2, Ct_q)));
    v3_store(h, f);

    // rotation: -(w x J_line w + 2 (tr(W) w - W^T w) + w x e_x (j w_x + c_x q_dot)) + S x g
    v3 Jw = v3_sub(v3_scale(trace(value->p2), w), m3_apply(value->p2, w));
    Jw.x += tube->j * w.x + dot(k.nt, tube->cp, q_dot + k.t);
    v3 m = v3_sub(v3_cross(value->S, g), v3_cross(w, Jw));
    m = v3_axpy(m, -2, v3_sub(v3_scale(trace(value->W), w), m3_apply_transposed(value->W, w)));
    v3_store(h + 3, m);

    // modes: inertial forces and gravity; what the shapes meet in each direction's velocity
    double stretch_u_y[LD_NA] = {0}, stretch_u_z[LD_NA] = {0};
    for (int i = 0; i < k.na; i++) {
        stretch_u_y[i] = dot(k.nb, tube->AB[PLANE_Y][i], q_dot + k.y);
        stretch_u_z[i] = dot(k.nb, tube->AB[PLANE_Z][i], q_dot + k.z);
    }
    const shape_family stretch = {
        .count = k.na,
        .axis = 0,
        .constant = tube->at,
        .moment = {value->stretch[0], value->stretch[1], value->stretch[2]},
        .along = {q_dot + k.a, stretch_u_y, stretch_u_z}};
    assemble_plane(tube, value, PLANE_Y, motion, h);
    assemble_plane(tube, value, PLANE_Z, motion, h);
    assemble_modal(&stretch, motion, h + 6 + k.a);
    if (tube->shortening)
        add_shortening(tube, value, motion, h);
    if (tube->shear)
        add_rotary_moment(tube, motion, h);

    // stiffness and damping
    add_bending(tube, PLANE_Y, q + k.y, q_dot + k.y, h + 6 + k.y);
    add_bending(tube, PLANE_Z, q + k.z, q_dot + k.z, h + 6 + k.z);
    for (int i = 0; i < k.nt; i++)
        h[6 + k.t + i] -= tube->om2_t[i] * q[k.t + i] + tube->dmp_t[i] * q_dot[k.t + i];
    for (int i = 0; i < k.na; i++)
        h[6 + k.a + i] -= tube->om2_a[i] * q[k.a + i] + tube->dmp_a[i] * q_dot[k.a + i];
}

void tube_dynamics_assemble(const flexible_tube *tube, const tube_motion *motion, double *M,
                            double *h)
{
    integrals value;
    integrate(tube, motion->q, motion->q_dot, &value);
    assemble_mass(tube, &value, M);
    assemble_forces(tube, &value, motion, h);
}

double tube_kinetic_energy(const flexible_tube *tube, v3 v, v3 w, const double *q,
                           const double *q_dot)
{
    int n = 6 + tube_mode_count(tube);
    double M[LD_TUBE_SPEEDS * LD_TUBE_SPEEDS], eta[LD_TUBE_SPEEDS], energy = 0;
    integrals value;
    integrate(tube, q, q_dot, &value);
    assemble_mass(tube, &value, M);
    v3_store(eta, v);
    v3_store(eta + 3, w);
    memcpy(eta + 6, q_dot, (size_t)(n - 6) * sizeof *eta);
    for (int i = 0; i < n; i++)
        energy += 0.5 * eta[i] * dot(n, M + i * n, eta);
    return energy;
}

double tube_elastic_energy(const flexible_tube *tube, const double *q)
{
    parts k = parts_of(tube);
    const double *om2_y = tube->om2_b[PLANE_Y], *om2_z = tube->om2_b[PLANE_Z];
    double sum = 0;
    for (int i = 0; i < k.nb; i++)
        sum += om2_y[i] * q[k.y + i] * q[k.y + i] + om2_z[i] * q[k.z + i] * q[k.z + i];
    for (int i = 0; i < k.nt; i++)
        sum += tube->om2_t[i] * q[k.t + i] * q[k.t + i];
    for (int i = 0; i < k.na; i++)
        sum += tube->om2_a[i] * q[k.a + i] * q[k.a + i];
    return 0.5 * sum;
}

double tube_damping_power(const flexible_tube *tube, const double *q_dot)
{
    parts k = parts_of(tube);
    double sum = 0;
    for (int i = 0; i < k.nb; i++)
        sum += tube->dmp_b[PLANE_Y][i] * q_dot[k.y + i] * q_dot[k.y + i];
    for (int i = 0; i < k.nb; i++)
        sum += tube->dmp_b[PLANE_Z][i] * q_dot[k.z + i] * q_dot[k.z + i];
    for (int i = 0; i < k.nt; i++)
        sum += tube->dmp_t[i] * q_dot[k.t + i] * q_dot[k.t + i];
    for (int i = 0; i < k.na; i++)
        sum += tube->dmp_a[i] * q_dot[k.a + i] * q_dot[k.a + i];
    return -sum;
}

v3 tube_first_moment(const flexible_tube *tube, const double *q)
{
    parts k = parts_of(tube);
    double drawn[LD_NB], shorter = 0;
    for (int plane = PLANE_Y; plane <= PLANE_Z && tube->shortening; plane++) {
        const double *bent = q + plane * k.nb;
        const tube_shortening *self = tube->shortening;
        shortening_apply(tube, shortening_matrix(self, self->first, plane), bent, drawn);
        shorter += 0.5 * dot(k.nb, bent, drawn);
    }
    return v3_make(tube->s0 + dot(k.na, tube->at, q + k.a) - shorter,
                   dot(k.nb, tube->ct[PLANE_Y], q + k.y), dot(k.nb, tube->ct[PLANE_Z], q + k.z));
}
