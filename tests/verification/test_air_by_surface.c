// The air by surface against closed forms: damping of two surfaces, roll of canted fins, the table
// made from them, the wind at each, body lift, and what is looked up against what was given.
#include "support/check.h"

#include <stdlib.h>

#include "math/vectors/quaternion.h"
#include "quantities/summary.h"
#include "support/flight_text.h"
#include "systems/flight/flight.h"

static const double pi = 3.14159265358979323846, degree = 0.017453292519943295;

// Two surfaces as far before as behind the mass centre of slopes that balance: without wind angle
// there is no moment, and w' = -rho V S/(2 J) sum C_i (x_i - c)^2 w.
static void test_pitch_damping(void **state)
{
    (void)state;
    ld_model model = read_text(
        "launchdyn: 1\n"
        "environment: {atmosphere: {density: 1.2 kg/m3, speed_of_sound: 1e5 m/s}, gravity: 0 "
        "m/s2,\n"
        "  ground: none}\n"
        "rocket: {mass: 1e6 kg, center: 1 0 0 m, inertia: 0.2 20 20 kg.m2, aerodynamics:\n"
        "  {model: surfaces, reference_diameter: 0.2 m, axial: 0, surfaces: [\n"
        "    {name: front, at: 2.5 m, slope: 2}, {name: rear, at: 0.25 m, slope: 4}]}}\n"
        "flight: {position: 0 0 0 m, velocity: 200 0 0 m/s, rate: 0 1.5e-4 1e-4 rad/s}\n"
        "run: {end: 4 s, flight_tolerance: 1e-12}\n");
    ld_rocket_summary rocket = fly_model(&model);
    double S = pi * 0.01, sum = 2 * 1.5 * 1.5 + 4 * 0.75 * 0.75;
    double left = exp(-1.2 * 200 * S * sum / (2 * 20) * 4);
    CHECK_NEAR("rate about z over the first", rocket.final.rate[2] / 1e-4, left, 4e-9);
    CHECK_NEAR("rate about y over the first", rocket.final.rate[1] / 1.5e-4, left, 4e-9);
    model_clear(&model);
}

// Canted fins turn until forcing and damping meet: C_l_delta delta V + C_l_p w d/2 = 0; towards
// that with the rate -rho V S d^2 C_l_p/(4 J).
static void test_steady_roll(void **state)
{
    (void)state;
    ld_model model = read_text(
        "launchdyn: 1\n"
        "environment: {atmosphere: {density: 1.2 kg/m3, speed_of_sound: 1e5 m/s}, gravity: 0 "
        "m/s2,\n"
        "  ground: none}\n"
        "rocket: {mass: 10 kg, center: 1 0 0 m, inertia: 0.02 20 20 kg.m2, aerodynamics:\n"
        "  {model: surfaces, reference_diameter: 0.2 m, axial: 0, surfaces: [\n"
        "    {name: fins, at: 0.1 m, slope: 8, roll_forcing: 5, roll_damping: -6, cant: 1 deg,\n"
        "     area: 0.02 m2}]}}\n"
        "flight: {position: 0 0 0 m, velocity: 200 0 0 m/s}\n"
        "run: {end: 0.2 s, flight_tolerance: 1e-12}\n");
    ld_rocket_summary rocket = fly_model(&model);
    double steady = 5 * degree * 200 * 2 / (6 * 0.2);
    double decay = 1.2 * 200 * 0.02 * 0.04 * 6 / (4 * 0.02);
    CHECK_NEAR("roll rate [rad/s]", rocket.final.rate[0], steady * (1 - exp(-decay * 0.2)), 1e-9);
    model.run.end_time = 5;
    rocket = fly_model(&model);
    CHECK_NEAR("steady roll rate [rad/s]", rocket.final.rate[0], steady, 1e-9);
    model_clear(&model);
}

static const char by_surface[] =
    "launchdyn: 1\n"
    "environment: {atmosphere: us1976}\n"
    "rocket: {mass: 20 kg, center: 1 0 0 m, inertia: 0.2 20 20 kg.m2, aerodynamics:\n"
    "  {model: surfaces, reference_diameter: 0.2 m,\n"
    "   axial: [[0, 0.4, 0.3], [0.7, 0.5, 0.35], [1.5, 0.7, 0.6]],\n"
    "   ca_scale: 1.1, cn_scale: 0.9, x_cp_shift: 20 mm, crossflow: {drag: 6, at: 1.2 m},\n"
    "   surfaces: [{name: nose, at: 2.5 m, slope: 2},\n"
    "     {name: tail, at: 0.05 m, slope: [[0, -0.8], [1, -0.9], [2, -0.7]], slope_scale: 1.2},\n"
    "     {name: fins, at: 0.25 m, slope: [[0, 7], [0.5, 7.5], [1.2, 9], [3, 5]], cant: 0.5 deg,\n"
    "      area: 0.03 m2, roll_forcing: [[0, 5], [0.9, 6], [3, 4]], roll_damping: [[0, -7], [3, "
    "-5]]}]}}\n"
    "flight: {position: 0 0 0 m, velocity: 200 0 0 m/s}\n";

// Piecewise monotone cubic of a column, on its own.
static double given(const ld_table *table, size_t column, double mach)
{
    curves one;
    double *pairs = malloc(2 * table->rows * sizeof *pairs), value;
    for (size_t i = 0; i < table->rows; i++) {
        pairs[2 * i] = table->data[i * table->columns];
        pairs[2 * i + 1] = table->data[i * table->columns + column];
    }
    assert_int_equal(curves_build(&one, table->rows, 2, pairs, CURVE_PCHIP, NULL), LD_OK);
    curves_held(&one, mach, &value);
    curves_free(&one);
    free(pairs);
    return value;
}

// The coefficients of all the surfaces together at a Mach number, as a table has them.
typedef struct together {
    double ca[2], slope, first, second, forcing, damping; // sums of C, C x, C x^2
} together;

static together sums_of(const ld_aerodynamics *built, double mach)
{
    double S = pi * built->reference_diameter * built->reference_diameter / 4;
    together sums = {{built->ca_scale * given(&built->axial, 1, mach),
                      built->ca_scale * given(&built->axial, 2, mach)},
                     0,
                     0,
                     0,
                     0,
                     0};
    for (int i = 0; i < built->surface_count; i++) {
        const ld_air_surface *one = &built->surface[i];
        double area = isnan(one->area) ? 1 : one->area / S, x = one->at + built->x_cp_shift;
        double slope = area * built->cn_scale * one->slope_scale * given(&one->slope, 1, mach);
        sums.slope += slope;
        sums.first += slope * x;
        sums.second += slope * x * x;
        if (one->roll_forcing.rows == 0)
            continue;
        sums.forcing += area * one->cant * given(&one->roll_forcing, 1, mach);
        sums.damping += area * given(&one->roll_damping, 1, mach);
    }
    return sums;
}

static air_wrench of(const aerodynamics *built, v3 v, v3 w, v3 c, double mach, bool power)
{
    size_t interval = 0;
    const airflow flow = {v, v3_norm(v), w, c, 1.1, mach};
    return aerodynamics_wrench(built, &flow, power, &interval);
}

// Without rates the surfaces are the table made from them, at any angle and Mach number; with small
// ones what differs is the force -rho V S/2 sum C_i w x (x_i - c) and its moment.
static void test_table_of_surfaces(void **state)
{
    (void)state;
    ld_model model = read_text(by_surface);
    ld_aerodynamics *given_air = &model.rocket.aerodynamics, table = *given_air;
    aerodynamics built;
    assert_int_equal(aerodynamics_build(&built, given_air, NULL), LD_OK);
    CHECK_NEAR("last Mach number", built.last_mach, 1.5, 0);
    assert_string_equal(built.last_of, "rocket.aerodynamics.axial");
    double still = 0, moving = 0, center = 0, S = pi * 0.01;
    const double mach[] = {0, 0.2, 0.5, 0.83, 1, 1.3, 1.5};
    for (int i = 0; i < 7; i++) {
        together sums = sums_of(given_air, mach[i]);
        // one row of that Mach number, so that the table holds it everywhere
        double x_cp = sums.first / sums.slope;
        double row[8] = {0,    sums.ca[0],   sums.ca[1],   sums.slope,
                         x_cp, sums.forcing, sums.damping, 0};
        table.model = LD_AERODYNAMICS_TABLE;
        table.table = (ld_table){1, 8, row};
        table.fin_cant = table.ca_scale = table.cn_scale = 1;
        table.x_cp_shift = 0;
        aerodynamics whole;
        assert_int_equal(aerodynamics_build(&whole, &table, NULL), LD_OK);
        v3 v = v3_make(120 * cos(i), 80 * sin(i), 30), c = v3_make(1, 0.01, -0.02);
        v3 roll = v3_make(12, 0, 0), w = v3_make(0, 3e-6, -2e-6);
        // of a roll about an axis off the centre the surfaces see the lateral velocity, too
        v3 centred = v3_make(1, 0, 0);
        air_wrench a = of(&built, v, roll, centred, mach[i], i & 1);
        air_wrench b = of(&whole, v, roll, centred, mach[i], i & 1);
        still = fmax(still, v3_norm(v3_sub(a.f, b.f)) / v3_norm(b.f));
        still = fmax(still, v3_norm(v3_sub(a.m, b.m)) / v3_norm(b.f));
        a = of(&built, v, v3_zero(), c, mach[i], i & 1);
        b = of(&whole, v, v3_zero(), c, mach[i], i & 1);
        still = fmax(still, v3_norm(v3_sub(a.f, b.f)) / v3_norm(b.f));
        still = fmax(still, v3_norm(v3_sub(a.m, b.m)) / v3_norm(b.f));
        // rates, straight ahead
        v = v3_make(150, 0, 0);
        a = of(&built, v, w, centred, mach[i], i & 1);
        b = of(&whole, v, w, centred, mach[i], i & 1);
        double q = 0.5 * 1.1 * 150 * S, first = sums.first - sums.slope;
        double second = sums.second - 2 * sums.first + sums.slope;
        v3 f = v3_make(0, -q * first * w.z, q * first * w.y);
        v3 m = v3_make(0, -q * second * w.y, -q * second * w.z);
        moving = fmax(moving, v3_norm(v3_sub(v3_sub(a.f, b.f), f)) / v3_norm(f));
        moving = fmax(moving, v3_norm(v3_sub(v3_sub(a.m, b.m), m)) / v3_norm(m));
        center = fmax(center, fabs(aerodynamics_center(&built, mach[i]).at - x_cp));
        center = fmax(center, fabs(aerodynamics_center(&built, mach[i]).slope - sums.slope));
        center = fmax(center, fabs(aerodynamics_center(&whole, mach[i]).at - x_cp));
        aerodynamics_free(&whole);
    }
    CHECK_BELOW("without rates, of force and moment", still, 1e-14);
    CHECK_BELOW("with rates, of what they add", moving, 1e-8);
    CHECK_BELOW("centre of pressure [m] and slope", center, 1e-14);
    // past the last row all stays
    together last = sums_of(given_air, 1.5);
    CHECK_NEAR("slope past the last row", aerodynamics_center(&built, 4).slope, last.slope, 1e-14);
    aerodynamics_free(&built);
    model_clear(&model);
}

// Each force by the local velocity, as far from small angles and rates as one likes.
static void test_large_rates(void **state)
{
    (void)state;
    ld_model model = read_text(by_surface);
    const ld_aerodynamics *given_air = &model.rocket.aerodynamics;
    aerodynamics built;
    assert_int_equal(aerodynamics_build(&built, given_air, NULL), LD_OK);
    v3 v = v3_make(20, -35, 10), w = v3_make(9, -14, 21), c = v3_make(1.1, 0.03, -0.02);
    const double rho = 1.1, S = pi * 0.01, mach = 0.6;
    together sums = sums_of(given_air, mach);
    v3 f = v3_make(-0.5 * rho * S * v3_norm(v) * sums.ca[0] * v.x, 0, 0);
    v3 m = v3_add(
        v3_cross(v3_sub(v3_zero(), c), f),
        v3_make(0.5 * rho * S * 0.2 * v3_norm(v) * (sums.forcing * v.x + sums.damping * 0.1 * w.x),
                0, 0));
    for (int i = 0; i <= given_air->surface_count; i++) {
        const ld_air_surface *one = &given_air->surface[i];
        bool cross = i == given_air->surface_count;
        double x = cross ? 1.2 : one->at + 0.02, area = i == 2 ? 0.03 : S;
        v3 arm = v3_sub(v3_make(x, 0, 0), c), u = v3_add(v, v3_cross(w, arm));
        v3 side = v3_make(0, u.y, u.z);
        double strength =
            cross ? 6 * S * v3_norm(side)
                  : 0.9 * one->slope_scale * area * given(&one->slope, 1, mach) * v3_norm(u);
        v3 force = v3_scale(-0.5 * rho * strength, side);
        f = v3_add(f, force);
        m = v3_add(m, v3_cross(arm, force));
    }
    air_wrench got = of(&built, v, w, c, mach, false);
    CHECK_BELOW("force, relative", v3_norm(v3_sub(got.f, f)) / v3_norm(f), 1e-15);
    CHECK_BELOW("moment, relative", v3_norm(v3_sub(got.m, m)) / v3_norm(m), 2e-15);
    aerodynamics_free(&built);
    model_clear(&model);
}

// A rocket that stands still in a wind that grows with height: each surface sees that of its own,
// upright on a flat Earth and lying along the wind on none at all; the same on a round one.
static void test_wind_at_each(void **state)
{
    (void)state;
    for (int round = 0; round < 2; round++) {
        ld_model model = read_text(
            "launchdyn: 1\n"
            "environment: {atmosphere: {density: 1.2 kg/m3, speed_of_sound: 1e5 m/s}, ground: 0 "
            "m,\n"
            "  wind: {profile: [[0 m, 5 m/s, -2 m/s], [100 m, 45 m/s, 8 m/s]]}}\n"
            "rocket: {mass: 20 kg, center: 1 0 0 m, inertia: 0.2 20 20 kg.m2, aerodynamics:\n"
            "  {model: surfaces, reference_diameter: 0.2 m, axial: 0, crossflow: {drag: 6, at: 1.2 "
            "m},\n"
            "   surfaces: [{name: nose, at: 2.5 m, slope: 2}, {name: fins, at: 0.25 m, slope: "
            "8}]}}\n"
            "flight: {position: 0 40 0 m, velocity: 0 0 0 m/s, attitude: {pitch: 70 deg}}\n");
        if (round) {
            model.environment.earth.kind = LD_EARTH_GIVEN;
            model.environment.earth.model = LD_EARTH_ROUND;
            model.environment.earth.rotation = 0;
        }
        model_complete(&model);
        flight_system system;
        assert_int_equal(flight_build(&system, &model, 0, NULL), LD_OK);
        assert_true(system.feels_shear);
        flight_phase phase = {.t_ignition = INFINITY};
        flight_set_piece(&system, &phase, -1);
        double y[FLIGHT_STATES], y_dot[FLIGHT_STATES];
        flight_start(&system, &phase, &model.flight, y);
        flight_rates(&system, &phase, 0, y, y_dot);
        // by hand: axis up at 70 degrees
        v3 axis = v3_make(cos(70 * degree), sin(70 * degree), 0), f = v3_zero(), m = v3_zero();
        const double at[] = {2.5, 0.25, 1.2}, strength[] = {2, 8, 6};
        for (int i = 0; i < 3; i++) {
            double h = 40 + at[i] * axis.y;
            v3 u = v3_make(-(5 + 0.4 * h), 0, -(-2 + 0.1 * h));
            v3 side = v3_axpy(u, -v3_dot(u, axis), axis);
            double speed = i == 2 ? v3_norm(side) : v3_norm(u);
            v3 force = v3_scale(-0.5 * 1.2 * pi * 0.01 * strength[i] * speed, side);
            f = v3_add(f, force);
            m = v3_add(m, v3_cross(v3_scale(at[i] - 1, axis), force));
        }
        m3 A_CB = q_matrix(q_from(y + FLIGHT_Q));
        m3 A_IC = round ? m3_transpose(system.earth.A_EI) : m3_identity();
        v3 a = m3_apply(
            A_IC,
            v3_sub(v3_from(y_dot + FLIGHT_V),
                   round ? v3_scale(-system.earth.gm / pow(v3_norm(v3_from(y)), 3), v3_from(y))
                         : v3_make(0, -9.80665, 0)));
        v3 alpha = m3_apply(A_IC, m3_apply(A_CB, v3_from(y_dot + FLIGHT_W)));
        printf("%s Earth\n", round ? "round" : "flat");
        CHECK_BELOW("force, relative", v3_norm(v3_sub(v3_scale(20, a), f)) / v3_norm(f),
                    round ? 6e-9 : 1e-14);
        CHECK_BELOW("moment, relative", v3_norm(v3_sub(v3_scale(20, alpha), m)) / v3_norm(m),
                    round ? 6e-9 : 1e-14);
        flight_free(&system);
        model_clear(&model);
    }
}

// By shape: a flight of nose, body, tail and fins is that of the coefficients that Barrowman's
// formulas make of them; body lift K A sin^2 across the wind.
static void test_shapes(void **state)
{
    (void)state;
    ld_model model = read_text(
        "launchdyn: 1\n"
        "environment: {atmosphere: us1976}\n"
        "rocket: {mass: 20 kg, center: 1 0 0 m, inertia: 0.2 20 20 kg.m2, aerodynamics:\n"
        "  {model: surfaces, reference_diameter: 0.2 m, axial: 0.4, surfaces: [\n"
        "   {name: nose, kind: nose, shape: cone, at: 2.5 m, length: 0.6 m, radius: 0.1 m,\n"
        "    body_lift: 1.5},\n"
        "   {name: body, kind: body, at: 1.9 m, length: 1.8 m, radius: 0.1 m, body_lift: 1.2},\n"
        "   {name: tail, kind: tail, at: 0.1 m, length: 0.1 m, front_radius: 0.1 m,\n"
        "    rear_radius: 0.06 m},\n"
        "   {name: fins, kind: fins, at: 0.5 m, fin_count: 4, root_chord: 0.3 m, tip_chord: 0.2 "
        "m,\n"
        "    span: 0.2 m, sweep_length: 0.1 m, radius: 0.1 m, cant: 1 deg, slope_scale: 1.1}]}}\n"
        "flight: {position: 0 0 0 m, velocity: 200 0 0 m/s}\n");
    aerodynamics built;
    assert_int_equal(aerodynamics_build(&built, &model.rocket.aerodynamics, NULL), LD_OK);
    assert_int_equal(built.surfaces.slopes, 3);
    assert_int_equal(built.surfaces.acrosses, 2);
    CHECK_NEAR("last Mach number, of the fins", built.last_mach, 10, 0);
    assert_string_equal(built.last_of, "rocket.aerodynamics.surfaces.fins");
    // slopes by Barrowman's book: cone, frustum, four fins
    double error = 0, place = 0, roll = 0, S = pi * 0.01;
    const double middle = hypot(0.2, 0.1 + 0.5 * (0.2 - 0.3));
    const double fins_at = 0.5 - (0.1 / 3 * 0.7 / 0.5 + (0.5 - 0.06 / 0.5) / 6);
    for (double mach = 0; mach < 9.9; mach += 0.013) {
        double beta =
            mach < 0.8 ? sqrt(1 - mach * mach) : fmax(0.6, mach > 1 ? sqrt(mach * mach - 1) : 0);
        double fins = 1.1 * (1 + 0.1 / 0.3) * 16 / (1 + sqrt(1 + pow(beta * 2 * middle / 0.5, 2)));
        double slope = 2 + 2 * (0.36 - 1) + fins;
        double tail_at = 0.1 - 0.1 / 3 * (1 + 0.06 / 0.16);
        air_center all = aerodynamics_center(&built, mach);
        error = fmax(error, fabs(all.slope / slope - 1));
        place = fmax(place, fabs(all.at - (2 * 2.1 - 1.28 * tail_at + fins * fins_at) / slope));
        // 2 K_f (y + r) cant/K of forcing and slope at every Mach number, K_f = 0.934919701494 at
        // tau = 3 by RocketPy's text of the formula
        air_wrench one = of(&built, v3_make(100, 0, 0), v3_zero(), v3_make(1, 0, 0), mach, false);
        roll = fmax(roll, fabs(one.m.x / (fins * 0.5 * 1.1 * 1e4 * S) - 0.00473205383952397));
    }
    CHECK_BELOW("slope up to Mach 10, relative", error, 1.6e-7);
    CHECK_BELOW("centre of pressure [m]", place, 1.6e-7);
    CHECK_BELOW("roll moment over the fins' force [m]", roll, 2e-9);
    // across the wind: what is left of the slopes, and the lift of the areas from the side
    air_wrench with = of(&built, v3_make(0, 50, 0), v3_zero(), v3_make(1, 0, 0), 0.1, false);
    for (int i = 0; i < 2; i++)
        model.rocket.aerodynamics.surface[i].body_lift = 0;
    aerodynamics_free(&built);
    assert_int_equal(aerodynamics_build(&built, &model.rocket.aerodynamics, NULL), LD_OK);
    assert_int_equal(built.surfaces.acrosses, 0);
    air_wrench without = of(&built, v3_make(0, 50, 0), v3_zero(), v3_make(1, 0, 0), 0.1, false);
    double nose = 1.5 * 0.06 * 0.5 * 1.1 * 2500, body = 1.2 * 0.36 * 0.5 * 1.1 * 2500;
    CHECK_NEAR("lift of nose and body [N]", without.f.y - with.f.y, nose + body, 1e-5);
    CHECK_NEAR("its moment [N m]", without.m.z - with.m.z, nose * 1.1 + body * 0, 1e-5);
    aerodynamics_free(&built);
    // of an ellipsoid the area from the side has its centre 4/(3 pi) of its length before its base
    model.rocket.aerodynamics.surface[0].shape = LD_NOSE_ELLIPSOID;
    air_wrench lift[2];
    for (int i = 0; i < 2; i++) {
        model.rocket.aerodynamics.surface[0].body_lift = i;
        assert_int_equal(aerodynamics_build(&built, &model.rocket.aerodynamics, NULL), LD_OK);
        lift[i] = of(&built, v3_make(0, 50, 0), v3_zero(), v3_make(1, 0, 0), 0.1, false);
        aerodynamics_free(&built);
    }
    nose = pi / 2 * 0.1 * 0.6 * 0.5 * 1.1 * 2500;
    CHECK_NEAR("lift of an ellipsoid [N]", lift[0].f.y - lift[1].f.y, nose, 1e-5);
    CHECK_NEAR("its moment [N m]", lift[0].m.z - lift[1].m.z,
               nose * (2.5 - 0.6 * (1 - 4 / (3 * pi)) - 1), 1e-5);
    model_clear(&model);
}

// The slopes of fins alone, from stubs to wings, over those of Barrowman's formula: what the cubics
// between the Mach numbers of the table leave.
static void test_aspects(void **state)
{
    (void)state;
    ld_model model = read_text(
        "launchdyn: 1\n"
        "environment: {atmosphere: us1976}\n"
        "rocket: {mass: 19 kg, inertia: 0.04 10 10 kg.m2, aerodynamics:\n"
        "  {model: surfaces, reference_diameter: 127 mm, axial: 0.5, surfaces: [\n"
        "   {name: fins, kind: fins, at: 0 m, fin_count: 4, root_chord: 0.1 m, tip_chord: 0.1 m,\n"
        "    span: 0.1 m, radius: 60 mm}]}}\n"
        "flight: {position: 0 0 0 m, velocity: 200 0 0 m/s}\n");
    ld_aerodynamics *shaped = &model.rocket.aerodynamics;
    const double aspect[] = {0.3, 1, 2, 3, 5, 8, 20, 100};
    double usual = 0, wide = 0;
    for (int i = 0; i < 8; i++) {
        aerodynamics built;
        double span = shaped->surface[0].span = 0.05 * aspect[i];
        assert_int_equal(aerodynamics_build(&built, shaped, NULL), LD_OK);
        double S = pi * pow(0.0635, 2), whole = (1 + 0.06 / (0.06 + span)) * 2 * 0.1 * span / S;
        for (double mach = 0; mach < 10; mach += 0.0037) {
            double square = mach < 0.8 ? 1 - mach * mach : fmax(0.36, mach * mach - 1);
            double known =
                whole * 2 * pi * aspect[i] / (2 + sqrt(4 + square * aspect[i] * aspect[i]));
            double off = fabs(aerodynamics_center(&built, mach).slope / known - 1);
            *(aspect[i] > 5 ? &wide : &usual) = fmax(aspect[i] > 5 ? wide : usual, off);
        }
        aerodynamics_free(&built);
    }
    CHECK_BELOW("slope up to an aspect ratio of 5, relative", usual, 2.4e-7);
    CHECK_BELOW("slope up to one of 100, relative", wide, 1.3e-6);
    model_clear(&model);
}

// Calisto of RocketPy's documentation, places from its reference: slope and centre of pressure at
// four Mach numbers as RocketPy 1.12 computes them.
static void test_calisto(void **state)
{
    (void)state;
    ld_model model = read_text(
        "launchdyn: 1\n"
        "environment: {atmosphere: us1976}\n"
        "rocket: {mass: 19 kg, inertia: 0.04 10 10 kg.m2, aerodynamics:\n"
        "  {model: surfaces, reference_diameter: 127 mm, axial: 0.5, surfaces: [\n"
        "   {name: nose, kind: nose, shape: von-karman, at: 1.16 m, length: 0.55829 m, radius: "
        "63.5 "
        "mm},\n"
        "   {name: fins, kind: fins, at: -1.168 m, fin_count: 4, root_chord: 0.12 m, tip_chord: "
        "0.04 "
        "m,\n"
        "    span: 0.1 m, sweep_length: 0.08 m, radius: 63.5 mm},\n"
        "   {name: tail, kind: tail, at: -1.313 m, length: 0.06 m, front_radius: 63.5 mm,\n"
        "    rear_radius: 43.5 mm}]}}\n"
        "flight: {position: 0 0 0 m, velocity: 200 0 0 m/s}\n");
    const double mach[] = {0, 0.3, 0.6, 0.9};
    const double slope[] = {6.083304594625116, 6.179948160269106, 6.5152609499214735,
                            6.9647111402943285};
    const double at[] = {-0.5107063800805572, -0.5218454047825836, -0.5579308517212458,
                         -0.6008494235447952};
    aerodynamics built;
    assert_int_equal(aerodynamics_build(&built, &model.rocket.aerodynamics, NULL), LD_OK);
    for (int i = 0; i < 4; i++) {
        air_center all = aerodynamics_center(&built, mach[i]);
        CHECK_NEAR("slope", all.slope, slope[i], 4e-15);
        CHECK_NEAR("centre of pressure [m]", all.at, at[i], 4e-11);
    }
    aerodynamics_free(&built);
    model_clear(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pitch_damping),
        cmocka_unit_test(test_steady_roll),
        cmocka_unit_test(test_table_of_surfaces),
        cmocka_unit_test(test_large_rates),
        cmocka_unit_test(test_wind_at_each),
        cmocka_unit_test(test_calisto),
        cmocka_unit_test(test_shapes),
        cmocka_unit_test(test_aspects),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
