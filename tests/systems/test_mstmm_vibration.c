// Natural frequencies against closed forms.
#include "launchdyn/mstmm.h"

#include <string.h>

#include "support/check.h"

static const double gravity[3] = {0, -9.81, 0};

static ld_mstmm *create(const ld_mstmm_element *elements, int count)
{
    ld_mstmm *system = NULL;
    ld_error error = {0};
    if (ld_mstmm_create(elements, count, gravity, &system, &error))
        fail_msg("%s", error.text);
    return system;
}

// Two point masses on massless rods, hanging: omega^2 = (2 -+ sqrt 2) g/l.
static void test_double_pendulum(void **state)
{
    (void)state;
    ld_mstmm_element e[2] = {{.name = "upper",
                              .hinge = LD_HINGE_REVOLUTE,
                              .axis = {0, 0, 1},
                              .mass = 1,
                              .center = {0, -1, 0}},
                             {.name = "lower",
                              .parent = "upper",
                              .at = {0, -1, 0},
                              .hinge = LD_HINGE_REVOLUTE,
                              .axis = {0, 0, 1},
                              .mass = 1,
                              .center = {0, -1, 0}}};
    ld_mstmm *system = create(e, 2);
    ld_mstmm_mode mode[2];
    ld_error error = {0};
    double q[2] = {0}, shape[2][4];
    int count;
    assert_int_equal(ld_mstmm_vibration(system, q, NULL, mode, &shape[0][0], &count, &error),
                     LD_OK);
    assert_int_equal(count, 2);
    for (int k = 0; k < 2; k++) {
        double omega = sqrt((2 + (k ? 1 : -1) * sqrt(2)) * 9.81);
        CHECK_BELOW("double pendulum: frequency, relative",
                    mode[k].frequency * 2 * M_PI / omega - 1, 1e-12);
        // absolute angles 1 : +-sqrt 2, the second hinge's is relative
        double ratio = shape[k][2] / shape[k][0];
        CHECK_BELOW("double pendulum: shape", ratio - ((k ? -1 : 1) * sqrt(2) - 1), 1e-13);
    }
    q[0] = 0.1;
    assert_int_equal(ld_mstmm_vibration(system, q, NULL, mode, NULL, &count, &error), LD_ERR_INPUT);
    assert_non_null(strstr(error.text, "not an equilibrium"));
    ld_mstmm_free(system);
}

// A body on a free hinge with springs and dampers in all six directions.
static void test_sprung_body(void **state)
{
    (void)state;
    ld_mstmm_element e = {.name = "body",
                          .hinge = LD_HINGE_FREE,
                          .stiffness = {100, 400, 900, 20, 50, 90},
                          .damping = {2, 8, 6, 0.2, 0.3, 0.4},
                          .mass = 4,
                          .inertia = {0.5, 0.6, 0.7}};
    ld_mstmm *system = create(&e, 1);
    double q[7] = {0, -4 * 9.81 / 400, 0, 1, 0, 0, 0}, worst = 0, worst_damping = 0;
    ld_mstmm_mode mode[6];
    ld_error error = {0};
    int count;
    if (ld_mstmm_vibration(system, q, NULL, mode, NULL, &count, &error))
        fail_msg("%s", error.text);
    assert_int_equal(count, 6);
    for (int k = 0; k < 6; k++) {
        double m = k < 3 ? e.mass : e.inertia[k - 3], omega = sqrt(e.stiffness[k] / m);
        double ratio = e.damping[k] / (2 * m * omega), nearest = 1, nearest_damping = 1;
        for (int j = 0; j < 6; j++)
            if (fabs(mode[j].frequency * 2 * M_PI / omega - 1) < nearest) {
                nearest = fabs(mode[j].frequency * 2 * M_PI / omega - 1);
                nearest_damping = fabs(mode[j].damping - ratio);
            }
        worst = fmax(worst, nearest);
        worst_damping = fmax(worst_damping, nearest_damping);
    }
    CHECK_BELOW("sprung body: frequencies, relative", worst, 5e-15);
    CHECK_BELOW("sprung body: damping ratios", worst_damping, 1e-15);
    ld_mstmm_free(system);
}

// Beams: clamped-free; pinned-pinned cannot be asked of a tree, so pinned-free (a hinge at its end,
// no gravity along it): tan = tanh, 3.92660231, 7.06858275, with a rigid turn at 0.
static void test_beams(void **state)
{
    (void)state;
    const ld_section section = {.mass_per_length = 2,
                                .axial_stiffness = 1e6,
                                .bending_stiffness = 50,
                                .torsion_stiffness = 40,
                                .polar_inertia = 1e-3};
    ld_mstmm_beam beam = {.length = 0.8, .section_count = 1, .section = &section, .bending = 8};
    ld_mstmm_element e = {.name = "beam", .hinge = LD_HINGE_WELD, .beam = &beam};
    const double none[3] = {0, 0, 0}, clamped[2] = {1.87510407, 4.69409113};
    const double pinned[2] = {3.92660231, 7.06858275};
    double unit = sqrt(50.0 / 2) / (0.8 * 0.8) / (2 * M_PI), q[32] = {0};
    ld_mstmm *system;
    ld_error error = {0};
    ld_mstmm_mode mode[32];
    int count;
    assert_int_equal(ld_mstmm_create(&e, 1, none, &system, &error), LD_OK);
    assert_int_equal(ld_mstmm_vibration(system, q, NULL, mode, NULL, &count, &error), LD_OK);
    assert_int_equal(count, 16);
    for (int k = 0; k < 2; k++)
        CHECK_BELOW("clamped beam: frequency, relative",
                    mode[2 * k].frequency / (unit * clamped[k] * clamped[k]) - 1, 1e-6);
    ld_mstmm_free(system);

    e.hinge = LD_HINGE_REVOLUTE;
    e.axis[2] = 1;
    assert_int_equal(ld_mstmm_create(&e, 1, none, &system, &error), LD_OK);
    assert_int_equal(ld_mstmm_vibration(system, q, NULL, mode, NULL, &count, &error), LD_OK);
    assert_int_equal(count, 17);
    CHECK_BELOW("pinned beam: its rigid turn [1/s]", hypot(mode[0].frequency, mode[0].rate), 1e-5);
    for (int k = 0; k < 2; k++) {
        double wanted = unit * pinned[k] * pinned[k], nearest = 1;
        for (int j = 0; j < count; j++)
            nearest = fmin(nearest, fabs(mode[j].frequency / wanted - 1));
        CHECK_BELOW("pinned beam: frequency, relative", nearest, k ? 1e-5 : 5e-7);
    }
    ld_mstmm_free(system);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_double_pendulum),
        cmocka_unit_test(test_sprung_body),
        cmocka_unit_test(test_beams),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
