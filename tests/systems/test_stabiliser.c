// The options of a stabiliser on one balanced platform over a heavy chassis that turns at a
// constant rate W about the hinge's axis: against the linear loop's matrix exponential, written
// here on its own, and against what is known exactly.
#include <stdlib.h>

#include "integration/integrator.h"
#include "model/model.h"
#include "support/check.h"
#include "support/reference_model.h"
#include "support/vehicle_bodies.h"

static const double J = 800, C = 900, W = 0.02; // [kg m2], [N m s/rad] friction, [rad/s]

typedef struct fixture {
    ld_model model;
    vehicle_bodies system;
    ld_stabiliser *given; // the elevation's
    double state[VEHICLE_MOST_BODY_STATES];
} fixture;

static void set_up(fixture *f)
{
    *f = (fixture){0};
    reference_vehicle(&f->model, 0);
    ld_platform *platform = &f->model.platform;
    ld_turret *turret[HINGES] = {&platform->azimuth, &platform->elevation};
    f->model.gravity = 0;
    f->model.tubes.layout.rows = f->model.tubes.layout.columns = 1;
    platform->chassis_mass = 1e12;
    for (int i = 0; i < 3; i++)
        platform->chassis_inertia[i] = 1e12;
    for (int i = 0; i < HINGES; i++) {
        memset(turret[i]->hinge_at, 0, sizeof turret[i]->hinge_at);
        memset(turret[i]->center, 0, sizeof turret[i]->center);
        turret[i]->friction = (ld_hinge_friction){.viscous = C, .rate = 1e-3};
    }
    platform->azimuth.lock = (ld_hinge_lock){true, 1e6, 1e3};
    for (int i = 0; i < 3; i++)
        platform->elevation.inertia[i] = J;
    f->given = &platform->elevation.stabiliser;
    free(f->given->command.data);
    f->given->command = reference_table(1, 2, (double[]){0, 0});
    f->given->torque_limit = 1e9;
}

// The platform at rest on its turning base, its pitch 0.
static void begin(fixture *f)
{
    ld_error error;
    if (vehicle_bodies_build(&f->system, &f->model, 1, NULL, 0, &error))
        fail_msg("%s", error.text);
    memset(f->state, 0, sizeof f->state);
    f->state[VEHICLE_QUATERNION] = 1;
    f->state[VEHICLE_W + 2] = W;
}

static void tear_down(fixture *f)
{
    vehicle_bodies_free(&f->system);
    reference_model_free(&f->model);
}

static int rhs(double t, const double *y, double *y_dot, void *user)
{
    const fixture *f = user;
    const vehicle_input input = {0};
    vehicle_motion motion;
    vehicle_output output;
    vehicle_bodies_move(&f->system, t, y, &motion);
    return vehicle_bodies_evaluate(&f->system, &input, y, &motion, y_dot, &output);
}

// Continues from time `from` to time `to`.
static void follow(fixture *f, double from, double to)
{
    ld_error error;
    integrator *stepper;
    double atol[VEHICLE_MOST_BODY_STATES];
    for (int i = 0; i < f->system.state_count; i++)
        atol[i] = 1e-13;
    integrator_settings settings = {.n = (size_t)f->system.state_count,
                                    .method = INTEGRATOR_CASH_KARP,
                                    .rtol = 1e-11,
                                    .atol = atol,
                                    .rhs = rhs,
                                    .self = f};
    assert_int_equal(integrator_create(&settings, &stepper, &error), LD_OK);
    assert_int_equal(integrator_start(stepper, from, f->state, &error), LD_OK);
    integrator_outcome outcome = INTEGRATOR_STEPPED;
    while (outcome == INTEGRATOR_STEPPED)
        outcome = integrator_step(stepper, to, &error);
    assert_int_equal(outcome, INTEGRATOR_STOPPED);
    memcpy(f->state, integrator_state(stepper), settings.n * sizeof *f->state);
    integrator_free(stepper);
}

enum { MOST = 6 };

// x := exp(A t) x, by Taylor's series in 1024 equal steps.
static void go_on(int n, double A[MOST][MOST], double t, double *x)
{
    enum { STEPS = 1024, TERMS = 12 };
    for (int step = 0; step < STEPS; step++) {
        double term[MOST], next[MOST];
        memcpy(term, x, sizeof term);
        for (int k = 1; k <= TERMS; k++) {
            for (int i = 0; i < n; i++) {
                next[i] = 0;
                for (int j = 0; j < n; j++)
                    next[i] += A[i][j] * term[j] * (t / STEPS) / k;
            }
            memcpy(term, next, sizeof term);
            for (int i = 0; i < n; i++)
                x[i] += term[i];
        }
    }
}

static hinge_report hinge_of(const fixture *f, double t)
{
    vehicle_motion motion;
    vehicle_output output;
    double unused[VEHICLE_MOST_BODY_STATES];
    const vehicle_input input = {0};
    vehicle_bodies_move(&f->system, t, f->state, &motion);
    vehicle_bodies_evaluate(&f->system, &input, f->state, &motion, unused, &output);
    return motion.hinge[HINGE_ELEVATION];
}

// The elevation's drive.
static double *drive_of(fixture *f)
{
    return f->state + VEHICLE_DRIVE + HINGE_ELEVATION * DRIVE_STATES;
}

// The platform from now on for 0.4 s against x' = A x of n unknowns, the first three of which are
// pitch, its rate and z, the fourth the torque of a drive where there is one; the largest error of
// the angle.
static double compare(fixture *f, int n, double A[MOST][MOST], double *x)
{
    double pitch = 0, rate = 0, torque = 0, largest = 0;
    for (int i = 0; i < 20; i++) {
        follow(f, 0.02 * i, 0.02 * (i + 1));
        go_on(n, A, 0.02, x);
        const hinge_report hinge = hinge_of(f, 1);
        pitch = fmax(pitch, fabs(hinge.measured - x[0]));
        rate = fmax(rate, fabs(hinge.measured_rate - x[1]));
        torque = fmax(torque, fabs(f->state[VEHICLE_Z + HINGE_ELEVATION] - x[2]));
        if (f->system.state_count > VEHICLE_DRIVE)
            torque = fmax(torque, fabs(drive_of(f)[DRIVE_TORQUE] - x[3]));
        largest = fmax(largest, fabs(hinge.error));
    }
    printf("  error up to %.3g mrad\n", 1e3 * largest);
    CHECK_BELOW("pitch [rad]", pitch, 1e-12);
    CHECK_BELOW("its rate [rad/s]", rate, 1e-11);
    CHECK_BELOW("torques in the state [N m]", torque, 2e-7);
    return largest;
}

// ---- feedforward

// Friction drags the platform along with its base, the feedforward pushes it back: with a share of
// C/kd of the base's rate nothing of the base is felt.
static void feedforward(void **context)
{
    (void)context;
    static const double share[] = {0, 0.02, 0.045, 0.3};
    for (int k = 0; k < 4; k++) {
        fixture f;
        set_up(&f);
        double kp = f.given->kp = 8e5, ki = f.given->ki = 4e6, kd = f.given->kd = 2e4;
        f.given->feedforward = share[k];
        begin(&f);
        // pitch, its rate, z, 1
        double x[MOST] = {0, W, 0, 1}, drag = (C - share[k] * kd) * W / J;
        double A[MOST][MOST] = {{0, 1}, {-kp / J, -(kd + C) / J, 1 / J, drag}, {-ki}, {0}};
        if (k == 2) // nothing drags: at rest in I it stays there
            x[1] = 0, f.state[VEHICLE_RATE + HINGE_ELEVATION] = -W;
        double error = compare(&f, 4, A, x);
        if (k == 2)
            CHECK_BELOW("error without drag [rad]", error, 1e-14);
        tear_down(&f);
    }
}

// ---- cascade and lag

// A step of the command, 2 mrad, by PID or by a cascade, whose torque is
// rate_kp (kp e + e_dot) + z, z_dot = rate_ki (kp e + e_dot), each at once or after a lag.
static void loops(void **context)
{
    (void)context;
    for (int k = 0; k < 4; k++) {
        fixture f;
        set_up(&f);
        bool cascade = k % 2, lags = k / 2;
        double step = f.given->command.data[1] = 2e-3, kp = 8e5, ki = 4e6, kd = 2e4, z[4];
        f.given->kp = kp, f.given->ki = ki, f.given->kd = kd;
        if (cascade) {
            f.given->cascade = (ld_cascade){true, 25, 2.2e4, 3e5};
            kp = 25 * 2.2e4, kd = 2.2e4, ki = 25 * 3e5;
            memcpy(z, (double[]){-ki, -3e5, 0, ki * step}, sizeof z);
        } else {
            memcpy(z, (double[]){-ki, 0, 0, ki * step}, sizeof z);
        }
        double rate = 2 * 3.14159265358979324 * 12;
        f.given->bandwidth = lags ? 12 : 0;
        begin(&f);
        vehicle_bodies_rest(&f.system, f.state);
        double x[MOST] = {0, W, 0, 0, 1};
        if (lags) { // pitch, rate, z, torque, 1
            double A[MOST][MOST] = {{0, 1},
                                    {0, -C / J, 0, 1 / J, C * W / J},
                                    {z[0], z[1], 0, 0, z[3]},
                                    {-rate * kp, -rate * kd, rate, -rate, rate * kp * step},
                                    {0}};
            compare(&f, 5, A, x);
        } else { // pitch, rate, z, -, 1
            double A[MOST][MOST] = {{0, 1},
                                    {-kp / J, -(kd + C) / J, 1 / J, 0, (kp * step + C * W) / J},
                                    {z[0], z[1], 0, 0, z[3]},
                                    {0},
                                    {0}};
            compare(&f, 5, A, x);
        }
        tear_down(&f);
    }
}

// On a platform that hardly moves the torque asked for jumps and stays: the actuator's goes up a
// ramp until its lag alone is slower, then on as a lag.
static void ramp(double sign)
{
    fixture f;
    set_up(&f);
    const double asked = 8e3, rate = 2 * 3.14159265358979324 * 20;
    for (int i = 0; i < 3; i++)
        f.model.platform.elevation.inertia[i] = 1e15;
    *f.given = (ld_stabiliser){
        .command = f.given->command, .kp = 8e5, .torque_limit = 1e9, .bandwidth = 20, .slew = 4e5};
    f.given->command.data[1] = sign * asked / 8e5;
    f.model.platform.elevation.friction.viscous = 0;
    begin(&f);
    f.state[VEHICLE_W + 2] = 0;
    vehicle_bodies_rest(&f.system, f.state);
    double corner = (asked - 4e5 / rate) / 4e5, worst = 0;
    for (int i = 0; i < 20; i++) {
        double t = 2e-3 * (i + 1), expected = 4e5 * t;
        follow(&f, 2e-3 * i, t);
        if (t > corner)
            expected = asked - 4e5 / rate * exp(-rate * (t - corner));
        worst = fmax(worst, fabs(sign * hinge_of(&f, t).torque - expected));
    }
    printf("  ramp of %.3g ms\n", 1e3 * corner);
    CHECK_BELOW("torque [N m]", worst, 1e-6);
    tear_down(&f);
}

static void slew(void **context)
{
    (void)context;
    ramp(1);
    ramp(-1);
}

// ---- digital loop

// A rigid inertia without friction on a base at rest.
static void let_go(fixture *f)
{
    f->model.platform.elevation.friction.viscous = 0;
    begin(f);
    f->state[VEHICLE_W + 2] = 0;
}

// A step of the command, 2 mrad, by a sampled PID with a delay: between the instants the torque
// stays, so that angle and rate are known exactly.
static void sampled(void **context)
{
    (void)context;
    static const double late[] = {0, 0.4, 1}; // of the period
    for (int k = 0; k < 3; k++) {
        fixture f;
        set_up(&f);
        const double T = 5e-3, d = late[k] * T, kp = 8e5, ki = 4e6, kd = 2e4, quantum = 1e-4;
        f.given->kp = kp, f.given->ki = ki, f.given->kd = kd;
        f.given->sample = T, f.given->delay = d;
        f.given->resolution.angle = quantum;
        f.given->command.data[1] = 2e-3;
        let_go(&f);
        double t = 0, angle = 0, rate = 0, z = 0, held = 0, computed = 0, worst = 0;
        for (int n = 1; n <= 60; n++) {
            // the equations' way, until sample n has been taken
            while (t < n * T) {
                double next = vehicle_bodies_next_sample(&f.system, t);
                follow(&f, t, next);
                vehicle_bodies_sample(&f.system, next, f.state);
                t = next;
            }
            // by hand: until the torque of sample n - 1 comes, and on
            angle += rate * d + 0.5 * held / J * d * d;
            rate += held / J * d;
            held = computed;
            angle += rate * (T - d) + 0.5 * held / J * (T - d) * (T - d);
            rate += held / J * (T - d);
            double error = 2e-3 - quantum * round(angle / quantum);
            computed = kp * error - kd * rate + z;
            z += T * ki * error;
            if (d == 0)
                held = computed;
            const hinge_report hinge = hinge_of(&f, t);
            worst = fmax(worst, fabs(hinge.measured - angle));
            worst = fmax(worst, fabs(hinge.measured_rate - rate) * T);
            worst = fmax(worst, fabs(f.state[VEHICLE_Z + HINGE_ELEVATION] - z) / kp);
        }
        printf("  delay %g ms: after %g ms at %.4g mrad\n", 1e3 * d, 1e3 * t, 1e3 * angle);
        CHECK_BELOW("angle, rate x period, z/kp [rad]", worst, 1e-12);
        tear_down(&f);
    }
}

// A commanded ramp whose two corners lie on samples, which take the rate behind each.
static void sampled_on_corners(void **context)
{
    (void)context;
    const double T = 5e-3, kp = 8e5, kd = 2e4, slope = 0.2; // [s], .., [rad/s]
    enum { BEGIN = 4, END = 12, SAMPLES = 24 };
    fixture f;
    set_up(&f);
    f.given->kp = kp, f.given->ki = 0, f.given->kd = kd, f.given->sample = T;
    free(f.given->command.data);
    f.given->command = reference_table(2, 2,
                                       (double[]){BEGIN * T, 0, //
                                                  END * T, slope * (END - BEGIN) * T});
    let_go(&f);
    double angle = 0, rate = 0, held = 0, worst = 0, torque = 0;
    for (int n = 1; n <= SAMPLES; n++) {
        follow(&f, (n - 1) * T, n * T);
        vehicle_bodies_sample(&f.system, n * T, f.state);
        angle += rate * T + 0.5 * held / J * T * T;
        rate += held / J * T;
        int along = n < BEGIN ? 0 : n < END ? n - BEGIN : END - BEGIN;
        double commanded_rate = n >= BEGIN && n < END ? slope : 0;
        held = kp * (slope * along * T - angle) + kd * (commanded_rate - rate);
        const hinge_report hinge = hinge_of(&f, n * T);
        worst = fmax(worst, fabs(hinge.measured - angle));
        worst = fmax(worst, fabs(hinge.measured_rate - rate) * T);
        if (n == BEGIN)
            torque = held;
    }
    CHECK_BELOW("angle, rate x period [rad]", worst, 1e-12);
    CHECK_NEAR("torque at the first corner over kd x rate", torque / (kd * slope), 1, 1e-12);
    tear_down(&f);
}

// What a sensor adds: its rms, white, of both channels, neither of them the other's.
static void noise(void **context)
{
    (void)context;
    enum { SAMPLES = 20000 };
    static double heard[2][SAMPLES];
    fixture f;
    set_up(&f);
    for (int channel = 0; channel < 2; channel++) {
        *f.given = (ld_stabiliser){.command = f.given->command,
                                   .kp = channel == 0,
                                   .kd = channel == 1,
                                   .torque_limit = 1e9,
                                   .sample = 1e-3,
                                   .noise = {0.03, 0.2, 7}};
        const hinge_report still = {0};
        for (int k = 0; k < SAMPLES; k++) {
            double z = 0, drive[DRIVE_STATES] = {0};
            stabiliser_sample(f.given, (k - SAMPLES / 2) * 1e-3, 12, &still, &z, drive);
            heard[channel][k] = -drive[DRIVE_HELD];
        }
    }
    double squares[2] = {0}, next[2] = {0}, both = 0;
    for (int k = 0; k < SAMPLES; k++) {
        for (int i = 0; i < 2; i++) {
            squares[i] += heard[i][k] * heard[i][k];
            next[i] += heard[i][k] * heard[i][(k + 1) % SAMPLES];
        }
        both += heard[0][k] * heard[1][k];
    }
    // five standard errors
    const double far = 5 / sqrt(SAMPLES);
    CHECK_BELOW("rms of the angle, over 0.03", fabs(sqrt(squares[0] / SAMPLES) / 0.03 - 1), far);
    CHECK_BELOW("rms of the rate, over 0.2", fabs(sqrt(squares[1] / SAMPLES) / 0.2 - 1), far);
    CHECK_BELOW("next samples' correlation, angle", fabs(next[0] / squares[0]), far);
    CHECK_BELOW("next samples' correlation, rate", fabs(next[1] / squares[1]), far);
    CHECK_BELOW("angle's with rate", fabs(both) / sqrt(squares[0] * squares[1]), far);
    tear_down(&f);
}

// ---- gear

// A step of the command through a gear without backlash: two inertias and a spring between them.
static void two_masses(void **context)
{
    (void)context;
    fixture f;
    set_up(&f);
    const double kp = 8e5, kd = 2e4, step = 2e-3, k = 3e6, d = 2e3, motor = 200;
    f.given->kp = kp, f.given->ki = 0, f.given->kd = kd;
    f.given->gear = (ld_gear){true, k, d, motor, 0};
    f.given->command.data[1] = step;
    begin(&f);
    vehicle_bodies_rest(&f.system, f.state);
    // pitch, its rate, the gear's twist, the motor's rate against the base, 1
    double x[MOST] = {0, W, 0, 0, 1}, angles = 0, rates = 0;
    double A[MOST][MOST] = {
        {0, 1},
        {0, -(C + d) / J, k / J, d / J, (C + d) * W / J},
        {0, -1, 0, 1, W},
        {-kp / motor, (d - kd) / motor, -k / motor, -d / motor, (kp * step - d * W) / motor},
        {0}};
    for (int i = 0; i < 20; i++) {
        follow(&f, 0.02 * i, 0.02 * (i + 1));
        go_on(5, A, 0.02, x);
        const hinge_report hinge = hinge_of(&f, 1);
        angles = fmax(angles, fabs(hinge.measured - x[0]));
        angles = fmax(angles, fabs(drive_of(&f)[DRIVE_TWIST] - x[2]));
        rates = fmax(rates, fabs(hinge.measured_rate - x[1]));
        rates = fmax(rates, fabs(drive_of(&f)[DRIVE_RATE] - x[3]));
    }
    CHECK_BELOW("pitch, twist [rad]", angles, 5e-11);
    CHECK_BELOW("their rates [rad/s]", rates, 5e-9);
    tear_down(&f);
}

// A motor pushed off one side of the teeth by a constant torque: it runs free through the backlash,
// then presses on the other side, from where it swings back, as one mass on a spring.
static void free_travel(void **context)
{
    (void)context;
    fixture f;
    set_up(&f);
    const double push = 500, backlash = 1e-3, k = 3e6, motor = 200;
    for (int i = 0; i < 3; i++)
        f.model.platform.elevation.inertia[i] = 1e15;
    *f.given = (ld_stabiliser){.command = f.given->command, .kp = push / 0.01, .torque_limit = 1e9};
    f.given->gear = (ld_gear){true, k, 0, motor, backlash};
    f.given->command.data[1] = -0.01;
    let_go(&f);
    vehicle_bodies_rest(&f.system, f.state);
    double touch = sqrt(2 * backlash * motor / push), speed = push / motor * touch;
    double omega = sqrt(k / motor), twist = 0, torque = 0, t = 0;
    CHECK_NEAR("at the start [rad]", drive_of(&f)[DRIVE_TWIST], 0.5 * backlash, 1e-15);
    for (int i = 1; i <= 50; i++) {
        double from = t, expected = 0;
        t = (touch + 2 / omega) * i / 50;
        double at = 0.5 * backlash - 0.5 * push / motor * t * t, since = t - touch;
        follow(&f, from, t);
        if (since > 0) {
            expected = -push * (1 - cos(omega * since)) - speed * k / omega * sin(omega * since);
            at = -0.5 * backlash + expected / k;
        }
        twist = fmax(twist, fabs(drive_of(&f)[DRIVE_TWIST] - at));
        torque = fmax(torque, fabs(hinge_of(&f, t).torque - expected));
    }
    printf("  free for %.4g ms\n", 1e3 * touch);
    CHECK_BELOW("twist [rad]", twist, 1e-12);
    CHECK_BELOW("torque on the hinge [N m]", torque, 3e-6);
    tear_down(&f);
}

// Damped teeth push; where they part they do not pull.
static void parting(void **context)
{
    (void)context;
    fixture f;
    set_up(&f);
    f.given->gear = (ld_gear){true, 1e6, 1e4, 200, 1e-3};
    begin(&f);
    f.state[VEHICLE_W + 2] = 0;
    static const struct {
        double twist, rate, torque;
    } row[] = {{0.7e-3, 0.01, 300}, {0.7e-3, -0.01, 100},  {0.7e-3, -0.03, 0}, {0.4e-3, 0.5, 0},
               {-0.4e-3, -1, 0},    {-0.7e-3, 0.01, -100}, {-0.7e-3, 0.03, 0}};
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        drive_of(&f)[DRIVE_TWIST] = row[i].twist;
        drive_of(&f)[DRIVE_RATE] = row[i].rate;
        CHECK_NEAR("torque [N m]", hinge_of(&f, 0).torque, row[i].torque, 1e-9);
    }
    tear_down(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(feedforward),
        cmocka_unit_test(loops),
        cmocka_unit_test(slew),
        cmocka_unit_test(sampled),
        cmocka_unit_test(sampled_on_corners),
        cmocka_unit_test(noise),
        cmocka_unit_test(two_masses),
        cmocka_unit_test(free_travel),
        cmocka_unit_test(parting),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
