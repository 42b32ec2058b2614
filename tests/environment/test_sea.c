// Waves: spectra against closed forms and published fits, what the waves' sum has of them, what the
// key decides, headings, encounter.
#include "environment/sea.h"

#include <stdlib.h>

#include "support/check.h"

static const double PI = 3.14159265358979323846;

static ld_sea sea_of(ld_sea_spectrum spectrum, int waves, int seed)
{
    return (ld_sea){.present = true,
                    .spectrum = spectrum,
                    .height = 3,
                    .period = 9,
                    .peakedness = 3.3,
                    .heading = 2.4,
                    .spreading = NAN,
                    .waves = waves,
                    .seed = seed};
}

static sea_wave *waves_of(const ld_sea *model, size_t *count)
{
    sea_wave *waves;
    assert_int_equal(sea_build(model, &waves, count, NULL), LD_OK);
    return waves;
}

// ---- spectra, by the power a^2/2 of waves in narrow cells

enum { CELLS = 1000 };

static const double peak = 2 * 3.14159265358979323846 / 9;

// Begin of a cell [rad/s]; of its middle: k + 0.5.
static double cell_at(double k)
{
    return 0.5 * peak * pow(20, k / CELLS);
}

static void powers_of(const ld_sea *model, double power[CELLS])
{
    size_t count;
    sea_wave *waves = waves_of(model, &count);
    for (size_t k = 0; k < count; k++)
        power[k] = waves[k].amplitude * waves[k].amplitude / 2;
    free(waves);
}

// Share of Pierson-Moskowitz' power below a frequency.
static double share_below(double omega)
{
    return exp(-1.25 * pow(peak / omega, 4));
}

static void test_pierson_moskowitz(void **state)
{
    (void)state;
    ld_sea model = sea_of(LD_SEA_PIERSON_MOSKOWITZ, CELLS, 1);
    double power[CELLS], error = 0, all = share_below(10 * peak) - share_below(0.5 * peak);
    powers_of(&model, power);
    for (int k = 0; k < CELLS; k++) {
        double closed = 9.0 / 16 * (share_below(cell_at(k + 1)) - share_below(cell_at(k))) / all;
        if (closed > 1e-6)
            error = fmax(error, fabs(power[k] / closed - 1));
    }
    CHECK_BELOW("power in a cell against the closed form", error, 3e-9);
}

// DNV-RP-C205 (2010), 3.5.5: how much lower than gamma times Pierson-Moskowitz' the peak is, and
// the mean period between upward crossings.
static void test_jonswap(void **state)
{
    (void)state;
    ld_sea calm = sea_of(LD_SEA_PIERSON_MOSKOWITZ, CELLS, 1);
    double power[CELLS], calm_power[CELLS];
    int at_peak = (int)(CELLS * log(2) / log(20));
    powers_of(&calm, calm_power);
    for (int i = 0; i < 3; i++) {
        static const double gammas[] = {1, 3.3, 5};
        ld_sea model = sea_of(LD_SEA_JONSWAP, CELLS, 1);
        double g = model.peakedness = gammas[i], m0 = 0, m2 = 0;
        powers_of(&model, power);
        for (int k = 0; k < CELLS; k++) {
            m0 += power[k];
            m2 += power[k] * pow(cell_at(k + 0.5), 2);
        }
        CHECK_BELOW("height of the peak against 1 - 0.287 ln gamma",
                    power[at_peak] / (g * (1 - 0.287 * log(g)) * calm_power[at_peak]) - 1, 4e-3);
        double fit = 0.6673 + 0.05037 * g - 0.006230 * g * g + 0.0003341 * g * g * g;
        CHECK_BELOW("Tz/Tp against the fit", 2 * PI * sqrt(m0 / m2) / 9 / fit - 1, 6e-3);
    }
}

// ---- the waves

static void test_waves_have_the_power(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        static const int counts[] = {1, 7, 1000};
        ld_sea model = sea_of(LD_SEA_PIERSON_MOSKOWITZ, counts[i], 4);
        size_t count;
        sea_wave *waves = waves_of(&model, &count);
        double m0 = 0, m2 = 0, cell = log(20) / counts[i];
        assert_int_equal(count, counts[i]);
        for (size_t k = 0; k < count; k++) {
            double place = log(waves[k].omega / (0.5 * peak)) / cell;
            assert_true(place >= (double)k && place <= (double)k + 1);
            assert_true(waves[k].heading == 2.4);
            m0 += waves[k].amplitude * waves[k].amplitude / 2;
            m2 += pow(waves[k].amplitude * waves[k].omega, 2) / 2;
        }
        CHECK_BELOW("sum of a^2/2 over Hs^2/16", m0 / (9.0 / 16) - 1, 1e-14);
        if (count == 1000) {
            // m2 between the bounds: v = 1/x^2 from 0.01 to 4 in its integral
            double share = exp(-1.25e-4) - exp(-20);
            double closed =
                5.0 / 4 * sqrt(PI / 1.25) * (erf(sqrt(1.25) * 4) - erf(sqrt(1.25) * 0.01));
            CHECK_BELOW("m2 against the closed form",
                        m2 / (9.0 / 16 * closed * peak * peak / share) - 1, 1e-5);
            // power below 1.3 of the peak
            double below = 0;
            for (size_t k = 0; k < count && waves[k].omega < 1.3 * peak; k++)
                below += waves[k].amplitude * waves[k].amplitude / 2;
            CHECK_NEAR("power below 1.3 peaks", below / m0, exp(-1.25 / pow(1.3, 4)), 1e-3);
        }
        free(waves);
    }
}

static double height_at(const sea_wave *waves, size_t count, double t)
{
    double sum = 0;
    for (size_t k = 0; k < count; k++)
        sum += waves[k].amplitude * cos(waves[k].omega * t + waves[k].phase);
    return sum;
}

static void test_mean_square_over_seeds(void **state)
{
    (void)state;
    enum { SEEDS = 2000 };
    double square = 0, mean = 0, fourth = 0;
    for (int seed = 0; seed < SEEDS; seed++) {
        ld_sea model = sea_of(LD_SEA_JONSWAP, 40, seed);
        size_t count;
        sea_wave *waves = waves_of(&model, &count);
        double h = height_at(waves, count, 100) / 0.75;
        free(waves);
        mean += h / SEEDS;
        square += h * h / SEEDS;
        fourth += h * h * h * h / SEEDS;
    }
    CHECK_BELOW("mean over its standard error", mean * sqrt(SEEDS), 1.96);
    CHECK_BELOW("mean square over its standard error", (square - 1) * sqrt(SEEDS / 2.0), 1.96);
    CHECK_NEAR("fourth moment, of a normal height 3", fourth, 3, 0.25);
}

// Within an hour the sea does not come back: its autocorrelation stays low.
static void test_no_repetition(void **state)
{
    (void)state;
    ld_sea model = sea_of(LD_SEA_JONSWAP, 200, 1);
    size_t count;
    sea_wave *waves = waves_of(&model, &count);
    double most = 0;
    for (double lag = 120; lag < 3600; lag += 0.8) {
        double sum = 0;
        for (size_t k = 0; k < count; k++)
            sum += waves[k].amplitude * waves[k].amplitude * cos(waves[k].omega * lag);
        most = fmax(most, fabs(sum) / (2 * 9.0 / 16));
    }
    free(waves);
    CHECK_BELOW("autocorrelation from 2 min to an hour", most, 0.5);
}

// Phase and place in its cell of wave i follow from the seed and i.
static void test_key(void **state)
{
    (void)state;
    ld_sea a = sea_of(LD_SEA_JONSWAP, 50, 7), b = a, c = a;
    b.height = 1, b.heading = 0, b.spreading = 5, b.spectrum = LD_SEA_PIERSON_MOSKOWITZ;
    c.seed = 8;
    size_t count;
    sea_wave *of[3] = {waves_of(&a, &count), waves_of(&b, &count), waves_of(&c, &count)};
    for (size_t k = 0; k < count; k++) {
        assert_true(of[0][k].phase == of[1][k].phase && of[0][k].omega == of[1][k].omega);
        assert_true(of[0][k].phase != of[2][k].phase && of[0][k].omega != of[2][k].omega);
        assert_true(of[0][k].amplitude == of[2][k].amplitude);
    }
    for (int i = 0; i < 3; i++)
        free(of[i]);
}

// ---- headings

static int by_heading(const void *a, const void *b)
{
    double x = ((const sea_wave *)a)->heading, y = ((const sea_wave *)b)->heading;
    return (x > y) - (x < y);
}

static void test_spreading(void **state)
{
    (void)state;
    enum { WAVES = 3000 };
    ld_sea model = sea_of(LD_SEA_JONSWAP, WAVES, 3);
    size_t count;
    model.spreading = 1; // density cos^2(angle/2)/pi
    sea_wave *waves = waves_of(&model, &count);
    qsort(waves, count, sizeof *waves, by_heading);
    double gap = 0;
    for (size_t k = 0; k < count; k++) {
        double off = waves[k].heading - 2.4;
        gap = fmax(gap, fabs(0.5 + (off + sin(off)) / (2 * PI) - ((double)k + 0.5) / WAVES));
    }
    free(waves);
    CHECK_BELOW("Kolmogorov's distance times sqrt(n), s = 1", gap * sqrt(WAVES), 1.36);
    model.spreading = 10;
    waves = waves_of(&model, &count);
    double cosine = 0, sine = 0;
    for (size_t k = 0; k < count; k++) {
        cosine += cos(waves[k].heading - 2.4) / WAVES;
        sine += sin(waves[k].heading - 2.4) / WAVES;
    }
    free(waves);
    CHECK_NEAR("mean cosine, s/(s + 1)", cosine, 10.0 / 11, 4e-3);
    CHECK_BELOW("mean sine", sine, 8e-3);
}

// ---- one wave; encounter

static void test_regular(void **state)
{
    (void)state;
    ld_sea model = sea_of(LD_SEA_REGULAR, 200, 1);
    size_t count;
    sea_wave *wave = waves_of(&model, &count);
    assert_int_equal(count, 1);
    assert_true(wave->amplitude == 1.5 && wave->phase == 0 && wave->heading == 2.4);
    CHECK_BELOW("frequency", wave->omega - 2 * PI / 9, 1e-16);
    free(wave);
}

// The frequency at which the phase omega t - k (x cos + z sin) continues along a path.
static void test_encounter(void **state)
{
    (void)state;
    const double g = 9.8, head[3] = {8, 0, 0}, across[3] = {0, 3, 5}, fast[3] = {30, 0, 0};
    sea_wave wave = {1, 0.7, PI, 0};
    CHECK_BELOW("head sea", sea_encounter(&wave, head, g) - (0.7 + 0.49 * 8 / g), 1e-15);
    wave.heading = 0;
    CHECK_BELOW("following sea", sea_encounter(&wave, head, g) - (0.7 - 0.49 * 8 / g), 1e-15);
    CHECK_BELOW("overtaken", sea_encounter(&wave, fast, g) - (0.7 - 0.49 * 30 / g), 1e-15);
    wave.heading = 1.1;
    double k = 0.49 / g, h = 1e-3;
    double phase[2];
    for (int i = 0; i < 2; i++)
        phase[i] = 0.7 * (i * h) - k * (0 * cos(1.1) + across[2] * (i * h) * sin(1.1));
    CHECK_BELOW("aslant, by differences",
                sea_encounter(&wave, across, g) - (phase[1] - phase[0]) / h, 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pierson_moskowitz),
        cmocka_unit_test(test_jonswap),
        cmocka_unit_test(test_waves_have_the_power),
        cmocka_unit_test(test_mean_square_over_seeds),
        cmocka_unit_test(test_no_repetition),
        cmocka_unit_test(test_key),
        cmocka_unit_test(test_spreading),
        cmocka_unit_test(test_regular),
        cmocka_unit_test(test_encounter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
