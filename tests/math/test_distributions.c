// Distribution functions against values to 20 digits (mpmath).
#include "support/check.h"

#include "math/curves/distributions.h"

static double relative(double measured, double expected)
{
    return expected == 0 ? measured : measured / expected - 1;
}

// The exact quantiles of the doubles p.
static void test_normal_quantile(void **state)
{
    (void)state;
    static const double known[][2] = {
        {1e-300, -37.047096299361199237},
        {1e-20, -9.2623400897984075796},
        {1e-9, -5.9978070150076868614},
        {0.001, -3.0902323061678135354},
        {0.025, -1.9599639845400542118},
        {0.075, -1.4395314709384559349},
        {0.1, -1.2815515655446004353},
        {0.3, -0.52440051270804081597},
        {0.5, 0},
        {0.6, 0.25334710313579974132},
        {0.9, 1.2815515655446005935},
        {0.975, 1.9599639845400538556},
        {0.999, 3.0902323061678132778},
    };
    double worst = 0, back = 0;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        double p = known[i][0], z = normal_quantile(p);
        worst = fmax(worst, fabs(relative(z, known[i][1])));
        if (p <= 0.5)
            back = fmax(back, fabs(relative(normal_cumulative(z), p)) / fmax(1, z * z));
    }
    CHECK_BELOW("normal quantile, relative", worst, 1e-15);
    CHECK_BELOW("and back, over z^2", back, 1e-15);
}

// From where it is a few of the smallest numbers to where it is 1.
static void test_normal_cumulative(void **state)
{
    (void)state;
    double worst = 0;
    for (int i = 0; i < 40000; i++) {
        double z = -37.5 + i * 1.15e-3;
        long double exact = 0.5L * erfcl(-z * 0.707106781186547524400844362104849039L);
        worst = fmax(worst, fabs((double)(normal_cumulative(z) / exact - 1)));
    }
    CHECK_BELOW("normal distribution function, relative", worst, 1.5e-15);
    assert_true(normal_cumulative(0) == 0.5 && normal_cumulative(INFINITY) == 1);
    assert_true(normal_cumulative(-INFINITY) == 0 && isnan(normal_cumulative(NAN)));
}

// One side by its own coefficients, the other by its mirror image.
static void test_normal_quantile_rises(void **state)
{
    (void)state;
    double before = -INFINITY, odd = 0;
    int falls = 0;
    for (int i = 1; i < 4096; i++) {
        double p = i / 4096., z = normal_quantile(p);
        falls += !(z > before);
        odd = fmax(odd, fabs(z + normal_quantile(1 - p)));
        before = z;
    }
    assert_int_equal(falls, 0);
    CHECK_BELOW("quantiles of p and 1 - p", odd, 1e-15);
}

static void test_student_quantile(void **state)
{
    (void)state;
    static const double known[][3] = {
        {0.975, 1, 12.706204736174693314},    {0.975, 2, 4.3026527297494617894},
        {0.975, 9, 2.2621571627982049992},    {0.975, 30, 2.0422724563012378878},
        {0.975, 1000, 1.9623390808264081039}, {0.9, 5, 1.4758840488244812516},
    };
    double worst = 0;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        double t = student_quantile(known[i][0], known[i][1]);
        worst = fmax(worst, fabs(relative(t, known[i][2])));
        worst = fmax(worst, fabs(t + student_quantile(1 - known[i][0], known[i][1])));
    }
    CHECK_BELOW("Student's quantile", worst, 1e-13);
}

static void test_binomial(void **state)
{
    (void)state;
    CHECK_BELOW("P(X <= 3), n = 10, p = 0.25",
                relative(binomial_cumulative(3, 10, 0.25), 0.775875091552734375), 1e-14);
    CHECK_BELOW("P(X <= 0), n = 5, p = 0.5", relative(binomial_cumulative(0, 5, 0.5), 0.03125),
                1e-14);
    CHECK_BELOW("P(X <= 40), n = 100, p = 0.5",
                relative(binomial_cumulative(40, 100, 0.5), 0.028443966820490395835), 1e-12);
    CHECK_BELOW("P(X <= 60), n = 1000, p = 0.05",
                relative(binomial_cumulative(60, 1000, 0.05), 0.93293748136669202876), 1e-11);
    assert_true(binomial_cumulative(-1, 5, 0.5) == 0 && binomial_cumulative(5, 5, 0.5) == 1);
}

static void test_chi_square(void **state)
{
    (void)state;
    double worst = 0, fisher = 0;
    for (double x = 0.01; x < 200; x *= 1.17) {
        double poisson = 0, term = exp(-x / 2);
        for (int k = 0; k < 50; term *= x / 2 / ++k)
            poisson += term;
        worst = fmax(worst, relative(chi_square_beyond(x, 1), 2 * normal_cumulative(-sqrt(x))));
        worst = fmax(worst, relative(chi_square_beyond(x, 2), exp(-x / 2)));
        worst = fmax(worst, relative(chi_square_beyond(x, 100), poisson));
        fisher = fmax(fisher, relative(fisher_beyond(x, 1, 7), student_beyond(sqrt(x), 7)));
        fisher = fmax(fisher, relative(fisher_beyond(x, 2, 9), pow(1 + 2 * x / 9, -4.5)));
    }
    CHECK_BELOW("chi-square of 1, 2 and 100 degrees of freedom", worst, 1e-12);
    CHECK_BELOW("Fisher's F of 1 and 2 over 7 and 9", fisher, 1e-12);
    assert_true(chi_square_beyond(0, 3) == 1 && chi_square_beyond(INFINITY, 3) == 0);
    assert_true(isnan(chi_square_beyond(NAN, 3)) && isnan(chi_square_beyond(1, INFINITY)));
}

// At once: the fraction has no last term for them.
static void test_no_numbers(void **state)
{
    (void)state;
    for (int i = 0; i < 1000; i++) {
        assert_true(isnan(beta_cumulative(NAN, 1, 0.5)) && isnan(beta_cumulative(1, NAN, 0.5)));
        assert_true(isnan(beta_cumulative(1, 1, NAN)) && isnan(beta_cumulative(INFINITY, 1, 0.5)));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_normal_cumulative),
        cmocka_unit_test(test_normal_quantile),
        cmocka_unit_test(test_normal_quantile_rises),
        cmocka_unit_test(test_student_quantile),
        cmocka_unit_test(test_binomial),
        cmocka_unit_test(test_chi_square),
        cmocka_unit_test(test_no_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
