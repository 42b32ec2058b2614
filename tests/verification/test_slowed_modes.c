// Modes slowed to `tubes.modes.cut`: the tube gives way at rest as before, launches come nearer to
// those of 24 bending and 8 torsion modes at the price of few modes, and what linear analyses show
// is the tube without the cut (theory-tube.md, selective mass scaling).
#include <stdlib.h>
#include <string.h>

#include "launchdyn/response.h"
#include "launchdyn/scenario.h"
#include "launchdyn/simulation.h"
#include "model/model.h"
#include "quantities/summary.h"
#include "support/check.h"
#include "support/reference_model.h"
#include "systems/launching/launching.h"

static double polynomial(const double (*row)[LD_NB], int k, double xi)
{
    return row[0][k] + xi * (row[1][k] + xi * (row[2][k] + xi * row[3][k]));
}

// Deflection at x for a unit force there, by the modes of a plane: sum of b^2 / omega^2.
static double compliance(const flexible_tube *tube, int plane, double x)
{
    const tube_element *element = &tube->element[flexible_tube_find(tube, x)];
    double sum = 0;
    for (int k = 0; k < tube->nb; k++) {
        double b = polynomial(element->b[plane], k, x - element->x0);
        sum += b * b / tube->om2_b[plane][k];
    }
    return sum;
}

// Twist at x by a unit torque there, stretch by a unit force.
static double bar_compliance(const flexible_tube *tube, bool twist, double x)
{
    const tube_element *element = &tube->element[flexible_tube_find(tube, x)];
    double sum = 0;
    for (int k = 0; k < (twist ? tube->nt : tube->na); k++) {
        const double *om2 = twist ? tube->om2_t : tube->om2_a;
        double value = twist ? element->tau[0][k] + (x - element->x0) * element->tau[1][k]
                             : element->a[0][k] + (x - element->x0) * element->a[1][k];
        sum += value * value / om2[k];
    }
    return sum;
}

static int slowed(int count, const double *om2, double at)
{
    int found = 0;
    for (int k = 0; k < count; k++)
        found += fabs(om2[k] / (at * at) - 1) < 1e-12;
    return found;
}

// Planes whose stiffnesses differ by `share`, all kinds of modes.
static void keep_compliance(double share, int least)
{
    ld_model model;
    flexible_tube plain, cut;
    reference_model(&model);
    model.tubes.modes.bending = 12;
    model.tubes.modes.torsion = 8;
    model.tubes.modes.axial = 4;
    ld_section *section = &model.tubes.section[0];
    section->bending_stiffness_y = section_stiffness_y(section);
    section->bending_stiffness_z = share * section->bending_stiffness_y;
    section->form = LD_SECTION_PLANES;
    model.tubes.support[0].stiffness[1] *= 2.5;
    assert_int_equal(flexible_tube_build(&plain, &model.tubes, NULL), LD_OK);
    model.tubes.modes.cut = 1700;
    assert_int_equal(flexible_tube_build(&cut, &model.tubes, NULL), LD_OK);
    double off = 0;
    for (int i = 1; i <= 11; i++) {
        double x = i * model.tubes.length / 11.3;
        for (int plane = 0; plane < 2; plane++)
            off = fmax(off, fabs(compliance(&cut, plane, x) / compliance(&plain, plane, x) - 1));
        for (int twist = 0; twist < 2; twist++)
            off = fmax(off,
                       fabs(bar_compliance(&cut, twist, x) / bar_compliance(&plain, twist, x) - 1));
    }
    double at = 2 * 3.14159265358979323846 * 1700;
    assert_true(slowed(12, cut.om2_b[1], at) >= least && slowed(8, cut.om2_t, at) >= 4);
    assert_true(slowed(12, cut.om2_b[1], at) < 12 && slowed(4, cut.om2_a, at) >= 2);
    CHECK_BELOW("static compliance of a tube with slowed modes (relative)", off, 2e-14);
    flexible_tube_free(&plain);
    flexible_tube_free(&cut);
    reference_model_free(&model);
}

static void compliance_stays(void **state)
{
    (void)state;
    keep_compliance(1, 5);
    keep_compliance(3.7, 5);
}

// ---- launches ----

typedef struct modes_of_launch {
    int bending, torsion;
    double cut, tolerance;
} modes_of_launch;

static ld_summary launch(const char *file, const char *more, modes_of_launch with)
{
    char text[3][64];
    const char *set[] = {text[0],
                         text[1],
                         text[2],
                         more,
                         "run.exit_error=no",
                         with.tolerance == 1e-5 ? NULL : "run.tolerance=1e-8"};
    ld_messages messages = {0};
    ld_model *model;
    ld_simulation *simulation;
    ld_summary summary = {0};
    ld_error error = {0};
    snprintf(text[0], sizeof text[0], "tubes.modes.bending=%d", with.bending);
    snprintf(text[1], sizeof text[1], "tubes.modes.torsion=%d", with.torsion);
    snprintf(text[2], sizeof text[2], "tubes.modes.cut=%g Hz", with.cut);
    if (ld_scenario_read(file, set, set[5] ? 6 : 5, &model, &messages)) {
        ld_messages_print(&messages, stdout);
        fail();
    }
    if (ld_simulation_create(model, &simulation, &error) ||
        ld_simulation_run(simulation, NULL, &summary, &error))
        fail_msg("%s", error.text);
    ld_simulation_free(simulation);
    ld_model_free(model);
    return summary;
}

static double rates_off(const ld_summary *a, const ld_summary *b)
{
    const ld_rocket_summary *p = &a->rocket[0], *q = &b->rocket[0];
    return fmax(fabs(p->pitch_rate - q->pitch_rate), fabs(p->yaw_rate - q->yaw_rate));
}

// Default modes; many modes with a cut, and with twice that, whose error is below that of the
// default tolerance; many modes as they are. Evaluations say what steps cost; they depend on no
// clock.
static void compare(const char *example, const char *more, double at, double bound, double twice,
                    double evaluations)
{
    char file[256];
    snprintf(file, sizeof file, LD_SOURCE_DIR "/examples/%s.yaml", example);
    ld_summary all = launch(file, more, (modes_of_launch){24, 8, 0, 1e-8});
    ld_summary few = launch(file, more, (modes_of_launch){7, 4, 0, 1e-5});
    ld_summary cut = launch(file, more, (modes_of_launch){24, 8, at, 1e-5});
    ld_summary higher = launch(file, more, (modes_of_launch){24, 8, 2 * at, 1e-8});
    double ratio = (double)cut.statistics.rhs_evaluations / (double)few.statistics.rhs_evaluations;
    printf("  %s, %s, cut %g Hz\n", example, more, at);
    printf("    7 and 4 modes: exit rates off by %.2e rad/s\n", rates_off(&few, &all));
    CHECK_BELOW("24 and 8 modes with the cut: exit rates [rad/s]", rates_off(&cut, &all), bound);
    CHECK_BELOW("with twice the cut: exit rates [rad/s]", rates_off(&higher, &all), twice);
    CHECK_BELOW("with the cut: evaluations, of those with 7 and 4", ratio, evaluations);
}

#define RECOIL                                                                                     \
    "tubes.supports=[{at: 0.4 m, stiffness: 2e7 2e7 2e7 N/m, rotational_stiffness: 2e5 2e5 2e5 "   \
    "N.m/rad, recoil: {preload: 100 N, stiffness: 10 kN/m, damping: 400 N.s/m}}, {at: 1.8 m, "     \
    "stiffness: 0 2e7 2e7 N/m}]"
// Their forces bend all modes, so that the mass added to them counts in the first order.
#define CLAMPS "tubes.supports=[{at: 0.4 m, clamped: all}, {at: 1.8 m, clamped: [y, z]}]"

static void launches_converge(void **state)
{
    (void)state;
    compare("fixed", "rocket.eccentricity=0.4 -0.3 mm", 2500, 2e-6, 4e-7, 1.1);
    compare("smooth", "rocket.eccentricity=-0.5 0.2 mm", 2500, 8e-5, 4e-6, 1.1);
    compare("rail/pad", "rocket.motor.misalignment=1 -0.6 mrad", 2500, 5e-5, 2e-5, 1.6);
    compare("rail/tower", "rocket.motor.misalignment=-0.7 1.1 mrad", 2500, 3e-8, 6e-9, 0.9);
    compare("fixed", RECOIL, 2500, 3e-4, 8e-5, 0.9);
    compare("fixed", CLAMPS, 10000, 1.5e-3, 8e-5, 4);
}

// Largest torque at three stations, relative.
static double loads_off(const ld_summary *a, const ld_summary *b)
{
    double off = 0;
    for (int i = 0; i < 3; i++) {
        const ld_station_summary *p = &a->rocket[0].station[i], *q = &b->rocket[0].station[i];
        off = fmax(off, fabs(p->torque / q->torque - 1));
    }
    return off;
}

static void loads_converge(void **state)
{
    (void)state;
    const char *const stations = "tubes.loads=[{at: 0.41 m}, {at: 1 m}, {at: 2.6 m}]";
    const char *const file = LD_SOURCE_DIR "/examples/fixed.yaml";
    ld_summary all = launch(file, stations, (modes_of_launch){24, 8, 0, 1e-8});
    ld_summary few = launch(file, stations, (modes_of_launch){7, 4, 0, 1e-5});
    ld_summary cut = launch(file, stations, (modes_of_launch){24, 8, 2500, 1e-5});
    printf("  torque along the tube, 7 and 4 modes: off by %.2e\n", loads_off(&few, &all));
    CHECK_BELOW("24 and 8 modes, cut 2.5 kHz: torque (relative)", loads_off(&cut, &all), 8e-3);
}

// ---- linear analyses ----

static void find_modes(double cut, ld_mode *tube, ld_mode *whole, int *count, ld_phasor *gain)
{
    enum { MOST = 2 * LD_MAX_MODES };
    ld_model model;
    ld_pole pole[2 * MOST];
    ld_simulation *simulation;
    ld_response *response;
    const char *const column = "tip.y";
    int poles;
    reference_vehicle(&model, 5);
    model.tubes.modes.bending = 9;
    model.tubes.modes.cut = cut;
    assert_int_equal(ld_simulation_create(&model, &simulation, NULL), LD_OK);
    count[0] = ld_simulation_tube_modes(simulation, tube, MOST);
    assert_int_equal(ld_simulation_system_modes(simulation, whole, MOST, &count[1], pole, 2 * MOST,
                                                &poles, NULL),
                     LD_OK);
    ld_simulation_free(simulation);
    assert_int_equal(ld_response_create(&model, NAN, NAN, &response, NULL), LD_OK);
    assert_int_equal(ld_response_choose(response, &column, 1, NULL), LD_OK);
    assert_int_equal(ld_response_gain(response, 5, "road", (double[2]){1.7, 41}, 2, gain, NULL),
                     LD_OK);
    ld_response_free(response);
    reference_model_free(&model);
}

// They show the tube's own frequencies, to the bit.
static void linear_analyses_ignore_it(void **state)
{
    (void)state;
    static ld_mode tube[2][2 * LD_MAX_MODES], whole[2][2 * LD_MAX_MODES];
    int count[2][2];
    ld_phasor gain[2][2];
    find_modes(0, tube[0], whole[0], count[0], gain[0]);
    find_modes(900, tube[1], whole[1], count[1], gain[1]);
    assert_memory_equal(count[0], count[1], sizeof count[0]);
    assert_true(count[0][0] > 20 && count[0][1] > 20);
    for (int i = 0; i < count[0][0]; i++)
        assert_true(tube[0][i].frequency == tube[1][i].frequency &&
                    tube[0][i].damping == tube[1][i].damping);
    for (int i = 0; i < count[0][1]; i++)
        assert_true(whole[0][i].frequency == whole[1][i].frequency);
    assert_memory_equal(gain[0], gain[1], sizeof gain[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(compliance_stays), cmocka_unit_test(launches_converge),
        cmocka_unit_test(loads_converge), cmocka_unit_test(linear_analyses_ignore_it)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
