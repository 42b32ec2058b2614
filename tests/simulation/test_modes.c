// Frequencies of the linearised equations: against the finite elements, and against the equations'
// own motion in time.
#include <stdlib.h>
#include <string.h>

#include "math/matrices/symmetric_eigen.h"
#include "model/model.h"
#include "scenario/scenario.h"
#include "state/equilibrium.h"
#include "state/evaluation.h"
#include "support/check.h"
#include "support/flight_text.h"
#include "support/fresh_launch.h"
#include "support/line_frequencies.h"
#include "support/reference_model.h"
#include "systems/launching/launching_dynamics.h"

static const double TWO_PI = 6.283185307179586476925286766559;

static ld_simulation *make(ld_model *model)
{
    ld_simulation *simulation = NULL;
    ld_error error;
    reference_model(model);
    if (ld_simulation_create(model, &simulation, &error))
        fail_msg("%s", error.text);
    return simulation;
}

static double nearest(const ld_mode *modes, int count, double frequency)
{
    double best = INFINITY;
    for (int i = 0; i < count; i++)
        best = fmin(best, fabs(modes[i].frequency / frequency - 1));
    return best;
}

// With the span `supported` the tube's equations have the frequencies of its finite elements.
static void tube_has_the_frequencies_of_its_elements(void **state)
{
    (void)state;
    ld_model model;
    ld_mode modes[LD_MAX_MODES];
    ld_simulation *simulation = make(&model);
    int count = ld_simulation_tube_modes(simulation, modes, LD_MAX_MODES);
    const flexible_tube *tube = &simulation->launcher.launching.tube.flexible;
    assert_int_equal(count, 6 + simulation->launcher.launching.layout.nq);
    double worst = 0, omega[LD_NB];
    line_frequencies(&model.tubes, LINE_BENDING, PLANE_Y, tube->nb, omega);
    for (int j = 0; j < tube->nb; j++)
        worst = fmax(worst, nearest(modes, count, omega[j] / TWO_PI));
    CHECK_BELOW("bending frequencies on the supports, relative", worst, 1e-12);
    // the round tube bends in both planes alike: each pair has one shape in each
    int pairs = 0;
    for (int i = 1; i < count; i++)
        if (modes[i].frequency == modes[i - 1].frequency) {
            assert_string_equal(modes[i - 1].shape, "tube, lateral plane");
            assert_string_equal(modes[i].shape, "tube, vertical plane");
            pairs++;
        }
    assert_int_equal(pairs, tube->nb + 2);
    ld_simulation_free(simulation);
    reference_model_free(&model);
}

// Frequencies of the tube's equations in each plane against its finite elements there, with the
// default modes: planes that differ by 3 and by 25 in stiffness, supports and tail, and in what is
// clamped. The first ones as a launch has them.
static void each_plane_has_the_frequencies_of_its_elements(void **state)
{
    (void)state;
    static const double ratio[][3] = {
        {3, 1, 1}, {25, 1, 1}, {1, 25, 25}, {1, 25, 0.04}, {5, 0.04, 25}};
    static const char *const of_plane[] = {"tube, vertical plane", "tube, lateral plane"};
    for (size_t i = 0; i <= sizeof ratio / sizeof *ratio; i++) {
        ld_model model;
        ld_mode modes[LD_MAX_MODES];
        const double *r = ratio[i % (sizeof ratio / sizeof *ratio)];
        bool clamped = i == sizeof ratio / sizeof *ratio;
        ld_error error;
        ld_simulation *simulation = NULL;
        reference_model(&model);
        ld_tubes *tubes = &model.tubes;
        tubes->modes.bending = 7;
        tubes->tail.inertia[1] *= r[0];
        tubes->section[0].form = LD_SECTION_PLANES;
        tubes->section[0].bending_stiffness_z = tubes->section[0].bending_stiffness * r[0];
        tubes->section[0].bending_stiffness_y = tubes->section[0].bending_stiffness;
        for (int k = 0; k < 2; k++) {
            tubes->support[k].stiffness[1] *= r[1];
            tubes->support[k].rotational_stiffness[2] *= r[2];
        }
        if (clamped)
            tubes->support[0].clamped = 1u << LD_CLAMP_Y | 1u << LD_CLAMP_YAW;
        if (ld_simulation_create(&model, &simulation, &error))
            fail_msg("%s", error.text);
        int count = ld_simulation_tube_modes(simulation, modes, LD_MAX_MODES);
        double worst = 0, omega[LD_NB];
        for (int plane = PLANE_Y; plane <= PLANE_Z; plane++) {
            line_frequencies(tubes, LINE_BENDING, plane, tubes->modes.bending, omega);
            for (int j = 0; j < tubes->modes.bending; j++) {
                double best = INFINITY;
                for (int k = 0; k < count; k++)
                    if (!strncmp(modes[k].shape, of_plane[plane], strlen(of_plane[plane])))
                        best = fmin(best, fabs(modes[k].frequency / (omega[j] / TWO_PI) - 1));
                worst = fmax(worst, best);
            }
        }
        printf("  stiffness %g:1, springs along %g:1, about %g:1%s\n", r[0], r[1], r[2],
               clamped ? ", clamped" : "");
        CHECK_BELOW("frequencies of each plane, relative", worst, 2e-12);
        ld_simulation_free(simulation);
        reference_model_free(&model);
    }
}

// ---- a rail with a rocket on it, by a stiffness matrix

enum { ELEMENTS = 60, LOADED = 2 * (ELEMENTS + 1) + 2 };
typedef struct loaded_line {
    double M[LOADED * LOADED], K[LOADED * LOADED];
} loaded_line;

// Adds k v v^T, v given by its places and values.
static void add_spring(double *K, double k, int count, const int *at, const double *v)
{
    for (int i = 0; i < count; i++)
        for (int j = 0; j < count; j++)
            K[at[i] * LOADED + at[j]] += k * v[i] * v[j];
}

// Hermite elements of a uniform rail; a rocket as a rigid body, displacement and slope at O1, held
// on the rail by springs at its shoes. Supports and shoes stand at nodes.
static void assemble_loaded(const ld_model *model, int plane, loaded_line *line)
{
    const ld_tubes *tubes = &model->tubes;
    const ld_rocket *rocket = &model->rocket;
    const ld_section *section = &tubes->section[0];
    double h = tubes->length / ELEMENTS, m = section->mass_per_length * h / 420;
    double EI = (plane == PLANE_Y ? section->bending_stiffness_z : section->bending_stiffness_y) /
                (h * h * h);
    const double mass[4][4] = {{156, 22 * h, 54, -13 * h},
                               {22 * h, 4 * h * h, 13 * h, -3 * h * h},
                               {54, 13 * h, 156, -22 * h},
                               {-13 * h, -3 * h * h, -22 * h, 4 * h * h}};
    const double stiffness[4][4] = {{12, 6 * h, -12, 6 * h},
                                    {6 * h, 4 * h * h, -6 * h, 2 * h * h},
                                    {-12, -6 * h, 12, -6 * h},
                                    {6 * h, 2 * h * h, -6 * h, 4 * h * h}};
    memset(line, 0, sizeof *line);
    for (int e = 0; e < ELEMENTS; e++)
        for (int i = 0; i < 4; i++)
            for (int j = 0; j < 4; j++) {
                line->M[(2 * e + i) * LOADED + 2 * e + j] += m * mass[i][j];
                line->K[(2 * e + i) * LOADED + 2 * e + j] += EI * stiffness[i][j];
            }
    for (int k = 0; k < tubes->support_count; k++) {
        int node = (int)lround(tubes->support[k].at / h);
        add_spring(line->K, tubes->support[k].stiffness[1 + plane], 1, (int[]){2 * node},
                   (double[]){1});
        add_spring(line->K, tubes->support[k].rotational_stiffness[2 - plane], 1,
                   (int[]){2 * node + 1}, (double[]){1});
    }
    int at = LOADED - 2;
    double c = rocket->full.center[0];
    line->M[at * LOADED + at] = rocket->full.mass;
    line->M[at * LOADED + at + 1] = line->M[(at + 1) * LOADED + at] = rocket->full.mass * c;
    line->M[(at + 1) * (LOADED + 1)] = rocket->full.inertia[2] + rocket->full.mass * c * c;
    for (int i = 0; i < rocket->adaptor_count; i++) {
        double x = rocket->adaptor[i].at;
        int node = (int)lround((rocket->start_at + x) / h);
        add_spring(line->K, rocket->contact.stiffness, 3, (int[]){2 * node, at, at + 1},
                   (double[]){1, -1, -x});
    }
}

// Lowest frequencies of the rail with its locked rocket in planes that differ by 25 in stiffness
// and supports, default modes, no gravity.
static void a_loaded_rail_has_the_frequencies_of_its_elements(void **state)
{
    (void)state;
    static loaded_line line;
    static double vectors[LOADED * LOADED];
    ld_mode modes[2 * LD_MAX_MODES];
    ld_pole poles[4 * LD_MAX_MODES];
    ld_simulation *simulation = NULL;
    ld_error error;
    int count, pole_count;
    double value[LOADED];
    ld_model model = read_text(
        "{launchdyn: 1, environment: {gravity: 0 m/s2}, base: {kind: fixed, elevation: 0 deg},"
        "tubes: {length: 6 m, sections: [{from: 0 m, bore_radius: 80 mm, mass_per_length: 12 kg/m,"
        "  axial_stiffness: 2.5e8 N, bending_stiffness_y: 2.5e6 N.m2, bending_stiffness_z: 1e5 "
        "N.m2,"
        "  torsion_stiffness: 3e5 N.m2, polar_inertia: 0.05 kg.m}], slot: none, supports: ["
        "  {at: 0.3 m, stiffness: 2e7 2e7 8e5 N/m,"
        "   rotational_stiffness: 1e5 4e3 1e5 N.m/rad},"
        "  {at: 2.7 m, stiffness: 2e7 2e7 8e5 N/m,"
        "   rotational_stiffness: 1e5 4e3 1e5 N.m/rad}]},"
        "rocket: {start_at: 0.4 m, mass: 30 kg, center: 0.9 0 0 m, inertia: 0.2 12 12 kg.m2,"
        " adaptors: [{name: rear, at: 0 m}, {name: front, at: 1.3 m}],"
        " contact: {law: bilateral, stiffness: 3e7 N/m}, lock: {release_force: 1 kN},"
        " motor: {thrust: [[0 s, 6 kN], [2 s, 0 N]]}}, firing: [{tube: 1, at: 0 s}],"
        "run: {end: tip}}");
    if (ld_simulation_create(&model, &simulation, &error) ||
        ld_simulation_system_modes(simulation, modes, 2 * LD_MAX_MODES, &count, poles,
                                   4 * LD_MAX_MODES, &pole_count, &error))
        fail_msg("%s", error.text);
    for (int plane = PLANE_Y; plane <= PLANE_Z; plane++) {
        assemble_loaded(&model, plane, &line);
        assert_int_equal(symmetric_eigen(LOADED, line.M, line.K, 1, value, vectors), 0);
        double exact = 1 / sqrt(value[0]) / TWO_PI;
        printf("  plane of %c: %.6f Hz\n", "yz"[plane], exact);
        CHECK_BELOW("lowest frequency, relative", nearest(modes, count, exact), 1e-5);
    }
    ld_simulation_free(simulation);
    model_clear(&model);
}

// Eigenvalues come in the right number and are stable: two of the rocket's twelve states a degree
// of freedom that lock and slot leave, none growing.
static void the_held_rocket_is_stable(void **state)
{
    (void)state;
    ld_model model;
    ld_mode modes[2 * LD_MAX_MODES];
    ld_pole poles[4 * LD_MAX_MODES];
    int count, pole_count;
    ld_error error;
    ld_simulation *simulation = make(&model);
    assert_int_equal(ld_simulation_system_modes(simulation, modes, 2 * LD_MAX_MODES, &count, poles,
                                                4 * LD_MAX_MODES, &pole_count, &error),
                     LD_OK);
    assert_int_equal(count, 10 + simulation->launcher.launching.layout.nq);
    double largest = -INFINITY;
    for (int i = 0; i < pole_count; i++)
        largest = fmax(largest, poles[i].real);
    CHECK_WITHIN("largest real part of an eigenvalue [1/s]", largest, -1, 0);
    ld_simulation_free(simulation);
    reference_model_free(&model);
}

// The lowest eigenvalue against the motion itself: the rocket pushed off its equilibrium by a
// nanometre swings at that frequency.
static void the_lowest_mode_is_seen_in_time(void **state)
{
    (void)state;
    ld_model model;
    ld_mode modes[2 * LD_MAX_MODES];
    ld_pole poles[4 * LD_MAX_MODES];
    int count, pole_count;
    ld_error error;
    ld_equilibrium_summary equilibrium;
    double y[LD_MAX_STATES], y_dot[LD_MAX_STATES], sum[LD_MAX_STATES], k[LD_MAX_STATES];
    fresh_launch launch;
    reference_model(&model);
    fresh_launch_make(&launch, &model);
    ld_simulation_system_modes(launch.simulation, modes, 2 * LD_MAX_MODES, &count, poles,
                               4 * LD_MAX_MODES, &pole_count, &error);
    assert_int_equal(simulation_equilibrium(&launch.state, 0, y, &equilibrium, &error), LD_OK);
    const launching_layout *at = &launch.state.launcher.launching.layout;
    launching_phase phase = simulation_start_phase(&launch.state);
    phase.frictionless = true;
    launcher_input input;
    simulation_input(&launch.state, 0, y, &input);
    double rest = y[at->x + 2];
    y[at->x + 2] += 1e-9;
    // plain fourth-order Runge-Kutta; upward crossings of the rest position are counted
    double h = 5e-5, before = 1, first = 0, last = 0, t = 0;
    int crossings = 0;
    const double weight[4] = {1, 2, 2, 1}, share[4] = {0, 0.5, 0.5, 1};
    for (int step = 0; step < 20000; step++, t += h) {
        for (int i = 0; i < at->count; i++)
            sum[i] = y_dot[i] = 0;
        for (int stage = 0; stage < 4; stage++) {
            launching_output out;
            for (int i = 0; i < at->count; i++)
                k[i] = y[i] + h * share[stage] * y_dot[i];
            assert_int_equal(launching_evaluate(&launch.state.launcher.launching, &input.launching,
                                                &phase, k, &out),
                             LAUNCHING_OK);
            launching_rates(&launch.state.launcher.launching, k, &out, true, y_dot);
            for (int i = 0; i < at->count; i++)
                sum[i] += weight[stage] * y_dot[i];
        }
        for (int i = 0; i < at->count; i++)
            y[i] += h / 6 * sum[i];
        double now = y[at->x + 2] - rest;
        if (t > 0.3 && before < 0 && now >= 0) {
            last = t + h - h * now / (now - before);
            first = crossings++ ? first : last;
        }
        before = now;
    }
    double measured = (crossings - 1) / (last - first);
    printf("    lowest: %.5f Hz by eigenvalue, %.5f Hz by %d swings\n", poles[0].imaginary / TWO_PI,
           measured, crossings - 1);
    CHECK_BELOW("lowest frequency, swings against eigenvalue, relative",
                measured / (poles[0].imaginary / TWO_PI) - 1, 2e-3);
    fresh_launch_free(&launch);
    reference_model_free(&model);
}

// Modes of a rail whose shoe is pressed sideways by the weight of a mass centre `beside` the axis.
static int modes_of_rail(const char *beside, ld_mode *modes)
{
    ld_model model;
    ld_messages messages;
    ld_simulation *simulation = NULL;
    ld_pole poles[4 * LD_MAX_MODES];
    int count = 0, pole_count;
    ld_error error;
    if (scenario_read(LD_SOURCE_DIR "/examples/rail/pad.yaml", &beside, 1, &model, &messages)) {
        ld_messages_print(&messages, stdout);
        fail();
    }
    if (ld_simulation_create(&model, &simulation, &error) ||
        ld_simulation_system_modes(simulation, modes, 2 * LD_MAX_MODES, &count, poles,
                                   4 * LD_MAX_MODES, &pole_count, &error))
        fail_msg("%s", error.text);
    ld_simulation_free(simulation);
    model_clear(&model);
    return count;
}

// The contact is a straight line of the depth: what presses a shoe by nanometres (less than steps
// of differences are) has the modes of what presses it by ten times as much.
static void a_light_touch_is_a_touch(void **state)
{
    (void)state;
    ld_mode light[2 * LD_MAX_MODES], firm[2 * LD_MAX_MODES];
    int count = modes_of_rail("rocket.eccentricity=0 0.05 mm", light);
    double frequency = 0, damping = 0, least = 1;
    assert_int_equal(count, modes_of_rail("rocket.eccentricity=0 0.5 mm", firm));
    for (int i = 0; i < count; i++) {
        frequency = fmax(frequency, fabs(light[i].frequency / firm[i].frequency - 1));
        damping = fmax(damping, fabs(light[i].damping - firm[i].damping));
        if (i > 0)
            least = fmin(least, firm[i].frequency / firm[i - 1].frequency - 1);
    }
    CHECK_BELOW("frequencies of a rail, shoe hardly pressed, relative", frequency, 1e-4);
    CHECK_BELOW("dampings, of which the contact's grows with its load", damping, 1e-3);
    CHECK_WITHIN("no two are of one frequency, least apart, relative", least, 1e-3, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tube_has_the_frequencies_of_its_elements),
        cmocka_unit_test(each_plane_has_the_frequencies_of_its_elements),
        cmocka_unit_test(a_loaded_rail_has_the_frequencies_of_its_elements),
        cmocka_unit_test(the_held_rocket_is_stable),
        cmocka_unit_test(the_lowest_mode_is_seen_in_time),
        cmocka_unit_test(a_light_touch_is_a_touch),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
