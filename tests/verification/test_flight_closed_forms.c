// Free flight against closed forms: vacuum parabola, thrust in vacuum, torque-free precession,
// constant body-fixed torque, terminal speed, roll driven by fins, apex and limits.
#include "support/check.h"

#include <stdlib.h>

#include "math/vectors/quaternion.h"
#include "quantities/summary.h"
#include "support/flight_text.h"

static const double degree = 0.017453292519943295, g = 9.80665;

// 50 m/s at 30 deg from 7 m above a ground at -3 m, at the default tolerance.
static void test_parabola(void **state)
{
    (void)state;
    ld_model model = read_text("launchdyn: 1\n"
                               "environment: {atmosphere: none, ground: -3 m, "
                               "site: {altitude: 300 m}}\n"
                               "rocket: {mass: 10 kg, inertia: 0.1 1 1 kg.m2}\n"
                               "flight: {position: 2 7 -1 m, speed: 50 m/s, attitude: {pitch: 30 "
                               "deg, yaw: 10 deg}, rate: 5 1 2 rad/s}\n");
    ld_rocket_summary rocket = fly_model(&model);
    double vy = 50 * sin(30 * degree), v = 50 * cos(30 * degree);
    double t = (vy + sqrt(vy * vy + 2 * g * 10)) / g;
    CHECK_NEAR("apogee above ground [m]", rocket.flight.apogee, 10 + vy * vy / (2 * g), 5e-14);
    CHECK_NEAR("apogee above sea level [m]", rocket.flight.apogee_altitude, 307 + vy * vy / (2 * g),
               1e-13);
    CHECK_NEAR("time of flight [s]", rocket.flight.time_of_flight, t, 1e-13);
    CHECK_NEAR("downrange [m]", rocket.flight.downrange, v * t * cos(10 * degree), 1e-11);
    CHECK_NEAR("drift [m]", rocket.flight.drift, -v * t * sin(10 * degree), 1e-11);
    CHECK_NEAR("impact speed [m/s]", rocket.flight.impact_speed, sqrt(2500 + 2 * g * 10), 1e-12);
    CHECK_NEAR("impact angle [deg]", rocket.flight.impact_angle / degree,
               atan2(g * t - vy, v) / degree, 1e-12);
    CHECK_NEAR("height of impact [m]", rocket.final.center[1], -3, 1e-12);
    model_clear(&model);
}

// An arc of a Kepler ellipse over a round Earth that does not turn: with l = r0 v cos(gamma) and
// energy E, p = l^2/GM, a = -GM/(2 E), e^2 = 1 - p/a. The flight goes from the true anomaly f0,
// r = p/(1 + e cos f), through the apogee to f1 where r is the ground's.
static void test_ellipse(void **state)
{
    (void)state;
    const double GM = 3.986004418e14, R = 6371007.1809, r0 = R + 1000, r1 = R + 400, v = 1500;
    const double gamma = 50 * degree, azimuth = 70 * degree, latitude = 30 * degree, pi = acos(-1);
    ld_model model = read_text(
        "launchdyn: 1\n"
        "environment: {earth: {model: round, rotation: 0 rad/s}, atmosphere: none, ground: 400 m,\n"
        "  site: {latitude: 30 deg, longitude: 12 deg, altitude: 1000 m, azimuth: 70 deg}}\n"
        "rocket: {mass: 10 kg, inertia: 0.1 1 1 kg.m2}\n"
        "flight: {position: 0 0 0 m, speed: 1500 m/s, attitude: {pitch: 50 deg}}\n"
        "run: {flight_tolerance: 1e-12}\n");
    ld_rocket_summary rocket = fly_model(&model);
    double l = r0 * v * cos(gamma), p = l * l / GM, a = 1 / (2 / r0 - v * v / GM);
    double e = sqrt(1 - p / a), f0 = acos((p / r0 - 1) / e), f1 = 2 * pi - acos((p / r1 - 1) / e);
    // times by Kepler's equation
    double E0 = 2 * atan(sqrt((1 - e) / (1 + e)) * tan(f0 / 2));
    double E1 = 2 * pi + 2 * atan(sqrt((1 - e) / (1 + e)) * tan(f1 / 2));
    double t = sqrt(a * a * a / GM) * (E1 - e * sin(E1) - E0 + e * sin(E0));
    double v1 = sqrt(GM * (2 / r1 - 1 / a)), arc = f1 - f0;
    double north = asin(sin(latitude) * cos(arc) + cos(latitude) * sin(arc) * cos(azimuth));
    double east = 12 * degree + asin(sin(arc) * sin(azimuth) / cos(north));
    printf("    to %.3f km of arc in %.3f s; the tangent plane is %.1f m off there\n",
           arc * r1 / 1000, t, r0 - r1 * cos(arc));
    CHECK_NEAR("apogee, over its altitude", rocket.flight.apogee_altitude / (a * (1 + e) - R), 1,
               1e-13);
    CHECK_NEAR("apogee above ground, relative", rocket.flight.apogee / (a * (1 + e) - r1), 1,
               1e-13);
    CHECK_NEAR("time of flight, relative", rocket.flight.time_of_flight / t, 1, 5e-13);
    CHECK_NEAR("downrange, relative", rocket.flight.downrange / (r1 * sin(arc)), 1, 5e-13);
    CHECK_NEAR("drift [m]", rocket.flight.drift, 0, 5e-9);
    CHECK_NEAR("y of the impact [m]", rocket.final.center[1], r1 * cos(arc) - r0, 2e-8);
    CHECK_NEAR("impact speed, relative", rocket.flight.impact_speed / v1, 1, 2e-13);
    CHECK_NEAR("impact angle [rad]", rocket.flight.impact_angle, acos(l / (r1 * v1)), 2e-13);
    CHECK_NEAR("latitude [rad]", rocket.final.latitude, north, 1e-14);
    CHECK_NEAR("longitude [rad]", rocket.final.longitude, east, 3e-14);
    CHECK_NEAR("altitude of the impact [m]", rocket.final.altitude, 400, 5e-9);
    model_clear(&model);
}

// Without a height of its own the ground is as high as the site: half a circle of the orbit's
// symmetry, the same speed and angle down as up.
static void test_ground_of_site(void **state)
{
    (void)state;
    ld_model model =
        read_text("launchdyn: 1\n"
                  "environment: {earth: {model: round, rotation: 0 rad/s}, atmosphere: none,\n"
                  "  site: {altitude: 1000 m}}\n"
                  "rocket: {mass: 10 kg, inertia: 0.1 1 1 kg.m2}\n"
                  "flight: {position: 0 0 0 m, speed: 500 m/s, attitude: {pitch: 50 deg}}\n"
                  "run: {flight_tolerance: 1e-12}\n");
    ld_rocket_summary rocket = fly_model(&model);
    CHECK_NEAR("altitude of the impact [m]", rocket.final.altitude, 1000, 5e-9);
    CHECK_NEAR("impact speed [m/s]", rocket.flight.impact_speed, 500, 2e-10);
    CHECK_NEAR("impact angle [deg]", rocket.flight.impact_angle / degree, 50, 2e-11);
    model_clear(&model);
}

// Thrust along x without gravity: v = u ln(m0/m), with u the exhaust speed I/m_p of constant
// thrust; the burn-out instant is a corner of the table.
static void test_rocket_equation(void **state)
{
    (void)state;
    ld_model model =
        read_text("launchdyn: 1\n"
                  "environment: {atmosphere: none, gravity: 0 m/s2, ground: none}\n"
                  "rocket:\n"
                  "  {mass: 60 kg, center: 1.1 0 0 m, inertia: 0.2 24 24 kg.m2,\n"
                  "   empty: {mass: 40 kg, center: 1.3 0 0 m, inertia: 0.1 18 18 kg.m2},\n"
                  "   motor: {thrust: [[0 s, 0 kN], [0 s, 10 kN], [2 s, 10 kN], [2 s, 0 kN]]}}\n"
                  "flight: {ignition: 0.5 s, position: 0 0 0 m, velocity: 0 0 0 m/s}\n"
                  "run: {end: 3 s}\n");
    ld_rocket_summary rocket = fly_model(&model);
    // x of the mass centre: integral of u ln(m0/m), and its own way in the rocket
    double u = 20000.0 / 20, m0 = 60, m = 40, rate = 10;
    double v = u * log(m0 / m);
    double x = u * 2 - u * m / rate * log(m0 / m) + v * 1;
    CHECK_NEAR("speed after burn-out [m/s]", rocket.final.velocity[0], v, 2e-6);
    CHECK_NEAR("rear adaptor [m]", rocket.final.position[0], x, 3e-6);
    CHECK_NEAR("mass centre [m]", rocket.final.center[0], x + 1.3, 3e-6);
    CHECK_NEAR("end [s]", rocket.final.t, 3.5, 0);
    model_clear(&model);
}

// A free body without symmetry: energy and angular momentum in inertial axes.
static void test_free_body(void **state)
{
    (void)state;
    ld_model model = read_text(
        "launchdyn: 1\n"
        "environment: {atmosphere: none, ground: none}\n"
        "rocket: {mass: 5 kg, center: 1 0.1 0 m, inertia: 2 3 4 kg.m2, products_of_inertia: 0.1 "
        "-0.2 0.3 kg.m2}\n"
        "flight: {position: 0 0 0 m, velocity: 1 2 3 m/s, rate: 0.1 4 0.2 rad/s}\n"
        "run: {end: 20 s, flight_tolerance: 1e-12}\n");
    recorded_run run;
    recorded_run_make(&run, &model);
    size_t q = recorded_column(&run, "rocket.q0"), w = recorded_column(&run, "rocket.wx");
    double first[4] = {0}, momentum = 0, energy = 0;
    for (size_t row = 0; row < run.rows; row++) {
        m3 A = q_matrix((quat){recorded_value(&run, row, q), recorded_value(&run, row, q + 1),
                               recorded_value(&run, row, q + 2), recorded_value(&run, row, q + 3)});
        v3 rate = v3_make(recorded_value(&run, row, w), recorded_value(&run, row, w + 1),
                          recorded_value(&run, row, w + 2));
        v3 L = m3_apply((m3){{{2, 0.1, -0.2}, {0.1, 3, 0.3}, {-0.2, 0.3, 4}}}, rate);
        double T = 0.5 * v3_dot(rate, L);
        L = m3_apply(A, L);
        if (row == 0) {
            v3_store(first, L);
            first[3] = T;
        }
        momentum = fmax(momentum, v3_norm(v3_sub(L, v3_from(first))) / v3_norm(v3_from(first)));
        energy = fmax(energy, fabs(T / first[3] - 1));
    }
    CHECK_BELOW("angular momentum, relative", momentum, 1e-11);
    CHECK_BELOW("energy, relative", energy, 1e-11);
    recorded_run_free(&run);
    model_clear(&model);
}

// A symmetric body precesses about its angular momentum at L/J_t; its axis keeps the angle.
static void test_precession(void **state)
{
    (void)state;
    ld_model model =
        read_text("launchdyn: 1\n"
                  "environment: {atmosphere: none, ground: none}\n"
                  "rocket: {mass: 60 kg, center: 1.1 0 0 m, inertia: 0.22 24 24 kg.m2}\n"
                  "flight: {position: 0 0 0 m, velocity: 0 0 0 m/s, rate: 60 0.1 0 rad/s}\n"
                  "run: {end: 7 s, flight_tolerance: 1e-12}\n");
    ld_rocket_summary rocket = fly_model(&model);
    // about L the axis turns by L/J_t t, about itself the body by w_x (1 - J_x/J_t) t
    double Lx = 0.22 * 60, Ly = 24 * 0.1, L = hypot(Lx, Ly), angle = L / 24 * 7;
    v3 n = v3_make(Lx / L, Ly / L, 0), e = v3_make(1, 0, 0);
    v3 axis = v3_add(v3_scale(cos(angle), e), v3_add(v3_scale(sin(angle), v3_cross(n, e)),
                                                     v3_scale((1 - cos(angle)) * v3_dot(n, e), n)));
    m3 A = q_matrix(q_from(rocket.final.quaternion));
    double own = -60 * (1 - 0.22 / 24) * 7;
    CHECK_BELOW("axis", v3_norm(v3_sub(m3_column(A, 0), axis)), 1e-11);
    CHECK_NEAR("rate about y", rocket.final.rate[1], 0.1 * cos(own), 1e-11);
    CHECK_NEAR("rate about z", rocket.final.rate[2], 0.1 * sin(own), 1e-11);
    model_clear(&model);
}

// A torque fixed in a spinning body (thrust beside the axis, mass constant): in B the lateral rate
// obeys w_y_dot = k w_z, w_z_dot = M/J - k w_y, k = (1 - J_x/J_t) p, so w_z = M/(J k) sin k t.
static void test_body_fixed_torque(void **state)
{
    (void)state;
    ld_model model =
        read_text("launchdyn: 1\n"
                  "environment: {atmosphere: none, ground: none}\n"
                  "rocket:\n"
                  "  {mass: 60 kg, inertia: 0.22 24 24 kg.m2, propellant: 0 kg,\n"
                  "   empty: {mass: 40 kg, center: 0 0 0 m, inertia: 0.22 24 24 kg.m2},\n"
                  "   motor: {thrust: [[0 s, 0 kN], [0 s, 15 kN], [10 s, 15 kN]], at: 0 -1 0 mm}}\n"
                  "flight: {position: 0 0 0 m, velocity: 0 0 0 m/s, rate: 30 0 0 rad/s}\n"
                  "run: {end: 5 s, flight_tolerance: 1e-11}\n");
    ld_rocket_summary rocket = fly_model(&model);
    double k = (1 - 0.22 / 24) * 30, M = 15000 * 1e-3;
    CHECK_NEAR("rate about y", rocket.final.rate[1], M / (24 * k) * (1 - cos(k * 5)), 1e-11);
    CHECK_NEAR("rate about z", rocket.final.rate[2], M / (24 * k) * sin(k * 5), 1e-11);
    CHECK_NEAR("spin", rocket.final.rate[0], 30, 1e-12);
    model_clear(&model);
}

// Falling from rest: v = v_t tanh(g t/v_t), fallen v_t^2/g ln cosh(g t/v_t).
static void test_terminal_speed(void **state)
{
    (void)state;
    ld_model model = read_text(
        "launchdyn: 1\n"
        "environment: {atmosphere: {density: 1.2 kg/m3, speed_of_sound: 340 m/s}, ground: none}\n"
        "rocket: {mass: 3 kg, inertia: 1 1 1 kg.m2, aerodynamics: {model: body, area: 0.1 m2, "
        "drag: "
        "0.5}}\n"
        "flight: {position: 0 0 0 m, velocity: 0 0 0 m/s}\n"
        "run: {end: 10 s, flight_tolerance: 1e-10}\n");
    ld_rocket_summary rocket = fly_model(&model);
    double v = sqrt(2 * 3 * g / (1.2 * 0.1 * 0.5));
    CHECK_NEAR("speed [m/s]", -rocket.final.velocity[1], v * tanh(g * 10 / v), 1e-9);
    CHECK_NEAR("fallen [m]", -rocket.final.position[1], v * v / g * log(cosh(g * 10 / v)), 2e-8);
    model_clear(&model);
}

// Constant coefficients in uniform air along a straight level course without drag: roll obeys
// J p_dot = 1/2 rho V^2 S d (Cl_delta delta + Cl_p p d/(2 V)), so p = p_s (1 - exp(-t/tau)).
static void test_fin_cant(void **state)
{
    (void)state;
    ld_model model = read_text(
        "launchdyn: 1\n"
        "environment: {atmosphere: {density: 1.2 kg/m3, speed_of_sound: 340 m/s}, gravity: 0 m/s2, "
        "ground: none}\n"
        "rocket:\n"
        "  {mass: 60 kg, inertia: 0.2 24 24 kg.m2, aerodynamics: {reference_diameter: 0.16 m,\n"
        "   fin_cant: 1 deg, table: [[0, 0, 0, 6, -0.3 m, 5, -7, -300], [2, 0, 0, 6, -0.3 m, 5, "
        "-7, "
        "-300]]}}\n"
        "flight: {position: 0 0 0 m, velocity: 300 0 0 m/s}\n"
        "run: {end: 0.7 s, flight_tolerance: 1e-11}\n");
    ld_rocket_summary rocket = fly_model(&model);
    double S = acos(-1) * 0.16 * 0.16 / 4, V = 300, d = 0.16;
    double torque = 0.5 * 1.2 * V * V * S * d * 5 * degree;
    double damping = 0.5 * 1.2 * V * S * d * d / 2 * 7;
    CHECK_NEAR("spin [rad/s]", rocket.final.rate[0],
               torque / damping * (1 - exp(-damping * 0.7 / 0.2)), 1e-9);
    model_clear(&model);
}

// Small pitch oscillation of a stable body: q_dd + 2 n q_d + w^2 q = 0 for the angle to a straight
// fast course (mass so great that the course stays straight).
static void test_pitch_oscillation(void **state)
{
    (void)state;
    ld_model model = read_text(
        "launchdyn: 1\n"
        "environment: {atmosphere: {density: 1.2 kg/m3, speed_of_sound: 340 m/s}, gravity: 0 m/s2, "
        "ground: none}\n"
        "rocket:\n"
        "  {mass: 1e9 kg, center: 1 0 0 m, inertia: 0.2 24 24 kg.m2, aerodynamics:\n"
        "   {reference_diameter: 0.16 m, table: [[0, 0, 0, 6, 0.7 m, 5, -7, -300], [2, 0, 0, 6, "
        "0.7 "
        "m, 5, -7, -300]]}}\n"
        "flight: {position: 0 0 0 m, point: center, velocity: 300 0 0 m/s, rate: 0 0 1e-6 rad/s}\n"
        "run: {end: 1.3 s, flight_tolerance: 1e-13}\n");
    ld_rocket_summary rocket = fly_model(&model);
    double S = acos(-1) * 0.16 * 0.16 / 4, V = 300, d = 0.16, q = 0.5 * 1.2 * V * S;
    double n = q * d * d / 2 * 300 / 24 / 2, w = sqrt(q * V * 6 * 0.3 / 24 - n * n);
    double t = 1.3, expected = 1e-6 * exp(-n * t) * (cos(w * t) - n / w * sin(w * t));
    CHECK_NEAR("pitch rate [rad/s]", rocket.final.rate[2] * 1e6, expected * 1e6, 2e-6);
    model_clear(&model);
}

// How a flight that cannot be flown ends.
static void expect_failure(const char *text, const char *message)
{
    ld_model model = read_text(text);
    static ld_summary summary;
    ld_simulation *simulation;
    ld_error error;
    assert_int_equal(ld_simulation_create(&model, &simulation, &error), LD_OK);
    assert_int_equal(ld_simulation_run(simulation, NULL, &summary, &error), LD_ERR_LAUNCH);
    printf("    %s\n", error.text);
    assert_non_null(strstr(error.text, message));
    assert_false(summary.complete);
    ld_simulation_free(simulation);
    model_clear(&model);
}

static void test_failures(void **state)
{
    (void)state;
    expect_failure("launchdyn: 1\n"
                   "rocket: {mass: 10 kg, inertia: 1 1 1 kg.m2}\n"
                   "flight: {position: 0 -1 0 m, velocity: 0 5 0 m/s}\n",
                   "begins below the ground: the mass centre is at y = -1 m");
    expect_failure("launchdyn: 1\n"
                   "environment: {earth: round, ground: 20 m}\n"
                   "rocket: {mass: 10 kg, inertia: 1 1 1 kg.m2}\n"
                   "flight: {position: 0 10 0 m, velocity: 0 5 0 m/s}\n",
                   "begins below the ground: the mass centre is at an altitude of 10 m, the ground "
                   "at 20 m");
    expect_failure("launchdyn: 1\n"
                   "environment: {gravity: 0 m/s2, atmosphere: none}\n"
                   "rocket: {mass: 10 kg, inertia: 1 1 1 kg.m2}\n"
                   "flight: {position: 0 1 0 m, velocity: 0 5 0 m/s}\n",
                   "has not landed within the flight limit of 600 s");
    expect_failure(
        "launchdyn: 1\n"
        "rocket: {mass: 10 kg, inertia: 1 1 1 kg.m2, aerodynamics: {reference_diameter: 0.1 m,\n"
        "  table: [[0, 0, 0, 0, 0 m, 0, 0, 0], [0.3, 0, 0, 0, 0 m, 0, 0, 0]]}}\n"
        "flight: {position: 0 3000 0 m, velocity: 80 0 0 m/s}\n",
        "rocket.aerodynamics.table: ends at Mach 0.3; the rocket exceeds it at t = ");
}

// A start on the ground, upwards and downwards; a flight of one long step.
static void test_ground(void **state)
{
    (void)state;
    ld_model model = read_text("launchdyn: 1\n"
                               "environment: {atmosphere: none}\n"
                               "rocket: {mass: 10 kg, inertia: 0.1 1 1 kg.m2}\n"
                               "flight: {position: 0 0 0 m, velocity: 1 3 0 m/s}\n"
                               "run: {flight_tolerance: 1e-2}\n");
    ld_rocket_summary rocket = fly_model(&model);
    CHECK_NEAR("hop from the ground [s]", rocket.flight.time_of_flight, 6 / g, 1e-14);
    model.flight.velocity[1] = 0;
    rocket = fly_model(&model);
    CHECK_NEAR("lying on the ground [s]", rocket.flight.time_of_flight, 0, 1e-9);
    model_clear(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_parabola),          cmocka_unit_test(test_ellipse),
        cmocka_unit_test(test_ground_of_site),    cmocka_unit_test(test_rocket_equation),
        cmocka_unit_test(test_free_body),         cmocka_unit_test(test_precession),
        cmocka_unit_test(test_body_fixed_torque), cmocka_unit_test(test_terminal_speed),
        cmocka_unit_test(test_fin_cant),          cmocka_unit_test(test_pitch_oscillation),
        cmocka_unit_test(test_failures),          cmocka_unit_test(test_ground),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
