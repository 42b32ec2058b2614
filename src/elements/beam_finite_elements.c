#include "elements/beam_finite_elements.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "math/symmetric_eigen.h"

enum { MAX_BREAKS = LD_MAX_SECTIONS + LD_MAX_POINT_MASSES + LD_MAX_SUPPORTS + 2 };

// Stations that must be nodes, ascending.
typedef struct breaks {
    int count;
    double at[MAX_BREAKS];
} breaks;

// Adds a station unless one lies closer than `distance`.
static void breaks_add(breaks *list, double x, double distance)
{
    int i = 0;
    for (int k = 0; k < list->count; k++) {
        if (fabs(list->at[k] - x) < distance)
            return;
        i += list->at[k] < x;
    }
    memmove(&list->at[i + 1], &list->at[i], (size_t)(list->count - i) * sizeof(double));
    list->at[i] = x;
    list->count++;
}

// Section steps and point masses break the line exactly; a support, which may lie anywhere in an
// element, becomes a node only where that makes no sliver.
static breaks breaks_of(const ld_tubes *model)
{
    double L = model->length;
    breaks list = {2, {0, L}};
    for (int i = 0; i < model->section_count; i++)
        breaks_add(&list, model->section[i].from, 1e-9 * L);
    for (int i = 0; i < model->point_mass_count; i++)
        breaks_add(&list, model->point_mass[i].at, 1e-9 * L);
    for (int i = 0; i < model->support_count; i++)
        breaks_add(&list, model->support[i].at, 0.05 * L / model->modes.elements);
    return list;
}

// Shares `wanted` elements out: one a piece, then one by one to the piece with the longest ones.
static int share_elements(const breaks *list, int wanted, int *share)
{
    int total = list->count - 1;
    for (int p = 0; p < total; p++)
        share[p] = 1;
    for (; total < wanted; total++) {
        int longest = 0;
        double length = 0;
        for (int p = 0; p < list->count - 1; p++) {
            double h = (list->at[p + 1] - list->at[p]) / share[p];
            if (h > length * (1 + 1e-12)) {
                length = h;
                longest = p;
            }
        }
        share[longest]++;
    }
    return total;
}

static int section_at(const ld_tubes *model, double x)
{
    int s = 0;
    while (s + 1 < model->section_count && model->section[s + 1].from <= x)
        s++;
    return s;
}

ld_status tube_mesh_build(tube_mesh *mesh, const ld_tubes *model, ld_error *error)
{
    int share[MAX_BREAKS];
    breaks list = breaks_of(model);
    int n = share_elements(&list, model->modes.elements, share);
    *mesh = (tube_mesh){.elements = n,
                        .node = malloc((size_t)(n + 1) * sizeof(double)),
                        .section = malloc((size_t)n * sizeof(int))};
    if (!mesh->node || !mesh->section) {
        tube_mesh_free(mesh);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a mesh of %d elements", n);
    }
    int e = 0;
    for (int p = 0; p < list.count - 1; p++)
        for (int i = 0; i < share[p]; i++, e++)
            mesh->node[e] = list.at[p] + (list.at[p + 1] - list.at[p]) * i / share[p];
    mesh->node[n] = model->length;
    for (e = 0; e < n; e++)
        mesh->section[e] = section_at(model, 0.5 * (mesh->node[e] + mesh->node[e + 1]));
    return LD_OK;
}

void tube_mesh_free(tube_mesh *mesh)
{
    free(mesh->node);
    free(mesh->section);
    *mesh = (tube_mesh){0};
}

int tube_mesh_find(const tube_mesh *mesh, double x)
{
    int low = 0, high = mesh->elements - 1;
    while (low < high) {
        int middle = (low + high + 1) / 2;
        if (x >= mesh->node[middle])
            low = middle;
        else
            high = middle - 1;
    }
    return low;
}

// Consistent mass of one element of length h and mass (polar inertia) m: int N N^T dm.
static void element_mass(int width, double m, double h, double out[4][4])
{
    if (width == 1) {
        out[0][0] = out[1][1] = m / 3;
        out[0][1] = out[1][0] = m / 6;
        return;
    }
    double k = m / 420,
           f[4][4] = {{156, 22, 54, -13}, {22, 4, 13, -3}, {54, 13, 156, -22}, {-13, -3, -22, 4}};
    double scale[4] = {1, h, 1, h};
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            out[i][j] = k * scale[i] * scale[j] * f[i][j];
}

// Mass of the whole line [N][N], N = n + width: the node at x = 0 included.
static void assemble_mass(const tube_line *line, const ld_tubes *model, double *M)
{
    const tube_mesh *mesh = line->mesh;
    int w = line->width, N = line->n + w;
    for (int e = 0; e < mesh->elements; e++) {
        const ld_section *section = &model->section[mesh->section[e]];
        double h = mesh->node[e + 1] - mesh->node[e], m[4][4];
        element_mass(
            w, h * (line->kind == LINE_TORSION ? section->polar_inertia : section->mass_per_length),
            h, m);
        for (int i = 0; i < 2 * w; i++)
            for (int j = 0; j < 2 * w; j++)
                M[(w * e + i) * N + w * e + j] += m[i][j];
    }
    if (line->kind == LINE_TORSION)
        return;
    for (int i = 0; i < model->point_mass_count; i++) {
        double at = model->point_mass[i].at;
        int node = tube_mesh_find(mesh, at);
        node += at - mesh->node[node] > mesh->node[node + 1] - at;
        M[w * node * (N + 1)] += model->point_mass[i].mass;
    }
}

static double stiffness_of(line_kind kind, const ld_section *section)
{
    switch (kind) {
    case LINE_BENDING:
        return section->bending_stiffness;
    case LINE_TORSION:
        return section->torsion_stiffness;
    default:
        return section->axial_stiffness;
    }
}

// Flexibility of the clamped line [n][n]: deflections under unit nodal loads, int m_i m_j ds/EI
// with the moments m_i = x_i - s of a force and 1 of a couple, s < x_i; bars: int ds/EA.
static void assemble_flexibility(const tube_line *line, const ld_tubes *model, double *F)
{
    const tube_mesh *mesh = line->mesh;
    int w = line->width, n = line->n;
    // integrals of 1, s, s^2 over ds/EI, from 0 to x_i
    double I0 = 0, I1 = 0, I2 = 0;
    for (int i = 1; i <= mesh->elements; i++) {
        double x0 = mesh->node[i - 1], xi = mesh->node[i];
        double f = (xi - x0) / stiffness_of(line->kind, &model->section[mesh->section[i - 1]]);
        I0 += f;
        I1 += f * (x0 + xi) / 2;
        I2 += f * (x0 * x0 + x0 * xi + xi * xi) / 3;
        for (int j = i; j <= mesh->elements; j++) {
            double xj = mesh->node[j], *Fij = &F[w * (i - 1) * n + w * (j - 1)];
            double *Fji = &F[w * (j - 1) * n + w * (i - 1)];
            if (w == 1) {
                Fij[0] = Fji[0] = I0;
                continue;
            }
            Fij[0] = Fji[0] = xi * xj * I0 - (xi + xj) * I1 + I2;
            Fij[1] = Fji[n] = xi * I0 - I1;
            Fij[n] = Fji[1] = xj * I0 - I1;
            Fij[n + 1] = Fji[n + 1] = I0;
        }
    }
}

// The moment vectors M 1 and M x, and the rigid integrals, from the mass of the whole line.
static void take_moments(tube_line *line, const double *M)
{
    int w = line->width, N = line->n + w;
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < N; i++) {
            double sum = 0;
            for (int j = 0; j < N; j++) {
                double x = line->mesh->node[j / w];
                double one = j % w == 0, linear = j % w == 0 ? x : 1;
                sum += M[i * N + j] * (k == 0 ? one : linear);
            }
            double x = line->mesh->node[i / w];
            line->rigid[k][0] += (i % w == 0) * sum;
            line->rigid[k][1] += (i % w == 0 ? x : 1) * sum;
            if (i >= w)
                line->moment[k][i - w] = sum;
        }
}

// Clamped modes: K b omega^-2... in flexibility form F M b = b/omega^2, b^T M b = 1.
static ld_status solve_clamped(tube_line *line, double *F, double *M, ld_error *error)
{
    static const char *const inertia[] = {"mass", "polar inertia", "mass"};
    int n = line->n;
    double *value = malloc((size_t)n * sizeof *value);
    if (!value)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for %d modes", n);
    int info = symmetric_eigen(EIGEN_PRODUCT, n, F, M, value);
    bool good = info == 0 && value[n - 1] > 0 && isfinite(value[n - 1]);
    for (int k = 0; good && k < n; k++) {
        // the tiniest flexibilities are known to rounding of the largest only
        double floor = 1e-17 * value[n - 1];
        line->om2[k] = 1 / fmax(value[n - 1 - k], floor);
        memcpy(&line->mode[k * n], &F[(n - 1 - k) * n], (size_t)n * sizeof *F);
    }
    free(value);
    if (info == EIGEN_NO_MEMORY)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for %d modes", n);
    if (info > n)
        return ld_fail(error, LD_ERR_INPUT, "the tube has sections without %s",
                       inertia[line->kind]);
    if (!good)
        return ld_fail(error, LD_ERR_NUMERIC,
                       "the modes of the clamped tube cannot be found: is a stiffness or a mass "
                       "not finite or out of all proportion?");
    return LD_OK;
}

ld_status tube_line_build(tube_line *line, line_kind kind, const tube_mesh *mesh,
                          const ld_tubes *model, ld_error *error)
{
    int w = kind == LINE_BENDING ? 2 : 1, n = w * mesh->elements, N = n + w;
    size_t nn = (size_t)n * (size_t)n, NN = (size_t)N * (size_t)N;
    double *block = calloc(nn + 3 * (size_t)n, sizeof(double));
    double *work = calloc(NN + 2 * nn, sizeof(double));
    if (!block || !work) {
        free(block);
        free(work);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a line of %d elements", mesh->elements);
    }
    *line = (tube_line){.kind = kind, .mesh = mesh, .width = w, .n = n};
    line->mode = block;
    line->om2 = block + nn;
    line->moment[0] = line->om2 + n;
    line->moment[1] = line->moment[0] + n;

    double *M = work, *F = work + NN, *held = F + nn;
    assemble_mass(line, model, M);
    assemble_flexibility(line, model, F);
    take_moments(line, M);
    for (int i = 0; i < n; i++)
        memcpy(&held[i * n], &M[(i + w) * N + w], (size_t)n * sizeof *M);
    ld_status status = solve_clamped(line, F, held, error);
    free(work);
    if (status)
        tube_line_free(line);
    return status;
}

void tube_line_free(tube_line *line)
{
    free(line->mode);
    *line = (tube_line){0};
}

void tube_line_polynomial(const tube_line *line, const double *nodal, int element,
                          double coefficient[4])
{
    static const double zero[2];
    int w = line->width;
    const double *left = element > 0 ? &nodal[w * (element - 1)] : zero,
                 *right = &nodal[w * element];
    double h = line->mesh->node[element + 1] - line->mesh->node[element];
    double rise = (right[0] - left[0]) / h;
    coefficient[0] = left[0];
    coefficient[1] = w == 2 ? left[1] : rise;
    coefficient[2] = w == 2 ? (3 * rise - 2 * left[1] - right[1]) / h : 0;
    coefficient[3] = w == 2 ? (left[1] + right[1] - 2 * rise) / (h * h) : 0;
}

double tube_line_value(const tube_line *line, const double *nodal, double x)
{
    double c[4];
    int e = tube_mesh_find(line->mesh, x);
    double xi = x - line->mesh->node[e];
    tube_line_polynomial(line, nodal, e, c);
    return c[0] + xi * (c[1] + xi * (c[2] + xi * c[3]));
}

double tube_line_slope(const tube_line *line, const double *nodal, double x)
{
    double c[4];
    int e = tube_mesh_find(line->mesh, x);
    double xi = x - line->mesh->node[e];
    tube_line_polynomial(line, nodal, e, c);
    return c[1] + xi * (2 * c[2] + xi * 3 * c[3]);
}
