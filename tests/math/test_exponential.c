// Exponential Runge-Kutta steps: linear equations to rounding at any step, order 4 and its error's
// order 3 on stiff ones with a known solution, states between a step's ends, integrals.
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "math/matrices/exponential.h"
#include "support/check.h"

enum { N = 4, RUNGS = 5 };

static void check_near(double value, double expected, double away)
{
    if (!(fabs(value - expected) <= away))
        fail_msg("%.17g is %.3g away from %.17g", value, fabs(value - expected), expected);
}

// Two oscillators, one of them stiff, about which L knows all or but a part.
typedef struct oscillators {
    double k[2], c, force, coupling;
    bool moves; // about a point that continues at 30 m/s
} oscillators;

static int slope(double t, const double *y, double *y_dot, void *user)
{
    const oscillators *of = user;
    double at = of->moves ? 30 * t : 0;
    y_dot[0] = y[1];
    y_dot[1] = -of->k[0] * (y[0] - at) - of->c * (y[1] - (of->moves ? 30 : 0)) + of->force +
               of->coupling * sin(y[2]);
    y_dot[2] = y[3];
    y_dot[3] = -of->k[1] * y[2] * (1 + of->coupling * y[2] * y[2]);
    return 0;
}

static exponential *make(const oscillators *of, double longest)
{
    static const int block[N] = {0, 0, 1, 1};
    exponential *self = exponential_new(&(exponential_settings){.n = N,
                                                                .block = block,
                                                                .block_count = 2,
                                                                .longest = longest,
                                                                .rungs = RUNGS,
                                                                .f = slope,
                                                                .self = (void *)of});
    assert_non_null(self);
    for (int b = 0; b < 2; b++) {
        int count;
        double *L = exponential_block(self, b, &count);
        assert_int_equal(count, 2);
        L[0] = 0;
        L[1] = -of->k[b];
        L[2] = 1;
        L[3] = b ? 0 : -of->c;
    }
    assert_int_equal(exponential_prepare(self), 0);
    return self;
}

// Goes to t; the largest error reported on the way.
static double go(exponential *self, const oscillators *of, int rung, double t_end, double y[N])
{
    double drift[N] = {of->moves ? 30 : 0}, f[N], y_end[N], f_end[N], error[N], most = 0;
    int count = (int)lround(t_end / exponential_size(self, rung));
    slope(0, y, f, (void *)of);
    for (int k = 0; k < count; k++) {
        double t = k * exponential_size(self, rung);
        const exponential_start start = {t, y, f, drift};
        const exponential_end end = {y_end, f_end, error};
        assert_int_equal(exponential_step(self, rung, &start, &end), 0);
        memcpy(y, y_end, sizeof y_end);
        memcpy(f, f_end, sizeof f_end);
        most = fmax(most, fabs(error[3]));
    }
    return most;
}

// x'' = -k (x - x_0) - c x'
static void free_oscillation(double k, double c, double x_0, double x, double v, double t,
                             double out[2])
{
    double delta = c / 2, omega = sqrt(k - delta * delta), a = x - x_0, b = (v + delta * a) / omega;
    double decay = exp(-delta * t), cosine = cos(omega * t), sine = sin(omega * t);
    out[0] = x_0 + decay * (a * cosine + b * sine);
    out[1] = decay * ((b * omega - delta * a) * cosine - (a * omega + delta * b) * sine);
}

static void linear_equations_are_exact(void **state)
{
    (void)state;
    const oscillators of = {.k = {4e6, 9}, .c = 40, .force = 3e3};
    for (int rung = 0; rung < RUNGS; rung++) {
        exponential *self = make(&of, 0.04);
        double y[N] = {2e-3, 1, 0.5, -1}, stiff[2], slow[2];
        double error = go(self, &of, rung, 0.4, y);
        free_oscillation(of.k[0], of.c, of.force / of.k[0], 2e-3, 1, 0.4, stiff);
        free_oscillation(of.k[1], 0, 0, 0.5, -1, 0.4, slow);
        check_near(y[0], stiff[0], 1e-14);
        check_near(y[1], stiff[1], 2e-11);
        check_near(y[2], slow[0], 1e-14);
        check_near(y[3], slow[1], 1e-14);
        assert_true(error < 1e-15);
        exponential_free(self);
    }
}

// A motion that all has in common is taken out of L's part, and linear equations stay exact.
static void a_common_motion_does_not_count(void **state)
{
    (void)state;
    const oscillators of = {.k = {4e6, 9}, .c = 40, .moves = true};
    exponential *self = make(&of, 0.04);
    double y[N] = {2e-3, 31, 0, 0}, stiff[2];
    go(self, &of, 1, 0.4, y);
    free_oscillation(of.k[0], of.c, 0, 2e-3, 1, 0.4, stiff);
    check_near(y[0], 12 + stiff[0], 1e-12);
    check_near(y[1], 30 + stiff[1], 1e-9);
    exponential_free(self);
}

// Coupled and bent ones against steps a hundred times shorter.
static void the_order_is_four(void **state)
{
    (void)state;
    const oscillators of = {.k = {4e4, 9}, .c = 40, .coupling = 2};
    const double start[N] = {0, 0, 1.2, 0};
    double fine[N], before = 0, error_before = 0;
    memcpy(fine, start, sizeof fine);
    exponential *reference = make(&of, 0.01);
    go(reference, &of, 4, 0.8, fine);
    exponential_free(reference);
    for (int rung = 0; rung < 4; rung++) {
        exponential *self = make(&of, 0.1);
        double y[N];
        memcpy(y, start, sizeof y);
        double error = go(self, &of, rung, 0.8, y), away = fabs(y[2] - fine[2]);
        print_message("  step %g s: %.3g away, error told %.3g\n", exponential_size(self, rung),
                      away, error);
        if (rung > 1) {
            assert_true(log2(before / away) > 3.7);
            assert_true(log2(error_before / error) > 3.6); // of one step, of order 3
        }
        before = away;
        error_before = error;
        exponential_free(self);
    }
}

// Within a step of one and a half periods of the stiff oscillator.
static void states_between_are_those_of_the_course(void **state)
{
    (void)state;
    const oscillators of = {.k = {1e4, 9}, .c = 4, .force = 10};
    exponential *self = make(&of, 0.08);
    double y[N] = {2e-3, 1, 0.5, -1};
    go(self, &of, 0, 0.08, y);
    for (int i = 0; i <= 64; i++) {
        double t = 0.08 * i / 64, between[N], stiff[2];
        exponential_between(self, t, between);
        free_oscillation(of.k[0], of.c, of.force / of.k[0], 2e-3, 1, t, stiff);
        // exact at every fourth of them, cubics between those
        check_near(between[0], stiff[0], i % 4 == 0 ? 1e-15 : 3e-5);
    }
    exponential_free(self);
}

static int one_over(double t, const double *y, double *y_dot, void *user)
{
    (void)user, (void)t;
    y_dot[0] = -y[0];
    y_dot[1] = y[0] * y[0];
    return 0;
}

// What is in no block: the integral of a square, which no exponential function gives.
static void integrals_are_of_order_four(void **state)
{
    (void)state;
    static const int block[2] = {0, EXPONENTIAL_NO_BLOCK};
    double before = 0;
    for (int rung = 0; rung < 3; rung++) {
        exponential *self = exponential_new(&(exponential_settings){
            .n = 2, .block = block, .block_count = 1, .longest = 0.5, .rungs = 3, .f = one_over});
        int count;
        *exponential_block(self, 0, &count) = -1;
        assert_int_equal(exponential_prepare(self), 0);
        double y[2] = {1, 0}, f[2] = {-1, 1}, drift[2] = {0}, end[2], slope_end[2], error[2];
        for (int k = 0; k < 2 << rung; k++) {
            exponential_step(self, rung, &(exponential_start){0, y, f, drift},
                             &(exponential_end){end, slope_end, error});
            memcpy(y, end, sizeof y);
            memcpy(f, slope_end, sizeof f);
        }
        check_near(y[0], exp(-1), 1e-15);
        double away = fabs(y[1] - (1 - exp(-2)) / 2);
        assert_true(rung == 0 || log2(before / away) > 3.9);
        before = away;
        exponential_free(self);
    }
}

static void what_is_not_finite_is_told(void **state)
{
    (void)state;
    const oscillators of = {.k = {4e6, 9}};
    int count;
    exponential *self = make(&of, 0.04);
    exponential_block(self, 0, &count)[1] = NAN;
    assert_int_equal(exponential_prepare(self), -1);
    exponential_block(self, 0, &count)[1] = -1e300;
    assert_int_equal(exponential_prepare(self), -1);
    exponential_free(self);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(linear_equations_are_exact),
        cmocka_unit_test(a_common_motion_does_not_count),
        cmocka_unit_test(the_order_is_four),
        cmocka_unit_test(states_between_are_those_of_the_course),
        cmocka_unit_test(integrals_are_of_order_four),
        cmocka_unit_test(what_is_not_finite_is_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
