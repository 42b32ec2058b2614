// Speed of the road: set-up of 30 m with 400 harmonics, and one evaluation of height and slope.
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "environment/road.h"

enum { REPEATS = 15 };

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

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

static double setup(const ld_road *model)
{
    double best = 1;
    for (int i = 0; i < REPEATS; i++) {
        double start = now();
        road_free(build(model));
        double used = now() - start;
        best = used < best ? used : best;
    }
    return best;
}

// Six wheels roll over it in steps of 1 mm; the sum keeps the calls alive.
static double evaluation(const road *self, double from, int steps, double *sum)
{
    static const double wheel[6] = {2.7, 2.7, -1.1, -1.1, -2.5, -2.5};
    double best = 1;
    for (int i = 0; i < REPEATS; i++) {
        double start = now();
        for (int step = 0; step < steps; step++)
            for (int j = 0; j < 6; j++) {
                double slope, x = from + 1e-3 * step + wheel[j];
                *sum += road_height(self, j % 2 ? ROAD_RIGHT : ROAD_LEFT, x, &slope);
                *sum += slope;
            }
        double used = (now() - start) / (6.0 * steps);
        best = used < best ? used : best;
    }
    return best;
}

int main(void)
{
    ld_road model = {
        .tracks = LD_TRACKS_SAME, .seed = 1, .harmonics = 400, .wavelengths = {0.3, 100}};
    double sum = 0;
    printf("set-up of 30 m, tracks same:        %8.2f ms\n", 1e3 * setup(&model));
    model.tracks = LD_TRACKS_INDEPENDENT;
    printf("set-up of 30 m, tracks independent: %8.2f ms\n", 1e3 * setup(&model));
    road *self = build(&model);
    printf("height and slope, tabulated:        %8.2f ns\n",
           1e9 * evaluation(self, -24, 24000, &sum));
    printf("height and slope, direct sum:       %8.2f ns\n", 1e9 * evaluation(self, 10, 200, &sum));
    road_free(self);
    printf("(%g)\n", sum);
    return 0;
}
