// Chassis and platforms of a vehicle: its mass data against many point masses, its frames and
// angles against differences, its energy and momentum, its torques, and both forms of its
// equations.
#include <stdlib.h>

#include "model/model.h"
#include "support/check.h"
#include "support/draw.h"
#include "support/reference_model.h"
#include "support/vehicle_bodies.h"

static const double PI = 3.141592653589793238462643383280;

typedef struct fixture {
    ld_model model;
    vehicle_bodies system;
} fixture;

static void build(fixture *f, int launching, const int *fired, int fired_count)
{
    ld_error error;
    if (vehicle_bodies_build(&f->system, &f->model, launching, fired, fired_count, &error))
        fail_msg("%s", error.text);
}

static void set_up(fixture *f)
{
    reference_vehicle(&f->model, 0);
    build(f, 8, NULL, 0);
}

// After a change of the model.
static void rebuild(fixture *f)
{
    vehicle_bodies_free(&f->system);
    build(f, 8, NULL, 0);
}

static void tear_down(fixture *f)
{
    vehicle_bodies_free(&f->system);
    reference_model_free(&f->model);
}

// A state far from the reference: any attitude, angles and rates.
static void draw_state(uint64_t *seed, double *state)
{
    for (int k = 0; k < VEHICLE_BODY_STATES; k++)
        state[k] = draw(seed);
    state[VEHICLE_QUATERNION] += 1.5;
    for (int i = 0; i < HINGES; i++)
        state[VEHICLE_Z + i] *= 1e4;
}

static vehicle_input draw_input(uint64_t *seed)
{
    return (vehicle_input){
        .chassis_force = draw_v3(seed, 1e5),
        .chassis_moment = draw_v3(seed, 1e5),
        .tube_force = draw_v3(seed, 1e4),
        .tube_moment = draw_v3(seed, 1e4),
    };
}

static vehicle_output evaluate(const fixture *f, const vehicle_input *input, double t,
                               const double *state, vehicle_motion *motion, double *state_dot)
{
    vehicle_output output;
    vehicle_bodies_move(&f->system, t, state, motion);
    assert_int_equal(vehicle_bodies_evaluate(&f->system, input, state, motion, state_dot, &output),
                     0);
    return output;
}

// The state after the time h at its present rate.
static void advance(const double *state, double h, const double *rate, double *out)
{
    for (int k = 0; k < VEHICLE_BODY_STATES; k++)
        out[k] = state[k] + h * rate[k];
}

// Weights of the derivative from values at -2h, -h, h, 2h: error of order h^4.
static const double place[4] = {-2, -1, 1, 2}, weight[4] = {1.0 / 12, -2.0 / 3, 2.0 / 3, -1.0 / 12};

static double worst(double so_far, double error)
{
    return fabs(error) <= so_far ? so_far : fabs(error); // a NaN stays
}

static double worst_v3(double so_far, v3 error)
{
    return worst(so_far, v3_norm(error));
}

// ---- mass data

// Point masses; negative ones take away.
typedef struct cloud {
    int count;
    struct {
        double m;
        v3 x;
    } point[4000];
} cloud;

static void add_point(cloud *all, double mass, double x, double y, double z)
{
    assert_true(all->count < 4000);
    all->point[all->count].m = mass;
    all->point[all->count++].x = v3_make(x, y, z);
}

// Mass, moments and products of inertia about c by points on three crossed axes: the products by
// pairs on the diagonals of the coordinate planes, the rest along the axes.
static void add_body(cloud *all, double mass, v3 c, const double J[3], const double products[3])
{
    const double a = 0.1, trace = 0.5 * (J[0] + J[1] + J[2]);
    double along[3] = {trace - J[0], trace - J[1], trace - J[2]}, left = mass;
    const int plane[3][2] = {{0, 1}, {0, 2}, {1, 2}};
    for (int k = 0; k < 3; k++) {
        // two points with sum m x y = -J_xy; two on the other diagonal take the rest away again
        double m = -products[k] / (4 * a * a);
        for (int side = -1; side <= 1; side += 2)
            for (int diagonal = -1; diagonal <= 1; diagonal += 2) {
                double e[3] = {0};
                e[plane[k][0]] = side * a;
                e[plane[k][1]] = side * diagonal * a;
                add_point(all, m * diagonal, c.x + e[0], c.y + e[1], c.z + e[2]);
            }
    }
    for (int k = 0; k < 3; k++)
        for (int side = -1; side <= 1; side += 2) {
            double e[3] = {0}, m = along[k] / (2 * a * a);
            e[k] = side * a;
            add_point(all, m, c.x + e[0], c.y + e[1], c.z + e[2]);
            left -= m;
        }
    add_point(all, left, c.x, c.y, c.z);
}

// A stretch of tube: points along its axis (three of Gauss: exact), and four around it whose
// inertia about y and z others take away (the section's bending rotary inertia is left out).
static void add_stretch(cloud *all, v3 at, double length, double line_mass, double polar)
{
    const double node = sqrt(0.6), a = 0.05, m = polar * length / (4 * a * a);
    add_point(all, line_mass * length * 5 / 18, at.x + 0.5 * length * (1 - node), at.y, at.z);
    add_point(all, line_mass * length * 8 / 18, at.x + 0.5 * length, at.y, at.z);
    add_point(all, line_mass * length * 5 / 18, at.x + 0.5 * length * (1 + node), at.y, at.z);
    for (int side = -1; side <= 1; side += 2) {
        add_point(all, m, at.x, at.y + side * a, at.z);
        add_point(all, m, at.x, at.y, at.z + side * a);
        add_point(all, -m, at.x + side * a, at.y, at.z);
    }
    add_point(all, -2 * m, at.x, at.y, at.z);
}

static double cloud_energy(const cloud *all, v3 v, v3 w)
{
    double sum = 0;
    for (int k = 0; k < all->count; k++)
        sum += all->point[k].m * v3_norm2(v3_add(v, v3_cross(w, all->point[k].x)));
    return 0.5 * sum;
}

static v3 cloud_momentum(const cloud *all, v3 v, v3 w)
{
    v3 sum = v3_zero();
    for (int k = 0; k < all->count; k++)
        sum = v3_axpy(sum, all->point[k].m, v3_add(v, v3_cross(w, all->point[k].x)));
    return sum;
}

// Everything different from zero: two sections, point masses, unbalanced rockets, tubes 2 and 5
// empty, 9 fired.
static void make_uneven(ld_model *model)
{
    ld_tubes *tubes = &model->tubes;
    tubes->section_count = 2;
    tubes->section[1] = tubes->section[0];
    tubes->section[1].from = 1.1;
    tubes->section[1].mass_per_length *= 0.7;
    tubes->section[1].polar_inertia *= 0.5;
    tubes->point_mass_count = 2;
    tubes->point_mass[0] = (ld_point_mass){0.7, 1.3};
    tubes->point_mass[1] = (ld_point_mass){2.9, 0.6};
    tubes->tail.inertia[2] = 0.09;
    tubes->empty_count = 2;
    tubes->empty[0] = 2;
    tubes->empty[1] = 5;
    model->rocket.mass_error = 0.5;
    model->rocket.eccentricity[0] = 2e-3;
    model->rocket.eccentricity[1] = -1e-3;
    model->rocket.products[0] = 0.03;
    model->rocket.products[1] = -0.02;
    model->rocket.products[2] = 0.01;
}

static void add_tube(cloud *all, const ld_model *model, int row, int column, bool rocket)
{
    const ld_tubes *tubes = &model->tubes;
    v3 at = v3_make(-0.4, 0.1 + 0.24 * row, -0.6 + 0.24 * column);
    const ld_section *section = tubes->section;
    add_stretch(all, at, 1.1, section[0].mass_per_length, section[0].polar_inertia);
    add_stretch(all, v3_add(at, v3_make(1.1, 0, 0)), 1.9, section[1].mass_per_length,
                section[1].polar_inertia);
    add_point(all, 1.3, at.x + 0.7, at.y, at.z);
    add_point(all, 0.6, at.x + 2.9, at.y, at.z);
    const double none[3] = {0};
    add_body(all, 8, v3_add(at, v3_make(-0.1, 0, 0)), (double[]){0.05, 0.06, 0.09}, none);
    if (rocket)
        add_body(all, 60.5, v3_add(at, v3_make(0.1 + 1.1, 2e-3, -1e-3)), (double[]){0.22, 24, 24},
                 model->rocket.products);
}

static void test_mass_data(void **context)
{
    (void)context;
    fixture f;
    reference_vehicle(&f.model, 0);
    make_uneven(&f.model);
    build(&f, 8, (int[]){9}, 1);

    const double none[3] = {0};
    cloud *chassis = calloc(1, sizeof *chassis), *azimuth = calloc(1, sizeof *azimuth);
    cloud *elevation = calloc(1, sizeof *elevation);
    add_body(chassis, 11000, v3_zero(), (double[]){9e3, 4.5e4, 4.2e4}, none);
    add_body(azimuth, 700, v3_make(0, 0.3, 0), (double[]){250, 400, 250}, none);
    add_body(elevation, 900, v3_make(0.7, 0.3, 0), (double[]){230, 470, 360}, none);
    for (int number = 1; number <= 18; number++)
        if (number != 8)
            add_tube(elevation, &f.model, (number - 1) / 6, (number - 1) % 6,
                     number != 2 && number != 5 && number != 9);

    // kinetic energy and momentum of the points as the three bodies move them
    uint64_t seed = 1;
    double energy_error = 0, momentum_error = 0;
    for (int sample = 0; sample < 100; sample++) {
        double state[VEHICLE_BODY_STATES];
        vehicle_motion motion;
        draw_state(&seed, state);
        vehicle_bodies_move(&f.system, 0, state, &motion);
        const base_frame *c = &motion.chassis;
        v3 v = m3_apply_transposed(c->A, c->v), w = m3_apply_transposed(c->A, c->w);
        double energy = cloud_energy(chassis, v, w);
        v3 momentum = m3_apply(c->A, cloud_momentum(chassis, v, w));

        v = v3_add(v, v3_cross(w, v3_make(-1.2, 0.6, 0)));
        w.y += state[VEHICLE_RATE + HINGE_AZIMUTH];
        m3 A = m3_rotation_y(state[VEHICLE_ANGLE + HINGE_AZIMUTH]);
        v = m3_apply_transposed(A, v);
        w = m3_apply_transposed(A, w);
        m3 A_I = m3_mul(c->A, A);
        energy += cloud_energy(azimuth, v, w);
        momentum = v3_add(momentum, m3_apply(A_I, cloud_momentum(azimuth, v, w)));

        v = v3_add(v, v3_cross(w, v3_make(-0.6, 0.7, 0)));
        w.z += state[VEHICLE_RATE + HINGE_ELEVATION];
        A = m3_rotation_z(state[VEHICLE_ANGLE + HINGE_ELEVATION]);
        v = m3_apply_transposed(A, v);
        w = m3_apply_transposed(A, w);
        A_I = m3_mul(A_I, A);
        energy += cloud_energy(elevation, v, w);
        momentum = v3_add(momentum, m3_apply(A_I, cloud_momentum(elevation, v, w)));

        double by_system = vehicle_bodies_kinetic_energy(&f.system, state);
        energy_error = worst(energy_error, by_system / energy - 1);
        momentum_error = worst_v3(momentum_error, v3_sub(motion.momentum, momentum)) /
                         fmax(v3_norm(momentum), 1);
    }
    CHECK_BELOW("kinetic energy against point masses, relative", energy_error, 2e-13);
    CHECK_BELOW("momentum against point masses, relative", momentum_error, 1e-13);
    free(chassis);
    free(azimuth);
    free(elevation);
    tear_down(&f);
}

// The reference launcher: 2682 kg with the launching tube, which is left out.
static void test_reference_mass(void **context)
{
    (void)context;
    fixture f;
    set_up(&f);
    double tube = 3 * f.model.tubes.section[0].mass_per_length + 8 + 60;
    CHECK_NEAR("elevation platform, all loaded [kg]", f.system.elevation_mass + tube, 2682, 0.4);
    CHECK_NEAR("three bodies [kg]", f.system.mass - f.system.elevation_mass, 11700, 1e-9);
    vehicle_bodies_free(&f.system);

    // every other tube fired or empty: frame, tubes and tails are left
    int fired[16];
    for (int k = 0; k < 16; k++)
        fired[k] = k < 7 ? k + 1 : k + 2;
    f.model.tubes.empty_count = 1;
    f.model.tubes.empty[0] = 18;
    build(&f, 8, fired, 16);
    CHECK_NEAR("without any rocket [kg]", f.system.elevation_mass, 900 + 17 * (tube - 60), 1e-9);
    CHECK_NEAR("tube 8: row 2, column 2: y [m]", f.system.tube_at.y, 0.34, 1e-15);
    CHECK_NEAR("tube 8: row 2, column 2: z [m]", f.system.tube_at.z, -0.36, 1e-15);
    tear_down(&f);
}

// ---- motion

// Frames and measured angles against differences along the state's rates.
static void test_rates_of_motion(void **context)
{
    (void)context;
    fixture f;
    set_up(&f);
    uint64_t seed = 2;
    const double h = 1e-3;
    double point = 0, turn = 0, quaternion = 0, angle = 0;
    for (int sample = 0; sample < 100; sample++) {
        double state[VEHICLE_BODY_STATES], rate[VEHICLE_BODY_STATES], near[VEHICLE_BODY_STATES];
        draw_state(&seed, state);
        vehicle_motion motion, other;
        vehicle_input input = draw_input(&seed);
        evaluate(&f, &input, 0, state, &motion, rate);
        v3 v = v3_zero();
        m3 A_dot = m3_diagonal(0, 0, 0);
        double measured_rate[HINGES] = {0};
        for (int k = 0; k < 4; k++) {
            advance(state, place[k] * h, rate, near);
            vehicle_bodies_move(&f.system, 0, near, &other);
            v = v3_axpy(v, weight[k] / h, other.tube.r);
            A_dot = m3_add(A_dot, m3_scale(weight[k] / h, other.tube.A));
            for (int i = 0; i < HINGES; i++) {
                double change = other.hinge[i].measured - motion.hinge[i].measured;
                measured_rate[i] += weight[k] / h * remainder(change, 2 * PI);
            }
        }
        m3 spin = m3_mul(A_dot, m3_transpose(motion.tube.A));
        point = worst_v3(point, v3_sub(v, motion.tube.v));
        v3 w = {spin.a[2][1], spin.a[0][2], spin.a[1][0]};
        turn = worst_v3(turn, v3_sub(w, motion.tube.w));
        m3 A = q_matrix(motion.tube.q);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                quaternion = worst(quaternion, A.a[i][j] - motion.tube.A.a[i][j]);
        // yaw turns fast where d points up
        double level = hypot(motion.tube.A.a[0][0], motion.tube.A.a[2][0]);
        for (int i = 0; i < HINGES; i++)
            angle =
                worst(angle, (measured_rate[i] - motion.hinge[i].measured_rate) * pow(level, 5));
    }
    CHECK_BELOW("velocity of the tube's origin against differences [m/s]", point, 4e-11);
    CHECK_BELOW("angular velocity against differences [rad/s]", turn, 3e-11);
    CHECK_BELOW("quaternion against matrix", quaternion, 2e-15);
    CHECK_BELOW("rates of pitch and yaw against differences [rad/s]", angle, 4e-11);
    tear_down(&f);
}

// Measured angles of a platform turned by known ones on a level chassis: yaw to the left, pitch up.
static void test_measured_angles(void **context)
{
    (void)context;
    fixture f;
    set_up(&f);
    double state[VEHICLE_BODY_STATES] = {0};
    state[VEHICLE_QUATERNION] = -2; // any length, either sign
    state[VEHICLE_ANGLE + HINGE_AZIMUTH] = 2.7;
    state[VEHICLE_ANGLE + HINGE_ELEVATION] = 0.4;
    vehicle_motion motion;
    vehicle_bodies_move(&f.system, 0, state, &motion);
    CHECK_NEAR("yaw [rad]", motion.hinge[HINGE_AZIMUTH].measured, 2.7, 1e-15);
    CHECK_NEAR("pitch [rad]", motion.hinge[HINGE_ELEVATION].measured, 0.4, 1e-15);
    CHECK_BELOW("x axis points left, to -z", motion.tube.A.a[2][0] + cos(0.4) * sin(2.7), 1e-15);
    tear_down(&f);
}

// ---- balances

static double power_of(v3 force, v3 moment, const base_frame *at)
{
    return v3_dot(force, at->v) + v3_dot(moment, at->w);
}

// Kinetic energy grows by the powers; momentum by gravity and the wrenches alone.
static void check_balances(fixture *f, uint64_t seed, const char *what)
{
    const double h = 1e-4;
    double energy_error = 0, momentum_error = 0, angular_error = 0;
    for (int sample = 0; sample < 100; sample++) {
        double state[VEHICLE_BODY_STATES], rate[VEHICLE_BODY_STATES], near[VEHICLE_BODY_STATES];
        draw_state(&seed, state);
        vehicle_motion motion;
        vehicle_input input = draw_input(&seed);
        for (int i = 0; i < HINGES; i++)
            input.rest[i] = (hold_rest){draw(&seed), 1e4 * draw(&seed)};
        vehicle_output output = evaluate(f, &input, 0, state, &motion, rate);
        v3 force = m3_apply(motion.tube.A, input.tube_force);
        v3 moment = m3_apply(motion.tube.A, input.tube_moment);
        double power = power_of(input.chassis_force, input.chassis_moment, &motion.chassis) +
                       power_of(force, moment, &motion.tube);
        for (int k = 0; k < VEHICLE_BODY_POWERS; k++)
            power += output.power[k];

        double energy_rate = 0, scale = 0;
        v3 momentum_rate = v3_zero(), angular_rate = v3_zero(), center = v3_zero();
        for (int k = 0; k < 4; k++) {
            double linear[3], angular[3];
            advance(state, place[k] * h, rate, near);
            double energy = vehicle_bodies_kinetic_energy(&f->system, near);
            ld_mstmm_momentum(f->system.mechanism.chain, near, near + VEHICLE_V, linear, angular);
            energy_rate += weight[k] / h * energy;
            momentum_rate = v3_axpy(momentum_rate, weight[k] / h, v3_from(linear));
            angular_rate = v3_axpy(angular_rate, weight[k] / h, v3_from(angular));
            scale = fmax(scale, energy);
        }
        energy_error = worst(energy_error, (energy_rate - power) / fmax(scale, fabs(power)));

        // gravity acts at the common mass centre, found from the bodies' places
        const ld_platform *given = &f->model.platform;
        m3 A = m3_mul(motion.chassis.A, m3_rotation_y(motion.hinge[HINGE_AZIMUTH].angle));
        v3 r =
            v3_add(motion.chassis.r, m3_apply(motion.chassis.A, v3_from(given->azimuth.hinge_at)));
        center = v3_scale(given->chassis_mass, motion.chassis.r);
        center = v3_axpy(center, given->azimuth.mass,
                         v3_add(r, m3_apply(A, v3_from(given->azimuth.center))));
        v3 arm = v3_sub(f->system.elevation_center, f->system.tube_at);
        center = v3_axpy(center, f->system.elevation_mass,
                         v3_add(motion.tube.r, m3_apply(motion.tube.A, arm)));
        v3 g = v3_make(0, -f->model.gravity, 0);
        v3 total = v3_axpy(v3_add(input.chassis_force, force), f->system.mass, g);
        v3 turning = v3_add(v3_add(input.chassis_moment, moment), v3_cross(center, g));
        turning = v3_add(turning, v3_cross(motion.chassis.r, input.chassis_force));
        turning = v3_add(turning, v3_cross(motion.tube.r, force));
        momentum_error = worst_v3(momentum_error, v3_sub(momentum_rate, total));
        angular_error = worst_v3(angular_error, v3_sub(angular_rate, turning));
    }
    printf("  %s\n", what);
    CHECK_BELOW("energy rate against powers, relative", energy_error, 2e-11);
    CHECK_BELOW("force against the rate of momentum [N]", momentum_error, 2e-7);
    CHECK_BELOW("moment against the rate of angular momentum [N m]", angular_error, 2e-6);
}

static void test_balances(void **context)
{
    (void)context;
    fixture f;
    set_up(&f);
    check_balances(&f, 3, "stabilisers");
    f.model.platform.azimuth.lock = (ld_hinge_lock){true, 1e6, 1e4};
    f.model.platform.elevation.lock = (ld_hinge_lock){true, 2e6, 1e4};
    rebuild(&f);
    check_balances(&f, 4, "locks");
    tear_down(&f);
}

static void test_forms_agree(void **context)
{
    (void)context;
    fixture f;
    set_up(&f);
    uint64_t seed = 5;
    double difference = 0, loss = 0;
    for (int sample = 0; sample < 1000; sample++) {
        double state[VEHICLE_BODY_STATES], reduced[VEHICLE_BODY_STATES], paper[VEHICLE_BODY_STATES];
        draw_state(&seed, state);
        vehicle_motion motion;
        vehicle_input input = draw_input(&seed);
        f.system.mechanism.overall = false;
        evaluate(&f, &input, 0, state, &motion, reduced);
        f.system.mechanism.overall = true;
        loss = worst(loss, evaluate(&f, &input, 0, state, &motion, paper).loss);
        double size = 0, off = 0;
        for (int k = VEHICLE_V; k < VEHICLE_Z; k++) {
            size = fmax(size, fabs(reduced[k]));
            off = worst(off, paper[k] - reduced[k]);
        }
        difference = worst(difference, off / size);
    }
    CHECK_BELOW("overall against reduced form, 1000 states, relative", difference, 1e-14);
    CHECK_BELOW("the same as reported", loss - difference, 1e-16);
    tear_down(&f);
}

// ---- torques

// A level chassis at rest with the platform at the given yaw and pitch and their rates.
static vehicle_output at_rest(const fixture *f, double t, const double angle[HINGES],
                              const double rate[HINGES], const double z[HINGES],
                              const vehicle_input *input, vehicle_motion *motion, double *state_dot)
{
    double state[VEHICLE_BODY_STATES] = {0};
    state[VEHICLE_QUATERNION] = 1;
    for (int i = 0; i < HINGES; i++) {
        state[VEHICLE_ANGLE + i] = angle[i];
        state[VEHICLE_RATE + i] = rate[i];
        state[VEHICLE_Z + i] = z[i];
    }
    return evaluate(f, input, t, state, motion, state_dot);
}

// Command of the azimuth stabiliser: up to 2 rad at 1 s, back to 0 at 3 s.
static void give_corner(fixture *f)
{
    ld_table *table = &f->model.platform.azimuth.stabiliser.command;
    free(table->data);
    *table = reference_table(3, 2, (double[]){0, 0, 1, 2, 3, 0});
    rebuild(f);
}

static void test_stabiliser(void **context)
{
    (void)context;
    fixture f;
    set_up(&f);
    give_corner(&f);
    const double none[HINGES] = {0}, z[HINGES] = {123, -456};
    const vehicle_input input = {0};
    vehicle_motion motion;
    double dot[VEHICLE_BODY_STATES];
    const hinge_report *azimuth = &motion.hinge[HINGE_AZIMUTH];
    const hinge_report *elevation = &motion.hinge[HINGE_ELEVATION];

    // before, in, at the corner (slope behind it) and after the table
    const double t[] = {-1, 0.5, 1, 2, 5}, command[] = {0, 1, 2, 1, 0}, slope[] = {0, 2, -1, -1, 0};
    double command_error = 0;
    for (int k = 0; k < 5; k++) {
        at_rest(&f, t[k], none, none, none, &input, &motion, dot);
        command_error = worst(command_error, azimuth->command - command[k]);
        command_error = worst(command_error, azimuth->command_rate - slope[k]);
    }
    CHECK_BELOW("command and its rate", command_error, 0);

    // T = kp e + kd e_dot + z; yaw 0.99 of 1 commanded, turning at 1.95 of 2
    double expected = 4e6 * 0.01 + 3e5 * 0.05 + 123;
    f.model.platform.azimuth.stabiliser.torque_limit = 1e6;
    rebuild(&f);
    at_rest(&f, 0.5, (double[]){0.99, 0.345}, (double[]){1.95, 0.02}, z, &input, &motion, dot);
    CHECK_NEAR("azimuth torque by yaw [N m]", azimuth->torque, expected, 1e-8);
    CHECK_NEAR("its integral's rate [N m/s]", dot[VEHICLE_Z], 4e6 * 0.01, 1e-8);
    double e = 19.8 * PI / 180 - 0.345;
    expected = 6e6 * e - 4e5 * 0.02 - 456;
    CHECK_NEAR("elevation torque by pitch [N m]", elevation->torque, expected, 1e-8);
    CHECK_NEAR("its integral's rate [N m/s]", dot[VEHICLE_Z + 1], 6e6 * e, 1e-8);

    // the error goes the short way round
    at_rest(&f, 1, (double[]){-3, 0}, none, none, &input, &motion, dot);
    CHECK_NEAR("wrapped error [rad]", azimuth->error, 5 - 2 * PI, 1e-15);
    tear_down(&f);
}

// Torque limit, and an integral that stops where it would wind up beyond the limit.
static void test_torque_limit(void **context)
{
    (void)context;
    fixture f;
    set_up(&f);
    const double still[HINGES] = {0}, limit = 5e4;
    const vehicle_input input = {0};
    const struct {
        double yaw, z, torque, z_dot;
        bool limited;
    } row[] = {
        {-0.1, 0, limit, 4e5, true},           // error 0.1: 4e5 N m requested
        {0.1, 0, -limit, -4e5, true},          //
        {-0.001, 1e4, 1.4e4, 4e3, false},      //
        {-0.001, limit, limit, 0, true},       // z at its limit, e of the same sign
        {0.001, limit, 4.6e4, -4e3, false},    // and of the other sign: it goes back
        {0.001, -1.1 * limit, -limit, 0, true} //
    };
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        vehicle_motion motion;
        double dot[VEHICLE_BODY_STATES];
        at_rest(&f, 0, (double[]){row[k].yaw, 0}, still, (double[]){row[k].z, 0}, &input, &motion,
                dot);
        CHECK_NEAR("torque [N m]", motion.hinge[HINGE_AZIMUTH].torque, row[k].torque, 1e-9);
        CHECK_NEAR("integral's rate [N m/s]", dot[VEHICLE_Z], row[k].z_dot, 1e-9);
        assert_int_equal(motion.hinge[HINGE_AZIMUTH].limited, row[k].limited);
    }
    tear_down(&f);
}

static void test_friction_and_locks(void **context)
{
    (void)context;
    fixture f;
    set_up(&f);
    const double angle[HINGES] = {0.03, 0.2}, rate[HINGES] = {1e-3, -2e-3}, z[HINGES] = {1e6, 7};
    vehicle_input input = {.rest = {{0.01, 30}, {0.25, 1e4}}};
    vehicle_motion motion;
    double dot[VEHICLE_BODY_STATES];
    const hinge_report *azimuth = &motion.hinge[HINGE_AZIMUTH];
    const hinge_report *elevation = &motion.hinge[HINGE_ELEVATION];

    // friction comes on top of a torque at its limit
    vehicle_output output = at_rest(&f, 0, angle, rate, z, &input, &motion, dot);
    CHECK_NEAR("azimuth friction [N m]", azimuth->friction, -0.5 - 200 / sqrt(2), 1e-12);
    CHECK_NEAR("elevation friction [N m]", elevation->friction, 1.6 + 600 / sqrt(5), 1e-12);
    CHECK_NEAR("azimuth torque [N m]", azimuth->torque, 5e4, 0);
    CHECK_NEAR("power of friction [W]", output.power[VEHICLE_FRICTION],
               1e-3 * azimuth->friction - 2e-3 * elevation->friction, 1e-15);
    input.linear = true;
    at_rest(&f, 0, angle, rate, z, &input, &motion, dot);
    CHECK_NEAR("viscous part alone [N m]", elevation->friction, 1.6, 1e-15);

    // a lock in place of the stabiliser, without limit
    f.model.platform.elevation.lock = (ld_hinge_lock){true, 1e7, 1e5};
    rebuild(&f);
    at_rest(&f, 0, angle, rate, z, &input, &motion, dot);
    CHECK_NEAR("locked [N m]", elevation->torque, 1e4 + 1e7 * 0.05 + 1e5 * 2e-3, 1e-8);
    CHECK_BELOW("its integral rests", dot[VEHICLE_Z + HINGE_ELEVATION], 0);

    // held: the given torques and nothing else
    input.held = true;
    at_rest(&f, 0, angle, rate, z, &input, &motion, dot);
    CHECK_NEAR("held azimuth [N m]", azimuth->torque, 30, 0);
    CHECK_NEAR("held elevation [N m]", elevation->torque, 1e4, 0);
    CHECK_BELOW("friction of held hinges", azimuth->friction + elevation->friction, 0);
    tear_down(&f);
}

// A state that is not finite is reported, not passed on.
static void test_not_finite(void **context)
{
    (void)context;
    fixture f;
    set_up(&f);
    double state[VEHICLE_BODY_STATES] = {[VEHICLE_QUATERNION] = 1}, dot[VEHICLE_BODY_STATES];
    const vehicle_input input = {.tube_force = {0, NAN, 0}};
    vehicle_motion motion;
    vehicle_output output;
    vehicle_bodies_move(&f.system, 0, state, &motion);
    assert_int_not_equal(vehicle_bodies_evaluate(&f.system, &input, state, &motion, dot, &output),
                         0);
    tear_down(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_mass_data),          cmocka_unit_test(test_reference_mass),
        cmocka_unit_test(test_rates_of_motion),    cmocka_unit_test(test_measured_angles),
        cmocka_unit_test(test_balances),           cmocka_unit_test(test_forms_agree),
        cmocka_unit_test(test_stabiliser),         cmocka_unit_test(test_torque_limit),
        cmocka_unit_test(test_friction_and_locks), cmocka_unit_test(test_not_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
