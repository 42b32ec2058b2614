// A thousand launches of the fixed launcher, each with another mass: what bench/launches.py does by
// the Python package, by the C interface.
//
//     bench_launches [COUNT]
#include "launchdyn/history.h"
#include "launchdyn/scenario.h"
#include "launchdyn/summary.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

// Sets the mass [kg], runs, and adds the exit speed [m/s] and the last deflection of the tip [m].
static ld_status launch(ld_model *model, double mass, double *sum, ld_error *error)
{
    char text[40];
    double speed = 0;
    size_t rows = 0;
    const double *tip = NULL;
    ld_messages messages;
    ld_simulation *simulation = NULL;
    ld_history *history = ld_history_new(NULL);
    ld_summary *summary = ld_summary_new();
    snprintf(text, sizeof text, "%.17g kg", mass);
    ld_status status = ld_model_set(model, "rocket.mass", text, &messages);
    if (!status)
        status = ld_simulation_create(model, &simulation, error);
    if (!status)
        status = ld_simulation_run(simulation, &(ld_run_options){.sink = ld_history_sink(history)},
                                   summary, error);
    if (!status)
        status = ld_summary_number(summary, "rocket.1.exit_speed", &speed, error);
    if (!status)
        tip = ld_history_column(history, "tip.y", &rows);
    *sum += tip ? speed + tip[rows - 1] : speed;
    ld_summary_free(summary);
    ld_history_free(history);
    ld_simulation_free(simulation);
    return status;
}

int main(int argc, char **argv)
{
    int count = argc > 1 ? atoi(argv[1]) : 1000;
    double sum = 0;
    ld_model *model;
    ld_messages messages;
    ld_error error;
    if (ld_scenario_read(LD_SOURCE_DIR "/examples/fixed.yaml", NULL, 0, &model, &messages))
        return 1;
    clock_t start = clock();
    ld_status status = LD_OK;
    for (int i = 0; i < count && !status; i++)
        status = launch(model, 60 + i * 1e-3, &sum, &error);
    printf("%d launches by the C interface: %.2f s of CPU time (sum %.17g)\n", count,
           (double)(clock() - start) / CLOCKS_PER_SEC, sum);
    ld_model_free(model);
    return status;
}
