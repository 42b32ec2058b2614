#include "support/frame_elements.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "math/matrices/lapack.h"
#include "support/check.h"

enum { FREEDOMS = 6 * FRAME_MOST_NODES };

void frame_create(frame *self)
{
    memset(self, 0, sizeof *self);
    self->K = calloc((size_t)FREEDOMS * FREEDOMS, sizeof(double));
    self->M = calloc((size_t)FREEDOMS * FREEDOMS, sizeof(double));
    self->f = calloc(FREEDOMS, sizeof(double));
    assert_true(self->K && self->M && self->f);
}

void frame_free(frame *self)
{
    free(self->K);
    free(self->M);
    free(self->f);
    memset(self, 0, sizeof *self);
}

int frame_node(frame *self, const double place[3])
{
    assert_true(self->nodes < FRAME_MOST_NODES);
    memcpy(self->place[self->nodes], place, sizeof self->place[0]);
    return self->nodes++;
}

// ---- elements

// Bending of an element of length h in one plane, freedoms w_1, phi_1, w_2, phi_2 with phi the turn
// of the section: shapes of w and phi at s = x/h, whose shear strain is constant; `p` is 12 EI/(kGA
// h^2).
static void bend_shapes(double h, double p, double s, double w[4], double phi[4])
{
    double c = 1 / (1 + p), s2 = s * s, s3 = s2 * s;
    w[0] = c * (1 - 3 * s2 + 2 * s3 + p * (1 - s));
    w[1] = c * h * (s - 2 * s2 + s3 + 0.5 * p * (s - s2));
    w[2] = c * (3 * s2 - 2 * s3 + p * s);
    w[3] = c * h * (s3 - s2 + 0.5 * p * (s2 - s));
    phi[0] = c * 6 / h * (s2 - s);
    phi[1] = c * (1 - 4 * s + 3 * s2 + p * (1 - s));
    phi[2] = c * 6 / h * (s - s2);
    phi[3] = c * (3 * s2 - 2 * s + p * s);
}

// dw/dx.
static void bend_slopes(double h, double p, double s, double w1[4])
{
    double c = 1 / (1 + p), s2 = s * s;
    w1[0] = c / h * (6 * s2 - 6 * s - p);
    w1[1] = c * (1 - 4 * s + 3 * s2 + p * (0.5 - s));
    w1[2] = c / h * (6 * s - 6 * s2 + p);
    w1[3] = c * (3 * s2 - 2 * s + p * (s - 0.5));
}

enum { GAUSS = 4 };
static const double gauss_at[GAUSS] = {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                       0.8611363115940526};
static const double gauss_weight[GAUSS] = {0.3478548451374538, 0.6521451548625461,
                                           0.6521451548625461, 0.3478548451374538};

typedef struct plane_matrices {
    double K[4][4], M[4][4], G[4][4], f[4]; // G: of unit tension; f: of a unit load per length
} plane_matrices;

static plane_matrices bend(double h, double EI, double kGA, double mass, double rotary)
{
    plane_matrices m = {0};
    double p = kGA > 0 ? 12 * EI / (kGA * h * h) : 0, k = EI / (h * h * h * (1 + p));
    const double K[4][4] = {{12, 6 * h, -12, 6 * h},
                            {6 * h, (4 + p) * h * h, -6 * h, (2 - p) * h * h},
                            {-12, -6 * h, 12, -6 * h},
                            {6 * h, (2 - p) * h * h, -6 * h, (4 + p) * h * h}};
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            m.K[i][j] = k * K[i][j];
    for (int g = 0; g < GAUSS; g++) {
        double w[4], phi[4], w1[4], s = 0.5 * (1 + gauss_at[g]), dx = 0.5 * h * gauss_weight[g];
        bend_shapes(h, p, s, w, phi);
        bend_slopes(h, p, s, w1);
        for (int i = 0; i < 4; i++) {
            m.f[i] += dx * w[i];
            for (int j = 0; j < 4; j++) {
                m.M[i][j] += dx * (mass * w[i] * w[j] + rotary * phi[i] * phi[j]);
                m.G[i][j] += dx * w1[i] * w1[j];
            }
        }
    }
    return m;
}

// Freedoms of an element in its own axes: u v w theta_x theta_y theta_z of both nodes.
typedef double element_matrix[12][12];

// Places of a plane's four among them and their signs: v and theta_z, w and -theta_y.
static const int in_y[4] = {1, 5, 7, 11}, in_z[4] = {2, 4, 8, 10};
static const double sign_z[4] = {1, -1, 1, -1};

static void add_bar(element_matrix to, int first, double value, double share)
{
    // [1, s; s, 1]
    to[first][first] += value;
    to[first + 6][first + 6] += value;
    to[first][first + 6] += share * value;
    to[first + 6][first] += share * value;
}

static void element_matrices(const frame_element *e, element_matrix K, element_matrix M,
                             element_matrix G)
{
    const frame_section *s = &e->section;
    double h = e->h;
    plane_matrices y = bend(h, s->EI_z, s->kGA_y, s->mass, s->rotary_z);
    plane_matrices z = bend(h, s->EI_y, s->kGA_z, s->mass, s->rotary_y);
    add_bar(K, 0, s->EA / h, -1);
    add_bar(K, 3, s->GJ / h, -1);
    add_bar(M, 0, s->mass * h / 3, 0.5);
    add_bar(M, 3, s->polar * h / 3, 0.5);
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            double sign = sign_z[i] * sign_z[j];
            K[in_y[i]][in_y[j]] += y.K[i][j];
            M[in_y[i]][in_y[j]] += y.M[i][j];
            G[in_y[i]][in_y[j]] += y.G[i][j];
            K[in_z[i]][in_z[j]] += sign * z.K[i][j];
            M[in_z[i]][in_z[j]] += sign * z.M[i][j];
            G[in_z[i]][in_z[j]] += sign * z.G[i][j];
        }
}

// to += weight T^T m T, T turning the ground's axes into the element's.
static void add_element(const frame_element *e, element_matrix m, double weight, double *to)
{
    for (int a = 0; a < 4; a++)
        for (int b = 0; b < 4; b++)
            for (int i = 0; i < 3; i++)
                for (int j = 0; j < 3; j++) {
                    double sum = 0;
                    for (int k = 0; k < 3; k++)
                        for (int l = 0; l < 3; l++)
                            sum += e->A[i][k] * m[3 * a + k][3 * b + l] * e->A[j][l];
                    to[(6 * e->node + 3 * a + i) * FREEDOMS + 6 * e->node + 3 * b + j] +=
                        weight * sum;
                }
}

int frame_line(frame *self, const double place[3], const double A[3][3], const double *station,
               int count, const frame_section *section)
{
    int first = self->nodes;
    for (int i = 0; i <= count; i++) {
        double at[3];
        for (int k = 0; k < 3; k++)
            at[k] = place[k] + station[i] * A[k][0];
        frame_node(self, at);
    }
    for (int i = 0; i < count; i++) {
        assert_true(self->elements < FRAME_MOST_ELEMENTS);
        frame_element *e = &self->element[self->elements++];
        element_matrix K = {{0}}, M = {{0}}, G = {{0}};
        *e = (frame_element){
            .node = first + i, .h = station[i + 1] - station[i], .section = section[i]};
        memcpy(e->A, A, sizeof e->A);
        element_matrices(e, K, M, G);
        add_element(e, K, 1, self->K);
        add_element(e, M, 1, self->M);
    }
    return first;
}

int frame_beam(frame *self, const double place[3], const double A[3][3], double length, int count,
               const frame_section *section)
{
    double station[FRAME_MOST_NODES];
    frame_section all[FRAME_MOST_ELEMENTS];
    for (int i = 0; i <= count; i++)
        station[i] = length * i / count;
    for (int i = 0; i < count; i++)
        all[i] = *section;
    return frame_line(self, place, A, station, count, all);
}

// ---- nodes that are held or follow

void frame_hold(frame *self, int node, const bool held[6])
{
    assert_true(self->followers < FRAME_MOST_FOLLOWERS);
    frame_follower *f = &self->follower[self->followers++];
    *f = (frame_follower){.node = node, .leader = -1};
    memcpy(f->held, held, sizeof f->held);
}

void frame_clamp(frame *self, int node)
{
    frame_hold(self, node, (const bool[6]){true, true, true, true, true, true});
}

void frame_follow(frame *self, int node, int leader)
{
    assert_true(self->followers < FRAME_MOST_FOLLOWERS);
    self->follower[self->followers++] = (frame_follower){.node = node, .leader = leader};
}

static const frame_follower *follower_of(const frame *self, int node)
{
    for (int i = 0; i < self->followers; i++)
        if (self->follower[i].node == node)
            return &self->follower[i];
    return NULL;
}

// Displacement of a point at arm from a node: rows u, columns of the node's six.
static void arm_rows(const double arm[3], double rows[3][6])
{
    memset(rows, 0, 3 * sizeof *rows);
    for (int i = 0; i < 3; i++)
        rows[i][i] = 1;
    rows[0][4] = arm[2], rows[0][5] = -arm[1];
    rows[1][3] = -arm[2], rows[1][5] = arm[0];
    rows[2][3] = arm[1], rows[2][4] = -arm[0];
}

// All freedoms from the independent ones: T [6 nodes][n], n returned.
static int independent(const frame *self, double **T)
{
    int n = 0, *first = malloc((size_t)self->nodes * 6 * sizeof *first);
    for (int i = 0; i < self->nodes; i++) {
        const frame_follower *f = follower_of(self, i);
        for (int k = 0; k < 6; k++)
            first[6 * i + k] = f && (f->leader >= 0 || f->held[k]) ? -1 : n++;
    }
    *T = calloc((size_t)(6 * self->nodes * n), sizeof **T);
    for (int i = 0; i < self->nodes; i++) {
        const frame_follower *f = follower_of(self, i);
        double arm[3] = {0}, rows[3][6];
        int leader = f && f->leader >= 0 ? f->leader : i;
        for (int k = 0; k < 3; k++)
            arm[k] = self->place[i][k] - self->place[leader][k];
        arm_rows(arm, rows);
        for (int k = 0; k < 6; k++)
            for (int l = 0; l < 6; l++) {
                double value = k < 3 ? rows[k][l] : k == l;
                if (first[6 * leader + l] >= 0)
                    (*T)[(6 * i + k) * n + first[6 * leader + l]] = value;
            }
    }
    free(first);
    return n;
}

// T^T A T.
static double *reduced(const frame *self, const double *A, const double *T, int n)
{
    int all = 6 * self->nodes;
    double *AT = calloc((size_t)(all * n), sizeof *AT), *R = calloc((size_t)(n * n), sizeof *R);
    for (int i = 0; i < all; i++)
        for (int j = 0; j < all; j++) {
            double a = A[i * FREEDOMS + j];
            for (int k = 0; k < n && a != 0; k++)
                AT[i * n + k] += a * T[j * n + k];
        }
    for (int i = 0; i < all; i++)
        for (int j = 0; j < n; j++) {
            double t = T[i * n + j];
            for (int k = 0; k < n && t != 0; k++)
                R[j * n + k] += t * AT[i * n + k];
        }
    free(AT);
    return R;
}

// ---- springs, bodies, loads

void frame_spring(frame *self, int a, int b, const frame_springs *spring)
{
    double stretch[6][12] = {{0}};
    for (int side = 0; side < 2; side++) {
        int node = side ? b : a;
        double arm[3], rows[3][6], sign = side ? 1 : -1;
        if (node < 0)
            continue;
        for (int k = 0; k < 3; k++)
            arm[k] = spring->place[k] - self->place[node][k];
        arm_rows(arm, rows);
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++) {
                stretch[3 + i][6 * side + 3 + k] = sign * spring->A[k][i];
                for (int l = 0; l < 6; l++)
                    stretch[i][6 * side + l] += sign * spring->A[k][i] * rows[k][l];
            }
    }
    for (int p = 0; p < 12; p++)
        for (int q = 0; q < 12; q++)
            for (int i = 0; i < 6; i++) {
                int node_p = p < 6 ? a : b, node_q = q < 6 ? a : b;
                double k = i < 3 ? spring->stiffness[i] : spring->rotational[i - 3];
                if (node_p >= 0 && node_q >= 0)
                    self->K[(6 * node_p + p % 6) * FREEDOMS + 6 * node_q + q % 6] +=
                        k * stretch[i][p] * stretch[i][q];
            }
}

void frame_body(frame *self, int node, double mass, const double center[3], const double inertia[3])
{
    double arm[3], rows[3][6];
    for (int k = 0; k < 3; k++)
        arm[k] = center[k] - self->place[node][k];
    arm_rows(arm, rows);
    for (int p = 0; p < 6; p++)
        for (int q = 0; q < 6; q++) {
            double sum = p == q && p >= 3 ? inertia[p - 3] : 0;
            for (int i = 0; i < 3; i++)
                sum += mass * rows[i][p] * rows[i][q];
            self->M[(6 * node + p) * FREEDOMS + 6 * node + q] += sum;
        }
}

void frame_force(frame *self, int node, const double force[3])
{
    for (int k = 0; k < 3; k++)
        self->f[6 * node + k] += force[k];
}

// The mass matrix times a common acceleration: consistent loads.
void frame_weigh(frame *self, const double gravity[3])
{
    for (int i = 0; i < 6 * self->nodes; i++)
        for (int node = 0; node < self->nodes; node++)
            for (int k = 0; k < 3; k++)
                self->f[i] += self->M[i * FREEDOMS + 6 * node + k] * gravity[k];
}

// ---- solutions

static double *with_tension(const frame *self)
{
    double *K = malloc((size_t)FREEDOMS * FREEDOMS * sizeof *K);
    memcpy(K, self->K, (size_t)FREEDOMS * FREEDOMS * sizeof *K);
    for (int i = 0; i < self->elements; i++) {
        element_matrix k = {{0}}, m = {{0}}, g = {{0}};
        element_matrices(&self->element[i], k, m, g);
        add_element(&self->element[i], g, self->element[i].N, K);
    }
    return K;
}

static void solve_once(frame *self, const double *K, double *u)
{
    double *T;
    int n = independent(self, &T), all = 6 * self->nodes;
    double *R = reduced(self, K, T, n), *x = calloc((size_t)n, sizeof *x);
    lapack_int *pivot = malloc((size_t)n * sizeof *pivot);
    for (int i = 0; i < all; i++)
        for (int j = 0; j < n; j++)
            x[j] += T[i * n + j] * self->f[i];
    assert_int_equal(LAPACKE_dgesv(LAPACK_COL_MAJOR, n, 1, R, n, pivot, x, n), 0);
    for (int i = 0; i < all; i++) {
        u[i] = 0;
        for (int j = 0; j < n; j++)
            u[i] += T[i * n + j] * x[j];
    }
    for (int i = 0; i < self->elements; i++) {
        frame_element *e = &self->element[i];
        double stretch = 0;
        for (int k = 0; k < 3; k++)
            stretch += e->A[k][0] * (u[6 * e->node + 6 + k] - u[6 * e->node + k]);
        e->N = e->section.EA / e->h * stretch;
    }
    free(pivot);
    free(x);
    free(R);
    free(T);
}

void frame_solve(frame *self, bool geometric, double *u)
{
    solve_once(self, self->K, u);
    for (int pass = 0; pass < 2 && geometric; pass++) {
        double *K = with_tension(self);
        solve_once(self, K, u);
        free(K);
    }
}

static void eigenvalues(int n, double *A, double *B, double *value)
{
    assert_int_equal(LAPACKE_dsygv(LAPACK_COL_MAJOR, 1, 'N', 'U', n, A, n, B, n, value), 0);
}

void frame_frequencies(frame *self, bool geometric, int count, double *omega)
{
    double *T, *K = geometric ? with_tension(self) : self->K;
    int n = independent(self, &T);
    double *A = reduced(self, K, T, n), *B = reduced(self, self->M, T, n);
    double *value = malloc((size_t)n * sizeof *value);
    eigenvalues(n, A, B, value);
    for (int i = 0; i < count; i++)
        omega[i] = copysign(sqrt(fabs(value[i])), value[i]);
    free(value);
    free(A);
    free(B);
    free(T);
    if (geometric)
        free(K);
}

double frame_buckling(frame *self)
{
    double *T, *K = with_tension(self), factor = 0;
    int n = independent(self, &T);
    for (int i = 0; i < FREEDOMS * FREEDOMS; i++)
        K[i] = self->K[i] - K[i];
    double *A = reduced(self, K, T, n), *B = reduced(self, self->K, T, n);
    double *value = malloc((size_t)n * sizeof *value);
    // -G x = value K x: the largest value is one over the factor
    eigenvalues(n, A, B, value);
    factor = 1 / value[n - 1];
    free(value);
    free(A);
    free(B);
    free(K);
    free(T);
    return factor;
}

void frame_set_tension(frame *self, int element, double N)
{
    self->element[element].N = N;
}
