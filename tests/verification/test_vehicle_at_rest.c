// The vehicle on its wheels: its tyres carry the weight, and released on a flat road it stays where
// it is.
// ctest: slow
#include "model/model.h"
#include "support/check.h"

#include "support/recorded_run.h"
#include "support/reference_model.h"

static const double pi = 3.14159265358979323846;

// [kg] reference launcher: chassis, platforms, 18 steel tubes of 3 m with tail and rocket, wheels.
static double whole_mass(const ld_model *model)
{
    double tube = 7850 * pi * (0.085 * 0.085 - 0.0825 * 0.0825) * 3 + 8 + 60;
    int empty = model->tubes.empty_count;
    return 11000 + 700 + 900 + 18 * tube - 60 * empty + 6 * 220;
}

static double tyre_forces(const ld_summary *summary)
{
    double sum = 0;
    for (int j = 0; j < summary->equilibrium.wheel_count; j++)
        sum += summary->equilibrium.wheel[j].tyre_force;
    return sum;
}

static void vehicle(ld_model *model, double speed)
{
    reference_vehicle(model, speed);
    model->run.end = LD_END_TIME;
    model->run.end_time = 0;
}

// Road heights as they are: level, and wheels at different heights.
static void tyres_carry_the_weight(void **state)
{
    (void)state;
    ld_model model;
    vehicle(&model, 0);
    ld_summary summary = summary_of_run(&model);
    double weight = whole_mass(&model) * model.gravity;
    CHECK_BELOW("flat road: tyre forces over the weight - 1", tyre_forces(&summary) / weight - 1,
                1e-12);
    CHECK_BELOW("rates left [m/s2, rad/s2]", summary.equilibrium.residual, 5e-8);
    model.base.vehicle.road.form = LD_ROAD_SUM;
    model.base.vehicle.road.iso_class = 2;
    model.tubes.empty_count = 5;
    memcpy(model.tubes.empty, (int[]){1, 2, 7, 13, 14}, 5 * sizeof(int));
    summary = summary_of_run(&model);
    weight = whole_mass(&model) * model.gravity;
    CHECK_BELOW("class C, loaded to one side: the same", tyre_forces(&summary) / weight - 1, 1e-12);
    reference_model_free(&model);
}

// Almost upright, the platform stands at its command; a parked vehicle does without a drive.
static void almost_upright(void **state)
{
    (void)state;
    ld_model model;
    vehicle(&model, 0);
    model.platform.elevation.stabiliser.command.data[1] = 88 * pi / 180;
    model.run.end = LD_END_TIP;
    ld_summary with = summary_of_run(&model);
    CHECK_BELOW("elevation and the chassis' pitch against 88 deg [rad]",
                with.equilibrium.hinge[1].angle + with.equilibrium.chassis.pitch - 88 * pi / 180,
                1e-14);
    CHECK_BELOW("energy residual, of the largest work", with.energy.residual_relative, 1e-9);
    model.base.vehicle.drive = (ld_drive){0, 0};
    ld_summary without = summary_of_run(&model);
    CHECK_BELOW("rates without a drive: differences [rad/s]",
                fabs(without.rocket[0].tip_off.pitch_rate - with.rocket[0].tip_off.pitch_rate) +
                    fabs(without.rocket[0].tip_off.yaw_rate - with.rocket[0].tip_off.yaw_rate),
                1e-15);
    reference_model_free(&model);
}

// ---- released ----

enum { SPEEDS = 13, RATES = 12 };
static const char *const speeds[SPEEDS] = {
    "chassis.vx", "chassis.vy", "chassis.vz",   "tube.vx",   "tube.vy",   "tube.vz",      "tip.vy",
    "tip.vz",     "rocket.vx",  "rocket.s_dot", "rocket.vy", "rocket.vz", "rocket.y_dot",
};
static const char *const rates[RATES] = {
    "chassis.wx",     "chassis.wy",  "chassis.wz",        "azimuth.rate",
    "elevation.rate", "tube.wx",     "tube.wy",           "tube.wz",
    "rocket.w_x",     "rocket.spin", "rocket.pitch_rate", "rocket.yaw_rate",
};

static double greatest(const recorded_run *run, const char *name)
{
    double most = 0;
    size_t column = recorded_column(run, name);
    for (size_t i = 0; i < run->rows; i++)
        most = fmax(most, fabs(recorded_value(run, i, column)));
    return most;
}

static double greatest_of(const recorded_run *run, int count, const char *const *names)
{
    double most = 0;
    for (int i = 0; i < count; i++)
        most = fmax(most, greatest(run, names[i]));
    return most;
}

// By differences of neighbouring rows, 5 ms apart.
static double greatest_rate(const recorded_run *run, const char *name)
{
    double most = 0;
    size_t column = recorded_column(run, name), t = recorded_column(run, "t");
    for (size_t i = 1; i < run->rows; i++)
        most =
            fmax(most, fabs(recorded_value(run, i, column) - recorded_value(run, i - 1, column)) /
                           (recorded_value(run, i, t) - recorded_value(run, i - 1, t)));
    return most;
}

static void nothing_moves(void **state)
{
    (void)state;
    ld_model model;
    recorded_run run;
    vehicle(&model, 0);
    model.run.lead_in = 10;
    model.run.tolerance = 1e-10;
    recorded_run_make(&run, &model);
    printf("  %d rows, %d steps, %.2f s of CPU\n", (int)run.rows, (int)run.summary.statistics.steps,
           run.summary.statistics.cpu_seconds);
    CHECK_WITHIN("end [s]", run.summary.t_end, 0, 0);
    CHECK_BELOW("10 s parked: speeds of chassis, tube, tip, rocket [m/s]",
                greatest_of(&run, SPEEDS, speeds), 5e-10);
    CHECK_BELOW("their rates, hinges [rad/s]", greatest_of(&run, RATES, rates), 5e-9);
    double most = 0;
    for (int j = 0; j < model.base.vehicle.wheel_count; j++)
        for (int k = 0; k < 3; k++) {
            char name[LD_MAX_NAME + 16];
            snprintf(name, sizeof name, "wheel.%s.%c", model.base.vehicle.wheel[j].name, 'x' + k);
            most = fmax(most, greatest_rate(&run, name));
        }
    CHECK_BELOW("speeds of the wheels [m/s]", most, 1e-11);
    recorded_run_free(&run);
    reference_model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tyres_carry_the_weight),
        cmocka_unit_test(almost_upright),
        cmocka_unit_test(nothing_moves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
