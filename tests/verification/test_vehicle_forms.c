// Vehicles of fewer parts: without an azimuth platform, against one whose azimuth platform is
// locked to its chassis; on one axle and on one wheel, which hang below them, against a body that
// rolls. ctest: slow
#include <stdlib.h>

#include "model/model.h"
#include "state/simulation.h"
#include "support/check.h"
#include "support/recorded_run.h"
#include "support/reference_model.h"

// ---- without an azimuth platform

// The azimuth frame's mass centre in that of the chassis: both together are one body.
static void with_locked_azimuth(ld_model *model, double stiffness)
{
    reference_vehicle(model, 30 / 3.6);
    ld_turret *azimuth = &model->platform.azimuth;
    for (int k = 0; k < 3; k++)
        azimuth->center[k] = -azimuth->hinge_at[k];
    azimuth->lock = (ld_hinge_lock){true, stiffness, 1e-3 * stiffness};
    model->run.lead_in = 0.5;
    model->run.tolerance = 1e-9;
}

static void without_azimuth(ld_model *model)
{
    with_locked_azimuth(model, 1);
    ld_platform *platform = &model->platform;
    platform->has_azimuth = false;
    platform->chassis_mass += platform->azimuth.mass;
    for (int k = 0; k < 3; k++) {
        platform->chassis_inertia[k] += platform->azimuth.inertia[k];
        platform->elevation.hinge_at[k] += platform->azimuth.hinge_at[k];
    }
}

typedef struct exit_numbers {
    double angle[3], rate[3], speed[3], torque; // pitch, yaw, roll; along, up, right
} exit_numbers;

static exit_numbers exit_of(const ld_model *model, int elevation)
{
    ld_summary summary = summary_of_run(model);
    const ld_rocket_summary *rocket = &summary.rocket[0];
    return (exit_numbers){.angle = {rocket->pitch, rocket->yaw},
                          .rate = {rocket->pitch_rate, rocket->yaw_rate, rocket->spin_rate},
                          .speed = {rocket->exit_speed, rocket->inertial_speed},
                          .torque = rocket->hinge[elevation].torque_peak};
}

static void fused_bodies(void **state)
{
    (void)state;
    ld_model one, two;
    without_azimuth(&one);
    exit_numbers a = exit_of(&one, 0);
    double worst[2] = {0};
    for (int k = 0; k < 2; k++) {
        with_locked_azimuth(&two, k ? 1e12 : 1e10);
        exit_numbers b = exit_of(&two, 1);
        double off[4] = {0};
        for (int i = 0; i < 3; i++) {
            off[0] = fmax(off[0], fabs(a.angle[i] - b.angle[i]));
            off[1] = fmax(off[1], fabs(a.rate[i] - b.rate[i]));
            off[2] = fmax(off[2], fabs(a.speed[i] - b.speed[i]));
        }
        off[3] = fabs(a.torque - b.torque) / a.torque;
        printf("    lock %g N m/rad: angles %.1e rad, rates %.1e rad/s, speeds %.1e m/s, torque "
               "%.1e\n",
               two.platform.azimuth.lock.stiffness, off[0], off[1], off[2], off[3]);
        worst[k] = fmax(fmax(off[0], off[1]), fmax(off[2], off[3]));
        reference_model_free(&two);
    }
    CHECK_BELOW("against a locked azimuth platform", worst[1], 2e-6);
    reference_model_free(&one);
}

// ---- on one axle

enum { MOST = 2 * LD_MAX_STATES };

static const double M = 1e8, J = 4e8, H = 4; // [kg], [kg m2], [m] of the axle above the mass centre

// At rest the wheels do not turn against the chassis: the whole rolls as a body on a round foot,
// the mass centre H below its centre.
static double swing_of(const ld_model *model)
{
    double arm = H - model->base.vehicle.tyre.radius;
    return sqrt(M * model->gravity * H / (J + M * arm * arm));
}

// So heavy that platforms and tubes do not count, on stiff wheels above its mass centre.
static void hanging(ld_model *model, int wheels)
{
    reference_vehicle(model, 0);
    ld_vehicle *vehicle = &model->base.vehicle;
    model->platform.chassis_mass = M;
    model->platform.chassis_inertia[0] = model->platform.chassis_inertia[1] =
        model->platform.chassis_inertia[2] = J;
    vehicle->wheel_count = wheels;
    for (int k = 0; k < 3; k++) {
        vehicle->suspension.stiffness[k] = vehicle->tyre.stiffness[k] = 1e12;
        vehicle->suspension.damping[k] = vehicle->tyre.damping[k] = 0;
    }
    for (int i = 0; i < wheels; i++) {
        ld_wheel *wheel = &vehicle->wheel[i];
        wheel->mount[0] = 0;
        wheel->mount[1] = H;
        wheel->mount[2] = wheels == 1 ? 0 : i ? 1 : -1;
    }
}

// Lowest frequency of a natural mode in which that group moves [rad/s].
static double lowest(const ld_model *model, const char *group)
{
    ld_simulation *simulation;
    ld_error error;
    ld_mode *mode = malloc(MOST * sizeof *mode);
    ld_pole *pole = malloc(MOST * sizeof *pole);
    int modes, poles = 0;
    double least = INFINITY;
    if (ld_simulation_create(model, &simulation, &error) ||
        ld_simulation_system_modes(simulation, mode, MOST, &modes, pole, MOST, &poles, &error))
        fail_msg("%s", error.text);
    for (int i = 0; i < poles; i++)
        if (pole[i].imaginary > 0 && strstr(pole[i].shape, group))
            least = fmin(least, hypot(pole[i].real, pole[i].imaginary));
    ld_simulation_free(simulation);
    free(mode);
    free(pole);
    return least;
}

static void hangs_on_an_axle(void **state)
{
    (void)state;
    ld_model model;
    hanging(&model, 2);
    double swing = swing_of(&model);
    CHECK_BELOW("pitch on two wheels, relative", lowest(&model, "chassis, pitch") / swing - 1,
                1e-3);
    reference_model_free(&model);
}

static void hangs_on_a_wheel(void **state)
{
    (void)state;
    ld_model model;
    hanging(&model, 1);
    double swing = swing_of(&model);
    CHECK_BELOW("pitch on one wheel, relative", lowest(&model, "chassis, pitch") / swing - 1, 1e-3);
    CHECK_BELOW("roll on one wheel, relative", lowest(&model, "chassis, roll") / swing - 1, 1e-3);
    reference_model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(fused_bodies),
                                       cmocka_unit_test(hangs_on_an_axle),
                                       cmocka_unit_test(hangs_on_a_wheel)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
