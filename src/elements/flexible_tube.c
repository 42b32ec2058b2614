#include "elements/flexible_tube.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "elements/beam_finite_elements.h"
#include "math/symmetric_eigen.h"

// What is tied to one line of the tube besides itself: the tail's rigid mass at x = 0 and the
// support springs.
typedef struct line_ties {
    double tail[2][2]; // tail's mass for the rigid shapes 1 and x (bars: 1 only)
    int springs;
    double at[LD_MAX_SUPPORTS];    // [m]
    double value[LD_MAX_SUPPORTS]; // stiffness against the shape's value
    double slope[LD_MAX_SUPPORTS]; // and, in bending, against its slope
    int held;                      // values and slopes that are held rigidly
    double held_at[LD_MAX_CLAMPED];
    bool held_slope[LD_MAX_CLAMPED];
} line_ties;

// The shapes chosen on a line, in tangent form, orthonormal, and the frequencies on the supports.
typedef struct line_shapes {
    int count;
    double om2[LD_NB];
    double supported[LD_NB]; // [rad/s]
    double *nodal;           // [count][n] nodal vectors, owned
    double *part;            // [count][n] amplitudes of the elements, of unit elastic energy, owned
} line_shapes;

// The line is held where both of its directions are.
static void hold(line_ties *ties, const ld_support *support, ld_clamp a, ld_clamp b, bool slope)
{
    if (!support_clamps(support, a) || !support_clamps(support, b))
        return;
    ties->held_at[ties->held] = support->at;
    ties->held_slope[ties->held++] = slope;
}

// How many of what is held the line follows as a rigid one: of slopes alone one, of a single value
// one, else as many as it has rigid shapes.
static int held_by_rigid_shapes(const line_ties *ties, int width)
{
    int values = 0;
    for (int c = 0; c < ties->held; c++)
        values += !ties->held_slope[c];
    int most = values > 0 ? width : 1;
    return ties->held < most ? ties->held : most;
}

// Tail and springs as one line feels them. Both planes share their shapes: bending takes the mean
// of their inertia and stiffness, which are equal as a rule.
static line_ties ties_of(line_kind kind, const ld_tubes *model)
{
    const ld_tail *tail = &model->tail;
    double m = tail->mass, s = m * tail->center;
    double J = 0.5 * (tail->inertia[1] + tail->inertia[2]) + s * tail->center;
    line_ties ties = {.springs = model->support_count};
    if (kind == LINE_BENDING)
        memcpy(ties.tail, (double[2][2]){{m, s}, {s, J}}, sizeof ties.tail);
    else
        ties.tail[0][0] = kind == LINE_TORSION ? tail->inertia[0] : m;
    for (int k = 0; k < model->support_count; k++) {
        const ld_support *support = &model->support[k];
        double K[LD_CLAMPS];
        for (int i = 0; i < LD_CLAMPS; i++)
            K[i] = support_spring(support, (ld_clamp)i);
        ties.at[k] = support->at;
        ties.value[k] = kind == LINE_BENDING   ? 0.5 * (K[LD_CLAMP_Y] + K[LD_CLAMP_Z])
                        : kind == LINE_TORSION ? K[LD_CLAMP_ROLL]
                                               : K[LD_CLAMP_X];
        ties.slope[k] = kind == LINE_BENDING ? 0.5 * (K[LD_CLAMP_YAW] + K[LD_CLAMP_PITCH]) : 0;
        if (kind == LINE_BENDING) {
            hold(&ties, support, LD_CLAMP_Y, LD_CLAMP_Z, false);
            hold(&ties, support, LD_CLAMP_PITCH, LD_CLAMP_YAW, true);
        } else {
            ld_clamp only = kind == LINE_TORSION ? LD_CLAMP_ROLL : LD_CLAMP_X;
            hold(&ties, support, only, only, false);
        }
    }
    return ties;
}

static void add_outer(int n, double *A, double k, const double *s)
{
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            A[i * n + j] += k * s[i] * s[j];
}

// Mass A and stiffness B of the free line with its ties, order N = width + n, in the coordinates
// (rigid shapes, amplitudes of the elements' deformations). `s` [N] is room for one row.
static void assemble_free(const tube_line *line, const line_ties *ties, double *A, double *B,
                          double *s)
{
    int w = line->width, n = line->n, N = w + n;
    for (int r = 0; r < w; r++) {
        for (int k = 0; k < w; k++)
            A[r * N + k] = line->rigid[r][k] + ties->tail[r][k];
        for (int k = 0; k < n; k++) {
            double sum = 0;
            for (int i = 0; i < n; i++)
                sum += line->moment[r][i] * line->shape[k * n + i];
            A[r * N + w + k] = A[(w + k) * N + r] = sum;
        }
    }
    for (int k = 0; k < n; k++) {
        memcpy(&A[(w + k) * N + w], &line->mass[k * n], (size_t)n * sizeof *A);
        B[(w + k) * (N + 1)] = 1;
    }
    for (int spring = 0; spring < ties->springs; spring++) {
        double x = ties->at[spring];
        s[0] = 1;
        if (w == 2)
            s[1] = x;
        for (int k = 0; k < n; k++)
            s[w + k] = tube_line_value(line, &line->shape[k * n], x);
        add_outer(N, B, ties->value[spring], s);
        s[0] = 0;
        if (w == 2)
            s[1] = 1;
        for (int k = 0; k < n; k++)
            s[w + k] = tube_line_slope(line, &line->shape[k * n], x);
        add_outer(N, B, ties->slope[spring], s);
    }
}

// Value or slope at x of the line's coordinates, one row.
static void tie_row(const tube_line *line, double x, bool slope, double *s)
{
    int w = line->width;
    s[0] = slope ? 0 : 1;
    if (w == 2)
        s[1] = slope ? 1 : x;
    for (int k = 0; k < line->n; k++)
        s[w + k] = slope ? tube_line_slope(line, &line->shape[k * line->n], x)
                         : tube_line_value(line, &line->shape[k * line->n], x);
}

// x := x - 2 v (v . x), both [N] from `first` on, v of length 1.
static void reflect(int first, int N, const double *v, double *x, int stride)
{
    double sum = 0;
    for (int i = first; i < N; i++)
        sum += v[i] * x[i * stride];
    for (int i = first; i < N; i++)
        x[i * stride] -= 2 * sum * v[i];
}

// Householder vectors [held][N] of reflections that leave what is held to the first coordinates.
static void find_reflections(const tube_line *line, const line_ties *ties, double *v)
{
    int N = line->width + line->n;
    for (int c = 0; c < ties->held; c++) {
        double *row = v + c * N, size = 0;
        tie_row(line, ties->held_at[c], ties->held_slope[c], row);
        for (int b = 0; b < c; b++)
            reflect(b, N, v + b * N, row, 1);
        for (int i = c; i < N; i++)
            size += row[i] * row[i];
        row[c] += copysign(sqrt(size), row[c]);
        size = 0;
        for (int i = c; i < N; i++)
            size += row[i] * row[i];
        for (int i = 0; i < N; i++)
            row[i] = i < c ? 0 : row[i] / sqrt(size);
    }
}

// The part of A [N][N] in coordinates in which the first `held` are held at zero: in place, [m][m].
static void leave_out_held(int N, int held, const double *v, double *A)
{
    for (int c = 0; c < held; c++) {
        for (int i = 0; i < N; i++)
            reflect(c, N, v + c * N, A + i * N, 1);
        for (int i = 0; i < N; i++)
            reflect(c, N, v + c * N, A + i, N);
    }
    for (int i = held; i < N; i++)
        memmove(A + (i - held) * (N - held), A + i * N + held, (size_t)(N - held) * sizeof *A);
}

// Back to the coordinates of the line: `count` vectors of N - held become vectors of N, in place.
static void put_back_held(int N, int held, const double *v, int count, double *vector)
{
    for (int k = count - 1; k >= 0; k--) {
        double *to = vector + k * N;
        memmove(to + held, vector + k * (N - held), (size_t)(N - held) * sizeof *to);
        memset(to, 0, (size_t)held * sizeof *to);
        for (int c = held - 1; c >= 0; c--)
            reflect(c, N, v + c * N, to, 1);
    }
}

// The `wanted` lowest natural frequencies and modes of the free line with its ties: rows of
// `vector` [wanted][N] from the highest to the lowest, omega^2 in `lambda` [N] in the same order.
// Solved for 1/(lambda + sigma), which keeps the digits of the low ones and lets rigid motions be.
static ld_status solve_free(const tube_line *line, const line_ties *ties, int wanted,
                            double *vector, double *lambda, ld_error *error)
{
    int N = line->width + line->n;
    size_t NN = (size_t)N * (size_t)N;
    int held = ties->held;
    double *A = calloc(2 * NN + (size_t)((held + 1) * N), sizeof *A);
    if (!A)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for %d modes", N);
    double *B = A + NN, *v = B + NN + N;
    assemble_free(line, ties, A, B, B + NN);
    for (size_t i = 0; i < NN; i++)
        B[i] += line->low * A[i];
    find_reflections(line, ties, v);
    if (held > 0) {
        leave_out_held(N, held, v, A);
        leave_out_held(N, held, v, B);
    }
    int info = symmetric_eigen(N - held, A, B, wanted, lambda, vector);
    if (!info)
        put_back_held(N, held, v, wanted, vector);
    free(A);
    if (info == EIGEN_NO_MEMORY)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for %d modes", N);
    if (info || !(lambda[0] > 0))
        return ld_fail(error, LD_ERR_NUMERIC,
                       "the modes of the tube on its supports cannot be found: is a stiffness or "
                       "a mass not finite or out of all proportion?");
    for (int k = 0; k < wanted; k++)
        lambda[k] = fmax(0, 1 / lambda[k] - line->low);
    return LD_OK;
}

static double dot(int n, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

// Elastic parts of the modes from the lowest on, made orthonormal in elastic energy: rows of `part`
// [m][n], of which `found` are there. A mode whose part is rounding, or depends on those before, is
// passed over: of a nearly rigid tube the first ones may be. Returns how many were found.
static int take_elastic_parts(const tube_line *line, const double *vector, int count, int found,
                              int m, double *part)
{
    int w = line->width, n = line->n, N = w + n;
    for (int k = 0; k < count && found < m; k++) {
        double *e = &part[found * n];
        memcpy(e, &vector[(count - 1 - k) * N + w], (size_t)n * sizeof *e);
        for (int pass = 0; pass < 2; pass++)
            for (int j = 0; j < found; j++) {
                double p = dot(n, e, &part[j * n]);
                for (int i = 0; i < n; i++)
                    e[i] -= p * part[j * n + i];
            }
        double size = sqrt(dot(n, e, e));
        if (size < 1e-9)
            continue;
        for (int i = 0; i < n; i++)
            e[i] /= size;
        found++;
    }
    return found;
}

// Elastic parts of the `m` lowest clamped modes.
static ld_status take_clamped(const tube_line *line, int m, double *part, ld_error *error)
{
    int n = line->n;
    size_t nn = (size_t)n * (size_t)n;
    double *mass = malloc((nn + (size_t)n) * sizeof *mass);
    if (!mass)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for %d modes", n);
    memcpy(mass, line->mass, nn * sizeof *mass);
    int info = symmetric_eigen(n, mass, NULL, m, mass + nn, part);
    free(mass);
    if (info == EIGEN_NO_MEMORY)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for %d modes", n);
    if (info)
        return ld_fail(error, LD_ERR_NUMERIC,
                       "the modes of the clamped tube cannot be found: is a stiffness or a mass "
                       "not finite or out of all proportion?");
    return LD_OK;
}

// Diagonalises the mass of the elastic parts, whose stiffness is E, and writes the tangent shapes:
// unit modal mass, positive at the tip, ascending frequency. `row` [n] is room.
static ld_status diagonalise(const tube_line *line, const double *part, line_shapes *shapes,
                             double *row, ld_error *error)
{
    int n = line->n, m = shapes->count, w = line->width;
    double mass[LD_NB * LD_NB], value[LD_NB], mixes[LD_NB * LD_NB];
    for (int k = 0; k < m; k++) {
        for (int i = 0; i < n; i++)
            row[i] = dot(n, &line->mass[i * n], &part[k * n]);
        for (int l = 0; l < m; l++)
            mass[k * m + l] = dot(n, row, &part[l * n]);
    }
    int info = symmetric_eigen(m, mass, NULL, m, value, mixes);
    if (info == EIGEN_NO_MEMORY)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for %d modes", m);
    if (info || !(value[0] > 0))
        return ld_fail(error, LD_ERR_NUMERIC, "the tube's modes are not independent");
    for (int k = 0; k < m; k++) {
        const double *mix = &mixes[(m - 1 - k) * m];
        double *nodal = &shapes->nodal[k * n], *own = &shapes->part[k * n];
        double omega = 1 / sqrt(value[m - 1 - k]);
        for (int i = 0; i < n; i++) {
            double c = 0;
            for (int l = 0; l < m; l++)
                c += mix[l] * part[l * n + i];
            own[i] = c;
            for (int d = 0; d < n; d++)
                nodal[d] += omega * c * line->shape[i * n + d];
        }
        shapes->om2[k] = omega * omega;
        if (nodal[n - w] < 0)
            for (int d = 0; d < n; d++) {
                nodal[d] = -nodal[d];
                own[d] = -own[d];
            }
    }
    return LD_OK;
}

// Shapes of the span on one line, `count` of them; `work` holds (count + width) N + N + count n
// numbers. Leaving out the rigid shapes makes as many modes dependent as there are, at most.
static ld_status choose_shapes(const tube_line *line, const ld_tubes *model, line_shapes *shapes,
                               double *work, ld_error *error)
{
    int n = line->n, N = line->width + n, m = shapes->count, count = m + line->width, found = 0,
        bearing;
    double *vector = work, *lambda = vector + count * N, *part = lambda + N;
    line_ties ties = ties_of(line->kind, model), none = {0};
    ld_status status = solve_free(line, &ties, count, vector, lambda, error);
    if (status)
        return status;
    for (int k = 0; k < m; k++)
        shapes->supported[k] = sqrt(lambda[count - 1 - k]);
    switch (model->modes.span) {
    case LD_SPAN_SUPPORTED:
        // what is held besides the rigid shapes moves in some of free modes: it bears forces
        bearing = ties.held - held_by_rigid_shapes(&ties, line->width);
        found = take_elastic_parts(line, vector, count, 0, m - bearing, part);
        if (!bearing)
            break;
        __attribute__((fallthrough));
    case LD_SPAN_FREE_FREE:
        status = solve_free(line, &none, count, vector, lambda, error);
        if (status)
            return status;
        found = take_elastic_parts(line, vector, count, found, m, part);
        break;
    case LD_SPAN_CLAMPED:
        status = take_clamped(line, m, part, error);
        if (status)
            return status;
        found = m;
        break;
    }
    if (found < m)
        return ld_fail(error, LD_ERR_INPUT,
                       "only %d of %d modes are independent: take fewer modes or more elements",
                       found, m);
    return diagonalise(line, part, shapes, lambda, error);
}

// Line and shapes of one kind; shapes->count = 0 leaves both empty.
static ld_status build_line(tube_line *line, line_shapes *shapes, line_kind kind,
                            const tube_mesh *mesh, const ld_tubes *model, ld_error *error)
{
    static const char *const names[] = {"bending", "torsion", "axial"};
    if (shapes->count == 0)
        return LD_OK;
    ld_status status = tube_line_build(line, kind, mesh, model, error);
    if (status)
        return status;
    size_t n = (size_t)line->n, N = n + (size_t)line->width, m = (size_t)shapes->count;
    if (m > n)
        return ld_fail(error, LD_ERR_INPUT, "%d %s modes need a mesh of more than %d elements",
                       shapes->count, names[kind], mesh->elements);
    shapes->nodal = calloc(m * n, sizeof(double));
    shapes->part = calloc(m * n, sizeof(double));
    double *work = calloc((m + (size_t)line->width + 1) * N + m * n, sizeof(double));
    status = shapes->nodal && shapes->part && work
                 ? choose_shapes(line, model, shapes, work, error)
                 : ld_fail(error, LD_ERR_MEMORY, "no memory for the modes");
    free(work);
    return status;
}

// Copies the polynomials of all shapes of a line into the elements.
static void fill_elements(flexible_tube *tube, const tube_line *line, const line_shapes *shapes)
{
    for (int e = 0; e < tube->element_count; e++)
        for (int k = 0; k < shapes->count; k++) {
            double p[4];
            tube_element *element = &tube->element[e];
            tube_line_polynomial(line, &shapes->nodal[k * line->n], e, p);
            for (int i = 0; i < 2 * line->width; i++)
                if (line->kind == LINE_BENDING)
                    element->b[i][k] = p[i];
                else if (line->kind == LINE_TORSION)
                    element->tau[i][k] = p[i];
                else
                    element->a[i][k] = p[i];
        }
}

// Frequencies, damping and the integrals of f and x f (the latter may be NULL) of a line's shapes.
static void fill_family(const tube_line *line, const line_shapes *shapes, double zeta, double *om2,
                        double *damping, double *supported, double *first, double *second)
{
    for (int k = 0; k < shapes->count; k++) {
        const double *nodal = &shapes->nodal[k * line->n];
        om2[k] = shapes->om2[k];
        damping[k] = 2 * zeta * sqrt(om2[k]);
        supported[k] = shapes->supported[k];
        first[k] = dot(line->n, line->moment[0], nodal);
        if (second)
            second[k] = dot(line->n, line->moment[1], nodal);
    }
}

// What a plane's bending stiffness is of the mean of both, by section. Returns whether it is the
// same in all.
static bool plane_shares(const ld_tubes *model, int plane, double share[LD_MAX_SECTIONS])
{
    bool same = true;
    for (int i = 0; i < model->section_count; i++) {
        double along_y = section_stiffness_z(&model->section[i]);
        double along_z = section_stiffness_y(&model->section[i]);
        share[i] = (plane == PLANE_Y ? along_y : along_z) / (0.5 * (along_y + along_z));
        same = same && fabs(share[i] - share[0]) <= 1e-13 * share[0];
    }
    return same;
}

// K [m][m] of a plane in the shapes, whose elastic energy its sections have their shares of.
static void plane_stiffness(const line_shapes *shapes, const tube_mesh *mesh, const double *share,
                            double *K)
{
    int m = shapes->count, n = 2 * mesh->elements;
    for (int k = 0; k < m; k++)
        for (int l = 0; l < m; l++) {
            double sum = 0;
            for (int i = 0; i < n; i++)
                sum +=
                    share[mesh->section[i / 2]] * shapes->part[k * n + i] * shapes->part[l * n + i];
            K[k * m + l] = sqrt(shapes->om2[k]) * sqrt(shapes->om2[l]) * sum;
        }
}

// Puts a symmetric matrix [m][m] where a plane has its diagonal and what is off it.
static void store_plane(int m, const double *matrix, double *diagonal, double off[LD_NB][LD_NB])
{
    for (int k = 0; k < m; k++)
        for (int l = 0; l < m; l++)
            if (k == l)
                diagonal[k] = matrix[k * m + l];
            else
                off[k][l] = matrix[k * m + l];
}

// K of a plane whose sections' shares differ, and D = 2 zeta K^(1/2): the one damping ratio for its
// own clamped modes in the space of the shapes.
static ld_status fill_mixed_plane(flexible_tube *tube, int plane, const line_shapes *shapes,
                                  const tube_mesh *mesh, const double *share, double zeta,
                                  ld_error *error)
{
    int m = shapes->count;
    double K[LD_NB * LD_NB], D[LD_NB * LD_NB] = {0}, value[LD_NB], mode[LD_NB * LD_NB];
    plane_stiffness(shapes, mesh, share, K);
    store_plane(m, K, tube->om2_b[plane], tube->mixing->K[plane]);
    int info = symmetric_eigen(m, K, NULL, m, value, mode);
    if (info == EIGEN_NO_MEMORY)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for %d modes", m);
    if (info || !(value[0] > 0))
        return ld_fail(error, LD_ERR_NUMERIC,
                       "the tube's modes in one of its planes cannot be found: are its bending "
                       "stiffnesses out of all proportion?");
    for (int i = 0; i < m; i++)
        for (int k = 0; k < m; k++)
            for (int l = 0; l < m; l++)
                D[k * m + l] += 2 * zeta * sqrt(value[i]) * mode[i * m + k] * mode[i * m + l];
    store_plane(m, D, tube->dmp_b[plane], tube->mixing->D[plane]);
    return LD_OK;
}

// Stiffness and damping of bending in both planes.
static ld_status fill_planes(flexible_tube *tube, const line_shapes *shapes, const tube_mesh *mesh,
                             const ld_tubes *model, ld_error *error)
{
    for (int plane = PLANE_Y; plane <= PLANE_Z; plane++) {
        double share[LD_MAX_SECTIONS] = {0}, zeta = model->modes.damping;
        if (plane_shares(model, plane, share)) {
            for (int k = 0; k < tube->nb; k++) {
                tube->om2_b[plane][k] = share[0] * shapes->om2[k];
                tube->dmp_b[plane][k] = 2 * zeta * sqrt(tube->om2_b[plane][k]);
            }
            continue;
        }
        if (!tube->mixing)
            tube->mixing = aligned_alloc(64, sizeof *tube->mixing);
        if (!tube->mixing)
            return ld_fail(error, LD_ERR_MEMORY, "no memory for the modes");
        if (plane == PLANE_Y)
            memset(tube->mixing, 0, sizeof *tube->mixing);
        ld_status status = fill_mixed_plane(tube, plane, shapes, mesh, share, zeta, error);
        if (status)
            return status;
    }
    return LD_OK;
}

// AB = int a b^T dm: Gauss with three points, exact for the product of linear and cubic.
static void fill_cross(flexible_tube *tube, const tube_mesh *mesh, const ld_tubes *model)
{
    static const double at[3] = {-0.7745966692414833770, 0, 0.7745966692414833770};
    static const double weight[3] = {5.0 / 9, 8.0 / 9, 5.0 / 9};
    int points = 3 * tube->element_count + model->point_mass_count;
    for (int i = 0; i < points; i++) {
        int e = i / 3;
        double x, dm;
        if (e < tube->element_count) {
            double half = 0.5 * (tube->element[e].x1 - tube->element[e].x0);
            x = tube->element[e].x0 + half * (1 + at[i % 3]);
            dm = model->section[mesh->section[e]].mass_per_length * half * weight[i % 3];
        } else {
            const ld_point_mass *point = &model->point_mass[i - 3 * tube->element_count];
            x = point->at;
            dm = point->mass;
            e = flexible_tube_find(tube, x);
        }
        const tube_element *element = &tube->element[e];
        double xi = x - element->x0;
        for (int l = 0; l < tube->nb; l++) {
            double b = element->b[0][l] +
                       xi * (element->b[1][l] + xi * (element->b[2][l] + xi * element->b[3][l]));
            for (int k = 0; k < tube->na; k++)
                tube->AB[k][l] += dm * (element->a[0][k] + xi * element->a[1][k]) * b;
        }
    }
}

static bool on_tube(const ld_tubes *model, double x)
{
    return x >= 0 && x <= model->length;
}

static ld_status check_model(const ld_tubes *model, ld_error *error)
{
    const ld_modes *modes = &model->modes;
    if (modes->bending < 1 || modes->bending > LD_NB || modes->torsion < 0 ||
        modes->torsion > LD_NT || modes->axial < 0 || modes->axial > LD_NA)
        return ld_fail(error, LD_ERR_INPUT,
                       "a tube has 1 to %d bending, 0 to %d torsion and 0 to %d axial modes, not "
                       "%d, %d and %d",
                       LD_NB, LD_NT, LD_NA, modes->bending, modes->torsion, modes->axial);
    if (modes->elements < 1 || !(model->length > 0) || model->section_count < 1)
        return ld_fail(error, LD_ERR_INPUT, "a tube needs a length, a section and an element");
    bool inside = true;
    for (int i = 0; i < model->section_count; i++)
        inside = inside && on_tube(model, model->section[i].from);
    for (int i = 0; i < model->point_mass_count; i++)
        inside = inside && on_tube(model, model->point_mass[i].at);
    for (int i = 0; i < model->support_count; i++)
        inside = inside && on_tube(model, model->support[i].at);
    if (!inside)
        return ld_fail(error, LD_ERR_INPUT,
                       "a section, point mass or support lies outside the tube's length of %g m",
                       model->length);
    return LD_OK;
}

static ld_status allocate_elements(flexible_tube *tube, const tube_mesh *mesh, ld_error *error)
{
    size_t size = (size_t)mesh->elements * sizeof(tube_element);
    tube->element = aligned_alloc(64, size);
    if (!tube->element)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for %d elements", mesh->elements);
    memset(tube->element, 0, size);
    tube->element_count = mesh->elements;
    for (int e = 0; e < mesh->elements; e++) {
        tube->element[e].x0 = mesh->node[e];
        tube->element[e].x1 = mesh->node[e + 1];
    }
    return LD_OK;
}

// Everything that is known once the shapes are: formulation.md, section 5, arrays.
static ld_status fill_tube(flexible_tube *tube, const tube_line line[3],
                           const line_shapes shapes[3], const tube_mesh *mesh,
                           const ld_tubes *model, ld_error *error)
{
    for (int kind = 0; kind < 3; kind++)
        fill_elements(tube, &line[kind], &shapes[kind]);
    double zeta = model->modes.damping;
    fill_family(&line[LINE_BENDING], &shapes[LINE_BENDING], zeta, tube->om2_b[PLANE_Y],
                tube->dmp_b[PLANE_Y], tube->supported_bending, tube->ct, tube->c);
    fill_family(&line[LINE_TORSION], &shapes[LINE_TORSION], zeta, tube->om2_t, tube->dmp_t,
                tube->supported_torsion, tube->cp, NULL);
    fill_family(&line[LINE_STRETCH], &shapes[LINE_STRETCH], zeta, tube->om2_a, tube->dmp_a,
                tube->supported_axial, tube->at, tube->ax);
    fill_cross(tube, mesh, model);
    tube->ctct = dot(tube->nb, tube->ct, tube->ct);
    tube->ctc = dot(tube->nb, tube->ct, tube->c);
    tube->cc = dot(tube->nb, tube->c, tube->c);
    tube->cpcp = dot(tube->nt, tube->cp, tube->cp);
    tube->m = line[LINE_BENDING].rigid[0][0];
    tube->s0 = line[LINE_BENDING].rigid[0][1];
    tube->j0 = line[LINE_BENDING].rigid[1][1];
    for (int e = 0; e < mesh->elements; e++)
        tube->j +=
            model->section[mesh->section[e]].polar_inertia * (mesh->node[e + 1] - mesh->node[e]);
    for (int k = 0; k < model->support_count; k++)
        tube->support_element[k] = flexible_tube_find(tube, model->support[k].at);
    return fill_planes(tube, &shapes[LINE_BENDING], mesh, model, error);
}

static int padded(int count)
{
    return (count + 3) / 4 * 4;
}

ld_status flexible_tube_build(flexible_tube *tube, const ld_tubes *model, ld_error *error)
{
    const ld_modes *modes = &model->modes;
    tube_mesh mesh = {0};
    tube_line line[3] = {0};
    line_shapes shapes[3] = {
        {.count = modes->bending}, {.count = modes->torsion}, {.count = modes->axial}};
    *tube = (flexible_tube){.nb = modes->bending,
                            .nt = modes->torsion,
                            .na = modes->axial,
                            .nbp = padded(modes->bending),
                            .ntp = padded(modes->torsion),
                            .nap = padded(modes->axial),
                            .length = model->length,
                            .bore_radius = model->section[0].bore_radius,
                            .support_count = model->support_count};
    ld_status status = check_model(model, error);
    if (!status)
        status = tube_mesh_build(&mesh, model, error);
    for (int kind = 0; kind < 3 && !status; kind++)
        status = build_line(&line[kind], &shapes[kind], (line_kind)kind, &mesh, model, error);
    if (!status)
        status = allocate_elements(tube, &mesh, error);
    if (!status)
        status = fill_tube(tube, line, shapes, &mesh, model, error);
    for (int kind = 0; kind < 3; kind++) {
        tube_line_free(&line[kind]);
        free(shapes[kind].nodal);
        free(shapes[kind].part);
    }
    tube_mesh_free(&mesh);
    return status;
}

void flexible_tube_free(flexible_tube *tube)
{
    free(tube->element);
    free(tube->mixing);
    *tube = (flexible_tube){0};
}

int flexible_tube_find(const flexible_tube *tube, double x)
{
    int last = tube->element_count - 1;
    if (!(x > 0))
        return 0;
    if (x >= tube->length)
        return last;
    // near the place it has on an even mesh
    int e = (int)(x / tube->length * tube->element_count);
    e = e > last ? last : e;
    while (e > 0 && x < tube->element[e].x0)
        e--;
    while (e < last && x >= tube->element[e].x1)
        e++;
    return e;
}
