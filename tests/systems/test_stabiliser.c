// The options of a stabiliser on one balanced platform over a heavy chassis that turns at a
// constant rate W about the hinge's axis: against the linear loop's matrix exponential, written
// here on its own, and against what is known exactly.
#include <stdlib.h>

#include "simulation/integrator.h"
#include "support/check.h"
#include "support/reference_model.h"
#include "systems/orientating.h"

static const double J = 800, C = 900, W = 0.02; // [kg m2], [N m s/rad] friction, [rad/s]

typedef struct fixture {
    ld_model model;
    orientating_system system;
    ld_stabiliser *given; // the elevation's
    double state[ORIENTATING_STATES];
} fixture;

static void set_up(fixture *f)
{
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
    if (orientating_build(&f->system, &f->model, 1, NULL, 0, &error))
        fail_msg("%s", error.text);
    memset(f->state, 0, sizeof f->state);
    f->state[ORIENTATING_QUATERNION] = 1;
    f->state[ORIENTATING_W + 2] = W;
}

static void tear_down(fixture *f)
{
    orientating_free(&f->system);
    reference_model_free(&f->model);
}

static int rhs(double t, const double *y, double *y_dot, void *user)
{
    const fixture *f = user;
    const orientating_input input = {0};
    orientating_motion motion;
    orientating_output output;
    orientating_motion_at(&f->system, t, y, &motion);
    return orientating_evaluate(&f->system, &input, y, &motion, y_dot, &output);
}

// Goes on from time `from` to time `to`.
static void follow(fixture *f, double from, double to)
{
    ld_error error;
    integrator *stepper;
    double atol[ORIENTATING_STATES];
    for (int i = 0; i < ORIENTATING_STATES; i++)
        atol[i] = 1e-13;
    integrator_settings settings = {.n = ORIENTATING_STATES,
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
    memcpy(f->state, integrator_state(stepper), sizeof f->state);
    integrator_free(stepper);
}

static orientating_motion motion_of(const fixture *f, double t)
{
    orientating_motion motion;
    orientating_motion_at(&f->system, t, f->state, &motion);
    return motion;
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
        double x[MOST] = {0, W, 0, 1}, drag = (C - share[k] * kd) * W / J, largest = 0;
        double pitch = 0, rate = 0, integral = 0; // largest differences
        double A[MOST][MOST] = {{0, 1}, {-kp / J, -(kd + C) / J, 1 / J, drag}, {-ki}, {0}};
        f.state[ORIENTATING_RATE + HINGE_ELEVATION] = 0;
        if (k == 2) // nothing drags: at rest in I it stays there
            x[1] = 0, f.state[ORIENTATING_RATE + HINGE_ELEVATION] = -W;
        for (int i = 0; i < 20; i++) {
            follow(&f, 0.02 * i, 0.02 * (i + 1));
            go_on(4, A, 0.02, x);
            const hinge_report hinge = motion_of(&f, 1).hinge[HINGE_ELEVATION];
            pitch = fmax(pitch, fabs(hinge.measured - x[0]));
            rate = fmax(rate, fabs(hinge.measured_rate - x[1]));
            integral = fmax(integral, fabs(f.state[ORIENTATING_Z + HINGE_ELEVATION] - x[2]));
            largest = fmax(largest, fabs(hinge.measured));
        }
        printf("  share %g: error up to %.3g mrad\n", share[k], 1e3 * largest);
        CHECK_BELOW("pitch [rad]", pitch, 1e-12);
        CHECK_BELOW("its rate [rad/s]", rate, 1e-11);
        CHECK_BELOW("integral [N m]", integral, 1e-7);
        if (k == 2)
            CHECK_BELOW("error without drag [rad]", largest, 1e-14);
        tear_down(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(feedforward),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
