#include "support/dense_mechanism.h"

#include <math.h>
#include <string.h>

#include "math/functions.h"
#include "model/model.h"
#include "support/dense_vehicle.h"

static const double two_pi = 6.283185307179586476925;

// ---------------------------------------------------------------- masses

static void add_part(dense_body *body, double mass, v3 center, m3 J)
{
    double square = v3_dot(center, center);
    m3 about = m3_sub(m3_diagonal(square, square, square), m3_outer(center, center));
    body->mass += mass;
    body->moment = v3_axpy(body->moment, mass, center);
    body->inertia = m3_add(body->inertia, m3_add(J, m3_scale(mass, about)));
}

static m3 matrix_of(const double diagonal[3], const double products[3])
{
    return (m3){{{diagonal[0], products[0], products[1]},
                 {products[0], diagonal[1], products[2]},
                 {products[1], products[2], diagonal[2]}}};
}

// A part of a tube whose rear end is at `rear`: its centre on the tube's axis, or beside it.
static void add_to_tube(dense_mechanism *self, v3 rear, double mass, v3 center, m3 J)
{
    const m3 *A = &self->tube_axes;
    add_part(&self->body[self->tube_body], mass, v3_add(rear, m3_apply(*A, center)),
             m3_mul(*A, m3_mul(J, m3_transpose(*A))));
}

static void carry_tube(dense_mechanism *self, v3 rear)
{
    static const double none[3] = {0};
    const ld_tubes *tubes = &self->model->tubes;
    for (int i = 0; i < tubes->section_count; i++) {
        const ld_section *section = &tubes->section[i];
        double end = i + 1 < tubes->section_count ? section[1].from : tubes->length;
        double length = end - section->from, mass = section->mass_per_length * length;
        double across = mass * length * length / 12;
        add_to_tube(self, rear, mass, v3_make(0.5 * (section->from + end), 0, 0),
                    m3_diagonal(section->polar_inertia * length, across, across));
    }
    for (int i = 0; i < tubes->point_mass_count; i++)
        add_to_tube(self, rear, tubes->point_mass[i].mass, v3_make(tubes->point_mass[i].at, 0, 0),
                    m3_diagonal(0, 0, 0));
    add_to_tube(self, rear, tubes->tail.mass, v3_make(tubes->tail.center, 0, 0),
                matrix_of(tubes->tail.inertia, none));
}

static void carry_rocket(dense_mechanism *self, v3 rear)
{
    const ld_rocket *rocket = &self->model->rocket;
    v3 center = v3_from(rocket->full.center);
    center.x += rocket->start_at;
    center.y += rocket->eccentricity[0];
    center.z += rocket->eccentricity[1];
    add_to_tube(self, rear, rocket->full.mass + rocket->mass_error, center,
                matrix_of(rocket->full.inertia, rocket->products));
}

static bool listed(int number, const int *list, int count)
{
    for (int i = 0; i < count; i++)
        if (list[i] == number)
            return true;
    return false;
}

// Tubes in rows along y, columns along z of the tubes' axes.
static void carry_tubes(dense_mechanism *self, int launching, const int *fired, int fired_count)
{
    const ld_base *base = &self->model->base;
    const ld_tubes *tubes = &self->model->tubes;
    self->tube_axes = m3_mul(m3_rotation_y(base->azimuth), m3_rotation_z(base->elevation));
    self->tube_body = mechanism_body(self->given, tubes->on);
    for (int row = 0, number = 1; row < tubes->layout.rows; row++)
        for (int column = 0; column < tubes->layout.columns; column++, number++) {
            v3 apart = v3_make(0, row * tubes->layout.pitch, column * tubes->layout.pitch);
            v3 rear = v3_add(v3_from(tubes->layout.first), m3_apply(self->tube_axes, apart));
            if (number == launching) {
                self->tube_at = rear;
                continue;
            }
            carry_tube(self, rear);
            if (!listed(number, fired, fired_count) &&
                !listed(number, tubes->empty, tubes->empty_count))
                carry_rocket(self, rear);
        }
}

// ---------------------------------------------------------------- layout of the state

static ld_hinge hinge_of(ld_joint_kind kind)
{
    switch (kind) {
    case LD_JOINT_REVOLUTE:
        return LD_HINGE_REVOLUTE;
    case LD_JOINT_PRISMATIC:
        return LD_HINGE_PRISMATIC;
    case LD_JOINT_CYLINDRICAL:
        return LD_HINGE_CYLINDRICAL;
    case LD_JOINT_UNIVERSAL:
        return LD_HINGE_UNIVERSAL;
    case LD_JOINT_SPHERICAL:
        return LD_HINGE_SPHERICAL;
    case LD_JOINT_PLANAR:
        return LD_HINGE_PLANAR;
    case LD_JOINT_FREE:
        return LD_HINGE_FREE;
    case LD_JOINT_FIXED:
        break;
    }
    return LD_HINGE_WELD;
}

static void lay_out_tree(dense_mechanism *self)
{
    const ld_mechanism *given = self->given;
    for (int k = 0; k < given->body_count; k++)
        self->joint_of[k] = -1;
    for (int i = 0; i < given->joint_count; i++) {
        int body = mechanism_body(given, given->joint[i].body);
        self->closes[i] = self->joint_of[body] >= 0;
        if (!self->closes[i])
            self->joint_of[body] = i;
    }
    for (int k = 0; k < given->body_count; k++) {
        ld_hinge hinge = hinge_of(given->joint[self->joint_of[k]].kind);
        self->q_at[k] = self->q_count;
        self->u_at[k] = self->u_count;
        self->q_count += tree_coordinates[hinge];
        self->u_count += tree_speeds[hinge];
    }
}

static bool locked_at_once(const ld_joint *joint)
{
    return joint->lock.spring.present && isnan(joint->lock.from);
}

static bool has_drive(const ld_stabiliser *s)
{
    return s->bandwidth > 0 || s->sample > 0 || s->gear.present;
}

// Drives in their order, locks of other joints in theirs, actuators of struts in theirs.
static void list_holds(dense_mechanism *self)
{
    const ld_mechanism *given = self->given;
    bool driven[LD_MAX_JOINTS] = {0}, in_state = false;
    for (int i = 0; i < given->drive_count; i++) {
        const ld_joint_drive *drive = &given->drive[i];
        int joint = mechanism_joint(given, drive->joint);
        driven[joint] = true;
        self->hold[self->hold_count++] = (dense_hold){i, joint, -1};
        in_state |= !locked_at_once(&given->joint[joint]) &&
                    has_drive(drive->form == LD_DRIVE_ANGLE ? &drive->angle : &drive->length);
    }
    for (int i = 0; i < given->joint_count; i++)
        if (!driven[i] && locked_at_once(&given->joint[i]))
            self->hold[self->hold_count++] = (dense_hold){-1, i, -1};
    for (int i = 0; i < given->strut_count; i++)
        if (given->strut[i].driven) {
            self->hold[self->hold_count++] = (dense_hold){-1, -1, i};
            in_state |= has_drive(&given->strut[i].actuator);
        }
    self->z_at = self->q_count + self->u_count;
    self->drive_at = in_state ? self->z_at + self->hold_count : -1;
}

static void lay_out(dense_mechanism *self)
{
    lay_out_tree(self);
    list_holds(self);
    int at = self->z_at + self->hold_count * (self->drive_at < 0 ? 1 : 1 + DRIVE_STATES);
    for (int i = 0; i < self->given->joint_count; i++) {
        const ld_joint_lock *lock = &self->given->joint[i].lock;
        self->later_at[i] = lock->spring.present && !isnan(lock->from) ? at++ : -1;
    }
    self->feet_at = at;
    self->wheels_at = at + 2 * self->given->foot_count;
    int wheels = self->model->base.vehicle.wheel_count;
    self->state_count = self->wheels_at + (wheels ? WHEEL_STATES * wheels + 1 : 0);
}

void dense_mechanism_create(dense_mechanism *self, const ld_model *model, int launching,
                            const int *fired, int fired_count)
{
    memset(self, 0, sizeof *self);
    self->model = model;
    self->given = &model->base.mechanism;
    for (int k = 0; k < self->given->body_count; k++) {
        const ld_body *body = &self->given->body[k];
        add_part(&self->body[k], body->mass, v3_from(body->center),
                 matrix_of(body->inertia, body->products));
    }
    carry_tubes(self, launching, fired, fired_count);
    lay_out(self);
}

void dense_mechanism_start(const dense_mechanism *self, double *state)
{
    memset(state, 0, (size_t)self->state_count * sizeof *state);
    for (int k = 0; k < self->given->body_count; k++) {
        const ld_joint *joint = &self->given->joint[self->joint_of[k]];
        double *q = state + self->q_at[k];
        if (joint->kind == LD_JOINT_SPHERICAL)
            q[0] = 1;
        if (joint->kind == LD_JOINT_FREE)
            q[3] = 1;
        if (joint->kind == LD_JOINT_PRISMATIC || joint->kind == LD_JOINT_CYLINDRICAL)
            q[0] = joint->displacement;
        if (joint->kind == LD_JOINT_REVOLUTE || joint->kind == LD_JOINT_UNIVERSAL)
            q[0] = joint->angle;
        if (joint->kind == LD_JOINT_CYLINDRICAL)
            q[1] = joint->angle;
        if (joint->kind == LD_JOINT_UNIVERSAL)
            q[1] = joint->angle_2;
    }
}

// ---------------------------------------------------------------- motion

typedef struct pose {
    jet3 r;
    jet33 R;
} pose;

static jet33 constant_matrix(m3 A)
{
    jet33 z;
    memset(&z, 0, sizeof z);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            z.a[i][j].c[0] = A.a[i][j];
    return z;
}

static jet3 constant(v3 x)
{
    return jet3_constant((double[]){x.x, x.y, x.z});
}

static m3 yaw_pitch_roll(const double angles[3])
{
    return m3_mul(m3_mul(m3_rotation_y(angles[0]), m3_rotation_z(angles[1])),
                  m3_rotation_x(angles[2]));
}

// A frame that moves on with these accelerations: R = (E + ~w t + (~alpha + ~w ~w) t^2/2) R_0.
static pose moving_frame(v3 r, v3 v, v3 a, m3 A, v3 w, v3 alpha)
{
    pose z = {.r = constant(r)};
    double rate[3], twice[3];
    v3_store(rate, v);
    v3_store(twice, a);
    m3 first = m3_skew(w), second = m3_add(m3_skew(alpha), m3_mul(first, first));
    jet33 turned = jet33_identity();
    for (int i = 0; i < 3; i++) {
        z.r.a[i].c[1] = rate[i];
        z.r.a[i].c[2] = twice[i] / 2;
        for (int j = 0; j < 3; j++) {
            turned.a[i][j].c[1] = first.a[i][j];
            turned.a[i][j].c[2] = second.a[i][j] / 2;
        }
    }
    z.R = jet33_multiply(turned, constant_matrix(A));
    return z;
}

// A frame fixed on another one.
static pose fixed_on(const pose *on, v3 at, m3 axes)
{
    return (pose){jet3_add(on->r, jet33_apply(on->R, constant(at))),
                  jet33_multiply(on->R, constant_matrix(axes))};
}

static pose ground(void)
{
    return moving_frame(v3_zero(), v3_zero(), v3_zero(), m3_identity(), v3_zero(), v3_zero());
}

// A direction across the axis of a planar joint: x of its axes, or y where the axis is along x.
static void second_axis(const ld_joint *joint, double axis_2[3])
{
    double x = joint->axis[0], y = joint->axis[1], z = joint->axis[2];
    memcpy(axis_2, joint->axis_2, 3 * sizeof *axis_2);
    if (joint->kind != LD_JOINT_PLANAR)
        return;
    bool along_x = fabs(x) > 0.9 * sqrt(x * x + y * y + z * z);
    axis_2[0] = !along_x;
    axis_2[1] = along_x;
    axis_2[2] = 0;
}

// Poses of all bodies at coordinates q with constant speeds u, on a carrier that goes its way.
static void trace(const dense_mechanism *self, const pose *carrier, const double *q,
                  const double *u, pose *body)
{
    const ld_mechanism *given = self->given;
    bool done[LD_MAX_BODIES] = {0};
    const pose still = ground();
    for (int left = given->body_count, k = 0; left > 0; k = (k + 1) % given->body_count) {
        const ld_joint *joint = &given->joint[self->joint_of[k]];
        int parent = mechanism_body(given, joint->parent);
        if (done[k] || (parent >= 0 && !done[parent]))
            continue;
        const pose *on = parent >= 0 ? &body[parent] : parent == LD_ON_CARRIER ? carrier : &still;
        pose frame = fixed_on(on, v3_from(joint->at), yaw_pitch_roll(joint->attitude));
        double axis_2[3];
        jet3 slide;
        jet33 own;
        second_axis(joint, axis_2);
        tree_joint(hinge_of(joint->kind), joint->axis, axis_2, q + self->q_at[k], u + self->u_at[k],
                   &slide, &own);
        body[k].r = jet3_add(frame.r, jet33_apply(frame.R, slide));
        body[k].R = jet33_multiply(frame.R, own);
        done[k] = true;
        left--;
    }
}

static v3 part_of(const jet3 *x, int order)
{
    return v3_make((double)x->a[0].c[order], (double)x->a[1].c[order], (double)x->a[2].c[order]);
}

static dense_frame frame_of(const pose *of)
{
    real w[3], alpha[3];
    dense_frame f = {.r = part_of(&of->r, 0), .v = part_of(&of->r, 1)};
    tree_rates(&of->R, w, alpha);
    f.w = v3_make((double)w[0], (double)w[1], (double)w[2]);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            f.A.a[i][j] = (double)of->R.a[i][j].c[0];
    return f;
}

// ---------------------------------------------------------------- equations

enum { FREEDOMS = 6 * LD_MAX_BODIES, ROWS = 6 * LD_MAX_JOINTS, SIZE = 2 * FREEDOMS };

// One state: M x - C^T lambda = h, C x = -gamma; x: acceleration of the origin and angular
// acceleration of every body, in I. Rows of C are made orthonormal, those that others imply left
// out: row i is the sum of R[i][k] times the k-th of these.
typedef struct equations {
    const dense_mechanism *self;
    const dense_mechanism_input *input;
    dense_mechanism_output *output;
    pose carrier, body[LD_MAX_BODIES];
    dense_frame carried_by;
    int n;
    real M[FREEDOMS][FREEDOMS], h[FREEDOMS];
    int row_count, independent;
    int first_row[LD_MAX_JOINTS + 1];
    real C[ROWS][FREEDOMS], gamma[ROWS], on_parent[ROWS][6];
    real Q[FREEDOMS][FREEDOMS], Q_gamma[FREEDOMS], R[ROWS][FREEDOMS];
    int kept[FREEDOMS]; // row of each that is kept
    real mu[FREEDOMS], lambda[ROWS];
    v3 joint_force[LD_MAX_JOINTS], joint_moment[LD_MAX_JOINTS]; // of springs and holds
    double torque[LD_MAX_JOINTS], push[LD_MAX_STRUTS];          // of holds
} equations;

// A point of a body, of the carrier or of the ground: its frame moves with it.
typedef struct place {
    int body;
    dense_frame at;
} place;

static const dense_frame *frame_at(const equations *eq, int body)
{
    static const dense_frame still = {.A = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
    return body >= 0 ? &eq->output->body[body] : body == LD_ON_CARRIER ? &eq->carried_by : &still;
}

static place place_of(const equations *eq, int body, v3 at, m3 axes)
{
    const dense_frame *of = frame_at(eq, body);
    v3 arm = m3_apply(of->A, at);
    return (place){body,
                   {.r = v3_add(of->r, arm),
                    .v = v3_add(of->v, v3_cross(of->w, arm)),
                    .A = m3_mul(of->A, axes),
                    .w = of->w}};
}

static place named_place(const equations *eq, const char *name, const double at[3])
{
    return place_of(eq, mechanism_body(eq->self->given, name), v3_from(at), m3_identity());
}

static double power_on(const equations *eq, int body, v3 f, v3 r, v3 m)
{
    const dense_frame *of = frame_at(eq, body);
    v3 v = v3_add(of->v, v3_cross(of->w, v3_sub(r, of->r)));
    return v3_dot(f, v) + v3_dot(m, of->w);
}

// Force f at r and moment m, all in I. What the carrier takes it gives to the bodies.
static void push(equations *eq, int body, v3 f, v3 r, v3 m)
{
    if (body == LD_ON_CARRIER)
        eq->output->power[MECHANISM_CARRYING] -= power_on(eq, body, f, r, m);
    if (body < 0)
        return;
    v3 moment = v3_add(m, v3_cross(v3_sub(r, eq->output->body[body].r), f));
    double six[6];
    v3_store(six, f);
    v3_store(six + 3, moment);
    for (int i = 0; i < 6; i++)
        eq->h[6 * body + i] += six[i];
}

static void push_pair(equations *eq, const place *on, const place *opposite, v3 f, v3 m)
{
    push(eq, on->body, f, on->at.r, m);
    push(eq, opposite->body, v3_neg(f), on->at.r, v3_neg(m));
}

// Newton's and Euler's equations about the body's origin.
static void add_mass(equations *eq, int k)
{
    const dense_body *body = &eq->self->body[k];
    const dense_frame *f = &eq->output->body[k];
    v3 s = m3_apply(f->A, body->moment), w = f->w;
    m3 J = m3_mul(f->A, m3_mul(body->inertia, m3_transpose(f->A)));
    m3 blocks[2][2] = {{m3_diagonal(body->mass, body->mass, body->mass), m3_scale(-1, m3_skew(s))},
                       {m3_skew(s), J}};
    for (int i = 0; i < 6; i++)
        for (int j = 0; j < 6; j++)
            eq->M[6 * k + i][6 * k + j] = blocks[i / 3][j / 3].a[i % 3][j % 3];
    v3 down = v3_make(0, -eq->self->model->gravity, 0);
    v3 force = v3_sub(v3_scale(body->mass, down), v3_cross(w, v3_cross(w, s)));
    v3 moment = v3_sub(v3_cross(s, down), v3_cross(w, m3_apply(J, w)));
    push(eq, k, force, f->r, moment);
    v3 momentum = v3_add(v3_scale(body->mass, f->v), v3_cross(w, s));
    eq->output->power[MECHANISM_GRAVITY] += v3_dot(down, momentum);
    eq->output->kinetic +=
        0.5 * v3_dot(momentum, f->v) + 0.5 * v3_dot(w, v3_add(m3_apply(J, w), v3_cross(s, f->v)));
}

// ---------------------------------------------------------------- constraints

static jet dot(jet3 a, jet3 b)
{
    jet sum = jet_multiply(a.a[0], b.a[0]);
    for (int i = 1; i < 3; i++)
        sum = jet_add(sum, jet_multiply(a.a[i], b.a[i]));
    return sum;
}

static v3 unit(const double x[3])
{
    v3 v = v3_from(x);
    return v3_scale(1 / v3_norm(v), v);
}

static v3 across(v3 e)
{
    v3 other = fabs(e.x) < 0.6 ? v3_make(1, 0, 0) : v3_make(0, 1, 0);
    v3 n = v3_cross(e, other);
    return v3_scale(1 / v3_norm(n), n);
}

// Axis of a joint, two directions across it, and its second axis, in its own axes.
typedef struct joint_axes {
    v3 e, n1, n2, e2;
} joint_axes;

static joint_axes axes_of(const ld_joint *joint)
{
    double axis_2[3];
    joint_axes a = {.e = unit(joint->axis)};
    a.n1 = across(a.e);
    a.n2 = v3_cross(a.e, a.n1);
    second_axis(joint, axis_2);
    if (joint->kind == LD_JOINT_UNIVERSAL)
        a.e2 = unit(axis_2);
    if (joint->kind == LD_JOINT_PLANAR) {
        v3 x = v3_from(axis_2);
        x = v3_axpy(x, -v3_dot(x, a.e), a.e);
        a.n1 = v3_scale(1 / v3_norm(x), x);
        a.n2 = v3_cross(a.e, a.n1);
    }
    return a;
}

static jet normal(const pose *p, v3 of_p, const pose *b, v3 of_b)
{
    jet z = dot(jet33_apply(p->R, constant(of_p)), jet33_apply(b->R, constant(of_b)));
    z.c[0] -= v3_dot(of_p, of_b);
    return z;
}

// All axes stay parallel.
static int keep_parallel(const pose *p, const pose *b, jet *phi)
{
    const v3 axis[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int i = 0; i < 3; i++)
        phi[i] = normal(p, axis[i], b, axis[(i + 1) % 3]);
    return 3;
}

static int keep_together(const jet3 *d, jet *phi)
{
    memcpy(phi, d->a, sizeof d->a);
    return 3;
}

static int keep_direction(const pose *p, const pose *b, const joint_axes *a, jet *phi)
{
    phi[0] = normal(p, a->n1, b, a->e);
    phi[1] = normal(p, a->n2, b, a->e);
    return 2;
}

static jet stay(const pose *p, const jet3 *d, v3 direction)
{
    return dot(*d, jet33_apply(p->R, constant(direction)));
}

// What a joint keeps at zero of the frames p on its parent and b on its body; how many rows.
static int constrain(const ld_joint *joint, const pose *p, const pose *b, jet phi[6])
{
    joint_axes a = {.e = {1, 0, 0}};
    jet3 d;
    int n = 0;
    for (int i = 0; i < 3; i++)
        d.a[i] = jet_add(b->r.a[i], jet_scale(-1, p->r.a[i]));
    bool has_axis = joint->kind != LD_JOINT_FIXED && joint->kind != LD_JOINT_SPHERICAL &&
                    joint->kind != LD_JOINT_FREE;
    if (has_axis)
        a = axes_of(joint);
    switch (joint->kind) {
    case LD_JOINT_FIXED:
        n = keep_together(&d, phi);
        return n + keep_parallel(p, b, phi + n);
    case LD_JOINT_REVOLUTE:
        n = keep_together(&d, phi);
        return n + keep_direction(p, b, &a, phi + n);
    case LD_JOINT_PRISMATIC:
        n = keep_parallel(p, b, phi);
        phi[n++] = stay(p, &d, a.n1);
        phi[n++] = stay(p, &d, a.n2);
        return n;
    case LD_JOINT_CYLINDRICAL:
        n = keep_direction(p, b, &a, phi);
        phi[n++] = stay(p, &d, a.n1);
        phi[n++] = stay(p, &d, a.n2);
        return n;
    case LD_JOINT_UNIVERSAL:
        n = keep_together(&d, phi);
        phi[n++] = normal(p, a.e, b, a.e2);
        return n;
    case LD_JOINT_SPHERICAL:
        return keep_together(&d, phi);
    case LD_JOINT_PLANAR:
        n = keep_direction(p, b, &a, phi);
        phi[n++] = stay(p, &d, a.e);
        return n;
    case LD_JOINT_FREE:
        break;
    }
    return 0;
}

static v3 body_side(const ld_joint *joint)
{
    return isnan(joint->body_at[0]) ? v3_zero() : v3_from(joint->body_at);
}

static int rows_of(const equations *eq, int joint, const pose *parent, const pose *body, jet *phi)
{
    const ld_joint *given = &eq->self->given->joint[joint];
    pose p = fixed_on(parent, v3_from(given->at), yaw_pitch_roll(given->attitude)), b = *body;
    if (eq->self->closes[joint])
        b = fixed_on(body, body_side(given), yaw_pitch_roll(given->body_attitude));
    return constrain(given, &p, &b, phi);
}

// A body that is where it is, at rest but for one of its accelerations being 1; -1: at rest.
static pose accelerated(const dense_frame *f, int i)
{
    double six[6] = {0};
    if (i >= 0)
        six[i] = 1;
    return moving_frame(f->r, v3_zero(), v3_from(six), f->A, v3_zero(), v3_from(six + 3));
}

// A body that goes on without accelerations; the carrier with its own.
static pose going(const equations *eq, int body)
{
    const dense_frame *f = frame_at(eq, body);
    if (body == LD_ON_CARRIER)
        return eq->carrier;
    return moving_frame(f->r, f->v, v3_zero(), f->A, f->w, v3_zero());
}

static void add_joint(equations *eq, int joint)
{
    const ld_joint *given = &eq->self->given->joint[joint];
    int parent = mechanism_body(eq->self->given, given->parent);
    int body = mechanism_body(eq->self->given, given->body), at = eq->row_count;
    pose p = going(eq, parent), b = going(eq, body);
    const dense_frame *of_p = frame_at(eq, parent), *of_b = frame_at(eq, body);
    jet phi[6];
    int n = rows_of(eq, joint, &p, &b, phi);
    eq->first_row[joint] = at;
    eq->row_count += n;
    for (int k = 0; k < n; k++) {
        eq->gamma[at + k] = 2 * phi[k].c[2];
        for (int order = 0; order < 2; order++)
            eq->output->open = fmax(eq->output->open, fabs((double)phi[k].c[order]));
    }
    for (int i = 0; i < 6; i++) {
        p = accelerated(of_p, i);
        b = accelerated(of_b, -1);
        rows_of(eq, joint, &p, &b, phi);
        for (int k = 0; k < n; k++) {
            eq->on_parent[at + k][i] = 2 * phi[k].c[2];
            if (parent >= 0)
                eq->C[at + k][6 * parent + i] = 2 * phi[k].c[2];
        }
        p = accelerated(of_p, -1);
        b = accelerated(of_b, i);
        rows_of(eq, joint, &p, &b, phi);
        for (int k = 0; k < n; k++)
            eq->C[at + k][6 * body + i] = 2 * phi[k].c[2];
    }
}

// ---------------------------------------------------------------- holds

// Command and its rate, linear between the rows.
static double command_of(const ld_table *table, double t, double *rate)
{
    const double *row = table->data;
    *rate = 0;
    if (t < row[0])
        return row[1];
    for (size_t i = 0; i + 1 < table->rows; i++, row += table->columns)
        if (t < row[table->columns]) {
            const double *next = row + table->columns;
            *rate = (next[1] - row[1]) / (next[0] - row[0]);
            return row[1] + *rate * (t - row[0]);
        }
    return row[1];
}

static double clip(double value, double limit)
{
    return value > limit ? limit : value < -limit ? -limit : value;
}

// Torque that the loops ask for and rate of their integral, of a digital one between its samples. A
// cascade is a PID whose integral takes the rate's error, too.
static double ask(const equations *eq, const ld_stabiliser *given, double z, const double *drive,
                  double e, double e_dot, double *z_dot)
{
    const ld_cascade *two = &given->cascade;
    double limit = given->torque_limit;
    double kp = two->present ? two->rate_kp * two->kp : given->kp;
    double kd = two->present ? two->rate_kp : given->kd;
    double ki = two->present ? two->rate_ki * two->kp : given->ki;
    double grows = ki * e + (two->present ? two->rate_ki * e_dot : 0);
    *z_dot = 0;
    if (given->sample > 0 && !eq->input->linear)
        return drive[DRIVE_HELD];
    if (fabs(z) < limit || z * grows <= 0)
        *z_dot = grows;
    return clip(kp * e + kd * e_dot + z, limit);
}

// Torque of a stabiliser's actuator and gear, of what is asked for; their rates.
static double actuate(const equations *eq, const ld_stabiliser *given, const double *drive,
                      double asked, double b_dot, double *rate)
{
    const ld_gear *gear = &given->gear;
    double torque = asked;
    if (given->bandwidth > 0) {
        torque = drive[DRIVE_TORQUE];
        rate[DRIVE_TORQUE] = two_pi * given->bandwidth * (asked - torque);
        if (given->slew > 0)
            rate[DRIVE_TORQUE] = clip(rate[DRIVE_TORQUE], given->slew);
    }
    if (!gear->present)
        return torque;
    double twist = drive[DRIVE_TWIST], play = 0.5 * gear->backlash;
    double side = twist < 0 ? -1 : 1, pressed = side * twist - play;
    double push = gear->stiffness * pressed + gear->damping * side * (drive[DRIVE_RATE] - b_dot);
    bool stuck = eq->input->linear || gear->backlash == 0;
    if (!stuck && (pressed < 0 || push < 0))
        push = 0;
    rate[DRIVE_TWIST] = drive[DRIVE_RATE] - b_dot;
    rate[DRIVE_RATE] = (torque - side * push) / gear->inertia;
    return side * push;
}

// Yaw or pitch of an axis, and its rate.
static double direction_of(v3 d, v3 w, bool pitch, double *rate)
{
    v3 d_dot = v3_cross(w, d);
    double level = d.x * d.x + d.z * d.z;
    if (!pitch) {
        *rate = (d.z * d_dot.x - d.x * d_dot.z) / level;
        return atan2(-d.z, d.x);
    }
    *rate = d_dot.y / sqrt(level);
    return atan2(d.y, sqrt(level));
}

// The line of a strut.
typedef struct line {
    place from, to;
    v3 e;
    double length, rate;
} line;

static line line_of(const equations *eq, int i)
{
    const ld_strut *strut = &eq->self->given->strut[i];
    line l = {named_place(eq, strut->from, strut->at), named_place(eq, strut->to, strut->to_at),
              .rate = 0};
    v3 arm = v3_sub(l.to.at.r, l.from.at.r);
    l.length = v3_norm(arm);
    l.e = v3_scale(1 / l.length, arm);
    l.rate = v3_dot(l.e, v3_sub(l.to.at.v, l.from.at.v));
    return l;
}

// What a drive on a joint measures.
static void measure_joint(const equations *eq, const dense_hold *hold, hinge_report *report)
{
    const dense_mechanism *self = eq->self;
    const ld_joint *joint = &self->given->joint[hold->joint];
    const ld_joint_drive *drive = hold->drive < 0 ? NULL : &self->given->drive[hold->drive];
    int body = mechanism_body(self->given, joint->body);
    place on = place_of(eq, mechanism_body(self->given, joint->parent), v3_from(joint->at),
                        yaw_pitch_roll(joint->attitude));
    const double *state = eq->input->state;
    report->angle = state[self->q_at[body]];
    report->rate = state[self->q_count + self->u_at[body]];
    report->base_rate = v3_dot(on.at.w, m3_apply(on.at.A, unit(joint->axis)));
    report->measured = report->angle;
    report->measured_rate = report->rate;
    if (!drive || drive->follows == LD_FOLLOWS_JOINT)
        return;
    const dense_frame *of = &eq->output->body[self->tube_body];
    v3 d = m3_column(eq->output->tube.A, 0);
    if (drive->of[0]) {
        of = &eq->output->body[mechanism_body(self->given, drive->of)];
        d = m3_column(of->A, 0);
    }
    report->measured =
        direction_of(d, of->w, drive->follows == LD_FOLLOWS_PITCH, &report->measured_rate);
}

// Stabiliser or lock number i: torque on a joint, push of a strut.
static void add_hold(equations *eq, int i)
{
    const dense_mechanism *self = eq->self;
    const dense_hold *hold = &self->hold[i];
    const double *state = eq->input->state, none[DRIVE_STATES] = {0};
    double *rate = eq->output->rate, unused[DRIVE_STATES] = {0};
    hinge_report *report = &eq->output->hold[i];
    const ld_stabiliser *given = NULL;
    if (hold->strut >= 0) {
        line l = line_of(eq, hold->strut);
        report->angle = report->measured = l.length;
        report->rate = report->measured_rate = l.rate;
        given = &self->given->strut[hold->strut].actuator;
    } else {
        measure_joint(eq, hold, report);
    }
    const ld_joint_drive *drive = hold->drive < 0 ? NULL : &self->given->drive[hold->drive];
    if (drive)
        given = drive->form == LD_DRIVE_ANGLE ? &drive->angle : &drive->length;
    const ld_joint *joint = hold->joint < 0 ? NULL : &self->given->joint[hold->joint];
    report->command =
        joint ? (joint->kind == LD_JOINT_PRISMATIC ? joint->displacement : joint->angle) : 0;
    report->command_rate = 0;
    if (given)
        report->command = command_of(&given->command, eq->input->t, &report->command_rate);
    report->error = report->command - report->measured;
    if (drive && drive->follows != LD_FOLLOWS_JOINT)
        report->error = remainder(report->error, two_pi);
    int at = self->drive_at < 0 ? -1 : self->drive_at + DRIVE_STATES * i;
    const hold_rest *rest = eq->input->rest + i;
    if (eq->input->held) {
        report->torque = rest->torque;
    } else if (joint && locked_at_once(joint)) {
        report->torque = rest->torque -
                         joint->lock.spring.stiffness * (report->angle - rest->angle) -
                         joint->lock.spring.damping * report->rate;
    } else {
        double e_dot =
            report->command_rate - given->feedforward * report->base_rate - report->measured_rate;
        const double *own = at < 0 ? none : state + at;
        double asked =
            ask(eq, given, state[self->z_at + i], own, report->error, e_dot, &rate[self->z_at + i]);
        report->torque = actuate(eq, given, own, asked, report->rate, at < 0 ? unused : rate + at);
    }
    if (joint)
        eq->torque[hold->joint] = report->torque;
    else
        eq->push[hold->strut] = report->torque;
    eq->output->power[MECHANISM_HOLDS] += report->torque * report->rate;
}

// ---------------------------------------------------------------- joints

// A coordinate along or about a direction in I.
typedef struct axis_freedom {
    bool turns;
    v3 along;
    double x, x_dot;
} axis_freedom;

static double angle_between(v3 from, v3 to, v3 about)
{
    v3 a = v3_axpy(from, -v3_dot(from, about), about), b = v3_axpy(to, -v3_dot(to, about), about);
    return atan2(v3_dot(about, v3_cross(a, b)), v3_dot(a, b));
}

// A joint between its frames, coordinates from the frames alone.
typedef struct jointed {
    place p, b;
    int count;
    axis_freedom axis[3];
    bool ball;
    v3 phi, w; // rotation and its rate, in I
} jointed;

static v3 rotation_vector(m3 A)
{
    double c = 0.5 * (A.a[0][0] + A.a[1][1] + A.a[2][2] - 1);
    v3 s = v3_make(0.5 * (A.a[2][1] - A.a[1][2]), 0.5 * (A.a[0][2] - A.a[2][0]),
                   0.5 * (A.a[1][0] - A.a[0][1]));
    double size = v3_norm(s);
    return size > 1e-9 ? v3_scale(atan2(size, c) / size, s) : s;
}

static void slide(jointed *j, v3 direction)
{
    v3 d = v3_sub(j->b.at.r, j->p.at.r);
    v3 drift = v3_sub(v3_sub(j->b.at.v, j->p.at.v), v3_cross(j->p.at.w, d));
    v3 e = m3_apply(j->p.at.A, direction);
    j->axis[j->count++] = (axis_freedom){false, e, v3_dot(e, d), v3_dot(e, drift)};
}

static void turn_about(jointed *j, v3 axis)
{
    v3 e = m3_apply(j->p.at.A, axis), n = across(axis);
    double angle = angle_between(m3_apply(j->p.at.A, n), m3_apply(j->b.at.A, n), e);
    j->axis[j->count++] = (axis_freedom){true, e, angle, v3_dot(e, v3_sub(j->b.at.w, j->p.at.w))};
}

// Angles about the axis on the parent, then about the one on the body.
static void turn_twice(jointed *j, const joint_axes *a)
{
    v3 first = m3_apply(j->p.at.A, a->e), second = m3_apply(j->b.at.A, a->e2);
    v3 w = v3_sub(j->b.at.w, j->p.at.w);
    double c = v3_dot(first, second), w1 = v3_dot(w, first), w2 = v3_dot(w, second);
    double x1 = angle_between(m3_apply(j->p.at.A, a->e2), second, first);
    // the first axis seen from the body turns back by the second angle
    double x2 = angle_between(m3_apply(j->b.at.A, a->e), first, second);
    j->axis[j->count++] = (axis_freedom){true, first, x1, (w1 - c * w2) / (1 - c * c)};
    j->axis[j->count++] = (axis_freedom){true, second, -x2, (w2 - c * w1) / (1 - c * c)};
}

static jointed joint_at(const equations *eq, int i)
{
    const dense_mechanism *self = eq->self;
    const ld_joint *given = &self->given->joint[i];
    int body = mechanism_body(self->given, given->body);
    jointed j = {
        .p = place_of(eq, mechanism_body(self->given, given->parent), v3_from(given->at),
                      yaw_pitch_roll(given->attitude)),
        .b = place_of(eq, body, self->closes[i] ? body_side(given) : v3_zero(),
                      self->closes[i] ? yaw_pitch_roll(given->body_attitude) : m3_identity())};
    joint_axes a = {.e = {1, 0, 0}};
    ld_joint_kind kind = given->kind;
    j.ball = kind == LD_JOINT_SPHERICAL || kind == LD_JOINT_FREE;
    if (kind != LD_JOINT_FIXED && !j.ball)
        a = axes_of(given);
    if (kind == LD_JOINT_PRISMATIC || kind == LD_JOINT_CYLINDRICAL)
        slide(&j, a.e);
    if (kind == LD_JOINT_PLANAR) {
        slide(&j, a.n1);
        slide(&j, a.n2);
    }
    for (int k = 0; k < 3 && kind == LD_JOINT_FREE; k++)
        slide(&j, v3_make(k == 0, k == 1, k == 2));
    if (kind == LD_JOINT_REVOLUTE || kind == LD_JOINT_CYLINDRICAL || kind == LD_JOINT_PLANAR)
        turn_about(&j, a.e);
    if (kind == LD_JOINT_UNIVERSAL)
        turn_twice(&j, &a);
    j.phi = m3_apply(j.p.at.A, rotation_vector(m3_mul(m3_transpose(j.p.at.A), j.b.at.A)));
    j.w = v3_sub(j.b.at.w, j.p.at.w);
    // angles of the tree are counted beyond a turn
    for (int k = 0; k < j.count && !self->closes[i]; k++)
        j.axis[k].x = eq->input->state[self->q_at[body] + k];
    return j;
}

// Force along or torque about each axis, and moment m, all in I.
static void load_joint(equations *eq, int i, const jointed *j, const double *tau, v3 m)
{
    v3 f = v3_zero();
    bool two = eq->self->given->joint[i].kind == LD_JOINT_UNIVERSAL;
    double own[3] = {0};
    memcpy(own, tau, (size_t)j->count * sizeof *tau);
    if (two) {
        // the moment in the plane of the axes that has these components
        double c = v3_dot(j->axis[0].along, j->axis[1].along), square = 1 - c * c;
        own[0] = (tau[0] - c * tau[1]) / square;
        own[1] = (tau[1] - c * tau[0]) / square;
    }
    for (int k = 0; k < j->count; k++) {
        v3 *to = j->axis[k].turns ? &m : &f;
        *to = v3_axpy(*to, own[k], j->axis[k].along);
    }
    push_pair(eq, &j->b, &j->p, f, m);
    eq->joint_force[i] = f;
    eq->joint_moment[i] = m;
}

static double friction_of(const equations *eq, const ld_joint *joint, double v)
{
    const ld_hinge_friction *friction = &joint->friction;
    double f = -friction->viscous * v;
    if (!eq->input->linear && friction->coulomb > 0)
        f -= friction->coulomb * v / hypot(v, friction->rate);
    return eq->input->held ? 0 : f;
}

static double stop_of(equations *eq, const ld_joint_stops *stops, double x, double v)
{
    double beyond = x > stops->high ? x - stops->high : x < stops->low ? x - stops->low : 0;
    if (!stops->present || beyond == 0)
        return 0;
    double spring = -stops->stiffness * beyond, both = spring - stops->damping * v;
    if (both * spring < 0)
        both = 0;
    eq->output->elastic += 0.5 * stops->stiffness * beyond * beyond;
    eq->output->power[MECHANISM_FRICTION] += (both - spring) * v;
    return both;
}

static double later_lock(equations *eq, int i, double x, double v)
{
    const ld_joint_lock *lock = &eq->self->given->joint[i].lock;
    int at = eq->self->later_at[i];
    if (at < 0 || eq->input->t < lock->from)
        return 0;
    double bent = x - eq->input->state[at];
    eq->output->elastic += 0.5 * lock->spring.stiffness * bent * bent;
    eq->output->power[MECHANISM_HOLDS] -= lock->spring.damping * v * v;
    return -lock->spring.stiffness * bent - lock->spring.damping * v;
}

// Springs and dampers; friction, stops, locks and drives of what slides or turns along one axis.
static void load_freedoms(equations *eq, int i)
{
    const ld_joint *given = &eq->self->given->joint[i];
    jointed j = joint_at(eq, i);
    dense_mechanism_output *output = eq->output;
    double tau[3] = {0};
    bool single = given->kind == LD_JOINT_REVOLUTE || given->kind == LD_JOINT_PRISMATIC;
    bool rests = single || given->kind == LD_JOINT_CYLINDRICAL;
    for (int k = 0; k < j.count; k++) {
        const axis_freedom *a = &j.axis[k];
        double stiffness = a->turns ? given->rotational_stiffness : given->stiffness;
        double damping = a->turns ? given->rotational_damping : given->damping;
        double rest = !rests ? 0 : a->turns ? given->rest_angle : given->rest_length;
        tau[k] = -stiffness * (a->x - rest) - damping * a->x_dot;
        output->elastic += 0.5 * stiffness * (a->x - rest) * (a->x - rest);
        output->power[MECHANISM_FRICTION] -= damping * a->x_dot * a->x_dot;
        int which = a->turns && given->kind != LD_JOINT_UNIVERSAL ? 1 : k < 2 ? k : 1;
        output->joint[i].position[which] = a->x;
        output->joint[i].rate[which] = a->x_dot;
    }
    v3 m = v3_zero();
    if (j.ball) {
        m = v3_scale(-given->rotational_stiffness, j.phi);
        m = v3_axpy(m, -given->rotational_damping, j.w);
        output->elastic += 0.5 * given->rotational_stiffness * v3_dot(j.phi, j.phi);
        output->power[MECHANISM_FRICTION] -= given->rotational_damping * v3_dot(j.w, j.w);
    }
    if (single && !eq->self->closes[i]) {
        double v = j.axis[0].x_dot;
        output->friction[i] = friction_of(eq, given, v);
        output->power[MECHANISM_FRICTION] += output->friction[i] * v;
        tau[0] += output->friction[i] + eq->torque[i] + stop_of(eq, &given->stops, j.axis[0].x, v) +
                  later_lock(eq, i, j.axis[0].x, v);
    }
    load_joint(eq, i, &j, tau, m);
}

// ---------------------------------------------------------------- force elements

// Force of one axis of a bushing at displacement d and rate v.
static double along_axis(equations *eq, const ld_bushing *given, int i, double d, double v)
{
    double side = d < 0 ? -1 : 1, size = fabs(d), force = 0;
    if (given->clearance[i] == 0 || size > given->clearance[i]) {
        double bent = size - given->clearance[i];
        force = -side * given->stiffness[i] * bent - given->damping[i] * v;
        eq->output->elastic += 0.5 * given->stiffness[i] * bent * bent;
        eq->output->power[MECHANISM_BUSHINGS] -= given->damping[i] * v * v;
    }
    if (size > given->stop[i]) {
        double beyond = size - given->stop[i];
        force -= side * given->stop_stiffness[i] * beyond;
        eq->output->elastic += 0.5 * given->stop_stiffness[i] * beyond * beyond;
    }
    return force;
}

// Jl(phi)^-T m by Jl = sum of ~phi^k/(k + 1)!, solved.
static v3 against_rotation(v3 phi, v3 m)
{
    m3 S = m3_skew(phi), power = m3_identity(), J = m3_identity();
    for (int k = 1; k < 40; k++) {
        power = m3_scale(1.0 / (k + 1), m3_mul(power, S));
        J = m3_add(J, power);
    }
    // rows of the inverse of J^T by cofactors
    v3 a = v3_make(J.a[0][0], J.a[0][1], J.a[0][2]), b = v3_make(J.a[1][0], J.a[1][1], J.a[1][2]),
       c = v3_make(J.a[2][0], J.a[2][1], J.a[2][2]);
    double det = v3_dot(a, v3_cross(b, c));
    // J^T x = m: columns of J^T are a, b, c
    return v3_make(v3_dot(m, v3_cross(b, c)) / det, v3_dot(m, v3_cross(c, a)) / det,
                   v3_dot(m, v3_cross(a, b)) / det);
}

static void add_bushing(equations *eq, int i)
{
    const dense_mechanism *self = eq->self;
    const ld_bushing *given = &self->given->bushing[i];
    place from = place_of(eq, mechanism_body(self->given, given->from), v3_from(given->at),
                          yaw_pitch_roll(given->attitude));
    place to = place_of(eq, mechanism_body(self->given, given->to), self->bushing_at[i],
                        self->bushing_turn[i]);
    v3 arm = v3_sub(to.at.r, from.at.r);
    v3 drift = v3_sub(v3_sub(to.at.v, from.at.v), v3_cross(from.at.w, arm));
    v3 d = m3_apply_transposed(from.at.A, arm), d_dot = m3_apply_transposed(from.at.A, drift);
    v3 f = v3_make(along_axis(eq, given, 0, d.x, d_dot.x), along_axis(eq, given, 1, d.y, d_dot.y),
                   along_axis(eq, given, 2, d.z, d_dot.z));
    v3 phi = rotation_vector(m3_mul(m3_transpose(from.at.A), to.at.A));
    v3 w = m3_apply_transposed(from.at.A, v3_sub(to.at.w, from.at.w));
    v3 spring = v3_mul(v3_from(given->rotational_stiffness), phi);
    v3 damper = v3_mul(v3_from(given->rotational_damping), w);
    eq->output->elastic += 0.5 * v3_dot(spring, phi);
    eq->output->power[MECHANISM_BUSHINGS] -= v3_dot(damper, w);
    v3 m = v3_neg(v3_add(against_rotation(phi, spring), damper));
    eq->output->bushing[i] = f;
    push_pair(eq, &to, &from, m3_apply(from.at.A, f), m3_apply(from.at.A, m));
}

static void add_strut(equations *eq, int i)
{
    const ld_strut *given = &eq->self->given->strut[i];
    line l = line_of(eq, i);
    double bent = l.length - eq->self->strut_length[i];
    double force = given->preload - given->stiffness * bent - given->damping * l.rate;
    eq->output->elastic += 0.5 * given->stiffness * bent * bent - given->preload * bent;
    eq->output->power[MECHANISM_BUSHINGS] -= given->damping * l.rate * l.rate;
    eq->output->strut[i] = (strut_report){l.length, l.rate, force};
    push_pair(eq, &l.to, &l.from, v3_scale(force + eq->push[i], l.e), v3_zero());
}

static void add_foot(equations *eq, int i)
{
    const ld_foot *given = &eq->self->given->foot[i];
    const double *xi = eq->input->state + eq->self->feet_at + 2 * i;
    double *rate = eq->output->rate + eq->self->feet_at + 2 * i;
    foot_report *report = &eq->output->foot[i];
    place foot = named_place(eq, given->body, given->at);
    v3 r = foot.at.r, v = foot.at.v;
    double depth = given->height - r.y;
    report->deflection = depth;
    if (depth > 0)
        report->normal = fmax(0, given->stiffness[1] * depth - given->damping[1] * v.y);
    double x = -given->stiffness[0] * xi[0] - given->damping[0] * v.x;
    double z = -given->stiffness[2] * xi[1] - given->damping[2] * v.z;
    double most = given->friction * report->normal;
    double share = most > 0 ? most / sqrt(most * most + x * x + z * z) : 0;
    report->force = v3_make(share * x, report->normal, share * z);
    rate[0] = depth > 0 ? v.x : -50 * xi[0];
    rate[1] = depth > 0 ? v.z : -50 * xi[1];
    eq->output->power[MECHANISM_FEET] += v3_dot(report->force, v);
    push(eq, foot.body, report->force, r, v3_zero());
}

static v3 table_at(const ld_table *table, double t)
{
    const double *row = table->data;
    if (table->rows == 0)
        return v3_zero();
    if (t <= row[0])
        return v3_from(row + 1);
    for (size_t i = 1; i < table->rows; i++, row += 4)
        if (t < row[4]) {
            double share = (t - row[0]) / (row[4] - row[0]);
            return v3_add(v3_scale(1 - share, v3_from(row + 1)), v3_scale(share, v3_from(row + 5)));
        }
    return v3_from(row + 1);
}

static void add_load(equations *eq, int i)
{
    const ld_point_load *given = &eq->self->given->load[i];
    place at = named_place(eq, given->body, given->at);
    v3 f = table_at(&given->force, eq->input->t), m = table_at(&given->moment, eq->input->t);
    if (given->axes == LD_LOAD_IN_BODY) {
        f = m3_apply(at.at.A, f);
        m = m3_apply(at.at.A, m);
    }
    eq->output->power[MECHANISM_LOADS] += power_on(eq, at.body, f, at.at.r, m);
    push(eq, at.body, f, at.at.r, m);
}

// Density [kg/m3] of uniform air, else of the standard's at the tube's rear end; wind without
// profile and gusts.
static v3 wind_of(const ld_environment *environment)
{
    const ld_wind *wind = &environment->wind;
    v3 flow = v3_from(wind->add);
    double heading = wind->heading;
    if (!wind->present)
        return v3_zero();
    flow.x += wind->scale * wind->speed * cos(heading);
    flow.z += wind->scale * wind->speed * sin(heading);
    if (wind->axes == LD_WIND_LAUNCHER)
        return flow;
    // x of I points from north towards east by the azimuth
    double azimuth = environment->site.azimuth;
    v3 x = v3_make(cos(azimuth), 0, sin(azimuth)), z = v3_cross(x, v3_make(0, 1, 0));
    return v3_make(v3_dot(flow, x), flow.y, v3_dot(flow, z));
}

static void add_drag(equations *eq, int i)
{
    const ld_body_drag *given = &eq->self->given->drag[i];
    place at = named_place(eq, given->body, given->at);
    double density = eq->self->model->environment.atmosphere.density;
    v3 flow = v3_sub(wind_of(&eq->self->model->environment), at.at.v), f = v3_zero();
    for (int k = 0; k < 3; k++) {
        v3 axis = m3_column(at.at.A, k);
        double pressure = 0.5 * density * v3_norm(flow) * v3_dot(axis, flow);
        f = v3_axpy(f, given->area[k] * pressure, axis);
    }
    eq->output->power[MECHANISM_LOADS] += v3_dot(f, at.at.v);
    push(eq, at.body, f, at.at.r, v3_zero());
}

static void load_tube(equations *eq)
{
    const base_frame *tube = &eq->output->tube;
    v3 f = m3_apply(tube->A, eq->input->tube_force), m = m3_apply(tube->A, eq->input->tube_moment);
    eq->output->tube_power = power_on(eq, eq->self->tube_body, f, tube->r, m);
    push(eq, eq->self->tube_body, f, tube->r, m);
}

// ---------------------------------------------------------------- wheels

typedef struct wheels {
    const ld_vehicle *vehicle;
    const dense_frame *on;
    int body;
    v3 ahead, aside; // horizontal
    double drive;    // [N] of each driven one
} wheels;

// Spring, damper and bump stop between wheel and body, by components along the body's axes; force
// on the wheel.
static v3 suspend(equations *eq, const wheels *all, int j, v3 r, v3 v)
{
    const ld_suspension *given = &all->vehicle->suspension;
    v3 arm = v3_sub(r, all->on->r);
    v3 drift = v3_sub(v3_sub(v, all->on->v), v3_cross(all->on->w, arm));
    double d[3], d_dot[3], f[3], *power = eq->output->power + MECHANISM_POWERS;
    v3_store(d,
             v3_sub(m3_apply_transposed(all->on->A, arm), v3_from(all->vehicle->wheel[j].mount)));
    v3_store(d_dot, m3_apply_transposed(all->on->A, drift));
    for (int i = 0; i < 3; i++) {
        f[i] = -given->stiffness[i] * d[i] - given->damping[i] * d_dot[i];
        eq->output->elastic += 0.5 * given->stiffness[i] * d[i] * d[i];
        power[MARCHING_SUSPENSION] -= given->damping[i] * d_dot[i] * d_dot[i];
    }
    double up = d[1] - given->bump_stop.compression, down = -d[1] - given->bump_stop.extension;
    double beyond = up > 0 ? up : down > 0 ? -down : 0;
    if (beyond != 0) {
        f[1] -= given->bump_stop.stiffness * beyond;
        eq->output->elastic += 0.5 * given->bump_stop.stiffness * beyond * beyond;
    }
    return m3_apply(all->on->A, v3_from(f));
}

// Tyre on the road; force on the wheel.
static v3 roll(equations *eq, const wheels *all, int j, v3 r, v3 v, const double *state,
               double *rate)
{
    const ld_tyre *tyre = &all->vehicle->tyre;
    double slope, *power = eq->output->power + MECHANISM_POWERS;
    double height =
        dense_road_height(&all->vehicle->road, all->vehicle->wheel[j].mount[2], r.x, &slope);
    double p = height + tyre->radius - r.y, p_dot = slope * v.x - v.y;
    double normal = p > 0 ? fmax(0, tyre->stiffness[1] * p + tyre->damping[1] * p_dot) : 0;
    v3 arm = v3_make(0, height - r.y, 0), v_c = v3_add(v, v3_cross(all->on->w, arm));
    double v_f = v3_dot(v_c, all->ahead), v_s = v3_dot(v_c, all->aside);
    bool parked = all->vehicle->speed == 0;
    rate[WHEEL_XI] = parked ? v_f : 0;
    rate[WHEEL_ETA] = parked ? v_s : v_s - fabs(v_f) * state[WHEEL_ETA] / tyre->relaxation_length;
    double f_f = parked ? -tyre->stiffness[0] * state[WHEEL_XI] - tyre->damping[0] * v_f
                        : (all->vehicle->wheel[j].driven ? all->drive : 0);
    double f_s = -tyre->stiffness[2] * state[WHEEL_ETA] - tyre->damping[2] * rate[WHEEL_ETA];
    double most = tyre->friction * normal;
    double share = normal > 0 ? 1 / sqrt(1 + (f_f * f_f + f_s * f_s) / (most * most)) : 0;
    f_f *= share;
    f_s *= share;
    v3 f = v3_add(v3_scale(f_f, all->ahead), v3_scale(f_s, all->aside));
    push(eq, all->body, v3_zero(), r, v3_cross(arm, f));
    power[MARCHING_TYRE] += normal * v.y;
    power[MARCHING_SIDE] += f_s * v_s + (parked ? f_f * v_f : 0);
    power[MARCHING_DRIVE] += parked ? 0 : f_f * v_f;
    eq->output->wheel[j].deflection = p;
    eq->output->wheel[j].normal = normal;
    eq->output->wheel[j].along = f_f;
    eq->output->wheel[j].side = f_s;
    return v3_axpy(f, normal, v3_make(0, 1, 0));
}

static void add_wheels(equations *eq)
{
    const dense_mechanism *self = eq->self;
    const ld_vehicle *vehicle = &self->model->base.vehicle;
    int count = vehicle->wheel_count, driven = 0;
    if (!count)
        return;
    wheels all = {.vehicle = vehicle, .body = mechanism_body(self->given, self->given->wheels_on)};
    all.on = &eq->output->body[all.body];
    v3 x = m3_column(all.on->A, 0);
    all.ahead = v3_scale(1 / hypot(x.x, x.z), v3_make(x.x, 0, x.z));
    all.aside = v3_cross(all.ahead, v3_make(0, 1, 0));
    for (int j = 0; j < count; j++)
        driven += vehicle->wheel[j].driven;
    const double *state = eq->input->state + self->wheels_at;
    double *rate = eq->output->rate + self->wheels_at;
    double lag = vehicle->speed - v3_dot(all.ahead, all.on->v);
    bool drives = vehicle->speed != 0 && !eq->input->held && driven > 0;
    if (drives)
        all.drive =
            (vehicle->drive.kp * lag + vehicle->drive.ki * state[WHEEL_STATES * count]) / driven;
    rate[WHEEL_STATES * count] = lag;
    for (int j = 0; j < count; j++, state += WHEEL_STATES, rate += WHEEL_STATES) {
        v3 r = v3_from(state + WHEEL_R), v = v3_from(state + WHEEL_V);
        double mass = vehicle->wheel[j].mass;
        v3 held = suspend(eq, &all, j, r, v), pushed = roll(eq, &all, j, r, v, state, rate);
        push(eq, all.body, v3_neg(held), r, v3_zero());
        v3 a = v3_scale(1 / mass, v3_add(held, pushed));
        a.y -= self->model->gravity;
        v3_store(rate + WHEEL_R, v);
        v3_store(rate + WHEEL_V, a);
        eq->output->power[MECHANISM_POWERS + MARCHING_GRAVITY] -= mass * self->model->gravity * v.y;
        eq->output->kinetic += 0.5 * mass * v3_dot(v, v);
    }
}

// ---------------------------------------------------------------- solution

static real product(const real *a, const real *b, int n)
{
    real sum = 0;
    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

// Rows of C as sums of orthonormal ones; those that the earlier ones imply give none.
static void make_independent(equations *eq)
{
    const real implied = 1e-9L;
    for (int i = 0; i < eq->row_count; i++) {
        real row[FREEDOMS], gamma = eq->gamma[i];
        real size = sqrtl(product(eq->C[i], eq->C[i], eq->n));
        memcpy(row, eq->C[i], (size_t)eq->n * sizeof *row);
        for (int turn = 0; turn < 2; turn++)
            for (int k = 0; k < eq->independent; k++) {
                real share = product(row, eq->Q[k], eq->n);
                eq->R[i][k] += share;
                gamma -= share * eq->Q_gamma[k];
                for (int j = 0; j < eq->n; j++)
                    row[j] -= share * eq->Q[k][j];
            }
        real left = sqrtl(product(row, row, eq->n));
        if (left <= implied * size) {
            eq->output->redundant++;
            continue;
        }
        int k = eq->independent++;
        eq->R[i][k] = left;
        eq->kept[k] = i;
        eq->Q_gamma[k] = gamma / left;
        for (int j = 0; j < eq->n; j++)
            eq->Q[k][j] = row[j] / left;
    }
    eq->output->rows = eq->row_count;
}

static real W[SIZE][SIZE + 1];

// W x = right, the last column, by Gauss' elimination.
static bool eliminate(int n, real *x)
{
    for (int j = 0; j < n; j++) {
        int best = j;
        for (int i = j + 1; i < n; i++)
            if (fabsl(W[i][j]) > fabsl(W[best][j]))
                best = i;
        if (!(fabsl(W[best][j]) > 0))
            return false;
        for (int k = j; k <= n && best != j; k++) {
            real swap = W[j][k];
            W[j][k] = W[best][k];
            W[best][k] = swap;
        }
        for (int i = j + 1; i < n; i++) {
            real share = W[i][j] / W[j][j];
            for (int k = j; k <= n && share != 0; k++)
                W[i][k] -= share * W[j][k];
        }
    }
    for (int j = n - 1; j >= 0; j--) {
        x[j] = W[j][n];
        for (int k = j + 1; k < n; k++)
            x[j] -= W[j][k] * x[k];
        x[j] /= W[j][j];
    }
    return true;
}

static bool solve(equations *eq, real *x)
{
    int n = eq->n, size = n + eq->independent;
    memset(W, 0, sizeof W);
    for (int i = 0; i < n; i++) {
        memcpy(W[i], eq->M[i], (size_t)n * sizeof **W);
        W[i][size] = eq->h[i];
    }
    for (int k = 0; k < eq->independent; k++) {
        for (int i = 0; i < n; i++) {
            W[i][n + k] = -eq->Q[k][i];
            W[n + k][i] = eq->Q[k][i];
        }
        W[n + k][size] = -eq->Q_gamma[k];
    }
    real all[SIZE];
    if (!eliminate(size, all))
        return false;
    memcpy(x, all, (size_t)n * sizeof *x);
    memcpy(eq->mu, all + n, (size_t)eq->independent * sizeof *eq->mu);
    return true;
}

// The multipliers of the rows themselves; those that others imply carry nothing.
static void find_multipliers(equations *eq)
{
    for (int k = eq->independent - 1; k >= 0; k--) {
        int row = eq->kept[k];
        eq->lambda[row] = eq->mu[k];
        for (int l = k + 1; l < eq->independent; l++)
            eq->lambda[row] -= eq->R[eq->kept[l]][k] * eq->lambda[eq->kept[l]];
        eq->lambda[row] /= eq->R[row][k];
    }
}

static v3 three(const real *x)
{
    return v3_make((double)x[0], (double)x[1], (double)x[2]);
}

// What each joint does to its body, and the carrier to what it carries.
static void write_reactions(equations *eq)
{
    const ld_mechanism *given = eq->self->given;
    for (int i = 0; i < given->joint_count; i++) {
        int body = mechanism_body(given, given->joint[i].body);
        int parent = mechanism_body(given, given->joint[i].parent);
        real on[6] = {0}, back[6] = {0};
        for (int row = eq->first_row[i]; row < eq->first_row[i + 1]; row++)
            for (int k = 0; k < 6; k++) {
                on[k] += eq->lambda[row] * eq->C[row][6 * body + k];
                back[k] += eq->lambda[row] * eq->on_parent[row][k];
            }
        const dense_frame *f = &eq->output->body[body];
        v3 arm = v3_zero(), force = three(on), moment = three(on + 3);
        if (eq->self->closes[i])
            arm = m3_apply(f->A, body_side(&given->joint[i]));
        eq->output->joint[i].force = v3_add(force, eq->joint_force[i]);
        eq->output->joint[i].moment =
            v3_add(v3_sub(moment, v3_cross(arm, force)), eq->joint_moment[i]);
        if (parent == LD_ON_CARRIER)
            eq->output->power[MECHANISM_CARRYING] -=
                v3_dot(three(back), eq->carried_by.v) + v3_dot(three(back + 3), eq->carried_by.w);
    }
}

// Rates of the coordinates from the speeds.
static void write_coordinates(const equations *eq)
{
    const dense_mechanism *self = eq->self;
    const double *state = eq->input->state;
    for (int k = 0; k < self->given->body_count; k++) {
        ld_joint_kind kind = self->given->joint[self->joint_of[k]].kind;
        const double *q = state + self->q_at[k], *u = state + self->q_count + self->u_at[k];
        double *rate = eq->output->rate + self->q_at[k];
        int slides = kind == LD_JOINT_FREE ? 3 : 0;
        bool ball = kind == LD_JOINT_FREE || kind == LD_JOINT_SPHERICAL;
        int plain = ball ? slides : tree_speeds[hinge_of(kind)];
        memcpy(rate, u, (size_t)plain * sizeof *rate);
        if (!ball)
            continue;
        // half of q times (0, w)
        const double *e = q + slides, *w = u + slides;
        rate[slides] = -0.5 * (e[1] * w[0] + e[2] * w[1] + e[3] * w[2]);
        for (int i = 0; i < 3; i++) {
            int a = (i + 1) % 3, b = (i + 2) % 3;
            rate[slides + 1 + i] = 0.5 * (e[0] * w[i] + e[1 + a] * w[b] - e[1 + b] * w[a]);
        }
    }
}

// Speeds' rates that give the bodies these accelerations, by least squares: those at constant
// speeds and those of unit rates are known.
static bool write_speeds(equations *eq, const real *x)
{
    static real unit_of[FREEDOMS][FREEDOMS];
    const dense_mechanism *self = eq->self;
    const pose still = {eq->carrier.r, eq->carrier.R};
    pose at_rest = still, moved[LD_MAX_BODIES];
    real left[FREEDOMS], w[3], alpha[3], answer[FREEDOMS];
    int n = self->u_count;
    for (int i = 0; i < 3; i++) {
        at_rest.r.a[i].c[1] = at_rest.r.a[i].c[2] = 0;
        for (int j = 0; j < 3; j++)
            at_rest.R.a[i][j].c[1] = at_rest.R.a[i][j].c[2] = 0;
    }
    for (int k = 0; k < self->given->body_count; k++) {
        tree_rates(&eq->body[k].R, w, alpha);
        for (int i = 0; i < 3; i++) {
            left[6 * k + i] = x[6 * k + i] - 2 * eq->body[k].r.a[i].c[2];
            left[6 * k + 3 + i] = x[6 * k + 3 + i] - alpha[i];
        }
    }
    for (int j = 0; j < n; j++) {
        double u[FREEDOMS] = {0};
        u[j] = 1;
        trace(self, &at_rest, eq->input->state, u, moved);
        for (int k = 0; k < self->given->body_count; k++) {
            tree_rates(&moved[k].R, w, alpha);
            for (int i = 0; i < 3; i++) {
                unit_of[j][6 * k + i] = moved[k].r.a[i].c[1];
                unit_of[j][6 * k + 3 + i] = w[i];
            }
        }
    }
    memset(W, 0, sizeof W);
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++)
            W[i][j] = product(unit_of[i], unit_of[j], eq->n);
        W[i][n] = product(unit_of[i], left, eq->n);
    }
    if (!eliminate(n, answer))
        return false;
    for (int i = 0; i < eq->n; i++) {
        for (int j = 0; j < n; j++)
            left[i] -= answer[j] * unit_of[j][i];
        eq->output->inconsistent = fmax(eq->output->inconsistent, fabs((double)left[i]));
    }
    for (int j = 0; j < n; j++)
        eq->output->rate[self->q_count + j] = (double)answer[j];
    return true;
}

static void place_all(equations *eq)
{
    const dense_mechanism *self = eq->self;
    const base_frame *carrier = eq->input->carrier;
    eq->carrier =
        moving_frame(carrier->r, carrier->v, carrier->a, carrier->A, carrier->w, carrier->alpha);
    eq->carried_by = frame_of(&eq->carrier);
    trace(self, &eq->carrier, eq->input->state, eq->input->state + self->q_count, eq->body);
    for (int k = 0; k < self->given->body_count; k++)
        eq->output->body[k] = frame_of(&eq->body[k]);
    place tube = place_of(eq, self->tube_body, self->tube_at, self->tube_axes);
    eq->output->tube = (base_frame){.r = tube.at.r, .v = tube.at.v, .A = tube.at.A, .w = tube.at.w};
}

static void set_up(equations *eq, const dense_mechanism *self, const dense_mechanism_input *input,
                   dense_mechanism_output *output)
{
    memset(eq, 0, sizeof *eq);
    memset(output, 0, sizeof *output);
    eq->self = self;
    eq->input = input;
    eq->output = output;
    eq->n = 6 * self->given->body_count;
    place_all(eq);
}

static void add_forces(equations *eq)
{
    const ld_mechanism *given = eq->self->given;
    for (int i = 0; i < eq->self->hold_count; i++)
        add_hold(eq, i);
    for (int i = 0; i < given->joint_count; i++)
        load_freedoms(eq, i);
    for (int i = 0; i < given->bushing_count; i++)
        add_bushing(eq, i);
    for (int i = 0; i < given->strut_count; i++)
        add_strut(eq, i);
    for (int i = 0; i < given->foot_count; i++)
        add_foot(eq, i);
    for (int i = 0; i < given->load_count; i++)
        add_load(eq, i);
    for (int i = 0; i < given->drag_count; i++)
        add_drag(eq, i);
    load_tube(eq);
    add_wheels(eq);
}

bool dense_mechanism_evaluate(const dense_mechanism *self, const dense_mechanism_input *input,
                              dense_mechanism_output *output)
{
    static equations eq;
    real x[FREEDOMS];
    set_up(&eq, self, input, output);
    for (int k = 0; k < self->given->body_count; k++)
        add_mass(&eq, k);
    for (int i = 0; i < self->given->joint_count; i++)
        add_joint(&eq, i);
    eq.first_row[self->given->joint_count] = eq.row_count;
    add_forces(&eq);
    make_independent(&eq);
    if (!solve(&eq, x))
        return false;
    for (int k = 0; k < self->given->body_count; k++) {
        output->body[k].a = three(x + 6 * k);
        output->body[k].alpha = three(x + 6 * k + 3);
    }
    find_multipliers(&eq);
    write_reactions(&eq);
    write_coordinates(&eq);
    return write_speeds(&eq, x);
}

void dense_mechanism_place(const dense_mechanism *self, const dense_mechanism_input *input,
                           dense_mechanism_output *output)
{
    static equations eq;
    set_up(&eq, self, input, output);
}

void dense_mechanism_begin(dense_mechanism *self, const base_frame *carrier, const double *start)
{
    static equations eq;
    static dense_mechanism_output output;
    dense_mechanism_input input = {.state = start, .carrier = carrier};
    const ld_mechanism *given = self->given;
    set_up(&eq, self, &input, &output);
    for (int i = 0; i < given->strut_count; i++)
        self->strut_length[i] =
            isnan(given->strut[i].length) ? line_of(&eq, i).length : given->strut[i].length;
    for (int i = 0; i < given->bushing_count; i++) {
        const ld_bushing *bushing = &given->bushing[i];
        place from = place_of(&eq, mechanism_body(given, bushing->from), v3_from(bushing->at),
                              yaw_pitch_roll(bushing->attitude));
        const dense_frame *to = frame_at(&eq, mechanism_body(given, bushing->to));
        self->bushing_at[i] = v3_from(bushing->to_at);
        if (isnan(bushing->to_at[0]))
            self->bushing_at[i] = m3_apply_transposed(to->A, v3_sub(from.at.r, to->r));
        self->bushing_turn[i] = m3_mul(m3_transpose(to->A), from.at.A);
    }
}
