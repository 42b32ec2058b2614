// The overall transfer equations in both forms, with applied wrenches, against the reduced sweep,
// and how the paper's form loses digits with the length of a chain.
#include "launchdyn/mstmm.h"

#include <string.h>

#include "support/check.h"
#include "support/draw.h"
#include "support/multibody_case.h"

enum { MOST = 128 };

static ld_mstmm_element element[MOST];
static char name[MOST][16];
static double q[7 * MOST], u[6 * MOST], tau[6 * MOST], wrench[6 * MOST];

// Wrenches of their own sequence on n bodies.
static void draw_wrench(int n)
{
    static uint64_t seed = 8;
    for (int i = 0; i < 6 * n; i++)
        wrench[i] = draw(&seed);
}

// A system of n bodies; parent of body i by `next`: a chain or a random tree.
static ld_mstmm *draw_system(int n, int tree, int all_hinges, uint64_t *seed)
{
    const double gravity[3] = {0, 0, -9.81};
    ld_mstmm *system = NULL;
    ld_error error = {0};
    memset(element, 0, sizeof element);
    for (int i = 0; i < n; i++) {
        ld_mstmm_element *e = &element[i];
        snprintf(name[i], sizeof name[i], "b%d", i);
        int parent = tree ? (int)((draw(seed) + 1) / 2 * i) : i - 1;
        e->name = name[i];
        e->parent = i && parent >= 0 ? name[parent] : NULL;
        e->hinge = all_hinges ? (ld_hinge)((draw(seed) + 1) / 2 * 7) : LD_HINGE_REVOLUTE;
        v3_store(e->at, v3_add(v3_make(i ? 0.25 : 0, 0, 0), draw_v3(seed, 0.05)));
        v3_store(e->axis, v3_add(v3_make(0, i % 2, (i + 1) % 2), draw_v3(seed, 0.3)));
        v3_store(e->axis_2, draw_v3(seed, 1));
        v3_store(e->center, v3_add(v3_make(0.12, 0, 0), draw_v3(seed, 0.02)));
        e->mass = 1.3 + 0.3 * draw(seed);
        double six[6] = {0.0021, 0.0058, 0.0062, 0.0002, -0.0001, 0.00015};
        memcpy(e->inertia, six, sizeof six);
    }
    if (ld_mstmm_create(element, n, gravity, &system, &error))
        fail_msg("%s", error.text);
    for (int i = 0; i < ld_mstmm_coordinate_count(system); i++)
        q[i] = draw(seed) + 0.01;
    for (int i = 0; i < ld_mstmm_speed_count(system); i++) {
        u[i] = draw(seed);
        tau[i] = draw(seed);
    }
    draw_wrench(n);
    return system;
}

// Largest difference from the reduced sweep over the largest acceleration; 1 or more: no digits.
static double difference(ld_mstmm *system, ld_mstmm_form form, ld_mstmm_overall *report)
{
    double reduced[6 * MOST], overall[6 * MOST], off = 0, size = 1e-3;
    ld_error error = {0};
    assert_int_equal(ld_mstmm_accelerations(system, q, u, tau, wrench, reduced, &error), LD_OK);
    ld_status status =
        ld_mstmm_accelerations_overall(system, form, q, u, tau, wrench, overall, report, &error);
    if (status == LD_ERR_NUMERIC)
        return 1;
    if (status)
        fail_msg("%s", error.text);
    for (int i = 0; i < ld_mstmm_speed_count(system); i++) {
        size = fmax(size, fabs(reduced[i]));
        off = fmax(off, fabs(reduced[i] - overall[i]));
    }
    return off / size;
}

static void test_small_trees_agree(void **state)
{
    (void)state;
    uint64_t seed = 3;
    double paper = 0, hinges = 0;
    int refused = 0;
    ld_mstmm_overall report;
    for (int i = 0; i < 200; i++) {
        ld_mstmm *system = draw_system(2 + i % 4, i % 2, 1, &seed);
        hinges = fmax(hinges, difference(system, LD_MSTMM_HINGES, &report));
        double off = difference(system, LD_MSTMM_PAPER, &report);
        if (off < 1 && !report.warning[0])
            paper = fmax(paper, off);
        else
            refused++;
        ld_mstmm_free(system);
    }
    CHECK_BELOW("trees to 5 bodies, all hinges: accelerations as unknowns", hinges, 2e-12);
    CHECK_BELOW("trees to 5 bodies, paper's form where not warned of", paper, 1e-9);
    CHECK_WITHIN("share of them refused or with a warning", refused / 200.0, 0.01, 0.2);
}

static void test_digits_lost_with_length(void **state)
{
    (void)state;
    const int lengths[] = {3, 5, 8, 12, 16, 20, 30, 60, 100};
    printf(
        "    bodies   paper's form   accelerations kept   (differences from the reduced sweep)\n");
    double kept_at_100 = 0, paper_at_20 = 0;
    for (size_t k = 0; k < sizeof lengths / sizeof *lengths; k++) {
        uint64_t seed = 17;
        double paper = 0, kept = 0;
        ld_mstmm_overall report = {0}, warned = {0};
        for (int sample = 0; sample < 5; sample++) {
            ld_mstmm *system = draw_system(lengths[k], 0, 0, &seed);
            kept = fmax(kept, difference(system, LD_MSTMM_HINGES, &report));
            assert_int_equal(report.order, lengths[k] + 6);
            double off = difference(system, LD_MSTMM_PAPER, &report);
            if (off < 1) {
                assert_int_equal(report.order, 7);
                assert_true((report.loss > 1e-9) == (report.warning[0] != 0));
                warned = report.warning[0] ? report : warned;
            }
            paper = fmax(paper, off);
            ld_mstmm_free(system);
        }
        printf("    %6d   %12.1e   %18.1e   %s\n", lengths[k], paper, kept, warned.warning);
        kept_at_100 = lengths[k] == 100 ? kept : kept_at_100;
        paper_at_20 = lengths[k] == 20 ? paper : paper_at_20;
    }
    CHECK_BELOW("100 bodies, accelerations kept as unknowns", kept_at_100, 1e-10);
    assert_true(paper_at_20 == 1); // refused: no digits left
}

// The reference cases: the vehicle is a tree, the chains serial.
static void test_reference_cases(void **state)
{
    (void)state;
    static multibody_case c;
    const char *const names[] = {"chain3", "chain10", "vehicle"};
    for (int i = 0; i < 3; i++) {
        ld_mstmm *system;
        double u_dot[CASE_VALUES], off = 0, size = 0;
        ld_error error = {0};
        assert_int_equal(read_multibody_case(names[i], &c), 0);
        assert_int_equal(ld_mstmm_create(c.element, c.count, c.gravity, &system, &error), LD_OK);
        if (ld_mstmm_accelerations_overall(system, LD_MSTMM_HINGES, c.q, c.u, c.tau, NULL, u_dot,
                                           NULL, &error))
            fail_msg("%s", error.text);
        for (int k = 0; k < ld_mstmm_speed_count(system); k++) {
            off = fmax(off, fabs(u_dot[k] - c.u_dot[k]));
            size = fmax(size, fabs(c.u_dot[k]));
        }
        CHECK_BELOW(names[i], off / size, 1e-13);
        ld_mstmm_free(system);
    }
}

// A beam between two revolutes with a body at its end, and a beam as a tip.
static void test_beams_agree(void **state)
{
    (void)state;
    const ld_section section = {.mass_per_length = 2,
                                .axial_stiffness = 1e6,
                                .bending_stiffness = 50,
                                .torsion_stiffness = 40,
                                .polar_inertia = 1e-3};
    const ld_mstmm_beam beam = {.length = 0.8,
                                .section_count = 1,
                                .section = &section,
                                .bending = 2,
                                .torsion = 1,
                                .damping = 0.01};
    const double gravity[3] = {0, 0, -9.81};
    ld_mstmm_element two[] = {
        {.name = "arm", .hinge = LD_HINGE_REVOLUTE, .axis = {0, 1, 0.2}, .beam = &beam},
        {.name = "hand",
         .parent = "arm",
         .at = {0.8, 0.02, 0},
         .hinge = LD_HINGE_REVOLUTE,
         .axis = {0.1, 0, 1},
         .mass = 1,
         .center = {0.1, 0, 0.02},
         .inertia = {0.01, 0.02, 0.02}},
        {.name = "whip",
         .parent = "hand",
         .at = {0.2, 0, 0},
         .hinge = LD_HINGE_SPHERICAL,
         .beam = &beam},
    };
    ld_mstmm *system;
    ld_error error = {0};
    uint64_t seed = 4;
    if (ld_mstmm_create(two, 3, gravity, &system, &error))
        fail_msg("%s", error.text);
    double worst = 0, back = 0, paper = 0;
    ld_mstmm_overall report;
    for (int sample = 0; sample < 50; sample++) {
        int n = ld_mstmm_speed_count(system);
        double u_dot[64], forces[64];
        ld_mstmm_reference(system, q);
        for (int i = 0; i < ld_mstmm_coordinate_count(system); i++)
            q[i] += (i == 0 || i == 6 || (i > 6 && i < 11) ? 1 : 0.02) * draw(&seed);
        for (int i = 0; i < n; i++) {
            u[i] = draw(&seed);
            tau[i] = draw(&seed);
        }
        draw_wrench(3);
        worst = fmax(worst, difference(system, LD_MSTMM_HINGES, &report));
        paper = fmax(paper, difference(system, LD_MSTMM_PAPER, &report));
        assert_int_equal(ld_mstmm_accelerations(system, q, u, tau, NULL, u_dot, &error), LD_OK);
        ld_mstmm_forces(system, q, u, u_dot, NULL, forces);
        double size = 0, off = 0;
        for (int i = 0; i < n; i++) {
            off = fmax(off, fabs(forces[i] - tau[i]));
            size = fmax(size, fabs(u_dot[i]));
        }
        back = fmax(back, off / size);
    }
    CHECK_BELOW("beams: overall form against the reduced step", worst, 5e-12);
    CHECK_BELOW("beams: paper's form against the reduced step", paper, 1e-10);
    CHECK_BELOW("beams: inverse(forward), over the largest acceleration", back, 2e-14);
    ld_mstmm_free(system);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_small_trees_agree),
        cmocka_unit_test(test_digits_lost_with_length),
        cmocka_unit_test(test_reference_cases),
        cmocka_unit_test(test_beams_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
