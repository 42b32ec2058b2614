// The air on a rocket that comes out of its tube: what it leaves on the base by hand, the energy
// balance of a launch in gusts, and the same air before and after the exit.
#include "simulation/propagator.h"
#include "support/check.h"
#include "support/fresh_launch.h"
#include "support/recorded_run.h"
#include "support/reference_model.h"

static const double degree = 3.14159265358979323846 / 180;

// A wind across the tube, in air of one density.
static void let_the_wind_blow(ld_model *model, double speed, double heading)
{
    ld_aerodynamics *given = &model->rocket.aerodynamics;
    ld_environment *environment = &model->environment;
    given->present = given->emerged.present = true;
    given->model = LD_AERODYNAMICS_BODY;
    given->emerged.nose = 2.45;
    given->emerged.drag = 1.2;
    given->emerged.diameter = 0.122;
    environment->atmosphere.kind = LD_ATMOSPHERE_UNIFORM;
    environment->atmosphere.density = 1.2;
    environment->atmosphere.speed_of_sound = 340;
    environment->wind.present = true;
    environment->wind.speed = speed;
    environment->wind.heading = heading;
}

// Without weight, the adaptors held on the axis: all that the base carries is the wind's.
static void rest_in_a_steady_wind(void **state)
{
    (void)state;
    const double speed = 20, heading = 70 * degree, s = 1.4;
    ld_model model;
    reference_model(&model);
    let_the_wind_blow(&model, speed, heading);
    model.gravity = 0;
    model.rocket.contact.law = LD_CONTACT_BILATERAL;
    model.rocket.start_at = s;
    model.tubes.modes.bending = 3;
    model.tubes.modes.torsion = 1;
    fresh_launch launch;
    ld_equilibrium_summary summary;
    double y[LD_MAX_STATES];
    ld_error error;
    fresh_launch_make(&launch, &model);
    if (simulation_equilibrium(&launch.state, 0, y, &summary, &error))
        fail_msg("%s", error.text);
    const launcher_output *found = simulation_output(&launch.state, 0, y);
    assert_non_null(found);
    launcher_input input;
    simulation_input(&launch.state, 0, y, &input);
    const launching_system *launching = &launch.state.launcher.launching;
    const launching_layout *at = &launching->layout;
    launching_output unused;
    launching_pose pose;
    launching_rocket_pose(launching, y, &pose, &unused);
    m3 A_IR = q_matrix(q_from(y + at->quaternion));
    v3 d = m3_apply(A_IR, m3_column(pose.A_RB, 0));
    v3 wind_I = v3_make(speed * cos(heading), 0, speed * sin(heading));
    v3 across = v3_axpy(wind_I, -v3_dot(wind_I, d), d);
    double tip = model.tubes.length - s, nose = model.rocket.aerodynamics.emerged.nose;
    v3 force = v3_scale(0.5 * 1.2 * 1.2 * 0.122 * (nose - tip) * v3_norm(across), across);
    v3 O1 = v3_add(v3_from(y + at->r), m3_apply(A_IR, pose.p1));
    v3 arm = v3_sub(v3_axpy(O1, 0.5 * (tip + nose), d), input.launching.base.r);
    v3 moment = v3_cross(arm, force);
    v3 found_force = m3_apply(input.launching.base.A, found->launching.base_force);
    v3 found_moment = m3_apply(input.launching.base.A, found->launching.base_moment);
    printf("    force %.6f N, moment %.6f N m\n", v3_norm(force), v3_norm(moment));
    CHECK_BELOW("force on the base", v3_norm(v3_sub(found_force, force)) / v3_norm(force), 1e-9);
    CHECK_BELOW("moment on it, about the tube's rear end",
                v3_norm(v3_sub(found_moment, moment)) / v3_norm(moment), 1e-9);
    fresh_launch_free(&launch);
    reference_model_free(&model);
}

// A gust rises, holds and falls while the rocket comes out.
static void energy_in_gusts(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    let_the_wind_blow(&model, 30, 60 * degree);
    model.tubes.modes.bending = 3;
    model.tubes.modes.torsion = 1;
    model.run.tolerance = 1e-9;
    model.environment.wind.gust_count = 1;
    model.environment.wind.gust[0] = (ld_gust){0.09, 0.02, 0.01, 0.02, 25, 100 * degree};
    ld_summary windy = summary_of_run(&model);
    model.rocket.aerodynamics.emerged.present = false;
    ld_summary calm = summary_of_run(&model);
    const ld_rocket_summary *in_wind = &windy.rocket[0], *in_calm = &calm.rocket[0];
    printf("    out at %.4f s; work of the air %.4g J\n", in_wind->t_rear,
           windy.energy.work[POWER_CROSSFLOW]);
    printf("    yaw rate %.6g and %.6g rad/s without\n", in_wind->yaw_rate, in_calm->yaw_rate);
    CHECK_BELOW("energy balance, relative", windy.energy.residual_relative, 1e-9);
    CHECK_WITHIN("what the air does to the yaw rate [rad/s]",
                 fabs(in_wind->yaw_rate - in_calm->yaw_rate), 1e-3, 1);
    reference_model_free(&model);
}

// The air of flight i at its start, r the mass centre in I, is that which it has in the tube with
// no way left to go.
static void compare_air(const ld_model *model, double *worst)
{
    const double t = 0.13;
    flight_system flight;
    ld_error error;
    if (flight_build(&flight, model, 2, &error))
        fail_msg("%s", error.text);
    flight_phase phase = {.t_ignition = 0};
    flight_set_piece(&flight, &phase, 1);
    flight_pose pose = {.r_O1 = {1.3, 4.2, -0.7}, .v_O1 = {30, 12, 1}, .q_IB = {1, 0, 0, 0}};
    double y[FLIGHT_STATES];
    flight_enter(&flight, &phase, t, &pose, y);
    flight_flow after = flight_flow_at(&flight, t, y);
    moving_air before = flight_air_at(&flight, t, flight_center(&flight, t, y).r, 0);
    assert_true(v3_norm(after.wind) > 5);
    *worst = fmax(*worst, v3_norm(v3_sub(after.wind, before.v)) / v3_norm(after.wind));
    *worst = fmax(*worst, fabs(before.density / after.density - 1));
    flight_free(&flight);
}

static void the_same_air_before_and_after_the_exit(void **state)
{
    (void)state;
    ld_model model;
    double worst = 0;
    reference_model(&model);
    let_the_wind_blow(&model, 8, 0.4);
    ld_wind *given = &model.environment.wind;
    given->gust_count = 1;
    given->gust[0] = (ld_gust){0.1, 0.05, 1, 0.05, 3, 2};
    given->turbulence = (ld_turbulence){true, LD_TURBULENCE_DRYDEN, 12, 7, 100};
    model.environment.atmosphere.kind = LD_ATMOSPHERE_US1976;
    model.environment.atmosphere.density_scale = 1.01;
    compare_air(&model, &worst);
    model.environment.earth.kind = LD_EARTH_WGS84;
    model.environment.site = (ld_site){true, 50 * degree, 8 * degree, 600, 130 * degree};
    model.environment.ground_height = 600;
    compare_air(&model, &worst);
    given->axes = LD_WIND_GEOGRAPHIC;
    compare_air(&model, &worst);
    CHECK_BELOW("wind and density at the exit, relative", worst, 1e-9);
    reference_model_free(&model);
}

// Two metres before the mouth the turbulence is that of two metres less of way.
static void turbulence_on_the_way_to_the_mouth(void **state)
{
    (void)state;
    const double left = 2, height = 3.5;
    ld_model model;
    ld_error error;
    flight_system flight;
    reference_model(&model);
    let_the_wind_blow(&model, 0, 0);
    model.environment.wind.turbulence = (ld_turbulence){true, LD_TURBULENCE_DRYDEN, 12, 7, 100};
    if (flight_build(&flight, &model, 0, &error))
        fail_msg("%s", error.text);
    turbulence_scales scales = turbulence_scales_at(&flight.turbulence, height);
    v3 by_hand =
        turbulence_velocity(&flight.turbulence, &scales, -left / scales.L_u, -left / scales.L_w);
    moving_air found = flight_air_at(&flight, 0, v3_make(0, height, 0), left);
    moving_air at_mouth = flight_air_at(&flight, 0, v3_make(0, height, 0), 0);
    CHECK_BELOW("velocity of the air [m/s]", v3_norm(v3_sub(found.v, by_hand)), 0);
    CHECK_WITHIN("it changes on that way [m/s]", v3_norm(v3_sub(found.v, at_mouth.v)), 0.1, 5);
    flight_free(&flight);
    reference_model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rest_in_a_steady_wind),
        cmocka_unit_test(energy_in_gusts),
        cmocka_unit_test(the_same_air_before_and_after_the_exit),
        cmocka_unit_test(turbulence_on_the_way_to_the_mouth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
