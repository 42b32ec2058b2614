// Two beams on two revolutes driven through a large angle, against the same beams cut into rigid
// pieces with springs: the pieces converge to the beams with the second order of their length.
// ctest: slow
#include "launchdyn/mstmm.h"

#include <stdbool.h>
#include <string.h>

#include "support/check.h"

enum { MOST = 64 };

static const double length = 1, line_mass = 1, end = 0.4;
static double stiffness; // E I [N m2]
static int geometric;
static const double gravity[3] = {0, 0, 0};

static ld_mstmm_element element[2 * MOST];
static char name[2 * MOST][16];

static ld_mstmm *create(int count)
{
    ld_mstmm *system = NULL;
    ld_error error = {0};
    if (ld_mstmm_create(element, count, gravity, &system, &error))
        fail_msg("%s", error.text);
    return system;
}

// A torque at the first hinge that grows smoothly, so that it bends the beams without ringing them.
static void drive(double t, const double *q, const double *u, double *tau, double *wrench,
                  void *context)
{
    (void)q, (void)u, (void)wrench, (void)context;
    tau[0] = 15 * sin(M_PI * t / 0.6) * sin(M_PI * t / 0.6);
}

// Tip of the last element after a motion from rest with the elbow bent.
static void tip_at_end(ld_mstmm *system, int elbow, int last, const double at[3], double tip[3])
{
    double q[256] = {0}, u[256] = {0};
    ld_error error = {0};
    ld_mstmm_settings settings = {.rtol = 1e-8, .atol = 1e-10, .drive = drive};
    q[ld_mstmm_coordinate_offset(system, elbow)] = -0.5;
    if (ld_mstmm_integrate(system, &settings, 0, end, q, u, NULL, &error))
        fail_msg("%s", error.text);
    ld_mstmm_point p = ld_mstmm_locate(system, q, u, last, at);
    memcpy(tip, p.position, sizeof p.position);
    ld_mstmm_free(system);
}

static void beams(double tip[3])
{
    const ld_section section = {.mass_per_length = line_mass,
                                .axial_stiffness = 1e8,
                                .bending_stiffness = stiffness,
                                .torsion_stiffness = stiffness,
                                .polar_inertia = 1e-4};
    const ld_mstmm_beam beam = {.length = length,
                                .section_count = 1,
                                .section = &section,
                                .bending = 6,
                                .elements = 60,
                                .geometric_stiffness = geometric};
    const double at[3] = {length, 0, 0};
    for (int i = 0; i < 2; i++)
        element[i] = (ld_mstmm_element){.name = i ? "lower" : "upper",
                                        .parent = i ? "upper" : NULL,
                                        .at = {i ? length : 0, 0, 0},
                                        .hinge = LD_HINGE_REVOLUTE,
                                        .axis = {0, 0, 1},
                                        .beam = &beam};
    tip_at_end(create(2), 1, 1, at, tip);
}

static void pieces(int count, double tip[3])
{
    double h = length / count, m = line_mass * h;
    const double at[3] = {h, 0, 0};
    for (int i = 0; i < 2 * count; i++) {
        snprintf(name[i], sizeof name[i], "%d", i);
        bool hinge = i % count == 0;
        element[i] = (ld_mstmm_element){.name = name[i],
                                        .parent = i ? name[i - 1] : NULL,
                                        .at = {i ? h : 0, 0, 0},
                                        .hinge = LD_HINGE_REVOLUTE,
                                        .axis = {0, 0, 1},
                                        .stiffness = {hinge ? 0 : stiffness / h},
                                        .mass = m,
                                        .center = {h / 2, 0, 0},
                                        .inertia = {0, m * h * h / 12, m * h * h / 12}};
    }
    tip_at_end(create(2 * count), count, 2 * count - 1, at, tip);
}

// Difference of the limit of the pieces (extrapolated with order 2 from 8 and 16) from the beams
// over what the flexing does to the tip; the order between 4, 8 and 16 pieces.
static double difference(double bending_stiffness, double *order)
{
    double beam[3], rigid[3], tip[3][3], step[2] = {0}, off = 0, flexed;
    stiffness = bending_stiffness;
    beams(beam);
    pieces(1, rigid);
    flexed = hypot(rigid[0] - beam[0], rigid[1] - beam[1]);
    printf("    EI = %.0f N m2: tip at %.1f s (%.6f, %.6f) m, the flexing moves it by %.3e m\n",
           stiffness, end, beam[0], beam[1], flexed);
    for (int k = 0; k < 3; k++) {
        pieces(4 << k, tip[k]);
        printf("    %2d pieces a beam: off by %.2e of the flexing\n", 4 << k,
               hypot(tip[k][0] - beam[0], tip[k][1] - beam[1]) / flexed);
    }
    for (int j = 0; j < 2; j++) {
        double limit = tip[2][j] + (tip[2][j] - tip[1][j]) / 3;
        off = hypot(off, limit - beam[j]);
        for (int k = 0; k < 2; k++)
            step[k] = hypot(step[k], tip[k + 1][j] - tip[k][j]);
    }
    *order = log2(step[0] / step[1]);
    return off / flexed;
}

// What is left in the limit is the geometric stiffness that the beams' linear deformation leaves
// out (formulation.md, section 1): of second order in the deformation, so its share falls as 1/EI.
static void test_pieces_converge_to_the_beams(void **state)
{
    (void)state;
    double order[2], soft = difference(4000, &order[0]), stiff = difference(16000, &order[1]);
    CHECK_WITHIN("order of the pieces in their length", order[0], 1.9, 2.2);
    CHECK_WITHIN("the same with stiffer beams", order[1], 1.9, 2.2);
    CHECK_BELOW("limit of the pieces against the beams, over the flexing", stiff, 5e-3);
    CHECK_WITHIN("its order in 1/EI", log(soft / stiff) / log(4), 0.8, 1.2);
}

// With it the limit is that of the beams, also of soft ones; the extrapolation is off by 1e-3.
static void test_pieces_converge_with_geometric_stiffness(void **state)
{
    (void)state;
    double order, without = difference(500, &order);
    geometric = 1;
    double soft = difference(500, &order), stiff = difference(4000, &order);
    geometric = 0;
    CHECK_WITHIN("soft beams without it, over the flexing", without, 0.13, 0.17);
    CHECK_BELOW("soft beams with it", soft, 2e-3);
    CHECK_BELOW("stiffer beams with it", stiff, 2e-3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pieces_converge_to_the_beams),
        cmocka_unit_test(test_pieces_converge_with_geometric_stiffness),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
