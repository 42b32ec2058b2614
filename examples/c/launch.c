// The library in one page: read a scenario, run it for several masses of the rocket, follow one
// column while it runs, and keep the results of the last one.
//
//     launch SCENARIO.yaml FOLDER
#include <launchdyn/output.h>
#include <launchdyn/scenario.h>
#include <launchdyn/simulation.h>
#include <launchdyn/summary.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

// A sink that keeps the largest magnitude of the tip's deflection and hands every row on.
typedef struct watch {
    const ld_sink *next; // NULL: nobody else wants the rows
    size_t column;       // of tip.y
    double largest;      // [m]
} watch;

static ld_status watch_begin(void *self, const ld_column *columns, size_t count, ld_error *error)
{
    watch *watched = self;
    for (size_t i = 0; i < count; i++)
        if (strcmp(columns[i].name, "tip.y") == 0)
            watched->column = i;
    return watched->next ? watched->next->begin(watched->next->self, columns, count, error) : LD_OK;
}

static ld_status watch_row(void *self, const double *values, size_t count, ld_error *error)
{
    watch *watched = self;
    watched->largest = fmax(watched->largest, fabs(values[watched->column]));
    return watched->next ? watched->next->row(watched->next->self, values, count, error) : LD_OK;
}

// Runs the model; results go into `folder` unless it is NULL.
static ld_status run(const ld_model *model, const char *folder, ld_error *error)
{
    ld_simulation *simulation = NULL;
    ld_output *output = NULL;
    ld_summary *summary = ld_summary_new();
    ld_status status = summary ? ld_simulation_create(model, &simulation, error) : LD_ERR_MEMORY;
    if (!status && folder)
        status = ld_output_open(folder, model, false, &output, error);
    if (!status) {
        watch watched = {.next = output ? ld_output_sink(output) : NULL};
        const ld_sink sink = {.self = &watched, .begin = watch_begin, .row = watch_row};
        status = ld_simulation_run(simulation, &(ld_run_options){.sink = &sink}, summary, error);
        double mass, t_rear, speed, rate;
        if (!status)
            status = ld_model_number(model, "rocket.mass", &mass, error);
        if (!status)
            status = ld_summary_number(summary, 1, "t_rear", &t_rear, error);
        if (!status)
            status = ld_summary_number(summary, 1, "muzzle_speed", &speed, error);
        if (!status)
            status = ld_summary_number(summary, 1, "pitch_rate", &rate, error);
        if (!status)
            printf("%5.1f kg  leaves at %8.4f ms with %8.4f m/s, pitch rate %8.3f mrad/s; "
                   "tip moved up to %.3f mm\n",
                   mass, t_rear * 1e3, speed, rate * 1e3, watched.largest * 1e3);
    }
    if (output && !status)
        status = ld_output_finish(output, summary, error);
    else
        ld_output_discard(output);
    ld_simulation_free(simulation);
    ld_summary_free(summary);
    return status;
}

// Reads the scenario with an override (or none); NULL after messages.
static ld_model *read(const char *path, const char *set)
{
    ld_model *model;
    ld_messages messages;
    if (ld_scenario_read(path, &set, set != NULL, &model, &messages))
        ld_messages_print(&messages, stderr);
    ld_messages_free(&messages);
    return model;
}

int main(int argc, char **argv)
{
    if (argc != 3) {
        fprintf(stderr, "usage: launch SCENARIO.yaml FOLDER\n");
        return 2;
    }
    double mass;
    ld_error error = {0};
    ld_model *model = read(argv[1], NULL);
    ld_status status = model ? ld_model_number(model, "rocket.mass", &mass, &error) : LD_ERR_INPUT;
    ld_model_free(model);
    for (int i = -1; i <= 1 && !status; i++) {
        char set[64];
        snprintf(set, sizeof set, "rocket.mass=%.17g kg", mass + i);
        model = read(argv[1], set);
        status = model ? run(model, i == 1 ? argv[2] : NULL, &error) : LD_ERR_INPUT;
        ld_model_free(model);
    }
    if (status)
        fprintf(stderr, "launch: %s\n", error.text);
    return status ? 1 : 0;
}
