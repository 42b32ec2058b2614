// Launches on a vehicle that cannot begin, that end early, and that look odd but happen.
#include "support/expected_launch.h"

static const double degree = 3.14159265358979323846 / 180;

#define DOES_NOT_START(name, status, sentence, ...)                                                \
    static void name(void **state)                                                                 \
    {                                                                                              \
        (void)state;                                                                               \
        ld_model model;                                                                            \
        reference_vehicle(&model, 30 / 3.6);                                                       \
        ld_vehicle *vehicle = &model.base.vehicle;                                                 \
        (void)vehicle;                                                                             \
        __VA_ARGS__;                                                                               \
        check_no_start(&model, status, sentence);                                                  \
    }

DOES_NOT_START(wheel_in_the_air, LD_ERR_INPUT,
               "base.wheels.3: wheel \"middle-left\" does not reach the ground at the start: "
               "in equilibrium it hangs # m above the road",
               vehicle->wheel[2].mount[1] += 0.3)

DOES_NOT_START(weak_stabiliser, LD_ERR_INPUT,
               "platform.elevation.stabiliser.torque_limit: holding the platform at the "
               "start takes # N m, more than the limit of 10000 N m",
               model.platform.elevation.stabiliser.torque_limit = 1e4)

DOES_NOT_START(
    mass_centre_before_the_wheels, LD_ERR_NUMERIC,
    "base.wheels: the vehicle has no static equilibrium on its wheels (smallest residual # m/s2): "
    "check that all wheels reach the road and the mass centre is between them",
    for (int i = 0; i < 6; i++) vehicle->wheel[i].mount[0] += 4)

DOES_NOT_START(
    one_axle_below_the_mass_centre, LD_ERR_INPUT,
    "base.wheels: nothing holds the chassis in pitch: the wheels are on one line, seen from above, "
    "and about its equilibrium it tips over, growing by # 1/s: give wheels beside it",
    vehicle->speed = 0, vehicle->wheel_count = 2,
    vehicle->wheel[0].mount[0] = vehicle->wheel[1].mount[0] = -0.3)

DOES_NOT_START(
    one_track_below_the_mass_centre, LD_ERR_INPUT,
    "base.wheels: nothing holds the chassis in roll: the wheels are on one line, seen from above, "
    "and about its equilibrium it tips over, growing by # 1/s: give wheels beside it",
    vehicle->speed = 0;
    for (int i = 0; i < 6; i++) vehicle->wheel[i].mount[2] = 0)

DOES_NOT_START(
    one_axle_behind_the_mass_centre, LD_ERR_INPUT,
    "base.wheels: nothing holds the chassis in pitch: the wheels are on one line, seen from above, "
    "and no equilibrium was found (smallest residual # m/s2): give wheels beside it",
    vehicle->wheel_count = 2)

DOES_NOT_START(weightless, LD_ERR_INPUT,
               "base.wheels.1: wheel \"front-left\" does not reach the ground at the start: "
               "in equilibrium it hangs # m above the road",
               model.gravity = 0)

// The lock releases when the wheels hit a wall, and the rocket, thrown back by the breech, leaves.
static void drives_against_a_wall(void **state)
{
    (void)state;
    ld_model model;
    outcome out;
    listener ear = {0};
    reference_vehicle(&model, 30 / 3.6);
    model.base.vehicle.road.form = LD_ROAD_SUM;
    model.base.vehicle.road.bump_count = 1;
    model.base.vehicle.road.bump[0] = (ld_bump){-5, 1, 3, LD_TRACK_BOTH};
    model.run.lead_in = 2;
    run(&model, &ear, &out);
    printf("    %s\n", out.error.text);
    assert_int_equal(out.status, LD_ERR_LAUNCH);
    assert_true(matches(out.error.text, "the rocket slid out of the tube's tip at t = # s, # s "
                                        "before its ignition"));
    assert_true(ear.last == out.summary.t_end);
    CHECK_BELOW("energy balance, relative", out.summary.energy.residual_relative, 1e-6);
}

// A damper so hard that the vehicle, integrated apart, would continue by femtoseconds between two
// exchanges.
static void damper_like_rock(void **state)
{
    (void)state;
    ld_model model;
    outcome out;
    listener ear = {0};
    reference_vehicle(&model, 30 / 3.6);
    model.base.vehicle.suspension.damping[2] = 2.5e14;
    model.run.coupling_step = 5e-4;
    run(&model, &ear, &out);
    printf("    %s\n", out.error.text);
    assert_int_equal(out.status, LD_ERR_NUMERIC);
    assert_true(matches(out.error.text,
                        "the steps became too short to continue: more than 20000 steps "
                        "between two exchanges of the subsystems, up to t = # s; check for "
                        "a damper or friction of the vehicle that is far too stiff"));
}

// Not failures: launches that look odd but happen.
#define HAPPENS(name, speed, ...)                                                                  \
    static void name(void **state)                                                                 \
    {                                                                                              \
        (void)state;                                                                               \
        ld_model model;                                                                            \
        reference_vehicle(&model, speed);                                                          \
        ld_road *road = &model.base.vehicle.road;                                                  \
        road->form = LD_ROAD_SUM;                                                                  \
        model.run.lead_in = 1;                                                                     \
        __VA_ARGS__;                                                                               \
        check_happens(#name, &model);                                                              \
    }

HAPPENS(wheels_leave_the_road, 30 / 3.6, road->bump_count = 1;
        road->bump[0] = (ld_bump){-13, 4, -0.5, LD_TRACK_BOTH}; model.run.lead_in = 2)
HAPPENS(on_ice, 30 / 3.6, model.base.vehicle.tyre.friction = 0)
HAPPENS(parked_on_ice, 0, model.base.vehicle.tyre.friction = 1e-3; road->iso_class = 2)
HAPPENS(fires_backwards, 30 / 3.6, model.platform.azimuth.stabiliser.command.data[1] = 179 * degree)
HAPPENS(both_hinges_locked, 30 / 3.6, model.platform.azimuth.lock = (ld_hinge_lock){true, 1e8, 1e5};
        model.platform.elevation.lock = (ld_hinge_lock){true, 1e8, 1e5})

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wheel_in_the_air),
        cmocka_unit_test(weak_stabiliser),
        cmocka_unit_test(mass_centre_before_the_wheels),
        cmocka_unit_test(one_axle_below_the_mass_centre),
        cmocka_unit_test(one_track_below_the_mass_centre),
        cmocka_unit_test(one_axle_behind_the_mass_centre),
        cmocka_unit_test(weightless),
        cmocka_unit_test(drives_against_a_wall),
        cmocka_unit_test(damper_like_rock),
        cmocka_unit_test(wheels_leave_the_road),
        cmocka_unit_test(on_ice),
        cmocka_unit_test(parked_on_ice),
        cmocka_unit_test(fires_backwards),
        cmocka_unit_test(both_hinges_locked),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
