// Error over CPU time of the launch through two ideal sliding points (bench/ideal.yaml; tests/
// verification/test_ideal.c): largest difference of the tip's deflection from a converged run, at
// every millisecond, over its peak. CPU time of the launch alone, without set-up and rows, least of
// many; the best of the grid at each error that is asked for, there with its set-up.
#include <math.h>

#include "bench_sample.h"
#include "integration/integrator.h"
#include "launchdyn/history.h"
#include "launchdyn/simulation.h"
#include "model/model.h"
#include "quantities/summary.h"
#include "scenario/scenario.h"

enum { REPEATS = 3, MOST = 200, MOST_MODES = 100 };

static const int modes[] = {4, 5, 6, 7, 8, 10, 12, 14, 16, 18, 20, 24};
static const double tolerances[] = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6};
static const double wanted[] = {1e-2, 1e-3, 4e-4, 1e-4};
// Highest frequency of what is slowed (theory-tube.md, selective mass scaling) [Hz]; 0: nothing is.
static const double cuts[] = {0, 700, 1000, 1500, 2000, 3000, 4000, 6000};
enum {
    MODES = sizeof modes / sizeof *modes,
    TOLERANCES = sizeof tolerances / sizeof *tolerances,
    CUTS = sizeof cuts / sizeof *cuts,
    POINTS = MODES * TOLERANCES * CUTS,
    WANTED = sizeof wanted / sizeof *wanted
};

// The tip's deflection [m] at k ms.
typedef struct tip_motion {
    int count;
    double y[MOST];
} tip_motion;

typedef struct point {
    int modes;
    double tolerance, cut, error, cpu, setup; // [1], [Hz], [1], [s]
    ld_statistics statistics;
} point;

static void check(int failed, const ld_error *error)
{
    if (failed) {
        fprintf(stderr, "%s\n", error->text);
        exit(1);
    }
}

static tip_motion motion_of(const ld_simulation *simulation)
{
    tip_motion motion = {0};
    ld_summary summary;
    ld_error error = {0};
    ld_history *history = ld_history_new(NULL);
    ld_run_options options = {.sink = ld_history_sink(history)};
    check(ld_simulation_run(simulation, &options, &summary, &error), &error);
    size_t rows;
    const double *t = ld_history_column(history, "t", &rows);
    const double *y = ld_history_column(history, "tip.y", NULL);
    for (size_t i = 0; i < rows && motion.count < MOST; i++)
        if (fabs(1e3 * t[i] - motion.count) < 1e-6)
            motion.y[motion.count++] = y[i];
    ld_history_free(history);
    return motion;
}

static double error_of(const tip_motion *motion, const tip_motion *truth)
{
    double worst = 0, peak = 0;
    for (int i = 0; i < truth->count && i < motion->count; i++) {
        worst = fmax(worst, fabs(motion->y[i] - truth->y[i]));
        peak = fmax(peak, fabs(truth->y[i]));
    }
    return worst / peak;
}

static double highest_frequency(const ld_simulation *simulation)
{
    ld_mode mode[MOST_MODES];
    int count = ld_simulation_tube_modes(simulation, mode, MOST_MODES);
    double highest = 0;
    for (int i = 0; i < count && i < MOST_MODES; i++)
        highest = fmax(highest, mode[i].frequency);
    return highest;
}

// Of the model, which is changed and stays in use. No step is longer than what is stable, a step
// that is not being refused only once it has done harm; a rocket makes frequencies lower.
static ld_simulation *simulation_of(ld_model *model, const point *at)
{
    ld_simulation *simulation;
    ld_error error = {0};
    model->tubes.modes.bending = at->modes;
    model->tubes.modes.cut = at->cut;
    model->run.tolerance = at->tolerance;
    check(ld_simulation_create(model, &simulation, &error), &error);
    // what is slowed is faster by a little where the tube moves on its supports
    double highest = highest_frequency(simulation);
    if (at->cut > 0)
        highest = fmin(highest, 1.1 * at->cut);
    model->run.max_step = 0.9 * INTEGRATOR_STABLE_TO / (2 * acos(-1.0) * highest);
    return simulation;
}

static void measure(ld_model *model, const tip_motion *truth, point *at)
{
    ld_summary summary;
    ld_error error = {0};
    double start = now();
    ld_simulation *simulation = simulation_of(model, at);
    at->setup = now() - start;
    tip_motion motion = motion_of(simulation);
    at->error = error_of(&motion, truth);
    at->cpu = INFINITY;
    for (int r = 0; r < REPEATS; r++) {
        start = now();
        check(ld_simulation_run(simulation, NULL, &summary, &error), &error);
        at->cpu = fmin(at->cpu, now() - start);
    }
    at->statistics = summary.statistics;
    ld_simulation_free(simulation);
}

static void print_point(const point *at)
{
    printf("%5d %7.0f  %9.0e %9.1e %9.3f %7lld %12lld\n", at->modes, at->cut, at->tolerance,
           at->error, 1e3 * at->cpu, (long long)at->statistics.steps,
           (long long)at->statistics.rhs_evaluations);
}

static const point *best_of(const point *grid, int count, double error)
{
    const point *best = NULL;
    for (int i = 0; i < count; i++)
        if (grid[i].error <= error && (!best || grid[i].cpu < best->cpu))
            best = &grid[i];
    return best;
}

int main(void)
{
    static point grid[POINTS];
    ld_model model;
    ld_messages messages = {0};
    if (scenario_read(LD_SOURCE_DIR "/bench/ideal.yaml", NULL, 0, &model, &messages)) {
        ld_messages_print(&messages, stderr);
        return 1;
    }
    const point tight = {.modes = 24, .tolerance = 1e-8};
    ld_simulation *simulation = simulation_of(&model, &tight);
    tip_motion truth = motion_of(simulation);
    ld_simulation_free(simulation);
    printf("modes     cut  tolerance     error  CPU [ms]   steps  evaluations\n");
    for (int i = 0; i < POINTS; i++) {
        grid[i].modes = modes[i / TOLERANCES % MODES];
        grid[i].tolerance = tolerances[i % TOLERANCES];
        grid[i].cut = cuts[i / (TOLERANCES * MODES)];
        measure(&model, &truth, &grid[i]);
        print_point(&grid[i]);
    }
    for (int i = 0; i < WANTED; i++) {
        const point *best = best_of(grid, POINTS, wanted[i]);
        if (best)
            printf("error %.2f %%: %7.3f ms by %d modes, cut %.0f Hz, tolerance %.0e; set-up %.1f "
                   "ms\n",
                   100 * wanted[i], 1e3 * best->cpu, best->modes, best->cut, best->tolerance,
                   1e3 * best->setup);
    }
    model_clear(&model);
    return 0;
}
