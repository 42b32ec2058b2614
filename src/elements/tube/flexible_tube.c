#include "elements/tube/flexible_tube.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "elements/tube/tube_modes.h"

static double dot(int n, const double *a, const double *b)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

// The lines that a tube has, each with the shapes chosen on it. That of z is left out where the
// planes share their shapes, and that of y has the mean of both.
enum { OF_Y, OF_Z, OF_TORSION, OF_STRETCH, LINES };

typedef struct tube_lines {
    tube_mesh mesh;
    tube_line line[LINES];
    line_shapes shapes[LINES];
} tube_lines;

// Line i and its shapes; a count of 0 of these leaves both empty.
static ld_status build_line(tube_lines *of, int i, line_kind kind, int plane, const ld_tubes *model,
                            ld_error *error)
{
    static const char *const names[] = {"bending", "torsion", "axial"};
    tube_line *line = &of->line[i];
    line_shapes *shapes = &of->shapes[i];
    if (shapes->count == 0)
        return LD_OK;
    ld_status status = tube_line_build(line, kind, plane, &of->mesh, model, error);
    if (status)
        return status;
    if (shapes->count > line->n)
        return ld_fail(error, LD_ERR_INPUT, "%d %s modes need a mesh of more than %d elements",
                       shapes->count, names[kind], of->mesh.elements);
    return line_shapes_choose(shapes, line, model, error);
}

static ld_status build_lines(tube_lines *of, const ld_tubes *model, ld_error *error)
{
    static const line_kind kind[LINES] = {LINE_BENDING, LINE_BENDING, LINE_TORSION, LINE_STRETCH};
    const ld_modes *modes = &model->modes;
    bool alike = tube_planes_alike(model);
    const int plane[LINES] = {alike ? PLANES_ALIKE : PLANE_Y, PLANE_Z};
    const int count[LINES] = {modes->bending, alike ? 0 : modes->bending, modes->torsion,
                              modes->axial};
    ld_status status = tube_mesh_build(&of->mesh, model, error);
    for (int i = 0; i < LINES && !status; i++) {
        of->shapes[i].count = count[i];
        status = build_line(of, i, kind[i], plane[i], model, error);
    }
    return status;
}

static void free_lines(tube_lines *of)
{
    for (int i = 0; i < LINES; i++) {
        tube_line_free(&of->line[i]);
        line_shapes_free(&of->shapes[i]);
    }
    tube_mesh_free(&of->mesh);
}

// Copies the polynomials of all shapes of a line into the elements; bending into those of a plane.
static void fill_elements(flexible_tube *tube, int plane, const tube_line *line,
                          const line_shapes *shapes)
{
    for (int e = 0; e < tube->element_count; e++)
        for (int k = 0; k < shapes->count; k++) {
            double p[4];
            tube_element *element = &tube->element[e];
            tube_line_polynomial(line, &shapes->nodal[k * line->n], e, p);
            for (int i = 0; i < 2 * line->width; i++)
                if (line->kind == LINE_BENDING)
                    element->b[plane][i][k] = p[i];
                else if (line->kind == LINE_TORSION)
                    element->tau[i][k] = p[i];
                else
                    element->a[i][k] = p[i];
        }
}

// The integrals of f and x f (the latter may be NULL) of a line's shapes.
static void fill_integrals(const tube_line *line, const line_shapes *shapes, double *first,
                           double *second)
{
    for (int k = 0; k < shapes->count; k++) {
        const double *nodal = &shapes->nodal[k * line->n];
        first[k] = dot(line->n, line->moment[0], nodal);
        if (second)
            second[k] = dot(line->n, line->moment[1], nodal);
    }
}

// Damping ratio of slowed modes. With 1 % they ring in the rocket's contacts.
static const double slowed_damping = 0.1;

// Stiffness omega^2 and damping of a line's shapes, of which a plane has a share.
static void fill_frequencies(const line_shapes *shapes, double share, double zeta, double *om2,
                             double *damping)
{
    for (int k = 0; k < shapes->count; k++) {
        bool slowed = k >= shapes->count - shapes->slowed;
        om2[k] = share * shapes->om2[k];
        damping[k] = 2 * (slowed ? fmax(zeta, slowed_damping) : zeta) * sqrt(om2[k]);
    }
}

// Shear strains of a plane's shapes; its rotary inertia, which the line's moments have too.
static void fill_shear(flexible_tube *tube, int plane, const tube_line *line,
                       const line_shapes *shapes)
{
    tube_shear *shear = tube->shear;
    for (int e = 0; e < tube->element_count; e++) {
        double h = tube->element[e].x1 - tube->element[e].x0;
        shear->inertia[plane] += line->rotary[e];
        for (int k = 0; k < shapes->count; k++) {
            const double *nodal = &shapes->nodal[k * line->n], *right = nodal + 2 * e;
            double rise = (right[0] - (e > 0 ? right[-2] : 0)) / h;
            double strain = tube_line_strain(line, nodal, e);
            shear->strain[e][plane][k] = strain;
            shear->turn[plane][k] += line->rotary[e] * (rise - strain);
        }
    }
    for (int k = 0; k < shapes->count; k++)
        tube->c[plane][k] -= shear->turn[plane][k];
}

// Shapes of a plane, and what comes of them.
static void fill_plane(flexible_tube *tube, int plane, const tube_lines *of, const ld_tubes *model)
{
    bool own = of->shapes[OF_Z].count > 0;
    int i = own && plane == PLANE_Z ? OF_Z : OF_Y;
    const line_shapes *shapes = &of->shapes[i];
    double share = own ? 1 : section_share(&model->section[0], plane);
    double *ct = tube->ct[plane], *c = tube->c[plane];
    fill_elements(tube, plane, &of->line[i], shapes);
    fill_integrals(&of->line[i], shapes, ct, c);
    if (tube->shear)
        fill_shear(tube, plane, &of->line[i], shapes);
    fill_frequencies(shapes, share, model->modes.damping, tube->om2_b[plane], tube->dmp_b[plane]);
    tube->ctct[plane] = dot(tube->nb, ct, ct);
    tube->ctc[plane] = dot(tube->nb, ct, c);
    tube->cc[plane] = dot(tube->nb, c, c);
}

static void bending_values(const flexible_tube *tube, int plane, const tube_element *element,
                           double x, double *b)
{
    double xi = x - element->x0;
    for (int l = 0; l < tube->nb; l++)
        b[l] = element->b[plane][0][l] +
               xi * (element->b[plane][1][l] +
                     xi * (element->b[plane][2][l] + xi * element->b[plane][3][l]));
}

// What a mass at a position of an element has of AB = int a b^T dm.
static void add_axial(flexible_tube *tube, const tube_element *element, double x, double dm)
{
    double xi = x - element->x0, b[LD_NB];
    for (int plane = PLANE_Y; plane <= PLANE_Z; plane++) {
        bending_values(tube, plane, element, x, b);
        for (int l = 0; l < tube->nb; l++)
            for (int k = 0; k < tube->na; k++)
                tube->AB[plane][k][l] += dm * (element->a[0][k] + xi * element->a[1][k]) * b[l];
    }
}

// What it has of G = int b_y b_z^T dm.
static void add_overlap(flexible_tube *tube, const tube_element *element, double x, double dm)
{
    double y[LD_NB], z[LD_NB];
    bending_values(tube, PLANE_Y, element, x, y);
    bending_values(tube, PLANE_Z, element, x, z);
    for (int k = 0; k < tube->nb; k++)
        for (int l = 0; l < tube->nb; l++) {
            tube->overlap->G[PLANE_Y][k][l] += dm * y[k] * z[l];
            tube->overlap->G[PLANE_Z][l][k] = tube->overlap->G[PLANE_Y][k][l];
        }
}

// Gauss's rule with three points, exact for the product of linear and cubic, and with four, exact
// for that of two cubics.
typedef struct gauss_rule {
    int points;
    double at[4], weight[4];
} gauss_rule;

static const gauss_rule three = {
    3, {-0.7745966692414833770, 0, 0.7745966692414833770}, {5.0 / 9, 8.0 / 9, 5.0 / 9}};
static const gauss_rule four = {4,
                                {-0.86113631159405257522, -0.33998104358485626480,
                                 0.33998104358485626480, 0.86113631159405257522},
                                {0.34785484513745385737, 0.65214515486254614263,
                                 0.65214515486254614263, 0.34785484513745385737}};

// Adds up over the masses of the tube.
static void integrate(flexible_tube *tube, const tube_mesh *mesh, const ld_tubes *model,
                      const gauss_rule *rule,
                      void (*add)(flexible_tube *, const tube_element *, double, double))
{
    for (int e = 0; e < tube->element_count; e++) {
        const tube_element *element = &tube->element[e];
        double half = 0.5 * (element->x1 - element->x0);
        double per_length = model->section[mesh->section[e]].mass_per_length;
        for (int i = 0; i < rule->points; i++)
            add(tube, element, element->x0 + half * (1 + rule->at[i]),
                per_length * half * rule->weight[i]);
    }
    for (int i = 0; i < model->point_mass_count; i++) {
        const ld_point_mass *point = &model->point_mass[i];
        add(tube, &tube->element[flexible_tube_find(tube, point->at)], point->at, point->mass);
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
                       "expected 1 to %d bending, 0 to %d torsion and 0 to %d axial modes, found "
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

static ld_status allocate_shear(flexible_tube *tube, ld_error *error)
{
    tube->shear = calloc(1, sizeof *tube->shear);
    if (tube->shear)
        tube->shear->strain = calloc((size_t)tube->element_count, sizeof *tube->shear->strain);
    if (!tube->shear || !tube->shear->strain)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the shear of %d elements",
                       tube->element_count);
    return LD_OK;
}

static ld_status allocate(flexible_tube *tube, const tube_lines *of, ld_error *error)
{
    const tube_mesh *mesh = &of->mesh;
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
    if (of->shapes[OF_Z].count == 0)
        return LD_OK;
    tube->overlap = aligned_alloc(64, sizeof *tube->overlap);
    if (!tube->overlap)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the modes");
    memset(tube->overlap, 0, sizeof *tube->overlap);
    return LD_OK;
}

// Everything that is known once the shapes are: formulation.md, section 5, arrays.
static void fill_tube(flexible_tube *tube, const tube_lines *of, const ld_tubes *model)
{
    const tube_line *bending = &of->line[OF_Y];
    double zeta = model->modes.damping;
    for (int plane = PLANE_Y; plane <= PLANE_Z; plane++)
        fill_plane(tube, plane, of, model);
    for (int i = OF_TORSION; i <= OF_STRETCH; i++)
        fill_elements(tube, PLANE_Y, &of->line[i], &of->shapes[i]);
    fill_integrals(&of->line[OF_TORSION], &of->shapes[OF_TORSION], tube->cp, NULL);
    fill_integrals(&of->line[OF_STRETCH], &of->shapes[OF_STRETCH], tube->at, tube->ax);
    fill_frequencies(&of->shapes[OF_TORSION], 1, zeta, tube->om2_t, tube->dmp_t);
    fill_frequencies(&of->shapes[OF_STRETCH], 1, zeta, tube->om2_a, tube->dmp_a);
    integrate(tube, &of->mesh, model, &three, add_axial);
    if (tube->overlap)
        integrate(tube, &of->mesh, model, &four, add_overlap);
    tube->cpcp = dot(tube->nt, tube->cp, tube->cp);
    tube->m = bending->rigid[0][0];
    tube->s0 = bending->rigid[0][1];
    tube->j0 = bending->rigid[1][1] - (tube->shear ? tube->shear->inertia[PLANE_Y] : 0);
    for (int e = 0; e < of->mesh.elements; e++)
        tube->j += model->section[of->mesh.section[e]].polar_inertia *
                   (of->mesh.node[e + 1] - of->mesh.node[e]);
    for (int k = 0; k < model->support_count; k++)
        tube->support_element[k] = flexible_tube_find(tube, model->support[k].at);
}

static int padded(int count)
{
    return (count + 3) / 4 * 4;
}

// The tube of the lines' shapes.
static ld_status make_tube(flexible_tube *tube, const tube_lines *of, const ld_tubes *model,
                           ld_error *error)
{
    const ld_modes *modes = &model->modes;
    *tube = (flexible_tube){.nb = modes->bending,
                            .nt = modes->torsion,
                            .na = modes->axial,
                            .nbp = padded(modes->bending),
                            .ntp = padded(modes->torsion),
                            .nap = padded(modes->axial),
                            .length = model->length,
                            .bore_radius = model->section[0].bore_radius,
                            .support_count = model->support_count};
    ld_status status = allocate(tube, of, error);
    if (!status && modes->shear_coefficient > 0)
        status = allocate_shear(tube, error);
    if (!status)
        fill_tube(tube, of, model);
    return status;
}

// Slows what is faster than the cut, once the tube with its modes as they are is made.
static ld_status slow_lines(tube_lines *of, const ld_tubes *model, flexible_tube **unslowed,
                            ld_error *error)
{
    *unslowed = calloc(1, sizeof **unslowed);
    if (!*unslowed)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the modes");
    ld_status status = make_tube(*unslowed, of, model, error);
    for (int i = 0; i < LINES && !status; i++)
        line_shapes_slow(&of->shapes[i], &of->line[i], model->modes.cut);
    return status;
}

ld_status flexible_tube_build(flexible_tube *tube, const ld_tubes *model, ld_error *error)
{
    tube_lines of = {0};
    flexible_tube *unslowed = NULL;
    *tube = (flexible_tube){0};
    ld_status status = check_model(model, error);
    if (!status)
        status = build_lines(&of, model, error);
    if (!status && model->modes.cut > 0)
        status = slow_lines(&of, model, &unslowed, error);
    if (!status)
        status = make_tube(tube, &of, model, error);
    tube->unslowed = unslowed;
    free_lines(&of);
    return status;
}

void flexible_tube_free(flexible_tube *tube)
{
    flexible_tube *unslowed = tube->unslowed;
    free(tube->element);
    free(tube->overlap);
    if (tube->shear)
        free(tube->shear->strain);
    free(tube->shear);
    *tube = (flexible_tube){0};
    if (unslowed)
        flexible_tube_free(unslowed);
    free(unslowed);
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
