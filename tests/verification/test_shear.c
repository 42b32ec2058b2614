// Beams with shear deformation and rotary inertia (theory-tube.md) against Timoshenko's equations,
// integrated exactly along the beam, and against independent finite elements.
#include "launchdyn/mstmm.h"

#include <string.h>

#include "elements/tube/flexible_tube.h"
#include "model/model.h"
#include "support/check.h"
#include "support/frame_elements.h"
#include "support/recorded_run.h"
#include "support/reference_model.h"

static const double PI = 3.14159265358979323846;

// A thick rod of steel, 0.1 m wide and 0.6 m long.
static const double length = 0.6, radius = 0.05, shear_coefficient = 0.886;
static const double modulus = 210e9, shear_modulus = 80.8e9, density = 7850;

static ld_section rod(void)
{
    double area = PI * radius * radius, I = 0.25 * area * radius * radius;
    return (ld_section){.mass_per_length = density * area,
                        .axial_stiffness = modulus * area,
                        .bending_stiffness = modulus * I,
                        .torsion_stiffness = 2 * shear_modulus * I,
                        .polar_inertia = 2 * density * I};
}

// One that is stiffer across z.
static ld_section flat(void)
{
    ld_section s = rod();
    s.form = LD_SECTION_PLANES;
    s.bending_stiffness_y = 1.6 * s.bending_stiffness;
    s.bending_stiffness_z = 0.4 * s.bending_stiffness;
    return s;
}

enum { MODES = 4, MOST = 64 };

// Timoshenko's equations for harmonic motion at omega over the whole beam, state (w, phi, M, V):
// w' = phi + V/kGA, phi' = M/EI, M' = -V - rho I omega^2 phi, V' = -mu omega^2 w; the matrix
// exponential by its series after halving.
static void transfer(double omega, double to[4][4])
{
    const ld_section s = rod();
    double kGA = shear_coefficient * shear_modulus * PI * radius * radius;
    double square = omega * omega, h = length / 1024;
    const double A[4][4] = {{0, h, 0, h / kGA},
                            {0, 0, h / s.bending_stiffness, 0},
                            {0, -0.5 * s.polar_inertia * square * h, 0, -h},
                            {-s.mass_per_length * square * h, 0, 0, 0}};
    double term[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}, next[4][4];
    memcpy(to, term, sizeof term);
    for (int order = 1; order < 12; order++) {
        memset(next, 0, sizeof next);
        for (int i = 0; i < 4; i++)
            for (int j = 0; j < 4; j++)
                for (int k = 0; k < 4; k++)
                    next[i][j] += term[i][k] * A[k][j] / order;
        memcpy(term, next, sizeof term);
        for (int i = 0; i < 4; i++)
            for (int j = 0; j < 4; j++)
                to[i][j] += term[i][j];
    }
    for (int pass = 0; pass < 10; pass++) {
        memset(next, 0, sizeof next);
        for (int i = 0; i < 4; i++)
            for (int j = 0; j < 4; j++)
                for (int k = 0; k < 4; k++)
                    next[i][j] += to[i][k] * to[k][j];
        memcpy(to, next, sizeof next);
    }
}

// Vanishes at natural frequencies: M = V = 0 at the far end, the near one clamped or free.
static double residual(double omega, bool clamped)
{
    double T[4][4];
    transfer(omega, T);
    int first = clamped ? 2 : 0, second = first + 1;
    return T[2][first] * T[3][second] - T[2][second] * T[3][first];
}

static void exact_frequencies(bool clamped, int count, double *omega)
{
    const double step = 50;
    int found = 0;
    for (double at = 200; found < count; at += step) {
        double low = at, high = at + step, left = residual(low, clamped);
        if (left * residual(high, clamped) > 0)
            continue;
        for (int i = 0; i < 80; i++) {
            double middle = 0.5 * (low + high);
            if (left * residual(middle, clamped) > 0)
                low = middle;
            else
                high = middle;
        }
        omega[found++] = low;
    }
}

static int elements = 80;

static ld_mstmm *build_of(const ld_section *section, ld_hinge hinge, ld_mode_span span, int modes,
                          double coefficient)
{
    const ld_mstmm_beam beam = {.length = length,
                                .section_count = 1,
                                .section = section,
                                .bending = modes,
                                .elements = elements,
                                .span = span,
                                .shear_coefficient = coefficient};
    const ld_mstmm_element e = {.name = "rod", .hinge = hinge, .beam = &beam};
    const double gravity[3] = {0, 0, 0};
    ld_mstmm *system;
    ld_error error = {0};
    if (ld_mstmm_create(&e, 1, gravity, &system, &error))
        fail_msg("%s", error.text);
    return system;
}

static ld_mstmm *build(ld_hinge hinge, ld_mode_span span, int modes, double coefficient)
{
    const ld_section section = rod();
    return build_of(&section, hinge, span, modes, coefficient);
}

// The lowest frequencies [rad/s] other than 0 of both planes.
static void all_frequencies(ld_mstmm *system, int count, double *omega)
{
    ld_mstmm_mode mode[MOST];
    double q[MOST];
    int all, found = 0;
    ld_mstmm_reference(system, q);
    assert_int_equal(ld_mstmm_vibration(system, q, NULL, mode, NULL, &all, NULL), LD_OK);
    for (int i = 0; i < all && found < count; i++)
        if (mode[i].frequency > 1)
            omega[found++] = 2 * PI * mode[i].frequency;
    assert_int_equal(found, count);
    ld_mstmm_free(system);
}

// Each once, of planes alike.
static void frequencies(ld_mstmm *system, int count, double *omega)
{
    double all[MOST];
    all_frequencies(system, 2 * count, all);
    for (int i = 0; i < count; i++)
        omega[i] = all[2 * i];
}

// All lowest frequencies, of both planes.
static void element_frequencies(const ld_section *given, bool clamped, int count, double *omega)
{
    const double E[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, origin[3] = {0};
    const ld_section s = *given;
    bool planes = s.form == LD_SECTION_PLANES;
    double kGA = shear_coefficient * shear_modulus * PI * radius * radius, all[MOST];
    double y = planes ? s.bending_stiffness_y : s.bending_stiffness;
    double z = planes ? s.bending_stiffness_z : s.bending_stiffness;
    const frame_section section = {.EA = 30 * s.axial_stiffness,
                                   .EI_y = y,
                                   .EI_z = z,
                                   .GJ = 30 * s.torsion_stiffness,
                                   .mass = s.mass_per_length,
                                   .polar = s.polar_inertia,
                                   .kGA_y = kGA,
                                   .kGA_z = kGA,
                                   .rotary_y = y / (y + z) * s.polar_inertia,
                                   .rotary_z = z / (y + z) * s.polar_inertia};
    frame fe;
    frame_create(&fe);
    int first = frame_beam(&fe, origin, E, length, 80, &section);
    if (clamped)
        frame_clamp(&fe, first);
    frame_frequencies(&fe, false, count + (clamped ? 0 : 6), all);
    memcpy(omega, all + (clamped ? 0 : 6), (size_t)count * sizeof *omega);
    frame_free(&fe);
}

// Errors of second order in the element size are taken out by halving.
static void check_frequencies(const char *name, bool clamped)
{
    double exact[MODES], thin[MODES], coarse[MODES], fine[MODES], of_frame[2 * MODES];
    double worst = 0, worst_fe = 0, rest = 0;
    ld_hinge hinge = clamped ? LD_HINGE_WELD : LD_HINGE_FREE;
    ld_mode_span span = clamped ? LD_SPAN_CLAMPED : LD_SPAN_FREE_FREE;
    exact_frequencies(clamped, MODES, exact);
    const ld_section section = rod();
    element_frequencies(&section, clamped, 2 * MODES, of_frame);
    frequencies(build(hinge, span, MODES, 0), MODES, thin);
    frequencies(build(hinge, span, MODES, shear_coefficient), MODES, coarse);
    elements = 160;
    frequencies(build(hinge, span, MODES, shear_coefficient), MODES, fine);
    elements = 80;
    for (int i = 0; i < MODES; i++) {
        double error[2] = {coarse[i] / exact[i] - 1, fine[i] / exact[i] - 1};
        printf("  %s %d: %.4f Hz, %.3f times that without shear\n", name, i + 1,
               exact[i] / (2 * PI), exact[i] / thin[i]);
        CHECK_WITHIN("order in the element size", log2(error[0] / error[1]), 1.95, 2.05);
        worst = fmax(worst, fabs(error[0]));
        rest = fmax(rest, fabs(4 * error[1] - error[0]) / 3);
        worst_fe = fmax(worst_fe, fabs(coarse[i] / of_frame[2 * i] - 1));
    }
    CHECK_BELOW("80 elements against Timoshenko's equations, relative", worst, 6e-4);
    CHECK_BELOW("extrapolated from 80 and 160", rest, 8e-8);
    CHECK_BELOW("80 against independent finite elements, relative", worst_fe, 5e-8);
    CHECK_BELOW("the fourth is lower by shear and rotary inertia", exact[3] / thin[3], 0.75);
}

static void test_frequencies(void **state)
{
    (void)state;
    check_frequencies("clamped", true);
    check_frequencies("free", false);
}

// Planes that differ, against independent finite elements.
static void test_planes(void **state)
{
    (void)state;
    const ld_section section = flat();
    double expected[5], found[5], worst = 0;
    for (int free = 0; free < 2; free++) {
        element_frequencies(&section, !free, 5, expected);
        all_frequencies(build_of(&section, free ? LD_HINGE_FREE : LD_HINGE_WELD,
                                 free ? LD_SPAN_FREE_FREE : LD_SPAN_CLAMPED, 5, shear_coefficient),
                        5, found);
        for (int i = 0; i < 5; i++)
            worst = fmax(worst, fabs(found[i] / expected[i] - 1));
    }
    CHECK_BELOW("planes that differ against finite elements, relative", worst, 5e-8);
}

// The integrals of x b over the mass and of the section's turn over rotary inertia, which modes
// know by their sum alone, by Gauss's rule in each element.
static void test_integrals(void **state)
{
    (void)state;
    static const double at[3] = {-0.7745966692414833770, 0, 0.7745966692414833770};
    static const double weight[3] = {5.0 / 9, 8.0 / 9, 5.0 / 9};
    static ld_tubes model;
    flexible_tube tube;
    model.length = length;
    model.section_count = 1;
    model.section[0] = flat();
    model.modes = (ld_modes){
        .bending = 4, .elements = 6, .span = LD_SPAN_CLAMPED, .shear_coefficient = 0.886};
    assert_int_equal(flexible_tube_build(&tube, &model, NULL), LD_OK);
    double worst = 0;
    for (int plane = PLANE_Y; plane <= PLANE_Z; plane++)
        for (int k = 0; k < tube.nb; k++) {
            double c = 0, turn = 0, rotary = model.section[0].polar_inertia * (plane ? 0.8 : 0.2);
            for (int e = 0; e < tube.element_count; e++)
                for (int p = 0; p < 3; p++) {
                    const tube_element *element = &tube.element[e];
                    double h = element->x1 - element->x0, xi = 0.5 * h * (1 + at[p]);
                    double dx = 0.5 * h * weight[p], b[4];
                    for (int i = 0; i < 4; i++)
                        b[i] = element->b[plane][i][k];
                    c += dx * model.section[0].mass_per_length * (element->x0 + xi) *
                         (b[0] + xi * (b[1] + xi * (b[2] + xi * b[3])));
                    turn +=
                        dx * rotary *
                        (b[1] + xi * (2 * b[2] + xi * 3 * b[3]) - tube.shear->strain[e][plane][k]);
                }
            worst = fmax(worst, fabs(c - tube.c[plane][k]));
            worst = fmax(worst, fabs(turn - tube.shear->turn[plane][k]));
        }
    CHECK_BELOW("moments of mass and rotary inertia [kg^1/2 m]", worst, 1e-12);
    flexible_tube_free(&tube);
}

// A free rod with clamped shapes, whose sections and frame turn against each other.
static void test_shapes_of_another_span(void **state)
{
    (void)state;
    double exact[2], found[2], coarse[2];
    exact_frequencies(false, 2, exact);
    frequencies(build(LD_HINGE_FREE, LD_SPAN_CLAMPED, 6, shear_coefficient), 2, coarse);
    frequencies(build(LD_HINGE_FREE, LD_SPAN_CLAMPED, 12, shear_coefficient), 2, found);
    CHECK_BELOW("free rod, 12 clamped shapes: first frequency", found[0] / exact[0] - 1, 1e-4);
    CHECK_BELOW("second", found[1] / exact[1] - 1, 1e-3);
    CHECK_WITHIN("error of the second with 6 shapes over that with 12",
                 (coarse[1] / exact[1] - 1) / (found[1] / exact[1] - 1), 3, 12);
}

// A force at the tip: F L^3/(3 E I) + F L/(k G A), and the turn F L^2/(2 E I) of the section.
static void test_deflection(void **state)
{
    (void)state;
    const ld_section s = rod();
    const double tip[3] = {length, 0, 0}, force = 1, zero[MOST] = {0};
    double kGA = shear_coefficient * shear_modulus * PI * radius * radius, error[2], turned = 0;
    double exact = force * (pow(length, 3) / (3 * s.bending_stiffness) + length / kGA);
    for (int pass = 0; pass < 2; pass++) {
        int modes = pass ? 24 : 12;
        ld_mstmm *system = build(LD_HINGE_WELD, LD_SPAN_CLAMPED, modes, shear_coefficient);
        // unit modal mass: a coordinate is what the force does on its shape over omega^2
        double q[MOST] = {0}, needed[MOST], at_rest[MOST];
        ld_mstmm_forces(system, q, zero, zero, NULL, at_rest);
        double deflection = 0, turn = 0;
        for (int j = 0; j < modes; j++) {
            q[j] = 1e-6;
            ld_mstmm_point point = ld_mstmm_locate(system, q, zero, 0, tip);
            ld_mstmm_forces(system, q, zero, zero, NULL, needed);
            q[j] = 0;
            double shape = point.position[1] / 1e-6, square = (needed[j] - at_rest[j]) / 1e-6;
            deflection += force * shape * shape / square;
            turn += force * shape / square * 2 * point.attitude[3] / 1e-6;
        }
        error[pass] = deflection / exact - 1;
        turned = turn / (force * length * length / (2 * s.bending_stiffness)) - 1;
        ld_mstmm_free(system);
    }
    printf("  shear is %.3f of the deflection, off by %.2e with 12 modes, %.2e with 24\n",
           force * length / kGA / exact, error[0], error[1]);
    CHECK_WITHIN("error with 12 modes over that with 24", error[0] / error[1], 1.5, 2);
    CHECK_BELOW("tip's deflection with 24 modes, relative", -error[1], 2e-4);
    CHECK_BELOW("tip's turn, relative", turned, 1e-3);
}

// With the static shapes of tip loads among four, the same is exact but for the turn of the frame.
static void test_tip_loaded_shapes(void **state)
{
    (void)state;
    const ld_section s = rod();
    const double tip[3] = {length, 0, 0}, zero[MOST] = {0};
    double kGA = shear_coefficient * shear_modulus * PI * radius * radius;
    double by_force = pow(length, 3) / (3 * s.bending_stiffness) + length / kGA;
    double by_moment = length / s.bending_stiffness, deflection = 0, turn = 0;
    ld_mstmm *system = build(LD_HINGE_WELD, LD_SPAN_TIP_LOADED, 4, shear_coefficient);
    double q[MOST] = {0}, needed[MOST], at_rest[MOST];
    ld_mstmm_forces(system, q, zero, zero, NULL, at_rest);
    for (int j = 0; j < 4; j++) {
        q[j] = 1e-6;
        ld_mstmm_point point = ld_mstmm_locate(system, q, zero, 0, tip);
        ld_mstmm_forces(system, q, zero, zero, NULL, needed);
        q[j] = 0;
        double shape = point.position[1] / 1e-6, slope = 2 * point.attitude[3] / 1e-6;
        double square = (needed[j] - at_rest[j]) / 1e-6;
        deflection += shape * shape / square;
        turn += slope * slope / square;
    }
    CHECK_BELOW("tip's deflection by a force, relative", deflection / by_force - 1, 1e-8);
    CHECK_BELOW("tip's turn by a moment, relative", turn / by_moment - 1, 1e-8);
    ld_mstmm_free(system);
}

// ---- the launching tube

// Lowest frequencies [rad/s] in the vertical plane of a rod as a tube that its rear end holds.
static void tube_frequencies(int mesh, int count, double *omega)
{
    ld_model model;
    ld_simulation *simulation;
    ld_error error;
    ld_mode mode[4 * MODES];
    reference_model(&model);
    ld_tubes *tubes = &model.tubes;
    tubes->length = length;
    tubes->section[0] = rod();
    tubes->tail = (ld_tail){0};
    tubes->modes = (ld_modes){.bending = 8,
                              .elements = mesh,
                              .span = LD_SPAN_CLAMPED,
                              .shear_coefficient = shear_coefficient};
    tubes->support_count = 1;
    tubes->support[0] = (ld_support){.clamped = 0x3f, .stiffness = {NAN, NAN, NAN}};
    if (ld_simulation_create(&model, &simulation, &error))
        fail_msg("%s", error.text);
    assert_int_equal(ld_simulation_tube_modes(simulation, mode, 4 * MODES), 4 * MODES);
    for (int k = 0; k < count; k++)
        omega[k] = 2 * PI * mode[2 * k].frequency; // planes alike: every frequency twice
    ld_simulation_free(simulation);
    reference_model_free(&model);
}

static void test_tube_frequencies(void **state)
{
    (void)state;
    double exact[MODES], coarse[MODES], fine[MODES];
    exact_frequencies(true, MODES, exact);
    tube_frequencies(80, MODES, coarse);
    tube_frequencies(160, MODES, fine);
    for (int k = 0; k < MODES; k++) {
        double found = fine[k] + (fine[k] - coarse[k]) / 3;
        printf("  %d: %.3f rad/s, 80 elements off by %.1e\n", k + 1, exact[k],
               coarse[k] / exact[k] - 1);
        CHECK_BELOW("frequency of the tube, extrapolated in h, relative", found / exact[k] - 1,
                    1e-8);
    }
}

// A launch from a tube that is soft in shear, with all that bends it.
static void test_tube_launch(void **state)
{
    (void)state;
    double rate[2];
    for (int k = 0; k < 2; k++) {
        ld_model model;
        reference_model(&model);
        model.run.tolerance = 1e-8;
        model.tubes.modes.shear_coefficient = k ? 0.02 : 0.53;
        model.tubes.modes.geometric_stiffness = LD_GEOMETRIC_YES;
        ld_summary summary = summary_of_run(&model);
        rate[k] = summary.rocket[0].pitch_rate;
        CHECK_BELOW("energy residual over the largest work", summary.energy.residual_relative,
                    1e-9);
        reference_model_free(&model);
    }
    printf("  exit pitch rate %.6f rad/s, soft in shear %.6f\n", rate[0], rate[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_frequencies),      cmocka_unit_test(test_planes),
        cmocka_unit_test(test_integrals),        cmocka_unit_test(test_shapes_of_another_span),
        cmocka_unit_test(test_deflection),       cmocka_unit_test(test_tip_loaded_shapes),
        cmocka_unit_test(test_tube_frequencies), cmocka_unit_test(test_tube_launch),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
