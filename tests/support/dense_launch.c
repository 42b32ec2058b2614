#include "support/dense_launch.h"

#include "math/matrices/lapack.h"
#include "model/model.h"
#include <stdlib.h>
#include <string.h>

#include "support/dense_flight.h"
#include "support/jet.h"

_Static_assert((int)JET_MAX >= (int)DENSE_MAX_COORDINATES, "a jet holds every coordinate");

// ---------------------------------------------------------------- the tube as points

enum { GAUSS = 4 }; // exact to degree 7: squares of cubics and their product with x
static const double gauss_at[GAUSS] = {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                       0.8611363115940526};
static const double gauss_weight[GAUSS] = {0.3478548451374538, 0.6521451548625461,
                                           0.6521451548625461, 0.3478548451374538};

static const ld_section *section_at(const ld_tubes *tubes, double x)
{
    int i = 0;
    while (i + 1 < tubes->section_count && tubes->section[i + 1].from <= x)
        i++;
    return &tubes->section[i];
}

static void add_to_shoes(dense_launch *dense, double y, double z, double normal, double gap,
                         bool round)
{
    const ld_rocket *rocket = &dense->model->rocket;
    for (int i = 0; i < rocket->adaptor_count; i++) {
        double extra = rocket->adaptor[i].clearance;
        dense->surface[dense->surface_count++] =
            (dense_surface){i, y, z, normal, gap + (isnan(extra) ? 0 : extra), round};
    }
}

// Surfaces of every shoe, as a list, a T-slot's lips from above, below and both sides, or rails
// around.
static void fill_surfaces(dense_launch *dense)
{
    const ld_guide *guide = &dense->model->tubes.guide;
    const ld_t_slot *slot = &guide->t_slot;
    const ld_tower *tower = &guide->tower;
    const double turn = 6.283185307179586476925;
    if (guide->present)
        memcpy(dense->line, guide->line, sizeof dense->line);
    if (guide->present && guide->form == LD_GUIDE_SURFACES)
        for (int k = 0; k < guide->surface_count; k++) {
            const ld_surface *s = &guide->surface[k];
            add_to_shoes(dense, s->at[0], s->at[1], s->normal, s->gap,
                         s->shape == LD_SURFACE_ROUND);
        }
    else if (guide->present && guide->form == LD_GUIDE_T_SLOT) {
        for (int side = -1; side <= 1; side += 2) {
            double z = slot->at[1] + 0.5 * side * slot->lips;
            add_to_shoes(dense, slot->at[0], z, 0, slot->gap, false);
            add_to_shoes(dense, slot->at[0], z, 0.5 * turn, slot->gap, false);
            add_to_shoes(dense, slot->at[0], slot->at[1], 0.25 * side * turn, slot->side_gap,
                         false);
        }
    } else if (guide->present) {
        for (int k = 0; k < tower->rails; k++) {
            double angle = tower->first + turn * k / tower->rails;
            add_to_shoes(dense, tower->radius * cos(angle), tower->radius * sin(angle), angle,
                         tower->gap, true);
        }
    }
}

bool dense_launch_holds_roll(const dense_launch *dense)
{
    ld_hold hold = dense->model->rocket.lock.holds_roll;
    bool smooth = dense->model->tubes.slot.kind == LD_SLOT_NONE;
    for (int k = 0; k < dense->surface_count; k++)
        smooth = smooth && dense->surface[k].round;
    return hold == LD_HOLD_BY_GUIDE ? smooth : hold == LD_HOLD_YES;
}

// [N m2] of deflections along y (plane 0) or z.
static double bending_of(const ld_section *section, int plane)
{
    if (section->form != LD_SECTION_PLANES)
        return section->bending_stiffness;
    return plane ? section->bending_stiffness_y : section->bending_stiffness_z;
}

// K += int EI b'' b''^T dx of a stretch: b'' is linear along it.
static void add_bending(double K[LD_NB][LD_NB], double b[4][LD_NB], double x0, int nb, double from,
                        double to, double EI)
{
    for (int g = 0; g < GAUSS; g++) {
        double xi = 0.5 * (from + to) + 0.5 * (to - from) * gauss_at[g] - x0;
        double weight = 0.5 * (to - from) * gauss_weight[g] * EI;
        for (int i = 0; i < nb; i++)
            for (int j = 0; j < nb; j++)
                K[i][j] +=
                    weight * (2 * b[2][i] + 6 * xi * b[3][i]) * (2 * b[2][j] + 6 * xi * b[3][j]);
    }
}

// K += k G A strain strain^T of a stretch of an element, G A = G I_t mu/(rho I_p) of round
// sections.
static void add_shear(dense_launch *dense, int element, double stretch, const ld_section *section)
{
    double GA = section->torsion_stiffness * section->mass_per_length / section->polar_inertia;
    double kGA = dense->model->tubes.modes.shear_coefficient * GA;
    for (int plane = 0; plane < 2; plane++) {
        const double *strain = dense->tube->shear->strain[element][plane];
        for (int i = 0; i < dense->tube->nb; i++)
            for (int j = 0; j < dense->tube->nb; j++)
                dense->K[plane][i][j] += kGA * stretch * strain[i] * strain[j];
    }
}

// D = 2 zeta K^(1/2), by K's eigenvectors: the shapes have unit mass.
static void damp_bending(double D[LD_NB][LD_NB], double K[LD_NB][LD_NB], int nb, double zeta)
{
    double vector[LD_NB * LD_NB], square[LD_NB];
    for (int i = 0; i < nb; i++)
        for (int j = 0; j < nb; j++)
            vector[i * nb + j] = K[i][j];
    if (nb)
        LAPACKE_dsyev(LAPACK_COL_MAJOR, 'V', 'U', nb, vector, nb, square);
    for (int k = 0; k < nb; k++)
        for (int i = 0; i < nb; i++)
            for (int j = 0; j < nb; j++)
                D[i][j] +=
                    2 * zeta * sqrt(fmax(0, square[k])) * vector[k * nb + i] * vector[k * nb + j];
}

void dense_launch_create(dense_launch *dense, const ld_model *model, const flexible_tube *tube)
{
    const ld_tubes *tubes = &model->tubes;
    *dense = (dense_launch){.model = model, .tube = tube};
    fill_surfaces(dense);
    dense->mode_count = 2 * tube->nb + tube->nt + tube->na;
    int capacity = GAUSS * (tube->element_count + tubes->section_count) + tubes->point_mass_count;
    dense->point = malloc((size_t)capacity * sizeof *dense->point);
    // Gauss points of every stretch between element ends and section ends
    for (int i = 0; i < tube->element_count; i++) {
        double from = tube->element[i].x0, end = tube->element[i].x1;
        while (from < end) {
            double to = end;
            for (int k = 0; k < tubes->section_count; k++)
                if (tubes->section[k].from > from + 1e-12 && tubes->section[k].from < to - 1e-12)
                    to = tubes->section[k].from;
            const ld_section *section = section_at(tubes, 0.5 * (from + to));
            for (int g = 0; g < GAUSS; g++) {
                double weight = 0.5 * (to - from) * gauss_weight[g];
                dense->point[dense->point_count++] = (dense_tube_point){
                    0.5 * (from + to) + 0.5 * (to - from) * gauss_at[g],
                    weight * section->mass_per_length, weight * section->polar_inertia};
            }
            for (int plane = 0; plane < 2; plane++)
                add_bending(dense->K[plane], tube->element[i].b[plane], tube->element[i].x0,
                            tube->nb, from, to, bending_of(section, plane));
            if (tube->shear)
                add_shear(dense, i, to - from, section);
            from = to;
        }
    }
    for (int plane = 0; plane < 2; plane++)
        damp_bending(dense->D[plane], dense->K[plane], tube->nb, tubes->modes.damping);
    for (int i = 0; i < tubes->point_mass_count; i++)
        dense->point[dense->point_count++] =
            (dense_tube_point){tubes->point_mass[i].at, tubes->point_mass[i].mass, 0};
}

void dense_launch_free(dense_launch *dense)
{
    free(dense->point);
    *dense = (dense_launch){0};
}

// ---------------------------------------------------------------- positions

// A frame: origin and axes, in the coordinates of another one.
typedef struct jet_frame {
    jet3 r;
    jet33 A;
} jet_frame;

// The coordinates of one state as jets: R, modes, B. Still: values only, no derivatives.
typedef struct jet_scene {
    const dense_launch *dense;
    const dense_state *state;
    int n;       // number of coordinates; 0 when still
    jet_frame R; // in I
    jet_frame B; // in I
} jet_scene;

// sum over k of (-x)^k/(first + 2 k)!, with first = 1: sin t/t, first = 2: (1 - cos t)/t^2, x = t^2
static jet rotation_series(const jet *x, int first)
{
    double factorial = first == 1 ? 1 : 0.5, f = 0, f1 = 0, f2 = 0;
    double power = 1, power1 = 0, power2 = 0; // x^k, its derivatives
    for (int k = 0, top = first; k < 30; k++, top += 2) {
        f += factorial * power;
        f1 += factorial * power1;
        f2 += factorial * power2;
        power2 = (k + 1) * power1;
        power1 = (k + 1) * power;
        power *= x->v;
        factorial /= -(double)((top + 1) * (top + 2));
        if (k > 1 && fabs(factorial * power2) < 1e-24)
            break;
    }
    return jet_apply(*x, f, f1, f2);
}

// Exp(~th) = E + a ~th + b (th th^T - |th|^2 E)
static jet33 rotation_of(const jet3 *th)
{
    jet x = jet3_dot(th, th), a = rotation_series(&x, 1), b = rotation_series(&x, 2), ath, bx;
    jet3 bth;
    jet33 A;
    jet_product(&bx, &b, &x);
    for (int i = 0; i < 3; i++)
        jet_product(&bth.c[i], &b, &th->c[i]);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            jet_product(&A.c[i][j], &bth.c[i], &th->c[j]);
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        jet_product(&ath, &a, &th->c[k]);
        A.c[i][i].v += 1;
        jet_increase(&A.c[i][i], -1, &bx);
        jet_increase(&A.c[j][i], 1, &ath);
        jet_increase(&A.c[i][j], -1, &ath);
    }
    return A;
}

// A free body: three coordinates of its origin, three of its rotation from A on.
static jet_frame free_body(const double r[3], const double A[3][3], const double v[3],
                           const double w[3], int index, int n)
{
    jet_frame body;
    jet33 start = jet33_constant(A);
    if (n == 0) {
        body.r = jet3_constant(r);
        body.A = start;
        return body;
    }
    jet3 turn;
    for (int i = 0; i < 3; i++) {
        body.r.c[i] = jet_coordinate(r[i], v[i], index + i, n);
        turn.c[i] = jet_coordinate(0, w[i], index + 3 + i, n);
    }
    jet33 rotation = rotation_of(&turn);
    body.A = jet33_mul(&start, &rotation);
    return body;
}

static void scene_set(jet_scene *scene, const dense_launch *dense, const dense_state *state, int n)
{
    scene->dense = dense;
    scene->state = state;
    scene->n = n;
    scene->R = free_body(state->r, state->A_R, state->v, state->w, 0, n);
    scene->B =
        free_body(state->r_O1, state->A_B, state->v_O1, state->w_B, 6 + dense->mode_count, n);
}

// Point with coordinates p in a frame.
static jet3 point_in(const jet_frame *frame, const jet3 *p)
{
    jet3 r = frame->r;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            jet_accumulate(&r.c[i], &frame->A.c[i][j], &p->c[j]);
    return r;
}

static jet_frame frame_in(const jet_frame *outer, const jet_frame *inner)
{
    jet_frame r = {point_in(outer, &inner->r), jet33_mul(&outer->A, &inner->A)};
    return r;
}

// Coordinates in a frame of a point.
static jet3 seen_from(const jet_frame *frame, const jet3 *point)
{
    jet3 arm = jet3_sub(point, &frame->r);
    return jet33_turn_back(&frame->A, &arm);
}

// One family of modes: coefficients of xi^k in row k, its place among the modal coordinates.
typedef struct mode_family {
    const double *coefficient;
    int rows, stride, count, first;
} mode_family;

// sum over modes of (derivative of the shape at xi) times its coordinate; xi a plain number
static jet shape_at(const jet_scene *scene, const mode_family *family, int derivative, double xi)
{
    jet r = jet_constant(0);
    if (scene->n && family->count) {
        r.n = scene->n;
        memset(r.d, 0, (size_t)r.n * sizeof *r.d);
    }
    for (int m = 0; m < family->count; m++) {
        double shape = 0;
        for (int k = family->rows - 1; k >= derivative; k--) {
            int falling = 1;
            for (int i = 0; i < derivative; i++)
                falling *= k - i;
            shape = shape * xi + falling * family->coefficient[k * family->stride + m];
        }
        r.v += shape * scene->state->q[family->first + m];
        if (scene->n) {
            r.t += shape * scene->state->q_dot[family->first + m];
            r.d[6 + family->first + m] = shape;
        }
    }
    r.e = r.t;
    return r;
}

// The same for a jet xi: Taylor's series about its value ends after the second power.
static jet shape_sum(const jet_scene *scene, const mode_family *family, int derivative, jet xi)
{
    jet r = shape_at(scene, family, derivative, xi.v);
    if (xi.n == 0 && xi.t == 0 && xi.e == 0 && xi.te == 0)
        return r;
    jet step = xi, square = jet_constant(0);
    step.v = 0;
    jet_accumulate(&square, &step, &step);
    jet slope = shape_at(scene, family, derivative + 1, xi.v);
    jet curvature = shape_at(scene, family, derivative + 2, xi.v);
    curvature = jet_scale(0.5, curvature);
    jet_accumulate(&r, &slope, &step);
    jet_accumulate(&r, &curvature, &square);
    return r;
}

static const tube_element *element_at(const flexible_tube *tube, double x)
{
    int i = 0;
    while (i + 1 < tube->element_count && tube->element[i + 1].x0 <= x)
        i++;
    return &tube->element[i];
}

// A family of modes at the element that holds station x.
static jet family_at(const jet_scene *scene, char family, int derivative, jet x)
{
    const flexible_tube *tube = scene->dense->tube;
    const tube_element *element = element_at(tube, x.v);
    mode_family modes;
    if (family == 'y')
        modes = (mode_family){&element->b[0][0][0], 4, LD_NB, tube->nb, 0};
    else if (family == 'z')
        modes = (mode_family){&element->b[1][0][0], 4, LD_NB, tube->nb, tube->nb};
    else if (family == 't')
        modes = (mode_family){&element->tau[0][0], 2, LD_NT, tube->nt, 2 * tube->nb};
    else
        modes = (mode_family){&element->a[0][0], 2, LD_NA, tube->na, 2 * tube->nb + tube->nt};
    x.v -= element->x0;
    return shape_sum(scene, &modes, derivative, x);
}

// Place of the axis point of station x, in R.
static jet3 axis_point(const jet_scene *scene, jet x)
{
    jet3 p = {{jet_add(x, family_at(scene, 'a', 0, x)), family_at(scene, 'y', 0, x),
               family_at(scene, 'z', 0, x)}};
    return p;
}

// Shear strain of an element in a plane: the slope less the section's turn.
static jet strain_of(const jet_scene *scene, int element, int plane)
{
    const flexible_tube *tube = scene->dense->tube;
    const mode_family modes = {tube->shear->strain[element][plane], 1, LD_NB, tube->nb,
                               plane * tube->nb};
    return shape_at(scene, &modes, 0, 0);
}

static bool is_shortened(const jet_scene *scene)
{
    return scene->dense->model->tubes.modes.geometric_stiffness == LD_GEOMETRIC_YES;
}

// Adds -1/2 int u'^2 dx of both planes between two places of an element.
static void add_shortening(const jet_scene *scene, double from, double to, jet *sum)
{
    for (int g = 0; g < GAUSS; g++) {
        jet at = jet_constant(0.5 * (from + to) + 0.5 * (to - from) * gauss_at[g]), square;
        for (int plane = 0; plane < 2; plane++) {
            jet slope = family_at(scene, plane ? 'z' : 'y', 1, at);
            jet_product(&square, &slope, &slope);
            jet_increase(sum, -0.25 * (to - from) * gauss_weight[g], &square);
        }
    }
}

// How far bending draws the axis point of station x along x: by half the slope's square.
static jet shortening_to(const jet_scene *scene, jet x)
{
    const flexible_tube *tube = scene->dense->tube;
    jet sum = jet_constant(0), step = x, square = jet_constant(0), slow = jet_constant(0), product;
    for (int i = 0; i < tube->element_count && tube->element[i].x0 < x.v; i++)
        add_shortening(scene, tube->element[i].x0, fmin(x.v, tube->element[i].x1), &sum);
    step.v = 0;
    jet_accumulate(&square, &step, &step);
    for (int plane = 0; plane < 2; plane++) {
        jet here = jet_constant(x.v), slope = family_at(scene, plane ? 'z' : 'y', 1, here);
        jet bend = family_at(scene, plane ? 'z' : 'y', 2, here);
        jet_product(&product, &slope, &slope);
        jet_increase(&slow, -0.5, &product);
        jet_product(&product, &slope, &bend);
        product = jet_scale(-0.5, product);
        jet_accumulate(&sum, &product, &square);
    }
    jet_accumulate(&sum, &slow, &step);
    return sum;
}

// Rotation vector of the section at station x, in R.
static jet3 section_turn(const jet_scene *scene, jet x)
{
    jet3 phi = {{family_at(scene, 't', 0, x), jet_scale(-1, family_at(scene, 'z', 1, x)),
                 family_at(scene, 'y', 1, x)}};
    if (scene->dense->tube->shear) {
        int element = (int)(element_at(scene->dense->tube, x.v) - scene->dense->tube->element);
        jet strain[2] = {strain_of(scene, element, 0), strain_of(scene, element, 1)};
        jet_increase(&phi.c[2], -1, &strain[0]);
        jet_increase(&phi.c[1], 1, &strain[1]);
    }
    return phi;
}

// Of the guide's initial shape a column, or a derivative of it, at station x: the polynomial
// through the table's two to four rows, which their spline is too.
static jet initial_column(const ld_initial_shape *given, int column, int derivative, jet x)
{
    const ld_table *table = &given->offsets;
    int rows = (int)table->rows, columns = (int)table->columns;
    const double *row = table->data;
    double c[4] = {0}, factor = column == 3 ? given->twist_scale : given->scale[column - 1];
    for (int i = 0; i < rows && column < columns; i++) { // Lagrange
        double basis[5] = {factor * row[i * columns + column]};
        for (int j = 0, degree = 0; j < rows; j++) {
            double at = row[j * columns], span = row[i * columns] - at;
            if (j == i)
                continue;
            degree++;
            for (int k = degree; k >= 0; k--)
                basis[k] = ((k > 0 ? basis[k - 1] : 0) - at * basis[k]) / span;
        }
        for (int k = 0; k < rows; k++)
            c[k] += basis[k];
    }
    for (int i = 0; i < derivative; i++)
        for (int k = 0; k < 4; k++)
            c[k] = k < 3 ? (k + 1) * c[k + 1] : 0;
    jet sum = jet_constant(0), product;
    for (int k = 3; k >= 0; k--) {
        jet_product(&product, &sum, &x);
        sum = jet_add(product, jet_constant(c[k]));
    }
    return sum;
}

// Moves and turns a section by it.
static void add_initial_shape(const ld_initial_shape *given, jet x, jet3 *place, jet3 *phi)
{
    jet z1 = initial_column(given, 2, 1, x);
    place->c[1] = jet_add(place->c[1], initial_column(given, 1, 0, x));
    place->c[2] = jet_add(place->c[2], initial_column(given, 2, 0, x));
    phi->c[0] = jet_add(phi->c[0], initial_column(given, 3, 0, x));
    jet_increase(&phi->c[1], -1, &z1);
    phi->c[2] = jet_add(phi->c[2], initial_column(given, 1, 1, x));
}

// What a section belongs to: the tube, or the guide with its initial shape.
typedef enum section_of { OF_TUBE, OF_GUIDE } section_of;

// Section frame at station s, in R; beyond the ends straight on along the end section's axis. The
// margin keeps a place at the tip (to rounding) on the tube, whose curvature there need not be
// zero.
static jet_frame frame_in_R(const jet_scene *scene, section_of part, jet s)
{
    jet_frame section;
    double length = scene->dense->tube->length;
    double end = s.v < 0 ? 0 : length;
    const double margin = 1e-9;
    if (s.v < -margin || s.v > length + margin) {
        section = frame_in_R(scene, part, jet_constant(end));
        jet beyond = jet_sub(s, jet_constant(end));
        jet3 along = {{beyond, jet_constant(0), jet_constant(0)}};
        section.r = point_in(&section, &along);
        return section;
    }
    jet3 phi = section_turn(scene, s);
    section.r = axis_point(scene, s);
    if (is_shortened(scene))
        section.r.c[0] = jet_add(section.r.c[0], shortening_to(scene, s));
    const ld_initial_shape *initial = &scene->dense->model->tubes.initial_shape;
    if (part == OF_GUIDE && initial->present)
        add_initial_shape(initial, s, &section.r, &phi);
    section.A = rotation_of(&phi);
    return section;
}

static jet_frame section_in_R(const jet_scene *scene, jet s)
{
    return frame_in_R(scene, OF_GUIDE, s);
}

static jet_frame tube_section_in_I(const jet_scene *scene, double at)
{
    jet_frame section = frame_in_R(scene, OF_TUBE, jet_constant(at));
    return frame_in(&scene->R, &section);
}

static jet_frame section_in_I(const jet_scene *scene, jet s)
{
    jet_frame section = section_in_R(scene, s);
    return frame_in(&scene->R, &section);
}

// e_x of the section at s times (p - its origin), p in R: zero at the foot.
static jet foot_residual(const jet_scene *scene, jet s, const jet3 *p)
{
    jet_frame section = section_in_R(scene, s);
    jet3 axis = jet33_column(&section.A, 0), arm = jet3_sub(p, &section.r);
    return jet3_dot(&axis, &arm);
}

// Station of the section whose plane holds a point of I: Newton in values, then in jets.
static jet foot_of(const jet_scene *moving, const jet_scene *still, const jet3 *point, double guess)
{
    jet3 p = seen_from(&moving->R, point), place;
    for (int i = 0; i < 3; i++)
        place.c[i] = jet_constant(p.c[i].v);
    double slope = -1, s = guess;
    for (int i = 0; i < 50; i++) {
        jet station = jet_constant(s);
        station.e = 1;
        jet residual = foot_residual(still, station, &place);
        slope = residual.e;
        s -= residual.v / slope;
        if (fabs(residual.v) < 4e-16)
            break;
    }
    // each pass is exact to one order more in the derivatives, which end at the second
    jet foot = jet_constant(s);
    for (int i = 0; i < 2; i++) {
        jet residual = foot_residual(moving, foot, &p);
        jet_increase(&foot, -1 / slope, &residual);
    }
    return foot;
}

// ---------------------------------------------------------------- equations

// those of adaptors held on the axis, two each, from HELD on; of clamped supports from CLAMPED on
enum { LOCK, SLOT, ROLL, HELD, CLAMPED = HELD + 4, ROWS = CLAMPED + LD_MAX_CLAMPED };

typedef struct equations {
    int n;
    double x_dot[DENSE_MAX_COORDINATES];
    double M[DENSE_MAX_COORDINATES][DENSE_MAX_COORDINATES]; // lower triangle
    double h[DENSE_MAX_COORDINATES];     // all forces, inertial ones quadratic in speeds included
    double other[DENSE_MAX_COORDINATES]; // forces without a potential
    bool active[ROWS];
    double C[ROWS][DENSE_MAX_COORDINATES]; // C x_ddot = rhs
    double rhs[ROWS];
    double G[ROWS][DENSE_MAX_COORDINATES]; // forces of unit multipliers
    double drag[DENSE_MAX_COORDINATES];    // slot friction of |N| = 1
    double support[DENSE_MAX_COORDINATES]; // forces of the supports
    double kinetic, potential, momentum[3], angular_momentum[3];
    bool frictionless;
} equations;

static void add_force(double *h, const jet3 *point, const double f[3])
{
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < point->c[i].n; k++)
            h[k] += point->c[i].d[k] * f[i];
}

static void add_mass(equations *eq, const jet3 *p, double mass, double gravity)
{
    for (int i = 0; i < 3; i++) {
        const jet *c = &p->c[i];
        for (int j = 0; j < eq->n; j++) {
            double momentum = mass * c->d[j];
            for (int k = 0; k <= j; k++)
                eq->M[j][k] += momentum * c->d[k];
        }
        eq->kinetic += 0.5 * mass * c->e * c->e;
        eq->momentum[i] += mass * c->e;
        const jet *next = &p->c[(i + 1) % 3], *last = &p->c[(i + 2) % 3];
        eq->angular_momentum[i] += mass * (next->v * last->e - last->v * next->e);
    }
    double f[3] = {-mass * p->c[0].te, -mass * (p->c[1].te + gravity), -mass * p->c[2].te};
    add_force(eq->h, p, f);
    eq->potential += mass * gravity * p->c[1].v;
}

// 1/2 I (w + phi_dot)^2 with w the rate of R about its axis (-1: none), like w_x = a_z . a_y_dot of
// its axes a_y and a_z: Lagrange's equations of a squared rate W = sum W_k x_k_dot, whose W_k
// depend on the coordinates, as I does.
static void add_turning(equations *eq, const jet_scene *scene, int axis, const jet *phi,
                        const jet *inertia)
{
    double form[DENSE_MAX_COORDINATES], curl[DENSE_MAX_COORDINATES];
    double rate = phi->e, rate_dot = phi->te;
    for (int k = 0; k < eq->n; k++) {
        form[k] = k < phi->n ? phi->d[k] : 0;
        curl[k] = 0;
    }
    for (int i = 0; i < 3 && axis >= 0; i++) {
        const jet *a_y = &scene->R.A.c[i][(axis + 1) % 3];
        const jet *a_z = &scene->R.A.c[i][(axis + 2) % 3];
        rate += a_z->v * a_y->e;
        rate_dot += a_z->v * a_y->te + a_z->e * a_y->e;
        for (int k = 0; k < eq->n; k++) {
            form[k] += a_z->v * a_y->d[k];
            curl[k] += a_z->e * a_y->d[k] - a_z->d[k] * a_y->e;
        }
    }
    for (int j = 0; j < eq->n; j++) {
        for (int k = 0; k <= j; k++)
            eq->M[j][k] += inertia->v * form[j] * form[k];
        eq->h[j] -=
            inertia->v * (form[j] * rate_dot + rate * curl[j]) + inertia->e * rate * form[j];
        eq->h[j] += j < inertia->n ? 0.5 * inertia->d[j] * rate * rate : 0;
    }
    eq->kinetic += 0.5 * inertia->v * rate * rate;
    for (int i = 0; i < 3 && axis >= 0; i++)
        eq->angular_momentum[i] += inertia->v * rate * scene->R.A.c[i][axis].v;
}

// A mass that bending draws by s along x of R: m r_R_dot . d/dt(A s e_x), a product of two speeds
// as squares of their sum and of each; its weight.
static void add_drawn(equations *eq, const jet_scene *scene, const jet *s, double mass)
{
    const double gravity = scene->dense->model->gravity;
    jet3 axis = jet33_column(&scene->R.A, 0), moved, both = scene->R.r;
    for (int i = 0; i < 3; i++) {
        jet_product(&moved.c[i], &axis.c[i], s);
        jet_increase(&both.c[i], 1, &moved.c[i]);
        eq->momentum[i] += mass * moved.c[i].e;
    }
    add_mass(eq, &both, mass, 0);
    add_mass(eq, &scene->R.r, -mass, 0);
    add_mass(eq, &moved, -mass, 0);
    const double weight[3] = {0, -mass * gravity, 0};
    add_force(eq->h, &moved, weight);
    eq->potential += mass * gravity * moved.c[1].v;
}

// What foreshortening leaves of j0/2 (w_y^2 + w_z^2) + w_z c_y . q_y_dot - w_y c_z . q_z_dot: a
// share, here of squares, j0/2 ((w_y - f_z)^2 + (w_z + f_y)^2 - f_y^2 - f_z^2), f = c . q_dot/j0.
static void add_shortened(equations *eq, const jet_scene *scene)
{
    const dense_launch *dense = scene->dense;
    jet eps = jet_constant(0), turn[2] = {jet_constant(0), jet_constant(0)};
    double j0 = 0;
    for (int i = 0; i < dense->point_count; i++) {
        const dense_tube_point *point = &dense->point[i];
        double first = point->mass * point->at;
        jet at = jet_constant(point->at), s = shortening_to(scene, at);
        add_drawn(eq, scene, &s, point->mass);
        jet_increase(&eps, 2 * first, &s);
        j0 += first * point->at;
        for (int plane = 0; plane < 2; plane++) {
            jet u = family_at(scene, plane ? 'z' : 'y', 0, at);
            jet_increase(&turn[plane], first, &u);
        }
    }
    jet back = jet_scale(-1, eps);
    for (int plane = 0; plane < 2; plane++) {
        turn[plane] = jet_scale((plane ? -1 : 1) / j0, turn[plane]);
        add_turning(eq, scene, plane ? 1 : 2, &turn[plane], &eps);
        add_turning(eq, scene, -1, &turn[plane], &back);
    }
}

// Rotary inertia of a part of the tube about z and y, as far as it turns with its section: round in
// the stiffness of both planes. 1/2 I ((w + phi_dot)^2 - phi_dot^2), and the modes' own share as
// the formulation has it, of a mass I at a deflection phi in R's axes: modal mass E in all terms.
static void add_rotary(equations *eq, const jet_scene *scene, const dense_tube_point *point)
{
    const ld_section *section = section_at(&scene->dense->model->tubes, point->at);
    double both = bending_of(section, 0) + bending_of(section, 1);
    jet3 turn = section_turn(scene, jet_constant(point->at));
    jet3 place[2] = {{{jet_constant(0), turn.c[2], jet_constant(0)}},
                     {{jet_constant(0), jet_constant(0), jet_scale(-1, turn.c[1])}}};
    bool alike = !scene->dense->tube->overlap;
    if (alike)
        place[0].c[2] = place[1].c[2];
    for (int plane = 0; plane < 2; plane++) {
        double share = point->polar * bending_of(section, plane) / both;
        jet inertia = jet_constant(share), back = jet_constant(-share);
        add_turning(eq, scene, 2 - plane, &turn.c[2 - plane], &inertia);
        add_turning(eq, scene, -1, &turn.c[2 - plane], &back);
        if (alike && plane)
            continue;
        jet3 moved = jet33_turn(&scene->R.A, &place[plane]);
        add_mass(eq, &moved, share, 0);
        for (int i = 0; i < 3; i++)
            eq->momentum[i] -= share * moved.c[i].e;
    }
}

static void add_tube(equations *eq, const jet_scene *scene)
{
    const dense_launch *dense = scene->dense;
    for (int i = 0; i < dense->point_count; i++) {
        const dense_tube_point *point = &dense->point[i];
        jet at = jet_constant(point->at);
        jet3 local = axis_point(scene, at), p = point_in(&scene->R, &local);
        add_mass(eq, &p, point->mass, dense->model->gravity);
        if (point->polar != 0) {
            jet phi_x = family_at(scene, 't', 0, at), polar = jet_constant(point->polar);
            add_turning(eq, scene, 0, &phi_x, &polar);
            if (dense->tube->shear)
                add_rotary(eq, scene, point);
        }
    }
    if (is_shortened(scene))
        add_shortened(eq, scene);
}

// Points that have mass, mass centre c and inertia J (about it) of a rigid body: a pair at c +- h u
// with weights g/(2 h^2) for every direction u of J's dyads sum g u u^T = tr(J)/2 E - J, the rest
// at c. Weights may be negative.
static void add_rigid(equations *eq, const jet_frame *body, double mass, const double c[3],
                      const double J[3], const double products[3], double gravity)
{
    static const double u[6][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1},
                                   {1, 1, 0}, {1, 0, 1}, {0, 1, 1}};
    const double arm = 0.5, half = 0.5 * (J[0] + J[1] + J[2]);
    double xy = -products[0], xz = -products[1], yz = -products[2];
    double g[6] = {half - J[0] - xy - xz, half - J[1] - xy - yz, half - J[2] - xz - yz, xy, xz, yz};
    double rest = mass;
    for (int i = 0; i < 6; i++)
        for (int side = -1; side <= 1; side += 2) {
            double at[3], weight = g[i] / (2 * arm * arm);
            if (weight == 0)
                continue;
            for (int k = 0; k < 3; k++)
                at[k] = c[k] + side * arm * u[i][k];
            jet3 local = jet3_constant(at), p = point_in(body, &local);
            add_mass(eq, &p, weight, gravity);
            rest -= weight;
        }
    jet3 local = jet3_constant(c), p = point_in(body, &local);
    add_mass(eq, &p, rest, gravity);
}

// Bending in each plane, then torsion and stretch, whose modes have frequencies of their own.
static void add_modes(equations *eq, const jet_scene *scene)
{
    const dense_launch *dense = scene->dense;
    const flexible_tube *tube = dense->tube;
    const double *state_q = scene->state->q, *state_rate = scene->state->q_dot;
    for (int plane = 0; plane < 2; plane++)
        for (int i = 0; i < tube->nb; i++) {
            int at = plane * tube->nb;
            double spring = 0, damper = 0;
            for (int j = 0; j < tube->nb; j++) {
                spring += dense->K[plane][i][j] * state_q[at + j];
                damper += dense->D[plane][i][j] * state_rate[at + j];
            }
            eq->h[6 + at + i] -= spring + damper;
            eq->other[6 + at + i] -= damper;
            eq->potential += 0.5 * spring * state_q[at + i];
        }
    const double *om2[2] = {tube->om2_t, tube->om2_a}, *dmp[2] = {tube->dmp_t, tube->dmp_a};
    int count[2] = {tube->nt, tube->na}, k = 2 * tube->nb;
    for (int part = 0; part < 2; part++)
        for (int m = 0; m < count[part]; m++, k++) {
            eq->h[6 + k] -= om2[part][m] * state_q[k] + dmp[part][m] * state_rate[k];
            eq->other[6 + k] -= dmp[part][m] * state_rate[k];
            eq->potential += 0.5 * om2[part][m] * state_q[k] * state_q[k];
        }
}

// Vector w of the skew matrix D A^T, D a derivative of A: entries of the derivative by `of`.
static void skew_of(double w[3], const jet33 *A, double (*of)(const jet *, int), int index)
{
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        w[i] = 0;
        for (int l = 0; l < 3; l++)
            w[i] += 0.5 *
                    (of(&A->c[k][l], index) * A->c[j][l].v - of(&A->c[j][l], index) * A->c[k][l].v);
    }
}

static double part_rate(const jet *a, int index)
{
    (void)index;
    return a->e;
}

static double part_coordinate(const jet *a, int index)
{
    return a->n ? a->d[index] : 0;
}

// A moment m (in the coordinates that A turns into) on the body with axes A.
static void add_moment(double *h, int n, const jet33 *A, const double m[3])
{
    for (int k = 0; k < n; k++) {
        double w[3];
        skew_of(w, A, part_coordinate, k);
        h[k] += w[0] * m[0] + w[1] * m[1] + w[2] * m[2];
    }
}

// Rotation vector of A: its skew part times angle/sin(angle), a series in (1 - cos(angle))/2.
static jet3 rotation_vector_of(const jet33 *A)
{
    jet trace = jet_add(jet_add(A->c[0][0], A->c[1][1]), A->c[2][2]);
    jet x = jet_scale(0.25, jet_sub(jet_constant(3), trace));
    // arcsin(z)/(z sqrt(1 - z^2)) = sum a_k x^k, x = z^2, a_(k+1)/a_k = 2 (k + 1)/(2 k + 3)
    double a = 1, f = 0, f1 = 0, f2 = 0, power = 1, power1 = 0, power2 = 0;
    for (int k = 0; k < 200 && a * fabs(power) + a * fabs(power2) > 1e-25; k++) {
        f += a * power;
        f1 += a * power1;
        f2 += a * power2;
        power2 = (k + 1) * power1;
        power1 = (k + 1) * power;
        power *= x.v;
        a *= 2.0 * (k + 1) / (2 * k + 3);
    }
    jet factor = jet_apply(x, f, f1, f2);
    jet3 phi;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        phi.c[i] = jet_mul(factor, jet_scale(0.5, jet_sub(A->c[k][j], A->c[j][k])));
    }
    return phi;
}

// The base's frame with its rates, as given functions of time.
static jet_frame base_frame(const dense_base *base)
{
    jet_frame frame;
    for (int i = 0; i < 3; i++) {
        frame.r.c[i] = jet_constant(base->r[i]);
        frame.r.c[i].t = frame.r.c[i].e = base->v[i];
        frame.r.c[i].te = base->a[i];
        int k = (i + 1) % 3, l = (i + 2) % 3;
        for (int j = 0; j < 3; j++) {
            frame.A.c[i][j] = jet_constant(base->A[i][j]);
            frame.A.c[i][j].t = frame.A.c[i][j].e =
                base->w[k] * base->A[l][j] - base->w[l] * base->A[k][j];
        }
    }
    // A'' = alpha x A + w x A'
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int k = (i + 1) % 3, l = (i + 2) % 3;
            frame.A.c[i][j].te = base->alpha[k] * base->A[l][j] - base->alpha[l] * base->A[k][j] +
                                 base->w[k] * frame.A.c[l][j].t - base->w[l] * frame.A.c[k][j].t;
        }
    return frame;
}

// A^T a of a matrix by rows
static void turn_back(double out[3], const double *A, const double a[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = A[i] * a[0] + A[3 + i] * a[1] + A[6 + i] * a[2];
}

// A a
static void turn(double out[3], const double *A, const double a[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = A[3 * i] * a[0] + A[3 * i + 1] * a[1] + A[3 * i + 2] * a[2];
}

// Opposite of all support forces on the tube: generalised forces of R's place (in I) and turning
// (in R), which move the sections as one rigid body.
static void react_on_base(const jet_scene *scene, const dense_base *base, const double *support,
                          dense_launch_output *output)
{
    const dense_state *state = scene->state;
    double moment[3], force[3];
    turn(moment, state->A_R[0], support + 3);
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        force[i] = -support[i];
        moment[i] +=
            (state->r[j] - base->r[j]) * support[k] - (state->r[k] - base->r[k]) * support[j];
        moment[i] = -moment[i];
    }
    turn_back(output->base_force, base->A[0], force);
    turn_back(output->base_moment, base->A[0], moment);
}

// Parts of a slide's force along the base's x: that with a potential, and what rubs.
typedef struct slide_parts {
    double spring, loss, energy;
} slide_parts;

// A stop pressed in by p, growing at p_dot, that pushes towards `side`; `held`: whether it does, as
// in dense_conditions. Returns what is positive where it pushes [N].
static double add_stop(const ld_support *support, double p, double p_dot, double side, int held,
                       slide_parts *parts)
{
    double elastic = support->stiffness[0] * p, damped = support->damping[0] * p_dot;
    double press = fmin(elastic, elastic + damped);
    bool pushes = held ? held > 0 : press > 0;
    if (pushes || p > 0) {
        parts->spring += side * elastic;
        parts->loss += side * (pushes ? damped : -elastic);
        parts->energy += 0.5 * elastic * p;
    }
    return press;
}

// Recoil slide i at d (its stretch along the base's x), whose derivatives are the direction of its
// force.
static void add_slide(equations *eq, const ld_support *support, int i, const jet *d,
                      const dense_conditions *on, double *force, dense_launch_output *output)
{
    const ld_recoil *slide = &support->recoil;
    double x = d->v, v = d->e, *press = output->slide_press[i];
    slide_parts parts = {.spring = slide->preload, .energy = -slide->preload * x};
    if (x < 0) {
        parts.spring -= slide->stiffness * x;
        parts.energy += 0.5 * slide->stiffness * x * x;
    }
    press[0] = add_stop(support, x, v, -1, on->slide_stop[i][0], &parts);
    press[1] = isnan(slide->stroke)
                   ? -1
                   : add_stop(support, -x - slide->stroke, -v, 1, on->slide_stop[i][1], &parts);
    parts.loss -= (slide->damping + slide->quadratic_damping * fabs(v)) * v;
    if (!eq->frictionless)
        parts.loss -= slide->friction * v / hypot(v, slide->friction_speed);
    for (int k = 0; k < eq->n; k++) {
        force[k] += (parts.spring + parts.loss) * d->d[k];
        eq->other[k] += parts.loss * d->d[k];
    }
    eq->potential += parts.energy;
    output->slide_force += parts.spring + parts.loss;
}

// Holds what x is at no acceleration, by a force along its gradient.
static void hold(equations *eq, int row, const jet *x)
{
    eq->active[row] = true;
    memcpy(eq->C[row], x->d, (size_t)eq->n * sizeof *x->d);
    memcpy(eq->G[row], x->d, (size_t)eq->n * sizeof *x->d);
    eq->rhs[row] = -x->te;
}

static void add_supports(equations *eq, const jet_scene *scene, const dense_conditions *on,
                         dense_launch_output *output)
{
    const ld_tubes *tubes = &scene->dense->model->tubes;
    double force[DENSE_MAX_COORDINATES] = {0};
    jet_frame base = base_frame(&on->base);
    jet33 to_base = jet33_transpose(&base.A);
    int row = CLAMPED;
    for (int i = 0; i < tubes->support_count; i++) {
        const ld_support *support = &tubes->support[i];
        jet_frame section = tube_section_in_I(scene, support->at);
        jet3 d = seen_from(&base, &section.r);
        d.c[0] = jet_sub(d.c[0], jet_constant(support->at));
        jet33 turn = jet33_mul(&to_base, &section.A);
        jet3 phi = rotation_vector_of(&turn);
        double w[3], moment[3];
        skew_of(w, &turn, part_rate, 0);
        for (int a = 0; a < 3; a++) {
            if (support->clamped >> a & 1)
                hold(eq, row++, &d.c[a]);
            if (support->clamped >> (3 + a) & 1)
                hold(eq, row++, &phi.c[a]);
            // springs from their potential 1/2 K d^2 + 1/2 K_r phi^2, dampers from their rates
            bool slides = a == 0 && support->recoil.present;
            bool held = support->clamped >> a & 1, free = !(support->clamped >> (3 + a) & 1);
            bool none = slides || held || isnan(support->stiffness[a]);
            double spring = none ? 0 : support->stiffness[a] * d.c[a].v;
            double damper = slides || held ? 0 : support->damping[a] * d.c[a].e;
            double coil = free ? support->rotational_stiffness[a] * phi.c[a].v : 0;
            if (slides)
                add_slide(eq, support, i, &d.c[0], on, force, output);
            moment[a] = free ? -support->rotational_damping[a] * w[a] : 0;
            for (int k = 0; k < eq->n; k++) {
                force[k] -= spring * d.c[a].d[k] + coil * phi.c[a].d[k] + damper * d.c[a].d[k];
                eq->other[k] -= damper * d.c[a].d[k];
            }
            eq->potential += 0.5 * (spring * d.c[a].v + coil * phi.c[a].v);
        }
        add_moment(force, eq->n, &turn, moment);
        add_moment(eq->other, eq->n, &turn, moment);
    }
    for (int k = 0; k < eq->n; k++)
        eq->h[k] += force[k];
    memcpy(eq->support, force, sizeof force);
}

// A force f (in I) on the rocket at a place of I, opposite on the section at station s, same place.
static void add_pair(double *h, const jet_scene *scene, const jet_frame *section,
                     const double place[3], const double f[3])
{
    jet3 at = jet3_constant(place);
    jet3 in_B = seen_from(&scene->B, &at), in_S = seen_from(section, &at);
    for (int i = 0; i < 3; i++) {
        in_B.c[i] = jet_constant(in_B.c[i].v);
        in_S.c[i] = jet_constant(in_S.c[i].v);
    }
    jet3 on_rocket = point_in(&scene->B, &in_B), on_tube = point_in(section, &in_S);
    double opposite[3] = {-f[0], -f[1], -f[2]};
    add_force(h, &on_rocket, f);
    add_force(h, &on_tube, opposite);
}

// Velocity of the rocket less that of the section's material at a place of I, both moved rigidly.
static void slip_at(double slip[3], const jet_scene *scene, const jet_frame *section,
                    const double place[3])
{
    jet3 at = jet3_constant(place);
    jet3 in_B = seen_from(&scene->B, &at), in_S = seen_from(section, &at);
    for (int i = 0; i < 3; i++) {
        in_B.c[i] = jet_constant(in_B.c[i].v);
        in_S.c[i] = jet_constant(in_S.c[i].v);
    }
    jet3 on_rocket = point_in(&scene->B, &in_B), on_tube = point_in(section, &in_S);
    for (int i = 0; i < 3; i++)
        slip[i] = on_rocket.c[i].e - on_tube.c[i].e;
}

static double normal_force(const ld_contact *contact, double p, double p_dot, double touch_speed)
{
    if (contact->law == LD_CONTACT_KELVIN_VOIGT || contact->law == LD_CONTACT_BILATERAL)
        return fmax(0, contact->stiffness * p + contact->damping * p_dot);
    double e = contact->restitution, v_0 = contact->reference_speed;
    double chi = 1.5 * (1 - e) / v_0;
    if (contact->law == LD_CONTACT_LANKARANI_NIKRAVESH)
        chi = 0.75 * (1 - e * e) / (touch_speed > 0 ? touch_speed : v_0);
    double d_0 = contact->reference_penetration;
    return contact->stiffness * d_0 * pow(p / d_0, contact->exponent) * fmax(0, 1 + chi * p_dot);
}

static void add_adaptor(equations *eq, const jet_scene *moving, const jet_scene *still,
                        const dense_conditions *on, int index, double guess,
                        dense_launch_output *output)
{
    const ld_model *model = moving->dense->model;
    const ld_adaptor *adaptor = &model->rocket.adaptor[index];
    const ld_contact *law = &model->rocket.contact;
    double bore = model->tubes.section[0].bore_radius;
    // foot, offset from the axis, penetration
    jet3 center = jet3_constant((double[]){adaptor->at, 0, 0});
    center = point_in(&moving->B, &center);
    jet s = foot_of(moving, still, &center, guess);
    jet_frame section = section_in_I(moving, s);
    jet3 offset = seen_from(&section, &center);
    double y = offset.c[1].v, z = offset.c[2].v, distance = hypot(y, z);
    double rate = distance > 0 ? (y * offset.c[1].e + z * offset.c[2].e) / distance : 0;
    double p = distance - adaptor->clearance, normal = 0, f[3] = {0}, place[3], axis[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            axis[i][j] = section.A.c[i][j].v;
    jet_frame material = section_in_I(moving, jet_constant(s.v));
    bool inside = !on->passed[index];
    if (inside && law->law == LD_CONTACT_IDEAL) {
        hold(eq, HELD + 2 * index, &offset.c[1]);
        hold(eq, HELD + 2 * index + 1, &offset.c[2]);
    } else if (inside && law->law == LD_CONTACT_BILATERAL) {
        double f_y = -law->stiffness * y - law->damping * offset.c[1].e;
        double f_z = -law->stiffness * z - law->damping * offset.c[2].e;
        normal = hypot(f_y, f_z);
        for (int i = 0; i < 3; i++) {
            f[i] = axis[i][1] * f_y + axis[i][2] * f_z;
            place[i] = center.c[i].v;
        }
    } else if (inside && p > 0 && distance > 0) {
        normal = normal_force(law, p, rate, on->touch_speed[index]);
        double out[3], slip[3], v_t[3], along = 0, square = 0;
        for (int i = 0; i < 3; i++) {
            out[i] = (axis[i][1] * y + axis[i][2] * z) / distance;
            place[i] = section.r.c[i].v + out[i] * bore;
        }
        slip_at(slip, moving, &material, place);
        for (int i = 0; i < 3; i++)
            along += slip[i] * out[i];
        for (int i = 0; i < 3; i++) {
            v_t[i] = slip[i] - along * out[i];
            square += v_t[i] * v_t[i];
        }
        double mu = on->frictionless ? 0 : law->friction;
        double drag = mu * normal / sqrt(square + law->friction_speed * law->friction_speed);
        for (int i = 0; i < 3; i++)
            f[i] = -normal * out[i] - drag * v_t[i];
    }
    if (normal != 0) {
        add_pair(eq->h, moving, &material, place, f);
        add_pair(eq->other, moving, &material, place, f);
    }
    output->contact[index].s = s.v;
    output->contact[index].penetration = p;
    output->contact[index].penetration_rate = rate;
    output->contact[index].normal = normal;
    memcpy(output->contact[index].force, f, sizeof f);
}

// How much of a generalised force h is a force on the rocket (in I) and a moment about `center`.
static void wrench_on_rocket(const jet_scene *scene, const double *h, const double center[3],
                             double force[3], double moment[3])
{
    int first = scene->n - 6;
    const dense_state *state = scene->state;
    turn(moment, state->A_B[0], h + first + 3); // about O1
    for (int i = 0; i < 3; i++)
        force[i] += h[first + i];
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        moment[i] -= (center[j] - state->r_O1[j]) * h[first + k] -
                     (center[k] - state->r_O1[k]) * h[first + j];
    }
}

// Friction of a surface that presses with `normal` where its point W, given in the section, is.
static void add_rubbing(equations *eq, const jet_scene *scene, const jet_frame *material,
                        const double W[3], double angle, double normal)
{
    const ld_contact *law = &scene->dense->model->rocket.contact;
    double place[3], slip[3], out[3], along = 0, square = 0, f[3];
    for (int i = 0; i < 3; i++) {
        place[i] = material->r.c[i].v;
        for (int j = 0; j < 3; j++)
            place[i] += material->A.c[i][j].v * W[j];
        out[i] = material->A.c[i][1].v * cos(angle) + material->A.c[i][2].v * sin(angle);
    }
    slip_at(slip, scene, material, place);
    for (int i = 0; i < 3; i++)
        along += slip[i] * out[i];
    for (int i = 0; i < 3; i++) {
        f[i] = slip[i] - along * out[i];
        square += f[i] * f[i];
    }
    double drag =
        -law->friction * normal / sqrt(square + law->friction_speed * law->friction_speed);
    for (int i = 0; i < 3; i++)
        f[i] *= drag;
    add_pair(eq->h, scene, material, place, f);
    add_pair(eq->other, scene, material, place, f);
}

// One surface of a shoe whose centre's foot is the section at s: the penetration is written as a
// function of the coordinates, and the normal force does the work -F_n dp.
static void add_surface(equations *eq, const jet_scene *scene, const dense_conditions *on,
                        int index, jet s, dense_launch_output *output)
{
    const dense_launch *dense = scene->dense;
    const dense_surface *surface = &dense->surface[index];
    const ld_model *model = dense->model;
    double n_y = cos(surface->normal), n_z = sin(surface->normal);
    double from_line[2] = {surface->round ? 0 : surface->y, surface->round ? 0 : surface->z};
    jet3 local = jet3_constant(
        (double[]){model->rocket.adaptor[surface->shoe].at, from_line[0], from_line[1]});
    jet3 point = point_in(&scene->B, &local);
    jet_frame section = section_in_I(scene, s);
    jet3 there = seen_from(&section, &point);
    jet delta[2];
    for (int i = 0; i < 2; i++)
        delta[i] = jet_sub(there.c[1 + i], jet_constant(dense->line[i] + from_line[i]));
    jet p = jet_add(jet_scale(n_y, delta[0]), jet_scale(n_z, delta[1]));
    p.v -= surface->gap;
    output->surface[index].penetration = p.v;
    output->surface[index].penetration_rate = p.e;
    if (on->passed[surface->shoe] || p.v <= 0)
        return;
    double normal = normal_force(&model->rocket.contact, p.v, p.e, on->surface_touch_speed[index]);
    output->surface[index].normal = normal;
    for (int k = 0; k < eq->n; k++) {
        eq->h[k] -= normal * p.d[k];
        eq->other[k] -= normal * p.d[k];
    }
    if (on->frictionless)
        return;
    double sideways = surface->round ? -n_z * delta[0].v + n_y * delta[1].v : 0;
    double W[3] = {0, dense->line[0] + surface->y - n_z * sideways,
                   dense->line[1] + surface->z + n_y * sideways};
    jet_frame material = section_in_I(scene, jet_constant(s.v));
    add_rubbing(eq, scene, &material, W, surface->normal, normal);
}

// All surfaces of a shoe.
static void add_shoe(equations *eq, const jet_scene *moving, const jet_scene *still,
                     const dense_conditions *on, int index, double guess,
                     dense_launch_output *output)
{
    const dense_launch *dense = moving->dense;
    double before[DENSE_MAX_COORDINATES], C[3];
    jet3 center = jet3_constant((double[]){dense->model->rocket.adaptor[index].at, 0, 0});
    center = point_in(&moving->B, &center);
    jet s = foot_of(moving, still, &center, guess);
    memcpy(before, eq->h, sizeof before);
    output->contact[index].s = s.v;
    output->contact[index].penetration = -INFINITY;
    for (int k = 0; k < dense->surface_count; k++) {
        if (dense->surface[k].shoe != index)
            continue;
        add_surface(eq, moving, on, k, s, output);
        output->contact[index].normal += output->surface[k].normal;
        if (output->surface[k].penetration > output->contact[index].penetration) {
            output->contact[index].penetration = output->surface[k].penetration;
            output->contact[index].penetration_rate = output->surface[k].penetration_rate;
        }
    }
    for (int i = 0; i < 3; i++)
        C[i] = center.c[i].v;
    for (int k = 0; k < eq->n; k++)
        before[k] = eq->h[k] - before[k];
    wrench_on_rocket(moving, before, C, output->contact[index].force,
                     output->contact[index].moment);
}

// A stop at the breech's station for O1, which is at station s: along e_x of the section at s.
static void add_breech(equations *eq, const jet_scene *scene, const dense_conditions *on, jet s,
                       dense_launch_output *output)
{
    if (on->locked || s.v >= on->breech)
        return;
    jet_frame here = section_in_I(scene, jet_constant(s.v));
    jet_frame stop = section_in_I(scene, jet_constant(on->breech));
    double place[3], f[3],
        force = normal_force(&scene->dense->model->rocket.contact, on->breech - s.v, -s.e,
                             on->breech_speed);
    for (int i = 0; i < 3; i++) {
        place[i] = scene->B.r.c[i].v;
        f[i] = force * here.A.c[i][0].v;
    }
    add_pair(eq->h, scene, &stop, place, f);
    add_pair(eq->other, scene, &stop, place, f);
    output->breech_force = force;
}

// Net pressure [Pa] over the travel, or of gas that expands; a table over travel of two rows.
static double gas_pressure(const ld_pressure *given, double area, double travel)
{
    if (given->form == LD_PRESSURE_OF_GAS)
        return given->scale * given->pressure *
                   exp(-given->exponent * log1p(area * travel / given->volume)) -
               given->ambient;
    const double *row = given->over_travel.data;
    double share = travel / row[2];
    return given->scale * ((1 - share) * row[1] + share * row[3]) - given->ambient;
}

// On the rocket at O1, along x of the section at its station s; on the tube's rear against its x.
static void add_gas(equations *eq, const jet_scene *scene, const dense_conditions *on,
                    const jet_frame *rear, double s, dense_launch_output *output)
{
    const ld_model *model = scene->dense->model;
    const ld_pressure *given = &model->tubes.pressure;
    if (!given->present || !on->pressed || on->passed[0])
        return;
    double area = acos(-1) * pow(model->tubes.section[0].bore_radius, 2);
    double travel = s - model->rocket.start_at, forwards[3], back[3];
    double p = given->form == LD_PRESSURE_OVER_TIME
                   ? on->pressure
                   : gas_pressure(given, area, travel > 0 ? travel : 0);
    jet_frame here = section_in_I(scene, jet_constant(s));
    for (int i = 0; i < 3; i++) {
        forwards[i] = p * area * here.A.c[i][0].v;
        back[i] = -p * area * rear->A.c[i][0].v;
    }
    add_force(eq->h, &scene->B.r, forwards);
    add_force(eq->other, &scene->B.r, forwards);
    add_force(eq->h, &rear->r, back);
    add_force(eq->other, &rear->r, back);
    output->gas_force = p * area;
}

static void add_thrust(equations *eq, const jet_scene *scene, double thrust, const double across[6])
{
    const double e_y = across[2], e_z = across[3];
    double direction[3] = {1, e_y, e_z}, norm = sqrt(1 + e_y * e_y + e_z * e_z), f[3];
    for (int i = 0; i < 3; i++) {
        f[i] = across[0] * scene->B.A.c[i][1].v + across[1] * scene->B.A.c[i][2].v;
        for (int j = 0; j < 3; j++)
            f[i] += thrust * scene->B.A.c[i][j].v * direction[j] / norm;
    }
    double place[3] = {scene->dense->model->rocket.motor.at[0], across[4], across[5]};
    jet3 at = jet3_constant(place), point = point_in(&scene->B, &at);
    add_force(eq->h, &point, f);
    add_force(eq->other, &point, f);
}

static void add_further_thrust(equations *eq, const jet_scene *scene, const dense_conditions *on)
{
    for (int k = 0; k < LD_MAX_FURTHER_MOTORS; k++) {
        jet3 at = jet3_constant(on->further[k].at), point = point_in(&scene->B, &at);
        double f[3] = {0};
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                f[i] += scene->B.A.c[i][j].v * on->further[k].force[j];
        add_force(eq->h, &point, f);
        add_force(eq->other, &point, f);
    }
}

// The air on what lies between the tip and the nose, by Simpson's rule: the force per length goes
// with the lateral velocity of a point against the air, which is linear along the rocket. Put on at
// O1 and at a point one metre before it, so that force and moment are right.
static void add_crossflow(equations *eq, const jet_scene *scene, const dense_conditions *on,
                          double s, dense_launch_output *output)
{
    const ld_aerodynamics *air = &scene->dense->model->rocket.aerodynamics;
    double from = scene->dense->model->tubes.length - s, length = air->emerged.nose - from;
    if (!air->present || !air->emerged.present || length <= 0)
        return;
    enum { STRETCHES = 4000 };
    jet3 one = jet3_constant((double[]){1, 0, 0}), ahead = point_in(&scene->B, &one);
    double per_length = 0.5 * on->density * air->emerged.drag * air->emerged.diameter;
    double force[3] = {0}, moment[3] = {0};
    for (int k = 0; k <= STRETCHES; k++) {
        double x = from + length * k / STRETCHES, along = 0, v[3];
        double weight = (k == 0 || k == STRETCHES ? 1 : k % 2 ? 4 : 2) * length / (3 * STRETCHES);
        for (int i = 0; i < 3; i++) {
            v[i] = (1 - x) * scene->B.r.c[i].e + x * ahead.c[i].e - on->air[i];
            along += v[i] * scene->B.A.c[i][0].v;
        }
        for (int i = 0; i < 3; i++)
            v[i] -= along * scene->B.A.c[i][0].v;
        double speed = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        for (int i = 0; i < 3; i++) {
            force[i] -= weight * per_length * speed * v[i];
            moment[i] -= weight * per_length * speed * v[i] * x;
        }
    }
    double rest[3];
    for (int i = 0; i < 3; i++)
        rest[i] = force[i] - moment[i];
    add_force(eq->h, &scene->B.r, rest);
    add_force(eq->h, &ahead, moment);
    add_force(eq->other, &scene->B.r, rest);
    add_force(eq->other, &ahead, moment);
    output->emerged = length;
    turn_back(output->crossflow, scene->state->A_R[0], force);
}

// The air on the guide's sections: a force per length by the velocity of the axis against the air,
// across the section's x axis, at the points at which the program takes it.
static void add_guide_wind(equations *eq, const jet_scene *scene, const dense_conditions *on,
                           dense_launch_output *output)
{
    const ld_tubes *tubes = &scene->dense->model->tubes;
    const double place = sqrt(0.6);
    double sum[3] = {0};
    for (int n = 0; n < tubes->wind_drag_count; n++) {
        const ld_wind_drag *one = &tubes->wind_drag[n];
        double share = (one->to - one->from) / tubes->length;
        int panels = (int)ceil(share * tubes->modes.bending), points = 3 * panels;
        for (int k = 0; k < points; k++) {
            double middle = k / 3 + 0.5, off = 0.5 * (k % 3 - 1) * place, v[3], along = 0, f[3];
            double at = one->from + (one->to - one->from) * (middle + off) / panels;
            double weight = (k % 3 == 1 ? 8 : 5) / 18.0 * (one->to - one->from) / panels;
            jet_frame section = tube_section_in_I(scene, at);
            for (int i = 0; i < 3; i++) {
                v[i] = on->air[i] - section.r.c[i].e;
                along += v[i] * section.A.c[i][0].v;
            }
            for (int i = 0; i < 3; i++)
                v[i] -= along * section.A.c[i][0].v;
            double speed = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
            for (int i = 0; i < 3; i++) {
                f[i] = 0.5 * on->density * speed * v[i] * one->coefficient * one->width * weight;
                sum[i] += f[i];
            }
            add_force(eq->h, &section.r, f);
            add_force(eq->other, &section.r, f);
        }
    }
    turn_back(output->guide_wind, scene->state->A_R[0], sum);
}

// What is fixed to the section at x.
static void add_push(equations *eq, const jet_scene *scene, double x, const double at[3],
                     const double force[3])
{
    jet_frame section = tube_section_in_I(scene, x);
    jet3 local = jet3_constant(at), point = point_in(&section, &local);
    double f[3] = {0};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            f[i] += section.A.c[i][j].v * force[j];
    add_force(eq->h, &point, f);
    add_force(eq->other, &point, f);
}

// The deflector is on the tail, where it is behind the rear end.
static void add_guide_jet(equations *eq, const jet_scene *scene, const dense_conditions *on)
{
    const double *behind = on->deflector_at;
    add_push(eq, scene, scene->dense->model->tubes.length, on->jet_face_at, on->jet_face);
    if (behind[0] < 0)
        add_push(eq, scene, 0, behind, on->deflector);
    else
        add_push(eq, scene, behind[0], (double[]){0, behind[1], behind[2]}, on->deflector);
}

// On an open guide: the air of the flight's own equations (support/dense_flight.c) on the rocket.
static void add_open_air(equations *eq, const jet_scene *scene, const dense_conditions *on,
                         dense_launch_output *output)
{
    const ld_model *model = scene->dense->model;
    const dense_state *state = scene->state;
    if (!model->tubes.guide.present || !model->rocket.aerodynamics.present)
        return;
    jet3 c = jet3_constant(on->center), center = point_in(&scene->B, &c);
    double slip[3], v[3], f[3], m[3];
    for (int i = 0; i < 3; i++)
        slip[i] = center.c[i].e - on->air[i];
    turn_back(v, state->A_B[0], slip);
    dense_wrench air = dense_air(model, on->power, v3_from(on->center), v3_from(v),
                                 v3_from(state->w_B), on->density, on->sound);
    turn(f, state->A_B[0], (double[]){air.f.x, air.f.y, air.f.z});
    turn(m, state->A_B[0], (double[]){air.m.x, air.m.y, air.m.z});
    double *const on_speeds[2] = {eq->h, eq->other};
    for (int i = 0; i < 2; i++) { // the last three speeds are the rocket's rate in B
        add_force(on_speeds[i], &center, f);
        on_speeds[i][eq->n - 3] += air.m.x;
        on_speeds[i][eq->n - 2] += air.m.y;
        on_speeds[i][eq->n - 1] += air.m.z;
    }
    turn_back(output->air_force, state->A_R[0], f);
    turn_back(output->air_moment, state->A_R[0], m);
}

// The slot's angle at s and its slope: linear between the table's points, constant outside.
static double slot_angle(const ld_table *table, int piece, double s, double *slope)
{
    const double *row = table->data;
    int last = (int)table->rows;
    if (piece == 0)
        for (piece = 1; piece <= last && s >= row[2 * (piece - 1)]; piece++)
            ;
    *slope = 0;
    if (piece == 1 || piece > last)
        return row[piece == 1 ? 1 : 2 * last - 1];
    row += 2 * (piece - 2);
    *slope = (row[3] - row[1]) / (row[2] - row[0]);
    return row[1] + *slope * (s - row[0]);
}

static void add_slot(equations *eq, const jet_scene *scene, const dense_conditions *on, jet s,
                     dense_launch_output *output)
{
    const ld_model *model = scene->dense->model;
    const ld_slot *slot = &model->tubes.slot;
    double knob = model->rocket.knob_angle, slope;
    jet3 E_B = jet3_constant((double[]){0, slot->radius * cos(knob), slot->radius * sin(knob)});
    // knob E seen from the section at s, and the tube's material there
    jet3 E = point_in(&scene->B, &E_B);
    jet_frame section = section_in_I(scene, s), material = section_in_I(scene, jet_freeze(s));
    jet3 r_E = seen_from(&section, &E), frozen = jet3_freeze(r_E);
    jet3 tube = point_in(&material, &frozen), v_rel = jet3_sub(&E, &tube);
    // directions across and along the slot, in the section, then in I
    double value = slot_angle(&slot->angle, on->slot_piece, s.v, &slope);
    jet alpha = jet_apply(s, value, slope, 0), sine = jet_sin(alpha), cosine = jet_cos(alpha);
    jet radius = jet_add(jet_mul(r_E.c[1], r_E.c[1]), jet_mul(r_E.c[2], r_E.c[2]));
    jet inverse = jet_inverse(jet_sqrt(radius));
    jet t_y = jet_scale(-1, jet_mul(r_E.c[2], inverse)), t_z = jet_mul(r_E.c[1], inverse);
    jet3 n = {{jet_scale(-1, sine), jet_mul(cosine, t_y), jet_mul(cosine, t_z)}};
    jet3 tau = {{cosine, jet_mul(sine, t_y), jet_mul(sine, t_z)}};
    n = jet33_turn(&section.A, &n);
    tau = jet33_turn(&section.A, &tau);
    // n . v_rel = 0 and its derivative in time
    double along = 0, place[3], direction[3], drag[3], drift = 0;
    eq->active[SLOT] = true;
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < eq->n; k++)
            eq->C[SLOT][k] += n.c[i].v * v_rel.c[i].d[k];
        eq->rhs[SLOT] -= n.c[i].v * v_rel.c[i].te + n.c[i].t * v_rel.c[i].e;
        drift += n.c[i].v * v_rel.c[i].e;
        along += tau.c[i].v * v_rel.c[i].e;
    }
    // forces at E
    double v_eps = model->rocket.contact.friction_speed;
    double w = along / sqrt(along * along + v_eps * v_eps);
    double mu = on->frictionless || on->locked ? 0 : slot->friction;
    for (int i = 0; i < 3; i++) {
        place[i] = E.c[i].v;
        direction[i] = n.c[i].v;
        drag[i] = -mu * w * tau.c[i].v;
    }
    jet_frame fixed = section_in_I(scene, jet_constant(s.v));
    add_pair(eq->G[SLOT], scene, &fixed, place, direction);
    if (mu != 0)
        add_pair(eq->drag, scene, &fixed, place, drag);
    output->slot_drift = drift;
}

// Where the rocket is relative to the section at s, and how it turns there.
static void write_relative(const jet_scene *scene, jet s, dense_launch_output *output)
{
    jet_frame section = section_in_I(scene, s);
    jet3 offset = seen_from(&section, &scene->B.r);
    jet33 back = jet33_transpose(&section.A), Q = jet33_mul(&back, &scene->B.A);
    output->s = s.v;
    output->s_dot = s.e;
    output->y = offset.c[1].v;
    output->z = offset.c[2].v;
    // Rz(psi) Ry(theta) Rx(gamma)
    output->psi = atan2(Q.c[1][0].v, Q.c[0][0].v);
    output->theta = -asin(Q.c[2][0].v);
    output->gamma = atan2(Q.c[2][1].v, Q.c[2][2].v);
    skew_of(output->w_SB, &Q, part_rate, 0);
}

static void add_lock(equations *eq, const jet_scene *scene, jet s, bool holds_roll,
                     dense_launch_output *output)
{
    // e_x of S . v_rel = 0 at L, and its derivative in time; force along e_x of S at L
    const ld_lock *lock = &scene->dense->model->rocket.lock;
    double at[3] = {lock->x, lock->radius * cos(lock->angle), lock->radius * sin(lock->angle)};
    jet3 L_B = jet3_constant(at), L = point_in(&scene->B, &L_B);
    jet_frame fixed = section_in_I(scene, jet_constant(s.v));
    jet_frame section = section_in_I(scene, s), material = section_in_I(scene, jet_freeze(s));
    jet3 r_L = seen_from(&section, &L), frozen = jet3_freeze(r_L);
    jet3 tube = point_in(&material, &frozen), v_rel = jet3_sub(&L, &tube);
    double place[3], axis[3];
    eq->active[LOCK] = true;
    for (int i = 0; i < 3; i++) {
        const jet *e_x = &section.A.c[i][0];
        for (int k = 0; k < eq->n; k++)
            eq->C[LOCK][k] += e_x->v * v_rel.c[i].d[k];
        eq->rhs[LOCK] -= e_x->v * v_rel.c[i].te + e_x->t * v_rel.c[i].e;
        output->lock_drift += e_x->v * v_rel.c[i].e;
        place[i] = L.c[i].v;
        axis[i] = fixed.A.c[i][0].v;
    }
    add_pair(eq->G[LOCK], scene, &fixed, place, axis);
    if (!holds_roll)
        return;
    // rate about e_x of S of B against the tube there, on which the moment does no work: entry zy
    // of (Q e-derivative) Q^T, Q = A_SB
    jet33 back = jet33_transpose(&material.A), Q = jet33_mul(&back, &scene->B.A);
    eq->active[ROLL] = true;
    for (int l = 0; l < 3; l++) {
        const jet *y = &Q.c[1][l], *z = &Q.c[2][l];
        for (int k = 0; k < eq->n; k++)
            eq->C[ROLL][k] += z->d[k] * y->v;
        eq->rhs[ROLL] -= z->te * y->v + z->e * y->t;
        output->lock_roll += z->e * y->v;
    }
    double opposite[3] = {-axis[0], -axis[1], -axis[2]};
    add_moment(eq->G[ROLL], eq->n, &scene->B.A, axis);
    add_moment(eq->G[ROLL], eq->n, &fixed.A, opposite);
}

// Solves [M, -G; C, 0] for accelerations and multipliers, with the slot friction of sign(N) = sign.
static bool solve(const equations *eq, double sign, double x_ddot[], double multiplier[ROWS])
{
    enum { SIZE = DENSE_MAX_COORDINATES + ROWS };
    static _Thread_local double matrix[SIZE * SIZE], right[SIZE];
    lapack_int pivot[SIZE];
    int n = eq->n, row[ROWS], size = n;
    for (int c = 0; c < ROWS; c++)
        row[c] = eq->active[c] ? size++ : -1;
    memset(matrix, 0, sizeof matrix);
    // columns one after another
    for (int j = 0; j < n; j++)
        for (int k = 0; k <= j; k++)
            matrix[j * size + k] = matrix[k * size + j] = eq->M[j][k];
    memcpy(right, eq->h, (size_t)n * sizeof *right);
    for (int c = 0; c < ROWS; c++) {
        if (row[c] < 0)
            continue;
        for (int k = 0; k < n; k++) {
            matrix[row[c] * size + k] = -eq->G[c][k] - (c == SLOT ? sign * eq->drag[k] : 0);
            matrix[k * size + row[c]] = eq->C[c][k];
        }
        right[row[c]] = eq->rhs[c];
    }
    if (LAPACKE_dgesv(LAPACK_COL_MAJOR, size, 1, matrix, size, pivot, right, size) != 0)
        return false;
    memcpy(x_ddot, right, (size_t)n * sizeof *right);
    for (int c = 0; c < ROWS; c++)
        multiplier[c] = row[c] < 0 ? 0 : right[row[c]];
    return true;
}

// The same for the one sign of N that is consistent.
static bool solve_signed(const equations *eq, bool rubs, double x_ddot[], double multiplier[ROWS],
                         double *sign)
{
    *sign = 0;
    if (!rubs)
        return solve(eq, 0, x_ddot, multiplier);
    double x[2][DENSE_MAX_COORDINATES], l[2][ROWS];
    bool fits[2];
    for (int i = 0; i < 2; i++) {
        double trial = i == 0 ? 1 : -1;
        fits[i] = solve(eq, trial, x[i], l[i]) && trial * l[i][SLOT] >= 0;
    }
    int i = fits[0] ? 0 : 1;
    if (!fits[i] || (fits[0] && fits[1] && l[0][SLOT] != 0))
        return false;
    *sign = i == 0 ? 1 : -1;
    memcpy(x_ddot, x[i], (size_t)eq->n * sizeof *x_ddot);
    memcpy(multiplier, l[i], sizeof l[i]);
    return true;
}

static void write_output(const dense_launch *dense, const dense_state *state, const equations *eq,
                         const double x_ddot[], const double multiplier[ROWS], double sign,
                         dense_launch_output *output)
{
    int rocket = 6 + dense->mode_count;
    double alpha[3];
    turn_back(output->a, state->A_R[0], x_ddot);
    memcpy(output->w_dot, x_ddot + 3, sizeof output->w_dot);
    memcpy(output->q_ddot, x_ddot + 6, (size_t)dense->mode_count * sizeof *x_ddot);
    turn_back(output->a_O1, state->A_R[0], x_ddot + rocket);
    turn(alpha, state->A_B[0], x_ddot + rocket + 3);
    turn_back(output->alpha_B, state->A_R[0], alpha);
    output->lock_force = -multiplier[LOCK];
    output->slot_force = multiplier[SLOT];
    output->lock_moment = multiplier[ROLL];
    for (int i = 0; eq->active[HELD] && i < 2; i++)
        output->contact[i].normal = hypot(multiplier[HELD + 2 * i], multiplier[HELD + 2 * i + 1]);
    output->kinetic = eq->kinetic;
    output->potential = eq->potential;
    memcpy(output->momentum, eq->momentum, sizeof eq->momentum);
    memcpy(output->angular_momentum, eq->angular_momentum, sizeof eq->angular_momentum);
    output->power = 0;
    for (int k = 0; k < eq->n; k++) {
        double force = eq->other[k] + sign * multiplier[SLOT] * eq->drag[k];
        for (int c = 0; c < ROWS; c++)
            force += multiplier[c] * eq->G[c][k];
        output->power += force * eq->x_dot[k];
    }
}

// Drag of the guide on one adaptor, at its centre or amid the guide's surfaces.
// Of a table of two columns, linear, constant outside; 0 without rows.
static double in_table(const ld_table *table, double x)
{
    double value = table->rows ? table->data[1] : 0;
    for (size_t i = 1; i < table->rows; i++) {
        const double *a = table->data + 2 * (i - 1), *b = a + 2;
        value += (b[1] - a[1]) * fmin(1, fmax(0, (x - a[0]) / (b[0] - a[0])));
    }
    return value;
}

static void add_drag(equations *eq, const jet_scene *moving, const jet_scene *still,
                     const dense_conditions *on, int index, double rear)
{
    const dense_launch *dense = moving->dense;
    const ld_rocket *rocket = &dense->model->rocket;
    const ld_table *drag = &rocket->contact.drag, *by_speed = &rocket->contact.drag_over_speed;
    if (on->locked || on->frictionless || on->passed[index] || drag->rows + by_speed->rows == 0)
        return;
    jet3 center = jet3_constant((double[]){rocket->adaptor[index].at, 0, 0});
    center = point_in(&moving->B, &center);
    jet s = foot_of(moving, still, &center, rear + rocket->adaptor[index].at);
    jet_frame section = section_in_I(moving, jet_constant(s.v));
    double place[3], slip[3], W[2] = {0}, along = 0, f[3];
    int surfaces = dense->surface_count / rocket->adaptor_count;
    for (int k = 0; k < dense->surface_count; k++) {
        W[0] += dense->surface[k].shoe == index ? dense->surface[k].y / surfaces : 0;
        W[1] += dense->surface[k].shoe == index ? dense->surface[k].z / surfaces : 0;
    }
    for (int i = 0; i < 3; i++)
        place[i] = !surfaces ? center.c[i].v
                             : section.r.c[i].v + section.A.c[i][1].v * (dense->line[0] + W[0]) +
                                   section.A.c[i][2].v * (dense->line[1] + W[1]);
    slip_at(slip, moving, &section, place);
    for (int i = 0; i < 3; i++)
        along += slip[i] * section.A.c[i][0].v;
    double force = in_table(drag, rear - rocket->start_at) + in_table(by_speed, fabs(along));
    force *= rocket->contact.drag_scale / rocket->adaptor_count;
    for (int i = 0; i < 3; i++)
        f[i] = -force * along / hypot(along, rocket->contact.friction_speed) * section.A.c[i][0].v;
    add_pair(eq->h, moving, &section, place, f);
    add_pair(eq->other, moving, &section, place, f);
}

bool dense_launch_rates(const dense_launch *dense, const dense_state *state,
                        const dense_conditions *conditions, dense_rates *rates,
                        dense_launch_output *output)
{
    const ld_model *model = dense->model;
    const ld_rocket *rocket = &model->rocket;
    int n = dense->mode_count + 12;
    jet_scene moving, still;
    dense_launch_output own;
    output = output ? output : &own;
    memset(output, 0, sizeof *output);
    scene_set(&moving, dense, state, n);
    scene_set(&still, dense, state, 0);
    equations eq;
    memset(&eq, 0, sizeof eq);
    eq.n = n;
    eq.frictionless = conditions->frictionless;
    memcpy(eq.x_dot, state->v, sizeof state->v);
    memcpy(eq.x_dot + 3, state->w, sizeof state->w);
    memcpy(eq.x_dot + 6, state->q_dot, (size_t)dense->mode_count * sizeof *eq.x_dot);
    memcpy(eq.x_dot + n - 6, state->v_O1, sizeof state->v_O1);
    memcpy(eq.x_dot + n - 3, state->w_B, sizeof state->w_B);
    // masses
    static const double none[3] = {0, 0, 0};
    const ld_tail *tail = &model->tubes.tail;
    jet_frame rear = tube_section_in_I(&moving, 0);
    add_tube(&eq, &moving);
    add_rigid(&eq, &rear, tail->mass, (double[]){tail->center, 0, 0}, tail->inertia, none,
              model->gravity);
    add_rigid(&eq, &moving.B, conditions->mass, conditions->center, conditions->inertia,
              conditions->products, model->gravity);
    // forces
    add_modes(&eq, &moving);
    add_supports(&eq, &moving, conditions, output);
    for (int i = 0; i < rocket->adaptor_count; i++)
        (dense->surface_count ? add_shoe : add_adaptor)(&eq, &moving, &still, conditions, i,
                                                        state->s + rocket->adaptor[i].at, output);
    add_thrust(&eq, &moving, conditions->thrust, conditions->across);
    add_further_thrust(&eq, &moving, conditions);
    // constraints
    bool slotted = model->tubes.slot.kind == LD_SLOT_HELIX;
    jet s = foot_of(&moving, &still, &moving.B.r, state->s);
    for (int i = 0; i < rocket->adaptor_count; i++)
        add_drag(&eq, &moving, &still, conditions, i, s.v);
    add_breech(&eq, &moving, conditions, s, output);
    add_gas(&eq, &moving, conditions, &rear, s.v, output);
    add_crossflow(&eq, &moving, conditions, s.v, output);
    add_open_air(&eq, &moving, conditions, output);
    add_guide_wind(&eq, &moving, conditions, output);
    add_guide_jet(&eq, &moving, conditions);
    if (slotted)
        add_slot(&eq, &moving, conditions, s, output);
    if (conditions->locked)
        add_lock(&eq, &moving, s, dense_launch_holds_roll(dense), output);
    write_relative(&moving, s, output);
    double x_ddot[DENSE_MAX_COORDINATES], multiplier[ROWS], sign;
    bool rubs = slotted && !conditions->locked && !conditions->frictionless &&
                model->tubes.slot.friction != 0;
    if (!solve_signed(&eq, rubs, x_ddot, multiplier, &sign))
        return false;
    write_output(dense, state, &eq, x_ddot, multiplier, sign, output);
    for (int c = CLAMPED; c < ROWS; c++)
        for (int k = 0; k < n; k++)
            eq.support[k] += multiplier[c] * eq.G[c][k];
    react_on_base(&moving, &conditions->base, eq.support, output);
    if (rates) {
        memcpy(rates->x_ddot, x_ddot, sizeof rates->x_ddot);
        memcpy(rates->h, eq.h, sizeof rates->h);
        memcpy(rates->G, eq.G, sizeof rates->G);
    }
    return true;
}

// ---------------------------------------------------------------- relative input

static void matrix_of_quaternion(double A[3][3], const double q[4])
{
    double norm = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        A[i][i] = 1 - 2 * (q[1 + j] * q[1 + j] + q[1 + k] * q[1 + k]) / norm;
        A[j][i] = 2 * (q[1 + i] * q[1 + j] + q[0] * q[1 + k]) / norm;
        A[i][j] = 2 * (q[1 + i] * q[1 + j] - q[0] * q[1 + k]) / norm;
    }
}

// Rotation by `angle` about axis 0, 1 or 2.
static jet33 rotation_about(int axis, double angle)
{
    double th[3] = {0, 0, 0};
    th[axis] = angle;
    jet3 vector = jet3_constant(th);
    return rotation_of(&vector);
}

static void values3(double out[3], const jet3 *a)
{
    for (int i = 0; i < 3; i++)
        out[i] = a->c[i].v;
}

void dense_launch_place(const dense_launch *dense, const dense_launch_input *input,
                        dense_state *state)
{
    memset(state, 0, sizeof *state);
    memcpy(state->r, input->r, sizeof input->r);
    memcpy(state->w, input->w, sizeof input->w);
    memcpy(state->q, input->q, sizeof input->q);
    memcpy(state->q_dot, input->q_dot, sizeof input->q_dot);
    matrix_of_quaternion(state->A_R, input->quaternion);
    turn(state->v, state->A_R[0], input->v);
    state->s = input->s;
    // rocket: from the section's frame
    jet_scene still;
    scene_set(&still, dense, state, 0);
    jet_frame section = section_in_I(&still, jet_constant(input->s)), rocket;
    jet3 offset = jet3_constant((double[]){0, input->y, input->z});
    jet33 Z = rotation_about(2, input->psi), Y = rotation_about(1, input->theta);
    jet33 X = rotation_about(0, input->gamma), A_SB = jet33_mul(&Z, &Y);
    A_SB = jet33_mul(&A_SB, &X);
    rocket.r = point_in(&section, &offset);
    rocket.A = jet33_mul(&section.A, &A_SB);
    values3(state->r_O1, &rocket.r);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            state->A_B[i][j] = rocket.A.c[i][j].v;
    double w_B[3];
    turn(state->v_O1, state->A_R[0], input->V);
    turn(w_B, state->A_R[0], input->V + 3);
    turn_back(state->w_B, state->A_B[0], w_B);
}

// Pitch and yaw of a direction and their rates.
static void direction_angles(const jet3 *d, double *pitch, double *yaw, double *pitch_rate,
                             double *yaw_rate)
{
    double x = d->c[0].v, y = d->c[1].v, z = d->c[2].v, level = hypot(x, z);
    *pitch = atan2(y, level);
    *yaw = atan2(-z, x);
    *pitch_rate = d->c[1].e / level;
    *yaw_rate = (z * d->c[0].e - x * d->c[2].e) / (level * level);
}

void dense_launch_tip(const dense_launch *dense, const dense_state *state, const dense_base *base,
                      double tip[8])
{
    jet_scene moving;
    scene_set(&moving, dense, state, dense->mode_count + 12);
    jet_frame section = tube_section_in_I(&moving, dense->tube->length);
    jet_frame frame = base_frame(base);
    jet3 place = seen_from(&frame, &section.r), axis = jet33_column(&section.A, 0);
    axis = jet33_turn_back(&frame.A, &axis);
    tip[0] = place.c[1].v;
    tip[1] = place.c[2].v;
    tip[4] = place.c[1].e;
    tip[5] = place.c[2].e;
    direction_angles(&axis, &tip[2], &tip[3], &tip[6], &tip[7]);
}

bool dense_launch_evaluate(const dense_launch *dense, const dense_launch_input *input,
                           dense_launch_output *output)
{
    dense_state state;
    dense_launch_place(dense, input, &state);
    return dense_launch_rates(dense, &state, &input->conditions, NULL, output);
}
