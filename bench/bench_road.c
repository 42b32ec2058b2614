// Speed of the road: set-up of 30 m with 400 harmonics, and one evaluation of height and slope.
#include <math.h>

#include "bench_sample.h"
#include "environment/road.h"

enum { REPEATS = 15 };

static road *build(const ld_road *model)
{
    road *self;
    ld_error error;
    if (road_build(model, -27, 3, &self, &error)) {
        fprintf(stderr, "%s\n", error.text);
        exit(1);
    }
    return self;
}

static void bench_setup(const char *what, const ld_road *model)
{
    double sample[REPEATS];
    for (int i = 0; i < REPEATS; i++) {
        double start = now();
        road_free(build(model));
        sample[i] = now() - start;
    }
    print(what, sample, REPEATS, 1e-3, "ms");
}

// Six wheels roll over it in steps of 1 mm; the sum, returned, keeps the calls alive.
static double bench_evaluation(const char *what, const road *self, double from, int steps)
{
    static const double wheel[6] = {2.7, 2.7, -1.1, -1.1, -2.5, -2.5};
    double sample[REPEATS], sum = 0;
    for (int i = 0; i < REPEATS; i++) {
        double start = now();
        for (int step = 0; step < steps; step++)
            for (int j = 0; j < 6; j++) {
                double slope, x = from + 1e-3 * step + wheel[j];
                sum += road_height(self, j % 2 ? ROAD_RIGHT : ROAD_LEFT, x, &slope);
                sum += slope;
            }
        sample[i] = (now() - start) / (6.0 * steps);
    }
    print(what, sample, REPEATS, 1e-9, "ns");
    return sum;
}

int main(void)
{
    ld_road model = {
        .tracks = LD_TRACKS_SAME, .seed = 1, .harmonics = 400, .wavelengths = {0.3, 100}};
    bench_setup("set-up of 30 m, tracks same", &model);
    model.tracks = LD_TRACKS_INDEPENDENT;
    bench_setup("set-up of 30 m, tracks independent", &model);
    road *self = build(&model);
    double sum = bench_evaluation("height and slope, tabulated", self, -24, 24000);
    sum += bench_evaluation("height and slope, direct sum", self, 10, 200);
    road_free(self);
    return isnan(sum);
}
