#include "elements/guide/guide_cut.h"

#include <string.h>

#include "math/functions.h"

// ---- set-up ----

// Bending shapes among the functions.
static int bending_of(const flexible_tube *tube)
{
    return tube->overlap ? 2 * tube->nb : tube->nb;
}

static int functions_of(const flexible_tube *tube)
{
    return 2 + bending_of(tube) + tube->na;
}

// The f_k at a position of an element.
static void find_functions(const flexible_tube *tube, const tube_element *element, double x,
                           double *f)
{
    double xi = x - element->x0;
    f[0] = 1;
    f[1] = x;
    for (int j = 0; j < bending_of(tube); j++) {
        const double(*b)[LD_NB] = element->b[j / tube->nb];
        int k = j % tube->nb;
        f[2 + j] = b[0][k] + xi * (b[1][k] + xi * (b[2][k] + xi * b[3][k]));
    }
    for (int j = 0; j < tube->na; j++)
        f[2 + bending_of(tube) + j] = element->a[0][j] + xi * element->a[1][j];
}

static void add_mass(guide_cut *self, const flexible_tube *tube, const tube_element *element,
                     double x, double mass)
{
    int n = functions_of(tube);
    double f[GUIDE_FUNCTIONS];
    find_functions(tube, element, x, f);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            self->gram[i][j] += mass * f[i] * f[j];
}

static const ld_section *section_at(const ld_tubes *model, double x)
{
    int i = model->section_count - 1;
    while (i > 0 && model->section[i].from >= x)
        i--;
    return &model->section[i];
}

// Gauss with four points, exact for products of two cubics.
static void add_stretch(guide_cut *self, const flexible_tube *tube, const ld_section *section,
                        const tube_element *element, double from)
{
    static const double at[4] = {-0.86113631159405257522, -0.33998104358485626480,
                                 0.33998104358485626480, 0.86113631159405257522};
    static const double weight[4] = {0.34785484513745385737, 0.65214515486254614263,
                                     0.65214515486254614263, 0.34785484513745385737};
    double half = 0.5 * (element->x1 - from);
    for (int i = 0; i < 4; i++) {
        double x = from + half * (1 + at[i]), length = half * weight[i];
        add_mass(self, tube, element, x, section->mass_per_length * length);
        self->polar += section->polar_inertia * length;
        for (int j = 0; j < tube->nt; j++)
            self->twist[j] += section->polar_inertia * length *
                              (element->tau[0][j] + (x - element->x0) * element->tau[1][j]);
    }
}

static void find_fibre(guide_cut *self, const ld_tubes *model, const ld_station *station)
{
    const ld_section *section = section_at(model, self->at);
    double E = model->material.youngs_modulus, R = section->outer_radius;
    self->round = section->form == LD_SECTION_ANNULUS && isnan(station->outer_fibre[0]);
    double y = self->round ? R : station->outer_fibre[0];
    double z = self->round ? R : station->outer_fibre[1];
    self->fibre_y = E * z / section_stiffness_y(section);
    self->fibre_z = E * y / section_stiffness_z(section);
}

void guide_cut_build(guide_cut *self, const flexible_tube *tube, const ld_tubes *model,
                     const ld_station *station)
{
    memset(self, 0, sizeof *self);
    double at = self->at = station->at;
    for (int e = flexible_tube_find(tube, at); e < tube->element_count; e++) {
        const tube_element *element = &tube->element[e];
        double middle = 0.5 * (element->x0 + element->x1);
        add_stretch(self, tube, section_at(model, middle), element, fmax(at, element->x0));
    }
    for (int i = 0; i < model->point_mass_count; i++) {
        double x = model->point_mass[i].at;
        if (x >= at)
            add_mass(self, tube, &tube->element[flexible_tube_find(tube, x)], x,
                     model->point_mass[i].mass);
    }
    find_fibre(self, model, station);
    const ld_section *section = section_at(model, at);
    self->EA = section->axial_stiffness;
    self->EI_y = section_stiffness_y(section);
    self->EI_z = section_stiffness_z(section);
}

// ---- at an instant ----

// What a function's coordinates q are along R's axes: those of function k of the bending shapes, or
// axial.
static v3 coordinates_of(const flexible_tube *tube, int k, const double *q)
{
    int nb = tube->nb, bending = bending_of(tube), j = k - 2;
    if (j >= bending)
        return v3_make(q[2 * nb + tube->nt + j - bending], 0, 0);
    if (!tube->overlap)
        return v3_make(0, q[j], q[nb + j]);
    return j < nb ? v3_make(0, q[j], 0) : v3_make(0, 0, q[j]);
}

// P_k and A_k of all functions, P_0 from the section's point P.
static void find_coefficients(const flexible_tube *tube, const guide_motion *motion, v3 P, v3 *to,
                              v3 *acceleration)
{
    v3 w = motion->w;
    to[0] = v3_neg(P);
    acceleration[0] = motion->a;
    for (int k = 1; k < functions_of(tube); k++) {
        v3 p = v3_make(1, 0, 0), rate = v3_zero(), relative = v3_zero();
        if (k >= 2) {
            p = coordinates_of(tube, k, motion->q);
            rate = coordinates_of(tube, k, motion->q_dot);
            relative = coordinates_of(tube, k, motion->q_ddot);
        }
        v3 turning = v3_cross(w, v3_axpy(v3_cross(w, p), 2, rate));
        to[k] = p;
        acceleration[k] = v3_add(relative, v3_add(v3_cross(motion->w_dot, p), turning));
    }
}

// d/dt of the angular momentum rho I_p (w_x + phi_x_dot) e_x of the part beyond.
static v3 spin_up(const guide_cut *self, const flexible_tube *tube, const guide_motion *motion)
{
    int torsion = 2 * tube->nb;
    double momentum = self->polar * motion->w.x, rate = self->polar * motion->w_dot.x;
    for (int j = 0; j < tube->nt; j++) {
        momentum += self->twist[j] * motion->q_dot[torsion + j];
        rate += self->twist[j] * motion->q_ddot[torsion + j];
    }
    return v3_add(v3_make(rate, 0, 0), v3_cross(motion->w, v3_make(momentum, 0, 0)));
}

// The largest one: all around a round section, at the corner (y, z) of others.
static double bending_stress(const guide_cut *self, v3 moment)
{
    double y = moment.y * self->fibre_y, z = moment.z * self->fibre_z;
    return self->round ? sqrt(y * y + z * z) : fabs(y) + fabs(z);
}

guide_load guide_cut_load(const guide_cut *self, const flexible_tube *tube,
                          const guide_motion *motion, v3 P, m3 A, const guide_wrench *beyond)
{
    v3 to[GUIDE_FUNCTIONS], acceleration[GUIDE_FUNCTIONS];
    int n = functions_of(tube);
    find_coefficients(tube, motion, P, to, acceleration);
    v3 f = beyond->f, m = v3_sub(beyond->m, v3_cross(P, beyond->f));
    m = v3_sub(m, spin_up(self, tube, motion));
    for (int k = 0; k < n; k++) {
        v3 B = v3_zero();
        for (int l = 0; l < n; l++)
            B = v3_axpy(B, self->gram[k][l], acceleration[l]);
        m = v3_sub(m, v3_cross(to[k], B));
        if (k == 0)
            f = v3_sub(f, B);
    }
    guide_load load = {.wrench = {m3_apply_transposed(A, f), m3_apply_transposed(A, m)}};
    load.bending = hypot(load.wrench.m.y, load.wrench.m.z);
    load.stress = bending_stress(self, load.wrench.m);
    load.strain = load.wrench.f.x / self->EA;
    load.curvature_y = load.wrench.m.z / self->EI_z;
    load.curvature_z = -load.wrench.m.y / self->EI_y;
    return load;
}
