// link: -Wl,--wrap=history_row
// ctest: slow
// Every column of a run's history by name and value, against a second route: the independent
// equations of support/dense_launch.h and support/dense_vehicle.h at the run's own states,
// velocities by differences, works by quadrature of powers found from those forces. The linker
// leads each row through this test, so that the state is at hand. A new column fails it until what
// the column ought to hold is said here (support/column_book.h).
#include "math/vectors/mat3.h"
#include "model/model.h"
#include "model/parts.h"
#include "state/launch_state.h"
#include "support/column_book.h"
#include "support/dense_simulation.h"
#include "support/recorded_run.h"
#include "support/reference_model.h"

static const char *const xyz[] = {"x", "y", "z"};
static const double two_pi = 6.283185307179586476925;

// A run and what has been summed over it.
typedef struct observer {
    column_book book;
    const ld_model *model;
    dense_launch dense;
    dense_vehicle vehicle;
    ld_model weightless;
    double power[LAUNCHER_MOST_WORKS],
        work[LAUNCHER_MOST_WORKS]; // of the row before, since the start
    double t, height[2], energy;   // at the start: sum of m y; energies
    m3 A_ignition;                 // the undeformed tube at the ignition
    int rows;
} observer;

static observer *watching;

// One row's state.
typedef struct instant {
    observer *run;
    const launch_state *self;
    double t;
    const double *y;           // the state
    dense_launch_input input;  // the same for the independent equations
    dense_launch_output out;   // what they say
    dense_state place;         // in absolute coordinates
    dense_vehicle_input on;    // of a vehicle
    dense_vehicle_output base; // of a vehicle
    const double *orientating, *marching;
} instant;

// ---- the state, a moment on

// A frame in I with its rates.
typedef struct moving {
    v3 r, v, w;
    m3 A;
} moving;

static m3 matrix(const double *A)
{
    m3 result;
    memcpy(result.a, A, sizeof result.a);
    return result;
}

static v3 unit(v3 a)
{
    return v3_scale(1 / v3_norm(a), a);
}

// The input with tube and base moved on by h seconds at their present speeds.
static dense_launch_input moved_on(const dense_launch_input *now, double h)
{
    dense_launch_input next = *now;
    const double *q = now->quaternion, *w = now->w;
    m3 A = q_matrix((quat){q[0], q[1], q[2], q[3]});
    v3_store(next.r, v3_axpy(v3_from(now->r), h, m3_apply(A, v3_from(now->v))));
    double rate[4] = {
        -q[1] * w[0] - q[2] * w[1] - q[3] * w[2], q[0] * w[0] + q[2] * w[2] - q[3] * w[1],
        q[0] * w[1] + q[3] * w[0] - q[1] * w[2], q[0] * w[2] + q[1] * w[1] - q[2] * w[0]};
    for (int i = 0; i < 4; i++)
        next.quaternion[i] += 0.5 * h * rate[i];
    for (int i = 0; i < DENSE_MAX_MODES; i++)
        next.q[i] += h * now->q_dot[i];
    return next;
}

// The tube's section at station x, there a rocket that sits straight on the axis.
static void place_section(const instant *at, double x, double h, dense_state *place)
{
    dense_launch_input input = moved_on(&at->input, h);
    input.s = x;
    input.y = input.z = input.psi = input.theta = input.gamma = 0;
    dense_launch_place(&at->run->dense, &input, place);
}

// With its rates, by central differences.
static moving section(const instant *at, double x)
{
    const double h = 1e-6;
    dense_state now, side[2];
    place_section(at, x, 0, &now);
    place_section(at, x, -h, &side[0]);
    place_section(at, x, h, &side[1]);
    m3 A = matrix(now.A_B[0]), before = matrix(side[0].A_B[0]), after = matrix(side[1].A_B[0]);
    m3 skew = m3_mul(m3_scale(0.5 / h, m3_sub(after, before)), m3_transpose(A));
    return (moving){
        .r = v3_from(now.r_O1),
        .A = A,
        .v = v3_scale(0.5 / h, v3_sub(v3_from(side[1].r_O1), v3_from(side[0].r_O1))),
        .w = {skew.a[2][1], skew.a[0][2], skew.a[1][0]},
    };
}

static moving rocket_frame(const instant *at)
{
    m3 A = matrix(at->place.A_B[0]);
    return (moving){v3_from(at->place.r_O1), v3_from(at->place.v_O1),
                    m3_apply(A, v3_from(at->place.w_B)), A};
}

// The undeformed tube on its base.
static moving carrier(const instant *at)
{
    const dense_base *base = &at->input.conditions.base;
    return (moving){v3_from(base->r), v3_from(base->v), v3_from(base->w), matrix(base->A[0])};
}

static v3 velocity_at(const moving *body, v3 place)
{
    return v3_add(body->v, v3_cross(body->w, v3_sub(place, body->r)));
}

// ---- what is there

// Pitch and yaw of the x axis, and their rates.
static void direction(const moving *body, double value[4])
{
    v3 d = m3_column(body->A, 0), d_dot = v3_cross(body->w, d);
    double level = hypot(d.x, d.z);
    value[0] = asin(d.y);
    value[1] = atan2(-d.z, d.x);
    value[2] = d_dot.y / level;
    value[3] = (d.z * d_dot.x - d.x * d_dot.z) / (level * level);
}

static void expect_direction(column_book *book, const char *stem, const moving *body)
{
    const char *names[] = {"pitch", "yaw", "pitch_rate", "yaw_rate"};
    double value[4];
    direction(body, value);
    for (int i = 0; i < 4; i++) {
        char name[64];
        snprintf(name, sizeof name, "%s%s", stem, names[i]);
        expect(book, name, value[i]);
    }
}

static void expect_pose_angles(column_book *book, const char *part, m3 A)
{
    expect_of(book, part, "yaw", atan2(-A.a[2][0], A.a[0][0]));
    expect_of(book, part, "pitch", asin(A.a[1][0]));
    expect_of(book, part, "roll", atan2(-A.a[1][2], A.a[1][1]));
}

// Place, angles, velocity in I and rate in its own axes of a frame.
static void expect_motion(column_book *book, const char *part, const moving *of)
{
    char stem[64];
    double r[3], v[3], w[3];
    v3_store(r, of->r);
    v3_store(v, of->v);
    v3_store(w, m3_apply_transposed(of->A, of->w));
    snprintf(stem, sizeof stem, "%s.", part);
    expect3(book, stem, xyz, r);
    expect_pose_angles(book, part, of->A);
    snprintf(stem, sizeof stem, "%s.v", part);
    expect3(book, stem, xyz, v);
    snprintf(stem, sizeof stem, "%s.w", part);
    expect3(book, stem, xyz, w);
}

static double sum_of(const ld_sines *sines, double t)
{
    double sum = 0;
    for (int i = 0; i < sines->count; i++)
        sum += sines->term[i].amplitude *
               sin(two_pi * sines->term[i].frequency * t + sines->term[i].phase);
    return sum;
}

static void say_frames(instant *at)
{
    column_book *book = &at->run->book;
    const ld_base *base = &at->run->model->base;
    const launching_layout *where = &at->self->launcher.launching.layout;
    const double *y = at->y;
    expect(book, "t", at->t);
    const launching_phase *phase = &at->self->phase;
    expect(book, "phase",
           !phase->rocket                 ? 3
           : !phase->locked               ? 2
           : at->t < at->self->t_ignition ? 0
                                          : 1);
    expect3(book, "base.", xyz, at->input.conditions.base.r);
    if (base->kind == LD_BASE_VEHICLE) {
        expect_pose_angles(book, "base", matrix(at->input.conditions.base.A[0]));
    } else {
        expect(book, "base.yaw", sum_of(&base->yaw, at->t));
        expect(book, "base.pitch", sum_of(&base->pitch, at->t));
        expect(book, "base.roll", sum_of(&base->roll, at->t));
    }
    expect3(book, "tube.", xyz, y + where->r);
    for (int i = 0; i < 4; i++)
        expect(book, (const char *[]){"tube.q0", "tube.q1", "tube.q2", "tube.q3"}[i],
               y[where->quaternion + i]);
    expect3(book, "tube.v", xyz, y + where->v);
    expect3(book, "tube.w", xyz, y + where->w);
    for (int i = 0; i < where->nq; i++) {
        char name[32];
        snprintf(name, sizeof name, "q%d", i + 1);
        expect(book, name, y[where->q + i]);
        snprintf(name, sizeof name, "q%d_dot", i + 1);
        expect(book, name, y[where->q_dot + i]);
    }
}

static void say_tip(instant *at)
{
    column_book *book = &at->run->book;
    const char *names[] = {"tip.y",  "tip.z",  "tip.pitch",      "tip.yaw",
                           "tip.vy", "tip.vz", "tip.pitch_rate", "tip.yaw_rate"};
    double tip[8];
    dense_launch_tip(&at->run->dense, &at->place, &at->input.conditions.base, tip);
    for (int i = 0; i < 8; i++)
        expect(book, names[i], tip[i]);
    moving end = section(at, at->run->model->tubes.length);
    expect3(book, "tip.inertial_", xyz, (double[]){end.r.x, end.r.y, end.r.z});
    expect3(book, "tip.inertial_v", xyz, (double[]){end.v.x, end.v.y, end.v.z});
    expect_direction(book, "tip.inertial_", &end);
}

// Wrenches that systems.guide_loads compares.
static void say_wrench(column_book *book, const char *part, const char *const names[6],
                       double value[6])
{
    for (int k = 0; k < 6; k++) {
        char name[64];
        snprintf(name, sizeof name, "%s.%s", part, names[k]);
        expect(book, name, value[k] = column_value(book, name));
    }
}

static void say_supports(instant *at)
{
    static const char *const names[] = {"force_x",  "force_y",  "force_z",
                                        "moment_x", "moment_y", "moment_z"};
    double unused[6];
    char part[32];
    for (int i = 0; i < at->run->model->tubes.support_count; i++) {
        snprintf(part, sizeof part, "support.%d", i + 1);
        say_wrench(&at->run->book, part, names, unused);
    }
}

// Motion of the section at a station, and what follows from the wrench that it carries.
static void say_station(instant *at, int i)
{
    static const char *const carried[] = {"axial",  "shear_y",   "shear_z",
                                          "torque", "bending_y", "bending_z"};
    column_book *book = &at->run->book;
    const ld_tubes *tubes = &at->run->model->tubes;
    const ld_section *made = &tubes->section[0];
    char part[32];
    double of[6];
    snprintf(part, sizeof part, "station.%d", i + 1);
    say_wrench(book, part, carried, of);
    const double *fibre = tubes->station[i].outer_fibre;
    double EI = made->bending_stiffness, E = tubes->material.youngs_modulus;
    expect_of(book, part, "bending", hypot(of[4], of[5]));
    expect_of(book, part, "stress", E * (fabs(of[4] * fibre[1]) + fabs(of[5] * fibre[0])) / EI);
    expect_of(book, part, "strain", of[0] / made->axial_stiffness);
    expect_of(book, part, "curvature_y", of[5] / EI);
    expect_of(book, part, "curvature_z", -of[4] / EI);
    moving there = section(at, tubes->station[i].at);
    expect_motion(book, part, &there);
}

// ---- rocket

// Angles of A_SB = Rz(psi) Ry(theta) Rx(gamma) from its elements, as A_SB turns at w.
static void expect_rates_of_angles(column_book *book, const m3 *A, v3 w)
{
    v3 d[3];
    for (int i = 0; i < 3; i++)
        d[i] = v3_cross(w, m3_column(*A, i));
    expect(book, "rocket.psi_dot",
           (A->a[0][0] * d[0].y - A->a[1][0] * d[0].x) /
               (A->a[0][0] * A->a[0][0] + A->a[1][0] * A->a[1][0]));
    expect(book, "rocket.theta_dot", -d[0].z / sqrt(1 - A->a[2][0] * A->a[2][0]));
    expect(book, "rocket.gamma_dot",
           (A->a[2][2] * d[1].z - A->a[2][1] * d[2].z) /
               (A->a[2][2] * A->a[2][2] + A->a[2][1] * A->a[2][1]));
}

enum { LOOKED = 8 };

// The rocket's direction in axes A, its rates, y and z of its mass centre's velocity, its roll and
// that's rate: all as `from` has them, which may move.
static void look(const instant *at, const m3 *A, const moving *from, double value[LOOKED])
{
    moving rocket = rocket_frame(at);
    v3 center = v3_add(rocket.r, m3_apply(rocket.A, v3_from(at->input.conditions.center)));
    v3 v = v3_sub(velocity_at(&rocket, center), velocity_at(from, center));
    moving seen = {.A = m3_mul(m3_transpose(*A), rocket.A),
                   .w = m3_apply_transposed(*A, v3_sub(rocket.w, from->w))};
    direction(&seen, value);
    value[4] = m3_apply_transposed(*A, v).y;
    value[5] = m3_apply_transposed(*A, v).z;
    double c = seen.A.a[1][1], s = -seen.A.a[1][2]; // cos(pitch) times cos and sin of the roll
    m3 spun = {{{0, -seen.w.z, seen.w.y}, {seen.w.z, 0, -seen.w.x}, {-seen.w.y, seen.w.x, 0}}};
    m3 A_dot = m3_mul(spun, seen.A);
    double gamma = at->y[at->self->launcher.launching.layout.x + X_GAMMA], roll = atan2(s, c);
    value[6] = roll + two_pi * round((gamma - roll) / two_pi);
    value[7] = (-A_dot.a[1][2] * c - A_dot.a[1][1] * s) / (c * c + s * s);
}

static void say_against_launcher(instant *at)
{
    static const char *const names[LOOKED] = {"pitch", "yaw", "pitch_rate", "yaw_rate",
                                              "vy",    "vz",  "roll",       "roll_rate"};
    observer *run = at->run;
    moving tube = carrier(at), still = {.v = {0}};
    if (at->t == at->self->t_ignition)
        run->A_ignition = tube.A;
    double inertial[LOOKED], relative[LOOKED], since[LOOKED];
    look(at, &tube.A, &still, inertial);
    look(at, &tube.A, &tube, relative);
    look(at, &run->A_ignition, &still, since);
    for (int i = 0; i < LOOKED; i++) {
        char name[32];
        snprintf(name, sizeof name, "%s_relative", names[i]);
        if (i < 6)
            expect_of(&run->book, "tip_off", names[i], inertial[i]);
        if (i > 1 && i < 6)
            expect_of(&run->book, "tip_off", name, relative[i]);
        expect_of(&run->book, "since_ignition", names[i],
                  at->t < at->self->t_ignition ? NAN : since[i]);
    }
}

// Rates, angular acceleration and specific force by the independent equations, whose R is the
// state's.
static void say_inertial(instant *at, const moving *rocket)
{
    const launching_layout *where = &at->self->launcher.launching.layout;
    const double *q = at->y + where->quaternion;
    m3 A_IR = q_matrix((quat){q[0], q[1], q[2], q[3]});
    v3 a = m3_apply(A_IR, v3_from(at->out.a_O1)), alpha = m3_apply(A_IR, v3_from(at->out.alpha_B));
    a.y += at->run->model->gravity;
    double force[3], rate[3];
    v3_store(force, m3_apply_transposed(rocket->A, a));
    v3_store(rate, m3_apply_transposed(rocket->A, alpha));
    const char *const dots[] = {"x_dot", "y_dot", "z_dot"};
    expect3(&at->run->book, "rocket.w", xyz, at->place.w_B);
    expect3(&at->run->book, "rocket.w", dots, rate);
    expect3(&at->run->book, "rocket.f", xyz, force);
    v3 center = v3_add(rocket->r, m3_apply(rocket->A, v3_from(at->input.conditions.center)));
    v3 v = velocity_at(rocket, center);
    expect3(&at->run->book, "center.", xyz, (double[]){center.x, center.y, center.z});
    expect3(&at->run->book, "center.v", xyz, (double[]){v.x, v.y, v.z});
}

static void say_rocket(instant *at)
{
    column_book *book = &at->run->book;
    const dense_launch_output *out = &at->out;
    moving rocket = rocket_frame(at);
    const char *names[] = {"s", "y", "z", "psi", "theta", "gamma"};
    double x[] = {out->s, out->y, out->z, out->psi, out->theta, out->gamma};
    for (int i = 0; i < 6; i++)
        expect_of(book, "rocket", names[i], x[i]);
    // the section's own motion under the rocket counts in the rate of y and z
    moving under = section(at, out->s);
    const double h = 1e-6;
    dense_state side[2];
    place_section(at, out->s - h, 0, &side[0]);
    place_section(at, out->s + h, 0, &side[1]);
    m3 turn = m3_mul(m3_scale(0.5 / h, m3_sub(matrix(side[1].A_B[0]), matrix(side[0].A_B[0]))),
                     m3_transpose(under.A));
    v3 w = v3_axpy(under.w, out->s_dot, (v3){turn.a[2][1], turn.a[0][2], turn.a[1][0]});
    v3 v = v3_axpy(under.v, 0.5 * out->s_dot / h,
                   v3_sub(v3_from(side[1].r_O1), v3_from(side[0].r_O1)));
    v3 offset = v3_sub(rocket.r, under.r);
    v3 slip = m3_apply_transposed(under.A, v3_sub(v3_sub(rocket.v, v), v3_cross(w, offset)));
    expect(book, "rocket.s_dot", out->s_dot);
    expect(book, "rocket.y_dot", slip.y);
    expect(book, "rocket.z_dot", slip.z);
    m3 relative = m3_mul(m3_transpose(under.A), rocket.A);
    // at the tip the curvature jumps, and S with it: a row there may be on either side
    if (fabs(out->s - at->run->model->tubes.length) > 1e-9)
        expect_rates_of_angles(book, &relative, v3_from(out->w_SB));
    expect3(book, "rocket.w_", xyz, out->w_SB);
    expect3(book, "rocket.v", xyz, (double[]){rocket.v.x, rocket.v.y, rocket.v.z});
    expect_direction(book, "rocket.", &rocket);
    expect(book, "rocket.spin", at->place.w_B[0]);
    say_inertial(at, &rocket);
    expect(book, "rocket.mass", at->input.conditions.mass);
    expect(book, "thrust", at->input.conditions.thrust);
    if (at->run->model->tubes.slot.kind == LD_SLOT_HELIX)
        expect(book, "slot.force", out->slot_force);
    expect(book, "lock.force", out->lock_force);
    expect(book, "breech.force", out->breech_force);
    say_against_launcher(at);
}

// Adaptor i: its columns; powers of its normal force and of its friction on rocket and tube.
static void say_contact(instant *at, int i, double power[LAUNCHER_MOST_WORKS])
{
    const ld_adaptor *adaptor = &at->run->model->rocket.adaptor[i];
    char part[80];
    snprintf(part, sizeof part, "contact.%s", adaptor->name);
    column_book *book = &at->run->book;
    bool passed = at->self->phase.passed[i];
    v3 force = passed ? v3_zero() : v3_from(at->out.contact[i].force);
    double normal = passed ? 0 : at->out.contact[i].normal;
    moving rocket = rocket_frame(at), foot = section(at, at->out.contact[i].s);
    v3 center = v3_axpy(rocket.r, adaptor->at, m3_column(rocket.A, 0));
    v3 offset = m3_apply_transposed(foot.A, v3_sub(center, foot.r));
    expect_of(book, part, "force", v3_norm(force));
    expect_of(book, part, "normal", normal);
    expect_of(book, part, "penetration",
              passed ? NAN : hypot(offset.y, offset.z) - adaptor->clearance);
    expect_of(book, part, "y", passed ? NAN : offset.y);
    expect_of(book, part, "z", passed ? NAN : offset.z);
    // at the wall
    v3 outward = m3_apply(foot.A, unit(v3_make(0, offset.y, offset.z)));
    v3 wall = v3_axpy(foot.r, at->run->model->tubes.section[0].bore_radius, outward);
    v3 slip = v3_sub(velocity_at(&rocket, wall), velocity_at(&foot, wall));
    double all = v3_dot(force, slip), pressing = -normal * v3_dot(outward, slip);
    power[POWER_CONTACT_NORMAL] += pressing;
    power[POWER_CONTACT_FRICTION] += all - pressing;
}

static void breech_power(const instant *at, double power[LAUNCHER_MOST_WORKS])
{
    moving rocket = rocket_frame(at), under = section(at, at->out.s),
           stop = section(at, at->input.conditions.breech);
    v3 slip = v3_sub(rocket.v, velocity_at(&stop, rocket.r));
    power[POWER_CONTACT_NORMAL] += at->out.breech_force * v3_dot(m3_column(under.A, 0), slip);
}

// The friction of the slot against the knob's sliding, and its power.
static void say_slot(instant *at, double power[LAUNCHER_MOST_WORKS])
{
    const ld_model *model = at->run->model;
    const ld_slot *slot = &model->tubes.slot;
    double knob = model->rocket.knob_angle, alpha = slot->angle.data[1];
    moving rocket = rocket_frame(at), under = section(at, at->out.s);
    v3 E =
        v3_add(rocket.r,
               m3_apply(rocket.A, v3_make(0, slot->radius * cos(knob), slot->radius * sin(knob))));
    v3 slip = v3_sub(velocity_at(&rocket, E), velocity_at(&under, E));
    v3 local = m3_apply_transposed(under.A, v3_sub(E, under.r));
    double radius = hypot(local.y, local.z);
    v3 tau = m3_apply(under.A, v3_make(cos(alpha), -sin(alpha) * local.z / radius,
                                       sin(alpha) * local.y / radius));
    double along = v3_dot(tau, slip), v_eps = model->rocket.contact.friction_speed;
    double drag = at->self->phase.locked ? 0
                                         : -slot->friction * fabs(at->out.slot_force) * along /
                                               sqrt(along * along + v_eps * v_eps);
    expect(&at->run->book, "slot.friction", drag);
    power[POWER_SLOT_FRICTION] = drag * along;
}

// The power of the air's force per length, by Simpson's rule along what is out of the tube.
static void say_crossflow(instant *at, double power[LAUNCHER_MOST_WORKS])
{
    enum { STRETCHES = 64 };
    const ld_model *model = at->run->model;
    const ld_aerodynamics *given = &model->rocket.aerodynamics;
    column_book *book = &at->run->book;
    const dense_launch_output *out = &at->out;
    expect(book, "crossflow.length", out->emerged);
    expect(book, "crossflow.y", out->crossflow[1]);
    expect(book, "crossflow.z", out->crossflow[2]);
    moving rocket = rocket_frame(at);
    v3 axis = m3_column(rocket.A, 0), breeze = v3_from(at->input.conditions.air);
    double half = 0.5 * at->input.conditions.density * given->emerged.drag;
    for (int k = 0; k <= STRETCHES; k++) {
        double x = given->emerged.nose - out->emerged * k / STRETCHES;
        double share = (k == 0 || k == STRETCHES ? 1 : k % 2 ? 4 : 2) / (3.0 * STRETCHES);
        v3 v = velocity_at(&rocket, v3_axpy(rocket.r, x, axis)), slip = v3_sub(v, breeze);
        v3 lateral = v3_axpy(slip, -v3_dot(slip, axis), axis);
        double per_length = -half * given->emerged.diameter * v3_norm(lateral);
        power[POWER_AIR] += share * out->emerged * per_length * v3_dot(lateral, v);
    }
}

// The power of the wind's force per length on the only section in it, by Simpson's rule.
static void say_guide_wind(instant *at, double power[LAUNCHER_MOST_WORKS])
{
    enum { STRETCHES = 8 };
    const ld_wind_drag *given = at->run->model->tubes.wind_drag;
    column_book *book = &at->run->book;
    const dense_conditions *on = &at->input.conditions;
    expect3(book, "guide_wind.", xyz, at->out.guide_wind);
    double length = given->to - given->from;
    for (int k = 0; k <= STRETCHES; k++) {
        double share = (k == 0 || k == STRETCHES ? 1 : k % 2 ? 4 : 2) / (3.0 * STRETCHES);
        moving part = section(at, given->from + length * k / STRETCHES);
        v3 axis = m3_column(part.A, 0), flow = v3_sub(v3_from(on->air), part.v);
        flow = v3_axpy(flow, -v3_dot(flow, axis), axis);
        double half = 0.5 * on->density * given->coefficient * given->width;
        power[POWER_GUIDE_WIND] += share * length * half * v3_norm(flow) * v3_dot(flow, part.v);
    }
}

// The force of the pressure at O1 along the section there, and against the rear section at its own.
static void say_pressure(instant *at, double power[LAUNCHER_MOST_WORKS])
{
    const ld_model *model = at->run->model;
    double radius = model->tubes.section[0].bore_radius, force = at->out.gas_force;
    moving rocket = rocket_frame(at), under = section(at, at->out.s), rear = section(at, 0);
    expect(&at->run->book, "pressure.force", force);
    expect(&at->run->book, "pressure.net", force / (acos(-1) * radius * radius));
    power[POWER_PRESSURE] =
        force * (v3_dot(m3_column(under.A, 0), rocket.v) - v3_dot(m3_column(rear.A, 0), rear.v));
}

// The only slide: travel back of its section on the base, its force; power of its stop's damper
// apart from that of its own damping and friction.
static void say_recoil(instant *at, const ld_support *support, double power[LAUNCHER_MOST_WORKS])
{
    const ld_recoil *slide = &support->recoil;
    moving held = section(at, support->at), under = carrier(at);
    v3 d = m3_apply_transposed(under.A, v3_sub(held.r, under.r));
    v3 v = m3_apply_transposed(under.A, v3_sub(held.v, velocity_at(&under, held.r)));
    double back = support->at - d.x, rubs = v.x / hypot(v.x, slide->friction_speed);
    double drag =
        slide->damping * v.x + slide->quadratic_damping * v.x * fabs(v.x) + slide->friction * rubs;
    double stop = back < 0 ? fmax(support->damping[0] * v.x, support->stiffness[0] * back) : 0;
    expect(&at->run->book, "recoil.1.travel", back);
    expect(&at->run->book, "recoil.1.rate", -v.x);
    expect(&at->run->book, "recoil.1.force", at->out.slide_force);
    power[POWER_RECOIL] -= drag * v.x;
    power[POWER_SUPPORT_DAMPING] += (support->damping[0] * v.x - stop) * v.x;
}

static double kinetic_of(const dense_conditions *on, const moving *rocket)
{
    m3 J = m3_diagonal(on->inertia[0], on->inertia[1], on->inertia[2]);
    J.a[0][1] = J.a[1][0] = on->products[0];
    J.a[0][2] = J.a[2][0] = on->products[1];
    J.a[1][2] = J.a[2][1] = on->products[2];
    v3 center = v3_add(rocket->r, m3_apply(rocket->A, v3_from(on->center)));
    v3 v = velocity_at(rocket, center), w = m3_apply_transposed(rocket->A, rocket->w);
    return 0.5 * on->mass * v3_norm2(v) + 0.5 * v3_dot(w, m3_apply(J, w));
}

static void rocket_powers(const instant *at, double power[LAUNCHER_MOST_WORKS])
{
    const ld_model *model = at->run->model;
    const dense_conditions *on = &at->input.conditions;
    const ld_motor *thruster = &model->rocket.motor;
    moving rocket = rocket_frame(at);
    v3 center = v3_add(rocket.r, m3_apply(rocket.A, v3_from(on->center)));
    v3 nozzle = v3_add(rocket.r, m3_apply(rocket.A, v3_from(thruster->at)));
    v3 push = unit(v3_make(1, thruster->misalignment[0], thruster->misalignment[1]));
    power[POWER_GRAVITY_ROCKET] = -on->mass * model->gravity * velocity_at(&rocket, center).y;
    power[POWER_THRUST] =
        on->thrust * v3_dot(m3_apply(rocket.A, push), velocity_at(&rocket, nozzle));
    // kinetic energy by what burns, the speeds held
    const double h = 1e-5;
    dense_conditions side[2] = {*on, *on};
    double since = at->t - at->self->t_ignition;
    dense_rocket_at(model, since - h, since, &side[0]);
    dense_rocket_at(model, since + h, since, &side[1]);
    power[POWER_MASS_CHANGE] =
        (kinetic_of(&side[1], &rocket) - kinetic_of(&side[0], &rocket)) / (2 * h);
}

// ---- tube

static void tube_powers(const instant *at, double power[LAUNCHER_MOST_WORKS])
{
    const flexible_tube *tube = at->run->dense.tube;
    moving under = carrier(at);
    m3 A = under.A;
    v3 v = m3_apply_transposed(A, under.v), w = m3_apply_transposed(A, under.w);
    power[POWER_BASE] =
        -v3_dot(v3_from(at->out.base_force), v) - v3_dot(v3_from(at->out.base_moment), w);
    const double *q_dot = at->input.q_dot;
    for (int i = 0; i < 2 * tube->nb; i++)
        for (int j = 0; j < tube->nb; j++) {
            int plane = i / tube->nb, k = i % tube->nb;
            power[POWER_MODAL_DAMPING] -=
                q_dot[i] * at->run->dense.D[plane][k][j] * q_dot[plane * tube->nb + j];
        }
    for (int i = 0; i < tube->nt; i++)
        power[POWER_MODAL_DAMPING] -=
            tube->dmp_t[i] * q_dot[2 * tube->nb + i] * q_dot[2 * tube->nb + i];
    for (int i = 0; i < at->run->model->tubes.support_count; i++) {
        const ld_support *support = &at->run->model->tubes.support[i];
        moving held = section(at, support->at);
        v3 rate = m3_apply_transposed(A, v3_sub(held.v, velocity_at(&under, held.r)));
        v3 turning = m3_apply_transposed(A, v3_sub(held.w, under.w));
        power[POWER_SUPPORT_DAMPING] -=
            v3_dot(v3_mul(v3_from(support->damping), rate), rate) +
            v3_dot(v3_mul(v3_from(support->rotational_damping), turning), turning);
    }
}

// ---- vehicle

static void say_chassis(instant *at)
{
    column_book *book = &at->run->book;
    const ld_vehicle *vehicle = &at->run->model->base.vehicle;
    const double *o = at->orientating;
    m3 A = q_matrix(q_from(o + VEHICLE_QUATERNION));
    expect3(book, "chassis.", xyz, o + VEHICLE_R);
    expect_pose_angles(book, "chassis", A);
    expect3(book, "chassis.v", xyz, o + VEHICLE_V);
    expect3(book, "chassis.w", xyz, o + VEHICLE_W);
    double heading = atan2(-A.a[2][0], A.a[0][0]);
    double speed = o[VEHICLE_V] * cos(heading) - o[VEHICLE_V + 2] * sin(heading);
    expect(book, "drive.speed", speed);
    expect(book, "drive.force",
           vehicle->drive.kp * (vehicle->speed - speed) +
               vehicle->drive.ki * at->marching[WHEEL_STATES * vehicle->wheel_count]);
}

// The platforms, each turned on its hinge by an angle about y or z of what carries it.
static void say_platforms(instant *at)
{
    const ld_platform *given = &at->run->model->platform;
    const ld_turret *turret[HINGES] = {&given->azimuth, &given->elevation};
    const double *o = at->orientating;
    m3 A = q_matrix(q_from(o + VEHICLE_QUATERNION));
    moving carries = {v3_from(o + VEHICLE_R), v3_from(o + VEHICLE_V),
                      m3_apply(A, v3_from(o + VEHICLE_W)), A};
    for (int i = 0; i < HINGES; i++) {
        double c = cos(o[VEHICLE_ANGLE + i]), s = sin(o[VEHICLE_ANGLE + i]);
        const m3 turned[HINGES] = {{{{c, 0, s}, {0, 1, 0}, {-s, 0, c}}},
                                   {{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}}};
        v3 axis = m3_column(carries.A, i + 1);
        v3 hinge = v3_add(carries.r, m3_apply(carries.A, v3_from(turret[i]->hinge_at)));
        carries =
            (moving){hinge, velocity_at(&carries, hinge),
                     v3_axpy(carries.w, o[VEHICLE_RATE + i], axis), m3_mul(carries.A, turned[i])};
        expect_motion(&at->run->book, i ? "elevation" : "azimuth", &carries);
    }
}

static void say_hinges(instant *at, double power[VEHICLE_BODY_POWERS])
{
    column_book *book = &at->run->book;
    for (int i = 0; i < HINGES; i++) {
        const char *part = i ? "elevation" : "azimuth";
        double rate = at->orientating[VEHICLE_RATE + i];
        double torque = at->base.hinge[i].torque, friction = at->base.hinge[i].friction;
        expect_of(book, part, "angle", at->orientating[VEHICLE_ANGLE + i]);
        expect_of(book, part, "rate", rate);
        expect_of(book, part, "measured", at->base.hinge[i].measured);
        expect_of(book, part, "command", at->base.hinge[i].measured + at->base.hinge[i].error);
        expect_of(book, part, "error", at->base.hinge[i].error);
        expect_of(book, part, "torque", torque);
        expect_of(book, part, "friction", friction);
        power[VEHICLE_STABILISERS] += torque * rate;
        power[VEHICLE_FRICTION] += friction * rate;
    }
}

// Wheel i: its columns; powers of its damper and of the road.
static void say_wheel(instant *at, int i, double power[MARCHING_POWERS])
{
    column_book *book = &at->run->book;
    const ld_vehicle *vehicle = &at->run->model->base.vehicle;
    const double *o = at->orientating, *wheel = at->marching + WHEEL_STATES * i;
    char part[80], stem[96];
    snprintf(part, sizeof part, "wheel.%s", vehicle->wheel[i].name);
    snprintf(stem, sizeof stem, "%s.", part);
    v3 r = v3_from(wheel + WHEEL_R), v = v3_from(wheel + WHEEL_V);
    double slope;
    double height = dense_road_height(&vehicle->road, vehicle->wheel[i].mount[2], r.x, &slope);
    expect3(book, stem, xyz, wheel + WHEEL_R);
    expect_of(book, part, "road", height);
    expect_of(book, part, "travel", at->base.wheel[i].travel.y);
    expect_of(book, part, "deflection", at->base.wheel[i].deflection);
    expect_of(book, part, "tyre_force", at->base.wheel[i].normal);
    expect_of(book, part, "along", at->base.wheel[i].along);
    expect_of(book, part, "side", at->base.wheel[i].side);
    // the carrier turns with the chassis
    m3 A = q_matrix(q_from(o + VEHICLE_QUATERNION));
    moving chassis = {v3_from(o + VEHICLE_R), v3_from(o + VEHICLE_V),
                      m3_apply(A, v3_from(o + VEHICLE_W)), A};
    v3 drift = m3_apply_transposed(A, v3_sub(v, velocity_at(&chassis, r)));
    v3 slip = v3_add(v, v3_cross(chassis.w, v3_make(0, height - r.y, 0)));
    double heading = atan2(-A.a[2][0], A.a[0][0]);
    v3 along = v3_make(cos(heading), 0, -sin(heading)),
       side = v3_make(sin(heading), 0, cos(heading));
    power[MARCHING_SUSPENSION] -=
        v3_dot(v3_mul(v3_from(vehicle->suspension.damping), drift), drift);
    power[MARCHING_TYRE] += at->base.wheel[i].normal * v.y;
    power[MARCHING_SIDE] += at->base.wheel[i].side * v3_dot(side, slip);
    power[MARCHING_DRIVE] += at->base.wheel[i].along * v3_dot(along, slip);
}

// Sums of m y [kg m]: of chassis and platforms, of the wheels.
static void heights(const instant *at, double sum[2])
{
    const ld_model *model = at->run->model;
    const double *o = at->orientating;
    v3 r = v3_from(o + VEHICLE_R);
    m3 A = q_matrix(q_from(o + VEHICLE_QUATERNION));
    sum[0] = sum[1] = 0;
    for (int i = 0; i < DENSE_BODIES; i++) {
        if (i > 0) {
            const ld_turret *turret =
                i == 1 ? &model->platform.azimuth : &model->platform.elevation;
            double angle = o[VEHICLE_ANGLE + i - 1];
            r = v3_add(r, m3_apply(A, v3_from(turret->hinge_at)));
            A = m3_mul(A, i == 1 ? m3_rotation_y(angle) : m3_rotation_z(angle));
        }
        for (int k = 0; k < at->run->vehicle.body[i].count; k++) {
            const dense_part *part = &at->run->vehicle.body[i].part[k];
            sum[0] += part->mass * v3_add(r, m3_apply(A, part->center)).y;
        }
    }
    for (int i = 0; i < model->base.vehicle.wheel_count; i++)
        sum[1] += model->base.vehicle.wheel[i].mass * at->marching[WHEEL_STATES * i + WHEEL_R + 1];
}

static void say_vehicle(instant *at, double power[LAUNCHER_MOST_WORKS])
{
    say_chassis(at);
    say_platforms(at);
    say_hinges(at, power + POWER_COUNT);
    for (int i = 0; i < at->run->model->base.vehicle.wheel_count; i++)
        say_wheel(at, i, power + POWER_COUNT + VEHICLE_BODY_POWERS);
}

// ---- energies and works

#define BASE_WORK(place) [(int)POWER_COUNT + (int)(place)]
#define WHEEL_WORK(place) [(int)POWER_COUNT + (int)VEHICLE_BODY_POWERS + (int)(place)]
static const char *const work_names[LAUNCHER_MOST_WORKS] = {
    [POWER_THRUST] = "thrust",
    [POWER_GRAVITY_ROCKET] = "gravity_rocket",
    [POWER_CONTACT_NORMAL] = "contact_normal",
    [POWER_CONTACT_FRICTION] = "contact_friction",
    [POWER_SLOT] = "slot",
    [POWER_SLOT_FRICTION] = "slot_friction",
    [POWER_LOCK] = "lock",
    [POWER_SUPPORT_DAMPING] = "support_damping",
    [POWER_MODAL_DAMPING] = "modal_damping",
    [POWER_BASE] = "base",
    [POWER_MASS_CHANGE] = "mass_change",
    [POWER_AIR] = "crossflow",
    [POWER_PRESSURE] = "pressure",
    [POWER_RECOIL] = "recoil",
    [POWER_LINE] = "line",
    [POWER_GUIDE_WIND] = "guide_wind",
    [POWER_GUIDE_JET] = "guide_jet",
    BASE_WORK(VEHICLE_STABILISERS) = "stabilisers",
    BASE_WORK(VEHICLE_FRICTION) = "hinge_friction",
    BASE_WORK(VEHICLE_GRAVITY) = "gravity_platform",
    WHEEL_WORK(MARCHING_GRAVITY) = "gravity_wheels",
    WHEEL_WORK(MARCHING_SUSPENSION) = "suspension_damping",
    WHEEL_WORK(MARCHING_TYRE) = "tyre",
    WHEEL_WORK(MARCHING_SIDE) = "tyre_side",
    WHEEL_WORK(MARCHING_DRIVE) = "drive",
    BASE_WORK(VEHICLE_JET) = "jet",
};

static const char *work_name(int i)
{
    if (!work_names[i])
        fail_msg("work %d has no name in work_names", i);
    return work_names[i];
}

// Whether a run has work i.
static bool has_work(const ld_model *model, int i)
{
    if (i == POWER_SLOT || i == POWER_SLOT_FRICTION)
        return model->tubes.slot.kind == LD_SLOT_HELIX;
    if (i == POWER_AIR)
        return model_has_crossflow(model);
    if (i == POWER_PRESSURE)
        return model_has_pressure(model);
    if (i == POWER_RECOIL)
        return model_slide_count(model) > 0;
    if (i == POWER_LINE)
        return model->rocket.line.present;
    if (i == POWER_GUIDE_WIND)
        return model_has_guide_wind(model);
    if (i == POWER_GUIDE_JET)
        return model_has_guide_jet(model);
    if (i == POWER_COUNT + VEHICLE_JET)
        return model_has_jet(model);
    return i < POWER_COUNT || model_has_vehicle(model);
}

// Elastic energy: what is left of the potential without gravity.
static void say_energies(instant *at)
{
    observer *run = at->run;
    column_book *book = &run->book;
    bool vehicle = run->model->base.kind == LD_BASE_VEHICLE;
    dense_launch light = run->dense;
    dense_launch_output still;
    light.model = &run->weightless;
    assert_true(dense_launch_evaluate(&light, &at->input, &still));
    const dense_conditions *on = &at->input.conditions;
    moving rocket = rocket_frame(at);
    v3 center = v3_add(rocket.r, m3_apply(rocket.A, v3_from(on->center)));
    double kinetic = at->out.kinetic, elastic = still.potential;
    double potential =
        at->out.potential - still.potential - on->mass * run->model->gravity * center.y;
    if (vehicle) {
        dense_vehicle floating = run->vehicle;
        dense_vehicle_output afloat;
        floating.model = &run->weightless;
        assert_true(dense_vehicle_evaluate(&floating, &at->on, &afloat));
        kinetic += at->base.kinetic;
        elastic += afloat.potential;
    }
    expect(book, "energy.kinetic", kinetic);
    expect(book, "energy.potential", potential);
    expect(book, "energy.elastic", elastic);
    if (run->rows == 0)
        run->energy = kinetic + potential + elastic;
    double balance = kinetic + potential + elastic - run->energy;
    for (int i = 0; i < POWER_COUNT + VEHICLE_POWERS; i++) {
        char name[64];
        if (!has_work(run->model, i))
            continue;
        snprintf(name, sizeof name, "work.%s", work_name(i));
        balance -= vehicle && i == POWER_BASE ? 0 : column_value(book, name);
    }
    expect(book, "energy.residual", balance);
}

// Works by the trapezoidal rule over the rows; of gravity on the vehicle, from its height.
static void say_works(instant *at, const double *power)
{
    observer *run = at->run;
    double sum[2] = {0};
    bool vehicle = run->model->base.kind == LD_BASE_VEHICLE;
    if (vehicle)
        heights(at, sum);
    if (run->rows == 0)
        memcpy(run->height, sum, sizeof sum);
    for (int i = 0; i < POWER_COUNT + VEHICLE_POWERS; i++) {
        if (!has_work(run->model, i))
            continue;
        if (run->rows > 0)
            run->work[i] += 0.5 * (power[i] + run->power[i]) * (at->t - run->t);
        if (i == POWER_COUNT + VEHICLE_GRAVITY)
            run->work[i] = -run->model->gravity * (sum[0] - run->height[0]);
        if (i == POWER_COUNT + VEHICLE_BODY_POWERS + MARCHING_GRAVITY)
            run->work[i] = -run->model->gravity * (sum[1] - run->height[1]);
        expect_of(&run->book, "work", work_name(i), run->work[i]);
        run->power[i] = power[i];
    }
}

// ---- the run

// The program's state for the independent equations.
static void load(instant *at)
{
    const launching_layout *where = &at->self->launcher.launching.layout;
    const double *y = at->y;
    dense_launch_input *in = &at->input;
    dense_conditions *on = &in->conditions;
    size_t modes = (size_t)where->nq * sizeof *y;
    memcpy(in->r, y + where->r, sizeof in->r);
    memcpy(in->quaternion, y + where->quaternion, sizeof in->quaternion);
    memcpy(in->v, y + where->v, sizeof in->v);
    memcpy(in->w, y + where->w, sizeof in->w);
    memcpy(in->q, y + where->q, modes);
    memcpy(in->q_dot, y + where->q_dot, modes);
    memcpy(&in->s, y + where->x, 6 * sizeof *y);
    memcpy(in->V, y + where->V, sizeof in->V);
    double since = at->t - at->self->t_ignition;
    dense_rocket_at(at->run->model, since, since - 1e-9, on);
    dense_air_at(at->run->model, on);
    on->pressed = at->self->pressure_piece > 0;
    on->pressure = dense_pressure_at(&at->run->model->tubes.pressure, since, since - 1e-9);
    on->locked = at->self->phase.locked;
    memcpy(on->passed, at->self->phase.passed, sizeof on->passed);
    memcpy(on->touch_speed, at->self->phase.touch_speed, sizeof on->touch_speed);
    on->breech = at->run->model->rocket.start_at;
    on->breech_speed = at->self->phase.breech_speed;
    at->orientating = y + at->self->launcher.base_at;
    at->marching = at->orientating + VEHICLE_BODY_STATES;
    if (at->run->model->base.kind != LD_BASE_VEHICLE) {
        dense_base_at(at->run->model, at->t, &on->base);
        return;
    }
    base_frame tube;
    dense_vehicle_tube(&at->run->vehicle, at->orientating, &tube);
    v3_store(on->base.r, tube.r);
    v3_store(on->base.v, tube.v);
    v3_store(on->base.w, tube.w);
    memcpy(on->base.A, tube.A.a, sizeof on->base.A);
}

// At the start tube and rocket move with the base as one rigid body.
static void check_rest(const column_book *book)
{
    const char *const rates[] = {"tip.vy",       "tip.vz",       "tip.pitch_rate", "tip.yaw_rate",
                                 "rocket.s_dot", "rocket.y_dot", "rocket.z_dot",   "rocket.w_x",
                                 "rocket.w_y",   "rocket.w_z"};
    double largest = 0;
    for (size_t i = 0; i < sizeof rates / sizeof *rates; i++)
        largest = fmax(largest, fabs(column_value(book, rates[i])));
    CHECK_BELOW("against the base at the start [m/s, rad/s]", largest, 1e-14);
}

static void look_at_row(observer *run, const launch_state *self, double t, const double *y,
                        const double *row)
{
    instant at = {.run = run, .self = self, .t = t, .y = y};
    double power[LAUNCHER_MOST_WORKS] = {0};
    run->book.row = row;
    load(&at);
    dense_launch_place(&run->dense, &at.input, &at.place);
    assert_true(dense_launch_rates(&run->dense, &at.place, &at.input.conditions, NULL, &at.out));
    say_frames(&at);
    say_tip(&at);
    for (int i = 0; i < run->model->tubes.station_count; i++)
        say_station(&at, i);
    if (run->model->tubes.station_count)
        say_supports(&at);
    say_rocket(&at);
    for (int i = 0; i < run->model->rocket.adaptor_count; i++)
        say_contact(&at, i, power);
    breech_power(&at, power);
    say_slot(&at, power);
    rocket_powers(&at, power);
    if (model_has_crossflow(run->model))
        say_crossflow(&at, power);
    if (model_has_guide_wind(run->model))
        say_guide_wind(&at, power);
    tube_powers(&at, power);
    if (model_has_pressure(run->model))
        say_pressure(&at, power);
    if (model_slide_count(run->model))
        say_recoil(&at, &run->model->tubes.support[0], power);
    if (run->model->base.kind == LD_BASE_VEHICLE) {
        at.on = (dense_vehicle_input){.t = t,
                                      .command_at = t,
                                      .orientating = at.orientating,
                                      .marching = at.marching,
                                      .tube_force = v3_from(at.out.base_force),
                                      .tube_moment = v3_from(at.out.base_moment)};
        memcpy(at.on.rest, self->rest.hold, sizeof at.on.rest);
        assert_true(dense_vehicle_evaluate(&run->vehicle, &at.on, &at.base));
        say_vehicle(&at, power);
    }
    say_energies(&at);
    say_works(&at, power);
    if (run->rows == 0)
        check_rest(&run->book);
    run->t = t;
    run->rows++;
}

void __real_history_row(const launch_state *self, double t, const double *y, double energy_start,
                        double *row);
void __wrap_history_row(const launch_state *self, double t, const double *y, double energy_start,
                        double *row);

void __wrap_history_row(const launch_state *self, double t, const double *y, double energy_start,
                        double *row)
{
    __real_history_row(self, t, y, energy_start, row);
    // at the tip the curvature jumps, and the rate of S with it: that row may be on either side
    const launching_system *launching = &self->launcher.launching;
    bool at_tip = fabs(y[launching->layout.x] - launching->tube.flexible.length) < 1e-9;
    if (watching && !at_tip)
        look_at_row(watching, self, t, y, row);
}

static ld_status begin(void *self, const ld_column *columns, size_t count, ld_error *error)
{
    observer *run = self;
    (void)error;
    assert_true(count <= BOOK_COLUMNS);
    run->book.column = columns;
    run->book.count = count;
    return LD_OK;
}

static ld_status row(void *self, const double *values, size_t count, ld_error *error)
{
    (void)self, (void)values, (void)count, (void)error;
    return LD_OK;
}

// Off its axes everywhere, so that no column is zero.
static void make_uneven(ld_model *model)
{
    ld_rocket *rocket = &model->rocket;
    model->tubes.modes.bending = 3;
    model->tubes.modes.torsion = 1;
    model->run.output_step_lead_in = 5e-4;
    model->run.output_step_tube = 1e-4;
    rocket->start_at = 0.9;
    rocket->knob_angle = 0.7;
    rocket->mass_error = 0.3;
    rocket->eccentricity[0] = 1e-3;
    rocket->eccentricity[1] = -2e-3;
    rocket->products[0] = 0.02;
    rocket->products[1] = -0.01;
    // burns fast, and from one side
    rocket->empty.center[1] = 0.1;
    rocket->empty.center[2] = -0.2;
    rocket->motor.misalignment[0] = 2e-3;
    rocket->motor.misalignment[1] = -1e-3;
    rocket->motor.at[1] = 1e-3;
    rocket->motor.thrust.data[4] = 0.3;
    rocket->motor.thrust.data[6] = 0.35;
    rocket->motor.thrust.data[3] = rocket->motor.thrust.data[5] = 3e4;
}

// Wind across, and a nose that is out of the tube before the rocket moves.
static void let_the_wind_blow(ld_model *model)
{
    ld_aerodynamics *given = &model->rocket.aerodynamics;
    given->present = given->emerged.present = true;
    given->model = LD_AERODYNAMICS_BODY;
    given->emerged.nose = 2.5;
    given->emerged.drag = 1.2;
    given->emerged.diameter = 0.122;
    model->environment.atmosphere.kind = LD_ATMOSPHERE_UNIFORM;
    model->environment.atmosphere.density = 1.21;
    model->environment.atmosphere.speed_of_sound = 340;
    model->environment.wind.present = true;
    model->environment.wind.speed = 25;
    model->environment.wind.heading = 1.1;
    model->tubes.wind_drag_count = 1;
    model->tubes.wind_drag[0] = (ld_wind_drag){0.5, 2.7, 0.4, 1.3};
}

static void watch_run(const ld_model *model, const column_bound *bound, size_t bounds)
{
    ld_error error;
    ld_simulation *simulation;
    ld_summary summary;
    observer *run = calloc(1, sizeof *run);
    ld_sink sink = {.self = run, .begin = begin, .row = row};
    run->model = model;
    run->weightless = *model;
    run->weightless.gravity = 0;
    if (ld_simulation_create(model, &simulation, &error))
        fail_msg("%s", error.text);
    dense_launch_create(&run->dense, model, &simulation->launcher.launching.tube.flexible);
    bool vehicle = model->base.kind == LD_BASE_VEHICLE;
    if (vehicle)
        dense_vehicle_create(&run->vehicle, model, model->firing[0].tube, NULL, 0);
    watching = run;
    if (ld_simulation_run(simulation, &(ld_run_options){.sink = &sink}, &summary, &error))
        fail_msg("%s", error.text);
    printf("  %d rows of %zu columns\n", run->rows, run->book.count);
    watching = NULL;
    check_book(&run->book, bound, bounds);
    if (vehicle)
        dense_vehicle_free(&run->vehicle);
    dense_launch_free(&run->dense);
    ld_simulation_free(simulation);
    free(run);
}

// Differences for velocities meet the kinks of the tube's shapes; quadratures the rows' distance.
static const column_bound bounds[] = {
    {"rocket.[yz]_dot", 2e-6, false},
    {"tip.inertial_v?", 4e-9, false},
    {"station.*.[vw]?", 4e-9, false},
    {"tip.inertial_*_rate", 1e-9, false},
    {"rocket.w?_dot", 1e-9, false},
    {"rocket.*_dot", 1e-13, false},
    {"tip_off.*", 3e-13, false},
    {"since_ignition.*", 3e-13, false},
    {"work.slot", 3e-5, true},
    {"work.lock", 1e-11, true},
    {"lock.force", 5e-8, true},
    {"breech.force", 1e-7, true},
    {"work.contact_*", 6e-3, false},
    {"work.*_damping", 5e-4, false},
    {"work.slot_friction", 4e-4, false},
    {"work.mass_change", 1e-6, false},
    {"work.gravity_*", 1e-6, false},
    {"work.*", 3e-4, false},
    {"energy.residual", 2e-9, true},
    {"energy.*", 2e-12, false},
    {"contact.*.force", 2e-7, false},
    {"contact.*.normal", 2e-7, false},
    {"*", 1e-9, false},
};

static void sine(ld_sines *sines, double amplitude, double frequency, double phase)
{
    sines->count = 1;
    sines->term[0] = (ld_sine){amplitude, frequency, phase};
}

static void move_base(ld_base *base)
{
    base->kind = LD_BASE_PRESCRIBED;
    base->azimuth = 0.4;
    base->velocity[0] = 5;
    base->velocity[1] = 1;
    base->velocity[2] = -2;
    sine(&base->surge, 0.1, 0.7, 0.3);
    sine(&base->heave, 0.3, 0.5, 1);
    sine(&base->sway, 0.2, 0.6, 2);
    sine(&base->yaw, 0.05, 0.8, 0.5);
    sine(&base->pitch, 0.03, 0.9, 1.2);
    sine(&base->roll, 0.04, 1.1, 0.2);
}

static void test_prescribed_base(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    make_uneven(&model);
    model.run.lead_in = 0.02;
    model.tubes.slot.angle.data[1] *= -1; // a negative slot force
    move_base(&model.base);
    model.tubes.material.youngs_modulus = 2.1e11;
    model.tubes.station_count = 2;
    model.tubes.station[0] = (ld_station){1.3, {0.07, 0.05}};
    model.tubes.station[1] = (ld_station){3.1, {0.07, 0.05}};
    let_the_wind_blow(&model);
    watch_run(&model, bounds, sizeof bounds / sizeof *bounds);
    reference_model_free(&model);
}

static void test_vehicle(void **state)
{
    (void)state;
    ld_model model;
    reference_vehicle(&model, 9);
    make_uneven(&model);
    model.run.lead_in = 0.1;
    ld_road *given = &model.base.vehicle.road;
    given->form = LD_ROAD_SUM;
    given->sine_count = 1;
    given->sine[0] = (ld_road_sine){0.01, 2, 0.5};
    given->bump_count = 1;
    given->bump[0] = (ld_bump){1.5, 2, 0.04, LD_TRACK_LEFT};
    model.platform.azimuth.stabiliser.command.data[1] = 0.3;
    let_the_wind_blow(&model);
    watch_run(&model, bounds, sizeof bounds / sizeof *bounds);
    reference_model_free(&model);
}

// Without a lock the rocket rests on the breech until its thrust lifts it off.
static void test_breech(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    make_uneven(&model);
    model.rocket.lock.present = false;
    model.run.lead_in = 0.02;
    move_base(&model.base);
    watch_run(&model, bounds, sizeof bounds / sizeof *bounds);
    reference_model_free(&model);
}

// A pressure beside the motor, and a tube that recoils on a slide.
static void test_pressure(void **state)
{
    (void)state;
    ld_model model;
    const double over_time[] = {0, 1e5, 0.01, 4e5, 0.05, 3e5, 1, 2e5};
    reference_model(&model);
    make_uneven(&model);
    model.tubes.pressure = (ld_pressure){.present = true,
                                         .form = LD_PRESSURE_OVER_TIME,
                                         .over_time = reference_table(4, 2, over_time),
                                         .scale = 1.1,
                                         .ambient = 1e5};
    reference_recoil(&model);
    model.tubes.support[0].recoil.stroke = 3;
    model.run.lead_in = 0.02;
    move_base(&model.base);
    watch_run(&model, bounds, sizeof bounds / sizeof *bounds);
    reference_model_free(&model);
}

// Moment of weights about the elevation hinge, on the platform's z axis [N m].
static double weight_moment(const dense_vehicle *vehicle, const ld_model *model, double pitch)
{
    const ld_tubes *tubes = &model->tubes;
    double tube = tubes->section[0].mass_per_length * tubes->length, sum[3] = {0};
    const ld_mass_data *rocket = &model->rocket.full;
    v3 rear = vehicle->tube_at;
    const dense_part more[] = {
        {tube, {rear.x + tubes->length / 2, rear.y, 0}, {{{0}}}},
        {tubes->tail.mass, {rear.x + tubes->tail.center, rear.y, 0}, {{{0}}}},
        {rocket->mass,
         {rear.x + model->rocket.start_at + rocket->center[0], rear.y + rocket->center[1], 0},
         {{{0}}}},
    };
    for (int i = 0; i < vehicle->body[DENSE_ELEVATION].count + 3; i++) {
        int own = i - vehicle->body[DENSE_ELEVATION].count;
        const dense_part *part = own < 0 ? &vehicle->body[DENSE_ELEVATION].part[i] : &more[own];
        sum[0] += part->mass * part->center.x;
        sum[1] += part->mass * part->center.y;
    }
    return -model->gravity * (sum[0] * cos(pitch) - sum[1] * sin(pitch));
}

// Begun undeformed, tube and rocket are a dead load: the stabiliser carries all weights by the law
// of the lever.
static void test_undeformed_start(void **state)
{
    (void)state;
    ld_model model;
    recorded_run run;
    dense_vehicle vehicle;
    reference_vehicle(&model, 0);
    model.run.start = LD_START_UNDEFORMED;
    recorded_run_make(&run, &model);
    dense_vehicle_create(&vehicle, &model, model.firing[0].tube, NULL, 0);
    double torque = recorded_value(&run, 0, recorded_column(&run, "elevation.torque"));
    double pitch = recorded_value(&run, 0, recorded_column(&run, "elevation.measured"));
    CHECK_BELOW("torque of the elevation stabiliser, relative",
                torque / -weight_moment(&vehicle, &model, pitch) - 1, 1e-13);
    dense_vehicle_free(&vehicle);
    recorded_run_free(&run);
    reference_model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_prescribed_base),  cmocka_unit_test(test_vehicle),
        cmocka_unit_test(test_breech),           cmocka_unit_test(test_pressure),
        cmocka_unit_test(test_undeformed_start),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
