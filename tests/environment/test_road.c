// The road: each part against its formula, the table against the direct sum, what a seed decides.
#include "environment/road.h"

#include <stdlib.h>

#include "base/random.h"
#include "support/check.h"
#include "support/draw.h"

#define PI_LONG 3.14159265358979323846264338327950288L
#define TWO_PI 6.283185307179586476925286766559

static ld_road class_road(int iso_class, ld_tracks tracks, int seed)
{
    return (ld_road){.iso_class = iso_class,
                     .tracks = tracks,
                     .seed = seed,
                     .harmonics = 400,
                     .wavelengths = {0.3, 100}};
}

// g = 0.9 below 0.1/m, falling to 0.2 at 1/m.
static double shares[] = {0.1, 0.9, 1, 0.2};

static ld_road coherent_road(int seed)
{
    ld_road model = class_road(2, LD_TRACKS_COHERENT, seed);
    model.coherence = (ld_table){.rows = 2, .columns = 2, .data = shares};
    return model;
}

static road *build(const ld_road *model, double x0, double x1)
{
    road *self;
    ld_error error;
    if (road_build(model, x0, x1, &self, &error))
        fail_msg("%s", error.text);
    return self;
}

// Weights of phase and phase' of harmonic n on a track.
static void weights(const ld_road *model, road_track track, long double n, long double weight[2])
{
    long double g = 1;
    if (track == ROAD_RIGHT && model->tracks == LD_TRACKS_INDEPENDENT)
        g = 0;
    if (track == ROAD_RIGHT && model->tracks == LD_TRACKS_COHERENT)
        g = n < 0.1L ? 0.9L : n > 1 ? 0.2L : 0.9L - 0.7L * (n - 0.1L) / 0.9L;
    weight[0] = g;
    weight[1] = sqrtl(1 - g * g);
}

// Height and slope from the definition of section 7, in long double.
static double defined_height(const ld_road *model, road_track track, double x, double *slope)
{
    long double height = 0, sum = 0, n_lo = 1 / (long double)model->wavelengths[1],
                ratio = model->wavelengths[1] / (long double)model->wavelengths[0];
    for (int i = 0; i < model->harmonics; i++) {
        long double lower = n_lo * powl(ratio, (long double)i / model->harmonics),
                    upper = n_lo * powl(ratio, (long double)(i + 1) / model->harmonics);
        long double n = sqrtl(lower * upper), weight[2];
        long double integral = 16e-6L * powl(4, model->iso_class) * 0.01L * (1 / lower - 1 / upper);
        weights(model, track, n, weight);
        for (uint64_t set = 0; set < 2; set++) {
            long double u =
                random_uniform((uint64_t)model->seed, random_stream("road"), set, (uint64_t)i, 0);
            long double angle = 2 * PI_LONG * (n * x + u), a = sqrtl(2 * integral) * weight[set];
            height += a * cosl(angle);
            sum -= a * 2 * PI_LONG * n * sinl(angle);
        }
    }
    *slope = (double)sum;
    return (double)height;
}

// Outside the table (direct sum), inside it and as a profile.
static void compare_with_definition(const char *name, const ld_road *model)
{
    enum { PLACES = 200 };
    const double x0 = -10, x1 = 25;
    uint64_t draws = 3;
    road *self = build(model, x0, x1);
    double table[2] = {0}, direct[2] = {0}, profile = 0;
    for (int i = 0; i < PLACES; i++) {
        road_track track = i % 2 ? ROAD_RIGHT : ROAD_LEFT;
        double x = 50 * draw(&draws), slope, defined_slope;
        double height = defined_height(model, track, x, &defined_slope);
        double *error = x >= x0 && x <= x1 ? table : direct;
        error[0] = fmax(error[0], fabs(road_height(self, track, x, &slope) - height));
        error[1] = fmax(error[1], fabs(slope - defined_slope));
    }
    double heights[PLACES], slope;
    const road_places places = {-30, 0.3, PLACES};
    assert_int_equal(road_profile(self, ROAD_RIGHT, &places, heights, NULL), LD_OK);
    for (int i = 0; i < PLACES; i++) {
        double height = defined_height(model, ROAD_RIGHT, -30 + 0.3 * i, &slope);
        profile = fmax(profile, fabs(heights[i] - height));
    }
    road_free(self);
    printf("  %s\n", name);
    CHECK_BELOW("direct sum: height [m]", direct[0], 1.5e-15);
    CHECK_BELOW("direct sum: slope", direct[1], 2e-14);
    CHECK_BELOW("table: height [m]", table[0], 1e-15);
    CHECK_BELOW("table: slope", table[1], 4e-14);
    CHECK_BELOW("profile: height [m]", profile, 1e-15);
}

static void test_definition(void **state)
{
    (void)state;
    ld_road same = class_road(0, LD_TRACKS_SAME, 42),
            independent = class_road(1, LD_TRACKS_INDEPENDENT, 42), coherent = coherent_road(42);
    compare_with_definition("class A, tracks same", &same);
    compare_with_definition("class B, tracks independent", &independent);
    compare_with_definition("class C, tracks coherent", &coherent);
    same.harmonics = 7;
    compare_with_definition("7 harmonics", &same);
}

// Far away, phases are those of the definition to the rounding of k x.
static void test_far_away(void **state)
{
    (void)state;
    ld_road model = class_road(0, LD_TRACKS_SAME, 5);
    road *self = build(&model, 99999, 100001);
    double slope, table = 0, direct = 0;
    for (int i = 0; i < 20; i++) {
        double x = 1e5 + 0.09 * i;
        double *error = x < 100001 ? &table : &direct;
        double height = defined_height(&model, ROAD_LEFT, x, &slope);
        *error = fmax(*error, fabs(road_height(self, ROAD_LEFT, x, NULL) - height));
    }
    road_free(self);
    CHECK_BELOW("table at 100 km [m]", table, 1e-12);
    CHECK_BELOW("direct sum at 100 km [m]", direct, 1e-12);
}

// Where cells meet and where the table ends, height and slope continue.
static void test_continuity(void **state)
{
    (void)state;
    ld_road model = class_road(0, LD_TRACKS_INDEPENDENT, 9);
    road *self = build(&model, 0, 1);
    double height = 0, slope = 0;
    for (int i = -1000; i < 11000; i++) {
        double x = 1e-4 * i, before, after, a, b, c;
        a = road_height(self, ROAD_RIGHT, x, &before);
        b = road_height(self, ROAD_RIGHT, x + 1e-4, &after);
        double middle;
        c = road_height(self, ROAD_RIGHT, x + 0.5e-4, &middle);
        // over 0.1 mm: Simpson's rule for the height, the mean for the slope in the middle
        height = fmax(height, fabs(b - a - 1e-4 / 6 * (before + 4 * middle + after)));
        slope = fmax(slope, fabs(middle - (before + after) / 2));
        assert_true(isfinite(c));
    }
    road_free(self);
    CHECK_BELOW("height less the integral of the slope [m]", height, 5e-17);
    CHECK_BELOW("slope between two places less their mean", slope, 1e-8);
}

// ---- sines, bumps, tables ----

// Slope against the differences of heights over +-1 um.
static void check_slope(const char *what, const road *self, road_track track, double x)
{
    double slope, d = 1e-6;
    double height = road_height(self, track, x, &slope);
    double difference =
        (road_height(self, track, x + d, NULL) - road_height(self, track, x - d, NULL)) / (2 * d);
    CHECK_BELOW(what, slope - difference, 1e-10 + 1e-9 * fabs(height));
}

static void test_sines(void **state)
{
    (void)state;
    ld_road model = {.iso_class = LD_ROAD_SMOOTH,
                     .sine_count = 2,
                     .sine = {{0.01, 2, 0}, {0.02, 5, TWO_PI / 4}}};
    road *self = build(&model, 0, 1);
    double slope;
    CHECK_NEAR("sines at x = 0: 0 + 20 mm", road_height(self, ROAD_LEFT, 0, &slope), 0.02, 1e-17);
    CHECK_NEAR("slope there: 10 mm 2 pi/2 m", slope, 0.01 * TWO_PI / 2, 1e-16);
    CHECK_NEAR("at 0.5 m", road_height(self, ROAD_RIGHT, 0.5, NULL), 0.01 + 0.02 * cos(TWO_PI / 10),
               1e-17);
    check_slope("slope at 0.7 m against differences", self, ROAD_RIGHT, 0.7);
    road_free(self);
}

static void test_bumps(void **state)
{
    (void)state;
    ld_road model = {.iso_class = LD_ROAD_SMOOTH,
                     .bump_count = 3,
                     .bump = {{20, 1, 0.03, LD_TRACK_BOTH},
                              {30, 2, -0.05, LD_TRACK_LEFT},
                              {40, 2, 0.04, LD_TRACK_RIGHT}}};
    road *self = build(&model, 0, 1);
    double slope;
    for (int track = 0; track < ROAD_TRACKS; track++) {
        road_track t = (road_track)track;
        CHECK_NEAR("top of a bump", road_height(self, t, 20.5, NULL), 0.03, 1e-17);
        CHECK_NEAR("a quarter of it", road_height(self, t, 20.25, &slope), 0.015, 1e-17);
        CHECK_NEAR("slope there, H pi/length", slope, 0.03 * TWO_PI / 2, 1e-16);
        check_slope("slope at 20.9 m against differences", self, t, 20.9);
        assert_true(road_height(self, t, 20, &slope) == 0 && slope == 0);
        assert_true(road_height(self, t, 21, &slope) == 0 && slope == 0);
        assert_true(road_height(self, t, 25, &slope) == 0 && slope == 0);
    }
    CHECK_NEAR("hole on the left track", road_height(self, ROAD_LEFT, 31, NULL), -0.05, 1e-17);
    CHECK_NEAR("and not on the right one", road_height(self, ROAD_RIGHT, 31, NULL), 0, 0);
    CHECK_NEAR("bump on the right track", road_height(self, ROAD_RIGHT, 41, NULL), 0.04, 1e-17);
    CHECK_NEAR("and not on the left one", road_height(self, ROAD_LEFT, 41, NULL), 0, 0);
    road_free(self);
}

static double cubic(double x)
{
    return 0.1 + x * (0.02 + x * (-0.03 + x * 0.004));
}

// Points of a cubic: not-a-knot gives it back; beyond the ends the height stays.
static void test_table(void **state)
{
    (void)state;
    static const double x[] = {-1, 0, 0.7, 2, 3, 4.5};
    enum { ROWS = sizeof x / sizeof *x };
    double data[3 * ROWS];
    for (int i = 0; i < ROWS; i++) {
        data[3 * i] = x[i];
        data[3 * i + 1] = cubic(x[i]);
        data[3 * i + 2] = -2 * cubic(x[i]);
    }
    ld_road model = {.iso_class = LD_ROAD_SMOOTH, .profile = {ROWS, 3, data}};
    road *self = build(&model, 0, 1);
    double slope;
    CHECK_NEAR("left track", road_height(self, ROAD_LEFT, 1.3, &slope), cubic(1.3), 1e-16);
    CHECK_NEAR("its slope", slope, 0.02 + 1.3 * (-0.06 + 1.3 * 0.012), 1e-16);
    CHECK_NEAR("right track", road_height(self, ROAD_RIGHT, 4.4, &slope), -2 * cubic(4.4), 2e-16);
    CHECK_NEAR("before", road_height(self, ROAD_LEFT, -7, &slope), cubic(-1), 1e-16);
    assert_true(slope == 0);
    CHECK_NEAR("beyond", road_height(self, ROAD_RIGHT, 7, &slope), -2 * cubic(4.5), 1e-16);
    assert_true(slope == 0);
    road_free(self);

    // two columns: the same on both tracks
    double both[] = {0, 0.1, 1, 0.3};
    model.profile = (ld_table){2, 2, both};
    self = build(&model, 0, 1);
    for (int track = 0; track < ROAD_TRACKS; track++)
        CHECK_NEAR("two points: a line", road_height(self, (road_track)track, 0.25, &slope), 0.15,
                   1e-16);
    road_free(self);
}

// Under wheels beside the tracks: a twisted plane road h = a + b x + (c + d x) z, given by its
// tracks.
static void test_between_the_tracks(void **state)
{
    (void)state;
    enum { WHEELS = 7 };
    static const double left = -0.8, right = 1.2,
                        z[WHEELS] = {-0.8, -0.45, 0, 0.3, 1.2, -1.5, 2}; // the last two: beyond
    double data[6], worst = 0, steepest = 0;
    for (int i = 0; i < 2; i++) {
        double x = data[3 * i] = 10 * i;
        data[3 * i + 1] = 0.1 + 0.02 * x + (0.05 - 0.01 * x) * left;
        data[3 * i + 2] = 0.1 + 0.02 * x + (0.05 - 0.01 * x) * right;
    }
    ld_road model = {.iso_class = LD_ROAD_SMOOTH, .profile = {2, 3, data}, .places = {left, right}};
    road *self = build(&model, 0, 1);
    for (int i = 0; i < WHEELS; i++)
        for (double x = 0.5; x < 10; x += 1.3) {
            double at = fmin(fmax(z[i], left), right), slope;
            double h = road_height_between(self, road_right_share(&model, z[i]), x, &slope);
            worst = fmax(worst, fabs(h - (0.1 + 0.02 * x + (0.05 - 0.01 * x) * at)));
            steepest = fmax(steepest, fabs(slope - (0.02 - 0.01 * at)));
        }
    CHECK_BELOW("twisted plane: height [m]", worst, 1e-16);
    CHECK_BELOW("twisted plane: slope", steepest, 1e-16);
    // on a track: its height to the bit; without places: that of the side
    double slope[2];
    assert_true(road_right_share(&model, left) == 0 && road_right_share(&model, right) == 1);
    assert_true(road_height_between(self, 1, 3.3, &slope[0]) ==
                    road_height(self, ROAD_RIGHT, 3.3, &slope[1]) &&
                slope[0] == slope[1]);
    model.places[0] = model.places[1] = NAN;
    assert_true(road_right_share(&model, -0.1) == 0 && road_right_share(&model, 0) == 1);
    road_free(self);
}

static void test_sum(void **state)
{
    (void)state;
    ld_road random = class_road(0, LD_TRACKS_SAME, 3), all = random;
    all.sine_count = all.bump_count = 1;
    all.sine[0] = (ld_road_sine){0.01, 3, 1};
    all.bump[0] = (ld_bump){-2, 5, 0.02, LD_TRACK_LEFT};
    double data[] = {0, 0.1, 1, 0.3};
    all.profile = (ld_table){2, 2, data};
    road *a = build(&random, -1, 1), *b = build(&all, -1, 1);
    double slope[2],
        x = 0.4,
        rest = 0.01 * sin(TWO_PI / 3 * x + 1) + 0.18 + 0.01 * (1 - cos(TWO_PI / 5 * (x + 2)));
    double height = road_height(a, ROAD_LEFT, x, &slope[0]);
    CHECK_NEAR("random, sine, bump and table", road_height(b, ROAD_LEFT, x, &slope[1]),
               height + rest, 1e-16);
    check_slope("slope of the sum against differences", b, ROAD_LEFT, x);
    road_free(a);
    road_free(b);
}

static void test_flat(void **state)
{
    (void)state;
    ld_road smooth = {.iso_class = LD_ROAD_SMOOTH}, flat = class_road(3, LD_TRACKS_SAME, 1);
    flat.form = LD_ROAD_FLAT;
    flat.sine_count = 1;
    flat.sine[0] = (ld_road_sine){0.01, 3, 1};
    const ld_road *models[] = {&smooth, &flat};
    for (int i = 0; i < 2; i++) {
        road *self = build(models[i], 0, 10);
        for (double x = -10; x < 20; x += 0.7) {
            double slope;
            assert_true(road_height(self, ROAD_LEFT, x, &slope) == 0 && slope == 0);
        }
        road_free(self);
    }
}

// ---- what the seed decides ----

static double difference(const ld_road *a, road_track track_a, const ld_road *b, road_track track_b)
{
    road *one = build(a, -1, 1), *two = build(b, -1, 1);
    double sum = 0, power = 0;
    for (double x = -50; x < 50; x += 0.37) {
        double h = road_height(one, track_a, x, NULL), g = road_height(two, track_b, x, NULL);
        sum += (h - g) * (h - g);
        power += h * h;
    }
    road_free(one);
    road_free(two);
    return sqrt(sum / power);
}

static void test_seeds(void **state)
{
    (void)state;
    ld_road one = class_road(0, LD_TRACKS_SAME, 1), two = class_road(0, LD_TRACKS_SAME, 2),
            independent = class_road(0, LD_TRACKS_INDEPENDENT, 1), coherent = coherent_road(1);
    coherent.iso_class = 0;
    assert_true(difference(&one, ROAD_LEFT, &one, ROAD_LEFT) == 0);
    assert_true(difference(&one, ROAD_LEFT, &one, ROAD_RIGHT) == 0);
    assert_true(difference(&one, ROAD_LEFT, &independent, ROAD_LEFT) == 0);
    assert_true(difference(&one, ROAD_LEFT, &coherent, ROAD_LEFT) == 0);
    CHECK_WITHIN("another seed: difference over rms", difference(&one, ROAD_LEFT, &two, ROAD_LEFT),
                 0.9, 2);
    CHECK_WITHIN("independent tracks: difference over rms",
                 difference(&independent, ROAD_LEFT, &independent, ROAD_RIGHT), 0.9, 2);

    // a class is twice as high as the one before
    ld_road rough = class_road(3, LD_TRACKS_SAME, 1);
    road *a = build(&one, -1, 1), *d = build(&rough, -1, 1);
    CHECK_NEAR("class D over class A",
               road_height(d, ROAD_LEFT, 0.3, NULL) / road_height(a, ROAD_LEFT, 0.3, NULL), 8,
               1e-12);
    road_free(a);
    road_free(d);
}

// A road in the place of another has the bits of one that is built alone, whichever of its numbers
// differs from the one before's.
static void test_renewed(void **state)
{
    (void)state;
    ld_road table = coherent_road(3), shorter = class_road(2, LD_TRACKS_SAME, 3), rougher = shorter;
    const ld_road base = shorter, seed = class_road(2, LD_TRACKS_SAME, 4),
                  tracks = class_road(2, LD_TRACKS_INDEPENDENT, 3), smooth = {.iso_class = -1},
                  flat = {.form = LD_ROAD_FLAT};
    shorter.wavelengths[0] = 0.5;
    rougher.iso_class = 3;
    ld_road fewer = base, bumpy = base;
    fewer.harmonics = 399;
    bumpy.bump_count = 1;
    bumpy.bump[0] = (ld_bump){.at = -1, .length = 0.5, .height = 0.1};
    const ld_road *models[] = {&base, &base,  &seed, &base,    &tracks, &tracks, &table,
                               &base, &table, &base, &shorter, &fewer,  &base,   &rougher,
                               &base, &bumpy, &base, &smooth,  &base,   &flat,   &base};
    road *renewed = NULL;
    ld_error error;
    for (size_t k = 0; k < sizeof models / sizeof *models; k++)
        for (int moved = 0; moved < 3; moved++) {
            // the stretch goes elsewhere, then is longer
            double x0 = -3 - (moved == 1), x1 = 2 + (moved == 2);
            road *own = build(models[k], x0, x1);
            assert_int_equal(road_renew(&renewed, models[k], x0, x1, &error), LD_OK);
            for (int track = 0; track < ROAD_TRACKS; track++)
                for (double x = -4.5; x < 3.5; x += 0.173) {
                    double slope, again;
                    double height = road_height(own, (road_track)track, x, &slope);
                    assert_true(road_height(renewed, (road_track)track, x, &again) == height);
                    assert_true(again == slope);
                }
            road_free(own);
        }
    road_free(renewed);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_renewed),
        cmocka_unit_test(test_definition),
        cmocka_unit_test(test_far_away),
        cmocka_unit_test(test_continuity),
        cmocka_unit_test(test_sines),
        cmocka_unit_test(test_bumps),
        cmocka_unit_test(test_table),
        cmocka_unit_test(test_sum),
        cmocka_unit_test(test_flat),
        cmocka_unit_test(test_seeds),
        cmocka_unit_test(test_between_the_tracks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
