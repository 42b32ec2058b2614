// IFToMM's library of computational benchmarks, A01 to A05, against its figures, the extrapolated
// solution of others, the balance of energy and closed forms. (A01's figures: multibody_motion.)
// ctest: slow
#include "support/check.h"
#include "support/loop_benchmarks.h"

typedef struct state {
    double q[128], u[128];
} state;

static state run(const benchmark *b, double tolerance, double t_0, double t_1, const state *from)
{
    state s;
    size_t nq = (size_t)ld_mstmm_coordinate_count(b->system);
    size_t nu = (size_t)ld_mstmm_speed_count(b->system);
    memcpy(s.q, from ? from->q : b->q, nq * sizeof *s.q);
    memcpy(s.u, from ? from->u : b->u, nu * sizeof *s.u);
    ld_mstmm_settings settings = b->drives;
    settings.rtol = settings.atol = tolerance;
    ld_error error = {0};
    if (ld_mstmm_integrate(b->system, &settings, t_0, t_1, s.q, s.u, NULL, &error))
        fail_msg("%s", error.text);
    return s;
}

static void test_four_bars(void **unused)
{
    (void)unused;
    // N = 2: position and velocity of B_0 at 10 s, Richardson's extrapolation of the published
    // steps
    const double expected[4] = {0.32845810, 0.94451854, 1.42305143, -0.49486881};
    const double top[3] = {0, 1, 0};
    benchmark b = four_bars(2);
    assert_int_equal(b.found.freedoms, 1);
    assert_int_equal(b.found.redundant, 6);
    double energy = benchmark_energy(&b, b.q, b.u), off = 0;
    state s = run(&b, 1e-11, 0, b.end, NULL);
    ld_mstmm_point p = ld_mstmm_locate(b.system, s.q, s.u, 0, top);
    for (int k = 0; k < 2; k++)
        off = fmax(off,
                   fmax(fabs(p.position[k] - expected[k]), fabs(p.velocity[k] - expected[2 + k])));
    CHECK_BELOW("A02, N = 2, at 10 s [m, m/s] (eight digits given)", off, 5e-8);
    CHECK_BELOW("A02, N = 2: energy [J]", benchmark_energy(&b, s.q, s.u) - energy, 1e-8);
    benchmark_free(&b);

    // any N is one pendulum
    const int windows[] = {1, 5, 10, 40};
    for (int i = 0; i < 4; i++) {
        const int n = windows[i];
        b = four_bars(n);
        assert_int_equal(b.found.freedoms, 1);
        assert_int_equal(b.found.redundant, 3 * n);
        energy = benchmark_energy(&b, b.q, b.u);
        s = run(&b, 1e-9, 0, b.end, NULL);
        // theta from upright: (1 + n + 3 n)/6 rate^2 m L^2 + ((n + 1)/2 + n) m g L cos theta
        double inertia = (n + 1) / 3.0 + n, weight = ((n + 1) / 2.0 + n) * 9.81, theta = 0;
        double rate = 1, h = 1e-5;
        for (int k = 0; k < 1000000; k++) {
            double a = weight / inertia * sin(theta), half = rate + 0.5 * h * a;
            theta += h * half;
            rate = half + 0.5 * h * weight / inertia * sin(theta);
        }
        off = 0;
        for (int k = 0; k <= n; k++)
            off = fmax(off, fabs(s.q[k] + theta));
        CHECK_BELOW("A02: all uprights at 10 s against one pendulum [rad]", off, 6e-7);
        CHECK_BELOW("A02: energy over that of the start",
                    (benchmark_energy(&b, s.q, s.u) - energy) / energy, 1e-7);
        benchmark_free(&b);
    }
}

static void test_andrews_squeezer(void **unused)
{
    (void)unused;
    // the start and the state at 0.03 s of the Test Set for IVP Solvers
    const double beta = -0.0617138900142764, gamma = 0.4552798191630704;
    const double expected[7] = {15.81077119629904,   -15.75637105984298, 0.04082224013073101,
                                -0.5347301163226948, 0.5244099658805304, 0.5347301163226948,
                                1.048080741042263};
    benchmark b = andrews_squeezer(beta);
    assert_int_equal(b.found.freedoms, 1);
    assert_int_equal(b.found.redundant, 9);
    CHECK_BELOW("A03: closed from a guess, angle of the triangle [rad]", b.q[2] - gamma, 1e-14);
    double start = squeezer_balance(&b, b.q, b.u, beta), off = 0;
    state s = run(&b, 1e-12, 0, 0.03, NULL);
    // theirs: beta, theta, gamma, phi, delta, omega, epsilon
    const int order[7] = {0, 1, 2, 4, 3, 6, 5};
    for (int k = 0; k < 7; k++)
        off = fmax(off, fabs(s.q[order[k]] - expected[k]));
    CHECK_BELOW("A03 at 0.03 s against the test set [rad]", off, 2e-9);
    s = run(&b, 1e-12, 0.03, 0.05, &s);
    CHECK_BELOW("A03: balance of energy at 0.05 s [J]",
                squeezer_balance(&b, s.q, s.u, beta) - start, 2e-13);
    benchmark_free(&b);
}

static void test_bricard(void **unused)
{
    (void)unused;
    benchmark b = bricard();
    assert_int_equal(b.found.freedoms, 1);
    assert_int_equal(b.found.held, 4);
    double start = benchmark_energy(&b, b.q, b.u), lowest = 0, highest = -1;
    const double corner[3] = {0, -1, 0};
    state s, at = {{0}, {0}};
    memcpy(at.q, b.q, 5 * sizeof *b.q);
    for (int k = 0; k < 1000; k++) {
        s = run(&b, 1e-10, 0.01 * k, 0.01 * (k + 1), &at);
        at = s;
        ld_mstmm_point p = ld_mstmm_locate(b.system, s.q, s.u, 1, corner);
        lowest = fmin(lowest, p.position[2]);
        highest = fmax(highest, p.position[1]);
    }
    CHECK_BELOW("A04: energy at 10 s [J]", benchmark_energy(&b, s.q, s.u) - start, 2e-11);
    CHECK_BELOW("A04: P3 comes to z = -1/2 [m]", lowest + 0.5, 2e-7);
    CHECK_BELOW("A04: P3 comes to y = -sqrt(3)/2 [m]", highest + sqrt(0.75), 2e-7);
    ld_mstmm_point p = ld_mstmm_locate(b.system, s.q, s.u, 1, corner);
    CHECK_WITHIN("A04: P3 at 10 s, x [m] (plot: 0.99)", p.position[0], 0.98, 1);
    benchmark_free(&b);
}

static void test_flyball_governor(void **unused)
{
    (void)unused;
    benchmark b = flyball_governor();
    double largest = 0, least = 1;
    state s, at = {{0}, {0}};
    memcpy(at.q, b.q, 4 * sizeof *b.q);
    memcpy(at.u, b.u, 4 * sizeof *b.u);
    double p_0[3], l_0[3], p[3], l[3];
    ld_mstmm_momentum(b.system, b.q, b.u, p_0, l_0);
    for (int k = 0; k < 100; k++) {
        s = run(&b, 1e-7, 0.1 * k, 0.1 * (k + 1), &at);
        at = s;
        largest = fmax(largest, s.q[1]);
        least = fmin(least, s.q[1]);
    }
    ld_mstmm_momentum(b.system, s.q, s.u, p, l);
    CHECK_WITHIN("A05: largest s [m] (plot: 0.744)", largest, 0.742, 0.746);
    CHECK_WITHIN("A05: s at 10 s [m] (plot: 0.62)", s.q[1], 0.615, 0.625);
    CHECK_WITHIN("A05: least s [m] (plot: 0.5)", least, 0.499, 0.5001);
    CHECK_BELOW("A05: angular momentum about the shaft, relative", l[2] / l_0[2] - 1, 1e-13);
    benchmark_free(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_four_bars),
        cmocka_unit_test(test_andrews_squeezer),
        cmocka_unit_test(test_bricard),
        cmocka_unit_test(test_flyball_governor),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
