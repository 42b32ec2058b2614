// Cost of a launch: one evaluation of the launching subsystem's accelerations, also with two shoes
// in a T-slot, set-up, a whole launch; steps and evaluations by phase, error of what the exit
// leaves against a tight run. Medians of many, process CPU time; the reference launcher on a fixed
// base at default settings.
#include <math.h>

#include "bench_sample.h"
#include "launch/launch_run.h"
#include "model/model.h"
#include "scenario/scenario.h"
#include "state/equilibrium.h"
#include "state/evaluation.h"
#include "systems/launching/launching_dynamics.h"
#include "systems/launching/launching_general.h"
#include "systems/launching/launching_overall.h"

enum { REPEATS = 41, EVALUATIONS = 2000, FEW_EVALUATIONS = 100 };

// A state in the tube with `contacts` adaptors on the wall.
static void bench_evaluation(launch_state *launch, int contacts, const char *what)
{
    double y[LD_MAX_STATES], sample[REPEATS];
    ld_equilibrium_summary unused;
    launching_phase phase = simulation_start_phase(launch);
    launcher_input input;
    launching_output out;
    const launching_layout *at = &launch->launcher.launching.layout;
    if (simulation_equilibrium(launch, 0, y, &unused, NULL))
        return;
    launch->piece = 1;
    simulation_input(launch, 0.1, y, &input);
    phase.locked = false;
    y[at->x] = 0.7;
    y[at->V] = 10;
    if (contacts == 3)
        y[at->x + 1] -= 1e-3;
    for (int r = 0; r < REPEATS; r++) {
        double start = now();
        for (int i = 0; i < EVALUATIONS; i++) {
            y[at->x + 1] += 1e-12; // a new state each time
            launching_evaluate(&launch->launcher.launching, &input.launching, &phase, y, &out);
        }
        sample[r] = (now() - start) / EVALUATIONS;
    }
    print(what, sample, REPEATS, 1e-9, "ns");
}

typedef launching_outcome evaluation(const launching_system *, const launching_input *,
                                     const launching_phase *, const double *, launching_output *);

static void bench_form(launch_state *launch, evaluation *evaluate, const char *what)
{
    double y[LD_MAX_STATES], sample[REPEATS];
    ld_equilibrium_summary unused;
    launching_phase phase = simulation_start_phase(launch);
    launcher_input input;
    launching_output out;
    if (simulation_equilibrium(launch, 0, y, &unused, NULL))
        return;
    simulation_input(launch, 0.1, y, &input);
    for (int r = 0; r < REPEATS; r++) {
        double start = now();
        for (int i = 0; i < FEW_EVALUATIONS; i++)
            evaluate(&launch->launcher.launching, &input.launching, &phase, y, &out);
        sample[r] = (now() - start) / FEW_EVALUATIONS;
    }
    print(what, sample, REPEATS, 1e-9, "ns");
}

// Smooth bore with its three adaptors, and two shoes in a T-slot whose lips all hold a rolled
// rocket, in turn; the ratio of the medians.
static void bench_guides(const ld_model *model)
{
    static const char *const what[] = {"evaluation, smooth bore, 3 of 3 in contact",
                                       "evaluation, T-slot, both shoes on both lips"};
    for (int slot = 0; slot < 2; slot++) {
        ld_model guided = *model;
        ld_simulation *simulation;
        launch_state launch;
        guided.tubes.slot.kind = LD_SLOT_NONE;
        guided.run.start = LD_START_UNDEFORMED;
        if (slot) {
            guided.tubes.guide = (ld_guide){
                .present = true, .form = LD_GUIDE_T_SLOT, .t_slot = {.lips = 0.06, .gap = 1e-6}};
            guided.rocket.adaptor[1] = guided.rocket.adaptor[2];
            guided.rocket.adaptor_count = 2;
            guided.rocket.adaptor[0].clearance = guided.rocket.adaptor[1].clearance = NAN;
        }
        if (ld_simulation_create(&guided, &simulation, NULL) ||
            launch_state_begin(&launch, simulation, NULL))
            return;
        bench_evaluation(&launch, 3, what[slot]);
        launch_state_end(&launch);
        ld_simulation_free(simulation);
    }
}

static void bench_run(const ld_model *model)
{
    double setup[REPEATS], run[REPEATS];
    ld_summary summary;
    for (int r = 0; r < REPEATS; r++) {
        ld_simulation *simulation;
        double start = now();
        if (ld_simulation_create(model, &simulation, NULL))
            return;
        setup[r] = now() - start;
        start = now();
        ld_simulation_run(simulation, NULL, &summary, NULL);
        run[r] = now() - start;
        ld_simulation_free(simulation);
    }
    print("set-up (modes, coefficients)", setup, REPEATS, 1e-3, "ms");
    print("whole launch, start in equilibrium included", run, REPEATS, 1e-3, "ms");
    printf("    %lld steps, %lld evaluations: %.0f ns each, all told\n",
           (long long)summary.statistics.steps, (long long)summary.statistics.rhs_evaluations,
           1e9 * run[REPEATS / 2] / (double)summary.statistics.rhs_evaluations);
}

// From event to event.
static void print_phases(const ld_simulation *simulation)
{
    static const char *const names[] = {[LD_EVENT_CORNER] = "up to the thrust's corner",
                                        [LD_EVENT_RELEASE] = "locked, up to the release",
                                        [LD_EVENT_EXIT] = "up to an adaptor's exit"};
    ld_run *run;
    ld_event next;
    int64_t steps = 0, evaluations = 0;
    double from = 0;
    if (ld_run_begin(simulation, NULL, &run, NULL))
        return;
    while (!ld_run_is_finished(run) && !ld_run_advance_to_event(run, INFINITY, &next, NULL)) {
        int64_t all_steps = propagator_steps(run->propagator);
        int64_t all_evaluations = propagator_evaluations(run->propagator);
        bool named = next.kind == LD_EVENT_CORNER || next.kind == LD_EVENT_RELEASE ||
                     next.kind == LD_EVENT_EXIT;
        if (!named)
            continue;
        printf("    %-26s %7.2f ms, %5lld steps, %5lld evaluations\n", names[next.kind],
               1e3 * (next.t - from), (long long)(all_steps - steps),
               (long long)(all_evaluations - evaluations));
        steps = all_steps;
        evaluations = all_evaluations;
        from = next.t;
    }
    ld_run_end(run, NULL, NULL);
}

static const ld_rocket_summary *exit_of(const ld_model *model, double tolerance,
                                        ld_summary *summary)
{
    ld_model varied = *model;
    ld_simulation *simulation;
    varied.run.tolerance = tolerance;
    if (ld_simulation_create(&varied, &simulation, NULL))
        exit(1);
    ld_status status = ld_simulation_run(simulation, NULL, summary, NULL);
    ld_simulation_free(simulation);
    if (status)
        exit(1);
    return &summary->rocket[0];
}

// What the tolerance leaves of errors.
static void print_errors(const ld_model *model)
{
    static ld_summary tight, usual;
    const ld_rocket_summary *exact = exit_of(model, 1e-10, &tight);
    printf(
        "tolerance     steps  evaluations  rate of pitch, yaw, spin off by [mrad/s]  exit [ns]\n");
    for (int k = 4; k <= 8; k++) {
        const ld_rocket_summary *found = exit_of(model, pow(10, -k), &usual);
        printf("    1e-%02d %9lld %12lld %12.1e %9.1e %9.1e %18.1e\n", k,
               (long long)usual.statistics.steps, (long long)usual.statistics.rhs_evaluations,
               1e3 * fabs(found->pitch_rate - exact->pitch_rate),
               1e3 * fabs(found->yaw_rate - exact->yaw_rate),
               1e3 * fabs(found->spin_rate - exact->spin_rate),
               1e9 * fabs(found->t_rear - exact->t_rear));
    }
}

int main(void)
{
    ld_model model;
    ld_messages messages = {0};
    ld_simulation *simulation;
    launch_state launch;
    if (scenario_read(LD_SOURCE_DIR "/examples/fixed.yaml", NULL, 0, &model, &messages) ||
        ld_simulation_create(&model, &simulation, NULL) ||
        launch_state_begin(&launch, simulation, NULL))
        return 1;
    bench_evaluation(&launch, 2, NULL); // the processor warms up
    bench_evaluation(&launch, 2, "evaluation, reduced, fast layout, 2 of 3 in contact");
    bench_evaluation(&launch, 3, "evaluation, reduced, fast layout, 3 of 3 in contact");
    bench_form(&launch, launching_evaluate_general, "evaluation, reduced, general matrix");
    bench_form(&launch, launching_evaluate_overall, "evaluation, overall 19 x 19");
    launch_state_end(&launch);
    bench_guides(&model);
    bench_run(&model);
    print_phases(simulation);
    print_errors(&model);
    ld_simulation_free(simulation);
    model_clear(&model);
    return 0;
}
