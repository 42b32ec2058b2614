// Power spectral densities against the plain sum of the definition, known signals, Parseval.
#include "math/curves/spectrum.h"

#include <complex.h>
#include <stdlib.h>

#include "support/check.h"
#include "support/draw.h"

enum { COUNT = 100, SIZE = 128, HALF = SIZE / 2 };

static const double step = 0.25;

// Edges that hold the frequency m of 1 .. HALF - 1 in band m - 1.
static void fine_edges(double edge[HALF])
{
    for (int m = 0; m < HALF; m++)
        edge[m] = (m + 0.5) / (SIZE * step);
}

static double complex sum_at(const double *x, int m)
{
    double mean = 0;
    double complex sum = 0;
    for (int i = 0; i < COUNT; i++)
        mean += x[i] / COUNT;
    for (int i = 0; i < COUNT; i++)
        sum += pow(sin(acos(-1) * (i + 0.5) / COUNT), 2) * (x[i] - mean) *
               cexp(-2 * acos(-1) * I * m * i / SIZE);
    return sum;
}

// The taper's squares sum to 3/8 of the count.
static void test_definition(void **state)
{
    (void)state;
    double a[COUNT], b[COUNT], edge[HALF], aa[HALF], bb[HALF], ab[HALF], error = 0;
    uint64_t seed = 1;
    for (int i = 0; i < COUNT; i++) {
        a[i] = 3 + draw(&seed);
        b[i] = a[i] + draw(&seed);
    }
    fine_edges(edge);
    const spectrum_series series = {COUNT, step, a, b};
    const spectrum_bands bands = {HALF - 1, edge, aa, bb, ab};
    assert_int_equal(spectrum_in_bands(&series, &bands, NULL), LD_OK);
    for (int m = 1; m < HALF; m++) {
        double complex A = sum_at(a, m), B = sum_at(b, m);
        double scale = 2 * step / (0.375 * COUNT);
        error = fmax(error, fabs(aa[m - 1] - scale * creal(A * conj(A))));
        error = fmax(error, fabs(bb[m - 1] - scale * creal(B * conj(B))));
        error = fmax(error, fabs(ab[m - 1] - scale * creal(A * conj(B))));
    }
    CHECK_BELOW("against the sum of the definition", error, 1e-14);
}

// A sine of amplitude 1 has the power 1/2, wherever it lies.
static void test_sine(void **state)
{
    (void)state;
    enum { MANY = 1000 };
    double a[MANY], edge[2] = {0.001, 1.99}, density;
    for (int i = 0; i < MANY; i++)
        a[i] = sin(2 * acos(-1) * 0.7071 * i * step + 1);
    spectrum_in_bands(&(spectrum_series){MANY, step, a, a},
                      &(spectrum_bands){1, edge, .aa = &density}, NULL);
    CHECK_NEAR("power of a sine", density * (edge[1] - edge[0]), 0.5, 1.5e-3);
}

static void test_empty_band(void **state)
{
    (void)state;
    double a[COUNT] = {1, 2}, edge[2] = {0.0001, 0.0002}, density;
    spectrum_in_bands(&(spectrum_series){COUNT, step, a, a},
                      &(spectrum_bands){1, edge, .aa = &density}, NULL);
    assert_true(isnan(density));
}

// A cosine of whole waves, even about each segment's middle: with Hann's taper 2/3 of its power
// lies in its own frequency, 1/6 in each neighbour, whatever line it stands on; the last samples,
// no whole segment, are left out.
static void test_segments(void **state)
{
    (void)state;
    enum { SEGMENTS = 5, LENGTH = (SEGMENTS + 1) * HALF, WAVE = 10 };
    double a[LENGTH + 7], density[HALF], error = 0;
    for (int i = 0; i < LENGTH; i++)
        a[i] = 3 * cos(2 * acos(-1) * WAVE * (i - (SIZE - 1) / 2.0) / SIZE) + 40 - 0.3 * i;
    for (int i = 0; i < 7; i++)
        a[LENGTH + i] = 1e6;
    assert_int_equal(spectrum_of_segments(LENGTH + 7, step, a, SIZE, density, NULL), LD_OK);
    for (int m = 1; m < HALF; m++) {
        double share = m == WAVE ? 2 / 3.0 : abs(m - WAVE) == 1 ? 1 / 6.0 : 0;
        error = fmax(error, fabs(density[m] - share * 4.5 * SIZE * step));
    }
    assert_true(isnan(density[0]));
    CHECK_BELOW("a cosine's density over segments", error, 2e-13);

    // waves in the first segment alone, which half the second one has: each counts alike
    for (int i = 0; i < LENGTH; i++)
        a[i] = (i < SIZE ? 1 : 0) * cos(2 * acos(-1) * WAVE * (i - (SIZE - 1) / 2.0) / SIZE);
    spectrum_of_segments(LENGTH, step, a, SIZE, density, NULL);
    double first[HALF], both[HALF];
    spectrum_of_segments(SIZE, step, a, SIZE, first, NULL);
    spectrum_of_segments(SIZE, step, a + HALF, SIZE, both, NULL);
    CHECK_BELOW("mean over five segments, one whole, one of half a wave train",
                density[WAVE] - (first[WAVE] + both[WAVE]) / SEGMENTS, 1e-14);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_definition),
        cmocka_unit_test(test_sine),
        cmocka_unit_test(test_empty_band),
        cmocka_unit_test(test_segments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
