// The library in one page: read a scenario, run it for several masses of the rocket, follow one
// column while it runs, and keep the results of the last one.
//
//     launch SCENARIO.yaml FOLDER
#include <launchdyn/output.h>
#include <launchdyn/scenario.h>
#include <launchdyn/simulation.h>

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
    ld_summary summary;
    ld_status status = ld_simulation_create(model, &simulation, error);
    if (!status && folder)
        status = ld_output_open(folder, model, false, &output, error);
    if (!status) {
        watch watched = {.next = output ? ld_output_sink(output) : NULL};
        const ld_sink sink = {.self = &watched, .begin = watch_begin, .row = watch_row};
        status = ld_simulation_run(simulation, &(ld_run_options){.sink = &sink}, &summary, error);
        if (!status)
            printf("%5.1f kg  leaves at %8.4f ms with %8.4f m/s, pitch rate %8.3f mrad/s; "
                   "tip moved up to %.3f mm\n",
                   model->rocket.full.mass, summary.rocket[0].t_rear * 1e3,
                   summary.rocket[0].muzzle_speed, summary.rocket[0].pitch_rate * 1e3,
                   watched.largest * 1e3);
    }
    if (output && !status)
        status = ld_output_finish(output, &summary, error);
    else
        ld_output_discard(output);
    ld_simulation_free(simulation);
    return status;
}

int main(int argc, char **argv)
{
    if (argc != 3) {
        fprintf(stderr, "usage: launch SCENARIO.yaml FOLDER\n");
        return 2;
    }
    ld_model model;
    ld_messages messages;
    if (ld_scenario_read(argv[1], NULL, 0, &model, &messages)) {
        ld_messages_print(&messages, stderr);
        ld_messages_free(&messages);
        return 2;
    }
    ld_error error;
    ld_status status = LD_OK;
    double mass = model.rocket.full.mass;
    for (int i = -1; i <= 1 && !status; i++) {
        model.rocket.full.mass = mass + i;
        status = run(&model, i == 1 ? argv[2] : NULL, &error);
    }
    if (status)
        fprintf(stderr, "launch: %s\n", error.text);
    ld_model_free(&model);
    return status ? 1 : 0;
}
