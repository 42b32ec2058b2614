// Supports that hold rigidly: frequencies of a cantilever, the limit of stiff springs, and the
// balance on bases that move.
#include "model/model.h"
#include "support/check.h"
#include "support/recorded_run.h"
#include "support/reference_model.h"

static const unsigned all = 0x3f, pin = 1u << LD_CLAMP_Y | 1u << LD_CLAMP_Z;

static void cantilever(void **state)
{
    (void)state;
    static const double lambda[] = {1.87510407, 4.69409113, 7.85475744, 10.99554073};
    ld_model model;
    ld_simulation *simulation;
    ld_error error;
    ld_mode mode[40];
    reference_model(&model);
    model.tubes.tail = (ld_tail){0};
    model.tubes.modes.torsion = 0;
    model.tubes.support_count = 1;
    model.tubes.support[0] = (ld_support){.clamped = all, .stiffness = {NAN, NAN, NAN}};
    assert_int_equal(ld_simulation_create(&model, &simulation, &error), LD_OK);
    int count = ld_simulation_tube_modes(simulation, mode, 40);
    assert_int_equal(count, 12);
    const ld_section *tube = &model.tubes.section[0];
    double L = model.tubes.length, rate = sqrt(tube->bending_stiffness / tube->mass_per_length);
    for (int k = 0; k < 4; k++) {
        double expected = lambda[k] * lambda[k] / (L * L) * rate / (2 * 3.14159265358979323846);
        CHECK_BELOW("frequency, relative", mode[2 * k].frequency / expected - 1, 5e-6);
    }
    ld_simulation_free(simulation);
    reference_model_free(&model);
}

// Lowest frequency [Hz] of a tube on springs whose slopes two stations hold, rigidly or by springs.
static double held_slopes(bool rigid)
{
    ld_model model;
    ld_simulation *simulation;
    ld_error error;
    ld_mode mode[2];
    reference_model(&model);
    for (int k = 0; k < 2; k++) {
        ld_support *support = &model.tubes.support[k];
        support->at = k ? 1.8 : 0.35;
        support->clamped = rigid ? 1u << LD_CLAMP_YAW | 1u << LD_CLAMP_PITCH : 0;
        support->rotational_stiffness[1] = support->rotational_stiffness[2] = 1e10;
    }
    if (ld_simulation_create(&model, &simulation, &error))
        fail_msg("%s", error.text);
    assert_int_equal(ld_simulation_tube_modes(simulation, mode, 2), 2);
    ld_simulation_free(simulation);
    reference_model_free(&model);
    return mode[0].frequency;
}

// Of two slopes the rigid tube follows one: the other takes a mode that bears it.
static void two_slopes(void **state)
{
    (void)state;
    CHECK_BELOW("frequency against stiff springs, relative",
                held_slopes(true) / held_slopes(false) - 1, 1e-3);
}

// A launch on a wall and a pin; k: springs in their place [N/m], 0: rigid.
static ld_summary launch(double k, ld_base_kind base)
{
    ld_model model;
    reference_model(&model);
    model.run.tolerance = 1e-7;
    model.base.kind = base;
    model.base.heave = (ld_sines){1, {{0.05, 1.5, 1}}};
    model.base.pitch = (ld_sines){1, {{0.03, 1, 0.4}}};
    model.base.roll = (ld_sines){1, {{0.05, 0.7, 2}}};
    for (int i = 0; i < 2; i++) {
        ld_support *support = &model.tubes.support[i];
        *support = (ld_support){.at = support->at, .clamped = k > 0 ? 0 : i ? pin : all};
        for (int a = 0; a < 3; a++) {
            support->stiffness[a] = i == 0 || a > 0 ? k : 0;
            support->rotational_stiffness[a] = i == 0 ? k : 0;
            support->damping[a] = k > 0 ? 2e4 : 0;
        }
    }
    ld_summary summary = summary_of_run(&model);
    reference_model_free(&model);
    return summary;
}

static void limit_of_springs(void **state)
{
    (void)state;
    ld_summary rigid = launch(0, LD_BASE_FIXED);
    double off[2];
    for (int i = 0; i < 2; i++) {
        ld_summary on = launch(i ? 1e9 : 1e8, LD_BASE_FIXED);
        off[i] = fabs(on.rocket[0].pitch_rate - rigid.rocket[0].pitch_rate);
        printf("  springs of %g N/m: %lld steps, rigid %lld\n", i ? 1e9 : 1e8,
               (long long)on.statistics.steps, (long long)rigid.statistics.steps);
    }
    CHECK_BELOW("pitch rate on springs of 1e8 N/m off the rigid one's [rad/s]", off[0], 5e-2);
    CHECK_BELOW("on springs of 1e9 N/m", off[1], 5e-3);
}

static void balances_on_a_moving_base(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        ld_summary on = launch(0, i ? LD_BASE_PRESCRIBED : LD_BASE_FIXED);
        CHECK_BELOW(i ? "balance, base that moves" : "balance, fixed base",
                    on.energy.residual_relative, 1e-8);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cantilever),
        cmocka_unit_test(two_slopes),
        cmocka_unit_test(limit_of_springs),
        cmocka_unit_test(balances_on_a_moving_base),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
