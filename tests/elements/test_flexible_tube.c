// The flexible tube as data: tangent form, orthonormal modes, inertia coefficients against
// quadrature of the shapes, alignment and padding, sign, refusals.
#include "elements/tube/flexible_tube.h"

#include <stdlib.h>
#include <string.h>

#include "support/check.h"
#include "support/line_frequencies.h"
#include "support/tube_shape.h"

static const char *const span_names[] = {"supported", "clamped", "free-free"};

// The reference tube with two section steps, three point masses (one at each end) and all families.
static ld_tubes stepped_tubes(void)
{
    ld_tubes tubes = reference_tubes();
    ld_section *section = tubes.section;
    tubes.section_count = 3;
    section[1] = section[2] = section[0];
    section[1].from = 0.77;
    section[1].mass_per_length *= 0.6;
    section[1].bending_stiffness *= 0.5;
    section[1].torsion_stiffness *= 0.5;
    section[1].axial_stiffness *= 0.6;
    section[1].polar_inertia *= 0.55;
    section[2].from = 2.31;
    section[2].mass_per_length *= 1.4;
    section[2].bending_stiffness *= 1.7;
    tubes.point_mass_count = 3;
    tubes.point_mass[0] = (ld_point_mass){0, 0.5};
    tubes.point_mass[1] = (ld_point_mass){1.234, 0.4};
    tubes.point_mass[2] = (ld_point_mass){3.0, 0.9};
    tubes.modes = (ld_modes){.bending = 6,
                             .torsion = 3,
                             .axial = 2,
                             .elements = 37,
                             .span = LD_SPAN_SUPPORTED,
                             .damping = 0.02};
    return tubes;
}

static void build(flexible_tube *tube, const ld_tubes *model)
{
    ld_error error;
    if (flexible_tube_build(tube, model, &error))
        fail_msg("%s", error.text);
}

static const ld_section *section_of(const ld_tubes *model, double x)
{
    int s = model->section_count - 1;
    while (s > 0 && model->section[s].from > x)
        s--;
    return &model->section[s];
}

// A function of the station, and the weight it is integrated over.
typedef enum weight {
    OVER_MASS,
    OVER_POLAR_INERTIA,
    OVER_BENDING, // of deflections along y
    OVER_BENDING_ALONG_Z,
    OVER_TORSION,
    OVER_AXIAL
} weight;
typedef struct integrand {
    const flexible_tube *tube;
    double (*value)(const struct integrand *f, double x);
    int i, j, plane;
} integrand;

static double weight_at(const ld_section *s, weight kind)
{
    bool planes = s->form == LD_SECTION_PLANES;
    return kind == OVER_MASS              ? s->mass_per_length
           : kind == OVER_POLAR_INERTIA   ? s->polar_inertia
           : kind == OVER_BENDING         ? (planes ? s->bending_stiffness_z : s->bending_stiffness)
           : kind == OVER_BENDING_ALONG_Z ? (planes ? s->bending_stiffness_y : s->bending_stiffness)
           : kind == OVER_TORSION         ? s->torsion_stiffness
                                          : s->axial_stiffness;
}

// Midpoint rule, 400 points an interval between section steps, extrapolated from half as many; the
// elements are not used, but for finding shape values.
static double integrate(const ld_tubes *model, weight kind, integrand f)
{
    enum { FINE = 12000 };
    double total = 0;
    for (int s = 0; s < model->section_count; s++) {
        double x0 = model->section[s].from;
        double x1 = s + 1 < model->section_count ? model->section[s + 1].from : model->length;
        double sum[2] = {0, 0};
        for (int level = 0; level < 2; level++) {
            int points = FINE << level;
            double h = (x1 - x0) / points;
            for (int p = 0; p < points; p++) {
                double x = x0 + (p + 0.5) * h;
                sum[level] += f.value(&f, x) * h;
            }
        }
        total += weight_at(section_of(model, 0.5 * (x0 + x1)), kind) * (4 * sum[1] - sum[0]) / 3;
    }
    for (int p = 0; kind == OVER_MASS && p < model->point_mass_count; p++)
        total += model->point_mass[p].mass * f.value(&f, model->point_mass[p].at);
    return total;
}

// Integrands: powers of x, shapes and their products.
static double power(const integrand *f, double x)
{
    return pow(x, f->i);
}
static double bending(const integrand *f, double x)
{
    return tube_bending(f->tube, f->plane, f->i, x, 0) * pow(x, f->j);
}
static double bending_product(const integrand *f, double x)
{
    return tube_bending(f->tube, f->plane, f->i, x, 0) *
           tube_bending(f->tube, f->plane, f->j, x, 0);
}
static double product_across(const integrand *f, double x)
{
    return tube_bending(f->tube, PLANE_Y, f->i, x, 0) * tube_bending(f->tube, PLANE_Z, f->j, x, 0);
}
static double curvature_product(const integrand *f, double x)
{
    return tube_bending(f->tube, f->plane, f->i, x, 2) *
           tube_bending(f->tube, f->plane, f->j, x, 2);
}
static double torsion(const integrand *f, double x)
{
    return tube_torsion(f->tube, f->i, x, 0);
}
static double torsion_product(const integrand *f, double x)
{
    return tube_torsion(f->tube, f->i, x, 0) * tube_torsion(f->tube, f->j, x, 0);
}
static double twist_product(const integrand *f, double x)
{
    return tube_torsion(f->tube, f->i, x, 1) * tube_torsion(f->tube, f->j, x, 1);
}
static double stretch(const integrand *f, double x)
{
    return tube_stretch(f->tube, f->i, x, 0) * pow(x, f->j);
}
static double stretch_product(const integrand *f, double x)
{
    return tube_stretch(f->tube, f->i, x, 0) * tube_stretch(f->tube, f->j, x, 0);
}
static double strain_product(const integrand *f, double x)
{
    return tube_stretch(f->tube, f->i, x, 1) * tube_stretch(f->tube, f->j, x, 1);
}
static double stretch_bending(const integrand *f, double x)
{
    return tube_stretch(f->tube, f->i, x, 0) * tube_bending(f->tube, f->plane, f->j, x, 0);
}

static double grow(double worst, double error)
{
    return isnan(error) ? error : fmax(worst, fabs(error));
}

// Largest deviation of int f_i f_j over `over` from diag(scale), each relative to the diagonal; of
// bending those of a plane.
static double off_diagonal_of(const flexible_tube *tube, int plane, const ld_tubes *model,
                              int count, weight over, double (*product)(const integrand *, double),
                              const double *diagonal)
{
    double worst = 0;
    for (int i = 0; i < count; i++)
        for (int j = i; j < count; j++) {
            double d = diagonal ? sqrt(diagonal[i] * diagonal[j]) : 1;
            double value = integrate(model, over, (integrand){tube, product, i, j, plane}) / d;
            worst = grow(worst, value - (i == j));
        }
    return worst;
}

static double off_diagonal(const flexible_tube *tube, const ld_tubes *model, int count, weight over,
                           double (*product)(const integrand *, double), const double *diagonal)
{
    return off_diagonal_of(tube, PLANE_Y, model, count, over, product, diagonal);
}

static void inertia_coefficients(void **state)
{
    (void)state;
    ld_tubes model = stepped_tubes();
    for (int span = 0; span < 3; span++) {
        flexible_tube tube;
        model.modes.span = (ld_mode_span)span;
        build(&tube, &model);
        printf("  span %s\n", span_names[span]);
        // rigid integrals
        double rigid = 0;
        rigid =
            grow(rigid, tube.m - integrate(&model, OVER_MASS, (integrand){&tube, power, 0, 0, 0}));
        rigid =
            grow(rigid, tube.s0 - integrate(&model, OVER_MASS, (integrand){&tube, power, 1, 0, 0}));
        rigid =
            grow(rigid, tube.j0 - integrate(&model, OVER_MASS, (integrand){&tube, power, 2, 0, 0}));
        rigid = grow(rigid, tube.j - integrate(&model, OVER_POLAR_INERTIA,
                                               (integrand){&tube, power, 0, 0, 0}));
        CHECK_BELOW("m, s0, j0, j against quadrature", rigid, 5e-11);
        // vectors
        double vectors = 0, cross = 0;
        for (int i = 0; i < tube.nb; i++) {
            const integrand first = {&tube, bending, i, 0, PLANE_Y};
            const integrand second = {&tube, bending, i, 1, PLANE_Y};
            vectors = grow(vectors, tube.ct[0][i] - integrate(&model, OVER_MASS, first));
            vectors = grow(vectors, tube.c[0][i] - integrate(&model, OVER_MASS, second));
        }
        for (int i = 0; i < tube.nt; i++)
            vectors = grow(vectors, tube.cp[i] - integrate(&model, OVER_POLAR_INERTIA,
                                                           (integrand){&tube, torsion, i, 0, 0}));
        for (int i = 0; i < tube.na; i++) {
            vectors = grow(vectors, tube.at[i] - integrate(&model, OVER_MASS,
                                                           (integrand){&tube, stretch, i, 0, 0}));
            vectors = grow(vectors, tube.ax[i] - integrate(&model, OVER_MASS,
                                                           (integrand){&tube, stretch, i, 1, 0}));
            for (int j = 0; j < tube.nb; j++)
                cross = grow(cross, tube.AB[0][i][j] -
                                        integrate(&model, OVER_MASS,
                                                  (integrand){&tube, stretch_bending, i, j, 0}));
        }
        CHECK_BELOW("ct, c, cp, at, ax against quadrature", vectors, 3e-9);
        CHECK_BELOW("AB against quadrature", cross, 1e-9);
        // modal mass E, modal stiffness omega^2, from the shapes themselves
        CHECK_BELOW("bending: int b b dm - E",
                    off_diagonal(&tube, &model, tube.nb, OVER_MASS, bending_product, NULL), 1e-12);
        CHECK_BELOW("torsion: int rho I_p tau tau dx - E",
                    off_diagonal(&tube, &model, tube.nt, OVER_POLAR_INERTIA, torsion_product, NULL),
                    3e-9);
        CHECK_BELOW("stretch: int a a dm - E",
                    off_diagonal(&tube, &model, tube.na, OVER_MASS, stretch_product, NULL), 3e-9);
        CHECK_BELOW("bending: stiffness against omega^2",
                    off_diagonal(&tube, &model, tube.nb, OVER_BENDING, curvature_product,
                                 tube.om2_b[PLANE_Y]),
                    5e-5);
        CHECK_BELOW("torsion: stiffness against omega^2",
                    off_diagonal(&tube, &model, tube.nt, OVER_TORSION, twist_product, tube.om2_t),
                    5e-5);
        CHECK_BELOW("stretch: stiffness against omega^2",
                    off_diagonal(&tube, &model, tube.na, OVER_AXIAL, strain_product, tube.om2_a),
                    5e-5);
        flexible_tube_free(&tube);
    }
}

// b(0) = b'(0) = 0, tau(0) = a(0) = 0 exactly; values and slopes continuous; positive at the tip.
static void tangent_form(void **state)
{
    (void)state;
    ld_tubes model = stepped_tubes();
    for (int span = 0; span < 3; span++) {
        flexible_tube tube;
        model.modes.span = (ld_mode_span)span;
        build(&tube, &model);
        printf("  span %s\n", span_names[span]);
        double root = 0, jump = 0, tip = HUGE_VAL, order = HUGE_VAL;
        for (int k = 0; k < tube.nb; k++) {
            root = grow(root, fabs(tube_bending(&tube, PLANE_Y, k, 0, 0)) +
                                  fabs(tube_bending(&tube, PLANE_Y, k, 0, 1)));
            tip = fmin(tip, tube_bending(&tube, PLANE_Y, k, tube.length, 0));
            order = fmin(order, tube.om2_b[PLANE_Y][k] - (k ? tube.om2_b[PLANE_Y][k - 1] : 0));
            for (int e = 0; e + 1 < tube.element_count; e++) {
                const tube_element *left = &tube.element[e], *right = left + 1;
                const double(*p)[LD_NB] = left->b[PLANE_Y], (*q)[LD_NB] = right->b[PLANE_Y];
                double h = left->x1 - left->x0;
                jump = grow(jump, p[0][k] + h * (p[1][k] + h * (p[2][k] + h * p[3][k])) - q[0][k]);
                jump = grow(jump, p[1][k] + h * (2 * p[2][k] + h * 3 * p[3][k]) - q[1][k]);
            }
        }
        for (int k = 0; k < tube.nt; k++) {
            root = grow(root, tube_torsion(&tube, k, 0, 0));
            tip = fmin(tip, tube_torsion(&tube, k, tube.length, 0));
        }
        for (int k = 0; k < tube.na; k++) {
            root = grow(root, tube_stretch(&tube, k, 0, 0));
            tip = fmin(tip, tube_stretch(&tube, k, tube.length, 0));
        }
        CHECK_BELOW("value and slope at x = 0", root, 0);
        CHECK_BELOW("jumps of value and slope at nodes", jump, 1e-14);
        CHECK_WITHIN("least value at the tip", tip, 1e-3, HUGE_VAL);
        CHECK_WITHIN("least step between omega^2", order, 1, HUGE_VAL);
        flexible_tube_free(&tube);
    }
}

static void layout(void **state)
{
    (void)state;
    ld_tubes model = stepped_tubes();
    flexible_tube tube;
    build(&tube, &model);
    // alignment, padding and the number of elements
    assert_int_equal((uintptr_t)tube.element % 64, 0);
    assert_int_equal(sizeof(tube_element) % 64, 0);
    assert_int_equal(offsetof(tube_element, b) % 64, 0);
    assert_int_equal(tube.nbp, 8);
    assert_int_equal(tube.ntp, 4);
    assert_int_equal(tube.nap, 4);
    assert_int_equal(tube.element_count, 37);
    double padding = 0;
    for (int e = 0; e < tube.element_count; e++)
        for (int i = 0; i < 4; i++)
            for (int k = 0; k < LD_NB; k++) {
                padding += k < tube.nb ? 0
                                       : fabs(tube.element[e].b[PLANE_Y][i][k]) +
                                             fabs(tube.element[e].b[PLANE_Z][i][k]) +
                                             tube.om2_b[PLANE_Y][k] + tube.om2_b[PLANE_Z][k];
                padding += k < tube.nt || k >= LD_NT || i > 1 ? 0 : fabs(tube.element[e].tau[i][k]);
                padding += k < tube.na || k >= LD_NA || i > 1 ? 0 : fabs(tube.element[e].a[i][k]);
            }
    CHECK_BELOW("padding lanes", padding, 0);
    // nodes at steps, point masses and supports; lengths as even as the pieces allow
    static const double stations[] = {0, 0.4, 0.77, 1.234, 1.8, 2.31, 3.0};
    double longest = 0, shortest = HUGE_VAL;
    for (size_t i = 0; i + 1 < sizeof stations / sizeof *stations; i++)
        assert_true(tube.element[flexible_tube_find(&tube, stations[i])].x0 == stations[i]);
    for (int e = 0; e < tube.element_count; e++) {
        longest = fmax(longest, tube.element[e].x1 - tube.element[e].x0);
        shortest = fmin(shortest, tube.element[e].x1 - tube.element[e].x0);
    }
    CHECK_WITHIN("longest over shortest element", longest / shortest, 1, 1.3);
    // finding an element
    assert_int_equal(flexible_tube_find(&tube, -1), 0);
    assert_int_equal(flexible_tube_find(&tube, 0), 0);
    assert_int_equal(flexible_tube_find(&tube, 3), 36);
    assert_int_equal(flexible_tube_find(&tube, 1e300), 36);
    for (int i = 0; i < 3000; i++) {
        double x = i * 1e-3;
        const tube_element *e = &tube.element[flexible_tube_find(&tube, x)];
        assert_true(x >= e->x0 && x < e->x1);
    }
    for (int e = 0; e < tube.element_count; e++)
        assert_int_equal(flexible_tube_find(&tube, tube.element[e].x0), e);
    for (int k = 0; k < tube.support_count; k++)
        assert_true(tube.element[tube.support_element[k]].x0 == model.support[k].at);
    // damping and dot products
    for (int k = 0; k < tube.nb; k++)
        assert_true(tube.dmp_b[PLANE_Y][k] == 2 * 0.02 * sqrt(tube.om2_b[PLANE_Y][k]));
    double ctc = 0;
    for (int k = 0; k < tube.nb; k++)
        ctc += tube.ct[PLANE_Y][k] * tube.c[PLANE_Y][k];
    CHECK_BELOW("ct.c", tube.ctc[PLANE_Y] - ctc, 0);
    flexible_tube_free(&tube);
}

// A support closer to a section step than a twentieth of an element makes no sliver, wherever it
// is.
static void support_in_an_element(void **state)
{
    (void)state;
    ld_tubes model = reference_tubes();
    flexible_tube tube;
    double at_node[2], beside[2];
    line_frequencies(&model, LINE_BENDING, PLANE_Y, 2, at_node);
    model.section_count = 2;
    model.section[1] = model.section[0];
    model.section[1].from = 0.4 + 1e-5;
    build(&tube, &model);
    assert_int_equal(tube.element_count, 40);
    assert_true(tube.element[tube.support_element[0]].x1 == model.section[1].from);
    line_frequencies(&model, LINE_BENDING, PLANE_Y, 2, beside);
    CHECK_BELOW("2nd frequency, support 10 um from a node", beside[1] / at_node[1] - 1, 1e-5);
    flexible_tube_free(&tube);
}

// The shapes of a plane of a tube are those of a tube that is as this one in both planes, to the
// bit.
static void same_plane(const flexible_tube *tube, int plane, const flexible_tube *alone)
{
    for (int e = 0; e < tube->element_count; e++)
        assert_memory_equal(tube->element[e].b[plane], alone->element[e].b[PLANE_Y],
                            sizeof alone->element[e].b[PLANE_Y]);
    assert_memory_equal(tube->om2_b[plane], alone->om2_b[PLANE_Y], sizeof alone->om2_b[PLANE_Y]);
    assert_memory_equal(tube->dmp_b[plane], alone->dmp_b[PLANE_Y], sizeof alone->dmp_b[PLANE_Y]);
    assert_memory_equal(tube->ct[plane], alone->ct[PLANE_Y], sizeof alone->ct[PLANE_Y]);
    assert_memory_equal(tube->c[plane], alone->c[PLANE_Y], sizeof alone->c[PLANE_Y]);
    assert_true(tube->ctct[plane] == alone->ctct[PLANE_Y] && tube->cc[plane] == alone->cc[PLANE_Y]);
}

// What differs between the planes, one at a time and all together.
typedef struct difference {
    const char *name;
    double along[2], about[2], inertia[2], stiffness[2]; // of plane y, z
    unsigned clamped[2];
} difference;

// What a plane of it has: of y the springs along y and about z.
static void give(const difference *of, int plane, int as, ld_tubes *model)
{
    static const unsigned along[] = {1u << LD_CLAMP_Y, 1u << LD_CLAMP_Z};
    static const unsigned about[] = {1u << LD_CLAMP_PITCH, 1u << LD_CLAMP_YAW};
    model->tail.inertia[2 - as] = of->inertia[plane];
    for (int i = 0; i < model->section_count; i++) {
        ld_section *s = &model->section[i];
        *(as == PLANE_Y ? &s->bending_stiffness_z : &s->bending_stiffness_y) =
            (i == 1 ? of->stiffness[plane] : 1) * 3e5;
    }
    for (int k = 0; k < 2; k++) {
        ld_support *support = &model->support[k];
        support->stiffness[1 + as] = of->along[plane];
        support->rotational_stiffness[2 - as] = of->about[plane];
        support->clamped &= ~(along[as] | about[as]);
        support->clamped |=
            (of->clamped[plane] & 1 ? along[as] : 0) | (of->clamped[plane] & 2 ? about[as] : 0);
    }
}

// Whatever differs between the planes, each has the shapes and frequencies of a tube that is in
// both as it is in that one; and they overlap as their quadrature says.
static void planes_that_differ(void **state)
{
    (void)state;
    static const double K = 2e7, Kr = 2e5, J = 0.06;
    static const difference of[] = {
        {"springs along", {1e7, 3e7}, {Kr, Kr}, {J, J}, {1, 1}, {0, 0}},
        {"springs about", {K, K}, {5e3, 5e5}, {J, J}, {1, 1}, {0, 0}},
        {"the tail's inertia", {K, K}, {Kr, Kr}, {0.02, 0.1}, {1, 1}, {0, 0}},
        {"one section's stiffness", {K, K}, {Kr, Kr}, {J, J}, {0.2, 5}, {0, 0}},
        {"what is clamped along", {K, K}, {Kr, Kr}, {J, J}, {1, 1}, {1, 0}},
        {"what is clamped about", {K, K}, {Kr, Kr}, {J, J}, {1, 1}, {1, 3}},
        {"all", {5e6, 5e5}, {5e3, 5e5}, {0.02, 0.1}, {0.2, 5}, {2, 0}},
    };
    for (size_t i = 0; i < sizeof of / sizeof *of; i++) {
        ld_tubes model = stepped_tubes(), alone[2];
        flexible_tube tube, one;
        for (int s = 0; s < model.section_count; s++)
            model.section[s].form = LD_SECTION_PLANES;
        alone[0] = alone[1] = model;
        for (int plane = PLANE_Y; plane <= PLANE_Z; plane++) {
            give(&of[i], plane, plane, &model);
            give(&of[i], plane, PLANE_Y, &alone[plane]);
            give(&of[i], plane, PLANE_Z, &alone[plane]);
        }
        printf("  %s\n", of[i].name);
        build(&tube, &model);
        assert_non_null(tube.overlap);
        assert_int_equal((uintptr_t)tube.overlap % 64, 0);
        double apart = 0, overlap = 0, across = 0;
        for (int plane = PLANE_Y; plane <= PLANE_Z; plane++) {
            build(&one, &alone[plane]);
            assert_null(one.overlap);
            same_plane(&tube, plane, &one);
            flexible_tube_free(&one);
        }
        for (int k = 0; k < tube.nb; k++)
            for (int l = 0; l < tube.nb; l++) {
                double G =
                    integrate(&model, OVER_MASS, (integrand){&tube, product_across, k, l, 0});
                overlap = grow(overlap, tube.overlap->G[PLANE_Y][k][l] - G);
                overlap = grow(overlap, tube.overlap->G[PLANE_Z][l][k] - G);
                apart = grow(apart, G - (k == l));
            }
        for (int k = 0; k < tube.na; k++)
            for (int l = 0; l < tube.nb; l++) {
                const integrand f = {&tube, stretch_bending, k, l, PLANE_Z};
                across = grow(across, tube.AB[PLANE_Z][k][l] - integrate(&model, OVER_MASS, f));
            }
        CHECK_BELOW("int b_y b_z dm against quadrature", overlap, 1e-12);
        CHECK_BELOW("int a b_z dm against quadrature", across, 1e-9);
        CHECK_WITHIN("largest difference of it from E", apart, 0.02, 2);
        CHECK_BELOW(
            "int b_z b_z dm - E",
            off_diagonal_of(&tube, PLANE_Z, &model, tube.nb, OVER_MASS, bending_product, NULL),
            6e-12);
        CHECK_BELOW("stiffness against omega^2, plane z",
                    off_diagonal_of(&tube, PLANE_Z, &model, tube.nb, OVER_BENDING_ALONG_Z,
                                    curvature_product, tube.om2_b[PLANE_Z]),
                    1e-4);
        flexible_tube_free(&tube);
    }
}

static double lowest(const ld_tubes *model, line_kind kind)
{
    double omega;
    line_frequencies(model, kind, PLANES_ALIKE, 1, &omega);
    return omega;
}

// Torsion and stretch have the supports' own stiffness.
static void bars_on_supports(void **state)
{
    (void)state;
    ld_tubes model = reference_tubes();
    double along = lowest(&model, LINE_STRETCH);
    for (int k = 0; k < 2; k++) {
        model.support[k].stiffness[0] *= 4;
        model.support[k].rotational_stiffness[0] = 0;
    }
    CHECK_WITHIN("axial frequency, supports 4 times as stiff: ratio",
                 lowest(&model, LINE_STRETCH) / along, 1.5, 2);
    CHECK_BELOW("torsion without springs: lowest frequency", lowest(&model, LINE_TORSION), 1e-4);
}

// Gives each section the bending stiffness of a plane by factors on what it has.
static void split_planes(ld_tubes *model, const double *about_y, const double *about_z)
{
    for (int i = 0; i < model->section_count; i++) {
        ld_section *s = &model->section[i];
        s->form = LD_SECTION_PLANES;
        s->bending_stiffness_y = about_y[i] * s->bending_stiffness;
        s->bending_stiffness_z = about_z[i] * s->bending_stiffness;
        s->bending_stiffness = NAN;
    }
}

// Springs of the planes in the same proportion.
static void split_springs(ld_tubes *model, double about_y, double about_z)
{
    for (int k = 0; k < model->support_count; k++) {
        ld_support *s = &model->support[k];
        s->stiffness[2] *= about_y;
        s->rotational_stiffness[1] *= about_y;
        s->stiffness[1] *= about_z;
        s->rotational_stiffness[2] *= about_z;
    }
}

// One bending stiffness given as two is the same tube to the bit; planes in one proportion all
// along, supports included, share their shapes, and so do those of a span without supports.
static void planes_in_proportion(void **state)
{
    (void)state;
    ld_tubes model = stepped_tubes(), alike = model, apart = model, nearly;
    flexible_tube tube, same, two, own;
    split_planes(&alike, (double[]){1, 1, 1}, (double[]){1, 1, 1});
    split_planes(&apart, (double[]){0.4, 0.4, 0.4}, (double[]){1.6, 1.6, 1.6});
    split_springs(&apart, 0.4, 1.6);
    nearly = apart;
    nearly.support[0].stiffness[1] *= 1 + 1e-9;
    build(&tube, &model);
    build(&same, &alike);
    build(&two, &apart);
    build(&own, &nearly);
    assert_true(!tube.overlap && !same.overlap && !two.overlap && own.overlap);
    size_t shapes = (size_t)tube.element_count * sizeof *tube.element;
    assert_memory_equal(tube.element, same.element, shapes);
    assert_memory_equal(tube.om2_b, same.om2_b, sizeof tube.om2_b);
    assert_memory_equal(tube.dmp_b, same.dmp_b, sizeof tube.dmp_b);
    assert_memory_equal(tube.om2_b[PLANE_Y], tube.om2_b[PLANE_Z], sizeof tube.om2_b[0]);
    double off = 0, jump = 0;
    for (int k = 0; k < tube.nb; k++) {
        off = grow(off, two.om2_b[PLANE_Y][k] / (1.6 * tube.om2_b[PLANE_Y][k]) - 1);
        off = grow(off, two.om2_b[PLANE_Z][k] / (0.4 * tube.om2_b[PLANE_Z][k]) - 1);
        off = grow(off, two.dmp_b[PLANE_Z][k] / (0.04 * sqrt(two.om2_b[PLANE_Z][k])) - 1);
        for (int e = 0; e < tube.element_count; e++)
            off = grow(off, two.element[e].b[PLANE_Z][0][k] - tube.element[e].b[PLANE_Y][0][k]);
        for (int plane = PLANE_Y; plane <= PLANE_Z; plane++) {
            jump = grow(jump, own.om2_b[plane][k] / two.om2_b[plane][k] - 1);
            for (int e = 0; e < tube.element_count; e++)
                jump = grow(jump, own.element[e].b[plane][0][k] - two.element[e].b[plane][0][k]);
        }
        for (int l = 0; l < tube.nb; l++)
            jump = grow(jump, own.overlap->G[PLANE_Y][k][l] - (k == l));
    }
    CHECK_BELOW("planes in proportion: omega^2, damping, shapes", off, 1e-12);
    CHECK_BELOW("from there to shapes of their own: omega^2, shapes, overlap", jump, 2e-9);
    flexible_tube_free(&own);
    flexible_tube_free(&two);
    split_springs(&apart, 7, 1);
    for (int span = LD_SPAN_CLAMPED; span <= LD_SPAN_FREE_FREE; span++) {
        apart.modes.span = (ld_mode_span)span;
        build(&two, &apart);
        assert_null(two.overlap);
        flexible_tube_free(&two);
    }
    flexible_tube_free(&tube);
    flexible_tube_free(&same);
}

// Stiff tubes on soft supports and tubes without supports have nearly or quite rigid modes: their
// tangent shapes must stay independent.
static void nearly_rigid(void **state)
{
    (void)state;
    static const double factors[] = {1e3, 1e6, 1e9, 1e12};
    for (int i = 0; i < 5; i++) {
        ld_tubes model = reference_tubes();
        model.modes.axial = 2;
        ld_section *section = model.section;
        double factor = i < 4 ? factors[i] : 1;
        section->bending_stiffness *= factor;
        section->torsion_stiffness *= factor;
        section->axial_stiffness *= factor;
        if (i == 4)
            model.support_count = 0;
        printf("  stiffness times %g, %d supports\n", factor, model.support_count);
        flexible_tube tube;
        build(&tube, &model);
        CHECK_BELOW("int b b dm - E",
                    off_diagonal(&tube, &model, tube.nb, OVER_MASS, bending_product, NULL), 1e-12);
        CHECK_BELOW("stiffness against omega^2",
                    off_diagonal(&tube, &model, tube.nb, OVER_BENDING, curvature_product,
                                 tube.om2_b[PLANE_Y]),
                    1e-6);
        CHECK_BELOW("int rho I_p tau tau dx - E",
                    off_diagonal(&tube, &model, tube.nt, OVER_POLAR_INERTIA, torsion_product, NULL),
                    3e-9);
        flexible_tube_free(&tube);
    }
}

static void repeats_its_bits(void **state)
{
    (void)state;
    ld_tubes model = stepped_tubes();
    flexible_tube a, b;
    build(&a, &model);
    build(&b, &model);
    assert_memory_equal(a.element, b.element, (size_t)a.element_count * sizeof *a.element);
    assert_memory_equal(a.ct, b.ct, sizeof a.ct);
    assert_memory_equal(a.om2_b, b.om2_b, sizeof a.om2_b);
    assert_memory_equal(a.AB, b.AB, sizeof a.AB);
    flexible_tube_free(&a);
    flexible_tube_free(&b);
}

static void refuse(const ld_tubes *model, ld_status status, const char *text)
{
    flexible_tube tube;
    ld_error error;
    assert_int_equal(flexible_tube_build(&tube, model, &error), status);
    assert_string_equal(error.text, text);
    assert_int_equal(flexible_tube_build(&tube, model, NULL), status);
    flexible_tube_free(&tube);
}

static void refusals(void **state)
{
    (void)state;
    const ld_tubes good = reference_tubes();
    ld_tubes model = good;
    model.modes.bending = 0;
    refuse(&model, LD_ERR_INPUT,
           "expected 1 to 24 bending, 0 to 8 torsion and 0 to 8 axial modes, found 0, 2 and 0");
    model = good;
    model.modes.elements = 2;
    model.modes.bending = 7;
    refuse(&model, LD_ERR_INPUT, "7 bending modes need a mesh of more than 3 elements");
    model = good;
    model.section[0].mass_per_length = 0;
    refuse(&model, LD_ERR_INPUT, "the tube has sections without mass");
    model = good;
    model.section[0].polar_inertia = 0;
    refuse(&model, LD_ERR_INPUT, "the tube has sections without polar inertia");
    model = good;
    model.section[0].bending_stiffness = NAN;
    refuse(&model, LD_ERR_NUMERIC,
           "the modes of the clamped tube cannot be computed: check that stiffnesses and masses "
           "are finite and in proportion");
    model = good;
    model.support[1].stiffness[1] = INFINITY;
    refuse(&model, LD_ERR_NUMERIC,
           "the modes of the tube on its supports cannot be computed: check that stiffnesses and "
           "masses are finite and in proportion");
    model = good;
    model.support[1].at = 3.5;
    refuse(&model, LD_ERR_INPUT,
           "a section, point mass or support lies outside the tube's length of 3 m");
    // as many modes as a mesh has
    flexible_tube tube;
    model = good;
    model.modes.bending = 24;
    model.modes.elements = 12;
    model.modes.torsion = model.modes.axial = 0;
    for (int span = 0; span < 3; span++) {
        model.modes.span = (ld_mode_span)span;
        build(&tube, &model);
        assert_int_equal(tube.nb, 24);
        assert_int_equal(tube.ntp, 0);
        flexible_tube_free(&tube);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(inertia_coefficients),
        cmocka_unit_test(tangent_form),
        cmocka_unit_test(layout),
        cmocka_unit_test(support_in_an_element),
        cmocka_unit_test(planes_that_differ),
        cmocka_unit_test(bars_on_supports),
        cmocka_unit_test(planes_in_proportion),
        cmocka_unit_test(nearly_rigid),
        cmocka_unit_test(repeats_its_bits),
        cmocka_unit_test(refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
