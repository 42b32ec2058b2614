// Spectrum of each component against the distance flown at constant height, over many seeds.
// ctest: slow
#include "environment/turbulence.h"
#include "math/curves/spectrum.h"
#include "support/check.h"

enum { SEEDS = 200, OCTAVES = 10 };

typedef struct flown {
    int samples;
    double step; // of xi
} flown;

static double x[1 << 14], y[1 << 14], z[1 << 14];

// Integral of the spectrum between two kappa over the width.
static double expected(int component, double from, double to)
{
    enum { PIECES = 1000 };
    double sum = 0;
    for (int i = 0; i < PIECES; i++) {
        double kappa = from + (to - from) * (i + 0.5) / PIECES;
        sum += component == 0 ? turbulence_longitudinal(kappa) : turbulence_transverse(kappa);
    }
    return sum / PIECES;
}

// Adds the densities over L Omega, in units of the variance, of one seed at 200 m.
static void add(int seed, flown line, int octaves, const double *edge, double sum[][OCTAVES])
{
    turbulence self;
    ld_turbulence model = {.present = true, .wind_at_6m = 5, .seed = seed, .harmonics = 100};
    assert_int_equal(turbulence_build(&self, &model, 0, NULL), LD_OK);
    turbulence_scales scales = turbulence_scales_at(&self, 200);
    for (int i = 0; i < line.samples; i++) {
        v3 v = turbulence_velocity(&self, &scales, i * line.step, i * line.step);
        x[i] = v.x, y[i] = v.y, z[i] = v.z;
    }
    turbulence_free(&self);

    // over the distance s, L_u xi for x and z and L_w xi for y, in cycles per metre
    const double *series[3] = {x, z, y};
    for (int j = 0; j < 3; j++) {
        double L = j == 2 ? scales.L_w : scales.L_u,
               sigma = j == 2 ? scales.sigma_w : scales.sigma_u;
        double cycles[OCTAVES + 1], density[OCTAVES];
        for (int i = 0; i <= octaves; i++)
            cycles[i] = edge[i] / (2 * acos(-1) * L);
        const spectrum_series along = {(size_t)line.samples, L * line.step, series[j], series[j]};
        const spectrum_bands bands = {(size_t)octaves, cycles, .aa = density};
        spectrum_in_bands(&along, &bands, NULL);
        // density over cycles/m -> over L Omega
        for (int i = 0; i < octaves; i++)
            sum[j][i] += density[i] / (2 * acos(-1) * L * sigma * sigma * SEEDS);
    }
}

static void test_spectrum(void **state)
{
    (void)state;
    static const char *const names[] = {"x", "z", "y"};
    const flown slow = {1 << 14, 0.1}, fast = {1 << 12, 0.03};
    double edge[OCTAVES + 1], sum[3][OCTAVES] = {{0}}, high[3][OCTAVES] = {{0}};
    for (int i = 0; i <= OCTAVES; i++)
        edge[i] = fmin(0.03 * pow(2, i), 30);
    for (int seed = 0; seed < SEEDS; seed++) {
        add(seed, slow, 5, edge, sum);
        add(seed, fast, 5, edge + 5, high);
    }
    for (int j = 0; j < 3; j++)
        for (int i = 0; i < OCTAVES; i++) {
            char what[80];
            double measured = i < 5 ? sum[j][i] : high[j][i - 5];
            snprintf(what, sizeof what, "%s, L Omega %.3g to %.3g: over Dryden's, -1", names[j],
                     edge[i], edge[i + 1]);
            CHECK_BELOW(what, measured / expected(j, edge[i], edge[i + 1]) - 1, 0.03);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_spectrum)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
