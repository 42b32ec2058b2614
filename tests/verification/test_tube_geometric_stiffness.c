// Geometric stiffness of the launching tube (theory-tube.md): buckling loads and frequencies of
// standing, hanging and rotating tubes against closed forms, a sag, the energy of a launch.
#include <stdlib.h>

#include "math/matrices/lapack.h"
#include "model/model.h"
#include "state/equilibrium.h"
#include "support/check.h"
#include "support/fresh_launch.h"
#include "support/recorded_run.h"
#include "support/reference_model.h"
#include "systems/launching/launching_dynamics.h"
#include "systems/launching/launching_kinematics.h"

static const double PI = 3.14159265358979323846;
static const double length = 3, line_mass = 4, greenhill = 7.83734744;

enum { MOST = 80 };

// A tube that its rear end holds, stands or hangs; the rocket in it weighs next to nothing.
static void standing_tube(ld_model *model, int modes, double gravity, double bending)
{
    reference_model(model);
    ld_tubes *tubes = &model->tubes;
    model->gravity = gravity;
    model->base.elevation = 0.5 * PI;
    tubes->section[0].mass_per_length = line_mass;
    tubes->section[0].bending_stiffness = bending;
    tubes->tail = (ld_tail){0};
    tubes->modes = (ld_modes){.bending = modes,
                              .torsion = 0,
                              .elements = 60,
                              .span = LD_SPAN_CLAMPED,
                              .geometric_stiffness = LD_GEOMETRIC_YES};
    tubes->support_count = 1;
    tubes->support[0] = (ld_support){.clamped = 0x3f, .stiffness = {NAN, NAN, NAN}};
    tubes->slot.kind = LD_SLOT_NONE;
    ld_rocket *rocket = &model->rocket;
    rocket->full = rocket->empty = (ld_mass_data){1e-6, {0, 0, 0}, {1e-9, 1e-8, 1e-8}};
    rocket->propellant = 0;
    rocket->adaptor_count = 2;
    rocket->contact.law = LD_CONTACT_IDEAL;
}

// Square [1/s2] of the lowest natural frequency; negative where it is unstable. Below `least` in
// size are those that constraints leave at zero.
static double lowest_square(const ld_model *model, double least)
{
    static ld_mode mode[MOST];
    static ld_pole pole[MOST];
    ld_simulation *simulation;
    ld_error error;
    int modes = 0, poles = 0;
    if (ld_simulation_create(model, &simulation, &error) ||
        ld_simulation_system_modes(simulation, mode, MOST, &modes, pole, MOST, &poles, &error))
        fail_msg("%s", error.text);
    ld_simulation_free(simulation);
    double lowest = INFINITY;
    for (int i = 0; i < modes; i++) {
        double square = pow(2 * PI * mode[i].frequency, 2);
        lowest = square > least ? fmin(lowest, square) : lowest;
    }
    for (int i = 0; i < poles; i++) {
        double square = pole[i].real * pole[i].real;
        if (pole[i].imaginary == 0 && pole[i].real > 0 && square > least)
            lowest = fmin(lowest, -square);
    }
    return lowest;
}

// ---- a clamped line under its own weight, by a power series

// Zero where mu omega^2 L^4/(E I) is an eigenvalue of a line clamped below (at 0), whose weight is
// mu g L = load E I/L^2: w'''' + load ((1 - x) w')' = square w, w'' = w''' = 0 at 1.
static double column_determinant(double load, double square)
{
    double end[2][2];
    for (int k = 0; k < 2; k++) {
        double a[84] = {0};
        a[2 + k] = 1;
        end[k][0] = end[k][1] = 0;
        for (int n = 0; n + 4 < 84; n++) {
            double pull = (n + 2) * (n + 1) * a[n + 2] - (n + 1) * (n + 1) * a[n + 1];
            a[n + 4] += (square * a[n] - load * pull) / ((n + 4) * (n + 3) * (n + 2) * (n + 1));
        }
        for (int n = 2; n < 84; n++) {
            end[k][0] += n * (n - 1) * a[n];
            end[k][1] += n * (n - 1) * (n - 2) * a[n];
        }
    }
    return end[0][0] * end[1][1] - end[0][1] * end[1][0];
}

static double column_square(double load)
{
    double low = 0, high = 5;
    while (column_determinant(load, low) * column_determinant(load, high) > 0)
        high += 5;
    for (int i = 0; i < 60; i++) {
        double middle = 0.5 * (low + high);
        if (column_determinant(load, low) * column_determinant(load, middle) > 0)
            low = middle;
        else
            high = middle;
    }
    return 0.5 * (low + high);
}

// Lowest frequencies standing (share of the buckling weight above 0) and hanging.
static void frequencies_under_weight(void **state)
{
    (void)state;
    static const double share[] = {0.3, 0.6, 0.9, -1, -5};
    for (int i = 0; i < 5; i++) {
        const double gravity = 9.81, bending = 40e3;
        double load = greenhill * share[i], unit = bending / pow(length, 3), off[2];
        double weight = fabs(load) * unit / (line_mass * gravity);
        for (int k = 0; k < 2; k++) {
            ld_model model;
            standing_tube(&model, k ? 12 : 6, gravity * weight, bending);
            if (load < 0)
                model.base.elevation = -0.5 * PI;
            double found = lowest_square(&model, 0) * line_mass * length / unit;
            off[k] = sqrt(found / column_square(load)) - 1;
            reference_model_free(&model);
        }
        printf("  weight %4.1f of the buckling one: frequency %.6f of that without, 6 modes off "
               "by %.1e\n",
               share[i], sqrt(column_square(load) / column_square(0)), off[0]);
        CHECK_BELOW("lowest frequency of a standing or hanging tube, relative", off[1], 5e-6);
    }
}

// ---- buckling

typedef void loading(ld_model *model, int modes, double load);

static const double heavy = 1e3, column_bending = 4e8, rocket_at = 2.4;

static void load_own_weight(ld_model *model, int modes, double load)
{
    standing_tube(model, modes, load / (line_mass * length), column_bending);
}

static void load_point_mass(ld_model *model, int modes, double load)
{
    standing_tube(model, modes, load / heavy, column_bending);
    model->tubes.point_mass_count = 1;
    model->tubes.point_mass[0] = (ld_point_mass){.at = length, .mass = heavy};
}

// A rocket that the lock carries, its mass centre at its rear adaptor.
static void load_rocket_weight(ld_model *model, int modes, double load)
{
    standing_tube(model, modes, load / heavy, column_bending);
    model->rocket.start_at = rocket_at;
    model->rocket.adaptor[1].at = 0.5 * (length - rocket_at);
    model->rocket.full = model->rocket.empty = (ld_mass_data){heavy, {0, 0, 0}, {1, 1, 1}};
}

static double square_at(loading *load, int modes, double at)
{
    ld_model model;
    load(&model, modes, at);
    double square = lowest_square(&model, 1e-3 * column_bending / (heavy * pow(length, 3)));
    reference_model_free(&model);
    return square;
}

// Load [N] at which the lowest frequency vanishes, near `guess`: its square on both sides, and
// Neville's rule for the load over the square.
static double critical_load(loading *load, int modes, double guess)
{
    static const double share[4] = {0.97, 0.985, 1.015, 1.03};
    double at[4], square[4];
    for (int i = 0; i < 4; i++) {
        at[i] = share[i] * guess;
        square[i] = square_at(load, modes, at[i]);
    }
    assert_true(square[1] > 0 && square[2] < 0);
    for (int order = 1; order < 4; order++)
        for (int i = 0; i + order < 4; i++)
            at[i] += square[i] * (at[i + 1] - at[i]) / (square[i] - square[i + order]);
    return at[0];
}

// The own weight counts at the top as by the square of the slope of a quarter wave; what stands
// free above the load turns by its greatest slope.
static double top_load(double load, double of_length)
{
    double above = length - of_length;
    double counted = of_length * (0.5 - 2 / (PI * PI)) + above + above * above / of_length;
    return load * (1 + line_mass * counted / heavy);
}

static void buckling_loads(void **state)
{
    (void)state;
    const double unit = column_bending / (length * length);
    const double euler = 0.25 * PI * PI * unit, shorter = euler * pow(length / rocket_at, 2);
    double own = critical_load(load_own_weight, 12, greenhill * unit);
    CHECK_BELOW("buckling by the own weight, relative", own / (greenhill * unit) - 1, 1e-6);
    for (int k = 0; k < 2; k++) {
        double top = top_load(critical_load(load_point_mass, k ? 24 : 12, euler), length);
        double at = top_load(critical_load(load_rocket_weight, k ? 24 : 12, shorter), rocket_at);
        printf("  %d modes: %.2e, %.2e\n", k ? 24 : 12, top / euler - 1, at / shorter - 1);
        if (k) {
            CHECK_BELOW("buckling by a mass at the tip", top / euler - 1, 4e-6);
            CHECK_BELOW("buckling by a rocket on its lock", at / shorter - 1, 5e-6);
        }
    }
}

// ---- sag

// Deflection of the tip of a tube clamped below, `lean` off the vertical: its slope follows Airy's
// equation (test_geometric_stiffness.c), here with load = mu g cos(lean) L^3/(E I).
static double sag_of_series(double load, double lean)
{
    double term = 1, A = 1, integral = 1;
    for (int k = 3; k < 60; k += 3) {
        term *= -load / (k * (k - 1));
        A += term;
        integral += term / (k + 1);
    }
    return length * tan(lean) * (1 - integral / A);
}

static double sag_of_equilibrium(double gravity, double bending, double lean, ld_geometric stiff)
{
    ld_model model;
    fresh_launch launch;
    ld_equilibrium_summary found;
    ld_error error;
    launching_section tip;
    double y[LD_MAX_STATES];
    standing_tube(&model, 12, gravity, bending);
    model.base.elevation -= lean;
    model.tubes.modes.geometric_stiffness = stiff;
    fresh_launch_make(&launch, &model);
    if (simulation_equilibrium(&launch.state, 0, y, &found, &error))
        fail_msg("%s", error.text);
    launching_section_at(&launch.state.launcher.launching, y, length, &tip);
    fresh_launch_free(&launch);
    reference_model_free(&model);
    return tip.P.y;
}

static void sag_of_a_leaning_tube(void **state)
{
    (void)state;
    const double lean = 1e-3, gravity = 9.81;
    for (int i = 1; i <= 3; i++) {
        double load = 0.3 * i * greenhill;
        double bending = line_mass * gravity * cos(lean) * pow(length, 3) / load;
        double exact = sag_of_series(load, lean);
        double without = sag_of_equilibrium(gravity, bending, lean, LD_GEOMETRIC_NO);
        printf("  weight %.1f of the buckling one: %.3f times the sag without\n", 0.3 * i,
               exact / without);
        CHECK_BELOW("sag of a leaning tube, relative",
                    sag_of_equilibrium(gravity, bending, lean, LD_GEOMETRIC_YES) / exact - 1, 5e-6);
    }
}

// ---- rotation

enum { ROTATING = 20 };

// Squares of the frequencies [1/s2] across the plane of rotation, or in it, of a tube clamped to a
// base that turns at a rate: from accelerations beside the straight one.
static void rotating_squares(const launching_system *system, double rate, bool in_plane,
                             double square[ROTATING])
{
    const launching_layout *at = &system->layout;
    const double step = 1e-6;
    const int first = at->q + (in_plane ? 0 : ROTATING);
    double A[ROTATING * ROTATING], y[LD_MAX_STATES] = {0};
    launching_phase phase = {.rocket = false};
    launching_input input = {.base = {.A = m3_identity(), .q = {1, 0, 0, 0}}};
    launching_output out[2];
    input.base.w = v3_make(0, 0, rate);
    y[at->quaternion] = 1;
    y[at->w + 2] = rate;
    for (int j = 0; j < ROTATING; j++) {
        for (int side = 0; side < 2; side++) {
            y[first + j] = (2 * side - 1) * step;
            assert_int_equal(launching_evaluate(system, &input, &phase, y, &out[side]),
                             LAUNCHING_OK);
        }
        y[first + j] = 0;
        for (int i = 0; i < ROTATING; i++) {
            int k = first - at->q + i;
            A[j * ROTATING + i] = -(out[1].q_ddot[k] - out[0].q_ddot[k]) / (2 * step);
        }
    }
    assert_int_equal(LAPACKE_dsyev(LAPACK_COL_MAJOR, 'N', 'U', ROTATING, A, ROTATING, square), 0);
}

// First and second frequency over sqrt(E I/m)/L^2 of a beam clamped in the axis of rotation:
// Wright, Smith, Thresher, Wang (1982), Frobenius' series.
static void rotating_tube(void **state)
{
    (void)state;
    static const double rate[4] = {1, 3, 6, 12};
    static const double exact[4][2] = {
        {3.6817, 22.1810}, {4.7973, 23.3203}, {7.3604, 26.8091}, {13.1702, 37.6031}};
    ld_model model;
    ld_error error;
    standing_tube(&model, ROTATING, 0, 40e3);
    launching_system *system = aligned_alloc(64, (sizeof *system + 63) / 64 * 64);
    assert_int_equal(launching_build(system, &model, NULL, &error), LD_OK);
    const double unit = sqrt(40e3 / line_mass) / (length * length);
    double worst = 0, lag = 0;
    for (int i = 0; i < 4; i++) {
        double across[ROTATING], in_plane[ROTATING];
        rotating_squares(system, rate[i] * unit, false, across);
        rotating_squares(system, rate[i] * unit, true, in_plane);
        for (int k = 0; k < 2; k++)
            worst = fmax(worst, fabs(sqrt(across[k]) / unit - exact[i][k]));
        lag = fmax(lag, fabs((across[0] - in_plane[0]) / pow(rate[i] * unit, 2) - 1));
    }
    CHECK_BELOW("frequencies over sqrt(E I/m)/L^2, printed to 1e-4", worst, 6e-5);
    CHECK_BELOW("squares in the plane are less by the rate's, relative", lag, 1e-6);
    launching_free(system);
    free(system);
    reference_model_free(&model);
}

// ---- launches

// Exit pitch rate [rad/s] and energy residual of a launch from a soft tube on its rear half.
static double soft_launch(ld_geometric stiff, int modes, double *residual)
{
    ld_model model;
    reference_model(&model);
    ld_section *tube = &model.tubes.section[0];
    tube->bending_stiffness *= 0.05;
    model.base.elevation = 1.2;
    model.tubes.support[1].at = 0.9;
    model.tubes.modes.bending = modes;
    model.tubes.modes.geometric_stiffness = stiff;
    model.run.tolerance = 1e-8;
    ld_summary summary = summary_of_run(&model);
    reference_model_free(&model);
    *residual = summary.energy.residual_relative;
    return summary.rocket[0].pitch_rate;
}

static void launches(void **state)
{
    (void)state;
    double residual[2];
    double without = soft_launch(LD_GEOMETRIC_NO, 6, &residual[0]);
    double with = soft_launch(LD_GEOMETRIC_YES, 6, &residual[1]);
    double more = soft_launch(LD_GEOMETRIC_YES, 10, &residual[0]);
    printf("  exit pitch rate %.6f rad/s, without geometric stiffness %.6f, with 10 modes %.6f\n",
           with, without, more);
    CHECK_BELOW("energy residual of a launch from a soft tube", residual[1], 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frequencies_under_weight),
        cmocka_unit_test(buckling_loads),
        cmocka_unit_test(sag_of_a_leaning_tube),
        cmocka_unit_test(rotating_tube),
        cmocka_unit_test(launches),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
