// Beams whose axial forces stiffen or soften bending (theory-tube.md): buckling loads and
// frequencies of rotating beams against closed forms and against independent finite elements.
#include "launchdyn/mstmm.h"

#include <stdlib.h>

#include "math/matrices/lapack.h"
#include "support/check.h"
#include "support/frame_elements.h"

static const double PI = 3.14159265358979323846;

enum { MOST = 96 };

static const ld_section heavy = {.mass_per_length = 2,
                                 .axial_stiffness = 1e9,
                                 .bending_stiffness = 50,
                                 .torsion_stiffness = 40,
                                 .polar_inertia = 1e-3};
static const double length = 0.8;

// Mass at a tip that bears nearly all of the load, and how much of the beam's weight counts as if
// it were there: by the work on the slope's square, sin^2 of a quarter wave.
static const double tip_mass = 1e5;

static double all_mass(void)
{
    return tip_mass + heavy.mass_per_length * length * (0.5 - 2 / (PI * PI));
}

static ld_mstmm_beam beam_of(int modes)
{
    return (ld_mstmm_beam){.length = length,
                           .section_count = 1,
                           .section = &heavy,
                           .bending = modes,
                           .elements = 60,
                           .geometric_stiffness = 1};
}

static ld_mstmm *build(const ld_mstmm_element *e, int elements, const ld_mstmm_loop *loop,
                       double gravity)
{
    const ld_mstmm_description all = {.elements = e,
                                      .element_count = elements,
                                      .loops = loop,
                                      .loop_count = loop != NULL,
                                      .gravity = {-gravity, 0, 0}};
    ld_mstmm *system;
    ld_error error = {0};
    if (ld_mstmm_build(&all, &system, &error))
        fail_msg("%s", error.text);
    return system;
}

// Square [1/s2] of the lowest natural frequency at q = 0, with a force on the last speed, that of
// a slide; negative where it is unstable.
static double lowest_square(ld_mstmm *system, double on_slide)
{
    ld_error error = {0};
    ld_mstmm_mode mode[MOST];
    double q[MOST], u[MOST] = {0}, tau[MOST] = {0}, lowest = INFINITY;
    int count;
    ld_mstmm_reference(system, q);
    if (ld_mstmm_loop_count(system))
        tau[ld_mstmm_speed_count(system) - 1] = on_slide;
    if (ld_mstmm_loop_count(system) && ld_mstmm_assemble(system, q, u, NULL, NULL, &error))
        fail_msg("%s", error.text);
    if (ld_mstmm_vibration(system, q, tau, mode, NULL, &count, &error))
        fail_msg("%s", error.text);
    for (int i = 0; i < count; i++) {
        double w = 2 * PI * mode[i].frequency;
        double rate = mode[i].rate;
        lowest = fmin(lowest, w > 0 ? w * w - 2 * rate * rate : -rate * rate);
    }
    ld_mstmm_free(system);
    return lowest;
}

typedef ld_mstmm *loaded(int modes, double gravity);

// Mass of a slide, whose weight is held from outside or which a force presses.
static const double slide_mass = 0.1;

// Gravity at which the lowest frequency vanishes, or force where `held` is a force per unit of it:
// regula falsi in its square.
static double critical(loaded *make, int modes, double guess, double held)
{
    double low = 0.5 * guess, high = 1.05 * guess;
    double below = lowest_square(make(modes, low), held * low);
    double above = lowest_square(make(modes, high), held * high);
    assert_true(below > 0 && above < 0);
    for (int i = 0; i < 60 && high - low > 1e-13 * guess; i++) {
        double middle = low + (high - low) * below / (below - above);
        if (i % 3 == 2)
            middle = 0.5 * (low + high);
        double square = lowest_square(make(modes, middle), held * middle);
        if (square > 0)
            low = middle, below = square;
        else
            high = middle, above = square;
    }
    return 0.5 * (low + high);
}

// Clamped below, with its own weight; with a heavy point at the tip, the beam nearly without mass.
static ld_mstmm *clamped_by_weight(int modes, double gravity)
{
    ld_mstmm_beam beam = beam_of(modes);
    ld_mstmm_element e = {.name = "beam", .hinge = LD_HINGE_WELD, .beam = &beam};
    return build(&e, 1, NULL, gravity);
}

static ld_mstmm *clamped_by_tip(int modes, double gravity)
{
    ld_mstmm_beam beam = beam_of(modes);
    ld_mstmm_element e[2] = {{.name = "beam", .hinge = LD_HINGE_WELD, .beam = &beam},
                             {.name = "tip",
                              .parent = "beam",
                              .at = {length},
                              .hinge = LD_HINGE_WELD,
                              .mass = tip_mass}};
    return build(e, 2, NULL, gravity);
}

// Pinned below; above held across on a slide along the beam.
static ld_mstmm *pinned(int modes, double gravity)
{
    ld_mstmm_beam beam = beam_of(modes);
    ld_mstmm_element e[2] = {
        {.name = "beam", .hinge = LD_HINGE_UNIVERSAL, .axis = {0, 0, 1}, .axis_2 = {0, 1, 0}},
        {.name = "slide",
         .at = {length},
         .hinge = LD_HINGE_PRISMATIC,
         .axis = {1, 0, 0},
         .mass = slide_mass,
         .inertia = {1, 1, 1}}};
    ld_mstmm_loop loop = {.name = "head", .joint = LD_HINGE_SPHERICAL};
    e[0].beam = &beam;
    loop.first.element = "beam";
    loop.first.at[0] = length;
    loop.second.element = "slide";
    return build(e, 2, &loop, gravity);
}

static ld_mstmm *pinned_by_weight(int modes, double gravity)
{
    return pinned(modes, gravity);
}

static ld_mstmm *pinned_by_tip(int modes, double force)
{
    (void)force;
    return pinned(modes, 0);
}

// Buckling load over E I/L^2 by finite elements of cubic shapes.
static double elements_buckle(bool pinned_ends, bool weight)
{
    enum { COUNT = 40 };
    const double E[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, origin[3] = {0};
    const frame_section unit = {.EA = 1e6, .EI_y = 1, .EI_z = 1, .GJ = 1, .mass = 1, .polar = 1};
    frame fe;
    frame_create(&fe);
    int first = frame_beam(&fe, origin, E, 1, COUNT, &unit);
    if (pinned_ends) {
        frame_hold(&fe, first, (const bool[6]){true, true, true, true, false, false});
        frame_hold(&fe, first + COUNT, (const bool[6]){false, true, true, false, false, false});
    } else {
        frame_clamp(&fe, first);
    }
    // constant within elements: second order, taken out by halving
    for (int i = 0; i < COUNT; i++)
        frame_set_tension(&fe, i, weight ? -(COUNT - i - 0.5) / COUNT : -1);
    double factor = frame_buckling(&fe);
    frame_free(&fe);
    return factor;
}

typedef struct buckling_case {
    const char *name;
    loaded *make;
    double mass; // [kg] that weighs
    bool pinned, weight;
    double exact, bound, fe_bound; // load over E I/L^2
} buckling_case;

// Beams that their own weight and a weight at their tip make buckle: Euler 1744, Greenhill 1881.
static void test_buckling_loads(void **state)
{
    (void)state;
    const double own = heavy.mass_per_length * length;
    const buckling_case cases[] = {
        {"clamped, tip force", clamped_by_tip, all_mass(), false, false, PI * PI / 4, 1e-5, 1e-8},
        {"clamped, own weight", clamped_by_weight, own, false, true, 7.83734744, 1e-7, 5e-4},
        {"pinned, tip force", pinned_by_tip, 1, true, false, PI * PI, 3e-5, 1e-7},
        {"pinned, own weight", pinned_by_weight, own, true, true, 18.5687243, 5e-6, 5e-4},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const buckling_case *c = &cases[i];
        double unit = heavy.bending_stiffness / (length * length), load[2];
        for (int k = 0; k < 2; k++)
            load[k] = critical(c->make, k ? 24 : 12, c->exact * unit / c->mass,
                               c->weight ? slide_mass : -1) *
                      c->mass / unit;
        printf("  %s: load %.9g E I/L^2 with 24 modes, off by %.2e with 12\n", c->name, load[1],
               load[0] / c->exact - 1);
        CHECK_BELOW("buckling load, relative to the closed form", load[1] / c->exact - 1, c->bound);
        if (!c->weight) // the shear that a tip's force bears is not that of free modes
            CHECK_WITHIN("order in the number of modes",
                         log2((load[0] / c->exact - 1) / (load[1] / c->exact - 1)), 2.9, 3.1);
        CHECK_BELOW("finite elements, relative",
                    elements_buckle(c->pinned, c->weight) / c->exact - 1, c->fe_bound);
    }
}

// ---- rotating beams

enum { ROTATING = 20 };

// Squares of the frequencies [1/s2] across the plane of rotation (or in it), ascending, of a beam
// clamped on a hub that turns at a rate: from accelerations beside the straight one.
static void rotating_squares(double hub, double rate, bool in_plane, double square[ROTATING])
{
    ld_mstmm_beam beam = beam_of(ROTATING);
    const ld_mstmm_element e[2] = {
        {.name = "hub", .hinge = LD_HINGE_REVOLUTE, .axis = {0, 0, 1}, .prescribed = 1},
        {.name = "beam", .parent = "hub", .at = {hub}, .hinge = LD_HINGE_WELD, .beam = &beam}};
    const int first = in_plane ? 1 : 1 + ROTATING;
    const double step = 1e-6;
    double q[1 + 2 * ROTATING] = {0}, u[1 + 2 * ROTATING] = {rate}, A[ROTATING * ROTATING];
    ld_mstmm *system = build(e, 2, NULL, 0);
    for (int j = 0; j < ROTATING; j++)
        for (int side = -1; side <= 1; side += 2) {
            double u_dot[1 + 2 * ROTATING];
            q[first + j] = side * step;
            assert_int_equal(ld_mstmm_accelerations(system, q, u, NULL, NULL, u_dot, NULL), LD_OK);
            q[first + j] = 0;
            for (int i = 0; i < ROTATING; i++)
                A[j * ROTATING + i] =
                    (side > 0 ? A[j * ROTATING + i] : 0) - side * u_dot[first + i] / (2 * step);
        }
    assert_int_equal(LAPACKE_dsyev(LAPACK_COL_MAJOR, 'N', 'U', ROTATING, A, ROTATING, square), 0);
    ld_mstmm_free(system);
}

// The same across the plane by finite elements under the axial force m rate^2 int (hub + x) dx.
static void rotating_elements(double hub, double rate, int count, double *omega)
{
    enum { COUNT = 100 };
    const double E[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, origin[3] = {0};
    const double m = heavy.mass_per_length;
    const double EI = heavy.bending_stiffness;
    const frame_section s = {
        .EA = 1e6, .EI_y = EI, .EI_z = EI, .GJ = 1e3, .mass = m, .polar = 1e-3};
    double both[2 * ROTATING]; // planes alike: every frequency twice
    frame fe;
    frame_create(&fe);
    frame_clamp(&fe, frame_beam(&fe, origin, E, length, COUNT, &s));
    for (int i = 0; i < COUNT; i++) {
        double x = length * (i + 0.5) / COUNT;
        double N = hub * (length - x) + 0.5 * (length * length - x * x);
        frame_set_tension(&fe, i, m * rate * rate * N);
    }
    frame_frequencies(&fe, true, 2 * count, both);
    for (int k = 0; k < count; k++)
        omega[k] = both[2 * k];
    frame_free(&fe);
}

// First and second frequency over sqrt(E I/m)/L^2 of a beam clamped in the axis of rotation at 1,
// 2, 3, 6, 12 times that rate: Wright, Smith, Thresher, Wang (1982), Frobenius' series.
static void test_rotating_cantilever(void **state)
{
    (void)state;
    const double unit = sqrt(heavy.bending_stiffness / heavy.mass_per_length) / (length * length);
    const double rate[5] = {1, 2, 3, 6, 12};
    const double exact[5][2] = {{3.6817, 22.1810},
                                {4.1373, 22.6149},
                                {4.7973, 23.3203},
                                {7.3604, 26.8091},
                                {13.1702, 37.6031}};
    double square[ROTATING], still[ROTATING], worst = 0, worst_fe = 0, lag = 0;
    for (int i = 0; i < 5; i++) {
        double omega[2];
        rotating_squares(0, rate[i] * unit, false, square);
        rotating_elements(0, rate[i] * unit, 2, omega);
        for (int k = 0; k < 2; k++) {
            double found = sqrt(square[k]) / unit;
            worst = fmax(worst, fabs(found - exact[i][k]));
            worst_fe = fmax(worst_fe, fabs(sqrt(square[k]) / omega[k] - 1));
        }
        rotating_squares(0, rate[i] * unit, true, still);
        lag = fmax(lag, fabs((square[0] - still[0]) / (rate[i] * rate[i] * unit * unit) - 1));
    }
    CHECK_BELOW("frequencies over sqrt(E I/m)/L^2, printed to 1e-4", worst, 6e-5);
    CHECK_BELOW("against finite elements, relative", worst_fe, 5e-5);
    // in the plane the centrifugal force turns with the beam: less by the square of the rate
    CHECK_BELOW("squares in the plane are less by the rate's, relative", lag, 1e-6);
    double omega[3];
    rotating_squares(0.5, 3 * unit, false, square);
    rotating_elements(0.5, 3 * unit, 3, omega);
    for (int k = 0; k < 3; k++)
        CHECK_BELOW("on a hub of 0.5 m, against finite elements, relative",
                    sqrt(square[k]) / omega[k] - 1, 5e-5);
}

// Southwell: omega^2 = omega_0^2 + s rate^2, s by Rayleigh's quotient of the mode at rest,
// int N b'^2 dx with N = m (L^2 - x^2)/2 at unit rate, exact in the limit of small rates.
static void test_southwell_coefficients(void **state)
{
    (void)state;
    const double root[3] = {1.87510406871196, 4.69409113297417, 7.85475743823761};
    double square[2][ROTATING];
    const double rate = 0.5;
    rotating_squares(0, 0, false, square[0]);
    rotating_squares(0, rate, false, square[1]);
    for (int k = 0; k < 3; k++) {
        enum { POINTS = 4000 };
        double sum = 0, mass = 0, z = root[k];
        double ratio = (cosh(z) + cos(z)) / (sinh(z) + sin(z));
        for (int i = 0; i < POINTS; i++) {
            double x = (i + 0.5) / POINTS, c = z * x;
            double b = cosh(c) - cos(c) - ratio * (sinh(c) - sin(c));
            double slope = z * (sinh(c) + sin(c) - ratio * (cosh(c) - cos(c)));
            sum += 0.5 * (1 - x * x) * slope * slope / POINTS;
            mass += b * b / POINTS;
        }
        double found = (square[1][k] - square[0][k]) / (rate * rate);
        CHECK_BELOW("Southwell's coefficient, relative", found * mass / sum - 1, 1e-5);
    }
}

// ---- a rail that stands

// Deflection of the tip of a rail clamped below, `lean` off the vertical: with n = m g cos(lean)
// and p = m g sin(lean) its slope at xi from the tip follows E I s'' + n xi s = p xi, s'(0) = s(L)
// = 0, so s = p/n (1 - A(xi)/A(L)) with Airy's series A'' = -n/(E I) xi A, A(0) = 1, A'(0) = 0.
static double sag_of_series(double gravity, double lean)
{
    const double EI = heavy.bending_stiffness, m = heavy.mass_per_length;
    double c = m * gravity * cos(lean) / EI * length * length * length;
    double term = 1, A = 1, integral = 1;
    for (int k = 3; k < 60; k += 3) {
        term *= -c / (k * (k - 1));
        A += term;
        integral += term / (k + 1);
    }
    return length * tan(lean) * (1 - integral / A);
}

// The same with `modes` bending modes: modal forces needed at rest are linear in q.
static double sag_of_modes(int modes, double gravity, double lean, bool geometric)
{
    ld_mstmm_beam beam = beam_of(modes);
    beam.geometric_stiffness = geometric;
    const ld_mstmm_element e = {.name = "rail", .hinge = LD_HINGE_WELD, .beam = &beam};
    const ld_mstmm_description all = {.elements = &e,
                                      .element_count = 1,
                                      .gravity = {-gravity * cos(lean), -gravity * sin(lean), 0}};
    ld_mstmm *system;
    assert_int_equal(ld_mstmm_build(&all, &system, NULL), LD_OK);
    const double zero[MOST] = {0}, tip[3] = {length, 0, 0};
    double q[MOST] = {0}, needed[MOST], K[MOST * MOST], at_rest[MOST];
    lapack_int pivot[MOST];
    ld_mstmm_forces(system, q, zero, zero, NULL, at_rest);
    for (int j = 0; j < modes; j++) {
        q[j] = 1e-3;
        ld_mstmm_forces(system, q, zero, zero, NULL, needed);
        q[j] = 0;
        for (int i = 0; i < modes; i++)
            K[j * modes + i] = (needed[i] - at_rest[i]) / 1e-3;
    }
    for (int i = 0; i < modes; i++)
        q[i] = -at_rest[i];
    assert_int_equal(LAPACKE_dgesv(LAPACK_COL_MAJOR, modes, 1, K, modes, pivot, q, modes), 0);
    double sag = -ld_mstmm_locate(system, q, zero, 0, tip).position[1];
    ld_mstmm_free(system);
    return sag;
}

static void test_standing_rail_sags(void **state)
{
    (void)state;
    const double lean = 0.01, EI = heavy.bending_stiffness;
    const double unit = EI / (heavy.mass_per_length * cos(lean) * length * length * length);
    const double share[3] = {0.3, 0.6, 0.9};
    for (int i = 0; i < 3; i++) {
        double gravity = 7.83734744 * share[i] * unit, exact = -sag_of_series(gravity, lean);
        double without = sag_of_modes(12, gravity, lean, false);
        printf("  weight %.1f of the buckling one: %.6f mm, %.3f times that without\n", share[i],
               1e3 * exact, exact / without);
        CHECK_BELOW("sag of a standing rail, relative",
                    sag_of_modes(12, gravity, lean, true) / exact - 1, 5e-6);
        // to 1 %: a load's deflection grows by 1/(1 - share)
        CHECK_WITHIN("growth by the weight, times 1 - share", exact / without * (1 - share[i]),
                     0.99, 1.01);
    }
}

// ---- shortening

// How far the sections of a bent beam of two elements have moved back, against the integral of half
// the square of the slope, the section's turn about z, by Gauss's rule within each element.
static void test_shortening(void **state)
{
    (void)state;
    static const double at[3] = {-0.7745966692414833770, 0, 0.7745966692414833770};
    static const double weight[3] = {5.0 / 9, 8.0 / 9, 5.0 / 9};
    ld_mstmm_beam beam = beam_of(3);
    beam.elements = 2;
    const ld_mstmm_element e = {.name = "beam", .hinge = LD_HINGE_WELD, .beam = &beam};
    ld_mstmm *system = build(&e, 1, NULL, 0);
    const double q[6] = {0.01, -0.004, 0.002}, zero[6] = {0}, half = 0.5 * length;
    double worst = 0;
    for (int i = 1; i <= 8; i++) {
        double x = length * i / 8, sum = 0;
        for (int k = 0; k < 2; k++) {
            double from = k * half, to = fmin(x, from + half), h = 0.5 * fmax(0, to - from);
            for (int p = 0; p < 3; p++) {
                const double point[3] = {from + h * (1 + at[p]), 0, 0};
                ld_mstmm_point section = ld_mstmm_locate(system, q, zero, 0, point);
                double turn = 2 * asin(section.attitude[3]);
                sum += 0.5 * h * weight[p] * turn * turn;
            }
        }
        const double point[3] = {x, 0, 0};
        double moved = x - ld_mstmm_locate(system, q, zero, 0, point).position[0];
        worst = fmax(worst, fabs(moved / sum - 1));
    }
    CHECK_BELOW("shortening against the slope's square, relative", worst, 1e-11);
    ld_mstmm_free(system);
}

// ---- conservation

// A beam with a body at its end tumbles freely: energy, momenta.
static void test_conservation(void **state)
{
    (void)state;
    ld_mstmm_beam beam = beam_of(4);
    ld_section soft = heavy;
    soft.axial_stiffness = 2e5;
    beam.section = &soft;
    beam.torsion = beam.axial = 1;
    beam.shear_coefficient = 0.6;
    const ld_mstmm_element e[2] = {{.name = "beam", .hinge = LD_HINGE_FREE, .beam = &beam},
                                   {.name = "body",
                                    .parent = "beam",
                                    .at = {length, 0.02, 0},
                                    .hinge = LD_HINGE_REVOLUTE,
                                    .axis = {0, 0, 1},
                                    .mass = 0.7,
                                    .center = {0.1, 0, 0.02},
                                    .inertia = {0.01, 0.02, 0.02}}};
    ld_mstmm *system = build(e, 2, NULL, 0);
    double q[MOST], u[MOST] = {0.3, -0.1, 0.2, 1, 6, 14, 1, 0, 0, 0, -0.7}, before[3], after[3],
                    spin[2][3];
    double worst = 0, most = 0;
    ld_mstmm_reference(system, q);
    u[ld_mstmm_speed_count(system) - 1] = -3;
    const ld_mstmm_settings settings = {.rtol = 1e-10, .atol = 1e-12, .output_step = 0.1};
    ld_mstmm_energies start = ld_mstmm_energy(system, q, u);
    ld_mstmm_momentum(system, q, u, before, spin[0]);
    assert_int_equal(ld_mstmm_integrate(system, &settings, 0, 0.5, q, u, NULL, NULL), LD_OK);
    ld_mstmm_energies end = ld_mstmm_energy(system, q, u);
    ld_mstmm_momentum(system, q, u, after, spin[1]);
    for (int i = 0; i < 3; i++) {
        worst = fmax(worst, fmax(fabs(after[i] - before[i]), fabs(spin[1][i] - spin[0][i])));
        most = fmax(most, fmax(fabs(before[i]), fabs(spin[0][i])));
    }
    printf("  %.3f J, elastic at the end %.3f J\n", start.kinetic, end.elastic);
    CHECK_BELOW("energy of a tumbling beam, relative",
                (end.kinetic + end.elastic) / (start.kinetic + start.elastic) - 1, 1e-10);
    CHECK_BELOW("its momenta, relative", worst / most, 1e-11);
    ld_mstmm_free(system);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_buckling_loads),
        cmocka_unit_test(test_rotating_cantilever),
        cmocka_unit_test(test_southwell_coefficients),
        cmocka_unit_test(test_standing_rail_sags),
        cmocka_unit_test(test_shortening),
        cmocka_unit_test(test_conservation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
