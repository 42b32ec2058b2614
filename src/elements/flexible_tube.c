#include "elements/flexible_tube.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "elements/tube_modes.h"
#include "math/symmetric_eigen.h"

static double dot(int n, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
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
    if (shapes->count > line->n)
        return ld_fail(error, LD_ERR_INPUT, "%d %s modes need a mesh of more than %d elements",
                       shapes->count, names[kind], mesh->elements);
    return line_shapes_choose(shapes, line, model, error);
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
                        double *damping, double *first, double *second)
{
    for (int k = 0; k < shapes->count; k++) {
        const double *nodal = &shapes->nodal[k * line->n];
        om2[k] = shapes->om2[k];
        damping[k] = 2 * zeta * sqrt(om2[k]);
        first[k] = dot(line->n, line->moment[0], nodal);
        if (second)
            second[k] = dot(line->n, line->moment[1], nodal);
    }
}

// K [m][m] of a plane in the shapes, whose elastic energy its sections have their shares of.
static void plane_stiffness(const line_shapes *shapes, const tube_mesh *mesh, const ld_tubes *model,
                            int plane, double *K)
{
    double share[LD_MAX_SECTIONS];
    for (int i = 0; i < model->section_count; i++)
        share[i] = section_share(&model->section[i], plane);
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
                                  const tube_mesh *mesh, const ld_tubes *model, ld_error *error)
{
    double zeta = model->modes.damping;
    int m = shapes->count;
    double K[LD_NB * LD_NB], D[LD_NB * LD_NB] = {0}, value[LD_NB], mode[LD_NB * LD_NB];
    plane_stiffness(shapes, mesh, model, plane, K);
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
    if (tube_planes_proportional(model)) {
        for (int plane = PLANE_Y; plane <= PLANE_Z; plane++) {
            double share = section_share(&model->section[0], plane);
            for (int k = 0; k < tube->nb; k++) {
                tube->om2_b[plane][k] = share * shapes->om2[k];
                tube->dmp_b[plane][k] = 2 * model->modes.damping * sqrt(tube->om2_b[plane][k]);
            }
        }
        return LD_OK;
    }
    tube->mixing = aligned_alloc(64, sizeof *tube->mixing);
    if (!tube->mixing)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the modes");
    memset(tube->mixing, 0, sizeof *tube->mixing);
    ld_status status = fill_mixed_plane(tube, PLANE_Y, shapes, mesh, model, error);
    return status ? status : fill_mixed_plane(tube, PLANE_Z, shapes, mesh, model, error);
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
                tube->dmp_b[PLANE_Y], tube->ct, tube->c);
    fill_family(&line[LINE_TORSION], &shapes[LINE_TORSION], zeta, tube->om2_t, tube->dmp_t,
                tube->cp, NULL);
    fill_family(&line[LINE_STRETCH], &shapes[LINE_STRETCH], zeta, tube->om2_a, tube->dmp_a,
                tube->at, tube->ax);
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
        line_shapes_free(&shapes[kind]);
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
