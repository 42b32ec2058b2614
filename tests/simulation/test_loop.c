// The loop of a hinge, opened: against closed forms of a rigid platform, and against what modes say
// at its margins.
#include <complex.h>
#include <stdlib.h>

#include "launchdyn/loop.h"
#include "model/model.h"
#include "state/simulation.h"
#include "support/check.h"
#include "support/reference_model.h"
#include "systems/bases/vehicle_mechanism.h"

static const double two_pi = 6.283185307179586476925, speed = 8;

static ld_loop *open_loop(const ld_model *model, const char *hinge, ld_loop_margins *margins)
{
    ld_loop *loop;
    ld_error error;
    if (ld_loop_create(model, hinge, &loop, &error))
        fail_msg("%s", error.text);
    ld_loop_margins_of(loop, margins);
    return loop;
}

static double complex number(ld_phasor z)
{
    return z.real + I * z.imaginary;
}

// ---- a rigid platform under a PID controller ----

// So heavy to turn that tube, rocket and suspension do not count, on a chassis that stands still.
static const double J = 1e11, W = 60; // [kg m2], [rad/s]

static void rigid(ld_model *model)
{
    reference_vehicle(model, speed);
    model->tubes.modes.bending = 3;
    model->tubes.modes.torsion = 1;
    ld_platform *platform = &model->platform;
    for (int i = 0; i < 3; i++) {
        platform->chassis_inertia[i] = 1e20;
        platform->elevation.inertia[i] = J;
    }
    platform->azimuth.lock = (ld_hinge_lock){true, 1e16, 1e13};
    platform->elevation.friction = (ld_hinge_friction){0, 1, 1e-3};
    ld_stabiliser *given = &platform->elevation.stabiliser;
    given->kp = J * W * W;
    given->kd = 1.4 * J * W;
    given->ki = 0.2 * J * W * W * W;
    given->torque_limit = 1e12;
}

// |L(i W u)|^2 = 1 for u^2 = x: x^3 = 1.96 x^2 + (1 - 0.56) x + 0.04.
static double crossover_of_rigid(void)
{
    double x = 2;
    for (int i = 0; i < 50; i++)
        x -= (x * x * x - 1.96 * x * x - 0.44 * x - 0.04) / (3 * x * x - 3.92 * x - 0.44);
    return sqrt(x);
}

static double complex open_of_rigid(double u, double late)
{
    double complex s = I * u;
    return cexp(-s * W * late) * (1.4 * s * s + s + 0.2) / (s * s * s);
}

// The phase of L to the next -pi behind u, by halves.
static double axis_of_rigid(double late)
{
    double low = 1, high = 1.5707963267948966 / (W * late) * 2;
    for (int i = 0; i < 60; i++) {
        double u = 0.5 * (low + high);
        // phase of the numerator less three quarters of a turn, less the delay
        double phase = atan2(u, 0.2 - 1.4 * u * u) - 1.5 * 3.141592653589793238 - u * W * late;
        if (phase > -3.141592653589793238)
            low = u;
        else
            high = u;
    }
    return low;
}

static void a_rigid_platform(void **state)
{
    (void)state;
    ld_model model;
    ld_loop_margins margins;
    ld_loop_point at;
    ld_error error;
    double u = crossover_of_rigid(), worst[3] = {0};
    rigid(&model);
    ld_loop *loop = open_loop(&model, "elevation", &margins);
    for (double f = 0.5; f < 200; f *= 1.7) {
        double complex L = open_of_rigid(two_pi * f / W, 0);
        assert_int_equal(ld_loop_points(loop, &f, 1, &at, &error), LD_OK);
        worst[0] = fmax(worst[0], cabs(number(at.open) / L - 1));
        worst[1] = fmax(worst[1], cabs(number(at.tracking) * (1 + L) / L - 1));
        worst[2] = fmax(worst[2], cabs(number(at.sensitivity) * (1 + L) - 1));
    }
    CHECK_BELOW("open loop, relative", worst[0], 1e-6);
    CHECK_BELOW("tracking", worst[1], 1e-6);
    CHECK_BELOW("sensitivity", worst[2], 1e-6);
    CHECK_BELOW("crossover", margins.crossover / (W * u / two_pi) - 1, 1e-6);
    CHECK_BELOW("phase margin [rad]", margins.phase - carg(-open_of_rigid(u, 0)), 1e-6);
    CHECK_BELOW("delay it bears", margins.delay / (margins.phase / (W * u)) - 1, 1e-6);
    CHECK_BELOW("least gain", margins.lower / (0.2 / 1.4) - 1, 1e-6);
    CHECK_BELOW("where", margins.lower_at / (W * sqrt(0.2 / 1.4) / two_pi) - 1, 1e-6);
    assert_true(isinf(margins.raise) && isnan(margins.raise_at));
    ld_loop_free(loop);
    reference_model_free(&model);
}

static void a_rigid_platform_late(void **state)
{
    (void)state;
    const double late = 5e-3;
    ld_model model;
    ld_loop_margins margins;
    ld_loop_point at;
    ld_error error;
    double u = axis_of_rigid(late), f = 12;
    double complex L = open_of_rigid(two_pi * f / W, late), D = cexp(-I * two_pi * f * late);
    rigid(&model);
    model.platform.elevation.stabiliser.sample = 4e-3;
    model.platform.elevation.stabiliser.delay = 3e-3;
    ld_loop *loop = open_loop(&model, "elevation", &margins);
    assert_int_equal(ld_loop_points(loop, &f, 1, &at, &error), LD_OK);
    CHECK_BELOW("open loop", cabs(number(at.open) / L - 1), 1e-6);
    CHECK_BELOW("tracking", cabs(number(at.tracking) / (L / (1 + L)) - 1), 1e-6);
    assert_true(cabs(D - 1) > 0.3);
    CHECK_BELOW("where the gain is too high", margins.raise_at / (W * u / two_pi) - 1, 1e-6);
    CHECK_BELOW("greatest gain", margins.raise * cabs(open_of_rigid(u, late)) - 1, 1e-6);
    u = crossover_of_rigid();
    CHECK_BELOW("phase margin [rad]", margins.phase - carg(-open_of_rigid(u, late)), 1e-6);
    CHECK_BELOW("delay it bears besides", margins.delay - margins.phase / (W * u), 1e-8);
    ld_loop_free(loop);
    // four times as late it is unstable
    model.platform.elevation.stabiliser.sample = 16e-3;
    model.platform.elevation.stabiliser.delay = 12e-3;
    assert_int_equal(ld_loop_create(&model, "elevation", &loop, &error), LD_ERR_INPUT);
    assert_string_equal(error.text, "platform.elevation.stabiliser: unstable: delay and half the "
                                    "period are 20 ms, the loop's delay margin is 12.4 ms");
    reference_model_free(&model);
}

// ---- a chassis that turns about the hinge ----

// It may turn the chassis, too, which is given its motion; its friction drags it along.
static const double DRAG = 0.1, SHARE = 0.3;

static double complex rejection_of_rigid(double u, double late)
{
    double complex s = I * u, D = cexp(-s * W * late);
    return s * (DRAG - D * SHARE * 1.4) / (s * s + DRAG * s + D * (1 + 1.4 * s + 0.2 / s));
}

static double worst_rejection(const ld_model *model, const char *hinge, double late)
{
    ld_loop_margins margins;
    ld_phasor at;
    ld_error error;
    double worst = 0;
    ld_loop *loop = open_loop(model, hinge, &margins);
    for (double f = 0.5; f < 100; f *= 1.7) {
        double complex closed = rejection_of_rigid(two_pi * f / W, late);
        assert_int_equal(ld_loop_rejection(loop, &f, 1, &at, &error), LD_OK);
        worst = fmax(worst, cabs(number(at) / closed - 1));
    }
    ld_loop_free(loop);
    return worst;
}

static void put_drag(ld_model *model, ld_turret *turret)
{
    ld_turret *other =
        turret == &model->platform.azimuth ? &model->platform.elevation : &model->platform.azimuth;
    for (int i = 0; i < 3; i++)
        model->platform.chassis_inertia[i] = J;
    turret->friction = (ld_hinge_friction){DRAG * J * W, 1, 1e-3};
    turret->stabiliser.feedforward = SHARE;
    turret->lock.present = false;
    other->lock = (ld_hinge_lock){true, 1e16, 1e13};
}

static void what_turns_a_rigid_platform(void **state)
{
    (void)state;
    ld_model model;
    rigid(&model);
    ld_turret *azimuth = &model.platform.azimuth, *elevation = &model.platform.elevation;
    ld_stabiliser gains = elevation->stabiliser;
    put_drag(&model, elevation);
    azimuth->stabiliser.command.data[1] = 0.6;
    elevation->stabiliser.sample = 4e-3;
    elevation->stabiliser.delay = 3e-3;
    CHECK_BELOW("elevation, to the side, late", worst_rejection(&model, "elevation", 5e-3), 1e-6);

    // the azimuth platform carries the inertia; a turn of a level chassis is a yaw
    model.base.vehicle.suspension.stiffness[1] *= 5;
    model.base.vehicle.tyre.stiffness[1] *= 5;
    elevation->stabiliser.command.data[1] = 0;
    azimuth->stabiliser.kp = gains.kp;
    azimuth->stabiliser.ki = gains.ki;
    azimuth->stabiliser.kd = gains.kd;
    azimuth->stabiliser.torque_limit = gains.torque_limit;
    for (int i = 0; i < 3; i++) {
        azimuth->inertia[i] = J;
        elevation->inertia[i] = 1e3;
    }
    put_drag(&model, azimuth);
    CHECK_BELOW("azimuth", worst_rejection(&model, "azimuth", 0), 1e-6);
    reference_model_free(&model);
}

// The hinge stays where it is, wherever that is: its accelerations would turn the platform, whose
// mass lies beside it, much more than its friction does.
static void where_the_hinge_is_does_not_matter(void **state)
{
    (void)state;
    ld_model model;
    ld_loop_margins margins;
    ld_phasor at[2];
    ld_error error;
    const double f = 5;
    reference_vehicle(&model, speed);
    model.tubes.modes.bending = 3;
    model.tubes.modes.torsion = 1;
    for (int i = 0; i < 2; i++) {
        ld_loop *loop = open_loop(&model, "elevation", &margins);
        assert_int_equal(ld_loop_rejection(loop, &f, 1, &at[i], &error), LD_OK);
        ld_loop_free(loop);
        model.platform.azimuth.hinge_at[0] += 0.3;
        model.platform.elevation.hinge_at[1] += 0.2;
    }
    CHECK_BELOW("rejection, relative", cabs(number(at[1]) / number(at[0]) - 1), 1e-6);
    reference_model_free(&model);
}

// ---- at the margin ----

static void scale(ld_stabiliser *given, double factor)
{
    given->kp *= factor;
    given->ki *= factor;
    given->kd *= factor;
    given->cascade.rate_kp *= factor;
    given->cascade.rate_ki *= factor;
}

// The least damping ratio of a motion within 1 % of a frequency.
static double damping_near(const ld_model *model, double frequency, double *found)
{
    enum { MOST = 512 };
    static ld_mode modes[MOST];
    static ld_pole poles[MOST];
    int mode_count, pole_count;
    double best = INFINITY;
    ld_error error;
    ld_simulation *simulation;
    assert_int_equal(ld_simulation_create(model, &simulation, &error), LD_OK);
    assert_int_equal(ld_simulation_system_modes(simulation, modes, MOST, &mode_count, poles, MOST,
                                                &pole_count, &error),
                     LD_OK);
    for (int i = 0; i < pole_count; i++) {
        double modulus = hypot(poles[i].real, poles[i].imaginary);
        if (fabs(modulus / (two_pi * frequency) - 1) < 0.01 &&
            fabs(poles[i].real) / modulus < fabs(best)) {
            best = -poles[i].real / modulus;
            *found = modulus / two_pi;
        }
    }
    ld_simulation_free(simulation);
    return best;
}

static void check_limit(const ld_model *model, ld_stabiliser *given, double factor, double at)
{
    double frequency = NAN;
    ld_stabiliser kept = *given;
    printf("  gains times %.6g, at %.6g Hz\n", factor, at);
    scale(given, factor);
    CHECK_BELOW("damping ratio", damping_near(model, at, &frequency), 1e-6);
    CHECK_BELOW("frequency, relative", frequency / at - 1, 1e-6);
    *given = kept;
    // on its two sides
    scale(given, pow(factor, 0.999));
    assert_true(damping_near(model, at, &frequency) > 0);
    *given = kept;
    scale(given, pow(factor, 1.001));
    assert_true(damping_near(model, at, &frequency) < 0);
    *given = kept;
}

static void at_its_margins_modes_do_not_decay(void **state)
{
    (void)state;
    ld_model model;
    ld_loop_margins margins;
    reference_vehicle(&model, speed);
    model.tubes.modes.bending = 3;
    model.tubes.modes.torsion = 1;
    // the options that are linear
    ld_stabiliser *azimuth = &model.platform.azimuth.stabiliser;
    ld_stabiliser *elevation = &model.platform.elevation.stabiliser;
    elevation->cascade = (ld_cascade){true, 15, 4e5, 4e5};
    elevation->bandwidth = 30;
    elevation->feedforward = 0.3;
    azimuth->gear = (ld_gear){true, 5e7, 2e4, 100, 0};
    azimuth->feedforward = 0.3;
    ld_loop_free(open_loop(&model, "elevation", &margins));
    check_limit(&model, elevation, margins.lower, margins.lower_at);
    ld_loop_free(open_loop(&model, "azimuth", &margins));
    check_limit(&model, azimuth, margins.raise, margins.raise_at);
    // a slow limit without a cascade, where all three gains weigh
    elevation->cascade.present = false;
    elevation->ki = 0.3 * elevation->kp;
    ld_loop_free(open_loop(&model, "elevation", &margins));
    check_limit(&model, elevation, margins.lower, margins.lower_at);
    reference_model_free(&model);
}

static void expect(const ld_model *model, const char *hinge, const char *text)
{
    ld_loop *loop;
    ld_error error;
    assert_int_equal(ld_loop_create(model, hinge, &loop, &error), LD_ERR_INPUT);
    assert_null(loop);
    assert_non_null(strstr(error.text, text));
}

// ---- a drive of a multibody base ----

// The vehicle and the bodies, joints and drives that it is expanded into.
static void a_drive_is_the_stabiliser(void **state)
{
    (void)state;
    static const char *const hinges[] = {"azimuth", "elevation"};
    ld_model model, bodies;
    ld_error error;
    reference_vehicle(&model, 0);
    model.platform.azimuth.stabiliser.feedforward = 0.3;
    model.platform.elevation.stabiliser.feedforward = 0.3;
    bodies = model;
    bodies.base.kind = LD_BASE_MULTIBODY;
    bodies.base.azimuth = bodies.base.elevation = 0;
    vehicle_describe(&model, &bodies.base.mechanism);
    snprintf(bodies.tubes.on, sizeof bodies.tubes.on, "elevation platform");
    double worst = 0;
    for (int i = 0; i < 2; i++) {
        ld_loop_margins margins[2];
        ld_loop *loop[2] = {open_loop(&model, hinges[i], &margins[0]),
                            open_loop(&bodies, hinges[i], &margins[1])};
        for (double f = 0.3; f < 100; f *= 1.9) {
            ld_loop_point at[2];
            for (int k = 0; k < 2; k++)
                assert_int_equal(ld_loop_points(loop[k], &f, 1, &at[k], &error), LD_OK);
            double complex L = number(at[0].open);
            worst = fmax(worst, cabs(number(at[1].open) - L) / cabs(L));
        }
        CHECK_BELOW("phase margin [rad]", margins[1].phase - margins[0].phase, 1e-5);
        double f = 1;
        ld_phasor rejection;
        assert_int_equal(ld_loop_rejection(loop[1], &f, 1, &rejection, &error), LD_ERR_INPUT);
        for (int k = 0; k < 2; k++)
            ld_loop_free(loop[k]);
    }
    CHECK_BELOW("open loop of a drive against the vehicle's, relative", worst, 1e-5);
    expect(&bodies, "elevaton", "unknown drive \"elevaton\", did you mean \"elevation\"?");
    reference_model_free(&model);
}

// ---- what is wrong ----

static void what_has_no_loop_is_told(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    expect(&model, "elevation", "there is no loop: the base is neither a vehicle nor multibody");
    reference_model_free(&model);
    reference_vehicle(&model, speed);
    expect(&model, "elevaton", "unknown hinge \"elevaton\", did you mean \"elevation\"?");
    expect(&model, "x", "unknown hinge \"x\"; expected azimuth or elevation");
    model.platform.azimuth.lock = (ld_hinge_lock){true, 1e8, 1e5};
    expect(&model, "azimuth", "platform.azimuth.lock: there is no loop: the hinge is locked");
    model.platform.elevation.stabiliser.kd = -1e5;
    expect(&model, "elevation", "platform.elevation.stabiliser: unstable");
    ld_loop_free(NULL);
    reference_model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_rigid_platform),
        cmocka_unit_test(a_rigid_platform_late),
        cmocka_unit_test(what_turns_a_rigid_platform),
        cmocka_unit_test(where_the_hinge_is_does_not_matter),
        cmocka_unit_test(at_its_margins_modes_do_not_decay),
        cmocka_unit_test(a_drive_is_the_stabiliser),
        cmocka_unit_test(what_has_no_loop_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
