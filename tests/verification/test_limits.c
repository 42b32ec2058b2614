// Limits of the launch (formulation.md, section 7, item 6): a stiff tube is a rigid one, a tube
// without rocket is a beam, a base that does not move is fixed; and closed forms of the rocket in a
// rigid tube.
// ctest: slow
#include <stdlib.h>

#include "model/model.h"
#include "quantities/summary.h"
#include "support/check.h"
#include "support/dense_simulation.h"
#include "support/launching_run.h"
#include "support/reference_model.h"
#include "systems/launching/launching_dynamics.h"
#include "systems/launching/launching_kinematics.h"

static const double pi = 3.14159265358979323846;

static ld_rocket_summary launch(const ld_model *model)
{
    ld_simulation *simulation;
    ld_summary summary;
    ld_error error;
    if (ld_simulation_create(model, &simulation, &error) ||
        ld_simulation_run(simulation, NULL, &summary, &error))
        fail_msg("%s", error.text);
    ld_simulation_free(simulation);
    return summary.rocket[0];
}

// ---- rigid tube ----

// The independent program with a tube that has no modes at all, against ours with a tube that is
// 1e2, 1e4, 1e6 times as stiff as steel.
static void stiff_tube_is_rigid(void **state)
{
    (void)state;
    ld_model model;
    flexible_tube rigid;
    dense_summary truth;
    ld_error error;
    reference_model(&model);
    model.rocket.eccentricity[0] = 0.5e-3;
    model.tubes.modes.bending = 2;
    model.tubes.modes.torsion = 1;
    model.run.tolerance = 1e-10;
    assert_int_equal(flexible_tube_build(&rigid, &model.tubes, &error), LD_OK);
    rigid.nb = rigid.nt = rigid.na = 0;
    assert_true(dense_simulate(&model, &rigid, 40e-6, &truth));
    flexible_tube_free(&rigid);
    static const double factor[] = {1e2, 1e4, 1e6};
    static const double instant[] = {3e-7, 4e-9, 1e-9}, speed[] = {1.5e-4, 1.5e-6, 1.5e-8},
                        rate[] = {1.2e-3, 1.2e-5, 4e-7};
    const ld_section steel = model.tubes.section[0];
    for (int i = 0; i < 3; i++) {
        model.tubes.section[0].bending_stiffness = factor[i] * steel.bending_stiffness;
        model.tubes.section[0].torsion_stiffness = factor[i] * steel.torsion_stiffness;
        ld_rocket_summary r = launch(&model);
        printf("  stiffness times %.0e\n", factor[i]);
        CHECK_BELOW("t_release [s]", r.t_release - truth.t_release, instant[i]);
        CHECK_BELOW("t_rear [s]", r.t_rear - truth.t_rear, instant[i]);
        CHECK_BELOW("exit speed [m/s]", r.exit_speed - truth.exit_speed, speed[i]);
        CHECK_BELOW("pitch rate [rad/s]", r.pitch_rate - truth.pitch_rate, rate[i]);
        CHECK_BELOW("yaw rate [rad/s]", r.yaw_rate - truth.yaw_rate, rate[i]);
        CHECK_BELOW("spin [rad/s]", r.spin_rate - truth.spin_rate, rate[i]);
    }
    reference_model_free(&model);
}

// ---- planes ----

// A launch without gravity along I's x, from a tube of two sections with a bending stiffness of
// each plane, out of proportion; turned: y and z of stiffnesses and eccentricity in each other's
// place.
static ld_rocket_summary launch_in_planes(bool turned)
{
    static const double soft[] = {0.3, 1.2}, firm[] = {0.9, 0.4};
    ld_model model;
    reference_model(&model);
    model.gravity = 0;
    model.base.elevation = 0;
    model.tubes.slot.kind = LD_SLOT_NONE;
    model.rocket.contact.friction = 0;
    model.rocket.eccentricity[turned] = 0.5e-3;
    model.tubes.section_count = 2;
    model.tubes.section[1] = model.tubes.section[0];
    model.tubes.section[1].from = 1.3;
    for (int i = 0; i < 2; i++) {
        ld_section *s = &model.tubes.section[i];
        s->form = LD_SECTION_PLANES;
        s->bending_stiffness_y = (turned ? firm : soft)[i] * s->bending_stiffness;
        s->bending_stiffness_z = (turned ? soft : firm)[i] * s->bending_stiffness;
    }
    ld_rocket_summary exit = launch(&model);
    reference_model_free(&model);
    return exit;
}

// y turned about x is z, pitch minus yaw.
static void turned_planes(void **state)
{
    (void)state;
    ld_rocket_summary upright = launch_in_planes(false), turned = launch_in_planes(true);
    CHECK_WITHIN("pitch rate [rad/s]", fabs(upright.pitch_rate), 1e-3, 1);
    CHECK_BELOW("pitch against yaw, turned", upright.pitch + turned.yaw, 1e-14);
    CHECK_BELOW("their rates", upright.pitch_rate + turned.yaw_rate, 1e-12);
    CHECK_BELOW("tip's place", upright.tip.y - turned.tip.z, 1e-14);
    CHECK_BELOW("the other plane", fabs(upright.yaw_rate) + fabs(turned.pitch_rate), 1e-12);
}

// ---- no rocket ----

typedef struct falling_beam {
    double EI, mu, L, g;
    double deviation, largest; // [m] midspan from the series; of the series
} falling_beam;

// A pinned beam that gravity begins to bend at t = 0.
static double series(const falling_beam *b, double t)
{
    double w = 0;
    for (int j = 1; j < 200; j += 2) {
        double k = j * pi / b->L, omega = k * k * sqrt(b->EI / b->mu);
        double sign = j % 4 == 1 ? 1 : -1;
        w -= sign * 4 * b->g / (j * pi * omega * omega) * (1 - cos(omega * t));
    }
    return w;
}

static void watch_middle(launching_run *run, double t)
{
    falling_beam *b = run->user;
    launching_section middle;
    launching_section_at(run->system, run->state, 0.5 * b->L, &middle);
    const double *r = run->state + run->system->layout.r;
    m3 A = q_matrix(q_from(run->state + run->system->layout.quaternion));
    double w = series(b, t);
    b->deviation = fmax(b->deviation, fabs(r[1] + m3_apply(A, middle.P).y - w));
    b->largest = fmax(b->largest, fabs(w));
}

static void tube_alone_is_a_beam(void **state)
{
    (void)state;
    static const double stiffness[] = {1e9, 1e10, 1e11}, bound[] = {3e-2, 3e-3, 4e-4};
    ld_model model;
    launching_run run;
    reference_model(&model);
    ld_tubes *tubes = &model.tubes;
    tubes->tail = (ld_tail){0};
    tubes->modes.damping = 0;
    falling_beam beam = {.EI = tubes->section[0].bending_stiffness,
                         .mu = tubes->section[0].mass_per_length,
                         .L = tubes->length,
                         .g = model.gravity};
    double period = 2 * beam.L * beam.L / pi / sqrt(beam.EI / beam.mu);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 2; k++) {
            tubes->support[k] = (ld_support){.at = k * tubes->length};
            tubes->support[k].stiffness[0] = k == 0 ? 1e9 : 0;
            tubes->support[k].stiffness[1] = tubes->support[k].stiffness[2] = stiffness[i];
            tubes->support[k].rotational_stiffness[0] = k == 0 ? 1e6 : 0;
        }
        launching_system *system = launching_system_of(&model);
        launching_run_begin(&run, system, 0);
        run.phase.rocket = false;
        run.after_step = watch_middle;
        run.user = &beam;
        beam.deviation = beam.largest = 0;
        launching_run_follow(&run, 1e-8, 5 * period);
        printf("  pins of %.0e N/m, 5 periods, %d steps\n", stiffness[i], (int)run.steps);
        CHECK_BELOW("midspan against the series, of its largest", beam.deviation / beam.largest,
                    bound[i]);
        launching_system_drop(system);
    }
    reference_model_free(&model);
}

// ---- base ----

static void check_same(const ld_rocket_summary *a, const ld_rocket_summary *b, double yaw,
                       double bound)
{
    CHECK_BELOW("t_rear [s]", a->t_rear - b->t_rear, bound);
    CHECK_BELOW("exit speed [m/s]", a->exit_speed - b->exit_speed, bound);
    CHECK_BELOW("pitch [rad]", a->pitch - b->pitch, bound);
    CHECK_BELOW("yaw [rad]", a->yaw - b->yaw - yaw, bound);
    CHECK_BELOW("pitch rate [rad/s]", a->pitch_rate - b->pitch_rate, bound);
    CHECK_BELOW("yaw rate [rad/s]", a->yaw_rate - b->yaw_rate, bound);
}

static void resting_base_is_fixed(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    model.run.tolerance = 1e-10;
    ld_rocket_summary fixed = launch(&model);
    printf("  prescribed, no motion\n");
    model.base.kind = LD_BASE_PRESCRIBED;
    model.base.heave = (ld_sines){1, {{0, 2, 0}}};
    ld_rocket_summary still = launch(&model);
    check_same(&still, &fixed, 0, 1e-15);
    printf("  turned about the vertical by 0.7 rad\n");
    model.base.azimuth = 0.3;
    model.base.yaw = (ld_sines){1, {{0.4, 0, pi / 2}}};
    ld_rocket_summary turned = launch(&model);
    check_same(&turned, &fixed, 0.7, 1e-8);
    printf("  moving steadily at 25 m/s\n");
    model.base.velocity[0] = 20;
    model.base.velocity[2] = -15;
    ld_rocket_summary moving = launch(&model);
    check_same(&moving, &fixed, 0.7, 2e-8);
    reference_model_free(&model);
}

// ---- closed forms in a rigid tube ----

// State: the tube stays where it is, whatever acts on it.
static int rhs_of_held_tube(double t, const double *state, double *state_dot, void *user)
{
    (void)t;
    launching_run *run = user;
    const launching_layout *at = &run->system->layout;
    launching_output out;
    if (launching_evaluate(run->system, &run->input, &run->phase, state, &out))
        return -1;
    launching_rates(run->system, state, &out, true, state_dot);
    memset(state_dot, 0, (size_t)at->x * sizeof *state_dot);
    memset(state_dot + at->count, 0, (size_t)run->system->work_count * sizeof(double));
    return 0;
}

// Half-binding: only the rear adaptor is still in the tube and glides without clearance.
static void half_binding(void **state)
{
    (void)state;
    ld_model model;
    launching_run run;
    reference_model(&model);
    model.tubes.slot.kind = LD_SLOT_NONE;
    model.rocket.contact.law = LD_CONTACT_BILATERAL;
    model.rocket.contact.friction = 0;
    static const double stiffness[] = {1e7, 1e8, 1e9}, bound[] = {4e-3, 4e-4, 5e-5};
    // a: acceleration that is felt, T/m; gravity along the tube works on tube and rocket alike
    const double elevation = 0.3, thrust = 15e3, time = 0.05, m = 60, x_c = 1.1, J = 24;
    for (int i = 0; i < 3; i++) {
        model.rocket.contact.stiffness = stiffness[i];
        model.rocket.contact.damping = 2 * sqrt(stiffness[i] * m * J / (J + m * x_c * x_c));
        launching_system *system = launching_system_of(&model);
        launching_run_begin(&run, system, 0.1);
        run.rhs = rhs_of_held_tube;
        run.phase.passed[1] = run.phase.passed[2] = true;
        run.input.thrust = thrust;
        double *quaternion = run.state + system->layout.quaternion;
        quaternion[0] = cos(0.5 * elevation);
        quaternion[3] = sin(0.5 * elevation);
        launching_run_follow(&run, 1e-10, time);
        double g = model.gravity, a = thrust / m;
        double k = sqrt(m * x_c * a / (J + m * x_c * x_c));
        double theta = g * cos(elevation) / a * (1 - cosh(k * time));
        double rate = -g * cos(elevation) / a * k * sinh(k * time);
        // pitch up turns x of B towards y of S: that is psi
        printf("  stiffness %.0e N/m, k t = %.2f\n", stiffness[i], k * time);
        printf("    theta %.9f, closed form %.9f rad\n", run.state[system->layout.x + 3], theta);
        CHECK_BELOW("theta, relative", run.state[system->layout.x + 3] / theta - 1, bound[i]);
        CHECK_BELOW("its rate, relative", run.state[system->layout.V + 5] / rate - 1, bound[i]);
        launching_system_drop(system);
    }
    reference_model_free(&model);
}

// A heavy tube at rest, no gravity, adaptors on stiff springs: the rocket turns with the helix.
static void helix_model(ld_model *model, double stiffness)
{
    reference_model(model);
    model->gravity = 0;
    model->tubes.section[0].mass_per_length = 1e12;
    model->tubes.section[0].polar_inertia = 1e12;
    model->tubes.support_count = 0;
    model->tubes.slot.friction = 0;
    model->rocket.contact.law = LD_CONTACT_BILATERAL;
    model->rocket.contact.stiffness = stiffness;
    model->rocket.contact.damping = 2 * sqrt(stiffness * 20);
    model->rocket.contact.friction = 0;
}

static void helix_spin(void **state)
{
    (void)state;
    static const double stiffness[] = {1e7, 1e8, 1e9}, bound[] = {6e-3, 6e-4, 6e-5};
    const double alpha = 4 * pi / 180, R = 0.0825, J = 0.22, m = 60, thrust = 15e3;
    for (int i = 0; i < 3; i++) {
        ld_model model;
        launching_run run;
        helix_model(&model, stiffness[i]);
        launching_system *system = launching_system_of(&model);
        const launching_layout layout = system->layout, *at = &layout;
        launching_run_begin(&run, system, 0.1);
        run.input.thrust = thrust;
        launching_run_follow(&run, 1e-10, 0.1);
        double turn = tan(alpha) / R, a = thrust / (m + J * turn * turn);
        printf("  constant angle, stiffness %.0e N/m\n", stiffness[i]);
        CHECK_BELOW("travel against T/(m + J tan^2/R^2), relative",
                    (run.state[at->x] - 0.1) / (0.5 * a * 0.01) - 1, 6e-4 * bound[i]);
        CHECK_BELOW("roll against travel tan/R, relative",
                    run.state[at->x + 5] / ((run.state[at->x] - 0.1) * turn) - 1, 0.2 * bound[i]);
        CHECK_BELOW("spin, relative", run.state[at->V + 3] / (a * 0.1 * turn) - 1, 1e-2 * bound[i]);
        launching_system_drop(system);
        // angle growing along the tube: roll is the integral of tan(alpha(s))/R
        free(model.tubes.slot.angle.data);
        const double slope = 0.1; // rad/m
        model.tubes.slot.angle = reference_table(2, 2, (double[]){0, 0, 3, 3 * slope});
        system = launching_system_of(&model);
        launching_run_begin(&run, system, 0.1);
        run.input.thrust = thrust;
        launching_run_set_speeds(system, run.state,
                                 (double[6]){1, 0, 0, tan(0.1 * slope) / R, 0, 0});
        launching_run_follow(&run, 1e-10, 0.1);
        double roll = log(cos(0.1 * slope) / cos(run.state[at->x] * slope)) / (slope * R);
        printf("  angle growing to %.2f rad at s = %.3f\n", run.state[at->x] * slope,
               run.state[at->x]);
        CHECK_BELOW("roll against int tan(alpha)/R ds, relative", run.state[at->x + 5] / roll - 1,
                    bound[i]);
        launching_system_drop(system);
        reference_model_free(&model);
    }
}

// Force along the tube per force around it, at slow and fast sliding and at angles up to 45 deg.
static void slot_force_ratio(void **state)
{
    (void)state;
    static const double degrees[] = {4, 15, 45}, speed[] = {0.02, 1, 30}, mu = 0.1;
    double worst = 0;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            ld_model model;
            launching_run run;
            launching_output out;
            double a = degrees[i] * pi / 180;
            helix_model(&model, 1e9);
            model.tubes.slot.friction = mu;
            model.tubes.slot.angle.data[1] = a;
            launching_system *system = launching_system_of(&model);
            launching_run_begin(&run, system, 1);
            run.input.thrust = 15e3;
            launching_run_set_speeds(system, run.state,
                                     (double[6]){speed[k], 0, 0, speed[k] * tan(a) / 0.0825, 0, 0});
            assert_int_equal(launching_evaluate(system, &run.input, &run.phase, run.state, &out),
                             LAUNCHING_OK);
            double v = speed[k] / cos(a), share = mu * v / hypot(v, 0.01);
            double axial = 15e3 - 60 * out.a_O1.x, around = 0.22 * out.alpha_B.x / 0.0825;
            double ratio = (sin(a) + share * cos(a)) / (cos(a) - share * sin(a));
            printf("    %2.0f deg, %5.2f m/s: %.12f, closed form %.12f\n", degrees[i], speed[k],
                   axial / around, ratio);
            worst = fmax(worst, fabs(axial / around / ratio - 1));
            launching_system_drop(system);
            reference_model_free(&model);
        }
    CHECK_BELOW("axial per tangential force, relative", worst, 5e-15);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stiff_tube_is_rigid),  cmocka_unit_test(turned_planes),
        cmocka_unit_test(tube_alone_is_a_beam), cmocka_unit_test(resting_base_is_fixed),
        cmocka_unit_test(half_binding),         cmocka_unit_test(helix_spin),
        cmocka_unit_test(slot_force_ratio),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
