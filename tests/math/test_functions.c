// The elementary functions with the bits of no processor: against those of long double over random
// arguments of all sizes; what the C standard says of zeros, infinities and what is not a number.
#include "math/functions.h"

#include <float.h>
#include <stdbool.h>

#include "support/check.h"

enum { ARGUMENTS = OF_ALL(300000, 30000) };

static uint64_t random_word(void)
{
    static uint64_t word = 88172645463325252;
    word ^= word << 13;
    word ^= word >> 7;
    return word ^= word << 17;
}

static double uniform(double from, double to)
{
    return from + (to - from) * 0x1p-53 * (double)(random_word() >> 11);
}

// Any double, ordinary ones, tiny and large ones, ones near 1.
static double argument(int i)
{
    double any;
    switch (i % 6) {
    case 0:
        do {
            uint64_t bits = random_word();
            memcpy(&any, &bits, sizeof any);
        } while (!isfinite(any));
        return any;
    case 1:
        return uniform(-1, 1);
    case 2:
        return uniform(-10, 10);
    case 3:
        return ldexp(uniform(-1, 1), (int)(random_word() % 80) - 40);
    case 4:
        return uniform(-750, 750);
    default:
        return 1 + ldexp(uniform(-1, 1), -(int)(random_word() % 50));
    }
}

// Of v from exact, in units of its last place; infinite where one is not finite, or has the other's
// sign, and the other not.
static double units(long double exact, double v)
{
    double nearest = (double)exact;
    if (!isfinite(nearest) || nearest == 0)
        return (isnan(nearest) && isnan(v)) || nearest == v ? 0 : v == 0 ? 1 : INFINITY;
    int exponent;
    frexp(nearest, &exponent);
    exponent = exponent < DBL_MIN_EXP ? DBL_MIN_EXP : exponent;
    return (double)(fabsl(exact - v) / ldexpl(1, exponent - DBL_MANT_DIG));
}

static void check_one(const char *what, long double (*exact)(long double), double (*own)(double),
                      double bound)
{
    double worst = 0;
    for (int i = 0; i < ARGUMENTS; i++) {
        double x = argument(i);
        worst = fmax(worst, units(exact(x), own(x)));
    }
    CHECK_BELOW(what, worst, bound);
}

static void check_two(const char *what, long double (*exact)(long double, long double),
                      double (*own)(double, double), double bound)
{
    double worst = 0;
    for (int i = 0; i < ARGUMENTS; i++) {
        double x = argument(i), y = argument((int)(random_word() % 6));
        worst = fmax(worst, units(exact(x, y), own(x, y)));
    }
    CHECK_BELOW(what, worst, bound);
}

static double arc_tangent(double x)
{
    return atan(x);
}

static void test_errors(void **state)
{
    (void)state;
    check_one("sin, units in the last place", sinl, portable_sin, 0.8);
    check_one("cos", cosl, portable_cos, 0.8);
    check_one("asin", asinl, portable_asin, 0.8);
    check_one("acos", acosl, portable_acos, 0.8);
    check_one("atan", atanl, arc_tangent, 0.9);
    check_one("exp", expl, portable_exp, 0.8);
    check_one("expm1", expm1l, portable_expm1, 1.3);
    check_one("log", logl, portable_log, 0.51);
    check_one("log10", log10l, portable_log10, 0.51);
    check_one("log1p", log1pl, portable_log1p, 0.7);
    check_two("atan2", atan2l, portable_atan2, 1.5);
    check_two("hypot", hypotl, portable_hypot, 1.2);
    check_two("pow", powl, portable_pow, 0.8);
}

// Powers as they come, and those near the ends of what a double holds.
static void test_powers(void **state)
{
    (void)state;
    double usual = 0, far = 0;
    for (int i = 0; i < ARGUMENTS; i++) {
        double x = exp(uniform(-20, 20)), y = uniform(-700, 700) / log(x);
        far = fmax(far, units(powl(x, y), pow(x, y)));
        double base = uniform(0, 10), power = uniform(-10, 10);
        usual = fmax(usual, units(powl(base, power), pow(base, power)));
    }
    CHECK_BELOW("powers from 0 to 10 to -10 to 10, units", usual, 0.8);
    CHECK_BELOW("powers from 1e-304 to 1e304, units", far, 0.8);
    double ten = 1;
    for (int n = 0; n <= 22; n++, ten *= 10) // as far as they are doubles
        assert_true(pow(10, n) == ten && log10(ten) == n);
    for (int n = -1074; n <= 1023; n++)
        assert_true(pow(2, n) == ldexp(1, n));
    for (int n = 0; n <= 1000; n++)
        assert_true(pow(n, 2) == n * n && pow(n, 3) == (double)n * n * n);
}

// Angles whose nearest multiple of pi/2 is very near, and 2^1023 (Muller, Elementary Functions).
static void test_large_angles(void **state)
{
    (void)state;
    const double angle[] = {0x1.6ac5b262ca1ffp+849, 0x1p1023, 5e5,
                            0x1.921fb54442d18p+40,  1e22,     -0x1.6ac5b262ca1ffp+849};
    double worst = 0;
    for (size_t i = 0; i < sizeof angle / sizeof *angle; i++) {
        double s, c;
        sincos(angle[i], &s, &c);
        worst = fmax(worst, fmax(units(sinl(angle[i]), s), units(cosl(angle[i]), c)));
        assert_true(s == sin(angle[i]) && c == cos(angle[i]));
    }
    CHECK_BELOW("sine and cosine of large angles, units", worst, 0.8);
}

// Zeros, infinities and what is not a number alike, the sign of zeros included; else near.
static bool alike(double a, double b)
{
    if (a == 0 || b == 0 || !isfinite(a) || !isfinite(b))
        return (isnan(a) && isnan(b)) || (a == b && !signbit(a) == !signbit(b));
    return units(a, b) <= 2;
}

static const double special[] = {0,           -0.,         1,        -1,      2,
                                 -2,          3,           -3,       0.5,     -0.5,
                                 2.5,         -2.5,        1e-320,   -1e-320, 1e-9,
                                 1e300,       -1e300,      0x1p-60,  0x1p53,  -0x1p53,
                                 0x1p53 + 2,  INFINITY,    710,      -746,    -INFINITY,
                                 NAN,         DBL_MAX,     -DBL_MAX, DBL_MIN, 709.782712893384,
                                 1 - 0x1p-53, -1 - 0x1p-52};
enum { SPECIAL = sizeof special / sizeof *special };

// The judge is the C library: a name in parentheses is its.
static void test_special_values(void **state)
{
    (void)state;
    static double (*const library[])(double) = {(sin), (cos),   (asin), (acos),  (atan),
                                                (exp), (expm1), (log),  (log10), (log1p)};
    static double (*const own[])(double) = {
        portable_sin, portable_cos,   portable_asin, portable_acos,  arc_tangent,
        portable_exp, portable_expm1, portable_log,  portable_log10, portable_log1p};
    static double (*const library_of_two[])(double, double) = {(atan2), (hypot), (pow)};
    static double (*const own_of_two[])(double, double) = {portable_atan2, portable_hypot,
                                                           portable_pow};
    for (size_t f = 0; f < sizeof own / sizeof *own; f++)
        for (int i = 0; i < SPECIAL; i++)
            if (!alike(own[f](special[i]), library[f](special[i])))
                fail_msg("function %zu of %g: %g", f, special[i], own[f](special[i]));
    for (size_t f = 0; f < sizeof own_of_two / sizeof *own_of_two; f++)
        for (int i = 0; i < SPECIAL; i++)
            for (int j = 0; j < SPECIAL; j++)
                if (!alike(own_of_two[f](special[i], special[j]),
                           library_of_two[f](special[i], special[j])))
                    fail_msg("function %zu of %g and %g: %g", f, special[i], special[j],
                             own_of_two[f](special[i], special[j]));
}

// No more than the error falls where a function rises, over pieces and quadrants.
static void test_rises(void **state)
{
    (void)state;
    double log_falls = 0, exp_falls = 0, arc_falls = 0;
    for (int i = 1; i < 20000; i++) {
        double x = 0.5 + i * 1e-4, next = nextafter(x, 3);
        log_falls += log(next) < log(x);
        exp_falls = fmax(exp_falls, exp(x) / exp(next) - 1);
        arc_falls = fmax(arc_falls, atan2(x, 1) / atan2(next, 1) - 1);
    }
    CHECK_BELOW("steps that the logarithm falls", log_falls, 0);
    CHECK_BELOW("most that exp falls in one step", exp_falls, 2.3e-16);
    CHECK_BELOW("most that an angle falls in one step", arc_falls, 2.3e-16);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_errors), cmocka_unit_test(test_powers),
                                       cmocka_unit_test(test_large_angles),
                                       cmocka_unit_test(test_special_values),
                                       cmocka_unit_test(test_rises)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
