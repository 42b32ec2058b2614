// Sobol's points: their direction numbers, first points, nets; scrambled, how fast means converge.
#include "base/sobol.h"
#include "support/check.h"

#include <stdbool.h>

#include "base/random.h"

// x has the order 2^s - 1 among the polynomials modulo a primitive one of degree s.
static int order_of_x(unsigned polynomial, int degree)
{
    int order = 0;
    unsigned power = 1;
    do {
        power <<= 1;
        if (power >> degree & 1)
            power ^= polynomial;
        order++;
    } while (power != 1 && order < 1 << degree);
    return order;
}

static void test_numbers(void **state)
{
    (void)state;
    unsigned before = 0;
    for (int i = 0; i < SOBOL_DIMENSIONS - 1; i++) {
        const sobol_number *number = &sobol_numbers[i];
        int degree = 0;
        while (number->polynomial >> (degree + 1))
            degree++;
        assert_int_equal(order_of_x(number->polynomial, degree), (1 << degree) - 1);
        assert_true(number->polynomial > before); // each once
        before = number->polynomial;
        for (int k = 0; k < SOBOL_DEGREE; k++)
            assert_true(k < degree ? number->m[k] % 2 == 1 && number->m[k] < 2 << k
                                   : number->m[k] == 0);
    }
    // all of the polynomials of the degrees 1 to 10, and 96 of degree 11
    assert_int_equal(before >> 11, 1);
    int below = 0;
    for (int i = 0; i < SOBOL_DIMENSIONS - 1; i++)
        below += sobol_numbers[i].polynomial < 2048;
    assert_int_equal(below, 1 + 1 + 2 + 2 + 6 + 6 + 18 + 16 + 48 + 60);
}

// As Joe and Kuo print them beside their program, and beyond: dimensions 100 and 256 from SciPy
// 1.10, which has read their file on its own.
static void test_first_points(void **state)
{
    (void)state;
    static const double known[10][3] = {{0, 0, 0},
                                        {0.5, 0.5, 0.5},
                                        {0.75, 0.25, 0.25},
                                        {0.25, 0.75, 0.75},
                                        {0.375, 0.375, 0.625},
                                        {0.875, 0.875, 0.125},
                                        {0.625, 0.125, 0.875},
                                        {0.125, 0.625, 0.375},
                                        {0.1875, 0.3125, 0.9375},
                                        {0.6875, 0.8125, 0.4375}};
    for (int i = 0; i < 10; i++)
        for (int k = 0; k < 3; k++)
            assert_true(sobol_point(k, (uint32_t)i) * 0x1p-32 == known[i][k]);
    static const struct {
        int dimension;
        uint32_t index, point;
    } far[] = {{99, 5, 0x60000000u},  {99, 77, 0xde000000u},  {99, 999, 0x7fc00000u},
               {255, 5, 0xe0000000u}, {255, 77, 0xf6000000u}, {255, 999, 0x6fc00000u}};
    for (size_t i = 0; i < sizeof far / sizeof *far; i++)
        assert_int_equal(sobol_point(far[i].dimension, far[i].index), far[i].point);
}

// Of 2^m points each interval of length 2^-m has one, in every dimension; in the first two also
// each rectangle of area 2^-m.
static void test_nets(void **state)
{
    (void)state;
    enum { BITS = 8, POINTS = 1 << BITS };
    for (int d = 0; d < SOBOL_DIMENSIONS; d++) {
        char seen[POINTS] = {0};
        for (uint32_t i = 0; i < POINTS; i++)
            seen[sobol_point(d, i) >> (32 - BITS)]++;
        for (int k = 0; k < POINTS; k++)
            assert_int_equal(seen[k], 1);
    }
    for (int wide = 0; wide <= BITS; wide++) {
        const uint64_t key[] = {7, 8};
        char seen[2][POINTS] = {{0}};
        for (uint32_t i = 0; i < POINTS; i++) {
            uint32_t x = sobol_point(0, i), z = sobol_point(1, i);
            uint32_t u = sobol_scrambled(x, BITS, key, 1, 2),
                     v = sobol_scrambled(z, BITS, key, 3, 2);
            x >>= 32 - BITS, z >>= 32 - BITS;
            seen[0][x >> wide << wide | z >> (BITS - wide)]++;
            seen[1][u >> wide << wide | v >> (BITS - wide)]++;
        }
        for (int k = 0; k < POINTS; k++) {
            assert_int_equal(seen[0][k], 1);
            assert_int_equal(seen[1][k], 1);
        }
    }
}

// Owen's scrambling: what two coordinates have in common up to a bit they keep, as they keep that
// this bit differs; whether the bits behind it are turned is drawn anew for each.
static void test_scrambling(void **state)
{
    (void)state;
    enum { BITS = 16, DRAWS = 4096, FIRST_BIT = 3 };
    const uint64_t key[] = {11, 4};
    const uint32_t a = 0x5a5a0000u, b = a ^ 1u << (31 - FIRST_BIT);
    double apart = 0;
    for (uint64_t draw = 0; draw < DRAWS; draw++) {
        uint32_t differ =
            sobol_scrambled(a, BITS, key, draw, 0) ^ sobol_scrambled(b, BITS, key, draw, 0);
        assert_int_equal(differ >> (BITS - 1 - FIRST_BIT), 1);
        for (int k = 0; k < BITS - 1 - FIRST_BIT; k++)
            apart += differ >> k & 1;
    }
    double bits = (double)DRAWS * (BITS - 1 - FIRST_BIT);
    CHECK_BELOW("bits behind that differ, of a half, in deviations",
                (apart / bits - 0.5) / 0.5 * sqrt(bits), 3);
}

// ---- convergence

enum { SCRAMBLINGS = 400, LEAST = 6, MOST = 10 };

// Smooth, with the mean 1.
static double product(const double *u, int dimensions)
{
    double value = 1;
    for (int i = 0; i < dimensions; i++)
        value *= 1 + (exp(u[i]) - exp(1) + 1) / (i + 1);
    return value;
}

// Root mean square error of the mean over 2^bits points.
static double error_of(int dimensions, int bits, bool scrambled)
{
    double squares = 0;
    for (uint64_t s = 0; s < SCRAMBLINGS; s++) {
        double sum = 0, u[5];
        for (uint32_t n = 0; n < 1u << bits; n++) {
            for (int i = 0; i < dimensions; i++) {
                const uint64_t key[] = {5, (uint64_t)i};
                u[i] = random_uniform(5, (uint64_t)i, s, n, 0);
                if (scrambled)
                    u[i] = ldexp(sobol_scrambled(sobol_point(i, n), bits, key, s, 0) + u[i], -bits);
            }
            sum += product(u, dimensions);
        }
        squares += pow(ldexp(sum, -bits) - 1, 2) / SCRAMBLINGS;
    }
    return sqrt(squares);
}

// Of the error, from so many points to so many.
static double order_of(int dimensions, bool scrambled)
{
    double first = error_of(dimensions, LEAST, scrambled);
    return log(error_of(dimensions, MOST, scrambled) / first) / log(2) / (MOST - LEAST);
}

static void test_convergence(void **state)
{
    (void)state;
    CHECK_WITHIN("order of the error, 64 to 1024 points of one dimension", order_of(1, true), -1.56,
                 -1.44);
    CHECK_WITHIN("of five, where logarithms count", order_of(5, true), -1.5, -1.25);
    CHECK_WITHIN("of random numbers", order_of(5, false), -0.56, -0.44);
    CHECK_BELOW("error of 1024 points of five dimensions, of random ones' 1.9 %",
                error_of(5, MOST, true), 1.5e-4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_numbers),     cmocka_unit_test(test_first_points),
        cmocka_unit_test(test_nets),        cmocka_unit_test(test_scrambling),
        cmocka_unit_test(test_convergence),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
