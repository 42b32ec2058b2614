// Error over CPU time of the launch through two ideal sliding points (tests/verification/
// test_ideal.c): largest difference of the tip's deflection from a converged run, at every
// millisecond, over its peak; the launch alone, without set-up and rows, least of many.
#include <math.h>

#include "bench_sample.h"
#include "launchdyn/history.h"
#include "launchdyn/simulation.h"
#include "scenario/scenario.h"
#include "simulation/summary.h"

enum { REPEATS = 15, MOST = 200 };

static const char *const sets[] = {
    "rocket.contact={law: ideal, stiffness: , friction: 0}",
    "rocket.adaptors=[{name: rear, at: 0 m}, {name: front, at: 1.9 m}]",
    "rocket={mass: 60 kg, center: 1.2 0 0 m, inertia: 0.25 30 30 kg.m2}",
    "rocket.empty={mass: 60 kg, center: 1.2 0 0 m, inertia: 0.25 30 30 kg.m2}",
    "rocket.motor.thrust=[[0 s, 15 kN], [2.5 s, 15 kN], [2.5 s, 0 kN]]",
    "rocket.lock.release_force=1 N",
    "tubes={slot: none, modes: {damping: 0 %}}",
    "base.elevation=20 deg",
    "environment.gravity=9.81 m/s2",
    "run={start: undeformed, output_step: 1 ms}",
};
enum { SETS = sizeof sets / sizeof *sets };

// The tip's deflection [m] at k ms.
typedef struct tip_motion {
    int count;
    double y[MOST];
} tip_motion;

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

static void compare(const ld_model *model, int modes, double tolerance, tip_motion *truth)
{
    ld_model varied = *model;
    ld_simulation *simulation;
    ld_summary summary;
    ld_error error = {0};
    double sample[REPEATS], worst = 0, peak = 0;
    varied.tubes.modes.bending = modes;
    varied.run.tolerance = tolerance;
    check(ld_simulation_create(&varied, &simulation, &error), &error);
    tip_motion motion = motion_of(simulation);
    if (truth->count == 0)
        *truth = motion;
    for (int i = 0; i < truth->count && i < motion.count; i++) {
        worst = fmax(worst, fabs(motion.y[i] - truth->y[i]));
        peak = fmax(peak, fabs(truth->y[i]));
    }
    for (int r = 0; r < REPEATS; r++) {
        double start = now();
        check(ld_simulation_run(simulation, NULL, &summary, &error), &error);
        sample[r] = now() - start;
    }
    char what[80];
    snprintf(what, sizeof what, "%2d modes, tolerance %.0e: %5lld steps, error %.1e", modes,
             tolerance, (long long)summary.statistics.steps, worst / peak);
    print(what, sample, REPEATS, 1e-3, "ms");
    ld_simulation_free(simulation);
}

int main(void)
{
    static const struct {
        int modes;
        double tolerance;
    } choice[] = {{24, 1e-8}, {2, 1e-3}, {4, 1e-4}, {6, 1e-5}, {8, 1e-5}, {12, 1e-5}, {16, 1e-5}};
    ld_model model;
    ld_messages messages = {0};
    tip_motion truth = {0};
    if (scenario_read(LD_SOURCE_DIR "/examples/fixed.yaml", sets, SETS, &model, &messages)) {
        ld_messages_print(&messages, stderr);
        return 1;
    }
    for (size_t i = 0; i < sizeof choice / sizeof *choice; i++)
        compare(&model, choice[i].modes, choice[i].tolerance, &truth);
    model_clear(&model);
    return 0;
}
