// The independent launch program on the reference launcher: it converges in its step, starts in
// balance, and gives what hand calculation expects.
// ctest: slow
#include "model/model.h"
#include "support/check.h"

#include "support/dense_simulation.h"
#include "support/reference_model.h"

static void launch(ld_model *model, double step, dense_summary *summary)
{
    flexible_tube tube;
    ld_error error;
    if (flexible_tube_build(&tube, &model->tubes, &error))
        fail_msg("%s", error.text);
    assert_true(dense_simulate(model, &tube, step, summary));
    flexible_tube_free(&tube);
}

static void print_summary(const dense_summary *s)
{
    printf("    release %.9f front %.9f middle %.9f rear %.9f, %d evaluations, drift %.1e\n",
           s->t_release, s->t_front, s->t_middle, s->t_rear, s->evaluations, s->slot_drift);
    printf("    exit %.9f inertial %.9f spin %.9f\n", s->exit_speed, s->inertial_speed,
           s->spin_rate);
    printf("    pitch %.9f yaw %.9f rates %.9f %.9f\n", s->pitch, s->yaw, s->pitch_rate,
           s->yaw_rate);
    printf("    relative y %.9f z %.9f psi %.9f theta %.9f gamma %.9f w %.6f %.6f %.6f\n",
           s->relative.y, s->relative.z, s->relative.psi, s->relative.theta, s->relative.gamma,
           s->relative.w_x, s->relative.w_y, s->relative.w_z);
    printf("    tip y %.9f z %.9f pitch %.9f yaw %.9f v %.6f %.6f rates %.6f %.6f\n", s->tip.y,
           s->tip.z, s->tip.pitch, s->tip.yaw, s->tip.vy, s->tip.vz, s->tip.pitch_rate,
           s->tip.yaw_rate);
    printf("    contact %.2f %.2f %.2f slot %.3f\n", s->max_contact_force[0],
           s->max_contact_force[1], s->max_contact_force[2], s->max_slot_force);
    printf("    start: lock %.6f slot %.6f contact %.4f %.4f %.4f sag %.9f %.9f residual %.1e\n",
           s->equilibrium.lock_force, s->equilibrium.slot_force, s->equilibrium.contact_force[0],
           s->equilibrium.contact_force[1], s->equilibrium.contact_force[2],
           s->equilibrium.tip_sag[0], s->equilibrium.tip_sag[1], s->equilibrium.residual);
}

static void coarse_modes(ld_model *model)
{
    model->tubes.modes.bending = 3;
    model->tubes.modes.torsion = 1;
    model->tubes.modes.elements = 12;
}

static void check_same(const dense_summary *a, const dense_summary *b, double instants,
                       double speed, double rates)
{
    CHECK_BELOW("t_release [s]", a->t_release - b->t_release, instants);
    CHECK_BELOW("t_front [s]", a->t_front - b->t_front, instants);
    CHECK_BELOW("t_middle [s]", a->t_middle - b->t_middle, instants);
    CHECK_BELOW("t_rear [s]", a->t_rear - b->t_rear, instants);
    CHECK_BELOW("exit speed [m/s]", a->exit_speed - b->exit_speed, speed);
    CHECK_BELOW("pitch rate [rad/s]", a->pitch_rate - b->pitch_rate, rates);
    CHECK_BELOW("yaw rate [rad/s]", a->yaw_rate - b->yaw_rate, rates);
    CHECK_BELOW("relative pitching [rad/s]", a->relative.w_z - b->relative.w_z, rates);
}

static void reference_launch_converges_in_its_step(void **state)
{
    (void)state;
    ld_model model;
    dense_summary coarse, fine;
    reference_model(&model);
    coarse_modes(&model);
    launch(&model, 80e-6, &coarse);
    launch(&model, 40e-6, &fine);
    print_summary(&fine);
    check_same(&coarse, &fine, 3e-9, 5e-7, 1e-5);
    CHECK_BELOW("acceleration at the start [m/s2, rad/s2]", fine.equilibrium.residual, 1e-8);
    CHECK_BELOW("slot drift [m/s]", fine.slot_drift, 2e-6);
    // statics: the rocket's weight along and across the tube (the tube sags by less than 0.1 mrad)
    double weight = 60 * model.gravity, elevation = model.base.elevation;
    double carried = fine.equilibrium.contact_force[0] + fine.equilibrium.contact_force[2];
    CHECK_NEAR("lock force [N]", fine.equilibrium.lock_force, -weight * sin(elevation), 0.1);
    CHECK_NEAR("rear and front [N]", carried, weight * cos(elevation), 0.1);
    CHECK_NEAR("front adaptor [N]", fine.equilibrium.contact_force[2],
               weight * cos(elevation) * 1.1 / 1.9, 0.1);
    reference_model_free(&model);
}

static void uniform_motion_of_the_base_changes_nothing(void **state)
{
    (void)state;
    ld_model model;
    dense_summary fixed, moving;
    reference_model(&model);
    coarse_modes(&model);
    model.tubes.modes.bending = 2;
    launch(&model, 160e-6, &fixed);
    model.base.kind = LD_BASE_PRESCRIBED;
    model.base.velocity[0] = 8;
    model.base.velocity[2] = -3;
    launch(&model, 160e-6, &moving);
    check_same(&fixed, &moving, 1e-14, 1e-12, 1e-11);
    reference_model_free(&model);
}

// A rigid tube too heavy to move, no gravity, no contact: release at a third of the ramp, then the
// rocket equation, v = I/m_p ln(m(t_release)/m(t)).
static void smooth_rigid_bore_follows_the_rocket_equation(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    model.gravity = 0;
    model.run.start = LD_START_UNDEFORMED;
    model.tubes.section[0].mass_per_length = 1e12;
    model.tubes.support_count = 0;
    model.tubes.slot.kind = LD_SLOT_NONE;
    for (int i = 0; i < 3; i++)
        model.rocket.adaptor[i].clearance = 1;
    tube_element element = {.x0 = 0, .x1 = 3};
    flexible_tube tube = {.length = 3, .element_count = 1, .element = &element};
    dense_summary summary;
    assert_true(dense_simulate(&model, &tube, 100e-6, &summary));
    double t_release = 0.01 / 3, total = 15e3 * (0.005 + 2.49 + 0.025), k = 20 / total;
    double burnt = 15e3 * (0.005 + summary.t_rear - 0.01);
    double m_release = 60 - k * 0.5 * 5e3 * t_release, m = 60 - k * burnt;
    CHECK_NEAR("release [s]", summary.t_release, t_release, 1e-12);
    CHECK_NEAR("exit speed [m/s]", summary.exit_speed, log(m_release / m) / k, 1e-8);
    // way: Simpson's rule over the ramp's rest and the plateau
    double way = 0, corner[3] = {t_release, 0.01, summary.t_rear};
    for (int part = 0; part < 2; part++)
        for (int i = 0; i <= 2000; i++) {
            double t = corner[part] + (corner[part + 1] - corner[part]) * i / 2000;
            double impulse = t < 0.01 ? 0.75e6 * t * t : 15e3 * (t - 0.005);
            double weight = i == 0 || i == 2000 ? 1 : i % 2 ? 4 : 2;
            way += weight * (corner[part + 1] - corner[part]) / 6000 *
                   log(m_release / (60 - k * impulse)) / k;
        }
    CHECK_NEAR("way to the tip [m]", way, 2.9, 1e-9);
    reference_model_free(&model);
}

static void base_rates_are_the_derivatives_of_its_pose(void **state)
{
    (void)state;
    ld_model model;
    reference_model(&model);
    model.base.kind = LD_BASE_PRESCRIBED;
    model.base.azimuth = 0.4;
    ld_sines *sines[6] = {&model.base.surge, &model.base.heave, &model.base.sway,
                          &model.base.yaw,   &model.base.pitch, &model.base.roll};
    for (int i = 0; i < 6; i++) {
        sines[i]->count = 2;
        sines[i]->term[0] = (ld_sine){0.1 + 0.05 * i, 0.7 + 0.2 * i, 0.3 * i};
        sines[i]->term[1] = (ld_sine){0.05, 1.9 - 0.1 * i, 1};
    }
    const double t = 0.37, h = 1e-5;
    dense_base now, before, after;
    dense_base_at(&model, t, &now);
    dense_base_at(&model, t - h, &before);
    dense_base_at(&model, t + h, &after);
    double worst = 0;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        double w = 0; // skew part of A_dot A^T
        for (int l = 0; l < 3; l++)
            w += 0.5 *
                 ((after.A[k][l] - before.A[k][l]) * now.A[j][l] -
                  (after.A[j][l] - before.A[j][l]) * now.A[k][l]) /
                 (2 * h);
        worst = fmax(worst, fabs(w - now.w[i]));
        worst = fmax(worst, fabs((after.r[i] - before.r[i]) / (2 * h) - now.v[i]));
    }
    CHECK_BELOW("base rates [m/s, rad/s]", worst, 1e-8);
    reference_model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(base_rates_are_the_derivatives_of_its_pose),
        cmocka_unit_test(smooth_rigid_bore_follows_the_rocket_equation),
        cmocka_unit_test(uniform_motion_of_the_base_changes_nothing),
        cmocka_unit_test(reference_launch_converges_in_its_step),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
