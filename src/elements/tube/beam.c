#include "elements/tube/beam.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "elements/tube/shortening.h"
#include "math/matrices/dense.h"

enum { DEFAULT_ELEMENTS = 40 };

static ld_status check_section(const ld_section *section, int i, const char *name, ld_error *error)
{
    const ld_section *s = &section[i];
    if (!(s->mass_per_length > 0) || !(section_stiffness_y(s) > 0) ||
        !(section_stiffness_z(s) > 0) || !(s->torsion_stiffness > 0) || !(s->axial_stiffness > 0) ||
        !(s->polar_inertia > 0))
        return ld_fail(error, LD_ERR_INPUT,
                       "element '%s': section %d of the beam needs mass, stiffnesses and polar "
                       "inertia above 0",
                       name, i + 1);
    if (i == 0 ? s->from != 0 : !(s->from > s[-1].from))
        return ld_fail(error, LD_ERR_INPUT,
                       "element '%s': section %d of the beam begins at %g m, expected %s %g m",
                       name, i + 1, s->from, i == 0 ? "it at" : "it beyond",
                       i == 0 ? 0 : s[-1].from);
    return LD_OK;
}

static ld_status check(const ld_mstmm_beam *given, const char *name, ld_error *error)
{
    if (!(given->length > 0) || given->section_count < 1 || !given->section)
        return ld_fail(error, LD_ERR_INPUT,
                       "element '%s': a beam needs a length above 0 and at least one section",
                       name);
    if (given->section_count > LD_MAX_SECTIONS)
        return ld_fail(error, LD_ERR_INPUT, "element '%s': a beam has at most %d sections", name,
                       LD_MAX_SECTIONS);
    if (given->bending < 0 || given->bending > LD_NB || given->torsion < 0 ||
        given->torsion > LD_NT || given->axial < 0 || given->axial > LD_NA)
        return ld_fail(
            error, LD_ERR_INPUT,
            "element '%s': a beam has at most %d bending modes a plane, %d torsional and "
            "%d axial ones",
            name, LD_NB, LD_NT, LD_NA);
    if (!(given->shear_coefficient >= 0 && given->shear_coefficient <= 1))
        return ld_fail(error, LD_ERR_INPUT,
                       "element '%s': shear coefficient %g, expected 0 (none) to 1", name,
                       given->shear_coefficient);
    if (!(given->damping >= 0 && given->damping <= 1))
        return ld_fail(error, LD_ERR_INPUT, "element '%s': damping ratio %g, expected 0 to 1", name,
                       given->damping);
    ld_status status = LD_OK;
    for (int i = 0; !status && i < given->section_count; i++)
        status = check_section(given->section, i, name, error);
    return status;
}

static bool allocate(beam *self)
{
    self->M = calloc((size_t)self->n * (size_t)self->n, sizeof *self->M);
    self->h = calloc((size_t)self->n, sizeof *self->h);
    self->eta_dot = calloc((size_t)self->n, sizeof *self->eta_dot);
    return self->M && self->h && self->eta_dot;
}

ld_status beam_create(beam *self, const ld_mstmm_beam *given, const char *name, ld_error *error)
{
    memset(self, 0, sizeof *self);
    ld_status status = check(given, name, error);
    if (status)
        return status;
    ld_tubes *model = calloc(1, sizeof *model);
    if (!model)
        return ld_fail(error, LD_ERR_MEMORY, "no memory for a beam");
    model->length = given->length;
    model->section_count = given->section_count;
    memcpy(model->section, given->section, (size_t)given->section_count * sizeof *given->section);
    model->modes =
        (ld_modes){.bending = given->bending,
                   .torsion = given->torsion,
                   .axial = given->axial,
                   .elements = given->elements ? given->elements : DEFAULT_ELEMENTS,
                   .span = given->span == LD_SPAN_SUPPORTED ? LD_SPAN_CLAMPED : given->span,
                   .damping = given->damping,
                   .shear_coefficient = given->shear_coefficient};
    ld_error reason = {0};
    status = flexible_tube_build(&self->tube, model, &reason);
    if (!status && given->geometric_stiffness)
        status = shortening_build(&self->tube, model, &reason);
    free(model);
    if (status)
        return ld_fail(error, status, "element '%s': %s", name, reason.text);
    self->modes = tube_mode_count(&self->tube);
    self->n = 6 + self->modes;
    return allocate(self) ? LD_OK : ld_fail(error, LD_ERR_MEMORY, "no memory for a beam");
}

bool beam_copy(beam *self, const beam *from)
{
    *self = *from;
    self->output = NULL;
    size_t bytes = (size_t)from->output_count * sizeof *from->output;
    bool whole = allocate(self);
    if (from->output_count > 0) {
        self->output = malloc(bytes);
        if (self->output)
            memcpy(self->output, from->output, bytes);
        whole &= self->output != NULL;
    }
    return whole;
}

int beam_add_output(beam *self, double station)
{
    beam_output *grown =
        realloc(self->output, (size_t)(self->output_count + 1) * sizeof *self->output);
    if (!grown)
        return -1;
    self->output = grown;
    self->output[self->output_count].station = station;
    return self->output_count++;
}

void beam_free(beam *self, bool last)
{
    if (last) {
        shortening_free(self->tube.shortening);
        flexible_tube_free(&self->tube);
    }
    free(self->output);
    free(self->M);
    free(self->h);
    free(self->eta_dot);
    memset(self, 0, sizeof *self);
}

double beam_turn(const beam *self, const double *q)
{
    const flexible_tube *tube = &self->tube;
    const tube_element *last = &tube->element[tube->element_count - 1];
    double xi = last->x1 - last->x0, sum = 0;
    for (int plane = PLANE_Y; plane <= PLANE_Z && tube->shortening; plane++)
        for (int i = 0; i < tube->nb; i++) {
            double slope = last->b[plane][1][i] +
                           xi * (2 * last->b[plane][2][i] + xi * 3 * last->b[plane][3][i]);
            sum += fabs(slope * q[plane * tube->nb + i]);
        }
    return sum;
}

void beam_move(beam *self, v3 w, const double *q, const double *q_dot)
{
    self->w = w;
    const tube_motion motion = {w, v3_zero(), q, q_dot};
    tube_dynamics_assemble(&self->tube, &motion, self->M, self->h);
    for (int i = 0; i < self->output_count; i++)
        tube_section(&self->tube, self->output[i].station, w, q, q_dot, &self->output[i].section);
}

// Column k of a section's L as an acceleration.
static spatial column(const beam *self, const double *L, int k)
{
    int n = self->n;
    return (spatial){v3_make(L[k], L[n + k], L[2 * n + k]),
                     v3_make(L[3 * n + k], L[4 * n + k], L[5 * n + k])};
}

static spatial gamma_of(const tube_section_state *section)
{
    return (spatial){v3_from(section->gamma), v3_from(section->gamma + 3)};
}

// M += L^T Z L, h -= L^T (Z gamma + zf)
void beam_load(beam *self, int output, const spatial_matrix *Z, spatial zf)
{
    const tube_section_state *section = &self->output[output].section;
    spatial load = spatial_add(spatial_apply(Z, gamma_of(section)), zf);
    for (int i = 0; i < self->n; i++) {
        spatial L_i = column(self, section->L, i), ZL = spatial_apply(Z, L_i);
        self->h[i] -= spatial_dot(L_i, load);
        for (int j = 0; j < self->n; j++)
            self->M[i * self->n + j] += spatial_dot(ZL, column(self, section->L, j));
    }
}

static void store(double out[6], spatial x)
{
    v3_store(out, x.linear);
    v3_store(out + 3, x.angular);
}

// Schur complement of the modes: with G G^T = M_qq, Y = G^-1 M_qr and y = G^-1 h_q,
// Z = M_rr - Y^T Y, zf = -(h_r - Y^T y). G stays in M's modal block, Y and y in place of M_qr, h_q.
int beam_reduce(beam *self, const double *tau_q, spatial_matrix *Z, spatial *zf)
{
    int n = self->n, modes = self->modes;
    double G[LD_TUBE_MODES * LD_TUBE_MODES], y[LD_TUBE_MODES], Zr[6][6], zr[6];
    for (int i = 0; i < modes; i++) {
        memcpy(G + i * modes, self->M + (6 + i) * n + 6, (size_t)modes * sizeof *G);
        self->h[6 + i] += tau_q[i];
    }
    if (cholesky_factor(modes, G))
        return 1;
    for (int i = 0; i < modes; i++)
        memcpy(self->M + (6 + i) * n + 6, G + i * modes, (size_t)modes * sizeof *G);
    for (int k = 0; k <= 6; k++) {
        for (int i = 0; i < modes; i++)
            y[i] = k < 6 ? self->M[(6 + i) * n + k] : self->h[6 + i];
        cholesky_forward(modes, G, y);
        for (int i = 0; i < modes; i++) {
            if (k < 6)
                self->M[(6 + i) * n + k] = y[i];
            else
                self->h[6 + i] = y[i];
        }
    }
    for (int i = 0; i < 6; i++) {
        zr[i] = -self->h[i];
        for (int j = 0; j < 6; j++)
            Zr[i][j] = self->M[i * n + j];
        for (int k = 6; k < n; k++) {
            zr[i] += self->M[k * n + i] * self->h[k];
            for (int j = 0; j < 6; j++)
                Zr[i][j] -= self->M[k * n + i] * self->M[k * n + j];
        }
    }
    Z->A = (sym3){Zr[0][0], Zr[1][0], Zr[2][0], Zr[1][1], Zr[2][1], Zr[2][2]};
    Z->C = (sym3){Zr[3][3], Zr[4][3], Zr[5][3], Zr[4][4], Zr[5][4], Zr[5][5]};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            Z->B.a[i][j] = Zr[i][3 + j];
    *zf = (spatial){v3_from(zr), v3_from(zr + 3)};
    return 0;
}

void beam_carry_unit(const beam *self, int output, spatial F, double *Q)
{
    const double *L = self->output[output].section.L;
    for (int i = 0; i < self->n; i++)
        Q[i] += spatial_dot(column(self, L, i), F);
}

// y = G^-1 Q_q, Q_r -= Y^T y
void beam_reduce_unit(const beam *self, double *Q)
{
    int n = self->n;
    for (int i = 6; i < n; i++) {
        const double *row = self->M + i * n;
        double sum = Q[i];
        for (int k = 6; k < i; k++)
            sum -= row[k] * Q[k];
        Q[i] = sum / row[i];
        for (int k = 0; k < 6; k++)
            Q[k] -= row[k] * Q[i];
    }
}

void beam_hold(beam *self)
{
    int n = self->n;
    for (int i = 6; i < n; i++) {
        memset(self->M + i * n, 0, (size_t)n * sizeof *self->M);
        self->M[i * n + i] = 1;
        self->h[i] = 0;
        for (int k = 0; k < 6; k++)
            self->M[k * n + i] = 0;
    }
}

void beam_still(beam *self)
{
    memset(self->h, 0, (size_t)self->n * sizeof *self->h);
    for (int i = 0; i < self->output_count; i++)
        memset(self->output[i].section.gamma, 0, sizeof self->output[i].section.gamma);
}

// q_ddot = G^-T (y - Y [a; alpha])
void beam_accelerate(beam *self, spatial x, double *q_ddot)
{
    int n = self->n;
    double *eta_dot = self->eta_dot;
    store(eta_dot, x);
    for (int i = n - 1; i >= 6; i--) {
        double sum = self->h[i];
        for (int k = 0; k < 6; k++)
            sum -= self->M[i * n + k] * eta_dot[k];
        for (int k = i + 1; k < n; k++)
            sum -= self->M[k * n + i] * eta_dot[k];
        eta_dot[i] = sum / self->M[i * n + i];
    }
    memcpy(q_ddot, eta_dot + 6, (size_t)self->modes * sizeof *q_ddot);
}

// M eta_dot - h
spatial beam_needed(beam *self, spatial x, const double *q_ddot)
{
    int n = self->n;
    store(self->eta_dot, x);
    memcpy(self->eta_dot + 6, q_ddot, (size_t)self->modes * sizeof *q_ddot);
    for (int i = 0; i < n; i++) {
        double sum = -self->h[i];
        for (int k = 0; k < n; k++)
            sum += self->M[i * n + k] * self->eta_dot[k];
        self->h[i] = sum;
    }
    return (spatial){v3_from(self->h), v3_from(self->h + 3)};
}

// L^T F
spatial beam_carry(beam *self, int output, spatial F)
{
    const double *L = self->output[output].section.L;
    double rigid[6];
    for (int i = 0; i < self->n; i++) {
        double share = spatial_dot(column(self, L, i), F);
        if (i < 6)
            rigid[i] = share;
        else
            self->h[i] += share;
    }
    return (spatial){v3_from(rigid), v3_from(rigid + 3)};
}

spatial beam_momentum(const beam *self, v3 v, const double *q_dot)
{
    int n = self->n;
    double speed[6], p[6];
    store(speed, (spatial){v, self->w});
    for (int i = 0; i < 6; i++) {
        p[i] = 0;
        for (int k = 0; k < 6; k++)
            p[i] += self->M[i * n + k] * speed[k];
        for (int k = 6; k < n; k++)
            p[i] += self->M[i * n + k] * q_dot[k - 6];
    }
    return (spatial){v3_from(p), v3_from(p + 3)};
}

spatial beam_section_acceleration(const beam *self, const tube_section_state *section)
{
    double x[6];
    for (int i = 0; i < 6; i++) {
        x[i] = section->gamma[i];
        for (int k = 0; k < self->n; k++)
            x[i] += section->L[i * self->n + k] * self->eta_dot[k];
    }
    return (spatial){v3_from(x), v3_from(x + 3)};
}

spatial beam_output_acceleration(const beam *self, int output)
{
    return beam_section_acceleration(self, &self->output[output].section);
}
