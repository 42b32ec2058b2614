// The wind on the guide itself against closed forms: a cantilever with a wind across both planes
// (deflection, root, section loads), the wind of a profile on a mast, turbulence that passes, and
// the energy of a launch in gusts.
#include "model/model.h"
#include "state/equilibrium.h"
#include "state/evaluation.h"
#include "support/check.h"
#include "support/fresh_launch.h"
#include "support/recorded_run.h"
#include "support/reference_model.h"
#include "systems/launching/launching_kinematics.h"

static const double density = 1.2;

static void let_the_wind_blow(ld_model *model, double speed, double heading)
{
    ld_environment *environment = &model->environment;
    environment->atmosphere.kind = LD_ATMOSPHERE_UNIFORM;
    environment->atmosphere.density = density;
    environment->atmosphere.speed_of_sound = 340;
    environment->wind.present = true;
    environment->wind.speed = speed;
    environment->wind.heading = heading;
}

// Clamped at its rear end, of two stiffnesses, without weight; the rocket on two adaptors carries
// nothing.
static void cantilever(ld_model *model, double stiffness, int modes)
{
    reference_model(model);
    ld_tubes *tubes = &model->tubes;
    ld_section *section = &tubes->section[0];
    model->gravity = 0;
    tubes->tail = (ld_tail){0};
    tubes->slot.kind = LD_SLOT_NONE;
    tubes->modes.bending = modes;
    tubes->modes.torsion = 1;
    tubes->support_count = 1;
    tubes->support[0] = (ld_support){.at = 0, .clamped = 0x3f};
    section->form = LD_SECTION_PLANES;
    section->bending_stiffness_y = 0.3 * stiffness * section->bending_stiffness;
    section->bending_stiffness_z = stiffness * section->bending_stiffness;
    section->bending_stiffness = NAN;
    model->rocket.adaptor_count = 2;
    model->rocket.contact.law = LD_CONTACT_BILATERAL;
    model->rocket.start_at = 0.2;
}

typedef struct rest {
    v3 tip;            // of the axis, in T
    v3 force, moment;  // on the base, in T, about the rear end
    guide_load middle; // at the first station
} rest;

static rest rest_of(const ld_model *model, double t)
{
    fresh_launch launch;
    ld_equilibrium_summary summary;
    launcher_input input;
    launcher_output out;
    launching_loads loads = {0};
    launching_section tip;
    ld_error error;
    double y[LD_MAX_STATES];
    fresh_launch_make(&launch, model);
    if (simulation_equilibrium(&launch.state, t, y, &summary, &error))
        fail_msg("%s", error.text);
    simulation_move_with_base(&launch.state, t, y);
    simulation_input(&launch.state, t, y, &input);
    assert_int_equal(simulation_loads(&launch.state, &input, y, &out, &loads), LAUNCHING_OK);
    launching_section_at(&launch.state.launcher.launching, y, model->tubes.length, &tip);
    rest found = {tip.P, out.launching.base_force, out.launching.base_moment, loads.station[0]};
    fresh_launch_free(&launch);
    return found;
}

// A wind from the side and from below a level tube: y of the tube is along y of I only where it is
// level, so the tube is inclined and the wind has parts along it, along its y and its z.
static const double speed = 25, heading = 50 * 3.14159265358979323846 / 180,
                    elevation = 35 * 3.14159265358979323846 / 180;

static v3 load_by_hand(double width)
{
    double x = speed * cos(heading), z = speed * sin(heading);
    v3 across = v3_make(0, -x * sin(elevation), z);
    return v3_scale(0.5 * density * width * v3_norm(across), across);
}

// int_a^b w xi^2 (3 L - xi)/(6 EI) d xi
static double tip_by_hand(double w, double a, double b, double length, double EI)
{
    double upper = length * b * b * b - 0.25 * b * b * b * b;
    double lower = length * a * a * a - 0.25 * a * a * a * a;
    return w / (6 * EI) * (upper - lower);
}

static void cantilever_bends(void **state)
{
    (void)state;
    for (int part = 0; part < 2; part++) {
        ld_model model;
        cantilever(&model, 1e4, 12);
        let_the_wind_blow(&model, speed, heading);
        model.base.elevation = elevation;
        ld_tubes *tubes = &model.tubes;
        double a = part ? 0.7 : 0, b = part ? 2.3 : tubes->length, L = tubes->length, at = 1.6;
        tubes->wind_drag_count = 1;
        tubes->wind_drag[0] = (ld_wind_drag){a, b, 0.3, 1.2};
        tubes->station_count = 1;
        tubes->station[0] = (ld_station){at, {NAN, NAN}};
        rest found = rest_of(&model, 0);
        v3 w = load_by_hand(0.3 * 1.2);
        double y = tip_by_hand(w.y, a, b, L, tubes->section[0].bending_stiffness_z);
        double z = tip_by_hand(w.z, a, b, L, tubes->section[0].bending_stiffness_y);
        if (!part)
            CHECK_BELOW("by hand: w L^4/8 EI, relative",
                        y / (w.y * L * L * L * L / 8 / tubes->section[0].bending_stiffness_z) - 1,
                        1e-14);
        v3 force = v3_scale(b - a, w);
        v3 moment = v3_cross(v3_make(0.5 * (a + b), 0, 0), force);
        printf("  %s: force %.2f N, tip by %.4g and %.4g um\n", part ? "a part" : "all of it",
               v3_norm(force), 1e6 * y, 1e6 * z);
        CHECK_BELOW("tip along y, relative", found.tip.y / y - 1, 2e-6);
        CHECK_BELOW("tip along z, relative", found.tip.z / z - 1, 2e-6);
        CHECK_BELOW("force at the root, relative",
                    v3_norm(v3_sub(found.force, force)) / v3_norm(force), 5e-7);
        CHECK_BELOW("moment at the root, relative",
                    v3_norm(v3_sub(found.moment, moment)) / v3_norm(moment), 5e-7);
        const guide_wrench *carried = &found.middle.wrench;
        double beyond = b - at, arm = 0.5 * (b - at);
        CHECK_BELOW("shear in a panel, relative",
                    hypot(carried->f.y - w.y * beyond, carried->f.z - w.z * beyond) /
                        (v3_norm(w) * beyond),
                    5e-7);
        CHECK_BELOW("bending moment there, relative",
                    hypot(carried->m.z - w.y * beyond * arm, carried->m.y + w.z * beyond * arm) /
                        (v3_norm(w) * beyond * arm),
                    5e-7);
        reference_model_free(&model);
    }
}

// Two modes to sixteen: how far the tip is off.
static void modes_converge(void **state)
{
    (void)state;
    double before = 0;
    for (int modes = 2; modes <= 16; modes *= 2) {
        ld_model model;
        cantilever(&model, 1e4, modes);
        let_the_wind_blow(&model, speed, heading);
        model.base.elevation = elevation;
        ld_tubes *tubes = &model.tubes;
        tubes->wind_drag_count = 1;
        tubes->wind_drag[0] = (ld_wind_drag){0.7, 2.3, 0.3, 1.2};
        rest found = rest_of(&model, 0);
        v3 w = load_by_hand(0.3 * 1.2);
        double z = tip_by_hand(w.z, 0.7, 2.3, tubes->length, tubes->section[0].bending_stiffness_y);
        double off = fabs(found.tip.z / z - 1);
        printf("  %d modes: off by %.2e\n", modes, off);
        if (modes > 2)
            CHECK_WITHIN("error of half as many modes over it", before / off, 8, 40);
        before = off;
        reference_model_free(&model);
    }
}

// A mast in a wind that grows with the square root of 1 m and the height, by a fine table: the
// force is the integral of the squares, the moment that with the height.
static void mast_in_a_profile(void **state)
{
    (void)state;
    enum { ROWS = 301 };
    ld_model model;
    cantilever(&model, 1e4, 8);
    let_the_wind_blow(&model, 0, 0);
    model.base.elevation = 0.5 * acos(-1);
    double row[ROWS][3], L = model.tubes.length;
    for (int i = 0; i < ROWS; i++) {
        double h = 1.2 * L * i / (ROWS - 1);
        row[i][0] = h;
        row[i][1] = 12 * sqrt(1 + h);
        row[i][2] = 5 * sqrt(1 + h);
    }
    model.environment.wind.profile = reference_table(ROWS, 3, row[0]);
    model.tubes.wind_drag_count = 1;
    model.tubes.wind_drag[0] = (ld_wind_drag){0, L, 0.3, 1.2};
    rest found = rest_of(&model, 0);
    // x of T is up, y of T is against x of I; per length k (1 + h)
    double k = 0.5 * density * 0.3 * 1.2 * 13;
    double all = k * (L + L * L / 2), turn = k * (L * L / 2 + L * L * L / 3);
    v3 force = v3_make(0, -12 * all, 5 * all), moment = v3_make(0, -5 * turn, -12 * turn);
    CHECK_BELOW("force of the profile, relative",
                v3_norm(v3_sub(found.force, force)) / v3_norm(force), 2e-7);
    CHECK_BELOW("its moment, relative", v3_norm(v3_sub(found.moment, moment)) / v3_norm(moment),
                1e-7);
    reference_model_free(&model);
}

// At a point at rest the frozen gusts go past with the mean wind: lengths and intensities of
// MIL-F-8785C below 1000 ft by hand, the gust by the flight's own functions at V t/L; the same all
// along the guide.
static void turbulence_passes(void **state)
{
    (void)state;
    const double foot = 0.3048, at_6m = 8, t = 1.7;
    ld_model model;
    cantilever(&model, 1e6, 3);
    let_the_wind_blow(&model, 9, 0.4);
    ld_wind *given = &model.environment.wind;
    given->turbulence.present = true;
    given->turbulence.wind_at_6m = at_6m;
    given->turbulence.harmonics = 100;
    given->turbulence.seed = 7;
    given->gust_count = 1; // is no mean wind
    given->gust[0] = (ld_gust){1, 0.3, 2, 0.3, 6, 1.1};
    model.base.elevation = 0.5 * acos(-1);
    model.environment.ground_height = -20;
    model.tubes.wind_drag_count = 1;
    model.tubes.wind_drag[0] = (ld_wind_drag){0, model.tubes.length, 0.3, 1.2};
    rest found = rest_of(&model, t);
    double height = 20 + model.tubes.length, h = height / foot;
    double L_u = height / pow(0.177 + 0.000823 * h, 1.2), sigma_w = 0.1 * at_6m;
    turbulence drawn;
    ld_error error;
    assert_int_equal(turbulence_build(&drawn, &given->turbulence, 0, &error), LD_OK);
    turbulence_scales scales = {L_u, height, sigma_w / pow(0.177 + 0.000823 * h, 0.4), sigma_w};
    v3 gust = turbulence_velocity(&drawn, &scales, 9 * t / L_u, 9 * t / height);
    turbulence_free(&drawn);
    double x = gust.x + 9 * cos(0.4) + 6 * cos(1.1), z = gust.z + 9 * sin(0.4) + 6 * sin(1.1);
    double k = 0.5 * density * 0.3 * 1.2 * hypot(x, z) * model.tubes.length;
    v3 force = v3_make(0, -k * x, k * z);
    printf("  gust of %.2f and %.2f m/s\n", gust.x, gust.z);
    CHECK_BELOW("force of wind, gust and turbulence, relative",
                v3_norm(v3_sub(found.force, force)) / v3_norm(force), 1e-9);
    reference_model_free(&model);
}

// A base goes through air at rest as one at rest stands in the wind that this makes.
static void go_or_stand(ld_model *model, bool goes)
{
    const double along = -9, aside = 24; // of the base, in I
    let_the_wind_blow(model, goes ? 0 : hypot(along, aside), atan2(-aside, -along));
    model->base.kind = LD_BASE_PRESCRIBED;
    model->base.azimuth = 0.6;
    model->base.elevation = elevation;
    model->base.velocity[0] = goes ? along : 0;
    model->base.velocity[2] = goes ? aside : 0;
    model->tubes.wind_drag_count = 1;
    model->tubes.wind_drag[0] = (ld_wind_drag){0.4, model->tubes.length, 0.3, 1.2};
}

// In equilibrium, which holds the base and lets the air pass, and in a launch from a soft guide.
static void moving_base(void **state)
{
    (void)state;
    rest found[2];
    ld_summary summary[2];
    for (int goes = 0; goes < 2; goes++) {
        ld_model model;
        cantilever(&model, 1e4, 6);
        go_or_stand(&model, goes);
        found[goes] = rest_of(&model, 0.3);
        reference_model_free(&model);
        reference_model(&model);
        model.tubes.section[0].bending_stiffness *= 0.1;
        model.tubes.modes.bending = 3;
        model.tubes.modes.torsion = 1;
        model.run.tolerance = 1e-9;
        go_or_stand(&model, goes);
        summary[goes] = summary_of_run(&model);
        reference_model_free(&model);
    }
    double size = v3_norm(found[0].force);
    CHECK_BELOW("tip of a moving base, relative",
                v3_norm(v3_sub(found[1].tip, found[0].tip)) / hypot(found[0].tip.y, found[0].tip.z),
                1e-13);
    CHECK_BELOW("force on it, relative", v3_norm(v3_sub(found[1].force, found[0].force)) / size,
                1e-13);
    const ld_rocket_summary *a = &summary[0].rocket[0], *b = &summary[1].rocket[0];
    CHECK_NEAR("exit speed [m/s]", b->exit_speed, a->exit_speed, 5e-9);
    CHECK_NEAR("pitch rate [rad/s]", b->pitch_rate, a->pitch_rate, 5e-9);
    CHECK_NEAR("yaw rate [rad/s]", b->yaw_rate, a->yaw_rate, 3e-8);
}

// A mast whose foot stands h above the point about which the base rolls: the air passes with
// w (h + x). The force is k w^2 int (h + x)^2 dx, at the instant at which the roll is 0.
static void rolling_base(void **state)
{
    (void)state;
    const double amplitude = 0.2, frequency = 0.4, h = 1.5;
    ld_model model;
    cantilever(&model, 1e5, 6);
    let_the_wind_blow(&model, 0, 0);
    model.base.kind = LD_BASE_PRESCRIBED;
    model.base.elevation = 0.5 * acos(-1);
    model.base.at[1] = h;
    model.base.roll = (ld_sines){1, {{amplitude, frequency, 0}}};
    model.tubes.wind_drag_count = 1;
    model.tubes.wind_drag[0] = (ld_wind_drag){0, model.tubes.length, 0.3, 1.2};
    rest found = rest_of(&model, 0);
    double w = amplitude * 2 * acos(-1) * frequency, L = model.tubes.length, end = h + L;
    double k = 0.5 * density * 0.3 * 1.2 * w * w;
    double force = k * (end * end * end - h * h * h) / 3;
    double moment = k * (pow(end, 4) - pow(h, 4)) / 4 - h * force;
    // the tip goes towards z of I; x of T is up
    CHECK_BELOW("force, relative", found.force.z / -force - 1, 5e-10);
    CHECK_BELOW("along y [N]", found.force.y, 2e-14);
    CHECK_BELOW("moment, relative", found.moment.y / moment - 1, 2e-9);
    reference_model_free(&model);
}

// A soft guide in a gust that rises, holds and falls during the launch.
static void energy_in_gusts(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    let_the_wind_blow(&model, 30, 1);
    model.tubes.section[0].bending_stiffness *= 0.1;
    model.tubes.modes.bending = 3;
    model.tubes.modes.torsion = 1;
    model.run.tolerance = 1e-9;
    model.environment.wind.gust_count = 1;
    model.environment.wind.gust[0] = (ld_gust){0.02, 0.02, 0.01, 0.02, 25, 1.8};
    ld_summary calm = summary_of_run(&model);
    model.tubes.wind_drag_count = 1;
    model.tubes.wind_drag[0] = (ld_wind_drag){0.2, model.tubes.length, 0.4, 1.3};
    ld_summary windy = summary_of_run(&model);
    double turned = windy.rocket[0].yaw_rate - calm.rocket[0].yaw_rate;
    printf("  work of the wind %.4g J; yaw rate by %.4g rad/s\n",
           windy.energy.work[POWER_GUIDE_WIND], turned);
    CHECK_BELOW("energy balance, relative", windy.energy.residual_relative, 5e-13);
    CHECK_WITHIN("work of the wind [J]", fabs(windy.energy.work[POWER_GUIDE_WIND]), 1e-3, 1);
    CHECK_WITHIN("what it does to the yaw rate [rad/s]", fabs(turned), 1e-4, 1e-1);
    reference_model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cantilever_bends),  cmocka_unit_test(modes_converge),
        cmocka_unit_test(mast_in_a_profile), cmocka_unit_test(turbulence_passes),
        cmocka_unit_test(moving_base),       cmocka_unit_test(rolling_base),
        cmocka_unit_test(energy_in_gusts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
