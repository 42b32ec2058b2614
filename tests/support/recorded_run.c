#include "support/recorded_run.h"

#include <stdlib.h>

#include "support/check.h"

static ld_status begin(void *self, const ld_column *columns, size_t count, ld_error *error)
{
    (void)columns, (void)error;
    ((recorded_run *)self)->columns = count;
    return LD_OK;
}

static ld_status row(void *self, const double *values, size_t count, ld_error *error)
{
    recorded_run *run = self;
    (void)error;
    if (run->rows == run->capacity) {
        run->capacity = 2 * run->capacity + 1000;
        run->values = realloc(run->values, run->capacity * count * sizeof *values);
    }
    memcpy(run->values + run->rows++ * count, values, count * sizeof *values);
    return LD_OK;
}

static void run_model(const ld_model *model, const ld_sink *sink, ld_simulation **simulation,
                      ld_summary *summary)
{
    ld_error error;
    if (ld_simulation_create(model, simulation, &error) ||
        ld_simulation_run(*simulation, &(ld_run_options){.sink = sink}, summary, &error))
        fail_msg("%s", error.text);
}

void recorded_run_make(recorded_run *run, const ld_model *model)
{
    ld_sink sink = {.self = run, .begin = begin, .row = row};
    memset(run, 0, sizeof *run);
    run_model(model, &sink, &run->simulation, &run->summary);
}

void recorded_run_free(recorded_run *run)
{
    ld_simulation_free(run->simulation);
    free(run->values);
    memset(run, 0, sizeof *run);
}

size_t recorded_column(const recorded_run *run, const char *name)
{
    const ld_column *columns;
    size_t count = ld_simulation_columns(run->simulation, &columns);
    for (size_t i = 0; i < count; i++)
        if (strcmp(columns[i].name, name) == 0)
            return i;
    fail_msg("no column %s", name);
    return 0;
}

double recorded_value(const recorded_run *run, size_t at, size_t column)
{
    return run->values[at * run->columns + column];
}

ld_summary summary_of_run(const ld_model *model)
{
    ld_simulation *simulation;
    ld_summary summary;
    run_model(model, NULL, &simulation, &summary);
    ld_simulation_free(simulation);
    return summary;
}
