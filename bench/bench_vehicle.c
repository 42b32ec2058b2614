// Cost of a launch from the marching vehicle: one evaluation and its parts, the whole run of
// examples/reference.yaml (3 s lead-in), and the part in the tube against the fixed base. Process
// CPU time.
#include <math.h>
#include <string.h>

#include "bench_sample.h"
#include "model/model.h"
#include "scenario/scenario.h"
#include "state/equilibrium.h"
#include "state/evaluation.h"
#include "state/launch_state.h"
#include "systems/launching/launching_dynamics.h"

enum { REPEATS = 11, PARTS = 41, EVALUATIONS = 2000 };

typedef struct part_of_it {
    const char *name;
    bool place, launching, vehicle;
} part_of_it;

// What an evaluation of the whole, or of parts of it, costs in the state before ignition.
static void bench_evaluation(launch_state *launch, const part_of_it *part)
{
    double y[LD_MAX_STATES], y_dot[LD_MAX_STATES], sample[PARTS];
    ld_equilibrium_summary unused;
    const launcher_system *launcher = &launch->launcher;
    launching_phase phase = simulation_start_phase(launch);
    launcher_input input;
    launcher_output out;
    memset(&out, 0, sizeof out);
    if (simulation_equilibrium(launch, 0, y, &unused, NULL))
        return;
    simulation_move_with_base(launch, 0, y);
    simulation_input(launch, 0, y, &input);
    launcher_evaluate(launcher, &input, &phase, y, &out);
    for (int r = 0; r < PARTS; r++) {
        double start = now();
        for (int i = 0; i < EVALUATIONS; i++) {
            y[launcher->base_at] += 1e-9; // a new place each time
            if (part->place)
                simulation_input(launch, 0, y, &input);
            if (part->launching)
                launching_evaluate(&launcher->launching, &input.launching, &phase, y,
                                   &out.launching);
            if (part->vehicle)
                launcher_evaluate_base(launcher, &input, &phase, y, &out);
            if (part->launching && part->vehicle)
                launcher_rates(launcher, y, &out, true, y_dot);
        }
        sample[r] = (now() - start) / EVALUATIONS;
    }
    print(part->name, sample, PARTS, 1e-9, "ns");
}

// Least CPU time [s] of a run, which fills the summary.
static double bench_summary(const char *what, const char *file, const char *const *sets, int count,
                            ld_summary *summary)
{
    ld_model model;
    ld_messages messages = {0};
    ld_simulation *simulation;
    double sample[REPEATS];
    if (scenario_read(file, sets, (size_t)count, &model, &messages) ||
        ld_simulation_create(&model, &simulation, NULL))
        return 0;
    for (int r = 0; r < REPEATS; r++) {
        double start = now();
        ld_simulation_run(simulation, NULL, summary, NULL);
        sample[r] = now() - start;
    }
    print(what, sample, REPEATS, 1e-3, "ms");
    printf("    %lld steps, %lld evaluations\n", (long long)summary->statistics.steps,
           (long long)summary->statistics.rhs_evaluations);
    ld_simulation_free(simulation);
    model_clear(&model);
    return sample[0];
}

static double bench_run(const char *what, const char *file, const char *const *sets, int count)
{
    ld_summary summary;
    return bench_summary(what, file, sets, count, &summary);
}

// To the tip with the lead-in by short and by long steps: cost, and exit rates against a tight run.
static void bench_lead_in(const char *what, const char *file, const char *first, const char *second)
{
    static const char *const methods[] = {"run.lead_in_method=explicit",
                                          "run.lead_in_method=exponential"};
    static ld_summary tight, summary;
    const char *sets[] = {first, second, "run.end=tip", methods[0], "run.tolerance=1e-8"};
    printf("%s\n", what);
    bench_summary("  explicit steps, tolerance 1e-8", file, sets, 5, &tight);
    for (int k = 0; k < 2; k++) {
        sets[3] = methods[k];
        bench_summary(k ? "  exponential steps" : "  explicit steps", file, sets, 4, &summary);
        double most = 0;
        for (int i = 0; i < summary.rocket_count; i++) {
            const ld_rocket_summary *a = &tight.rocket[i], *b = &summary.rocket[i];
            most = fmax(most, fabs(b->pitch_rate - a->pitch_rate));
            most = fmax(most, fabs(b->yaw_rate - a->yaw_rate));
        }
        printf("    exit rates within %.2g mrad/s, energy residual %.1e of the largest work\n",
               1e3 * most, summary.energy.residual_relative);
    }
}

int main(void)
{
    static const char reference[] = LD_SOURCE_DIR "/examples/reference.yaml";
    static const char fixed[] = LD_SOURCE_DIR "/examples/fixed.yaml";
    static const char *const in_tube[] = {"run.lead_in=0 s", "run.end=tip"};
    static const part_of_it parts[] = {{"evaluation of the whole", true, true, true},
                                       {"of it frames, thrust and mass", true, false, false},
                                       {"of it tube and rocket", false, true, false},
                                       {"of it wheels, chassis and platforms", false, false, true}};
    ld_model model;
    ld_messages messages = {0};
    ld_simulation *simulation;
    launch_state launch;
    if (scenario_read(reference, NULL, 0, &model, &messages) ||
        ld_simulation_create(&model, &simulation, NULL) ||
        launch_state_begin(&launch, simulation, NULL))
        return 1;
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++)
        bench_evaluation(&launch, &parts[i]);
    launch_state_end(&launch);
    ld_simulation_free(simulation);
    model_clear(&model);
    bench_run("whole run, 3 s lead-in, to the ground", reference, NULL, 0);
    bench_lead_in("30 km/h, 3 s lead-in", reference, "run.lead_in=3 s", "base.speed=30 km/h");
    bench_lead_in("class E, 60 km/h", reference, "base.road.class=E", "base.speed=60 km/h");
    bench_lead_in("parked", reference, "run.lead_in=3 s", "base.speed=0 km/h");
    bench_lead_in("sequence of four, slewing", LD_SOURCE_DIR "/examples/sequence.yaml",
                  "run.lead_in=3 s", "base.speed=15 km/h");
    double vehicle = bench_run("in the tube alone, vehicle", reference, in_tube, 2);
    double base = bench_run("in the tube alone, fixed base", fixed, NULL, 0);
    printf("vehicle against fixed base, least against least: %.2f\n", vehicle / base);
    return 0;
}
