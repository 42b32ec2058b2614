// The factors of the paper's salvo, each alone as a study draws it, reach the physics by the right
// size: flights alone and a rocket at rest in its tube against closed forms.
#include "model/model.h"
#include "support/check.h"

#include "launchdyn/study.h"
#include "scenario/scenario.h"
#include "support/recorded_run.h"

// A rocket of constant mass but for what burns, 10 kN for 2 s in empty space, from rest.
#define SPACE                                                                                      \
    "launchdyn: 1\nenvironment: {gravity: 0 m/s2, atmosphere: none, ground: none}\n"               \
    "flight: {position: 0 0 0 m, velocity: 0 0 0 m/s}\n"                                           \
    "run: {end: 2 s, flight_tolerance: 1e-12}\n"
#define MOTOR "motor: {thrust: [[0 s, 0 kN], [0 s, 10 kN], [2 s, 10 kN], [2 s, 0 kN]]"
#define ROCKET "rocket: {mass: 60 kg, center: 1.1 0 0 m, inertia: 0.22 24 24 kg.m2, "
#define BURNING                                                                                    \
    SPACE ROCKET "empty: {mass: 40 kg, center: 1.1 0 0 m, inertia: 0.22 24 24 kg.m2}, " MOTOR "}}" \
                 "\n"
#define CONSTANT SPACE ROCKET MOTOR "}}\n"
#define SCATTER "scatter:\n  samples: 1\n  factors:\n    "

// Sample 1 of a scenario and its run.
typedef struct drawn_run {
    ld_model model;
    ld_sample *sample;
    recorded_run run;
} drawn_run;

static void begin(drawn_run *self, const char *text)
{
    ld_messages messages;
    ld_error error;
    ld_status status = scenario_read_text(text, strlen(text), "text", LD_SOURCE_DIR "/examples",
                                          NULL, 0, &self->model, &messages);
    ld_messages_print(&messages, stdout);
    assert_int_equal(status, LD_OK);
    if (ld_sample_create(&self->model, 1, &self->sample, &error))
        fail_msg("%s", error.text);
    recorded_run_make(&self->run, ld_sample_model(self->sample));
}

static void end(drawn_run *self)
{
    recorded_run_free(&self->run);
    ld_sample_free(self->sample);
    model_clear(&self->model);
}

typedef struct factor_case {
    const char *what, *text;
    const char *column; // whose last value is found
    double expected, bound;
} factor_case;

static void check_cases(const factor_case *all, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        drawn_run drawn;
        begin(&drawn, all[i].text);
        size_t column = recorded_column(&drawn.run, all[i].column);
        CHECK_NEAR(all[i].what, recorded_value(&drawn.run, drawn.run.rows - 1, column),
                   all[i].expected, all[i].bound * fabs(all[i].expected));
        end(&drawn);
    }
}

// Speed after burn-out I/m_p ln(m_0/(m_0 - m_p)), of a constant mass rate J w = moment t.
static void test_mass_and_thrust(void **state)
{
    (void)state;
    const double impulse = 20000, J = 24, arm = 1.1, straight = sqrt(1 + 4e-6);
    const factor_case all[] = {
        {"mass, 3 kg more: speed [m/s]", BURNING SCATTER "rocket.mass_error: {discrete: [3 kg]}\n",
         "rocket.vx", impulse / 20 * log(63. / 43), 1e-9},
        {"propellant, 21 kg: speed [m/s]",
         BURNING SCATTER "rocket.propellant: {discrete: [21 kg]}\n", "rocket.vx",
         impulse / 21 * log(60. / 39), 1e-9},
        {"thrust, a tenth more: speed [m/s]",
         BURNING SCATTER "rocket.motor.thrust_scale: {discrete: [1.1]}\n", "rocket.vx",
         1.1 * impulse / 20 * log(60. / 40), 1e-9},
        {"eccentricity, 2 mm along y: rate about z [rad/s]",
         CONSTANT SCATTER "rocket.eccentricity.y: {discrete: [2 mm]}\n", "rocket.wz",
         2e-3 * impulse / J, 1e-9},
        {"along z: rate about y [rad/s]",
         CONSTANT SCATTER "rocket.eccentricity.z: {discrete: [2 mm]}\n", "rocket.wy",
         -2e-3 * impulse / J, 1e-9},
        {"thrust 2 mm beside the axis: rate about z [rad/s]",
         CONSTANT SCATTER "rocket.motor.at.y: {discrete: [2 mm]}\n", "rocket.wz",
         -2e-3 * impulse / J, 1e-9},
        {"thrust 2 mrad out of line: rate about z [rad/s]",
         CONSTANT SCATTER "rocket.motor.misalignment.y: {discrete: [2 mrad]}\n", "rocket.wz",
         -arm * 2e-3 / straight * impulse / J, 1e-9},
    };
    check_cases(all, sizeof all / sizeof *all);
}

// A top that spins about its body's axis, which is none of its own: with a = atan(delta) and
// n = (J_t - J_x)/J_t p cos a the rates across come and go, p sin a sin(n t) about one axis,
// p sin a cos a (1 - cos(n t)) about the other.
static void test_dynamic_imbalance(void **state)
{
    (void)state;
#define SPINNING                                                                                   \
    "launchdyn: 1\nenvironment: {gravity: 0 m/s2, atmosphere: none, ground: none}\n"               \
    "flight: {position: 0 0 0 m, velocity: 0 0 0 m/s, rate: 60 0 0 rad/s}\n"                       \
    "run: {end: 2.03 s, flight_tolerance: 1e-12}\n" ROCKET "}\n" SCATTER
    const double p = 60, delta = 3e-3, a = atan(delta);
    const double n = (24 - 0.22) / 24 * p * cos(a), t = 2.03;
    const double along = p * sin(a) * cos(a) * (1 - cos(n * t)), across = p * sin(a) * sin(n * t);
    // as a product, J_xy of a turn by a; the moments differ by (J_t - J_x) sin(a)^2, 9e-6 of them
    const factor_case all[] = {
        {"towards y: rate about y [rad/s]",
         SPINNING "rocket.dynamic_imbalance.y: {discrete: [3 mrad]}\n", "rocket.wy", along, 1e-8},
        {"towards y: rate about z [rad/s]",
         SPINNING "rocket.dynamic_imbalance.y: {discrete: [3 mrad]}\n", "rocket.wz", across, 1e-8},
        {"towards z: rate about y [rad/s]",
         SPINNING "rocket.dynamic_imbalance.z: {discrete: [3 mrad]}\n", "rocket.wy", -across, 1e-8},
        {"towards z: rate about z [rad/s]",
         SPINNING "rocket.dynamic_imbalance.z: {discrete: [3 mrad]}\n", "rocket.wz", along, 1e-8},
        {"by a product: rate about z [rad/s]",
         SPINNING "rocket.products_of_inertia.x: {discrete: [-0.07134 kg.m2]}\n", "rocket.wz",
         across, 3e-3},
    };
    check_cases(all, sizeof all / sizeof *all);
}

// A plain body at rest that a gust takes along: in air that has gone over to U at once its speed is
// U - U/(1 + rho A C U t/(2 m)); sideways alike.
static void test_gust(void **state)
{
    (void)state;
#define DRAG                                                                                       \
    "launchdyn: 1\n"                                                                               \
    "environment: {gravity: 0 m/s2, atmosphere: {density: 1.2 kg/m3, speed_of_sound: 340 m/s}, "   \
    "ground: none, wind: {gust: [{start: 0 s, rise: 1 us, hold: 100 s, speed: 3 m/s}]}}\n"         \
    "rocket: {mass: 2 kg, inertia: 1 1 1 kg.m2, aerodynamics: {model: body, area: 0.5 m2, "        \
    "drag: 1}}\nflight: {position: 0 0 0 m, velocity: 0 0 0 m/s}\n"                                \
    "run: {end: 4 s, flight_tolerance: 1e-12}\n" SCATTER
    const double U = 8, taken = U - U / (1 + 1.2 * 0.5 * U * 4 / (2 * 2));
    const factor_case all[] = {
        {"8 m/s along: speed [m/s]", DRAG "environment.wind.gust.1.speed: {discrete: [8 m/s]}\n",
         "rocket.vx", taken, 1e-6},
        {"to the right: speed [m/s]",
         DRAG "environment.wind.gust.1.speed: {discrete: [8 m/s]}\n    "
              "environment.wind.gust.1.heading: {discrete: [90 deg]}\n",
         "rocket.vz", taken, 1e-6},
        {"a second late: speed [m/s]",
         DRAG "environment.wind.gust.1.speed: {discrete: [8 m/s]}\n    "
              "environment.wind.gust.1.start: {discrete: [1 s]}\n",
         "rocket.vx", U - U / (1 + 1.2 * 0.5 * U * 3 / (2 * 2)), 1e-6},
    };
    check_cases(all, sizeof all / sizeof *all);
}

// In air without weight m v' = -rho A v^2/2, so 1/v grows by rho/(2 m) A t from when a canopy of A
// opens, or brakes of that area are out; a fall under a canopy ends at v_t = sqrt(2 m g/(rho A)).
static void test_drag_areas(void **state)
{
    (void)state;
#define AIR                                                                                        \
    "launchdyn: 1\nrun: {end: 4 s, flight_tolerance: 1e-12}\nenvironment: {ground: 0 m, "          \
    "atmosphere: {density: 1.2 kg/m3, speed_of_sound: 340 m/s}"
#define LIGHT AIR ", gravity: 0 m/s2"
#define BODY "}\nrocket: {mass: 4 kg, center: 0.3 0 0 m, inertia: 0.1 1 1 kg.m2, "
#define CANOPY BODY "parachutes: [{name: main, drag_area: 0.5 m2, trigger: "
#define FROM "\nflight: {point: center, position: 0 300 0 m, velocity: "
    const double g = 9.80665, v_t = sqrt(2 * 4 * g / (1.2 * 0.7)), per_area = 1.2 / (2 * 4);
    const factor_case all[] = {
        {"canopy, 0.7 m2: speed [m/s]",
         AIR CANOPY "time, time: 0 s}]}" FROM "0 0 0 m/s}\n" SCATTER
                    "rocket.parachutes.main.drag_area: {discrete: [0.7 m2]}\n",
         "rocket.vy", -v_t * tanh(g * 4 / v_t), 2e-12},
        {"1.5 s after its trigger: speed [m/s]",
         LIGHT CANOPY "time, time: 0.5 s}]}" FROM "50 0 0 m/s}\n" SCATTER
                      "rocket.parachutes.main.lag: {discrete: [1.5 s]}\n",
         "rocket.vx", 1 / (1 / 50. + per_area * 0.5 * (4 - 2)), 2e-12},
        {"at 260 m, 2 s down from 300 m: speed [m/s]",
         LIGHT CANOPY "height, height: 240 m}]}" FROM "0 -20 0 m/s}\n" SCATTER
                      "rocket.parachutes.main.height: {discrete: [260 m]}\n",
         "rocket.vy", -1 / (1 / 20. + per_area * 0.5 * (4 - 2)), 2e-12},
        {"air brakes, half as much again: speed [m/s]",
         LIGHT BODY "air_brakes: {over_time: [[0 s, 0.2 m2], [4 s, 0.1 m2]]}}" FROM
                    "50 0 0 m/s}\n" SCATTER "rocket.air_brakes.scale: {discrete: [1.5]}\n",
         "rocket.vx", 1 / (1 / 50. + per_area * 1.5 * 0.15 * 4), 2e-12},
    };
    check_cases(all, sizeof all / sizeof *all);
}

// Propellant of 20 kg, 0.1 m before a place drawn as 0.4 m for 0.8 m: burnt, it leaves the centre
// at c_1 and J_1 about it by Steiner's theorem. Under a thrust out of line J w' = -c F sin, centre
// and J even in time between both ends.
static void test_place_of_masses(void **state)
{
    (void)state;
    const double c_0 = 1.1, J_0 = 24, x = 0.1 + 0.4, T = 2;
    const double c_1 = (60 * c_0 - 20 * x) / 40;
    const double J_1 = J_0 - 20 * (x - c_0) * (x - c_0) - 40 * (c_1 - c_0) * (c_1 - c_0);
    const double b = (c_1 - c_0) / T, q = (J_1 - J_0) / T;
    const double integral = b / q * T + (c_0 - b * J_0 / q) / q * log(J_1 / J_0);
    const factor_case all[] = {
        {"0.4 m: rate about z [rad/s]",
         SPACE ROCKET MOTOR
         ", misalignment: 2 0 mrad, masses_at: 0.8 m, masses: [[0 s, 20 kg, 0.1 m, "
         "0 kg.m2, 0 kg.m2], [2 s, 0 kg, 0.1 m, 0 kg.m2, 0 kg.m2]]}}\n" SCATTER
         "rocket.motor.masses_at: {discrete: [0.4 m]}\n",
         "rocket.wz", -1e4 * 2e-3 / sqrt(1 + 4e-6) * integral, 1e-14},
    };
    check_cases(all, 1);
}

// At rest the rocket lies on rear and front adaptor: each sinks by what its clearance grows.
static void test_clearances(void **state)
{
    (void)state;
#define AT_REST "include: fixed.yaml\nrun: {end: 1 us}\n"
    static const char *const text[] = {
        AT_REST SCATTER "rocket.adaptors.rear.clearance: {discrete: [0.3 mm]}\n",
        AT_REST SCATTER "rocket.adaptors.rear.clearance: {discrete: [0.25 mm]}\n",
        AT_REST SCATTER "rocket.adaptors.front.clearance: {discrete: [0.3 mm]}\n",
    };
    double y[3], pitch[3];
    for (int i = 0; i < 3; i++) {
        drawn_run drawn;
        begin(&drawn, text[i]);
        y[i] = recorded_value(&drawn.run, 0, recorded_column(&drawn.run, "rocket.y"));
        pitch[i] = recorded_value(&drawn.run, 0, recorded_column(&drawn.run, "rocket.psi"));
        end(&drawn);
    }
    CHECK_NEAR("rear, 50 um closer: it lies higher [um]", 1e6 * (y[1] - y[0]), 50, 0.05);
    CHECK_NEAR("the rocket pitches [urad]", 1e6 * (pitch[1] - pitch[0]), -50 / 1.9, 0.05);
    CHECK_NEAR("front, 100 um closer: the rear stays [um]", 1e6 * (y[2] - y[0]), 0, 0.05);
    CHECK_NEAR("the rocket pitches [urad]", 1e6 * (pitch[2] - pitch[0]), 100 / 1.9, 0.05);
}

static double first_value(const char *text, const char *column)
{
    drawn_run drawn;
    begin(&drawn, text);
    double value = recorded_value(&drawn.run, 0, recorded_column(&drawn.run, column));
    end(&drawn);
    return value;
}

// At rest on a rail, level and clamped at its end, which sags by what its stiffness lets it.
static void test_rail(void **state)
{
    (void)state;
#define ON_RAIL                                                                                    \
    "include: rail/pad.yaml\nbase: {elevation: 0 deg}\nenvironment: {wind: none}\n"                \
    "tubes: {supports: [{at: 0 m, clamped: all}], modes: {span: clamped}}\n"                       \
    "run: {lead_in: 0 s, end: 1 us}\n" SCATTER
    const char *nominal = ON_RAIL "tubes.guide.t_slot.gap: {discrete: [0.4 mm]}\n";
    const char *gap = ON_RAIL "tubes.guide.t_slot.gap: {discrete: [0.5 mm]}\n";
    const char *line = ON_RAIL "tubes.guide.line.y: {discrete: [0.17 m]}\n";
    const char *soft = ON_RAIL "tubes.sections.1.bending_stiffness_z: {discrete: [8e5 N.m2]}\n";
    double y = first_value(nominal, "rocket.y"), sag = first_value(nominal, "tip.y");
    CHECK_NEAR("gap 100 um wider: it lies lower [um]", 1e6 * (first_value(gap, "rocket.y") - y),
               -100, 0.05);
    CHECK_NEAR("line 10 mm higher: it lies higher [mm]", 1e3 * (first_value(line, "rocket.y") - y),
               10, 1e-3);
    CHECK_NEAR("softer by 8/9: the tip sags by more", first_value(soft, "tip.y") / sag, 9.0 / 8,
               1e-3);
}

// A gas scaled by 1.1 pushes by 0.1 MPa on the bore's area more.
static void test_pressure(void **state)
{
    (void)state;
#define BY_GAS "include: line-thrower.yaml\nrun: {end: 1 us}\n" SCATTER "tubes.pressure.scale: "
    double plain = first_value(BY_GAS "{discrete: [1]}\n", "pressure.force");
    double scaled = first_value(BY_GAS "{discrete: [1.1]}\n", "pressure.force");
    double bore = 3.14159265358979323846 * 0.04 * 0.04;
    CHECK_NEAR("force more [N]", scaled - plain, 0.1e6 * bore, 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_mass_and_thrust),
        cmocka_unit_test(test_dynamic_imbalance),
        cmocka_unit_test(test_gust),
        cmocka_unit_test(test_drag_areas),
        cmocka_unit_test(test_place_of_masses),
        cmocka_unit_test(test_clearances),
        cmocka_unit_test(test_rail),
        cmocka_unit_test(test_pressure),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
