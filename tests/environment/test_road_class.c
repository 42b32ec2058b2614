// The class of roads from their heights: generated roads of each class, random walks, whose density
// is known in closed form, records that do not report.
#include "environment/road_class.h"

#include "environment/road.h"
#include "support/check.h"
#include "support/draw.h"

enum { SAMPLES = 4000 };

static const double step = 0.1; // [m]
static double height[SAMPLES];

static void road_of(int iso_class, int seed)
{
    ld_road model = {.iso_class = iso_class,
                     .tracks = LD_TRACKS_SAME,
                     .seed = seed,
                     .harmonics = 300,
                     .wavelengths = {0.3, 100}};
    road *self;
    assert_int_equal(road_build(&model, 0, 0, &self, NULL), LD_OK);
    const road_places places = {0, step, SAMPLES};
    assert_int_equal(road_profile(self, ROAD_LEFT, &places, height, NULL), LD_OK);
    road_free(self);
}

static road_estimate classify(size_t count, double from, double to)
{
    road_estimate estimate;
    const road_record record = {count, step, height, from, to};
    assert_int_equal(road_classify(&record, &estimate, NULL), LD_OK);
    return estimate;
}

// ISO 8608, table of classes: G_d(n0) [1e-6 m3] up to 32 is A, up to 128 B, ... above 131072 H.
static void test_bounds(void **state)
{
    (void)state;
    static const double upper[] = {32, 128, 512, 2048, 8192, 32768, 131072};
    assert_int_equal(road_class_of(1e-9), 0);
    assert_int_equal(road_class_of(1e9), 7);
    for (int i = 0; i < 7; i++) {
        assert_int_equal(road_class_of(0.999e-6 * upper[i]), i);
        assert_int_equal(road_class_of(1.001e-6 * upper[i]), i + 1);
    }
}

// 400 m of each class: every seed gives its class.
static void test_generated_roads(void **state)
{
    (void)state;
    enum { SEEDS = 12, ROADS = 8 * SEEDS };
    double mean = 0, square = 0, inside = 0;
    for (int i = 0; i < ROADS; i++) {
        road_of(i / SEEDS, i);
        road_estimate estimate = classify(SAMPLES, 0.01, 1 / 0.3);
        assert_int_equal(estimate.nearest, i / SEEDS);
        assert_true(estimate.lowest <= i / SEEDS && estimate.highest >= i / SEEDS);
        double level = log(estimate.density / road_class_density(i / SEEDS, 0.1));
        mean += level / ROADS;
        square += level * level / ROADS;
        inside += (fabs(level) < log(estimate.factor)) / (double)ROADS;
    }
    CHECK_BELOW("mean of ln G_d(n0) less the class'", mean, 0.01);
    CHECK_BELOW("its deviation from road to road", sqrt(square), 0.06);
    CHECK_WITHIN("share of roads whose 95 % interval has it", inside, 0.9, 1);
}

// Steps of the variance s^2: G_d(n) = 2 s^2/step/(2 pi n)^2, by far below the sampling rate.
static void test_random_walk(void **state)
{
    (void)state;
    enum { WALKS = 40 };
    const double s = 2e-3;
    double mean = 0, closed = 2 * s * s / step / pow(2 * acos(-1) * 0.1, 2);
    uint64_t seed = 5;
    for (int i = 0; i < WALKS; i++) {
        // draw() is uniform from -1 to 1, of variance 1/3; a grade of 5 % below it
        double walk = 0;
        for (int k = 0; k < SAMPLES; k++) {
            walk += s * sqrt(3) * draw(&seed);
            height[k] = walk + 0.05 * step * k;
        }
        mean += log(classify(SAMPLES, 0, 1).density / closed) / WALKS;
    }
    CHECK_BELOW("random walks: mean of ln G_d(n0) less the closed form", mean, 0.045);
}

static void test_records_that_do_not_tell(void **state)
{
    (void)state;
    road_of(2, 1);
    road_estimate whole = classify(SAMPLES, 0, INFINITY);
    CHECK_BELOW("lowest frequency of 400 m, 4 waves in 102.4 m", whole.from - 4 / 102.4, 1e-15);
    CHECK_BELOW("highest, a quarter of the sampling rate", whole.to - 2.5, 1e-15);
    assert_true(isnan(classify(600, 0, 10).density) && classify(600, 0, 10).from > 0.1);
    assert_true(isnan(classify(10, 0, 10).density));
    assert_true(isnan(classify(SAMPLES, 0, 0.19).density));
    assert_true(isnan(classify(SAMPLES, 0.11, 10).density));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bounds),
        cmocka_unit_test(test_generated_roads),
        cmocka_unit_test(test_random_walk),
        cmocka_unit_test(test_records_that_do_not_tell),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
