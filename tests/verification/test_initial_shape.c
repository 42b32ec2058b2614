// Guides that are not straight (model.md, section 5): shapes against their definition, a rigid
// rocket on a rigid sine and over a joint of a rigid rail, launches whose energy balances.
#include <stdlib.h>

#include "base/random.h"
#include "elements/tube/initial_shape.h"

#include "model/model.h"
#include "support/check.h"
#include "support/launching_run.h"
#include "support/recorded_run.h"
#include "support/reference_model.h"
#include "systems/launching/launching_dynamics.h"

static const double PI = 3.14159265358979323846;

// Rows of an initial shape: sines along both planes, of the wave number k.
static void bend_guide(int rows, double length, double a_y, double a_z, double k, ld_model *model)
{
    double *row = malloc((size_t)rows * 3 * sizeof *row);
    for (int i = 0; i < rows; i++) {
        double x = length * i / (rows - 1);
        row[3 * i] = x;
        row[3 * i + 1] = a_y * sin(k * x);
        row[3 * i + 2] = a_z * cos(k * x);
    }
    model->tubes.initial_shape = (ld_initial_shape){
        .present = true, .scale = {1, 1}, .twist_scale = 1, .offsets = {rows, 3, row}};
}

// ---- a rigid rocket on a rigid sine ----

// Two adaptors, held on a line u(x) exactly, l apart, the mass centre c before the rear one:
// u_C'' = u_r'' + c th'', th = (u_f - u_r)/l, of u'' = u_xx v^2 at the speed v. Forces of rear and
// front from m u_C'' and J th'', to first order in u.
static void expected_forces(const rocket_mass *mass, double l, double rear, double front,
                            double force[2])
{
    double th = (front - rear) / l, c = mass->c.x, J = mass->J.a[2][2];
    double sum = mass->m * (rear + c * th), couple = J * th; // F_f (l - c) - F_r c = couple
    force[1] = (couple + sum * c) / l;
    force[0] = sum - force[1];
}

// The reference without gravity, on a guide that nothing moves.
static void unmoved_model(ld_model *model)
{
    reference_model(model);
    model->gravity = 0;
    model->tubes.tail = (ld_tail){0};
    model->tubes.section[0].mass_per_length = 1e12;
    model->tubes.section[0].polar_inertia = 1e10;
    model->tubes.modes.bending = 2;
    model->tubes.slot.kind = LD_SLOT_NONE;
}

// The largest error of the forces along the guide, of the largest force, with so many rows.
static double error_on_a_sine(int rows)
{
    const double a[2] = {2e-5, -3e-5}, k = 2 * PI / 0.8, v = 37;
    ld_model model;
    unmoved_model(&model);
    model.rocket.contact.law = LD_CONTACT_IDEAL;
    model.rocket.adaptor_count = 2;
    double l = model.rocket.adaptor[1].at, worst = 0, largest = 0, bend = -k * k * v * v;
    bend_guide(rows, model.tubes.length, a[0], a[1], k, &model);
    launching_system *system = launching_system_of(&model);
    for (int i = 0; i < 40; i++) {
        launching_run run;
        launching_output out;
        double s = 0.1 + 0.04 * i, y[2], z[2];
        launching_run_begin(&run, system, s);
        run.input.mass = (rocket_mass){.m = 60, .c = {1.1, 0, 0}, .J = m3_diagonal(0.2, 24, 24)};
        run.state[system->layout.V] = v;
        launching_project(system, &run.input, &run.phase, run.state);
        assert_int_equal(launching_evaluate(system, &run.input, &run.phase, run.state, &out),
                         LAUNCHING_OK);
        expected_forces(&run.input.mass, l, bend * a[0] * sin(k * s),
                        bend * a[0] * sin(k * (s + l)), y);
        expected_forces(&run.input.mass, l, bend * a[1] * cos(k * s),
                        bend * a[1] * cos(k * (s + l)), z);
        for (int j = 0; j < 2; j++) {
            largest = fmax(largest, hypot(y[j], z[j]));
            worst = fmax(worst, fabs(out.adaptor[j].normal - hypot(y[j], z[j])));
        }
    }
    launching_system_drop(system);
    reference_model_free(&model);
    printf("  %d rows: largest force %.1f N\n", rows, largest);
    return worst / largest;
}

// The spline's curvature is wrong by (k h)^2/12 between rows h apart.
static void rigid_rocket_on_a_sine(void **state)
{
    (void)state;
    double coarse = error_on_a_sine(301), fine = error_on_a_sine(1201);
    CHECK_BELOW("forces on a sine, of the largest", fine, 5e-5);
    CHECK_WITHIN("their order in the distance of rows", 0.5 * log2(coarse / fine), 1.9, 2.1);
}

// ---- shapes ----

static const double length = 4.3;

static initial_shape *shape_of(const ld_initial_shape *given)
{
    ld_error error;
    initial_shape *shape;
    ld_tubes *tubes = calloc(1, sizeof *tubes);
    tubes->length = length;
    tubes->initial_shape = *given;
    tubes->initial_shape.present = true;
    assert_int_equal(initial_shape_build(tubes, &shape, &error), LD_OK);
    free(tubes);
    return shape;
}

// z with the standard normal probability p below it, by Newton's rule.
static double normal_below(double p)
{
    double z = 0;
    for (int i = 0; i < 60; i++) {
        double miss = 0.5 * erfc(-z / sqrt(2)) - p, density = exp(-z * z / 2) / sqrt(2 * PI);
        z -= fmax(-0.5, fmin(0.5, miss / density));
    }
    return z;
}

static double term(const char *stream, int seed, int axis, int n)
{
    return normal_below(
        random_uniform((uint64_t)seed, random_stream(stream), (uint64_t)axis, (uint64_t)n, 0));
}

// The sums of half waves, their offsets and second derivatives, times what makes them as large as
// is asked; that by a search over their own points.
static void half_waves_by_definition(void **state)
{
    (void)state;
    enum { TERMS = 7, POINTS = 4001 };
    double worst = 0, worst_bend = 0, worst_end = 0, worst_size = 0;
    for (int seed = 0; seed < 40; seed++) {
        const ld_initial_shape given = {
            .scale = {3, 3}, // of the rows alone
            .seed = seed,
            .random = {.present = true, .deviation = 2.7e-3, .terms = TERMS, .decay = 1.5}};
        double amplitude[2][TERMS + 1], most = 0, size = 0, sum[2], bend[2], most_bend = 0;
        double miss = 0, miss_bend = 0;
        initial_shape *shape = shape_of(&given);
        for (int k = 0; k < 2; k++)
            for (int n = 1; n <= TERMS; n++)
                amplitude[k][n] = term("initial_shape.random", seed, k, n) / (n * sqrt(n));
        for (int pass = 0; pass < 2; pass++)
            for (int i = 0; i < POINTS; i++) {
                initial_section at;
                double part = (double)i / (POINTS - 1);
                for (int k = 0; k < 2; k++) {
                    sum[k] = bend[k] = 0;
                    for (int n = 1; n <= TERMS; n++) {
                        double wave = n * PI / length, y = amplitude[k][n] * sin(n * PI * part);
                        sum[k] += y;
                        bend[k] -= wave * wave * y;
                    }
                }
                if (pass == 0) {
                    most = fmax(most, hypot(sum[0], sum[1]));
                    continue;
                }
                double by = given.random.deviation / most;
                initial_shape_at(shape, length * part, &at);
                size = fmax(size, hypot(at.P.y, at.P.z));
                miss = fmax(miss, hypot(at.P.y - by * sum[0], at.P.z - by * sum[1]));
                miss_bend = fmax(miss_bend, hypot(at.P2.y - by * bend[0], at.P2.z - by * bend[1]));
                most_bend = fmax(most_bend, by * hypot(bend[0], bend[1]));
                if (i == 0 || i == POINTS - 1)
                    worst_end = fmax(worst_end, hypot(at.P.y, at.P.z));
            }
        worst = fmax(worst, miss / given.random.deviation);
        worst_bend = fmax(worst_bend, miss_bend / most_bend);
        worst_size = fmax(worst_size, fabs(size / given.random.deviation - 1));
        initial_shape_free(shape);
    }
    CHECK_BELOW("half waves, of the deviation", worst, 6e-4);
    CHECK_BELOW("their curvature, of the largest", worst_bend, 2e-3);
    CHECK_BELOW("their size, of the deviation", worst_size, 6e-4);
    CHECK_BELOW("offset of the ends [m]", worst_end, 5e-18);
}

// First half waves of many seeds: axes independent, every direction as likely.
static void seeds_are_independent(void **state)
{
    (void)state;
    enum { SEEDS = 4000 };
    double both = 0, with_next = 0, upright = 0, before = 0;
    for (int seed = 0; seed < SEEDS; seed++) {
        const ld_initial_shape given = {
            .seed = seed, .random = {.present = true, .deviation = 1, .terms = 1, .decay = 2}};
        initial_section at;
        initial_shape *shape = shape_of(&given);
        initial_shape_at(shape, length / 2, &at);
        both += 2 * at.P.y * at.P.z / SEEDS;
        upright += (2 * at.P.y * at.P.y - 1) / SEEDS;
        with_next += 2 * before * at.P.y / SEEDS;
        before = at.P.y;
        initial_shape_free(shape);
    }
    // standard deviations of the first two: 0.011, of the third: 0.016
    CHECK_BELOW("correlation of y and z", both, 0.03);
    CHECK_BELOW("share of y above z", upright, 0.03);
    CHECK_BELOW("correlation with the next seed", with_next, 0.045);
}

static void rows_miss_by_their_accuracy(void **state)
{
    (void)state;
    enum { ROWS = 6, SEEDS = 1500 };
    double row[ROWS][4], sum[2][3] = {{0}}, shared = 0, worst = 0;
    for (int i = 0; i < ROWS; i++)
        memcpy(row[i], (double[]){length * i / (ROWS - 1), 1e-3 * i, -2e-3, 0.01 * i}, sizeof *row);
    const ld_initial_shape given = {.offsets = {ROWS, 4, row[0]},
                                    .scale = {0.5, 3},
                                    .twist_scale = 2,
                                    .accuracy = {2e-4, 5e-5}};
    for (int seed = 0; seed < SEEDS; seed++) {
        ld_initial_shape drawn = given;
        drawn.seed = seed;
        initial_shape *shape = shape_of(&drawn);
        for (int i = 0; i < ROWS; i++) {
            initial_section at;
            initial_shape_at(shape, row[i][0], &at);
            double by[2] = {(at.P.y / 0.5 - row[i][1]) / 2e-4, (at.P.z / 3 - row[i][2]) / 5e-5};
            for (int k = 0; k < 2; k++) {
                sum[k][0] += by[k];
                sum[k][1] += by[k] * by[k];
                sum[k][2] += pow(by[k], 4);
                double expected = term("initial_shape.accuracy", seed, k, i);
                worst = fmax(worst, fabs(by[k] - expected));
            }
            shared += by[0] * by[1];
            worst = fmax(worst, fabs(at.th.x - 2 * row[i][3]));
        }
        initial_shape_free(shape);
    }
    double n = ROWS * SEEDS;
    CHECK_BELOW("errors of rows, over their deviation, and twist", worst, 1e-12);
    for (int k = 0; k < 2; k++) {
        CHECK_BELOW("mean", sum[k][0] / n, 0.03);
        CHECK_WITHIN("variance", sum[k][1] / n, 0.97, 1.03);
        CHECK_WITHIN("fourth moment", sum[k][2] / n, 2.8, 3.2);
    }
    CHECK_BELOW("covariance of y and z", shared / n, 0.03);
}

// Offset, slope and curvature of a rounded step and kink, u from its beginning to its end at 1.
static void over_joint(const ld_rail_joint *joint, int k, double x, double w[3])
{
    double l = joint->length, u = (x - joint->at) / l + 0.5, s = joint->step[k], a = joint->kink[k];
    double in[3] = {s * (u * u * (3 - 2 * u)) + a * l * u * u / 2, s * 6 * u * (1 - u) / l + a * u,
                    s * (6 - 12 * u) / (l * l) + a / l};
    double after[3] = {s + a * (x - joint->at), a, 0};
    for (int i = 0; i < 3; i++)
        w[i] = u <= 0 ? 0 : u >= 1 ? after[i] : in[i];
}

// Joints, one across another's ramp and one across the tip, on rows of a cubic, which a spline
// meets exactly.
static void joints_by_definition(void **state)
{
    (void)state;
    enum { ROWS = 9, JOINTS = 3 };
    double row[ROWS][4], worst[4] = {0};
    ld_initial_shape given = {.scale = {2, -1},
                              .twist_scale = 1,
                              .offsets = {ROWS, 4, row[0]},
                              .joint_count = JOINTS,
                              .joint = {{1.7, {2e-3, -1e-3}, {3e-3, 0}, 0.11},
                                        {1.66, {0, 5e-4}, {-1e-3, 2e-3}, 0.05},
                                        {4.28, {-1e-3, 1e-3}, {0, 1e-3}, 0.2}}};
    for (int i = 0; i < ROWS; i++) {
        double x = -0.2 + 0.6 * i;
        memcpy(row[i], (double[]){x, 1e-3 * x * x * x, 2e-3 * x * x, 0.01 * x}, sizeof *row);
    }
    initial_shape *shape = shape_of(&given);
    for (int i = 0; i <= 4300; i++) {
        initial_section at;
        double x = 1e-3 * i + (i % 2 ? 3e-4 : -3e-4), w[2][3];
        double row_y[3] = {2e-3 * x * x * x, 6e-3 * x * x, 12e-3 * x};
        double row_z[3] = {-2e-3 * x * x, -4e-3 * x, -4e-3};
        x = fmax(0, fmin(length, x));
        for (int k = 0; k < 2; k++)
            for (int j = 0; j < 3; j++)
                w[k][j] = (k == 0 ? row_y : row_z)[j];
        for (int n = 0; n < JOINTS; n++)
            for (int k = 0; k < 2; k++) {
                double more[3];
                over_joint(&given.joint[n], k, x, more);
                for (int j = 0; j < 3; j++)
                    w[k][j] += more[j];
            }
        initial_shape_at(shape, x, &at);
        if (x <= 0 || x >= length)
            continue;
        worst[0] = fmax(worst[0], hypot(at.P.y - w[0][0], at.P.z - w[1][0]));
        worst[1] = fmax(worst[1], hypot(at.P1.y - w[0][1], at.P1.z - w[1][1]));
        worst[2] = fmax(worst[2], hypot(at.P2.y - w[0][2], at.P2.z - w[1][2]));
        worst[3] = fmax(worst[3], fabs(at.th.x - 0.01 * x));
    }
    initial_shape_free(shape);
    CHECK_BELOW("offsets with joints [m]", worst[0], 3e-16);
    CHECK_BELOW("slopes", worst[1], 5e-16);
    CHECK_BELOW("curvature [1/m]", worst[2], 2e-14);
    CHECK_BELOW("twist [rad]", worst[3], 3e-17);
}

// ---- a rigid rocket over a joint of a rigid rail ----

// The rocket on a spring k at each of two shoes, l apart, its mass centre c before the rear one,
// crosses w(x) at the speed v: M u'' + K u = K w, u the shoes' offsets. Each mode feels polynomials
// in time that begin where w changes: the free vibration that each leaves is known.
typedef struct bumpy_ride {
    double omega[2], mode[2][2], mass[2]; // mode: of both shoes
    double k, l, v, from;
    const ld_rail_joint *joint;
} bumpy_ride;

static void find_modes(double m, double J, double c, bumpy_ride *ride)
{
    // kinetic energy of u: the mass centre's (1 - c/l) u_r + c/l u_f, the turn's (u_f - u_r)/l
    double f = c / ride->l, r = 1 - f, turn = J / (ride->l * ride->l);
    double a = m * r * r + turn, b = m * r * f - turn, d = m * f * f + turn;
    double half = (a + d) / 2, root = hypot((a - d) / 2, b);
    for (int i = 0; i < 2; i++) {
        double value = i == 0 ? half + root : half - root;
        double x = b, y = value - a, norm = hypot(x, y);
        ride->mode[i][0] = x / norm;
        ride->mode[i][1] = y / norm;
        ride->mass[i] = value;
        ride->omega[i] = sqrt(ride->k / value);
    }
}

// A mode's coordinate at t under the force F + F1 s + F2 s^2/2 + F3 s^3/6 from s = 0 on, over its
// mass, at rest before.
static double response(double w, double s, const double F[4])
{
    if (s <= 0)
        return 0;
    double w2 = w * w;
    double forced =
        (F[0] + s * (F[1] + s * (F[2] / 2 + s * F[3] / 6))) / w2 - (F[2] + s * F[3]) / (w2 * w2);
    return forced - (F[0] / w2 - F[2] / (w2 * w2)) * cos(w * s) -
           (F[1] / w2 - F[3] / (w2 * w2)) * sin(w * s) / w;
}

// Offset of a shoe along an axis at t. A joint's ramp begins with the third derivative -12 s/l^3
// and the second 6 s/l^2 + a/l; where it ends, the third stops and the second falls to 0.
static double ride_at(const bumpy_ride *ride, int axis, int shoe, double t)
{
    const ld_rail_joint *joint = ride->joint;
    double s = joint->step[axis], a = joint->kink[axis], l = joint->length, v = ride->v, u = 0;
    const double jump[2][4] = {{0, 0, 6 * s / (l * l) + a / l, -12 * s / (l * l * l)},
                               {0, 0, 6 * s / (l * l) - a / l, 12 * s / (l * l * l)}};
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++)       // under either shoe
            for (int e = 0; e < 2; e++) { // begins and ends
                double F[4], by = ride->mode[i][j] * ride->k / ride->mass[i];
                double x = joint->at + (e - 0.5) * l - ride->from - j * ride->l;
                for (int p = 0; p < 4; p++)
                    F[p] = by * jump[e][p] * pow(v, p);
                u += ride->mode[i][shoe] * response(ride->omega[i], t - x / v, F);
            }
    return u;
}

typedef struct ride_check {
    bumpy_ride ride;
    double start;          // [s] of the present stretch
    double error, largest; // [N] of the normal forces
} ride_check;

static void watch_ride(launching_run *run, double t)
{
    ride_check *check = run->user;
    const bumpy_ride *ride = &check->ride;
    launching_output out;
    assert_int_equal(launching_evaluate(run->system, &run->input, &run->phase, run->state, &out),
                     LAUNCHING_OK);
    for (int shoe = 0; shoe < 2; shoe++) {
        double off[2], now = check->start + t, x = ride->from + ride->v * now + shoe * ride->l;
        for (int axis = 0; axis < 2; axis++) {
            double w[3];
            over_joint(ride->joint, axis, x, w);
            off[axis] = ride_at(ride, axis, shoe, now) - w[0];
        }
        double force = ride->k * hypot(off[0], off[1]);
        check->largest = fmax(check->largest, force);
        check->error = fmax(check->error, fabs(out.adaptor[shoe].normal - force));
    }
}

static void ride_over(const char *name, const ld_rail_joint *joint)
{
    ld_model model;
    launching_run run;
    unmoved_model(&model);
    model.tubes.initial_shape = (ld_initial_shape){.present = true, .joint_count = 1};
    model.tubes.initial_shape.joint[0] = *joint;
    ld_rocket *rocket = &model.rocket;
    rocket->adaptor_count = 2;
    rocket->contact = (ld_contact){.law = LD_CONTACT_BILATERAL, .stiffness = 3e6, .exponent = 1};
    for (int i = 1; i < 3; i++)
        rocket->full.inertia[i] = 21;
    launching_system *system = launching_system_of(&model);
    launching_run_begin(&run, system, 0.15);
    ride_check check = {.ride = {.k = 3e6, .l = rocket->adaptor[1].at, .v = 31, .from = 0.15}};
    check.ride.joint = joint;
    find_modes(rocket->full.mass, 21, rocket->full.center[0], &check.ride);
    run.state[system->layout.V] = check.ride.v;
    run.after_step = watch_ride;
    run.user = &check;
    for (int i = 0; i < 5; i++) { // from corner to corner
        double x = joint->at + (i % 2 - 0.5) * joint->length - (i < 2 ? check.ride.l : 0);
        double until = ((i < 4 ? x : joint->at + 0.3) - check.ride.from) / check.ride.v;
        launching_run_follow(&run, 1e-11, until - check.start);
        check.start = until;
    }
    printf("  %s: %.1f and %.1f Hz, largest force %.4g N, %d steps\n", name,
           check.ride.omega[0] / 2 / PI, check.ride.omega[1] / 2 / PI, check.largest,
           (int)run.steps);
    CHECK_BELOW("normal forces, of the largest", check.error / check.largest, 3e-6);
    launching_system_drop(system);
    reference_model_free(&model);
}

static void rigid_rocket_over_joints(void **state)
{
    (void)state;
    ride_over("step", &(ld_rail_joint){1.55, {2e-7, -3e-7}, {0, 0}, 0.06});
    ride_over("kink", &(ld_rail_joint){1.55, {0, 0}, {-2e-6, 1e-6}, 0.04});
    ride_over("both", &(ld_rail_joint){1.5, {1e-7, 1e-7}, {2e-6, 0}, 0.2});
}

// ---- launches ----

// What a launch from a guide of these offsets, perhaps with joints, leaves of the energy.
static void check_launch(const char *name, ld_model *model, bool joints, double bound)
{
    model->run.tolerance = 1e-8;
    double straight = summary_of_run(model).rocket[0].pitch_rate;
    bend_guide(7, model->tubes.length, 3e-4, -2e-4, 2 * PI / 1.7, model);
    ld_initial_shape *shape = &model->tubes.initial_shape;
    if (joints) {
        shape->random = (ld_random_bends){true, 2e-4, 5, 2};
        shape->joint_count = 2;
        shape->joint[0] = (ld_rail_joint){2.2, {2e-4, -1e-4}, {0, 3e-4}, 0.05};
        shape->joint[1] = (ld_rail_joint){2.7, {-1e-4, 1e-4}, {-5e-4, 0}, 0.02};
    }
    ld_summary summary = summary_of_run(model);
    printf("  %s: exit pitch rate %.5f rad/s, straight %.5f\n", name, summary.rocket[0].pitch_rate,
           straight);
    CHECK_BELOW("energy residual over the largest work", summary.energy.residual_relative, bound);
    assert_true(fabs(summary.rocket[0].pitch_rate - straight) > 1e-3);
    reference_model_free(model);
}

static void energy_of_launches(void **state)
{
    (void)state;
    for (int joints = 0; joints < 2; joints++) {
        ld_model model;
        reference_model(&model);
        check_launch(joints ? "bore with slot, joints" : "bore with slot", &model, joints,
                     joints ? 3e-10 : 1e-11);
        reference_model(&model);
        model.tubes.slot.kind = LD_SLOT_NONE;
        model.tubes.guide = (ld_guide){.present = true,
                                       .form = LD_GUIDE_T_SLOT,
                                       .line = {0.07, 0.02},
                                       .t_slot = {.lips = 0.06, .gap = 2e-4, .side_gap = 3e-4}};
        for (int i = 0; i < 3; i++)
            model.rocket.adaptor[i].clearance = NAN;
        check_launch(joints ? "T-slot, joints" : "T-slot", &model, joints, joints ? 3e-10 : 1e-11);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(half_waves_by_definition),    cmocka_unit_test(seeds_are_independent),
        cmocka_unit_test(rows_miss_by_their_accuracy), cmocka_unit_test(joints_by_definition),
        cmocka_unit_test(rigid_rocket_on_a_sine),      cmocka_unit_test(rigid_rocket_over_joints),
        cmocka_unit_test(energy_of_launches),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
