// The air on a rocket that comes out of its tube: what it leaves on the base by hand, the energy
// balance of a launch in gusts, and the same air before and after the exit. The air on a rocket on
// a rail: what its shoes carry, the flight's own accelerations, damping, energy balance.
#include <stdlib.h>

#include "model/model.h"
#include "scenario/scenario.h"
#include "state/equilibrium.h"
#include "state/evaluation.h"
#include "state/linearise.h"
#include "state/stepping/propagator.h"
#include "support/check.h"
#include "support/dense_flight.h"
#include "support/draw.h"
#include "support/fresh_launch.h"
#include "support/recorded_run.h"
#include "support/reference_model.h"
#include "systems/launching/launching_kinematics.h"

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
           windy.energy.work[POWER_AIR]);
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

// ---- on a rail ----

#define RAIL                                                                                       \
    "run.lead_in=20 ms", "rocket.aerodynamics.crossflow={drag: 20, at: 1.3 m}",                    \
        "rocket.aerodynamics.fin_cant=1 deg", "rocket.eccentricity=0 0 m",                         \
        "environment.atmosphere={density: 1.2 kg/m3, speed_of_sound: 340 m/s}"
// Of a rail that does not give, without weight and without play.
#define RIGID                                                                                      \
    "tubes.guide={line: 0 0 mm, t_slot: {at: 0 0 mm, lips: 40 mm, gap: 0 mm, side_gap: 0 mm}}",    \
        "environment.gravity=0 m/s2", "rocket.contact.stiffness=1e10 N/m",                         \
        "tubes.sections=[{from: 0 m, mass_per_length: 9 kg/m, axial_stiffness: 1e12 N, "           \
        "bending_stiffness_y: 1e11 N.m2, bending_stiffness_z: 1e11 N.m2, "                         \
        "torsion_stiffness: 1e11 N.m2, polar_inertia: 0.05 kg.m}]",                                \
        "tubes.supports=[{at: 0.2 m, clamped: all}]"

static void read_pad(const char *const *set, size_t count, ld_model *model)
{
    ld_messages messages;
    if (scenario_read(LD_SOURCE_DIR "/examples/rail/pad.yaml", set, count, model, &messages)) {
        ld_messages_print(&messages, stdout);
        fail();
    }
}

static double apart(v3 found, v3 expected)
{
    return v3_norm(v3_sub(found, expected)) / v3_norm(expected);
}

static v3 sum_of_shoes(const launching_output *out, v3 *moment)
{
    v3 sum = v3_zero();
    *moment = v3_zero();
    for (int i = 0; i < 2; i++) {
        v3 f = v3_make(0, out->shoe[i].force_y, out->shoe[i].force_z);
        sum = v3_add(sum, f);
        *moment = v3_add(*moment, v3_make(out->shoe[i].moment_x, 0, 0));
        *moment = v3_add(*moment, v3_cross(v3_make(1.6 * i, 0, 0), f));
    }
    return sum;
}

static v3 told(const recorded_run *run, const char *const name[3])
{
    double of[3];
    for (int i = 0; i < 3; i++)
        of[i] = recorded_value(run, 0, recorded_column(run, name[i]));
    return v3_from(of);
}

// At rest the shoes and the lock carry what the air of the flight's other program does.
static void shoes_carry_the_wind(void **state)
{
    (void)state;
    static const char *const set[] = {RAIL, RIGID, "base.elevation=60 deg", "run.end=1 ms",
                                      "environment.wind={speed: 20 m/s, heading: 70 deg}"};
    static const char *const force_name[] = {"air.x", "air.y", "air.z"};
    static const char *const moment_name[] = {"air.moment_x", "air.moment_y", "air.moment_z"};
    ld_model model;
    fresh_launch launch;
    recorded_run run;
    ld_equilibrium_summary summary;
    double y[LD_MAX_STATES];
    ld_error error;
    read_pad(set, sizeof set / sizeof *set, &model);
    fresh_launch_make(&launch, &model);
    if (simulation_equilibrium(&launch.state, 0, y, &summary, &error))
        fail_msg("%s", error.text);
    const launcher_output *found = simulation_output(&launch.state, 0, y);
    assert_non_null(found);
    // the wind in the rail's axes
    double ahead = 20 * cos(70 * degree);
    v3 breeze = v3_make(ahead * cos(60 * degree), -ahead * sin(60 * degree), 20 * sin(70 * degree));
    v3 c = v3_make(1.2, 0, 0);
    dense_wrench on = dense_air(&model, true, c, v3_neg(breeze), v3_zero(), 1.2, 340);
    v3 about_rear = v3_add(on.m, v3_cross(c, on.f)), moment;
    v3 force = sum_of_shoes(&found->launching, &moment);
    force.x = -found->launching.lock_force;
    printf("    force %.4f N, moment about the rear shoe %.4f N m, of it %.4f about the rail\n",
           v3_norm(on.f), v3_norm(about_rear), about_rear.x);
    CHECK_BELOW("force of shoes and lock", apart(force, v3_neg(on.f)), 1e-7);
    CHECK_BELOW("their moment", apart(moment, v3_neg(about_rear)), 1e-7);
    CHECK_BELOW("of it about the rail", fabs(moment.x / about_rear.x + 1), 1e-4);
    fresh_launch_free(&launch);
    recorded_run_make(&run, &model);
    CHECK_BELOW("force told", apart(told(&run, force_name), on.f), 1e-7);
    CHECK_BELOW("moment told", apart(told(&run, moment_name), on.m), 1e-7);
    CHECK_NEAR("Mach number", recorded_value(&run, 0, recorded_column(&run, "air.mach")), 20. / 340,
               1e-9);
    recorded_run_free(&run);
    model_clear(&model);
}

// A base that moves through calm air and one that stands in the wind are alike from the start on.
static void on_a_base_that_moves_through_the_air(void **state)
{
    (void)state;
    static const char *const set[] = {RAIL, "environment.wind={speed: 20 m/s, heading: 70 deg}"};
    ld_equilibrium_summary summary[2];
    double yaw_rate[2];
    for (int moves = 0; moves < 2; moves++) {
        ld_model model;
        read_pad(set, sizeof set / sizeof *set, &model);
        if (moves) {
            model.environment.wind.present = false;
            model.base.kind = LD_BASE_PRESCRIBED;
            model.base.velocity[0] = -20 * cos(70 * degree);
            model.base.velocity[2] = -20 * sin(70 * degree);
        }
        ld_summary found = summary_of_run(&model);
        summary[moves] = found.equilibrium;
        yaw_rate[moves] = found.rocket[0].tip_off.yaw_rate_relative;
        model_clear(&model);
    }
    // both rest but for the accelerations [m/s2] at which Newton's method ends, of 80 kg
    double left = 80 * (summary[0].residual + summary[1].residual);
    CHECK_BELOW("what the rests leave [N]", left, 3e-6);
    for (int i = 0; i < 2; i++)
        CHECK_NEAR("force of a shoe at rest [N]", summary[1].contact_force[i],
                   summary[0].contact_force[i], left);
    CHECK_NEAR("yaw rate as it leaves [rad/s]", yaw_rate[1], yaw_rate[0], 1e-6);
}

// Off the shoes the rocket accelerates as in free flight, in gusts and turbulence: what differs at
// most, relative; with what else is set.
static double shoeless_less_flight(const char *const *more, size_t count)
{
    const char *weather =
        "environment.wind={speed: 12 m/s, heading: 70 deg, gust: [{start: 90 ms, rise: 50 ms, "
        "speed: 9 m/s, heading: 10 deg}], turbulence: {model: dryden, wind_at_6m: 10 m/s, seed: "
        "3}}";
    const char *set[16] = {RAIL, "environment.atmosphere=us1976", weather,
                           "rocket.motor.misalignment=2 -1 mrad"};
    size_t common = 0;
    while (set[common])
        common++;
    for (size_t i = 0; i < count; i++)
        set[common + i] = more[i];
    const double t = 0.12;
    ld_model model;
    fresh_launch launch;
    ld_error error;
    double worst = 0;
    uint64_t seed = 17;
    read_pad(set, common + count, &model);
    fresh_launch_make(&launch, &model);
    launch_state *self = &launch.state;
    const launching_layout *at = &self->launcher.launching.layout;
    flight_system flight;
    flight_phase burning = {.t_ignition = 0};
    if (flight_build(&flight, &model, 0, &error))
        fail_msg("%s", error.text);
    flight_set_piece(&flight, &burning, 1);
    self->t_ignition = 0;
    self->piece = 1;
    self->phase.locked = false;
    self->phase.passed[0] = self->phase.passed[1] = true;
    for (int n = 0; n < 20; n++) {
        double y[LD_MAX_STATES];
        launcher_input input;
        launcher_output out;
        launching_output unused;
        launching_pose pose;
        if (simulation_undeformed(self, t, y, &error))
            fail_msg("%s", error.text);
        for (int i = 0; i < at->nq; i++)
            y[at->q + i] = 1e-3 * draw(&seed);
        y[at->x + X_S] = model.tubes.length; // no way is left
        for (int i = X_PSI; i < X_COUNT; i++)
            y[at->x + i] = 0.05 * draw(&seed);
        v3_store(y + at->V, v3_add(v3_make(27, 0, 0), draw_v3(&seed, 5)));
        v3_store(y + at->V + 3, draw_v3(&seed, 3));
        simulation_input(self, t, y, &input);
        assert_int_equal(launcher_evaluate(&self->launcher, &input, &self->phase, y, &out),
                         LAUNCHING_OK);
        launching_rocket_pose(&self->launcher.launching, y, &pose, &unused);
        // the flight there
        m3 A_IR = q_matrix(q_from(y + at->quaternion)), A_IB = m3_mul(A_IR, pose.A_RB);
        double x[FLIGHT_STATES], x_dot[FLIGHT_STATES] = {0};
        v3 w = m3_apply_transposed(pose.A_RB, pose.w_B);
        flight_pose start = {.r_O1 = v3_add(v3_from(y + at->r), m3_apply(A_IR, pose.p1)),
                             .v_O1 = m3_apply(A_IR, pose.v_O1),
                             .q_IB = q_from_matrix(A_IB),
                             .w = w};
        flight_enter(&flight, &burning, t, &start, x);
        flight_rates(&flight, &burning, t, x, x_dot);
        rocket_mass mass = flight_mass(&flight, &burning, t);
        v3 of_burning = m3_apply(A_IB, v3_cross(w, mass.c_dot)); // in the flight's v_dot
        v3 a_C = v3_sub(v3_from(x_dot + FLIGHT_V), of_burning);
        v3 alpha = v3_from(x_dot + FLIGHT_W); // the roll angle is 0: w_dot less its turning axes
        alpha = v3_sub(alpha, v3_make(0, -w.x * w.z, w.x * w.y));
        v3 a = v3_sub(m3_apply_transposed(A_IB, a_C), v3_cross(alpha, mass.c));
        a = v3_sub(a, v3_cross(w, v3_cross(w, mass.c)));
        worst = fmax(worst, apart(m3_apply_transposed(pose.A_RB, out.launching.a_O1), a));
        worst = fmax(worst, apart(m3_apply_transposed(pose.A_RB, out.launching.alpha_B), alpha));
    }
    flight_free(&flight);
    fresh_launch_free(&launch);
    model_clear(&model);
    return worst;
}

static void shoeless_as_in_flight(void **state)
{
    (void)state;
    static const char *const by_surface[] = {
        "rocket.aerodynamics.table=", "rocket.aerodynamics.fin_cant=",
        "rocket.aerodynamics={model: surfaces, axial: 0.4, surfaces: [{name: nose, at: 2.4 m, "
        "slope: 2}, {name: fins, at: 0.2 m, slope: 8, cant: 1 deg, roll_forcing: 5, roll_damping: "
        "-7}]}"};
    CHECK_BELOW("accelerations on the guide less those in flight, relative",
                shoeless_less_flight(NULL, 0), 1e-12);
    CHECK_BELOW("the same of the air by surface", shoeless_less_flight(by_surface, 3), 5e-14);
}

// A plain body across a wind U: force -k |v| v, so that the linearised equations have 2 k U along
// the wind, k U across it.
static void wind_damps_what_moves_in_it(void **state)
{
    (void)state;
    static const char *const set[] = {
        RIGID,
        "base.elevation=90 deg",
        "rocket.eccentricity=0 0 m",
        "rocket.contact.restitution=1",
        "environment.atmosphere={density: 1.2 kg/m3, speed_of_sound: 340 m/s}",
        "environment.wind={speed: 10 m/s, heading: 90 deg}"};
    const double k = 0.5 * 1.2 * 0.5 * 1.1, U = 10, mass = 80;
    double at_V[2][2];
    for (int blows = 0; blows < 2; blows++) {
        ld_model model;
        fresh_launch launch;
        linear_system system;
        ld_error error;
        read_pad(set, sizeof set / sizeof *set, &model);
        model.environment.wind.speed *= blows;
        model.rocket.aerodynamics.model = LD_AERODYNAMICS_BODY;
        model.rocket.aerodynamics.area = 0.5;
        model.rocket.aerodynamics.drag = 1.1;
        fresh_launch_make(&launch, &model);
        if (simulation_linearise(&launch.state, false, false, &system, &error))
            fail_msg("%s", error.text);
        for (int i = 0; i < 2; i++) { // y, z of the rocket's speeds
            int place = system.half + system.tube + 1 + i;
            at_V[blows][i] = system.J[place + system.count * place];
        }
        free(system.J);
        fresh_launch_free(&launch);
        model_clear(&model);
    }
    CHECK_NEAR("damping along the wind [1/s]", at_V[0][1] - at_V[1][1], 2 * k * U / mass, 1e-6);
    CHECK_NEAR("across it [1/s]", at_V[0][0] - at_V[1][0], k * U / mass, 1e-6);
}

// Through gusts from the lead-in to the exit.
static void energy_on_a_rail_in_gusts(void **state)
{
    (void)state;
    const char *gust = "environment.wind={speed: 15 m/s, heading: 70 deg, gust: [{start: 0.1 s, "
                       "rise: 0.1 s, speed: 15 m/s, heading: 100 deg}]}";
    const char *const set[] = {RAIL, "run.tolerance=1e-9", "tubes.modes.bending=3",
                               "tubes.modes.torsion=1", gust};
    ld_model model;
    read_pad(set, sizeof set / sizeof *set, &model);
    ld_summary windy = summary_of_run(&model);
    model.environment.wind.present = false;
    ld_summary calm = summary_of_run(&model);
    printf("    work of the air %.4g J, %.4g J in calm air; yaw rate %.4g and %.4g rad/s\n",
           windy.energy.work[POWER_AIR], calm.energy.work[POWER_AIR],
           windy.rocket[0].tip_off.yaw_rate, calm.rocket[0].tip_off.yaw_rate);
    CHECK_BELOW("energy balance, relative", windy.energy.residual_relative, 1e-9);
    CHECK_WITHIN("work of the drag in calm air [J]", calm.energy.work[POWER_AIR], -10, -1);
    model_clear(&model);
}

// A table that ends below the speed on the rail, as one that ends below that of the flight.
static void a_table_ends_on_the_rail(void **state)
{
    (void)state;
    const char *table = "rocket.aerodynamics.table=[[0, 0.4, 0.3, 6, 0.8 m, 5, -7, -360], "
                        "[0.05, 0.4, 0.3, 6, 0.8 m, 5, -7, -360]]";
    const char *const set[] = {table, "rocket.aerodynamics.beyond_table=hold"};
    const char *sentence = "rocket.aerodynamics.table: ends at Mach 0.05; the rocket exceeds it "
                           "at t = 0.";
    for (size_t holds = 0; holds < 2; holds++) {
        ld_model model;
        ld_simulation *simulation = NULL;
        static ld_summary summary;
        ld_error error;
        read_pad(set, 1 + holds, &model);
        assert_int_equal(ld_simulation_create(&model, &simulation, &error), LD_OK);
        ld_status status = ld_simulation_run(simulation, NULL, &summary, &error);
        assert_int_equal(status, holds ? LD_OK : LD_ERR_LAUNCH);
        if (!holds)
            assert_memory_equal(error.text, sentence, strlen(sentence));
        ld_simulation_free(simulation);
        model_clear(&model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rest_in_a_steady_wind),
        cmocka_unit_test(energy_in_gusts),
        cmocka_unit_test(the_same_air_before_and_after_the_exit),
        cmocka_unit_test(turbulence_on_the_way_to_the_mouth),
        cmocka_unit_test(shoes_carry_the_wind),
        cmocka_unit_test(on_a_base_that_moves_through_the_air),
        cmocka_unit_test(shoeless_as_in_flight),
        cmocka_unit_test(wind_damps_what_moves_in_it),
        cmocka_unit_test(energy_on_a_rail_in_gusts),
        cmocka_unit_test(a_table_ends_on_the_rail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
