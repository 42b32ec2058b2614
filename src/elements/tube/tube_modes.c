#include "elements/tube/tube_modes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "math/matrices/symmetric_eigen.h"

enum { MOST = LD_MAX_BENDING_MODES };

// How much of plane y and of plane z is in a line.
static const double weight_of[][2] = {
    [PLANE_Y] = {1, 0}, [PLANE_Z] = {0, 1}, [PLANES_ALIKE] = {0.5, 0.5}};

// The line is held where the directions of all of its planes are.
static void tie_support(line_ties *ties, const ld_support *support, const double weight[2],
                        ld_clamp y, ld_clamp z, bool slope)
{
    if ((weight[PLANE_Y] > 0 && !support_clamps(support, y)) ||
        (weight[PLANE_Z] > 0 && !support_clamps(support, z)))
        return;
    ties->held_at[ties->held] = support->at;
    ties->held_slope[ties->held++] = slope;
}

static double spring_of(const ld_support *support, const double weight[2], ld_clamp y, ld_clamp z)
{
    return weight[PLANE_Y] * support_spring(support, y) +
           weight[PLANE_Z] * support_spring(support, z);
}

static void tie_bending(const ld_support *support, const double weight[2], line_ties *ties)
{
    ties->value[ties->springs] = spring_of(support, weight, LD_CLAMP_Y, LD_CLAMP_Z);
    ties->slope[ties->springs] = spring_of(support, weight, LD_CLAMP_PITCH, LD_CLAMP_YAW);
    tie_support(ties, support, weight, LD_CLAMP_Y, LD_CLAMP_Z, false);
    tie_support(ties, support, weight, LD_CLAMP_PITCH, LD_CLAMP_YAW, true);
}

static void tie_bar(const ld_support *support, const double weight[2], ld_clamp only,
                    line_ties *ties)
{
    ties->value[ties->springs] = support_spring(support, only);
    tie_support(ties, support, weight, only, only, false);
}

// Tail and supports as a line in these planes feels them.
static line_ties ties_of(line_kind kind, const double weight[2], const ld_tubes *model)
{
    const ld_tail *tail = &model->tail;
    double m = tail->mass, s = m * tail->center;
    double J = weight[PLANE_Y] * tail->inertia[2] + weight[PLANE_Z] * tail->inertia[1];
    line_ties ties = {0};
    if (kind == LINE_BENDING)
        memcpy(ties.tail, (double[2][2]){{m, s}, {s, J + s * tail->center}}, sizeof ties.tail);
    else
        ties.tail[0][0] = kind == LINE_TORSION ? tail->inertia[0] : m;
    for (; ties.springs < model->support_count; ties.springs++) {
        const ld_support *support = &model->support[ties.springs];
        ties.at[ties.springs] = support->at;
        if (kind == LINE_BENDING)
            tie_bending(support, weight, &ties);
        else
            tie_bar(support, weight, kind == LINE_TORSION ? LD_CLAMP_ROLL : LD_CLAMP_X, &ties);
    }
    return ties;
}

void tied_line_make(tied_line *self, const tube_line *line, const ld_tubes *model)
{
    int plane = line->kind == LINE_BENDING ? line->plane : PLANES_ALIKE;
    *self = (tied_line){.line = line, .ties = ties_of(line->kind, weight_of[plane], model)};
}

// Whether two stiffnesses are as `share` to 2 - share.
static bool as_share(double y, double z, double share)
{
    return fabs(y * (2 - share) - z * share) <= 1e-13 * (y * (2 - share) + z * share);
}

// Whether what a support ties the planes to is in that proportion, too.
static bool ties_alike(const ld_support *support, double share)
{
    return support_clamps(support, LD_CLAMP_Y) == support_clamps(support, LD_CLAMP_Z) &&
           support_clamps(support, LD_CLAMP_PITCH) == support_clamps(support, LD_CLAMP_YAW) &&
           as_share(support_spring(support, LD_CLAMP_Y), support_spring(support, LD_CLAMP_Z),
                    share) &&
           as_share(support_spring(support, LD_CLAMP_PITCH), support_spring(support, LD_CLAMP_YAW),
                    share);
}

bool tube_planes_alike(const ld_tubes *model)
{
    double share = section_share(&model->section[0], PLANE_Y);
    bool alike = !(model->modes.shear_coefficient > 0) || share == 1;
    for (int i = 1; i < model->section_count; i++)
        alike = alike && as_share(section_stiffness_z(&model->section[i]),
                                  section_stiffness_y(&model->section[i]), share);
    if (model->modes.span != LD_SPAN_SUPPORTED)
        return alike;
    for (int k = 0; k < model->support_count; k++)
        alike = alike && ties_alike(&model->support[k], share);
    return alike && model->tail.inertia[1] == model->tail.inertia[2];
}

static void add_outer(int n, double *A, double k, const double *s)
{
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            A[i * n + j] += k * s[i] * s[j];
}

// Mass A and stiffness B of the free line with its ties, order N = width + n, in the coordinates
// (rigid shapes, amplitudes of the elements' deformations). `s` [N] is room for one row.
static void assemble_free(const tied_line *self, double *A, double *B, double *s)
{
    const tube_line *line = self->line;
    const line_ties *ties = &self->ties;
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

// Solved for 1/(lambda + sigma), which keeps the digits of the low ones and lets rigid motions be.
ld_status tied_line_solve(const tied_line *self, int wanted, double *vector, double *lambda,
                          ld_error *error)
{
    const tube_line *line = self->line;
    const line_ties *ties = &self->ties;
    int N = line->width + line->n;
    size_t NN = (size_t)N * (size_t)N;
    int held = ties->held;
    double *A = calloc(2 * NN + (size_t)((held + 1) * N), sizeof *A);
    if (!A)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for %d modes", N);
    double *B = A + NN, *v = B + NN + N;
    assemble_free(self, A, B, B + NN);
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
                       "the modes of the tube on its supports cannot be computed: check that "
                       "stiffnesses and masses are finite and in proportion");
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

// Modes of a line, as their elastic parts: amplitudes of the elements.
typedef struct elastic_modes {
    int count;
    double *part;  // [...][n] orthonormal in the line's elastic energy
    double *omega; // [...] [rad/s]
} elastic_modes;

// x := x less what it has of the `count` orthonormal rows, twice, for rounding. Returns its length.
static double take_out(int n, int count, const double *rows, double *x)
{
    for (int pass = 0; pass < 2; pass++)
        for (int j = 0; j < count; j++) {
            double p = dot(n, x, &rows[j * n]);
            for (int i = 0; i < n; i++)
                x[i] -= p * rows[j * n + i];
        }
    return sqrt(dot(n, x, x));
}

// Adds modes of the line with these ties, of which it needs `m` at most, from the lowest on, until
// there are `until`. A mode whose part is rounding, or depends on those before, is passed over: of
// a nearly rigid tube the first ones may be. Leaving out the rigid shapes makes as many modes
// dependent as there are, at most.
static ld_status add_free_modes(const tied_line *self, int m, int until, elastic_modes *modes,
                                ld_error *error)
{
    int w = self->line->width, n = self->line->n, N = w + n, wanted = m + w;
    double *vector = malloc((size_t)((wanted + 1) * N) * sizeof *vector);
    if (!vector)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for %d modes", N);
    double *lambda = vector + wanted * N;
    ld_status status = tied_line_solve(self, wanted, vector, lambda, error);
    for (int k = wanted - 1; k >= 0 && modes->count < until && !status; k--) {
        double *part = &modes->part[modes->count * n];
        memcpy(part, &vector[k * N + w], (size_t)n * sizeof *part);
        double size = take_out(n, modes->count, modes->part, part);
        if (size < 1e-9)
            continue;
        for (int i = 0; i < n; i++)
            part[i] /= size;
        modes->omega[modes->count++] = sqrt(lambda[k]);
    }
    free(vector);
    return status;
}

// Adds the `m` lowest clamped modes, which no ties reach.
static ld_status add_clamped_modes(const tied_line *self, int m, elastic_modes *modes,
                                   ld_error *error)
{
    int n = self->line->n;
    size_t nn = (size_t)n * (size_t)n;
    double *mass = calloc(nn + (size_t)n, sizeof *mass);
    if (!mass)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for %d modes", n);
    double *value = mass + nn;
    memcpy(mass, self->line->mass, nn * sizeof *mass);
    int info = symmetric_eigen(n, mass, NULL, m, value, modes->part);
    for (int k = 0; k < m && !info; k++)
        modes->omega[k] = 1 / sqrt(value[k]);
    free(mass);
    modes->count = m;
    if (info == EIGEN_NO_MEMORY)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for %d modes", n);
    if (info)
        return ld_fail(error, LD_ERR_NUMERIC,
                       "the modes of the clamped tube cannot be computed: check that stiffnesses "
                       "and masses are finite and in proportion");
    return LD_OK;
}

// The lowest clamped modes and, as the last ones, what a force and a moment at the tip bend:
// nothing converges slower than clamped modes under the body that a beam carries there.
static ld_status add_tip_loaded_modes(const tied_line *self, int m, elastic_modes *modes,
                                      ld_error *error)
{
    const tube_line *line = self->line;
    int w = line->width, n = line->n;
    ld_status status = m > w ? add_clamped_modes(self, m - w, modes, error) : LD_OK;
    for (int load = 0; load < w && modes->count < m && !status; load++) {
        // the elastic stiffness is E: an element's amplitude is the load times its shape there
        double *part = &modes->part[modes->count * n];
        for (int i = 0; i < n; i++)
            part[i] = line->shape[i * n + n - w + load];
        double length = sqrt(dot(n, part, part)),
               size = take_out(n, modes->count, modes->part, part);
        if (size < 1e-9 * length)
            break;
        for (int i = 0; i < n; i++)
            part[i] /= size;
        modes->count++;
    }
    return status;
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

// `m` modes of the span, or as many as are independent.
static ld_status find_modes(const tied_line *self, ld_mode_span span, int m, elastic_modes *modes,
                            ld_error *error)
{
    tied_line untied = *self;
    untied.ties = (line_ties){0};
    modes->count = 0;
    if (span == LD_SPAN_CLAMPED)
        return add_clamped_modes(self, m, modes, error);
    if (span == LD_SPAN_TIP_LOADED)
        return add_tip_loaded_modes(self, m, modes, error);
    if (span == LD_SPAN_FREE_FREE)
        return add_free_modes(&untied, m, m, modes, error);
    // what is held besides the rigid shapes moves in some of free modes: it bears forces
    int bearing = self->ties.held - held_by_rigid_shapes(&self->ties, self->line->width);
    ld_status status = add_free_modes(self, m, m - bearing, modes, error);
    return status || !bearing ? status : add_free_modes(&untied, m, m, modes, error);
}

// Turns elastic parts [m][n], whose stiffness is E, into those of diagonal mass, by ascending
// frequency: `own` [m][n], `omega` [m].
static ld_status diagonalise(const tube_line *line, int m, const double *part, double *own,
                             double *omega, ld_error *error)
{
    int n = line->n;
    double mass[MOST * MOST], value[MOST], mixes[MOST * MOST];
    for (int k = 0; k < m; k++) {
        double *row = own; // room until the parts stand there
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
        omega[k] = 1 / sqrt(value[m - 1 - k]);
        for (int i = 0; i < n; i++) {
            own[k * n + i] = 0;
            for (int l = 0; l < m; l++)
                own[k * n + i] += mix[l] * part[l * n + i];
        }
    }
    return LD_OK;
}

// Writes the tangent shapes of the parts: unit modal mass, positive at the tip.
static void write_shapes(const tube_line *line, const double *own, const double *omega,
                         line_shapes *shapes)
{
    int n = line->n, w = line->width;
    for (int k = 0; k < shapes->count; k++) {
        double *nodal = &shapes->nodal[k * n];
        for (int i = 0; i < n; i++)
            for (int d = 0; d < n; d++)
                nodal[d] += omega[k] * own[k * n + i] * line->shape[i * n + d];
        shapes->om2[k] = omega[k] * omega[k];
        if (nodal[n - w] < 0)
            for (int d = 0; d < n; d++)
                nodal[d] = -nodal[d];
    }
}

static ld_status choose_modes(line_shapes *shapes, const tube_line *line, const ld_tubes *model,
                              elastic_modes *modes, ld_error *error)
{
    int m = shapes->count;
    tied_line tied;
    tied_line_make(&tied, line, model);
    ld_status status = find_modes(&tied, model->modes.span, m, modes, error);
    if (status)
        return status;
    if (modes->count < m)
        return ld_fail(error, LD_ERR_INPUT,
                       "only %d of %d modes are independent: use fewer modes or more elements",
                       modes->count, m);
    double *own = calloc((size_t)m * (size_t)line->n, sizeof *own);
    if (!own)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for %d modes", m);
    status = diagonalise(line, m, modes->part, own, modes->omega, error);
    if (!status)
        write_shapes(line, own, modes->omega, shapes);
    free(own);
    return status;
}

ld_status line_shapes_choose(line_shapes *shapes, const tube_line *line, const ld_tubes *model,
                             ld_error *error)
{
    size_t n = (size_t)line->n, m = (size_t)shapes->count;
    double omega[MOST], *part = calloc(m * n, sizeof *part);
    elastic_modes modes = {.part = part, .omega = omega};
    shapes->nodal = calloc(m * n, sizeof(double));
    ld_status status = part && shapes->nodal
                           ? choose_modes(shapes, line, model, &modes, error)
                           : ld_fail(error, LD_ERR_MEMORY, "no memory for the modes");
    free(part);
    return status;
}

void line_shapes_slow(line_shapes *shapes, const tube_line *line, double cut)
{
    double limit = 2 * M_PI * cut, om2 = limit * limit;
    int n = line->n;
    for (int k = 0; k < shapes->count; k++) {
        if (shapes->om2[k] <= om2)
            continue;
        double scale = limit / sqrt(shapes->om2[k]);
        for (int d = 0; d < n; d++)
            shapes->nodal[k * n + d] *= scale;
        shapes->om2[k] = om2;
        shapes->slowed++;
    }
}

void line_shapes_free(line_shapes *shapes)
{
    free(shapes->nodal);
    *shapes = (line_shapes){0};
}
