#include "systems/launching.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "elements/tube_dynamics.h"

// ---- set-up ----

static void lay_out(launching_layout *at, int nq)
{
    int n = 0;
    at->nq = nq;
    at->r = n, n += 3;
    at->quaternion = n, n += 4;
    at->v = n, n += 3;
    at->w = n, n += 3;
    at->q = n, n += nq;
    at->q_dot = n, n += nq;
    at->x = n, n += 6;
    at->V = n, n += 6;
    at->count = n;
}

// Packs the shapes of one element by mode and by power.
static void pack_element(const flexible_tube *tube, const tube_element *from, packed_element *to)
{
    memset(to, 0, sizeof *to);
    to->x0 = from->x0;
    to->x1 = from->x1;
    for (int j = 0; j < tube->nb; j++)
        for (int k = 0; k < 4; k++) {
            double shape = from->b[k][j];
            to->by_mode[j][k] = shape;
            to->by_power[k][j] = shape;
            to->ctb[k] += tube->ct[j] * shape;
            to->cb[k] += tube->c[j] * shape;
        }
    for (int j = 0; j < tube->nt; j++)
        for (int k = 0; k < 2; k++)
            to->tau[j][k] = from->tau[k][j];
    for (int j = 0; j < tube->na; j++)
        for (int k = 0; k < 2; k++)
            to->a[j][k] = from->a[k][j];
}

static double element_shape(const tube_element *element, int j, double x)
{
    double xi = x - element->x0;
    return element->b[0][j] +
           xi * (element->b[1][j] + xi * (element->b[2][j] + xi * element->b[3][j]));
}

static double element_slope(const tube_element *element, int j, double x)
{
    double xi = x - element->x0;
    return element->b[1][j] + xi * (2 * element->b[2][j] + xi * 3 * element->b[3][j]);
}

static void set_row(launching_system *self, int row, int j, double value)
{
    self->rows[row][j] = value;
    self->rows_by_mode[j][row] = value;
}

// Supports, and the rows that never change: b and b' at the supports, ct, c.
static void build_supports(launching_system *self)
{
    const ld_tubes *model = &self->model->tubes;
    const flexible_tube *tube = &self->tube;
    self->support_count = model->support_count;
    self->row_count = 2 * model->support_count + 2;
    self->row_lanes = (self->row_count + 3) / 4;
    for (int k = 0; k < model->support_count; k++) {
        const ld_support *from = &model->support[k];
        launching_support *to = &self->support[k];
        const tube_element *element = &tube->element[tube->support_element[k]];
        to->x = from->at;
        to->K = v3_from(from->stiffness);
        to->C = v3_from(from->damping);
        to->Kr = v3_from(from->rotational_stiffness);
        to->Cr = v3_from(from->rotational_damping);
        to->isotropic = to->Kr.x == to->Kr.y && to->Kr.y == to->Kr.z;
        for (int j = 0; j < tube->nb; j++) {
            set_row(self, 2 * k, j, element_shape(element, j, from->at));
            set_row(self, 2 * k + 1, j, element_slope(element, j, from->at));
        }
        for (int j = 0; j < tube->nt; j++)
            to->tau[j] = element->tau[0][j] + (from->at - element->x0) * element->tau[1][j];
        for (int j = 0; j < tube->na; j++)
            to->a[j] = element->a[0][j] + (from->at - element->x0) * element->a[1][j];
    }
    for (int j = 0; j < tube->nb; j++) {
        set_row(self, self->row_count - 2, j, tube->ct[j]);
        set_row(self, self->row_count - 1, j, tube->c[j]);
        self->om2[j] = tube->om2_b[j];
        self->dmp[j] = tube->dmp_b[j];
    }
}

static void build_rigid_part(launching_system *self)
{
    const ld_tail *tail = &self->model->tubes.tail;
    const flexible_tube *tube = &self->tube;
    double away = tail->mass * tail->center * tail->center;
    self->m = tube->m + tail->mass;
    self->Sx = tube->s0 + tail->mass * tail->center;
    self->tail_inertia =
        v3_make(tail->inertia[0], tail->inertia[1] + away, tail->inertia[2] + away);
    self->jx = tube->j - tube->cpcp + tail->inertia[0];
}

void launching_set_rocket(launching_system *self)
{
    const ld_rocket *rocket = &self->model->rocket;
    const ld_slot *slot = &self->model->tubes.slot;
    self->adaptor_count = rocket->adaptor_count;
    for (int i = 0; i < rocket->adaptor_count; i++) {
        self->adaptor_at[i] = rocket->adaptor[i].at;
        self->clearance[i] = rocket->adaptor[i].clearance;
    }
    self->contact = contact_law_of(&rocket->contact);
    self->slot = slot->kind == LD_SLOT_HELIX;
    self->slot_angle = &slot->angle;
    self->knob_radius = slot->radius;
    self->knob_y = slot->radius * cos(rocket->knob_angle);
    self->knob_z = slot->radius * sin(rocket->knob_angle);
    self->slot_friction = slot->friction;
}

// Modes and coefficients follow from what ld_tubes holds from its length to its supports.
static bool same_tube(const ld_tubes *a, const ld_tubes *b)
{
    size_t from = offsetof(ld_tubes, length), to = offsetof(ld_tubes, slot);
    return memcmp((const char *)a + from, (const char *)b + from, to - from) == 0;
}

launching_tube launching_take_tube(launching_system *self)
{
    launching_tube tube = {self->tubes, self->tube, self->packed};
    self->tube = (flexible_tube){0};
    self->packed = NULL;
    return tube;
}

void launching_tube_free(launching_tube *self)
{
    flexible_tube_free(&self->tube);
    free(self->packed);
    self->packed = NULL;
}

static void use_tube(launching_system *self, launching_tube *kept)
{
    self->tube = kept->tube;
    self->packed = kept->packed;
    *kept = (launching_tube){0};
}

static ld_status build_tube(launching_system *self, ld_error *error)
{
    ld_status status = flexible_tube_build(&self->tube, &self->tubes, error);
    if (status)
        return status;
    size_t count = (size_t)self->tube.element_count;
    self->packed = aligned_alloc(64, (count * sizeof(packed_element) + 63) / 64 * 64);
    if (!self->packed) {
        launching_free(self);
        return ld_fail(error, LD_ERR_MEMORY, "no memory for the tube's shapes");
    }
    for (size_t i = 0; i < count; i++)
        pack_element(&self->tube, &self->tube.element[i], &self->packed[i]);
    return LD_OK;
}

ld_status launching_build(launching_system *self, const ld_model *model, launching_tube *kept,
                          ld_error *error)
{
    memset(self, 0, sizeof *self);
    self->model = model;
    self->tubes = model->tubes;
    self->gravity = model->gravity;
    ld_status status = LD_OK;
    if (kept && kept->packed && same_tube(&kept->tubes, &self->tubes))
        use_tube(self, kept);
    else
        status = build_tube(self, error);
    if (status)
        return status;
    lay_out(&self->layout, 2 * self->tube.nb + self->tube.nt + self->tube.na);
    build_supports(self);
    build_rigid_part(self);
    launching_set_rocket(self);
#if defined(__x86_64__)
    // valgrind does not know them all: LAUNCHDYN_PLAIN=1 does without
    self->wide_instructions = __builtin_cpu_supports("avx2") && !getenv("LAUNCHDYN_PLAIN");
#endif
    return LD_OK;
}

void launching_free(launching_system *self)
{
    flexible_tube_free(&self->tube);
    free(self->packed);
    self->packed = NULL;
}

// ---- rates ----

void launching_rates(const launching_system *self, const double *state, const launching_output *out,
                     bool rocket, double *state_dot)
{
    const launching_layout *at = &self->layout;
    quat q = q_from(state + at->quaternion);
    v3 v = v3_from(state + at->v), w = v3_from(state + at->w);
    v3_store(state_dot + at->r, m3_apply(q_matrix(q), v));
    quat q_dot = q_rate(q, w);
    memcpy(state_dot + at->quaternion, &q_dot, sizeof q_dot);
    v3_store(state_dot + at->v, v3_sub(out->a, v3_cross(w, v)));
    v3_store(state_dot + at->w, out->w_dot);
    memcpy(state_dot + at->q, state + at->q_dot, (size_t)at->nq * sizeof(double));
    memcpy(state_dot + at->q_dot, out->q_ddot, (size_t)at->nq * sizeof(double));
    if (rocket) {
        // V in R: d/dt V = [a_O1; alpha_B] - w x V
        memcpy(state_dot + at->x, out->x_dot, 6 * sizeof(double));
        v3 v_O1 = v3_from(state + at->V), w_B = v3_from(state + at->V + 3);
        v3_store(state_dot + at->V, v3_sub(out->a_O1, v3_cross(w, v_O1)));
        v3_store(state_dot + at->V + 3, v3_sub(out->alpha_B, v3_cross(w, w_B)));
    } else {
        memset(state_dot + at->x, 0, 12 * sizeof(double));
    }
}

// ---- energies ----

double launching_kinetic_energy(const launching_system *self, const launching_input *input,
                                const launching_phase *phase, const double *state)
{
    const launching_layout *at = &self->layout;
    const ld_tail *tail = &self->model->tubes.tail;
    v3 v = v3_from(state + at->v), w_R = v3_from(state + at->w);
    v3 v_tail = v3_add(v, v3_cross(w_R, v3_make(tail->center, 0, 0)));
    double energy =
        tube_kinetic_energy(&self->tube, v, w_R, state + at->q, state + at->q_dot) +
        0.5 * (tail->mass * v3_norm2(v_tail) + v3_dot(w_R, v3_mul(v3_from(tail->inertia), w_R)));
    if (phase->rocket) {
        launching_output out;
        launching_pose pose;
        launching_rocket_pose(self, state, &pose, &out);
        const rocket_mass *mass = &input->mass;
        v3 v_C = v3_add(pose.v_O1, v3_cross(pose.w_B, m3_apply(pose.A_RB, mass->c)));
        v3 w = m3_apply_transposed(pose.A_RB, pose.w_B);
        energy += 0.5 * (mass->m * v3_norm2(v_C) + v3_dot(w, m3_apply(mass->J, w)));
    }
    return energy;
}

double launching_potential_energy(const launching_system *self, const double *state)
{
    const launching_layout *at = &self->layout;
    const ld_tail *tail = &self->model->tubes.tail;
    v3 S = tube_first_moment(&self->tube, state + at->q);
    S.x += tail->mass * tail->center;
    m3 A_IR = q_matrix(q_from(state + at->quaternion));
    return self->gravity * (self->m * state[at->r + 1] + m3_apply(A_IR, S).y);
}
