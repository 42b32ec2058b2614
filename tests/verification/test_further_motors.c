// Several motors: a rigid free rocket whose motors are lit apart against angular impulse and
// momentum, mass data against the parts put together, and against one motor of the summed table
// where they are lit at once on the axis, in flight and on the launcher.
#include "elements/exchange.h"
#include "model/masses.h"
#include "support/check.h"
#include "support/flight_text.h"
#include "support/reference_model.h"

#include <stdlib.h>

static const double degree = 3.14159265358979323846 / 180;

// In empty space, the mass centre 1.3 m before the first nozzle; what is put in goes on.
#define IN_SPACE(more)                                                                             \
    "launchdyn: 1\n"                                                                               \
    "environment: {atmosphere: none, gravity: 0 m/s2, ground: none}\n"                             \
    "rocket:\n"                                                                                    \
    "  {mass: 60 kg, center: 1.1 0 0 m, inertia: 2 24 24 kg.m2,\n"                                 \
    "   motor: {thrust: [[0 s, 3 kN], [0.4 s, 3 kN]], at: -0.2 0 0 m}," more "}\n"                 \
    "flight: {point: center, position: 0 0 0 m, velocity: 0 0 0 m/s}\n"                            \
    "run: {end: 0.8 s, flight_tolerance: 1e-12}\n"

// Thrust of the two boosters [N]: of 0.2 s each, 50 and 170 ms late, the second scaled.
static double booster(int k, double t)
{
    if (k == 0)
        return t < 0.05 || t >= 0.25 ? 0 : 500 + (t - 0.05) / 0.2 * 300;
    double tau = (t - 0.17) / 1.5;
    return tau < 0 || tau >= 0.2 ? 0 : 1.2 * (tau < 0.05 ? 8000 * tau : 400);
}

// Opposite each other 0.21 m off the axis, in a plane 35 degrees from y: the moments have one axis
// in B, so that rates are angular impulses over J, and the momentum is an integral over the turn.
static void test_lit_apart(void **state)
{
    (void)state;
    const double r = 0.21, plane = 35 * degree, y = r * cos(plane), z = r * sin(plane);
    char text[2000];
    snprintf(text, sizeof text,
             IN_SPACE("further_motors: [{thrust: [[0 s, 500 N], [0.2 s, 800 N]], at: 0.3 %.17g "
                      "%.17g m, delay: 50 ms}, {thrust: [[0 s, 0 N], [0.05 s, 400 N], [0.2 s, 400 "
                      "N]], at: -0.1 %.17g %.17g m, delay: 170 ms, time_scale: 1.5, thrust_scale: "
                      "1.2}]"),
             y, z, -y, -z);
    ld_model model = read_text(text);
    ld_rocket_summary rocket = fly_model(&model);
    enum { STEPS = 9400 }; // of 0.05 ms, to 0.47 s
    double w = 0, turn = 0, v[2] = {0}, h = 0.47 / STEPS, impulse[2] = {0};
    for (int i = 0; i < STEPS; i++) { // linear in each step
        double t = i * h, F[3][2];
        for (int n = 0; n < 3; n++) {
            double at = t + (n == 0 ? 1e-9 : n == 1 ? 0.5 * h : h - 1e-9);
            F[n][0] = booster(0, at);
            F[n][1] = booster(1, at);
        }
        double M0 = r * (F[0][1] - F[0][0]) / 24, M1 = r * (F[2][1] - F[2][0]) / 24;
        for (int n = 0; n < 3; n++) {
            double s = 0.5 * n * h, weight = (n == 1 ? 4 : 1) * h / 6 / 60;
            double angle = turn + w * s + M0 * s * s / 2 + (M1 - M0) / h * s * s * s / 6;
            double push = (t + s < 0.4 - 1e-9 + (n == 2) * 1e-8 ? 3000 : 0) + F[n][0] + F[n][1];
            v[0] += weight * push * cos(angle);
            v[1] += weight * push * sin(angle);
        }
        turn += w * h + M0 * h * h / 3 + M1 * h * h / 6;
        w += (M0 + M1) * h / 2;
    }
    impulse[0] = 0.2 * 650;
    impulse[1] = 1.5 * 1.2 * (0.05 * 200 + 0.15 * 400);
    // towards +plane the thrust turns the nose towards -plane
    double rate = r * (impulse[1] - impulse[0]) / 24;
    printf("  impulses %.1f and %.1f N s, turned by %.2f deg\n", impulse[0], impulse[1],
           turn / degree);
    CHECK_NEAR("rate about y [rad/s]", rocket.final.rate[1], -rate * sin(plane), 2e-15);
    CHECK_NEAR("rate about z [rad/s]", rocket.final.rate[2], rate * cos(plane), 2e-15);
    CHECK_NEAR("rate about x [rad/s]", rocket.final.rate[0], 0, 1e-17);
    const double *u = rocket.final.center_velocity;
    CHECK_NEAR("momentum over the mass, along x [m/s]", u[0], v[0], 1e-11);
    CHECK_NEAR("along y [m/s]", u[1], v[1] * cos(plane), 3e-12);
    CHECK_NEAR("along z [m/s]", u[2], v[1] * sin(plane), 2e-12);
    model_clear(&model);
}

// Two boosters canted against each other spin the rocket; across it they push against each other.
static void test_canted(void **state)
{
    (void)state;
    ld_model model = read_text(
        IN_SPACE("further_motors: [{thrust: [[0 s, 500 N], [0.2 s, 800 N]], at: 0.3 0.1 0 m, "
                 "misalignment: 0 0.3 rad, delay: 0.5 s}, {thrust: [[0 s, 500 N], [0.2 s, 800 N]], "
                 "at: 0.3 -0.1 0 m, misalignment: 0 -0.3 rad, delay: 0.5 s}]"));
    ld_rocket_summary rocket = fly_model(&model);
    double norm = sqrt(1.09), each = 0.2 * 650;
    CHECK_NEAR("spin [rad/s]", rocket.final.rate[0], 2 * 0.1 * each * 0.3 / norm / 2, 2e-15);
    CHECK_NEAR("speed [m/s]", rocket.final.center_velocity[0], (1200 + 2 * each / norm) / 60,
               1e-14);
    CHECK_NEAR("across [m/s]",
               hypot(rocket.final.center_velocity[1], rocket.final.center_velocity[2]), 0, 1e-14);
    model_clear(&model);
}

// ---- what burns

static void add_body(double m, v3 at, const double own[2], double *mass, v3 *moment, m3 *J)
{
    m3 X = m3_skew(at);
    *mass += m;
    *moment = v3_axpy(*moment, m, at);
    *J = m3_add(*J, m3_add(m3_diagonal(own[0], own[1], own[1]), m3_scale(-m, m3_mul(X, X))));
}

// A rest and three parts, on the axis and off it, put together about O1 at each instant.
static void test_masses(void **state)
{
    (void)state;
    const double thrust[] = {0, 900, 3, 900};
    const double part[3][2][5] = {{{0, 20, 0.5, 0.2, 1.1}, {3, 8, 0.6, 0.1, 0.5}},
                                  {{0, 6, 0.1, 0.03, 0.2}, {1, 1, 0.2, 0.01, 0.05}},
                                  {{0, 5, 0.1, 0.02, 0.3}, {2, 2, 0.15, 0.01, 0.1}}};
    // the first on the line through the whole's mass centre, whose place follows from the others
    v3 from[3] = {{0.2, 0, 0}, {0.1, 0.12, -0.05}, {-0.1, -0.1, 0.03}};
    const double delay[3] = {0, 0.5, 1.25}, rest_own[2] = {0.8, 12}, rest = 30;
    const v3 rest_at = {1.6, 0.004, -0.003};
    ld_rocket rocket = {.motor = {.thrust_scale = 1, .time_scale = 1, .rise_scale = 1}};
    ld_motor *first = &rocket.motor;
    first->thrust = reference_table(2, 2, thrust);
    first->masses = reference_table(2, 5, part[0][0]);
    first->masses_at = from[0].x;
    rocket.further_motor_count = 2;
    for (int k = 0; k < 2; k++) {
        const v3 *at = &from[k + 1];
        rocket.further_motor[k] =
            (ld_further_motor){.thrust = reference_table(2, 2, thrust),
                               .masses = reference_table(2, 5, part[k + 1][0]),
                               .masses_at = at->x,
                               .at = {-5, at->y, at->z},
                               .thrust_scale = 1,
                               .time_scale = 1,
                               .delay = delay[k + 1]};
    }
    double without = rest + part[1][0][1] + part[2][0][1];
    from[0].y =
        (rest * rest_at.y + part[1][0][1] * from[1].y + part[2][0][1] * from[2].y) / without;
    from[0].z =
        (rest * rest_at.z + part[1][0][1] * from[1].z + part[2][0][1] * from[2].z) / without;
    motor burns;
    // corners of all, three at 0.5, 1.25 and 3 s where the thrust jumps
    const double at[] = {0, 0.5, 1.25, 1.5, 3, 3.25, 3.5, 4.25, 9};
    for (int i = -1; i < (int)(sizeof at / sizeof *at); i++) {
        double t = i < 0 ? 0 : at[i], m = 0;
        v3 moment = v3_zero();
        m3 J = m3_diagonal(0, 0, 0);
        add_body(rest, rest_at, rest_own, &m, &moment, &J);
        for (int k = 0; k < 3; k++) {
            const double *a = part[k][0], *b = part[k][1];
            double share = fmin(1, fmax(0, (t - delay[k]) / b[0])), now[5];
            for (int n = 0; n < 5; n++)
                now[n] = a[n] + share * (b[n] - a[n]);
            add_body(now[1], v3_add(from[k], v3_make(now[2], 0, 0)), now + 3, &m, &moment, &J);
        }
        v3 c = v3_scale(1 / m, moment);
        m3 C = m3_skew(c);
        J = m3_add(J, m3_scale(m, m3_mul(C, C)));
        if (i < 0) { // the whole at ignition; its products stand in their own keys
            rocket.full = (ld_mass_data){m, {c.x, c.y, c.z}, {J.a[0][0], J.a[1][1], J.a[2][2]}};
            rocket.products[0] = J.a[0][1];
            rocket.products[1] = J.a[0][2];
            rocket.products[2] = J.a[1][2];
            assert_int_equal(motor_build(&burns, &rocket, 0, NULL), LD_OK);
            continue;
        }
        rocket_mass now;
        motor_mass(&burns, motor_piece(&burns, t), t, &now);
        double off = 0;
        for (int n = 0; n < 9; n++)
            off = fmax(off, fabs(now.J.a[n / 3][n % 3] - J.a[n / 3][n % 3]));
        printf("  %.2f s: %.3f kg\n", t, m);
        CHECK_NEAR("mass [kg]", now.m, m, 2e-14);
        CHECK_BELOW("centre [m]", v3_norm(v3_sub(now.c, c)), 5e-16);
        CHECK_BELOW("inertia [kg m2]", off, 6e-14);
    }
    motor_free(&burns);
    free(first->thrust.data);
    free(first->masses.data);
    for (int k = 0; k < 2; k++) {
        free(rocket.further_motor[k].thrust.data);
        free(rocket.further_motor[k].masses.data);
    }
}

// ---- lit at once on the axis: as one motor of the summed table

static ld_rocket_summary fly_split(const char *motors)
{
    char text[2000];
    snprintf(text, sizeof text,
             "launchdyn: 1\nenvironment: {atmosphere: none, ground: none}\n"
             "rocket:\n"
             "  {mass: 60 kg, center: 1.1 0.002 0 m, inertia: 2 24 25 kg.m2, mass_error: 0.4 kg,\n"
             "   eccentricity: 1 -2 mm, dynamic_imbalance: 3 -2 mrad, %s}\n"
             "flight: {point: center, position: 0 0 0 m, velocity: 30 40 0 m/s, ignition: 0.1 s}\n"
             "run: {end: 1 s, flight_tolerance: 1e-12}\n",
             motors);
    ld_model model = read_text(text);
    ld_rocket_summary rocket = fly_model(&model);
    model_clear(&model);
    return rocket;
}

#define NOZZLE "at: -0.2 0.001 0.002 m, misalignment: 2 -3 mrad"
#define CENTRAL "at: -0.2 0.002 0 m, misalignment: 2 -3 mrad"

static void test_at_once(void **state)
{
    (void)state;
    static const char *const one[2] = {
        "motor: {thrust: [[0 s, 3 kN], [0.1 s, 3.5 kN], [0.3 s, 2 kN], [0.4 s, 0 kN]], " NOZZLE
        ", delay: 20 ms}",
        "motor: {thrust: [[0 s, 3 kN], [0.4 s, 2 kN]], " CENTRAL
        ", masses: [[0 s, 20 kg, 0.8 m, 1 kg.m2, 3 kg.m2], [0.4 s, 10 kg, 0.8 m, 0.5 kg.m2, 2 "
        "kg.m2]]}",
    };
    static const char *const split[2] = {
        "motor: {thrust: [[0 s, 1 kN], [0.1 s, 1.5 kN], [0.4 s, 0 kN]], " NOZZLE
        ", delay: 20 ms}, further_motors: [{thrust: [[0 s, 1.5 kN], [0.3 s, 0.5 kN], [0.4 s, 0 "
        "kN]], " NOZZLE ", delay: 20 ms}, {thrust: [[0 s, 0.5 kN], [0.1 s, 0.83333333333333337 "
        "kN], [0.3 s, 1 kN], [0.4 s, 0 kN]], " NOZZLE ", delay: 20 ms}]",
        "motor: {thrust: [[0 s, 1 kN], [0.4 s, 1 kN]], " CENTRAL
        ", masses: [[0 s, 8 kg, 0.8 m, 0.3 kg.m2, 1 kg.m2], [0.4 s, 4 kg, 0.8 m, 0.2 kg.m2, 0.8 "
        "kg.m2]]}, further_motors: [{thrust: [[0 s, 4 kN], [0.8 s, 2 kN]], " CENTRAL ", "
        "time_scale: 0.5, thrust_scale: 0.5, masses_at: 0.3 m, masses: [[0 s, 12 kg, 0.5 m, 0.7 "
        "kg.m2, 2 kg.m2], [0.8 s, 6 kg, 0.5 m, 0.3 kg.m2, 1.2 kg.m2]]}]",
    };
    for (int n = 0; n < 2; n++) {
        ld_rocket_summary a = fly_split(one[n]), b = fly_split(split[n]);
        for (int i = 0; i < 3; i++) {
            CHECK_NEAR("velocity [m/s]", a.final.center_velocity[i], b.final.center_velocity[i],
                       1e-13);
            CHECK_NEAR("rate [rad/s]", a.final.rate[i], b.final.rate[i], 2e-16);
        }
    }
}

// On the launcher: 100 + 50 ms of two motors one after the other, against the table written out;
// tables that jump where the second begins and the first ends.
static void test_on_the_launcher(void **state)
{
    (void)state;
    const double first[] = {0, 0, 0.01, 15e3, 0.15, 15e3}, second[] = {0, 6e3, 2, 6e3},
                 written[] = {0,    0,    0.01, 15e3, 0.1, 15e3, 0.1,
                              21e3, 0.15, 21e3, 0.15, 6e3, 2.1,  6e3};
    ld_summary summary[2];
    for (int k = 0; k < 2; k++) {
        ld_model model;
        reference_model(&model);
        model.run.tolerance = 1e-9;
        ld_motor *main_one = &model.rocket.motor;
        free(main_one->thrust.data);
        main_one->thrust = k ? reference_table(7, 2, written) : reference_table(3, 2, first);
        if (k == 0) {
            model.rocket.further_motor_count = 1;
            ld_further_motor *one = &model.rocket.further_motor[0];
            *one = (ld_further_motor){.thrust = reference_table(2, 2, second),
                                      .thrust_scale = 1,
                                      .time_scale = 1,
                                      .delay = 0.1};
            memcpy(one->at, main_one->at, sizeof one->at);
            memcpy(one->misalignment, main_one->misalignment, sizeof one->misalignment);
        }
        summary[k] = summary_of_run(&model);
        reference_model_free(&model);
    }
    const ld_rocket_summary *a = &summary[0].rocket[0], *b = &summary[1].rocket[0];
    CHECK_NEAR("exit [s]", a->t_rear, b->t_rear, 1e-11);
    CHECK_NEAR("exit speed [m/s]", a->exit_speed, b->exit_speed, 2e-8);
    CHECK_NEAR("pitch rate [rad/s]", a->pitch_rate, b->pitch_rate, 1e-8);
    CHECK_NEAR("yaw rate [rad/s]", a->yaw_rate, b->yaw_rate, 1e-8);
    CHECK_NEAR("work of the thrust [J]", summary[0].energy.work[POWER_THRUST],
               summary[1].energy.work[POWER_THRUST], 1e-4);
}

// Off the axis and canted, lit on the way: energy.
static void test_energy(void **state)
{
    (void)state;
    const double thrust[] = {0, 0, 0.005, 2e3, 0.1, 1e3};
    ld_model model;
    reference_model(&model);
    model.run.tolerance = 1e-9;
    ld_rocket_summary alone = summary_of_run(&model).rocket[0];
    model.rocket.further_motor_count = 2;
    for (int k = 0; k < 2; k++)
        model.rocket.further_motor[k] = (ld_further_motor){.thrust = reference_table(3, 2, thrust),
                                                           .at = {0.1, k ? 0.06 : -0.05, 0.02},
                                                           .misalignment = {0.01, k ? -0.05 : 0.02},
                                                           .thrust_scale = 1,
                                                           .time_scale = 1,
                                                           .delay = k ? 0.13 : 0.04};
    ld_summary summary = summary_of_run(&model);
    const ld_rocket_summary *rocket = &summary.rocket[0];
    printf("  pitch and yaw rate by %.3f and %.3f rad/s\n", rocket->pitch_rate - alone.pitch_rate,
           rocket->yaw_rate - alone.yaw_rate);
    CHECK_BELOW("energy balance, relative", summary.energy.residual_relative, 1e-13);
    reference_model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lit_apart),       cmocka_unit_test(test_canted),
        cmocka_unit_test(test_masses),          cmocka_unit_test(test_at_once),
        cmocka_unit_test(test_on_the_launcher), cmocka_unit_test(test_energy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
