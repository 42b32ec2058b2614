#include "elements/tube/beam_finite_elements.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

// Of a beam with shear, between nodal values and turns of the sections: powers of xi of the axis,
// and its shear strain, which is constant.
static double sheared_polynomial(const double left[2], const double right[2], double h,
                                 double shear, double coefficient[4])
{
    double rise = (right[0] - left[0]) / h, bent = rise - 0.5 * (left[1] + right[1]);
    double strain = bent * shear / (1 + shear), turn_2 = -6 * bent / (h * h * (1 + shear));
    coefficient[0] = left[0];
    coefficient[1] = left[1] + strain;
    coefficient[2] = 0.5 * ((right[1] - left[1]) / h - turn_2 * h);
    coefficient[3] = turn_2 / 3;
    return strain;
}

// Consistent mass with its shapes and rotary inertia: Gauss's rule with four points, exact.
static void sheared_mass(double m, double rotary, double h, double shear, double out[4][4])
{
    static const double at[4] = {-0.86113631159405257522, -0.33998104358485626480,
                                 0.33998104358485626480, 0.86113631159405257522};
    static const double weight[4] = {0.34785484513745385737, 0.65214515486254614263,
                                     0.65214515486254614263, 0.34785484513745385737};
    memset(out, 0, 4 * sizeof *out);
    for (int p = 0; p < 4; p++) {
        double xi = 0.5 * h * (1 + at[p]), value[4], turn[4];
        for (int k = 0; k < 4; k++) {
            double c[4], end[4] = {0};
            end[k] = 1;
            double strain = sheared_polynomial(end, end + 2, h, shear, c);
            value[k] = c[0] + xi * (c[1] + xi * (c[2] + xi * c[3]));
            turn[k] = c[1] + xi * (2 * c[2] + xi * 3 * c[3]) - strain;
        }
        for (int i = 0; i < 4; i++)
            for (int j = 0; j < 4; j++)
                out[i][j] +=
                    0.5 * weight[p] * (m * value[i] * value[j] + rotary * turn[i] * turn[j]);
    }
}

// Mass of the whole line [N][N], N = n + width: the node at x = 0 included.
static void assemble_mass(const tube_line *line, const ld_tubes *model, double *M)
{
    const tube_mesh *mesh = line->mesh;
    int w = line->width, N = line->n + w;
    for (int e = 0; e < mesh->elements; e++) {
        const ld_section *section = &model->section[mesh->section[e]];
        double h = mesh->node[e + 1] - mesh->node[e], m[4][4];
        double of_element =
            h * (line->kind == LINE_TORSION ? section->polar_inertia : section->mass_per_length);
        if (line->shear)
            sheared_mass(of_element, line->rotary[e], h, line->shear[e], m);
        else
            element_mass(w, of_element, h, m);
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

static double stiffness_of(const tube_line *line, const ld_section *section)
{
    double along_y = section_stiffness_z(section), along_z = section_stiffness_y(section);
    switch (line->kind) {
    case LINE_BENDING:
        return line->plane == PLANE_Y   ? along_y
               : line->plane == PLANE_Z ? along_z
                                        : 0.5 * (along_z + along_y);
    case LINE_TORSION:
        return section->torsion_stiffness;
    default:
        return section->axial_stiffness;
    }
}

// Shear numbers and rotary inertias of the elements: of round sections G A = G I_t A/I_p, and
// A/I_p is the mass over the polar inertia; a plane has its part of the latter.
static void fill_shear(tube_line *line, const ld_tubes *model)
{
    for (int e = 0; e < line->mesh->elements; e++) {
        const ld_section *s = &model->section[line->mesh->section[e]];
        double h = line->mesh->node[e + 1] - line->mesh->node[e], EI = stiffness_of(line, s);
        double GA = s->torsion_stiffness * s->mass_per_length / s->polar_inertia;
        double both = section_stiffness_y(s) + section_stiffness_z(s);
        line->shear[e] = 12 * EI / (model->modes.shear_coefficient * GA * h * h);
        line->rotary[e] = h * s->polar_inertia * EI / both;
    }
}

// What unit elastic energy (f^T K f = 1) bends, twists or stretches an element by, its curvature or
// strain constant.
static double element_deformation(const tube_line *line, const ld_tubes *model, int e)
{
    double h = line->mesh->node[e + 1] - line->mesh->node[e];
    return sqrt(h / stiffness_of(line, &model->section[line->mesh->section[e]]));
}

// And how far its linear curvature, with the shear strain that this causes, shifts what lies
// beyond.
static double element_shift(const tube_line *line, const ld_tubes *model, int e)
{
    double h = line->mesh->node[e + 1] - line->mesh->node[e];
    double shift = element_deformation(line, model, e) * h / sqrt(12);
    return line->shear ? shift * sqrt(1 + line->shear[e]) : shift;
}

// Nodal vectors of the clamped line with one element deformed, the others rigid: with constant
// curvature, then with a linear one, zero in the middle, which shifts what lies beyond. A bar is
// stretched.
static void fill_shapes(const tube_line *line, const ld_tubes *model)
{
    int w = line->width, n = line->n;
    const double *node = line->mesh->node;
    for (int e = 0; e < line->mesh->elements; e++) {
        double d = element_deformation(line, model, e), h = node[e + 1] - node[e];
        double shift = element_shift(line, model, e);
        double *first = &line->shape[(size_t)(w * e) * (size_t)n], *second = first + n;
        for (int i = e + 1; i <= line->mesh->elements; i++) {
            int at = w * (i - 1);
            first[at] = w == 1 ? d : d * (node[i] - node[e + 1] + 0.5 * h);
            if (w == 2) {
                first[at + 1] = d;
                second[at] = -shift;
            }
        }
    }
}

// Products `out` [n] of all shapes with the nodal forces (and couples) [n], from the tip on: force
// and couple that an element carries at its outer end.
static void times_shapes(const tube_line *line, const ld_tubes *model, const double *forces,
                         double *out)
{
    int w = line->width;
    double force = 0, couple = 0;
    for (int e = line->mesh->elements - 1; e >= 0; e--) {
        double d = element_deformation(line, model, e);
        double h = line->mesh->node[e + 1] - line->mesh->node[e];
        force += forces[w * e];
        if (w == 1) {
            out[e] = d * force;
            continue;
        }
        couple += forces[2 * e + 1];
        out[2 * e] = d * (couple + 0.5 * h * force);
        out[2 * e + 1] = -element_shift(line, model, e) * force;
        couple += h * force;
    }
}

// The mass in the amplitudes of the shapes; `forces` [n] is room.
static void fill_mass(const tube_line *line, const ld_tubes *model, const double *M, double *forces)
{
    int w = line->width, n = line->n, N = n + w;
    for (int k = 0; k < n; k++) {
        const double *shape = &line->shape[(size_t)k * (size_t)n];
        for (int i = 0; i < n; i++) {
            int first = i - 2 * w + 1 > 0 ? i - 2 * w + 1 : 0, end = i + 2 * w < n ? i + 2 * w : n;
            forces[i] = 0;
            for (int j = first; j < end; j++)
                forces[i] += M[(i + w) * N + w + j] * shape[j];
        }
        times_shapes(line, model, forces, &line->mass[(size_t)k * (size_t)n]);
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

static ld_status check_mass(const tube_line *line, const ld_tubes *model, ld_error *error)
{
    static const char *const inertia[] = {"mass", "polar inertia", "mass"};
    for (int e = 0; e < line->mesh->elements; e++) {
        const ld_section *section = &model->section[line->mesh->section[e]];
        double has = line->kind == LINE_TORSION ? section->polar_inertia : section->mass_per_length;
        if (!(has > 0))
            return ld_fail(error, LD_ERR_INPUT, "the tube has sections without %s",
                           inertia[line->kind]);
    }
    return LD_OK;
}

ld_status tube_line_build(tube_line *line, line_kind kind, int plane, const tube_mesh *mesh,
                          const ld_tubes *model, ld_error *error)
{
    int w = kind == LINE_BENDING ? 2 : 1, n = w * mesh->elements, N = n + w;
    size_t nn = (size_t)n * (size_t)n, NN = (size_t)N * (size_t)N;
    bool sheared = kind == LINE_BENDING && model->modes.shear_coefficient > 0;
    double *block = calloc(2 * nn + 3 * (size_t)n, sizeof(double));
    double *M = calloc(NN + (size_t)n, sizeof(double)), trace = 0;
    if (!block || !M) {
        free(block);
        free(M);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a line of %d elements", mesh->elements);
    }
    *line = (tube_line){.kind = kind, .plane = plane, .mesh = mesh, .width = w, .n = n};
    line->shape = block;
    line->mass = block + nn;
    line->moment[0] = line->mass + nn;
    line->moment[1] = line->moment[0] + n;
    if (sheared) {
        line->shear = line->moment[1] + n;
        line->rotary = line->shear + mesh->elements;
        fill_shear(line, model);
    }

    assemble_mass(line, model, M);
    take_moments(line, M);
    fill_shapes(line, model);
    fill_mass(line, model, M, M + NN);
    free(M);
    for (int k = 0; k < n; k++)
        trace += line->mass[k * (n + 1)];
    line->low = 1 / trace;
    ld_status status = check_mass(line, model, error);
    if (!status && !(trace > 0 && isfinite(trace)))
        status = ld_fail(error, LD_ERR_NUMERIC,
                         "the modes of the clamped tube cannot be computed: check that stiffnesses "
                         "and masses are finite and in proportion");
    if (status)
        tube_line_free(line);
    return status;
}

void tube_line_free(tube_line *line)
{
    free(line->shape);
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
    if (line->shear) {
        sheared_polynomial(left, right, h, line->shear[element], coefficient);
        return;
    }
    double rise = (right[0] - left[0]) / h;
    coefficient[0] = left[0];
    coefficient[1] = w == 2 ? left[1] : rise;
    coefficient[2] = w == 2 ? (3 * rise - 2 * left[1] - right[1]) / h : 0;
    coefficient[3] = w == 2 ? (left[1] + right[1] - 2 * rise) / (h * h) : 0;
}

double tube_line_strain(const tube_line *line, const double *nodal, int element)
{
    static const double zero[2];
    const double *left = element > 0 ? &nodal[2 * (element - 1)] : zero,
                 *right = &nodal[2 * element];
    double h = line->mesh->node[element + 1] - line->mesh->node[element], unused[4];
    return sheared_polynomial(left, right, h, line->shear[element], unused);
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
