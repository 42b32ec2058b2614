// The dense check is right on its own: closed forms, balances and numerical derivatives.
#include "model/model.h"
#include "support/check.h"

#include <stdlib.h>
#include <string.h>

#include "support/dense_launch.h"
#include "support/dense_motor.h"
#include "support/reference_model.h"

// Numbers in [-1, 1], the same on every machine.
static double random_number(void)
{
    static uint64_t state = 88172645463325252u;
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (double)(state >> 11) / 4503599627370496.0 - 1;
}

// A tube of three elements: cubic shapes of random node values and slopes (smooth: one cubic).
static void make_tube(flexible_tube *tube, double length, int nb, int nt, int na, bool smooth)
{
    enum { ELEMENTS = 3 };
    memset(tube, 0, sizeof *tube);
    tube->nb = nb;
    tube->nt = nt;
    tube->na = na;
    tube->length = length;
    tube->element_count = ELEMENTS;
    tube->element = calloc(ELEMENTS, sizeof *tube->element);
    double h = length / ELEMENTS;
    for (int i = 0; i < ELEMENTS; i++) {
        tube->element[i].x0 = i * h;
        tube->element[i].x1 = (i + 1) * h;
    }
    for (int k = 0; k < 2 * nb; k++) {
        int plane = k / nb, m = k % nb;
        double value = 0, slope = 0, c2 = 0.1 * random_number(), c3 = 0.05 * random_number();
        for (int i = 0; i < ELEMENTS; i++) {
            double x = i * h, value1 = 0.1 * random_number(), slope1 = 0.1 * random_number();
            double(*b)[LD_NB] = tube->element[i].b[plane];
            b[0][m] = smooth ? c2 * x * x + c3 * x * x * x : value;
            b[1][m] = smooth ? 2 * c2 * x + 3 * c3 * x * x : slope;
            double rise = (value1 - value) / h;
            b[2][m] = smooth ? c2 + 3 * c3 * x : (3 * rise - 2 * slope - slope1) / h;
            b[3][m] = smooth ? c3 : (slope + slope1 - 2 * rise) / (h * h);
            value = value1;
            slope = slope1;
        }
    }
    for (int m = 0; m < nt; m++) {
        double value = 0;
        for (int i = 0; i < ELEMENTS; i++) {
            double slope = random_number();
            tube->element[i].tau[0][m] = value;
            tube->element[i].tau[1][m] = slope;
            value += slope * h;
        }
        tube->om2_t[m] = 3e5;
        tube->dmp_t[m] = 20;
    }
    for (int m = 0; m < na; m++) {
        double value = 0;
        for (int i = 0; i < ELEMENTS; i++) {
            double slope = 0.1 * random_number();
            tube->element[i].a[0][m] = value;
            tube->element[i].a[1][m] = slope;
            value += slope * h;
        }
        tube->om2_a[m] = 4e5;
        tube->dmp_a[m] = 30;
    }
}

typedef struct bench {
    ld_model model;
    flexible_tube tube;
    dense_launch dense;
} bench;

static void bench_open(bench *b, int nb, int nt, int na, bool smooth)
{
    reference_model(&b->model);
    b->model.tubes.point_mass_count = 1;
    b->model.tubes.point_mass[0] = (ld_point_mass){1.5, 0.4};
    make_tube(&b->tube, b->model.tubes.length, nb, nt, na, smooth);
    dense_launch_create(&b->dense, &b->model, &b->tube);
}

static void bench_close(bench *b)
{
    dense_launch_free(&b->dense);
    free(b->tube.element);
    reference_model_free(&b->model);
}

static void fill_random(double *a, int count, double size)
{
    for (int i = 0; i < count; i++)
        a[i] = size * random_number();
}

// A state far from any symmetry: bent tube, tilted rocket that presses on the wall, moving fast.
static void random_input(const bench *b, dense_launch_input *in)
{
    memset(in, 0, sizeof *in);
    fill_random(in->r, 3, 0.01);
    fill_random(in->quaternion, 4, 0.02);
    in->quaternion[0] = 1;
    fill_random(in->v, 3, 1);
    fill_random(in->w, 3, 1);
    fill_random(in->q, b->dense.mode_count, 0.02);
    fill_random(in->q_dot, b->dense.mode_count, 1);
    in->s = 0.3 + 0.2 * random_number();
    in->y = 0.0005 * random_number();
    in->z = 0.0005 * random_number();
    in->psi = 0.01 * random_number();
    in->theta = 0.01 * random_number();
    in->gamma = 2 * random_number();
    in->V[0] = 30;
    fill_random(in->V + 1, 2, 2);
    fill_random(in->V + 3, 3, 3);
    dense_conditions *on = &in->conditions;
    for (int i = 0; i < 3; i++)
        on->base.A[i][i] = 1;
    on->mass = 55;
    on->center[0] = 1.1;
    fill_random(on->center + 1, 2, 0.002);
    on->inertia[0] = 0.22;
    on->inertia[1] = 24;
    on->inertia[2] = 22;
    fill_random(on->products, 3, 0.05);
    on->thrust = 15e3;
    dense_motor_across(&b->model.rocket.motor, 0, on->across);
}

// Surfaces of every shoe, flat and round, most of them pressed in, beside an offset guide line.
static void random_surfaces(bench *b)
{
    b->model.tubes.slot.kind = LD_SLOT_NONE;
    b->dense.surface_count = 0;
    for (int i = 0; i < 2; i++)
        b->dense.line[i] = 0.1 * random_number();
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 5; k++)
            b->dense.surface[b->dense.surface_count++] = (dense_surface){i,
                                                                         0.1 * random_number(),
                                                                         0.1 * random_number(),
                                                                         3 * random_number(),
                                                                         2e-3 * random_number(),
                                                                         k % 2 == 0};
}

// The rocket centred on the guide line, hardly rolled.
static void put_on_line(const bench *b, dense_launch_input *in)
{
    in->y += b->dense.line[0];
    in->z += b->dense.line[1];
    in->gamma *= 0.01;
}

// ---------------------------------------------------------------- motion for a short time

static void rotate(double A[3][3], const double th[3])
{
    // A Exp(~th), by the quaternion (cos t/2, sin(t/2) th/t)
    double t = sqrt(th[0] * th[0] + th[1] * th[1] + th[2] * th[2]), c = cos(0.5 * t);
    double f = t > 1e-8 ? sin(0.5 * t) / t : 0.5, u[3] = {f * th[0], f * th[1], f * th[2]};
    double E[3][3], r[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            E[i][j] = 2 * u[i] * u[j] + (i == j ? 2 * c * c - 1 : 0);
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        E[k][j] += 2 * c * u[i];
        E[j][k] -= 2 * c * u[i];
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            r[i][j] = A[i][0] * E[0][j] + A[i][1] * E[1][j] + A[i][2] * E[2][j];
    memcpy(A, r, sizeof r);
}

// The state a time dt later, with its accelerations held: exact to second order in positions.
static void advance(const bench *b, dense_state *x, const double *x_ddot, double dt)
{
    int nq = b->dense.mode_count;
    const double *rocket = x_ddot + 6 + nq;
    double turn_R[3], turn_B[3];
    for (int i = 0; i < 3; i++) {
        x->r[i] += dt * (x->v[i] + 0.5 * dt * x_ddot[i]);
        x->v[i] += dt * x_ddot[i];
        turn_R[i] = dt * (x->w[i] + 0.5 * dt * x_ddot[3 + i]);
        x->w[i] += dt * x_ddot[3 + i];
        x->r_O1[i] += dt * (x->v_O1[i] + 0.5 * dt * rocket[i]);
        x->v_O1[i] += dt * rocket[i];
        turn_B[i] = dt * (x->w_B[i] + 0.5 * dt * rocket[3 + i]);
        x->w_B[i] += dt * rocket[3 + i];
    }
    for (int i = 0; i < nq; i++) {
        x->q[i] += dt * (x->q_dot[i] + 0.5 * dt * x_ddot[6 + i]);
        x->q_dot[i] += dt * x_ddot[6 + i];
    }
    rotate(x->A_R, turn_R);
    rotate(x->A_B, turn_B);
}

// Time derivatives along the motion of a list of outputs, by central differences in two steps.
enum {
    ENERGY,
    DRIFT,
    LOCK_DRIFT,
    LOCK_ROLL,
    STATION,
    PENETRATION,
    LINEAR,
    ANGULAR = LINEAR + 3,
    LIST = ANGULAR + 3
};

static void list_outputs(double list[LIST], const dense_launch_output *out)
{
    list[ENERGY] = out->kinetic + out->potential;
    list[DRIFT] = out->slot_drift;
    list[LOCK_DRIFT] = out->lock_drift;
    list[LOCK_ROLL] = out->lock_roll;
    list[STATION] = out->s;
    list[PENETRATION] = out->contact[2].penetration;
    memcpy(list + LINEAR, out->momentum, sizeof out->momentum);
    memcpy(list + ANGULAR, out->angular_momentum, sizeof out->angular_momentum);
}

static void derivatives(const bench *b, const dense_launch_input *in, double rate[LIST],
                        dense_launch_output *out)
{
    dense_state state;
    dense_rates rates;
    double coarse[LIST];
    dense_launch_place(&b->dense, in, &state);
    assert_true(dense_launch_rates(&b->dense, &state, &in->conditions, &rates, out));
    for (int level = 0; level < 2; level++) {
        double dt = level == 0 ? 2e-6 : 1e-6, side[2][LIST];
        for (int i = 0; i < 2; i++) {
            dense_state moved = state;
            dense_launch_output there;
            advance(b, &moved, rates.x_ddot, i == 0 ? -dt : dt);
            assert_true(dense_launch_rates(&b->dense, &moved, &in->conditions, NULL, &there));
            list_outputs(side[i], &there);
        }
        for (int k = 0; k < LIST; k++) {
            coarse[k] = level == 0 ? (side[1][k] - side[0][k]) / (2 * dt) : coarse[k];
            rate[k] = (side[1][k] - side[0][k]) / (2 * dt);
        }
    }
    for (int k = 0; k < LIST; k++)
        rate[k] += (rate[k] - coarse[k]) / 3;
}

static double larger(double a, double b)
{
    return fabs(b) > a ? fabs(b) : a;
}

// ---------------------------------------------------------------- tests

static void energy_changes_by_the_power_of_the_forces(void **state)
{
    (void)state;
    bench b;
    bench_open(&b, 3, 2, 1, false);
    b.model.rocket.lock.x = 0.4;
    b.model.rocket.lock.radius = 0.08;
    b.model.rocket.lock.angle = 2;
    double worst = 0, drift = 0, station = 0, penetration = 0;
    for (int i = 0; i < 100; i++) {
        dense_launch_input in;
        dense_launch_output out;
        double rate[LIST];
        random_input(&b, &in);
        in.conditions.locked = i % 4 == 0;
        in.conditions.frictionless = i % 3 == 0;
        derivatives(&b, &in, rate, &out);
        worst = larger(worst, (rate[ENERGY] - out.power) / (fabs(out.power) + 1e6));
        drift = larger(drift, rate[DRIFT]);
        station = larger(station, rate[STATION] - out.s_dot);
        penetration = larger(penetration, rate[PENETRATION] - out.contact[2].penetration_rate);
        if (in.conditions.locked)
            drift = larger(drift, rate[LOCK_DRIFT]);
    }
    CHECK_BELOW("d/dt(energy) - power, of power + 1 MW", worst, 1e-9);
    CHECK_BELOW("d/dt(slot's v_rel, lock's v_rel) [m/s2]", drift, 1e-4);
    CHECK_BELOW("d/dt(s) - s_dot [m/s]", station, 3e-9);
    CHECK_BELOW("d/dt(p) - p_dot of the front adaptor [m/s]", penetration, 1e-7);
    bench_close(&b);
}

// Without friction and damping the contacts' power is the change of their springs' energy.
static void surfaces_change_energy_by_their_power(void **state)
{
    (void)state;
    bench b;
    bench_open(&b, 3, 2, 1, false);
    double worst = 0, penetration = 0, conserved = 0;
    int pressed = 0;
    for (int i = 0; i < 100; i++) {
        dense_launch_input in;
        dense_launch_output out;
        double rate[LIST];
        random_surfaces(&b);
        random_input(&b, &in);
        put_on_line(&b, &in);
        b.model.rocket.contact.restitution = i % 3 == 0 ? 1 : 0.5;
        in.conditions.frictionless = i % 3 == 0;
        in.conditions.locked = i % 4 == 0;
        derivatives(&b, &in, rate, &out);
        worst = larger(worst, (rate[ENERGY] - out.power) / (fabs(out.power) + 1e6));
        penetration = larger(penetration, rate[PENETRATION] - out.contact[2].penetration_rate);
        double springs = 0, without = out.power;
        for (int k = 0; k < b.dense.surface_count; k++) {
            pressed += out.surface[k].normal > 0;
            springs += out.surface[k].normal * out.surface[k].penetration_rate;
        }
        dense_launch_output apart;
        for (int k = 0; k < b.dense.surface_count; k++)
            b.dense.surface[k].gap = 1;
        assert_true(dense_launch_evaluate(&b.dense, &in, &apart));
        // the lock's force depends on the contacts; open, all else keeps its power
        if (in.conditions.frictionless && !in.conditions.locked)
            conserved = larger(conserved, (without - apart.power + springs) / (fabs(springs) + 1));
    }
    CHECK_WITHIN("surfaces pressed, of a state", pressed / 100.0, 5, 10);
    CHECK_BELOW("d/dt(energy) - power, of power + 1 MW", worst, 1e-9);
    CHECK_BELOW("d/dt(p) - p_dot of the front shoe [m/s]", penetration, 1e-7);
    CHECK_BELOW("power + F p_dot, no friction [relative]", conserved, 1e-11);
    bench_close(&b);
}

static void inner_forces_keep_the_momenta(void **state)
{
    (void)state;
    bench b;
    bench_open(&b, 3, 2, 1, false);
    b.model.gravity = 0;
    b.model.tubes.support_count = 0;
    double linear = 0, angular = 0, slot = 0, contact = 0, roll = 0;
    for (int i = 0; i < 60; i++) {
        dense_launch_input in;
        dense_launch_output out;
        double rate[LIST];
        random_input(&b, &in);
        in.conditions.thrust = 0;
        in.conditions.locked = i % 3 == 0;
        b.model.tubes.slot.kind = i % 4 == 1 ? LD_SLOT_NONE : LD_SLOT_HELIX;
        if (i % 4 == 2) {
            random_surfaces(&b);
            put_on_line(&b, &in);
        } else
            b.dense.surface_count = 0;
        derivatives(&b, &in, rate, &out);
        if (in.conditions.locked && b.model.tubes.slot.kind == LD_SLOT_NONE)
            roll = larger(roll, rate[LOCK_ROLL]);
        slot = larger(slot, out.slot_force);
        contact = larger(contact, out.contact[1].normal);
        for (int k = 0; k < 3; k++) {
            linear = larger(linear, rate[LINEAR + k]);
            angular = larger(angular, rate[ANGULAR + k]);
        }
    }
    printf("    largest slot force %.3g N, contact %.3g N\n", slot, contact);
    CHECK_BELOW("d/dt(roll rate), smooth tube, locked [rad/s2]", roll, 1e-4);
    CHECK_BELOW("d/dt(momentum) [N]", linear, 5e-4);
    CHECK_BELOW("d/dt(angular momentum) [N m]", angular, 1e-3);
    bench_close(&b);
}

// Accelerations of a free rigid body with mass m, centre c, inertia J about the centre, all in body
// axes, under gravity g (body axes): Euler's equations, then the origin's acceleration.
static void rigid_body(double m, const double c[3], double J[3][3], const double w[3],
                       const double g[3], double a[3], double w_dot[3])
{
    double L[3], t[3], wc[3];
    (void)m;
    for (int i = 0; i < 3; i++)
        L[i] = J[i][0] * w[0] + J[i][1] * w[1] + J[i][2] * w[2];
    for (int i = 0; i < 3; i++)
        t[i] = L[(i + 1) % 3] * w[(i + 2) % 3] - L[(i + 2) % 3] * w[(i + 1) % 3];
    // J w_dot = L x w by Cramer's rule
    double det = 0, inverse[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            inverse[j][i] = J[i1][j1] * J[i2][j2] - J[i1][j2] * J[i2][j1];
        }
    for (int j = 0; j < 3; j++)
        det += J[0][j] * inverse[j][0];
    for (int i = 0; i < 3; i++)
        w_dot[i] = (inverse[i][0] * t[0] + inverse[i][1] * t[1] + inverse[i][2] * t[2]) / det;
    for (int i = 0; i < 3; i++)
        wc[i] = w[(i + 1) % 3] * c[(i + 2) % 3] - w[(i + 2) % 3] * c[(i + 1) % 3];
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        a[i] = g[i] - (w_dot[j] * c[k] - w_dot[k] * c[j]) - (w[j] * wc[k] - w[k] * wc[j]);
    }
}

static void free_bodies_follow_euler(void **state)
{
    (void)state;
    bench b;
    bench_open(&b, 0, 0, 0, true);
    b.model.tubes.support_count = 0;
    b.model.tubes.slot.kind = LD_SLOT_NONE;
    for (int i = 0; i < 3; i++)
        b.model.rocket.adaptor[i].clearance = 1;
    dense_launch_input in;
    dense_launch_output out;
    dense_state placed;
    random_input(&b, &in);
    in.conditions.thrust = 0;
    dense_launch_place(&b.dense, &in, &placed);
    assert_true(dense_launch_evaluate(&b.dense, &in, &out));
    double worst = 0, g_R[3], g_B[3], a[3], w_dot[3];
    for (int i = 0; i < 3; i++) {
        g_R[i] = -b.model.gravity * placed.A_R[1][i];
        g_B[i] = -b.model.gravity * placed.A_B[1][i];
    }
    // rocket, in B
    const dense_conditions *on = &in.conditions;
    double J[3][3] = {{on->inertia[0], on->products[0], on->products[1]},
                      {on->products[0], on->inertia[1], on->products[2]},
                      {on->products[1], on->products[2], on->inertia[2]}};
    rigid_body(on->mass, on->center, J, placed.w_B, g_B, a, w_dot);
    for (int i = 0; i < 3; i++) {
        double a_I = 0, a_out = 0, alpha_I = 0, alpha_out = 0;
        for (int j = 0; j < 3; j++) {
            a_I += placed.A_B[i][j] * a[j];
            alpha_I += placed.A_B[i][j] * w_dot[j];
            a_out += placed.A_R[i][j] * out.a_O1[j];
            alpha_out += placed.A_R[i][j] * out.alpha_B[j];
        }
        worst = larger(worst, a_out - a_I);
        worst = larger(worst, alpha_out - alpha_I);
    }
    CHECK_BELOW("free rocket against Euler [m/s2, rad/s2]", worst, 1e-10);
    // tube (line of mass with polar inertia), point mass and tail, in R
    const ld_section *section = &b.model.tubes.section[0];
    double length = b.model.tubes.length, line = section->mass_per_length * length;
    double mass = line + 0.4 + 8, center = (line * length / 2 + 0.4 * 1.5 - 8 * 0.1) / mass;
    double second = line * length * length / 3 + 0.4 * 1.5 * 1.5 + 8 * 0.01 + 0.06;
    double K[3][3] = {{section->polar_inertia * length + 0.05, 0, 0},
                      {0, second - mass * center * center, 0},
                      {0, 0, second - mass * center * center}};
    rigid_body(mass, (double[]){center, 0, 0}, K, in.w, g_R, a, w_dot);
    worst = 0;
    for (int i = 0; i < 3; i++) {
        worst = larger(worst, out.a[i] - a[i]);
        worst = larger(worst, out.w_dot[i] - w_dot[i]);
    }
    CHECK_BELOW("free rigid tube against Euler [m/s2, rad/s2]", worst, 1e-10);
    bench_close(&b);
}

static void helix_follows_the_closed_form(void **state)
{
    (void)state;
    // rocket on the axis of an immovable straight tube, mass centre at O1, alpha(s) = 0.1 + 0.2 s
    bench b;
    bench_open(&b, 0, 0, 0, true);
    b.model.gravity = 0;
    b.model.tubes.section[0].mass_per_length = 1e12;
    b.model.tubes.section[0].polar_inertia = 1e12;
    dense_launch_free(&b.dense);
    dense_launch_create(&b.dense, &b.model, &b.tube);
    free(b.model.tubes.slot.angle.data);
    b.model.tubes.slot.angle = reference_table(2, 2, (double[]){0, 0.1, 3, 0.7});
    dense_launch_input in;
    dense_launch_output out;
    memset(&in, 0, sizeof in);
    dense_conditions *on = &in.conditions;
    for (int i = 0; i < 3; i++)
        on->base.A[i][i] = 1;
    *on =
        (dense_conditions){.base = on->base, .mass = 60, .inertia = {0.22, 24, 24}, .thrust = 15e3};
    double s_dot = 12, s = 0.5, alpha = 0.2, R_k = 0.0825, mu = 0.1, v_eps = 0.01;
    in.quaternion[0] = 1;
    in.s = s;
    in.gamma = 0.3;
    in.V[0] = s_dot;
    in.V[3] = s_dot * tan(alpha) / R_k;
    assert_true(dense_launch_evaluate(&b.dense, &in, &out));
    // m s_dd = T - N (sin + f cos), J w_d = N R t, m a_t = N t, t = cos - f sin, f = mu sigma, and
    // the knob's path: R w_d + a_t = tan(alpha) a_x + s_d d(tan(alpha))/dt, where a_x differs from
    // s_dd by the pitching that the axial force at the knob causes
    double v = s_dot / cos(alpha), f = mu * v / sqrt(v * v + v_eps * v_eps);
    double along = sin(alpha) + f * cos(alpha), t = cos(alpha) - f * sin(alpha);
    double bend = 0.2 * s_dot * s_dot / (cos(alpha) * cos(alpha));
    double N = (tan(alpha) * 15e3 / 60 + bend) /
               (R_k * R_k * t / 0.22 + t / 60 + tan(alpha) * along * (1.0 / 60 + R_k * R_k / 24));
    CHECK_BELOW("drift", out.slot_drift, 1e-14);
    CHECK_NEAR("N in a growing helix [N]", out.slot_force, N, 1e-6);
    CHECK_NEAR("s_ddot [m/s2]", out.a_O1[0], (15e3 - N * along) / 60, 1e-8);
    CHECK_NEAR("roll acceleration [rad/s2]", out.alpha_B[0], N * R_k * t / 0.22, 1e-6);
    bench_close(&b);
}

static void support_springs_hold_their_potential(void **state)
{
    (void)state;
    // one support at the rear end, turned by phi about one axis: moment -K phi, force -K d
    bench b;
    bench_open(&b, 0, 0, 0, true);
    b.model.gravity = 0;
    b.model.tubes.support_count = 1;
    b.model.tubes.support[0].at = 0;
    b.model.tubes.tail.mass = 0;
    b.model.tubes.point_mass_count = 0;
    dense_launch_free(&b.dense);
    dense_launch_create(&b.dense, &b.model, &b.tube);
    b.model.tubes.slot.kind = LD_SLOT_NONE;
    for (int i = 0; i < 3; i++)
        b.model.rocket.adaptor[i].clearance = 1;
    dense_launch_input in;
    dense_launch_output out;
    random_input(&b, &in);
    in.conditions.thrust = 0;
    double phi = 0.7, zero[3] = {0};
    memcpy(in.r, zero, sizeof zero);
    memcpy(in.v, zero, sizeof zero);
    memcpy(in.w, zero, sizeof zero);
    in.quaternion[1] = in.quaternion[2] = 0;
    in.quaternion[0] = cos(phi / 2);
    in.quaternion[3] = sin(phi / 2);
    assert_true(dense_launch_evaluate(&b.dense, &in, &out));
    double m = b.model.tubes.section[0].mass_per_length * 3;
    double moment = -2e5 * phi, J = m * 9 / 3 + 0.06;
    // forces act at the rear end: about the mass centre at 1.5 m only the moment and no force
    double J_C = J - m * 1.5 * 1.5;
    CHECK_NEAR("w_dot by a turned support [rad/s2]", out.w_dot[2], moment / J_C, 1e-6);
    CHECK_NEAR("a of the rear end [m/s2]", out.a[1], -1.5 * moment / J_C, 1e-6);
    bench_close(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(free_bodies_follow_euler),
        cmocka_unit_test(support_springs_hold_their_potential),
        cmocka_unit_test(helix_follows_the_closed_form),
        cmocka_unit_test(energy_changes_by_the_power_of_the_forces),
        cmocka_unit_test(surfaces_change_energy_by_their_power),
        cmocka_unit_test(inner_forces_keep_the_momenta),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
