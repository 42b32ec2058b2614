// Statistics of the random road over many seeds, from profiles as they are: spectrum against the
// class line, root mean square, coherence of the tracks.
// ctest: slow
#include <stdlib.h>

#include "environment/road.h"
#include "math/curves/spectrum.h"
#include "support/check.h"

enum { SEEDS = 200, SAMPLES = 32768, OCTAVES = 9, SHARES = 200 };

static const double step = 0.125; // [m]
static double left[SAMPLES], right[SAMPLES];

static void profiles(const ld_road *model)
{
    road *self;
    assert_int_equal(road_build(model, 0, 0, &self, NULL), LD_OK);
    const road_places places = {-1000, step, SAMPLES};
    assert_int_equal(road_profile(self, ROAD_LEFT, &places, left, NULL), LD_OK);
    assert_int_equal(road_profile(self, ROAD_RIGHT, &places, right, NULL), LD_OK);
    road_free(self);
}

static double class_mean(double from, double to)
{
    return 16e-8 * (1 / from - 1 / to) / (to - from);
}

// Modified Bessel function of the second kind, order 1: int_0^inf exp(-z cosh t) cosh t dt.
static double bessel_k1(double z)
{
    double sum = 0, dt = 1.0 / 64;
    for (int i = 0; i < 64 * 12; i++)
        sum += (i == 0 ? 0.5 : 1) * exp(-z * cosh(i * dt)) * cosh(i * dt);
    return sum * dt;
}

// Cross-spectrum over spectrum of two tracks 2.1 m apart on an isotropic surface.
static double isotropic_share(double n)
{
    double z = 2 * acos(-1) * n * 2.1;
    return z * bessel_k1(z);
}

// The published values, and the table that the road reads.
static const double known[4][2] = {{0.011, 0.9731}, {0.05, 0.7539}, {0.1, 0.4773}, {0.25, 0.09289}};
static double shares[2 * SHARES];

static void test_isotropic_share(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++)
        CHECK_NEAR("k B K_1(k B)", isotropic_share(known[i][0]), known[i][1], 5e-5);
    for (int i = 0; i < SHARES; i++) {
        shares[2 * i] = 0.01 * pow(100, (double)i / (SHARES - 1));
        shares[2 * i + 1] = isotropic_share(shares[2 * i]);
    }
}

// One harmonic more or less in an octave of 47.7 is up to 1 %; that is in the 3 % too.
static void check_octaves(const double *edge, double mean[ROAD_TRACKS][OCTAVES])
{
    for (int track = 0; track < ROAD_TRACKS; track++)
        for (int i = 0; i < OCTAVES; i++) {
            char what[80];
            snprintf(what, sizeof what, "%s track, %.4g to %.4g 1/m: over the class line, -1",
                     track == ROAD_LEFT ? "left" : "right", edge[i], edge[i + 1]);
            CHECK_BELOW(what, mean[track][i] / class_mean(edge[i], edge[i + 1]) - 1, 0.03);
        }
}

static void test_spectrum_and_coherence(void **state)
{
    (void)state;
    double edge[OCTAVES + 1], around[8], auto_sum[ROAD_TRACKS][OCTAVES] = {{0}};
    double cross[4][SEEDS], own[4][SEEDS];
    for (int i = 0; i <= OCTAVES; i++)
        edge[i] = fmin(0.01 * pow(2, i), 1 / 0.3);
    for (int i = 0; i < 4; i++) {
        around[2 * i] = known[i][0] / 1.1;
        around[2 * i + 1] = known[i][0] * 1.1;
    }
    for (int seed = 0; seed < SEEDS; seed++) {
        ld_road model = {.tracks = LD_TRACKS_COHERENT,
                         .coherence = {SHARES, 2, shares},
                         .seed = seed,
                         .harmonics = 400,
                         .wavelengths = {0.3, 100}};
        profiles(&model);
        double aa[OCTAVES], bb[OCTAVES];
        const spectrum_series tracks = {SAMPLES, step, left, right};
        const spectrum_bands octaves = {OCTAVES, edge, .aa = aa, .bb = bb};
        spectrum_in_bands(&tracks, &octaves, NULL);
        for (int i = 0; i < OCTAVES; i++) {
            auto_sum[ROAD_LEFT][i] += aa[i] / SEEDS;
            auto_sum[ROAD_RIGHT][i] += bb[i] / SEEDS;
        }
        double near_aa[7], near_ab[7];
        const spectrum_bands near_by = {7, around, .aa = near_aa, .ab = near_ab};
        spectrum_in_bands(&tracks, &near_by, NULL);
        for (int i = 0; i < 4; i++) {
            own[i][seed] = near_aa[2 * i];
            cross[i][seed] = near_ab[2 * i];
        }
    }
    check_octaves(edge, auto_sum);

    // cross-spectrum over spectrum; its deviation from the scatter of the seeds
    for (int i = 0; i < 4; i++) {
        double a = 0, c = 0, square = 0;
        for (int seed = 0; seed < SEEDS; seed++) {
            a += own[i][seed];
            c += cross[i][seed];
        }
        double share = c / a;
        for (int seed = 0; seed < SEEDS; seed++)
            square += pow(cross[i][seed] - share * own[i][seed], 2);
        double deviation = sqrt(square) / a;
        char what[64];
        snprintf(what, sizeof what, "share at %g 1/m", known[i][0]);
        CHECK_NEAR(what, share, known[i][1], 3 * deviation + 0.003);
        CHECK_BELOW("its standard deviation", deviation, 0.02);
    }
}

static double power(const double *values)
{
    double sum = 0;
    for (int i = 0; i < SAMPLES; i++)
        sum += values[i] * values[i];
    return sum / SAMPLES;
}

static void test_root_mean_square(void **state)
{
    (void)state;
    enum { FEW = 40 };
    double sum = 0, product = 0;
    for (int seed = 0; seed < FEW; seed++) {
        ld_road model = {.tracks = LD_TRACKS_INDEPENDENT,
                         .seed = seed,
                         .harmonics = 400,
                         .wavelengths = {1 / 2.83, 1 / 0.011}};
        profiles(&model);
        sum += (power(left) + power(right)) / (2 * FEW);
        for (int i = 0; i < SAMPLES; i++)
            product += left[i] * right[i] / ((double)SAMPLES * FEW);
    }
    CHECK_NEAR("class A, 0.011 to 2.83 1/m: rms [mm]", 1e3 * sqrt(sum), 3.806, 0.03806);
    CHECK_BELOW("independent tracks: correlation", product / sum, 0.02);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_isotropic_share),
        cmocka_unit_test(test_spectrum_and_coherence),
        cmocka_unit_test(test_root_mean_square),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
