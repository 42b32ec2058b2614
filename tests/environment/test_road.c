// The road: its parts against their formulas, the table against the direct sum.
#include "environment/road.h"

#include <stdlib.h>

#include "base/random.h"
#include "support/check.h"
#include "support/draw.h"

#define TWO_PI 6.283185307179586476925286766559

static ld_road class_road(int iso_class, ld_tracks tracks, int seed)
{
    return (ld_road){.iso_class = iso_class,
                     .tracks = tracks,
                     .seed = seed,
                     .harmonics = 400,
                     .wavelengths = {0.3, 100}};
}

static road *build(const ld_road *model, double x0, double x1)
{
    road *self;
    ld_error error;
    if (road_build(model, x0, x1, &self, &error))
        fail_msg("%s", error.text);
    return self;
}

// Height and slope from the definition of section 7, in long double, phases drawn here.
static double defined_height(const ld_road *model, int set, double x, double *slope)
{
    long double height = 0, sum = 0, n_lo = 1 / (long double)model->wavelengths[1],
                ratio = model->wavelengths[1] / (long double)model->wavelengths[0];
    for (int i = 0; i < model->harmonics; i++) {
        long double lower = n_lo * powl(ratio, (long double)i / model->harmonics),
                    upper = n_lo * powl(ratio, (long double)(i + 1) / model->harmonics);
        long double k = 2 * acosl(-1) * sqrtl(lower * upper);
        long double integral = 16e-6L * powl(4, model->iso_class) * 0.01L * (1 / lower - 1 / upper);
        long double u = random_uniform((uint64_t)model->seed, random_stream("road"), (uint64_t)set,
                                       (uint64_t)i, 0);
        long double angle = k * x + 2 * acosl(-1) * u;
        height += sqrtl(2 * integral) * cosl(angle);
        sum -= sqrtl(2 * integral) * k * sinl(angle);
    }
    *slope = (double)sum;
    return (double)height;
}

// Outside the table (direct sum) and inside it, against the definition.
static void test_definition(void **state)
{
    (void)state;
    const double x0 = -10, x1 = 25;
    uint64_t draws = 3;
    for (int tracks = LD_TRACKS_SAME; tracks <= LD_TRACKS_INDEPENDENT; tracks++) {
        ld_road model = class_road(1, (ld_tracks)tracks, 42);
        road *self = build(&model, x0, x1);
        double table[2] = {0}, direct[2] = {0};
        for (int i = 0; i < 400; i++) {
            road_track track = i % 2 ? ROAD_RIGHT : ROAD_LEFT;
            double x = 50 * draw(&draws), slope, defined_slope, *error = direct;
            if (x >= x0 && x <= x1)
                error = table;
            int set = tracks == LD_TRACKS_INDEPENDENT && track == ROAD_RIGHT;
            double height = defined_height(&model, set, x, &defined_slope);
            error[0] = fmax(error[0], fabs(road_height(self, track, x, &slope) - height));
            error[1] = fmax(error[1], fabs(slope - defined_slope));
        }
        CHECK_BELOW("direct sum: height [m]", direct[0], 1e-15);
        CHECK_BELOW("direct sum: slope", direct[1], 1e-14);
        CHECK_BELOW("table: height [m]", table[0], 1e-15);
        CHECK_BELOW("table: slope", table[1], 1e-13);
        road_free(self);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_definition),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
