// A mast that carries a flexible cradle that carries a tube by its supports, each on its own
// section, against independent finite elements: natural frequencies, with weight also the mast's
// geometric stiffness. A launch from such a cradle: its energy.
#include <stdio.h>
#include <string.h>

#include "model/model.h"
#include "scenario/scenario.h"
#include "state/simulation.h"
#include "support/check.h"
#include "support/frame_elements.h"
#include "support/recorded_run.h"

static const double PI = 3.14159265358979323846;

enum { MOST = 2 * LD_MAX_STATES, MAST = 25, CRADLE = 26, TUBE = 30 };

static const double mast_length = 2.5, cradle_length = 2.6, tube_length = 3, neck = 0.1, rear = 0.1;
static const double head_mass = 20, ballast_mass = 60;

// A launcher of which some numbers differ from case to case.
typedef struct launcher {
    double gravity, bending; // [m/s2], [N m2] of the mast
    double neck_y, rear_y;   // [m] cradle over the mast's head, tube over the cradle
    bool geometric;
} launcher;

static frame_section mast_section(const launcher *of)
{
    return (frame_section){2e8, of->bending, of->bending, 2e5, 9, 0.03, 0, 0, 0, 0};
}

static const frame_section cradle_section = {1e8, 4e5, 4e5, 0.8e5, 6, 0.02, 0, 0, 0, 0};

static frame_section tube_section_of(void)
{
    double inner = 0.0825, outer = 0.085, E = 210e9, nu = 0.3, rho = 7850;
    double A = PI * (outer * outer - inner * inner);
    double I = 0.25 * PI * (pow(outer, 4) - pow(inner, 4));
    return (frame_section){E * A, E * I, E * I, E / (1 + nu) * I, rho * A, 2 * rho * I, 0, 0, 0, 0};
}

static const double tail_mass = 8, tail_at = -0.1, support_at[2] = {0.4, 1.8};
static const double spring[2][2][3] = {{{2e6, 2e6, 2e6}, {2e4, 2e4, 2e4}},
                                       {{1e6, 3e6, 2e6}, {1e4, 2e4, 2e4}}};

// Where the ballast's weight balances that of cradle, tube and tail about the mast.
static double ballast_at(void)
{
    double cradle = cradle_section.mass * cradle_length,
           tube = tube_section_of().mass * tube_length;
    double moment = cradle * (neck + 0.5 * cradle_length) +
                    tube * (neck + rear + 0.5 * tube_length) + tail_mass * (neck + rear + tail_at);
    return -moment / ballast_mass;
}

static double carried_mass(void)
{
    return head_mass + ballast_mass + cradle_section.mass * cradle_length +
           tube_section_of().mass * tube_length + tail_mass;
}

// ---- the scenario

static const char *const text_of =
    "launchdyn: 1\n"
    "environment: {gravity: %.17g m/s2}\n"
    "base:\n"
    "  kind: multibody\n"
    "  elevation: 0 deg\n"
    "  bodies:\n"
    "    - {name: head, mass: 20 kg, inertia: 0.3 0.4 0.3 kg.m2}\n"
    "    - {name: ballast, mass: 60 kg, inertia: 0.5 0.5 0.5 kg.m2}\n"
    "  beams:\n"
    "    - name: mast\n"
    "      length: 2.5 m\n"
    "      sections: [{from: 0 m, bore_radius: 50 mm, mass_per_length: 9 kg/m,\n"
    "        axial_stiffness: 2e8 N, bending_stiffness: %.17g N.m2, torsion_stiffness: 2e5 N.m2,\n"
    "        polar_inertia: 0.03 kg.m}]\n"
    "      modes: {bending: 12, torsion: 6, axial: 6, damping: 0, elements: 25,\n"
    "        geometric_stiffness: %s}\n"
    "    - name: cradle\n"
    "      length: 2.6 m\n"
    "      sections: [{from: 0 m, bore_radius: 50 mm, mass_per_length: 6 kg/m,\n"
    "        axial_stiffness: 1e8 N, bending_stiffness: 4e5 N.m2, torsion_stiffness: 0.8e5 N.m2,\n"
    "        polar_inertia: 0.02 kg.m}]\n"
    "      modes: {bending: 12, torsion: 6, axial: 6, damping: 0, elements: 26,\n"
    "        geometric_stiffness: %s}\n"
    "  joints:\n"
    "    - {name: root, kind: fixed, parent: ground, body: mast, attitude: 0 90 0 deg}\n"
    "    - {name: top, kind: fixed, parent: mast, body: head, at: 2.5 0 0 m,\n"
    "       attitude: 0 -90 0 deg}\n"
    "    - {name: side, kind: fixed, parent: head, body: ballast, at: %.17g 0 0 m}\n"
    "    - {name: neck, kind: fixed, parent: head, body: cradle, at: 0.1 %.17g 0 m}\n"
    "tubes:\n"
    "  on: cradle\n"
    "  layout: {first: 0.1 %.17g 0 m}\n"
    "  length: 3.0 m\n"
    "  sections: [{from: 0 m, inner_radius: 82.5 mm, outer_radius: 85 mm}]\n"
    "  material: {youngs_modulus: 210 GPa, poisson_ratio: 0.3, density: 7850 kg/m3}\n"
    "  modes: {bending: 8, torsion: 6, axial: 6, elements: 30, damping: 0}\n"
    "  tail: {mass: 8 kg, center: -0.1 m, inertia: 0.05 0.06 0.06 kg.m2}\n"
    "  supports:\n"
    "    - {at: 0.4 m, stiffness: 2e6 2e6 2e6 N/m, rotational_stiffness: 2e4 2e4 2e4 N.m/rad}\n"
    "    - {at: 1.8 m, stiffness: 1e6 3e6 2e6 N/m, rotational_stiffness: 1e4 2e4 2e4 N.m/rad}\n"
    "  slot: {angle: 0 deg, radius: 82.5 mm, friction: 0}\n"
    "rocket:\n" // of no weight
    "  start_at: 0.1 m\n"
    "  mass: 1 g\n"
    "  center: 1.1 0 0 m\n"
    "  inertia: 1e-6 1e-4 1e-4 kg.m2\n"
    "  empty: {mass: 0.5 g, center: 1.1 0 0 m, inertia: 1e-6 1e-4 1e-4 kg.m2}\n"
    "  adaptors:\n"
    "    - {name: rear, at: 0 m, clearance: 0 mm}\n"
    "    - {name: front, at: 1.9 m, clearance: 0 mm}\n"
    "  contact: {law: ideal}\n"
    "  knob: {angle: 0 deg}\n"
    "  lock: {release_force: 5 kN}\n"
    "  motor:\n"
    "    thrust: [[0 s, 0 kN], [10 ms, 15 N], [2.5 s, 15 N], [2.55 s, 0 kN]]\n";

// The lowest natural frequencies [Hz].
static void launcher_frequencies(const launcher *of, int count, double *frequency)
{
    char text[8192];
    const char *geometric = of->geometric ? "yes" : "no";
    static ld_model model;
    static ld_mode mode[MOST];
    static ld_pole pole[MOST];
    ld_messages messages = {0};
    ld_simulation *simulation;
    ld_error error;
    snprintf(text, sizeof text, text_of, of->gravity, of->bending, geometric, geometric,
             ballast_at(), of->neck_y, of->rear_y);
    if (scenario_read_text(text, strlen(text), "text", ".", NULL, 0, &model, &messages)) {
        ld_messages_print(&messages, stdout);
        fail_msg("the scenario cannot be read");
    }
    if (ld_simulation_create(&model, &simulation, &error))
        fail_msg("%s", error.text);
    int all, poles;
    if (ld_simulation_system_modes(simulation, mode, MOST, &all, pole, MOST, &poles, &error))
        fail_msg("%s", error.text);
    assert_true(all >= count);
    for (int i = 0; i < count; i++)
        frequency[i] = mode[i].frequency;
    ld_simulation_free(simulation);
    model_clear(&model);
}

// ---- finite elements

static void build_frame(const launcher *of, frame *fe)
{
    const double up[3][3] = {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}};
    const double along[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, ground[3] = {0};
    const frame_section mast = mast_section(of), tube = tube_section_of();
    const double head[3] = {0, mast_length, 0}, ballast[3] = {ballast_at(), mast_length, 0};
    const double cradle[3] = {neck, mast_length + of->neck_y, 0};
    const double first[3] = {neck + rear, mast_length + of->neck_y + of->rear_y, 0};
    const double tail[3] = {first[0] + tail_at, first[1], 0};
    frame_create(fe);
    int on_ground = frame_beam(fe, ground, up, mast_length, MAST, &mast), top = on_ground + MAST;
    int of_cradle = frame_beam(fe, cradle, along, cradle_length, CRADLE, &cradle_section);
    int of_tube = frame_beam(fe, first, along, tube_length, TUBE, &tube);
    frame_clamp(fe, on_ground);
    frame_body(fe, top, head_mass, head, (const double[3]){0.3, 0.4, 0.3});
    frame_body(fe, top, ballast_mass, ballast, (const double[3]){0.5, 0.5, 0.5});
    frame_follow(fe, of_cradle, top);
    frame_body(fe, of_tube, tail_mass, tail, (const double[3]){0.05, 0.06, 0.06});
    for (int k = 0; k < 2; k++) {
        frame_springs springs = {{first[0] + support_at[k], first[1], 0}, {{0}}, {0}, {0}};
        memcpy(springs.A, along, sizeof along);
        memcpy(springs.stiffness, spring[k][0], sizeof springs.stiffness);
        memcpy(springs.rotational, spring[k][1], sizeof springs.rotational);
        int on_cradle = of_cradle + (int)lround((rear + support_at[k]) / cradle_length * CRADLE);
        int on_tube = of_tube + (int)lround(support_at[k] / tube_length * TUBE);
        frame_spring(fe, on_cradle, on_tube, &springs);
    }
    for (int i = 0; i < MAST; i++) {
        double above = mast.mass * mast_length * (MAST - i - 0.5) / MAST;
        frame_set_tension(fe, i, -of->gravity * (carried_mass() + above));
    }
}

// The largest difference of the frequencies up to `few`, and of all.
static void compare(const launcher *of, int few, int count, double worst[2], double *lowest)
{
    double omega[20], frequency[20];
    frame fe;
    build_frame(of, &fe);
    frame_frequencies(&fe, of->geometric, count, omega);
    frame_free(&fe);
    launcher_frequencies(of, count, frequency);
    for (int i = 0; i < count; i++) {
        printf("  %2d: %10.6f Hz, off by %9.2e\n", i + 1, omega[i] / (2 * PI),
               2 * PI * frequency[i] / omega[i] - 1);
        worst[1] = fmax(i ? worst[1] : 0, fabs(2 * PI * frequency[i] / omega[i] - 1));
        if (i < few)
            worst[0] = worst[1];
    }
    *lowest = frequency[0];
}

// Torques at inner stations converge slowest: those of the cradle and the tube, from the sixth on.
static void test_without_weight(void **state)
{
    (void)state;
    const launcher of = {.bending = 3e5, .neck_y = 0.05, .rear_y = 0.15};
    double lowest, worst[2];
    compare(&of, 5, 16, worst, &lowest);
    CHECK_BELOW("five frequencies without weight, relative", worst[0], 8e-5);
    CHECK_BELOW("sixteen frequencies", worst[1], 7e-3);
}

// Under the weight a mast near half of its buckling load sways slower.
static void test_under_weight(void **state)
{
    (void)state;
    launcher of = {.gravity = 9.80665, .bending = 8e3};
    double linear, loaded, worst[2];
    compare(&of, 8, 8, worst, &linear);
    CHECK_BELOW("eight frequencies, no geometric stiffness", worst[1], 4e-4);
    of.geometric = true;
    compare(&of, 8, 8, worst, &loaded);
    CHECK_BELOW("eight frequencies under weight, relative", worst[1], 4e-4);
    CHECK_WITHIN("lowest over that without geometric stiffness", loaded / linear, 0.75, 0.76);
}

// A launch from a flexible cradle on a soft mount: what the supports do to the cradle's sections
// and to the tube balances.
static void test_launch(void **state)
{
    (void)state;
    static const char *const text =
        "include: fixed.yaml\n"
        "base:\n"
        "  kind: multibody\n"
        "  elevation: 0 deg\n"
        "  bodies:\n"
        "    - {name: mount, mass: 200 kg, inertia: 10 40 40 kg.m2}\n"
        "  beams:\n"
        "    - name: cradle\n"
        "      length: 3 m\n"
        "      material: {youngs_modulus: 210 GPa, poisson_ratio: 0.3, density: 7850 kg/m3}\n"
        "      sections: [{from: 0 m, inner_radius: 60 mm, outer_radius: 64 mm}]\n"
        "      modes: {bending: 3, torsion: 2, shear_coefficient: 0.53}\n"
        "  joints:\n"
        "    - {name: pivot, kind: spherical, parent: ground, body: mount, at: 0 1 0 m,\n"
        "       attitude: 10 30 0 deg, rotational_stiffness: 4e5 N.m/rad,\n"
        "       rotational_damping: 4e3 N.m.s/rad}\n"
        "    - {name: root, kind: fixed, parent: mount, body: cradle, at: 0.1 0.1 0 m}\n"
        "tubes: {on: cradle, layout: {rows: 1, columns: 1, first: 0.1 0.2 0 m}}\n"
        "firing: [{tube: 1, at: 0 s}]\n"
        "run: {tolerance: 1e-6}\n";
    static ld_model model;
    ld_messages messages = {0};
    if (scenario_read_text(text, strlen(text), "text", LD_SOURCE_DIR "/examples", NULL, 0, &model,
                           &messages)) {
        ld_messages_print(&messages, stdout);
        fail_msg("the scenario cannot be read");
    }
    ld_summary summary = summary_of_run(&model);
    CHECK_BELOW("energy residual over the largest work", summary.energy.residual_relative, 1e-9);
    model_clear(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_without_weight),
        cmocka_unit_test(test_under_weight),
        cmocka_unit_test(test_launch),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
