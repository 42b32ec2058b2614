// The library in one page: read a scenario, run it for several masses of the rocket, look at
// results and at one column of the history, and keep the results of the last run in a folder.
//
//     launch SCENARIO.yaml FOLDER
#include <launchdyn/history.h>
#include <launchdyn/output.h>
#include <launchdyn/scenario.h>
#include <launchdyn/simulation.h>
#include <launchdyn/summary.h>

#include <math.h>
#include <stdio.h>

// A result of the first rocket, in SI.
static double result(const ld_summary *summary, const char *name)
{
    double value;
    ld_summary_number(summary, name, &value, NULL);
    return value;
}

// Runs the model; rows go into `history`, results into `summary`.
static ld_status run(const ld_model *model, ld_history *history, ld_summary *summary,
                     ld_error *error)
{
    ld_simulation *simulation;
    ld_status status = ld_simulation_create(model, &simulation, error);
    if (status)
        return status;
    ld_run_options options = {.sink = ld_history_sink(history)};
    status = ld_simulation_run(simulation, &options, summary, error);
    ld_simulation_free(simulation);
    return status;
}

static void tell(const ld_model *model, const ld_history *history, const ld_summary *summary)
{
    char mass[32];
    size_t rows;
    const double *y = ld_history_column(history, "tip.y", &rows);
    double largest = 0;
    for (size_t i = 0; i < rows; i++)
        largest = fmax(largest, fabs(y[i]));
    ld_model_text(model, "rocket.mass", mass, sizeof mass, NULL);
    printf("%s  leaves at %8.4f ms with %8.4f m/s, pitch rate %8.3f mrad/s; tip moved up to %.3f "
           "mm\n",
           mass, 1e3 * result(summary, "rocket.1.t_rear"), result(summary, "rocket.1.exit_speed"),
           1e3 * result(summary, "rocket.1.pitch_rate"), 1e3 * largest);
}

// Runs the model with another mass; what comes of it goes into `folder` too unless it is NULL.
static ld_status run_with_mass(ld_model *model, const char *mass, const char *folder,
                               ld_error *error)
{
    ld_messages messages;
    ld_output *output = NULL;
    ld_status status = ld_model_set(model, "rocket.mass", mass, &messages);
    if (status) {
        ld_messages_print(&messages, stderr);
        ld_messages_free(&messages);
        return ld_fail(error, status, "a rocket of %s cannot be simulated", mass);
    }
    if (folder && (status = ld_output_open(folder, model, false, &output, error)))
        return status;
    ld_history *history = ld_history_new(output ? ld_output_sink(output) : NULL);
    ld_summary *summary = ld_summary_new();
    status = history && summary ? run(model, history, summary, error)
                                : ld_fail(error, LD_ERR_MEMORY, "no memory");
    if (!status)
        tell(model, history, summary);
    if (output && !status)
        status = ld_output_finish(output, summary, error);
    else
        ld_output_discard(output);
    ld_history_free(history);
    ld_summary_free(summary);
    return status;
}

int main(int argc, char **argv)
{
    if (argc != 3) {
        fprintf(stderr, "usage: launch SCENARIO.yaml FOLDER\n");
        return 2;
    }
    ld_model *model;
    ld_messages messages;
    if (ld_scenario_read(argv[1], NULL, 0, &model, &messages)) {
        ld_messages_print(&messages, stderr);
        ld_messages_free(&messages);
        return 2;
    }
    static const char *const mass[] = {"59 kg", "60 kg", "61 kg"};
    ld_error error;
    ld_status status = LD_OK;
    for (int i = 0; i < 3 && !status; i++)
        status = run_with_mass(model, mass[i], i == 2 ? argv[2] : NULL, &error);
    if (status)
        fprintf(stderr, "launch: %s\n", error.text);
    ld_model_free(model);
    return status ? 1 : 0;
}
