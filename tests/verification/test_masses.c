// Mass, centre and inertia by rocket.motor.masses: the rest of the rocket and its part put together
// about the origin, the rocket's equation piece by piece, the same burn said both ways in flight
// and on the launcher.
#include "support/check.h"

#include <stdlib.h>
#include <string.h>

#include "elements/motor.h"
#include "model/masses.h"
#include "support/flight_text.h"
#include "support/reference_model.h"

// Two tanks that empty, as one part: masses, places and moments of inertia of each at three times.
static const double oxidiser[3][2] = {{20, 1.1}, {12, 1.05}, {1, 1.0}};
static const double fuel[3][2] = {{6, 2.3}, {4, 2.2}, {0.5, 2.15}};
static const double own[3][2] = {{0.2, 1.3}, {0.15, 0.8}, {0.02, 0.1}}; // axial, transverse

// Mass, first and second moment about O1, own transverse moment of inertia included.
typedef struct moments {
    double m, first, second;
} moments;

static moments part_of(int k)
{
    const double *a = oxidiser[k], *b = fuel[k];
    return (moments){a[0] + b[0], a[0] * a[1] + b[0] * b[1],
                     a[0] * a[1] * a[1] + b[0] * b[1] * b[1] + own[k][1]};
}

static void fill_masses(ld_table *table, double places_from)
{
    double rows[3][MASSES_COLUMNS];
    for (int k = 0; k < 3; k++) {
        moments part = part_of(k);
        double x = part.first / part.m;
        const double row[] = {1.5 * k, part.m, x - places_from, own[k][0],
                              part.second - part.m * x * x};
        memcpy(rows[k], row, sizeof row);
    }
    free(table->data);
    *table = reference_table(3, MASSES_COLUMNS, rows[0]);
}

// A rest of 30 kg at 1.6 m with the two tanks, summed up about O1.
static void test_steiner(void **state)
{
    (void)state;
    const moments rest = {30, 30 * 1.6, 30 * 1.6 * 1.6 + 11};
    ld_rocket rocket = {.motor.masses_at = 0.4};
    fill_masses(&rocket.motor.masses, 0.4);
    for (int k = 0; k < 3; k++) {
        moments part = part_of(k);
        double m = rest.m + part.m, c = (rest.first + part.first) / m;
        double J = rest.second + part.second - m * c * c;
        if (k == 0)
            rocket.full = (ld_mass_data){m, {c, 0.01, -0.02}, {0.9 + own[0][0], J, J + 0.3}};
        ld_mass_data now = masses_at(&rocket, (size_t)k);
        CHECK_NEAR("mass [kg]", now.mass, m, 1e-14);
        CHECK_NEAR("centre [m]", now.center[0], c, 1e-15);
        CHECK_NEAR("across [m]", now.center[1] + now.center[2], -0.01, 1e-16);
        CHECK_NEAR("axial moment of inertia [kg m2]", now.inertia[0], 0.9 + own[k][0], 1e-15);
        CHECK_NEAR("transverse ones [kg m2]", now.inertia[1], J, 5e-14);
        CHECK_NEAR("transverse ones [kg m2]", now.inertia[2], J + 0.3, 5e-14);
    }
    free(rocket.motor.masses.data);
}

// Between rows evenly in time, at corners that the thrust has not; constant before and after.
static void test_between(void **state)
{
    (void)state;
    const double thrust[] = {0, 100, 2, 100, 2, 300, 4, 0};
    ld_rocket rocket = {.mass_error = 0.5, .eccentricity = {1e-3, 0}};
    rocket.full = (ld_mass_data){56, {1.5, 0, 0}, {1.1, 30, 30}};
    rocket.motor = (ld_motor){.thrust = reference_table(4, 2, thrust),
                              .thrust_scale = 2,
                              .time_scale = 3,
                              .rise_scale = 1};
    fill_masses(&rocket.motor.masses, 0);
    motor burns;
    assert_int_equal(motor_build(&burns, &rocket, 0, NULL), LD_OK);
    // corners at 0, 1.5, 2, 2, 3, 4 times 3
    assert_int_equal(burns.corner_count, 6);
    CHECK_NEAR("thrust at a corner of the masses [N]", motor_thrust(&burns, 4, 9), 300, 1e-12);
    CHECK_NEAR("impulse [N s]", motor_total_impulse(&burns), 2 * 3 * (200 + 300), 1e-11);
    const double at[] = {-1, 0, 3, 4.5, 5, 7, 8.9, 9, 11, 40};
    for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
        double share = fmin(fmax(at[i] / 4.5, 0), 2);
        int k = share >= 1;
        ld_mass_data a = masses_at(&rocket, (size_t)k), b = masses_at(&rocket, (size_t)k + 1);
        double inside = share - k, moves = at[i] >= 0 && at[i] < 9;
        rocket_mass now;
        motor_mass(&burns, motor_piece(&burns, at[i]), at[i], &now);
        CHECK_NEAR("mass [kg]", now.m, 0.5 + a.mass + inside * (b.mass - a.mass), 2e-14);
        CHECK_NEAR("its rate [kg/s]", now.m_dot, moves * (b.mass - a.mass) / 4.5, 5e-15);
        CHECK_NEAR("centre [m]", now.c.x, a.center[0] + inside * (b.center[0] - a.center[0]),
                   1e-15);
        CHECK_NEAR("its rate [m/s]", now.c_dot.x, moves * (b.center[0] - a.center[0]) / 4.5, 1e-16);
        CHECK_NEAR("across [m]", now.c.y, 1e-3, 0);
        CHECK_NEAR("moment of inertia [kg m2]", now.J.a[1][1],
                   a.inertia[1] + inside * (b.inertia[1] - a.inertia[1]), 2e-14);
        CHECK_NEAR("its rate [kg m2/s]", now.J_dot.a[1][1],
                   moves * (b.inertia[1] - a.inertia[1]) / 4.5, 1e-15);
    }
    motor_free(&burns);
    free(rocket.motor.thrust.data);
    free(rocket.motor.masses.data);
}

#define SPACE "launchdyn: 1\nenvironment: {atmosphere: none, gravity: 0 m/s2, ground: none}\n"

// A thrust that stays, mass lost evenly from 60 to 50 kg in 0.5 s, to 40 kg in 1.5 s more; then the
// thrust doubles and nothing is lost: v = sum T dt/dm ln(m0/m1), momentum with what stays.
static void test_rocket_equation(void **state)
{
    (void)state;
    ld_model model =
        read_text(SPACE "rocket:\n  {mass: 60 kg, center: 1.1 0 0 m, inertia: 2 24 24 kg.m2,\n"
                        "   motor: {thrust: [[0 s, 3 kN], [2 s, 3 kN], [2 s, 6 kN], [3 s, 6 kN]],\n"
                        "     masses: [[0 s, 60 kg, 1.1 m, 2 kg.m2, 24 kg.m2],\n"
                        "       [0.5 s, 50 kg, 1.2 m, 1.5 kg.m2, 20 kg.m2],\n"
                        "       [2 s, 40 kg, 1.3 m, 1 kg.m2, 18 kg.m2]]}}\n"
                        "flight: {point: center, position: 0 0 0 m, speed: 0 m/s}\n"
                        "run: {end: 4 s, flight_tolerance: 1e-12}\n");
    ld_rocket_summary rocket = fly_model(&model);
    double v = 3000 * (0.5 / 10 * log(60 / 50.0) + 1.5 / 10 * log(50 / 40.0)) + 6000 * 1 / 40.0;
    CHECK_NEAR("speed [m/s]", rocket.final.center_velocity[0], v, 1e-10);
    CHECK_NEAR("propellant [kg]", model.rocket.propellant, 20, 1e-14);
    model_clear(&model);
}

static const char burn[] =
    "rocket:\n"
    "  {mass: 60 kg, center: 1.1 0.01 0 m, inertia: 0.5 24 23.8 kg.m2, mass_error: 0.3 kg,\n"
    "   eccentricity: 1 -2 mm, products_of_inertia: 0.02 0.01 0.005 kg.m2,\n"
    "   dynamic_imbalance: 2 -1 mrad,\n"
    "   %s\n"
    "   motor: {thrust: [[0 s, 0 kN], [0 s, 8 kN], [2 s, 8 kN], [2 s, 0 kN]], at: -0.1 0 0 m,\n"
    "     thrust_scale: 1.1, time_scale: 0.9, jet_damping: yes, exit_radius: 40 mm %s}}\n"
    "flight: {position: 0 0 0 m, velocity: 30 -20 10 m/s, rate: 2 1.5 -1 rad/s}\n"
    "run: {end: 2.5 s}\n";

// A thrust that stays burns evenly in time: what `empty` says by the impulse is a table of two rows
// of the whole rocket, and three of which the middle one lies between.
static void test_both_ways(void **state)
{
    (void)state;
    char text[2][2048];
    snprintf(text[0], sizeof text[0], SPACE "%s", burn);
    ld_rocket_summary rocket[2];
    for (int i = 0; i < 2; i++) {
        snprintf(text[1], sizeof text[1], text[0],
                 i ? "" : "empty: {mass: 40 kg, center: 1.3 0.01 0 m, inertia: 0.3 18 17.8 kg.m2},",
                 i ? ", masses: [[0 s, 60 kg, 1.1 m, 0.5 kg.m2, 24 kg.m2], [0.8 s, 52 kg, 1.18 m, "
                     "0.42 kg.m2, 21.6 kg.m2], [2 s, 40 kg, 1.3 m, 0.3 kg.m2, 18 kg.m2]]"
                   : "");
        ld_model model = read_text(text[1]);
        model.run.flight_tolerance = 1e-12;
        rocket[i] = fly_model(&model);
        model_clear(&model);
    }
    for (int i = 0; i < 3; i++) {
        CHECK_NEAR("place [m]", rocket[1].final.center[i], rocket[0].final.center[i], 1e-11);
        CHECK_NEAR("rate [rad/s]", rocket[1].final.rate[i], rocket[0].final.rate[i], 1e-13);
    }
}

// The reference launcher with such a motor, to the exit.
static void test_on_the_launcher(void **state)
{
    (void)state;
    const double thrust[] = {0, 15000, 1, 15000};
    ld_rocket_summary rocket[2];
    for (int i = 0; i < 2; i++) {
        ld_model model;
        reference_model(&model);
        ld_rocket *given = &model.rocket;
        free(given->motor.thrust.data);
        given->motor.thrust = reference_table(2, 2, thrust);
        const ld_mass_data *a = &given->full;
        given->empty = (ld_mass_data){a->mass - 20, {a->center[0] + 0.1, 0, 0}, {0}};
        for (int k = 0; k < 3; k++)
            given->empty.inertia[k] = a->inertia[k] * 0.8;
        given->empty.inertia[2] = given->empty.inertia[1] + a->inertia[2] - a->inertia[1];
        given->propellant = 20;
        const ld_mass_data *b = &given->empty;
        const double rows[] = {
            0, a->mass, a->center[0], a->inertia[0], a->inertia[1],
            1, b->mass, b->center[0], b->inertia[0], b->inertia[1],
        };
        if (i)
            given->motor.masses = reference_table(2, MASSES_COLUMNS, rows);
        model.run.tolerance = 1e-11;
        rocket[i] = summary_of_run(&model).rocket[0];
        model_clear(&model);
    }
    CHECK_NEAR("speed [m/s]", rocket[1].exit_speed, rocket[0].exit_speed, 1e-9);
    for (int i = 0; i < 3; i++)
        CHECK_NEAR("rate [rad/s]", rocket[1].exit.rate[i], rocket[0].exit.rate[i], 5e-8);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_steiner),         cmocka_unit_test(test_between),
        cmocka_unit_test(test_rocket_equation), cmocka_unit_test(test_both_ways),
        cmocka_unit_test(test_on_the_launcher),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
